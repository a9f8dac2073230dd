// The line of the main figures, which opens and closes their panel.

import { element } from './dom.js';
import { fixed, periodAndDirection, statisticsOf } from './statistics.js';

/** Frames a second over the last second. */
export class FrameRate {
  constructor() {
    this.times = [];
  }

  /** Note a frame at a time [s]; return the frames a second, or null for fewer than two. */
  note(now) {
    this.times.push(now);
    while (this.times.length > 2 && now - this.times[0] > 1) this.times.shift();
    const span = now - this.times[0];
    return span > 0 ? (this.times.length - 1) / span : null;
  }

  /** Forget the frames: time stood still. */
  clear() {
    this.times = [];
  }
}

/** The line of the main figures. */
export class Chip {
  /** Build the line into a button. */
  constructor(button) {
    this.cells = {};
    for (const name of ['dot', 'hs', 'tp', 'rate', 'quality']) {
      this.cells[name] = element('span', {
        class: { dot: 'dot', quality: 'badge' }[name] ?? 'figure',
      });
    }
    this.cells.dot.setAttribute('aria-hidden', 'true');
    button.append(...Object.values(this.cells));
  }

  /** Show the height and the period of a sea, and whether its amplitudes are exact. */
  showSea(document, quality) {
    const { specified, realised } = statisticsOf(document);
    const shown = realised.hs === undefined ? specified : realised;
    this.text('hs', `Hs ${fixed(shown.hs, 2)} m`);
    this.text('tp', `Tp ${fixed(periodAndDirection(shown).tp, 1)} s`);
    this.text('quality', quality);
    this.cells.quality.dataset.quality = quality;
  }

  /** Show the frames a second. */
  showRate(rate, paused) {
    const speed = rate === null ? '' : `${fixed(rate, rate < 10 ? 1 : 0)} fps`;
    this.text('rate', paused ? 'paused' : speed);
  }

  /** Show the state of the connection as the colour of the dot. */
  showConnection(phase) {
    this.cells.dot.dataset.phase = phase;
  }

  /** Set the text of a cell where it differs. */
  text(name, text) {
    if (this.cells[name].textContent !== text) this.cells[name].textContent = text;
  }
}
