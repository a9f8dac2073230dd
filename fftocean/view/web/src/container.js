// The bytes of a sea: a head, a JSON document and the files of the run-time package, in one buffer.

/** The fields of a frame, in the order of a reference answer and of the channels of a simulation. */
export const FIELDS = [
  'displace_x',
  'displace_y',
  'height',
  'stretch_xy',
  'slope_x',
  'slope_y',
  'stretch_xx',
  'stretch_yy',
];

const ALIGNMENT = 16;
const MOST_TABLES = 16; // to keep
const MOST_LIFT = 40; // a power of two that leaves single precision enough of its range
const WAVE_BYTES = 14; // int16 mx, my; uint16 cycles; float32 re, im

/** Return the number of bytes with its padding. */
function padded(count) {
  return Math.ceil(count / ALIGNMENT) * ALIGNMENT;
}

/** Return bytes of any view or buffer; a view of a larger buffer keeps its offset. */
function asBytes(data) {
  if (ArrayBuffer.isView(data))
    return new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
  return new Uint8Array(data);
}

/**
 * Read the head and the JSON header of a binary message.
 *
 * @param {ArrayBuffer|ArrayBufferView} data
 * @param {string} magic the four letters that it must begin with
 * @returns {{header: object, rest: Uint8Array}} the header, and the bytes after it
 */
export function readMessage(data, magic) {
  const bytes = asBytes(data);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const found = String.fromCharCode(...bytes.subarray(0, 4));
  if (bytes.length < ALIGNMENT || found !== magic) {
    throw new Error(`the data must begin with ${magic}, got ${JSON.stringify(found)}`);
  }
  const version = view.getUint32(4, true);
  if (version !== 1) throw new Error(`version of the data must be 1, got ${version}`);
  const length = view.getUint32(8, true);
  if (ALIGNMENT + length > bytes.length) {
    throw new Error(`the header must end within the data: ${length} of ${bytes.length} bytes`);
  }
  const text = new TextDecoder().decode(bytes.subarray(ALIGNMENT, ALIGNMENT + length));
  return { header: JSON.parse(text), rest: bytes.subarray(ALIGNMENT + length) };
}

/** Return the four letters that name the kind of a binary message. */
export function kindOf(data) {
  return String.fromCharCode(...asBytes(data).subarray(0, 4));
}

/** Return the files of a container by name. */
function splitFiles(document, rest) {
  const files = new Map();
  let start = 0;
  for (const { name, bytes } of document.files) {
    if (start + bytes > rest.length) throw new Error(`the data ends within ${name}`);
    files.set(name, rest.subarray(start, start + bytes));
    start += padded(bytes);
  }
  return files;
}

/** Return a JSON file of a container, or null if it is not there. */
function jsonFile(files, name) {
  return files.has(name) ? JSON.parse(new TextDecoder().decode(files.get(name))) : null;
}

/**
 * Decode a sea from the bytes of a container.
 *
 * @param {ArrayBuffer|ArrayBufferView} data
 * @returns {{document: object, tiles: object[], reference: ?object}} the document (sea.json); of
 *   each tile nx, ny, lx, ly, mixed and two tables, x fastest, in the order of an FFT: `h0`, four
 *   numbers an entry, h0(k) and conj(h0(-k)); `wave`, two numbers, whole cycles in a loop and
 *   1/(k tanh kh); and the points of check.json
 */
export function decodeSea(data) {
  const { header: document, rest } = readMessage(data, 'FFTO');
  if (document.format !== 'fftocean-runtime' || document.version !== 1) {
    throw new Error(
      `the format must be fftocean-runtime 1, got ${document.format} ${document.version}`,
    );
  }
  requirePowerOfTwo('ticks', document.ticks);
  const files = splitFiles(document, rest);
  const tiles = document.tiles.map((about, i) => {
    const waves = files.get(`tile${i}.waves`);
    if (!waves) throw new Error(`the file tile${i}.waves is missing`);
    return decodeTile(about, waves, document.depth ?? Infinity);
  });
  return { document, tiles, reference: jsonFile(files, 'check.json') };
}

/** Refuse a number of samples or ticks that is not a power of two, and name the next one. */
export function requirePowerOfTwo(name, value) {
  const exponent = Math.ceil(Math.log2(value));
  if (!(value >= 2) || 2 ** exponent !== value) {
    const next = value >= 2 ? 2 ** exponent : 2;
    throw new Error(`${name} must be a power of two, got ${value}: the next one is ${next}`);
  }
}

/** Return the tables of one tile from its wave records. */
export function decodeTile(about, waves, depth) {
  const [nx, ny] = about.n;
  const [lx, ly] = about.size;
  requirePowerOfTwo('n', nx);
  requirePowerOfTwo('n', ny);
  if (waves.length % WAVE_BYTES) {
    throw new Error(`waves must be records of ${WAVE_BYTES} bytes, got ${waves.length} bytes`);
  }
  const h0 = new Float32Array(4 * nx * ny);
  const wave = potentialFactors(nx, ny, lx, ly, depth).slice();
  const view = new DataView(waves.buffer, waves.byteOffset, waves.byteLength);
  const variances = new Float64Array(8); // of pairs of fields, but for a common factor
  for (let at = 0; at < waves.length; at += WAVE_BYTES) {
    const mx = view.getInt16(at, true);
    const my = view.getInt16(at + 2, true);
    // The Nyquist row and column stay empty: there two real fields in one complex one mix.
    if (2 * Math.abs(mx) >= nx || 2 * Math.abs(my) >= ny) {
      throw new Error(`a wave must have |mx| < ${nx / 2} and |my| < ${ny / 2}, got (${mx}, ${my})`);
    }
    const here = (my & (ny - 1)) * nx + (mx & (nx - 1));
    const opposite = (-my & (ny - 1)) * nx + (-mx & (nx - 1));
    const re = view.getFloat32(at + 6, true);
    const im = view.getFloat32(at + 10, true);
    h0[4 * here] = re;
    h0[4 * here + 1] = im;
    h0[4 * opposite + 2] = re;
    h0[4 * opposite + 3] = -im;
    wave[2 * here] = wave[2 * opposite] = view.getUint16(at + 4, true);
    addVariances(variances, mx / lx, my / ly, re * re + im * im, wave[2 * here + 1]);
  }
  return { nx, ny, lx, ly, lifts: liftsOf(variances), h0, wave };
}

/** Add the variances of one wave's eight fields, in pairs; `kx` and `ky` are in cycles a metre. */
function addVariances(sums, kx, ky, height, factor) {
  const [xx, yy] = [(2 * Math.PI * kx) ** 2, (2 * Math.PI * ky) ** 2];
  const potential = height * factor * factor;
  sums[0] += potential * xx; // displace_x
  sums[1] += potential * yy; // displace_y
  sums[2] += height;
  sums[3] += potential * xx * yy; // stretch_xy
  sums[4] += height * xx; // slope_x
  sums[5] += height * yy; // slope_y
  sums[6] += potential * xx * xx; // stretch_xx
  sums[7] += potential * yy * yy; // stretch_yy
}

/**
 * Return the powers of two that lift the second of two fields to the size of the first.
 *
 * Two real fields are the parts of one complex one, whose rounding errors are those of the larger
 * part: without a lift the smaller field would drown in them, where waves run along an axis, say.
 *
 * @returns {number[]} for displace_y, stretch_xy, slope_y and stretch_yy, beside displace_x,
 *   height, slope_x and stretch_xx
 */
function liftsOf(variances) {
  return [0, 2, 4, 6].map((first) => {
    // Where one of them is 0 the ratio is 0 or infinite, or no number without any waves.
    const exponent = Math.round(Math.log2(variances[first] / variances[first + 1]) / 2) || 0;
    return 2 ** Math.min(Math.max(exponent, -MOST_LIFT), MOST_LIFT);
  });
}

const factors = new Map(); // tables of `potentialFactors` by their arguments: sliders ask often

/** Return the table of a tile's waves without cycles: 0 and 1/(k tanh kh). */
function potentialFactors(nx, ny, lx, ly, depth) {
  const key = [nx, ny, lx, ly, depth].join();
  if (factors.has(key)) return factors.get(key);
  const wave = new Float32Array(2 * nx * ny);
  for (let j = 0; j < ny; j++) {
    const ky = (2 * Math.PI * (2 * j < ny ? j : j - ny)) / ly;
    for (let i = 0; i < nx; i++) {
      const kx = (2 * Math.PI * (2 * i < nx ? i : i - nx)) / lx;
      const k = Math.sqrt(kx * kx + ky * ky);
      if (k > 0) wave[2 * (j * nx + i) + 1] = 1 / (k * Math.tanh(k * depth));
    }
  }
  if (factors.size >= MOST_TABLES) factors.clear();
  factors.set(key, wave);
  return wave;
}

/**
 * Decode a reference answer: the fields of one tile at one tick, as Python computed them.
 *
 * @param {ArrayBuffer|ArrayBufferView} data
 * @returns {{header: object, fields: Object<string, Float32Array>}}
 */
export function decodeReference(data) {
  const { header, rest } = readMessage(data, 'FFTR');
  const samples = header.nx * header.ny;
  if (rest.length < 4 * samples * header.fields.length) {
    throw new Error(
      `a reference must hold ${header.fields.length} fields of ${samples} numbers, ` +
        `got ${rest.length} bytes`,
    );
  }
  const numbers = new Float32Array(rest.slice(0, 4 * samples * header.fields.length).buffer);
  const fields = {};
  header.fields.forEach((name, i) => {
    fields[name] = numbers.subarray(i * samples, (i + 1) * samples);
  });
  return { header, fields };
}
