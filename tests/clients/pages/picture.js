// The live page's pictures: seas drawn by the renderer, as colours of the screen or as radiance.
import { Camera } from '/live/camera.js';
import { decodeSea } from '/live/container.js';
import { drawFullscreen, program, target, texture } from '/live/gl.js';
import { FRAGMENT_HEAD } from '/live/shaders/heads.js';
import { FoamField } from '/live/foam.js';
import { halfFloats } from '/live/half.js';
import { Renderer } from '/live/renderer.js';
import { FOAM_LOOKUP } from '/live/shaders/breaking.js';
import { VISIBLE_SLOPES } from '/live/shaders/surface.js';
import { createSimulation } from '/live/simulation.js';
import { visibleTable } from '/live/visible_slopes.js';
import { base64, bytes } from './common.js';

const canvas = document.getElementById('canvas');
const gl = canvas.getContext('webgl2', {
  antialias: true,
  preserveDrawingBuffer: true,
});
gl.getExtension('EXT_color_buffer_float');

let stage = null;

/** Return the simulation of a sea and a renderer, kept between the pictures of one sea. */
async function prepare({ name, quality, document: changed = {} }) {
  const key = JSON.stringify([name, quality, changed]);
  if (stage?.key === key) return stage;
  stage?.renderer.dispose();
  stage?.simulation.dispose();
  const sea = decodeSea(await bytes(name));
  Object.assign(sea.document, changed);
  const simulation = await createSimulation(gl, sea);
  stage = { key, simulation, renderer: new Renderer(gl, { quality }) };
  return stage;
}

/** Run the foam up to a tick. */
async function foamUntil({ simulation, renderer }, camera, tick, { steps, seconds }) {
  const { ticks, loop } = simulation.document;
  renderer.restartFoam();
  for (let i = steps; i >= 0; i--) {
    const back = Math.round(((i * seconds) / loop) * ticks);
    await simulation.step((((tick - back) % ticks) + ticks) % ticks);
    renderer.advanceFoam(simulation, camera, seconds);
  }
}

/**
 * Return the radiance of a picture, (height, width, 4), row 0 at the bottom, with the edges of waves
 * smoothed as on the page's own canvas.
 */
function radiance(renderer, simulation, camera, look, width, height) {
  const handle = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, handle);
  const planes = [
    [gl.COLOR_ATTACHMENT0, gl.RGBA16F],
    [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24],
  ].map(([point, format]) => {
    const plane = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, plane);
    gl.renderbufferStorageMultisample(gl.RENDERBUFFER, 4, format, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, point, gl.RENDERBUFFER, plane);
    return plane;
  });
  renderer.render(simulation, camera, look, width, height, { target: { handle }, linear: true });
  const into = target(gl, [texture(gl, { width, height, format: 'RGBA16F', wrap: 'clamp' })]);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, handle);
  gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, into.handle);
  gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
  const texels = into.read(0);
  into.dispose();
  gl.deleteFramebuffer(handle);
  for (const plane of planes) gl.deleteRenderbuffer(plane);
  return texels;
}

/** Return the colours of the canvas, (height, width, 4) in 0..255, row 0 at the bottom. */
function colours(width, height) {
  const texels = new Uint8Array(4 * width * height);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, texels);
  return texels;
}

/** Draw one picture and return what is asked for of it. */
async function draw(picture) {
  const { width, height, tick = 100000, look = {}, foam = { steps: 0, seconds: 0 } } = picture;
  const made = await prepare(picture);
  const { simulation, renderer } = made;
  const camera = new Camera(picture.camera);
  await renderer.load(look);
  await simulation.step(tick, picture.choppiness);
  if (foam.steps) await foamUntil(made, camera, tick, foam);
  const answer = {};
  for (let i = 1; i < (picture.repeats ?? 1); i++) {
    renderer.render(simulation, camera, look, width, height);
    colours(1, 1);
  }
  const began = performance.now();
  if (picture.answer === 'radiance') {
    answer.radiance = base64(radiance(renderer, simulation, camera, look, width, height));
  } else {
    canvas.width = width;
    canvas.height = height;
    renderer.render(simulation, camera, look, width, height);
    answer.colours = base64(colours(width, height));
    if (picture.answer === 'image') answer.image = canvas.toDataURL('image/png').split(',')[1];
  }
  answer.milliseconds = performance.now() - began;
  if (picture.answer === 'image') delete answer.colours;
  answer.error = gl.getError();
  return answer;
}

/** Return the mean coverage of the foam's windows after many steps, averaged over the last ones. */
async function coverage(picture) {
  const made = await prepare(picture);
  const { simulation, renderer } = made;
  const { ticks, loop } = simulation.document;
  const { steps, seconds, averaged } = picture.foam;
  const eye = { east: 0, north: 0 };
  const sums = renderer.foam.windows.map(() => 0);
  renderer.restartFoam();
  for (let i = 0; i < steps; i++) {
    await simulation.step(Math.round(((i * seconds) / loop) * ticks) % ticks);
    renderer.advanceFoam(simulation, eye, seconds);
    if (i < steps - averaged) continue;
    renderer.foam.windows.forEach(({ targets }, k) => {
      const texels = targets[0].read(0);
      let sum = 0;
      for (let at = 1; at < texels.length; at += 4) sum += texels[at];
      sums[k] += sum / (texels.length / 4);
    });
  }
  return { coverage: sums.map((sum) => sum / averaged), error: gl.getError() };
}

/** Return the texels of the light and the map of the sky. */
async function lightOf(picture) {
  const { renderer } = await prepare(picture);
  await draw({ ...picture, answer: 'colours' });
  const { sky } = renderer;
  return {
    light: [...sky.lightTarget.read(0)],
    sky: base64(sky.mapTarget.read(0)),
    error: 0,
  };
}

/** Return what a fragment shader writes for some numbers, so many times four values each. */
function evaluated(source, numbers, times, values) {
  const size = { width: numbers.length, height: 1, format: 'RGBA32F' };
  const data = Float32Array.from(numbers.flatMap((x) => [x, 0, 0, 0]));
  const given = texture(gl, { ...size, data });
  const into = target(gl, [texture(gl, { ...size, width: times * numbers.length })]);
  const made = program(gl, source);
  drawFullscreen(gl, made, { ...values, given }, into);
  const answer = base64(into.read(0));
  for (const one of [given, into, made]) one.dispose();
  return answer;
}

/** Return the mean of the projected area above zero, and the four facets with their weights. */
async function visible({ numbers }) {
  const { data, width, height } = visibleTable();
  const size = { format: 'RGBA16F', width, height, wrap: 'clamp', filter: 'linear' };
  const visible_rules = texture(gl, { ...size, data: halfFloats(data) });
  const source = `${FRAGMENT_HEAD}${VISIBLE_SLOPES}
uniform sampler2D given;
out vec4 answer;
void main() {
  float mean = texelFetch(given, ivec2(gl_FragCoord.x / 3.0, 0), 0).x;
  int which = int(gl_FragCoord.x) % 3;
  vec4 areas, weights;
  visible_facets(mean, 1.0, areas, weights);
  answer = which == 0 ? vec4(mean_above_zero(mean, 1.0)) : which == 1 ? areas : weights;
}`;
  const statistics = evaluated(source, numbers, 3, { visible_rules });
  visible_rules.dispose();
  return { statistics, error: gl.getError() };
}

/** Return the mean of the broken-up foam over a square of water whose coverage is the same. */
async function brokenUp({ covers, metres, pixels }) {
  const foam = new FoamField(gl, [16, 16], 256, 8);
  const source = `${FRAGMENT_HEAD}${FOAM_LOOKUP}
uniform float metres, pixels;
out vec4 answer;
void main() {
  answer = vec4(foam_at((gl_FragCoord.xy / pixels - 0.5) * metres), 1.0);
}`;
  const made = program(gl, source);
  const size = { width: pixels, height: pixels, format: 'RGBA32F' };
  const into = target(gl, [texture(gl, size)]);
  const means = covers.map((cover) => {
    for (const { targets } of foam.windows) {
      targets[0].bind();
      gl.clearColor(0, cover, 0, 1);
      gl.clear(gl.COLOR_BUFFER_BIT);
      targets[0].textures[0].generateMips();
    }
    drawFullscreen(gl, made, { ...foam.uniforms([0, 0], null), metres, pixels }, into);
    const texels = into.read(0);
    let sum = 0;
    for (let i = 1; i < texels.length; i += 4) sum += texels[i];
    return sum / (pixels * pixels);
  });
  for (const one of [foam, made, into]) one.dispose();
  return { means, error: gl.getError() };
}

globalThis.run = async ({ pictures }) => {
  const answers = [];
  for (const picture of pictures) {
    const task = { brokenUp, coverage, light: lightOf, visible }[picture.answer] ?? draw;
    answers.push(await task(picture));
  }
  return answers;
};
