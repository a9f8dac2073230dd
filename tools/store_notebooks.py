"""
Execution of the notebooks, whose outputs are stored with them.

`python tools/store_notebooks.py [NAME...]` executes notebooks (all of them without a name) and
stores their outputs; `--check` fails if the outputs are not of the code.
"""

import argparse
import hashlib
import time
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parents[1] / "notebooks"
LIVE = ("application/vnd.jupyter.widget-view+json", "application/javascript")
"""Outputs that are nothing without their kernel."""


def code_hash(notebook: Any) -> str:
    """Return the SHA-256 of the code of a notebook."""
    code = "\0".join(cell.source for cell in notebook.cells if cell.cell_type == "code")
    return hashlib.sha256(code.encode()).hexdigest()


def execute(notebook: Any) -> Any:
    """Execute a notebook in its folder and return it; an error in a cell is raised."""
    import nbclient

    resources = {"metadata": {"path": str(FOLDER)}}
    return nbclient.NotebookClient(
        notebook, timeout=1200, kernel_name="python3", resources=resources
    ).execute()


def store(path: Path) -> float:
    """Execute a notebook and write it with its outputs; return the time that it took [s]."""
    import nbformat

    notebook = nbformat.read(path, as_version=4)
    start = time.perf_counter()
    execute(notebook)
    taken = time.perf_counter() - start
    for cell in notebook.cells:
        cell.metadata = {}
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            for kind in LIVE:
                data.pop(kind, None)
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
        "fftocean": {"code_sha256": code_hash(notebook)},
    }
    nbformat.write(notebook, path)
    return taken


def main() -> None:
    """Execute and store notebooks, or check them."""
    import nbformat

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--check", action="store_true", help="execute nothing")
    options = parser.parse_args()
    paths = [FOLDER / f"{name.removesuffix('.ipynb')}.ipynb" for name in options.names]
    for path in paths or sorted(FOLDER.glob("*.ipynb")):
        if options.check:
            notebook = nbformat.read(path, as_version=4)
            if notebook.metadata.get("fftocean", {}).get("code_sha256") != code_hash(notebook):
                raise SystemExit(
                    f"{path.name} is stale: run python tools/store_notebooks.py {path.stem}"
                )
        else:
            print(f"{path.name}: {store(path):.0f} s, {path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
