// The Worker that computes the maps of a sea where the GPU cannot.
import { FIELDS } from './container.js';
import { Tile, mapsOf } from './evolve.js';

let tiles = [];
let ticks = 1;

const answers = {
  /** Keep the waves of a sea. */
  load({ sets, ticks: given }) {
    ticks = given;
    tiles = sets.map(({ to, from }, i) => {
      const kept = tiles[i];
      if (kept?.to.nx !== to.nx || kept.to.ny !== to.ny) return new Tile(to, from);
      return Object.assign(kept, { to, from });
    });
    return [{}, []];
  },

  /** Return the maps at a tick. */
  step({ tick, choppiness, scaleTo, scaleFrom }) {
    const maps = tiles.map((tile) => {
      const fields = tile.fields(tick, ticks, scaleTo, scaleFrom);
      return mapsOf(fields, tile.to.nx, tile.to.ny, choppiness);
    });
    const levels = maps.flatMap((map) => Object.values(map).flat());
    return [{ maps }, levels.map((level) => level.buffer)];
  },

  /** Return the fields of one tile at a tick. */
  read({ index, tick, scaleTo, scaleFrom }) {
    const computed = tiles[index].fields(tick, ticks, scaleTo, scaleFrom);
    const fields = {};
    for (const name of FIELDS) fields[name] = Float32Array.from(computed[name]);
    return [{ fields }, Object.values(fields).map((field) => field.buffer)];
  },
};

globalThis.onmessage = ({ data: { kind, number, ...rest } }) => {
  try {
    const [answer, buffers] = answers[kind](rest);
    globalThis.postMessage({ number, ...answer }, buffers);
  } catch (error) {
    globalThis.postMessage({ number, failed: String(error?.message ?? error) });
  }
};
