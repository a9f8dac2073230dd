// A picture of a sea: sky, foam, water and buoy, drawn from the maps of a simulation or of a bake.
import { stopsFactor } from './exposure.js';
import { FloatingPoints } from './floating.js';
import { FoamField } from './foam.js';
import { part, parts } from './parts.js';
import { Sky, sunDirection } from './sky.js';
import { tileUniforms } from './tiles.js';
import { Water } from './water.js';

/**
 * How much a picture may cost: columns and rings of the mesh, samples a side of the sky, of the
 * foam's windows and of its noise, samples along a stretched pixel, and the most pixels of the
 * picture for one of the page.
 */
export const QUALITIES = {
  low: {
    columns: 96,
    rings: 112,
    sky: 256,
    foam: [128, 256],
    noise: 128,
    anisotropy: 2,
    pixelRatio: 1,
  },
  medium: {
    columns: 192,
    rings: 224,
    sky: 512,
    foam: [512, 1024],
    noise: 256,
    anisotropy: 8,
    pixelRatio: 1,
  },
  high: {
    columns: 384,
    rings: 384,
    sky: 512,
    foam: [1024, 2048],
    noise: 512,
    anisotropy: 16,
    pixelRatio: 2,
  },
};

/** The look of a sea that says nothing else; angles in degrees, exposure in stops. */
export const DEFAULT_LOOK = {
  sunElevation: 28,
  sunAzimuth: 60,
  chlorophyll: 0.3,
  haze: 1,
  clouds: 0.45,
  exposure: 0,
  view: 'sea',
  buoy: false,
  crestLight: true,
};

/** Draws a sea with one graphics context. */
export class Renderer {
  /**
   * Compile what every picture needs.
   *
   * @param {WebGL2RenderingContext} gl
   * @param {object} [options]
   * @param {string|object} [options.quality] a name or a value of `QUALITIES`
   */
  constructor(gl, { quality = 'medium' } = {}) {
    this.gl = gl;
    this.quality = typeof quality === 'string' ? QUALITIES[quality] : quality;
    if (!this.quality) {
      const names = Object.keys(QUALITIES).join(', ');
      throw new RangeError(`quality must be one of ${names}, got ${JSON.stringify(quality)}`);
    }
    // Half floats suffice for all that is drawn here; either extension allows them.
    gl.getExtension('EXT_color_buffer_float') ?? gl.getExtension('EXT_color_buffer_half_float');
    const { sky, foam, noise, anisotropy } = this.quality;
    this.sky = new Sky(gl, sky);
    this.foam = new FoamField(gl, foam, noise, anisotropy);
    this.floating = new FloatingPoints(gl);
    this.water = new Water(gl, this.quality);
    this.buoy = null;
    this.filtered = new WeakSet();
    this.vertexArray = gl.createVertexArray();
  }

  /**
   * Advance the foam around an eye.
   *
   * @param {object} source a simulation or a playback, with `tiles` and `document`
   * @param {{east: number, north: number}} eye
   * @param {number} seconds since the last step
   */
  advanceFoam(source, eye, seconds) {
    this.prepare();
    this.foam.advance(source, [eye.east, eye.north], seconds);
  }

  /** Forget the foam, for another sea. */
  restartFoam() {
    this.foam.restart();
  }

  /**
   * Have the parts that a look needs, before it is drawn for the first time.
   *
   * @throws {RangeError} no such view
   */
  async load({ view = 'sea', buoy = false }) {
    if (view !== 'sea') (await part('views')).viewNumber(view);
    if (buoy) await part('buoy');
  }

  /**
   * Draw a picture; see `load` for views other than the sea, and for the buoy.
   *
   * @param {object} source a simulation or a playback, with `tiles` and `document`
   * @param {Camera} camera
   * @param {object} look what of `DEFAULT_LOOK` is different
   * @param {number} width of the picture [pixels]
   * @param {number} height
   * @param {object} [into]
   * @param {?Target} [into.target] null for the canvas; else a target with depth
   * @param {boolean} [into.linear] write radiance instead of the colours of the screen
   */
  render(source, camera, look, width, height, { target = null, linear = false } = {}) {
    const { gl } = this;
    const full = { ...DEFAULT_LOOK, ...look };
    this.prepare();
    this.filter(source.tiles);
    const sun = sunDirection(full.sunElevation, full.sunAzimuth);
    const light = { sun, haze: full.haze, clouds: full.clouds };
    this.sky.update(light);
    const tiles = tileUniforms(source.tiles, camera.east, camera.north);
    if (full.buoy) this.buoy ??= new parts.buoy.Buoy(gl);
    else this.buoy?.remove();
    const buoyPlace = full.buoy ? this.buoy.placeFrom(camera) : [0, 0];
    this.floating.update(tiles, source.tiles.length, buoyPlace);

    gl.bindFramebuffer(gl.FRAMEBUFFER, target?.handle ?? null);
    gl.viewport(0, 0, width, height);
    gl.depthMask(true);
    gl.clearDepth(1);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    const matrices = camera.matrices(width / height);
    const exposureFactor = stopsFactor(full.exposure);
    const shared = {
      ...tiles,
      ...this.foam.uniforms([camera.east, camera.north], source.document.wind),
      floating: this.floating.position,
      floating_tilt: this.floating.tilt,
      eye_height: camera.height,
      view_projection: matrices.viewProjection,
      sky: this.sky.map,
      light: this.sky.light,
      sunward: sun,
      exposure_factor: exposureFactor,
      linear_light: linear,
    };
    if (full.buoy && full.view === 'sea') this.buoy.draw(shared);
    this.water.draw(source, camera, width / height, full, shared);
    gl.depthFunc(gl.LEQUAL); // the background lies on the far plane
    const plain = full.view === 'sea' ? null : parts.views.PLAIN;
    this.sky.drawBackground({ ...light, plain, exposureFactor, linearLight: linear }, matrices);
    gl.disable(gl.DEPTH_TEST);
  }

  /** Set what may have been left otherwise by someone else who draws here. */
  prepare() {
    const { gl } = this;
    gl.bindVertexArray(this.vertexArray);
    for (const test of [gl.DEPTH_TEST, gl.BLEND, gl.CULL_FACE, gl.SCISSOR_TEST]) gl.disable(test);
    gl.colorMask(true, true, true, true);
  }

  /** Let slopes and moments be filtered along stretched pixels. */
  filter(tiles) {
    const { gl } = this;
    const found = gl.getExtension('EXT_texture_filter_anisotropic');
    if (!found) return;
    const most = gl.getParameter(found.MAX_TEXTURE_MAX_ANISOTROPY_EXT);
    const samples = Math.min(this.quality.anisotropy, most);
    for (const { maps } of tiles) {
      for (const map of Object.values(maps)) {
        if (this.filtered.has(map)) continue;
        gl.bindTexture(gl.TEXTURE_2D, map.handle);
        gl.texParameterf(gl.TEXTURE_2D, found.TEXTURE_MAX_ANISOTROPY_EXT, samples);
        this.filtered.add(map);
      }
    }
  }

  /** Free everything. */
  dispose() {
    for (const one of [this.sky, this.foam, this.floating, this.water, this.buoy]) one?.dispose();
    this.gl.deleteVertexArray(this.vertexArray);
  }
}
