// Inverse Fourier transforms in JavaScript, in double precision.

/** Return cos and sin of 2 pi i/n, i = 0..n-1, interleaved; quarters of a turn are exact. */
export function twiddleTable(n) {
  const table = new Float64Array(2 * n);
  for (let i = 0; i < n; i++) {
    const quarters = (4 * i) / n;
    const exact = Number.isInteger(quarters);
    table[2 * i] = exact ? [1, 0, -1, 0][quarters] : Math.cos((2 * Math.PI * i) / n);
    table[2 * i + 1] = exact ? [0, 1, 0, -1][quarters] : Math.sin((2 * Math.PI * i) / n);
  }
  return table;
}

/** Transforms of complex arrays (ny, nx), without a factor; powers of two. */
export class Fourier {
  /** Make the tables and the scratch arrays of one size. */
  constructor(nx, ny) {
    this.nx = nx;
    this.ny = ny;
    this.tableX = twiddleTable(nx);
    this.tableY = nx === ny ? this.tableX : twiddleTable(ny);
    this.scratch = [new Float64Array(nx * ny), new Float64Array(nx * ny)];
  }

  /**
   * Transform: sum over k of the input times e^{+i k.x}.
   *
   * @param {Float64Array} re real parts, overwritten
   * @param {Float64Array} im imaginary parts, overwritten
   */
  inverse(re, im) {
    const { nx, ny, scratch } = this;
    this.along(re, im, ny, nx, this.tableY);
    transpose(re, scratch[0], ny, nx);
    transpose(im, scratch[1], ny, nx);
    re.set(scratch[0]);
    im.set(scratch[1]);
    this.along(re, im, nx, ny, this.tableX);
    transpose(re, scratch[0], nx, ny);
    transpose(im, scratch[1], nx, ny);
    re.set(scratch[0]);
    im.set(scratch[1]);
  }

  /** Transform (n, count) along the first axis: Stockham steps on whole rows, in place. */
  along(re, im, n, count, table) {
    let [fromRe, fromIm] = [re, im];
    let [toRe, toIm] = this.scratch;
    const half = (n / 2) * count;
    for (let block = 2; block <= n; block *= 2) {
      const part = block / 2;
      for (let row = 0; row < n / 2; row++) {
        const remainder = row & (part - 1);
        const out = (2 * (row - remainder) + remainder) * count;
        const opposite = out + part * count;
        const wr = table[(2 * remainder * n) / block];
        const wi = table[(2 * remainder * n) / block + 1];
        const start = row * count;
        for (let i = 0; i < count; i++) {
          const br = fromRe[start + half + i];
          const bi = fromIm[start + half + i];
          const tr = wr * br - wi * bi;
          const ti = wr * bi + wi * br;
          const ar = fromRe[start + i];
          const ai = fromIm[start + i];
          toRe[out + i] = ar + tr;
          toIm[out + i] = ai + ti;
          toRe[opposite + i] = ar - tr;
          toIm[opposite + i] = ai - ti;
        }
      }
      [fromRe, fromIm, toRe, toIm] = [toRe, toIm, fromRe, fromIm];
    }
    if (fromRe !== re) {
      re.set(fromRe);
      im.set(fromIm);
    }
  }
}

/** Write the transpose of (rows, columns) into another array, square by square for the cache. */
function transpose(from, to, rows, columns) {
  const side = 16;
  for (let top = 0; top < rows; top += side) {
    for (let left = 0; left < columns; left += side) {
      const bottom = Math.min(top + side, rows);
      const right = Math.min(left + side, columns);
      for (let j = top; j < bottom; j++) {
        for (let i = left; i < right; i++) to[i * rows + j] = from[j * columns + i];
      }
    }
  }
}
