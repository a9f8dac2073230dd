// Time that the graphics card takes for parts of a picture, where the browser tells it.

/** Share of a new measurement in the running mean. */
const NEW_SHARE = 0.15;

/** Measures parts by name; a part is measured again once its last measurement is known. */
export class GpuTimer {
  /** Ask for the extension. */
  constructor(gl) {
    this.gl = gl;
    this.extension = gl.getExtension('EXT_disjoint_timer_query_webgl2');
    this.pending = new Map();
    this.means = new Map();
    this.open = false;
  }

  /** Return the mean time of a part [ms], or null where it is not known. */
  milliseconds(name) {
    return this.means.get(name) ?? null;
  }

  /** Do some drawing, and measure it. */
  measure(name, draw) {
    const { extension, gl } = this;
    this.collect(name);
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
      const found = gl.getQueryParameter(query, gl.QUERY_RESULT) / 1e6;
      const before = this.means.get(name) ?? found;
      this.means.set(name, before + NEW_SHARE * (found - before));
    }
    gl.deleteQuery(query);
    this.pending.delete(name);
  }
}
