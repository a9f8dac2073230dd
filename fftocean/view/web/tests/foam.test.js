// The noise that breaks foam up: distributed normally, or coverage would not keep its mean.
import test from 'node:test';
import assert from 'node:assert/strict';
import { breakUpNoise, normalQuantile } from '../src/foam.js';

test('has the quantiles of the normal distribution', () => {
  // Abramowitz & Stegun, table 26.1: P(1) = .8413447461, P(2) = .9772498681, P(3) = .9986501020
  for (const [x, share] of [
    [0, 0.5],
    [1, 0.8413447461],
    [2, 0.9772498681],
    [3, 0.998650102],
  ]) {
    assert.ok(Math.abs(normalQuantile(share) - x) < 1e-6);
    assert.ok(Math.abs(normalQuantile(1 - share) + x) < 1e-6);
  }
});

test('is distributed normally', () => {
  const noise = breakUpNoise(64);
  const mean = noise.reduce((a, b) => a + b) / noise.length;
  const variance = noise.reduce((a, b) => a + b * b, 0) / noise.length;
  assert.ok(Math.abs(mean) < 1e-4);
  assert.ok(Math.abs(variance - 1) < 2e-3);
  for (const [x, share] of [
    [-1, 0.1587],
    [1.5, 0.9332],
  ]) {
    const below = noise.filter((value) => value < x).length / noise.length;
    assert.ok(Math.abs(below - share) < 1e-3);
  }
});

test('repeats without a seam', () => {
  const n = 64;
  const noise = breakUpNoise(n);
  let [seam, inside] = [0, 0];
  for (let j = 0; j < n; j++) {
    seam += (noise[j * n] - noise[j * n + n - 1]) ** 2;
    inside += (noise[j * n + 30] - noise[j * n + 31]) ** 2;
  }
  assert.ok(seam < 2 * inside);
});
