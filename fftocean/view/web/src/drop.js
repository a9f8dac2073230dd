// A job or a buoy file, dropped on the page or chosen from a list, becomes a message to the server.

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

/** Take files that are dropped on an element; `onFile(name, bytes)` gets each. */
export function takeDrops(root, { onFile, onRefused, onOver, signal }) {
  const options = { signal };
  let inside = 0;
  root.addEventListener(
    'dragenter',
    (event) => {
      event.preventDefault();
      inside += 1;
      onOver(true);
    },
    options,
  );
  root.addEventListener('dragover', (event) => event.preventDefault(), options);
  root.addEventListener(
    'dragleave',
    () => {
      inside = Math.max(0, inside - 1);
      if (!inside) onOver(false);
    },
    options,
  );
  root.addEventListener(
    'drop',
    async (event) => {
      event.preventDefault();
      inside = 0;
      onOver(false);
      const files = [...(event.dataTransfer?.files ?? [])];
      if (files.length !== 1) {
        onRefused(`drop one file, got ${files.length}`);
        return;
      }
      await readFile(files[0], { onFile, onRefused });
    },
    options,
  );
}

/** Read a file of the browser and hand its bytes on; one that is too large is not read. */
export async function readFile(file, { onFile, onRefused }) {
  if (file.size > LARGEST_FILE) {
    onRefused(fileMessage(file.name, { length: file.size }).refused);
    return;
  }
  try {
    onFile(file.name, new Uint8Array(await file.arrayBuffer()));
  } catch (error) {
    onRefused(`the file ${file.name} cannot be read: ${error.message}`);
  }
}
