// The elements of the page around the picture: line of figures, panels, tool bar, messages, dialogs.

import { element, icon, uniqueId } from './dom.js';
import { keyName } from './controls.js';

const ICONS = {
  pause: 'M9 5v14M15 5v14',
  play: 'M8 5l11 7-11 7z',
  view: 'M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12zM12 9a3 3 0 1 0 0 6 3 3 0 0 0 0-6z',
  few_waves:
    'M2 9c2.5 0 2.5-3 5-3s2.5 3 5 3 2.5-3 5-3 2.5 3 5 3M2 17c2.5 0 2.5-3 5-3s2.5 3 5 3 2.5-3 5-3 2.5 3 5 3',
  screenshot: 'M4 8h3l2-3h6l2 3h3v11H4zM12 10a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7z',
  controls: 'M4 7h9M17 7h3M4 17h3M11 17h9M15 5v4M9 15v4',
  help: 'M9 9.2a3 3 0 1 1 4.6 2.6c-1 .7-1.6 1.2-1.6 2.5M12 17.6v.4M12 2.5a9.5 9.5 0 1 0 0 19 9.5 9.5 0 0 0 0-19z',
};

/** Return a button with a drawing, a name and its key. */
function toolButton(name, label, key, click, attributes = {}) {
  const hint = key ? `${label} (${keyName(key)})` : label;
  return element(
    'button',
    {
      type: 'button',
      class: `tool tool-${name}`,
      'aria-label': label,
      'aria-keyshortcuts': key === ' ' ? 'Space' : key,
      'data-hint': hint,
      on: { click },
      ...attributes,
    },
    icon(ICONS[name]),
  );
}

/** Return a button with its text and its key. */
function textButton(label, key, click) {
  return element(
    'button',
    { type: 'button', class: 'action', 'aria-keyshortcuts': key, on: { click } },
    element('span', { text: label }),
    key ? element('kbd', { text: keyName(key) }) : null,
  );
}

/** Build the page into `root`; `act(name)` does the action of a button. */
export class Layout {
  /** Build all parts; `canvas` is put behind them. Dialogs are built when they are needed. */
  constructor(root, { canvas, act, title = 'fftocean' }) {
    this.root = root;
    this.act = act;
    root.classList.add('fftocean');
    const figuresId = uniqueId('figures');
    const controlsId = uniqueId('controls');
    this.chip = element('button', {
      type: 'button',
      class: 'chip',
      'aria-expanded': 'false',
      'aria-controls': figuresId,
      'aria-label': 'Figures of the sea',
      on: { click: () => this.toggle('figures') },
    });
    this.figures = element('section', {
      id: figuresId,
      class: 'panel figures',
      'aria-label': 'Figures of the sea',
      tabindex: '-1',
      hidden: true,
    });
    this.actions = element('div', { class: 'actions' });
    this.controls = element('section', {
      id: controlsId,
      class: 'panel controls',
      'aria-label': 'Controls',
      tabindex: '-1',
      hidden: true,
    });
    this.pauseButton = toolButton('pause', 'Pause', ' ', () => act('pause'));
    this.viewButton = toolButton('view', 'Next view', 'v', () => act('view'));
    this.fewButton = toolButton('few_waves', 'Few-wave models', 'g', () => act('few_waves'));
    this.controlsButton = toolButton('controls', 'Controls', '', () => this.toggle('controls'), {
      'aria-expanded': 'false',
      'aria-controls': controlsId,
    });
    this.bar = element(
      'div',
      { class: 'bar', role: 'toolbar', 'aria-label': 'Tools' },
      this.pauseButton,
      this.viewButton,
      this.fewButton,
      toolButton('screenshot', 'Save a screenshot', 'x', () => act('screenshot')),
      this.controlsButton,
      toolButton('help', 'Keys', '?', () => act('help')),
    );
    this.viewLabel = element('p', { class: 'view-label', 'aria-hidden': 'true' });
    this.split = ['left', 'right'].map((side) => element('p', { class: `half ${side}` }));
    this.halves = element('div', { class: 'halves', hidden: true }, ...this.split);
    this.spoken = element('p', { class: 'spoken', role: 'status', 'aria-live': 'polite' });
    this.toasts = element('div', { class: 'toasts' });
    this.banner = element('div', { class: 'banner', role: 'alert', hidden: true });
    this.dropHint = element('div', { class: 'drop-hint', 'aria-hidden': 'true', hidden: true });
    this.dropHint.append(element('p', { text: 'Drop a job or a buoy file' }));
    this.canvas = canvas;
    root.prepend(canvas);
    root.append(
      element('h1', { class: 'spoken', text: title }),
      element(
        'div',
        { class: 'frame' },
        element('div', { class: 'top' }, this.chip, this.figures),
        this.controls,
        element('div', { class: 'bottom' }, this.viewLabel, this.halves, this.bar),
      ),
      this.toasts,
      this.banner,
      this.dropHint,
      this.spoken,
    );
  }

  /** Return true where there is width for two panels beside the sea. */
  get wide() {
    const size = Number.parseFloat(getComputedStyle(this.root).fontSize);
    return this.root.clientWidth >= 56 * size;
  }

  /** Open or close a panel; where there is no width for both, the other one closes. */
  toggle(name, open = this[name].hidden) {
    const buttons = { figures: this.chip, controls: this.controlsButton };
    if (open && !this.wide) {
      for (const other of Object.keys(buttons)) if (other !== name) this.toggle(other, false);
    }
    this[name].hidden = !open;
    buttons[name].setAttribute('aria-expanded', String(open));
    this.root.classList.toggle(`with-${name}`, open);
    this.onToggle?.(name, open);
  }

  /** Close a panel; the focus goes back to the sea where the panel had it. */
  close(name) {
    if (this[name].contains(document.activeElement)) this.canvas.focus();
    this.toggle(name, false);
  }

  /** Add a button to the actions. */
  addAction(label, key, click) {
    const button = textButton(label, key, click);
    this.actions.append(button);
    return button;
  }

  /** Show time running or standing still. */
  showPaused(paused) {
    this.pauseButton.replaceChildren(icon(paused ? ICONS.play : ICONS.pause));
    const label = paused ? 'Go on' : 'Pause';
    this.pauseButton.setAttribute('aria-label', label);
    this.pauseButton.dataset.hint = `${label} (Space)`;
    this.pauseButton.setAttribute('aria-pressed', String(paused));
  }

  /** Name the view where it is not the sea itself. */
  showView(text) {
    this.viewLabel.textContent = text;
    this.viewLabel.hidden = !text;
  }

  /** Name the halves of a picture in two parts; null for a whole one. */
  showSplit(names) {
    this.root.classList.toggle('split', Boolean(names));
    this.halves.hidden = !names;
    this.split.forEach((node, i) => {
      if (names && node.textContent !== names[i]) node.textContent = names[i];
    });
  }

  /** Show a message for a while; `kind` is "note" or "refusal". */
  toast(message, kind = 'note') {
    for (const old of [...this.toasts.children]) if (old.textContent === message) old.remove();
    while (this.toasts.children.length > 2) this.toasts.firstChild.remove();
    const node = element('p', {
      class: `toast ${kind}`,
      role: kind === 'refusal' ? 'alert' : 'status',
      text: message,
    });
    this.toasts.append(node);
    const time = kind === 'refusal' ? 12 : 5;
    setTimeout(() => node.remove(), 1000 * time);
    return node;
  }

  /** Show a sentence that stays, over the picture; an empty one removes it. */
  showBanner(text) {
    this.banner.replaceChildren(...(text ? [element('p', { text })] : []));
    this.banner.hidden = !text;
  }

  /** Remove all parts. */
  dispose() {
    this.root.replaceChildren();
  }
}
