// GLSL inside the sources of the page: comments and spaces are left out, and names become short.
//
// In the modules of src/shaders every text between backquotes is GLSL, and no other text is. All
// shaders share one table of names, in which no two names become one: whatever a name means in one
// place or another, it still means the same there. Names of the language, of its functions and of
// parts of vectors stay, and so does each name that stands in a quoted text of those modules.

const LANGUAGE = new Set(
  `attribute const uniform varying layout location centroid flat smooth break continue do for while
  switch case default if else in out inout float int uint void bool true false invariant discard
  return precision highp mediump lowp struct sampler2D sampler3D samplerCube sampler2DArray isampler2D
  usampler2D version es main define ifdef endif
  radians degrees sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh pow exp log exp2 log2
  sqrt inversesqrt abs sign floor trunc round roundEven ceil fract mod modf min max clamp mix step
  smoothstep isnan isinf floatBitsToInt floatBitsToUint intBitsToFloat uintBitsToFloat packSnorm2x16
  unpackSnorm2x16 packUnorm2x16 unpackUnorm2x16 packHalf2x16 unpackHalf2x16 length distance dot cross
  normalize faceforward reflect refract matrixCompMult outerProduct transpose determinant inverse
  lessThan lessThanEqual greaterThan greaterThanEqual equal notEqual any all not textureSize texture
  textureProj textureLod textureOffset texelFetch texelFetchOffset textureProjOffset textureLodOffset
  textureProjLod textureProjLodOffset textureGrad textureGradOffset textureProjGrad
  textureProjGradOffset dFdx dFdy fwidth`.split(/\s+/),
);
const TYPE = /^(?:[iub]?vec[234]|mat[234](?:x[234])?|gl_\w+)$/;
const PARTS = /^(?:[xyzw]{1,4}|[rgba]{1,4}|[stpq]{1,4})$/;
const NAME = /\b[A-Za-z_]\w*\b/g;

/**
 * Return a JavaScript source in pieces: {kind, text} of kind 'code', 'quoted', 'template' (text
 * between backquotes, up to a substitution or after it) or 'comment'. Joined they are the source.
 */
export function piecesOf(source) {
  const pieces = [];
  const depths = []; // of braces, in each template that is open
  let at = 0;
  let start = 0;
  const close = (kind, end) => {
    if (end > start) pieces.push({ kind, text: source.slice(start, end) });
    start = at = end;
  };
  /** Read a template from `at` up to its end or to a substitution. */
  const template = () => {
    while (source[at] !== '`' && !source.startsWith('${', at)) {
      if (at >= source.length) throw new Error('a text between backquotes does not end');
      at += source[at] === '\\' ? 2 : 1;
    }
    close('template', at);
    if (source[at] === '`') at += 1;
    else {
      at += 2;
      depths.push(0);
    }
  };
  while (at < source.length) {
    const two = source.slice(at, at + 2);
    const letter = source[at];
    if (two === '//' || two === '/*') {
      close('code', at);
      const end = two === '//' ? source.indexOf('\n', at) : source.indexOf('*/', at) + 2;
      close('comment', end < 2 ? source.length : end);
    } else if (letter === "'" || letter === '"') {
      close('code', at);
      at += 1;
      while (source[at] !== letter) at += source[at] === '\\' ? 2 : 1;
      close('quoted', at + 1);
    } else if (letter === '`') {
      close('code', at + 1);
      template();
    } else if (depths.length && letter === '}' && depths.at(-1) === 0) {
      depths.pop();
      close('code', at + 1);
      template();
    } else {
      if (depths.length && letter === '{') depths[depths.length - 1] += 1;
      if (depths.length && letter === '}') depths[depths.length - 1] -= 1;
      at += 1;
    }
  }
  close('code', at);
  return pieces;
}

/** Return the names of a piece of GLSL that shaders choose themselves. */
function ownNames(text) {
  return [...text.matchAll(NAME)].filter(({ 0: name }) => {
    if (LANGUAGE.has(name) || TYPE.test(name)) return false;
    return !PARTS.test(name);
  });
}

/** Return GLSL without comments, and without the spaces that nothing needs. */
export function compact(text) {
  return text
    .replace(/\/\*[^]*?\*\//g, '')
    .replace(/\/\/[^\n]*/g, '')
    .replace(/[ \t]+/g, ' ')
    .replace(/ *\n[ \n]*/g, '\n')
    .replace(/ ?([=*/<>,;{}?:()[\]|&]) ?/g, '$1')
    .replace(/([;{},=*/<>(&|?:])\n/g, '$1')
    .replace(/(?<=[\w)\]]) (?=[-+] )|(?<=[\w)\]] ?[-+]) (?=[\w(.])/g, '')
    .replace(/(?<=\d\.)0+(?!\d)/g, '')
    .replace(/(?<![\w.])0(?=\.\d)/g, '');
}

/** Return the pieces of a module of shaders, its GLSL compact. */
function compactPieces(source) {
  return piecesOf(source).map((piece) =>
    piece.kind === 'template' ? { ...piece, text: compact(piece.text) } : piece,
  );
}

/**
 * Return the uniforms that modules of shaders declare.
 *
 * @param {string[]} sources of the modules
 */
export function uniformsOf(sources) {
  const found = new Set();
  for (const source of sources) {
    const templates = compactPieces(source).filter(({ kind }) => kind === 'template');
    const text = templates.map((piece) => piece.text).join('0'); // a size may be put in between
    for (const [, list] of text.matchAll(/\buniform \w+ ([^;]+)/g)) {
      for (const [name] of list.matchAll(/(?<=^|,)[A-Za-z_]\w*/g)) found.add(name);
    }
  }
  return found;
}

/**
 * Return the table of short names for the GLSL of some modules.
 *
 * @param {string[]} sources of the modules
 * @param {object} options
 * @param {Set<string>} options.kept names that stay as they are
 * @param {Set<string>} options.taken names that no name may become
 * @returns {Map<string, string>}
 */
export function shortNames(sources, { kept, taken }) {
  const counts = new Map();
  const quoted = new Set();
  for (const source of sources) {
    const pieces = compactPieces(source);
    pieces.forEach(({ kind, text }, i) => {
      if (kind === 'quoted') for (const [name] of text.matchAll(NAME)) quoted.add(name);
      if (kind !== 'template') return;
      const begun = pieces[i - 1].text.endsWith('}');
      const goesOn = pieces[i + 1]?.text.startsWith('${');
      if ((begun && /^\w/.test(text)) || (goesOn && /[A-Za-z_]\w*$/.test(text))) {
        throw new Error(`a substitution must not stand within a name: ${text.slice(0, 60)}`);
      }
      for (const [name] of ownNames(text)) counts.set(name, (counts.get(name) ?? 0) + 1);
    });
  }
  const renamed = [...counts.keys()]
    .filter((name) => name.length > 1 && !kept.has(name) && !quoted.has(name))
    .sort((a, b) => counts.get(b) - counts.get(a) || (a < b ? -1 : 1));
  const used = new Set([...counts.keys(), ...taken, ...LANGUAGE]);
  const table = new Map();
  let number = 0;
  for (const name of renamed) {
    let short;
    do short = numbered(number++);
    while (used.has(short) || PARTS.test(short) || TYPE.test(short));
    if (short.length < name.length) table.set(name, short);
  }
  // A word of the language that stands in many places is defined at the head of every shader.
  const words = new Map();
  for (const source of sources) {
    for (const { kind, text } of compactPieces(source)) {
      if (kind !== 'template') continue;
      for (const [name] of text.matchAll(NAME)) {
        if (DEFINED.test(name)) words.set(name, (words.get(name) ?? 0) + 1);
      }
    }
  }
  const definitions = [];
  for (const [word, count] of [...words].sort(([a], [b]) => (a < b ? -1 : 1))) {
    let short;
    do short = numbered(number++);
    while (used.has(short) || PARTS.test(short) || TYPE.test(short));
    const saved = count * (word.length - short.length) - `#define ${short} ${word}\n`.length;
    if (saved < 20) continue;
    table.set(word, short);
    definitions.push(`#define ${short} ${word}\n`);
  }
  table.definitions = definitions.join('');
  return table;
}

// Types, functions and the like: what a macro may stand for wherever it is.
const DEFINED =
  /^(?:float|uniform|return|const|sampler2D|[iu]?vec[234]|mat[234]|texture\w*|texelFetch|smoothstep|normalize|clamp|fract|inversesqrt|float|length|gl_FragCoord)$/;

const LETTERS = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ';

/** Return the name of a number: a, b, ..., Z, aa, ab, ... */
function numbered(number) {
  const rest = Math.floor(number / LETTERS.length);
  return (rest ? numbered(rest - 1) : '') + LETTERS[number % LETTERS.length];
}

/** Return the source of a module of shaders with its GLSL compact and its names short. */
export function shortened(source, table) {
  return compactPieces(source)
    .map(({ kind, text }) => {
      if (kind === 'comment') return text.startsWith('//') ? '' : ' ';
      if (kind !== 'template') return text;
      const short = text.replace(NAME, (name) => table.get(name) ?? name);
      return short.replace('#version 300 es\n', `$&${table.definitions}`);
    })
    .join('');
}
