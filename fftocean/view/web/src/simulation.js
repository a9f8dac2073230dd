// A sea that moves: its waves evolved and transformed on the GPU, or in a Worker.
import { FIELDS, requirePowerOfTwo } from './container.js';
import { drawFullscreen, program, target, texture } from './gl.js';
import { makeMaps } from './maps.js';
import { MovingSea } from './moving_sea.js';
import { part } from './parts.js';
import { EVOLVE_SHADER } from './shaders/evolve.js';
import { MAPS_SHADER } from './shaders/maps.js';
import { Transforms } from './transform.js';

/**
 * Make a simulation of a sea.
 *
 * After the loss of the context, dispose of it and make another one of the same `sea`.
 *
 * @param {WebGL2RenderingContext} gl
 * @param {object} sea of `decodeSea`
 * @param {object} [options]
 * @param {'gpu'|'worker'} [options.prefer] the Worker takes over where the GPU cannot draw into
 *   32-bit floats, whatever is preferred
 * @param {number} [options.anisotropy] of the maps of slopes and moments; 1 for none
 * @param {function(): Worker} [options.makeWorker] start another Worker than the page's own
 * @param {function(string): string} [options.edited] changes the source of a shader, for tests
 * @returns {Promise<GpuSimulation|WorkerSimulation>} with
 *   kind: 'gpu' or 'worker', and note: a sentence for the screen, empty for the GPU;
 *   document, sea: of the newest sea whose tiles are shown;
 *   tiles: a list of {nx, ny, lx, ly, maps: {displacement, slopes, moments}}, textures of `gl.js`;
 *   weight: the share of the newest sea, 1 when nothing is being blended;
 *   tick, choppiness: what the maps show;
 *   step(tick, choppiness): bring the maps to a tick; a promise for when they are;
 *   readFields(tile): a promise of the eight fields of a tile at `tick`, each a Float32Array;
 *   replace(sea, seconds): change into another sea, a promise for the beginning of the change;
 *   advance(seconds): let a change go on;
 *   dispose(): free everything.
 */
export async function createSimulation(gl, sea, options = {}) {
  for (const { nx, ny } of sea.tiles) {
    requirePowerOfTwo('n', nx);
    requirePowerOfTwo('n', ny);
  }
  if (options.prefer !== 'worker' && drawsFloats(gl)) return new GpuSimulation(gl, sea, options);
  return (await part('worker_simulation')).WorkerSimulation.start(gl, sea, options);
}

/** Return true if two textures of 32-bit floats can be drawn into at once. */
export function drawsFloats(gl) {
  if (!gl.getExtension('EXT_color_buffer_float')) return false;
  const plane = () => texture(gl, { format: 'RGBA32F', width: 4, height: 4 });
  const probe = target(gl, [plane(), plane()]);
  const { complete } = probe;
  probe.dispose();
  return complete;
}

/** A simulation on the GPU; see `createSimulation`. */
export class GpuSimulation extends MovingSea {
  /** Compile the shaders and upload a sea. */
  constructor(gl, sea, { edited = (source) => source, anisotropy = 8 } = {}) {
    super(gl, anisotropy);
    this.begin(sea);
    this.kind = 'gpu';
    this.note = '';
    this.evolve = program(gl, edited(EVOLVE_SHADER));
    this.transforms = new Transforms(gl, edited);
    this.shade = program(gl, MAPS_SHADER);
    this.revision = -1;
    this.tick = 0;
    this.choppiness = sea.document.choppiness ?? 1;
    this.upload();
  }

  /** Bring the maps to a tick of the loop; the promise is there for the Worker's sake. */
  step(tick, choppiness = this.choppiness) {
    const { gl } = this;
    if (gl.isContextLost()) return DONE;
    this.tick = tick >>> 0;
    this.choppiness = choppiness;
    this.blend.prepare(this.tick);
    if (this.revision !== this.blend.revision) this.upload();
    for (const state of [gl.BLEND, gl.DEPTH_TEST, gl.CULL_FACE, gl.SCISSOR_TEST]) gl.disable(state);
    for (const tile of this.tiles) {
      const fields = this.fieldsOf(tile);
      const [input_first, input_second] = fields.textures;
      const { lifts } = tile;
      const values = { input_first, input_second, choppiness, lifts };
      drawFullscreen(gl, this.shade, values, tile.target);
      for (const map of tile.target.textures) map.generateMips();
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return DONE;
  }

  /** Return the eight fields of a tile, as the maps are made of them. */
  async readFields(index) {
    const tile = this.tiles[index];
    const target = this.fieldsOf(tile);
    const planes = [target.read(0), target.read(1)];
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, null);
    const fields = {};
    FIELDS.forEach((name, field) => {
      const values = new Float32Array(tile.nx * tile.ny);
      const plane = planes[field >> 2];
      const factor = field & 1 ? 1 / tile.lifts[field >> 1] : 1; // a power of two
      for (let i = 0; i < values.length; i++) values[i] = factor * plane[4 * i + (field & 3)];
      fields[name] = values;
    });
    return fields;
  }

  /** Return the target that holds the fields of a tile at the tick. */
  fieldsOf(tile) {
    const { blend } = this;
    const { nx, ny, lx, ly, lifts } = tile;
    const values = {
      ...tile.tables,
      samples: [nx, ny],
      wavenumber_step: [(2 * Math.PI) / lx, (2 * Math.PI) / ly],
      tick: this.tick,
      mask: this.document.ticks - 1,
      turns_per_tick: 1 / this.document.ticks,
      lifts,
      scale_to: blend.scaleTo,
      scale_from: blend.scaleFrom,
    };
    drawFullscreen(this.gl, this.evolve, values, this.transforms.targetsOf(nx, ny)[0]);
    return this.transforms.run(nx, ny);
  }

  /** Upload the tables of the waves; make the tiles anew if they are others. */
  upload() {
    const { blend, gl } = this;
    const fits = (tile, i) => ['nx', 'ny'].every((name) => tile[name] === blend.to[i][name]);
    if (this.tiles.length !== blend.to.length || !this.tiles.every(fits)) {
      for (const tile of this.tiles) disposeTile(tile);
      this.tiles = blend.to.map(({ nx, ny }) => makeTile(gl, nx, ny, this.anisotropy));
    }
    this.tiles.forEach((tile, i) => {
      const { lx, ly, lifts, h0, wave } = blend.to[i];
      Object.assign(tile, { lx, ly, lifts });
      tile.tables.h0_to.upload(h0);
      tile.tables.wave_to.upload(wave);
      tile.tables.h0_from.upload(blend.from[i].h0);
      tile.tables.wave_from.upload(blend.from[i].wave);
    });
    this.revision = blend.revision;
  }

  /** Free everything. */
  dispose() {
    for (const tile of this.tiles) disposeTile(tile);
    this.tiles = [];
    for (const one of [this.evolve, this.transforms, this.shade]) one.dispose();
  }
}

const DONE = Promise.resolve();

/** Return a tile with empty tables and maps. */
function makeTile(gl, nx, ny, anisotropy) {
  const size = { width: nx, height: ny };
  const table = (format) => texture(gl, { format, ...size });
  const tables = {
    h0_to: table('RGBA32F'),
    h0_from: table('RGBA32F'),
    wave_to: table('RG32F'),
    wave_from: table('RG32F'),
  };
  const maps = makeMaps(gl, nx, ny, anisotropy);
  const made = target(gl, Object.values(maps));
  return { nx, ny, tables, maps, target: made };
}

/** Free the textures of a tile. */
function disposeTile(tile) {
  tile.target.dispose();
  for (const table of Object.values(tile.tables)) table.dispose();
}
