// Colour maps of even steps, and the tone curve.
import test from 'node:test';
import assert from 'node:assert/strict';
import { PLAIN, VIEWS, legend, mapColours, mapInLab, viewNumber } from '../src/views.js';
import { toneCurve } from '../src/exposure.js';

/** Return the CIE lightness of a colour of sRGB in 0..255: another measure than that of the maps. */
function lightness(colour) {
  const [r, g, b] = colour.map((value) => {
    const x = value / 255;
    return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
  });
  return 116 * Math.cbrt(0.2126 * r + 0.7152 * g + 0.0722 * b) - 16;
}

test('steps evenly along each colour map', () => {
  for (const name of ['sequential', 'twoSided']) {
    const map = mapInLab(name);
    const steps = map.slice(1).map((lab, i) => Math.hypot(...lab.map((v, k) => v - map[i][k])));
    steps.splice(name === 'twoSided' ? 127 : steps.length, 1); // the two halves touch in white
    const mean = steps.reduce((a, b) => a + b) / steps.length;
    for (const step of steps) assert.ok(Math.abs(step / mean - 1) < 0.15, `${step} of ${mean}`);
  }
});

test('grows lighter all the way, or to the middle and darker again', () => {
  const rising = mapColours('sequential').map(lightness);
  for (let i = 8; i < 256; i += 8) assert.ok(rising[i] > rising[i - 8]);
  const both = mapColours('twoSided').map(lightness);
  for (let i = 8; i < 128; i += 8) {
    assert.ok(both[i] > both[i - 8]);
    assert.ok(both[255 - i] > both[255 - i + 8]);
  }
  assert.ok(Math.abs(both[0] - both[255]) < 4);
});

test('keeps the colour behind the water out of the maps', () => {
  const plain = PLAIN.map((value) => Math.round(255 * value));
  for (const name of ['sequential', 'twoSided']) {
    for (const colour of mapColours(name)) {
      assert.ok(Math.hypot(...colour.map((value, i) => value - plain[i])) > 12);
    }
  }
});

test('has a legend for each view of numbers, and a name for each view', () => {
  const document = {
    statistics: { realised: { hs: 2.5 } },
    slope_variance: { total: [0.03, 0.02, 0] },
  };
  assert.deepEqual(
    VIEWS.map((view) => view.name),
    ['sea', 'height', 'slopes', 'normals', 'jacobian', 'foam', 'roughness', 'tiles', 'wireframe'],
  );
  assert.deepEqual([legend('height', document).low, legend('height', document).high], [-2.5, 2.5]);
  assert.equal(legend('sea', document), null);
  assert.equal(legend('foam', document).colours.length, 256);
  assert.throws(() => viewNumber('heigth'), /view must be one of sea, height/);
});

test('maps radiance to the screen rising, from black to white, without a burnt colour', () => {
  let last = -1;
  for (let light = 0; light < 40; light += 0.05) {
    const [grey] = toneCurve([light, light, light]);
    assert.ok(grey > last || grey === 1);
    last = grey;
  }
  assert.deepEqual(toneCurve([0, 0, 0]), [0, 0, 0]);
  assert.ok(toneCurve([30, 30, 30])[0] > 0.98);
  const [red, , blue] = toneCurve([20, 5, 0.5]); // a bright warm light turns pale
  assert.ok(blue > 0.1 * red);
});
