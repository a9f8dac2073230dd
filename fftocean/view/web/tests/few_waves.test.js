import assert from 'node:assert/strict';
import test from 'node:test';
import { reachOf, ripplesOf, wavesAt } from '../src/few_waves.js';
import { NOISE_SAMPLES, noiseChannels, noiseLevels } from '../src/noise.js';

const MODEL = {
  kx: [0.1, -0.37],
  ky: [0.02, 1.3],
  amplitude: [0.8, 0.1],
  sharpness: [1, 0.4],
  cycles: [8191, 3],
  phase: [0.3, 5],
  ticks: 2 ** 19,
};

test('wavenumbers are a leading part of 12 bits and a rest', () => {
  const { wavenumber, wave, count } = wavesAt(MODEL, 0, 0, 0);
  assert.equal(count, 2);
  for (let i = 0; i < count; i++) {
    const [first, rest, second, other] = wavenumber.subarray(4 * i, 4 * i + 4);
    assert.ok(Math.abs(first + rest - MODEL.kx[i] / (2 * Math.PI)) < 1e-11);
    assert.ok(Math.abs(second + other - MODEL.ky[i] / (2 * Math.PI)) < 1e-10);
    // the product with another number of 12 bits is exact in 24 bits
    for (const value of [first, second]) {
      const scaled = value / 2 ** (Math.floor(Math.log2(Math.abs(value))) - 11);
      assert.equal(scaled, Math.round(scaled));
    }
    assert.deepEqual(
      [...wave.subarray(4 * i, 4 * i + 2)],
      [Math.fround(MODEL.amplitude[i]), Math.fround(MODEL.sharpness[i])],
    );
  }
});

test('phases are exact at every tick, also where cycles x tick nearly passes 2^32', () => {
  for (const tick of [0, 1, 77777, 2 ** 19 - 1]) {
    const { wave } = wavesAt(MODEL, tick, 0, 0);
    MODEL.cycles.forEach((cycles, i) => {
      const turned = Number((BigInt(cycles) * BigInt(tick)) % BigInt(MODEL.ticks)) / MODEL.ticks;
      const right = -turned - MODEL.phase[i] / (2 * Math.PI);
      const apart = wave[4 * i + 3] - right;
      assert.ok(Math.abs(apart - Math.round(apart)) < 6e-8);
    });
  }
});

test('the phase at the eye is that of its place', () => {
  const [east, north] = [-123456.5, 4321.25];
  const { wave } = wavesAt(MODEL, 0, east, north);
  MODEL.kx.forEach((kx, i) => {
    const right = (kx * east + MODEL.ky[i] * north - MODEL.phase[i]) / (2 * Math.PI);
    const apart = wave[4 * i + 3] - right;
    assert.ok(Math.abs(apart - Math.round(apart)) < 1e-6);
  });
});

test('more than 64 waves are refused', () => {
  const many = Object.fromEntries(
    Object.entries(MODEL).map(([name, value]) => [
      name,
      Array.isArray(value) ? Array(65).fill(value[0]) : value,
    ]),
  );
  assert.throws(() => wavesAt(many, 0, 0, 0), /at most 64 waves, got 65/);
});

test('the reach is that of all crests at one place', () => {
  assert.ok(Math.abs(reachOf(MODEL, 2) - (1.6 + 0.1)) < 1e-12);
});

test('noise has mean 0, stays within -1 to 1 and repeats', () => {
  const channels = noiseChannels();
  for (const values of channels) {
    const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
    assert.ok(Math.abs(mean) < 1e-6);
    const largest = values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
    assert.ok(Math.abs(largest - 1) < 1e-6);
    let inside = 0;
    let across = 0;
    for (let row = 0; row < NOISE_SAMPLES; row++) {
      const at = row * NOISE_SAMPLES;
      across = Math.max(across, Math.abs(values[at] - values[at + NOISE_SAMPLES - 1]));
      for (let i = 1; i < NOISE_SAMPLES; i++) {
        inside = Math.max(inside, Math.abs(values[at + i] - values[at + i - 1]));
      }
    }
    assert.ok(across <= inside); // the edge is no seam
  }
  const together = channels[0].reduce((sum, value, i) => sum + value * channels[1][i], 0);
  const alone = channels[0].reduce((sum, value) => sum + value * value, 0);
  assert.ok(Math.abs(together / alone) < 0.2);
});

test('levels of the noise go down to its mean', () => {
  const levels = noiseLevels();
  assert.deepEqual(
    levels.map(({ length }) => length),
    Array.from({ length: 9 }, (_, i) => 2 * 4 ** (8 - i)),
  );
  assert.ok([...levels[8]].every((half) => (half & 0x7fff) < 0x0100)); // below 2^-17
});

test('ripples vanish with the waves', () => {
  assert.equal(ripplesOf({ amplitude: [] }), 0);
  assert.equal(ripplesOf({ amplitude: [0, 0] }), 0);
  // Hs is 4 standard deviations, the variance of a wave half the square of its amplitude
  const half = 0.05 / 4;
  assert.ok(Math.abs(ripplesOf({ amplitude: [half, half] }) - 0.5) < 1e-12);
  assert.equal(ripplesOf(MODEL), 1);
});
