// Entry of the page that is one file: the sea is in it, and nothing is asked of a server.

import { startApp } from './sea_view.js';
import { EmbeddedSea } from './embedded.js';
import { bytesOf, inflated, joined } from './planes.js';

/** Return the text of an element that carries data. */
function carried(id) {
  return document.getElementById(id)?.textContent.trim() ?? null;
}

/** Return the bytes of the container. */
async function carriedSea() {
  const planes = Number(document.getElementById('sea').dataset.planes);
  return joined(await inflated(bytesOf(carried('sea'))), planes);
}

/** Start the page in its main element. */
async function start() {
  globalThis.fftocean = await startApp({
    root: document.getElementById('live-page'),
    table: JSON.parse(carried('parameters')),
    keysOn: globalThis,
    embedded: new EmbeddedSea(await carriedSea(), JSON.parse(carried('about') ?? '{}')),
  });
}

start().catch((error) => {
  const line = document.createElement('p');
  line.className = 'without-scripts';
  line.setAttribute('role', 'alert');
  line.textContent = `The page cannot start: ${error.message}`;
  document.body.append(line);
});
