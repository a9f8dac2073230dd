// Answers the questions of ask.txt by sea_waves.js: see tests/clients/sea_waves.py.
import { existsSync, readFileSync } from 'node:fs';
import { SeaWaves } from './sea_waves.mjs';

let sea;
const all = (w) => [w.x0, w.y0, w.x, w.y, w.height, ...w.normal, w.residual, w.jacobian].join(' ');
for (const line of readFileSync('ask.txt', 'utf8').trim().split('\n')) {
  const [word, ...rest] = line.split(' ');
  if (word === 'sea') {
    const [folder, strongest] = rest;
    const path = (name) => `${folder}/${name}`;
    const read = (name) => (existsSync(path(name)) ? new Uint8Array(readFileSync(path(name))) : null);
    try {
      sea = await SeaWaves.load(read, strongest === '-1' ? {} : { strongest: +strongest });
      console.log('ok', sea.neglectedRms);
    } catch (error) {
      console.log('error', error.message);
    }
  } else console.log(all(sea[word](...rest.map(Number))));
}
