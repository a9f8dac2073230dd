// The places where things float: the eye, and the buoy.
import { drawFullscreen, program, target, texture } from './gl.js';
import { floatingShader } from './shaders/surface.js';

// The hull of the buoy is about this wide: it does not follow shorter waves [m].
const HULL = 0.9;

// The eye is lifted out of what would swallow it: it feels all waves of more than this [m].
const EYE = 0.4;

/** Heights and slopes of the surface at the eye and at the buoy, found on the graphics processor. */
export class FloatingPoints {
  /** Make the two texels. */
  constructor(gl) {
    this.gl = gl;
    const half = { format: 'RGBA16F', width: 2, height: 1, wrap: 'clamp' };
    this.target = target(gl, [texture(gl, half), texture(gl, half)]);
    this.programs = new Map();
  }

  /** Find the surface below the eye and at a place relative to it [m]. */
  update(tiles, count, buoy) {
    const { gl, programs } = this;
    if (!programs.has(count)) programs.set(count, program(gl, floatingShader(count)));
    const values = { ...tiles, places: [[0, 0], buoy], spacings: [EYE, HULL] };
    drawFullscreen(gl, programs.get(count), values, this.target);
  }

  get position() {
    return this.target.textures[0];
  }

  get tilt() {
    return this.target.textures[1];
  }

  /** Free everything. */
  dispose() {
    for (const one of this.programs.values()) one.dispose();
    this.target.dispose();
  }
}
