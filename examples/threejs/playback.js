// Plays a bake (`fftocean bake --engine three`): loads its maps as texture arrays and blends frames.
import * as THREE from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { read as readKtx2 } from 'three/addons/libs/ktx-parse.module.js';
import { Passes, mapTarget, pass } from './passes.js';

const FORMATS = ['bin', 'ktx2', 'exr', 'exr-float', 'exr-atlas'];

/** Raise an error that names the file and the rule, unless it holds. */
function require(holds, file, rule, got) {
  if (!holds) throw new Error(`${file}: ${rule}${got === undefined ? '' : `, got ${JSON.stringify(got)}`}`);
}

async function bytes(url) {
  const answer = await fetch(url);
  require(answer.ok, url.pathname, `it could not be read (${answer.status})`);
  return answer.arrayBuffer();
}

const json = async (url) => JSON.parse(new TextDecoder().decode(await bytes(url)));

/** Return four channels a texel of an array of texels. */
function asFour(data, texels) {
  const channels = data.length / texels;
  if (channels === 4) return data;
  const found = new data.constructor(4 * texels);
  for (let i = 0; i < texels; i++)
    for (let c = 0; c < 4; c++) found[4 * i + c] = data[channels * i + Math.min(c, channels - 1)];
  return found;
}

/** Return the frames of an atlas: cells from left to right, then down, with a gutter around each. */
function cut(image, sidecar) {
  const { frames, rows, columns, tiles: [across], gutter } = { gutter: 0, ...sidecar, ...sidecar.sampling.values };
  const { data, width, height } = image, all = asFour(data, width * height);
  const found = new data.constructor(4 * frames * rows * columns);
  const [wide, high] = [columns + 2 * gutter, rows + 2 * gutter];
  for (let frame = 0; frame < frames; frame++) {
    const left = (frame % across) * wide + gutter;
    // the loader put the last row of the file first
    const below = height - (Math.floor(frame / across) + 1) * high + gutter;
    for (let row = 0; row < rows; row++) {
      const from = 4 * ((below + row) * width + left);
      found.set(all.subarray(from, from + 4 * columns), 4 * (frame * rows + row) * columns);
    }
  }
  return found;
}

/** Loaders of each format: all frames of a map in one array, four numbers a texel. */
const LOADERS = {
  bin: async ({ base, name }) => new Uint16Array(await bytes(new URL(`${name}.bin`, base))),
  ktx2: async ({ base, name }) => {
    const { levels } = readKtx2(new Uint8Array(await bytes(new URL(`${name}.ktx2`, base))));
    return new Uint16Array(levels[0].levelData.slice().buffer);
  },
  exr: async ({ base, name, manifest, told, type = THREE.HalfFloatType }) => {
    const loader = new EXRLoader().setDataType(type);
    const paths = manifest.frames.map((row) => row.files[name].path);
    let found = null;
    for (const [frame, path] of paths.entries()) {
      const { data, width, height } = (await loader.loadAsync(new URL(path, base).href)).image;
      const four = asFour(data, width * height);
      found ??= new data.constructor(four.length * paths.length);
      found.set(four, frame * four.length);
      told(`${name}: frame ${frame + 1} of ${paths.length}`);
    }
    return found;
  },
  'exr-float': (map) => LOADERS.exr({ ...map, type: THREE.FloatType }),
  'exr-atlas': async ({ base, name }) => {
    const sidecar = await json(new URL(`${name}.json`, base));
    return cut((await new EXRLoader().loadAsync(new URL(`${name}.exr`, base).href)).image, sidecar);
  },
};

// A map of a frame in three's axes, as simulation.js makes them from waves.
const BLEND = `
uniform sampler2DArray MAPS;
uniform ivec2 frames; uniform float weight; uniform vec2 spacing; uniform float row_sign, normal_z; uniform bool packed;
layout(location = 0) out vec4 displacement; // X, Y, Z, stretch_XZ
layout(location = 1) out vec4 slopes; // slope_X, slope_Z, stretch_XX, stretch_ZZ
layout(location = 2) out vec4 moments; // squares and product of the slopes, foam

vec4 blended(sampler2DArray map, ivec2 at) {
  return mix(texelFetch(map, ivec3(at, frames.x), 0), texelFetch(map, ivec3(at, frames.y), 0), weight);
}

vec3 moved(ivec2 at) {
  ivec2 count = textureSize(PLACE, 0).xy;
  at = (at + count) % count;
#ifdef HAS_DISPLACEMENT
  return blended(displacement_map, at).xyz;
#else
  return vec3(0.0, blended(height_map, at).x, 0.0);
#endif
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  displacement = vec4(moved(at), 0.0);
  vec3 east = (moved(at + ivec2(1, 0)) - moved(at - ivec2(1, 0))) / (2.0 * spacing.x);
  vec3 south = row_sign * (moved(at + ivec2(0, 1)) - moved(at - ivec2(0, 1))) / (2.0 * spacing.y);
  slopes = vec4(east.y, south.y, east.x, south.z);
  displacement.w = 0.5 * (east.z + south.x);
#ifdef HAS_NORMAL
  vec3 n = blended(normal_map, at).xyz;
  if (packed) n = 2.0 * n - 1.0;
  // a normal is that of the displaced surface: slopes that need no stretch
  slopes = vec4(-n.x / max(n.z, 0.1), -normal_z * n.y / max(n.z, 0.1), 0.0, 0.0);
  displacement.w = 0.0;
#endif
#ifdef HAS_DERIVATIVE
  slopes = blended(derivative_map, at);
#endif
#ifdef HAS_STRETCH
  displacement.w = blended(stretch_map, at).y;
#endif
  moments = vec4(slopes.xy * slopes.xy, slopes.x * slopes.y, 0.0);
#ifdef HAS_FOAM
  moments.w = blended(foam_map, at).x;
#endif
}`;

/** Return the maps that the player takes of those of a bake. */
function wanted(maps) {
  const place = 'displacement' in maps ? 'displacement' : 'height';
  require(place in maps, 'manifest.json', 'maps must have displacement or height', Object.keys(maps));
  const light = 'derivative' in maps ? ['derivative', 'stretch'] : ['normal'];
  return [place, ...light, 'foam'].filter((name) => name in maps);
}

/** Return the manifests of a bake, of one tile or several: [{ base, manifest }]. */
async function manifestsOf(base, document) {
  if (!document.tiles) return [{ base, manifest: document }];
  require(document.tiles.length <= 4, 'cascade.json', 'tiles must be 1 to 4', document.tiles.length);
  return Promise.all(document.tiles.map(async ({ path }) => {
    require(/^tile\d+$/.test(path), 'cascade.json', 'path must be tile0, tile1, ...', path);
    const folder = new URL(`${path}/`, base);
    return { base: folder, manifest: await json(new URL('manifest.json', folder)) };
  }));
}

/** A bake that plays. */
export class Playback {
  /** Load a bake; `told` is called with what is being loaded. */
  static async load(renderer, base, document, told = () => {}) {
    const found = new Playback(renderer);
    for (const part of await manifestsOf(base, document)) found.tiles.push(await found.tile(part, told));
    found.document = found.tiles[0].manifest;
    const { values } = found.document.sampling;
    Object.assign(found, { loop: values.loop, frames: values.frames });
    return found;
  }

  constructor(renderer) {
    this.passes = new Passes(renderer);
    this.tiles = [];
  }

  /** Load the maps of a tile. */
  async tile({ base, manifest }, told) {
    const { conventions, sampling, maps } = manifest, { values } = sampling;
    const file = 'manifest.json';
    require(['three', 'three-exr'].includes(conventions.profile), file, 'the bake must be of --engine three', conventions.profile);
    const v = { 'Z / size_y - 0.5 / ny': -1, '-Z / size_y + 0.5 / ny': 1 }[sampling.v];
    require(v, file, 'sampling.v must be a rule of three.js', sampling.v);
    const textures = {}, names = wanted(maps);
    for (const name of names) {
      const { format, shape: [rows, columns] } = maps[name];
      require(FORMATS.includes(format), file, `format must be one of ${FORMATS.join(', ')}`, format);
      told(name);
      const data = await LOADERS[format]({ base, name, manifest, told });
      require(data.length === 4 * rows * columns * values.frames, name, `it must have ${values.frames} frames of ${columns} x ${rows}`);
      const texture = new THREE.DataArrayTexture(data, columns, rows, values.frames);
      texture.type = data instanceof Float32Array ? THREE.FloatType : THREE.HalfFloatType;
      texture.format = THREE.RGBAFormat;
      texture.minFilter = texture.magFilter = THREE.NearestFilter;
      texture.needsUpdate = true;
      textures[name] = texture;
    }
    const defines = names.map((name) => `#define HAS_${name.toUpperCase()}`).join('\n');
    const samplers = names.map((name) => `${name}_map`);
    const source = `${defines}\n${BLEND.replace('MAPS', samplers.join(', ')).replace('PLACE', samplers[0])}`;
    const n = [values.nx, values.ny], size = [values.size_x, values.size_y];
    return {
      n, size, manifest, vSign: v, textures,
      hasFoam: names.includes('foam'),
      hasStretch: names.includes('derivative'),
      blend: pass(source, [...samplers, 'frames', 'weight', 'spacing', 'row_sign', 'normal_z', 'packed']),
      inputs: {
        ...Object.fromEntries(names.map((name) => [`${name}_map`, textures[name]])),
        spacing: new THREE.Vector2(size[0] / n[0], size[1] / n[1]),
        row_sign: -v, // rows of the array go south where v grows with Z
        normal_z: maps.normal?.world.normal_Z.startsWith('-') ? -1 : 1,
        packed: conventions.normals.startsWith('packed'),
      },
      target: mapTarget(...n, 3),
    };
  }

  /** Return the place in the sequence at a time [s], from 0 to the number of frames. */
  frameAt(time) {
    const { start, loop, frames } = this.document.sampling.values;
    const frame = ((time - start) / loop) * frames;
    return frame - frames * Math.floor(frame / frames);
  }

  /** Bring the maps for the water to a time [s]. */
  update(time) {
    this.frame = this.frameAt(time);
    const first = Math.floor(this.frame), frames = new THREE.Vector2(first, (first + 1) % this.frames);
    for (const { blend, inputs, target } of this.tiles) {
      this.passes.run(blend, { ...inputs, frames, weight: this.frame - first }, target);
    }
  }

  /** Return displacement (X, height, Z) of the summed tiles at a place at rest [m]. */
  atRest(X, Z) {
    const found = [0, 0, 0], first = Math.floor(this.frame), weight = this.frame - first;
    for (const { n: [nx, ny], size, vSign, textures } of this.tiles) {
      const map = textures.displacement ?? textures.height, { data } = map.image;
      const value = map.type === THREE.FloatType ? (x) => x : THREE.DataUtils.fromHalfFloat;
      // texel i has its middle at (i + 1/2) / n: the halves of the rule cancel
      const column = (X / size[0]) * nx, row = -vSign * (Z / size[1]) * ny - (vSign > 0 ? 0 : 1);
      const [i, j] = [Math.floor(column), Math.floor(row)];
      for (const [frame, part] of [[first, 1 - weight], [(first + 1) % this.frames, weight]]) {
        for (const [a, b] of [[0, 0], [1, 0], [0, 1], [1, 1]]) {
          const share = part * (a ? column - i : 1 - column + i) * (b ? row - j : 1 - row + j);
          const texel = 4 * ((frame * ny + (((j + b) % ny) + ny) % ny) * nx + (((i + a) % nx) + nx) % nx);
          if (textures.displacement) for (let c = 0; c < 3; c++) found[c] += share * value(data[texel + c]);
          else found[1] += share * value(data[texel]);
        }
      }
    }
    return found;
  }

  /** Return the height of the water at a place in the world, X east and Z south [m]. */
  heightAt(X, Z) {
    let rest = [X, Z], moved;
    for (let i = 0; i < 5; i++) {
      moved = this.atRest(...rest);
      rest = [X - moved[0], Z - moved[2]];
    }
    return moved[1];
  }
}
