import assert from 'node:assert/strict';
import test from 'node:test';
import { halfFloat, halfFloats } from '../src/half.js';

/** Return the value of the bits of a finite half float. */
function value(bits) {
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  const size = exponent ? (1 + fraction / 1024) * 2 ** (exponent - 15) : fraction * 2 ** -24;
  return bits & 0x8000 ? -size : size;
}

test('every half float is kept', () => {
  for (let bits = 0; bits < 0x7c00; bits++) {
    assert.equal(halfFloat(value(bits)), bits);
    assert.equal(halfFloat(-value(bits)), bits | 0x8000);
  }
});

test('a number between two half floats goes to the nearer one, and from the middle to even', () => {
  for (let bits = 0; bits < 0x7bff; bits += 7) {
    const [low, high] = [value(bits), value(bits + 1)];
    assert.equal(halfFloat(low + 0.49 * (high - low)), bits);
    assert.equal(halfFloat(low + 0.51 * (high - low)), bits + 1);
    assert.equal(halfFloat((low + high) / 2), bits & 1 ? bits + 1 : bits);
  }
});

test('numbers that are too large become infinite, and NaN stays NaN', () => {
  assert.deepEqual(
    [...halfFloats([65519, 65520, 1e30, -Infinity, NaN])],
    [0x7bff, 0x7c00, 0x7c00, 0xfc00, 0x7e00],
  );
});
