"""
Files to open to follow a bake, found by a profiler: those that have a function which ran.

    python tools/follow.py                 # a bake of one frame of the default job, n = 64, EXR
    python tools/follow.py sea.toml --n 64 # of a job file

The first list is one frame after set-up: its fields, its maps, and the pixels that the format
stores. The second is the whole call of `fftocean.bake`. Both call compiled kernels, whose calls the
profiler sees; files that only declare types or constants are not counted.
"""

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

ROOT = Path(__file__).resolve().parents[1]


def files_of(action: Callable[[], Any]) -> dict[str, list[str]]:
    """Return the functions of the package that run in an action, by file, in order of use."""
    found: dict[str, Counter[str]] = {}

    def note(frame: FrameType, event: str, _: object) -> None:
        code = frame.f_code
        if event == "call" and code.co_name != "<module>" and "fftocean" in code.co_filename:
            path = Path(code.co_filename)
            if path.is_relative_to(ROOT / "fftocean"):
                name = path.relative_to(ROOT).as_posix()
                found.setdefault(name, Counter())[code.co_qualname] += 1

    sys.setprofile(note)
    try:
        action()
    finally:
        sys.setprofile(None)
    return {name: list(functions) for name, functions in found.items()}


def main() -> None:
    """Print both lists."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument("job", nargs="?", help="a job file; the default job without one")
    parser.add_argument("--n", type=int, default=64, help="samples a side (64)")
    parser.add_argument("--functions", action="store_true", help="list the functions, too")
    options = parser.parse_args()
    import fftocean as fo
    from fftocean.baking.scene.scene import Scene

    job = fo.Job.read(options.job) if options.job else fo.Job.default()
    job = job.replaced({"ocean.n": options.n})
    with tempfile.TemporaryDirectory() as folder:
        fo.bake(job, Path(folder, "first"), frames="0:1", executor="serial")  # imports
        scene = Scene(job)

        def whole() -> None:
            fo.bake(job, Path(folder, "again"), frames="0:1", executor="serial")

        def pixels() -> None:
            for _, levels in scene.maps(scene.frame(0), None):
                scene.stored(levels)

        for caption, action in (("one frame to its pixels", pixels), ("fftocean.bake", whole)):
            found = files_of(action)
            print(f"{caption}: {len(found)} files")
            for name, functions in found.items():
                print(f"    {name}" + (f": {', '.join(functions)}" if options.functions else ""))


if __name__ == "__main__":
    main()
