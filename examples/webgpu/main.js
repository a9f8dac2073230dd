// The page: it reads the package beside it, checks itself, and shows the sea.
import { LIMIT, selfCheck } from './check.js';
import { Sea } from './sea.js';
import { Water } from './water.js';

const canvas = document.getElementById('canvas'), notes = document.getElementById('notes');
const options = new URLSearchParams(location.search); // ?sun=elevation,azimuth&height=&yaw=&pitch=&tick=: for a still

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
  const toward = document.statistics.realised.direction;
  const camera = {
    yaw: (number('yaw', toward + 180 - 28) * Math.PI) / 180,
    pitch: (number('pitch', -7) * Math.PI) / 180,
    height: Math.max(number('height', 1.6 * document.statistics.realised.hs + 2), lowest),
    fov: 0.85,
    eye: [0, 0],
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

/** Return a function that computes and draws one moment of the loop. */
function painter(sea, water, camera) {
  const [elevation, azimuth] = (options.get('sun') ?? '20').split(',').map((x) => (Number(x) * Math.PI) / 180);
  const sun = [elevation, azimuth ?? camera.yaw - 0.2];
  return (tick, seconds) => {
    const ratio = Math.min(devicePixelRatio, 2);
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    canvas.height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    const encoder = sea.device.createCommandEncoder(), pass = encoder.beginComputePass();
    sea.set({ tick, eye: camera.eye, seconds });
    sea.frame(pass);
    sea.stepFoam(pass);
    sea.average(pass);
    sea.copyToTextures(pass);
    pass.end();
    water.draw(encoder, camera, sun, Number(options.get('exposure') ?? 0.55));
    sea.device.queue.submit([encoder.finish()]);
  };
}

async function start() {
  say('Reading the sea ...');
  const sea = await Sea.load('.');
  sea.device.lost.then(({ message }) => say(`The graphics processor was lost: ${message}`, true));
  sea.device.addEventListener('uncapturederror', ({ error }) => say(error.message, true));
  const found = await selfCheck(sea);
  say(...report(sea, found));
  const water = new Water(sea, canvas, await (await fetch('draw.wgsl')).text());
  const camera = cameraOf(sea), paint = painter(sea, water, camera);
  const { loop, ticks } = sea.document;
  const tickAt = (seconds) => Math.floor(((seconds % loop) / loop) * ticks);
  if (options.has('tick')) {
    // A still, with the foam of the 8 s before it.
    const tick = Number(options.get('tick')), step = 0.1;
    for (let i = -80; i <= 0; i++) {
      paint((((tick + Math.round((i * step * ticks) / loop)) % ticks) + ticks) % ticks, step);
      await sea.device.queue.onSubmittedWorkDone();
    }
  } else {
    let before = performance.now();
    requestAnimationFrame(function next(now) {
      paint(tickAt(now / 1000), Math.min(Math.max((now - before) / 1000, 0), 0.1));
      before = now;
      requestAnimationFrame(next);
    });
  }
  return { sea, found };
}

globalThis.ready = start().catch((error) => {
  say(error.message, true);
  return { error: error.message };
});
