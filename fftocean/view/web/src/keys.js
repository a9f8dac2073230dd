// Keys of the page, from the tables of parameters and actions.

/** Keys of the table that also turn the eye, which a mouse does by dragging. */
const ARROWS = Object.freeze([
  { name: 'turn_left', key: 'ArrowLeft', label: 'turn left', held: true },
  { name: 'turn_right', key: 'ArrowRight', label: 'turn right', held: true },
  { name: 'look_up', key: 'ArrowUp', label: 'look up', held: true },
  { name: 'look_down', key: 'ArrowDown', label: 'look down', held: true },
]);

const FIELDS = new Set(['INPUT', 'TEXTAREA', 'SELECT']);
const PRESSED_BY_SPACE = new Set(['BUTTON', 'SUMMARY', 'A']);

/** Return the name of a key as it is in the tables: letters in lower case. */
export function normalKey(key) {
  return key.length === 1 ? key.toLowerCase() : key;
}

/** Return true for an element that takes the keys for itself. */
export function isField(node) {
  return Boolean(node) && (FIELDS.has(node.tagName) || node.isContentEditable === true);
}

/** Return all actions: those of the table, and the arrows. */
export function allActions(actions) {
  return [...actions, ...ARROWS];
}

/** Return the map from a key to what it does. */
export function keyPlan(parameters, actions) {
  const plan = new Map();
  for (const { name, keyDown, keyUp } of parameters) {
    if (keyDown) plan.set(keyDown, { type: 'step', name, direction: -1, ring: false });
    // A parameter with one key goes round; Shift goes round the other way.
    if (keyUp) plan.set(keyUp, { type: 'step', name, direction: 1, ring: !keyDown });
  }
  for (const { name, key, held } of allActions(actions)) {
    plan.set(key, { type: held ? 'hold' : 'act', name });
  }
  return plan;
}

/**
 * Return what a key event does, or null.
 * Keys are left alone while a field has the focus, with Control, Alt or Meta, and while a character
 * is composed. The space bar presses a button that has the focus.
 */
export function actionOf(event, plan) {
  if (event.ctrlKey || event.altKey || event.metaKey || event.isComposing) return null;
  if (event.defaultPrevented || isField(event.target)) return null;
  if (event.key === ' ' && PRESSED_BY_SPACE.has(event.target?.tagName)) return null;
  const action = plan.get(normalKey(event.key));
  if (!action) return null;
  if (event.repeat && (action.type === 'act' || action.ring)) return null;
  if (action.ring && event.shiftKey) return { ...action, direction: -action.direction };
  return action;
}

/** The movements whose keys are down. */
export class HeldKeys {
  /** Keep the plan, which names the movement of a key. */
  constructor(plan) {
    this.plan = plan;
    this.down = new Set();
    this.fast = false;
  }

  /** Note that the key of a movement went down. */
  press(name) {
    this.down.add(name);
  }

  /** Note that a key went up, whatever it does. */
  release(key) {
    const action = this.plan.get(normalKey(key));
    if (action?.type === 'hold') this.down.delete(action.name);
  }

  /** Forget all keys: a window without the focus is not told that they went up. */
  clear() {
    this.down.clear();
    this.fast = false;
  }

  /** Return +1, 0 or -1 for a pair of movements. */
  axis(positive, negative) {
    return Number(this.down.has(positive)) - Number(this.down.has(negative));
  }

  /** Return true while any movement is held. */
  get any() {
    return this.down.size > 0;
  }
}
