// Inverse Fourier transforms of a tile's fields on the GPU.
import { drawFullscreen, program, target, texture } from './gl.js';
import { stepShader } from './shaders/transform.js';
import { twiddleTable } from './fft.js';

/** Programs and tables of the transforms, and the targets between their steps, by size. */
export class Transforms {
  /** Compile the steps; see `createSimulation` for `edited`. */
  constructor(gl, edited) {
    this.gl = gl;
    const step = (radix) => program(gl, edited(stepShader(radix)));
    this.steps = { 2: step(2), 4: step(4) };
    this.twiddles = new Map();
    this.targets = new Map();
  }

  /** Return the two targets for fields of one size, made when first asked for. */
  targetsOf(nx, ny) {
    const { gl } = this;
    const key = `${nx} x ${ny}`;
    if (!this.targets.has(key)) {
      const plane = () => texture(gl, { format: 'RGBA32F', width: nx, height: ny });
      this.targets.set(
        key,
        [0, 1].map(() => target(gl, [plane(), plane()])),
      );
    }
    return this.targets.get(key);
  }

  /** Return the texture of the twiddle factors of n samples. */
  twiddlesOf(n) {
    if (!this.twiddles.has(n)) {
      const data = Float32Array.from(twiddleTable(n));
      this.twiddles.set(n, texture(this.gl, { format: 'RG32F', width: n, height: 1, data }));
    }
    return this.twiddles.get(n);
  }

  /** Transform what the first target of a size holds; return the target of the result. */
  run(nx, ny) {
    let [from, to] = this.targetsOf(nx, ny);
    for (const [axis, samples] of [nx, ny].entries()) {
      const twiddles = this.twiddlesOf(samples);
      let block = 1;
      while (block < samples) {
        // The step of radix 2, where one is needed, comes first: its factors are 1 and -1.
        const radix = block === 1 && Math.log2(samples) % 2 ? 2 : 4;
        block *= radix;
        const [input_first, input_second] = from.textures;
        const values = { input_first, input_second, twiddles, samples, block, axis };
        drawFullscreen(this.gl, this.steps[radix], values, to);
        [from, to] = [to, from];
      }
    }
    return from;
  }

  /** Free everything. */
  dispose() {
    const all = [...Object.values(this.steps), ...this.twiddles.values()];
    for (const one of [...all, ...[...this.targets.values()].flat()]) one.dispose();
  }
}
