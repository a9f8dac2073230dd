// three.js: what its loaders and materials make of a bake.
import * as THREE from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { read } from 'ktx-parse';
import { base64, bytes, formula, json, lookup } from './common.js';

const renderer = new THREE.WebGLRenderer({ canvas: document.getElementById('canvas') });
renderer.outputColorSpace = THREE.LinearSRGBColorSpace;

function data(texture) {
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.colorSpace = THREE.NoColorSpace;
  texture.generateMipmaps = false;
  texture.needsUpdate = true;
  return texture;
}

function halves(buffer, columns, rows, frames) {
  const texture = new THREE.DataArrayTexture(new Uint16Array(buffer), columns, rows, frames);
  texture.type = THREE.HalfFloatType;
  texture.format = THREE.RGBAFormat;
  return data(texture);
}

// One texture of a bake, as docs/engines.md says to load it.
const LOADERS = {
  exr: async ({ url }) => data(await new EXRLoader().loadAsync(url)),
  'exr-atlas': (texture) => LOADERS.exr(texture),
  // without setDataType the loader rounds single precision to half, toward zero
  'exr-float': async ({ url }) => data(await new EXRLoader().setDataType(THREE.FloatType).loadAsync(url)),
  bin: async ({ url, sidecar }) => {
    const s = await json(sidecar);
    return halves(await bytes(url), s.columns, s.rows, s.frames);
  },
  ktx2: async ({ url }) => {
    const file = read(new Uint8Array(await bytes(url)));
    return halves(file.levels[0].levelData.slice().buffer, file.pixelWidth, file.pixelHeight, file.layerCount);
  },
};

function rendered(scene, camera, width, height) {
  const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType });
  renderer.setRenderTarget(target);
  renderer.setClearColor(0x000000, 0);
  renderer.clear();
  renderer.render(scene, camera);
  const out = new Float32Array(4 * width * height);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, out);
  target.dispose();
  return out;
}

// The map at places of the world, by the formulas: (places, 4).
function sample(texture, { sampling, meaning, places }) {
  const array = Boolean(texture.isDataArrayTexture);
  const at = new THREE.DataTexture(Float32Array.from(places.flat()), places.length, 1, THREE.RGBAFormat, THREE.FloatType);
  at.needsUpdate = true;
  const material = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    uniforms: { places: { value: at }, map: { value: texture } },
    vertexShader: 'in vec3 position; void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
    fragmentShader: `precision highp float; precision highp sampler2D; precision highp sampler2DArray;
      uniform sampler2D places; uniform ${array ? 'sampler2DArray' : 'sampler2D'} map; out vec4 colour;
      ${lookup({ sampling, meaning, array, output: 'colour' })}`,
    depthTest: false,
  });
  const quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material);
  quad.frustumCulled = false;
  const scene = new THREE.Scene();
  scene.add(quad);
  return rendered(scene, new THREE.Camera(), places.length, 1);
}

// A still tile of `size` seen from above, north up, a pixel a sample, in one of three's own materials: (rows, columns, 4), row 0 south.
function seen(material, { sampling, size, count }) {
  const [lx, ly] = size, [nx, ny] = count;
  const corners = [[-lx, ly], [2 * lx, ly], [2 * lx, -2 * ly], [-lx, -2 * ly]]; // X and Z (south)
  const geometry = new THREE.BufferGeometry();
  const uv = (X, Z) => ['u', 'v'].map((name) => formula(sampling[name], { X, Z, ...sampling.values }));
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners.flatMap(([x, z]) => [x, 0, z]), 3));
  geometry.setAttribute('normal', new THREE.Float32BufferAttribute(corners.flatMap(() => [0, 1, 0]), 3));
  geometry.setAttribute('uv', new THREE.Float32BufferAttribute(corners.flatMap(([x, z]) => uv(x, z)), 2));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  const scene = new THREE.Scene();
  scene.add(new THREE.Mesh(geometry, material));
  scene.add(new THREE.DirectionalLight(0xffffff, 3)); // from straight above
  // pixel (i, j) is centred on the sample at x = i lx / nx, y = j ly / ny
  const [dx, dy] = [lx / nx / 2, ly / ny / 2];
  const camera = new THREE.OrthographicCamera(-dx, lx - dx, ly - dy, -dy, 0.1, 100);
  camera.position.set(0, 20, 0);
  camera.up.set(0, 0, -1);
  camera.lookAt(0, 0, 0);
  return rendered(scene, camera, nx, ny);
}

globalThis.run = async ({ textures, samples = [], pictures = [] }) => {
  const loaded = {};
  for (const [name, texture] of Object.entries(textures)) loaded[name] = await LOADERS[texture.loader](texture);
  const out = { revision: THREE.REVISION, samples: [], pictures: [] };
  for (const s of samples) out.samples.push(base64(sample(loaded[s.texture], s)));
  for (const p of pictures) {
    let map = p.texture ? loaded[p.texture] : null;
    if (map?.isDataArrayTexture) {
      // a material takes a plain texture: one frame of the array
      const { data: all, width, height } = map.image;
      map = data(new THREE.DataTexture(all.slice(0, 4 * width * height), width, height, THREE.RGBAFormat, THREE.HalfFloatType));
    }
    const material = new THREE[p.material](p.settings ?? {});
    if (map) {
      material.normalMap = map;
      material.normalScale.set(1, p.normalScaleY);
    }
    out.pictures.push(base64(seen(material, p)));
  }
  // where east and north appear when the camera looks down with north up: the axes' handedness, by the engine itself
  const camera = new THREE.OrthographicCamera(-10, 10, 10, -10, 0.1, 100);
  camera.position.set(0, 20, 0);
  camera.up.set(0, 0, -1);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  const project = (x, y, z) => new THREE.Vector3(x, y, z).project(camera).toArray();
  out.screen = { X: project(1, 0, 0), Z: project(0, 0, 1) };
  out.error = renderer.getContext().getError();
  return out;
};
