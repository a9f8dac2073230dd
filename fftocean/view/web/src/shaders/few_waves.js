// Shaders of the few-wave models: waves summed at each vertex, lit as in the slides.
import { FRAGMENT_HEAD, VERTEX_HEAD } from './heads.js';
import { TONE } from './tone.js';
import { SKY_LOOKUP } from './air.js';
import { PHASOR } from './evolve.js';

/** Most waves of a model; they fit the uniforms that every WebGL 2 context has. */
export const MOST_WAVES = 64;

/** Outputs of the vertex shader that `FewWaves.readVertices` reads back, in this order. */
export const VERTEX_OUTPUTS = ['still', 'moved', 'normal'];

/**
 * The vertex shader: a fan of rings before the eye, raised and moved by the waves.
 *
 * Everything is relative to the point of the still water below the eye, so that 32-bit floats hold
 * it anywhere on the sea. Phases are in turns: `start` has that of each wave below the eye at the
 * tick, reduced in double precision, and the products of wavenumber and position are exact where
 * they are large: each factor is split into its leading 12 bits and the rest.
 */
export const FEW_WAVES_VERTEX = `${VERTEX_HEAD}
${PHASOR}
const float EARTH_RADIUS = 6371e3;
uniform mat4 view_projection;
uniform sampler2D rings;
uniform int columns, waves;
uniform float middle, half_angle, apex, height, fade, choppiness;
uniform vec4 wavenumber[${MOST_WAVES}];
uniform vec4 wave[${MOST_WAVES}];
out vec2 still;
out vec3 moved;
out vec3 normal;
out float rough;

float leading(float value) {
  return uintBitsToFloat(floatBitsToUint(value) & 0xfffff000u);
}

float turns(vec2 k, float position) {
  float large = leading(position), small = position - large;
  return fract(k.x * large) + (k.x * small + k.y * position);
}

void main() {
  ivec2 node = ivec2(gl_VertexID % columns, gl_VertexID / columns);
  vec2 ring = texelFetch(rings, ivec2(node.y, 0), 0).xy;
  float share = float(node.x) / float(columns - 1);
  float angle = middle + half_angle * (2.0 * share - 1.0);
  vec2 ahead = vec2(cos(middle), sin(middle));
  float reach = ring.x + apex;
  still = vec2(cos(angle), sin(angle)) * reach - ahead * apex;
  float across = 2.0 * half_angle * reach / float(columns - 1);
  float spacing = fade * pow(max(across, 1e-3), 0.3) * pow(ring.y, 0.7);
  moved = vec3(0.0);
  rough = 0.0;
  vec3 along_x = vec3(1.0, 0.0, 0.0), along_y = vec3(0.0, 1.0, 0.0);
  for (int i = 0; i < waves; i++) {
    vec4 k = wavenumber[i];
    vec2 turned = phasor(wave[i].w + turns(k.xy, still.x) + turns(k.zw, still.y));
    vec2 vector = vec2(k.x + k.y, k.z + k.w);
    float number = length(vector);
    // A wave needs a few vertices; one that the mesh cannot hold would turn up as another.
    float kept = 1.0 - smoothstep(0.2, 0.45, spacing * number);
    float amplitude = kept * wave[i].x, sharp = choppiness * amplitude * wave[i].y;
    vec2 unit = vector / number, gradient = 6.2831853 * vector;
    float steepness = wave[i].x * 6.2831853 * number;
    rough += 0.25 * (1.0 - kept * kept) * steepness * steepness;
    moved += vec3(-sharp * unit * turned.y, amplitude * turned.x);
    vec3 slope = vec3(-sharp * unit * turned.x, -amplitude * turned.y);
    along_x += gradient.x * slope;
    along_y += gradient.y * slope;
  }
  // d place/dx x d place/dy, in this order upward; at a cusp, where it is 0, straight up.
  vec3 upward = cross(along_x, along_y);
  float size = length(upward);
  normal = size > 0.0 ? upward / size : vec3(0.0, 0.0, 1.0);
  vec3 seen = vec3(still, -height - dot(still, still) / (2.0 * EARTH_RADIUS)) + moved;
  gl_Position = view_projection * vec4(seen, 1.0);
}`;

/**
 * The fragment shader: the slides' ambient, diffuse and specular light on a normal turned by noise.
 *
 * Differences from the slides: the colour is a colour, the diffuse term is 0 where the light is
 * behind the surface, and the noise has mean 0 and stays within -1 to 1, so that its amplitude is
 * the largest angle in radians. The light has the colours of the sun and the sky of the picture;
 * the ambient one, which comes from everywhere, is that of the sky: scattered by the water, and
 * mirrored by it after Fresnel, of water as rough as the waves that the mesh leaves out (Bruneton,
 * Neyret & Holzschuch 2010).
 */
export const FEW_WAVES_FRAGMENT = `${FRAGMENT_HEAD}${SKY_LOOKUP}${TONE}
const float PI = 3.14159265;
uniform sampler2D noise, sky, light;
uniform float height, ambient, diffuse, specular, shininess, noise_amplitude, noise_frequency;
uniform float air_extinction;
uniform vec2 noise_start;
uniform vec3 sunward, albedo;
in vec2 still;
in vec3 moved;
in vec3 normal;
in float rough;
out vec4 pixel;

vec3 turn_normal(vec2 angle, vec3 n) {
  float c = cos(angle.x), s = sin(angle.x);
  n.yz = vec2(n.y * c - n.z * s, n.y * s + n.z * c);
  c = cos(angle.y);
  s = sin(angle.y);
  n.xz = vec2(n.x * c + n.z * s, n.z * c - n.x * s);
  return normalize(n);
}

vec3 mirrored_sky(vec3 n, vec3 to_eye, float variance) {
  float deviation = sqrt(variance);
  // Of rough water one sees the facets that turn toward the eye.
  float level_part = max(length(to_eye.xy), 1e-4);
  float steepness = level_part / max(to_eye.z, 0.02);
  float lean = variance * steepness / (1.0 + 1.2 * deviation * steepness);
  n = normalize(n + n.z * vec3(to_eye.xy / level_part * lean, 0.0));
  float cosine = max(dot(n, to_eye), 0.01);
  float share = 0.02 + 0.98 * pow(1.0 - cosine, 5.0 * exp(-2.69 * deviation)) /
    (1.0 + 22.7 * pow(deviation, 1.5));
  vec3 ray = 2.0 * cosine * n - to_eye;
  // A ray that goes down meets another wave, which shows a darker part of the sky.
  float dim = mix(1.0, 0.5, smoothstep(0.02, -0.3, ray.z));
  ray = normalize(vec3(ray.xy, abs(ray.z) + 0.01));
  float level = log2(max(2.0 * deviation * float(textureSize(sky, 0).x), 1.0));
  return dim * share * textureLod(sky, sky_place(ray), min(level, 6.0)).rgb;
}

void main() {
  vec2 at = noise_start + still * noise_frequency;
  // The second layer is turned and wider, so that the pattern does not repeat visibly.
  const mat2 TURN = mat2(0.8, 0.6, -0.6, 0.8);
  vec2 wide = TURN * at * 0.37 + 0.37;
  vec2 angle = texture(noise, at).xy + texture(noise, wide).xy * TURN;
  vec3 n = turn_normal(0.5 * noise_amplitude * angle, normalize(normal));
  // Ripples that are finer than a pixel roughen the water instead.
  float texels = float(textureSize(noise, 0).x) * max(length(dFdx(at)), length(dFdy(at)));
  float lost = 0.05 * noise_amplitude * noise_amplitude * clamp(log2(texels) / 6.0, 0.0, 1.0);
  vec3 way = vec3(-still, height) - moved;
  float far = length(way);
  vec3 to_eye = way / far;
  vec3 sun_light = texelFetch(light, ivec2(0, 0), 0).rgb;
  vec3 sky_light = texelFetch(light, ivec2(1, 0), 0).rgb;
  float lit = dot(n, sunward);
  float glint = 0.0;
  if (lit > 0.0) {
    // A highlight of rougher water is wider, and as much weaker (Toksvig 2005).
    float wider = 1.0 + shininess * (lost + rough);
    float mirrored = max(dot(to_eye, 2.0 * n * lit - sunward), 0.0);
    glint = pow(mirrored, shininess / wider) / wider;
  }
  vec3 everywhere = albedo / PI * (sun_light * max(sunward.z, 0.0) + sky_light);
  vec3 radiance = ambient * (everywhere + mirrored_sky(n, to_eye, 2e-4 + rough + lost));
  radiance += diffuse * max(lit, 0.0) * albedo / PI * sun_light;
  // 1.2: radiance of a perfect mirror of the slides, over the irradiance
  radiance += specular * glint * 1.2 * sun_light;
  vec3 haze = textureLod(sky, sky_place(normalize(vec3(-to_eye.xy, 0.02))), 1.0).rgb;
  radiance = mix(radiance, haze, 1.0 - exp(-far * air_extinction));
  pixel = shown(radiance, texelFetch(light, ivec2(3, 0), 0).x);
}`;
