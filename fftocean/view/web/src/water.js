// The water's surface: its mesh, the light on it, and the false colours of its fields.
import { drawVertices, program, texture } from './gl.js';
import { halfFloats } from './half.js';
import { ringDistances, visibleSector } from './camera.js';
import { TONE } from './shaders/tone.js';
import { reflectance, waterOptics } from './optics.js';
import { parts } from './parts.js';
import { meshVertex, waterShader } from './shaders/surface.js';
import { visibleTable } from './visible_slopes.js';
import { waveHeight } from './statistics.js';

// Slope variance of a sea that tells nothing of its own: capillary waves of a light air.
const CALM = [0.002, 0.002, 0];

// Extinction of a clear day's air, for a visibility of some 60 km [1/m]; haze is a factor on it.
const AIR_EXTINCTION = 6e-5;

/** Return how far the water moves from its place at rest, at most [m]. */
export function reachOf(document) {
  const bound = document?.bounds?.displacement;
  const likely = 1.6 * waveHeight(document); // beyond it waves of three hours do not go
  return Math.max(Number.isFinite(bound) ? bound : likely, 0.2);
}

/** Return a table of floats as a texture that can be filtered everywhere. */
function halfTable(gl, { data, width, height }) {
  const size = { format: 'RGBA16F', width, height, wrap: 'clamp' };
  return texture(gl, { ...size, data: halfFloats(data), filter: 'linear' });
}

/** The surface of the water. */
export class Water {
  /** Prepare a mesh of `columns` x `rings`. */
  constructor(gl, { columns, rings }) {
    this.gl = gl;
    this.columns = columns;
    this.rings = rings;
    this.ringTexture = texture(gl, { format: 'RG32F', width: rings, height: 1, wrap: 'clamp' });
    this.visibleRules = halfTable(gl, visibleTable());
    this.programs = new Map();
    this.colourMaps = null;
  }

  /** Return the program for some tiles, compiled when first asked for. */
  programFor(count, falseColours) {
    const key = `${count} ${falseColours}`;
    if (!this.programs.has(key)) {
      const source = falseColours ? parts.views.falseColourShader(count) : waterShader(count, TONE);
      this.programs.set(key, program(this.gl, source, meshVertex(count)));
    }
    return this.programs.get(key);
  }

  /** Draw the water into the current target; see `Renderer.render`. */
  draw(source, camera, aspect, look, shared) {
    const { gl } = this;
    const { document, tiles } = source;
    const reach = reachOf(document);
    const sector = visibleSector(camera, aspect, reach);
    const height = Math.max(camera.height, 0.35 * waveHeight(document));
    this.ringTexture.upload(ringDistances(sector.near, sector.far, height, this.rings));
    const falseColours = look.view !== 'sea';
    const optics = waterOptics(look.chlorophyll);
    const values = {
      ...shared,
      rings: this.ringTexture,
      visible_rules: this.visibleRules,
      sector: [sector.apex, sector.middle, sector.half, this.columns],
      beyond: document.slope_variance?.beyond ?? CALM,
      absorption: optics.absorption,
      backscattering: optics.backscattering,
      reflectance: reflectance(optics),
      wave_height: waveHeight(document),
      air_extinction: AIR_EXTINCTION * look.haze,
      crest_light: look.crestLight ? 1 : 0,
      ...(falseColours ? this.falseColours(look.view, document) : {}),
    };
    drawVertices(
      gl,
      this.programFor(tiles.length, falseColours),
      values,
      null,
      gl.TRIANGLE_STRIP,
      2 * (this.columns + 1),
      this.rings - 1,
    );
  }

  /** Return the uniforms of false colours. */
  falseColours(view, document) {
    this.colourMaps ??= texture(this.gl, {
      ...parts.views.mapTexels(),
      format: 'RGBA8',
      filter: 'linear',
      wrap: 'clamp',
    });
    return { ...parts.views.viewUniforms(view, document), colour_maps: this.colourMaps };
  }

  /** Free everything. */
  dispose() {
    for (const one of [...this.programs.values(), this.ringTexture, this.visibleRules]) {
      one.dispose();
    }
    this.colourMaps?.dispose();
  }
}
