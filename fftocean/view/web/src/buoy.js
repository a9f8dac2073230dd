// A buoy of 2 m that shows the scale, and the places where things float.
import { drawFullscreen, drawVertices, program, target, texture } from './gl.js';
import { TONE } from './exposure.js';
import { BUOY_COLUMNS, BUOY_RINGS, BUOY_VERTEX, buoyShader } from './shaders/float.js';
import { floatingShader } from './shaders/surface.js';

// The hull is about this wide: it does not follow shorter waves [m].
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

/** The buoy: it stays where it was laid out, before the eye. */
export class Buoy {
  constructor(gl) {
    this.gl = gl;
    this.program = program(gl, buoyShader(TONE), BUOY_VERTEX);
    this.place = null;
  }

  /**
   * Return the buoy's place relative to the eye [m], laying it out if it is not there or so far
   * away that it would hardly be seen.
   */
  placeFrom(camera) {
    const { forward } = camera.axes();
    const away = this.place
      ? Math.hypot(this.place[0] - camera.east, this.place[1] - camera.north)
      : Infinity;
    const distance = Math.max(14, 1.6 * camera.height);
    if (away > 12 * distance) {
      const level = Math.hypot(forward[0], forward[1]) || 1;
      const side = 0.18 * distance;
      this.place = [
        camera.east + (distance * forward[0] + side * forward[1]) / level,
        camera.north + (distance * forward[1] - side * forward[0]) / level,
      ];
    }
    return [this.place[0] - camera.east, this.place[1] - camera.north];
  }

  /** Take the buoy out of the water; it will be laid out anew. */
  remove() {
    this.place = null;
  }

  /** Draw the buoy into the current target. */
  draw(values) {
    const { gl } = this;
    const corners = 2 * (BUOY_COLUMNS + 1);
    drawVertices(gl, this.program, values, null, gl.TRIANGLE_STRIP, corners, BUOY_RINGS - 1);
  }

  /** Free everything. */
  dispose() {
    this.program.dispose();
  }
}
