// The tables that the live page decodes from a container, of all tiles one after the other: h0, then wave, as float32.
// Usage: node decode_sea.mjs SOURCES CONTAINER OUTPUT; prints the document and the reference as JSON
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [sources, container, output] = process.argv.slice(2);
const { decodeSea } = await import(pathToFileURL(path.join(sources, 'container.js')));
const { document, tiles, reference } = decodeSea(readFileSync(container));
writeFileSync(output, Buffer.concat(tiles.flatMap(({ h0, wave }) => [Buffer.from(h0.buffer), Buffer.from(wave.buffer)])));
const sizes = tiles.map(({ nx, ny, lx, ly, mixed }) => ({ n: [nx, ny], size: [lx, ly], mixed }));
process.stdout.write(JSON.stringify({ document, sizes, reference }));
