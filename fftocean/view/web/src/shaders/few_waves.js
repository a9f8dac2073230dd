// Shaders of the few-wave models: waves summed at each vertex, lit as in the slides.
import { FRAGMENT_HEAD } from '../gl.js';
import { phasorSource } from './evolve.js';

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
export const FEW_WAVES_VERTEX = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
${phasorSource('polynomial')}
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
out float far;

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
    moved += vec3(-sharp * unit * turned.y, amplitude * turned.x);
    vec3 slope = vec3(-sharp * unit * turned.x, -amplitude * turned.y);
    along_x += gradient.x * slope;
    along_y += gradient.y * slope;
  }
  // d place/dx x d place/dy, in this order upward; at a cusp, where it is 0, straight up.
  vec3 upward = cross(along_x, along_y);
  float size = length(upward);
  normal = size > 0.0 ? upward / size : vec3(0.0, 0.0, 1.0);
  far = length(still);
  vec3 seen = vec3(still, -height - dot(still, still) / (2.0 * EARTH_RADIUS)) + moved;
  gl_Position = view_projection * vec4(seen, 1.0);
}`;

/**
 * The fragment shader: the slides' ambient, diffuse and specular light on a normal turned by noise.
 *
 * Differences from the slides are corrections: the colour is a colour, the diffuse term is 0 where
 * the light is behind the surface, and the noise has mean 0 and stays within -1 to 1, so that its
 * amplitude is the largest angle in radians.
 */
export const FEW_WAVES_FRAGMENT = `${FRAGMENT_HEAD}
uniform sampler2D noise;
uniform float height, ambient, diffuse, specular, shininess, noise_amplitude, noise_frequency, air;
uniform vec2 noise_start;
uniform vec3 sun, color, light, horizon;
in vec2 still;
in vec3 moved;
in vec3 normal;
in float far;
out vec4 pixel;

vec3 turn_normal(vec2 angle, vec3 n) {
  float c = cos(angle.x), s = sin(angle.x);
  n.yz = vec2(n.y * c - n.z * s, n.y * s + n.z * c);
  c = cos(angle.y);
  s = sin(angle.y);
  n.xz = vec2(n.x * c + n.z * s, n.z * c - n.x * s);
  return normalize(n);
}

void main() {
  vec2 at = noise_start + still * noise_frequency;
  // The second layer is turned and wider, so that the pattern does not repeat visibly.
  vec2 wide = mat2(0.29, 0.22, -0.22, 0.29) * at + 0.37;
  vec2 angle = 0.5 * noise_amplitude * (texture(noise, at).xy + texture(noise, wide).xy);
  vec3 n = turn_normal(angle, normalize(normal));
  vec3 eye = normalize(vec3(-still, height) - moved);
  float lit = dot(n, sun);
  float mirrored = 0.0;
  if (lit > 0.0) mirrored = pow(max(dot(eye, 2.0 * n * lit - sun), 0.0), shininess);
  vec3 seen = (ambient + diffuse * max(lit, 0.0)) * color + specular * mirrored * light;
  pixel = vec4(mix(seen, horizon, 1.0 - exp(-far * air)), 1.0);
}`;
