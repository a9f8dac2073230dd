// The page: it reads the package beside it, checks itself, and shows the sea.
import { LIMIT, selfCheck } from './check.js';
import { Sea } from './sea.js';
import { Water } from './water.js';

const canvas = document.getElementById('canvas'), notes = document.getElementById('notes');
const options = new URLSearchParams(location.search); // ?sun=elevation,azimuth&height=&yaw=&pitch=&foam=; &tick= for a still

function say(text, wrong = false) {
  notes.textContent = text;
  notes.className = wrong ? 'wrong' : '';
}

/** Return the sentences about a sea, and about what the self-check found. */
function report({ document, tiles }, { worst, field, tile }) {
  const { hs, tp } = document.statistics.realised, passed = worst <= LIMIT;
  const sea = `Significant wave height ${hs.toPrecision(3)} m, peak period ${tp.toPrecision(3)} s; ${tiles.length} tiles; loop ${document.loop} s`;
  const numbers = `relative error ${worst.toExponential(1)} at most (${field} of tile ${tile}), limit ${LIMIT.toExponential(0)}`;
  const found = passed ? `Self-check passed: eight fields beside Python's, ${numbers}` : `SELF-CHECK FAILED: eight fields beside Python's, ${numbers}`;
  return [`${sea}\n${found}\nDrag to look around; wheel for the height; arrow keys to move; H hides this.`, !passed];
}

/** Return the camera, which pointer, wheel and keys move. */
function cameraOf({ document }) {
  const number = (name, otherwise) => (options.has(name) ? Number(options.get(name)) : otherwise);
  const lowest = document.bounds.height + 0.5; // no crest reaches the eye
  const [elevation, azimuth] = (options.get('sun') ?? '24').split(',').map((x) => (Number(x) * Math.PI) / 180);
  const yaw = (number('yaw', document.statistics.realised.direction + 180 - 28) * Math.PI) / 180;
  const camera = {
    yaw,
    pitch: (number('pitch', -7) * Math.PI) / 180,
    height: Math.max(number('height', 1.6 * document.statistics.realised.hs + 2), lowest),
    fov: 0.85,
    eye: [0, 0],
    sun: [elevation, azimuth ?? yaw - 0.6],
    exposure: number('exposure', 0.7),
  };
  canvas.addEventListener('pointerdown', (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener('pointermove', (event) => {
    if (!event.buttons) return;
    camera.yaw += (event.movementX / canvas.clientHeight) * camera.fov;
    camera.pitch = Math.min(Math.max(camera.pitch + (event.movementY / canvas.clientHeight) * camera.fov, -0.6), 0.4);
  });
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    camera.height = Math.min(Math.max(camera.height * Math.exp(event.deltaY / 600), lowest), 300);
  }, { passive: false });
  addEventListener('keydown', ({ key }) => {
    const [ahead, aside] = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowRight: [0, 1], ArrowLeft: [0, -1] }[key] ?? [0, 0];
    const [c, s] = [Math.cos(camera.yaw), Math.sin(camera.yaw)], step = 0.2 * camera.height;
    camera.eye[0] += step * (ahead * c + aside * s);
    camera.eye[1] += step * (ahead * s - aside * c);
    if (key.toLowerCase() === 'h') notes.classList.toggle('quiet');
  });
  return camera;
}

/** Add kernels of a sea to an encoder, in the order of their names. */
function addKernels(sea, encoder, ...names) {
  const pass = encoder.beginComputePass();
  for (const name of names) sea[name](pass);
  pass.end();
}

/** Show the moments of the loop one after the other, as time goes. */
function play(sea, water, camera) {
  const { loop, ticks } = sea.document;
  let before = performance.now();
  requestAnimationFrame(function next(now) {
    const ratio = Math.min(devicePixelRatio, 2), wanted = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.max(1, Math.round(side * ratio)));
    if (canvas.width !== wanted[0] || canvas.height !== wanted[1]) [canvas.width, canvas.height] = wanted;
    const tick = Math.floor((((now / 1000) % loop) / loop) * ticks);
    sea.set({ tick, eye: camera.eye, seconds: Math.min(Math.max((now - before) / 1000, 0), 0.1) });
    before = now;
    const encoder = sea.device.createCommandEncoder();
    addKernels(sea, encoder, 'frame', 'stepFoam', 'average', 'copyToTextures');
    water.draw(encoder, camera);
    sea.device.queue.submit([encoder.finish()]);
    requestAnimationFrame(next);
  });
}

/** Show one moment, with the foam of some seconds before it. */
async function showStill(sea, water, camera, tick) {
  const { loop, ticks } = sea.document, step = 0.2, steps = 20;
  for (let i = -steps; i <= 0; i++) {
    const earlier = Math.round((i * step * ticks) / loop);
    sea.set({ tick: (((tick + earlier) % ticks) + ticks) % ticks, eye: camera.eye, seconds: step });
    const encoder = sea.device.createCommandEncoder();
    addKernels(sea, encoder, 'frame', 'stepFoam');
    sea.device.queue.submit([encoder.finish()]);
    await sea.device.queue.onSubmittedWorkDone();
  }
  [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight];
  const picture = await water.still(canvas.width, canvas.height, camera, (encoder) => addKernels(sea, encoder, 'average', 'copyToTextures'));
  canvas.getContext('2d').putImageData(picture, 0, 0);
}

async function start() {
  say('Reading the sea ...');
  const side = Number(options.get('foam') ?? 512); // cells of foam, a power of two, over 256 m
  const sea = await Sea.load('.', { foam: { side, cell: 256 / side } });
  sea.device.lost.then(({ message }) => say(`The graphics processor was lost: ${message}`, true));
  sea.device.addEventListener('uncapturederror', ({ error }) => say(error.message, true));
  const found = await selfCheck(sea);
  say(...report(sea, found));
  const drawing = await (await fetch('draw.wgsl')).text(), camera = cameraOf(sea);
  if (options.has('tick')) await showStill(sea, new Water(sea, drawing), camera, Number(options.get('tick')));
  else play(sea, new Water(sea, drawing, canvas), camera);
  return { sea, found };
}

globalThis.ready = start().catch((error) => {
  say(error.message, true);
  return { error: error.message };
});
