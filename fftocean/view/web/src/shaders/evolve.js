// Shader that brings the waves of a tile to a tick and packs eight fields into four complex ones.
import { FRAGMENT_HEAD } from './heads.js';

/**
 * A function of GLSL, phasor(turn): the cosine and sine of a phase in turns.
 *
 * Phases are reduced to an eighth of a turn about the nearest quarter; the coefficients are those
 * of the least largest error there. The platform's cos and sin promise no more than 2^-11.
 */
export const PHASOR = `
vec2 phasor(float turn) {
  float quarter = floor(4.0 * turn + 0.5);
  float x = turn - 0.25 * quarter;
  float q = x * x;
  float s = x * (6.2831853 + q * (-41.341663 + q * (81.591983 + q * -75.369649)));
  float c = 1.0 + q * (-19.739209 + q * (64.939363 + q * (-85.447456 + q * 59.362561)));
  int quadrant = int(quarter) & 3;
  vec2 turned = (quadrant & 1) == 0 ? vec2(c, s) : vec2(-s, c);
  return (quadrant & 2) == 0 ? turned : -turned;
}`;

/** The source of the shader. */
export const EVOLVE_SHADER = `${FRAGMENT_HEAD}${PHASOR}
uniform sampler2D h0_to, h0_from, wave_to, wave_from;
uniform ivec2 samples;
uniform vec2 wavenumber_step;
uniform uint tick, mask;
uniform float turns_per_tick, scale_to, scale_from;
uniform vec4 lifts;
layout(location = 0) out vec4 first;
layout(location = 1) out vec4 second;

vec2 multiply(vec2 a, vec2 b) {
  return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

vec2 times_i(vec2 a) {
  return vec2(-a.y, a.x);
}

vec2 height_of(vec4 h0, vec2 phase) {
  return multiply(h0.xy, vec2(phase.x, -phase.y)) + multiply(h0.zw, phase);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 wave = texelFetch(wave_to, at, 0).xy;
  // Exact for ever: the product wraps at 2^32, and the ticks of a loop are a power of two.
  uint ticks = (uint(wave.x) * tick) & mask;
  vec2 phase = phasor(float(ticks) * turns_per_tick);
  vec2 height = scale_to * height_of(texelFetch(h0_to, at, 0), phase);
  vec2 potential = height * wave.y;
  if (scale_from > 0.0) {
    vec2 earlier = scale_from * height_of(texelFetch(h0_from, at, 0), phase);
    height += earlier;
    potential += earlier * texelFetch(wave_from, at, 0).y;
  }
  ivec2 whole = ivec2(2 * at.x < samples.x ? at.x : at.x - samples.x,
                      2 * at.y < samples.y ? at.y : at.y - samples.y);
  vec2 k = vec2(whole) * wavenumber_step;
  vec2 displace_x = times_i(k.x * potential), displace_y = times_i(k.y * potential);
  vec2 slope_x = times_i(k.x * height), slope_y = times_i(k.y * height);
  vec2 stretch_xx = -k.x * k.x * potential;
  vec2 stretch_xy = -k.x * k.y * potential;
  vec2 stretch_yy = -k.y * k.y * potential;
  // A real field comes out of each part of a complex one; see the lifts in container.js.
  first = vec4(displace_x + lifts.x * times_i(displace_y), height + lifts.y * times_i(stretch_xy));
  second = vec4(slope_x + lifts.z * times_i(slope_y), stretch_xx + lifts.w * times_i(stretch_yy));
}`;
