// The parameter table of Python, as the page uses it: values, steps, slider positions, texts.

/** Positions of a slider from its lower to its upper end. */
export const POSITIONS = 1000;

/** Most steps of a range that gets a slider: more cannot be hit. */
const MOST_SLIDER_STEPS = 1e5;

/** Return a text that begins with a capital letter. */
export function sentenceCase(text) {
  return text.slice(0, 1).toUpperCase() + text.slice(1);
}

/** Units as they are printed. */
const PRINTED_UNITS = { '-': '', degrees: '°', 'mg/m^3': 'mg/m³' };

/** Length from which the upper end of a range in metres is printed in kilometres [m]. */
const LONG = 1e5;

/** Return the unit in which a row is printed, and how many of the row's own units it has. */
function printed({ unit = '', high }) {
  if (unit === 'm' && high >= LONG) return { unit: 'km', size: 1000 };
  return { unit: PRINTED_UNITS[unit] ?? unit, size: 1 };
}

/** Return one row of the table with every property present. */
function complete(row) {
  const kind = row.kind ?? (row.choices ? 'choice' : row.unit === undefined ? 'switch' : 'number');
  return Object.freeze({
    name: row.name,
    label: sentenceCase(row.label ?? row.name),
    ...printed(row),
    help: row.help ?? '',
    group: row.group ?? 'Other',
    low: row.low ?? 0,
    high: row.high ?? 1,
    step: row.step ?? 0,
    default: row.default ?? null,
    keyDown: row.key_down ?? null,
    keyUp: row.key_up ?? null,
    logarithmic: Boolean(row.logarithmic),
    local: Boolean(row.local),
    wraps: Boolean(row.wraps),
    whole: Boolean(row.whole),
    infinite: row.infinite ?? null,
    kind,
    choices: row.choices ? Object.freeze([...row.choices]) : null,
  });
}

/** Return {parameters, actions, presets} of the answer to /parameters.json. */
export function readTable(answer) {
  return {
    parameters: answer.parameters.map(complete),
    actions: answer.actions ?? [],
    presets: answer.presets ?? [],
  };
}

/** Return the table's default of every parameter. */
export function defaults(parameters) {
  return Object.fromEntries(parameters.map((row) => [row.name, row.default]));
}

/** Return true for a range that a slider can show. */
export function hasSlider(row) {
  return row.logarithmic || (row.high - row.low) / (row.step || 1) <= MOST_SLIDER_STEPS;
}

/** Return the decimals that a step needs. */
function decimals(step) {
  if (!(step > 0)) return 2;
  const [, fraction = ''] = String(step).split('.');
  return fraction.length;
}

/** Return a value on the grid of the row's step and inside its range. */
export function snapped(row, value) {
  if (row.logarithmic) {
    const bounded = Math.min(row.high, Math.max(row.low, value));
    return bounded === row.low || bounded === row.high ? bounded : Number(bounded.toPrecision(3));
  }
  let next = value;
  if (row.step > 0) next = row.low + Math.round((next - row.low) / row.step) * row.step;
  next = Math.min(row.high, Math.max(row.low, next));
  return Number(next.toFixed(decimals(row.step)));
}

/** Return a value of a ring that starts again after its end. */
function wrapped(row, value) {
  // The two ends of an angle are the same place; those of a number of tiles are not.
  const turn = row.whole ? row.high - row.low + row.step : row.high - row.low;
  return row.low + ((((value - row.low) % turn) + turn) % turn);
}

/** Return the value one step of a key away. */
export function stepped(row, value, direction) {
  if (row.kind === 'switch') return !value;
  if (row.kind === 'choice') {
    const count = row.choices.length;
    const next = row.choices.indexOf(value) + direction;
    const bounded = row.wraps ? (next + count) % count : Math.min(count - 1, Math.max(0, next));
    return row.choices[bounded];
  }
  if (row.infinite && value === null) return direction < 0 ? row.high : null;
  if (row.logarithmic) {
    if (row.infinite && direction > 0 && value >= row.high) return null;
    return snapped(row, value * row.step ** direction);
  }
  const next = value + direction * (row.step || (row.high - row.low) / 100);
  const beyond = next > row.high + 1e-9 || next < row.low - 1e-9;
  return snapped(row, row.wraps && beyond ? wrapped(row, next) : next);
}

/** Return the slider position (0 to POSITIONS) of a value; an infinite one is the upper end. */
export function position(row, value) {
  if (value === null) return POSITIONS;
  const bounded = Math.min(row.high, Math.max(row.low, Number(value)));
  const share = row.logarithmic
    ? Math.log(bounded / row.low) / Math.log(row.high / row.low)
    : (bounded - row.low) / (row.high - row.low);
  const place = share * POSITIONS;
  return row.infinite ? Math.min(POSITIONS - 1, Math.round(place)) : Math.round(place);
}

/** Return the value at a slider position. */
export function valueAt(row, place) {
  if (row.infinite && place >= POSITIONS) return null;
  const share = place / POSITIONS;
  const value = row.logarithmic
    ? row.low * (row.high / row.low) ** share
    : row.low + share * (row.high - row.low);
  return snapped(row, value);
}

/** Return a number as text, without trailing zeros, with the decimals of the row's step. */
export function numberText(row, value) {
  if (value === null) return row.infinite ? '∞' : '';
  if (value === undefined) return '';
  const shown = Number(value) / row.size;
  if (row.logarithmic) return String(Number(shown.toPrecision(3)));
  return String(Number(shown.toFixed(Math.max(2, decimals(row.step)))));
}

/** Return a number with its unit; a sign of degrees follows without a space. */
function withUnit(text, unit) {
  if (!unit) return text;
  return unit === '°' ? `${text}°` : `${text} ${unit}`;
}

/** Return a value as text with its unit. */
export function valueText(row, value) {
  if (row.kind === 'choice') return String(value);
  if (row.kind === 'switch') return value ? 'on' : 'off';
  if (row.infinite && value === null) return row.infinite;
  return withUnit(numberText(row, value), row.unit);
}

/** Return the value that a text field holds, or undefined where it is none of the row's. */
export function parsed(row, text) {
  const given = text.trim().toLowerCase();
  if (row.infinite && ['∞', 'inf', 'infinity', 'deep', row.infinite].includes(given)) return null;
  const value = Number(given.replace(',', '.').replace('\u2212', '-')) * row.size;
  if (given === '' || !Number.isFinite(value)) return undefined;
  if (value < row.low || value > row.high) return undefined;
  if (row.whole && !Number.isInteger(value)) return undefined;
  return value;
}

/** Return the rule that a value of a row must meet, in words. */
export function rule(row) {
  const number = row.whole ? 'a whole number from ' : '';
  const range = `${numberText(row, row.low)} to ${valueText(row, row.high)}`;
  return `${number}${range}${row.infinite ? ', or deep' : ''}`;
}

/** Return [{title, rows}] of the table, in the order in which the groups first appear. */
export function groups(parameters) {
  const found = new Map();
  for (const row of parameters) {
    if (!found.has(row.group)) found.set(row.group, []);
    found.get(row.group).push(row);
  }
  return [...found].map(([title, rows]) => ({ title, rows }));
}
