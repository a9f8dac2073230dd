// Shaders of one Stockham step of an inverse Fourier transform, on four complex fields at once.
import { FRAGMENT_HEAD } from './heads.js';

/** Return the source of a step that combines `radix` (2 or 4) parts of the input along an axis. */
export function stepShader(radix) {
  const terms = Array.from(
    { length: radix - 1 },
    (_, i) => `add(at + ${i + 1} * apart, ${i + 1});`,
  );
  return `${FRAGMENT_HEAD}
uniform sampler2D input_first, input_second, twiddles;
uniform int samples, block, axis;
layout(location = 0) out vec4 first;
layout(location = 1) out vec4 second;

int turn;

vec2 twiddle(int index) {
  return texelFetch(twiddles, ivec2(index & (samples - 1), 0), 0).xy;
}

vec4 multiply(vec2 w, vec4 v) {
  return vec4(w.x * v.xz - w.y * v.yw, w.x * v.yw + w.y * v.xz).xzyw;
}

void add(ivec2 at, int part) {
  vec2 w = twiddle(part * turn);
  first += multiply(w, texelFetch(input_first, at, 0));
  second += multiply(w, texelFetch(input_second, at, 0));
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  int i = axis == 0 ? at.x : at.y;
  int quotient = i / block, remainder = i & (block - 1);
  int part = block / ${radix};
  turn = remainder * (samples / block);
  int from = quotient * part + (remainder & (part - 1));
  int distance = samples / ${radix};
  ivec2 apart = axis == 0 ? ivec2(distance, 0) : ivec2(0, distance);
  at = axis == 0 ? ivec2(from, at.y) : ivec2(at.x, from);
  first = texelFetch(input_first, at, 0);
  second = texelFetch(input_second, at, 0);
  ${terms.join('\n  ')}
}`;
}
