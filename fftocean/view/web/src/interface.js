// What lets a reader see and change the sea: controls, keys, figures, messages.

import { Announcer } from './announcer.js';
import { Chip, FrameRate } from './chip.js';
import { choiceLabel, Controls, presetList } from './controls.js';
import { element } from './dom.js';
import { takeDrops } from './drop.js';
import { moveByKeys, takePointers } from './input.js';
import { actionOf, HeldKeys, isField, keyPlan } from './keys.js';
import { Layout } from './layout.js';
import { BAKE_ONLY, keepOwnControls } from './own.js';
import { part, parts, partsSoon } from './parts.js';
import { SeaView } from './sea_view.js';
import { missingGraphics } from './stage.js';
import { readTable, stepped, valueText } from './table.js';

/** Shortest time between two drawings of the figures [s]. */
const FIGURES_EVERY = 0.25;

/** Slowest rate at which the picture stays as fine as it is [frames a second]. */
const SLOWEST = 24;

/** The sentence for a server that may not come back: another one has another address. */
const SERVER_GONE =
  'The server has stopped or is out of reach, so that only light, camera and view can change. ' +
  'Start fftocean view again and open the address that it prints.';

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

/** The page in one element, with everything it does. */
export class App extends SeaView {
  /** Make the page of a view that is shown already, as a browser upgrades an element. */
  static upgrade(view) {
    Object.setPrototypeOf(view, App.prototype);
    view.build();
    return view;
  }

  /** Build the page around the canvas. */
  build() {
    this.table = readTable(this.table);
    this.rows = new Map(this.table.parameters.map((row) => [row.name, row]));
    this.plan = keyPlan(this.table.parameters, this.table.actions);
    this.held = new HeldKeys(this.plan);
    this.keysEnabled = true;
    this.frameRate = new FrameRate();
    this.rate = null;
    this.verifying = null;
    this.ending = new AbortController();
    this.layout = new Layout(this.root, { canvas: this.canvas, act: (name) => this.act(name) });
    this.announcer = new Announcer(this.layout.spoken);
    this.chip = new Chip(this.layout.chip);
    this.panel = null; // of the figures, once it is asked for
    this.own = null; // names of what can be changed, where the sea is made already
    this.connectionText = '';
    this.buildControls();
    this.listen(this.keysOn);
    this.showWhatIs();
  }

  /** Show what has come before the page was built. */
  showWhatIs() {
    const { layout, notes, refusal, status } = this;
    layout.showBanner(this.trouble || missingGraphics(this.stage.gl));
    layout.onToggle = (name, open) => {
      if (name === 'figures' && open) this.showPanel();
    };
    if (layout.wide) {
      layout.toggle('figures', true);
      layout.toggle('controls', true);
    }
    layout.showPaused(this.clock.paused);
    this.applyLocal(['view']);
    this.controls.show(this.values, { force: true });
    if (this.bake || this.embedded) keepOwnControls(this);
    if (status) this.showStatus(status);
    this.notes = { sea: [], picture: [] };
    this.showNotes(notes);
    if (refusal) this.refuse(refusal);
    this.showFigures();
    if (this.embedded && this.sea) this.use('verification', 'checkItself');
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
      this.takeFiles([...this.fileInput.files]);
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
    this.controls.keepOnly(new Set([...this.rows.keys()].filter((one) => !BAKE_ONLY.has(one))));
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
    this.resizes.observe(this.root);
    if (!this.embedded) {
      takeDrops(this.root, {
        onFiles: (files) => this.takeFiles(files),
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
    this.panel?.resized();
    this.changed();
  }

  /** Send a file to the server. */
  async takeFiles(files) {
    (await part('files')).takeFiles(this, files);
  }

  /** Take the state of the server, and show it. */
  takeState(state, message) {
    super.takeState(state, message);
    this.controls.show(this.values);
  }

  /** Show notes on the sea or on the picture, and say once those that are new. */
  showNotes(notes) {
    const before = new Set(Object.values(this.notes).flat());
    super.showNotes(notes);
    const all = Object.values(this.notes).flat();
    this.panel?.showNotes(all);
    for (const note of all) if (!before.has(note)) this.layout.toast(note);
  }

  /** Show what the newest sea is. */
  showFigures() {
    const shown = this.sea?.document ?? this.bake;
    if (!shown) return;
    const quality = this.bake ? 'recorded' : (shown.quality ?? 'exact');
    this.chip.showSea(shown, quality);
    this.panel?.showSea(shown);
    if (quality !== 'moving') this.announcer.say(this.sentence());
  }

  /** Build the panel of figures where there is none, and bring it up to date. */
  async showPanel() {
    const { HeadsUp } = await part('heads_up');
    if (this.ending.signal.aborted) return;
    if (!this.panel) {
      this.panel = new HeadsUp(this);
      this.resizes.observe(this.panel.plot);
      this.panel.showNotes(Object.values(this.notes).flat());
      this.panel.showTime();
    }
    const shown = this.sea?.document ?? this.bake;
    if (shown) this.panel.showSea(shown);
  }

  /** Return the sea in words, once that part is here. */
  sentence() {
    const described = {
      document: this.sea?.document ?? this.bake,
      look: this.look(),
      paused: this.clock.paused,
      few: this.fewModel(),
      playback: Boolean(this.bake),
    };
    return parts.accessibility?.describeSea(described) ?? '';
  }

  /** Have the parts that may be wanted, once the sea is shown. */
  async haveParts() {
    await partsSoon();
    if (this.ending.signal.aborted) return;
    this.whole = true;
    this.showFigures();
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
    super.applyLocal(names);
    if (names.includes('view')) this.layout.showView(VIEW_NAMES[this.values.view] ?? '');
    if (names.includes('sun_elevation')) this.announcer.say(this.sentence());
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
    const { help, text } = this.layout;
    if (!this.keysEnabled || text?.node.open) return;
    const action = actionOf(event, this.plan);
    if (!action) return;
    if (help?.node.open && action.name !== 'help') return;
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
    if (this.own && !this.own.has(name)) {
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
      copy_job: () => this.use('dialogs', 'askCopy', 'job'),
      copy_command: () => this.use('dialogs', 'askCopy', 'command'),
      screenshot: () => this.use('dialogs', 'screenshot'),
      help: () => this.use('dialogs', 'toggleHelp'),
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

  /** Compare the fields of the page with those of the library. */
  verify() {
    return this.use('verification', 'verify');
  }

  /** End a verification that is under way, and say why if it failed. */
  endVerifying(failure) {
    const { verifying } = this;
    if (!verifying) return;
    this.verifying = null;
    clearTimeout(verifying.timer);
    this.verifyButton.disabled = false;
    if (failure) this.refuse(`not verified: ${failure}`);
    verifying.end();
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
    super.refuse(message);
    this.layout.toast(message, 'refusal');
  }

  /** Show why there is no picture. */
  showTrouble(text) {
    super.showTrouble(text);
    this.layout.showBanner(text);
  }

  /** Show the state of the connection. */
  showConnection(phase, text) {
    this.connectionText = text;
    this.chip.showConnection(phase);
    this.panel?.showTime();
  }

  /** Show how the connection is. */
  showStatus({ phase, attempts, wait }) {
    const texts = {
      embedded: 'none: one file',
      connecting: 'connecting',
      again: 'connecting again',
      open: 'connected',
      waiting: this.connection?.gone ? 'none: the server is gone' : `lost; again in ${wait} s`,
    };
    this.showConnection(phase, texts[phase]);
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
    super.takeCanvas(canvas);
    this.layout.canvas = canvas;
    const { signal } = this.ending;
    takePointers(canvas, this.camera, { onMove: () => this.moved(), signal });
  }

  /** Draw a picture where something changed; move by the keys that are held. */
  frame(now) {
    const passed = Math.min((now - (this.lastFrame ?? now)) / 1000, 0.25);
    if (moveByKeys(this.camera, this.held, passed)) this.moved();
    if (now - (this.lastFigures ?? -Infinity) > 1000 * FIGURES_EVERY) {
      this.lastFigures = now;
      this.showTime();
    }
    return super.frame(now);
  }

  /** Go back to the sea itself where a part of the look is missing. */
  withoutParts(message) {
    super.withoutParts(message);
    this.controls.show(this.values, { force: true });
    this.layout.showView('');
  }

  /** Note a picture, and draw a cheaper picture where the device is too slow for this one. */
  drawn(seconds) {
    this.partsAsked ??= this.haveParts();
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
    this.chip.showRate(this.rate, this.clock.paused);
    this.panel?.showTime();
    const model = parts.comparison && this.fewModel();
    this.layout.showSplit(model && parts.comparison.namesOfHalves(this, model));
  }

  /** End: free the context, close the socket, remove the elements. */
  dispose() {
    this.ending.abort();
    this.resizes.disconnect();
    this.announcer.dispose();
    super.dispose();
  }
}
