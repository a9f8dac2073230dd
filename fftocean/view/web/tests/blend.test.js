import assert from 'node:assert/strict';
import test from 'node:test';
import { AmplitudeBlend } from '../src/blend.js';
import { FIELDS, decodeSea } from '../src/container.js';
import { Tile } from '../src/evolve.js';
import { WAVES, container } from './helpers/seas.js';

const TILE = { n: [8, 8], size: [40, 40], waves: WAVES };

/** Return a sea whose waves are changed one by one. */
function sea(change = (wave) => wave, more = {}, tile = TILE) {
  const waves = WAVES.map(([mx, my, cycles, re, im]) => change([mx, my, cycles, re, im]));
  return decodeSea(container([{ ...tile, waves }], more));
}

const higher = ([mx, my, cycles, re, im]) => [mx, my, cycles, 3 * re, 3 * im];
const slower = ([mx, my, cycles, re, im]) => [mx, my, cycles - 1, 2 * re, 2 * im];

/** Return the fields of the first tile that a blend shows at a tick. */
function shown(blend, tick) {
  blend.prepare(tick);
  const tile = new Tile(blend.to[0], blend.from[0]);
  const fields = tile.fields(tick, blend.document.ticks, blend.scaleTo, blend.scaleFrom);
  return Object.fromEntries(FIELDS.map((name) => [name, fields[name].slice()]));
}

/** Return the largest difference of two frames. */
function apart(one, other) {
  return Math.max(
    ...FIELDS.map((name) => Math.max(...one[name].map((v, i) => Math.abs(v - other[name][i])))),
  );
}

const ROUNDING = 1e-6; // of amplitudes in float32; the fields reach about 3

test('amplitudes change linearly in time', () => {
  const [first, second] = [sea(), sea(higher)];
  const blend = new AmplitudeBlend(first);
  const frame = shown(blend, 100);
  blend.replace(second, 0.3);
  for (const [seconds, factor, weight] of [
    [0, 1, 0],
    [0.1, 1 + 2 / 3, 1 / 3],
    [0.05, 2, 0.5],
    [0.2, 3, 1],
    [5, 3, 1],
  ]) {
    blend.advance(seconds);
    const now = shown(blend, 100);
    assert.ok(Math.abs(blend.weight - weight) < 1e-12);
    for (const name of FIELDS) {
      now[name].forEach((v, i) => assert.ok(Math.abs(v - factor * frame[name][i]) < ROUNDING));
    }
  }
});

test('in the end the later sea is shown alone, with its own bits', () => {
  const second = sea(slower, { depth: 3 });
  const blend = new AmplitudeBlend(sea());
  shown(blend, 5);
  blend.replace(second, 0.3);
  shown(blend, 6);
  blend.advance(0.2);
  shown(blend, 7);
  assert.ok(blend.weight < 1);
  blend.advance(0.11);
  assert.deepEqual([blend.weight, blend.scaleFrom, blend.scaleTo], [1, 0, 1]);
  assert.deepEqual(shown(blend, 77), shown(new AmplitudeBlend(second), 77));
  assert.equal(blend.document, second.document);
});

const OTHERS = {
  'other amplitudes': [higher, {}],
  'other cycles and depth': [slower, { depth: 3 }],
  'fewer waves': [([mx, my, c, re, im]) => [mx, my, mx > 0 ? c : 0, re * (mx > 0), im * (mx > 0)]],
};
for (const [name, [change, more]] of Object.entries(OTHERS)) {
  test(`nothing jumps when a sea begins to change: ${name}`, () => {
    const blend = new AmplitudeBlend(sea());
    const before = shown(blend, 100);
    blend.replace(sea(change, more), 0.3);
    assert.ok(apart(shown(blend, 100), before) < ROUNDING);
  });
}

test('nothing jumps when a sea changes again half way', () => {
  const blend = new AmplitudeBlend(sea());
  shown(blend, 100);
  blend.replace(sea(higher), 0.3);
  blend.advance(0.15);
  const half = shown(blend, 200);
  blend.replace(sea(slower), 0.3);
  assert.ok(apart(shown(blend, 200), half) < ROUNDING);
});

test('a change of the loop goes on from the moment that was shown', () => {
  const blend = new AmplitudeBlend(sea());
  const before = shown(blend, 100);
  blend.replace(sea(slower, { loop: 48, ticks: 4096 }), 0.3);
  assert.ok(apart(shown(blend, 3333), before) < ROUNDING);
});

test('a sea that was replaced before it was stepped leaves no trace', () => {
  const blend = new AmplitudeBlend(sea());
  const before = shown(blend, 100);
  blend.replace(sea(slower, { depth: 3, loop: 48 }), 0.3);
  blend.advance(0.2);
  blend.replace(sea(higher), 0.3);
  assert.ok(apart(shown(blend, 100), before) < ROUNDING);
});

for (const [name, tile, count] of [
  ['size', { ...TILE, size: [50, 50] }, 1],
  ['samples', { ...TILE, n: [16, 16] }, 1],
]) {
  test(`tiles of another ${name} rise when the earlier ones have come to rest`, () => {
    const [first, second] = [sea(), sea(undefined, { choppiness: 2 }, tile)];
    const blend = new AmplitudeBlend(first);
    const before = shown(blend, 100);
    blend.replace(second, 0.3);
    assert.ok(apart(shown(blend, 100), before) < ROUNDING);
    blend.advance(0.075);
    const falling = shown(blend, 100);
    assert.equal(blend.weight, 0);
    FIELDS.forEach((field) =>
      before[field].forEach((v, i) => assert.ok(Math.abs(falling[field][i] - v / 2) < ROUNDING)),
    );
    assert.equal(blend.document.choppiness, 1.25);
    assert.equal(blend.newest, second);
    blend.advance(0.075);
    assert.equal(blend.to.length, count);
    assert.deepEqual([blend.sea, blend.scaleFrom, blend.scaleTo], [second, 0, 0]);
    blend.advance(0.15);
    assert.equal(blend.weight, 1);
    assert.equal(blend.document, second.document);
  });
}

test('a sea comes back that was left while it fell', () => {
  const blend = new AmplitudeBlend(sea());
  const before = shown(blend, 100);
  blend.replace(sea(undefined, {}, { ...TILE, size: [50, 50] }), 0.3);
  blend.advance(0.075);
  blend.replace(sea(), 0.3);
  blend.advance(0.3);
  assert.ok(apart(shown(blend, 100), before) < ROUNDING);
});

test('without time for it a sea changes at once', () => {
  const second = sea(higher);
  const blend = new AmplitudeBlend(sea());
  blend.replace(second, 0);
  assert.equal(blend.weight, 1);
  assert.equal(blend.sea, second);
});

test('numbers for shading change with the amplitudes, and nothing else of the document does', () => {
  const numbers = (v) => ({
    choppiness: v,
    slope_variance: { beyond: [v, 2 * v, 0] },
    foam: { threshold: v },
    id: v,
  });
  const blend = new AmplitudeBlend(sea(undefined, numbers(1)));
  blend.replace(sea(higher, numbers(2)), 0.2);
  blend.advance(0.1);
  const { choppiness, slope_variance, foam, id } = blend.document;
  assert.deepEqual({ choppiness, slope_variance, foam, id }, { ...numbers(1.5), id: 2 });
});
