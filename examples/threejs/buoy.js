// A buoy of 2 m, striped in half metres: it shows the scale, and that heights can be asked for.
import * as THREE from 'three';
import { TONE } from './sky.js';

// Radius by height above the water line [m]: hull, float, cone, staff, lamp.
const PROFILE = [
  [0.02, -0.7], [0.12, -0.6], [0.42, -0.1], [0.42, 0.3], [0.26, 0.42], [0.075, 1.3], [0.035, 1.31],
  [0.035, 1.77], [0.085, 1.8], [0.085, 1.95], [0.0, 2.0],
];
const HULL = 0.45; // it follows the mean of the water at four places this far out [m]

/** The buoy at a place in the world. */
export class Buoy {
  constructor(sky, X = 0, Z = 0) {
    this.X = X;
    this.Z = Z;
    const points = PROFILE.map(([radius, height]) => new THREE.Vector2(radius, height));
    this.mesh = new THREE.Mesh(new THREE.LatheGeometry(points, 32), new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      side: THREE.DoubleSide,
      uniforms: sky.uniforms,
      vertexShader: `in vec3 position, normal; uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
        out vec3 at, place, n;
        void main() {
          at = position;
          place = (modelMatrix * vec4(position, 1.0)).xyz;
          n = mat3(modelMatrix) * normal;
          gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
        }`,
      fragmentShader: `precision highp float;
        uniform vec3 cameraPosition, sunward, sun_light, sky_light; in vec3 at, place, n; out vec4 colour;
        ${TONE}
        void main() {
          vec3 to_eye = normalize(cameraPosition - place), normal = normalize(n);
          if (dot(normal, to_eye) < 0.0) normal = -normal;
          vec3 paint = at.y < 0.0 ? vec3(0.16, 0.03, 0.02)
            : fract(at.y) < 0.5 ? vec3(0.80, 0.60, 0.04) : vec3(0.62, 0.05, 0.03);
          if (at.y > 1.78) paint = vec3(0.75);
          float wet = smoothstep(0.25, 0.05, at.y), lit = max(dot(normal, sunward), 0.0);
          paint *= 1.0 - 0.45 * wet;
          float gloss = mix(60.0, 200.0, wet);
          float mirror = 0.04 * (gloss + 8.0) / 25.0 * pow(max(dot(normal, normalize(sunward + to_eye)), 0.0), gloss) * lit;
          float edge = 0.04 + 0.5 * pow(1.0 - max(dot(normal, to_eye), 0.0), 5.0);
          colour = shown(paint / 3.14159 * (sun_light * lit + sky_light * (0.55 + 0.45 * normal.y)) + sun_light * mirror + 0.25 * edge * sky_light);
        }`,
    }));
  }

  /** Let it float: `heightAt(X, Z)` is the height of the water [m]. */
  update(heightAt) {
    const { X, Z, mesh } = this;
    const [east, west, south, north] = [[1, 0], [-1, 0], [0, 1], [0, -1]].map(([i, j]) => heightAt(X + i * HULL, Z + j * HULL));
    mesh.position.set(X, (east + west + south + north) / 4, Z);
    const up = new THREE.Vector3(-0.7 * (east - west) / (2 * HULL), 1, -0.7 * (south - north) / (2 * HULL));
    mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), up.normalize());
  }
}
