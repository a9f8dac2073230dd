// A bake that is played: its frames as textures, in the place of a simulation.
import { readMessage } from './container.js';
import { drawFullscreen, program, target, texture } from './gl.js';
import { disposeMaps, makeMaps } from './maps.js';
import { BLEND_FRAMES_SHADER } from './shaders/blend_frames.js';

/** Bytes of frames that are kept, in the order in which they will be shown. */
export const MEMORY = 128 * 2 ** 20;

/** Most frames of tiles that are asked for and have not come. */
export const MOST_REQUESTS = 8;

/** Time without an answer after which a frame is asked for again [ms], and doublings of it. */
const PATIENCE = 2000;
const MOST_DOUBLINGS = 4;

const MAPS = ['displacement', 'slopes', 'moments'];
const ALIGNMENT = 16;
const DONE = Promise.resolve();

/**
 * Decode one frame of a tile.
 *
 * @param {ArrayBuffer|ArrayBufferView} data
 * @returns {{tile: number, frame: number, nx: number, ny: number, maps: Uint16Array[]}} the maps of
 *   `makeMaps` in their order, as bits of half floats, four a texel
 */
export function decodeFrame(data) {
  const { header, rest } = readMessage(data, 'FFTB');
  const { tile, frame, nx, ny } = header;
  const numbers = 4 * nx * ny;
  const padded = Math.ceil((2 * numbers) / ALIGNMENT) * ALIGNMENT;
  if (rest.length < MAPS.length * padded) {
    throw new Error(
      `a frame of ${nx} x ${ny} must have ${MAPS.length * padded} bytes, got ${rest.length}`,
    );
  }
  const maps = MAPS.map((_, i) => {
    const bytes = rest.subarray(i * padded, i * padded + 2 * numbers);
    // an array of 16-bit numbers must begin at an even byte
    const even = bytes.byteOffset % 2 ? bytes.slice() : bytes;
    return new Uint16Array(even.buffer, even.byteOffset, numbers);
  });
  return { tile, frame, nx, ny, maps };
}

/**
 * The frames of a bake, with the interface of a simulation.
 *
 * Frames are asked for in the order in which they will be shown, as many ahead as fit into memory.
 * A bake that fits as a whole is asked for once. While a frame has not come, the one before stays.
 */
export class Playback {
  /**
   * Make the textures, and ask for the first frames.
   *
   * @param {WebGL2RenderingContext} gl
   * @param {object} manifest of Python's `Playback.manifest`
   * @param {function(number, number): (void|Promise<ArrayBuffer>)} requestFrame asks for a frame of
   *   a tile, which its promise brings, or `receive`
   * @param {object} [options]
   * @param {boolean} [options.blend] blend linearly between two frames: smoother, but short waves
   *   lose height half way between two frames; without it frames are shown as they were baked
   * @param {function()} [options.onChange] hears that there is another frame to show
   * @param {number} [options.memory] bytes of frames to keep
   * @param {function(): number} [options.now] the time [ms]
   */
  constructor(gl, manifest, requestFrame, options = {}) {
    gl.getExtension('EXT_color_buffer_float') ?? gl.getExtension('EXT_color_buffer_half_float');
    this.gl = gl;
    this.kind = 'playback';
    this.note = '';
    this.document = manifest;
    this.requestFrame = requestFrame;
    this.blend = options.blend ?? false;
    this.onChange = options.onChange ?? (() => {});
    this.now = options.now ?? (() => performance.now());
    this.tiles = manifest.tiles.map(({ n: [nx, ny], size: [lx, ly] }) => {
      return { nx, ny, lx, ly, maps: makeMaps(gl, nx, ny, 8) };
    });
    const bytes = this.tiles.reduce((sum, { nx, ny }) => sum + 24 * nx * ny, 0);
    const fitting = Math.floor((options.memory ?? MEMORY) / bytes);
    this.ahead = Math.min(Math.max(fitting, 2), manifest.frames);
    this.frames = new Map(); // of each frame, what has come of its tiles
    this.requests = new Map(); // of each frame of a tile, when it was asked for and how often
    this.position = 0;
    this.shown = '';
    this.blending = null;
    this.request();
  }

  /** The number of the frame that is due, from 0. */
  get frame() {
    return Math.floor(this.position);
  }

  /** The frame that the textures show, or null before the first. */
  get shownFrame() {
    return this.shown === '' ? null : Number.parseInt(this.shown, 10);
  }

  /** True if the whole bake is kept once it has come. */
  get fits() {
    return this.ahead === this.document.frames;
  }

  /** True if all frames are here. */
  get whole() {
    return this.fits && Array.from({ length: this.ahead }, (_, i) => i).every((i) => this.has(i));
  }

  /** Always 1: nothing is being changed into another sea. */
  get weight() {
    return 1;
  }

  /** Show the frame that is due at a tick of the loop; the choppiness is that of the bake. */
  step(tick) {
    const { frames, ticks } = this.document;
    this.position = ((tick % ticks) * frames) / ticks;
    this.request();
    if (!this.gl.isContextLost()) this.show();
    return DONE;
  }

  /** Take a frame of a tile. */
  receive(data) {
    const { tile, frame, nx, ny, maps } = decodeFrame(data);
    const expected = this.tiles[tile];
    if (!expected || nx !== expected.nx || ny !== expected.ny) {
      throw new Error(`a frame of tile ${tile} must have its samples, got ${nx} x ${ny}`);
    }
    this.requests.delete(keyOf(tile, frame));
    if (!this.isAhead(frame)) return;
    if (!this.frames.has(frame)) this.frames.set(frame, []);
    this.frames.get(frame)[tile] = maps;
    this.request();
    if (this.has(frame)) this.onChange();
  }

  /** Ask for the frames that come next, and forget those that were shown. */
  request() {
    const { frames } = this.document;
    for (const frame of this.frames.keys()) if (!this.isAhead(frame)) this.frames.delete(frame);
    for (const [key, { frame }] of this.requests) {
      if (!this.isAhead(frame)) this.requests.delete(key);
    }
    const now = this.now();
    let waiting = 0;
    for (const { until } of this.requests.values()) if (now < until) waiting += 1;
    for (let i = 0; i < this.ahead; i++) {
      const frame = (this.frame + i) % frames;
      for (let tile = 0; tile < this.tiles.length; tile++) {
        if (waiting >= MOST_REQUESTS) return;
        if (this.frames.get(frame)?.[tile]) continue;
        const key = keyOf(tile, frame);
        const before = this.requests.get(key);
        if (before && (now < before.until || before.times > MOST_DOUBLINGS)) continue;
        const times = (before?.times ?? 0) + 1;
        this.requests.set(key, { frame, times, until: now + PATIENCE * 2 ** (times - 1) });
        waiting += 1;
        this.ask(tile, frame);
      }
    }
  }

  /** Ask for one frame of a tile; a request that fails is repeated later. */
  ask(tile, frame) {
    const answer = this.requestFrame(tile, frame);
    answer?.then?.(
      (data) => this.gl && this.receive(data),
      (error) => (this.note = String(error.message ?? error)),
    );
  }

  /** Return true if a frame is one of those that are kept. */
  isAhead(frame) {
    const { frames } = this.document;
    return (frame - this.frame + frames) % frames < this.ahead;
  }

  /** Return true if every tile of a frame has come. */
  has(frame) {
    const come = this.frames.get(frame);
    return Boolean(come) && this.tiles.every((_, tile) => come[tile]);
  }

  /** Bring the textures to the frame that is due, if it has come. */
  show() {
    const { frame, document } = this;
    if (!this.has(frame)) return;
    const next = (frame + 1) % document.frames;
    const share = this.blend && this.has(next) ? this.position - frame : 0;
    const shown = `${frame} ${share}`;
    if (shown === this.shown) return;
    if (share > 0) this.showBlended(frame, next, share);
    else this.upload(frame);
    this.shown = shown;
  }

  /** Upload a frame as it was baked. */
  upload(frame) {
    this.tiles.forEach(({ maps }, tile) => {
      MAPS.forEach((name, i) => {
        maps[name].upload(this.frames.get(frame)[tile][i]);
        maps[name].generateMips();
      });
    });
  }

  /** Draw what lies between two frames. */
  showBlended(before, after, share) {
    const { gl } = this;
    this.blending ??= this.makeBlending();
    for (const state of [gl.BLEND, gl.DEPTH_TEST, gl.CULL_FACE, gl.SCISSOR_TEST]) gl.disable(state);
    this.tiles.forEach(({ maps }, tile) => {
      const { ends, into } = this.blending.tiles[tile];
      [before, after].forEach((frame, end) => {
        if (ends[end].frame === frame) return;
        const [displacement, slopes] = this.frames.get(frame)[tile];
        ends[end].displacement.upload(displacement);
        ends[end].slopes.upload(slopes);
        ends[end].frame = frame;
      });
      const values = {
        share,
        displacement_before: ends[0].displacement,
        displacement_after: ends[1].displacement,
        slopes_before: ends[0].slopes,
        slopes_after: ends[1].slopes,
      };
      drawFullscreen(gl, this.blending.program, values, into);
      for (const map of Object.values(maps)) map.generateMips();
    });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** Make what blending needs: two frames of each tile, and targets of its maps. */
  makeBlending() {
    const { gl } = this;
    const tiles = this.tiles.map(({ nx, ny, maps }) => {
      const plane = () => texture(gl, { format: 'RGBA16F', width: nx, height: ny });
      const end = () => ({ displacement: plane(), slopes: plane(), frame: -1 });
      return { ends: [end(), end()], into: target(gl, Object.values(maps)) };
    });
    return { program: program(gl, BLEND_FRAMES_SHADER), tiles };
  }

  /** Free everything. */
  dispose() {
    for (const { maps } of this.tiles) disposeMaps(maps);
    if (this.blending) {
      this.blending.program.dispose();
      for (const { ends, into } of this.blending.tiles) {
        into.dispose({ keepTextures: true });
        for (const { displacement, slopes } of ends) {
          displacement.dispose();
          slopes.dispose();
        }
      }
    }
    this.frames.clear();
    this.requests.clear();
    this.tiles = [];
    this.gl = null;
  }
}

/** Return the key of a frame of a tile. */
function keyOf(tile, frame) {
  return `${tile} ${frame}`;
}
