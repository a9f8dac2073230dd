// The notebook widget with a model that stands in for the kernel's.
import { FIELDS } from '/live/container.js';
import { LIMITS, render } from '/live/widget.js';
import { base64, bytes, json } from './common.js';

/** A model as a notebook gives it: values, events, messages. */
class Model {
  constructor(values, answer) {
    this.values = values;
    this.answer = answer;
    this.listeners = new Map();
    this.sent = [];
  }

  get(name) {
    return this.values[name];
  }

  on(event, listener) {
    this.listeners.set(event, [...(this.listeners.get(event) ?? []), listener]);
  }

  off(event, listener) {
    const kept = (this.listeners.get(event) ?? []).filter((one) => one !== listener);
    this.listeners.set(event, kept);
  }

  emit(event, ...values) {
    for (const listener of this.listeners.get(event) ?? []) listener(...values);
  }

  get listening() {
    return [...this.listeners.values()].reduce((sum, { length }) => sum + length, 0);
  }

  send(content) {
    this.sent.push(JSON.parse(content.text));
    this.answer(this, this.sent.at(-1));
  }
}

/** Return bytes as a notebook gives them: somewhere in a larger message. */
async function viewOf(address, offset = 13) {
  const data = new Uint8Array(await bytes(address));
  const message = new Uint8Array(offset + data.length + 5);
  message.set(data, offset);
  return new DataView(message.buffer, offset, data.length);
}

/** Wait until a condition holds. */
async function until(condition) {
  while (!condition()) await new Promise((resolve) => setTimeout(resolve, 20));
}

/** Show a model; return the element, the app that it gets, and what ends it. */
async function shown(model) {
  const el = document.body.appendChild(document.createElement('div'));
  el.style.width = '300px';
  const end = render({ model, el });
  const own = globalThis[Symbol.for('fftocean.live-views')].at(-1);
  await until(() => {
    if (el.textContent.includes('cannot be shown')) throw new Error(el.textContent);
    return own.app?.frames > 0;
  });
  return { el, own, end };
}

const scenes = {
  /** A sea: its fields, another sea, and the end. */
  async sea({ folder }) {
    const values = {
      about: await json(`${folder}/about.json`),
      sea: await viewOf(`${folder}/first.bin`),
      still: new DataView(new ArrayBuffer(0)),
      height: 160,
    };
    const model = new Model(values, () => {});
    const { el, own, end } = await shown(model);
    const { app } = own;
    await until(() => el.querySelector('.verdict')); // it has checked itself
    app.clock.paused = true;
    await app.alone(() => app.stage.step(12345, 1));
    const fields = await app.stage.simulation.readFields(0);
    const first = Object.fromEntries(FIELDS.map((name) => [name, base64(fields[name])]));
    const { height } = el.firstChild.getBoundingClientRect();
    const verdict = el.querySelector('.verdict')?.textContent ?? '';
    values.sea = await viewOf(`${folder}/second.bin`, 6);
    model.emit('change:sea');
    await until(() => app.sea.document.id === 2 && app.stage.simulation.weight === 1);
    await app.alone(() => app.stage.step(12345, 1));
    const second = base64((await app.stage.simulation.readFields(0)).height);
    const { gl } = app.stage;
    const error = gl.getError();
    const before = gl.isContextLost();
    end();
    return {
      ...{ first, second, height, verdict, error, before },
      lost: gl.isContextLost(),
      left: [el.childElementCount, model.listening, globalThis[Symbol.for('fftocean.live-views')].length],
    };
  },

  /** The same widget twice, and then more of them than may be live. */
  async many({ folder }) {
    const about = await json(`${folder}/about.json`);
    const sea = await viewOf(`${folder}/first.bin`);
    const still = new DataView(new ArrayBuffer(0));
    const make = () => new Model({ about, sea, still, height: 130 }, () => {});
    const model = make();
    const one = await shown(model);
    const { gl } = one.own.app.stage;
    const two = await shown(model);
    const twice = {
      lost: gl.isContextLost(),
      parked: one.el.querySelector('button')?.style.backgroundImage.slice(0, 26),
      live: two.el.querySelectorAll('canvas.sea').length,
    };
    const others = [];
    LIMITS.live = 2;
    for (let i = 0; i < 2; i++) others.push(await shown(make()));
    const canvases = document.querySelectorAll('canvas.sea').length;
    one.el.querySelector('button').click();
    await until(() => one.own.app?.frames > 0);
    const again = {
      live: one.el.querySelectorAll('canvas.sea').length,
      canvases: document.querySelectorAll('canvas.sea').length,
    };
    for (const { end } of [one, two, ...others]) end();
    return { twice, canvases, again };
  },

  /** A bake, whose frames are asked of the kernel, and what the kernel refuses. */
  async bake({ folder }) {
    const values = {
      about: await json(`${folder}/about.json`),
      sea: new DataView(new ArrayBuffer(0)),
      still: new DataView(new ArrayBuffer(0)),
      height: 160,
    };
    const model = new Model(values, async (own, { frame }) => {
      if (!frame) return;
      const data = await viewOf(`${folder}/${frame.tile}_${frame.frame}.bin`, 3);
      own.emit('msg:custom', { kind: 'frame' }, [data]);
    });
    const { own, end } = await shown(model);
    const { playback } = own.app.stage;
    await until(() => playback.requests.size === 0 && playback.shownFrame !== null);
    model.emit('msg:custom', { kind: 'refused', value: { message: 'not <b>so</b>', name: null } });
    await until(() => document.querySelector('.refusal'));
    const refusal = document.querySelector('.refusal').textContent;
    const shownFrame = playback.shownFrame;
    const asked = model.sent;
    end();
    return { asked, shownFrame, refusal };
  },

  /** A context that the view has not got is told, and the still is what remains of a parked view. */
  async still({ folder }) {
    const about = await json(`${folder}/about.json`);
    const sea = await viewOf(`${folder}/first.bin`);
    const png = Uint8Array.of(137, 80, 78, 71);
    const still = new DataView(png.buffer);
    const model = new Model({ about, sea, still, height: 130 }, () => {});
    const el = document.body.appendChild(document.createElement('div'));
    const end = render({ model, el });
    const own = globalThis[Symbol.for('fftocean.live-views')].at(-1);
    own.park(); // before the page has begun
    const image = el.querySelector('button').style.backgroundImage;
    await new Promise((resolve) => setTimeout(resolve, 100));
    const canvases = el.querySelectorAll('canvas').length;
    end();
    return { image, canvases };
  },
};

globalThis.run = ({ scene, ...options }) => scenes[scene](options);
