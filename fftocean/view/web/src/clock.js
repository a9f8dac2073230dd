// The moment that is shown: whole ticks of the sea's loop, from the time that passes.

/** A clock of a loop; it never drifts and never loses precision, however long it runs. */
export class Clock {
  /** Start at the first tick of a document's loop. */
  constructor({ loop, ticks }) {
    this.loop = loop; // [s]
    this.ticks = ticks; // in a loop
    this.scale = 1; // seconds of the sea a second; below 0 it runs backwards
    this.paused = false;
    this.position = 0; // [ticks], 0 <= position < ticks
    this.last = null; // [ms] of the last update
  }

  /** The number of the tick, 0 to ticks - 1. */
  get tick() {
    return Math.floor(this.position) >>> 0;
  }

  /** Show a tick; any whole number. */
  set tick(tick) {
    this.position = wrapped(tick, this.ticks);
  }

  /** The time within the loop [s]. */
  get seconds() {
    return (this.tick * this.loop) / this.ticks;
  }

  /**
   * Let the clock run on to a time.
   *
   * @param {number} now [ms], as of performance.now()
   * @returns {number} seconds of the sea that passed: 0 in a pause
   */
  update(now) {
    const passed = this.last === null ? 0 : (now - this.last) / 1000;
    this.last = now;
    return this.paused ? 0 : this.advance(passed * this.scale);
  }

  /** Let seconds of the sea pass; return them. */
  advance(seconds) {
    // The rest of a division is exact, so that years take no precision from the moment.
    const share = (seconds % this.loop) / this.loop;
    this.position = wrapped(this.position + share * this.ticks, this.ticks);
    return seconds;
  }

  /** Go on with the loop of another document, at the same time within it. */
  follow({ loop, ticks }) {
    if (loop === this.loop && ticks === this.ticks) return;
    const seconds = (this.position * this.loop) / this.ticks;
    Object.assign(this, { loop, ticks });
    this.position = wrapped((seconds / loop) * ticks, ticks);
  }
}

/** Return a number modulo a period, never negative nor the period itself. */
function wrapped(number, period) {
  const rest = number % period;
  const positive = rest < 0 ? rest + period : rest;
  return positive < period ? positive : 0;
}
