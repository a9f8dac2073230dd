// The live page's simulation: the fields that it computes of a sea at given ticks, and its maps.
import { decodeSea, decodeReference } from '/live/container.js';
import { drawFullscreen, program, target, texture, watchContext } from '/live/gl.js';
import { createSimulation } from '/live/simulation.js';
import { Clock } from '/live/clock.js';
import { verifyTile } from '/live/verify.js';
import { base64, bytes } from './common.js';

const canvas = document.getElementById('canvas');
const gl = canvas.getContext('webgl2');
const makeWorker = () => new Worker('/live/worker.js', { type: 'module' });

/** Return the fields of all tiles of a simulation, as text. */
async function fieldsOf(simulation) {
  const tiles = [];
  for (let i = 0; i < simulation.tiles.length; i++) {
    const fields = await simulation.readFields(i);
    tiles.push(Object.fromEntries(Object.entries(fields).map(([k, v]) => [k, base64(v)])));
  }
  return tiles;
}

const COPY = `#version 300 es
precision highp float;
uniform highp sampler2D map;
uniform float level;
out vec4 texel;
void main() {
  texel = textureLod(map, gl_FragCoord.xy / vec2(textureSize(map, 0)) * exp2(level), level);
}`;

/** Return one level of each map of each tile, as text. */
function mapsOf(simulation, level) {
  const copy = program(gl, COPY);
  const read = (map) => {
    const [width, height] = [map.width >> level || 1, map.height >> level || 1];
    const into = target(gl, [texture(gl, { format: 'RGBA32F', width, height })]);
    drawFullscreen(gl, copy, { map, level }, into);
    const texels = base64(into.read(0));
    into.dispose();
    return texels;
  };
  const tiles = simulation.tiles.map(({ maps }) =>
    Object.fromEntries(Object.entries(maps).map(([name, map]) => [name, read(map)])),
  );
  copy.dispose();
  return tiles;
}

const sea = async (name) => decodeSea(await bytes(`/bakes/${name}`));
const PHASOR = /vec2 phasor\(float turn\) \{[^]*?\n\}/;
const TWIDDLE = /return texelFetch\(twiddles,[^;]*;/;

/** Put the platform's cosine and sine into a shader, in place of the polynomials and the table. */
function withPlatformSine(source) {
  const turn = 'float(index & (samples - 1)) / float(samples)';
  const angle = (turns) => `6.2831853 * (${turns})`;
  const both = (turns) => `return vec2(cos(${angle(turns)}), sin(${angle(turns)}));`;
  return source
    .replace(PHASOR, `vec2 phasor(float turn) { ${both('turn')} }`)
    .replace(TWIDDLE, both(turn));
}

/** Return a simulation; the page's own Worker is started if `workerSource` names a bundle of it. */
async function make(decoded, { workerSource, platformSine, ...options } = {}) {
  if (platformSine) options.edited = withPlatformSine;
  if (workerSource) globalThis.WORKER_SOURCE = await (await fetch(`/bakes/${workerSource}`)).text();
  const own = workerSource ? {} : { makeWorker };
  return createSimulation(gl, decoded, { anisotropy: 1, ...own, ...options });
}

/** Let an extension be missing. */
function withhold(missing) {
  const { getExtension } = gl;
  gl.getExtension = (name) => (name === missing ? null : getExtension.call(gl, name));
}

/** Return an error's message, or null. */
const refusal = async (action) => {
  try {
    await action();
    return null;
  } catch (error) {
    return error.message;
  }
};

const tasks = {
  /** The fields and maps at ticks. */
  async fields({ name, ticks, options = {}, choppiness, level = 0, missing = '', maps = false }) {
    withhold(missing);
    if (maps) gl.getExtension('EXT_color_buffer_float'); // to read them
    const simulation = await make(await sea(name), options);
    const frames = [];
    for (const tick of ticks) {
      await simulation.step(tick, choppiness);
      const fields = await fieldsOf(simulation);
      frames.push({ fields, maps: maps ? mapsOf(simulation, level) : null });
    }
    const { kind, note, document } = simulation;
    simulation.dispose();
    return { kind, note, ticks: document.ticks, frames };
  },

  /** The fields after the clock has run for a long time. */
  async clock({ name, seconds }) {
    const decoded = await sea(name);
    const simulation = await make(decoded);
    const clock = new Clock(decoded.document);
    clock.update(0);
    clock.update(1000 * seconds);
    await simulation.step(clock.tick);
    const { tick } = simulation;
    const fields = await fieldsOf(simulation);
    simulation.dispose();
    return { tick, fields };
  },

  /** The fields while one sea changes into another, after each of some seconds. */
  async blend({ names, tick, advances, options = {} }) {
    const [first, second] = await Promise.all(names.map(sea));
    const simulation = await make(first, options);
    await simulation.step(tick);
    const seen = [{ weight: simulation.weight, fields: await fieldsOf(simulation) }];
    await simulation.replace(second, 0.3);
    for (const seconds of advances) {
      simulation.advance(seconds);
      await simulation.step(tick);
      seen.push({ weight: simulation.weight, fields: await fieldsOf(simulation) });
    }
    simulation.dispose();
    return seen;
  },

  /** The fields before and after the loss of the context, and the seconds that the return took. */
  async loss({ name, tick }) {
    let simulation = await make(await sea(name));
    await simulation.step(tick);
    const before = await fieldsOf(simulation);
    const extension = gl.getExtension('WEBGL_lose_context');
    const events = [];
    const restored = new Promise((resolve) => {
      const forget = watchContext(canvas, {
        // a context can be restored only after the event of its loss
        lost: () => events.push('lost') && setTimeout(() => extension.restoreContext()),
        restored: () => resolve(forget()),
      });
    });
    extension.loseContext();
    await simulation.step(tick + 1); // changes nothing, fails nothing
    await restored;
    const start = performance.now();
    const { sea: kept } = simulation;
    simulation.dispose();
    simulation = await make(kept);
    await simulation.step(tick);
    const after = await fieldsOf(simulation);
    const seconds = (performance.now() - start) / 1000;
    simulation.dispose();
    return { before, after, seconds, events };
  },

  /** What the page's own comparison finds. */
  async verify({ name, tick, reference, wrong, other }) {
    const decoded = await sea(name);
    const simulation = await make(decoded);
    await simulation.step(tick);
    const answer = decodeReference(await bytes(`/bakes/${reference}`));
    const found = await verifyTile(simulation, answer);
    const altered = decodeReference(await bytes(`/bakes/${wrong}`));
    const failing = await verifyTile(simulation, altered);
    await simulation.step(tick + 1);
    const moved = await refusal(() => verifyTile(simulation, answer));
    await simulation.step(tick);
    await simulation.replace(await sea(other), 0.3);
    simulation.advance(0.1);
    await simulation.step(tick);
    const blending = await refusal(() => verifyTile(simulation, answer));
    simulation.dispose();
    return { found, failing, moved, blending };
  },
};

globalThis.run = async ({ task, ...args }) => {
  const value = await tasks[task](args);
  return { value, error: gl.getError() };
};
