import assert from 'node:assert/strict';
import test from 'node:test';
import { FIELDS, decodeReference, decodeSea, kindOf } from '../src/container.js';
import { container, message } from './helpers/seas.js';

const TILE = { n: [8, 4], size: [40, 10], waves: [[-3, 1, 9, 0.5, -0.25]] };

test('a wave is at +k with its amplitude, and at -k with the conjugate of it', () => {
  const { tiles } = decodeSea(container([TILE]));
  const { h0, wave, nx, ny, lx, ly } = tiles[0];
  assert.deepEqual([nx, ny, lx, ly], [8, 4, 40, 10]);
  const here = 1 * 8 + 5; // my = 1, mx = -3
  const opposite = 3 * 8 + 3; // my = -1, mx = 3
  const expected = new Float32Array(4 * 8 * 4);
  expected.set([0.5, -0.25], 4 * here);
  expected.set([0.5, 0.25], 4 * opposite + 2);
  assert.deepEqual(h0, expected);
  const cycles = Array.from({ length: 32 }, (_, i) => wave[2 * i]);
  assert.deepEqual([cycles[here], cycles[opposite]], [9, 9]);
  assert.equal(cycles.filter(Boolean).length, 2);
});

test('opposite waves share both entries', () => {
  const waves = [
    [1, 1, 4, 1, 2],
    [-1, -1, 4, 3, 4],
  ];
  const { h0 } = decodeSea(container([{ ...TILE, waves }])).tiles[0];
  assert.deepEqual([...h0.subarray(4 * 9, 4 * 9 + 4)], [1, 2, 3, -4]);
  assert.deepEqual([...h0.subarray(4 * 31, 4 * 31 + 4)], [3, 4, 1, -2]);
});

for (const depth of [null, 2]) {
  test(`the factors of the displacement potential are those of the depth ${depth}`, () => {
    const { wave } = decodeSea(container([TILE], { depth })).tiles[0];
    const k = Math.hypot((2 * Math.PI * 3) / 40, (2 * Math.PI) / 10);
    const expected = 1 / (k * Math.tanh(k * (depth ?? Infinity)));
    assert.equal(wave[2 * (8 + 5) + 1], Math.fround(expected));
    assert.equal(wave[1], 0);
  });
}

test('files follow each other with their padding, in a view that does not begin at 0', () => {
  const check = { name: 'check.json', bytes: Buffer.from('{"moments":[0]}') };
  const other = { ...TILE, waves: [[1, 0, 2, 1, 0]] };
  const bytes = container([TILE, other], { extra: [check] });
  const shifted = new Uint8Array(bytes.length + 3);
  shifted.set(bytes, 3);
  const sea = decodeSea(new DataView(shifted.buffer, 3));
  assert.equal(sea.tiles[1].h0[4], 1);
  assert.deepEqual(sea.reference, { moments: [0] });
  assert.equal(decodeSea(container([TILE])).reference, null);
  assert.equal(kindOf(shifted.subarray(3)), 'FFTO');
});

test('lifts bring the second of two fields to the size of the first, in powers of two', () => {
  const lifts = (size, waves) => decodeSea(container([{ ...TILE, size, waves }])).tiles[0].lifts;
  const wave = (mx, my) => [[mx, my, 4, 0.3, 0.4]];
  // displacements are as kx : ky, height and stretch_xy as k : kx ky, here sqrt(2) : 1 times 2,
  // 1/2 and 32 metres; slopes as kx : ky, stretches as kx^2 : ky^2
  assert.deepEqual(lifts([4 * Math.PI, 4 * Math.PI], wave(1, 1)), [1, 4, 1, 1]);
  assert.deepEqual(lifts([Math.PI, Math.PI], wave(1, 1)), [1, 1, 1, 1]);
  assert.deepEqual(lifts([64 * Math.PI, 64 * Math.PI], wave(1, 1)), [1, 64, 1, 1]);
  assert.deepEqual(lifts([2 * Math.PI, 8 * Math.PI], wave(1, 1)), [4, 4, 4, 16]);
  // waves along an axis have no displacement, slope or stretch across it
  assert.deepEqual(lifts([4, 4], wave(1, 0)), [2 ** 40, 2 ** 40, 2 ** 40, 2 ** 40]);
  assert.deepEqual(lifts([4, 4], wave(0, 1)), [2 ** -40, 2 ** 40, 2 ** -40, 2 ** -40]);
  assert.deepEqual(lifts([4, 4], []), [1, 1, 1, 1]);
});

test('a reference answer is a list of fields by name', () => {
  const numbers = Float32Array.from({ length: 8 * 6 }, (_, i) => i / 4);
  const header = { tick: 5, ticks: 64, tile: 0, nx: 3, ny: 2, fields: FIELDS, sea: 7 };
  const answer = decodeReference(message('FFTR', header, Buffer.from(numbers.buffer)));
  assert.deepEqual(answer.header, header);
  assert.deepEqual([...answer.fields.height], [3, 3.25, 3.5, 3.75, 4, 4.25]);
});

const REFUSED = {
  'must begin with FFTO': message('FFTX', {}),
  'version of the data must be 1, got 2': container([TILE]).fill(2, 4, 5),
  'header must end within': container([TILE]).subarray(0, 64),
  'format must be fftocean-runtime 1, got fftocean-runtime 2': container([TILE], { version: 2 }),
  'ticks must be a power of two, got 1000: the next one is 1024': container([TILE], {
    ticks: 1000,
  }),
  'n must be a power of two, got 100: the next one is 128': container([{ ...TILE, n: [128, 100] }]),
  'a wave must have |mx| < 4 and |my| < 2, got (-4, 0)': container([
    { ...TILE, waves: [[-4, 0, 1, 1, 1]] },
  ]),
  'the data ends within tile0.waves': container([TILE]).subarray(0, -8),
  'the file tile1.waves is missing': container([TILE], { tiles: [TILE, TILE] }),
};
for (const [message, bytes] of Object.entries(REFUSED)) {
  test(`refused: ${message}`, () => {
    assert.throws(
      () => decodeSea(bytes),
      (error) => error.message.includes(message),
    );
  });
}
