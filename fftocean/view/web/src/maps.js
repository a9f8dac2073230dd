// The textures that a renderer samples: three maps of each tile.
import { texture } from './gl.js';

/**
 * Return the three maps of a tile, each RGBA16F with mips: GPUs that cannot filter 32-bit floats
 * filter these.
 *
 * displacement: (c dx, c dy, h, c dxy); slopes: (sx, sy, c dxx, c dyy); moments: (sx^2, sy^2,
 * sx sy, 0), with the choppiness c.
 */
export function makeMaps(gl, nx, ny, anisotropy) {
  const options = { format: 'RGBA16F', width: nx, height: ny, filter: 'linear', mips: true };
  return {
    displacement: texture(gl, options),
    slopes: texture(gl, { ...options, anisotropy }),
    moments: texture(gl, { ...options, anisotropy }),
  };
}

/** Free the maps of a tile. */
export function disposeMaps(maps) {
  for (const map of Object.values(maps)) map.dispose();
}
