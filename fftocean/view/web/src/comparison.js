// Few waves beside the sea: drawn over the right half of the picture, and timed.

import { wavesText } from './amounts.js';
import { choiceLabel } from './controls.js';
import { FewWaves } from './few_waves.js';
import { GpuTimer } from './gpu_timer.js';
import { wavesOf } from './statistics.js';

/** Draw few waves under the same sky over the right half of a stage's picture. */
export function renderFew(stage, model, tick, camera, look, width, height) {
  stage.timer ??= new GpuTimer(stage.gl);
  stage.few ??= new FewWaves(stage.gl, stage.renderer.quality);
  const half = Math.floor(width / 2);
  const viewport = [half, 0, width - half, height];
  const { sky } = stage.renderer;
  stage.timer.waits = true;
  stage.timer.measure('few', () => {
    stage.few.render(model, tick, camera, look, width, height, viewport, sky);
  });
}

/** Return the names of the two halves, with the time that each takes. */
export function namesOfHalves({ stage, sea, values }, model) {
  const lit = values.view === 'sea' ? '' : ', lit'; // false colours are of the FFT alone
  const time = (name, what) => {
    const found = stage.timer?.milliseconds(name) ?? null;
    return found === null ? '' : `, ${what} ${Number(found.toPrecision(2))} ms`;
  };
  return [
    `FFT: ${wavesText(wavesOf(sea.document))}` +
      `${time('waves', 'transforms')}${time('sea', 'picture')}`,
    `${choiceLabel(model.model)}${lit}: ${wavesText(model.kx.length)}` +
      time('few', 'half a picture'),
  ];
}
