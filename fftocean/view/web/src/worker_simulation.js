// A sea that a Worker computes in JavaScript, for GPUs that cannot draw into 32-bit floats.
/* global WORKER_SOURCE */
import { disposeMaps, makeMaps } from './maps.js';
import { MovingSea } from './moving_sea.js';

/** Most samples a side that JavaScript computes fast enough to watch. */
export const MOST_SAMPLES = 128;

/** Start the page's own Worker: a file of the server, or the text in the page that is one file. */
function startWorker() {
  if (typeof WORKER_SOURCE === 'undefined') return new Worker('worker.js');
  const address = URL.createObjectURL(new Blob([WORKER_SOURCE], { type: 'text/javascript' }));
  const worker = new Worker(address);
  URL.revokeObjectURL(address);
  return worker;
}

/** A simulation by a Worker; see `createSimulation`. */
export class WorkerSimulation extends MovingSea {
  /** Return a simulation that shows the first tick. */
  static async start(gl, sea, options) {
    const simulation = new WorkerSimulation(gl, sea, options);
    try {
      await simulation.step(0);
    } catch (error) {
      simulation.dispose();
      throw error;
    }
    return simulation;
  }

  /** Start a Worker. */
  constructor(gl, sea, { prefer, anisotropy = 8, makeWorker = startWorker } = {}) {
    super(gl, anisotropy);
    this.kind = 'worker';
    this.reason =
      prefer === 'worker'
        ? 'As asked for'
        : 'This graphics card cannot draw into 32-bit floats (EXT_color_buffer_float)';
    this.begin(sea);
    this.shown = { tick: 0, choppiness: sea.document.choppiness ?? 1 };
    this.wanted = null; // the newest step that has not been sent
    this.running = null; // a promise while steps are under way
    this.requests = new Map();
    this.worker = makeWorker();
    this.worker.onmessage = ({ data }) => this.receive(data);
    this.worker.onerror = (event) => {
      event.preventDefault?.();
      this.fail(`the Worker that computes the sea failed: ${event.message || 'it did not load'}`);
    };
  }

  get tick() {
    return this.shown.tick;
  }

  get choppiness() {
    return this.shown.choppiness;
  }

  /** Return a sea with no more samples than can be computed, and say what it lacks. */
  fitted(sea) {
    const { sea: less, lost } = reduced(sea, MOST_SAMPLES);
    const lacks = lost ? `; the ${lost} shortest waves are left out` : '';
    this.note =
      `${this.reason}: JavaScript computes the sea, ` +
      `with at most ${MOST_SAMPLES} x ${MOST_SAMPLES} samples a tile${lacks}.`;
    this.reduced = lost > 0;
    return less;
  }

  /**
   * Bring the maps to a tick of the loop; of the steps asked for while one is under way only the
   * last is computed. The promise waits for it.
   */
  step(tick, choppiness = this.choppiness) {
    this.wanted = { tick: tick >>> 0, choppiness };
    if (!this.running) {
      this.running = this.run();
      this.running.catch(() => {}); // for those who do not wait
    }
    return this.running;
  }

  /** Compute and show steps until none is wanted. */
  async run() {
    try {
      while (this.wanted && !this.gl.isContextLost()) {
        const { tick, choppiness } = this.wanted;
        this.wanted = null;
        const { blend } = this;
        blend.prepare(tick);
        const { scaleTo, scaleFrom, to, from, document } = blend;
        if (this.revision !== blend.revision) {
          const sets = to.map((tile, i) => ({ to: tile, from: from[i] }));
          this.revision = blend.revision;
          this.request('load', { sets, ticks: document.ticks });
        }
        const step = { tick, choppiness, scaleTo, scaleFrom };
        const { maps } = await this.request('step', step);
        this.show(to, maps);
        this.shown = step;
      }
    } finally {
      this.running = null;
    }
  }

  /** Return the eight fields of a tile, as the maps are made of them. */
  async readFields(index) {
    await this.running;
    const { tick, scaleTo, scaleFrom } = this.shown;
    return (await this.request('read', { index, tick, scaleTo, scaleFrom })).fields;
  }

  /** Upload maps; make the tiles anew if they are others. */
  show(tiles, maps) {
    const fits = ({ nx, ny }, i) => nx === tiles[i].nx && ny === tiles[i].ny;
    if (this.tiles.length !== tiles.length || !this.tiles.every(fits)) {
      for (const tile of this.tiles) disposeMaps(tile.maps);
      this.tiles = tiles.map(({ nx, ny }) => {
        return { nx, ny, maps: makeMaps(this.gl, nx, ny, this.anisotropy) };
      });
    }
    this.tiles.forEach((tile, i) => {
      const { lx, ly } = tiles[i];
      Object.assign(tile, { lx, ly });
      for (const [name, levels] of Object.entries(maps[i])) {
        levels.forEach((level, number) => tile.maps[name].upload(level, number));
      }
    });
  }

  /** Ask the Worker for something; return a promise of its answer. */
  request(kind, values) {
    if (this.failure) return Promise.reject(new Error(this.failure));
    const number = (this.count = (this.count ?? 0) + 1);
    return new Promise((resolve, reject) => {
      this.requests.set(number, { resolve, reject });
      this.worker.postMessage({ kind, number, ...values });
    });
  }

  /** Settle the request that an answer of the Worker belongs to. */
  receive({ number, failed, ...answer }) {
    const { resolve, reject } = this.requests.get(number);
    this.requests.delete(number);
    if (failed) reject(new Error(`the Worker that computes the sea failed: ${failed}`));
    else resolve(answer);
  }

  /** Refuse all requests, now and later. */
  fail(message) {
    this.failure = message;
    this.note = message;
    for (const { reject } of this.requests.values()) reject(new Error(message));
    this.requests.clear();
  }

  /** End the Worker and free everything. */
  dispose() {
    this.worker.terminate();
    this.fail('the simulation has ended');
    for (const tile of this.tiles) disposeMaps(tile.maps);
    this.tiles = [];
  }
}

/**
 * Return a sea of at most `most` samples a side, and the number of waves that it cannot hold.
 *
 * Every other sample of a tile shows the same waves, but for those that are too short for them;
 * the variance of their slopes is then beyond the tiles.
 */
export function reduced(sea, most) {
  let lost = 0;
  const slopes = [0, 0, 0]; // xx, yy, xy
  const tiles = sea.tiles.map((tile) => {
    const { nx, ny, lx, ly, h0, wave } = tile;
    if (nx <= most && ny <= most) return tile;
    const [fewerX, fewerY] = [Math.min(nx, most), Math.min(ny, most)];
    const less = {
      ...tile,
      nx: fewerX,
      ny: fewerY,
      h0: new Float32Array(4 * fewerX * fewerY),
      wave: new Float32Array(2 * fewerX * fewerY),
    };
    for (let j = 0; j < ny; j++) {
      const my = 2 * j < ny ? j : j - ny;
      for (let i = 0; i < nx; i++) {
        const mx = 2 * i < nx ? i : i - nx;
        const at = j * nx + i;
        if (2 * Math.abs(mx) < fewerX && 2 * Math.abs(my) < fewerY) {
          const to = (my & (fewerY - 1)) * fewerX + (mx & (fewerX - 1));
          less.h0.set(h0.subarray(4 * at, 4 * at + 4), 4 * to);
          less.wave.set(wave.subarray(2 * at, 2 * at + 2), 2 * to);
        } else if (h0[4 * at] || h0[4 * at + 1]) {
          const variance = 2 * (h0[4 * at] ** 2 + h0[4 * at + 1] ** 2); // a^2/2
          const [kx, ky] = [(2 * Math.PI * mx) / lx, (2 * Math.PI * my) / ly];
          [kx * kx, ky * ky, kx * ky].forEach((factor, n) => (slopes[n] += variance * factor));
          lost++;
        }
      }
    }
    return less;
  });
  const { slope_variance: whole } = sea.document;
  if (!lost || !whole) return { sea: { ...sea, tiles }, lost };
  const slope_variance = {
    ...whole,
    captured: whole.captured.map((value, n) => value - slopes[n]),
    beyond: whole.beyond.map((value, n) => value + slopes[n]),
  };
  return { sea: { ...sea, tiles, document: { ...sea.document, slope_variance } }, lost };
}
