// Sums over the tiles of a sea, at a place of the water at rest.

/** Return numbered lines of a shader: samplers can be indexed with constants only. */
export function eachTile(count, line) {
  return Array.from({ length: count }, (_, i) => line.replaceAll('TILE', String(i))).join('\n');
}

/**
 * Return the source that finds places in the maps of some tiles.
 *
 * Each tile's coordinates are sheared a little by two long waves whose lengths are no fraction of
 * the tile's: what repeats meets itself out of step, and no repetition is seen from high above.
 * Shears keep areas, and with them the spectrum; where the waves are turned, at most by 3.5
 * degrees, slopes are not turned with them. At the origin of the world the shears and their
 * gradients vanish.
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
    spaced ? `textureLod(${map}_maps[TILE], at, level)` : `texture(${map}_maps[TILE], at)`;
  const line = `
  at = tile_place(TILE, rest);
  ${spaced ? 'level = max(log2(spacing * tile_frames[TILE].z * float(textureSize(slope_maps[TILE], 0).x)), 0.0);' : ''}
  slopes = ${look('slope')};
  moments = ${look('moment')};
  sums.slope += slopes.xy;
  sums.stretch += vec3(slopes.zw, ${spaced ? '0.0' : `${look('displacement')}.w`});
  // Half floats leave a negative difference now and then.
  sums.variance.xy += max(moments.xy - slopes.xy * slopes.xy, 0.0);
  sums.variance.z += moments.z - slopes.x * slopes.y;`;
  return `
struct Sums {
  vec2 slope;
  vec3 stretch; // xx, yy, xy, with choppiness
  vec3 variance; // of slopes: xx, yy, xy
};

Sums summed(vec2 rest${spaced ? ', float spacing' : ''}) {
  Sums sums = Sums(vec2(0.0), vec3(0.0), vec3(0.0));
  vec2 at;
  vec4 slopes, moments;
  ${spaced ? 'float level;' : ''}
  ${eachTile(count, line)}
  return sums;
}
`;
}
