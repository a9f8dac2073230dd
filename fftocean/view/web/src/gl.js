// WebGL 2 programs, textures and render targets: set by name, checked, and disposable.
import { FULLSCREEN_VERTEX } from './shaders/heads.js';

/** The graphics context was lost while something was made; make it anew once it is restored. */
export class ContextLost extends Error {
  constructor() {
    super('the graphics context is lost');
    this.name = 'ContextLost';
  }
}

/**
 * Return the WebGL 2 context of a canvas.
 *
 * @throws {Error} there is none; the message is a sentence for the screen
 */
export function openContext(canvas, attributes = {}) {
  const gl = canvas.getContext('webgl2', { powerPreference: 'high-performance', ...attributes });
  if (!gl) {
    throw new Error(
      'This browser offers no WebGL 2, which the sea is drawn with: turn on hardware ' +
        'acceleration in its settings, update the graphics driver, or use another browser.',
    );
  }
  return gl;
}

/**
 * Call functions when the context of a canvas is lost, and when a new one can be used.
 *
 * What was made in a lost context is gone: dispose of it, and make it again of the data.
 *
 * @returns {function()} call it to watch no longer
 */
export function watchContext(canvas, { lost, restored }) {
  const onLost = (event) => {
    event.preventDefault(); // or the context would never come back
    lost();
  };
  canvas.addEventListener('webglcontextlost', onLost);
  canvas.addEventListener('webglcontextrestored', restored);
  return () => {
    canvas.removeEventListener('webglcontextlost', onLost);
    canvas.removeEventListener('webglcontextrestored', restored);
  };
}

/** Return the formats of the data of a sized internal format. */
function layout(gl, format) {
  const layouts = {
    R8: [gl.RED, gl.UNSIGNED_BYTE],
    RG8: [gl.RG, gl.UNSIGNED_BYTE],
    RGBA8: [gl.RGBA, gl.UNSIGNED_BYTE],
    SRGB8_ALPHA8: [gl.RGBA, gl.UNSIGNED_BYTE],
    R16F: [gl.RED, gl.HALF_FLOAT],
    RG16F: [gl.RG, gl.HALF_FLOAT],
    RGBA16F: [gl.RGBA, gl.HALF_FLOAT],
    R32F: [gl.RED, gl.FLOAT],
    RG32F: [gl.RG, gl.FLOAT],
    RGBA32F: [gl.RGBA, gl.FLOAT],
    DEPTH_COMPONENT24: [gl.DEPTH_COMPONENT, gl.UNSIGNED_INT],
  };
  if (!layouts[format]) throw new Error(`a texture's format must be known, got ${format}`);
  return layouts[format];
}

/** Delete the object of a context, unless it went with a context that was lost. */
function free(owner, kind) {
  const { gl, handle } = owner;
  if (handle && gl[`is${kind}`](handle)) gl[`delete${kind}`](handle);
  owner.handle = null;
}

/** A linked program; its uniforms are set by name. */
export class Program {
  /**
   * Compile and link the sources of two shaders.
   *
   * @param {WebGL2RenderingContext} gl
   * @param {string} fragment source of the fragment shader
   * @param {string} [vertex] source of the vertex shader
   * @param {string[]} [feedback] outputs of the vertex shader to read back, interleaved
   */
  constructor(gl, fragment, vertex = FULLSCREEN_VERTEX, feedback = []) {
    this.gl = gl;
    this.handle = gl.createProgram();
    const shaders = [
      [gl.VERTEX_SHADER, vertex],
      [gl.FRAGMENT_SHADER, fragment],
    ].map(([type, source]) => {
      const shader = gl.createShader(type);
      if (!shader) throw new ContextLost();
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(this.handle, shader);
      return shader;
    });
    if (feedback.length) {
      gl.transformFeedbackVaryings(this.handle, feedback, gl.INTERLEAVED_ATTRIBS);
    }
    gl.linkProgram(this.handle);
    const linked = gl.getProgramParameter(this.handle, gl.LINK_STATUS);
    const messages = shaders.map((shader) => gl.getShaderInfoLog(shader));
    for (const shader of shaders) gl.deleteShader(shader); // freed with the program
    if (!linked) {
      if (gl.isContextLost()) throw new ContextLost();
      const why = [...messages, gl.getProgramInfoLog(this.handle)].filter(Boolean).join('\n');
      gl.deleteProgram(this.handle);
      throw new Error(`a shader does not compile: ${why}`);
    }
    this.uniforms = new Map();
    const count = gl.getProgramParameter(this.handle, gl.ACTIVE_UNIFORMS);
    let unit = 0;
    for (let i = 0; i < count; i++) {
      const { name, type, size } = gl.getActiveUniform(this.handle, i);
      const setter = SETTERS[type];
      if (!setter) throw new Error(`uniform ${name} has a type that is not supported: ${type}`);
      const place = gl.getUniformLocation(this.handle, name);
      this.uniforms.set(name.replace('[0]', ''), { place, setter, size, unit });
      if (setter === setSamplers) unit += size;
    }
  }

  /**
   * Make this the current program and set its uniforms.
   *
   * @param {Object<string, number|boolean|ArrayLike|Texture|Texture[]>} values by name; every
   *   uniform of the program must be among them, and others are ignored
   */
  use(values) {
    const { gl } = this;
    gl.useProgram(this.handle);
    for (const [name, { place, setter, size, unit }] of this.uniforms) {
      const value = values[name];
      if (value === undefined) throw new Error(`the uniform ${name} was not given`);
      setter(gl, place, value, size, unit);
    }
  }

  /** Free the program. */
  dispose() {
    free(this, 'Program');
  }
}

/** Bind textures to units of their own and tell the samplers. */
function setSamplers(gl, place, value, size, unit) {
  const textures = Array.isArray(value) ? value : [value];
  const units = Int32Array.from({ length: size }, (_, i) => unit + i);
  textures.slice(0, size).forEach((given, i) => {
    gl.activeTexture(gl.TEXTURE0 + unit + i);
    gl.bindTexture(gl.TEXTURE_2D, given.handle);
  });
  gl.uniform1iv(place, units);
}

/** Return the setter of a uniform of numbers, given as one number, a list, or a list of lists. */
function numbers(method) {
  return (gl, place, value) => gl[method](place, flat(value));
}

/** Return the setter of a uniform matrix, whose columns come one after the other. */
function matrices(method) {
  return (gl, place, value) => gl[method](place, false, flat(value));
}

/** Return a number, a list or a list of lists as a flat list. */
function flat(value) {
  if (typeof value === 'number' || typeof value === 'boolean') return [Number(value)];
  return Array.isArray(value) ? value.flat() : value;
}

// By the number that getActiveUniform gives for the type, which is the same in every context.
const SETTERS = {
  0x1404: numbers('uniform1iv'),
  0x8b53: numbers('uniform2iv'),
  0x8b54: numbers('uniform3iv'),
  0x8b55: numbers('uniform4iv'),
  0x1405: numbers('uniform1uiv'),
  0x8b56: numbers('uniform1iv'), // bool
  0x1406: numbers('uniform1fv'),
  0x8b50: numbers('uniform2fv'),
  0x8b51: numbers('uniform3fv'),
  0x8b52: numbers('uniform4fv'),
  0x8b5a: matrices('uniformMatrix2fv'),
  0x8b5b: matrices('uniformMatrix3fv'),
  0x8b5c: matrices('uniformMatrix4fv'),
  0x8b5e: setSamplers,
};

/** Return a program; see `Program`. */
export function program(gl, fragment, vertex = FULLSCREEN_VERTEX, feedback = []) {
  return new Program(gl, fragment, vertex, feedback);
}

/** A two-dimensional texture of fixed size. */
export class Texture {
  /**
   * Make a texture.
   *
   * @param {WebGL2RenderingContext} gl
   * @param {object} options
   * @param {string} options.format a sized internal format, such as 'RGBA16F'
   * @param {number} options.width
   * @param {number} options.height
   * @param {?ArrayBufferView} [options.data] of level 0; zeros without it
   * @param {'nearest'|'linear'} [options.filter] for mips, linear between levels too
   * @param {'repeat'|'clamp'} [options.wrap]
   * @param {boolean} [options.mips] keep a whole chain of levels
   * @param {number} [options.anisotropy] most samples along a stretched pixel, where supported
   */
  constructor(gl, options) {
    const { format, width, height, data = null, filter = 'nearest', wrap = 'repeat' } = options;
    this.gl = gl;
    this.format = format;
    this.width = width;
    this.height = height;
    this.handle = gl.createTexture();
    this.levels = options.mips ? Math.floor(Math.log2(Math.max(width, height))) + 1 : 1;
    gl.bindTexture(gl.TEXTURE_2D, this.handle);
    gl.texStorage2D(gl.TEXTURE_2D, this.levels, gl[format], width, height);
    const magnified = filter === 'linear' ? gl.LINEAR : gl.NEAREST;
    const shrunk = filter === 'linear' ? gl.LINEAR_MIPMAP_LINEAR : gl.NEAREST_MIPMAP_NEAREST;
    const around = wrap === 'repeat' ? gl.REPEAT : gl.CLAMP_TO_EDGE;
    for (const [name, value] of [
      [gl.TEXTURE_MAG_FILTER, magnified],
      [gl.TEXTURE_MIN_FILTER, this.levels > 1 ? shrunk : magnified],
      [gl.TEXTURE_WRAP_S, around],
      [gl.TEXTURE_WRAP_T, around],
    ]) {
      gl.texParameteri(gl.TEXTURE_2D, name, value);
    }
    const anisotropic = options.anisotropy && gl.getExtension('EXT_texture_filter_anisotropic');
    if (anisotropic) {
      const most = gl.getParameter(anisotropic.MAX_TEXTURE_MAX_ANISOTROPY_EXT);
      const samples = Math.min(options.anisotropy, most);
      gl.texParameterf(gl.TEXTURE_2D, anisotropic.TEXTURE_MAX_ANISOTROPY_EXT, samples);
    }
    if (data) this.upload(data);
  }

  /** Replace the texels of one level: width x height rows, x fastest. */
  upload(data, level = 0) {
    const { gl } = this;
    const [components, type] = layout(gl, this.format);
    const width = Math.max(1, this.width >> level);
    const height = Math.max(1, this.height >> level);
    gl.bindTexture(gl.TEXTURE_2D, this.handle);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texSubImage2D(gl.TEXTURE_2D, level, 0, 0, width, height, components, type, data);
  }

  /** Average level 0 into the other levels. */
  generateMips() {
    this.gl.bindTexture(this.gl.TEXTURE_2D, this.handle);
    this.gl.generateMipmap(this.gl.TEXTURE_2D);
  }

  /** Free the texture. */
  dispose() {
    free(this, 'Texture');
  }
}

/** Return a texture; see `Texture`. */
export function texture(gl, options) {
  return new Texture(gl, options);
}

/** One or several textures of one size to draw into, all at once. */
export class Target {
  /**
   * Make a framebuffer of textures, and of a depth texture if one is given.
   *
   * @param {WebGL2RenderingContext} gl
   * @param {Texture[]} textures
   * @param {?Texture} [depth]
   */
  constructor(gl, textures, depth = null) {
    this.gl = gl;
    this.textures = textures;
    this.depth = depth;
    this.width = (textures[0] ?? depth).width;
    this.height = (textures[0] ?? depth).height;
    this.handle = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.handle);
    const attach = (point, { handle }) =>
      gl.framebufferTexture2D(gl.FRAMEBUFFER, point, gl.TEXTURE_2D, handle, 0);
    textures.forEach((one, i) => attach(gl.COLOR_ATTACHMENT0 + i, one));
    if (depth) attach(gl.DEPTH_ATTACHMENT, depth);
    gl.drawBuffers(textures.map((_, i) => gl.COLOR_ATTACHMENT0 + i));
    this.complete = gl.checkFramebufferStatus(gl.FRAMEBUFFER) === gl.FRAMEBUFFER_COMPLETE;
  }

  /** Direct drawing into the whole of this target. */
  bind() {
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, this.handle);
    this.gl.viewport(0, 0, this.width, this.height);
  }

  /** Return the texels of one of the textures as float32, (height, width, 4). */
  read(index = 0) {
    const { gl, width, height } = this;
    const texels = new Float32Array(4 * width * height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.handle);
    gl.readBuffer(gl.COLOR_ATTACHMENT0 + index);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, texels);
    return texels;
  }

  /** Free the framebuffer, and its textures too unless they are kept. */
  dispose({ keepTextures = false } = {}) {
    free(this, 'Framebuffer');
    if (keepTextures) return;
    for (const one of this.textures) one.dispose();
    this.depth?.dispose();
  }
}

/** Return a target; see `Target`. */
export function target(gl, textures, depth = null) {
  return new Target(gl, textures, depth);
}

/**
 * Draw a program over the whole of a target, or of what is bound now if the target is null.
 *
 * Depth test and blending are left as they are.
 */
export function drawFullscreen(gl, drawn, values, into = null) {
  drawVertices(gl, drawn, values, into, gl.TRIANGLES, 3);
}

/** Draw vertices that the program makes of their numbers (gl_VertexID). */
export function drawVertices(gl, drawn, values, into, mode, count, instances = 1) {
  drawn.use(values);
  into?.bind();
  if (instances === 1) gl.drawArrays(mode, 0, count);
  else gl.drawArraysInstanced(mode, 0, count, instances);
}
