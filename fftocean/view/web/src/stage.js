// The graphics context with all that lives in it: made, lost, and made again from the same sea.

import { part, parts } from './parts.js';
import { Renderer } from './renderer.js';
import { createSimulation } from './simulation.js';

/** Time after which a lost context that does not come back is replaced by a new canvas [s]. */
const PATIENCE = 1;

/** Time that foam is let grow before the first picture, and its steps [s]. */
const FOAM_BEFORE = 6;
const FOAM_STEP = { hardware: 0.5, software: 1.5 };

const ATTRIBUTES = {
  alpha: false,
  antialias: true,
  depth: true,
  stencil: false,
  powerPreference: 'high-performance',
};

/** Steps from the finest picture to the cheapest; `scale` is pixels for each of the screen. */
export const LEVELS = [
  { quality: 'high', scale: 1 },
  { quality: 'medium', scale: 1 },
  { quality: 'medium', scale: 0.75 },
  { quality: 'low', scale: 0.75 },
  { quality: 'low', scale: 0.5 },
];

/** Level where a program draws the picture instead of a graphics card. */
const SOFTWARE_LEVEL = 3;

/** Return true where a program draws the picture instead of a graphics card. */
function drawnBySoftware(gl) {
  const found = gl.getExtension('WEBGL_debug_renderer_info');
  const name = found ? gl.getParameter(found.UNMASKED_RENDERER_WEBGL) : '';
  return /swiftshader|llvmpipe|software/i.test(name);
}

/** Return a sentence for a browser without WebGL 2, or an empty text. */
export function missingGraphics(gl) {
  if (gl) return '';
  return (
    'This browser has no WebGL 2, which the picture of the sea needs. A newer browser, or hardware ' +
    'acceleration switched on in its settings, shows it; the figures and the controls work.'
  );
}

/** Return the sentence for an error of the picture. */
export function cannotDraw(error) {
  return `The picture cannot be drawn: ${error.message}`;
}

/** A canvas, its WebGL context, the simulation or the playback, and the renderer. */
export class Stage {
  /**
   * Ask for a context on a canvas.
   * `onChange()` hears that a picture must be drawn, `onTrouble(text)` why there is none,
   * `onNote(text)` what is worth knowing of the one there is, `onCanvas(canvas)` that another
   * canvas has taken the place of the old one.
   */
  constructor(canvas, { onChange, onTrouble, onNote, onCanvas, prefer = 'gpu' }) {
    this.onChange = onChange;
    this.onTrouble = onTrouble;
    this.onNote = onNote;
    this.onCanvas = onCanvas;
    this.prefer = prefer;
    this.sea = null;
    this.bake = null;
    this.source = null;
    this.simulation = null;
    this.playback = null;
    this.renderer = null;
    this.few = null;
    this.timer = null;
    this.level = 0;
    this.building = null;
    this.changes = 0; // that have not begun to show
    this.disposed = false;
    this.losses = 0;
    this.listen(canvas);
  }

  /** Take a canvas: its context, and the events of its loss. */
  listen(canvas) {
    this.canvas = canvas;
    this.listening?.abort();
    this.listening = new AbortController();
    const { signal } = this.listening;
    canvas.addEventListener('webglcontextlost', (event) => this.lost(event), { signal });
    canvas.addEventListener('webglcontextrestored', () => this.restored(), { signal });
    this.gl = canvas.getContext('webgl2', ATTRIBUTES);
    this.software = Boolean(this.gl) && drawnBySoftware(this.gl);
    if (this.software) this.level = Math.max(this.level, SOFTWARE_LEVEL);
  }

  /** Return the pixels of the picture for each of the screen. */
  get scale() {
    return LEVELS[this.level].scale;
  }

  /** Draw a cheaper picture; return false where there is none. */
  coarser() {
    if (this.level === LEVELS.length - 1) return false;
    const before = LEVELS[this.level].quality;
    this.level += 1;
    const { quality } = LEVELS[this.level];
    if (quality !== before && this.renderer) {
      this.renderer.dispose();
      this.renderer = new Renderer(this.gl, { quality });
      this.foamIsNew = true;
    }
    return true;
  }

  /** Return true where a picture can be drawn. */
  get ready() {
    return Boolean(this.source && this.renderer && !this.gl.isContextLost());
  }

  /** Return 'gpu', 'worker' or 'playback'. */
  get kind() {
    return this.playback ? 'playback' : (this.simulation?.kind ?? '');
  }

  /** Show a sea; one that is shown already changes into it within some seconds. */
  async setSea(sea, seconds) {
    this.sea = sea;
    this.bake = null;
    if (!this.gl) return;
    if (this.simulation && !this.gl.isContextLost()) {
      this.changes += 1;
      await this.simulation.replace(sea, seconds).finally(() => (this.changes -= 1));
      this.onChange();
      return;
    }
    await this.build();
  }

  /** Show a bake: its manifest, and a function that asks for a frame. */
  async setBake(manifest, requestFrame) {
    this.bake = { manifest, requestFrame };
    this.sea = null;
    if (this.gl) await this.build();
  }

  /** Make everything for the sea or the bake; only one building goes on at a time. */
  async build() {
    while (this.building) await this.building;
    if (this.disposed || this.gl.isContextLost()) return;
    this.building = this.make();
    try {
      await this.building;
    } finally {
      this.building = null;
    }
  }

  /** Make simulation or playback, and the renderer. */
  async make() {
    this.free();
    const { gl } = this;
    if (this.bake) {
      const { manifest, requestFrame } = this.bake;
      this.playback = new parts.bake.Playback(gl, manifest, requestFrame, {
        onChange: this.onChange,
      });
      this.source = this.playback;
    } else {
      const wanted = this.sea;
      const made = await createSimulation(gl, wanted, { prefer: this.prefer });
      if (this.disposed || gl.isContextLost()) {
        made.dispose();
        return;
      }
      this.simulation = made;
      this.source = made;
      this.onNote(made.note ?? '');
      if (this.sea !== wanted) await made.replace(this.sea, 0);
    }
    this.renderer = new Renderer(gl, { quality: LEVELS[this.level].quality });
    this.foamIsNew = true;
    this.onTrouble('');
    this.onChange();
  }

  /** Do some drawing, and measure it while times are shown. */
  measure(name, draw) {
    if (this.timer) this.timer.measure(name, draw);
    else draw();
  }

  /** Bring the maps to a tick. */
  async step(tick, choppiness) {
    let done = null;
    if (this.playback) this.playback.blend = this.blendFrames;
    this.measure('waves', () => {
      done = (this.simulation ?? this.playback)?.step(tick, choppiness);
    });
    await done;
  }

  /** Advance the foam around the eye; `amount` is a factor on what crests leave. */
  advanceFoam(eye, seconds, amount = 1) {
    const { document, tiles } = this.source;
    const { foam } = document;
    const more = foam && { ...foam, strength: amount * foam.strength };
    this.renderer.advanceFoam({ tiles, document: { ...document, foam: more } }, eye, seconds);
  }

  /** Let foam grow over the seconds before a tick, once after each building. */
  async growFoam(clock, choppiness, eye, amount) {
    const { playback } = this;
    // the earlier frames of a bake must be here; where they do not fit, foam grows as it plays
    this.foamIsNew = Boolean(playback?.fits && !playback.whole);
    if (playback && !playback.whole) return;
    this.renderer.restartFoam();
    const { loop, ticks } = clock;
    const step = this.software ? FOAM_STEP.software : FOAM_STEP.hardware;
    for (let before = FOAM_BEFORE; before >= step; before -= step) {
      const tick = Math.floor(clock.tick - (before / loop) * ticks);
      await this.step(((tick % ticks) + ticks) % ticks, choppiness);
      if (!this.ready) return;
      this.advanceFoam(eye, step, amount);
    }
  }

  /** Draw the picture. */
  render(camera, look, width, height) {
    this.measure('sea', () => {
      this.renderer.render(this.source, camera, look, width, height);
    });
  }

  /** Have the parts that a look needs; see `Renderer.load`. */
  async load(look, model) {
    if (model) await part('comparison');
    await this.renderer?.load(look);
  }

  /** Keep the page alive without a context, and ask for another where none comes back. */
  lost(event) {
    event.preventDefault();
    this.losses += 1;
    this.forget();
    this.onTrouble('The graphics context was lost; the picture comes back.');
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => this.replaceCanvas(), 1000 * PATIENCE);
  }

  /** Make everything again in the context that came back. */
  restored() {
    clearTimeout(this.waiting);
    this.rebuild();
  }

  /** Make everything again, and show why where that fails. */
  rebuild() {
    if (!this.sea && !this.bake) this.onTrouble('');
    else this.build().catch((error) => this.onTrouble(cannotDraw(error)));
  }

  /** Put a new canvas in the place of one whose context does not come back. */
  replaceCanvas() {
    if (this.disposed || !this.gl?.isContextLost()) return;
    const fresh = this.canvas.cloneNode(false);
    const focused = document.activeElement === this.canvas;
    this.canvas.replaceWith(fresh);
    this.listen(fresh);
    this.onCanvas(fresh);
    if (focused) fresh.focus();
    if (this.gl) this.rebuild();
    else this.onTrouble(missingGraphics(null));
  }

  /** Forget objects of a lost context: there is nothing to free. */
  forget() {
    if (this.simulation?.kind === 'worker') this.simulation.dispose();
    this.empty();
  }

  /** Free everything that lives in the context. */
  free() {
    for (const one of [this.simulation, this.playback, this.renderer, this.few]) one?.dispose?.();
    this.empty();
  }

  /** Hold nothing that lives in a context. */
  empty() {
    Object.assign(this, {
      simulation: null,
      playback: null,
      source: null,
      renderer: null,
      few: null,
      timer: null,
    });
  }

  /** Free everything and give the context back: a browser keeps few of them. */
  dispose() {
    this.disposed = true;
    clearTimeout(this.waiting);
    this.listening.abort();
    if (!this.gl) return;
    this.free();
    this.gl.getExtension('WEBGL_lose_context')?.loseContext();
  }
}
