"""
Bakes of many small frames: costs of a frame, in the number of frames.

For each number of frames a fresh process bakes a sea of 16 x 16, one map, no pictures, and stops
before the last frame. It bakes again, until the first new frame begins: that is the time to resume.
Then it finishes the bake and checks it, as `fftocean bake` and `fftocean check` do. Times are those
of the process's own processor time, for each frame; memory is the process's peak above a bake of
three frames. What is flat does not depend on the number of frames. Last, the manifest's rows are
unpacked to plain data, as `fo.bake` returns them and `fo.load` holds them.

    python benchmarks/many_frames.py [--frames 1000 10000 100000] [--json FILE] [--plot FILE]
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import fresh
import script

from fftocean import limits
from fftocean.bench.charts import sheet
from fftocean.bench.results import Reading, Result
from fftocean.bench.timing import summary
from fftocean.errors import ParameterError

ASKS = "Do many small frames cost the same each?"
CHILD = """
import json, re, sys, tempfile, time, warnings
from pathlib import Path
import fftocean as fo
from fftocean.baking.bake import bake_packed

warnings.simplefilter("ignore", fo.SeaWarning)
count, n, place = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3] or None
small = {"ocean.n": n, "bake.maps": ["height"], "bake.pictures": []}
job = fo.Job.default().replaced({**small, "bake.frames": count})

def peak():
    text = Path("/proc/self/status").read_text()
    return int(re.search(r"VmHWM:\\s+(\\d+) kB", text).group(1)) / 1024

class Stopped(Exception):
    pass

def stop(event):
    if event["event"] == "frame" and event["done"] == count - 1:
        raise Stopped

def started(event):
    if event["event"] == "start":
        assert event["kept"] == count - 1, event
        said["resume"] = 1e3 * (time.process_time() - start) / count

with tempfile.TemporaryDirectory(dir=place) as folder:
    few = job.replaced({"bake.frames": 3})
    bake_packed(few, Path(folder, "few"), executor="serial")
    fo.check(Path(folder, "few"))
    base, said = peak(), {}
    start = time.process_time()
    try:
        bake_packed(job, Path(folder, "many"), executor="serial", listen=stop)
    except Stopped:
        pass
    said["bake"] = 1e3 * (time.process_time() - start) / count
    said["memory of the bake"] = peak() - base
    said["journal"] = Path(folder, "many", ".work", "journal").stat().st_size / 2**20
    start = time.process_time()
    many = Path(folder, "many")
    manifest = bake_packed(job, many, executor="serial", listen=started)
    start = time.process_time()
    assert fo.check(many) == ()
    said["check"] = 1e3 * (time.process_time() - start) / count
    said["memory of all"] = peak() - base
    said["manifest"] = (many / "manifest.json").stat().st_size / 2**20
    plain = list(manifest["frames"])
    said["plain"] = peak() - base
print(json.dumps(said))
"""
WHAT = {
    "bake": ("time of a frame", "ms"),
    "check": ("time to check a frame", "ms"),
    "resume": ("time to resume, a frame", "ms"),
    "memory of the bake": ("peak memory of the bake", "MiB"),
    "memory of all": ("peak memory with resuming, manifest and check", "MiB"),
    "plain": ("peak memory with the manifest as plain data", "MiB"),
    "manifest": ("size of the manifest", "MiB"),
    "journal": ("size of the journal", "MiB"),
}


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    parser.add_argument(
        "--frames",
        type=int,
        nargs="+",
        default=[1000, 10_000, 100_000],
        metavar="N",
        help="numbers of frames (default: 1000 10000 100000)",
    )
    parser.add_argument("--n", type=int, default=16, help="samples a side (default: 16)")
    parser.add_argument("--folder", default="", help="where to bake; default: the temporary folder")


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Bake, resume and check each number of frames in a process of its own."""
    if not Path("/proc/self/status").exists():
        raise ParameterError("memory is measured on Linux only: there is no /proc/self/status here")
    readings = []
    for count in [limits.FRAMES.check("--frames", count) for count in options.frames]:
        say(f"{count} frames")
        said = fresh.python("-c", CHILD, str(count), str(options.n), options.folder).said
        readings += [
            Reading.of(
                what,
                unit,
                summary([said[key]]),
                {"frames": count, "n": options.n},
                clock="cpu" if unit == "ms" else "",
            )
            for key, (what, unit) in WHAT.items()
        ]
    return [*readings, *growth(readings)]


def growth(readings: Sequence[Reading]) -> list[Reading]:
    """Return the ratios of the times of a frame at the most frames to those at the fewest."""
    counts = sorted(int(r.at["frames"]) for r in readings if r.what == WHAT["bake"][0])
    found = []
    for what, unit in WHAT.values():
        if unit == "ms" and len(counts) > 1:
            few, many = (
                next(r for r in readings if r.what == what and r.at["frames"] == count)
                for count in (counts[0], counts[-1])
            )
            ratio = many.median / few.median
            at = {"frames": counts[-1], "n": many.at["n"]}
            found.append(
                Reading.single(f"{what}, of the most / the fewest", "x", ratio, at, clock="cpu")
            )
    return found


def draw(result: Result, path: Path) -> None:
    """Draw times and memory over the number of frames."""
    counts = result.settings["frames"]
    with sheet(path, ASKS, result, width=11.0, height=5.6) as figure:
        times, memory = figure.subplots(1, 2)
        for ax, unit in ((times, "ms"), (memory, "MiB")):
            for what, its_unit in WHAT.values():
                if its_unit == unit:
                    ys = [result.find(what, frames=count).median for count in counts]
                    ax.plot(counts, ys, marker="o", label=what)
            ax.set_xscale("log")
            ax.set_yscale("log")
            ax.set_xlabel("frames")
            ax.set_ylabel("processor time of a frame [ms]" if unit == "ms" else "memory [MiB]")
            # below: lines that rise and fall by turns leave no room among them
            ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=1, frameon=False)


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "many_frames", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
