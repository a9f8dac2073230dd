// Parts of the page that the first picture of the sea does not need: each is a file of its own.

const SOURCES = {
  accessibility: () => import('./accessibility.js'),
  bake: () => import('./bake.js'),
  blend: () => import('./blend.js'),
  buoy: () => import('./buoy.js'),
  comparison: () => import('./comparison.js'),
  dialogs: () => import('./dialogs.js'),
  files: () => import('./files.js'),
  heads_up: () => import('./heads_up.js'),
  interface: () => import('./interface.js'),
  verification: () => import('./verification.js'),
  views: () => import('./views.js'),
  worker_simulation: () => import('./worker_simulation.js'),
};

/** Parts that a page may want when its server is gone: they are asked for after the first picture. */
const SOON = Object.keys(SOURCES).filter((name) => !/^(?:bake|interface|worker)/.test(name));

/** The parts that are here, by name. */
export const parts = {};

const asked = new Map();

/**
 * Return a promise of a part, which is asked for once.
 *
 * @throws {Error} its file cannot be had
 */
export function part(name) {
  if (!asked.has(name)) {
    const coming = SOURCES[name]().then(
      (found) => (parts[name] = found),
      () => {
        asked.delete(name);
        throw new Error(`a part of the page did not come from the server (${name}.js)`);
      },
    );
    asked.set(name, coming);
  }
  return asked.get(name);
}

/** Ask for all parts that may be wanted soon; those that do not come are asked for again then. */
export function partsSoon() {
  return Promise.allSettled(SOON.map(part));
}
