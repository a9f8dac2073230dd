// Shader passes over a whole render target, and the targets themselves.
import * as THREE from 'three';

const VERTEX = 'in vec3 position; void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }';

export const HEAD = `precision highp float; precision highp int;
precision highp sampler2D; precision highp sampler2DArray;
`;

/** Return the material of a pass, with uniforms by name. */
export function pass(source, names) {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: VERTEX,
    fragmentShader: HEAD + source,
    uniforms: Object.fromEntries(names.map((name) => [name, { value: null }])),
    depthTest: false,
    depthWrite: false,
  });
}

/** Runs passes with one renderer. */
export class Passes {
  constructor(renderer) {
    this.renderer = renderer;
    const triangle = new THREE.BufferGeometry();
    triangle.setAttribute('position', new THREE.Float32BufferAttribute([-1, -1, 0, 3, -1, 0, -1, 3, 0], 3));
    this.mesh = new THREE.Mesh(triangle);
    this.mesh.frustumCulled = false;
    this.scene = new THREE.Scene();
    this.scene.add(this.mesh);
    this.camera = new THREE.Camera();
  }

  /** Draw a material over a target, with values of its uniforms. */
  run(material, values, target) {
    for (const [name, value] of Object.entries(values)) material.uniforms[name].value = value;
    this.mesh.material = material;
    this.renderer.setRenderTarget(target);
    this.renderer.render(this.scene, this.camera);
  }
}

/** Return a target of `count` float32 textures that are only fetched. */
export function floatTarget(width, height, count) {
  return new THREE.WebGLRenderTarget(width, height, {
    count,
    type: THREE.FloatType,
    format: THREE.RGBAFormat,
    minFilter: THREE.NearestFilter,
    magFilter: THREE.NearestFilter,
    depthBuffer: false,
  });
}

/** Return a target of `count` half float textures that repeat, with mip levels. */
export function mapTarget(width, height, count) {
  return new THREE.WebGLRenderTarget(width, height, {
    count,
    type: THREE.HalfFloatType,
    format: THREE.RGBAFormat,
    minFilter: THREE.LinearMipmapLinearFilter,
    magFilter: THREE.LinearFilter,
    wrapS: THREE.RepeatWrapping,
    wrapT: THREE.RepeatWrapping,
    generateMipmaps: true,
    anisotropy: 4,
    depthBuffer: false,
  });
}

/** Return a texture of numbers that are only fetched. */
export function numbers(data, width, height, format) {
  const texture = new THREE.DataTexture(data, width, height, format, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}
