// The fields of a tile at a tick, and its maps, computed in JavaScript in double precision.
import { FIELDS } from './container.js';
import { Fourier } from './fft.js';
import { halfFloats } from './half.js';

/** The waves of one tile, and arrays for its fields. */
export class Tile {
  /** Keep the tables of a tile; see `AmplitudeBlend` for the two sets of amplitudes. */
  constructor(to, from = to) {
    this.to = to;
    this.from = from;
    const samples = to.nx * to.ny;
    this.fourier = new Fourier(to.nx, to.ny);
    // Four complex fields: displacement, height + i stretch_xy, slopes, and the other stretches.
    this.parts = Array.from({ length: 8 }, () => new Float64Array(samples));
  }

  /**
   * Compute the eight fields at a tick of the loop.
   *
   * @returns {Object<string, Float64Array>} by name; overwritten by the next call
   */
  fields(tick, ticks, scaleTo = 1, scaleFrom = 0) {
    this.evolve(tick, ticks, scaleTo, scaleFrom);
    const { parts } = this;
    for (let i = 0; i < 8; i += 2) this.fourier.inverse(parts[i], parts[i + 1]);
    return Object.fromEntries(FIELDS.map((name, i) => [name, parts[i]]));
  }

  /** Write the four complex spectra at a tick. */
  evolve(tick, ticks, scaleTo, scaleFrom) {
    const { to, from, parts } = this;
    const { nx, ny, lx, ly } = to;
    const sets = [
      [scaleTo, to],
      [scaleFrom, from],
    ].filter(([scale]) => scale !== 0);
    for (let j = 0; j < ny; j++) {
      const ky = (2 * Math.PI * (2 * j < ny ? j : j - ny)) / ly;
      for (let i = 0; i < nx; i++) {
        const at = j * nx + i;
        const kx = (2 * Math.PI * (2 * i < nx ? i : i - nx)) / lx;
        // Whole numbers below 2^36: exact.
        const angle = (2 * Math.PI * ((to.wave[2 * at] * tick) % ticks)) / ticks;
        const c = Math.cos(angle);
        const s = Math.sin(angle);
        let hr = 0;
        let hi = 0;
        let pr = 0; // of the potential, height / (k tanh kh)
        let pi = 0;
        for (const [scale, { h0, wave }] of sets) {
          const [a, b, p, q] = [h0[4 * at], h0[4 * at + 1], h0[4 * at + 2], h0[4 * at + 3]];
          const re = scale * (a * c + b * s + p * c - q * s);
          const im = scale * (b * c - a * s + q * c + p * s);
          hr += re;
          hi += im;
          pr += re * wave[2 * at + 1];
          pi += im * wave[2 * at + 1];
        }
        parts[0][at] = -kx * pi - ky * pr;
        parts[1][at] = kx * pr - ky * pi;
        parts[2][at] = hr + kx * ky * pi;
        parts[3][at] = hi - kx * ky * pr;
        parts[4][at] = -kx * hi - ky * hr;
        parts[5][at] = kx * hr - ky * hi;
        parts[6][at] = -kx * kx * pr + ky * ky * pi;
        parts[7][at] = -kx * kx * pi - ky * ky * pr;
      }
    }
  }
}

/** Return the three maps of a tile, each a list of its levels in half floats, RGBA. */
export function mapsOf(fields, nx, ny, choppiness) {
  const maps = { displacement: [], slopes: [], moments: [] };
  const full = Object.fromEntries(
    Object.keys(maps).map((name) => [name, new Float32Array(4 * nx * ny)]),
  );
  const { displace_x, displace_y, height, stretch_xy, slope_x, slope_y, stretch_xx, stretch_yy } =
    fields;
  for (let i = 0; i < nx * ny; i++) {
    const sx = slope_x[i];
    const sy = slope_y[i];
    const place = 4 * i;
    full.displacement[place] = choppiness * displace_x[i];
    full.displacement[place + 1] = choppiness * displace_y[i];
    full.displacement[place + 2] = height[i];
    full.displacement[place + 3] = choppiness * stretch_xy[i];
    full.slopes[place] = sx;
    full.slopes[place + 1] = sy;
    full.slopes[place + 2] = choppiness * stretch_xx[i];
    full.slopes[place + 3] = choppiness * stretch_yy[i];
    full.moments[place] = sx * sx;
    full.moments[place + 1] = sy * sy;
    full.moments[place + 2] = sx * sy;
  }
  for (const name of Object.keys(maps)) maps[name] = levels(full[name], nx, ny);
  return maps;
}

/** Return a map and its averages over ever larger squares, down to one texel, as half floats. */
function levels(map, nx, ny) {
  const made = [halfFloats(map)];
  while (nx > 1 || ny > 1) {
    const [stepX, stepY] = [nx > 1 ? 2 : 1, ny > 1 ? 2 : 1];
    const [width, height] = [nx / stepX, ny / stepY];
    const less = new Float32Array(4 * width * height);
    const right = 4 * (stepX - 1);
    const below = 4 * nx * (stepY - 1);
    for (let j = 0; j < height; j++) {
      for (let i = 0; i < width; i++) {
        for (let channel = 0; channel < 4; channel++) {
          const at = 4 * (j * stepY * nx + i * stepX) + channel;
          less[4 * (j * width + i) + channel] =
            (map[at] + map[at + right] + map[at + below] + map[at + right + below]) / 4;
        }
      }
    }
    made.push(halfFloats(less));
    [map, nx, ny] = [less, width, height];
  }
  return made;
}
