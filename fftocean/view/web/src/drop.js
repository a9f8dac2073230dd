// Files that are dropped on the page.

/** Take what is dropped on an element; `onFiles(files)` gets it, `onOver(over)` hears of it before. */
export function takeDrops(root, { onFiles, onOver, signal }) {
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
    (event) => {
      event.preventDefault();
      inside = 0;
      onOver(false);
      onFiles([...(event.dataTransfer?.files ?? [])]);
    },
    options,
  );
}
