// The parameter table as controls: steps, slider positions, texts, and what a field accepts.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { controlsModel } from '../src/controls.js';
import {
  defaults,
  numberText,
  parsed,
  position,
  POSITIONS,
  readTable,
  stepped,
  valueAt,
  valueText,
} from '../src/table.js';
import { ANSWER } from './helpers/table.js';

const { parameters } = readTable(ANSWER);
const row = (name) => parameters.find((one) => one.name === name);

test('the model has each parameter once, with label, unit, range and keys', () => {
  const model = controlsModel(parameters);
  assert.deepEqual(
    model.map(({ title }) => title),
    ['Wind', 'Water', 'Tiles', 'View'],
  );
  const controls = model.flatMap((group) => group.controls);
  assert.deepEqual(
    controls.map((one) => one.row.name),
    ANSWER.parameters.map((one) => one.name),
  );
  for (const { label } of controls) assert.match(label, /^[A-Z0-9]/);
  const [wind, direction, fetch, depth, , seed] = controls;
  assert.deepEqual([wind.unit, wind.range, wind.keys], ['m/s', ['0', '40'], ['O', 'P']]);
  assert.equal(direction.unit, '°');
  assert.deepEqual([fetch.unit, fetch.range], ['km', ['0.1', '5000']]);
  assert.deepEqual(depth.range, ['1', '∞']);
  assert.equal(wind.slider, true);
  assert.equal(seed.slider, false); // a slider cannot hit one of a million
});

test('defaults are those of the table', () => {
  assert.equal(defaults(parameters).wind_speed, 11);
  assert.equal(defaults(parameters).depth, null);
});

test('steps stay on the grid and inside the range', () => {
  const wind = row('wind_speed');
  assert.equal(stepped(wind, 11, 1), 11.5);
  assert.equal(stepped(wind, 11.2, -1), 10.5);
  assert.equal(stepped(wind, 40, 1), 40);
  assert.equal(stepped(wind, 0, -1), 0);
  assert.equal(stepped({ ...wind, step: 0.25 }, 1, 1), 1.25); // quarters need two decimals
  let value = 0;
  for (let i = 0; i < 22; i++) value = stepped(wind, value, 1);
  assert.equal(value, 11); // no rounding errors add up
});

test('an angle wraps over its two equal ends, a count over both of its different ones', () => {
  const angle = row('wind_direction');
  assert.equal(stepped(angle, 355, 1), 360);
  assert.equal(stepped(angle, 360, 1), 5);
  assert.equal(stepped(angle, 0, -1), 355);
  const tiles = row('tiles');
  assert.deepEqual(
    [1, 2, 3, 4].map((count) => stepped(tiles, count, 1)),
    [2, 3, 4, 1],
  );
  assert.equal(stepped(tiles, 1, -1), 4);
  assert.equal(stepped(row('seed'), 999999, 1), 0);
});

test('choices and switches go round', () => {
  const view = row('view');
  assert.equal(stepped(view, 'slopes', 1), 'sea');
  assert.equal(stepped(view, 'sea', -1), 'slopes');
  assert.equal(stepped(row('buoy'), false, 1), true);
});

test('a logarithmic step is the factor of the table', () => {
  const fetch = row('fetch');
  assert.equal(stepped(fetch, 100e3, 1), 120e3);
  assert.equal(stepped(fetch, 5e6, 1), 5e6);
  const depth = row('depth');
  assert.equal(stepped(depth, 1000, 1), null);
  assert.equal(stepped(depth, null, 1), null);
  assert.equal(stepped(depth, null, -1), 1000);
});

test('slider positions give their values back', () => {
  for (const one of parameters.filter(({ kind }) => kind === 'number')) {
    for (const place of [0, 1, 250, 500, 999, POSITIONS]) {
      const value = valueAt(one, place);
      if (value !== null) assert.ok(value >= one.low && value <= one.high, `${one.name} ${value}`);
      const again = valueAt(one, position(one, value));
      assert.equal(again, value, `${one.name} at ${place}`);
    }
    assert.equal(valueAt(one, 0), one.low);
    assert.equal(valueAt(one, POSITIONS), one.infinite ? null : one.high);
  }
});

test('texts have the unit, and no zeros at their end', () => {
  assert.equal(valueText(row('wind_speed'), 11), '11 m/s');
  assert.equal(valueText(row('wind_direction'), 30), '30°');
  assert.equal(valueText(row('fetch'), 150e3), '150 km');
  assert.equal(valueText(row('depth'), null), 'deep water');
  assert.equal(numberText(row('depth'), null), '∞');
  assert.equal(numberText(row('wind_speed'), 0.1 + 0.2), '0.3');
});

test('a field takes numbers of the range, and nothing else', () => {
  const wind = row('wind_speed');
  assert.equal(parsed(wind, ' 12,5 '), 12.5);
  assert.equal(parsed(row('fetch'), '150'), 150e3);
  for (const text of ['', 'abc', '41', '-1', 'NaN', 'Infinity', '1e999', '0x']) {
    assert.equal(parsed(wind, text), undefined, text);
  }
  assert.equal(parsed(row('depth'), 'deep'), null);
  assert.equal(parsed(row('depth'), '∞'), null);
  assert.equal(parsed(row('tiles'), '2.5'), undefined);
});
