// Shader that makes the three maps of a tile for the renderer from its eight fields.
import { FRAGMENT_HEAD } from './heads.js';

/** The source of the shader. */
export const MAPS_SHADER = `${FRAGMENT_HEAD}
uniform sampler2D input_first, input_second;
uniform float choppiness;
uniform vec4 lifts;
layout(location = 0) out vec4 displacement;
layout(location = 1) out vec4 slopes;
layout(location = 2) out vec4 moments;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 first = texelFetch(input_first, at, 0), second = texelFetch(input_second, at, 0);
  first.yw /= lifts.xy;
  second.yw /= lifts.zw;
  displacement = vec4(choppiness * first.xy, first.z, choppiness * first.w);
  slopes = vec4(second.xy, choppiness * second.zw);
  moments = vec4(second.xy * second.xy, second.x * second.y, 0.0);
}`;
