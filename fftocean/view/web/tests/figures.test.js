// Figures and spectrum of the page, from seas whose values are known.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { grouped, wavesText } from '../src/amounts.js';
import { FrameRate } from '../src/chip.js';
import { statisticsRows, tilesText } from '../src/heads_up.js';
import {
  densityOfEnergy,
  edgesOfLoop,
  energyOfPolar,
  energyOfWaves,
  geometricEdges,
} from '../src/spectrum_plot.js';
import { wavesOf } from '../src/statistics.js';

/** Return a sea of one tile with waves [mx, my, cycles, amplitude]. */
function seaOf(waves, { n = 16, size = 100, loop = 64 } = {}) {
  const h0 = new Float32Array(4 * n * n);
  const wave = new Float32Array(2 * n * n);
  for (const [mx, my, cycles, amplitude] of waves) {
    const at = ((my + n) % n) * n + ((mx + n) % n);
    h0[4 * at] = amplitude / 2;
    wave[2 * at] = cycles;
  }
  return { document: { loop }, tiles: [{ nx: n, ny: n, lx: size, ly: size, h0, wave }] };
}

test('the energy of a wave is half the square of its amplitude, in its bin and sector', () => {
  const edges = geometricEdges(0.05, 1, 10);
  const energy = energyOfWaves(seaOf([[0, 3, 8, 2]]), edges, 4);
  const bin = edges.findLastIndex((edge) => edge <= 8 / 64);
  energy.forEach((value, i) => {
    assert.equal(value, i === 4 * bin + 1 ? 2 : 0); // north is the second of four sectors
  });
});

test('the density has the variance of the sea as its integral', () => {
  const waves = [
    [1, 0, 5, 1],
    [2, 1, 9, 0.5],
    [-3, 2, 40, 0.25],
  ];
  const edges = edgesOfLoop(64);
  const { density } = densityOfEnergy(energyOfWaves(seaOf(waves), edges), edges);
  let m0 = 0;
  density.forEach((value, i) => (m0 += value * (edges[i + 1] - edges[i])));
  assert.ok(Math.abs(m0 - (1 + 0.25 + 0.0625) / 2) < 1e-12);
});

test('bins of a loop hold whole cycles: none is narrower than one', () => {
  for (const loop of [8, 64, 600]) {
    const edges = edgesOfLoop(loop);
    for (let i = 1; i < edges.length; i++) {
      const width = (edges[i] - edges[i - 1]) * loop;
      assert.ok(width > 0.999, `${width} cycles`);
      assert.ok(Math.abs(width - Math.round(width)) < 1e-9);
      assert.ok(Math.abs(((edges[i] * loop) % 1) - 0.5) < 1e-9);
    }
  }
});

test('statistics stand beside each other, with dashes for what is not known', () => {
  const document = {
    statistics: { specified: null, realised: { hs: 2.345, tp: 8.25, direction: -0.2 } },
  };
  assert.deepEqual(statisticsRows(document), [
    ['Hs [m]', '–', '2.35'],
    ['Tp [s]', '–', '8.3'],
    ['Direction', '–', '0°'],
  ]);
  const turned = { statistics: { specified: { direction: 355 }, realised: {} } };
  assert.equal(statisticsRows(turned)[2][1], '-5°');
});

test('tiles and waves are summed up', () => {
  const tiles = [
    { n: [64, 64], size: [1357.6, 1357.6], waves: 1000 },
    { n: [64, 64], size: [10.632, 10.632], waves: 234 },
    { n: [64, 32], size: [50, 25], waves: 1 },
  ];
  assert.equal(tilesText(tiles), '64² on 1360, 10.6 m; 64 × 32 on 50 m');
  assert.equal(wavesOf({ tiles }), 1235);
  assert.equal(grouped(1048576), '1\u2009048\u2009576');
});

test('the rate is that of the last second', () => {
  const rate = new FrameRate();
  assert.equal(rate.note(0), null);
  let last = null;
  for (let i = 1; i <= 100; i++) last = rate.note(i * 0.02);
  assert.ok(Math.abs(last - 50) < 1e-9);
  rate.clear();
  assert.equal(rate.note(100), null);
});

test('flat water has neither a period nor a direction', () => {
  const flat = { hs: 0, tp: 0, direction: 0 };
  const rows = statisticsRows({ statistics: { specified: flat, realised: flat } });
  assert.deepEqual(rows, [
    ['Hs [m]', '0.00', '0.00'],
    ['Tp [s]', '–', '–'],
    ['Direction', '–', '–'],
  ]);
});

test('one wave is in the singular', () => {
  assert.deepEqual([0, 1, 2, 12345].map(wavesText), [
    '0 waves',
    '1 wave',
    '2 waves',
    '12\u2009345 waves',
  ]);
});

test('a density by frequency and direction gives the energy of wider rings', () => {
  // density f in one sector and 2 f in the other: the mean over a ring is that of its middle
  const density = Array.from({ length: 10 }, (_, i) => [i + 0.5, 2 * (i + 0.5)]);
  const rings = Float64Array.of(0.2, 0.3, 0.5, 0.85);
  const energy = energyOfPolar({ highest: 1, density }, rings);
  [0.25, 0.4, 0.675].forEach((middle, i) => {
    const wanted = 10 * middle * (rings[i + 1] - rings[i]);
    assert.ok(Math.abs(energy[i][0] - wanted) < 1e-12);
    assert.ok(Math.abs(energy[i][1] - 2 * wanted) < 1e-12);
  });
});
