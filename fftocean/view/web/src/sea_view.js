// The sea of a page: what brings it, its moment, and its picture. All else is the interface's.

import { Camera } from './camera.js';
import { Clock } from './clock.js';
import { decodeSea } from './container.js';
import { element } from './dom.js';
import { part, parts } from './parts.js';
import { Stage } from './stage.js';

/** Seconds in which one sea changes into another. */
const CHANGE = 0.3;

/** Return a name of the table as a property: sun_elevation as sunElevation. */
function property(name) {
  return name.replace(/_(.)/g, (_, letter) => letter.toUpperCase());
}

/**
 * Start the page in an element: the sea, and the interface as soon as it is here.
 *
 * @param {object} options see `SeaView`
 * @returns {Promise<App>} see interface.js
 */
export async function startApp(options) {
  const view = new SeaView(options);
  const [{ App }] = await Promise.all([part('interface'), view.start()]);
  return view.ended ? view : App.upgrade(view);
}

/** The sea in one element, without what lets a reader change it; `App` adds that. */
export class SeaView {
  /**
   * Prepare the view.
   *
   * @param {object} options
   * @param {HTMLElement} options.root the element to fill
   * @param {object} options.table the answer to /parameters.json
   * @param {EventTarget} [options.keysOn] what hears the keys; the root without it
   * @param {?function(object): object} [options.connect] takes the listeners of messages (`status`,
   *   `state`, `sea`, `refused`, `reference`, `copied`, `bake`, `frame`; see `listeners`) and returns
   *   a connection: `set(values)`, `send(message)` (true if it was sent), `ready`, `close()`
   * @param {?EmbeddedSea} [options.embedded] the sea itself, without a server
   */
  constructor({ root, table, keysOn = root, connect = null, embedded = null }) {
    Object.assign(this, { root, table, keysOn, connect, embedded });
    this.values = Object.fromEntries(
      table.parameters.map(({ name, default: value = null }) => [name, value]),
    );
    this.served = {};
    this.connection = null;
    this.status = null; // of the connection, as it was told last
    this.camera = new Camera({ height: this.values.camera_height ?? 12 });
    this.clock = new Clock({ loop: 60, ticks: 2 ** 16 });
    // readers may ask for less motion
    this.clock.paused = Boolean(
      globalThis.matchMedia?.('(prefers-reduced-motion: reduce)').matches,
    );
    this.frames = 0;
    this.dirty = true;
    this.sea = null;
    this.bake = null;
    this.source = '';
    this.busy = false;
    this.mostTiles = Infinity;
    this.servedSea = null; // number of the sea of the newest values, once it is made
    this.notes = { sea: [], picture: [] };
    this.trouble = '';
    this.ended = false;
    this.canvas = element('canvas', {
      class: 'sea',
      tabindex: '0',
      role: 'img',
      'aria-label': 'The sea, live',
    });
    root.classList.add('fftocean');
    root.prepend(this.canvas);
    this.stage = new Stage(this.canvas, {
      onChange: () => this.changed(),
      onTrouble: (text) => this.showTrouble(text),
      onNote: (text) => this.showNotes({ picture: text ? [text] : [] }),
      onCanvas: (canvas) => this.takeCanvas(canvas),
    });
  }

  /** Begin: connect, or show the sea that is embedded. */
  async start() {
    this.applyLocal(Object.keys(this.values));
    this.connection = this.connect?.(this.listeners()) ?? null;
    this.loop = (now) => {
      this.handle = requestAnimationFrame(this.loop);
      this.frame(now).catch((error) => this.failed(error));
    };
    this.handle = requestAnimationFrame(this.loop);
    await this.embedded?.show(this);
  }

  /** Return what hears the messages of a server. */
  listeners() {
    return {
      status: (status) => this.showStatus(status),
      state: (state, message) => this.takeState(state, message),
      sea: (data) => this.takeSea(data),
      refused: (refusal) => this.takeRefusal(refusal),
      reference: (data) => this.use('verification', 'takeReference', data),
      copied: ({ what, text }) => this.use('dialogs', 'copy', what, text),
      bake: (manifest, { source = '' } = {}) => this.use('bake', 'takeBake', manifest, source),
      frame: (data) => this.stage.playback?.receive(data),
    };
  }

  /** Let a part do something to the page. */
  async use(name, action, ...values) {
    try {
      await (await part(name))[action](this, ...values);
    } catch (error) {
      this.refuse(error.message);
    }
  }

  /** Take the state of the server, unless the hand is ahead of its values. */
  takeState(state, { source = '', busy = false, notes = [], sea = null, most_tiles: most }) {
    this.served = { ...state };
    this.busy = busy;
    this.source = source;
    this.mostTiles = most ?? Infinity;
    this.servedSea = sea;
    const waiting = this.connection?.pending ?? new Map();
    for (const [name, value] of Object.entries(state)) {
      if (!waiting.has(name)) this.values[name] = value;
    }
    if (!busy) this.showNotes({ sea: notes });
    this.changed();
  }

  /** Take a sea of the server. */
  async takeSea(data) {
    try {
      await this.showSea(decodeSea(data));
    } catch (error) {
      this.refuse(`the sea cannot be shown: ${error.message}`);
    }
  }

  /** Show a sea, its figures and its spectrum. */
  async showSea(sea) {
    const first = !this.sea;
    this.sea = sea;
    this.bake = null;
    // a sea that is shown keeps its loop until the new one takes its place: see `picture`
    if (!this.stage.simulation) this.clock.follow(sea.document);
    this.showFigures();
    await this.stage.setSea(sea, first || this.clock.paused ? 0 : CHANGE);
    // While time stands still foam cannot follow the sea, so that it grows anew for the exact one.
    if (this.clock.paused && sea.document.quality !== 'moving') this.stage.foamIsNew = true;
    this.changed();
  }

  /** Apply local values that are not read at every picture. */
  applyLocal(names) {
    for (const name of names) {
      const value = this.values[name];
      if (name === 'time_scale') this.clock.scale = value;
      if (name === 'blend_frames') this.stage.blendFrames = value;
      if (name === 'foam' && this.clock.paused) this.stage.foamIsNew = true;
      if (name === 'camera_height') this.camera.height = value;
      if (name === 'field_of_view') this.camera.fieldOfView = value;
    }
  }

  /** Return the look of the picture: every local value by its property. */
  look() {
    const look = { choppiness: this.values.choppiness };
    for (const row of this.table.parameters) {
      if (row.local) look[property(row.name)] = this.values[row.name];
    }
    return look;
  }

  /** Return the few-wave model that is shown beside the sea, or null. */
  fewModel() {
    return (this.values.model !== 'fft' && this.sea?.document.few_waves) || null;
  }

  /** Note that a picture must be drawn. */
  changed() {
    this.dirty = true;
  }

  /** Return the picture of this moment as a PNG, or null where there is none. */
  async still() {
    return this.alone(async () => {
      if (!this.stage.ready) return null;
      await this.picture(0, 0);
      // A canvas keeps what was drawn only until the browser shows it.
      return new Promise((resolve) => this.canvas.toBlob(resolve, 'image/png'));
    });
  }

  /** Show what the newest sea is; this and what follows is the interface's. */
  showFigures() {}

  /** Keep notes on the sea or on the picture. */
  showNotes(notes) {
    Object.assign(this.notes, notes);
  }

  /** Keep why there is no picture; an empty text where there is one. */
  showTrouble(text) {
    this.trouble = text;
  }

  /** Keep how the connection is. */
  showStatus(status) {
    this.status = status;
  }

  /** Keep a refusal. */
  refuse(message) {
    this.refusal = message;
  }

  /** Keep a refusal of the server. */
  takeRefusal({ message }) {
    this.refuse(message);
  }

  /** Use another canvas, after a context that did not come back. */
  takeCanvas(canvas) {
    this.canvas = canvas;
  }

  /** Note that a picture was drawn at a time [s]. */
  drawn() {}

  /** Go back to the sea itself where a part of the look is missing. */
  withoutParts(message) {
    Object.assign(this.values, { view: 'sea', buoy: false, model: 'fft' });
    this.refuse(message);
  }

  /** Draw a picture where something changed. */
  async frame(now) {
    const passed = Math.min((now - (this.lastFrame ?? now)) / 1000, 0.25);
    this.lastFrame = now;
    const seconds = this.clock.update(now);
    const { stage } = this;
    if (!stage.ready || this.turn) return;
    const blending = stage.simulation !== null && stage.simulation.weight !== 1;
    if (!this.dirty && this.clock.paused && !blending) return;
    if (!this.dirty && seconds === 0 && !blending && this.clock.scale === 0) return;
    this.dirty = false;
    await this.alone(() => this.picture(seconds, this.clock.paused ? CHANGE : passed));
    this.frames += 1;
    this.drawn(now / 1000);
  }

  /** Do something to the simulation that nothing else may interrupt. */
  async alone(work) {
    while (this.turn) await this.turn.catch(() => {});
    const turn = work();
    this.turn = turn;
    try {
      return await turn;
    } finally {
      this.turn = null;
    }
  }

  /** Bring the sea to the clock's tick, and draw it. */
  async picture(seconds, passed) {
    const { clock, stage } = this;
    const { choppiness, foam } = this.values;
    await this.loadLook();
    if (stage.simulation) clock.follow(stage.simulation.document);
    if (stage.foamIsNew) await stage.growFoam(clock, choppiness, this.eye(), foam);
    stage.simulation?.advance(passed);
    if (stage.simulation) clock.follow(stage.simulation.document);
    await stage.step(clock.tick, choppiness);
    if (!stage.ready) return;
    if (seconds !== 0) stage.advanceFoam(this.eye(), Math.abs(seconds), foam);
    this.draw();
  }

  /** Have the parts that the look needs. */
  async loadLook() {
    try {
      await this.stage.load(this.look(), this.fewModel());
    } catch (error) {
      this.withoutParts(error.message);
    }
  }

  /** Return the place of the eye [m]. */
  eye() {
    return { east: this.camera.east, north: this.camera.north };
  }

  /** Draw the sea, and few waves beside it. */
  draw() {
    const { canvas, stage } = this;
    const ratio = Math.min(2, globalThis.devicePixelRatio || 1) * stage.scale;
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
    const look = this.look();
    stage.render(this.camera, look, width, height);
    const model = this.fewModel();
    if (model) {
      const { tick } = this.clock;
      parts.comparison.renderFew(stage, model, tick, this.camera, look, width, height);
    }
  }

  /** Show an error of the picture, once. */
  failed(error) {
    if (this.stage.gl?.isContextLost() || this.failure === error.message) return;
    this.failure = error.message;
    this.showTrouble(`The picture cannot be drawn: ${error.message}`);
    console.error(error);
  }

  /** True when the picture shows the exact sea of the newest values, or a bake; for tests. */
  get settled() {
    const { connection, stage } = this;
    // a bake has no seas that could be newer; its picture is there once a frame has come
    const newest = !connection || Boolean(this.bake) || this.servedSea === this.sea?.document.id;
    if (this.bake && (stage.playback?.shownFrame ?? null) === null) return false;
    const waiting = Boolean(connection?.pending?.size) || this.busy || !newest;
    const shown =
      stage.ready &&
      !stage.changes &&
      (stage.simulation?.weight ?? 1) === 1 &&
      !this.dirty &&
      !this.turn;
    return shown && !waiting && this.sea?.document.quality !== 'moving';
  }

  /** Return the error of the graphics context, 0 for none; for tests. */
  get glError() {
    return this.stage.gl?.getError() ?? 0;
  }

  /** End: free the context, close the socket, remove the elements. */
  dispose() {
    this.ended = true;
    cancelAnimationFrame(this.handle);
    this.connection?.close?.();
    this.stage.dispose();
    this.root.replaceChildren();
  }
}
