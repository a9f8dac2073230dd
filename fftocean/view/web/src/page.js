// Entry of the page that the server sends: a socket brings the sea, the server keeps its state.

import { startApp } from './sea_view.js';
import { Connection, socketAddress } from './connection.js';

/** Start the page in its main element. */
async function start() {
  const root = document.getElementById('live-page');
  const answer = await fetch('parameters.json', { credentials: 'omit' });
  const table = await answer.json();
  const token = decodeURIComponent(location.hash.slice(1));
  globalThis.fftocean = await startApp({
    root,
    table,
    keysOn: globalThis,
    connect(listeners) {
      const connection = new Connection({ address: socketAddress(location), token, listeners });
      connection.start();
      return connection;
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
