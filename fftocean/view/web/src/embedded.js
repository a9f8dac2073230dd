// A sea that a page carries in itself: there is no server.

import { decodeSea } from './container.js';

/** The sea of a page that is one file, or of a notebook's widget. */
export class EmbeddedSea {
  /** Keep the bytes of the container, and what is said about the sea. */
  constructor(bytes, about) {
    this.bytes = bytes;
    this.about = about;
  }

  /** Show the sea in a view. */
  async show(view) {
    const sea = decodeSea(this.bytes);
    view.source = this.about.source ?? '';
    view.served = { choppiness: sea.document.choppiness };
    view.values.choppiness = sea.document.choppiness ?? view.values.choppiness;
    view.showStatus({ phase: 'embedded' });
    await view.showSea(sea);
  }
}
