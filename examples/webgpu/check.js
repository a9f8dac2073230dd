// Self-check: the fields that this page computes beside those that Python summed, wave by wave, in double precision (check.json).

export const LIMIT = 5e-7; // relative error that single precision leaves, in the L2 norm of each field

/** Return {worst, field, tile}: the largest relative error of any field, tile and moment. */
export async function selfCheck(sea) {
  const { moments, tiles } = sea.reference;
  let found = { worst: 0, field: 'height', tile: 0 };
  const errors = new Map(), sizes = new Map();
  for (const [m, tick] of moments.entries()) {
    const seen = await sea.fields(tick);
    tiles.forEach(({ columns, rows, fields }, tile) => {
      for (const [field, values] of Object.entries(fields)) {
        const key = `${field} ${tile}`;
        values[m].forEach((value, point) => {
          const own = seen[tile][field][rows[point] * sea.tiles[tile].nx + columns[point]];
          errors.set(key, (errors.get(key) ?? 0) + (own - value) ** 2);
          sizes.set(key, (sizes.get(key) ?? 0) + value ** 2);
        });
      }
    });
  }
  for (const [key, error] of errors) {
    const worst = Math.sqrt(error / (sizes.get(key) || 1)); // a field that is 0 everywhere must be 0
    if (!(worst <= found.worst)) found = { worst, field: key.split(' ')[0], tile: Number(key.split(' ')[1]) };
  }
  return found;
}
