// Mouse, touch and held keys that move the camera.

/** Degrees a second of a held arrow, and degrees a pixel of a drag for each degree of field. */
const TURNING = 45;

/** Share of the height above the water that a notch of the wheel moves ahead. */
const WHEEL = 0.25;

/** Return the speed of the camera [m/s]: higher up, the same step crosses more of the picture. */
export function cameraSpeed(height, fast) {
  return (3 + 1.2 * height) * (fast ? 4 : 1);
}

/** Move a camera by the keys that are held, for a time [s]; return true if it moved. */
export function moveByKeys(camera, held, seconds) {
  if (!held.any) return false;
  const length = cameraSpeed(camera.height, held.fast) * seconds;
  camera.move(
    held.axis('forward', 'back') * length,
    held.axis('right', 'left') * length,
    held.axis('up', 'down') * length * 0.5,
  );
  const turning = TURNING * seconds * (held.fast ? 2 : 1);
  camera.turn(
    held.axis('turn_left', 'turn_right') * turning,
    held.axis('look_up', 'look_down') * turning,
  );
  return true;
}

/** Let drags turn a camera, and let the wheel and two fingers move it. */
export function takePointers(canvas, camera, { onMove, signal }) {
  const options = { signal };
  const pointers = new Map();
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  const ahead = (share) => {
    camera.move(share * (4 + camera.height));
    onMove();
  };
  canvas.addEventListener(
    'pointerdown',
    (event) => {
      canvas.setPointerCapture?.(event.pointerId);
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      canvas.classList.add('dragged');
    },
    options,
  );
  canvas.addEventListener(
    'pointermove',
    (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const now = { x: event.clientX, y: event.clientY };
      if (pointers.size === 2) {
        const apart = spread();
        pointers.set(event.pointerId, now);
        ahead(2 * Math.log(spread() / Math.max(apart, 1)));
        return;
      }
      pointers.set(event.pointerId, now);
      const degrees = camera.fieldOfView / Math.max(canvas.clientHeight, 1);
      camera.turn((now.x - before.x) * degrees, (now.y - before.y) * degrees);
      onMove();
    },
    options,
  );
  for (const name of ['pointerup', 'pointercancel']) {
    canvas.addEventListener(
      name,
      (event) => {
        pointers.delete(event.pointerId);
        if (!pointers.size) canvas.classList.remove('dragged');
      },
      options,
    );
  }
  canvas.addEventListener(
    'wheel',
    (event) => {
      event.preventDefault();
      const notches = event.deltaMode === 0 ? event.deltaY / 100 : event.deltaY / 3;
      ahead(-WHEEL * Math.max(-3, Math.min(3, notches)));
    },
    { ...options, passive: false },
  );
}
