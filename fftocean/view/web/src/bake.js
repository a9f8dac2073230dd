// A bake in the place of a sea.

import { keepOwnControls } from './own.js';

export { Playback } from './playback.js';

/** Play the maps of a bake in an app. */
export async function takeBake(app, manifest, source) {
  app.bake = manifest;
  app.sea = null;
  app.source = source;
  app.clock.follow(manifest);
  if (app.controls) keepOwnControls(app);
  app.showFigures();
  if (app.stage.playback) return; // after a reconnection the same bake goes on
  const ask = (tile, frame) => {
    app.connection.send({ frame: { tile, frame } });
  };
  await app.stage.setBake(manifest, ask);
  app.changed();
}
