// What a document says of its sea.

/** Return the significant wave height of a document [m]; 1 if it is not known. */
export function waveHeight(document) {
  const { realised, specified } = document?.statistics ?? {};
  return Math.max(realised?.hs ?? specified?.hs ?? 1, 0.02);
}

/** Return the statistics of a document; a sea of given waves has none that are specified. */
export function statisticsOf(document) {
  const { specified, realised } = document.statistics ?? {};
  return { specified: specified ?? {}, realised: realised ?? {} };
}

/** Return true where statistics are those of water without waves: no period, no direction. */
export function isFlat({ hs, tp }) {
  return hs === 0 || tp === 0;
}

/** Return the number of waves on all tiles. */
export function wavesOf({ tiles }) {
  return tiles.reduce((sum, tile) => sum + (tile.waves ?? 0), 0);
}

/** Return a number with a fixed number of decimals, or a dash. */
export function fixed(value, decimals) {
  return typeof value === 'number' && Number.isFinite(value) ? value.toFixed(decimals) : '–';
}

/** Return the peak period and the direction of statistics; flat water has neither. */
export function periodAndDirection(statistics) {
  const { tp, direction } = isFlat(statistics) ? {} : statistics;
  return { tp, direction };
}
