// The picture: sky, and water whose surface is the sum of the tiles. Put after fftocean.wgsl, whose block `sea` has the tiles; the
// functions `displaced` and `summed` come from water.js, which knows how many there are.

struct View {
  right: vec4f, up: vec4f, forward: vec4f,  // rows of the projection: clip x, y and w of a place from the eye
  ray_right: vec4f, ray_up: vec4f,          // directions of the picture's edges
  sun: vec4f,                               // toward it; w: exposure
  mesh: vec4f,                              // columns, rings, nearest ring [m], ln(farthest / nearest)
  sector: vec4f,                            // distance of the apex behind the eye [m], direction, half angle; height of the eye [m]
  beyond: vec4f,                            // slope variance of the waves that no tile holds: xx, yy, xy; w: significant wave height [m]
  foam: vec4f,                              // place of the eye in the window of foam, 1 / its size; 1 / 256 m of the noise
  noise: vec4f,                             // place of the eye in the noise
}

@group(1) @binding(0) var<uniform> view: View;
@group(1) @binding(1) var repeating: sampler;
@group(1) @binding(2) var foam_map: texture_2d<f32>;

struct Sums { slope: vec2f, stretch: vec3f, variance: vec3f }

const PI = 3.14159265;
const EARTH = 6371e3;       // radius [m]
const SUN = vec3f(1.0, 0.97, 0.93) * 10.0;   // irradiance above the air, any unit
const RAYLEIGH = vec3f(0.046, 0.108, 0.265); // optical depth of the air at 610, 550, 465 nm
const HAZE = vec3f(0.03, 0.032, 0.035);      // of what is in it
const OZONE = vec3f(0.010, 0.028, 0.001);     // which only absorbs
const WATER = vec3f(0.0016, 0.0085, 0.0135); // radiance from below, of the irradiance [1/sr]

// Air masses on the way to a direction (Kasten & Young 1989).
fn air_mass(up: f32) -> f32 {
  let degrees = asin(clamp(up, 0.0, 1.0)) * 180.0 / PI;
  return 1.0 / (max(up, 0.0) + 0.50572 * pow(degrees + 6.07995, -1.6364));
}

fn sunlight() -> vec3f { return SUN * exp(-(RAYLEIGH + HAZE + OZONE) * air_mass(view.sun.z)); }

// Clear sky: light scattered once in a flat layer, and a share of what was scattered before.
fn sky(direction: vec3f) -> vec3f {
  let cosine = dot(direction, view.sun.xyz);
  let to_eye = air_mass(max(direction.z, 0.0));
  let to_sun = air_mass(view.sun.z);
  let depth = RAYLEIGH + HAZE + OZONE;
  let g = 0.76;
  let rayleigh = 3.0 / (16.0 * PI) * (1.0 + cosine * cosine);
  let haze = (1.0 - g * g) / (4.0 * PI * pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
  let away = to_sun - to_eye;
  let apart = select(away, select(0.02, -0.02, away < 0.0), abs(away) < 0.02);
  let layer = to_eye / apart * (exp(-depth * to_eye) - exp(-depth * (to_eye + apart)));
  let once = SUN * (RAYLEIGH * rayleigh + HAZE * haze) / depth * layer;
  let again = SUN * RAYLEIGH * max(view.sun.z, 0.05) * exp(-depth * to_sun * 0.6) * (1.0 - exp(-depth * to_eye)) * 0.55 / (depth * PI);
  return once + again;
}

fn sky_light() -> vec3f { return PI * 0.5 * (sky(vec3f(0.0, 0.0, 1.0)) + sky(normalize(vec3f(-view.sun.xy, 0.6)))); }

// From radiance to the screen: a filmic curve (Narkowicz' fit to ACES), sRGB, and half a step of noise against bands.
fn shown(radiance: vec3f, at: vec2f) -> vec4f {
  let x = radiance * view.sun.w;
  let curve = clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), vec3f(0.0), vec3f(1.0));
  let coded = select(1.055 * pow(curve, vec3f(1.0 / 2.4)) - 0.055, 12.92 * curve, curve < vec3f(0.0031308));
  return vec4f(coded + (fract(52.98 * fract(dot(at, vec2f(0.0671, 0.00584)))) - 0.5) / 255.0, 1.0);
}

struct SkyPoint { @builtin(position) position: vec4f, @location(0) ray: vec3f }

@vertex fn sky_corner(@builtin(vertex_index) i: u32) -> SkyPoint {
  let corner = vec2f(f32(i & 1u), f32(i >> 1u)) * 4.0 - 1.0;
  return SkyPoint(vec4f(corner, 0.0, 1.0), view.forward.xyz + corner.x * view.ray_right.xyz + corner.y * view.ray_up.xyz);
}

@fragment fn sky_colour(p: SkyPoint) -> @location(0) vec4f {
  let direction = normalize(p.ray);
  let angle = acos(clamp(dot(direction, view.sun.xyz), -1.0, 1.0));
  let disc = sunlight() * (900.0 * smoothstep(0.0056, 0.0042, angle) + 0.8 * exp(-angle / 0.015) + 0.06 * exp(-angle / 0.1));
  return shown(sky(normalize(vec3f(direction.xy, max(direction.z, 0.002)))) + disc, p.position.xy);
}

struct Point {
  @builtin(position) position: vec4f,
  @location(0) place: vec3f,  // from the eye, displaced
  @location(1) rest: vec2f,   // from the eye, at rest
}

// The mesh: rings about an apex behind the eye, each farther by the same factor; a strip of triangles between two of them.
@vertex fn mesh(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Point {
  let ring = f32(instance + (vertex & 1u)) / view.mesh.y;
  let column = f32(vertex >> 1u) / view.mesh.x;
  let angle = view.sector.y + view.sector.z * (2.0 * column - 1.0);
  let away = view.mesh.z * exp(view.mesh.w * ring);
  let rest = away * vec2f(cos(angle), sin(angle)) - view.sector.x * vec2f(cos(view.sector.y), sin(view.sector.y));
  // Waves shorter than the mesh can hold are left to the shading.
  let spacing = away * pow(2.0 * view.sector.z / view.mesh.x, 0.4) * pow(view.mesh.w / view.mesh.y, 0.6);
  let place = vec3f(rest, -view.sector.w - dot(rest, rest) / (2.0 * EARTH)) + displaced(rest, spacing);
  let clip = vec4f(dot(view.right.xyz, place), dot(view.up.xyz, place), 0.1, dot(view.forward.xyz, place));
  return Point(clip, place, rest);
}

fn hash(cell: vec2f) -> f32 {
  let wrapped = vec2u(vec2i(cell) & vec2i(255));
  var bits = wrapped.x * 1664525u + wrapped.y * 22695477u;
  bits = (bits ^ (bits >> 13u)) * 2246822519u;
  bits = (bits ^ (bits >> 15u)) * 3266489917u;
  return f32(bits >> 8u) / 16777216.0;
}

fn smooth_noise(at: vec2f) -> f32 {
  let cell = floor(at);
  let f = (at - cell) * (at - cell) * (3.0 - 2.0 * (at - cell));
  return mix(mix(hash(cell), hash(cell + vec2f(1.0, 0.0)), f.x), mix(hash(cell + vec2f(0.0, 1.0)), hash(cell + 1.0), f.x), f.y);
}

// How near a place is to the border between two random cells, 1 on it: foam is a web of such.
fn web(at: vec2f) -> f32 {
  let cell = floor(at);
  var first = 9.0;
  var second = 9.0;
  for (var i = -1; i <= 1; i++) {
    for (var j = -1; j <= 1; j++) {
      let near = cell + vec2f(f32(i), f32(j));
      let apart = length(near + vec2f(hash(near), hash(near + 71.0)) - at);
      second = min(second, max(first, apart));
      first = min(first, apart);
    }
  }
  return 1.0 - clamp(second - first, 0.0, 1.0);
}

// Share of a pixel that foam covers: coverage, broken up.
fn foam_at(rest: vec2f, pixel: f32) -> f32 {
  let window = textureSampleBias(foam_map, repeating, view.foam.xy + rest * view.foam.z, 1.8).x;
  let edge = 2.0 * max(abs(rest.x), abs(rest.y)) * view.foam.z;
  let mean = textureLoad(foam_map, vec2u(0u), textureNumLevels(foam_map) - 1u).x;
  let cover = mix(window, mean, smoothstep(0.75, 0.98, edge));
  let at = 2.0 * rest + view.noise.xy;
  let bend = vec2f(smooth_noise(at), smooth_noise(at + 37.0));
  let fine = 0.55 * web(at + bend) + 0.45 * web(3.0 * at + 2.0 * bend);
  let noise = 0.7 * fine + 0.3 * smooth_noise(0.5 * at);
  let broken = smoothstep(0.0, 0.75, 1.4 * noise - 1.4 + 1.2 * pow(cover, 0.5));
  return mix(broken, cover, smoothstep(0.1, 0.6, pixel));
}

fn along(variance: vec3f, d: vec2f) -> f32 { return dot(variance, vec3f(d * d, 2.0 * d.x * d.y)); }

@fragment fn water_colour(p: Point) -> @location(0) vec4f {
  let distance = length(p.place);
  let to_eye = -p.place / distance;
  let sums = summed(p.rest);
  let pixel = max(length(dpdx(p.rest)), 1e-4);
  let foam = foam_at(p.rest, pixel);

  // Slope of the displaced surface, and the variance that filtering and the waves beyond the tiles leave.
  let a = 1.0 + sums.stretch.x;
  let b = 1.0 + sums.stretch.y;
  let c = sums.stretch.z;
  var slope = vec2f(b * sums.slope.x - c * sums.slope.y, a * sums.slope.y - c * sums.slope.x) / max(a * b - c * c, 0.15);
  slope *= min(1.0, 2.0 / max(length(slope), 1e-4));
  var variance = max(sums.variance + view.beyond.xyz, vec3f(2e-4, 2e-4, -1.0));
  let most = 0.95 * sqrt(variance.x * variance.y);
  variance.z = clamp(variance.z, -most, most);
  let level = max(length(to_eye.xy), 1e-4);
  let ahead = to_eye.xy / level;
  let deviation = sqrt(along(variance, ahead));

  // An eye that looks flatly sees those slopes that lean toward it.
  let tilt = min(deviation * deviation * level / max(to_eye.z + 0.7 * deviation, 0.02), 1.5 * deviation);
  let normal = normalize(vec3f(-slope + ahead * tilt, 1.0));
  let cosine = max(dot(normal, to_eye), 0.02);
  let fresnel = 0.02 + 0.98 * pow(1.0 - cosine, 5.0 * exp(-2.69 * deviation)) / (1.0 + 22.7 * pow(deviation, 1.5));

  // Sky in the mirror, from a few directions of the rough surface; rays below the horizon meet darker water.
  var mirrored = vec3f(0.0);
  for (var i = -1; i <= 1; i++) {
    let facet = normalize(normal + vec3f(ahead * deviation * 0.8 * f32(i), 0.0));
    let ray = reflect(-to_eye, facet);
    mirrored += sky(normalize(vec3f(ray.xy, abs(ray.z) + 0.02))) * mix(0.5, 1.0, smoothstep(-0.25, 0.1, ray.z)) / 3.0;
  }

  // Facets that mirror the sun (Cox & Munk 1954).
  let sun = sunlight();
  let halfway = normalize(view.sun.xyz + to_eye);
  let rough = variance + vec3f(2e-4, 2e-4, 0.0);
  let determinant = rough.x * rough.y - rough.z * rough.z;
  let off = -halfway.xy / max(halfway.z, 0.05) - slope;
  let square = (rough.y * off.x * off.x - 2.0 * rough.z * off.x * off.y + rough.x * off.y * off.y) / determinant;
  let facets = exp(-0.5 * square) / (2.0 * PI * sqrt(determinant));
  let mirror = 0.02 + 0.98 * pow(1.0 - max(dot(halfway, to_eye), 0.0), 5.0);
  // 0.4 is taste: all of it burns out the path below the sun, as it does in photographs.
  let glitter = 0.4 * sun * mirror * facets / (4.0 * pow(max(halfway.z, 0.1), 4.0) * max(to_eye.z + deviation, 0.05)) * smoothstep(0.0, 0.1, view.sun.z);

  // Light from below; more and greener where the sun shines through a crest.
  let falling = sun * max(view.sun.z, 0.0) + sky_light();
  let height = p.place.z + view.sector.w + dot(p.rest, p.rest) / (2.0 * EARTH);
  let crest = clamp(0.3 + height / view.beyond.w, 0.0, 1.2);
  let against = pow(max(dot(normalize(view.sun.xy), -ahead), 0.0) * 0.8 + 0.2, 2.0);
  let through = sun * vec3f(0.004, 0.026, 0.022) * against * crest * crest * smoothstep(0.05, 0.6, length(slope));
  let body = WATER * falling + through;

  var radiance = mix(body, mirrored, fresnel) + glitter;
  let white = 0.55 / PI * (sun * (0.25 + 0.75 * max(dot(normal, view.sun.xyz), 0.0)) + sky_light());
  radiance = mix(radiance, white, clamp(foam, 0.0, 0.92));

  // Air between: what it takes away it replaces by the sky above the horizon.
  let air = sky(normalize(vec3f(-to_eye.xy, 0.02)));
  return shown(mix(radiance, air, 1.0 - exp(-distance / 9000.0)), p.position.xy);
}
