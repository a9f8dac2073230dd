// Noise that turns normals: two channels, periodic, of mean 0, within -1 to 1.

/** Samples a side of the texture, and cells of its coarsest octave across it. */
export const NOISE_SAMPLES = 256;
export const NOISE_CELLS = 8;

const OCTAVES = 4;
const LARGEST_HALF = 65504;

const view = new DataView(new ArrayBuffer(4));

/** Return the bits of the 16-bit float nearest to a number; ties go to the even one. */
export function toHalf(value) {
  view.setFloat32(0, value);
  const bits = view.getUint32(0);
  const sign = (bits >>> 16) & 0x8000;
  const size = Math.abs(value);
  if (Number.isNaN(value)) return 0x7e00;
  if (size > LARGEST_HALF) return sign | 0x7c00;
  if (size < 2 ** -14) return sign | roundToEven(size * 2 ** 24);
  const exponent = ((bits >>> 23) & 0xff) - 112;
  return sign + (exponent << 10) + roundToEven((bits & 0x7fffff) / 2 ** 13);
}

/** Return a number >= 0 rounded to the nearest whole one, ties to the even one. */
function roundToEven(value) {
  const below = Math.floor(value);
  const rest = value - below;
  if (rest !== 0.5) return Math.round(value);
  return below + (below & 1);
}

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

/** Return the noise as texels of an RG16F texture. */
export function noiseTexels() {
  const [first, second] = noiseChannels();
  const texels = new Uint16Array(2 * first.length);
  for (let i = 0; i < first.length; i++) {
    texels[2 * i] = toHalf(first[i]);
    texels[2 * i + 1] = toHalf(second[i]);
  }
  return texels;
}
