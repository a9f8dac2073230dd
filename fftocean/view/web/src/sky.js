// Sun and sky: the map of the sky, the light that falls on the sea, and the background.
import { drawFullscreen, program, target, texture } from './gl.js';
import {
  BACKGROUND_VERTEX,
  CLEAR_SHADER,
  LIGHT_SHADER,
  SKY_SHADER,
  backgroundShader,
} from './shaders/air.js';

import { TONE } from './shaders/tone.js';

const DEGREE = Math.PI / 180;

/** Return the unit vector toward the sun, from its elevation and azimuth [degrees]. */
export function sunDirection(elevation, azimuth) {
  const [e, a] = [elevation * DEGREE, azimuth * DEGREE];
  return [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
}

/** The map of the sky, drawn anew only when the light changes. */
export class Sky {
  /** Make the map, `samples` a side. */
  constructor(gl, samples) {
    this.gl = gl;
    this.clearProgram = program(gl, CLEAR_SHADER);
    this.mapProgram = program(gl, SKY_SHADER);
    this.lightProgram = program(gl, LIGHT_SHADER);
    this.background = program(gl, backgroundShader(TONE), BACKGROUND_VERTEX);
    const size = { format: 'RGBA16F', width: samples, height: samples };
    this.map = texture(gl, { ...size, filter: 'linear', wrap: 'clamp', mips: true });
    this.mapTarget = target(gl, [this.map]);
    const half = { format: 'RGBA16F', width: samples / 2, height: samples / 2 };
    this.clearMap = texture(gl, { ...half, filter: 'linear', wrap: 'clamp' });
    this.clearTarget = target(gl, [this.clearMap]);
    this.light = texture(gl, { format: 'RGBA16F', width: 4, height: 1, wrap: 'clamp' });
    this.lightTarget = target(gl, [this.light]);
    if (!this.mapTarget.complete) {
      this.dispose();
      throw new Error('this graphics processor cannot draw into half-float textures');
    }
    this.key = '';
  }

  /** Bring the map and the light up to date with a look; see `Renderer.render`. */
  update({ sun, haze, clouds }) {
    const key = [...sun, haze, clouds].join();
    if (key === this.key) return;
    this.key = key;
    const values = { sun, haze, clouds, sky: this.map, clear_map: this.clearMap };
    const draw = (one, into) =>
      drawFullscreen(this.gl, one, { ...values, samples: into.width }, into);
    draw(this.clearProgram, this.clearTarget);
    draw(this.mapProgram, this.mapTarget);
    this.map.generateMips();
    draw(this.lightProgram, this.lightTarget);
  }

  /** Draw the background into the current target, behind everything that has depth. */
  drawBackground({ sun, clouds, plain, exposureFactor, linearLight }, matrices) {
    drawFullscreen(this.gl, this.background, {
      rays: matrices.rays,
      clear_map: this.clearMap,
      light: this.light,
      sunward: sun,
      clouds,
      plain: plain ?? [-1, -1, -1],
      exposure_factor: exposureFactor,
      linear_light: linearLight,
    });
  }

  /** Free everything. */
  dispose() {
    for (const one of [this.clearProgram, this.mapProgram, this.lightProgram, this.background])
      one?.dispose();
    this.clearTarget?.dispose();
    this.mapTarget?.dispose();
    this.lightTarget?.dispose();
  }
}
