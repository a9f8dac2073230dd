// A sea in three.js: the live one of sea.json, or the bake of manifest.json or cascade.json, whichever
// index.html names.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { Buoy } from './buoy.js';
import { WaveSum, readPackage } from './package.js';
import { Playback } from './playback.js';
import { Simulation } from './simulation.js';
import { Sky } from './sky.js';
import { Water } from './water.js';

const base = new URL('./', location.href);
const element = (id) => document.getElementById(id);
const told = (text) => (element('message').textContent = `Loading ${text} ...`);

/** Return the document that the page names. */
async function found() {
  const name = element('canvas').dataset.sea;
  const answer = await fetch(new URL(name, base)).catch(() => null);
  if (answer?.ok) return { name, document: await answer.json() };
  throw new Error(
    `${name} is not in this folder, or the page was not opened by a server. Make one:\n\n` +
      '    fftocean export-sea sea.toml -o DIR --engine three\n' +
      '    fftocean bake sea.toml -o DIR --engine three --format bin\n\n' +
      'and serve it: python -m http.server --directory DIR',
  );
}

/** Return a live sea: waves that are evolved and transformed here. */
async function live(renderer, document) {
  told('the waves');
  const sea = await readPackage(base, document);
  const simulation = new Simulation(renderer, sea), waves = new WaveSum(sea);
  const [xx, yy, xy] = document.slope_variance?.beyond ?? [0, 0, 0];
  let tick = 0;
  return {
    simulation, waves, package: sea,
    tiles: simulation.tiles,
    loop: document.loop,
    about: `live: ${sea.tiles.map(({ n, size }) => `${n[0]} x ${n[1]} over ${size[0]} m`).join(', ')}`,
    foam: document.foam,
    foam_source: document.foam ? 2 : 0,
    beyond: [xx, yy, -xy], // Z is south
    wave_height: document.statistics?.realised?.hs ?? 1,
    bearing: document.wind?.direction ?? 0,
    update(time) {
      const { ticks, loop } = document;
      tick = Math.floor((time / loop - Math.floor(time / loop)) * ticks);
      simulation.update(tick);
    },
    heightAt: (X, Z) => waves.at(X, -Z, tick).height,
  };
}

/** Return a sea that plays from a bake. */
async function baked(renderer, document) {
  const playback = await Playback.load(renderer, base, document, told);
  const { manifest } = playback.tiles[0], job = manifest.job;
  const foam = {
    decay: job['bake.foam.tau'], threshold: job['bake.foam.threshold'], strength: job['bake.foam.strength'],
  };
  const one = playback.tiles.length === 1 && playback.tiles[0].hasFoam;
  const speed = job['sea.wind.speed'] ?? 7;
  return {
    playback,
    tiles: playback.tiles,
    loop: playback.loop,
    about: `bake: ${playback.frames} frames, ${playback.tiles.map(({ n, size }) => `${n[0]} x ${n[1]} over ${size[0]} m`).join(', ')}`,
    foam,
    foam_source: one ? 1 : playback.tiles.every((tile) => tile.hasStretch) ? 2 : 0,
    beyond: [0.0004 * speed, 0.0004 * speed, 0], // a share of Cox & Munk's: ripples that no map has
    wave_height: document.statistics.hs,
    bearing: job['sea.wind.direction'] ?? 0,
    update: (time) => playback.update(time),
    heightAt: (X, Z) => playback.heightAt(X, Z),
  };
}

const renderer = new THREE.WebGLRenderer({ canvas: element('canvas'), antialias: true });
renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // the shaders write the screen's numbers
const { name, document: read } = await found();
const sea = await (name === 'sea.json' ? live : baked)(renderer, read);
const sky = new Sky(renderer), water = new Water(renderer, sea.tiles, sky, sea), buoy = new Buoy(sky);
const scene = new THREE.Scene();
scene.add(sky.mesh, water.mesh, buoy.mesh);
const camera = new THREE.PerspectiveCamera(50, 1, 0.1, 40e3);
const controls = new OrbitControls(camera, element('canvas'));
Object.assign(controls, { minDistance: 3, maxDistance: 400, maxPolarAngle: 1.53, enableDamping: true });
let bearing = sea.bearing + 180; // the wind comes from before the camera

/** Put the camera where the buoy is seen, whatever the window's shape. */
function place(distance = innerWidth < innerHeight ? 13 : 11, height = 3.2 + 0.4 * sea.wave_height) {
  const angle = ((bearing + 50) * Math.PI) / 180;
  controls.target.set(0, 1.2, 0);
  camera.position.set(-distance * Math.cos(angle), height, distance * Math.sin(angle));
  controls.update();
}

const state = { time: 0, playing: true, last: null };

/** Draw the sea at its time; foam has had `seconds` to form and fade. */
function draw(seconds) {
  sea.update(state.time);
  water.update(seconds);
  buoy.update(sea.heightAt);
  // a crest must not swallow the camera
  const lift = sea.heightAt(camera.position.x, camera.position.z) + 0.6 - camera.position.y;
  if (lift > 0) camera.position.y += lift;
  camera.updateMatrixWorld();
  renderer.setRenderTarget(null);
  renderer.render(scene, camera);
}

function resize() {
  renderer.setPixelRatio(Math.min(devicePixelRatio, 1.5));
  renderer.setSize(innerWidth, innerHeight, false);
  camera.aspect = innerWidth / innerHeight;
  camera.updateProjectionMatrix();
}

function step(now) {
  const seconds = Math.min((now - (state.last ?? now)) / 1000, 0.1);
  state.last = now;
  if (!state.playing) return;
  state.time += seconds;
  controls.update();
  draw(seconds);
}

function light() {
  sky.set(Number(element('sun').value), bearing);
}

element('play').onclick = () => {
  state.playing = !state.playing;
  state.last = null;
  element('play').textContent = state.playing ? 'Pause' : 'Play';
};
element('sun').oninput = light;
controls.addEventListener('change', () => state.playing || draw(0));
addEventListener('resize', resize);
element('about').textContent = sea.about;
resize();
place();
light();
element('message').hidden = true;
element('panel').hidden = false;
if (new URLSearchParams(location.search).has('still')) state.playing = false;
else renderer.setAnimationLoop(step);

/** For tests and the console: parts of the page, and one picture at a time [s]. */
globalThis.page = {
  THREE, renderer, sea, sky, water, buoy, camera, controls, state, place, resize,
  still(time, { sun = 22, distance, height, bearing: other } = {}) {
    element('sun').value = sun;
    bearing = other ?? bearing;
    light();
    place(distance, height);
    for (const before of [1.2, 0.9, 0.6, 0.3, 0]) {
      state.time = time - before;
      sea.update(state.time);
      if (before) water.update(0.3);
    }
    draw(0.3);
    return renderer.getContext().getError();
  },
};
