// The socket to the server: changes are joined, the newest wins, and a lost socket comes back.

import { kindOf } from './container.js';

/** Seconds before each attempt to connect again; the last is repeated. */
export const WAITS = Object.freeze([0.25, 0.5, 1, 2, 4, 8]);

/** Failed attempts after which a server counts as gone: it takes 4 s to get there. */
export const GIVE_UP = 4;

/** Shortest time between two messages that set values [s]. */
export const PAUSE = 0.05;

/** Longest text message that the server takes [bytes]. */
export const LONGEST_MESSAGE = 64 * 1024;

/** Return the address of the socket beside a page, or null where the page is not on a server. */
export function socketAddress(location) {
  if (location.protocol !== 'http:' && location.protocol !== 'https:') return null;
  return `${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/socket`;
}

/** A socket that reconnects; `listeners` get state, sea, reference, frame, refused and so on. */
export class Connection {
  /**
   * Keep what a connection needs; `start` opens it.
   * `open(address, protocols)` returns a WebSocket, `later(seconds, call)` returns a function that
   * cancels, `now()` returns seconds: tests give their own.
   */
  constructor({ address, token, listeners, open = openSocket, later = callLater, now = clock }) {
    this.address = address;
    this.protocols = [`fftocean.${token}`];
    this.listeners = listeners;
    this.open = open;
    this.later = later;
    this.now = now;
    this.socket = null;
    this.ready = false;
    this.closed = false;
    this.attempts = 0;
    this.pending = new Map();
    this.lastSent = -Infinity;
    this.cancelFlush = null;
    this.cancelRetry = null;
  }

  /** Open the socket. */
  start() {
    if (this.closed) return;
    this.tell('status', { phase: this.attempts ? 'again' : 'connecting', attempts: this.attempts });
    const socket = this.open(this.address, this.protocols);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.onopen = () => this.opened();
    socket.onmessage = (event) => this.received(event.data);
    socket.onclose = (event) => this.lost(socket, event);
  }

  /** Close for good. */
  close() {
    this.closed = true;
    this.cancelFlush?.();
    this.cancelRetry?.();
    this.socket?.close();
  }

  /** Try again at once, where a retry is waiting. */
  retryNow() {
    if (!this.cancelRetry) return;
    this.cancelRetry();
    this.cancelRetry = null;
    this.start();
  }

  /**
   * Set values: those that wait are joined, and the newest value of a name is sent.
   * Values that are set while a lost socket may come back soon arrive then; a server that is gone
   * takes none.
   */
  set(values) {
    if (this.gone) return;
    for (const [name, value] of Object.entries(values)) {
      this.pending.delete(name);
      this.pending.set(name, value);
    }
    this.flushSoon();
  }

  /** True where the server has not answered for so long that it may not come back. */
  get gone() {
    return this.attempts > GIVE_UP;
  }

  /** Send a message other than `set`; return false where the socket is not open. */
  send(message) {
    if (!this.ready) return false;
    const text = JSON.stringify(message);
    const bytes = new TextEncoder().encode(text).length;
    if (bytes > LONGEST_MESSAGE) {
      const rule = `at most ${LONGEST_MESSAGE / 1024} KiB`;
      this.tell('refused', { message: `the message must have ${rule}, got ${bytes} bytes` });
      return false;
    }
    this.flush();
    this.socket.send(text);
    return true;
  }

  /** Send what waits, now or when the shortest pause is over. */
  flushSoon() {
    if (!this.ready || this.cancelFlush || !this.pending.size) return;
    const wait = this.lastSent + PAUSE - this.now();
    if (wait <= 0) {
      this.flush();
      return;
    }
    this.cancelFlush = this.later(wait, () => {
      this.cancelFlush = null;
      this.flush();
    });
  }

  /** Send the values that wait. */
  flush() {
    this.cancelFlush?.();
    this.cancelFlush = null;
    if (!this.ready || !this.pending.size) return;
    const values = Object.fromEntries(this.pending);
    this.pending.clear();
    this.lastSent = this.now();
    this.socket.send(JSON.stringify({ set: values }));
  }

  /** Note that the socket is open, and send what was set meanwhile. */
  opened() {
    this.ready = true;
    this.attempts = 0;
    this.tell('status', { phase: 'open', attempts: 0 });
    this.flushSoon();
  }

  /** Note that a socket was lost, and try again later. */
  lost(socket, event) {
    if (socket !== this.socket) return;
    this.ready = false;
    this.socket = null;
    this.cancelFlush?.();
    this.cancelFlush = null;
    if (this.closed) return;
    const wait = WAITS[Math.min(this.attempts, WAITS.length - 1)];
    this.attempts += 1;
    if (this.gone) this.pending.clear();
    const reason = event?.reason ?? '';
    this.tell('status', { phase: 'waiting', attempts: this.attempts, wait, reason });
    this.cancelRetry = this.later(wait, () => {
      this.cancelRetry = null;
      this.start();
    });
  }

  /** Hand a message to its listener. */
  received(data) {
    if (typeof data !== 'string') {
      const kind = { FFTO: 'sea', FFTR: 'reference', FFTB: 'frame' }[kindOf(data)];
      if (kind) this.tell(kind, data);
      return;
    }
    let message;
    try {
      message = JSON.parse(data);
    } catch {
      return;
    }
    for (const kind of ['state', 'refused', 'copied', 'bake']) {
      const content = message?.[kind];
      if (content) this.tell(kind, content, message);
    }
  }

  /** Call a listener where there is one. */
  tell(kind, ...values) {
    this.listeners[kind]?.(...values);
  }
}

/** Open a WebSocket. */
function openSocket(address, protocols) {
  return new WebSocket(address, protocols);
}

/** Call a function after a time; return a function that cancels. */
function callLater(seconds, call) {
  const timer = setTimeout(call, 1000 * seconds);
  return () => clearTimeout(timer);
}

/** Return the time [s]. */
function clock() {
  return performance.now() / 1000;
}
