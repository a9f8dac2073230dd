// Time that the GPU takes for parts of a picture.

const SMOOTHING = 0.2; // weight of the newest measurement

/** Shortest time between two measurements that wait for the GPU, where it has no clock [ms]. */
const WAIT_EVERY = 700;

/** Measures the work of a graphics context by name, over many pictures. */
export class GpuTimer {
  /** Ask for the clock of a context; without one, some pictures are waited for. */
  constructor(gl) {
    this.gl = gl;
    this.clock = gl.getExtension('EXT_disjoint_timer_query_webgl2');
    this.waiting = []; // queries whose answers have not come, the oldest first
    this.times = new Map();
    this.waited = new Map();
    this.active = false;
  }

  /**
   * Do some work and measure the time that the GPU takes for it.
   *
   * @param {string} name
   * @param {function(): *} work draws; what it returns is returned
   */
  measure(name, work) {
    if (this.active || this.gl.isContextLost()) return work();
    return this.clock ? this.query(name, work) : this.wait(name, work);
  }

  /** Return the time that some work takes [ms], or null before the first measurement. */
  milliseconds(name) {
    this.collect();
    return this.times.get(name) ?? null;
  }

  /** Measure with the clock of the GPU. */
  query(name, work) {
    const { gl, clock } = this;
    this.collect();
    const query = gl.createQuery();
    gl.beginQuery(clock.TIME_ELAPSED_EXT, query);
    this.active = true;
    try {
      return work();
    } finally {
      this.active = false;
      gl.endQuery(clock.TIME_ELAPSED_EXT);
      this.waiting.push({ name, query });
    }
  }

  /** Measure by waiting until the GPU has finished, now and then. */
  wait(name, work) {
    const now = performance.now();
    if (now - (this.waited.get(name) ?? -Infinity) < WAIT_EVERY) return work();
    this.waited.set(name, now);
    this.finish();
    const start = performance.now();
    const result = work();
    this.finish();
    this.note(name, performance.now() - start);
    return result;
  }

  /** Wait until everything is drawn: only reading a pixel does that everywhere. */
  finish() {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  /** Take the answers that have come. */
  collect() {
    const { gl, clock } = this;
    if (!clock) return;
    const disjoint = gl.getParameter(clock.GPU_DISJOINT_EXT);
    while (this.waiting.length) {
      const { name, query } = this.waiting[0];
      if (!gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE)) break;
      this.waiting.shift();
      if (!disjoint) this.note(name, gl.getQueryParameter(query, gl.QUERY_RESULT) / 1e6);
      gl.deleteQuery(query);
    }
  }

  /** Take one measurement [ms] into the mean. */
  note(name, milliseconds) {
    const before = this.times.get(name) ?? milliseconds;
    this.times.set(name, before + SMOOTHING * (milliseconds - before));
  }

  /** Free everything. */
  dispose() {
    for (const { query } of this.waiting) this.gl.deleteQuery(query);
    this.waiting = [];
  }
}
