// What opens over the page or leaves it: the list of keys, texts to copy, screenshots.

import { keyName } from './controls.js';
import { element, icon, uniqueId } from './dom.js';
import { allActions } from './keys.js';

const CLOSE = 'M6 6l12 12M18 6L6 18';

/** Return a dialog with a title and a button that closes it. */
function dialog(title, kind) {
  const heading = uniqueId('title');
  const content = element('div', { class: 'dialog-body' });
  const node = element(
    'dialog',
    { class: `sheet ${kind}`, 'aria-labelledby': heading },
    element(
      'div',
      { class: 'dialog-head' },
      element('h2', { id: heading, text: title }),
      element(
        'button',
        {
          type: 'button',
          class: 'tool close',
          'aria-label': 'Close',
          on: { click: () => node.close() },
        },
        icon(CLOSE),
      ),
    ),
    content,
  );
  return { node, content };
}

/** Return the dialogs of a page, built when first asked for. */
export function dialogsOf(layout) {
  if (!layout.help) {
    layout.help = dialog('Keys', 'help');
    layout.text = dialog('Copy', 'copy');
    layout.root.append(layout.help.node, layout.text.node);
  }
  return layout;
}

/** Show or hide the list of keys. */
export function toggleHelp(app) {
  const { help } = dialogsOf(app.layout);
  if (help.node.open) {
    help.node.close();
    return;
  }
  if (!help.content.firstChild) fillHelp(help, app);
  help.node.showModal();
}

/** Return the rows of the list of keys: [keys, meaning]. */
function rowsOfKeys({ table, embedded, own }) {
  const rows = [];
  for (const { name, keyDown, keyUp, label } of table.parameters) {
    const keys = [keyDown, keyUp].filter(Boolean);
    if (!keys.length || (embedded && !own.has(name))) continue;
    const meaning = keys.length === 2 ? `${label} down, up` : `Next ${label.toLowerCase()}`;
    rows.push([keys, meaning]);
  }
  for (const { key, label } of allActions(table.actions)) {
    rows.push([[key], label.slice(0, 1).toUpperCase() + label.slice(1)]);
  }
  return rows;
}

/** Build the list of keys, with a switch for all of them. */
function fillHelp({ content }, app) {
  const id = uniqueId('field');
  const box = element('input', { id, type: 'checkbox', role: 'switch' });
  box.checked = app.keysEnabled;
  box.addEventListener('change', () => {
    app.keysEnabled = box.checked;
    app.held.clear();
  });
  content.replaceChildren(
    element(
      'dl',
      { class: 'keys-list' },
      ...rowsOfKeys(app).map(([keys, meaning]) =>
        element(
          'div',
          {},
          element('dt', {}, ...keys.map((key) => element('kbd', { text: keyName(key) }))),
          element('dd', { text: meaning }),
        ),
      ),
    ),
    element('p', {
      class: 'note',
      text:
        'Drag to look round, turn the wheel or pinch to move. Shift goes faster, or backward ' +
        'through a list. Keys are left alone while a field has the focus; Escape leaves it.',
    }),
    element('div', { class: 'control-head' }, element('label', { for: id, text: 'Keys' }), box),
  );
}

/** Show a text to copy by hand. */
function showText(layout, title, text) {
  const { node, content } = dialogsOf(layout).text;
  node.querySelector('h2').textContent = title;
  const area = element('textarea', { readonly: true, rows: '14', 'aria-label': title });
  area.value = text;
  content.replaceChildren(area);
  node.showModal();
  area.focus();
  area.select();
}

/** Put the job or the bake command on the clipboard; where the browser refuses, show it. */
export async function copy(app, what, text) {
  const name = what === 'job' ? 'The job' : 'The bake command';
  app.copied = { what, text };
  try {
    await navigator.clipboard.writeText(text);
    app.layout.toast(`${name} is on the clipboard`);
  } catch {
    showText(app.layout, name, text);
  }
}

/** Ask for a text to copy, or take it from the sea itself. */
export function askCopy(app, what) {
  if (app.connection) {
    app.sendOr({ copy: what });
    return;
  }
  const { about = {} } = app.embedded ?? {};
  const text = what === 'job' ? (app.sea?.document.job ?? about.job) : about.command;
  if (text) copy(app, what, text);
  else app.refuse(`this page carries no ${what === 'job' ? 'job' : 'bake command'}`);
}

/** Save the picture as a PNG. */
export async function screenshot(app) {
  const blob = await app.still();
  if (!blob) return;
  const address = URL.createObjectURL(blob);
  const name = `fftocean-${String(app.clock.tick)}.png`;
  element('a', { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10e3);
  app.layout.toast(`Saved ${name}`);
}
