// Shader of the false colours of the fields.
import { FOAM_LOOKUP } from './breaking.js';
import { FRAGMENT_HEAD } from './heads.js';
import { INPUTS, LIFTED_EYE, SURFACE } from './surface.js';
import { slopeSum, tilePlaces } from './tiles.js';

/** Return the source of the fragment shader of false colours; `view` as numbered in views.js. */
export function falseColourShader(count) {
  return `${FRAGMENT_HEAD}${tilePlaces(count)}${slopeSum(count)}${SURFACE}${FOAM_LOOKUP}${LIFTED_EYE}${INPUTS}
uniform sampler2D colour_maps; // one map a row
uniform int view;
uniform vec4 shown_range; // lowest and highest value, row of the map, rows
uniform float tile_counts[${count}];

vec3 mapped(float value) {
  float at = clamp((value - shown_range.x) / (shown_range.y - shown_range.x), 0.0, 1.0);
  return textureLod(colour_maps, vec2((at * 255.0 + 0.5) / 256.0, (shown_range.z + 0.5) / shown_range.w), 0.0).rgb;
}

float line(vec2 at, float width) {
  vec2 near = abs(fract(at - 0.5) - 0.5) / max(fwidth(at), 1e-6);
  return 1.0 - smoothstep(width - 0.5, width + 0.5, min(near.x, near.y));
}

// Dense lines turn into a grey of their own instead of noise.
float fading(vec2 at) {
  vec2 rate = fwidth(at);
  return 1.0 - smoothstep(0.25, 0.6, max(rate.x, rate.y));
}

void main() {
  Sums sums = summed(rest);
  Surface surface = displaced_surface(sums, beyond);
  vec3 facet = normalize(vec3(-surface.slope, 1.0));
  float height = place.z + lifted_eye() + dot(rest, rest) / (2.0 * 6371e3);
  vec3 found;
  if (view == 1) found = mapped(height);
  else if (view == 2) found = mapped(length(surface.slope));
  else if (view == 3) found = 0.5 + 0.5 * facet;
  else if (view == 4) found = mapped(surface.jacobian);
  else if (view == 5) found = mapped(foam_at(rest).x);
  else if (view == 6) found = mapped(sqrt(surface.variance.x + surface.variance.y));
  else if (view == 7) {
    // The borders of the tiles, one hue a tile, over the heights.
    found = mix(vec3(dot(mapped(height), vec3(0.33))), vec3(0.35), 0.3);
    const vec3 HUES[4] = vec3[4](vec3(0.95, 0.75, 0.2), vec3(0.3, 0.75, 0.95), vec3(0.95, 0.45, 0.55), vec3(0.55, 0.85, 0.45));
    for (int i = 0; i < ${count}; i++) {
      vec2 at = tile_place(i, rest);
      found = mix(found, HUES[i & 3], line(at, 1.0) * fading(at));
    }
  } else {
    float edges = max(line(cell, 0.6), line(vec2(cell.x + cell.y), 0.6));
    vec3 plain = mapped(height) * (0.55 + 0.45 * facet.z);
    found = mix(plain, vec3(0.05), 0.8 * edges * fading(cell));
  }
  colour = vec4(found, 1.0);
}`;
}
