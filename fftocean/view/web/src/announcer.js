// What is said to those who listen.

/** A polite live region: a text is said once, after the changes have come to rest. */
export class Announcer {
  /** Keep the region; `rest` is the time without a change after which a text is said [s]. */
  constructor(region, rest = 1.2) {
    this.region = region;
    this.rest = rest;
    this.timer = null;
    this.said = '';
  }

  /** Say a text soon, in place of one that still waits. */
  say(text) {
    clearTimeout(this.timer);
    if (text === this.said) return;
    this.timer = setTimeout(() => this.sayNow(text), 1000 * this.rest);
  }

  /** Say a text at once. */
  sayNow(text) {
    clearTimeout(this.timer);
    this.said = text;
    this.region.textContent = text;
  }

  /** Say nothing more. */
  dispose() {
    clearTimeout(this.timer);
  }
}
