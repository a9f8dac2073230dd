// The sea on the graphics processor: buffers, and the dispatches of the kernels of fftocean.wgsl (docs/kernels.md).
import { readPackage, tablesOf } from './package.js';

const SEA_BYTES = 1120, TABLE = 96, TILE_BYTES = 64, MOST_TILES = 16;
const BINDINGS = {
  rows: [0, 1, 2, 3, 4],
  columns: [0, 3, 4, 5],
  foam: [0, 5],
  mips: [0, 5],
  mips_far: [0, 5],
  textures: [0, 5, 6, 9],
  heights: [0, 5, 7, 8],
};

/** Return the sides of all levels of a plane. */
export function levelsOf(nx, ny) {
  const levels = [[nx, ny]];
  while (nx * ny > 1) levels.push([(nx = Math.max(1, nx >> 1)), (ny = Math.max(1, ny >> 1))]);
  return levels;
}

const fraction = (x) => x - Math.floor(x);

/** All tiles of a package, and the foam of their sum. */
export class Sea {
  /**
   * Read the package of a folder.
   *
   * @param {object} foam side: cells of the window of foam, a power of two; cell: side of one [m]
   */
  static async load(folder, { foam = { side: 512, cell: 0.5 }, changed = (kernels) => kernels } = {}) {
    const { document, file } = await readPackage(folder);
    if (document.tiles.length > MOST_TILES) throw new Error(`a sea must have at most ${MOST_TILES} tiles, got ${document.tiles.length}`);
    const sea = new Sea();
    sea.document = document;
    sea.foam = { ...document.foam, ...foam, corner: [0, 0], before: [2 ** 20, 2 ** 20] };
    sea.tiles = await Promise.all(document.tiles.map(async (_, i) => tablesOf(document, i, await file(`tile${i}.waves`))));
    sea.kernels = changed(new TextDecoder().decode(await file('fftocean.wgsl')));
    sea.twiddle = await file('twiddle.bin');
    sea.reference = JSON.parse(new TextDecoder().decode(await file('check.json')));
    sea.#place();
    sea.device = await sea.#openDevice();
    sea.#fill();
    return sea;
  }

  /** Give each tile and plane its place in the buffers. */
  #place() {
    this.planes = [];
    let texels = 0, at = 0;
    const plane = (nx, ny) => {
      this.planes.push({ first: at, levels: levelsOf(nx, ny) });
      at += this.planes.at(-1).levels.reduce((sum, [w, h]) => sum + w * h, 0);
    };
    for (const tile of this.tiles) {
      Object.assign(tile, { first: texels, firstMap: at });
      texels += tile.nx * tile.ny;
      for (let i = 0; i < 3; i++) plane(tile.nx, tile.ny);
    }
    plane(this.foam.side, this.foam.side);
    Object.assign(this, { texels, mapBytes: 16 * at });
  }

  async #openDevice() {
    if (!navigator.gpu) throw new Error(missing('this browser has no WebGPU'));
    const adapter = await navigator.gpu.requestAdapter({ powerPreference: 'high-performance' });
    if (!adapter) throw new Error(missing('this browser has WebGPU, but no graphics processor for it'));
    const needed = { maxStorageBufferBindingSize: this.mapBytes, maxBufferSize: this.mapBytes };
    for (const [name, size] of Object.entries(needed)) {
      if (size > adapter.limits[name]) throw new Error(`the maps of this sea take ${size} bytes; ${name} of this device is ${adapter.limits[name]}`);
      if (size <= 2 ** 27) delete needed[name]; // every device has as much
    }
    return adapter.requestDevice({ requiredLimits: needed });
  }

  #fill() {
    const { device } = this, { UNIFORM, STORAGE, COPY_DST, COPY_SRC } = GPUBufferUsage;
    const buffer = (size, usage) => device.createBuffer({ size, usage });
    const h0 = new Float32Array(4 * this.texels), wave = new Float32Array(2 * this.texels);
    for (const tile of this.tiles) {
      h0.set(tile.h0, 4 * tile.first);
      wave.set(tile.wave, 2 * tile.first);
    }
    this.buffers = { 0: buffer(SEA_BYTES, UNIFORM | COPY_DST), 4: buffer(32 * this.texels, STORAGE), 5: buffer(this.mapBytes, STORAGE | COPY_SRC) };
    [h0, wave, this.twiddle].forEach((data, i) => {
      this.buffers[i + 1] = buffer(data.byteLength, STORAGE | COPY_DST);
      device.queue.writeBuffer(this.buffers[i + 1], 0, data);
    });
    this.module = device.createShaderModule({ code: this.kernels });
    this.pipelines = {};
    this.groups = {};
  }

  /** Add a dispatch of a kernel to a pass; `others` are resources by binding, and `key` names a bind group that is kept. */
  dispatch(pass, kernel, groups, others = {}, key = kernel) {
    this.pipelines[kernel] ??= this.device.createComputePipeline({ layout: 'auto', compute: { module: this.module, entryPoint: kernel } });
    this.groups[key] ??= this.device.createBindGroup({
      layout: this.pipelines[kernel].getBindGroupLayout(0),
      entries: BINDINGS[kernel].map((binding) => ({ binding, resource: others[binding] ?? { buffer: this.buffers[binding] } })),
    });
    pass.setPipeline(this.pipelines[kernel]);
    pass.setBindGroup(0, this.groups[key]);
    pass.dispatchWorkgroups(...groups);
  }

  /** Write the uniform block: the moment, the place of the eye, and the step of foam [s]. */
  set({ tick, eye = [0, 0], seconds = 0, choppiness = this.document.choppiness, points = 0, iterations = 4 }) {
    const { document, foam, tiles } = this;
    const block = new ArrayBuffer(SEA_BYTES), u = new Uint32Array(block), i = new Int32Array(block), f = new Float32Array(block);
    foam.corner = eye.map((at) => Math.floor(at / foam.cell) - foam.side / 2);
    u.set([tick, document.ticks - 1, tiles.length, this.twiddle.byteLength / 8]);
    f.set([1 / document.ticks, choppiness], 4);
    u.set([points, iterations], 6);
    i.set([...foam.corner, ...foam.before], 8);
    f.set([...foam.corner.map((cell, axis) => (cell + 0.5) * foam.cell - eye[axis]), foam.cell, seconds], 12);
    f.set([foam.decay, foam.threshold, foam.strength], 16);
    u.set([foam.side, this.planes.at(-1).first], 19);
    tiles.forEach(({ nx, ny, first, firstMap, lx, ly, lifts }, index) => {
      const at = (TABLE + index * TILE_BYTES) / 4;
      u.set([nx, ny, first, firstMap], at);
      f.set([lx, ly, (2 * Math.PI) / lx, (2 * Math.PI) / ly, ...lifts, fraction(eye[0] / lx), fraction(eye[1] / ly)], at + 4);
    });
    this.device.queue.writeBuffer(this.buffers[0], 0, block);
  }

  /** Add the kernels that compute all tiles to a pass. */
  frame(pass) {
    const most = Math.max(...this.tiles.map(({ nx, ny }) => Math.max(1, (nx * ny) / 512)));
    this.dispatch(pass, 'rows', [most, this.tiles.length]);
    this.dispatch(pass, 'columns', [most, this.tiles.length]);
  }

  /** Add a step of foam to a pass. */
  stepFoam(pass) {
    this.dispatch(pass, 'foam', [Math.ceil(this.foam.side / 8), Math.ceil(this.foam.side / 8)]);
    this.foam.before = this.foam.corner;
  }

  /** Add the averages of all planes to a pass. */
  average(pass) {
    const most = [0, 1].map((axis) => Math.max(...this.planes.map(({ levels }) => levels[0][axis])));
    this.dispatch(pass, 'mips', [...most.map((n) => Math.ceil(n / 32)), this.planes.length]);
    this.dispatch(pass, 'mips_far', [...most.map((n) => Math.ceil(n / 1024)), this.planes.length]);
  }

  /** Make a texture of each plane, with all its levels. */
  makeTextures() {
    const { TEXTURE_BINDING, STORAGE_BINDING } = GPUTextureUsage;
    this.textures = this.planes.map(({ levels }) => this.device.createTexture({
      size: levels[0], format: 'rgba16float', mipLevelCount: levels.length, usage: TEXTURE_BINDING | STORAGE_BINDING,
    }));
    this.targets = this.planes.map(({ levels }, plane) => levels.map((_, level) => {
      const target = this.device.createBuffer({ size: 16, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
      this.device.queue.writeBuffer(target, 0, new Uint32Array([plane, level, 0, 0]));
      return { 6: this.textures[plane].createView({ baseMipLevel: level, mipLevelCount: 1 }), 9: { buffer: target } };
    }));
  }

  /** Add the copies of all planes to their textures to a pass. */
  copyToTextures(pass) {
    this.planes.forEach(({ levels }, plane) => levels.forEach(([w, h], level) => {
      this.dispatch(pass, 'textures', [Math.ceil(w / 8), Math.ceil(h / 8)], this.targets[plane][level], `texture ${plane} ${level}`);
    }));
  }

  /** Return the eight fields of each tile at a tick, before choppiness. */
  async fields(tick) {
    this.set({ tick, choppiness: 1 });
    const maps = await this.read(5, (pass) => this.frame(pass));
    return this.tiles.map(({ nx, ny }, tile) => {
      const at = (plane, channel) => {
        const first = 4 * this.planes[3 * tile + plane].first + channel;
        return Float32Array.from({ length: nx * ny }, (_, i) => maps[first + 4 * i]);
      };
      return {
        height: at(0, 2), displace_x: at(0, 0), displace_y: at(0, 1), slope_x: at(1, 0), slope_y: at(1, 1),
        stretch_xx: at(1, 2), stretch_xy: at(0, 3), stretch_yy: at(1, 3),
      };
    });
  }

  /** Run kernels, and return the numbers of a buffer after them. */
  async read(binding, kernels, buffer = this.buffers[binding]) {
    const { size } = buffer;
    const copy = this.device.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    const encoder = this.device.createCommandEncoder(), pass = encoder.beginComputePass();
    kernels(pass);
    pass.end();
    encoder.copyBufferToBuffer(buffer, 0, copy, 0, size);
    this.device.queue.submit([encoder.finish()]);
    await copy.mapAsync(GPUMapMode.READ);
    const numbers = new Float32Array(copy.getMappedRange()).slice();
    copy.destroy();
    return numbers;
  }
}

function missing(reason) {
  return `This page needs WebGPU, and ${reason}.\nChrome and Edge 113, Safari 26 and Firefox 141 have it, on pages from https:// or localhost.`;
}
