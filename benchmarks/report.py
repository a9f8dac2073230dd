"""
Report of all benchmarks, RESULTS.md, made from their JSON files.

It has the goals row by row, then each question with its chart and its readings.

    python benchmarks/report.py
"""

import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from fftocean.bench.charts import plain
from fftocean.bench.results import Condition, Reading, Result, read

HERE = Path(__file__).resolve().parent
RESULTS, REPORT = HERE / "results", HERE / "RESULTS.md"
QUESTIONS = (
    *("frame", "direct_sum", "scaling", "memory", "startup", "seeding", "bake", "second_order"),
    *("series", "robots", "query", "bake_peers", "many_frames"),
)
ON_REQUEST = ("encino_waves",)
"""Questions that need another program's sources: they are asked by hand, and reported with all."""

REPORTED_QUESTIONS = (*QUESTIONS, *ON_REQUEST)

REPORTED: Mapping[str, tuple[str, ...]] = {
    "frame": (
        "full frame",
        "floor",
        "textbook / full frame",
        "textbook, its eight ifft2 alone / full frame",
        "careful / full frame",
        "full frame / floor",
        "one thread / more",
        "eight linear fields / full frame",
        "height only / full frame",
        "float64 / float32",
        "estimate / measure",
    ),
    "direct_sum": ("direct sum / FFT", "crossover", "exponent", "misfit"),
    "scaling": ("full frame", "full frame, a point and log2 N", "exponent of N, powers of two"),
}
BUSY_FROM = 1.1  # wall over CPU time of one thread


@dataclass(frozen=True, slots=True)
class Goal:
    """One row of the table of goals: a reading and its largest or smallest allowed value."""

    what: str
    sign: str  # "<=" or ">="
    bound: float
    question: str
    reading: str
    at: Mapping[str, Condition]
    clock: str | None = None

    def met(self, reading: Reading) -> bool:
        """Return whether a reading meets the goal."""
        holds: Callable[[float, float], bool] = {"<=": operator.le, ">=": operator.ge}[self.sign]
        return holds(reading.median, self.bound)


def goals() -> list[Goal]:
    """Return all goals, in the sequence of the report."""
    found = []
    for backend, bounds in (
        ("pyfftw", {256: 18.0, 512: 18.0, 1024: 18.0}),
        ("mkl", {256: 18.0, 512: 18.0, 1024: 18.0}),
    ):
        for n, bound in bounds.items():
            what = f"textbook NumPy / full frame, {n} x {n}, {backend}"
            found.append(
                Goal(
                    what,
                    ">=",
                    bound,
                    "frame",
                    "textbook / full frame",
                    {"n": n, "backend": backend},
                )
            )
    at: dict[str, Condition]
    for n, bound in ((256, 3.5), (1024, 3.0)):
        at = {"n": n, "backend": "pyfftw", "threads": 1}
        reading = "EncinoWaves / full frame"
        found.append(Goal(f"{reading}, {n} x {n}", ">=", bound, "encino_waves", reading, at))
    # The bounds are EncinoWaves (C++, FFTW planned with MEASURE, with its normals) over 3.5 at 256
    # and over 3 beyond, on a two-core Sapphire Rapids: it took 2.5 and 2.1 times as long as eight
    # raw c2r with FFTW and a copy there, and 17 and 18 times as long as a copy of the outputs.
    for backend in ("pyfftw", "mkl"):
        for n, bound, copies in ((256, 0.72, 0.2), (512, 0.7, 0.17), (1024, 0.7, 0.17)):
            at = {"n": n, "backend": backend}
            what = f"full frame / eight raw c2r and a copy, {n} x {n}, {backend}"
            if backend == "mkl":  # its raw transforms are faster themselves
                bound = 1.0
            found.append(Goal(what, "<=", bound, "frame", "full frame / floor", at))
            what = f"copy of its outputs / full frame, {n} x {n}, {backend}"
            found.append(Goal(what, ">=", copies, "frame", "copy of the outputs / full frame", at))
    for backend in ("pyfftw", "mkl"):
        for n in (512, 1024, 2048):
            what = f"one thread / two, {n} x {n}, {backend}"
            found.append(
                Goal(
                    what,
                    ">=",
                    1.75,
                    "frame",
                    "one thread / more",
                    {"n": n, "backend": backend, "threads": 2},
                )
            )
    # "about a third": it needs one of the eight transforms, and the same evolution
    for n in (256, 512, 1024):
        found.append(
            Goal(
                f"height only / full frame, {n} x {n}",
                "<=",
                0.36,
                "frame",
                "height only / full frame",
                {"n": n},
            )
        )
    at = {"n": 128, "dtype": "float32"}
    found.append(
        Goal(
            "direct sum / FFT, eight fields, 128 x 128",
            ">=",
            5000.0,
            "direct_sum",
            "direct sum / FFT",
            at,
        )
    )
    found.append(
        Goal(
            "peak memory above imports, full frames, 2048 x 2048",
            "<=",
            300.0,
            "memory",
            "peak above imports",
            {"n": 2048},
        )
    )
    for what, bound, reading in (
        ("`import fftocean`", 0.05, "import fftocean, above Python"),
        ("`fftocean --help`, a whole process", 0.3, "fftocean --help"),
        ("first frame after installation", 15.0, "first frame after installation"),
        (
            "first frame in later processes, above NumPy",
            1.0,
            "first frame in later processes, above NumPy",
        ),
    ):
        found.append(Goal(what, "<=", bound, "startup", reading, {}, clock="wall"))
    for what, n, bound in (
        ("cascade of three tiles", 256, 200.0),
        ("ocean", 512, 150.0),
        ("ocean", 2048, 2000.0),
    ):
        found.append(
            Goal(f"seeding: {what}, {n} x {n}", "<=", bound, "seeding", what, {"n": n}, clock="cpu")
        )
    found.append(
        Goal(
            "bake at 512, 3 maps: simulation and encoder",
            ">=",
            70.0,
            "bake",
            "simulation and encoder",
            {"n": 512},
        )
    )
    found.append(
        Goal("bake at 512, 3 maps: Python's own share", "<=", 10.0, "bake", "Python", {"n": 512})
    )
    for waves, bound in ((500, 0.5), (1000, 1.3), (2000, 5.0)):
        what = f"second order of {waves} waves in a frame, 256 x 256"
        at = {"n": 256, "waves": waves}
        found.append(Goal(what, "<=", bound, "second_order", "second order adds", at))
    for loop, words in ((True, "on a loop"), (False, "without a loop")):
        what = f"10 probes, 3 hours at 5 Hz, all fields, 256 x 256, {words}"
        at = {"n": 256, "loop": loop, "fields": "all"}
        found.append(Goal(what, "<=", 5000.0, "series", "series", at))
        what = f"series {words}, error to the direct sum"
        at = {"n": 256, "loop": loop}
        found.append(Goal(what, "<=", 1e-9, "series", "largest error / largest height", at))
    what = "`kinematics.at`, 200 points, waves of 3 m and more on 3 tiles of 128 x 128"
    at = {"n": 128, "tiles": 3, "points": 200}
    found.append(Goal(what, "<=", 5.0, "robots", "below the surface", at))
    for mode, bound in (("bilinear", 2e6), ("bicubic", 1e6)):
        what = f"query: {mode} heights over 4 km, 3 tiles, points a second of a core"
        at = {"by": "fftocean", "where": "random over 4 km", "mode": mode, "fields": "heights"}
        found.append(Goal(what, ">=", bound, "query", "points a second", at))
    for other, what, bound in (
        ("Blender", "Blender's bake of its Ocean modifier", 4.0),
        ("0.1.0", "version 0.1.0", 2.0),
    ):
        what = f"bake at 512, 3 maps: frames a second / those of {what}"
        reading = "frames a second, this version / others"
        found.append(Goal(what, ">=", bound, "bake_peers", reading, {"n": 512, "by": other}))
    many: dict[str, Condition] = {"n": 16, "frames": 100_000}
    for time in ("time of a frame", "time to check a frame", "time to resume, a frame"):
        what = f"bake of 100,000 frames of 16 x 16: {time} / that of 1,000"
        reading = f"{time}, of the most / the fewest"
        found.append(Goal(what, "<=", 1.25, "many_frames", reading, many))
    # 260 and 470 bytes a frame at most; a row of manifest.json has 600, as plain data 1,500
    for reading, bound in (
        ("peak memory of the bake", 25.0),
        ("peak memory with resuming, manifest and check", 45.0),
    ):
        what = f"bake of 100,000 frames of 16 x 16: {reading}"
        found.append(Goal(what, "<=", bound, "many_frames", reading, many))
    return found


def report(results: Mapping[str, Result]) -> str:
    """Return the whole page."""
    return (
        "\n".join(
            [
                *_head(results),
                *_goals(results),
                *(
                    line
                    for name in REPORTED_QUESTIONS
                    if name in results
                    for line in _section(results[name])
                ),
            ]
        )
        + "\n"
    )


def _head(results: Mapping[str, Result]) -> list[str]:
    """Return the lines on the machine."""
    lines = [
        "# Benchmarks",
        "",
        "Made by `python benchmarks/all.py` from the files in `results/`. "
        "Medians of alternating runs;",
        "ratios are taken round by round, and their median and quartiles are given. "
        "Times of one thread are CPU time, others elapsed time.",
        "",
    ]
    if not results:
        return [*lines, "Not measured yet."]
    result = next(results[name] for name in REPORTED_QUESTIONS if name in results)
    m = result.machine
    caches = ", ".join(f"{level} {size}" for level, size in m["caches"].items())
    versions = ", ".join(f"{name} {version}" for name, version in m["packages"].items())
    libraries = ", ".join(f"{name}: {version}" for name, version in m["fft_libraries"].items())
    lines += [
        "| machine | |",
        "|---|---|",
        f"| processor | {m['cpu']}, {m['cores']} cores ({m['usable_cores']} usable), "
        f"{' '.join(m['instructions'])} |",
        f"| caches, memory | {caches}; {m['memory_gib']} GiB |",
        f"| system | {m['os']}, {m['python']} |",
        f"| packages | {versions} |",
        f"| FFT libraries | {libraries}; by default {m['fft_default']} |",
    ]
    for name in REPORTED_QUESTIONS:
        if name in results:
            before, after = results[name].before, results[name].after
            busy = [r.median for r in results[name].all("wall time / CPU time")]
            word = (
                f"; a second of one thread's work took {max(busy):.2f} s at worst"
                if busy and max(busy) > BUSY_FROM
                else ""
            )
            own = results[name].machine["cpu"]
            elsewhere = "" if own == m["cpu"] else f"; on another machine: {own}"
            lines.append(
                f"| {name} | {before['utc']} UTC, load {before['load']} before, "
                f"{after['load']} after{word}{elsewhere} |"
            )
    return [*lines, ""]


def _goals(results: Mapping[str, Result]) -> list[str]:
    """Return the table of goals."""
    lines = ["## Goals", "", "| what | goal | measured | quartiles | |", "|---|---|---|---|---|"]
    for goal in goals():
        found = (
            results[goal.question].all(goal.reading, clock=goal.clock, **goal.at)
            if goal.question in results
            else []
        )
        sign = {"<=": "at most", ">=": "at least"}[goal.sign]
        if len(found) == 1:
            r = found[0]
            unit = unit_of(r)
            cells = (
                f"{sign} {plain(goal.bound)}{unit} | {number(r.median)}{unit} | "
                f"{number(r.low)} to {number(r.high)} | "
            )
            lines.append(f"| {goal.what} | {cells}{'met' if goal.met(r) else '**not met**'} |")
        else:
            lines.append(f"| {goal.what} | {sign} {plain(goal.bound)} | not measured | | |")
    return [*lines, ""]


def _section(result: Result) -> list[str]:
    """Return the section of one question."""
    name = result.question
    lines = [f"## {name}: {result.asks}", "", f"![{result.asks}](results/{name}.png)", ""]
    readings = [
        r for r in result.readings if name not in REPORTED or r.what.startswith(REPORTED[name])
    ]
    keys = list(dict.fromkeys(key for r in readings for key in r.at))
    lines += [
        f"| {' | '.join(['what', *keys, 'median', 'quartiles', 'of', 'clock'])} |",
        "|---" * (len(keys) + 5) + "|",
    ]
    for r in readings:
        conditions = [str(r.at.get(key, "")) for key in keys]
        cells = [
            r.what,
            *conditions,
            f"{number(r.median)}{unit_of(r)}",
            f"{number(r.low)} to {number(r.high)}",
            str(r.count),
            r.clock,
        ]
        lines.append(f"| {' | '.join(cells)} |")
    settings = ", ".join(f"{key} {value}" for key, value in result.settings.items())
    return [
        *lines,
        "",
        f"Settings: {settings}. Every reading: [results/{name}.json](results/{name}.json).",
        "",
    ]


def unit_of(reading: Reading) -> str:
    """Return the unit of a reading as it follows the number."""
    return {"x": " x", "1": "", "n": ""}.get(reading.unit, f" {reading.unit}")


def number(value: float) -> str:
    """Return a number with three digits."""
    return plain(float(f"{value:.3g}")) if abs(value) < 1000.0 else plain(value)


def gather(folder: Path = RESULTS) -> dict[str, Result]:
    """Return the results in a folder, in the sequence of the questions."""
    return {
        name: read(folder / f"{name}.json")
        for name in REPORTED_QUESTIONS
        if (folder / f"{name}.json").exists()
    }


def main(_: Sequence[str] | None = None) -> int:
    """Write the report; return the exit code."""
    REPORT.write_text(report(gather()), encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
