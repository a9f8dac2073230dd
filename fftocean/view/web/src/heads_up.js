// The figures: what was specified, what is realised, how fast the page is, what it computes.

import { element } from './dom.js';

/** Largest relative error of a field that passes. */
export const PASS = 5e-7;

const DASH = '–';

/** Space around an answer that is scrolled to [CSS pixels]. */
const MARGIN = 12;

/** Facts of the list, in their order. */
const FACTS = [
  'Waves',
  'Frames',
  'Tiles',
  'Seed',
  'Loop',
  'Tick',
  'Picture',
  'Connection',
  'Made by',
];

/** Return a number with a fixed number of decimals, or a dash. */
function fixed(value, decimals) {
  return typeof value === 'number' && Number.isFinite(value) ? value.toFixed(decimals) : DASH;
}

/** Return a direction in degrees, -180 < d <= 180, without a sign of zero. */
function degrees(value) {
  if (typeof value !== 'number' || !Number.isFinite(value)) return DASH;
  const turned = ((((Math.round(value) + 180) % 360) + 360) % 360) - 180;
  return `${turned === -180 ? 180 : turned}°`;
}

/** Return the statistics of a document; a sea of given waves has none that are specified. */
function statisticsOf(document_) {
  const { specified, realised } = document_.statistics ?? {};
  return { specified: specified ?? {}, realised: realised ?? {} };
}

/** Return true where statistics are those of water without waves: no period, no direction. */
export function isFlat({ hs, tp }) {
  return hs === 0 || tp === 0;
}

/** Return the peak period and the direction of statistics; flat water has neither. */
function periodAndDirection(statistics) {
  const { tp, direction } = isFlat(statistics) ? {} : statistics;
  return { tp, direction };
}

/** Return the rows of the table of statistics: [label, specified, realised]. */
export function statisticsRows(document_) {
  const { specified, realised } = statisticsOf(document_);
  const both = [specified, realised].map(periodAndDirection);
  return [
    ['Hs [m]', fixed(specified.hs, 2), fixed(realised.hs, 2)],
    ['Tp [s]', ...both.map(({ tp }) => fixed(tp, 1))],
    ['Direction', ...both.map(({ direction }) => degrees(direction))],
  ];
}

/** Return the text of the tiles: their samples, and the width of each. */
export function tilesText(tiles) {
  const samples = ({ n: [nx, ny] }) => (nx === ny ? `${nx}²` : `${nx} × ${ny}`);
  const width = ({ size }) => String(Number(size[0].toPrecision(3)));
  const found = new Map();
  for (const tile of tiles) {
    if (!found.has(samples(tile))) found.set(samples(tile), []);
    found.get(samples(tile)).push(width(tile));
  }
  return [...found].map(([n, widths]) => `${n} on ${widths.join(', ')} m`).join('; ');
}

/** Return the number of waves on all tiles. */
export function wavesOf({ tiles }) {
  return tiles.reduce((sum, tile) => sum + (tile.waves ?? 0), 0);
}

/** Return a number with thin spaces between thousands. */
export function grouped(value) {
  return String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, '\u2009');
}

/** Return a number of waves as text. */
export function wavesText(count) {
  return `${grouped(count)} ${count === 1 ? 'wave' : 'waves'}`;
}

/** Return the relative error as text. */
export function errorText(error) {
  return Number.isFinite(error) ? error.toExponential(1) : 'not a number';
}

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

/** The panel of figures, with a line of the main ones that opens and closes it. */
export class HeadsUp {
  /** Build the line and the panel. */
  constructor({ chip, body }) {
    this.cells = {};
    this.body = body;
    const cell = (name, properties = {}) => {
      this.cells[name] = element('span', properties);
      return this.cells[name];
    };
    chip.append(
      cell('dot', { class: 'dot', 'aria-hidden': 'true' }),
      cell('hs', { class: 'figure' }),
      cell('tp', { class: 'figure' }),
      cell('rate', { class: 'figure' }),
      cell('quality', { class: 'badge' }),
    );
    this.table = element('tbody');
    this.plot = element('canvas', {
      class: 'plot',
      role: 'img',
      'aria-label': 'The spectrum by frequency and by direction, specified beside realised',
    });
    this.list = element('dl', { class: 'facts' });
    this.notes = element('div', { class: 'notes' });
    this.verification = element('div', { class: 'verification', role: 'status' });
    this.source = element('p', { class: 'source' });
    this.sentence = element('p', { class: 'sentence' });
    this.words = element(
      'details',
      { class: 'words' },
      element('summary', { text: 'In words' }),
      this.sentence,
    );
    body.append(
      this.source,
      element(
        'table',
        { class: 'statistics' },
        element(
          'thead',
          {},
          element(
            'tr',
            {},
            element('td', {}),
            element('th', { scope: 'col', class: 'specified', text: 'Specified' }),
            element('th', { scope: 'col', class: 'realised', text: 'Realised' }),
          ),
        ),
        this.table,
      ),
      this.plot,
      this.list,
      this.words,
      this.notes,
      this.verification,
    );
    this.facts = new Map();
    for (const label of FACTS) this.fact(label, '');
  }

  /** Show what belongs to a sea: statistics, tiles, waves, loop. */
  showSea(document_, { source, quality, sentence }) {
    this.table.replaceChildren(
      ...statisticsRows(document_).map(([label, specified, realised]) =>
        element(
          'tr',
          {},
          element('th', { scope: 'row', text: label }),
          element('td', { text: specified }),
          element('td', { text: realised }),
        ),
      ),
    );
    const { specified, realised } = statisticsOf(document_);
    this.text('hs', `Hs ${fixed(realised.hs ?? specified.hs, 2)} m`);
    const { tp } = periodAndDirection(realised.hs === undefined ? specified : realised);
    this.text('tp', `Tp ${fixed(tp, 1)} s`);
    this.showQuality(quality);
    this.source.textContent = source ?? '';
    this.source.hidden = !source;
    this.sentence.textContent = sentence;
    const { tiles } = document_;
    const { frames } = document_; // of a bake
    const rate = frames && Number((frames / document_.loop).toPrecision(3));
    this.fact('Waves', frames ? '' : grouped(wavesOf(document_)));
    this.fact('Frames', frames ? `${grouped(frames)}, ${rate} a second` : '');
    this.fact('Tiles', tilesText(tiles));
    this.fact('Loop', `${Number(document_.loop.toPrecision(6))} s`);
    if (Number.isFinite(tiles[0]?.seed)) this.fact('Seed', String(tiles[0].seed));
  }

  /** Show whether the amplitudes are exact or those of a moving slider. */
  showQuality(quality) {
    this.text('quality', quality ?? '');
    this.cells.quality.dataset.quality = quality ?? '';
  }

  /** Show what is worth knowing of the sea and of the picture. */
  showNotes(notes) {
    this.notes.replaceChildren(...notes.map((text) => element('p', { class: 'note', text })));
  }

  /** Show what changes with time. */
  showTime({ rate, tick, ticks, paused, picture }) {
    const speed = paused ? 'paused' : rate === null ? '' : `${fixed(rate, rate < 10 ? 1 : 0)} fps`;
    this.text('rate', speed);
    this.fact('Tick', `${grouped(tick)} of ${grouped(ticks)}`);
    this.fact('Picture', picture);
  }

  /** Show the state of the connection as the colour of the dot, with a text. */
  showConnection(phase, text) {
    this.cells.dot.dataset.phase = phase;
    this.fact('Connection', text);
  }

  /** Show the answer of a comparison: rows of {tile, field, error}. */
  showVerification({ title, rows, note = '' }) {
    const fields = [...new Set(rows.map((row) => row.field))];
    const tiles = [...new Set(rows.map((row) => row.tile))];
    const of = (tile, field) => rows.find((row) => row.tile === tile && row.field === field);
    const passed = rows.length > 0 && rows.every((row) => row.error <= PASS);
    this.verification.dataset.passed = rows.length ? String(passed) : '';
    this.verification.replaceChildren(
      element('p', { class: 'verdict', text: title }),
      ...(rows.length
        ? [
            element(
              'table',
              { class: 'errors' },
              element('caption', { text: 'Relative error of each field' }),
              element(
                'thead',
                {},
                element(
                  'tr',
                  {},
                  element('td', {}),
                  ...tiles.map((tile) => element('th', { scope: 'col', text: `tile ${tile}` })),
                ),
              ),
              element(
                'tbody',
                {},
                ...fields.map((field) =>
                  element(
                    'tr',
                    {},
                    element('th', { scope: 'row', text: field.replaceAll('_', ' ') }),
                    ...tiles.map((tile) => {
                      const error = of(tile, field)?.error;
                      return element('td', {
                        class: error <= PASS ? 'good' : 'bad',
                        text: error === undefined ? DASH : errorText(error),
                      });
                    }),
                  ),
                ),
              ),
            ),
          ]
        : []),
      ...(note ? [element('p', { class: 'note', text: note })] : []),
    );
  }

  /** Scroll the panel to the answer of a comparison, or to its beginning where it is longer. */
  revealVerification() {
    const panel = this.body.getBoundingClientRect();
    const answer = this.verification.getBoundingClientRect();
    const below = answer.bottom - panel.bottom + MARGIN;
    if (below > 0) this.body.scrollTop += Math.min(below, answer.top - panel.top - MARGIN);
  }

  /** Set the text of a cell where it differs. */
  text(name, text) {
    if (this.cells[name].textContent !== text) this.cells[name].textContent = text;
  }

  /** Set a fact of the list; an empty one is not shown. */
  fact(label, text) {
    let node = this.facts.get(label);
    if (!node) {
      node = element('dd', { hidden: true });
      this.facts.set(label, node);
      this.list.append(element('dt', { text: label, hidden: true }), node);
    }
    if (node.textContent === text) return;
    node.textContent = text;
    node.hidden = node.previousSibling.hidden = !text;
  }
}
