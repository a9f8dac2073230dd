// Keys of the page: what each does, and when it is left alone.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { actionOf, HeldKeys, keyPlan } from '../src/keys.js';
import { readTable } from '../src/table.js';
import { ANSWER } from './helpers/table.js';

const { parameters, actions } = readTable(ANSWER);
const plan = keyPlan(parameters, actions);

/** Return what a key does on the canvas, or with other properties of the event. */
function pressed(key, more = {}) {
  return actionOf({ key, target: { tagName: 'CANVAS' }, ...more }, plan);
}

test('every key of both tables acts', () => {
  const steps = Object.fromEntries(
    ['o', 'p', 'u', 'i', 't', 'r', 'v'].map((key) => {
      const { name, direction } = pressed(key);
      return [key, `${name} ${direction}`];
    }),
  );
  assert.deepEqual(steps, {
    o: 'wind_speed -1',
    p: 'wind_speed 1',
    u: 'wind_direction -1',
    i: 'wind_direction 1',
    t: 'tiles 1',
    r: 'seed 1',
    v: 'view 1',
  });
  assert.deepEqual(pressed(' '), { type: 'act', name: 'pause' });
  assert.deepEqual(pressed('?', { shiftKey: true }), { type: 'act', name: 'help' });
  assert.deepEqual(pressed('w'), { type: 'hold', name: 'forward' });
  assert.deepEqual(pressed('ArrowLeft'), { type: 'hold', name: 'turn_left' });
  assert.equal(pressed('z'), null);
});

test('no two meanings share a key', () => {
  const keys = [
    ...parameters.flatMap(({ keyDown, keyUp }) => [keyDown, keyUp]).filter(Boolean),
    ...actions.map(({ key }) => key),
  ];
  assert.equal(new Set(keys).size, keys.length);
});

test('capital letters act as small ones, and Shift turns a ring round', () => {
  assert.equal(pressed('P', { shiftKey: true }).direction, 1);
  assert.equal(pressed('V', { shiftKey: true }).direction, -1);
});

test('keys are left alone in fields, with modifiers and in a composition', () => {
  for (const tagName of ['INPUT', 'TEXTAREA', 'SELECT']) {
    assert.equal(pressed('p', { target: { tagName } }), null, tagName);
  }
  assert.equal(pressed('p', { target: { tagName: 'DIV', isContentEditable: true } }), null);
  for (const modifier of ['ctrlKey', 'altKey', 'metaKey', 'isComposing', 'defaultPrevented']) {
    assert.equal(pressed('p', { [modifier]: true }), null, modifier);
  }
});

test('the space bar presses the button that has the focus', () => {
  for (const tagName of ['BUTTON', 'SUMMARY', 'A']) {
    assert.equal(pressed(' ', { target: { tagName } }), null, tagName);
    assert.notEqual(pressed('p', { target: { tagName } }), null, tagName);
  }
});

test('a key that is held repeats steps of a range, but no action and no ring', () => {
  assert.notEqual(pressed('p', { repeat: true }), null);
  for (const key of [' ', '?', 'v', 'r']) assert.equal(pressed(key, { repeat: true }), null, key);
});

test('movements last as long as their keys are down', () => {
  const held = new HeldKeys(plan);
  held.press('forward');
  assert.equal(held.axis('forward', 'back'), 1);
  held.press('back');
  assert.equal(held.axis('forward', 'back'), 0);
  held.release('W'); // with Shift the browser names the capital letter
  assert.equal(held.axis('forward', 'back'), -1);
  held.release('p');
  assert.equal(held.any, true);
  held.clear();
  assert.equal(held.any, false);
});
