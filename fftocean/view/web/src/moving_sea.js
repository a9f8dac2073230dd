// What all simulations share: the sea that they show, and its change into another.
import { part } from './parts.js';

/** [s] in which a sea changes into another. */
export const BLEND_SECONDS = 0.3;

/** A sea that is shown alone; see `AmplitudeBlend`, which takes its place when the sea changes. */
class OneSea {
  /** Show a sea. */
  constructor(sea) {
    this.sea = this.newest = sea;
    this.from = this.to = sea.tiles;
    this.scaleFrom = 0;
    this.scaleTo = this.weight = 1;
    this.revision = this.lastTick = 0;
  }

  get document() {
    return this.sea.document;
  }

  /** Note the tick that is shown. */
  prepare(tick) {
    this.lastTick = tick;
  }

  /** Let time pass, which changes nothing. */
  advance() {}
}

/** A simulation, but for its arithmetic; see `createSimulation`. */
export class MovingSea {
  /** Begin; `begin` shows a sea. */
  constructor(gl, anisotropy) {
    this.gl = gl;
    this.anisotropy = anisotropy;
    this.tiles = [];
  }

  /** Show the first sea. */
  begin(sea) {
    this.blend = new OneSea(this.fitted(sea));
  }

  get document() {
    return this.blend.document;
  }

  get sea() {
    return this.blend.newest;
  }

  get weight() {
    return this.blend.weight;
  }

  /** Return a sea as this simulation can compute it. */
  fitted(sea) {
    return sea;
  }

  /** Change into another sea; the promise is for the beginning of the change. */
  async replace(sea, seconds = BLEND_SECONDS) {
    const fitted = this.fitted(sea);
    const { AmplitudeBlend } = await part('blend');
    if (this.blend instanceof OneSea) this.blend = AmplitudeBlend.after(this.blend);
    this.blend.replace(fitted, seconds);
  }

  /** Let a change into another sea go on. */
  advance(seconds) {
    this.blend.advance(seconds);
  }
}
