// Time that the graphics card takes for parts of a picture, where the browser tells it.

/** Share of a new measurement in the running mean. */
const NEW_SHARE = 0.15;

/** Shortest time between two measurements of a part that is waited for [ms]. */
const WAIT_EVERY = 1000;

/** Measures parts by name; a part is measured again once its last measurement is known. */
export class GpuTimer {
  /** Ask for the extension. */
  constructor(gl) {
    this.gl = gl;
    this.extension = gl.getExtension('EXT_disjoint_timer_query_webgl2');
    this.pending = new Map();
    this.means = new Map();
    this.open = false;
    this.waits = false; // where the browser tells no times, now and then wait until all is drawn
    this.waited = new Map();
  }

  /** Return the mean time of a part [ms], or null where it is not known. */
  milliseconds(name) {
    return this.means.get(name) ?? null;
  }

  /** Do some drawing, and measure it. */
  measure(name, draw) {
    const { extension, gl } = this;
    this.collect(name);
    if (!extension && this.waits && !this.open) {
      this.wait(name, draw);
      return;
    }
    if (!extension || this.open || this.pending.has(name)) {
      draw();
      return;
    }
    const query = gl.createQuery();
    gl.beginQuery(extension.TIME_ELAPSED_EXT, query);
    this.open = true;
    try {
      draw();
    } finally {
      gl.endQuery(extension.TIME_ELAPSED_EXT);
      this.open = false;
      this.pending.set(name, query);
    }
  }

  /** Take the answer of a measurement that has come in. */
  collect(name) {
    const { extension, gl } = this;
    const query = this.pending.get(name);
    if (!query || !gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE)) return;
    const valid = !gl.getParameter(extension.GPU_DISJOINT_EXT);
    if (valid) {
      this.note(name, gl.getQueryParameter(query, gl.QUERY_RESULT) / 1e6);
    }
    gl.deleteQuery(query);
    this.pending.delete(name);
  }

  /** Take one measurement into the mean [ms]. */
  note(name, found) {
    const before = this.means.get(name) ?? found;
    this.means.set(name, before + NEW_SHARE * (found - before));
  }

  /** Do some drawing; if it is time for it, measure how long it takes until all is drawn. */
  wait(name, draw) {
    const now = performance.now();
    if (now - (this.waited.get(name) ?? -Infinity) < WAIT_EVERY) {
      draw();
      return;
    }
    this.waited.set(name, now);
    this.finish();
    const start = performance.now();
    draw();
    this.finish();
    this.note(name, performance.now() - start);
  }

  /** Wait until all is drawn: only the reading of a pixel does that in every browser. */
  finish() {
    const { gl } = this;
    const pixel = new Uint8Array(4);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  }
}
