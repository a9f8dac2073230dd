// The page held against the library: by fields that the server sends, by points that a file carries.

import { decodeReference, FIELDS } from './container.js';
import { judged, LIMITS, relativeError, verifyTile, whyNotExact } from './verify.js';

/** Time without an answer after which a verification is given up [s]. */
const PATIENCE = 60;

/** Compare the fields of a page with those of the library. */
export async function verify(app) {
  const { stage } = app;
  if (app.verifying) return;
  if (!stage.simulation) {
    app.refuse('there is no sea to verify: a bake is played, or no picture can be drawn');
    return;
  }
  if (!app.connection) {
    await checkItself(app);
    app.panel.revealVerification();
    return;
  }
  const why = exactSea(stage.simulation, app.busy);
  if (why) {
    app.refuse(`verify once the sea is exact: ${why}`);
    return;
  }
  const { tick } = app.clock;
  await new Promise((resolve) => {
    app.verifying = { tick, answers: [], end: resolve, tiles: stage.simulation.tiles.length };
    app.verifyButton.disabled = true;
    const end = () => app.endVerifying(`no answer within ${PATIENCE} s`);
    app.verifying.timer = setTimeout(end, 1000 * PATIENCE);
    if (!app.sendOr({ verify: { tick, sea: app.sea.document.id } })) app.endVerifying('');
  });
}

/** Take the fields of one tile, and compare them with those of the page at the same tick. */
export async function takeReference(app, data) {
  const { verifying } = app;
  if (!verifying) return;
  try {
    const reference = decodeReference(data);
    const { simulation } = app.stage;
    const compare = () => compareReference(simulation, reference, app.values.choppiness);
    verifying.answers.push(await app.alone(compare));
    app.changed();
  } catch (error) {
    app.endVerifying(error.message);
    return;
  }
  if (app.verifying !== verifying || verifying.answers.length < verifying.tiles) return;
  await showVerdict(app, verifying.answers, `at tick ${verifying.tick}, against the library`);
  app.endVerifying('');
}

/** Compare a page with the points that its file carries. */
export async function checkItself(app) {
  const check = new SelfCheck(app.sea);
  if (!check.possible) {
    app.refuse('this page carries no reference points');
    return;
  }
  const { simulation } = app.stage;
  try {
    const answers = await app.alone(() => check.run(simulation, app.values.choppiness));
    await showVerdict(app, answers, `at ${check.points} points that the file carries`);
  } catch (error) {
    app.refuse(`not verified: ${error.message}`);
  }
  app.changed();
}

/** Show errors with a verdict. */
async function showVerdict(app, answers, against) {
  const passed = answers.every((answer) => answer.passed);
  const worst = Math.max(...answers.map((answer) => answer.worst));
  const verdict = passed ? 'Verified' : 'Not the same';
  const title = `${verdict} ${against}: largest relative error ${worst.toExponential(1)}`;
  const rows = answers.flatMap(({ tile, errors, limit }) =>
    Object.entries(errors).map(([field, error]) => ({ tile, field, error, limit })),
  );
  await app.showPanel();
  app.panel.showVerification({ title, rows });
  app.verdict = { passed, worst, rows };
  app.layout.toast(title, passed ? 'note' : 'refusal');
  if (app.layout.wide && !app.embedded) {
    app.layout.toggle('figures', true);
    app.panel.revealVerification();
  }
}

/** Return why the sea that is shown cannot be verified now, or ''. */
export function exactSea(simulation, busy) {
  if (busy) return 'a sea is being made';
  return whyNotExact(simulation);
}

/** Bring a simulation to the tick of a reference answer, and compare that tile. */
export async function compareReference(simulation, reference, choppiness) {
  await simulation.step(reference.header.tick, choppiness);
  return verifyTile(simulation, reference);
}

/** The reference points that a package carries (check.json). */
export class SelfCheck {
  /** Take the reference of a decoded sea. */
  constructor({ reference }) {
    this.reference = reference;
  }

  /** True where there are points. */
  get possible() {
    return Boolean(this.reference?.tiles?.length);
  }

  /** The number of points, of all tiles at all moments. */
  get points() {
    const { moments, tiles } = this.reference;
    return moments.length * tiles.reduce((sum, { columns }) => sum + columns.length, 0);
  }

  /** Return, for each tile, the relative errors of its fields at all points and moments. */
  async run(simulation, choppiness) {
    const why = whyNotExact(simulation);
    if (why) throw new Error(`nothing to verify: ${why}`);
    const { moments, tiles } = this.reference;
    const computed = tiles.map(() => Object.fromEntries(FIELDS.map((name) => [name, []])));
    for (const tick of moments) {
      await simulation.step(tick, choppiness);
      for (const [i, { columns, rows }] of tiles.entries()) {
        const fields = await simulation.readFields(i);
        const { nx } = simulation.tiles[i];
        for (const name of FIELDS) {
          columns.forEach((column, p) =>
            computed[i][name].push(fields[name][rows[p] * nx + column]),
          );
        }
      }
    }
    return tiles.map(({ fields }, tile) => {
      const errors = {};
      for (const name of FIELDS) {
        errors[name] = relativeError(computed[tile][name], fields[name].flat());
      }
      return { tile, ...judged(errors, LIMITS[simulation.kind]) };
    });
  }
}
