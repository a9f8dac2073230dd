// Helpers that the pages share: numbers to and from the test, and the sampling rule of a sidecar as shader code.

// Floats as base64: JSON would lose nothing, but takes ten times as long.
export function base64(floats) {
  const bytes = new Uint8Array(floats.buffer, floats.byteOffset, floats.byteLength);
  let text = '';
  for (let i = 0; i < bytes.length; i += 4096) text += String.fromCharCode(...bytes.subarray(i, i + 4096));
  return btoa(text);
}

export const json = async (url) => (await fetch(url)).json();
export const bytes = async (url) => (await fetch(url)).arrayBuffer();

// Body of a fragment shader that looks `map` up at the places in the texture `places`, one texel each.
// `rule` = {u, v}: expressions in X, Y, Z, size_u, size_v, columns, rows, copied from the sidecar.
export function lookup({ rule, array, output }) {
  const at = array ? `vec3(u, v, layer)` : 'vec2(u, v)';
  return `void main() {
    vec3 place = texelFetch(places, ivec2(gl_FragCoord.xy), 0).xyz;
    float X = place.x, Y = place.y, Z = place.z;
    float u = ${rule.u};
    float v = ${rule.v};
    ${output} = textureLod(map, ${at}, 0.0); // neighbours of a pixel are no neighbours in the world: no level, no anisotropy
  }`;
}
