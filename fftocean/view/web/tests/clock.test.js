import assert from 'node:assert/strict';
import test from 'node:test';
import { Clock } from '../src/clock.js';

const LOOP = { loop: 64, ticks: 2 ** 20 };

test('a clock shows the whole tick of the time that has passed', () => {
  const clock = new Clock(LOOP);
  assert.equal(clock.update(5000), 0); // the first call sets the beginning
  assert.equal(clock.update(6000), 1);
  assert.equal(clock.tick, 2 ** 20 / 64);
  clock.update(5000 + 64000);
  assert.equal(clock.tick, 0);
  assert.equal(clock.seconds, 0);
});

test('ticks stay exact after 1e9 seconds', () => {
  const clock = new Clock(LOOP);
  clock.update(0);
  clock.update(1e12); // 1e9 s = 15,625,000 loops
  assert.equal(clock.tick, 0);
  clock.update(1e12 + 250);
  assert.equal(clock.tick, 2 ** 12);
  clock.update(2e12 + 350); // at once
  assert.equal(clock.tick, Math.floor(0.35 * 2 ** 14));
});

test('frames of a 64th of a second do not drift', () => {
  const clock = new Clock(LOOP);
  for (let frame = 0; frame < 100000; frame++) clock.advance(1 / 64);
  assert.equal(clock.tick, ((100000 / 64) % 64) * 2 ** 14);
});

test('a pause takes no time, and the time scale may be negative', () => {
  const clock = new Clock(LOOP);
  clock.update(0);
  clock.paused = true;
  assert.equal(clock.update(10000), 0);
  clock.paused = false;
  clock.scale = -2;
  assert.equal(clock.update(10500), -1);
  assert.equal(clock.seconds, 63);
  clock.scale = 0.5;
  clock.update(12500);
  assert.equal(clock.tick, 0);
});

test('a tick can be set, and any whole number is one of the loop', () => {
  const clock = new Clock(LOOP);
  for (const [given, shown] of [
    [7, 7],
    [2 ** 20 + 3, 3],
    [-1, 2 ** 20 - 1],
    [2 ** 40 + 1, 1],
  ]) {
    clock.tick = given;
    assert.equal(clock.tick, shown);
  }
});

test('another loop keeps the time', () => {
  const clock = new Clock(LOOP);
  clock.advance(20);
  clock.follow({ loop: 80, ticks: 2 ** 18 });
  assert.equal(clock.seconds, 20);
  assert.equal(clock.tick, 2 ** 16);
  clock.follow({ loop: 16, ticks: 2 ** 18 });
  assert.equal(clock.seconds, 4);
});

test('a tick stays below the number of ticks', () => {
  const clock = new Clock(LOOP);
  clock.advance(-1e-30);
  assert.ok(clock.tick < 2 ** 20);
});
