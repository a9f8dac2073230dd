// Colour of the water and Fresnel's reflectance against published numbers.
import test from 'node:test';
import assert from 'node:assert/strict';
import { coxMunk, fresnel, reflectance, waterOptics } from '../src/optics.js';

const near = (value, wanted, tolerance) =>
  assert.ok(Math.abs(value - wanted) <= tolerance, `${value} is not ${wanted} +- ${tolerance}`);

test('absorbs and scatters like pure sea water where there is hardly any chlorophyll', () => {
  const { absorption, backscattering } = waterOptics(1e-9);
  // Pope & Fry (1997), table 3, at 610, 550 and 465 nm, with the yellow matter's share that remains
  const yellow = [610, 550, 465].map((nm) => 1 + 0.2 * Math.exp(-0.014 * (nm - 440)));
  [0.2644, 0.0565, 0.0101].forEach((a, i) => near(absorption[i] / yellow[i], a, 1e-4));
  // Smith & Baker (1981), table 1: scattering of clear natural waters 0.0019 at 550 nm
  near(2 * backscattering[1], 0.0019, 1e-4);
});

test('absorbs by chlorophyll as Prieur and Sathyendranath (1981) measured, relative to 440 nm', () => {
  // of what 1 mg/m^3 adds, between their values at the two nearest tens of nanometres
  const clear = waterOptics(1e-12).absorption;
  const added = waterOptics(1).absorption.map((a, i) => {
    const yellow = 1 + 0.2 * Math.exp(-0.014 * ([610, 550, 465][i] - 440));
    return (a - clear[i]) / yellow / 0.06;
  });
  [0.252, 0.357, (0.917 + 0.87) / 2].forEach((wanted, i) => near(added[i], wanted, 1e-3));
});

test('has the ratio of blue to green of the ocean by chlorophyll', () => {
  // OC2 as O'Reilly et al. (1998) print it, a fit to measurements at 490 and 555 nm. Our channels lie
  // at 465 and 550 nm, so that no more than the trend and the size can agree.
  for (const ratio of [3.5, 2.3, 1.3, 0.8]) {
    const r = Math.log10(ratio);
    const measured = 10 ** (0.341 - 3.001 * r + 2.811 * r * r - 2.041 * r ** 3) - 0.04;
    const [red, green, blue] = reflectance(waterOptics(measured));
    const found = blue / green;
    assert.ok(found > ratio / 1.5 && found < ratio * 1.5, `${found}, not ${ratio}, at ${measured}`);
    assert.ok(red < 0.5 * green);
  }
});

test('refuses water without a positive chlorophyll', () => {
  for (const chlorophyll of [0, -1, NaN, undefined]) {
    assert.throws(() => waterOptics(chlorophyll), /chlorophyll must be positive/);
  }
});

test('reflects light by Fresnel', () => {
  near(fresnel(1), ((1.34 - 1) / (1.34 + 1)) ** 2, 1e-12); // upright: 2.1 %
  near(fresnel(0), 1, 1e-12); // grazing: all
  // At Brewster's angle only one polarisation is reflected: half of ((n^2 - 1)/(n^2 + 1))^2.
  const brewster = Math.cos(Math.atan(1.34));
  near(fresnel(brewster), 0.5 * ((1.34 ** 2 - 1) / (1.34 ** 2 + 1)) ** 2, 1e-12);
  near(fresnel(0.5, 1.333), 0.06, 0.0005); // the 6.0 % at 60 degrees of tables
});

test('has the slope variance of Cox and Munk', () => {
  // Their total: 0.003 + 0.00512 U = 0.003 + 0.00192 U + 0.00316 U, to the figures they print
  for (const direction of [0, 33, 170]) {
    const [xx, yy, xy] = coxMunk(10, direction);
    near(xx + yy, 0.003 + 0.0508, 1e-12);
    near(xx * yy - xy * xy, 0.0316 * 0.0222, 1e-12);
  }
  const [xx, yy, xy] = coxMunk(10, 90);
  near(xx, 0.0222, 1e-12);
  near(yy, 0.0316, 1e-12);
  near(xy, 0, 1e-12);
});
