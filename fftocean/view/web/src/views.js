// False colours of the fields: what each view shows, its range, and colour maps of even steps.
import { waveHeight } from './statistics.js';

export { falseColourShader } from './shaders/false_colours.js';

const STEPS = 256;

/** The colour behind false colours, where there is no water; no map holds it. */
export const PLAIN = [0.09, 0.09, 0.1];

/** Return the linear sRGB channels of a colour in OKLab (Ottosson 2020). */
function linearFromLab([lightness, a, b]) {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
}

/** Return a colour of OKLab with as much of a chroma as the screen can show. */
function shownColour(lightness, chroma, hue) {
  const angle = (hue * Math.PI) / 180;
  const lab = (share) => {
    const shown = share * chroma;
    return [lightness, shown * Math.cos(angle), shown * Math.sin(angle)];
  };
  const fits = (share) => linearFromLab(lab(share)).every((value) => value > 0 && value < 1);
  if (fits(1)) return lab(1);
  let [low, high] = [0, 1];
  for (let step = 0; step < 24; step++) {
    const middle = 0.5 * (low + high);
    if (fits(middle)) low = middle;
    else high = middle;
  }
  return lab(low);
}

/** Return the value at `at` in 0..1 of a line through evenly spaced knots. */
function along(knots, at) {
  const place = at * (knots.length - 1);
  const first = Math.min(Math.floor(place), knots.length - 2);
  return knots[first] + (place - first) * (knots[first + 1] - knots[first]);
}

/** Return colours of OKLab at even distances on a path of lightness, chroma and hue. */
function evenPath(lightness, chroma, hue, count) {
  const fine = 2000;
  const path = Array.from({ length: fine + 1 }, (_, i) =>
    shownColour(along(lightness, i / fine), along(chroma, i / fine), along(hue, i / fine)),
  );
  const lengths = [0];
  for (let i = 1; i <= fine; i++) {
    lengths.push(lengths[i - 1] + Math.hypot(...path[i].map((v, k) => v - path[i - 1][k])));
  }
  let i = 1;
  return Array.from({ length: count }, (_, step) => {
    const wanted = (lengths[fine] * step) / (count - 1);
    while (i < fine && lengths[i] < wanted) i++;
    const share = Math.min((wanted - lengths[i - 1]) / (lengths[i] - lengths[i - 1] || 1), 1);
    return path[i].map((v, k) => path[i - 1][k] + share * (v - path[i - 1][k]));
  });
}

/** Return two paths as one that meets in its middle. */
function twoSided(low, high) {
  const half = STEPS / 2;
  return [
    ...evenPath(low.lightness, low.chroma, low.hue, half),
    ...evenPath(high.lightness, high.chroma, high.hue, half).reverse(),
  ];
}

// Lightness rises evenly in the first; in the second it falls evenly to both sides of the middle.
const MAPS = {
  sequential: () =>
    evenPath([0.2, 0.96], [0.09, 0.13, 0.14, 0.14, 0.15], [300, 265, 215, 150, 105], STEPS),
  twoSided: () =>
    twoSided(
      { lightness: [0.32, 0.96], chroma: [0.13, 0.14, 0.0], hue: [262, 235, 220] },
      { lightness: [0.32, 0.96], chroma: [0.12, 0.15, 0.0], hue: [25, 45, 80] },
    ),
};

const ROWS = Object.keys(MAPS);

/** Return the colours of a map in OKLab, (256, 3). */
export function mapInLab(name) {
  return MAPS[name]();
}

/** Return the code of sRGB of a linear channel, in 0..255. */
function coded(linear) {
  const x = Math.min(Math.max(linear, 0), 1);
  return Math.round(255 * (x < 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
}

/** Return the colours of a map as sRGB, (256, 3) in 0..255. */
export function mapColours(name) {
  return mapInLab(name).map((lab) => linearFromLab(lab).map(coded));
}

/** Return the texels of all maps, one a row. */
export function mapTexels() {
  const texels = new Uint8Array(4 * STEPS * ROWS.length);
  ROWS.forEach((name, row) =>
    mapColours(name).forEach((colour, i) => texels.set([...colour, 255], 4 * (STEPS * row + i))),
  );
  return { data: texels, width: STEPS, height: ROWS.length };
}

/** The views in the sequence in which a key steps through them. */
export const VIEWS = [
  { name: 'sea', label: 'sea' },
  { name: 'height', label: 'height', unit: 'm', map: 'twoSided' },
  { name: 'slopes', label: 'slope', unit: '', map: 'sequential', range: () => [0, 0.8] },
  { name: 'normals', label: 'normals', unit: '' },
  { name: 'jacobian', label: 'Jacobian', unit: '', map: 'twoSided', range: () => [0, 2] },
  { name: 'foam', label: 'foam coverage', unit: '', map: 'sequential', range: () => [0, 1] },
  { name: 'roughness', label: 'rms slope below a pixel', map: 'sequential', range: roughnessRange },
  { name: 'tiles', label: 'borders of the tiles', unit: 'm', map: 'twoSided' },
  { name: 'wireframe', label: 'mesh over height', unit: 'm', map: 'twoSided' },
];

/** Return the number that the shader knows a view by: 0 is the sea as it looks. */
export function viewNumber(name) {
  const found = VIEWS.findIndex((view) => view.name === name);
  if (found < 0) {
    const names = VIEWS.map((view) => view.name).join(', ');
    throw new RangeError(`view must be one of ${names}, got ${JSON.stringify(name)}`);
  }
  return found;
}

/** Return the range of the view of roughness: up to what the whole sea has. */
function roughnessRange(document) {
  const total = document?.slope_variance?.total ?? [0.03, 0.03, 0];
  return [0, Math.max(1.1 * Math.sqrt(total[0] + total[1]), 0.1)];
}

/**
 * Return what a legend says of a view, or null where colours are no numbers.
 *
 * @returns {?{label: string, unit: string, low: number, high: number, colours: number[][]}}
 */
export function legend(name, document) {
  const view = VIEWS[viewNumber(name)];
  if (!view.map) return null;
  const [low, high] = viewRange(view, document);
  return { label: view.label, unit: view.unit ?? '', low, high, colours: mapColours(view.map) };
}

/** Return the range of values of a view. */
function viewRange(view, document) {
  if (view.range) return view.range(document);
  const height = waveHeight(document); // four standard deviations to either side
  return [-height, height];
}

/** Return the uniforms of the shader of false colours for a view. */
export function viewUniforms(name, document) {
  const view = VIEWS[viewNumber(name)];
  const range = view.map ? viewRange(view, document) : [0, 1];
  const row = Math.max(ROWS.indexOf(view.map), 0);
  return { view: viewNumber(name), shown_range: [...range, row, ROWS.length] };
}
