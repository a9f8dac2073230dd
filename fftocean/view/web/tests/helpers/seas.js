// Small seas for tests: their bytes, and the direct sum of their waves.

/** Return the bytes of a container of tiles; each has n, size, and waves [mx, my, cycles, re, im]. */
export function container(tiles, more = {}) {
  const files = tiles.map(({ waves }, i) => {
    const bytes = Buffer.alloc(14 * waves.length);
    waves.forEach(([mx, my, cycles, re, im], w) => {
      bytes.writeInt16LE(mx, 14 * w);
      bytes.writeInt16LE(my, 14 * w + 2);
      bytes.writeUInt16LE(cycles, 14 * w + 4);
      bytes.writeFloatLE(re, 14 * w + 6);
      bytes.writeFloatLE(im, 14 * w + 10);
    });
    return { name: `tile${i}.waves`, bytes };
  });
  const { extra = [], ...members } = more;
  files.push(...extra);
  const document = {
    format: 'fftocean-runtime',
    version: 1,
    loop: 32,
    ticks: 1024,
    choppiness: 1,
    depth: null,
    tiles: tiles.map(({ n, size }) => ({ n, size })),
    files: files.map(({ name, bytes }) => ({ name, bytes: bytes.length })),
    ...members,
  };
  return message('FFTO', document, ...files.map(({ bytes }) => bytes));
}

/** Return the bytes of a message: a head, a header, and parts that are padded. */
export function message(magic, header, ...parts) {
  const padding = (bytes, fill) => Buffer.alloc((16 - (bytes.length % 16)) % 16, fill);
  const text = Buffer.from(JSON.stringify(header));
  const json = Buffer.concat([text, padding(text, ' ')]);
  const head = Buffer.alloc(16);
  head.write(magic, 0, 'latin1');
  head.writeUInt32LE(1, 4);
  head.writeUInt32LE(json.length, 8);
  return Buffer.concat([head, json, ...parts.flatMap((part) => [part, padding(part, 0)])]);
}

/** Return the eight fields of waves at a point and a share of the loop, wave by wave. */
export function directSum(waves, [lx, ly], depth, [x, y], share) {
  const sum = {
    displace_x: 0,
    displace_y: 0,
    height: 0,
    stretch_xy: 0,
    slope_x: 0,
    slope_y: 0,
    stretch_xx: 0,
    stretch_yy: 0,
  };
  for (const [mx, my, cycles, re, im] of waves) {
    const kx = (2 * Math.PI * mx) / lx;
    const ky = (2 * Math.PI * my) / ly;
    const k = Math.hypot(kx, ky);
    const amplitude = 2 * Math.hypot(Math.fround(re), Math.fround(im));
    const angle =
      kx * x + ky * y - 2 * Math.PI * cycles * share + Math.atan2(Math.fround(im), Math.fround(re));
    const along = amplitude / Math.tanh(k * depth);
    const cos = Math.cos(angle);
    const sin = Math.sin(angle);
    sum.height += amplitude * cos;
    sum.slope_x -= amplitude * kx * sin;
    sum.slope_y -= amplitude * ky * sin;
    sum.displace_x -= (along * kx * sin) / k;
    sum.displace_y -= (along * ky * sin) / k;
    sum.stretch_xx -= (along * kx * kx * cos) / k;
    sum.stretch_xy -= (along * kx * ky * cos) / k;
    sum.stretch_yy -= (along * ky * ky * cos) / k;
  }
  return sum;
}

/** Return numbers between 0 and 1 that look random, the same in every run. */
export function randoms(count, seed = 1) {
  let state = seed;
  return Array.from({ length: count }, () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  });
}

/** Waves of all four quadrants, one along each axis, and a pair of opposite ones. */
export const WAVES = [
  [1, 0, 3, 0.25, -0.125],
  [0, -2, 5, -0.5, 0.0625],
  [3, 2, 7, 0.1, 0.2],
  [-3, 2, 7, 0.05, -0.3],
  [3, -2, 7, -0.2, 0.15],
  [-3, -2, 7, 0.07, 0.01],
];
