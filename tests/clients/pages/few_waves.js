// Reads the vertices of few-wave models back from the GPU, and pixels of some pictures.
import { Camera } from '/live/camera.js';
import { FewWaves } from '/live/few_waves.js';
import { base64 } from './common.js';

const canvas = document.getElementById('canvas');

/** Return the vertices of each view, and the picture of a part, drawn over a red background. */
globalThis.run = ({ models, views, columns, rings }) => {
  const gl = canvas.getContext('webgl2', { antialias: false, preserveDrawingBuffer: true });
  const few = new FewWaves(gl, { columns, rings });
  const { width, height } = canvas;
  const seen = views.map(({ model, tick, place, look, fade, part }) => {
    const camera = new Camera(place);
    const vertices = few.readVertices(models[model], tick, camera, look, width / height, { fade });
    if (!part) return mapped(vertices);
    gl.clearColor(1, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    few.render(models[model], tick, camera, look, width, height, part);
    const picture = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    return { ...mapped(vertices), picture: base64(picture), size: [width, height] };
  });
  few.dispose();
  return { seen, error: gl.getError() };
};

/** Return arrays as base64. */
function mapped(arrays) {
  return Object.fromEntries(Object.entries(arrays).map(([name, one]) => [name, base64(one)]));
}
