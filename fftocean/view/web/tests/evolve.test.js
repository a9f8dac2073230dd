import assert from 'node:assert/strict';
import test from 'node:test';
import { FIELDS, decodeSea } from '../src/container.js';
import { Tile, mapsOf } from '../src/evolve.js';
import { WAVES, container, directSum } from './helpers/seas.js';

/** Return the value of a half float. */
function half(bits) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  return sign * (exponent ? (1 + fraction / 1024) * 2 ** (exponent - 15) : fraction * 2 ** -24);
}

for (const depth of [null, 4]) {
  test(`the fields equal the direct sum of the waves, depth ${depth}`, () => {
    const [n, size] = [
      [16, 8],
      [50, 20],
    ];
    const sea = decodeSea(container([{ n, size, waves: WAVES }], { depth }));
    const tile = new Tile(sea.tiles[0]);
    for (const tick of [0, 1, 333, 1023, 1024]) {
      const fields = tile.fields(tick, 1024);
      for (let y = 0; y < n[1]; y++) {
        for (let x = 0; x < n[0]; x++) {
          const place = [(x * size[0]) / n[0], (y * size[1]) / n[1]];
          const expected = directSum(WAVES, size, depth ?? Infinity, place, tick / 1024);
          for (const name of FIELDS) {
            // 1/(k tanh kh) is a float32; the largest stretch is about 2.
            const apart = Math.abs(fields[name][y * n[0] + x] - expected[name]);
            assert.ok(apart < 3e-7, `${name} at ${x}, ${y}, tick ${tick}: ${apart}`);
          }
        }
      }
    }
  });
}

test('the first tick and the one after the last give equal bits', () => {
  const sea = decodeSea(container([{ n: [8, 8], size: [30, 30], waves: WAVES }]));
  const tile = new Tile(sea.tiles[0]);
  const first = Object.values(tile.fields(0, 1024)).map((field) => field.slice());
  assert.deepEqual(Object.values(tile.fields(1024, 1024)), first);
});

test('two sets of amplitudes add up with their scales', () => {
  const [one, other] = [WAVES, WAVES.map(([mx, my, c, re, im]) => [mx, my, c, im, 2 * re])].map(
    (waves) => decodeSea(container([{ n: [8, 8], size: [30, 30], waves }])).tiles[0],
  );
  const alone = [one, other].map((tile) => new Tile(tile).fields(77, 1024));
  const sum = new Tile(other, one).fields(77, 1024, 0.25, 0.75);
  for (const name of FIELDS) {
    for (let i = 0; i < 64; i++) {
      const expected = 0.75 * alone[0][name][i] + 0.25 * alone[1][name][i];
      assert.ok(Math.abs(sum[name][i] - expected) < 1e-12);
    }
  }
});

test('maps hold the fields with choppiness, and their levels the averages', () => {
  const [nx, ny] = [4, 2];
  const fields = {};
  FIELDS.forEach((name, f) => {
    fields[name] = Float64Array.from({ length: nx * ny }, (_, i) => (f + 1) * (i + 1) * 0.125);
  });
  const maps = mapsOf(fields, nx, ny, 2);
  const texel = (name, level, i) => [...maps[name][level].subarray(4 * i, 4 * i + 4)].map(half);
  assert.deepEqual(
    Object.values(maps).map((levels) => levels.map((level) => level.length / 4)),
    [
      [8, 2, 1],
      [8, 2, 1],
      [8, 2, 1],
    ],
  );
  // displace_x, displace_y, height, stretch_xy are 1, 2, 3, 4 eighths of i + 1; and so on
  assert.deepEqual(texel('displacement', 0, 5), [1.5, 3, 2.25, 6]);
  assert.deepEqual(texel('slopes', 0, 1), [1.25, 1.5, 3.5, 4]);
  assert.deepEqual(texel('moments', 0, 1), [1.25 ** 2, 1.5 ** 2, 1.25 * 1.5, 0]);
  // (1 + 2 + 5 + 6)/4 and (1 + ... + 8)/8 eighths of the height's three
  assert.equal(texel('displacement', 1, 0)[2], (3.5 * 3) / 8);
  assert.equal(texel('displacement', 2, 0)[2], (4.5 * 3) / 8);
});

test('a tall tile has levels down to one texel too', () => {
  const fields = Object.fromEntries(FIELDS.map((name) => [name, Float64Array.of(1, 2, 3, 6)]));
  const { displacement } = mapsOf(fields, 1, 4, 1);
  assert.deepEqual(
    displacement.map((level) => [...level].filter((_, i) => i % 4 === 2).map(half)),
    [[1, 2, 3, 6], [1.5, 4.5], [3]],
  );
});
