// The live page: the sea of a server or of a file, its picture, its controls and its figures.

import { Announcer, describeSea, prefersReducedMotion } from './accessibility.js';
import { Camera } from './camera.js';
import { Clock } from './clock.js';
import { decodeReference, decodeSea } from './container.js';
import { choiceLabel, Controls, presetList } from './controls.js';
import { element } from './dom.js';
import { fileMessage, readFile, takeDrops } from './drop.js';
import { FrameRate, HeadsUp, wavesOf, wavesText } from './heads_up.js';
import { moveByKeys, takePointers } from './input.js';
import { actionOf, allActions, HeldKeys, isField, keyPlan } from './keys.js';
import { Layout } from './layout.js';
import { drawSpectrum, plotFits } from './spectrum_plot.js';
import { cannotDraw, missingGraphics, Stage } from './stage.js';
import { defaults, stepped, valueText } from './table.js';
import { compareReference, exactSea, SelfCheck } from './verification.js';

/** Seconds in which one sea changes into another. */
const CHANGE = 0.3;

/** Shortest time between two drawings of the figures [s]. */
const FIGURES_EVERY = 0.25;

/** Time without an answer after which a verification is given up [s]. */
const VERIFY_PATIENCE = 60;

/** Slowest rate at which the picture stays as fine as it is [frames a second]. */
const SLOWEST = 24;

/** The sentence for a server that may not come back: another one has another address. */
const SERVER_GONE =
  'The server has stopped or is out of reach, so that only light, camera and view can change. ' +
  'Start fftocean view again and open the address that it prints.';

/** Parameters of the server that a page without one can change itself. */
const OWN_CHANGES = new Set(['choppiness']);

/** Group of the light of few waves, which a page without a server does not have. */
const FEW_GROUP = /^few-wave/i;

/** Parameters that only a bake has. */
const BAKE_ONLY = new Set(['blend_frames']);

/** Groups that begin open. */
const OPEN_GROUPS = ['Local wind sea'];

/** Names of the views that are not the sea itself, for the line over the tool bar. */
const VIEW_NAMES = {
  height: 'Height of the water',
  slopes: 'Slopes',
  normals: 'Normals',
  jacobian: 'Jacobian: where the surface folds',
  foam: 'Foam',
  roughness: 'Roughness below the pixel',
  tiles: 'Tiles',
  wireframe: 'Mesh',
};

/** Return a name of the table as a property: sun_elevation as sunElevation. */
function property(name) {
  return name.replace(/_(.)/g, (_, letter) => letter.toUpperCase());
}

/** Start the page in an element; see `App`. */
export async function startApp(options) {
  const app = new App(options);
  await app.start();
  return app;
}

/** The page in one element, with everything it does. */
export class App {
  /**
   * Build the page.
   *
   * @param {object} options
   * @param {HTMLElement} options.root the element to fill
   * @param {object} options.table of `readTable`
   * @param {EventTarget} [options.keysOn] what hears the keys; the root without it
   * @param {?function(object): object} [options.connect] takes the listeners of messages (`status`,
   *   `state`, `sea`, `refused`, `reference`, `copied`, `bake`, `frame`; see `listeners`) and returns
   *   a connection: `set(values)`, `send(message)` (true if it was sent), `ready`, `close()`
   * @param {?{bytes: Uint8Array, about: object}} [options.embedded] the sea itself, without a server
   */
  constructor({ root, table, keysOn = null, connect = null, embedded = null }) {
    this.root = root;
    this.table = table;
    this.rows = new Map(table.parameters.map((row) => [row.name, row]));
    this.values = defaults(table.parameters);
    this.served = {};
    this.connect = connect;
    this.embedded = embedded;
    this.connection = null;
    this.plan = keyPlan(table.parameters, table.actions);
    this.held = new HeldKeys(this.plan);
    this.keysEnabled = true;
    this.camera = new Camera({ height: this.values.camera_height ?? 12 });
    this.clock = new Clock({ loop: 60, ticks: 2 ** 16 });
    this.clock.paused = prefersReducedMotion();
    this.frameRate = new FrameRate();
    this.rate = null;
    this.frames = 0;
    this.dirty = true;
    this.sea = null;
    this.bake = null;
    this.source = '';
    this.busy = false;
    this.mostTiles = Infinity;
    this.servedSea = null; // number of the sea of the newest values, once it is made
    this.notes = { sea: [], picture: [] };
    this.verifying = null;
    this.ending = new AbortController();
    this.canvas = element('canvas', {
      class: 'sea',
      tabindex: '0',
      role: 'img',
      'aria-label': 'The sea, live',
    });
    this.layout = new Layout(root, { canvas: this.canvas, act: (name) => this.act(name) });
    this.announcer = new Announcer(this.layout.spoken);
    this.figures = new HeadsUp({ chip: this.layout.chip, body: this.layout.figures });
    this.stage = new Stage(this.canvas, {
      onChange: () => this.changed(),
      onTrouble: (text) => this.layout.showBanner(text),
      onNote: (text) => this.showNotes({ picture: text ? [text] : [] }),
      onCanvas: (canvas) => this.takeCanvas(canvas),
    });
    this.buildControls();
    this.buildHelp();
    this.listen(keysOn ?? root);
  }

  /** Begin: connect, or show the sea that is embedded. */
  async start() {
    this.layout.showBanner(missingGraphics(this.stage.gl));
    this.layout.onToggle = (name, open) => {
      if (name === 'figures' && open) this.drawPlot();
    };
    if (this.layout.wide) {
      this.layout.toggle('figures', true);
      this.layout.toggle('controls', true);
    }
    this.layout.showPaused(this.clock.paused);
    this.applyLocal(Object.keys(this.values));
    this.controls.show(this.values, { force: true });
    this.connection = this.connect?.(this.listeners()) ?? null;
    if (this.embedded) await this.showEmbedded();
    this.loop = (now) => {
      this.handle = requestAnimationFrame(this.loop);
      this.frame(now).catch((error) => this.failed(error));
    };
    this.handle = requestAnimationFrame(this.loop);
  }

  /** Build the controls of the table, the presets and the actions. */
  buildControls() {
    const { layout } = this;
    const action = (label, name) => {
      const key = this.table.actions.find((one) => one.name === name)?.key;
      return layout.addAction(label, key, () => this.act(name));
    };
    this.copyButtons = [action('Copy job', 'copy_job'), action('Copy command', 'copy_command')];
    this.verifyButton = action('Verify', 'verify');
    if (!this.embedded) this.openButton = action('Open file …', 'open');
    this.fileInput = element('input', {
      type: 'file',
      hidden: true,
      tabindex: '-1',
      'aria-label': 'A job or a buoy file',
    });
    this.fileInput.addEventListener('change', () => {
      const [file] = this.fileInput.files;
      if (file) readFile(file, this.fileReceivers());
      this.fileInput.value = '';
    });
    this.presets = this.embedded
      ? null
      : presetList(this.table.presets, (preset) => this.change(preset.values, { exactly: true }));
    if (this.presets) layout.controls.append(this.presets.node);
    this.controls = new Controls(layout.controls, this.table.parameters, {
      onChange: (values) => this.change(values),
      open: this.embedded ? ['Light', 'Water'] : OPEN_GROUPS,
    });
    layout.controls.append(this.fileInput, layout.actions);
    if (this.embedded) this.keepOwnControls();
    else
      this.controls.keepOnly(new Set([...this.rows.keys()].filter((one) => !BAKE_ONLY.has(one))));
  }

  /** Hide what needs a server that makes seas. */
  keepOwnControls() {
    this.controls.keepOnly(this.ownNames());
    this.layout.fewButton.hidden = true;
    if (this.presets) this.presets.node.hidden = true;
    if (this.openButton) this.openButton.hidden = true;
    if (this.bake) this.verifyButton.hidden = true;
    if (this.bake) for (const button of this.copyButtons) button.hidden = true;
  }

  /** True where no server makes seas: the page is one file, or a bake is played. */
  get fixed() {
    return Boolean(this.embedded || this.bake);
  }

  /** Return the names of parameters that the page can change without a server. */
  ownNames() {
    const changes = this.bake ? new Set() : OWN_CHANGES; // a bake has its choppiness in it
    const local = ({ name, group }) =>
      !FEW_GROUP.test(group) && (Boolean(this.bake) || !BAKE_ONLY.has(name));
    const own = (row) => (row.local && local(row)) || changes.has(row.name);
    return new Set(this.table.parameters.filter(own).map((row) => row.name));
  }

  /** Build the list of keys. */
  buildHelp() {
    const rows = [];
    for (const row of this.table.parameters) {
      const keys = [row.keyDown, row.keyUp].filter(Boolean);
      if (!keys.length || (this.embedded && !row.local && !OWN_CHANGES.has(row.name))) continue;
      rows.push([
        keys,
        keys.length === 2 ? `${row.label} down, up` : `Next ${row.label.toLowerCase()}`,
      ]);
    }
    for (const { key, label } of allActions(this.table.actions)) {
      rows.push([[key], label.slice(0, 1).toUpperCase() + label.slice(1)]);
    }
    this.layout.fillHelp(rows, {
      enabled: this.keysEnabled,
      onEnabled: (enabled) => {
        this.keysEnabled = enabled;
        this.held.clear();
      },
    });
  }

  /** Listen to keys, pointers, sizes and files. */
  listen(keysOn) {
    const { signal } = this.ending;
    const options = { signal };
    keysOn.addEventListener('keydown', (event) => this.keyDown(event), options);
    keysOn.addEventListener('keyup', (event) => this.keyUp(event), options);
    globalThis.addEventListener('blur', () => this.held.clear(), options);
    this.root.addEventListener('focusin', (event) => {
      if (isField(event.target)) this.held.clear();
    });
    takePointers(this.canvas, this.camera, { onMove: () => this.moved(), signal });
    this.resizes = new ResizeObserver(() => this.resized());
    for (const node of [this.root, this.figures.plot]) this.resizes.observe(node);
    if (!this.embedded) {
      takeDrops(this.root, {
        ...this.fileReceivers(),
        onOver: (over) => (this.layout.dropHint.hidden = !over),
        signal,
      });
    }
  }

  /** Fit what is shown to a new size; panels would cover the sea once there is no width for two. */
  resized() {
    const { layout } = this;
    const { wide } = layout;
    if (this.wasWide && !wide) for (const name of ['figures', 'controls']) layout.close(name);
    this.wasWide = wide;
    if (!plotFits(this.figures.plot)) this.drawPlot();
    this.changed();
  }

  /** Return what a file that is read or refused is handed to. */
  fileReceivers() {
    return {
      onFile: (name, bytes) => {
        const { message, refused } = fileMessage(name, bytes);
        if (refused) this.refuse(refused);
        else if (this.sendOr(message)) this.layout.toast(`Reading ${name}`);
      },
      onRefused: (message) => this.refuse(message),
    };
  }

  /** Return what hears the messages of a server. */
  listeners() {
    return {
      status: (status) => this.showStatus(status),
      state: (state, message) => this.takeState(state, message),
      sea: (data) => this.takeSea(data),
      refused: (refusal) => this.takeRefusal(refusal),
      reference: (data) => this.takeReference(data),
      copied: ({ what, text }) => this.copy(what, text),
      bake: (manifest, message) => this.takeBake(manifest, message),
      frame: (data) => this.stage.playback?.receive(data),
    };
  }

  /** Show the embedded sea, and check it against its own reference points. */
  async showEmbedded() {
    const { bytes, about } = this.embedded;
    const sea = decodeSea(bytes);
    this.source = about.source ?? '';
    this.served = { choppiness: sea.document.choppiness };
    this.values.choppiness = sea.document.choppiness ?? this.values.choppiness;
    this.controls.show(this.values, { force: true });
    this.figures.showConnection('embedded', 'none: one file');
    if (about.version) this.figures.fact('Made by', `fftocean ${about.version}`);
    await this.showSea(sea);
    await this.checkItself();
  }

  /** Take the state of the server: its values, unless the hand is ahead of them. */
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
    this.controls.show(this.values);
    if (!busy) this.showNotes({ sea: notes });
    this.changed();
  }

  /** Show notes on the sea or on the picture, and say once those that are new. */
  showNotes(notes) {
    const before = new Set(Object.values(this.notes).flat());
    Object.assign(this.notes, notes);
    const all = Object.values(this.notes).flat();
    this.figures.showNotes(all);
    for (const note of all) if (!before.has(note)) this.layout.toast(note);
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

  /** Play the maps of a bake. */
  async takeBake(manifest, { source = '' } = {}) {
    this.bake = manifest;
    this.sea = null;
    this.source = source;
    this.clock.follow(manifest);
    this.keepOwnControls();
    this.showFigures();
    if (this.stage.playback) return; // after a reconnection the same bake goes on
    const ask = (tile, frame) => {
      this.connection.send({ frame: { tile, frame } });
    };
    await this.stage.setBake(manifest, ask);
    this.changed();
  }

  /** Show what the newest sea is. */
  showFigures() {
    const shown = this.sea?.document ?? this.bake;
    if (!shown) return;
    const sentence = this.sentence();
    const quality = this.bake ? 'recorded' : (shown.quality ?? 'exact');
    this.figures.showSea(shown, { source: this.source, quality, sentence });
    if (quality !== 'moving') this.announcer.say(sentence);
    this.drawPlot();
  }

  /** Return the sea in words. */
  sentence() {
    return describeSea({
      document: this.sea?.document ?? this.bake,
      look: this.look(),
      paused: this.clock.paused,
      few: this.fewModel(),
      playback: Boolean(this.bake),
    });
  }

  /** Draw the spectrum where it can be seen. */
  drawPlot() {
    const { plot } = this.figures;
    plot.hidden = !this.sea;
    if (!this.sea || this.layout.figures.hidden) return;
    const style = getComputedStyle(this.root);
    const colour = (name) => style.getPropertyValue(name).trim();
    drawSpectrum(plot, this.sea, {
      line: colour('--specified'),
      second: colour('--realised'),
      area: colour('--realised-area'),
      grid: colour('--line'),
      text: colour('--muted'),
      font: `${0.72 * Number.parseFloat(style.fontSize)}px ${style.fontFamily}`,
    });
  }

  /**
   * Change values by hand: local ones here, the others on the server.
   * Return false where the server is gone: then nothing changes, as some values would not arrive.
   */
  change(values) {
    const sent = {};
    const local = [];
    const names = Object.keys(values);
    if (this.serverGone && names.some((name) => this.rows.get(name)?.local === false)) {
      const before = Object.fromEntries(names.map((name) => [name, this.values[name]]));
      this.controls.show(before, { force: true });
      this.refuse(SERVER_GONE);
      return false;
    }
    for (const [name, value] of Object.entries(values)) {
      const row = this.rows.get(name);
      if (!row) continue;
      this.values[name] = value;
      this.controls.refuse(name, '');
      if (row.local) local.push(name);
      else if (this.connection) sent[name] = value;
    }
    this.applyLocal(local);
    this.controls.show(values, { force: true });
    if (Object.keys(sent).length) this.connection.set(sent);
    this.changed();
    return true;
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
      if (name === 'view') this.layout.showView(VIEW_NAMES[value] ?? '');
      if (name === 'sun_elevation') this.announcer.say(this.sentence());
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

  /** Note that the camera moved. */
  moved() {
    const height = this.camera.height;
    if (this.rows.has('camera_height') && Math.abs(height - this.values.camera_height) > 1e-6) {
      this.values.camera_height = height;
      this.controls.show({ camera_height: height });
    }
    this.changed();
  }

  /** Do what a key does. */
  keyDown(event) {
    if (event.key === 'Escape' && isField(event.target) && this.root.contains(event.target)) {
      event.target.blur();
      this.canvas.focus();
      return;
    }
    if (!this.keysEnabled || this.layout.text.node.open) return;
    const action = actionOf(event, this.plan);
    if (!action) return;
    if (this.layout.help.node.open && action.name !== 'help') return;
    event.preventDefault();
    this.held.fast = event.shiftKey;
    if (action.type === 'hold') this.held.press(action.name);
    else if (action.type === 'step') this.step(action.name, action.direction);
    else this.act(action.name);
  }

  /** Let go of a key. */
  keyUp(event) {
    this.held.release(event.key);
    if (event.key === 'Shift') this.held.fast = false;
  }

  /** Change a parameter by one step, and say its value. */
  step(name, direction) {
    const row = this.rows.get(name);
    if (this.fixed && !this.ownNames().has(name)) {
      this.refuse(`${row.label.toLowerCase()} is fixed: the sea is made already`);
      return;
    }
    const high = name === 'tiles' ? Math.min(row.high, this.mostTiles) : row.high;
    const value = stepped({ ...row, high }, this.values[name], direction);
    if (!this.change({ [name]: value })) return;
    const text = row.kind === 'choice' ? choiceLabel(value) : valueText(row, value);
    this.layout.toast(`${row.label}: ${text}`);
  }

  /** Do an action of a key or a button. */
  act(name) {
    const does = {
      pause: () => this.pause(!this.clock.paused),
      view: () => this.step('view', 1),
      few_waves: () => this.step('model', 1),
      copy_job: () => this.askCopy('job'),
      copy_command: () => this.askCopy('command'),
      screenshot: () => this.screenshot(),
      help: () => this.layout.toggleHelp(),
      verify: () => this.verify(),
      open: () => this.fileInput.click(),
    };
    does[name]?.();
  }

  /** Let time stand still, or go on. */
  pause(paused) {
    this.clock.paused = paused;
    this.clock.last = null;
    this.frameRate.clear();
    this.layout.showPaused(paused);
    this.announcer.say(paused ? 'Time stands still.' : 'Time goes on.');
    this.changed();
  }

  /** Send a message, or say that there is no connection. */
  sendOr(message) {
    if (!this.connection) this.refuse('this page has no server');
    else if (this.connection.send(message)) return true;
    else if (!this.connection.ready)
      this.refuse('the server does not answer; the change is not made');
    return false;
  }

  /** Ask for a text to copy, or take it from the sea itself. */
  askCopy(what) {
    if (this.connection) {
      this.sendOr({ copy: what });
      return;
    }
    const { about = {} } = this.embedded ?? {};
    const text = what === 'job' ? (this.sea?.document.job ?? about.job) : about.command;
    if (text) this.copy(what, text);
    else this.refuse(`this page carries no ${what === 'job' ? 'job' : 'bake command'}`);
  }

  /** Put a text on the clipboard; where the browser refuses, show it. */
  async copy(what, text) {
    const name = what === 'job' ? 'The job' : 'The bake command';
    this.copied = { what, text };
    try {
      await navigator.clipboard.writeText(text);
      this.layout.toast(`${name} is on the clipboard`);
    } catch {
      this.layout.showText(name, text);
    }
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

  /** Save the picture as a PNG. */
  async screenshot() {
    const blob = await this.still();
    if (!blob) return;
    const address = URL.createObjectURL(blob);
    const name = `fftocean-${String(this.clock.tick)}.png`;
    element('a', { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10e3);
    this.layout.toast(`Saved ${name}`);
  }

  /** Compare the fields of the page with those of the library. */
  async verify() {
    if (this.verifying) return;
    if (!this.stage.simulation) {
      this.refuse('there is no sea to verify: a bake is played, or no picture can be drawn');
      return;
    }
    if (!this.connection) {
      await this.checkItself();
      this.figures.revealVerification();
      return;
    }
    const why = exactSea(this.stage.simulation, this.busy);
    if (why) {
      this.refuse(`verify once the sea is exact: ${why}`);
      return;
    }
    const { tick } = this.clock;
    const done = Promise.withResolvers?.() ?? withResolvers();
    this.verifying = { tick, answers: [], done, tiles: this.stage.simulation.tiles.length };
    this.verifyButton.disabled = true;
    const timer = setTimeout(
      () => this.endVerifying(`no answer within ${VERIFY_PATIENCE} s`),
      1000 * VERIFY_PATIENCE,
    );
    const { id } = this.sea.document;
    if (!this.sendOr({ verify: { tick, sea: id } })) this.endVerifying('');
    await done.promise;
    clearTimeout(timer);
  }

  /** Take the fields of one tile, and compare them with those of the page at the same tick. */
  async takeReference(data) {
    const { verifying } = this;
    if (!verifying) return;
    try {
      const reference = decodeReference(data);
      const { simulation } = this.stage;
      const answer = await this.alone(() =>
        compareReference(simulation, reference, this.values.choppiness),
      );
      verifying.answers.push(answer);
      this.changed();
    } catch (error) {
      this.endVerifying(error.message);
      return;
    }
    if (verifying.answers.length < verifying.tiles) return;
    this.endVerifying('');
  }

  /** Show what a verification found, or why it found nothing. */
  endVerifying(failure) {
    const { verifying } = this;
    if (!verifying) return;
    this.verifying = null;
    this.verifyButton.disabled = false;
    verifying.done.resolve();
    if (failure) {
      this.refuse(`not verified: ${failure}`);
      return;
    }
    if (!verifying.answers.length) return;
    this.showVerdict(verifying.answers, `at tick ${verifying.tick}, against the library`);
  }

  /** Compare the page with the points that its file carries. */
  async checkItself() {
    const check = new SelfCheck(this.sea);
    if (!check.possible) {
      this.refuse('this page carries no reference points');
      return;
    }
    const { simulation } = this.stage;
    try {
      const answers = await this.alone(() => check.run(simulation, this.values.choppiness));
      this.showVerdict(answers, `at ${check.points} points that the file carries`);
    } catch (error) {
      this.refuse(`not verified: ${error.message}`);
    }
    this.changed();
  }

  /** Show errors with a verdict. */
  showVerdict(answers, against) {
    const passed = answers.every((answer) => answer.passed);
    const worst = Math.max(...answers.map((answer) => answer.worst));
    const verdict = passed ? 'Verified' : 'Not the same';
    const title = `${verdict} ${against}: largest relative error ${worst.toExponential(1)}`;
    const rows = answers.flatMap(({ tile, errors, limit }) =>
      Object.entries(errors).map(([field, error]) => ({ tile, field, error, limit })),
    );
    this.verdict = { passed, worst, rows };
    this.figures.showVerification({ title, rows });
    this.layout.toast(title, passed ? 'note' : 'refusal');
    if (this.layout.wide && !this.embedded) {
      this.layout.toggle('figures', true);
      this.figures.revealVerification();
    }
  }

  /** Take a refusal of the server: show the values that it still has, and say why. */
  takeRefusal({ message, name }) {
    const names = name ? [name] : Object.keys(this.served);
    const before = {};
    for (const one of names) if (one in this.served) before[one] = this.served[one];
    Object.assign(this.values, before);
    this.controls.show(before, { force: true });
    if (name) this.controls.refuse(name, message);
    if (this.verifying) this.endVerifying(message);
    else this.refuse(message);
    this.changed();
  }

  /** Show a refusal. */
  refuse(message) {
    this.refusal = message;
    this.layout.toast(message, 'refusal');
  }

  /** Show how the connection is. */
  showStatus({ phase, attempts, wait }) {
    const texts = {
      connecting: 'connecting',
      again: 'connecting again',
      open: 'connected',
      waiting: this.connection?.gone ? 'none: the server is gone' : `lost; again in ${wait} s`,
    };
    this.figures.showConnection(phase, texts[phase]);
    if (phase === 'waiting' && attempts === 1) {
      this.layout.toast('The server does not answer. The sea goes on; the page tries again.');
    }
    if (phase === 'waiting' && this.connection?.gone && !this.serverGone) this.loseServer();
    if (phase === 'open') this.serverGone = false;
    if (phase === 'waiting') this.endVerifying('the connection was lost');
    if (phase === 'open' && this.wasLost) this.layout.toast('Connected again');
    this.wasLost = phase !== 'open' && (this.wasLost || phase === 'waiting');
  }

  /** Say that the server may not come back, and show the values of the sea that it sent last. */
  loseServer() {
    this.serverGone = true;
    Object.assign(this.values, this.served);
    this.controls.show(this.served, { force: true });
    this.changed();
    this.refuse(SERVER_GONE);
  }

  /** Use another canvas, after a context that did not come back. */
  takeCanvas(canvas) {
    this.canvas = canvas;
    this.layout.canvas = canvas;
    const { signal } = this.ending;
    takePointers(canvas, this.camera, { onMove: () => this.moved(), signal });
  }

  /** Draw a picture where something changed. */
  async frame(now) {
    const passed = Math.min((now - (this.lastFrame ?? now)) / 1000, 0.25);
    this.lastFrame = now;
    const seconds = this.clock.update(now);
    if (moveByKeys(this.camera, this.held, passed)) this.moved();
    const { stage } = this;
    if (now - (this.lastFigures ?? -Infinity) > 1000 * FIGURES_EVERY) {
      this.lastFigures = now;
      this.showTime();
    }
    if (!stage.ready || this.turn) return;
    const blending = stage.simulation !== null && stage.simulation.weight !== 1;
    if (!this.dirty && this.clock.paused && !blending) return;
    if (!this.dirty && seconds === 0 && !blending && this.clock.scale === 0) return;
    this.dirty = false;
    await this.alone(() => this.picture(seconds, this.clock.paused ? CHANGE : passed));
    this.frames += 1;
    this.noteFrame(now / 1000);
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
    if (stage.simulation) clock.follow(stage.simulation.document);
    if (stage.foamIsNew) await stage.growFoam(clock, choppiness, this.eye(), foam);
    stage.simulation?.advance(passed);
    if (stage.simulation) clock.follow(stage.simulation.document);
    await stage.step(clock.tick, choppiness);
    if (!stage.ready) return;
    if (seconds !== 0) stage.advanceFoam(this.eye(), Math.abs(seconds), foam);
    this.draw();
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
    if (model) stage.renderFew(model, this.clock.tick, this.camera, look, width, height);
  }

  /** Note a frame, and draw a cheaper picture where the device is too slow for this one. */
  noteFrame(seconds) {
    if (this.clock.paused) return;
    this.rate = this.frameRate.note(seconds);
    this.levelSince ??= seconds;
    const settled = seconds - this.levelSince > 3 && this.frameRate.times.length > 2;
    if (!settled || this.rate === null || this.rate >= SLOWEST) return;
    this.levelSince = seconds;
    if (this.stage.coarser()) this.frameRate.clear();
  }

  /** Show what changes with time. */
  showTime() {
    const { clock, stage } = this;
    const by = { gpu: 'GPU', worker: 'JavaScript', playback: 'bake' }[stage.kind] ?? 'none';
    const software = stage.software ? ', drawn by software' : '';
    this.figures.showTime({
      rate: this.rate,
      tick: clock.tick,
      ticks: clock.ticks,
      paused: clock.paused,
      picture: `${by}${software}, ${this.canvas.width} × ${this.canvas.height}`,
    });
    this.showSplit();
  }

  /** Name the two halves of the picture while few waves are shown, with the time that each takes. */
  showSplit() {
    const model = this.fewModel();
    const lit = this.values.view === 'sea' ? '' : ', lit'; // false colours are of the FFT alone
    const time = (name, what) => {
      const found = this.stage.timer?.milliseconds(name) ?? null;
      return found === null ? '' : `, ${what} ${Number(found.toPrecision(2))} ms`;
    };
    this.layout.showSplit(
      model && [
        `FFT: ${wavesText(wavesOf(this.sea.document))}` +
          `${time('waves', 'transforms')}${time('sea', 'picture')}`,
        `${choiceLabel(model.model)}${lit}: ${wavesText(model.kx.length)}` +
          time('few', 'half a picture'),
      ],
    );
  }

  /** Show an error of the picture, once. */
  failed(error) {
    if (this.stage.gl?.isContextLost() || this.failure === error.message) return;
    this.failure = error.message;
    this.layout.showBanner(cannotDraw(error));
    console.error(error);
  }

  /** True when the picture shows the exact sea of the newest values, or a bake; for tests. */
  get settled() {
    const { connection, stage } = this;
    // a bake has no seas that could be newer; its picture is there once a frame has come
    const newest = !connection || Boolean(this.bake) || this.servedSea === this.sea?.document.id;
    if (this.bake && (stage.playback?.shownFrame ?? null) === null) return false;
    const waiting = Boolean(connection?.pending?.size) || this.busy || !newest;
    const shown = stage.ready && (stage.simulation?.weight ?? 1) === 1 && !this.dirty && !this.turn;
    return shown && !waiting && this.sea?.document.quality !== 'moving';
  }

  /** Return the error of the graphics context, 0 for none; for tests. */
  get glError() {
    return this.stage.gl?.getError() ?? 0;
  }

  /** End: free the context, close the socket, remove the elements. */
  dispose() {
    cancelAnimationFrame(this.handle);
    this.ending.abort();
    this.resizes.disconnect();
    this.announcer.dispose();
    this.connection?.close?.();
    this.stage.dispose();
    this.layout.dispose();
  }
}

/** Return {promise, resolve, reject}. */
function withResolvers() {
  const made = {};
  made.promise = new Promise((resolve, reject) => Object.assign(made, { resolve, reject }));
  return made;
}
