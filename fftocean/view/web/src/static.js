// Entry of the page that is one file: the sea is in it, and nothing is asked of a server.

import { startApp } from './app.js';
import { readTable } from './table.js';

/** Return the text of an element that carries data. */
function carried(id) {
  return document.getElementById(id)?.textContent.trim() ?? null;
}

/** Return the bytes of base64. */
function bytesOf(text) {
  const binary = atob(text);
  return Uint8Array.from(binary, (letter) => letter.charCodeAt(0));
}

/** Start the page in its main element. */
async function start() {
  globalThis.fftocean = await startApp({
    root: document.getElementById('live-page'),
    table: readTable(JSON.parse(carried('parameters'))),
    keysOn: globalThis,
    embedded: {
      bytes: bytesOf(carried('sea')),
      about: JSON.parse(carried('about') ?? '{}'),
    },
  });
}

start().catch((error) => {
  const line = document.createElement('p');
  line.className = 'without-scripts';
  line.setAttribute('role', 'alert');
  line.textContent = `The page cannot start: ${error.message}`;
  document.body.append(line);
});
