import assert from 'node:assert/strict';
import test from 'node:test';
import { Fourier, twiddleTable } from '../src/fft.js';
import { randoms } from './helpers/seas.js';

for (const [nx, ny] of [
  [2, 2],
  [8, 4],
  [4, 16],
  [32, 8],
]) {
  test(`a transform of ${nx} x ${ny} equals the direct sum`, () => {
    const samples = nx * ny;
    const [re, im] = [1, 2].map((seed) =>
      Float64Array.from(randoms(samples, seed), (v) => v - 0.5),
    );
    const [gotRe, gotIm] = [re.slice(), im.slice()];
    new Fourier(nx, ny).inverse(gotRe, gotIm);
    for (let y = 0; y < ny; y++) {
      for (let x = 0; x < nx; x++) {
        let [a, b] = [0, 0];
        for (let j = 0; j < ny; j++) {
          for (let i = 0; i < nx; i++) {
            const angle = 2 * Math.PI * ((i * x) / nx + (j * y) / ny);
            const [c, s] = [Math.cos(angle), Math.sin(angle)];
            a += re[j * nx + i] * c - im[j * nx + i] * s;
            b += re[j * nx + i] * s + im[j * nx + i] * c;
          }
        }
        // Sums of `samples` numbers below 1 in double precision.
        assert.ok(Math.abs(gotRe[y * nx + x] - a) < samples * 1e-14);
        assert.ok(Math.abs(gotIm[y * nx + x] - b) < samples * 1e-14);
      }
    }
  });
}

test('twiddle factors at quarters of a turn are exact', () => {
  assert.deepEqual([...twiddleTable(4)], [1, 0, 0, 1, -1, 0, 0, -1]);
  assert.deepEqual([...twiddleTable(2)], [1, 0, -1, 0]);
});
