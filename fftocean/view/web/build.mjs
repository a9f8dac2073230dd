// Bundle the sources into ../page, which is what Python serves and what the wheel holds.
// `npm run build` writes it; `npm run build -- --check` fails if it differs from the sources.
import { readFile, writeFile, mkdir } from 'node:fs/promises';
import { existsSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import path from 'node:path';
import { build } from 'esbuild';

const here = path.dirname(fileURLToPath(import.meta.url));
const target = path.join(here, '..', 'page');
const check = process.argv.includes('--check');

/**
 * Return a source with the comments and the indentation of its shaders left out: what stands between backquotes in
 * the modules that hold shaders is GLSL, which the bundler takes for text.
 */
export function withoutShaderComments(source) {
  return source.replace(/`(?:[^`\\]|\\.)*`/g, (text) =>
    /\b(?:vec[234]|float|void|uniform)\b/.test(text)
      ? text
          .replace(/\/\*[^]*?\*\//g, '')
          .replace(/\/\/[^\n`]*/g, '')
          .replace(/[ \t]+/g, ' ')
          .replace(/ *\n[ \n]*/g, '\n')
          .replace(/ ?([=*/<>,;{}?:]) ?/g, '$1')
      : text,
  );
}

const shaders = {
  name: 'shaders',
  setup(bundler) {
    bundler.onLoad({ filter: /src[/\\].*\.js$/ }, async ({ path: file }) => ({
      contents: withoutShaderComments(await readFile(file, 'utf8')),
      loader: 'js',
    }));
  },
};
const options = {
  plugins: [shaders],
  bundle: true,
  minify: true,
  target: 'es2022',
  charset: 'utf8',
  write: false,
};

/** Return one bundled source as bytes. */
async function bundled(source, more) {
  const result = await build({
    ...options,
    ...more,
    entryPoints: [path.join(here, 'src', source)],
  });
  return result.outputFiles[0].contents;
}

// The Worker is a file of its own on a server and a text inside the page that is one file.
const worker = await bundled('worker.js', { format: 'iife' });
const define = { WORKER_SOURCE: JSON.stringify(new TextDecoder().decode(worker)) };
const files = {
  'worker.js': worker,
  'page.js': await bundled('page.js', { format: 'iife', define: { WORKER_SOURCE: 'null' } }),
  'static.js': await bundled('static.js', { format: 'iife', define }),
  'widget.js': await bundled('widget.js', { format: 'esm', define }),
  'page.css': await bundled('page.css', {}),
  'index.html': await readFile(path.join(here, 'src', 'index.html')),
};

await mkdir(target, { recursive: true });
const stale = [];
for (const [name, bytes] of Object.entries(files)) {
  const file = path.join(target, name);
  const same = existsSync(file) && Buffer.compare(await readFile(file), Buffer.from(bytes)) === 0;
  if (!same) stale.push(name);
  if (!same && !check) await writeFile(file, bytes);
  console.log(
    `${name}: ${bytes.length} bytes${same ? '' : check ? ', not the bundle of the sources' : ', written'}`,
  );
}
if (check && stale.length) process.exit(1);
