// A live sea on the graphics processor: waves evolved to a tick, inverse Fourier transforms, maps.
import * as THREE from 'three';
import { Passes, floatTarget, mapTarget, numbers, pass } from './passes.js';

// Cosine and sine of a phase in turns, by polynomials about the nearest quarter: the platform's own
// promise no more than 2^-11, which would be a thousand times coarser.
const PHASOR = `
vec2 phasor(float turn) {
  float quarter = floor(4.0 * turn + 0.5);
  float x = turn - 0.25 * quarter;
  float q = x * x;
  float s = x * (6.2831853 + q * (-41.341663 + q * (81.591983 + q * -75.369649)));
  float c = 1.0 + q * (-19.739209 + q * (64.939363 + q * (-85.447456 + q * 59.362561)));
  int quadrant = int(quarter) & 3;
  vec2 turned = (quadrant & 1) == 0 ? vec2(c, s) : vec2(-s, c);
  return (quadrant & 2) == 0 ? turned : -turned;
}`;

const OUT = 'layout(location = 0) out vec4 first; layout(location = 1) out vec4 second;';

// Eight real fields as four complex ones: (displace_x, displace_y), (height, stretch_xy lifted),
// (slope_x, slope_y), (stretch_xx, stretch_yy).
const EVOLVE = `${PHASOR}
uniform sampler2D h0, wave; uniform ivec2 samples; uniform vec2 step_k;
uniform uint tick, mask; uniform float turns_per_tick, mixed;
${OUT}
vec2 multiply(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }
vec2 times_i(vec2 a) { return vec2(-a.y, a.x); }
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 both = texelFetch(h0, at, 0);
  vec2 of = texelFetch(wave, at, 0).xy;
  // exact for ever: the product wraps at 2^32, and the ticks of a loop are a power of two
  vec2 phase = phasor(float((uint(of.x) * tick) & mask) * turns_per_tick);
  vec2 height = multiply(both.xy, vec2(phase.x, -phase.y)) + multiply(both.zw, phase);
  vec2 potential = height * of.y;
  ivec2 whole = ivec2(2 * at.x < samples.x ? at.x : at.x - samples.x,
                      2 * at.y < samples.y ? at.y : at.y - samples.y);
  vec2 k = vec2(whole) * step_k;
  vec2 displace_x = times_i(k.x * potential), displace_y = times_i(k.y * potential);
  vec2 slope_x = times_i(k.x * height), slope_y = times_i(k.y * height);
  first = vec4(displace_x + times_i(displace_y), height - mixed * k.x * k.y * times_i(potential));
  second = vec4(slope_x + times_i(slope_y), -k.x * k.x * potential - k.y * k.y * times_i(potential));
}`;

/** Return one Stockham step of `radix` parts along an axis, on four complex fields at once. */
const step = (radix) => `
uniform sampler2D input_first, input_second, twiddles; uniform int samples, block, axis;
${OUT}
vec4 multiply(vec2 w, vec4 v) { return vec4(w.x * v.xz - w.y * v.yw, w.x * v.yw + w.y * v.xz).xzyw; }
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  int i = axis == 0 ? at.x : at.y;
  int part = block / ${radix}, rest = i & (block - 1);
  int turn = rest * (samples / block), from = (i / block) * part + (rest & (part - 1));
  ivec2 apart = axis == 0 ? ivec2(samples / ${radix}, 0) : ivec2(0, samples / ${radix});
  at = axis == 0 ? ivec2(from, at.y) : ivec2(at.x, from);
  first = texelFetch(input_first, at, 0);
  second = texelFetch(input_second, at, 0);
  for (int p = 1; p < ${radix}; p++) {
    vec2 w = texelFetch(twiddles, ivec2((p * turn) & (samples - 1), 0), 0).xy;
    first += multiply(w, texelFetch(input_first, at + p * apart, 0));
    second += multiply(w, texelFetch(input_second, at + p * apart, 0));
  }
}`;

// Maps in three's axes: X east, Y up, Z south. A mirrored axis negates what is odd in it.
const MAPS = `
uniform sampler2D input_first, input_second; uniform float choppiness, mixed;
layout(location = 0) out vec4 displacement; // X, Y, Z, stretch_XZ
layout(location = 1) out vec4 slopes; // slope_X, slope_Z, stretch_XX, stretch_ZZ
layout(location = 2) out vec4 moments; // squares and product of the slopes
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 a = texelFetch(input_first, at, 0), b = texelFetch(input_second, at, 0);
  displacement = vec4(choppiness * a.x, a.z, -choppiness * a.y, -choppiness * a.w / mixed);
  slopes = vec4(b.x, -b.y, choppiness * b.zw);
  moments = vec4(slopes.xy * slopes.xy, slopes.x * slopes.y, 0.0);
}`;

/** Return the twiddle factors of a transform of n samples, in single precision. */
function twiddles(n) {
  const found = new Float32Array(2 * n);
  for (let i = 0; i < n; i++) {
    found[2 * i] = Math.cos((2 * Math.PI * i) / n);
    found[2 * i + 1] = Math.sin((2 * Math.PI * i) / n);
  }
  return numbers(found, n, 1, THREE.RGFormat);
}

const INPUTS = ['input_first', 'input_second'];

/** The sea of a package, ready for any tick of its loop. */
export class Simulation {
  constructor(renderer, { document, tiles }) {
    if (!renderer.extensions.has('EXT_color_buffer_float')) {
      throw new Error('this graphics processor cannot draw 32-bit float textures (EXT_color_buffer_float)');
    }
    this.document = document;
    this.passes = new Passes(renderer);
    this.evolve = pass(EVOLVE, ['h0', 'wave', 'samples', 'step_k', 'tick', 'mask', 'turns_per_tick', 'mixed']);
    this.steps = Object.fromEntries([2, 4].map((radix) => [radix, pass(step(radix), [...INPUTS, 'twiddles', 'samples', 'block', 'axis'])]));
    this.maps = pass(MAPS, [...INPUTS, 'choppiness', 'mixed']);
    this.tiles = tiles.map((tile) => {
      const [nx, ny] = tile.n;
      return {
        n: tile.n,
        size: tile.size,
        mixed: tile.mixed,
        vSign: 1,
        h0: numbers(tile.h0, nx, ny, THREE.RGBAFormat),
        wave: numbers(tile.wave, nx, ny, THREE.RGFormat),
        twiddles: tile.n.map(twiddles),
        fields: floatTarget(nx, ny, 2),
        other: floatTarget(nx, ny, 2),
        target: mapTarget(nx, ny, 3),
      };
    });
  }

  /** Bring all tiles to a tick: the eight fields, and the maps for the water. */
  update(tick) {
    for (const tile of this.tiles) {
      this.transform(tile, tick);
      this.passes.run(this.maps, { ...this.inputs(tile), choppiness: this.document.choppiness, mixed: tile.mixed }, tile.target);
    }
  }

  inputs(tile) {
    const [input_first, input_second] = tile.fields.textures;
    return { input_first, input_second };
  }

  transform(tile, tick) {
    const { ticks } = this.document;
    const [nx, ny] = tile.n, [lx, ly] = tile.size;
    this.passes.run(this.evolve, {
      h0: tile.h0, wave: tile.wave, samples: new THREE.Vector2(nx, ny),
      step_k: new THREE.Vector2((2 * Math.PI) / lx, (2 * Math.PI) / ly),
      tick: tick >>> 0, mask: ticks - 1, turns_per_tick: 1 / ticks, mixed: tile.mixed,
    }, tile.fields);
    for (const axis of [0, 1]) {
      const samples = tile.n[axis];
      for (let block = 1; block < samples; ) {
        const radix = samples / block >= 4 ? 4 : 2;
        block *= radix;
        this.passes.run(this.steps[radix], { ...this.inputs(tile), twiddles: tile.twiddles[axis], samples, block, axis }, tile.other);
        [tile.fields, tile.other] = [tile.other, tile.fields];
      }
    }
  }

  /** Return the eight fields of a tile, before choppiness, as fftocean names them, row 0 south. */
  fields(index) {
    const tile = this.tiles[index], [nx, ny] = tile.n;
    const [a, b] = [0, 1].map((which) => {
      const found = new Float32Array(4 * nx * ny);
      this.passes.renderer.readRenderTargetPixels(tile.fields, 0, 0, nx, ny, found, undefined, which);
      return found;
    });
    const every = (data, channel, over = 1) => Float32Array.from({ length: nx * ny }, (_, i) => data[4 * i + channel] / over);
    return {
      displace_x: every(a, 0), displace_y: every(a, 1), height: every(a, 2), stretch_xy: every(a, 3, tile.mixed),
      slope_x: every(b, 0), slope_y: every(b, 1), stretch_xx: every(b, 2), stretch_yy: every(b, 3),
    };
  }
}
