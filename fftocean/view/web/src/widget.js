// Entry of the notebook widget: the page in an output cell, its messages over the kernel's own link.

import { startApp } from './sea_view.js';
import { EmbeddedSea } from './embedded.js';

/** Views that may hold a graphics context at once; browsers keep 8 to 16 for a whole page. */
export const LIMITS = { live: 4 };

// One list for all widgets of a notebook, each of which may bring its own copy of this module.
const LIVE = Symbol.for('fftocean.live-views');

/** Return the views that are live, the one shown last at the end. */
function liveViews() {
  globalThis[LIVE] ??= [];
  return globalThis[LIVE];
}

/** Return the bytes of a value of the kernel, which is a view somewhere into a message. */
export function bytesOf(value) {
  if (value instanceof ArrayBuffer) return new Uint8Array(value);
  return new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
}

/** One display of a widget: live, or parked as a still picture. */
class View {
  /** Show a model in an element. */
  constructor(model, el) {
    this.model = model;
    this.app = null;
    this.starts = 0;
    this.root = document.createElement('div');
    this.root.style.height = `${model.get('height')}px`;
    el.append(this.root);
    this.listening = new Map([
      ['change:sea', () => this.seaChanged()],
      ['change:height', () => (this.root.style.height = `${model.get('height')}px`)],
      ['msg:custom', (content, buffers) => this.take(content, buffers)],
    ]);
    for (const [event, listener] of this.listening) model.on(event, listener);
    this.resume();
  }

  /** Become live; the same widget elsewhere, and the oldest of too many, become still. */
  resume() {
    const views = liveViews();
    for (const other of views.filter((view) => view.model === this.model)) other.park();
    while (views.length >= LIMITS.live) views[0].park();
    views.push(this);
    this.root.replaceChildren();
    this.start().catch((error) => {
      this.root.textContent = `The sea cannot be shown: ${error.message}`;
    });
  }

  /** Start the page. */
  async start() {
    const { model } = this;
    this.starts += 1;
    const { starts } = this;
    const about = model.get('about');
    const plays = Boolean(about.bake);
    const app = await startApp({
      root: this.root,
      table: about.table,
      embedded: plays ? null : new EmbeddedSea(bytesOf(model.get('sea')), about),
      connect: (listeners) => this.connect(listeners, about),
    });
    if (starts === this.starts && liveViews().includes(this)) this.app = app;
    else app.dispose();
  }

  /** Return the connection of the page: messages of the widget in place of a socket. */
  connect(listeners, about) {
    this.listeners = listeners;
    const connection = {
      ready: true,
      pending: new Map(),
      set() {}, // the page itself applies what it can change
      send: (message) => {
        this.model.send({ text: JSON.stringify(message) });
        return true;
      },
      close: () => (this.listeners = null),
    };
    if (about.bake) queueMicrotask(() => this.listeners?.bake?.(about.bake));
    return connection;
  }

  /** Take a message of the kernel. */
  take(content, buffers = []) {
    const listener = this.listeners?.[content.kind];
    if (!listener) return;
    if (buffers.length) for (const buffer of buffers) listener(bytesOf(buffer));
    else listener(content.value);
  }

  /** Show another sea of the kernel. */
  seaChanged() {
    if (this.app) this.app.takeSea(bytesOf(this.model.get('sea')));
  }

  /** Return the picture that is shown, as the address of a PNG, or the kernel's still. */
  picture() {
    const { app } = this;
    if (app?.stage.ready) {
      app.draw(); // what was drawn before has gone with its frame
      return app.canvas.toDataURL('image/png');
    }
    const still = bytesOf(this.model.get('still'));
    return still.length ? URL.createObjectURL(new Blob([still], { type: 'image/png' })) : null;
  }

  /** Free the graphics context, and leave a picture that brings the view back. */
  park() {
    const address = this.picture();
    this.free();
    const again = document.createElement('button');
    again.type = 'button';
    again.setAttribute('aria-label', 'Show the sea live again');
    again.title = 'Show the sea live again';
    again.style.cssText =
      'display:block;width:100%;height:100%;padding:0;border:0;cursor:pointer;background:#0d2233 ' +
      `center/cover no-repeat ${address ? `url("${address}")` : ''}`;
    again.addEventListener('click', () => this.resume());
    this.root.replaceChildren(again);
  }

  /** Free the page with its graphics context. */
  free() {
    const views = liveViews();
    if (views.includes(this)) views.splice(views.indexOf(this), 1);
    this.app?.dispose();
    this.app = null;
    this.listeners = null;
  }

  /** End for good. */
  end() {
    for (const [event, listener] of this.listening) this.model.off(event, listener);
    this.free();
    this.root.remove();
  }
}

/** Show the widget's model in an element; return what ends it. */
export function render({ model, el }) {
  const view = new View(model, el);
  return () => view.end();
}

export default { render };
