// A job or a buoy file becomes a message to the server.

/** Largest file that fits in a message: base64 takes four bytes for three [bytes]. */
export const LARGEST_FILE = 47 * 1024;

/** Return base64 of bytes. */
export function base64(bytes) {
  let text = '';
  for (let at = 0; at < bytes.length; at += 8192) {
    text += String.fromCharCode(...bytes.subarray(at, at + 8192));
  }
  return btoa(text);
}

/** Return {message} that sends a file to the server, or {refused} with the rule. */
export function fileMessage(name, bytes) {
  if (bytes.length === 0) return { refused: `the file ${name} is empty` };
  if (bytes.length > LARGEST_FILE) {
    const most = LARGEST_FILE / 1024;
    const size = (bytes.length / 1024).toFixed(0);
    return { refused: `a file must have at most ${most} KiB, got ${size} KiB: ${name}` };
  }
  if (/\.toml$/i.test(name)) {
    try {
      return { message: { job: new TextDecoder('utf-8', { fatal: true }).decode(bytes) } };
    } catch {
      return { refused: `a job must be UTF-8 text: ${name}` };
    }
  }
  return { message: { file: { name, base64: base64(bytes) } } };
}

/** Send the only one of some files of the browser; one that is too large is not read. */
export async function takeFiles(app, files) {
  const [file] = files;
  if (files.length !== 1) {
    app.refuse(`drop one file, got ${files.length}`);
    return;
  }
  try {
    const large = file.size > LARGEST_FILE;
    const bytes = large ? { length: file.size } : new Uint8Array(await file.arrayBuffer());
    const { message, refused } = fileMessage(file.name, bytes);
    if (refused) app.refuse(refused);
    else if (app.sendOr(message)) app.layout.toast(`Reading ${file.name}`);
  } catch (error) {
    app.refuse(`the file ${file.name} cannot be read: ${error.message}`);
  }
}
