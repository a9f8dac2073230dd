// The figures: what was specified, what is realised, how fast the page is, what it computes.

import { grouped } from './amounts.js';
import { element } from './dom.js';
import { drawSpectrum, plotFits } from './spectrum_plot.js';
import { fixed, periodAndDirection, statisticsOf, wavesOf } from './statistics.js';

const DASH = fixed(null);

/** Largest relative error of a field that passes. */
export const PASS = 5e-7;

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

/** Return a direction in degrees, -180 < d <= 180, without a sign of zero. */
function degrees(value) {
  if (typeof value !== 'number' || !Number.isFinite(value)) return DASH;
  const turned = ((((Math.round(value) + 180) % 360) + 360) % 360) - 180;
  return `${turned === -180 ? 180 : turned}°`;
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

/** Return the relative error as text. */
export function errorText(error) {
  return Number.isFinite(error) ? error.toExponential(1) : 'not a number';
}

/** The panel of figures. */
export class HeadsUp {
  /** Build the panel of an app, and fill it. */
  constructor(app) {
    this.app = app;
    this.body = app.layout.figures;
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
    this.body.append(
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

  /** Show what belongs to a sea: statistics, tiles, waves, loop; and its spectrum. */
  showSea(document_) {
    const { source } = this.app;
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
    this.source.textContent = source;
    this.source.hidden = !source;
    this.sentence.textContent = this.app.sentence();
    const { tiles } = document_;
    const { frames } = document_; // of a bake
    const rate = frames && Number((frames / document_.loop).toPrecision(3));
    this.fact('Waves', frames ? '' : grouped(wavesOf(document_)));
    this.fact('Frames', frames ? `${grouped(frames)}, ${rate} a second` : '');
    this.fact('Tiles', tilesText(tiles));
    this.fact('Loop', `${Number(document_.loop.toPrecision(6))} s`);
    if (Number.isFinite(tiles[0]?.seed)) this.fact('Seed', String(tiles[0].seed));
    this.drawPlot();
  }

  /** Show what is worth knowing of the sea and of the picture. */
  showNotes(notes) {
    this.notes.replaceChildren(...notes.map((text) => element('p', { class: 'note', text })));
  }

  /** Show what changes with time, the connection, and what made the page. */
  showTime() {
    const { app } = this;
    const { canvas, clock, embedded, stage } = app;
    const by = { gpu: 'GPU', worker: 'JavaScript', playback: 'bake' }[stage.kind] ?? 'none';
    const software = stage.software ? ', drawn by software' : '';
    this.fact('Tick', `${grouped(clock.tick)} of ${grouped(clock.ticks)}`);
    this.fact('Picture', `${by}${software}, ${canvas.width} × ${canvas.height}`);
    this.fact('Connection', app.connectionText);
    const version = embedded?.about.version;
    this.fact('Made by', version ? `fftocean ${version}` : '');
  }

  /** Draw the spectrum where it can be seen. */
  drawPlot() {
    const { layout, root, sea } = this.app;
    const { plot } = this;
    plot.hidden = !sea;
    if (!sea || layout.figures.hidden) return;
    const style = getComputedStyle(root);
    const colour = (name) => style.getPropertyValue(name).trim();
    drawSpectrum(plot, sea, {
      line: colour('--specified'),
      second: colour('--realised'),
      area: colour('--realised-area'),
      grid: colour('--line'),
      text: colour('--muted'),
      font: `${0.72 * Number.parseFloat(style.fontSize)}px ${style.fontFamily}`,
    });
  }

  /** Draw the spectrum anew where the panel has another size. */
  resized() {
    if (!plotFits(this.plot)) this.drawPlot();
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
