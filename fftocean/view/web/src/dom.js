// Elements without innerHTML: every text from a file or from the server is set as text.

let made = 0;

/** Return a name for an element's id that no other element of the document has. */
export function uniqueId(stem) {
  made += 1;
  return `fftocean-${stem}-${made}`;
}

/**
 * Return a new element.
 * `properties`: `text` sets its text, `on` its listeners, `class` its classes; the others are
 * attributes, left out where they are null, undefined or false.
 */
export function element(tag, properties = {}, ...children) {
  const node = document.createElement(tag);
  const { text, on = {}, ...attributes } = properties;
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    node.setAttribute(name, value === true ? '' : String(value));
  }
  if (text !== undefined) node.textContent = text;
  for (const [name, listener] of Object.entries(on)) node.addEventListener(name, listener);
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

const SVG = 'http://www.w3.org/2000/svg';

/** Return a line drawing of 24 x 24 units from the path data, hidden from screen readers. */
export function icon(path) {
  const svg = document.createElementNS(SVG, 'svg');
  const line = document.createElementNS(SVG, 'path');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  svg.setAttribute('class', 'icon');
  line.setAttribute('d', path);
  svg.append(line);
  return svg;
}
