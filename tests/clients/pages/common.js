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

// A sidecar's formula in JavaScript, of the numbers in `names`.
export function formula(text, names) {
  const mod = (a, b) => a - b * Math.floor(a / b);
  return new Function('mod', 'floor', ...Object.keys(names), `return ${text};`)(mod, Math.floor, ...Object.values(names));
}

// Shader code that looks `map` up at the places and times in the texture `places`, one texel each, by a sidecar's formulas.
// `sampling`: for u, v, and, in an atlas, atlas_u, atlas_v, with their values; `meaning`: up to four, of R, G, B and A.
export function lookup({ sampling, meaning, array, output }) {
  const floats = (text) => text.replace(/(?<![\w.])(\d+)(?![\w.])/g, '$1.0');
  const literal = (number) => (Number.isInteger(number) ? `${number}.0` : String(number));
  const values = Object.entries(sampling.values).map(([name, number]) => `const float ${name} = ${literal(number)};`);
  const set = (name) => (name in sampling ? `float ${name} = ${floats(sampling[name])};` : '');
  const at = array ? 'vec3(u, v, index)' : 'atlas_u' in sampling ? 'vec2(atlas_u, atlas_v)' : 'vec2(u, v)';
  const given = [0, 1, 2, 3].map((i) => floats(meaning[i] ?? '0'));
  return `${values.join('\n')}
  vec4 means(vec4 texel) {
    float R = texel.r, G = texel.g, B = texel.b, A = texel.a;
    return vec4(${given.join(', ')});
  }
  void main() {
    vec4 place = texelFetch(places, ivec2(gl_FragCoord.xy), 0);
    float X = place.x, Y = place.y, Z = place.z, time = place.w;
    ${set('u')} ${set('v')} ${set('frame')}
    float index = floor(frame + 0.5); // the times are those of frames
    ${set('atlas_u')} ${set('atlas_v')}
    // neighbours of a pixel are no neighbours in the world: no mip level, no anisotropy
    ${output} = means(textureLod(map, ${at}, 0.0));
  }`;
}
