// Shaders of the buoy: a float with a staff, striped to be measured by.
import { FRAGMENT_HEAD, VERTEX_HEAD } from './heads.js';

/** Rings and columns of the buoy's mesh. */
export const BUOY_RINGS = 40;
export const BUOY_COLUMNS = 28;

/**
 * Vertex shader: a surface of revolution, 2 m above the water line, standing where the surface is
 * and leaning with its slope.
 */
export const BUOY_VERTEX = `${VERTEX_HEAD}
uniform mat4 view_projection;
uniform sampler2D floating, floating_tilt;
uniform float eye_height;
out vec3 at; // in the buoy, z from the water line
out vec3 normal, place;

// Radius by height: a hull below the water, a float, a cone, a staff with a lamp.
float radius(float z) {
  if (z < -0.6) return 0.02;
  if (z < -0.1) return mix(0.12, 0.42, (z + 0.6) / 0.5);
  if (z < 0.3) return 0.42;
  if (z < 0.42) return mix(0.42, 0.26, (z - 0.3) / 0.12);
  if (z < 1.3) return mix(0.24, 0.075, (z - 0.42) / 0.88);
  if (z < 1.78) return 0.035;
  if (z < 2.0) return 0.085 * sqrt(max(1.0 - pow((z - 1.89) / 0.11, 4.0), 0.0));
  return 0.0;
}

void main() {
  const float[12] HEIGHTS = float[12](-0.7, -0.6, -0.1, 0.29, 0.3, 0.42, 1.29, 1.31, 1.77, 1.8, 1.98, 2.0);
  int ring = gl_InstanceID + (gl_VertexID & 1), column = gl_VertexID >> 1;
  float share = float(ring) / ${(BUOY_RINGS - 1).toFixed(1)} * 11.0;
  int first = min(int(share), 10);
  float z = mix(HEIGHTS[first], HEIGHTS[first + 1], share - float(first));
  float angle = float(column) / ${BUOY_COLUMNS.toFixed(1)} * 6.28318531;
  vec2 out_ = vec2(cos(angle), sin(angle));
  float r = radius(z), rise = (radius(z + 0.01) - radius(z - 0.01)) / 0.02;
  at = vec3(out_ * r, z);
  vec3 up = normalize(vec3(-0.7 * texelFetch(floating_tilt, ivec2(1, 0), 0).xy, 1.0));
  vec3 east = normalize(vec3(1.0, 0.0, 0.0) - up * up.x), north = cross(up, east);
  mat3 turned = mat3(east, north, up);
  normal = turned * normalize(vec3(out_, -clamp(rise, -4.0, 4.0)));
  vec3 foot = texelFetch(floating, ivec2(1, 0), 0).xyz;
  float eye = max(eye_height, texelFetch(floating, ivec2(0), 0).z + 0.45);
  place = foot - vec3(0.0, 0.0, eye) + turned * at;
  gl_Position = view_projection * vec4(place, 1.0);
}`;

/** Return the source of the fragment shader, given that of the tone curve. */
export function buoyShader(tone) {
  return `${FRAGMENT_HEAD}${tone}
uniform sampler2D light;
uniform vec3 sunward;
in vec3 at, normal, place;
out vec4 colour;

void main() {
  vec3 n = normalize(normal), to_eye = -normalize(place);
  vec3 sun_light = texelFetch(light, ivec2(0), 0).rgb, sky_light = texelFetch(light, ivec2(1, 0), 0).rgb;
  // Stripes of half a metre; rust-red antifouling below the water line.
  vec3 paint = at.z < 0.0 ? vec3(0.16, 0.03, 0.02)
    : fract(at.z) < 0.5 ? vec3(0.80, 0.60, 0.04) : vec3(0.62, 0.05, 0.03);
  if (at.z > 1.78) paint = vec3(0.75);
  float wet = smoothstep(0.25, 0.05, at.z);
  paint *= 1.0 - 0.45 * wet;
  float from_sun = max(dot(n, sunward), 0.0);
  vec3 scattered = paint / 3.14159265 * (sun_light * from_sun + sky_light * (0.55 + 0.45 * n.z));
  vec3 halfway = normalize(sunward + to_eye);
  float gloss = mix(60.0, 200.0, wet);
  float mirror = 0.04 * (gloss + 8.0) / 25.0 * pow(max(dot(n, halfway), 0.0), gloss) * from_sun;
  float edge = 0.04 + 0.5 * pow(1.0 - max(dot(n, to_eye), 0.0), 5.0);
  colour = shown(scattered + sun_light * mirror + edge * sky_light * 0.25, texelFetch(light, ivec2(3, 0), 0).x);
}`;
}
