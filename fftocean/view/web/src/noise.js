// Noise that turns normals: two channels, periodic, of mean 0, within -1 to 1.

import { halfFloats } from './half.js';

/** Samples a side of the texture, and cells of its coarsest octave across it. */
export const NOISE_SAMPLES = 256;
export const NOISE_CELLS = 8;

const OCTAVES = 4;

/** Return a whole number that looks random, for a cell of an octave of a channel. */
function hash(x, y, channel) {
  let h = Math.imul(x, 0x8da6b343) ^ Math.imul(y, 0xd8163841) ^ Math.imul(channel, 0xcb1ab31f);
  h = Math.imul(h ^ (h >>> 15), 0x2c1b3c6d);
  h = Math.imul(h ^ (h >>> 12), 0x297a2d39);
  return (h ^ (h >>> 15)) >>> 0;
}

/** Return smooth noise of `cells` cells across the texture, (samples x samples), in -1 to 1. */
function octave(cells, channel) {
  const values = new Float32Array(NOISE_SAMPLES * NOISE_SAMPLES);
  const random = (x, y) => hash(x % cells, y % cells, channel) / 2 ** 31 - 1;
  for (let j = 0; j < NOISE_SAMPLES; j++) {
    for (let i = 0; i < NOISE_SAMPLES; i++) {
      const [x, y] = [(i * cells) / NOISE_SAMPLES, (j * cells) / NOISE_SAMPLES];
      const [column, row] = [Math.floor(x), Math.floor(y)];
      const [u, v] = [smooth(x - column), smooth(y - row)];
      const south = mix(random(column, row), random(column + 1, row), u);
      const north = mix(random(column, row + 1), random(column + 1, row + 1), u);
      values[j * NOISE_SAMPLES + i] = mix(south, north, v);
    }
  }
  return values;
}

const mix = (a, b, share) => a + share * (b - a);
const smooth = (x) => x * x * x * (x * (6 * x - 15) + 10);

/**
 * Return the noise as two channels of numbers: four octaves, each half as strong as the one before.
 *
 * The mean is 0 and the largest magnitude 1: a sum of octaves as it comes would turn normals
 * further than its amplitude says, and to one side.
 */
export function noiseChannels() {
  return [0, 1].map((channel) => {
    const sum = new Float32Array(NOISE_SAMPLES * NOISE_SAMPLES);
    for (let i = 0; i < OCTAVES; i++) {
      const part = octave(NOISE_CELLS << i, 2 * i + channel);
      part.forEach((value, at) => (sum[at] += value * 2 ** -i));
    }
    const mean = sum.reduce((total, value) => total + value, 0) / sum.length;
    const most = sum.reduce((largest, value) => Math.max(largest, Math.abs(value - mean)), 0);
    return sum.map((value) => (value - mean) / most);
  });
}

/**
 * Return the levels of an RG16F texture of the noise, the finest first, each half as fine.
 *
 * They are averaged here, because a GPU that cannot draw into half floats makes no mips of them.
 */
export function noiseLevels() {
  let channels = noiseChannels();
  const levels = [];
  for (let samples = NOISE_SAMPLES; samples >= 1; samples /= 2) {
    const [first, second] = channels;
    const texels = new Float32Array(2 * samples * samples);
    first.forEach((value, i) => texels.set([value, second[i]], 2 * i));
    levels.push(halfFloats(texels));
    channels = channels.map((channel) => halved(channel, samples));
  }
  return levels;
}

/** Return the means of two by two samples. */
function halved(values, samples) {
  const half = samples >> 1;
  return Float32Array.from({ length: half * half }, (_, i) => {
    const at = 2 * Math.floor(i / half) * samples + 2 * (i % half);
    return 0.25 * (values[at] + values[at + 1] + values[at + samples] + values[at + samples + 1]);
  });
}
