// Numbers of half precision.

const single = new Float32Array(1);
const bits = new Uint32Array(single.buffer);

/** Return the bits of the half float nearest to a number; ties go to even, too large to infinity. */
export function halfFloat(value) {
  single[0] = value;
  const sign = (bits[0] >>> 16) & 0x8000;
  const size = bits[0] & 0x7fffffff;
  if (size > 0x7f800000) return 0x7e00; // NaN
  if (size >= 0x477ff000) return sign | 0x7c00;
  if (size < 0x38800000) {
    // Below 2^-14 the steps are 2^-24.
    const steps = Math.abs(value) * 2 ** 24;
    const low = Math.floor(steps);
    const above = steps - low;
    return sign | (low + (above > 0.5 || (above === 0.5 && low & 1) ? 1 : 0));
  }
  return sign | ((size - 0x38000000 + 0xfff + ((size >>> 13) & 1)) >>> 13);
}

/** Return the half floats nearest to some numbers. */
export function halfFloats(values) {
  const halves = new Uint16Array(values.length);
  for (let i = 0; i < values.length; i++) halves[i] = halfFloat(values[i]);
  return halves;
}
