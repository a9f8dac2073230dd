// Noise that turns normals: the slopes of ripples, periodic, of mean 0, within -1 to 1.

import { halfFloats } from './half.js';

/** Samples a side of the texture, and cycles across it of a ripple of the nominal length. */
export const NOISE_SAMPLES = 256;
export const NOISE_CYCLES = 8;

const RIPPLES = 72;
const FEWEST_CYCLES = 6;
const MOST_CYCLES = 60;

/** Return a number from 0 to 1 that looks random, for each whole number. */
function random(number) {
  let h = Math.imul(number + 1, 0x2c1b3c6d);
  h = Math.imul(h ^ (h >>> 15), 0x297a2d39);
  h = Math.imul(h ^ (h >>> 13), 0x5bd1e995);
  return ((h ^ (h >>> 16)) >>> 0) / 2 ** 32;
}

/**
 * Return the noise as two channels of numbers: the angles about the axes to the east and to the
 * north by which ripples of all directions turn a normal, each ripple as steep as the others.
 *
 * Their mean is 0 and the largest magnitude 1: a sum as it comes would turn normals further than
 * its amplitude says.
 */
export function noiseChannels() {
  const samples = NOISE_SAMPLES;
  const wave = Float32Array.from({ length: samples }, (_, i) =>
    Math.sin((2 * Math.PI * i) / samples),
  );
  const channels = [0, 1].map(() => new Float32Array(samples * samples));
  for (let ripple = 0; ripple < RIPPLES; ripple++) {
    const size = FEWEST_CYCLES * (MOST_CYCLES / FEWEST_CYCLES) ** (ripple / (RIPPLES - 1));
    const direction = 2 * Math.PI * random(2 * ripple);
    const mx = Math.round(size * Math.cos(direction));
    const my = Math.round(size * Math.sin(direction));
    const length = Math.hypot(mx, my);
    const phase = Math.floor(samples * random(2 * ripple + 1));
    for (let j = 0; j < samples; j++) {
      for (let i = 0; i < samples; i++) {
        // whole cycles across the texture: the phase is a whole number of samples of the sine
        const value = wave[(mx * i + my * j + phase) & (samples - 1)];
        channels[0][j * samples + i] += (my / length) * value;
        channels[1][j * samples + i] -= (mx / length) * value;
      }
    }
  }
  return channels.map((sum) => {
    const most = sum.reduce((largest, value) => Math.max(largest, Math.abs(value)), 0);
    return sum.map((value) => value / most);
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
