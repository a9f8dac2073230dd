// Not run in Bevy: compiled by wgpu's naga with a stub of the import. The surface of the sea: maps of
// the kernels, sampled between texels and levels, summed over the tiles. x east, y up, z south.
#import bevy_pbr::mesh_view_bindings::view

struct SeaPlaces {
  eye: vec4f,                  // x, still water level, z
  count: vec4u,                // tiles
  sun: vec4f,                  // direction to it, brightness
  places: array<vec4f, 16>,    // sides [m]; place of the eye in the tile
  samples: array<vec4u, 16>,   // nx, ny, first texel in maps
}

@group(2) @binding(0) var<storage, read> maps: array<vec4f>;
@group(2) @binding(1) var<uniform> sea: SeaPlaces;

struct Between {
  @builtin(position) position: vec4f,
  @location(0) world: vec3f,
  @location(1) rest: vec2f,    // from the eye [m], east and north
}

// One level of a plane, between its texels; texel i is the water that rests at i/n of the side.
fn bilinear(first: u32, n: vec2u, place: vec2f) -> vec4f {
  let at = fract(place) * vec2f(n);
  let low = vec2u(floor(at)) % n;
  let high = (low + 1u) % n;
  let part = fract(at);
  let south = mix(maps[first + low.y * n.x + low.x], maps[first + low.y * n.x + high.x], part.x);
  let north = mix(maps[first + high.y * n.x + low.x], maps[first + high.y * n.x + high.x], part.x);
  return mix(south, north, part.y);
}

// A plane of a tile (0: moved, 1: slopes, 2: moments) averaged over a footprint [m].
fn plane_at(tile: u32, plane: u32, rest: vec2f, footprint: f32) -> vec4f {
  let sides = sea.places[tile].xy;
  let place = rest / sides + sea.places[tile].zw;
  var n = sea.samples[tile].xy;
  var first = sea.samples[tile].z;
  var all = 0u;
  for (var size = n; ; size = max(size / 2u, vec2u(1u))) {
    all += size.x * size.y;
    if (size.x * size.y == 1u) { break; }
  }
  first += plane * all;
  let level = max(0.0, log2(footprint * max(f32(n.x) / sides.x, f32(n.y) / sides.y)));
  let steps = min(u32(level), 16u);
  for (var i = 0u; i < steps && n.x * n.y > 1u; i++) {
    first += n.x * n.y;
    n = max(n / 2u, vec2u(1u));
  }
  // A texel of a level is the mean of its square of samples: its centre lies half a square further on.
  let half_square = 0.5 * (1.0 / vec2f(n) - 1.0 / vec2f(sea.samples[tile].xy));
  let fine = bilinear(first, n, place - half_square);
  if (level == 0.0 || n.x * n.y == 1u) { return fine; }
  let next = max(n / 2u, vec2u(1u));
  let next_half = 0.5 * (1.0 / vec2f(next) - 1.0 / vec2f(sea.samples[tile].xy));
  return mix(fine, bilinear(first + n.x * n.y, next, place - next_half), fract(level));
}

@vertex
fn vertex(@location(0) position: vec3f, @location(2) uv: vec2f) -> Between {
  let rest = vec2f(position.x, -position.z);
  var moved = vec3f(0.0);
  for (var i = 0u; i < sea.count.x; i++) { moved += plane_at(i, 0u, rest, uv.x).xyz; }
  var out: Between;
  out.world = sea.eye.xyz + position + vec3f(moved.x, moved.z, -moved.y);
  out.rest = rest;
  out.position = view.clip_from_world * vec4f(out.world, 1.0);
  return out;
}

fn sky(direction: vec3f) -> vec3f {
  return mix(vec3f(0.75, 0.83, 0.9), vec3f(0.25, 0.45, 0.75), sqrt(saturate(direction.y)));
}

@fragment
fn fragment(in: Between) -> @location(0) vec4f {
  let across = max(length(dpdx(in.rest)), 1e-3);
  let along = max(length(dpdy(in.rest)), 1e-3);
  let footprint = sqrt(across * along);
  var slope = vec2f(0.0);
  var stretch = vec3f(0.0);
  var variance = 0.005; // of the waves beyond the tiles
  for (var i = 0u; i < sea.count.x; i++) {
    let slopes = plane_at(i, 1u, in.rest, footprint);
    let moments = plane_at(i, 2u, in.rest, footprint);
    slope += slopes.xy;
    stretch += vec3f(slopes.zw, plane_at(i, 0u, in.rest, footprint).w);
    variance += max(0.0, 0.5 * (moments.x + moments.y - dot(slopes.xy, slopes.xy)));
  }
  // Slopes and stretches add up over tiles; the normal is of their sums.
  let sides = 1.0 + stretch.xy;
  let area = sides.x * sides.y - stretch.z * stretch.z;
  let tilt = vec2f(stretch.z * slope.y - sides.y * slope.x, stretch.z * slope.x - sides.x * slope.y);
  let normal = normalize(vec3f(tilt.x, max(area, 0.05), -tilt.y));
  let eye = normalize(view.world_position - in.world);
  let facing = saturate(dot(eye, normal));
  // Fresnel of a rough sea: Bruneton, Neyret and Holzschuch 2010
  let fresnel = 0.02 + 0.98 * pow(1.0 - facing, 5.0 * exp(-2.69 * sqrt(variance)))
    / (1.0 + 22.7 * pow(variance, 0.75));
  var mirrored = reflect(-eye, normal);
  mirrored.y = abs(mirrored.y); // else it meets another wave
  var light = mix(vec3f(0.01, 0.05, 0.07), sky(mirrored), fresnel);
  let to_sun = normalize(sea.sun.xyz);
  let middle = normalize(eye + to_sun);
  let facet = middle - normal * dot(middle, normal);
  let steep = dot(facet, facet) / max(dot(middle, normal) * dot(middle, normal), 1e-4);
  light += vec3f(1.0, 0.95, 0.85) * 0.001 * sea.sun.w * exp(-0.5 * steep / variance) / (6.2831853 * variance);
  let foam = 1.0 - smoothstep(0.1, 0.45, area); // where the surface is squeezed, without memory
  return vec4f(mix(light, vec3f(0.8), foam), 1.0);
}
