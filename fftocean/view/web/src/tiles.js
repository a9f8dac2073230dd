// Where the eye stands in each tile of a sea, in double precision.
import { SHRUNK } from './shaders/tiles.js';

// Wave vectors, in tiles, of the shears that keep tiles from repeating. No small multiple of a tile
// is near a whole wave of both.
const SHEARS = [
  [0.19, 0.137],
  [-0.15, 0.217],
];

// Their gradients: the largest tile holds many waves, whose crests need to move little; of the
// others the longest waves are a fifth of the tile.
const GRADIENT_OF_LARGEST = 0.065;
const GRADIENT = 0.21;

/** Return the part of a number after the point, also of a negative one. */
function fraction(value) {
  return value - Math.floor(value);
}

/**
 * Return the uniforms that `tilePlaces` needs.
 *
 * @param {object[]} tiles each with nx, ny, lx, ly and maps
 * @param {number} east place of the eye [m]
 * @param {number} north [m]
 */
export function tileUniforms(tiles, east, north) {
  const frames = [];
  const waves = [];
  const shifts = [];
  const phases = [];
  const largest = Math.max(...tiles.map((tile) => tile.lx));
  for (const { nx, ny, lx, ly } of tiles) {
    const gradient = lx === largest ? GRADIENT_OF_LARGEST : GRADIENT;
    const corner = [0.5 / nx, 0.5 / ny]; // texel i lies at i L / n
    const size = Math.max(lx, ly);
    const shear = [];
    const wave = [];
    const phase = [];
    for (const [x, y] of SHEARS) {
      const length = Math.hypot(x, y);
      const amplitude = (gradient * size) / (2 * Math.PI * length);
      const shift = [(-y / length) * amplitude, (x / length) * amplitude];
      shear.push(...shift);
      wave.push((2 * Math.PI * x) / size, (2 * Math.PI * y) / size);
      phase.push(2 * Math.PI * fraction((x * east + y * north) / size));
      corner[0] -= shift[0] / lx; // no shift at the origin of the world
      corner[1] -= shift[1] / ly;
    }
    frames.push([
      fraction(east / lx + corner[0]),
      fraction(north / ly + corner[1]),
      1 / lx,
      1 / ly,
    ]);
    waves.push(wave);
    shifts.push(shear);
    phases.push(phase);
  }
  const { lx, ly } = tiles.at(-1);
  const size = Math.max(lx, ly);
  const ripple = [0.8 * east - 0.6 * north, 0.6 * east + 0.8 * north];
  return {
    ripple_frame: [...ripple.map((at) => fraction((SHRUNK * at) / size)), 1 / size],
    tile_frames: frames,
    shear_waves: waves,
    shear_shifts: shifts,
    shear_phases: phases,
    displacement_maps: tiles.map(({ maps }) => maps.displacement),
    slope_maps: tiles.map(({ maps }) => maps.slopes),
    moment_maps: tiles.map(({ maps }) => maps.moments),
  };
}
