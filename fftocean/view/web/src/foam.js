// Foam on the water around the eye: two windows that move with it, and the noise that breaks it up.
import { drawFullscreen, program, target, texture } from './gl.js';
import { foamStepShader } from './shaders/breaking.js';
import { tileUniforms } from './tiles.js';

/** Sides of the windows [m]: the first for what is near, the second for the view from above. */
export const WINDOWS = [256, 2048];

// Shortest steps of the windows [s]: nobody sees what is far away change from picture to picture.
const SHORTEST_STEPS = [0, 0.2];

/** Side of a tile of the break-up noise [m]. */
export const BREAK_UP_SIZE = 11;

// Enlargement of the noise for the view from afar, no whole number lest the two fall into step.
const LARGER = 6.7;

// Kept in 0..1 of eight bits; the shader reads them back.
const NOISE_RANGE = 4;

/** Return a whole number scrambled to 32 bits. */
function scrambled(x) {
  let bits = x | 0;
  bits = Math.imul(bits ^ (bits >>> 16), 0x7feb352d);
  bits = Math.imul(bits ^ (bits >>> 15), 0x846ca68b);
  return (bits ^ (bits >>> 16)) >>> 0;
}

/** Return a number in 0..1 of a place of a lattice that repeats. */
function latticeValue(x, y, period, salt) {
  const column = ((x % period) + period) % period;
  const row = ((y % period) + period) % period;
  return scrambled(scrambled(column + 7919 * salt) + row) / 2 ** 32;
}

/** Return smooth noise in 0..1 at a place in 0..1, `period` cells a side. */
function smoothNoise(x, y, period, salt) {
  const [column, row] = [Math.floor(x * period), Math.floor(y * period)];
  const ease = (t) => t * t * (3 - 2 * t);
  const [u, v] = [ease(x * period - column), ease(y * period - row)];
  const at = (i, j) => latticeValue(column + i, row + j, period, salt);
  const low = at(0, 0) + u * (at(1, 0) - at(0, 0));
  const high = at(0, 1) + u * (at(1, 1) - at(0, 1));
  return low + v * (high - low);
}

/** Return how near a place is to the border between two cells, 1 on it. */
function nearBorder(x, y, period, salt) {
  const [column, row] = [Math.floor(x * period), Math.floor(y * period)];
  let [first, second] = [9, 9];
  for (let i = column - 1; i <= column + 1; i++) {
    for (let j = row - 1; j <= row + 1; j++) {
      const dx = i + latticeValue(i, j, period, salt) - x * period;
      const dy = j + latticeValue(i, j, period, salt + 1) - y * period;
      const distance = Math.hypot(dx, dy);
      if (distance < first) [first, second] = [distance, first];
      else second = Math.min(second, distance);
    }
  }
  return 1 - Math.min(second - first, 1);
}

/** Return the value that a standard normal variable passes with a probability of 1 - `share`. */
export function normalQuantile(share) {
  // Bisection of the error function's series is slow; Acklam's rational fit (2003) is good to 1e-9.
  const a = [-39.69683028665376, 220.9460984245205, -275.9285104469687];
  a.push(138.357751867269, -30.66479806614716, 2.506628277459239);
  const b = [-54.47609879822406, 161.5858368580409, -155.6989798598866];
  b.push(66.80131188771972, -13.28068155288572, 1);
  const c = [-0.007784894002430293, -0.3223964580411365, -2.400758277161838];
  c.push(-2.549732539343734, 4.374664141464968, 2.938163982698783);
  const d = [0.007784695709041462, 0.3224671290700398, 2.445134137142996, 3.754408661907416, 1];
  const polynomial = (coefficients, x) => coefficients.reduce((sum, value) => sum * x + value, 0);
  if (share > 0.5) return -normalQuantile(1 - share);
  if (share < 0.02425) {
    const q = Math.sqrt(-2 * Math.log(share));
    return polynomial(c, q) / polynomial(d, q);
  }
  const q = share - 0.5;
  return (q * polynomial(a, q * q)) / polynomial(b, q * q);
}

/**
 * Return noise of a bubbly look whose values are distributed normally, n x n, with mean 0 and
 * variance 1.
 */
export function breakUpNoise(n) {
  const values = new Float64Array(n * n);
  for (let j = 0; j < n; j++) {
    for (let i = 0; i < n; i++) {
      const [x, y] = [(i + 0.5) / n, (j + 0.5) / n];
      const bend = 0.05 * (smoothNoise(x, y, 7, 11) - 0.5);
      const turn = 0.05 * (smoothNoise(x, y, 7, 12) - 0.5);
      const [u, v] = [x + bend, y + turn];
      const lace = nearBorder(u, v, 11, 1) ** 2;
      const fine = nearBorder(u + bend, v, 27, 3) ** 2;
      const finest = nearBorder(u, v + bend, 61, 5);
      const broad = smoothNoise(x, y, 4, 7) + 0.6 * smoothNoise(x, y, 9, 8);
      values[j * n + i] = 0.34 * lace + 0.3 * fine + 0.2 * finest + 0.22 * broad;
    }
  }
  // By rank: the shape of the noise stays, its distribution becomes normal.
  const order = Array.from(values.keys()).sort((p, q) => values[p] - values[q]);
  const noise = new Float32Array(n * n);
  order.forEach((at, rank) => (noise[at] = normalQuantile((rank + 0.5) / (n * n))));
  return noise;
}

/** Return the noise as texels: the value and its square, in eight bits each. */
function breakUpTexels(n) {
  const texels = new Uint8Array(4 * n * n);
  breakUpNoise(n).forEach((value, i) => {
    const kept = Math.min(Math.max(value, -NOISE_RANGE), NOISE_RANGE);
    const code = Math.round(255 * (0.5 + kept / (2 * NOISE_RANGE)));
    // The square of the value as it is kept, or rounding would look like lost variance.
    const read = (code / 255 - 0.5) * 2 * NOISE_RANGE;
    texels.set([code, Math.round((255 * read * read) / NOISE_RANGE ** 2), 0, 255], 4 * i);
  });
  return texels;
}

/** One window of foam that repeats around the eye; its cells stay where they are in the world. */
class FoamWindow {
  constructor(gl, size, samples) {
    Object.assign(this, { gl, size, samples, cell: size / samples });
    const options = { format: 'RGBA16F', width: samples, height: samples, filter: 'linear' };
    this.targets = [0, 1].map(() => target(gl, [texture(gl, { ...options, mips: true })]));
    this.corner = [0, 0];
    this.fresh = true;
    this.pending = 0; // seconds that are not in the foam yet
  }

  /** Advance by some seconds around an eye, in steps of `shortest` seconds at least. */
  advance(step, tiles, foam, [east, north], passed, shortest) {
    const corner = [east, north].map((at) => Math.floor(at / this.cell) - this.samples / 2);
    const moved = Math.max(...corner.map((at, i) => Math.abs(at - this.corner[i])));
    this.pending += passed;
    if (this.pending < shortest && moved < this.samples / 32 && !this.fresh) return;
    const seconds = this.pending;
    this.pending = 0;
    const [before, after] = this.targets;
    drawFullscreen(
      this.gl,
      step,
      {
        ...tiles,
        before: before.textures[0],
        corner,
        corner_before: this.corner,
        corner_place: [east, north].map((at, i) => (corner[i] + 0.5) * this.cell - at),
        cell: this.cell,
        seconds,
        decay: foam.decay,
        threshold: foam.threshold,
        strength: foam.strength,
        fresh: this.fresh,
      },
      after,
    );
    after.textures[0].generateMips();
    this.targets = [after, before];
    this.corner = corner;
    this.fresh = false;
  }

  /** Return the eye's place in the window, 1 / size, and the distance of its edge [m]. */
  frame([east, north]) {
    const place = [east, north].map((at) => at / this.size - Math.floor(at / this.size));
    return [...place, 1 / this.size, this.size / 2 - 2 * this.cell];
  }

  get map() {
    return this.targets[0].textures[0];
  }

  /** Free the window. */
  dispose() {
    for (const one of this.targets) one.dispose();
  }
}

/** The foam of a sea. */
export class FoamField {
  /** Make the windows, of so many samples a side each, and the noise, `noise` a side. */
  constructor(gl, samples, noise, anisotropy) {
    this.gl = gl;
    this.windows = WINDOWS.map((size, i) => new FoamWindow(gl, size, samples[i]));
    this.breakUp = texture(gl, {
      format: 'RGBA8',
      width: noise,
      height: noise,
      data: breakUpTexels(noise),
      filter: 'linear',
      mips: true,
      anisotropy,
    });
    this.breakUp.generateMips();
    this.steps = new Map();
  }

  /** Forget all foam: the next step begins with that of a steady source. */
  restart() {
    for (const one of this.windows) one.fresh = true;
  }

  /** Advance by some seconds; long steps are taken as one. */
  advance(source, eye, seconds) {
    const { foam } = source.document;
    if (!foam || !(seconds > 0)) return;
    const count = source.tiles.length;
    if (!this.steps.has(count)) this.steps.set(count, program(this.gl, foamStepShader(count)));
    const tiles = tileUniforms(source.tiles, ...eye);
    this.windows.forEach((one, i) =>
      one.advance(this.steps.get(count), tiles, foam, eye, seconds, SHORTEST_STEPS[i]),
    );
  }

  /** Return the uniforms that `FOAM_LOOKUP` needs. */
  uniforms([east, north], wind) {
    // Patches are drawn out along the wind, in a storm to streaks.
    const longer = 1 + Math.min((wind?.speed ?? 0) / 14, 2);
    const angle = ((wind?.direction ?? 0) * Math.PI) / 180;
    const [c, s] = [Math.cos(angle) / BREAK_UP_SIZE, Math.sin(angle) / BREAK_UP_SIZE];
    const rows = [
      [c / longer, s / longer],
      [-s, c],
    ];
    const place = rows.map(([x, y]) => x * east + y * north);
    const wrapped = (scale) => place.map((at) => at / scale - Math.floor(at / scale));
    return {
      foam_near: this.windows[0].map,
      foam_far: this.windows[1].map,
      foam_frames: this.windows.map((one) => one.frame([east, north])),
      break_up: this.breakUp,
      break_up_axes: [rows[0][0], rows[1][0], rows[0][1], rows[1][1]],
      break_up_places: [wrapped(1), wrapped(LARGER)],
      break_up_larger: LARGER,
    };
  }

  /** Free everything. */
  dispose() {
    for (const one of [...this.windows, ...this.steps.values(), this.breakUp]) one.dispose();
  }
}
