import assert from 'node:assert/strict';
import test from 'node:test';
import { decodeFrame, MOST_REQUESTS, Playback } from '../src/playback.js';

const TICKS = 2 ** 20;

/** Return a graphics context that does nothing, and lists what is uploaded to level 0. */
function silent() {
  const uploads = [];
  const given = {
    uploads,
    isContextLost: () => false,
    texSubImage2D: (...values) => uploads.push(values.at(-1)),
    getParameter: () => 16,
  };
  return new Proxy(given, { get: (own, name) => own[name] ?? (() => ({})) });
}

/** Return the bytes of a frame, whose numbers are all its own number, at some offset. */
function message(tile, frame, [nx, ny] = [4, 2], { offset = 0, cut = 0 } = {}) {
  const header = new TextEncoder().encode(
    JSON.stringify({ tile, frame, nx, ny, lx: 1, ly: 1 }).padEnd(96),
  );
  const padded = Math.ceil((8 * nx * ny) / 16) * 16;
  const bytes = new Uint8Array(offset + 16 + header.length + 3 * padded);
  const view = new DataView(bytes.buffer, offset);
  bytes.set(new TextEncoder().encode('FFTB'), offset);
  view.setUint32(4, 1, true);
  view.setUint32(8, header.length, true);
  bytes.set(header, offset + 16);
  for (let map = 0; map < 3; map++) {
    for (let i = 0; i < 4 * nx * ny; i++) {
      view.setUint16(16 + header.length + map * padded + 2 * i, 100 * map + frame, true);
    }
  }
  return new DataView(bytes.buffer, offset, bytes.length - offset - cut);
}

/** Return a playback of some frames, what it asks for, and a clock. */
function playing(frames, options = {}, tiles = 1) {
  const asked = [];
  const clock = { now: 0 };
  const gl = silent();
  const manifest = {
    frames,
    ticks: TICKS,
    tiles: Array.from({ length: tiles }, () => ({ n: [4, 2], size: [1, 1] })),
  };
  const playback = new Playback(gl, manifest, (tile, frame) => void asked.push([tile, frame]), {
    now: () => clock.now,
    ...options,
  });
  return { playback, asked, clock, gl };
}

/** Return the tick at which a frame of a number of frames begins. */
const tickOf = (frame, frames) => Math.ceil((frame * TICKS) / frames);

test('a frame is decoded wherever it lies in its buffer', () => {
  for (const offset of [0, 1, 2, 7]) {
    const { tile, frame, nx, ny, maps } = decodeFrame(message(2, 5, [3, 3], { offset }));
    assert.deepEqual([tile, frame, nx, ny], [2, 5, 3, 3]);
    maps.forEach((map, i) => assert.deepEqual([...map], Array(36).fill(100 * i + 5)));
  }
  assert.throws(() => decodeFrame(message(0, 0, [4, 2], { cut: 1 })), /must have 192 bytes/);
});

test('frames are asked for in the order in which they are shown', () => {
  const { playback, asked } = playing(100, { memory: 5 * 24 * 8 });
  assert.deepEqual(
    asked,
    [0, 1, 2, 3, 4].map((frame) => [0, frame]),
  );
  for (const frame of [0, 1, 2, 3, 4]) playback.receive(message(0, frame));
  assert.equal(playback.frames.size, 5);
  playback.step(tickOf(2, 100));
  assert.deepEqual(asked.slice(5), [
    [0, 5],
    [0, 6],
  ]);
  assert.deepEqual([...playback.frames.keys()], [2, 3, 4]); // those that were shown are forgotten
});

test('requests and memory are bounded', () => {
  const { playback, asked } = playing(1000, {}, 3);
  assert.equal(asked.length, MOST_REQUESTS);
  for (let frame = 0; frame < 1000; frame++) {
    playback.step(tickOf(frame, 1000));
    while (asked.length) playback.receive(message(...asked.pop()));
  }
  assert.ok(playback.frames.size <= playback.ahead);
  const few = playing(1000, { memory: 0 }).playback;
  assert.equal(few.ahead, 2);
});

test('a bake that fits into memory is asked for once', () => {
  const { playback, asked } = playing(6);
  for (let round = 0; round < 3; round++) {
    for (let frame = 0; frame < 6; frame++) {
      playback.step(tickOf(frame, 6));
      for (const [tile, number] of asked.splice(0)) playback.receive(message(tile, number));
      playback.step(tickOf(frame, 6));
      assert.equal(playback.shownFrame, frame);
      if (round > 0) assert.equal(asked.length, 0);
    }
  }
});

test('the last frame stays until the next has come, and late ones are dropped', () => {
  let changes = 0;
  const { playback, asked } = playing(50, {
    memory: 3 * 24 * 8,
    onChange: () => (changes += 1),
  });
  playback.receive(message(0, 0));
  playback.step(0);
  assert.equal(playback.shownFrame, 0);
  playback.step(tickOf(10, 50));
  assert.equal(playback.shownFrame, 0);
  assert.deepEqual(asked.slice(3), [
    [0, 10],
    [0, 11],
    [0, 12],
  ]);
  assert.equal(changes, 1);
  playback.receive(message(0, 1));
  assert.equal(playback.frames.has(1), false);
  assert.equal(changes, 1);
  playback.receive(message(0, 10));
  playback.step(tickOf(10, 50));
  assert.equal(playback.shownFrame, 10);
});

test('a frame without an answer is asked for again, later each time, and then left out', () => {
  const { playback, asked, clock } = playing(2, {});
  asked.length = 0;
  const times = [];
  for (clock.now = 0; clock.now < 3e5; clock.now += 500) {
    playback.step(0);
    for (const [, frame] of asked.splice(0)) if (frame === 0) times.push(clock.now);
  }
  assert.deepEqual(times, [2000, 6000, 14000, 30000]);
});

test('a frame of several tiles is shown when all have come', () => {
  const { playback, gl } = playing(4, {}, 2);
  playback.receive(message(0, 0));
  playback.step(0);
  assert.equal(playback.shownFrame, null);
  playback.receive(message(1, 0));
  playback.step(0);
  assert.equal(playback.shownFrame, 0);
  assert.equal(gl.uploads.length, 6);
  playback.step(1);
  assert.equal(gl.uploads.length, 6); // the same frame is not uploaded again
  assert.throws(() => playback.receive(message(2, 0)), /a frame of tile 2/);
  assert.throws(() => playback.receive(message(1, 1, [8, 8])), /got 8 x 8/);
});

test('answers may be promises, and a failed one is told', async () => {
  const gl = silent();
  const manifest = { frames: 2, ticks: TICKS, tiles: [{ n: [4, 2], size: [1, 1] }] };
  const playback = new Playback(gl, manifest, async (tile, frame) => {
    if (frame === 1) throw new Error('frame 1 is damaged');
    return message(tile, frame);
  });
  await new Promise((resolve) => setTimeout(resolve, 5));
  playback.step(0);
  assert.equal(playback.shownFrame, 0);
  assert.equal(playback.note, 'frame 1 is damaged');
  playback.dispose();
});
