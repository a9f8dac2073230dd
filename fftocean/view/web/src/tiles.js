// Where the eye stands in each tile of a sea, in double precision.
import { SHRUNK } from './shaders/tiles.js';

// The shears that keep tiles from repeating: wave vectors in tiles, and the gradient of each.
const SHEARS = [
  { east: 0.368, north: 0.277, gradient: 0.06 },
  { east: -0.561, north: 0.47, gradient: 0.06 },
];

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
  for (const { nx, ny, lx, ly } of tiles) {
    const corner = [0.5 / nx, 0.5 / ny]; // texel i lies at i L / n
    const size = Math.max(lx, ly);
    const shear = [];
    const wave = [];
    const phase = [];
    for (const { east: x, north: y, gradient } of SHEARS) {
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
