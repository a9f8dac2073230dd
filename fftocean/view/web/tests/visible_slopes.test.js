// Rules for the slopes that are seen: exact for polynomials, against moments in closed form.
import test from 'node:test';
import assert from 'node:assert/strict';
import { HIGHEST, LOWEST, POINTS, visibleRule, visibleTable } from '../src/visible_slopes.js';

test('integrates polynomials of degree 7 exactly', () => {
  // Moments of y exp(-(y - x)^2 / 2) over y > 0 by parts: M(n+1) = x M(n) + n M(n-1).
  for (const x of [0, 1.5, 6]) {
    // M(0) and M(1) of exp(-(y - x)^2 / 2) by Simpson's rule: no closed form without erf
    const steps = 4000;
    const width = (x + 10) / steps;
    let first = 0;
    for (let i = 0; i <= steps; i++) {
      const weight = i === 0 || i === steps ? 1 : i % 2 ? 4 : 2;
      first += ((weight * width) / 3) * Math.exp(-0.5 * (i * width - x) ** 2);
    }
    const moments = [first, x * first + Math.exp(-0.5 * x * x)];
    for (let n = 1; n < 9; n++) moments.push(x * moments[n] + n * moments[n - 1]);
    const { nodes, weights } = visibleRule(x);
    assert.equal(nodes.length, POINTS);
    for (let power = 0; power < 2 * POINTS; power++) {
      const found = nodes.reduce((sum, y, i) => sum + weights[i] * y ** power, 0);
      const wanted = moments[power + 1] / moments[1];
      assert.ok(Math.abs(found / wanted - 1) < 2e-4, `${found}, not ${wanted}, at ${x}, ${power}`);
    }
  }
});

test('sees only facets that face the eye, and all alike from above', () => {
  assert.ok(visibleRule(LOWEST).nodes.every((y) => y > 0));
  // Far above, what is seen is normal about x + 1/x: the nodes of Gauss and Hermite.
  const { nodes } = visibleRule(HIGHEST);
  [-2.334, -0.742, 0.742, 2.334].forEach((node, i) =>
    assert.ok(Math.abs(nodes[i] - HIGHEST - 1 / HIGHEST - node) < 0.05),
  );
});

test('fills its table', () => {
  const { data, width, height } = visibleTable();
  assert.equal(data.length, 4 * width * height);
  for (let i = 0; i < width; i++) {
    const weights = data.subarray(4 * (width + i), 4 * (width + i) + 4);
    assert.ok(Math.abs(weights.reduce((a, b) => a + b) - 1) < 1e-6);
  }
});
