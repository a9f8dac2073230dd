// Short names in shaders: one for one, and only where a name is the shader's own.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { compact, piecesOf, shortened, shortNames, uniformsOf } from '../glsl.mjs';

const FOLDER = new URL('../src/shaders/', import.meta.url);
const SOURCES = readdirSync(FOLDER).map((name) => readFileSync(new URL(name, FOLDER), 'utf8'));
const NONE = { kept: new Set(), taken: new Set() };
const NAME = /\b[A-Za-z_]\w*\b/g;

/** Return the texts between the backquotes of a source. */
function templates(source) {
  const found = piecesOf(source).filter(({ kind }) => kind === 'template');
  return found.map(({ text }) => text).join(' ');
}

test('the pieces of a source are the source', () => {
  for (const source of SOURCES) {
    const joined = piecesOf(source).map(({ text }) => text);
    assert.equal(joined.join(''), source);
  }
  const kinds = piecesOf("a = `x ${b ? `y` : '`'} z`; // `").map(({ kind, text }) => [kind, text]);
  assert.deepEqual(kinds, [
    ['code', 'a = `'],
    ['template', 'x '],
    ['code', '${b ? `'],
    ['template', 'y'],
    ['code', '` : '],
    ['quoted', "'`'"],
    ['code', '}'],
    ['template', ' z'],
    ['code', '`; '],
    ['comment', '// `'],
  ]);
});

test('every name of all shaders has one short name of its own', () => {
  const table = shortNames(SOURCES, NONE);
  assert.ok(table.size > 300);
  const back = new Map([...table].map(([name, short]) => [short, name]));
  assert.equal(back.size, table.size);
  for (const source of SOURCES) {
    const before = templates(source.replaceAll('#version 300 es', ''));
    const names = compact(before).match(NAME) ?? [];
    for (const name of names) assert.ok(!back.has(name), name); // no short name was there before
    const short = shortened(source.replaceAll('#version 300 es', ''), table);
    const after = templates(short).match(NAME) ?? [];
    assert.deepEqual(
      after.map((name) => back.get(name) ?? name),
      names,
    );
  }
});

test('names that are kept, taken or quoted, and parts of vectors, are left alone', () => {
  const source =
    "const A = 'moved'; const B = `uniform vec3 sun; vec3 moved = sun.xyz * kept.rgb;`;";
  const table = shortNames([source], { kept: new Set(['kept']), taken: new Set(['a', 'b']) });
  assert.deepEqual([...table], [['sun', 'c']]);
  const other = shortened(source, table);
  assert.ok(other.endsWith('`uniform vec3 c;vec3 moved=c.xyz*kept.rgb;`;'), other);
});

test('words of the language that stand in many places are defined once, after the version', () => {
  const many = Array.from({ length: 40 }, (_, i) => `float f${i}0 = smoothstep(0.0, 1.0, 0.5);`);
  const source = `const A = \`#version 300 es\n${many.join(' ')}\`;`;
  const table = shortNames([source], NONE);
  const made = shortened(source, table);
  const short = table.get('smoothstep');
  assert.ok(made.startsWith('const A = `#version 300 es\n#define '), made.slice(0, 60));
  assert.equal(made.split(`#define ${short} smoothstep\n`).length, 2);
  assert.equal(made.split(`=${short}(0.,1.,.5);`).length, 41);
});

test('a substitution within a name is refused', () => {
  for (const text of ['`vec3 ${a}_map;`', '`vec3 map_${a};`']) {
    assert.throws(() => shortNames([`const A = ${text};`], NONE), /within a name/);
  }
});

test('uniforms are found, also in lists with sizes that are put in', () => {
  const source = 'const A = `uniform vec4 one[${n}], two; uniform sampler2D three; vec4 four;`;';
  assert.deepEqual([...uniformsOf([source])], ['one', 'two', 'three']);
});

test('spaces and zeros that mean nothing are left out, others are not', () => {
  assert.equal(compact('float a = 1.0 - -b; // one'), 'float a=1.- -b;');
  assert.equal(compact('x = 10.0 * 0.5 + 2.50 + 1.0e-6;'), 'x=10.*.5+2.50+1.e-6;');
  assert.equal(compact('a[2] - 1.25e-3 /* two */ + v.x0'), 'a[2]-1.25e-3+v.x0');
  assert.equal(
    compact('#version 300 es\nprecision highp float;\n'),
    '#version 300 es\nprecision highp float;',
  );
});
