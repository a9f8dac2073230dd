// Controls of the parameters: each has a label, a unit, its range and its keys.

import { element, uniqueId } from './dom.js';
import {
  groups,
  hasSlider,
  numberText,
  parsed,
  position,
  POSITIONS,
  rule,
  sentenceCase,
  stepped,
  valueAt,
  valueText,
} from './table.js';

/** Time after a change of the hand during which older values of the server are not shown [s]. */
const FRESH = 0.6;

/** Texts of keys that have no letter. */
const KEY_NAMES = { ' ': 'Space', ArrowLeft: '←', ArrowRight: '→', ArrowUp: '↑', ArrowDown: '↓' };

/** Return the text of a key as it stands on the keyboard. */
export function keyName(key) {
  return KEY_NAMES[key] ?? key.toUpperCase();
}

/** Return what the controls show: groups of rows with label, range text and keys. */
export function controlsModel(parameters) {
  return groups(parameters).map(({ title, rows }) => ({
    title,
    controls: rows.map((row) => ({
      row,
      label: row.label,
      unit: row.unit,
      range:
        row.kind === 'number'
          ? [numberText(row, row.low), row.infinite ? '∞' : numberText(row, row.high)]
          : null,
      slider: row.kind === 'number' && hasSlider(row),
      keys: [row.keyDown, row.keyUp].filter(Boolean).map(keyName),
    })),
  }));
}

/** All controls in a panel; `onChange(values)` hears of a change by hand. */
export class Controls {
  /** Build the groups of a table into a panel; groups named in `open` begin open. */
  constructor(panel, parameters, { onChange, open = [] }) {
    this.onChange = onChange;
    this.controls = new Map();
    this.sections = [];
    for (const { title, controls } of controlsModel(parameters)) {
      const body = element('div', { class: 'group-body' });
      for (const model of controls) {
        const control = makeControl(model, (value) => this.changed(model.row, value));
        this.controls.set(model.row.name, control);
        body.append(control.node);
      }
      const section = element(
        'details',
        { class: 'group', open: open.includes(title) },
        element('summary', { text: title }),
        body,
      );
      this.sections.push(section);
      panel.append(section);
    }
  }

  /** Hand a change by hand on, and remember when it was. */
  changed(row, value) {
    const control = this.controls.get(row.name);
    control.touched = performance.now() / 1000;
    control.fault('');
    this.onChange({ [row.name]: value });
  }

  /** Show values; a control that the hand has just moved keeps its own unless `force`. */
  show(values, { force = false } = {}) {
    const now = performance.now() / 1000;
    for (const [name, value] of Object.entries(values)) {
      const control = this.controls.get(name);
      if (!control) continue;
      if (!force && now - control.touched < FRESH) continue;
      control.show(value);
    }
  }

  /** Show at a control why its value was refused; return false where there is no such control. */
  refuse(name, message) {
    const control = this.controls.get(name);
    control?.fault(message);
    return Boolean(control);
  }

  /** Let only some controls be used, and hide the others with their empty groups. */
  keepOnly(names) {
    for (const [name, control] of this.controls) control.node.hidden = !names.has(name);
    for (const section of this.sections) {
      section.hidden = [...section.querySelectorAll('.control')].every((node) => node.hidden);
    }
  }
}

/** Return the control of a row: {node, show, fault, touched}. */
function makeControl(model, changed) {
  const makers = { number: numberControl, choice: choiceControl, switch: switchControl };
  return { touched: -Infinity, ...makers[model.row.kind](model, changed) };
}

/** Return the keys of a control as elements. */
function keyMarks(keys) {
  return element('span', { class: 'keys' }, ...keys.map((key) => element('kbd', { text: key })));
}

/** Return {node, fault} for the message under a control. */
function faultLine(field) {
  const id = uniqueId('fault');
  const node = element('p', { class: 'fault', id, hidden: true });
  const fault = (message) => {
    node.textContent = message;
    node.hidden = !message;
    if (message) {
      field.setAttribute('aria-invalid', 'true');
      field.setAttribute('aria-describedby', id);
    } else {
      field.removeAttribute('aria-invalid');
      field.removeAttribute('aria-describedby');
    }
  };
  return { node, fault };
}

/** Return a text field with a slider under it, or with a button for the next value. */
function numberControl(model, changed) {
  const { row, label, unit, keys } = model;
  const id = uniqueId('field');
  const labelId = uniqueId('label');
  const field = element('input', {
    id,
    type: 'text',
    inputmode: 'decimal',
    class: 'number',
    autocomplete: 'off',
    spellcheck: 'false',
    title: rule(row),
  });
  const { node: line, fault } = faultLine(field);
  const { node: extra, show: showExtra } = model.slider
    ? sliderLine(model, labelId, (value) => change(value))
    : nextButton(model, () => change(stepped(row, current, 1)));
  let current = row.default;
  const show = (value) => {
    current = value;
    showExtra(value);
    if (document.activeElement !== field) field.value = numberText(row, value);
  };
  const change = (value) => {
    fault('');
    show(value);
    changed(value);
  };
  const take = () => {
    const value = parsed(row, field.value);
    if (value !== undefined) {
      if (value !== current) change(value);
      return;
    }
    fault(`${label} must be ${rule(row)}, got ${field.value.trim() || 'nothing'}`);
  };
  field.addEventListener('change', take);
  field.addEventListener('blur', () => {
    if (!field.hasAttribute('aria-invalid')) field.value = numberText(row, current);
  });
  field.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') take();
    if (event.key !== 'Escape') return;
    fault('');
    field.value = numberText(row, current);
  });
  const node = element(
    'div',
    { class: 'control', title: sentenceCase(row.help) },
    element(
      'div',
      { class: 'control-head' },
      element('label', { for: id, id: labelId, text: label }),
      keyMarks(keys),
      element(
        'span',
        { class: 'value' },
        field,
        unit ? element('span', { class: 'unit', text: unit }) : null,
      ),
    ),
    extra,
    line,
  );
  return { node, show, fault };
}

/** Return {node, show} of a slider between the ends of its range. */
function sliderLine({ row, range }, labelId, changed) {
  const slider = element('input', {
    type: 'range',
    min: 0,
    max: POSITIONS,
    step: sliderStep(row),
    'aria-labelledby': labelId,
  });
  const show = (value) => {
    const place = position(row, value);
    slider.value = String(place);
    slider.style.setProperty('--share', String(place / POSITIONS));
    slider.setAttribute('aria-valuetext', valueText(row, value));
  };
  slider.addEventListener('input', () => changed(valueAt(row, Number(slider.value))));
  // After a drag the keys are the sea's again; whoever moves the slider by its keys keeps it.
  slider.addEventListener('pointerup', () => slider.blur());
  const node = element(
    'div',
    { class: 'slider-line' },
    element('span', { class: 'end', 'aria-hidden': 'true', text: range[0] }),
    slider,
    element('span', { class: 'end', 'aria-hidden': 'true', text: range[1] }),
  );
  return { node, show };
}

/** Return {node, show} of a button for the next value, where a slider has too many steps. */
function nextButton({ label, row }, next) {
  const node = element('button', {
    type: 'button',
    class: 'quiet',
    text: `Next ${label.toLowerCase()}`,
    title: `${rule(row)}`,
    on: { click: next },
  });
  return { node, show: () => {} };
}

/** Return the step of a slider in positions: one step of the table at least, for the arrows. */
function sliderStep(row) {
  if (row.logarithmic || !(row.step > 0)) return 1;
  const positions = (row.step / (row.high - row.low)) * POSITIONS;
  return positions >= 1 && Number.isInteger(positions) ? positions : 'any';
}

/** Names of choices that are no plain words. */
const CHOICE_LABELS = { fft: 'FFT', pms: 'PMS', cwr: 'CWR' };

/** Return the label of a choice. */
export function choiceLabel(value) {
  return CHOICE_LABELS[value] ?? sentenceCase(value);
}

/** Return a control whose field stands beside its label, with the line that says what is wrong. */
function oneLine({ row, label, keys }, field, fault) {
  return element(
    'div',
    { class: 'control', title: sentenceCase(row.help) },
    element(
      'div',
      { class: 'control-head' },
      element('label', { for: field.id, text: label }),
      keyMarks(keys),
      field,
    ),
    fault,
  );
}

/** Return a list of choices. */
function choiceControl(given, changed) {
  const id = uniqueId('field');
  const list = element(
    'select',
    { id },
    ...given.row.choices.map((one) => element('option', { value: one, text: choiceLabel(one) })),
  );
  const { node: line, fault } = faultLine(list);
  list.addEventListener('change', () => changed(list.value));
  const show = (value) => {
    list.value = value;
  };
  return { node: oneLine(given, list, line), show, fault };
}

/** Return a switch. */
function switchControl(given, changed) {
  const id = uniqueId('field');
  const box = element('input', { id, type: 'checkbox', role: 'switch' });
  const { node: line, fault } = faultLine(box);
  box.addEventListener('change', () => changed(box.checked));
  const show = (value) => {
    box.checked = Boolean(value);
  };
  return { node: oneLine(given, box, line), show, fault };
}

/** Return a list of presets by scale, or null where there are none. */
export function presetList(presets, onChoose) {
  if (!presets.length) return null;
  const id = uniqueId('field');
  const list = element('select', { id }, element('option', { value: '', text: 'Choose …' }));
  const scales = new Map();
  presets.forEach((preset, i) => {
    const scale = preset.scale ?? preset.group ?? 'Seas';
    if (!scales.has(scale)) scales.set(scale, element('optgroup', { label: scale }));
    scales.get(scale).append(element('option', { value: i, text: preset.label ?? preset.name }));
  });
  list.append(...scales.values());
  list.addEventListener('change', () => {
    if (list.value !== '') onChoose(presets[Number(list.value)]);
  });
  const node = element(
    'div',
    { class: 'control preset' },
    element('div', { class: 'control-head' }, element('label', { for: id, text: 'Preset' }), list),
  );
  return { node, clear: () => (list.value = '') };
}
