import assert from 'node:assert/strict';
import test from 'node:test';
import { decodeSea } from '../src/container.js';
import { Tile } from '../src/evolve.js';
import { reduced } from '../src/worker_simulation.js';
import { container } from './helpers/seas.js';

const LONG = [
  [1, 0, 3, 0.25, -0.125],
  [-3, 2, 7, 0.05, -0.3],
];
const SHORT = [
  [4, 0, 9, 0.5, 0],
  [-2, -6, 9, 0, 0.25],
];
const slope_variance = { captured: [5, 5, 5], total: [6, 6, 6], beyond: [1, 1, 1] };

/** Return a sea of 16 x 16 samples on 2 pi x pi metres, where kx = mx and ky = 2 my. */
function sea(waves) {
  const tile = { n: [16, 16], size: [2 * Math.PI, Math.PI], waves };
  return decodeSea(container([tile], { slope_variance }));
}

test('half the samples show the same long waves', () => {
  const whole = sea(LONG);
  const { sea: less, lost } = reduced(whole, 8);
  assert.equal(lost, 0);
  assert.equal(less.document, whole.document);
  const [many, few] = [whole, less].map(({ tiles }) => new Tile(tiles[0]).fields(321, 1024));
  for (const name of Object.keys(few)) {
    assert.equal(few[name].length, 64);
    few[name].forEach((value, i) => {
      const same = many[name][2 * (i >> 3) * 16 + 2 * (i & 7)];
      assert.ok(Math.abs(value - same) < 1e-12);
    });
  }
});

test('waves that are left out are counted, and their slopes are beyond the tiles', () => {
  const { sea: less, lost } = reduced(sea([...LONG, ...SHORT]), 8);
  assert.equal(lost, 2);
  // a^2/2 of the waves are 0.5 and 0.125, their wavenumbers (4, 0) and (-2, -12)
  const slopes = [0.5 * 16 + 0.125 * 4, 0.125 * 144, 0.125 * 24];
  assert.deepEqual(less.document.slope_variance, {
    captured: slopes.map((s) => 5 - s),
    total: [6, 6, 6],
    beyond: slopes.map((s) => 1 + s),
  });
  assert.deepEqual(less.tiles[0].h0, reduced(sea(LONG), 8).sea.tiles[0].h0);
});

test('a sea that fits is kept as it is', () => {
  const whole = sea(LONG);
  const { sea: same, lost } = reduced(whole, 16);
  assert.equal(lost, 0);
  assert.equal(same.tiles[0], whole.tiles[0]);
});
