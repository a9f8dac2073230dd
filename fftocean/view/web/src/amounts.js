// Numbers as text.

/** Return a number with thin spaces between thousands. */
export function grouped(value) {
  return String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, '\u2009');
}

/** Return a number of waves as text. */
export function wavesText(count) {
  return `${grouped(count)} ${count === 1 ? 'wave' : 'waves'}`;
}
