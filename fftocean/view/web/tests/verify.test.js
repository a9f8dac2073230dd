import assert from 'node:assert/strict';
import test from 'node:test';
import { FIELDS } from '../src/container.js';
import { relativeError, verifyTile, whyNotExact } from '../src/verify.js';

/** Return a simulation of one tile of 2 x 2 whose every field is (1, 2, 3, 4) plus the tick. */
function simulation(more = {}) {
  const shown = {
    kind: 'gpu',
    weight: 1,
    tick: 0,
    tiles: [{ nx: 2, ny: 2 }],
    document: { ticks: 64, id: 3, quality: 'exact' },
    async readFields() {
      const values = Float32Array.from([1, 2, 3, 4], (value) => value + this.tick);
      return Object.fromEntries(FIELDS.map((name) => [name, values]));
    },
    ...more,
  };
  return shown;
}

/** Return a reference answer for it; `change` alters the heights. */
function reference(header = {}, change = (value) => value) {
  const fields = Object.fromEntries(FIELDS.map((name) => [name, Float32Array.of(1, 2, 3, 4)]));
  fields.height = fields.height.map(change);
  return { header: { tick: 0, ticks: 64, tile: 0, nx: 2, ny: 2, sea: 3, ...header }, fields };
}

test('the relative error is the norm of the difference over that of the reference', () => {
  assert.equal(relativeError([3, 4, 1], [3, 4, 0]), 1 / 5);
  assert.equal(relativeError([0, 0], [0, 0]), 0);
  assert.equal(relativeError([3, 4], [0, 0]), 5);
  assert.equal(relativeError([NaN], [1]), Infinity);
  assert.equal(relativeError([1], [1, 2]), Infinity);
});

test('equal fields pass, and one that is a little off fails by name', async () => {
  const good = await verifyTile(simulation(), reference());
  assert.deepEqual([good.passed, good.worst, good.limit], [true, 0, 5e-7]);
  const bad = await verifyTile(
    simulation(),
    reference({}, (v) => v * (1 + 1e-6)),
  );
  assert.equal(bad.passed, false);
  assert.ok(bad.errors.height > 5e-7 && bad.errors.slope_x === 0);
});

for (const header of [{ tick: 1 }, { ticks: 32 }, { sea: 4 }, { nx: 4 }, { tile: 1 }]) {
  test(`a reference with ${JSON.stringify(header)} is refused`, async () => {
    const [name, value] = Object.entries(header)[0];
    await assert.rejects(verifyTile(simulation(), reference(header)), {
      message: new RegExp(`${name} .*got ${value}`),
    });
  });
}

test('only one exact sea alone can be verified', async () => {
  assert.equal(whyNotExact(simulation()), '');
  for (const more of [
    { weight: 0.5 },
    { reduced: true },
    { document: { quality: 'moving', ticks: 64 } },
  ]) {
    assert.notEqual(whyNotExact(simulation(more)), '');
    await assert.rejects(verifyTile(simulation(more), reference()), /nothing to verify/);
  }
});
