// A page whose sea is made already: one file, a notebook, or a bake that is played.

/** Parameters of the server that a page without one can change itself. */
const OWN_CHANGES = new Set(['choppiness']);

/** Group of the light of few waves, which a page without a server does not have. */
const FEW_GROUP = /^few-wave/i;

/** Parameters that only a bake has. */
export const BAKE_ONLY = new Set(['blend_frames']);

/** Let a page change only what needs no server that makes seas, and hide the rest. */
export function keepOwnControls(app) {
  const changes = app.bake ? new Set() : OWN_CHANGES; // a bake has its choppiness in it
  const local = ({ name, group }) =>
    !FEW_GROUP.test(group) && (Boolean(app.bake) || !BAKE_ONLY.has(name));
  const own = (row) => (row.local && local(row)) || changes.has(row.name);
  app.own = new Set(app.table.parameters.filter(own).map((row) => row.name));
  app.controls.keepOnly(app.own);
  app.layout.fewButton.hidden = true;
  for (const node of [app.presets?.node, app.openButton]) if (node) node.hidden = true;
  if (app.bake) for (const one of [app.verifyButton, ...app.copyButtons]) one.hidden = true;
}
