// The amplitudes of a sea that changes into another: linear in time, without a jump.

/**
 * The amplitudes to show: those of a sea, or a sum of two sets while one changes into the other.
 *
 * `from` and `to` are lists of tiles with the tables of `decodeSea`, and the amplitudes shown are
 * `scaleFrom` times the first plus `scaleTo` times the second. Both run with the cycles of `to`.
 * Seas whose tiles differ in number, samples or size have no wave in common: then the earlier one
 * falls to rest in the first half of the time, and the later one rises in the second half.
 */
export class AmplitudeBlend {
  /** Show a sea. */
  constructor(sea) {
    this.revision = 0; // counts changes of the tables
    this.lastTick = 0;
    this.show(sea);
  }

  /** Return a blend that goes on where one sea was shown alone. */
  static after({ sea, revision, lastTick }) {
    return Object.assign(new AmplitudeBlend(sea), { revision, lastTick });
  }

  /** Show a sea at once. */
  show(sea) {
    this.sea = sea;
    this.from = sea.tiles;
    this.to = sea.tiles;
    this.scaleFrom = 0;
    this.scaleTo = 1;
    this.duration = 0;
    this.numbers = null; // of the document, while they change
    this.next = null; // a sea that rises after this one has come to rest
    this.pending = null; // tiles whose phases are brought to those of `sea` at the next tick
    this.revision++;
  }

  /**
   * The document of the sea whose loop and ticks are in use; its numbers for shading change as the
   * amplitudes do.
   */
  get document() {
    return this.numbers ? { ...this.sea.document, ...this.numbers.now } : this.sea.document;
  }

  /** The newest sea, which will be shown alone in the end. */
  get newest() {
    return this.next ?? this.sea;
  }

  /** The share of the newest sea: 1 when it is shown alone. */
  get weight() {
    return this.scaleTo;
  }

  /** Change into another sea within some seconds. */
  replace(sea, seconds) {
    if (!(seconds > 0)) {
      this.show(sea);
      return;
    }
    // What a sea that was never stepped would have shown has not been seen.
    const seen = this.pending ?? { sea: this.sea, tiles: this.shown(), tick: this.lastTick };
    this.from = seen.tiles;
    this.revision++;
    const numbers = { from: this.document, to: sea.document, total: seconds, passed: 0 };
    if (alike(seen.sea, sea)) {
      this.pending = seen;
      this.sea = sea;
      this.to = sea.tiles;
      this.next = null;
      this.begin(1, 0, 0, 1, seconds);
    } else {
      this.pending = null;
      this.sea = seen.sea;
      this.to = seen.tiles;
      this.next = sea;
      this.begin(1, 0, 0, 0, seconds / 2);
    }
    this.numbers = numbers;
    this.average();
  }

  /** Bring the numbers of the document to the time that has passed. */
  average() {
    const { from, to, passed, total } = this.numbers;
    this.numbers.now = {};
    for (const name of SHADING) {
      if (name in from && name in to) {
        this.numbers.now[name] = between(from[name], to[name], Math.min(1, passed / total));
      }
    }
  }

  /** Let both scales run linearly from first to last values. */
  begin(scaleFrom, scaleTo, lastFrom, lastTo, duration) {
    Object.assign(this, { scaleFrom, scaleTo, lastFrom, lastTo, duration });
    this.ends = { scaleFrom, scaleTo };
    this.elapsed = 0;
  }

  /** Return the tiles with the amplitudes that are shown now, under the cycles of `to`. */
  shown() {
    const { from, to, scaleFrom, scaleTo } = this;
    if (scaleFrom === 0 && scaleTo === 1) return to;
    return to.map((tile, i) => mixedTile(from[i], tile, scaleFrom, scaleTo));
  }

  /** Let time pass. */
  advance(seconds) {
    if (this.duration === 0 || !(seconds > 0)) return;
    this.elapsed += seconds;
    this.numbers.passed += seconds;
    this.average();
    const share = Math.min(1, this.elapsed / this.duration);
    const { scaleFrom, scaleTo } = this.ends;
    this.scaleFrom = scaleFrom + share * (this.lastFrom - scaleFrom);
    this.scaleTo = scaleTo + share * (this.lastTo - scaleTo);
    if (share < 1) return;
    if (this.next) {
      const { duration, next, numbers } = this;
      this.show(next);
      this.numbers = numbers;
      this.begin(0, 0, 0, 1, duration);
    } else {
      this.numbers = null;
      this.scaleFrom = 0; // exactly
      this.scaleTo = 1;
      this.duration = 0;
    }
  }

  /** Make the tables ready for a tick of `document`. */
  prepare(tick) {
    if (this.pending) {
      const { sea, tiles, tick: last } = this.pending;
      const { document } = sea;
      const before = sameTicks(document, this.document) ? tick : last;
      this.from = tiles.map((tile, i) =>
        rebased(tile, before, document.ticks, this.to[i], tick, this.document.ticks),
      );
      this.to = this.to.map((tile, i) => withMissingCycles(tile, tiles[i]));
      this.pending = null;
      this.revision++;
    }
    this.lastTick = tick;
  }
}

/** Members of a document that a renderer shades by. */
const SHADING = ['choppiness', 'slope_variance', 'foam'];

/** Return what lies between two numbers, or two lists or objects of them. */
function between(from, to, share) {
  if (typeof from === 'number' && typeof to === 'number') return from + share * (to - from);
  if (!from || !to || typeof from !== 'object') return to;
  const entries = Object.keys(to).map((name) => [name, between(from[name], to[name], share)]);
  return Array.isArray(to) ? entries.map(([, value]) => value) : Object.fromEntries(entries);
}

/** Return true if a tick of both documents is the same share of the same loop. */
function sameTicks(a, b) {
  return a.loop === b.loop && a.ticks === b.ticks;
}

/** Return true if two seas have tiles of the same samples and sizes. */
export function alike(a, b) {
  return (
    a.tiles.length === b.tiles.length &&
    a.tiles.every((tile, i) =>
      ['nx', 'ny', 'lx', 'ly'].every((name) => tile[name] === b.tiles[i][name]),
    )
  );
}

/** Return a tile whose amplitudes are a sum, and whose factors are an average. */
function mixedTile(from, to, scaleFrom, scaleTo) {
  const h0 = new Float32Array(to.h0.length);
  const [earlier, later] = [from.h0, to.h0];
  for (let i = 0; i < h0.length; i++) h0[i] = scaleFrom * earlier[i] + scaleTo * later[i];
  const wave = to.wave.slice();
  if (scaleFrom > 0) {
    const share = scaleFrom / (scaleFrom + scaleTo);
    const { wave: before } = from;
    for (let i = 1; i < wave.length; i += 2) wave[i] += share * (before[i] - wave[i]);
  }
  return { ...to, h0, wave };
}

/** Return a tile with the cycles of another where only that one has a wave. */
function withMissingCycles(tile, other) {
  const [own, others] = [tile.wave, other.wave];
  let wave = own;
  for (let i = 0; i < own.length; i += 2) {
    if (own[i] !== 0 || others[i] === 0) continue;
    if (wave === own) wave = own.slice();
    wave[i] = others[i];
  }
  return wave === own ? tile : { ...tile, wave };
}

/**
 * Return the waves of a tile such that they have, with the cycles of another tile and at its tick,
 * the phases that they have now with their own.
 */
function rebased(tile, tick, ticks, other, otherTick, otherTicks) {
  const [own, others] = [tile.wave, other.wave];
  const sameMoment = ticks === otherTicks && tick === otherTick;
  let { h0 } = tile;
  for (let i = 0; i < own.length; i += 2) {
    const cycles = own[i];
    const later = others[i] || cycles;
    if (cycles === 0 || (sameMoment && cycles === later)) continue;
    const turns =
      ((cycles * tick) % ticks) / ticks - ((later * otherTick) % otherTicks) / otherTicks;
    if (h0 === tile.h0) h0 = tile.h0.slice();
    const c = Math.cos(2 * Math.PI * turns);
    const s = Math.sin(2 * Math.PI * turns);
    for (const [at, sine] of [
      [2 * i, s],
      [2 * i + 2, -s],
    ]) {
      const re = h0[at];
      h0[at] = re * c + h0[at + 1] * sine;
      h0[at + 1] = h0[at + 1] * c - re * sine;
    }
  }
  return { ...tile, h0 };
}
