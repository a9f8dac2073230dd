// Rules that average over the slopes that an eye sees of a rough surface, as a table.
//
// Of slopes distributed normally along the line of sight, an eye sees each in proportion to its
// projected area y = v_z - slope * v_h, where that is positive (Ross, Dion & Potvin 2005). In units
// of y's deviation the distribution of what is seen is y exp(-(y - x)^2 / 2), y > 0, and depends on
// x = mean / deviation alone. What a facet reflects changes much over it, so the mean is taken by
// Gauss' rule of four points.

export const POINTS = 4;

/** Lowest and highest x of the table; beyond the second the rule only moves along. */
export const LOWEST = -3;
export const HIGHEST = 12;

const ENTRIES = 61;
const GRID = 500;

/** Return nodes y and weights, which sum to 1, of the rule at x. */
export function visibleRule(x) {
  const low = Math.max(x - 9, 0);
  const step = (Math.max(x, 0) + 9 - low) / GRID;
  const places = Array.from({ length: GRID }, (_, i) => low + (i + 0.5) * step);
  const shift = 0.5 * Math.min(x, 0) ** 2; // against underflow
  const weights = places.map((y) => y * Math.exp(shift - 0.5 * (y - x) ** 2));
  const total = weights.reduce((a, b) => a + b);
  // Orthogonal polynomials by their recurrence (Stieltjes), on the grid.
  const middles = [];
  const norms = [total];
  let before = places.map(() => 0);
  let now = places.map(() => 1);
  for (let order = 0; order < POINTS; order++) {
    const square = now.map((p, i) => weights[i] * p * p);
    const norm = square.reduce((a, b) => a + b);
    norms[order] = norm;
    middles.push(square.reduce((sum, value, i) => sum + value * places[i], 0) / norm);
    const back = order ? norm / norms[order - 1] : 0;
    const next = now.map((p, i) => (places[i] - middles[order]) * p - back * before[i]);
    [before, now] = [now, next];
  }
  /** Return the polynomials of each order at y. */
  const polynomials = (y) => {
    const values = [1];
    for (let order = 0; order < POINTS; order++) {
      const back = order ? (norms[order] / norms[order - 1]) * values[order - 1] : 0;
      values.push((y - middles[order]) * values[order] - back);
    }
    return values;
  };
  const nodes = [];
  for (let i = 1; i < GRID; i++) {
    if (now[i - 1] * now[i] > 0 || now[i - 1] === 0) continue;
    let [a, b] = [places[i - 1], places[i]];
    const rising = now[i] > now[i - 1];
    for (let halving = 0; halving < 40; halving++) {
      const middle = 0.5 * (a + b);
      if (polynomials(middle)[POINTS] > 0 === rising) b = middle;
      else a = middle;
    }
    nodes.push(0.5 * (a + b));
  }
  // Christoffel's numbers
  const shares = nodes.map((y) => {
    const values = polynomials(y).slice(0, POINTS);
    return 1 / values.reduce((sum, p, order) => sum + (p * p * total) / norms[order], 0);
  });
  return { nodes, weights: shares };
}

/** Return the texels of the table: nodes less x in the first row, weights in the second. */
export function visibleTable() {
  const data = new Float32Array(4 * ENTRIES * 2);
  for (let i = 0; i < ENTRIES; i++) {
    const x = LOWEST + ((HIGHEST - LOWEST) * i) / (ENTRIES - 1);
    const { nodes, weights } = visibleRule(x);
    data.set(
      nodes.map((y) => y - x),
      4 * i,
    );
    data.set(weights, 4 * (ENTRIES + i));
  }
  return { data, width: ENTRIES, height: 2 };
}
