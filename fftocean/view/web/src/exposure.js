// Exposure and tone: from radiance to the numbers of the screen.
import { LEAK } from './shaders/tone.js';

/** Return the factor of an exposure in stops. */
export function stopsFactor(stops) {
  return 2 ** stops;
}

/** Return the numbers of sRGB in 0..1 of a radiance times exposure: the twin of the shader. */
export function toneCurve(light) {
  const mean = (colour) => colour.reduce((sum, value) => sum + value, 0) / 3;
  const scaled = light.map((value) => 0.5 * value);
  const grey = mean(scaled);
  const bent = scaled.map((value) => {
    const x = value + LEAK * (grey - value);
    return Math.min(Math.max((x * (2.4 * x + 0.3)) / (x * (2.4 * x + 0.85) + 0.33), 0), 1);
  });
  const after = mean(bent);
  return bent.map((value) => {
    const x = Math.min(Math.max((value - LEAK * after) / (1 - LEAK), 0), 1);
    return x < 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
  });
}
