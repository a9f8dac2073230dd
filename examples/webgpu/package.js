// The run-time package beside this page: its document, and its files, each with the SHA-256 that the document lists.

/** Return {document, file}: the contents of sea.json, and a function that reads a file of the package. */
export async function readPackage(folder = '.') {
  const document = JSON.parse(new TextDecoder().decode(await bytesOf(folder, 'sea.json')));
  if (document.format !== 'fftocean-runtime' || document.version !== 1) {
    throw new Error(`sea.json must be of format fftocean-runtime, version 1; got ${document.format}, ${document.version}`);
  }
  for (const { n } of document.tiles) {
    if (Math.max(...n) > 512) throw new Error(`tiles must have at most 512 samples a side for these kernels, got ${n.join(' x ')}`);
  }
  const listed = new Map(document.files.map((row) => [row.name, row]));
  async function file(name) {
    if (!listed.has(name)) throw new Error(`sea.json must list ${name}: export with --engine webgpu`);
    const bytes = await bytesOf(folder, name);
    const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
    const found = Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
    if (found !== listed.get(name).sha256) throw new Error(`${name} is not what sea.json lists: its SHA-256 is ${found}`);
    return bytes;
  }
  return { document, file };
}

async function bytesOf(folder, name) {
  const answer = await fetch(`${folder}/${name}`);
  if (!answer.ok) throw new Error(`${name} cannot be read: ${answer.status} ${answer.statusText}`);
  return new Uint8Array(await answer.arrayBuffer());
}

/**
 * Return the tables of a tile, from its records of 14 bytes: int16 mx, my; uint16 cycles; float32 re, im of h0(k).
 *
 * h0 has h0(k) and conj(h0(-k)) of each texel, wave its cycles and 1/(k tanh(k depth)); lifts are powers of two that make
 * displace_y, stretch_xy, slope_y and stretch_yy as large as the field that each is transformed with.
 */
export function tablesOf(document, index, bytes) {
  const { n: [nx, ny], size: [lx, ly] } = document.tiles[index];
  const depth = document.depth ?? Infinity;
  const h0 = new Float32Array(4 * nx * ny), wave = new Float32Array(2 * nx * ny), sums = new Float64Array(8);
  const factor = (k) => (k > 0 ? 1 / (k * Math.tanh(k * depth)) : 0);
  for (let y = 0; y < ny; y++) {
    const ky = (2 * Math.PI * (2 * y < ny ? y : y - ny)) / ly;
    for (let x = 0; x < nx; x++) wave[2 * (y * nx + x) + 1] = factor(Math.hypot((2 * Math.PI * (2 * x < nx ? x : x - nx)) / lx, ky));
  }
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  for (let at = 0; at + 14 <= bytes.length; at += 14) {
    const mx = view.getInt16(at, true), my = view.getInt16(at + 2, true);
    const re = view.getFloat32(at + 6, true), im = view.getFloat32(at + 10, true);
    const here = (my & (ny - 1)) * nx + (mx & (nx - 1)), opposite = (-my & (ny - 1)) * nx + (-mx & (nx - 1));
    h0.set([re, im], 4 * here);
    h0.set([re, -im], 4 * opposite + 2);
    wave[2 * here] = wave[2 * opposite] = view.getUint16(at + 4, true);
    const kx = (2 * Math.PI * mx) / lx, ky = (2 * Math.PI * my) / ly, f = factor(Math.hypot(kx, ky)), energy = re * re + im * im;
    [kx * f, ky * f, 1, kx * ky * f, kx, ky, kx * kx * f, ky * ky * f].forEach((size, i) => (sums[i] += energy * size * size));
  }
  const lifts = [0, 2, 4, 6].map((i) => {
    const exponent = Math.round(Math.log2(sums[i] / sums[i + 1]) / 2) || 0; // NaN without waves
    return 2 ** Math.min(Math.max(exponent, -40), 40);
  });
  return { nx, ny, lx, ly, h0, wave, lifts };
}
