// Reader of a run-time package (`fftocean export-sea`): checks it and lays its waves out as textures.

const NAME = /^[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)*$/;
const RECORD = 14; // bytes of a wave: int16 mx, my; uint16 cycles; float32 re, im

/** Raise an error that names the file and the rule, unless it holds. */
function require(holds, file, rule, got) {
  if (!holds) throw new Error(`${file}: ${rule}${got === undefined ? '' : `, got ${JSON.stringify(got)}`}`);
}

const isPower = (n) => Number.isInteger(n) && n >= 2 && n <= 1024 && (n & (n - 1)) === 0;
const isLength = (x) => Number.isFinite(x) && x > 0;

/** Return the document of a package, checked. */
export function checkedDocument(document) {
  const file = 'sea.json';
  require(document?.format === 'fftocean-runtime', file, 'format must be "fftocean-runtime"', document?.format);
  require(document.version === 1, file, 'version must be 1', document.version);
  require(isLength(document.loop), file, 'loop must be positive', document.loop);
  const ticks = document.ticks;
  require(
    Number.isInteger(ticks) && ticks >= 2 && ticks <= 2 ** 20 && (ticks & (ticks - 1)) === 0,
    file, 'ticks must be a power of two up to 1048576', ticks,
  );
  require(Number.isFinite(document.choppiness), file, 'choppiness must be a number', document.choppiness);
  require(document.depth === null || isLength(document.depth), file, 'depth must be positive or null', document.depth);
  require(Array.isArray(document.tiles) && document.tiles.length >= 1 && document.tiles.length <= 4, file, 'tiles must be 1 to 4');
  for (const tile of document.tiles) {
    require(tile.n?.length === 2 && tile.n.every(isPower), file, 'n must be two powers of two, 2 to 1024', tile.n);
    require(tile.size?.length === 2 && tile.size.every(isLength), file, 'size must be two positive numbers', tile.size);
    require(Number.isInteger(tile.waves) && tile.waves >= 0, file, 'waves must be a whole number', tile.waves);
    require(tile.most_cycles <= 65535 && tile.most_cycles * ticks < 2 ** 32, file, 'cycles times ticks must stay below 2^32', tile.most_cycles);
    require(isLength(tile.mixed), file, 'mixed must be positive', tile.mixed);
  }
  require(Array.isArray(document.files), file, 'files must be a list');
  for (const entry of document.files) require(NAME.test(entry.name), file, 'a file name must have letters, digits, _ and - alone', entry.name);
  return document;
}

/** Return the bytes of a listed file, if they are the listed ones. */
async function listedBytes(base, document, name) {
  const entry = document.files.find((file) => file.name === name);
  require(entry, 'sea.json', `it must list ${name}`);
  const answer = await fetch(new URL(name, base));
  require(answer.ok, name, `it could not be read (${answer.status})`);
  const bytes = await answer.arrayBuffer();
  require(bytes.byteLength === entry.bytes, name, `it must have ${entry.bytes} bytes`, bytes.byteLength);
  // Browsers have SHA-256 on https and localhost alone.
  if (entry.sha256 && globalThis.crypto?.subtle) {
    const sum = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
    const text = [...sum].map((byte) => byte.toString(16).padStart(2, '0')).join('');
    require(text === entry.sha256, name, 'its SHA-256 is not the listed one');
  }
  return bytes;
}

/**
 * Return the waves of a tile as arrays: `h0` is (ny, nx, 4), h0(k) and conj(h0(-k)); `wave` is
 * (ny, nx, 2), cycles and 1/(k tanh(k depth)); `list` has the waves themselves.
 */
export function layOut(bytes, tile, depth, name) {
  require(bytes.byteLength === RECORD * tile.waves, name, `it must have ${RECORD * tile.waves} bytes`, bytes.byteLength);
  const [nx, ny] = tile.n, [lx, ly] = tile.size, view = new DataView(bytes);
  const h0 = new Float32Array(4 * nx * ny), wave = new Float32Array(2 * nx * ny);
  const seen = new Uint8Array(nx * ny);
  const list = [];
  for (let i = 0; i < tile.waves; i++) {
    const at = RECORD * i;
    const mx = view.getInt16(at, true), my = view.getInt16(at + 2, true), cycles = view.getUint16(at + 4, true);
    const re = view.getFloat32(at + 6, true), im = view.getFloat32(at + 10, true);
    require(Math.abs(mx) < nx / 2 && Math.abs(my) < ny / 2 && (mx || my), name, `wave ${i} must lie in the grid`, [mx, my]);
    require(Number.isFinite(re) && Number.isFinite(im), name, `wave ${i} must be finite`);
    require(cycles >= 1 && cycles <= tile.most_cycles, name, `cycles of wave ${i} must be 1 to ${tile.most_cycles}`, cycles);
    const texel = ((my + ny) % ny) * nx + ((mx + nx) % nx);
    const opposite = ((ny - my) % ny) * nx + ((nx - mx) % nx);
    require(!seen[texel], name, `wave ${i} must occur once`, [mx, my]);
    seen[texel] = 1;
    const kx = (2 * Math.PI * mx) / lx, ky = (2 * Math.PI * my) / ly, k = Math.hypot(kx, ky);
    const factor = 1 / (k * (depth === null ? 1 : Math.tanh(k * depth)));
    h0[4 * texel] = re;
    h0[4 * texel + 1] = im;
    h0[4 * opposite + 2] = re;
    h0[4 * opposite + 3] = -im;
    for (const one of [texel, opposite]) {
      wave[2 * one] = cycles;
      wave[2 * one + 1] = factor;
    }
    list.push({ kx, ky, cycles, re, im, factor });
  }
  return { h0, wave, list };
}

/** Return the package in a folder: its document, and the waves of each tile. */
export async function readPackage(base, document) {
  checkedDocument(document);
  const tiles = [];
  for (const [index, tile] of document.tiles.entries()) {
    const name = `tile${index}.waves`;
    tiles.push({ ...tile, ...layOut(await listedBytes(base, document, name), tile, document.depth, name) });
  }
  return { document, tiles };
}

/**
 * Heights of a sea at points, by a sum over its strongest waves in double precision.
 *
 * `neglected` is the root mean square of the waves that are left out [m].
 */
export class WaveSum {
  constructor({ document, tiles }, most = 1500) {
    this.document = document;
    const all = tiles.flatMap((tile) => tile.list);
    const energy = (wave) => wave.re * wave.re + wave.im * wave.im;
    all.sort((a, b) => energy(b) - energy(a));
    this.waves = all.slice(0, most);
    // each record and its conjugate: a wave of amplitude 2 |h0|, of variance 2 |h0|^2
    this.neglected = Math.sqrt(2 * all.slice(most).reduce((sum, wave) => sum + energy(wave), 0));
  }

  /** Return displacement (dx, dy, height) and slopes at a place at rest, x east and y north [m]. */
  atRest(x, y, tick) {
    const { ticks, choppiness } = this.document;
    const found = { dx: 0, dy: 0, height: 0, slope_x: 0, slope_y: 0 };
    for (const wave of this.waves) {
      const turn = (Math.imul(wave.cycles, tick) & (ticks - 1)) / ticks;
      const phase = wave.kx * x + wave.ky * y - 2 * Math.PI * turn;
      const c = Math.cos(phase), s = Math.sin(phase);
      const real = 2 * (wave.re * c - wave.im * s), imaginary = 2 * (wave.re * s + wave.im * c);
      found.height += real;
      found.dx -= choppiness * wave.kx * wave.factor * imaginary;
      found.dy -= choppiness * wave.ky * wave.factor * imaginary;
      found.slope_x -= wave.kx * imaginary;
      found.slope_y -= wave.ky * imaginary;
    }
    return found;
  }

  /** Return the surface at a place in the world: height and slopes there. */
  at(x, y, tick) {
    let rest = [x, y], found;
    for (let i = 0; i < 8; i++) {
      found = this.atRest(...rest, tick);
      rest = [x - found.dx, y - found.dy];
    }
    return found;
  }
}
