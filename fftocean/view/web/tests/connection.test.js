// The socket of the page: joined changes, retries, and what a lost socket may not lose.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import {
  Connection,
  GIVE_UP,
  LONGEST_MESSAGE,
  PAUSE,
  socketAddress,
  WAITS,
} from '../src/connection.js';

/** A clock that the test moves, sockets that it opens and closes, and everything that is heard. */
class Bench {
  constructor() {
    this.time = 0;
    this.calls = [];
    this.sockets = [];
    this.heard = [];
    const hear = (kind) => (value) => this.heard.push([kind, value]);
    const kinds = ['status', 'state', 'sea', 'reference', 'refused', 'copied', 'bake', 'frame'];
    this.connection = new Connection({
      address: 'ws://127.0.0.1:1/socket',
      token: 'secret',
      listeners: Object.fromEntries(kinds.map((kind) => [kind, hear(kind)])),
      open: (address, protocols) => this.opened(address, protocols),
      later: (seconds, call) => this.later(seconds, call),
      now: () => this.time,
    });
  }

  opened(address, protocols) {
    const socket = { address, protocols, sent: [], closed: false };
    socket.send = (text) => socket.sent.push(JSON.parse(text));
    socket.close = () => (socket.closed = true);
    this.sockets.push(socket);
    return socket;
  }

  later(seconds, call) {
    const entry = { at: this.time + seconds, call };
    this.calls.push(entry);
    return () => (this.calls = this.calls.filter((one) => one !== entry));
  }

  /** Let time pass, and what is due happen. */
  pass(seconds) {
    const end = this.time + seconds;
    for (;;) {
      const [next] = this.calls.filter(({ at }) => at <= end).sort((a, b) => a.at - b.at);
      if (!next) break;
      this.calls = this.calls.filter((one) => one !== next);
      this.time = next.at;
      next.call();
    }
    this.time = end;
  }

  get socket() {
    return this.sockets.at(-1);
  }
}

test('the token is the subprotocol, and not in the address', () => {
  const bench = new Bench();
  bench.connection.start();
  assert.deepEqual(bench.socket.protocols, ['fftocean.secret']);
  assert.equal(bench.socket.address, 'ws://127.0.0.1:1/socket');
  const page = { protocol: 'http:', host: '127.0.0.1:8' };
  assert.equal(socketAddress(page), 'ws://127.0.0.1:8/socket');
  assert.equal(socketAddress({ protocol: 'file:', host: '' }), null);
});

test('changes within a pause are joined, and the newest wins', () => {
  const bench = new Bench();
  const { connection } = bench;
  connection.start();
  bench.socket.onopen();
  connection.set({ wind_speed: 1 });
  for (let i = 2; i <= 9; i++) connection.set({ wind_speed: i });
  connection.set({ fetch: 5 });
  assert.deepEqual(bench.socket.sent, [{ set: { wind_speed: 1 } }]);
  bench.pass(PAUSE);
  assert.deepEqual(bench.socket.sent[1], { set: { wind_speed: 9, fetch: 5 } });
  bench.pass(10);
  assert.equal(bench.socket.sent.length, 2);
});

test('a message other than a change comes after the changes before it', () => {
  const bench = new Bench();
  bench.connection.start();
  bench.socket.onopen();
  bench.connection.set({ a: 1 });
  bench.connection.set({ a: 2 });
  assert.equal(bench.connection.send({ verify: { tick: 3 } }), true);
  assert.deepEqual(bench.socket.sent.slice(1), [{ set: { a: 2 } }, { verify: { tick: 3 } }]);
});

test('a lost socket comes back after longer and longer times', () => {
  const bench = new Bench();
  const { connection } = bench;
  connection.start();
  bench.socket.onopen();
  for (const wait of [...WAITS, WAITS.at(-1)]) {
    bench.socket.onclose({ reason: '' });
    const count = bench.sockets.length;
    bench.pass(wait - 0.001);
    assert.equal(bench.sockets.length, count, 'not before its time');
    bench.pass(0.002);
    assert.equal(bench.sockets.length, count + 1);
  }
  assert.equal(connection.send({ copy: 'job' }), false);
  bench.socket.onopen();
  assert.equal(connection.ready, true);
  bench.socket.onclose({ reason: '' });
  bench.pass(WAITS[0]);
  assert.equal(bench.sockets.length, WAITS.length + 3, 'a connection that held begins anew');
});

test('a socket that was replaced cannot end the new one', () => {
  const bench = new Bench();
  bench.connection.start();
  const [old] = bench.sockets;
  old.onclose({});
  bench.pass(WAITS[0]);
  bench.socket.onopen();
  old.onclose({});
  assert.equal(bench.connection.ready, true);
});

test('nothing happens after close', () => {
  const bench = new Bench();
  bench.connection.start();
  bench.socket.onopen();
  bench.connection.set({ a: 1 });
  bench.connection.set({ a: 2 });
  bench.connection.close();
  bench.socket.onclose({});
  bench.pass(100);
  assert.equal(bench.sockets.length, 1);
  assert.equal(bench.socket.sent.length, 1);
});

test('messages reach the listener of their kind', () => {
  const bench = new Bench();
  const { connection } = bench;
  const binary = (magic) => {
    const bytes = new Uint8Array(32);
    bytes.set([...magic].map((letter) => letter.charCodeAt(0)));
    return bytes.buffer;
  };
  connection.received('{"state": {"seed": 7}, "source": "the page", "busy": false}');
  connection.received('{"refused": {"message": "no", "name": "seed"}}');
  for (const magic of ['FFTO', 'FFTR', 'FFTB', 'ELSE']) connection.received(binary(magic));
  connection.received('no JSON');
  connection.received('null');
  connection.received('7');
  assert.deepEqual(
    bench.heard.map(([kind]) => kind),
    ['state', 'refused', 'sea', 'reference', 'frame'],
  );
});

test('a message that is too long is refused here', () => {
  const bench = new Bench();
  bench.connection.start();
  bench.socket.onopen();
  assert.equal(bench.connection.send({ job: 'ä'.repeat(LONGEST_MESSAGE / 2) }), false);
  const [kind, { message }] = bench.heard.at(-1);
  assert.equal(kind, 'refused');
  assert.match(message, /at most 64 KiB/);
  assert.deepEqual(bench.socket.sent, []);
});

test('what is set while a socket is lost for a short time arrives, the newest value alone', () => {
  const bench = new Bench();
  const { connection } = bench;
  connection.start();
  bench.socket.onopen();
  for (let attempt = 1; attempt <= GIVE_UP; attempt++) {
    bench.socket.onclose({});
    connection.set({ seed: attempt });
    bench.pass(WAITS[attempt - 1]);
  }
  bench.socket.onopen();
  assert.deepEqual(bench.socket.sent, [{ set: { seed: GIVE_UP } }]);
});

test('a server that is gone takes no values, and what waited for it is forgotten', () => {
  const bench = new Bench();
  const { connection } = bench;
  connection.start();
  bench.socket.onopen();
  bench.socket.onclose({});
  connection.set({ seed: 2 });
  for (let attempt = 1; attempt <= GIVE_UP; attempt++) {
    assert.equal(connection.gone, false);
    assert.equal(connection.pending.size, 1);
    bench.pass(WAITS[attempt - 1]);
    bench.socket.onclose({});
  }
  assert.equal(connection.gone, true);
  connection.set({ seed: 3 });
  assert.equal(connection.pending.size, 0);
  bench.pass(WAITS.at(-1)); // it goes on trying
  bench.socket.onopen();
  assert.equal(connection.gone, false);
  assert.deepEqual(bench.socket.sent, []);
  bench.pass(PAUSE);
  connection.set({ seed: 4 });
  assert.deepEqual(bench.socket.sent, [{ set: { seed: 4 } }]);
});
