import assert from 'node:assert/strict';
import test from 'node:test';
import { deflateSync } from 'node:zlib';
import { bytesOf, inflated, joined } from '../src/planes.js';

test('planes of bytes are joined to the bytes', () => {
  assert.deepEqual([...joined(Uint8Array.of(0, 3, 1, 4, 2, 5), 3)], [0, 1, 2, 3, 4, 5]);
  assert.deepEqual([...joined(Uint8Array.of(7, 8), 1)], [7, 8]);
});

test('deflated bytes in base64 come back', async () => {
  const bytes = Uint8Array.from({ length: 5000 }, (_, i) => (i * i) & 255);
  const text = deflateSync(bytes).toString('base64');
  assert.deepEqual(await inflated(bytesOf(text)), bytes);
});
