"""
Speed of a bake, and its profile.

The embedded default job is baked whole at each n: three maps (height, displacement, normal) as
half-float EXR. Frames a second are those of a bake in one process, and in one per core. The profile
is that of Python's profiler in one process, whose frames are written by the thread that computes:
each function's own time belongs to the part of the package that holds its file, and the time of
library functions to the part that called them. Compiled kernels are wrapped, so that each is
profiled under its own file. The profiler slows down Python only: "Python" is an upper bound.

    python benchmarks/bake.py [--n 256 512] [--frames 240] [--json FILE] [--plot FILE]
"""

import argparse
import cProfile
import importlib
import pkgutil
import pstats
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import script

import fftocean as fo
from fftocean import host, kernels
from fftocean.baking.scene import scene
from fftocean.bench.charts import bars, sheet
from fftocean.bench.results import Reading, Result
from fftocean.bench.timing import summary
from fftocean.plots.theme import BLUE

ASKS = "How fast is a bake, and where does its time go?"
Function = tuple[str, int, str]  # file, line, name: as the profiler has it
PACKAGE = Path(fo.__file__).resolve().parent

# The first row that matches a function's place in the package, or a library function's name, is the
# part to which its time belongs.
PARTS = (
    (
        "simulation",
        (
            "ocean.py:frame",
            "ocean.py:loop_frame",
            "ocean.py:_",
            "lookahead.py",
            "frame.py",
            "synthesis.py",
            "transforms.py",
            "kernels/passes",
            "kernels/surface",
        ),
    ),
    (
        "encoder",
        ("export/", "kernels/half", "kernels/byte_planes", "baking/scene/scene.py:_halves"),
    ),
    ("preview", ("baking/previews/", "blend_loss.py")),
    (
        "maps",
        (
            "baking/scene/maps.py",
            "foam.py",
            "eulerian.py",
            "mips.py",
            "products.py",
            "kernels/",
        ),
    ),
    (
        "setting up",
        (
            "amplitudes.py",
            "noise.py",
            "physics/",
            "statistics.py",
            "grid.py",
            "limits.py",
            "ocean.py",
            "wisdom.py",
        ),
    ),
    ("checksums", ("~:sha256",)),
    ("disk", ("~:posix.", "~:nt.", "~:_io.open", "~:_io.FileIO")),
)
OTHER = "Python"
COLOURS = {"simulation": BLUE, "encoder": "#00805d", OTHER: "#c75000"}


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    script.sizes(parser, 256, 512)
    parser.add_argument(
        "--frames", type=int, default=240, help="in the loop, all of which are baked (default: 240)"
    )


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Bake three times for each n: in one process, in one per core, and under the profiler."""
    readings: list[Reading] = []
    warnings.simplefilter("ignore", fo.SeaWarning)
    with tempfile.TemporaryDirectory() as folder:
        fo.bake(job(16, 2), Path(folder, "warm"), executor="serial")  # kernels
        for n in options.n:
            for executor, workers in (("serial", 1), ("processes", host.cores())):
                say(f"{n} x {n}, {executor}, {workers} workers")
                start = time.perf_counter()
                fo.bake(
                    job(n, options.frames),
                    Path(folder, f"{n} {executor}"),
                    executor=executor,
                    workers=workers,
                )
                seconds = time.perf_counter() - start
                at = {"n": n, "executor": executor, "workers": workers, "frames": options.frames}
                readings.append(
                    Reading.of(
                        "frames a second",
                        "1/s",
                        summary([options.frames / seconds]),
                        at,
                        clock="wall",
                    )
                )
            say(f"{n} x {n}, under the profiler")
            with kernels_seen(), one_thread():
                profile = cProfile.Profile()
                profile.runcall(
                    fo.bake, job(n, options.frames), Path(folder, f"{n} profile"), executor="serial"
                )
            shares = parts(pstats.Stats(profile).stats)  # type: ignore[attr-defined]
            total = sum(shares.values())
            at = {"n": n, "frames": options.frames}
            for name, seconds in sorted(shares.items(), key=lambda item: -item[1]):
                readings.append(
                    Reading.single(name, "%", 100.0 * seconds / total, at, clock="wall")
                )
            both = shares.get("simulation", 0.0) + shares.get("encoder", 0.0)
            readings.append(
                Reading.single(
                    "simulation and encoder", "%", 100.0 * both / total, at, clock="wall"
                )
            )
    return readings


def job(n: int, frames: int) -> fo.Job:
    """Return the embedded default job at another resolution."""
    return fo.Job.default().replaced({"ocean.n": n, "bake.frames": frames})


class SameThread:
    """An executor that does its work at once, in the thread that submits it."""

    def __init__(self, *_: Any) -> None:
        """Start no thread."""

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Return the result of the function."""
        done: Future[Any] = Future()
        done.set_result(function(*arguments))
        return done

    def shutdown(self, **_: Any) -> None:
        """Wait for no thread."""


@contextmanager
def one_thread() -> Iterator[None]:
    """Let bakes write frames in the thread that computes them, which the profiler sees."""
    pool = scene.ThreadPoolExecutor
    scene.ThreadPoolExecutor = SameThread  # type: ignore[assignment,misc]
    try:
        yield
    finally:
        scene.ThreadPoolExecutor = pool  # type: ignore[misc]


@contextmanager
def kernels_seen() -> Iterator[None]:
    """
    Make compiled kernels visible to the profiler, each as a function of its own file.

    Otherwise their time is counted with their callers.
    """
    changed: list[tuple[Any, str, Any]] = []
    for info in pkgutil.iter_modules(kernels.__path__):
        module = importlib.import_module(f"{kernels.__name__}.{info.name}")
        for name, kernel in vars(module).items():
            if type(kernel).__module__.startswith("numba") and callable(kernel):
                changed.append((module, name, kernel))
    try:
        for module, name, kernel in changed:
            setattr(module, name, seen(kernel, name, str(module.__file__)))
        yield
    finally:
        for module, name, kernel in changed:
            setattr(module, name, kernel)


def seen(kernel: Callable[..., Any], name: str, file: str) -> Callable[..., Any]:
    """Return a Python function of that name and file that calls the kernel."""
    space: dict[str, Any] = {"kernel": kernel}
    exec(compile(f"def {name}(*arguments):\n    return kernel(*arguments)\n", file, "exec"), space)
    made: Callable[..., Any] = space[name]
    return made


def parts(
    stats: Mapping[
        Function, tuple[int, int, float, float, Mapping[Function, tuple[int, int, float, float]]]
    ],
) -> dict[str, float]:
    """
    Return a profile's seconds by part of the package.

    Args:
        stats: for each function (calls, primitive calls, own time, time, callers), as
            `pstats.Stats` has it.
    """
    homes: dict[Function, str | None] = {}

    def home(function: Function) -> str:
        """
        Return its own part, or that of the caller for which it spends most time.

        Library functions that call each other in a cycle belong to Python.
        """
        if function not in homes:
            homes[function] = OTHER  # until it is found
            own = part_of(function)
            if own is None:
                callers = stats[function][4] if function in stats else {}
                main_caller = max(callers, key=lambda caller: callers[caller][3], default=None)
                own = OTHER if main_caller is None else home(main_caller)
            homes[function] = own
        return homes[function] or OTHER

    found: dict[str, float] = {}
    for function, (_, _, own_time, _, callers) in stats.items():
        named = part_of(function)
        rest = own_time
        if named is None:
            for caller, (_, _, spent, _) in callers.items():
                found[home(caller)] = found.get(home(caller), 0.0) + spent
                rest -= spent
        name = named or home(function)
        found[name] = found.get(name, 0.0) + max(rest, 0.0)
    return found


def part_of(function: Function) -> str | None:
    """
    Return the part to which a function belongs by its file; None for a library's function.
    """
    file, _, name = function
    if file == "~":
        place = "~:" + name
        for part, marks in PARTS:
            if any(mark.startswith("~:") and mark[2:] in name for mark in marks):
                return part
        return None
    try:
        place = f"{Path(file).resolve().relative_to(PACKAGE).as_posix()}:{name}"
    except ValueError:
        return None
    for part, marks in PARTS:
        if place.startswith(marks):
            return part
    return OTHER


def draw(result: Result, path: Path) -> None:
    """Draw frames a second, and the parts' shares at the largest n."""
    n = max(result.settings["n"])
    with sheet(path, ASKS, result, width=12.0, height=4.6) as figure:
        left, right = figure.subplots(1, 2)
        rows = []
        for r in result.all("frames a second"):
            by = "one process" if r.at["executor"] == "serial" else f"{r.at['workers']} processes"
            rows.append((f"{r.at['n']} x {r.at['n']}, {by}", r.median, f"{r.median:.1f}", BLUE))
        bars(left, rows)
        left.set_title("Frames a second, three EXR maps each")
        shares = [
            r
            for r in result.readings
            if r.unit == "%" and r.at["n"] == n and r.what != "simulation and encoder"
        ]
        bars(
            right,
            [
                (r.what, r.median, f"{r.median:.1f} %", COLOURS.get(r.what, "#56707a"))
                for r in shares
            ],
        )
        right.set_title(f"Profile of a bake of {n} x {n}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "bake", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
