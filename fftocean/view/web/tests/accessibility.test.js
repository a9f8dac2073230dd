// The sea in words, by the scales of the WMO; contrast by the formula of WCAG.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { beaufort, compassName, contrast, describeSea, seaState } from '../src/accessibility.js';
import { Announcer } from '../src/announcer.js';

const SEA = {
  depth: null,
  wind: { speed: 11, direction: 30 },
  statistics: { realised: { hs: 2.14, tp: 6.8, direction: 67.5 } },
};

test('Beaufort numbers and sea states are those of the tables of the WMO', () => {
  for (const [speed, number, name] of [
    [0, 0, 'calm'],
    [0.3, 1, 'light air'],
    [11, 6, 'strong breeze'],
    [20, 8, 'gale'],
    [32.7, 12, 'hurricane'],
    [60, 12, 'hurricane'],
  ]) {
    assert.deepEqual(beaufort(speed), { number, name });
  }
  for (const [height, number, name] of [
    [0, 0, 'glassy'],
    [0.1, 1, 'rippled'],
    [1.25, 3, 'slight'],
    [2.14, 4, 'moderate'],
    [14, 8, 'very high'],
    [15, 9, 'phenomenal'],
  ]) {
    assert.deepEqual(seaState(height), { number, name });
  }
});

test('directions are counter-clockwise from east', () => {
  assert.deepEqual([0, 90, 180, 270, 45, -45, 360, 348.76].map(compassName), [
    'east',
    'north',
    'west',
    'south',
    'north-east',
    'south-east',
    'east',
    'east',
  ]);
});

test('the sentence has height, period, direction, wind and light', () => {
  const text = describeSea({ document: SEA, look: { sunElevation: 1 }, paused: true });
  assert.equal(
    text,
    'A moderate sea, significant wave height 2.1 metres, peak period 6.8 seconds, running toward ' +
      'the north-north-east. Wind of 11 metres per second toward the east-north-east, Beaufort 6, ' +
      'strong breeze. The sun stands 1 degree above the horizon. Time stands still.',
  );
});

test('what is not known is not said', () => {
  assert.equal(describeSea({ document: null }), 'A sea.');
  const flat = { ...SEA, wind: null, statistics: { specified: { hs: 0 }, realised: null } };
  assert.equal(describeSea({ document: flat }), 'A flat sea without waves.');
  const given = { ...SEA, wind: null, statistics: { specified: null, realised: { hs: 1 } } };
  assert.equal(
    describeSea({ document: given, playback: true }),
    'A recorded sea is played. A slight sea, significant wave height 1 metre.',
  );
  assert.match(describeSea({ document: { ...SEA, depth: 12 } }), /water is 12 metres deep/);
});

test('a text is said once, and only the last of several', (t) => {
  t.mock.timers.enable({ apis: ['setTimeout'] });
  const said = [];
  const region = {
    set textContent(text) {
      said.push(text);
    },
  };
  const announcer = new Announcer(region, 1);
  announcer.say('one');
  announcer.say('two');
  t.mock.timers.tick(999);
  assert.deepEqual(said, []);
  t.mock.timers.tick(1);
  announcer.say('two');
  t.mock.timers.tick(5000);
  assert.deepEqual(said, ['two']);
});

test('contrast of black and white is 21, of equal colours 1, of #767676 on white 4.54', () => {
  assert.equal(contrast([0, 0, 0], [255, 255, 255]), 21);
  assert.equal(contrast([9, 9, 9], [9, 9, 9]), 1);
  assert.equal(contrast([118, 118, 118], [255, 255, 255]).toFixed(2), '4.54');
});

test('small numbers keep two digits, and one unit is in the singular', () => {
  const said = (statistics, more) => describeSea({ document: { statistics, ...more } });
  assert.match(said({ realised: { hs: 0.02 } }), /wave height 0\.02 metres\./);
  assert.match(said({ realised: { hs: 2, tp: 1 } }), /peak period 1 second\./);
  assert.match(said({}, { wind: { speed: 1 } }), /Wind of 1 metre per second, Beaufort 1/);
  assert.match(said({}, { depth: 1 }), /water is 1 metre deep/);
});
