// The spectrum by frequency and by direction: specified beside realised, on a 2D canvas.

import { isFlat } from './statistics.js';

/** Sectors and rings of the polar plot. */
const SECTORS = 36;
const RINGS = 14;

/** Shares of the largest specified energy of a cell that lines are drawn around. */
const CONTOURS = [0.08, 0.5];

/**
 * Return the energy of the waves in bins of frequency and direction.
 * Wave k adds 2 |h0(k)|^2 to the variance; its frequency is cycles / loop.
 * `edges` are the frequencies [Hz] between the bins.
 */
export function energyOfWaves(sea, edges, sectors = SECTORS) {
  const count = edges.length - 1;
  const energy = new Float64Array(count * sectors);
  const binOf = binsOfCycles(edges, sea.document.loop);
  for (const tile of sea.tiles) {
    const { nx, ny, lx, ly, h0, wave } = tile;
    for (let j = 0; j < ny; j += 1) {
      const my = j < ny / 2 ? j : j - ny;
      for (let i = 0; i < nx; i += 1) {
        const at = j * nx + i;
        const real = h0[4 * at];
        const imaginary = h0[4 * at + 1];
        const variance = 2 * (real * real + imaginary * imaginary);
        if (variance === 0) continue;
        const bin = binOf(wave[2 * at]);
        if (bin < 0) continue;
        const mx = i < nx / 2 ? i : i - nx;
        const turn = Math.atan2(my / ly, mx / lx) / (2 * Math.PI) + 1;
        const sector = Math.round(turn * sectors) % sectors;
        energy[bin * sectors + sector] += variance;
      }
    }
  }
  return energy;
}

/** Return a function from cycles in a loop to the bin of their frequency, -1 outside. */
function binsOfCycles(edges, loop) {
  const most = Math.ceil(edges.at(-1) * loop);
  const bins = new Int16Array(most + 1).fill(-1);
  let bin = 0;
  for (let cycles = 0; cycles <= most; cycles += 1) {
    const frequency = cycles / loop;
    if (frequency < edges[0]) continue;
    while (bin < edges.length - 1 && frequency >= edges[bin + 1]) bin += 1;
    if (bin < edges.length - 1) bins[cycles] = bin;
  }
  return (cycles) => bins[cycles] ?? -1;
}

/**
 * Return the frequencies between bins that each hold a whole number of the loop's frequencies.
 * All waves have whole cycles in a loop, so a bin between two of them would be empty.
 */
export function edgesOfLoop(loop, low = 0.02, high = 4, ratio = 1.12) {
  const edges = [Math.max(0.5, Math.floor(low * loop) - 0.5)];
  while (edges.at(-1) / loop < high) {
    const last = edges.at(-1);
    edges.push(last + Math.max(1, Math.round(last * (ratio - 1))));
  }
  return Float64Array.from(edges, (cycles) => cycles / loop);
}

/** Return `count` + 1 frequencies in geometric progression. */
export function geometricEdges(low, high, count) {
  return Float64Array.from({ length: count + 1 }, (_, i) => low * (high / low) ** (i / count));
}

/** Return the density S(f) [m^2 s] of binned energy, and the middle frequency of each bin. */
export function densityOfEnergy(energy, edges, sectors = SECTORS) {
  const count = edges.length - 1;
  const frequency = new Float64Array(count);
  const density = new Float64Array(count);
  for (let bin = 0; bin < count; bin += 1) {
    let sum = 0;
    for (let sector = 0; sector < sectors; sector += 1) sum += energy[bin * sectors + sector];
    frequency[bin] = (edges[bin] + edges[bin + 1]) / 2;
    density[bin] = sum / (edges[bin + 1] - edges[bin]);
  }
  return { frequency, density };
}

/** Return the range of frequencies that the plot shows [Hz]: where nearly all energy is. */
export function plotRange(spectrum) {
  const { frequency, density } = spectrum;
  const top = Math.max(...density);
  const shown = frequency.filter((_, i) => density[i] > 0.004 * top);
  if (!shown.length) return [0.02, 1];
  return [Math.min(...shown) * 0.8, Math.max(...shown) * 1.1];
}

/** Return the size of a canvas on the page [CSS pixels], and the pixels that it should have. */
function sizesOf(canvas) {
  const ratio = Math.min(2, globalThis.devicePixelRatio || 1);
  const width = canvas.clientWidth || 280;
  const height = canvas.clientHeight || 130;
  return { ratio, width, height, pixels: [Math.round(width * ratio), Math.round(height * ratio)] };
}

/** Return true if a canvas has the pixels of its size: else the browser stretches the plot. */
export function plotFits(canvas) {
  const [width, height] = sizesOf(canvas).pixels;
  return canvas.width === width && canvas.height === height;
}

/** Draw S(f) and the polar spectrum; `colours` are CSS colours of line, second, grid, text. */
export function drawSpectrum(canvas, sea, colours) {
  const { ratio, width, height, pixels } = sizesOf(canvas);
  if (!plotFits(canvas)) [canvas.width, canvas.height] = pixels;
  const pen = canvas.getContext('2d');
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  const edges = edgesOfLoop(sea.document.loop);
  const energy = energyOfWaves(sea, edges);
  const realised = densityOfEnergy(energy, edges);
  const { spectrum } = sea.document;
  const specified = spectrum?.density ? spectrum : null; // given waves have no density
  const size = Math.min(height, width * 0.42);
  drawDensity(pen, { width: width - size - 12, height }, specified, realised, colours);
  drawPolar(pen, { left: width - size, size, top: (height - size) / 2 }, sea, edges, colours);
}

/** Draw S(f): the specified density as a line, the realised one as an area. */
function drawDensity(pen, box, specified, realised, colours) {
  const bottom = box.height - 16;
  const [low, high] = plotRange(specified ?? realised);
  const top = 1.15 * Math.max(...(specified ?? realised).density, 1e-12);
  const x = (f) => ((f - low) / (high - low)) * box.width;
  const y = (s) => bottom - (bottom - 12) * Math.min(1, s / top);
  pen.strokeStyle = colours.grid;
  pen.lineWidth = 1;
  pen.beginPath();
  pen.moveTo(0, bottom + 0.5);
  pen.lineTo(box.width, bottom + 0.5);
  pen.stroke();
  pen.fillStyle = colours.text;
  pen.font = colours.font;
  pen.textBaseline = 'alphabetic';
  for (const f of ticks(low, high)) {
    const label = `${Number(f.toPrecision(3))}`;
    pen.textAlign = x(f) < 12 ? 'left' : x(f) > box.width - 12 ? 'right' : 'center';
    pen.fillText(label, x(f), box.height - 3);
    pen.fillRect(x(f), bottom, 1, 3);
  }
  pen.textAlign = 'right';
  pen.fillText('f [Hz]', box.width, 9);
  pen.save();
  pen.beginPath();
  pen.rect(0, 0, box.width, bottom);
  pen.clip();
  pen.beginPath();
  pen.moveTo(x(realised.frequency[0]), bottom);
  for (let i = 0; i < realised.frequency.length; i += 1) {
    pen.lineTo(x(realised.frequency[i]), y(realised.density[i]));
  }
  pen.lineTo(x(realised.frequency.at(-1)), bottom);
  pen.fillStyle = colours.area;
  pen.fill();
  pen.strokeStyle = colours.second;
  pen.lineWidth = 1.25;
  pen.stroke();
  if (specified) {
    pen.beginPath();
    specified.frequency.forEach((f, i) => {
      if (i) pen.lineTo(x(f), y(specified.density[i]));
      else pen.moveTo(x(f), y(specified.density[i]));
    });
    pen.strokeStyle = colours.line;
    pen.lineWidth = 1.75;
    pen.stroke();
  }
  pen.restore();
}

/** Return three or four round frequencies inside a range. */
function ticks(low, high) {
  const rough = (high - low) / 3;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough) ?? rough;
  const found = [];
  for (let f = Math.ceil(low / step) * step; f <= high; f += step) found.push(f);
  return found;
}

/** Draw energy by direction (east right, north up) and frequency (outward, logarithmic). */
function drawPolar(pen, box, sea, edges, colours) {
  const [low, high] = polarRange(sea);
  const rings = geometricEdges(low, high, RINGS);
  const energy = energyOfWaves(sea, rings);
  const radius = box.size / 2 - 9;
  const cx = box.left + box.size / 2;
  const cy = box.top + box.size / 2;
  const top = Math.max(...energy, 1e-30);
  const half = Math.PI / SECTORS;
  for (let ring = 0; ring < RINGS; ring += 1) {
    const [inner, outer] = [ring, ring + 1].map((edge) => radius * radiusOf(edge));
    for (let sector = 0; sector < SECTORS; sector += 1) {
      const share = Math.sqrt(energy[ring * SECTORS + sector] / top);
      if (share < 0.03) continue;
      const angle = -(2 * Math.PI * sector) / SECTORS;
      pen.globalAlpha = Math.min(1, share);
      pen.fillStyle = colours.second;
      pen.beginPath();
      pen.arc(cx, cy, outer, angle - half, angle + half);
      pen.arc(cx, cy, inner, angle + half, angle - half, true);
      pen.fill();
    }
  }
  pen.globalAlpha = 1;
  const polar = sea.document.spectrum?.polar;
  if (polar) drawContours(pen, { cx, cy, radius }, energyOfPolar(polar, rings), colours.line);
  pen.strokeStyle = colours.grid;
  pen.lineWidth = 1;
  for (const share of [0.5, 1]) {
    pen.beginPath();
    pen.arc(cx, cy, radius * share, 0, 2 * Math.PI);
    pen.stroke();
  }
  const { specified } = sea.document.statistics ?? {};
  if (specified && !isFlat(specified)) {
    drawDirection(pen, cx, cy, radius, specified.direction, colours.line);
  }
  pen.fillStyle = colours.text;
  pen.font = colours.font;
  pen.textAlign = 'center';
  pen.textBaseline = 'middle';
  pen.fillText('N', cx, cy - radius - 5);
  pen.fillText('E', cx + radius + 5, cy);
}

/** Return the radius of an edge of rings, as a share of the plot's. */
function radiusOf(edge) {
  return 0.12 + (0.88 * edge) / RINGS;
}

/**
 * Return the energy, but for a factor, that a specified density has in each ring and sector.
 *
 * @param {{highest: number, density: number[][]}} polar even rings from 0 to `highest` [Hz], and
 *   sectors that begin at east
 * @param {Float64Array} rings frequencies of the edges of the plot's rings [Hz]
 */
export function energyOfPolar({ highest, density }, rings) {
  return Array.from({ length: rings.length - 1 }, (_, i) => {
    const [low, high] = [rings[i], rings[i + 1]];
    const place = ((low + high) / 2 / highest) * density.length - 0.5; // in middles of its rings
    const at = Math.min(Math.max(Math.floor(place), 0), density.length - 2);
    const share = Math.min(Math.max(place - at, 0), 1);
    return density[at].map(
      (value, sector) => (value + share * (density[at + 1][sector] - value)) * (high - low),
    );
  });
}

/** Draw lines around the cells that have more than some shares of the largest energy. */
function drawContours(pen, { cx, cy, radius }, energy, colour) {
  const sectors = energy[0].length;
  const top = Math.max(...energy.flat(), 1e-30);
  const turn = (sector) => (-2 * Math.PI * sector) / sectors;
  pen.strokeStyle = colour;
  pen.lineWidth = 1;
  for (const level of CONTOURS) {
    const inside = (ring, sector) =>
      (energy[ring]?.[(sector + sectors) % sectors] ?? 0) > level * top;
    pen.beginPath();
    energy.forEach((row, ring) => {
      const [inner, outer] = [ring, ring + 1].map((edge) => radius * radiusOf(edge));
      row.forEach((_, sector) => {
        if (!inside(ring, sector)) return;
        for (const [beside, edge] of [
          [ring - 1, inner],
          [ring + 1, outer],
        ]) {
          if (inside(beside, sector)) continue;
          pen.moveTo(cx + edge * Math.cos(turn(sector)), cy + edge * Math.sin(turn(sector)));
          pen.arc(cx, cy, edge, turn(sector), turn(sector + 1), true);
        }
        for (const [beside, edge] of [
          [sector - 1, sector],
          [sector + 1, sector + 1],
        ]) {
          if (inside(ring, beside)) continue;
          const [x, y] = [Math.cos(turn(edge)), Math.sin(turn(edge))];
          pen.moveTo(cx + inner * x, cy + inner * y);
          pen.lineTo(cx + outer * x, cy + outer * y);
        }
      });
    });
    pen.stroke();
  }
}

/** Return the frequencies of the polar plot's inner and outer edge [Hz]. */
function polarRange(sea) {
  const peak = sea.document.statistics?.specified?.tp;
  const middle = peak > 0 ? 1 / peak : 0.12;
  return [middle / 2.2, middle * 5];
}

/** Draw the specified mean direction as a line from the centre outward. */
function drawDirection(pen, cx, cy, radius, degrees, colour) {
  if (typeof degrees !== 'number' || !Number.isFinite(degrees)) return;
  const angle = (-degrees * Math.PI) / 180;
  pen.strokeStyle = colour;
  pen.lineWidth = 1.75;
  pen.beginPath();
  pen.moveTo(cx + 0.12 * radius * Math.cos(angle), cy + 0.12 * radius * Math.sin(angle));
  pen.lineTo(cx + radius * Math.cos(angle), cy + radius * Math.sin(angle));
  pen.stroke();
}
