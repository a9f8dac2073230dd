// The water: a mesh about the camera, displaced by the sum of all tiles and lit by the sky.
import * as THREE from 'three';
import { HEAD, Passes, mapTarget, pass } from './passes.js';
import { SKY_PLACE, TONE } from './sky.js';

const WINDOW = { samples: 512, size: 160 }; // of foam that is remembered, about the origin [m]

/** Return the code of the sums over tiles: linear fields alone, never normals. */
export function sums(tiles) {
  const each = (line) => tiles.map((_, i) => line.replaceAll('TILE', i)).join('\n  ');
  return `
${each('uniform sampler2D displacement_TILE, slopes_TILE, moments_TILE;')}
uniform vec4 tiles[${tiles.length}]; // 1 / size, and half a texel with the sign of v
vec2 place(int i, vec2 rest) { return rest * tiles[i].xy * vec2(1.0, -sign(tiles[i].w)) + tiles[i].zw; }
float level(int i, vec2 samples, float spacing) { return log2(max(spacing * max(tiles[i].x * samples.x, tiles[i].y * samples.y), 1.0)); }
vec3 displaced(vec2 rest, float spacing) {
  vec3 sum = vec3(0.0);
  ${each('sum += textureLod(displacement_TILE, place(TILE, rest), level(TILE, vec2(textureSize(displacement_TILE, 0)), spacing)).xyz;')}
  return sum;
}
// Slopes, stretches (XX, ZZ, XZ), and covariance of the slopes that filtering took away.
void summed(vec2 rest, out vec2 slope, out vec3 stretch, out vec3 variance, out float foam) {
  slope = vec2(0.0); stretch = vec3(0.0); variance = vec3(0.0); foam = 0.0;
  vec4 s, m; float xz;
  ${each(`s = texture(slopes_TILE, place(TILE, rest)); m = texture(moments_TILE, place(TILE, rest));
  xz = texture(displacement_TILE, place(TILE, rest)).w;
  slope += s.xy; stretch += vec3(s.zw, xz); foam += m.w;
  variance += max(m.xyz - vec3(s.xy * s.xy, s.x * s.y), vec3(0.0, 0.0, -1.0));`)}
}`;
}

const EIGENVALUE = `
// The smallest eigenvalue of the deformation gradient: 1 at rest, 0 at a fold.
float eigenvalue(vec3 stretch) {
  return 1.0 + 0.5 * (stretch.x + stretch.y) - length(vec2(0.5 * (stretch.x - stretch.y), stretch.z));
}`;

// df/dt = -f / tau + strength max(threshold - eigenvalue, 0), of the sum of all tiles.
const foamStep = (tiles) => `${sums(tiles)}${EIGENVALUE}
uniform sampler2D before; uniform float seconds; uniform vec3 rule; uniform bool fresh;
out vec4 foam;
void main() {
  vec2 rest = (gl_FragCoord.xy / ${WINDOW.samples.toFixed(1)} - 0.5) * ${WINDOW.size.toFixed(1)};
  // texels as they are: filtering would take away what foams
  vec3 stretch = vec3(0.0);
  ivec2 count, texel;
  ${tiles.map((_, i) => `count = textureSize(slopes_${i}, 0);
  texel = ivec2(floor(fract(place(${i}, rest)) * vec2(count))) % count;
  stretch += vec3(texelFetch(slopes_${i}, texel, 0).zw, texelFetch(displacement_${i}, texel, 0).w);`).join('\n  ')}
  float breaking = rule.z * max(rule.y - eigenvalue(stretch), 0.0);
  float left = fresh ? 0.0 : exp(-seconds / rule.x);
  float amount = min(left * texelFetch(before, ivec2(gl_FragCoord.xy), 0).x + (1.0 - left) * rule.x * breaking, 30.0);
  foam = vec4(amount, 1.0 - exp(-amount), 0.0, 1.0);
}`;

const VERTEX = (tiles) => `${HEAD}
in vec3 position; // angle, radius, gap to the next ring
uniform mat4 projectionMatrix, viewMatrix; uniform vec3 cameraPosition;
${sums(tiles)}
out vec3 at; out vec2 rest;
void main() {
  rest = cameraPosition.xz + position.y * vec2(cos(position.x), sin(position.x));
  float spacing = pow(position.y * ${((2 * Math.PI) / 512).toFixed(6)}, 0.4) * pow(position.z, 0.6);
  float d = position.y;
  at = vec3(rest.x, -d * d / 12742e3, rest.y) + displaced(rest, spacing);
  gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0);
}`;

const FRAGMENT = (tiles) => `${HEAD}
${SKY_PLACE}${TONE}${sums(tiles)}${EIGENVALUE}
uniform vec3 cameraPosition, sunward, sun_light, sky_light, beyond, rule;
uniform sampler2D sky, foam_window, noise; uniform int foam_source; uniform float wave_height; uniform vec2 wind;
in vec3 at; in vec2 rest;
out vec4 colour;

const vec3 ABSORPTION = vec3(0.276, 0.069, 0.0393), BACK = vec3(0.0025, 0.0030, 0.0044);
const vec3 REFLECTANCE = vec3(0.00045, 0.00216, 0.00545); // 0.3 mg/m^3 of chlorophyll

float along(vec3 v, vec2 d) { return dot(v, vec3(d * d, 2.0 * d.x * d.y)); }

float fresnel(float cosine) { return 0.02 + 0.98 * pow(1.0 - clamp(cosine, 0.0, 1.0), 5.0); }

// Shadowing of a rough sea (Smith; Bruneton, Neyret & Holzschuch 2010).
float shadow(float cosine, float variance) {
  float a = cosine / sqrt(max(1.0 - cosine * cosine, 1e-6) * 2.0 * variance), gauss = exp(-a * a);
  float erfc = 2.0 * gauss / (2.319 * a + sqrt(4.0 + 1.52 * a * a));
  return max((gauss - 1.7724539 * a * erfc) / (3.5449077 * a), 0.0);
}

float cover(vec2 rest, vec3 stretch, float baked) {
  if (foam_source == 0) return 0.0;
  if (foam_source == 1) return clamp(baked, 0.0, 1.0);
  float now = 1.0 - exp(-rule.x * rule.z * max(rule.y - eigenvalue(stretch), 0.0));
  vec2 inside = abs(rest) * ${(2 / WINDOW.size).toFixed(6)};
  // part of the coverage is spread over the water around: the noise makes streaks of it
  vec2 at_ = rest * ${(1 / WINDOW.size).toFixed(8)} + 0.5;
  float pixel = log2(max(length(fwidth(at_)) * ${WINDOW.samples.toFixed(1)}, 1.0));
  float kept = mix(texture(foam_window, at_).y, textureLod(foam_window, at_, max(pixel, 2.3)).y, 0.7);
  return mix(kept, now, smoothstep(0.8, 1.0, max(inside.x, inside.y)));
}

void main() {
  vec3 to_eye = cameraPosition - at;
  float distance_ = length(to_eye);
  to_eye /= distance_;
  vec2 s; vec3 stretch, variance; float baked;
  summed(rest, s, stretch, variance, baked);
  // the slope of the displaced surface, of the sums
  float a = 1.0 + stretch.x, b = 1.0 + stretch.y, c = stretch.z, jacobian = max(a * b - c * c, 0.15);
  vec2 slope = vec2(b * s.x - c * s.y, a * s.y - c * s.x) / jacobian;
  slope *= min(1.0, 2.2 / max(length(slope), 1e-4));
  variance = max(variance + beyond, vec3(4e-5, 4e-5, -1.0));
  float most = 0.98 * sqrt(variance.x * variance.y);
  variance.z = clamp(variance.z, -most, most);

  // the mean of the slopes that the eye sees leans toward it where it looks along the water
  vec2 ahead = to_eye.xz / max(length(to_eye.xz), 1e-4);
  float deviation = sqrt(max(along(variance, ahead), 1e-6)), sine = length(to_eye.xz);
  float middle = to_eye.y - dot(slope, ahead) * sine, x = middle / max(deviation * sine, 1e-4);
  float lean = deviation * exp(-0.5 * x * x) * 0.3989 / max(0.5 + 0.5 * x / sqrt(0.6 + x * x), 0.05);
  vec2 seen = slope - ahead * min(lean, 1.2);
  vec3 normal = normalize(vec3(-seen.x, 1.0, -seen.y));
  float cosine = max(dot(normal, to_eye), 0.02);
  float share = 0.02 + 0.98 * pow(1.0 - cosine, 5.0 * exp(-2.69 * deviation)) / (1.0 + 22.7 * pow(deviation, 1.5));

  vec3 ray = 2.0 * cosine * normal - to_eye;
  float up = ray.y;
  ray = normalize(vec3(ray.x, sqrt(up * up + 0.0025), ray.z)); // one that goes down meets another wave
  float blur = sqrt(0.5 * (variance.x + variance.y));
  float lod = min(log2(max(0.9 * blur * float(textureSize(sky, 0).x), 1.0)), 5.0);
  vec3 radiance = share * textureLod(sky, sky_place(ray), lod).rgb * mix(1.0, 0.5, smoothstep(0.15, -0.3, up));

  // light from below, and through crests against the sun (taste)
  vec3 falling = sun_light * max(sunward.y, 0.0) + sky_light;
  vec3 facet = normalize(vec3(-slope.x, 1.0, -slope.y));
  vec3 body = REFLECTANCE * falling;
  float crest = clamp(0.5 + at.y / max(wave_height, 0.2), 0.0, 1.4);
  float against = pow(max(-dot(normalize(sunward.xz + 1e-5), ahead), 0.0) * 0.92 + 0.08, 3.0) * (1.0 - 0.7 * to_eye.y);
  float tilt = clamp(0.55 - 0.5 * dot(facet, sunward) + 0.4 * length(slope), 0.0, 1.0);
  vec3 through = exp(-(ABSORPTION + BACK) * mix(10.0, 2.2, clamp(crest, 0.0, 1.0))) * BACK / (BACK + 0.02);
  body += (sun_light * against * (0.3 + 0.7 * smoothstep(0.05, 0.5, length(slope))) + 0.15 * sky_light) * through * tilt * tilt * crest * 0.3;
  radiance += (1.0 - share) * body;

  // facets whose slope is that of the half vector mirror the sun (Cox & Munk 1954)
  vec3 halfway = normalize(sunward + to_eye);
  if (halfway.y > 0.02) {
    float determinant = max(variance.x * variance.y - variance.z * variance.z, 1e-10);
    vec2 off = -halfway.xz / halfway.y - slope;
    float square = (variance.y * off.x * off.x - 2.0 * variance.z * off.x * off.y + variance.x * off.y * off.y) / determinant;
    float probability = exp(-0.5 * square) / (6.2831853 * sqrt(determinant)), upright = halfway.y * halfway.y;
    float masks = 1.0 + shadow(max(sunward.y, 0.01), along(variance, normalize(sunward.xz + 1e-5))) + shadow(max(to_eye.y, 0.01), along(variance, ahead));
    radiance += sun_light * fresnel(dot(to_eye, halfway)) * probability / (4.0 * upright * upright * max(to_eye.y, 0.06) * masks);
  }

  // foam: cells of noise where noise exceeds 1 - coverage, and bubbles below them
  float covered = cover(rest, stretch, baked);
  vec2 drawn = vec2(dot(rest, wind), 2.2 * dot(rest, vec2(-wind.y, wind.x))); // out along the wind
  float fine = texture(noise, drawn / 9.1).r, broad = texture(noise, drawn / 43.0 + 0.37).r;
  float n = mix(fine, broad, 0.3 + 0.4 * smoothstep(20.0, 160.0, distance_));
  float white = smoothstep(1.0 - covered - 0.22, 1.0 - covered + 0.22, n) * smoothstep(0.0, 0.08, covered);
  vec3 foam = 0.55 / 3.14159 * (sun_light * (0.3 + 0.7 * max(dot(facet, sunward), 0.0)) + sky_light) * (0.85 + 0.3 * fine);
  vec3 bubbles = body + 0.038 * falling * exp(-(ABSORPTION + BACK) * 5.0);
  radiance = mix(radiance, mix(radiance, bubbles, 0.75), smoothstep(0.0, 0.6, covered) * (1.0 - share) * 0.8);
  radiance = mix(radiance, foam, white * 0.85);

  vec3 haze = textureLod(sky, sky_place(normalize(vec3(-to_eye.x, 0.02, -to_eye.z))), 1.0).rgb;
  colour = shown(mix(radiance, haze, 1.0 - exp(-distance_ / 17e3)));
}`;

/** Return a mesh of rings about the camera: angle, radius and gap to the next ring of each vertex. */
function rings() {
  const columns = 512, radii = [0];
  for (let r = 0.5; r < 26e3; r *= 1.034) radii.push(r);
  const corners = [], index = [];
  radii.forEach((radius, i) => {
    const gap = (radii[i + 1] ?? radius * 1.034) - radius;
    for (let c = 0; c <= columns; c++) corners.push((2 * Math.PI * c) / columns, radius, gap);
  });
  const row = columns + 1;
  for (let i = 0; i + 1 < radii.length; i++)
    for (let c = 0; c < columns; c++) {
      const first = i * row + c;
      index.push(first, first + 1, first + row, first + 1, first + row + 1, first + row);
    }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
  geometry.setIndex(index);
  return geometry;
}

/** Return noise that repeats, spread evenly over 0..1, so that it exceeds 1 - c on a share c of it. */
function noiseTexture(n = 256) {
  let state = 12345;
  const random = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
  const sum = new Float32Array(n * n);
  for (const cells of [8, 16, 32, 64, 128]) {
    const lattice = Float32Array.from({ length: cells * cells }, random);
    for (let y = 0; y < n; y++)
      for (let x = 0; x < n; x++) {
        const [u, v] = [(x * cells) / n, (y * cells) / n], [i, j] = [Math.floor(u), Math.floor(v)];
        const [a, b] = [u - i, v - j].map((t) => t * t * (3 - 2 * t));
        const at = (p, q) => lattice[((j + q) % cells) * cells + ((i + p) % cells)];
        const value = (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
        sum[y * n + x] += Math.abs(value - 0.5) / cells ** 0.6; // ridges: the edges of bubbles
      }
  }
  const data = new Uint8Array(n * n);
  [...sum.keys()].sort((p, q) => sum[q] - sum[p]).forEach((cell, rank) => (data[cell] = (256 * rank) / (n * n)));
  const texture = new THREE.DataTexture(data, n, n, THREE.RedFormat);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.magFilter = THREE.LinearFilter;
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.needsUpdate = true;
  return texture;
}

/** The water of some tiles: those of a simulation or of a playback. */
export class Water {
  /**
   * @param tiles each with n, size, vSign and target
   * @param sea foam ({ decay, threshold, strength } or null), foam_source (0 none, 1 the bake's
   *   map, 2 the stretches), beyond (slope covariance that no tile holds), wave_height [m],
   *   bearing toward which the wind blows [degrees]
   */
  constructor(renderer, tiles, sky, sea) {
    this.passes = new Passes(renderer);
    this.tiles = tiles;
    this.sea = sea;
    const own = Object.fromEntries(tiles.flatMap(({ target }, i) => {
      const [displacement, slopes, moments] = target.textures;
      return [[`displacement_${i}`, displacement], [`slopes_${i}`, slopes], [`moments_${i}`, moments]];
    }).map(([name, value]) => [name, { value }]));
    const half = ({ n, vSign }) => [0.5 / n[0], (vSign * 0.5) / n[1]];
    own.tiles = { value: tiles.map((tile) => new THREE.Vector4(1 / tile.size[0], 1 / tile.size[1], ...half(tile))) };
    const { decay, threshold, strength } = sea.foam ?? { decay: 1, threshold: 0, strength: 0 };
    own.rule = { value: new THREE.Vector3(decay, threshold, strength) };
    this.foam = [0, 1].map(() => mapTarget(WINDOW.samples, WINDOW.samples, 1));
    this.step = pass(foamStep(tiles), ['before', 'seconds', 'fresh']);
    Object.assign(this.step.uniforms, own);
    const toward = (sea.bearing * Math.PI) / 180;
    this.uniforms = {
      ...own, ...sky.uniforms,
      beyond: { value: new THREE.Vector3(...sea.beyond) },
      foam_window: { value: this.foam[0].texture },
      foam_source: { value: sea.foam_source },
      wave_height: { value: sea.wave_height },
      wind: { value: new THREE.Vector2(Math.cos(toward), -Math.sin(toward)) },
      noise: { value: noiseTexture() },
    };
    this.mesh = new THREE.Mesh(rings(), new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      uniforms: this.uniforms,
      vertexShader: VERTEX(tiles),
      fragmentShader: FRAGMENT(tiles),
      side: THREE.DoubleSide,
    }));
    this.mesh.frustumCulled = false;
    this.fresh = true;
  }

  /** Let foam fade and form for some seconds; the tiles' maps are those of now. */
  update(seconds) {
    if (this.sea.foam_source !== 2) return;
    const [before, after] = this.foam;
    this.passes.run(this.step, { before: before.texture, seconds, fresh: this.fresh }, after);
    this.fresh = false;
    this.foam = [after, before];
    this.uniforms.foam_window.value = after.texture;
  }
}
