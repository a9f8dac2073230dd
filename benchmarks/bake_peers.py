"""
Bakes beside those of other programs: earlier versions of this package, and Blender.

All bake in one process, in turn, several rounds. This package and its earlier versions bake the
embedded default job at n, three maps as half-float EXR, without pictures, which are another work;
a frame's time is that from the eighth frame to the last. Pixels of all versions are decoded and
compared. Blender bakes displacement and normals of its Ocean modifier, whose side is the square of
a whole number, the one nearest to n; frames a second are scaled to n * n samples.

    python benchmarks/bake_peers.py [--n 512] [--frames 60] [--rounds 3]
        [--earlier NAME=PYTHON ...] [--blender PYTHON] [--json FILE] [--plot FILE]

An earlier version is named by the Python that has it installed, Blender by one that has `bpy`,
such as this one. Without them, their bakes are skipped, which is said.
"""

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import fresh
import numpy as np
import script

from fftocean import limits
from fftocean.bench.charts import bars, sheet
from fftocean.bench.results import Reading, Result
from fftocean.bench.timing import summary
from fftocean.errors import ParameterError
from fftocean.plots.theme import BLUE

ASKS = "How fast is a bake, beside earlier versions and Blender's?"
OURS, BLENDER = "this version", "Blender"
SPEED = "frames a second"
RATIO = "frames a second, this version / others"
FIRST = 8  # frames before those that are timed

CHILD = """
import json, sys, time, warnings
from pathlib import Path
import fftocean as fo

warnings.simplefilter("ignore")
n, frames, folder = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
plain = fo.Job.default().replaced({"bake.pictures": []})
fo.bake(plain.replaced({"ocean.n": 16, "bake.frames": 2}), folder / "warm", executor="serial")
marks = []

def listen(event):
    if event["event"] == "frame":
        marks.append((time.perf_counter(), time.process_time()))

job = plain.replaced({"ocean.n": n, "bake.frames": frames})
manifest = fo.bake(job, folder / "bake", executor="serial", listen=listen)
left_out = int(sys.argv[4])
count, first = len(marks) - 1 - left_out, marks[left_out]
size = sum(entry["bytes"] for row in manifest["frames"] for entry in row["files"].values())
print(json.dumps({
    "wall": count / (marks[-1][0] - first[0]),
    "cpu": 1e3 * (marks[-1][1] - first[1]) / count,
    "size": size / frames / 2**20,
}))
"""

BLENDER_CHILD = """
import json, sys, time
from pathlib import Path
import bpy

side, frames, folder = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.mesh.primitive_plane_add()
ocean = bpy.context.object.modifiers.new("Ocean", "OCEAN")
ocean.resolution = ocean.viewport_resolution = side
ocean.use_normals = True
ocean.frame_start, ocean.frame_end, ocean.filepath = 1, frames, str(folder) + "/"
start, used = time.perf_counter(), time.process_time()
bpy.ops.object.ocean_bake(modifier="Ocean")
end = time.monotonic() + 600.0
while len(list(folder.glob("*.exr"))) < 2 * frames and time.monotonic() < end:
    time.sleep(0.002)  # it returns before its last files are written
files = list(folder.glob("*.exr"))
print(json.dumps({
    "wall": frames / (time.perf_counter() - start),
    "cpu": 1e3 * (time.process_time() - used) / frames,
    "size": sum(file.stat().st_size for file in files) / frames / 2**20,
    "frames": len(files) // 2,
}))
"""


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    parser.add_argument("--n", type=int, default=512, help="samples a side (default: 512)")
    parser.add_argument("--frames", type=int, default=60, help="in the loop (default: 60)")
    parser.add_argument("--rounds", type=int, default=3, help="bakes of each (default: 3)")
    parser.add_argument("--earlier", nargs="*", default=[], metavar="NAME=PYTHON")
    parser.add_argument(
        "--blender", default="", metavar="PYTHON", help="a Python that has bpy (default: this one)"
    )


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Bake with each program in turn; compare the pixels of the versions of this package."""
    if options.frames < FIRST + 4:
        raise ParameterError(f"--frames must be at least {FIRST + 4}, got {options.frames}")
    limits.Count("", 1, 1000).check("--rounds", options.rounds)
    side = round(options.n**0.5)
    programs: dict[str, list[str]] = {OURS: []}
    for one in options.earlier:
        name, _, python = one.partition("=")
        programs[name] = [python]
    blender = options.blender or sys.executable
    if has_bpy(blender):
        programs[BLENDER] = [blender]
    else:
        say(f"Blender is skipped: {blender} has no bpy; --blender names a Python that has")
    said: dict[str, list[Any]] = {name: [] for name in programs}
    with tempfile.TemporaryDirectory() as folder:
        for i in range(options.rounds):
            for name, python in programs.items():
                say(f"round {i + 1} of {options.rounds}: {name}")
                at = Path(folder, f"{name}-{i}".replace("/", "-"))
                at.mkdir()
                said[name].append(one_bake(name, python, options, side, at))
        for name in programs:
            if name not in (OURS, BLENDER):
                say(f"{name}: pixels")
                compare(Path(folder, f"{OURS}-0", "bake"), Path(folder, f"{name}-0", "bake"))
    readings, own = [], np.array([one["wall"] for one in said[OURS]])
    for name, found in said.items():
        scale = side**4 / options.n**2 if name == BLENDER else 1.0
        conditions = {"by": name, "n": options.n, "frames": options.frames}
        wall = np.array([scale * one["wall"] for one in found])
        for what, unit, clock, values in (
            (SPEED, "1/s", "wall", wall),
            *([] if name == OURS else [(RATIO, "x", "wall", own / wall)]),
            ("processor time of a frame", "ms", "cpu", [one["cpu"] / scale for one in found]),
            ("size of a frame's files", "MiB", "", [one["size"] / scale for one in found]),
        ):
            readings.append(Reading.of(what, unit, summary(values), conditions, clock=clock))
    return readings


def has_bpy(python: str) -> bool:
    """Return whether a Python can import Blender."""
    try:
        done = subprocess.run([python, "-c", "import bpy"], capture_output=True, timeout=300)
    except OSError:
        return False
    return done.returncode == 0


def one_bake(
    name: str, python: Sequence[str], options: argparse.Namespace, side: int, folder: Path
) -> Any:
    """Bake in a fresh process; return what it says."""
    code, n = (BLENDER_CHILD, side) if name == BLENDER else (CHILD, options.n)
    words = ["-c", code, str(n), str(options.frames), str(folder), str(FIRST)]
    if not python:
        return fresh.python(*words).said
    try:
        done = subprocess.run([*python, *words], capture_output=True, text=True, cwd=folder)
    except OSError as error:
        raise ParameterError(f"{name} could not be run: {error}") from None
    if done.returncode:
        raise ParameterError(f"{name} failed with {done.returncode}: {done.stderr[-400:]}")
    return fresh.last_json(done.stdout)


def compare(ours: Path, theirs: Path) -> None:
    """
    Raise unless two bakes have the same pixels, by OpenEXR's own reader.

    Raises:
        ParameterError: a file is missing, or a pixel differs by more than two steps of a half: the
            FFT of another version may sum in another order.
    """
    import OpenEXR

    for file in sorted(ours.glob("*/[0-9]*.exr"))[:: 1 + FIRST]:
        other = theirs / file.relative_to(ours)
        pixels = []
        for path in (file, other):
            channels = OpenEXR.File(str(path), separate_channels=True).channels()
            pixels.append(np.stack([channels[c].pixels for c in "RGB"]).astype(np.float64))
        step = np.spacing(np.abs(pixels[0]).astype(np.float16)).astype(np.float64)
        floor = float(np.finfo(np.float16).eps) * np.abs(pixels[0]).max() / 64
        off = float(np.max(np.abs(pixels[0] - pixels[1]) / np.maximum(step, floor)))
        if off > 2.0:
            raise ParameterError(f"{file.name} of {file.parent.name} differs by {off:.3g} steps")


def draw(result: Result, path: Path) -> None:
    """Draw frames a second and processor time of each program."""
    with sheet(path, ASKS, result, width=11.0, height=3.6) as figure:
        for ax, what, title in zip(
            figure.subplots(1, 2),
            (SPEED, "processor time of a frame"),
            ("Frames a second, one process", "Processor time of a frame, all threads [ms]"),
            strict=True,
        ):
            rows = [
                (
                    str(r.at["by"]),
                    r.median,
                    f"{r.median:.1f}",
                    BLUE if r.at["by"] == OURS else "#56707a",
                )
                for r in result.all(what)
            ]
            bars(ax, rows)
            ax.set_title(title)


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "bake_peers", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
