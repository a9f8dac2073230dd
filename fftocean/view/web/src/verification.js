// The page held against the library: by fields that the server sends, by points that a file carries.

import { FIELDS } from './container.js';
import { judged, LIMITS, relativeError, verifyTile, whyNotExact } from './verify.js';

/** Return why the sea that is shown cannot be verified now, or ''. */
export function exactSea(simulation, busy) {
  if (busy) return 'a sea is being made';
  return whyNotExact(simulation);
}

/** Bring a simulation to the tick of a reference answer, and compare that tile. */
export async function compareReference(simulation, reference, choppiness) {
  await simulation.step(reference.header.tick, choppiness);
  return verifyTile(simulation, reference);
}

/** The reference points that a package carries (check.json). */
export class SelfCheck {
  /** Take the reference of a decoded sea. */
  constructor({ reference }) {
    this.reference = reference;
  }

  /** True where there are points. */
  get possible() {
    return Boolean(this.reference?.tiles?.length);
  }

  /** The number of points, of all tiles at all moments. */
  get points() {
    const { moments, tiles } = this.reference;
    return moments.length * tiles.reduce((sum, { columns }) => sum + columns.length, 0);
  }

  /** Return, for each tile, the relative errors of its fields at all points and moments. */
  async run(simulation, choppiness) {
    const why = whyNotExact(simulation);
    if (why) throw new Error(`nothing to verify: ${why}`);
    const { moments, tiles } = this.reference;
    const computed = tiles.map(() => Object.fromEntries(FIELDS.map((name) => [name, []])));
    for (const tick of moments) {
      await simulation.step(tick, choppiness);
      for (const [i, { columns, rows }] of tiles.entries()) {
        const fields = await simulation.readFields(i);
        const { nx } = simulation.tiles[i];
        for (const name of FIELDS) {
          columns.forEach((column, p) =>
            computed[i][name].push(fields[name][rows[p] * nx + column]),
          );
        }
      }
    }
    return tiles.map(({ fields }, tile) => {
      const errors = {};
      for (const name of FIELDS) {
        errors[name] = relativeError(computed[tile][name], fields[name].flat());
      }
      return { tile, ...judged(errors, LIMITS[simulation.kind]) };
    });
  }
}
