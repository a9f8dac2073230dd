// The few-wave models: at most 64 waves, summed at each vertex and lit as in the slides.
import { ringDistances, visibleSector } from './camera.js';
import { stopsFactor } from './exposure.js';
import { program, texture } from './gl.js';
import { NOISE_CYCLES, NOISE_SAMPLES, noiseLevels } from './noise.js';
import { reflectance, waterOptics } from './optics.js';
import { DEFAULT_LOOK } from './renderer.js';
import {
  FEW_WAVES_FRAGMENT,
  FEW_WAVES_VERTEX,
  MOST_WAVES,
  VERTEX_OUTPUTS,
} from './shaders/few_waves.js';
import { Sky, sunDirection } from './sky.js';

const TURN = 2 * Math.PI;
const AIR_EXTINCTION = 6e-5; // [1/m] of a clear day, as for the other sea
const SKY_SAMPLES = 256; // of a sky of its own

/**
 * The water as the slides light it scatters all light that one sees of it. Sea water scatters so
 * little that this must be more than it does, for the same brightness.
 */
const SCATTERED = 3;

/** Light where a look does not give it; see `Renderer` for sun, sky and chlorophyll. */
export const DEFAULT_FEW_LOOK = {
  ambient: 1,
  diffuse: 0.6,
  specular: 0.5,
  shininess: 180,
  noiseAmplitude: 0.3, // largest turn of the normal [rad], where there are waves
  noiseFrequency: 1, // ripples a metre
  choppiness: 1,
};

/** Return the fraction of a number of turns, in 0 to 1. */
function fraction(turns) {
  return turns - Math.floor(turns);
}

/** Return the number whose significand has the leading 12 bits of a 32-bit float. */
function leading(value) {
  const bits = new Uint32Array(Float32Array.of(value).buffer);
  bits[0] &= 0xfffff000;
  return new Float32Array(bits.buffer)[0];
}

/**
 * Return the waves of a model as the vertex shader takes them.
 *
 * @param {object} model a column of numbers for each quantity, as Python's `FewWaves.document`
 * @param {number} tick of the loop
 * @param {number} east, north place of the eye [m], to which positions are relative
 * @returns {{wavenumber: Float32Array, wave: Float32Array, count: number}} of each wave: leading
 *   part and rest of kx and of ky [turns/m]; amplitude [m], sharpness, 0, phase at the eye [turns]
 */
export function wavesAt(model, tick, east, north) {
  const count = model.kx.length;
  if (count > MOST_WAVES) {
    throw new RangeError(`a few-wave model must have at most ${MOST_WAVES} waves, got ${count}`);
  }
  const wavenumber = new Float32Array(4 * MOST_WAVES);
  const wave = new Float32Array(4 * MOST_WAVES);
  for (let i = 0; i < count; i++) {
    const [x, y] = [model.kx[i] / TURN, model.ky[i] / TURN];
    const [first, second] = [leading(x), leading(y)];
    wavenumber.set([first, x - first, second, y - second], 4 * i);
    // cycles x tick is below 2^32, so its remainder is exact
    const turned = ((model.cycles[i] * tick) % model.ticks) / model.ticks;
    const start = fraction(x * east) + fraction(y * north) - turned - model.phase[i] / TURN;
    wave.set([model.amplitude[i], model.sharpness[i], 0, fraction(start)], 4 * i);
  }
  return { wavenumber, wave, count };
}

/** Return the largest sum of amplitudes and of horizontal reaches of a model [m]. */
export function reachOf(model, choppiness) {
  let reach = 0;
  model.amplitude.forEach((amplitude, i) => {
    reach += Math.abs(amplitude) * Math.max(1, choppiness * model.sharpness[i]);
  });
  return reach;
}

/** Significant wave height at which ripples are as steep as they get [m]: sea state 1 of the WMO. */
const RIPPLED = 0.1;

/** Return the share of the ripples that a model has: none on flat water, all above sea state 1. */
export function ripplesOf(model) {
  const variance = model.amplitude.reduce((sum, amplitude) => sum + amplitude ** 2 / 2, 0);
  return Math.min(1, (4 * Math.sqrt(variance)) / RIPPLED);
}

/** The surface of a few-wave model, drawn with WebGL 2. */
export class FewWaves {
  /**
   * Compile the shaders and make the mesh.
   *
   * @param {WebGL2RenderingContext} gl
   * @param {object} [options]
   * @param {number} [options.columns] vertices of a ring
   * @param {number} [options.rings]
   */
  constructor(gl, { columns = 384, rings = 512 } = {}) {
    this.gl = gl;
    // Half floats suffice for a sky of its own; either extension allows them.
    gl.getExtension('EXT_color_buffer_float') ?? gl.getExtension('EXT_color_buffer_half_float');
    this.columns = columns;
    this.ringCount = rings;
    this.drawn = program(gl, FEW_WAVES_FRAGMENT, FEW_WAVES_VERTEX);
    this.readBack = null;
    this.sky = null;
    this.rings = texture(gl, { format: 'RG32F', width: rings, height: 1, wrap: 'clamp' });
    this.noise = texture(gl, {
      format: 'RG16F',
      width: NOISE_SAMPLES,
      height: NOISE_SAMPLES,
      filter: 'linear',
      mips: true,
      anisotropy: 8,
    });
    noiseLevels().forEach((texels, level) => this.noise.upload(texels, level));
    this.vertexArray = gl.createVertexArray();
    this.indices = gl.createBuffer();
    gl.bindVertexArray(this.vertexArray);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles(columns, rings), gl.STATIC_DRAW);
    gl.bindVertexArray(null);
  }

  /**
   * Draw a model and the sky behind it into a part of a picture.
   *
   * @param {object} model as Python's `FewWaves.document`
   * @param {number} tick of the model's loop
   * @param {Camera} camera
   * @param {object} look of the renderer, and what of `DEFAULT_FEW_LOOK` is different
   * @param {number} width of the whole picture, which the camera shows [pixels]
   * @param {number} height
   * @param {number[]} viewport the part to draw: left, bottom, width and height [pixels]
   * @param {Sky} [sky] of a renderer; without it, one of its own
   */
  render(model, tick, camera, look, width, height, viewport, sky = null) {
    const { gl } = this;
    const light = sky ?? (this.sky ??= new Sky(gl, SKY_SAMPLES));
    const given = { ...DEFAULT_LOOK, ...DEFAULT_FEW_LOOK, ...look };
    const sun = sunDirection(given.sunElevation, given.sunAzimuth);
    const air = { sun, haze: given.haze, clouds: given.clouds };
    for (const test of [gl.BLEND, gl.CULL_FACE, gl.DEPTH_TEST, gl.SCISSOR_TEST]) gl.disable(test);
    light.update(air);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(...viewport);
    gl.clearDepth(1);
    gl.depthMask(true);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    const aspect = width / height;
    gl.bindVertexArray(this.vertexArray);
    this.drawn.use(this.values(model, tick, camera, given, aspect, light));
    const count = 6 * (this.columns - 1) * (this.ringCount - 1);
    gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
    gl.depthFunc(gl.LEQUAL); // the background lies on the far plane
    const factors = { exposureFactor: stopsFactor(given.exposure), linearLight: false };
    light.drawBackground({ ...air, plain: null, ...factors }, camera.matrices(aspect));
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.SCISSOR_TEST);
  }

  /**
   * Return the vertices that `draw` would draw, read back from the GPU, for tests.
   *
   * @param {object} options
   * @param {boolean} [options.fade] leave out waves that the mesh cannot hold, as `draw` does
   * @returns {{still: Float32Array, moved: Float32Array, normal: Float32Array}} of each vertex: its
   *   place at rest, relative to the point of the still water below the eye; its displacement; and
   *   its normal
   */
  readVertices(model, tick, camera, look, aspect, { fade = true } = {}) {
    const { gl } = this;
    this.readBack ??= program(gl, FEW_WAVES_FRAGMENT, FEW_WAVES_VERTEX, VERTEX_OUTPUTS);
    const count = this.columns * this.ringCount;
    const floats = 8; // of a vertex: 2 + 3 + 3
    const buffer = gl.createBuffer();
    const feedback = gl.createTransformFeedback();
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, feedback);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    gl.bufferData(gl.TRANSFORM_FEEDBACK_BUFFER, 4 * floats * count, gl.STREAM_READ);
    const light = (this.sky ??= new Sky(gl, SKY_SAMPLES));
    const given = { ...DEFAULT_LOOK, ...DEFAULT_FEW_LOOK, ...look };
    const values = this.values(model, tick, camera, given, aspect, light);
    this.readBack.use(fade ? values : { ...values, fade: 0 });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.enable(gl.RASTERIZER_DISCARD);
    gl.beginTransformFeedback(gl.POINTS);
    gl.drawArrays(gl.POINTS, 0, count);
    gl.endTransformFeedback();
    gl.disable(gl.RASTERIZER_DISCARD);
    const found = new Float32Array(floats * count);
    gl.getBufferSubData(gl.TRANSFORM_FEEDBACK_BUFFER, 0, found);
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, null);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, null);
    gl.deleteTransformFeedback(feedback);
    gl.deleteBuffer(buffer);
    return separated(found, { still: 2, moved: 3, normal: 3 });
  }

  /** Return the uniforms of a picture, and upload the rings of its mesh. */
  values(model, tick, camera, look, aspect, sky) {
    const { wavenumber, wave, count } = wavesAt(model, tick, camera.east, camera.north);
    const sector = visibleSector(camera, aspect, reachOf(model, look.choppiness));
    this.rings.upload(ringDistances(sector.near, sector.far, camera.height, this.ringCount));
    const frequency = look.noiseFrequency / NOISE_CYCLES; // of the texture, a metre
    return {
      view_projection: camera.matrices(aspect).viewProjection,
      rings: this.rings,
      columns: this.columns,
      waves: count,
      middle: sector.middle,
      half_angle: sector.half,
      apex: sector.apex,
      height: camera.height,
      fade: 1,
      choppiness: look.choppiness,
      wavenumber,
      wave,
      noise: this.noise,
      noise_amplitude: ripplesOf(model) * look.noiseAmplitude,
      noise_frequency: frequency,
      noise_start: [fraction(camera.east * frequency), fraction(camera.north * frequency)],
      ambient: look.ambient,
      diffuse: look.diffuse,
      specular: look.specular,
      shininess: look.shininess,
      albedo: reflectance(waterOptics(look.chlorophyll)).map((one) => SCATTERED * Math.PI * one),
      sunward: sunDirection(look.sunElevation, look.sunAzimuth),
      sky: sky.map,
      light: sky.light,
      air_extinction: AIR_EXTINCTION * look.haze,
      exposure_factor: stopsFactor(look.exposure),
      linear_light: false,
    };
  }

  /** Free everything. */
  dispose() {
    const { gl } = this;
    for (const one of [this.drawn, this.readBack, this.rings, this.noise, this.sky]) one?.dispose();
    gl.deleteVertexArray(this.vertexArray);
    gl.deleteBuffer(this.indices);
  }
}

/** Return the corners of the triangles of a mesh of rings, two for each of its cells. */
function triangles(columns, rings) {
  const corners = new Uint32Array(6 * (columns - 1) * (rings - 1));
  let at = 0;
  for (let ring = 0; ring < rings - 1; ring++) {
    for (let column = 0; column < columns - 1; column++) {
      const corner = ring * columns + column;
      corners.set([corner, corner + 1, corner + columns], at);
      corners.set([corner + columns, corner + 1, corner + columns + 1], at + 3);
      at += 6;
    }
  }
  return corners;
}

/** Return interleaved numbers as one array for each quantity, given by its number of components. */
function separated(interleaved, components) {
  const stride = Object.values(components).reduce((sum, count) => sum + count, 0);
  const vertices = interleaved.length / stride;
  const parts = {};
  let first = 0;
  for (const [name, count] of Object.entries(components)) {
    const part = new Float32Array(count * vertices);
    for (let i = 0; i < part.length; i++) {
      part[i] = interleaved[Math.floor(i / count) * stride + first + (i % count)];
    }
    parts[name] = part;
    first += count;
  }
  return parts;
}
