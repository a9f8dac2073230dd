// Files that are dropped on the page, as messages to the server.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { LONGEST_MESSAGE } from '../src/connection.js';
import { base64, fileMessage, LARGEST_FILE } from '../src/files.js';

test('a job goes as text, every other file as base64', () => {
  const text = '[sea.wind]\nspeed = 12.0 # m/s, ° and µ\n';
  assert.deepEqual(fileMessage('A.TOML', new TextEncoder().encode(text)), {
    message: { job: text },
  });
  const bytes = Uint8Array.from({ length: 3000 }, (_, i) => (i * 7) & 255);
  const { message } = fileMessage('buoy <b>.nc', bytes);
  assert.equal(message.file.name, 'buoy <b>.nc');
  assert.deepEqual(new Uint8Array(Buffer.from(message.file.base64, 'base64')), bytes);
  assert.equal(base64(bytes), Buffer.from(bytes).toString('base64'));
});

test('empty, too large and wrongly encoded files are refused with the rule', () => {
  assert.match(fileMessage('a.toml', new Uint8Array(0)).refused, /empty/);
  assert.match(fileMessage('a.nc', new Uint8Array(LARGEST_FILE + 1)).refused, /at most 47 KiB/);
  assert.match(fileMessage('a.toml', Uint8Array.of(0xff, 0xfe)).refused, /UTF-8/);
});

test('the largest file fits into a message', () => {
  const { message } = fileMessage('n'.repeat(255), new Uint8Array(LARGEST_FILE));
  assert.ok(JSON.stringify(message).length <= LONGEST_MESSAGE);
});
