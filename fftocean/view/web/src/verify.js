// Comparison of the fields in the page with those that Python computed for the same tick.
import { FIELDS } from './container.js';

/** Largest relative error (L2) that float32 arithmetic explains, by the kind of simulation. */
export const LIMITS = { gpu: 5e-7, worker: 2e-7 };

/** Return the relative error of values: the norm of the difference over that of the reference. */
export function relativeError(values, reference) {
  let apart = 0;
  let size = 0;
  for (let i = 0; i < reference.length; i++) {
    apart += (values[i] - reference[i]) ** 2;
    size += reference[i] ** 2;
  }
  if (values.length !== reference.length || Number.isNaN(apart)) return Infinity;
  return size > 0 ? Math.sqrt(apart / size) : Math.sqrt(apart);
}

/** Return why a simulation does not show one exact sea now, or '' if it does. */
export function whyNotExact(simulation) {
  if (simulation.weight !== 1) return 'the sea is changing into another';
  if (simulation.reduced) return 'waves too short for this device are left out';
  if (simulation.document.quality === 'moving') return 'the amplitudes are approximate';
  return '';
}

/**
 * Compare the fields of a tile with a reference answer.
 *
 * @param {object} simulation see `createSimulation`
 * @param {{header: object, fields: Object<string, Float32Array>}} reference of `decodeReference`
 * @returns {Promise<object>} tile, tick, errors (relative, of each field), worst, limit, and
 *   passed
 * @throws {Error} the reference is of another moment, or of another sea
 */
export async function verifyTile(simulation, { header, fields }) {
  const { tile, tick } = header;
  const tiles = simulation.tiles.length;
  if (!(tile >= 0 && tile < tiles)) throw new Error(`tile must be below ${tiles}, got ${tile}`);
  const why = whyNotExact(simulation);
  if (why) throw new Error(`nothing to verify: ${why}`);
  const expected = {
    sea: simulation.document.id,
    ticks: simulation.document.ticks,
    tick: simulation.tick,
    nx: simulation.tiles[tile].nx,
    ny: simulation.tiles[tile].ny,
  };
  for (const [name, value] of Object.entries(expected)) {
    if (header[name] !== undefined && value !== undefined && header[name] !== value) {
      throw new Error(`a reference must have ${name} ${value}, got ${header[name]}`);
    }
  }
  const computed = await simulation.readFields(tile);
  const errors = {};
  for (const name of FIELDS) errors[name] = relativeError(computed[name], fields[name]);
  return { tile, tick, ...judged(errors, LIMITS[simulation.kind]) };
}

/** Return errors with the worst of them and whether it is within a limit. */
export function judged(errors, limit) {
  const worst = Math.max(...Object.values(errors));
  return { errors, worst, limit, passed: worst <= limit };
}
