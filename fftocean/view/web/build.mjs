// Bundle the sources into ../page, which is what Python serves and what the wheel holds.
// `npm run build` writes it; `npm run build -- --check` fails if it differs from the sources.
//
// core.js holds all that the served page needs for the first picture of the sea. The three entries
// (page.js for a server, static.js for one file, widget.js for notebooks) and the parts, which are
// loaded when they are wanted, import it. Python puts files together where a page must be one file,
// see one_file.py: it relies on imports at the beginning of a file and exports at its end.
import { readFile, writeFile, mkdir, readdir, rm } from 'node:fs/promises';
import { existsSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { build } from 'esbuild';
import { shortened, shortNames, uniformsOf } from './glsl.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const sources = path.join(here, 'src');
const target = path.join(here, '..', 'page');

const ENTRIES = ['page.js', 'static.js', 'widget.js'];

/** Return the JSON of a file beside this one. */
async function json(name) {
  return JSON.parse(await readFile(path.join(here, name), 'utf8'));
}

/** Return all sources by their paths. */
async function readSources() {
  const names = (await readdir(sources, { recursive: true })).filter((one) => one.endsWith('.js'));
  const texts = await Promise.all(
    names.sort().map(async (name) => {
      const file = path.join(sources, name);
      return [file, await readFile(file, 'utf8')];
    }),
  );
  return new Map(texts);
}

/** Return the imports of a source: {file, names}. */
function importsOf(file, text) {
  const found = text.matchAll(/^(?:im|ex)port \{([^}]*)\} from '(\.[^']+)';$/gm);
  return [...found].map(([, list, from]) => ({
    file: path.resolve(path.dirname(file), from),
    names: list
      .split(',')
      .map((name) => name.trim().split(/\s+as\s+/)[0])
      .filter(Boolean),
  }));
}

/** Return the files that a source imports, and those that they import, without itself. */
function reachedFrom(file, texts) {
  const reached = new Set();
  const visit = (one) => {
    for (const { file: next } of importsOf(one, texts.get(one))) {
      if (reached.has(next)) continue;
      reached.add(next);
      visit(next);
    }
  };
  visit(file);
  return reached;
}

/** Return the files of the page by name, as texts. */
export async function bundle() {
  const texts = await readSources();
  const inSources = (name) => path.join(sources, name);
  const core = reachedFrom(inSources('page.js'), texts);
  const parts = [...texts.get(inSources('parts.js')).matchAll(/import\('\.\/(\w+\.js)'\)/g)];
  const outside = [...ENTRIES, ...parts.map(([, name]) => name)];

  // What files outside the core take of it, each under a short name.
  const exported = new Map();
  for (const name of outside) {
    const file = inSources(name);
    const own = [file, ...reachedFrom(file, texts)].filter((one) => !core.has(one));
    for (const one of own) {
      for (const { file: from, names } of importsOf(one, texts.get(one))) {
        if (core.has(from)) for (const each of names) exported.set(`${from} ${each}`, '');
      }
    }
  }
  const keys = [...exported.keys()].sort();
  keys.forEach((key, i) => exported.set(key, `e${i.toString(36)}`));
  const exportsOf = (file) =>
    keys
      .filter((key) => key.startsWith(`${file} `))
      .map((key) => ({ name: key.split(' ').at(-1), short: exported.get(key) }));

  // Names of shaders and of properties become short; see short_names.json for the second.
  const { properties } = await json('short_names.json');
  checkProperties(properties, texts, parts);
  const constants = await json('gl_constants.json');
  const shaders = [...texts].filter(([file]) => file.includes(`${path.sep}shaders${path.sep}`));
  const shaderTexts = shaders.map(([, text]) => text);
  const uniforms = uniformsOf(shaderTexts);
  const short = new Set(properties);
  const known = new Set();
  for (const text of texts.values()) {
    for (const [name] of text.matchAll(/\b[a-zA-Z]\w?\b/g)) known.add(name);
  }
  const table = shortNames(shaderTexts, {
    kept: new Set([...uniforms].filter((name) => !short.has(name))),
    taken: known,
  });
  let mangleCache = {};
  for (const name of [...uniforms].sort()) if (table.has(name)) mangleCache[name] = table.get(name);

  const plugin = {
    name: 'page',
    setup(bundler) {
      const inCore = bundler.initialOptions.entryPoints === undefined;
      bundler.onResolve({ filter: /^\.\/core\.js$/ }, () => ({
        path: './core.js',
        external: true,
      }));
      bundler.onResolve({ filter: /^\./ }, ({ path: name, kind, resolveDir }) => {
        if (kind === 'dynamic-import') return { path: name, external: true };
        const file = path.resolve(resolveDir, name);
        if (inCore || kind === 'entry-point' || !core.has(file)) return { path: file };
        return { path: file, namespace: 'core' };
      });
      bundler.onLoad({ filter: /./, namespace: 'core' }, ({ path: file }) => {
        const names = exportsOf(file).map(({ name, short: from }) => `${from} as ${name}`);
        return {
          contents: `export { ${names.join(', ')} } from './core.js';`,
          resolveDir: sources,
        };
      });
      bundler.onLoad({ filter: /\.js$/ }, ({ path: file }) => {
        const text = texts.get(file);
        if (!text) return undefined;
        const contents = shaderTexts.includes(text) ? shortened(text, table) : text;
        return {
          contents: contents.replace(/\b(?:this\.)?gl\.([A-Z][A-Z0-9_]*)\b/g, constant),
          loader: 'js',
        };
      });
    },
  };
  const constant = (_, name) => {
    if (!(name in constants)) throw new Error(`gl_constants.json must have ${name}`);
    return String(constants[name]);
  };
  const options = {
    bundle: true,
    minify: true,
    target: 'es2022',
    charset: 'utf8',
    write: false,
    format: 'esm',
    plugins: [plugin],
    mangleProps: new RegExp(`^(?:${properties.join('|')})$`),
    metafile: true,
  };
  /** Return one bundle as text; names that it shortens are shortened in the next ones too. */
  const bundled = async (more) => {
    const result = await build({ ...options, ...more, mangleCache });
    mangleCache = result.mangleCache;
    bundle.inputs ??= {};
    for (const output of Object.values(result.metafile.outputs)) {
      for (const [input, { bytesInOutput }] of Object.entries(output.inputs)) {
        bundle.inputs[input] = Math.max(bundle.inputs[input] ?? 0, bytesInOutput);
      }
    }
    return importsFirst(result.outputFiles[0].text);
  };

  const files = {};
  const entry = keys.map((key) => {
    const [file, name] = key.split(' ');
    return `export { ${name} as ${exported.get(key)} } from './${path.relative(sources, file)}';`;
  });
  files['core.js'] = await bundled({
    stdin: { contents: entry.join('\n'), resolveDir: sources, sourcefile: 'core.js' },
  });
  for (const name of outside) files[name] = await bundled({ entryPoints: [inSources(name)] });
  for (const [name, text] of Object.entries(files)) checkForm(name, text);
  // The Worker stands alone: what it shares with the core is small.
  const { outputFiles } = await build({
    ...options,
    plugins: [],
    format: 'iife',
    mangleCache,
    entryPoints: [inSources('worker.js')],
  });
  files['worker.js'] = outputFiles[0].text;
  const style = await build({ ...options, plugins: [], entryPoints: [inSources('page.css')] });
  files['page.css'] = style.outputFiles[0].text;
  files['index.html'] = await readFile(inSources('index.html'), 'utf8');
  return files;
}

/** Refuse short names of properties that are also asked for by their whole name. */
function checkProperties(properties, texts, parts) {
  const whole = new Set(parts.map(([, name]) => name.replace('.js', '')));
  for (const text of texts.values()) {
    for (const [, name] of text.matchAll(/\bexport (?:async )?(?:function|class|const) (\w+)/g)) {
      whole.add(name);
    }
    for (const [, name] of text.matchAll(/'(\w+)'/g)) whole.add(name);
    for (const [, name] of text.matchAll(/\bdataset\.(\w+)/g)) whole.add(name);
  }
  const wrong = properties.filter((name) => whole.has(name));
  if (wrong.length) throw new Error(`short_names.json must not have ${wrong.join(', ')}`);
}

/** Return a file whose imports of the core are one, at its beginning. */
function importsFirst(text) {
  const names = [];
  const rest = text.replace(/import\{([\w$ ,]*)\}from"\.\/core\.js";/g, (_, list) => {
    names.push(list);
    return '';
  });
  return names.length ? `import{${names.join(',')}}from"./core.js";${rest}` : rest;
}

/** Refuse a file that Python could not put together with others. */
function checkForm(name, text) {
  const rest = text
    .replace(/^(?:import\{[\w$ ,]*\}from"\.\/\w+\.js";)*/, '')
    .replace(/export\{[\w$ ,]*\};\n?$/, '');
  const wrong = /\b(?:import|export)\b(?!\("\.\/\w+\.js"\))/.exec(rest);
  if (wrong) {
    const near = rest.slice(Math.max(wrong.index - 30, 0), wrong.index + 40);
    throw new Error(`${name} must import at its beginning and export at its end, got ${near}`);
  }
}

/** Write the files that differ from those of the page, or only name them. */
async function main() {
  const check = process.argv.includes('--check');
  const files = await bundle();
  await mkdir(target, { recursive: true });
  let stale = 0;
  for (const [name, text] of Object.entries(files)) {
    const file = path.join(target, name);
    const same = existsSync(file) && (await readFile(file, 'utf8')) === text;
    if (!same) stale += 1;
    if (!same && !check) await writeFile(file, text);
    const state = same ? '' : check ? ', not the bundle of the sources' : ', written';
    console.log(`${name}: ${Buffer.byteLength(text)} bytes${state}`);
  }
  for (const name of await readdir(target)) {
    if (name in files) continue;
    stale += 1;
    if (!check) await rm(path.join(target, name));
    console.log(`${name}: not of the page${check ? '' : ', removed'}`);
  }
  if (process.argv.includes('--inputs')) {
    const rows = Object.entries(bundle.inputs).sort((a, b) => b[1] - a[1]);
    for (const [name, bytes] of rows) console.log(`${bytes}\t${name}`);
  }
  if (check && stale) process.exit(1);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) await main();
