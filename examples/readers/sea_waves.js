// The sea of a run-time package in JavaScript, in node and in browsers, without a GPU:
//     fftocean export-sea -o sea
//     const read = (name) => fetch(`sea/${name}`).then((answer) => answer.arrayBuffer());
//     const sea = await SeaWaves.load(read); // every wave
//     const fast = await SeaWaves.load(read, { strongest: 500 }); // without fast.neglectedRms [m]
//     const { height, normal } = sea.at(x, y, t); // the water above a place
//     const { x, y, height } = sea.rest(x0, y0, t); // the water that rests at a place
// x east, y north, z up, metres, seconds; three.js: at(p.x, -p.z, t), normal (n[0], n[2], -n[1]).
// A damaged package is refused with an Error that names the file and the rule.

const MOST = 2 ** 20, DEEPEST = 32; // bytes and depth of sea.json

export class SeaWaves {
  // read(name) gives a file's bytes, or a promise of them; null: it does not exist.
  static async load(read, { strongest = Infinity } = {}) {
    const bytes = async (name) => {
      const data = await read(name);
      return data instanceof ArrayBuffer ? new Uint8Array(data) : data;
    };
    const document = parsed(await bytes('sea.json')), tiles = [];
    for (const i of document.tiles.keys()) tiles.push(await bytes(`tile${i}.waves`));
    return new SeaWaves(document, tiles, strongest);
  }

  // document: of `parsed`; tiles: the bytes of tile0.waves, tile1.waves, ...
  constructor(document, tiles, strongest = Infinity) {
    const { loop, choppiness } = document, depth = document.depth ?? Infinity;
    must(isPositive(loop), 'loop of sea.json must be a positive number');
    must(Number.isFinite(choppiness), 'choppiness of sea.json must be a number');
    must(depth === Infinity || isPositive(depth),
      'depth of sea.json must be null or a positive number');
    Object.assign(this, { document, loop, choppiness });
    const all = document.tiles.flatMap((tile, i) => wavesOf(document, tile, i, tiles[i], depth));
    all.sort((a, b) => b.a2 - a.a2); // stable: waves of one size stay in the order of the files
    this.waves = all.slice(0, Math.max(0, strongest));
    let lost = 0;
    for (const wave of all.slice(this.waves.length)) lost += wave.a2 / 2;
    this.neglectedRms = Math.sqrt(lost); // of the height of the waves that are left out [m]
  }

  // Water that rests at (x0, y0): it is at (x, y, height) now. residual: 0.
  rest(x0, y0, t) {
    return this.#water(x0, y0, x0, y0, t);
  }

  // Water above (x, y), that is x0 + choppiness D(x0) = x by Newton's method: `residual` [m] is how
  // far the water found is from there; `jacobian` <= 0: it lies in a fold, one of several.
  at(x, y, t) {
    let water = this.#water(x, y, x, y, t), least = water.jacobian;
    for (let i = 0; i < 30 && water.residual > 1e-9; i++) {
      const dx = water.x - x, dy = water.y - y, [xx, xy, yy] = water.gradient;
      const j = Math.max(water.jacobian, 0.2); // short steps near a fold
      const x0 = water.x0 - (yy * dx - xy * dy) / j, y0 = water.y0 - (xx * dy - xy * dx) / j;
      water = this.#water(x, y, x0, y0, t);
      least = Math.min(least, water.jacobian);
    }
    return { ...water, jacobian: least };
  }

  #water(x, y, x0, y0, t) {
    const now = (t % this.loop) / this.loop, c = this.choppiness;
    // In each tile's own period: far from the origin no digits are lost.
    const place = this.document.tiles.map(({ size: [lx, ly] }) => [(x0 % lx) / lx, (y0 % ly) / ly]);
    let height = 0, dx = 0, dy = 0, sx = 0, sy = 0, xx = 0, xy = 0, yy = 0;
    for (const { tile, mx, my, cycles, re, im, kx, ky, f } of this.waves) {
      const turn = mx * place[tile][0] + my * place[tile][1] - cycles * now;
      const angle = 2 * Math.PI * (turn - Math.round(turn));
      const cos = Math.cos(angle), sin = Math.sin(angle);
      const a = re * cos - im * sin, b = re * sin + im * cos;
      height += a;
      sx -= kx * b; sy -= ky * b;
      dx -= kx * f * b; dy -= ky * f * b;
      xx -= kx * kx * f * a; xy -= kx * ky * f * a; yy -= ky * ky * f * a;
    }
    xx = 1 + c * xx; xy *= c; yy = 1 + c * yy;
    const n = [xy * sy - yy * sx, xy * sx - xx * sy, xx * yy - xy * xy], length = Math.hypot(...n);
    const moved = { x: x0 + c * dx, y: y0 + c * dy };
    return {
      x0, y0, ...moved, height, normal: n.map((part) => part / length), jacobian: n[2],
      gradient: [xx, xy, yy], residual: Math.hypot(moved.x - x, moved.y - y),
    };
  }
}

// The document of sea.json, checked: its checksum is that of all before the last key.
export function parsed(bytes) {
  must(bytes, 'sea.json does not exist');
  must(bytes.length <= MOST, `sea.json must have at most ${MOST} bytes, got ${bytes.length}`);
  let depth = 0, text = false;
  for (let i = 0; i < bytes.length; i++) {
    const c = String.fromCharCode(bytes[i]);
    if (c === '\\' && text) i++;
    else if (c === '"') text = !text;
    else if (!text && '[{'.includes(c)) depth++;
    else if (!text && ']}'.includes(c)) depth--;
    must(depth <= DEEPEST, `sea.json must nest at most ${DEEPEST} deep`);
  }
  let document;
  try {
    document = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(bytes));
  } catch {
    throw new Error('sea.json must be JSON');
  }
  const { format, version, check, ticks, tiles, files } = document ?? {};
  must(format === 'fftocean-runtime',
    `format of sea.json must be fftocean-runtime, got ${format}`);
  must(version === 1, `version of sea.json must be 1, got ${version}`);
  const end = new TextEncoder().encode(`,\n  "check": "${check}"\n}\n`);
  const start = Math.max(bytes.length - end.length, 0), rest = bytes.slice(0, start + 3);
  rest.set([10, 125, 10], start); // a line, a brace, a line
  must(end.every((byte, i) => byte === bytes[start + i]) && sha256(rest) === check,
    'sea.json was changed after it was written');
  must(isPower(ticks, 2 ** 20),
    'ticks of sea.json must be a power of two from 2 to 1048576');
  must(Array.isArray(tiles) && tiles.length > 0 && tiles.length <= 16,
    'tiles of sea.json must be a list of 1 to 16');
  must(Array.isArray(files), 'files of sea.json must be a list');
  return document;
}

// The waves of a tile: h0 of k and -k are two of them, and each is twice the real part of its own.
function wavesOf(document, tile, index, bytes, depth) {
  const name = `tile${index}.waves`, { n, size, waves, most_cycles } = tile ?? {};
  const pair = (value, rule) => Array.isArray(value) && value.length === 2 && value.every(rule);
  const whole = (value, most) => Number.isInteger(value) && value >= 0 && value <= most;
  must(pair(n, (value) => isPower(value, 1024)),
    `n of tile ${index} in sea.json must be two powers of two from 2 to 1024`);
  must(pair(size, isPositive),
    `size of tile ${index} in sea.json must be two positive numbers`);
  must(whole(waves, n[0] * n[1]) && whole(most_cycles, 65535),
    `waves of tile ${index} in sea.json must fit its n and most_cycles`);
  const row = document.files.find((file) => file?.name === name);
  must(row && row.bytes === 14 * waves && /^[0-9a-f]{64}$/.test(row.sha256),
    `sea.json must list ${name} with ${14 * waves} bytes and its SHA-256`);
  must(bytes, `${name} does not exist`);
  must(bytes.length === 14 * waves, `${name} must have ${14 * waves} bytes, got ${bytes.length}`);
  must(sha256(bytes) === row.sha256, `${name} was changed after it was written`);
  const view = new DataView(bytes.buffer, bytes.byteOffset), found = [];
  const [[nx, ny], [lx, ly]] = [n, size], last = { place: -1 };
  for (let i = 0; i < waves; i++) {
    const mx = view.getInt16(14 * i, true), my = view.getInt16(14 * i + 2, true);
    const cycles = view.getUint16(14 * i + 4, true);
    const re = 2 * view.getFloat32(14 * i + 6, true), im = 2 * view.getFloat32(14 * i + 10, true);
    const place = ((my + ny) % ny) * nx + ((mx + nx) % nx), a2 = re * re + im * im;
    const record = (right, rule) => must(right, `record ${i} of ${name} must ${rule}`);
    record(2 * Math.abs(mx) < nx && 2 * Math.abs(my) < ny && (mx || my),
      `have |mx| < ${nx / 2} and |my| < ${ny / 2}, not both 0`);
    record(place > last.place, 'follow the one before in the plane');
    record(a2 > 0 && a2 < Infinity, 'have a finite amplitude, not 0');
    record(cycles >= 1 && cycles <= most_cycles, `have 1 to ${most_cycles} cycles`);
    last.place = place;
    const kx = (2 * Math.PI * mx) / lx, ky = (2 * Math.PI * my) / ly, k = Math.hypot(kx, ky);
    const f = 1 / (k * Math.tanh(k * depth));
    found.push({ tile: index, mx, my, cycles, re, im, kx, ky, f, a2 });
  }
  return found;
}

function isPositive(value) {
  return Number.isFinite(value) && value > 0;
}

function isPower(value, most) {
  return Number.isInteger(value) && value >= 2 && value <= most && (value & (value - 1)) === 0;
}

function must(right, rule) {
  if (!right) throw new Error(rule);
}

// FIPS 180-4; browsers have their own, but not on pages without https.
export function sha256(bytes) {
  const part = (x) => Math.floor((x - Math.floor(x)) * 2 ** 32);
  const primes = [];
  for (let n = 2; primes.length < 64; n++) if (primes.every((p) => n % p)) primes.push(n);
  const k = primes.map((p) => part(Math.cbrt(p)));
  const h = primes.slice(0, 8).map((p) => part(Math.sqrt(p)));
  const data = new Uint8Array(((bytes.length + 72) >> 6) << 6), view = new DataView(data.buffer);
  data.set(bytes);
  data[bytes.length] = 128;
  view.setUint32(data.length - 8, Math.floor(bytes.length / 2 ** 29));
  view.setUint32(data.length - 4, bytes.length << 3);
  const turn = (x, n) => (x >>> n) | (x << (32 - n)), w = new Int32Array(64);
  for (let at = 0; at < data.length; at += 64) {
    let [a, b, c, d, e, f, g, z] = h;
    for (let i = 0; i < 64; i++) {
      if (i < 16) w[i] = view.getInt32(at + 4 * i);
      else {
        const p = w[i - 15], q = w[i - 2];
        const r = turn(p, 7) ^ turn(p, 18) ^ (p >>> 3), s = turn(q, 17) ^ turn(q, 19) ^ (q >>> 10);
        w[i] = w[i - 16] + r + w[i - 7] + s;
      }
      const mixed = (turn(e, 6) ^ turn(e, 11) ^ turn(e, 25)) + ((e & f) ^ (~e & g));
      const one = (z + mixed + k[i] + w[i]) | 0;
      const two = ((turn(a, 2) ^ turn(a, 13) ^ turn(a, 22)) + ((a & b) ^ (a & c) ^ (b & c))) | 0;
      z = g; g = f; f = e; e = (d + one) | 0; d = c; c = b; b = a; a = (one + two) | 0;
    }
    [a, b, c, d, e, f, g, z].forEach((value, i) => { h[i] = (h[i] + value) | 0; });
  }
  return h.map((word) => (word >>> 0).toString(16).padStart(8, '0')).join('');
}
