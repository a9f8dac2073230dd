// Babylon.js: what its loaders and materials make of a bake.
import { base64, bytes, formula, json, lookup } from './common.js';

const B = globalThis.BABYLON;
B.ExrLoaderGlobalConfiguration.FFLATEUrl = '/npm/fflate/umd/index.js'; // its default is a public server
const engine = new B.Engine(document.getElementById('canvas'), false, { preserveDrawingBuffer: true });
const scene = new B.Scene(engine);
scene.clearColor = new B.Color4(0, 0, 0, 0);
scene.ambientColor = B.Color3.Black();
scene.imageProcessingConfiguration.isEnabled = false;

const BILINEAR = B.Texture.BILINEAR_SAMPLINGMODE;
const HALF = B.Constants.TEXTURETYPE_HALF_FLOAT;
const repeat = (texture) => Object.assign(texture, { wrapU: B.Texture.WRAP_ADDRESSMODE, wrapV: B.Texture.WRAP_ADDRESSMODE });

// One texture of a bake, as docs/engines.md says to load it.
const LOADERS = {
  'exr-atlas': (texture) => LOADERS.exr(texture),
  'exr-float': async (texture) => {
    const kept = B.ExrLoaderGlobalConfiguration.DefaultOutputType; // half: it would round single precision toward zero
    B.ExrLoaderGlobalConfiguration.DefaultOutputType = B.EXROutputType.Float;
    try {
      return await LOADERS.exr(texture);
    } finally {
      B.ExrLoaderGlobalConfiguration.DefaultOutputType = kept;
    }
  },
  exr: ({ url }) =>
    new Promise((done, failed) => {
      const texture = new B.Texture(url, scene, true, undefined, BILINEAR, () => done(repeat(texture)), (m, e) => failed(new Error(`${m} ${e}`)));
    }),
  bin: async ({ url, sidecar, layer }) => {
    const { columns, rows, frames } = await json(sidecar);
    const all = new Uint16Array(await bytes(url)), one = 4 * columns * rows;
    return layer === undefined
      ? repeat(new B.RawTexture2DArray(all, columns, rows, frames, B.Constants.TEXTUREFORMAT_RGBA, scene, false, false, BILINEAR, HALF))
      : repeat(new B.RawTexture(all.slice(layer * one, (layer + 1) * one), columns, rows, B.Constants.TEXTUREFORMAT_RGBA, scene, false, false, BILINEAR, HALF));
  },
};

const target = (width, height) =>
  new B.RenderTargetTexture('out', { width, height }, scene, false, true, B.Constants.TEXTURETYPE_FLOAT, false, B.Texture.NEAREST_SAMPLINGMODE);

// The map at places of the world, by the formulas: (places, 4).
async function sample(texture, { sampling, meaning, places }, name) {
  const array = texture instanceof B.RawTexture2DArray;
  const at = new B.RawTexture(
    Float32Array.from(places.flat()), places.length, 1, B.Constants.TEXTUREFORMAT_RGBA, scene, false, false,
    B.Texture.NEAREST_SAMPLINGMODE, B.Constants.TEXTURETYPE_FLOAT,
  );
  const wrapper = new B.EffectWrapper({
    engine,
    name,
    fragmentShader: `precision highp float; precision highp sampler2D; precision highp sampler2DArray;
      uniform sampler2D places; uniform ${array ? 'sampler2DArray' : 'sampler2D'} map;
      ${lookup({ sampling, meaning, array, output: 'gl_FragColor' })}`,
    uniformNames: [],
    samplerNames: ['places', 'map'],
  });
  await wrapper.effect.whenCompiledAsync();
  wrapper.onApplyObservable.add(() => {
    wrapper.effect.setTexture('places', at);
    wrapper.effect.setTexture('map', texture);
  });
  const out = target(places.length, 1);
  new B.EffectRenderer(engine).render(wrapper, out);
  return new Float32Array((await out.readPixels()).buffer);
}

function fromAbove([lx, ly], [nx, ny]) {
  const camera = new B.FreeCamera('above', new B.Vector3(0, 20, 0), scene);
  camera.upVector = new B.Vector3(0, 0, 1); // north
  camera.rotation = new B.Vector3(Math.PI / 2, 0, 0); // straight down
  camera.mode = B.Camera.ORTHOGRAPHIC_CAMERA;
  camera.minZ = 0.1;
  camera.maxZ = 100;
  const [dx, dy] = [lx / nx / 2, ly / ny / 2]; // pixel (i, j) is centred on the sample at x = i lx / nx, y = j ly / ny
  Object.assign(camera, { orthoLeft: -dx, orthoRight: lx - dx, orthoBottom: -dy, orthoTop: ly - dy });
  return camera;
}

// A still tile of `size` seen from above, north up, a pixel a sample, in StandardMaterial: (rows, columns, 4), row 0 south.
async function seen(texture, { sampling, size, count, light, settings }) {
  const [lx, ly] = size, [nx, ny] = count;
  const corners = [[-lx, -ly], [2 * lx, -ly], [2 * lx, 2 * ly], [-lx, 2 * ly]]; // X and Z (north)
  const uv = (X, Z) => ['u', 'v'].map((name) => formula(sampling[name], { X, Z, ...sampling.values }));
  const mesh = new B.Mesh('tile', scene), vertices = new B.VertexData();
  vertices.positions = corners.flatMap(([x, z]) => [x, 0, z]);
  vertices.normals = corners.flatMap(() => [0, 1, 0]);
  vertices.uvs = corners.flatMap(([x, z]) => uv(x, z));
  vertices.indices = [0, 1, 2, 0, 2, 3];
  vertices.applyToMesh(mesh);
  mesh.alwaysSelectAsActiveMesh = true;
  const material = new B.StandardMaterial('water', scene);
  material.specularColor = B.Color3.Black();
  material.backFaceCulling = false;
  if (texture) material.bumpTexture = texture;
  Object.assign(material, settings);
  mesh.material = material;
  const sun = new B.DirectionalLight('sun', new B.Vector3(...light).scale(-1), scene); // `light`: toward the sun
  sun.specular = B.Color3.Black();
  const camera = fromAbove(size, count), out = target(nx, ny);
  out.renderList = [mesh];
  out.activeCamera = camera;
  scene.activeCamera = camera;
  await material.forceCompilationAsync(mesh);
  out.render();
  const pixels = new Float32Array((await out.readPixels()).buffer);
  for (const used of [out, camera, sun, material, mesh]) used.dispose();
  return pixels;
}

globalThis.run = async ({ textures, samples = [], pictures = [] }) => {
  const loaded = {};
  for (const [name, texture] of Object.entries(textures)) loaded[name] = await LOADERS[texture.loader](texture);
  const out = { version: B.Engine.Version, samples: [], pictures: [] };
  for (const [i, s] of samples.entries()) out.samples.push(base64(await sample(loaded[s.texture], s, `sample${i}`)));
  for (const p of pictures) out.pictures.push(base64(await seen(p.texture ? loaded[p.texture] : null, p)));
  // where east and north appear when the camera looks down with north up: the axes' handedness, by the engine itself
  const camera = fromAbove([10, 10], [10, 10]);
  const project = (x, y, z) => B.Vector3.TransformCoordinates(new B.Vector3(x, y, z), camera.getTransformationMatrix()).asArray();
  const [zero, one, two] = [project(0, 0, 0), project(1, 0, 0), project(0, 0, 1)];
  out.screen = { X: one.map((v, i) => v - zero[i]), Z: two.map((v, i) => v - zero[i]) };
  out.error = engine._gl.getError();
  return out;
};
