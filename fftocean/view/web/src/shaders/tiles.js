// Sums over the tiles of a sea, at a place of the water at rest.

/** How much smaller the ripples are than the last tile that they are a copy of. */
export const SHRUNK = 5.3;

/** Return numbered lines of a shader: samplers can be indexed with constants only. */
export function eachTile(count, line) {
  return Array.from({ length: count }, (_, i) => line.replaceAll('TILE', String(i))).join('\n');
}

/**
 * Return the source that finds places in the maps of some tiles.
 *
 * Each tile's coordinates are sheared by two waves some tiles long, no whole number of them: what
 * repeats meets itself out of step, and no repetition is seen from high above. Shears keep areas,
 * and with them the spectrum; they turn waves by some degrees, and slopes and their moments with
 * them. At the origin of the world the shears and their gradients vanish.
 */
export function tilePlaces(count) {
  return `
uniform vec4 tile_frames[${count}]; // place of the eye in the tile, and 1 / size
uniform vec4 shear_waves[${count}]; // two wave vectors [1/m]
uniform vec4 shear_shifts[${count}]; // two displacements [m]
uniform vec2 shear_phases[${count}]; // of the two at the eye
uniform sampler2D displacement_maps[${count}], slope_maps[${count}], moment_maps[${count}];

vec2 tile_place(int tile, vec2 rest) {
  vec4 waves = shear_waves[tile], shifts = shear_shifts[tile];
  vec2 turned = cos(vec2(dot(waves.xy, rest), dot(waves.zw, rest)) + shear_phases[tile]);
  vec2 sheared = rest + shifts.xy * turned.x + shifts.zw * turned.y;
  return tile_frames[tile].xy + sheared * tile_frames[tile].zw;
}

// Gradients of the sheared fields from those of the tile's own coordinates.
void turn_slopes(int tile, vec2 rest, inout vec2 slope, inout vec3 moments) {
  vec4 waves = shear_waves[tile], shifts = shear_shifts[tile];
  vec2 rate = sin(vec2(dot(waves.xy, rest), dot(waves.zw, rest)) + shear_phases[tile]);
  mat2 turn = mat2(1.0) - rate.x * outerProduct(waves.xy, shifts.xy) -
    rate.y * outerProduct(waves.zw, shifts.zw);
  slope = turn * slope;
  mat2 second = turn * mat2(moments.x, moments.z, moments.z, moments.y) * transpose(turn);
  moments = vec3(second[0][0], second[1][1], second[0][1]);
}
`;
}

/**
 * Return the source of a function that sums displacements (x, y, up), without the waves that a
 * mesh of some spacing cannot hold.
 */
export function displacementSum(count) {
  const line = `
  level = max(log2(spacing * tile_frames[TILE].z * float(textureSize(displacement_maps[TILE], 0).x)), 0.0);
  if (level < 8.0) sum += textureLod(displacement_maps[TILE], tile_place(TILE, rest), level).xyz;`;
  return `
vec3 displaced(vec2 rest, float spacing) {
  vec3 sum = vec3(0.0);
  float level;
  ${eachTile(count, line)}
  return sum;
}
`;
}

/**
 * Return the source of a function that sums slopes, stretches and slope variances of the linear
 * fields, as filtered by \`texture\` or at the level of some spacing.
 *
 * The tiles hold waves of disjoint bands, so their covariances add (Olano & Baker 2010, Dupuy et
 * al. 2013): what filtering took from the slopes it leaves in the variance.
 */
export function slopeSum(count, { spaced = false } = {}) {
  const look = (map) =>
    spaced ? `textureLod(${map}[TILE], at, level)` : `texture(${map}[TILE], at)`;
  const line = `
  at = tile_place(TILE, rest);
  ${spaced ? `level = max(log2(spacing * tile_frames[TILE].z * float(textureSize(slope_maps[TILE], 0).x)), 0.0);` : ''}
  slopes = ${look(`slope_maps`)};
  moments = ${look(`moment_maps`)}.xyz;
  turn_slopes(TILE, rest, slopes.xy, moments);
  sums.slope += slopes.xy;
  sums.stretch += vec3(slopes.zw, ${spaced ? '0.0' : `${look(`displacement_maps`)}.w`});
  // Half floats leave a negative difference now and then.
  sums.variance.xy += max(moments.xy - slopes.xy * slopes.xy, 0.0);
  sums.variance.z += moments.z - slopes.x * slopes.y;`;
  return `
struct Sums {
  vec2 slope;
  vec3 stretch; // xx, yy, xy, with choppiness
  vec3 variance; // of slopes: xx, yy, xy
};

Sums summed(vec2 rest ${spaced ? `, float spacing` : ''}) {
  Sums sums = Sums(vec2(0.0), vec3(0.0), vec3(0.0));
  vec2 at;
  vec4 slopes;
  vec3 moments;
  ${spaced ? `float level;` : ''}
  ${eachTile(count, line)}
  return sums;
}
`;
}

/**
 * Return the source of a function that adds ripples to the sums of \`slopeSum\`: part of the slope
 * variance of the waves that no tile holds is drawn, as the last tile shrunk and turned.
 *
 * What is drawn leaves the variance that is not: the total stays, and filtering gives it back.
 */
export function rippleSum(count) {
  const last = count - 1;
  return `
void add_ripples(vec2 rest, inout Sums sums, inout vec3 beyond) {
  vec3 whole = textureLod(moment_maps[${last}], vec2(0.5), 20.0).xyz;
  if (min(whole.x, whole.y) < 1e-6) return;
  float share = min(0.6 * min(beyond.x / whole.x, beyond.y / whole.y), 0.5);
  const mat2 TURN = mat2(0.8, 0.6, -0.6, 0.8);
  float shrunk = ${SHRUNK.toFixed(1)};
  vec2 at = ripple_frame.xy + shrunk * ripple_frame.z * (TURN * rest);
  vec4 slopes = texture(slope_maps[${last}], at);
  vec3 moments = texture(moment_maps[${last}], at).xyz;
  vec2 slope = slopes.xy * TURN; // turned back
  mat2 second = transpose(TURN) * mat2(moments.x, moments.z, moments.z, moments.y) * TURN;
  mat2 all = transpose(TURN) * mat2(whole.x, whole.z, whole.z, whole.y) * TURN;
  float root = sqrt(share);
  sums.slope += root * slope;
  vec3 lost = vec3(second[0][0], second[1][1], second[0][1]) - vec3(slope * slope, slope.x * slope.y);
  beyond += share * (lost - vec3(all[0][0], all[1][1], all[0][1]));
}
`;
}
