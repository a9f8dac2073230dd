// Plays a bake, reads the texels of its textures back, and draws it with the renderer.
import { Camera } from '/live/camera.js';
import { target } from '/live/gl.js';
import { Playback } from '/live/playback.js';
import { Renderer } from '/live/renderer.js';
import { base64, bytes, json } from './common.js';

const canvas = document.getElementById('canvas');

/** Return the texels of each map of each tile, at one of its levels. */
function texels(gl, playback, level) {
  return playback.tiles.map(({ maps }) =>
    Object.values(maps).map((map) => {
      const [width, height] = [map.width, map.height].map((n) => Math.max(1, n >> level));
      const framebuffer = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
      gl.framebufferTexture2D(
        gl.FRAMEBUFFER,
        gl.COLOR_ATTACHMENT0,
        gl.TEXTURE_2D,
        map.handle,
        level,
      );
      const found = new Float32Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, found);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      gl.deleteFramebuffer(framebuffer);
      return { width, height, texels: base64(found) };
    }),
  );
}

/** Wait until what was asked for has come. */
async function settled(playback) {
  while (playback.requests.size) await new Promise((resolve) => setTimeout(resolve, 5));
}

/**
 * Play the frames of a folder of messages, tile_frame, and return what the textures hold at ticks.
 */
globalThis.run = async ({ folder, ticks, blend, level, picture }) => {
  const gl = canvas.getContext('webgl2', { antialias: false, preserveDrawingBuffer: true });
  const manifest = await json(`${folder}/manifest.json`);
  const asked = [];
  let changes = 0;
  const playback = new Playback(
    gl,
    manifest,
    (tile, frame) => {
      asked.push([tile, frame]);
      return bytes(`${folder}/${tile}_${frame}.bin`);
    },
    { blend, onChange: () => (changes += 1) },
  );
  await settled(playback);
  const renderer = picture ? new Renderer(gl, { quality: 'low' }) : null;
  const seen = [];
  for (const tick of ticks) {
    playback.step(tick);
    await settled(playback);
    playback.step(tick);
    const one = { frame: playback.shownFrame, tiles: texels(gl, playback, level ?? 0) };
    if (renderer) {
      const camera = new Camera({ height: 4, yaw: 60, pitch: -12 });
      const { width, height } = canvas;
      renderer.render(playback, camera, {}, width, height);
      const pixels = new Uint8Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      one.picture = base64(pixels);
    }
    seen.push(one);
  }
  renderer?.dispose();
  playback.dispose();
  return { seen, asked, changes, error: gl.getError() };
};
