// The container of a page that is one file: deflated, with bytes of equal place in a record together.

/** Return the bytes of base64. */
export function bytesOf(text) {
  const binary = atob(text);
  return Uint8Array.from(binary, (letter) => letter.charCodeAt(0));
}

/** Return what was deflated (zlib format) to `packed`. */
export async function inflated(packed) {
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Return bytes in their order, of `count` planes: plane i holds bytes i, i + count, and so on. */
export function joined(planes, count) {
  const rows = planes.length / count;
  const bytes = new Uint8Array(planes.length);
  for (let plane = 0; plane < count; plane++) {
    for (let row = 0; row < rows; row++) bytes[row * count + plane] = planes[plane * rows + row];
  }
  return bytes;
}
