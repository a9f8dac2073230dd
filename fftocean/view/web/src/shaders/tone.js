// From radiance to the numbers of the screen, in a shader.

// Channels leak into each other before the curve and are separated after it, so that what is very
// bright turns white instead of a pure colour. The curve has the form of Narkowicz' fit to ACES
// (2015, CC0), with hardly a toe: the sea is dark, and its colours live there.
export const LEAK = 0.12;

/** The tone curve, the code of sRGB, and noise of half a step against bands. */
export const TONE = `
uniform float exposure_factor;
uniform bool linear_light;

float grain(vec2 at, float shift) {
  // Interleaved gradient noise (Jimenez 2014): even, and without clumps.
  return fract(52.9829189 * fract(dot(at + shift * 5.588238, vec2(0.06711056, 0.00583715))));
}

vec3 curve(vec3 light) {
  vec3 x = 0.5 * light;
  float grey = dot(x, vec3(0.3333));
  x = mix(x, vec3(grey), ${LEAK.toFixed(3)});
  x = clamp(x * (2.4 * x + 0.3) / (x * (2.4 * x + 0.85) + 0.33), 0.0, 1.0);
  grey = dot(x, vec3(0.3333));
  return clamp((x - ${LEAK.toFixed(3)} * grey) / (1.0 - ${LEAK.toFixed(3)}), 0.0, 1.0);
}

vec3 coded(vec3 linear) {
  return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055,
    step(0.0031308, linear));
}

vec4 shown(vec3 radiance, float exposure) {
  if (linear_light) return vec4(radiance, 1.0);
  vec3 screen = coded(curve(radiance * exposure * exposure_factor));
  vec2 at = gl_FragCoord.xy;
  vec3 noise = vec3(grain(at, 0.0), grain(at, 1.0), grain(at, 2.0)) - 0.5;
  return vec4(screen + noise / 255.0, 1.0);
}
`;
