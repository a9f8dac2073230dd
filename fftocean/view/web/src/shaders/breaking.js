// Shaders of foam: what it remembers, and how it breaks up.
import { FRAGMENT_HEAD } from './heads.js';
import { eachTile, tilePlaces } from './tiles.js';

/**
 * Return the source of one step of the foam of a window, at places of the water at rest.
 *
 * df/dt = -f / decay + strength max(threshold - lambda, 0), lambda the smaller eigenvalue of the
 * deformation gradient (Tessendorf 2001), of the SUM of the tiles' stretches: a tile cannot know
 * the others. Each cell takes the texel of each tile at its own middle: neither filtered nor
 * interpolated, so that the mean of what foams is that of the waves whatever the size of a cell.
 */
export function foamStepShader(count) {
  const line = `
  samples = textureSize(slope_maps[TILE], 0);
  texel = ivec2(floor(fract(tile_place(TILE, rest)) * vec2(samples))) & (samples - 1);
  stretch += vec3(texelFetch(slope_maps[TILE], texel, 0).zw,
    texelFetch(displacement_maps[TILE], texel, 0).w);`;
  return `${FRAGMENT_HEAD}${tilePlaces(count)}
uniform sampler2D before;
uniform ivec2 corner, corner_before; // first cell of the window now and at the last step
uniform vec2 corner_place; // of the middle of the first cell, from the eye [m]
uniform float cell, seconds, decay, threshold, strength;
uniform bool fresh;
out vec4 foam;

void main() {
  int side = textureSize(before, 0).x;
  ivec2 place = ivec2(gl_FragCoord.xy);
  // A cell of the world keeps its place while the window moves over it.
  ivec2 index = (place - corner) & (side - 1);
  vec2 rest = corner_place + vec2(index) * cell;
  vec3 stretch = vec3(0.0);
  ivec2 samples, texel;
  ${eachTile(count, line)}
  float middle = 1.0 + 0.5 * (stretch.x + stretch.y), half_difference = 0.5 * (stretch.x - stretch.y);
  float smaller = middle - sqrt(half_difference * half_difference + stretch.z * stretch.z);
  ivec2 old = corner + index - corner_before;
  bool kept = !fresh && all(greaterThanEqual(old, ivec2(0))) && all(lessThan(old, ivec2(side)));
  // A cell that enters the window begins with what a steady source would have left on it.
  float left = kept ? texelFetch(before, place, 0).x * exp(-seconds / decay) : 0.0;
  float made = kept ? 1.0 - exp(-seconds / decay) : 1.0;
  float amount = left + made * decay * strength * max(threshold - smaller, 0.0);
  amount = min(amount, 30.0);
  foam = vec4(amount, 1.0 - exp(-amount), smaller, 1.0);
}`;
}

/**
 * Where foam shows: coverage in the windows, and its break-up into patches.
 *
 * The noise is a Gaussian field g of unit variance, stored with its square, so that mips tell how
 * much of it they lost. Foam of coverage c lies where g > t with P(g > t) = c. Of a filtered value
 * m with variance v lost, the share above t is P((t - m) / sqrt(v)): whatever the filter, the mean
 * over the water stays c.
 */
export const FOAM_LOOKUP = `
uniform sampler2D foam_near, foam_far, break_up;
uniform vec4 foam_frames[2]; // place of the eye in the window, 1 / size, distance of the edge [m]
uniform mat2 break_up_axes; // from places on the water to the noise, which wind draws out
uniform vec2 break_up_places[2]; // of the eye, in the noise and in its enlargement
uniform float break_up_larger;

// The normal distribution and its inverse by Winitzki's (2008) error function, a pair.
float above(float x) {
  float square = 0.5 * x * x, part = square * (1.2732395 + 0.147 * square) / (1.0 + 0.147 * square);
  return 0.5 - 0.5 * sign(x) * sqrt(1.0 - exp(-part));
}

float threshold_of(float share) {
  float p = clamp(share, 1e-4, 1.0 - 1e-4), twice = 1.0 - 2.0 * p;
  float logarithm = log(4.0 * p * (1.0 - p)), part = 4.3307468 + 0.5 * logarithm;
  return 1.4142136 * sign(twice) * sqrt(max(sqrt(part * part - logarithm / 0.147) - part, 0.0));
}

// Coverage, part of it spread over the water around: averages of coverage keep its mean, and the
// noise makes streaks of what they spread.
float spread_cover(sampler2D window, vec2 place, float level) {
  vec2 cells = place * float(textureSize(window, 0).x), along = dFdx(cells), across = dFdy(cells);
  float pixel = 0.5 * log2(max(max(dot(along, along), dot(across, across)), 1e-8));
  return mix(texture(window, place).y, textureLod(window, place, max(pixel, level)).y, 0.6);
}

// (coverage, share of the pixel that foam covers, variation of its white about 1)
vec3 foam_at(vec2 rest) {
  float out_near = max(abs(rest.x), abs(rest.y)) / foam_frames[0].w;
  float out_far = max(abs(rest.x), abs(rest.y)) / foam_frames[1].w;
  vec2 place_far = foam_frames[1].xy + rest * foam_frames[1].z;
  vec2 place_near = foam_frames[0].xy + rest * foam_frames[0].z;
  float far_cover = spread_cover(foam_far, place_far, 0.8);
  float near_cover = spread_cover(foam_near, place_near, 2.6);
  float mean_cover = textureLod(foam_far, vec2(0.5), 20.0).y;
  float cover = mix(far_cover, mean_cover, smoothstep(0.8, 1.0, out_far));
  cover = mix(near_cover, cover, smoothstep(0.75, 1.0, out_near));
  vec2 place = break_up_axes * rest, far_place = break_up_places[1] + place / break_up_larger;
  vec2 along = dFdx(place), across = dFdy(place);
  float pixel = sqrt(max(dot(along, along), dot(across, across))) * float(textureSize(break_up, 0).x);
  vec2 fine = (texture(break_up, break_up_places[0] + place).xy - vec2(0.5, 0.0)) * vec2(8.0, 16.0);
  vec2 broad = (texture(break_up, far_place).xy - vec2(0.5, 0.0)) * vec2(8.0, 16.0);
  // From afar an enlargement takes over; a weighted sum of normal variables is normal.
  float larger = smoothstep(0.5, 4.0, log2(max(pixel, 1e-4)));
  vec2 weights = normalize(vec2(1.0 - 0.85 * larger, 0.3 + 0.7 * larger));
  float noise = weights.x * fine.x + weights.y * broad.x;
  vec2 lost_each = max(vec2(fine.y, broad.y) - vec2(fine.x, broad.x) * vec2(fine.x, broad.x), 0.0);
  float lost = min(dot(weights * weights, lost_each), 1.0);
  // A soft edge adds to the variance, and moves the threshold by as much.
  float soft = 0.45;
  float patches = above((threshold_of(cover) * sqrt(1.0 + soft) - noise) / sqrt(lost + soft));
  // Where almost none of the noise is left, nothing is: the rest of the pair's error goes too.
  patches = mix(patches, cover, smoothstep(0.5, 0.9, lost));
  return vec3(cover, cover < 2e-4 ? cover : patches, 1.0 + 0.12 * noise);
}
`;
