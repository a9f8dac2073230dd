// Shader that blends two frames of a bake.
import { FRAGMENT_HEAD } from './heads.js';

/** The three maps of a tile between two frames; moments are those of the blended slopes. */
export const BLEND_FRAMES_SHADER = `${FRAGMENT_HEAD}
uniform sampler2D displacement_before, displacement_after, slopes_before, slopes_after;
uniform float share;
layout(location = 0) out vec4 displacement;
layout(location = 1) out vec4 slopes;
layout(location = 2) out vec4 moments;

vec4 between(sampler2D before, sampler2D after) {
  ivec2 at = ivec2(gl_FragCoord.xy);
  return mix(texelFetch(before, at, 0), texelFetch(after, at, 0), share);
}

void main() {
  displacement = between(displacement_before, displacement_after);
  slopes = between(slopes_before, slopes_after);
  moments = vec4(slopes.xy * slopes.xy, slopes.x * slopes.y, 0.0);
}`;
