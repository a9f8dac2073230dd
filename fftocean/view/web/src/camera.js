// The camera over the water: its matrices, its movement, and the part of the sea that it sees.

const DEGREE = Math.PI / 180;

/** Radius of the earth [m]; it decides where the horizon lies. */
export const EARTH_RADIUS = 6371e3;

/** Distance of the nearest and the farthest thing that is drawn [m]. */
const NEAR = 0.15;
const FAR = 200e3;

const DIRECTIONS_AN_EDGE = 48;

/** An eye above the water and the direction in which it looks. */
export class Camera {
  /**
   * Place the camera.
   *
   * @param {object} [place]
   * @param {number} [place.east] [m]
   * @param {number} [place.north] [m]
   * @param {number} [place.height] above the still water [m]
   * @param {number} [place.yaw] direction of view, counter-clockwise from east [degrees]
   * @param {number} [place.pitch] above the horizontal plane [degrees]
   * @param {number} [place.fieldOfView] between the lower and the upper edge [degrees]
   */
  constructor({ east = 0, north = 0, height = 6, yaw = 60, pitch = -6, fieldOfView = 50 } = {}) {
    Object.assign(this, { east, north, height, yaw, pitch, fieldOfView });
  }

  /** Return the unit vectors to the right, up and forward, each (east, north, up). */
  axes() {
    const [cy, sy] = [Math.cos(this.yaw * DEGREE), Math.sin(this.yaw * DEGREE)];
    const [cp, sp] = [Math.cos(this.pitch * DEGREE), Math.sin(this.pitch * DEGREE)];
    return {
      right: [sy, -cy, 0],
      up: [-sp * cy, -sp * sy, cp],
      forward: [cp * cy, cp * sy, sp],
    };
  }

  /**
   * Return the matrices of a picture, for positions relative to the eye, columns one after another.
   *
   * @param {number} aspect width of the picture over its height
   * @returns {{viewProjection: Float32Array, rays: Float32Array}} `rays` (3 x 3) takes a point of
   *   the screen (x, y in -1..1, 1) to the direction of its ray
   */
  matrices(aspect) {
    const { right, up, forward } = this.axes();
    const tangent = Math.tan((this.fieldOfView * DEGREE) / 2);
    const [x, y] = [1 / (tangent * aspect), 1 / tangent];
    const depth = -(FAR + NEAR) / (FAR - NEAR);
    const shift = (-2 * FAR * NEAR) / (FAR - NEAR);
    const viewProjection = new Float32Array(16);
    for (let axis = 0; axis < 3; axis++) {
      const column = [x * right[axis], y * up[axis], -depth * forward[axis], forward[axis]];
      viewProjection.set(column, 4 * axis);
    }
    viewProjection[14] = shift;
    const rays = Float32Array.from([
      ...right.map((v) => v * tangent * aspect),
      ...up.map((v) => v * tangent),
      ...forward,
    ]);
    return { viewProjection, rays };
  }

  /**
   * Move in the direction of view, to the right of it, and up.
   *
   * @param {number} ahead [m], level whatever the pitch
   * @param {number} right [m]
   * @param {number} up [m]
   */
  move(ahead, right = 0, up = 0) {
    const [c, s] = [Math.cos(this.yaw * DEGREE), Math.sin(this.yaw * DEGREE)];
    this.east += ahead * c + right * s;
    this.north += ahead * s - right * c;
    this.height = Math.min(Math.max(this.height + up, 0.3), 20e3);
  }

  /** Turn to the left and up [degrees]; the camera never looks over backward. */
  turn(left, up = 0) {
    this.yaw = (((this.yaw + left) % 360) + 360) % 360;
    this.pitch = Math.min(Math.max(this.pitch + up, -90), 90);
  }
}

/** Return the distance to the horizon [m] from a height [m]. */
export function horizonDistance(height) {
  return Math.sqrt(2 * EARTH_RADIUS * Math.max(height, 0));
}

/** Return the rays through the edge of a picture, as directions (east, north, up). */
function edgeRays(camera, aspect) {
  const { rays } = camera.matrices(aspect);
  const corners = [
    [-1, -1],
    [1, -1],
    [1, 1],
    [-1, 1],
  ];
  const found = [];
  corners.forEach(([x, y], i) => {
    const [u, v] = corners[(i + 1) % 4];
    for (let step = 0; step < DIRECTIONS_AN_EDGE; step++) {
      const share = step / DIRECTIONS_AN_EDGE;
      const [a, b] = [x + share * (u - x), y + share * (v - y)];
      const ray = [0, 1, 2].map((axis) => a * rays[axis] + b * rays[3 + axis] + rays[6 + axis]);
      const length = Math.hypot(...ray);
      found.push(ray.map((value) => value / length));
    }
  });
  return found;
}

/** Return true if the picture shows a direction (east, north, up), with a margin. */
function shows(camera, aspect, direction, margin = 1.15) {
  const { right, up, forward } = camera.axes();
  const along = (axis) => axis.reduce((sum, value, i) => sum + value * direction[i], 0);
  const ahead = along(forward);
  const tangent = Math.tan((camera.fieldOfView * DEGREE) / 2) * margin;
  return (
    ahead > 0 &&
    Math.abs(along(up)) <= tangent * ahead &&
    Math.abs(along(right)) <= tangent * aspect * ahead
  );
}

/**
 * Return the sector of the sea that a picture may show.
 *
 * The water moves up to `reach` from its place at rest, and the eye may be lifted to the crests.
 * The sector therefore begins behind the eye: its apex lies so far back that everything within
 * `reach` of what is seen is inside.
 *
 * @param {Camera} camera
 * @param {number} aspect width over height
 * @param {number} reach largest displacement of the water [m]
 * @returns {{apex: number, middle: number, half: number, near: number, far: number}} the apex's
 *   distance behind the eye [m]; direction of the middle and half the angle [radians]; nearest and
 *   farthest distance from the eye, the nearest negative behind it [m]
 */
export function visibleSector(camera, aspect, reach) {
  const lowest = camera.height;
  const highest = Math.max(camera.height, reach) + 1;
  const horizon = horizonDistance(highest);
  const rays = edgeRays(camera, aspect);
  const middle = camera.yaw * DEGREE;
  const around = shows(camera, aspect, [0, 0, -1]) || shows(camera, aspect, [0, 0, 1]);
  let half = 0;
  let near = horizon;
  let far = 0;
  for (const [east, north, up] of rays) {
    const ahead = east * Math.cos(middle) + north * Math.sin(middle);
    const left = north * Math.cos(middle) - east * Math.sin(middle);
    half = Math.max(half, Math.abs(Math.atan2(left, ahead)));
    const level = Math.hypot(east, north);
    // A crest higher than the eye may be seen at any distance, also by a ray that rises.
    if (lowest <= reach) near = 0;
    else if (up < 0) near = Math.min(near, ((lowest - reach) * level) / -up);
    // A ray that is less steep than twice the horizon's dip may reach it: the earth is round.
    const steep = -up > (4 * highest * level) / horizon;
    far = Math.max(far, steep ? ((highest + reach) * level) / -up + reach : horizon);
  }
  far = Math.min(Math.max(far, 4 * reach), horizon);
  if (around || half > 1.4) return { apex: 0, middle, half: Math.PI, near: 0, far };
  half += 0.01;
  const apex = reach / Math.sin(half);
  return { apex, middle, half, near: Math.max(near - reach, -apex), far };
}

/**
 * Return the distances of the rings of the mesh from the eye, and the gaps between them.
 *
 * A gap grows with distance as (distance^2 + height^2)^(power/2): with power 2 rings would be evenly
 * spaced on the screen, but so far apart near the horizon that crests turn into stairs; with 1
 * they would be as far apart as the columns.
 *
 * @param {number} near first distance [m], negative behind the eye
 * @param {number} far last distance [m]
 * @param {number} height of the eye [m]
 * @param {number} count number of rings
 * @returns {Float32Array} (count, 2): distance and gap [m]
 */
export function ringDistances(near, far, height, count, power = 1.3) {
  const soft = Math.max(0.6 * height, 0.8);
  const density = (distance) => (distance * distance + soft * soft) ** (-power / 2);
  // The integral of the density, on a grid that is fine where the density is large.
  const steps = 16 * count;
  const [first, last] = [Math.asinh(near / soft), Math.asinh(far / soft)];
  const places = Array.from(
    { length: steps + 1 },
    (_, i) => soft * Math.sinh(first + ((last - first) * i) / steps),
  );
  const sums = [0];
  for (let i = 1; i <= steps; i++) {
    const middle = 0.5 * (places[i] + places[i - 1]);
    sums.push(sums[i - 1] + density(middle) * (places[i] - places[i - 1]));
  }
  const total = sums[steps];
  const rings = new Float32Array(2 * count);
  let i = 1;
  for (let ring = 0; ring < count; ring++) {
    const wanted = (total * ring) / (count - 1);
    while (i < steps && sums[i] < wanted) i++;
    const share = Math.min((wanted - sums[i - 1]) / (sums[i] - sums[i - 1]), 1);
    const distance = places[i - 1] + share * (places[i] - places[i - 1]);
    rings[2 * ring] = distance;
    rings[2 * ring + 1] = total / (count - 1) / density(distance);
  }
  return rings;
}
