// Heights of a baked sea in JavaScript:
//     fftocean bake sea.toml -o sea --engine three --maps height --format bin --lookup eulerian
//     const json = await (await fetch('sea/height.json')).json();
//     const sea = new SeaHeights(json, await (await fetch('sea/' + json.file)).arrayBuffer());
//     const y = sea.at(boat.position.x, boat.position.z, clock.getElapsedTime());
// The same bytes are a texture: new THREE.DataArrayTexture(new Uint16Array(buffer), columns, rows,
// frames), type HalfFloatType.

export class SeaHeights {
  constructor(sidecar, buffer) {
    const expected = {
      schema: 1, dtype: 'float16, little-endian', levels: 1, lookup: 'eulerian', closes: true,
    };
    for (const [key, value] of Object.entries(expected))
      if (sidecar[key] !== value) throw new Error(`${key} must be ${value}, got ${sidecar[key]}`);
    if (sidecar.channels.R !== 'height')
      throw new Error(`R must be height, got ${sidecar.channels.R}`);
    this.s = sidecar;
    const count = sidecar.frames * sidecar.rows * sidecar.columns;
    const bytes = buffer.byteLength;
    if (bytes !== 8 * count)
      throw new Error(`${sidecar.file} must have ${8 * count} bytes, got ${bytes}`);
    const view = new DataView(buffer);
    // R of RGBA; [frame, row, column]
    const red = (_, i) => half(view.getUint16(8 * i, true));
    this.heights = Float32Array.from({ length: count }, red);
  }

  // Bilinear between samples, linear between frames; the sea repeats in x, z and t.
  at(x, z, t) {
    const { frames, rows, columns, row_origin, row_sign, loop, start, size } = this.s;
    const place = [
      ((t - start) / loop) * frames,
      row_origin + ((row_sign * z) / size[1]) * rows,
      (x / size[0]) * columns,
    ];
    let sum = 0;
    for (let corner = 0; corner < 8; corner++) {
      let weight = 1;
      const [f, r, c] = place.map((p, axis) => {
        const bit = (corner >> axis) & 1, part = p - Math.floor(p);
        const n = [frames, rows, columns][axis];
        weight *= bit ? part : 1 - part;
        return (((Math.floor(p) + bit) % n) + n) % n;
      });
      sum += weight * this.heights[(f * rows + r) * columns + c];
    }
    return sum;
  }
}

function half(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
  // A bake has no infinity and no NaN.
  return sign * (exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : 2 ** -24 * fraction);
}
