// What the camera sees: its matrices, the horizon, and the sector of the sea that the mesh covers.
import test from 'node:test';
import assert from 'node:assert/strict';
import { Camera, horizonDistance, ringDistances, visibleSector } from '../src/camera.js';

const VIEWS = [];
for (const height of [0.5, 3, 40, 900]) {
  for (const pitch of [-90, -60, -20, -4, 10, 80]) {
    for (const fieldOfView of [20, 90]) VIEWS.push({ height, pitch, fieldOfView, yaw: 37 });
  }
}

/** Return the point of the screen at which a position from the eye is seen, or null behind it. */
function projected({ viewProjection: m }, [x, y, z]) {
  const row = (i) => m[i] * x + m[4 + i] * y + m[8 + i] * z + m[12 + i];
  return row(3) > 0 ? [row(0) / row(3), row(1) / row(3)] : null;
}

test('projects a ray to the point of the screen that it comes from', () => {
  const camera = new Camera({ yaw: 123, pitch: -31, fieldOfView: 47 });
  const matrices = camera.matrices(16 / 9);
  for (const [x, y] of [
    [0, 0],
    [0.7, -0.3],
    [-1, 1],
  ]) {
    const ray = [0, 1, 2].map(
      (i) => x * matrices.rays[i] + y * matrices.rays[3 + i] + matrices.rays[6 + i],
    );
    const [u, v] = projected(
      matrices,
      ray.map((value) => 50 * value),
    );
    assert.ok(Math.abs(u - x) < 1e-5 && Math.abs(v - y) < 1e-5);
  }
});

test('looks where yaw and pitch say, north to the left of east', () => {
  const { forward, right, up } = new Camera({ yaw: 90, pitch: 0 }).axes();
  const rounded = (axis) => axis.map((value) => Math.round(value * 1e9) / 1e9 + 0);
  assert.deepEqual(rounded(forward), [0, 1, 0]);
  assert.deepEqual(rounded(right), [1, 0, 0]);
  assert.deepEqual(rounded(up), [0, 0, 1]);
  assert.ok(Math.abs(new Camera({ pitch: -90 }).axes().forward[2] + 1) < 1e-12);
});

test('puts the horizon at 3.57 km times the root of the height', () => {
  assert.ok(Math.abs(horizonDistance(1) - 3570) < 2);
  assert.ok(Math.abs(horizonDistance(400) - 71400) < 40);
});

test('covers all water that can be seen, wherever waves carry it', () => {
  const reach = 2;
  let seed = 1;
  const random = () => {
    seed = (seed * 16807) % 2147483647;
    return seed / 2147483647;
  };
  let seen = 0;
  for (const view of VIEWS) {
    const camera = new Camera(view);
    for (const aspect of [16 / 9, 0.46]) {
      const matrices = camera.matrices(aspect);
      const { apex, middle, half, near, far } = visibleSector(camera, aspect, reach);
      for (let i = 0; i < 4000; i++) {
        const distance = 0.1 * 1e5 ** random();
        if (distance > horizonDistance(view.height)) continue;
        const angle = 2 * Math.PI * random();
        const rest = [distance * Math.cos(angle), distance * Math.sin(angle)];
        const moved = [0, 1].map((axis) => rest[axis] + 0.7 * reach * (2 * random() - 1));
        const up = reach * (2 * random() - 1) - view.height - distance ** 2 / 2 / 6371e3;
        const at = projected(matrices, [...moved, up]);
        if (!at || Math.max(Math.abs(at[0]), Math.abs(at[1])) > 1) continue;
        seen++;
        const back = [rest[0] + apex * Math.cos(middle), rest[1] + apex * Math.sin(middle)];
        const turn = Math.atan2(back[1], back[0]) - middle;
        const off = Math.abs(Math.atan2(Math.sin(turn), Math.cos(turn)));
        const where = JSON.stringify({ ...view, aspect, rest, moved, up });
        assert.ok(off <= half + 1e-9, `outside the sector: ${where}`);
        const from = Math.hypot(...back) - apex;
        assert.ok(from >= near - 1e-9 && from <= far + 1e-9, `outside the rings: ${where}`);
      }
    }
  }
  assert.ok(seen > 20000, `${seen} points seen`);
});

test('spreads rings from the first to the last distance, with gaps that it names', () => {
  for (const [near, far, height] of [
    [-3, 9e3, 5],
    [0, 7e4, 400],
    [20, 30, 50],
  ]) {
    const rings = ringDistances(near, far, height, 200);
    assert.ok(Math.abs(rings[0] - near) < 1e-3 * (far - near));
    assert.ok(Math.abs(rings[398] - far) < 1e-3 * far);
    for (let i = 1; i < 200; i++) {
      const gap = rings[2 * i] - rings[2 * i - 2];
      assert.ok(gap > 0);
      const named = 0.5 * (rings[2 * i + 1] + rings[2 * i - 1]);
      assert.ok(Math.abs(gap / named - 1) < 0.05, `gap ${gap}, named ${named}`);
    }
  }
});

test('moves level, whatever the pitch, and never below the water', () => {
  const camera = new Camera({ east: 1, north: 2, height: 5, yaw: 90, pitch: -80 });
  camera.move(10, 3, -50);
  assert.ok(Math.abs(camera.east - 4) < 1e-12 && Math.abs(camera.north - 12) < 1e-12);
  assert.equal(camera.height, 0.3);
  camera.turn(-100, -30);
  assert.ok(Math.abs(camera.yaw - 350) < 1e-12);
  assert.equal(camera.pitch, -90);
});
