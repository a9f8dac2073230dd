// Sky of a clear day and the light that it gives: single scattering by air, haze and ozone.
import * as THREE from 'three';
import { Passes, floatTarget, mapTarget, pass } from './passes.js';

/** Where a direction (Y up) lies in the map of the sky: a stereographic projection. */
export const SKY_PLACE = `
vec2 sky_place(vec3 d) { return d.xz / (1.0 + max(d.y, -0.05)) * (0.5 / 1.1) + 0.5; }
`;

// Rayleigh, Mie and ozone at 680, 550 and 440 nm: Bruneton (2017), Hillaire (2020).
const SCATTERING = `
const float PI = 3.14159265, EARTH = 6371e3, TOP = 6471e3, MIE = 4.0e-6;
const vec3 RAYLEIGH = vec3(5.802e-6, 13.558e-6, 33.1e-6), OZONE = vec3(0.650e-6, 1.881e-6, 0.085e-6);
uniform vec3 sun;
float way_out(vec3 from, vec3 to) {
  float along = dot(from, to);
  return -along + sqrt(max(along * along - dot(from, from) + TOP * TOP, 0.0));
}
vec3 density(vec3 at) {
  float height = max(length(at) - EARTH, 0.0);
  return vec3(exp(-height / 8000.0), exp(-height / 1200.0), max(0.0, 1.0 - abs(height - 25e3) / 15e3));
}
vec3 transmitted(vec3 column) { return exp(-(RAYLEIGH * column.x + 4.4e-6 * column.y + OZONE * column.z)); }
vec3 sunlight(vec3 at) {
  float way = way_out(at, sun), along = dot(at, sun);
  vec3 column = vec3(0.0);
  for (int i = 0; i < 12; i++) {
    float share = (float(i) + 0.5) / 12.0;
    column += density(at + sun * way * share * share) * (2.0 * share * way / 12.0);
  }
  float lit = along > 0.0 ? 1.0 : smoothstep(EARTH - 6e3, EARTH + 6e3, length(at - along * sun));
  return 20.0 * lit * transmitted(column);
}
vec3 clear_sky(vec3 direction) {
  vec3 from = vec3(0.0, EARTH + 20.0, 0.0);
  float way = way_out(from, direction), cosine = dot(direction, sun);
  const float g = 0.78, g2 = g * g;
  float rayleigh_phase = 3.0 / (16.0 * PI) * (1.0 + cosine * cosine);
  float mie_phase = 3.0 / (8.0 * PI) * (1.0 - g2) * (1.0 + cosine * cosine) / ((2.0 + g2) * pow(1.0 + g2 - 2.0 * g * cosine, 1.5));
  // light scattered more than once, as even over all directions
  vec3 again = 1.05 * sunlight(vec3(0.0, EARTH + 3e3, 0.0)) * max(sun.y + 0.08, 0.0) + 0.03 * sunlight(vec3(0.0, EARTH + 20e3, 0.0));
  vec3 column = vec3(0.0), found = vec3(0.0);
  float last = 0.0;
  for (int i = 0; i < 24; i++) {
    float share = (float(i) + 0.5) / 24.0, next = (float(i) + 1.0) / 24.0;
    next *= next * way;
    vec3 at = from + direction * share * share * way, air = density(at);
    column += air * (next - last);
    vec3 seen = transmitted(column) * (next - last), scattered = RAYLEIGH * air.x, haze = vec3(MIE * air.y);
    found += seen * (sunlight(at) * (scattered * rayleigh_phase + haze * mie_phase) + (scattered + haze) * again / (4.0 * PI));
    last = next;
  }
  return found;
}`;

const MAP = `${SCATTERING}
uniform float samples;
out vec4 radiance;
void main() {
  vec2 at = (gl_FragCoord.xy / samples - 0.5) * 2.2;
  float square = dot(at, at);
  vec3 direction = vec3(2.0 * at.x, 1.0 - square, 2.0 * at.y) / (1.0 + square);
  if (direction.y < 0.002) direction = normalize(vec3(direction.x, 0.002, direction.z));
  radiance = vec4(clear_sky(direction), 1.0);
}`;

// Irradiance of the sun and of the sky, and the level of the brightest part.
const LIGHT = `${SCATTERING}
uniform sampler2D sky;
out vec4 light;
void main() {
  if (gl_FragCoord.x < 1.0) { light = vec4(sunlight(vec3(0.0, EARTH + 20.0, 0.0)), 1.0); return; }
  vec3 irradiance = vec3(0.0);
  float bright = 0.0, area = 0.0;
  for (int y = 0; y < 32; y++) for (int x = 0; x < 32; x++) {
    vec2 at = ((vec2(x, y) + 0.5) / 32.0 - 0.5) * 2.2;
    float square = dot(at, at);
    if (square > 1.0) continue;
    float solid = 4.0 / ((1.0 + square) * (1.0 + square)), up = (1.0 - square) / (1.0 + square);
    vec3 radiance = textureLod(sky, (vec2(x, y) + 0.5) / 32.0, 3.0).rgb;
    irradiance += radiance * solid * up;
    if (up < 0.6) { bright += pow(dot(radiance, vec3(0.2126, 0.7152, 0.0722)), 8.0) * solid; area += solid; }
  }
  light = vec4(irradiance * 4.84 / 1024.0, pow(bright / area, 0.125));
}`;

/** Tone curve and code of sRGB, with noise of half a step against bands. */
export const TONE = `
uniform float exposure;
vec4 shown(vec3 radiance) {
  vec3 x = 0.5 * exposure * radiance;
  float grey = dot(x, vec3(0.3333));
  x = mix(x, vec3(grey), 0.12);
  x = clamp(x * (2.4 * x + 0.3) / (x * (2.4 * x + 0.85) + 0.33), 0.0, 1.0);
  grey = dot(x, vec3(0.3333));
  x = clamp((x - 0.12 * grey) / 0.88, 0.0, 1.0);
  x = mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
  float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
  return vec4(x + grain / 255.0, 1.0);
}`;

const SAMPLES = 256;

/** The sky: its map, the light, and the background of a scene. */
export class Sky {
  constructor(renderer) {
    this.renderer = renderer;
    this.passes = new Passes(renderer);
    this.map = pass(MAP, ['sun', 'samples']);
    this.light = pass(LIGHT, ['sun', 'sky']);
    this.target = mapTarget(SAMPLES, SAMPLES, 1);
    this.measured = floatTarget(2, 1, 1);
    this.uniforms = {
      sky: { value: this.target.texture },
      sunward: { value: new THREE.Vector3(0, 1, 0) },
      sun_light: { value: new THREE.Vector3() },
      sky_light: { value: new THREE.Vector3() },
      exposure: { value: 1 },
    };
    this.mesh = new THREE.Mesh(new THREE.SphereGeometry(1, 48, 24), new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      side: THREE.BackSide,
      depthWrite: false,
      uniforms: this.uniforms,
      vertexShader: `in vec3 position; uniform mat4 projectionMatrix, viewMatrix; out vec3 ray;
        void main() { ray = position; gl_Position = (projectionMatrix * mat4(mat3(viewMatrix)) * vec4(position, 1.0)).xyww; }`,
      fragmentShader: `precision highp float; ${SKY_PLACE}${TONE}
        uniform sampler2D sky; uniform vec3 sunward, sun_light; in vec3 ray; out vec4 colour;
        void main() {
          vec3 d = normalize(ray);
          vec3 radiance = textureLod(sky, sky_place(normalize(vec3(d.x, max(d.y, 0.003), d.z))), 0.0).rgb;
          float angle = 2.0 * asin(min(0.5 * length(d - sunward), 1.0));
          float disc = clamp(0.5 - (angle - 0.00465) / max(length(fwidth(d)), 1e-5), 0.0, 1.0);
          radiance += sun_light * (2000.0 * disc + 0.35 * exp(-angle / 0.012) + 0.03 * exp(-angle / 0.07));
          colour = shown(radiance);
        }`,
    }));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = -1;
  }

  /** Put the sun at a height and a bearing, counter-clockwise from east [degrees]. */
  set(height, bearing) {
    const [h, b] = [height, bearing].map((degrees) => (degrees * Math.PI) / 180);
    const sun = new THREE.Vector3(Math.cos(h) * Math.cos(b), Math.sin(h), -Math.cos(h) * Math.sin(b));
    this.passes.run(this.map, { sun, samples: SAMPLES }, this.target);
    this.passes.run(this.light, { sun, sky: this.target.texture }, this.measured);
    const found = new Float32Array(8);
    this.renderer.readRenderTargetPixels(this.measured, 0, 0, 2, 1, found);
    this.renderer.setRenderTarget(null);
    const { uniforms } = this, bright = (r, g, b_) => 0.2126 * r + 0.7152 * g + 0.0722 * b_;
    uniforms.sunward.value.copy(sun);
    uniforms.sun_light.value.fromArray(found, 0);
    uniforms.sky_light.value.fromArray(found, 4);
    const middle = bright(...found.slice(4, 7)) + (0.25 * Math.max(sun.y, 0) + 0.02) * bright(...found.slice(0, 3));
    uniforms.exposure.value = Math.min(3.2 / (middle + 0.25), 1.5 / (found[7] + 0.15));
  }
}
