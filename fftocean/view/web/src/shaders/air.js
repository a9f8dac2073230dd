// Light of the sun and the sky: single scattering by air, haze and ozone, on a round earth.
import { FRAGMENT_HEAD, VERTEX_HEAD } from './heads.js';

/**
 * Where a direction lies in the map of the sky, and its radiance there.
 *
 * The map is a stereographic projection seen from below: even near the zenith and the horizon,
 * without the seam of a map by angles. It reaches a little below the horizon.
 */
export const SKY_LOOKUP = `
const float SKY_SCALE = 0.5 / 1.1;

vec2 sky_place(vec3 direction) {
  return direction.xy / (1.0 + max(direction.z, -0.05)) * SKY_SCALE + 0.5;
}
`;

/**
 * Radiance of the sky without clouds.
 *
 * Coefficients at 680, 550 and 440 nm of Bruneton (2017) and Hillaire (2020): Rayleigh scattering
 * with a scale height of 8 km, Mie scattering with 1.2 km, ozone about 25 km.
 */
const SCATTERING = `
const float PI = 3.14159265;
const float EARTH = 6371e3, AIR_TOP = 6471e3;
const vec3 RAYLEIGH = vec3(5.802e-6, 13.558e-6, 33.1e-6);
const vec3 OZONE = vec3(0.650e-6, 1.881e-6, 0.085e-6);
const float MIE = 4.0e-6, MIE_EXTINCTION = 4.4e-6, MIE_FORWARD = 0.78;
const float SUN_IRRADIANCE = 20.0; // in units of our own: the exposure follows it

uniform vec3 sun;
uniform float haze;

float way_out(vec3 from, vec3 direction) {
  float along = dot(from, direction);
  return -along + sqrt(max(along * along - dot(from, from) + AIR_TOP * AIR_TOP, 0.0));
}

vec3 density(vec3 at) {
  float height = max(length(at) - EARTH, 0.0);
  float ozone = max(0.0, 1.0 - abs(height - 25e3) / 15e3);
  return vec3(exp(-height / 8000.0), exp(-height / 1200.0), ozone);
}

vec3 transmitted(vec3 column) {
  return exp(-(RAYLEIGH * column.x + MIE_EXTINCTION * haze * column.y + OZONE * column.z));
}

// Share of sunlight that reaches a place; it fades where the earth's shadow begins.
vec3 sunlight(vec3 at) {
  float way = way_out(at, sun), along = dot(at, sun);
  vec3 column = vec3(0.0);
  for (int i = 0; i < 12; i++) {
    float share = (float(i) + 0.5) / 12.0; // steps grow with distance: the air is densest here
    column += density(at + sun * way * share * share) * (2.0 * share * way / 12.0);
  }
  float closest = length(at - along * sun);
  float lit = along > 0.0 ? 1.0 : smoothstep(EARTH - 6e3, EARTH + 6e3, closest);
  return lit * transmitted(column);
}

vec3 clear_sky(vec3 direction) {
  vec3 from = vec3(0.0, 0.0, EARTH + 20.0);
  float way = way_out(from, direction), cosine = dot(direction, sun);
  float g = MIE_FORWARD, g2 = g * g;
  float rayleigh_phase = 3.0 / (16.0 * PI) * (1.0 + cosine * cosine);
  float mie_phase = 3.0 / (8.0 * PI) * (1.0 - g2) * (1.0 + cosine * cosine) /
    ((2.0 + g2) * pow(1.0 + g2 - 2.0 * g * cosine, 1.5));
  // Light scattered more than once, taken as even over all directions (a stand-in for Hillaire's
  // table): it is what falls on the lower air, chosen so that a clear sky gives a tenth of the sun.
  vec3 again = 1.05 * sunlight(vec3(0.0, 0.0, EARTH + 3000.0)) * max(sun.z + 0.08, 0.0) +
    0.03 * sunlight(vec3(0.0, 0.0, EARTH + 20e3));
  vec3 column = vec3(0.0), once = vec3(0.0), more = vec3(0.0);
  float last = 0.0;
  for (int i = 0; i < 32; i++) {
    float share = (float(i) + 0.5) / 32.0, next = (float(i) + 1.0) / 32.0;
    next *= next * way;
    float stretch = next - last;
    last = next;
    vec3 at = from + direction * share * share * way, air = density(at);
    column += air * stretch;
    vec3 seen = transmitted(column) * stretch;
    vec3 scattered = RAYLEIGH * air.x, haze_scattered = vec3(MIE * haze * air.y);
    once += seen * sunlight(at) * (scattered * rayleigh_phase + haze_scattered * mie_phase);
    more += seen * (scattered + haze_scattered) / (4.0 * PI);
  }
  return SUN_IRRADIANCE * (once + more * again);
}
`;

/** Thin high clouds: how much of a direction they cover, and how thick they are. */
export const CLOUDS = `
uniform float clouds;

uint scrambled(uint x) {
  x ^= x >> 16; x *= 0x7feb352du; x ^= x >> 15; x *= 0x846ca68bu; x ^= x >> 16;
  return x;
}

float lattice_value(ivec2 at) {
  return float(scrambled(uint(at.x) * 73856093u + scrambled(uint(at.y) + 17u))) / 4294967296.0;
}

float smooth_noise(vec2 at) {
  ivec2 cell = ivec2(floor(at));
  vec2 part = fract(at);
  part = part * part * part * (part * (part * 6.0 - 15.0) + 10.0);
  vec2 low = vec2(lattice_value(cell), lattice_value(cell + ivec2(1, 0)));
  vec2 high = vec2(lattice_value(cell + ivec2(0, 1)), lattice_value(cell + ivec2(1, 1)));
  vec2 both = mix(low, high, part.y);
  return mix(both.x, both.y, part.x);
}

// Cover in 0..1 of a layer 7 km up, drawn out along the wind there.
float cloud_cover(vec3 direction) {
  if (clouds <= 0.0 || direction.z <= 0.01) return 0.0;
  float up = max(direction.z, 0.02);
  float way = 0.0022 / (up + sqrt(up * up + 0.0022)); // over a round earth, in earth radii
  vec2 at = direction.xy * way * 430.0 + 4.3;
  at = mat2(0.86, 0.5, -0.5, 0.86) * at;
  vec2 bent = vec2(smooth_noise(at * 0.8 + 7.0), smooth_noise(at * 0.8 + 31.0));
  vec2 drawn = (at + 1.3 * bent) * vec2(0.42, 1.5);
  float sum = 0.0, weight = 0.5;
  for (int i = 0; i < 6; i++) {
    sum += weight * smooth_noise(drawn);
    drawn = mat2(0.8, 0.6, -0.6, 0.8) * drawn * 2.03 + 3.7;
    weight *= 0.53;
  }
  float patches = smoothstep(0.25, 0.75, smooth_noise(at * 0.45 + 11.0));
  float cover = smoothstep(0.82 - 0.5 * clouds, 1.12 - 0.3 * clouds, sum + 0.28 * patches);
  return cover * smoothstep(0.015, 0.12, direction.z);
}

vec3 with_clouds(vec3 clear, vec3 direction, vec3 sunward, vec3 cloud_sun, vec3 cloud_sky) {
  float cover = cloud_cover(direction);
  if (cover <= 0.0) return clear;
  float cosine = max(dot(direction, sunward), 0.0);
  float forward = 0.055 + 0.10 * pow(cosine, 4.0) + 0.35 * pow(cosine, 48.0);
  vec3 lit = cloud_sun * forward * (1.0 - 0.35 * cover) + cloud_sky * 0.8;
  // The air before it takes the colour of the clear sky at the same place.
  float near = exp(-0.05 / max(direction.z, 0.03));
  return mix(clear, mix(clear, lit, near), cover * 0.8);
}
`;

/** The map of the sky without clouds. */
export const CLEAR_SHADER = `${FRAGMENT_HEAD}${SKY_LOOKUP}${SCATTERING}
uniform float samples;
out vec4 radiance;

void main() {
  vec2 at = (gl_FragCoord.xy / samples - 0.5) / SKY_SCALE;
  float square = dot(at, at);
  vec3 direction = vec3(2.0 * at, 1.0 - square) / (1.0 + square);
  // Below the horizon the map repeats it, so that filtering near the horizon finds no edge.
  if (direction.z < 0.002) direction = normalize(vec3(direction.xy, 0.002));
  radiance = vec4(clear_sky(direction), 1.0);
}`;

/** The map of the sky with clouds, for the light and for reflections. */
export const SKY_SHADER = `${FRAGMENT_HEAD}${SKY_LOOKUP}${SCATTERING}${CLOUDS}
uniform sampler2D clear_map;
uniform float samples;
out vec4 radiance;

void main() {
  vec2 at = (gl_FragCoord.xy / samples - 0.5) / SKY_SCALE;
  float square = dot(at, at);
  vec3 direction = vec3(2.0 * at, 1.0 - square) / (1.0 + square);
  vec3 clear = textureLod(clear_map, gl_FragCoord.xy / samples, 0.0).rgb;
  vec3 cloud_sun = SUN_IRRADIANCE * sunlight(vec3(0.0, 0.0, EARTH + 7000.0));
  vec3 zenith = textureLod(clear_map, vec2(0.5), 0.0).rgb;
  radiance = vec4(with_clouds(clear, direction, sun, cloud_sun, zenith), 1.0);
}`;

/** Irradiances of the sun and of the sky, the sun above the clouds, and the exposure: four texels. */
export const LIGHT_SHADER = `${FRAGMENT_HEAD}${SKY_LOOKUP}${SCATTERING}
uniform sampler2D sky;
out vec4 light;

float luminance(vec3 colour) {
  return dot(colour, vec3(0.2126, 0.7152, 0.0722));
}

void main() {
  int which = int(gl_FragCoord.x);
  if (which == 0) {
    light = vec4(SUN_IRRADIANCE * sunlight(vec3(0.0, 0.0, EARTH + 20.0)), 1.0);
    return;
  }
  if (which == 2) {
    light = vec4(SUN_IRRADIANCE * sunlight(vec3(0.0, 0.0, EARTH + 7000.0)), 1.0);
    return;
  }
  // Sums over the map; a texel of a stereographic map covers 4 / (1 + r^2)^2 of its area.
  vec3 irradiance = vec3(0.0);
  float bright = 0.0, area = 0.0;
  for (int y = 0; y < 32; y++) {
    for (int x = 0; x < 32; x++) {
      vec2 at = (vec2(x, y) + 0.5) / 32.0, from_zenith = (at - 0.5) / SKY_SCALE;
      float square = dot(from_zenith, from_zenith);
      if (square > 1.0) continue;
      float solid = 4.0 / ((1.0 + square) * (1.0 + square));
      float up = (1.0 - square) / (1.0 + square);
      vec3 radiance = textureLod(sky, at, log2(float(textureSize(sky, 0).x) / 32.0)).rgb;
      irradiance += radiance * solid * up;
      // The eighth power weighs the brightest parts: what would be burnt out first.
      float level = luminance(radiance), seen = up < 0.6 ? solid : 0.0;
      bright += pow(level, 8.0) * seen;
      area += seen;
    }
  }
  float cell = 1.0 / (32.0 * 32.0 * SKY_SCALE * SKY_SCALE);
  irradiance *= cell;
  if (which == 1) {
    light = vec4(irradiance, 1.0);
    return;
  }
  float from_sun = luminance(SUN_IRRADIANCE * sunlight(vec3(0.0, 0.0, EARTH + 20.0)));
  float middle = luminance(irradiance) + (0.25 * max(sun.z, 0.0) + 0.02) * from_sun;
  float burnt = pow(bright / area, 0.125);
  // Radiance times exposure that a picture aims at, and the level that the brightest tenth of the
  // sky may reach: without the second a low sun, which gives little light to the sea but a bright
  // sky around it, burns the sky out.
  light = vec4(min(3.2 / (middle + 0.25), 1.5 / (burnt + 0.15)), irradiance);
}`;

/** The sky behind the water, with the sun's disc. */
export const BACKGROUND_VERTEX = `${VERTEX_HEAD}
uniform mat3 rays;
out vec3 ray;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
  gl_Position = vec4(corner, 1.0, 1.0);
  ray = rays * vec3(corner, 1.0);
}`;

/** Radiance of the sun's disc and of its glare in the eye. */
const DISC = `
vec3 sun_disc(vec3 direction, vec3 sunward, vec3 irradiance) {
  float angle = 2.0 * asin(min(0.5 * length(direction - sunward), 1.0));
  float pixel = max(length(fwidth(direction)), 1e-5);
  float inside = clamp(0.5 - (angle - 0.00465) / pixel, 0.0, 1.0);
  // The disc is as bright as it is small; the glare around it is taste: the eye's, not the air's.
  float glare = 0.35 * exp(-angle / 0.012) + 0.03 * exp(-angle / 0.07);
  return irradiance * (2000.0 * inside + glare);
}
`;

/** Return the source of the background's fragment shader, given that of the tone curve. */
export function backgroundShader(tone) {
  return `${FRAGMENT_HEAD}${SKY_LOOKUP}${CLOUDS}${DISC}${tone}
uniform sampler2D clear_map, light;
uniform vec3 sunward;
uniform vec3 plain; // the colour behind false colours; negative for the sky
in vec3 ray;
out vec4 colour;

void main() {
  vec3 direction = normalize(ray);
  if (plain.x >= 0.0) {
    colour = vec4(plain, 1.0);
    return;
  }
  vec3 above = normalize(vec3(direction.xy, max(direction.z, 0.003)));
  vec3 radiance = textureLod(clear_map, sky_place(above), 0.0).rgb;
  vec3 zenith = textureLod(clear_map, vec2(0.5), 0.0).rgb;
  vec3 cloud_sun = texelFetch(light, ivec2(2, 0), 0).rgb;
  radiance = with_clouds(radiance, direction, sunward, cloud_sun, zenith);
  radiance += sun_disc(direction, sunward, texelFetch(light, ivec2(0), 0).rgb);
  colour = shown(radiance, texelFetch(light, ivec2(3, 0), 0).x);
}`;
}
