// A buoy of 2 m that shows the scale.
import { drawVertices, program } from './gl.js';
import { BUOY_COLUMNS, BUOY_RINGS, BUOY_VERTEX, buoyShader } from './shaders/float.js';
import { TONE } from './shaders/tone.js';

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
