// The picture of a sea: camera, mesh, and the pipelines of draw.wgsl.

const EARTH = 6371e3; // [m]

/** Return the part of draw.wgsl that depends on the number of tiles. */
export function tileCode(count) {
  const each = (line) => Array.from({ length: count }, (_, i) => line.replaceAll('TILE', i)).join('\n');
  const binding = (map, offset) => Array.from({ length: count }, (_, i) =>
    `@group(1) @binding(${3 + 3 * i + offset}) var ${map}_${i}: texture_2d<f32>;`).join('\n');
  return `
${binding('displacement', 0)}
${binding('slopes', 1)}
${binding('moments', 2)}

// Place of a rest position in the texture of a tile: texel i lies at i L / n, and has its middle at (i + 1/2) / n.
fn tile_place(i: u32, rest: vec2f) -> vec2f {
  return rest / sea.table[i].size + sea.table[i].origin + 0.5 / vec2f(f32(sea.table[i].nx), f32(sea.table[i].ny));
}

fn displaced(rest: vec2f, spacing: f32) -> vec3f {
  var sum = vec3f(0.0);
  ${each(`sum += textureSampleLevel(displacement_TILE, repeating, tile_place(TILEu, rest),
    max(log2(spacing * f32(sea.table[TILE].nx) / sea.table[TILE].size.x), 0.0)).xyz;`)}
  return sum;
}

fn summed(rest: vec2f) -> Sums {
  var sums = Sums(vec2f(0.0), vec3f(0.0), vec3f(0.0));
  var s: vec4f;
  ${each(`s = textureSample(slopes_TILE, repeating, tile_place(TILEu, rest));
  sums.slope += s.xy;
  sums.stretch += vec3f(s.zw, textureSample(displacement_TILE, repeating, tile_place(TILEu, rest)).w);
  let moment_TILE = textureSample(moments_TILE, repeating, tile_place(TILEu, rest)).xyz - vec3f(s.xy * s.xy, s.x * s.y);
  sums.variance += vec3f(max(moment_TILE.xy, vec2f(0.0)), moment_TILE.z);`)}
  return sums;
}
`;
}

const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];

export class Water {
  /**
   * Prepare pictures of a sea.
   *
   * @param {string} drawing the text of draw.wgsl
   * @param {?HTMLCanvasElement} canvas to draw to; without one, `still` draws pictures
   */
  constructor(sea, drawing, canvas = null) {
    const { device } = sea;
    const textures = 3 * sea.tiles.length + 1;
    if (textures > device.limits.maxSampledTexturesPerShaderStage) {
      throw new Error(`a picture of ${sea.tiles.length} tiles takes ${textures} textures; this device has ${device.limits.maxSampledTexturesPerShaderStage}`);
    }
    sea.makeTextures();
    Object.assign(this, { sea, device });
    this.format = canvas ? navigator.gpu.getPreferredCanvasFormat() : 'rgba8unorm';
    this.context = canvas?.getContext('webgpu');
    this.context?.configure({ device, format: this.format });
    const module = device.createShaderModule({ code: sea.kernels + drawing + tileCode(sea.tiles.length) });
    const repeating = device.createSampler({
      addressModeU: 'repeat', addressModeV: 'repeat', magFilter: 'linear', minFilter: 'linear', mipmapFilter: 'linear', maxAnisotropy: 8,
    });
    this.view = device.createBuffer({ size: 176, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
    // One layout for both pipelines: the sky uses less of it.
    const { VERTEX, FRAGMENT } = GPUShaderStage, both = VERTEX | FRAGMENT;
    const entry = (binding, kind) => ({ binding, visibility: both, ...kind });
    const groups = [
      [entry(0, { buffer: {} })],
      [entry(0, { buffer: {} }), entry(1, { sampler: {} }), ...Array.from({ length: textures }, (_, i) => entry(2 + i, { texture: {} }))],
    ].map((entries) => device.createBindGroupLayout({ entries }));
    const layout = device.createPipelineLayout({ bindGroupLayouts: groups });
    const planes = [sea.textures.at(-1), ...sea.textures.slice(0, -1)];
    this.bindings = [
      [{ buffer: sea.buffers[0] }],
      [{ buffer: this.view }, repeating, ...planes.map((texture) => texture.createView())],
    ].map((resources, i) => device.createBindGroup({ layout: groups[i], entries: resources.map((resource, binding) => ({ binding, resource })) }));
    const pipeline = (vertex, fragment, topology, depth) => device.createRenderPipeline({
      layout,
      vertex: { module, entryPoint: vertex },
      fragment: { module, entryPoint: fragment, targets: [{ format: this.format }] },
      primitive: { topology },
      depthStencil: { format: 'depth32float', depthWriteEnabled: depth, depthCompare: depth ? 'greater' : 'always' },
    });
    this.sky = pipeline('sky_corner', 'sky_colour', 'triangle-list', false);
    this.water = pipeline('mesh', 'water_colour', 'triangle-strip', true);
  }

  /**
   * Draw the sea as it is in its textures.
   *
   * @param {object} camera yaw, pitch and field of view [radians], height above the mean level [m], eye: its place [m],
   *   sun: elevation and azimuth [radians], exposure
   * @param {GPUTexture} target the canvas, if none is given
   */
  draw(encoder, { yaw, pitch, fov, height, eye, sun: [elevation, azimuth], exposure }, target = this.context.getCurrentTexture()) {
    const { device, sea } = this;
    const { width, height: rows } = target;
    const forward = [Math.cos(pitch) * Math.cos(yaw), Math.cos(pitch) * Math.sin(yaw), Math.sin(pitch)];
    const right = [Math.sin(yaw), -Math.cos(yaw), 0], up = cross(right, forward);
    const tall = Math.tan(fov / 2), wide = (tall * width) / rows;
    const scaled = (vector, factor) => [...vector.map((x) => x * factor), 0];
    const reach = sea.document.bounds.displacement, hs = Math.max(sea.document.statistics.realised.hs, 0.1);
    const apex = height + 2 * reach;
    const half = Math.min(Math.atan(wide / Math.max(Math.cos(pitch) - tall * Math.abs(Math.sin(pitch)), 0.2)) + 0.12, 3.1);
    const far = apex + Math.sqrt(2 * EARTH * height) + 4000 * Math.sqrt(hs);
    const near = 0.35 * apex;
    // As fine as the picture: a quad of the mesh is a few pixels wide.
    const columns = Math.min(Math.max(Math.round(width / 3), 96), 640), rings = Math.min(Math.max(rows, 160), 900);
    const { foam } = sea, size = foam.side * foam.cell, fraction = (x) => x - Math.floor(x);
    const beyond = sea.document.slope_variance.beyond;
    device.queue.writeBuffer(this.view, 0, new Float32Array([
      ...scaled(right, 1 / wide), ...scaled(up, 1 / tall), ...scaled(forward, 1),
      ...scaled(right, wide), ...scaled(up, tall),
      Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation), exposure,
      columns, rings, near, Math.log(far / near),
      apex, yaw, half, height,
      ...beyond, hs,
      fraction(eye[0] / size), fraction(eye[1] / size), 1 / size, 0,
      ...eye.map((at) => 512 * fraction(at / 256)), 0, 0, // two cells of the noise a metre, 512 of them
    ]));
    if (this.depth?.width !== width || this.depth?.height !== rows) {
      this.depth?.destroy();
      this.depth = device.createTexture({ size: [width, rows], format: 'depth32float', usage: GPUTextureUsage.RENDER_ATTACHMENT });
    }
    const pass = encoder.beginRenderPass({
      colorAttachments: [{ view: target.createView(), loadOp: 'clear', storeOp: 'store' }],
      depthStencilAttachment: { view: this.depth.createView(), depthClearValue: 0, depthLoadOp: 'clear', depthStoreOp: 'discard' },
    });
    this.bindings.forEach((group, i) => pass.setBindGroup(i, group));
    pass.setPipeline(this.sky);
    pass.draw(3);
    pass.setPipeline(this.water);
    pass.draw(2 * (columns + 1), rings);
    pass.end();
  }

  /** Return a picture as ImageData, after the kernels that `before` adds to an encoder. */
  async still(width, height, camera, before) {
    const { device } = this, row = Math.ceil(width / 64) * 256; // bytes, a multiple of 256
    const target = device.createTexture({ size: [width, height], format: this.format, usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC });
    const copy = device.createBuffer({ size: row * height, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    const encoder = device.createCommandEncoder();
    before(encoder);
    this.draw(encoder, camera, target);
    encoder.copyTextureToBuffer({ texture: target }, { buffer: copy, bytesPerRow: row }, [width, height]);
    device.queue.submit([encoder.finish()]);
    await copy.mapAsync(GPUMapMode.READ);
    const bytes = new Uint8Array(copy.getMappedRange()), picture = new ImageData(width, height);
    for (let y = 0; y < height; y++) picture.data.set(bytes.subarray(y * row, y * row + 4 * width), 4 * width * y);
    target.destroy();
    copy.destroy();
    return picture;
  }
}
