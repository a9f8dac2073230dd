"""
Cost of a frame, compared with other implementations.

A full frame is height, two displacements, Jacobian and unit normals of the displaced surface,
float32. At each n four races are run, in each of which the contenders alternate:

  others     every FFT library's full frame, one thread, against NumPy as in textbooks (eight
             complex128 ifft2), against its eight ifft2 alone, against carefully optimised NumPy and
             SciPy (complex64 halves, irfft2), and against the floor: eight bare real transforms
             (c2r) of the same library, planned with MEASURE all at once or one by one, whichever is
             faster, and one copy of the result; and a copy of the full frame's own outputs
  fields     full, the eight linear fields, height only, and the full frame in float64
  planning   MEASURE against ESTIMATE
  threads    one against two, and against all cores (elapsed time; the other races count CPU time)

    python benchmarks/frame.py [--n 256 512] [--seconds 10] [--json FILE] [--plot FILE]
"""

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path

import script

from fftocean import host
from fftocean.bench import machine
from fftocean.bench.charts import COLOURS, Line, bars, curves, duration, plain, sheet
from fftocean.bench.contenders import FULL, Careful, Fast, Textbook, floor, require_same_water
from fftocean.bench.quick import WITHIN, ocean
from fftocean.bench.results import Condition, Entry, Pair, Reading, Result, race
from fftocean.fields import EIGHT
from fftocean.host import available_memory
from fftocean.ocean import Ocean
from fftocean.plots.theme import BLUE

ASKS = "What does a frame cost, and against what?"
# of the largest race: the textbook's filters and intermediate fields, and the floors' buffers
BYTES_A_POINT = 900.0


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    script.sizes(parser, 128, 256, 512, 1024, 2048)
    parser.add_argument(
        "--seconds", type=float, default=20.0, help="per n, planning not counted (default: 20)"
    )
    parser.add_argument(
        "--backends",
        nargs="+",
        default=list(machine.backends()),
        choices=machine.backends(),
        help="default: all that are installed",
    )


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Run the four races at each n."""
    readings: list[Reading] = []
    for n in options.n:
        if (free := available_memory()) < BYTES_A_POINT * n * n:
            needed = BYTES_A_POINT * n * n / 2**30
            say(
                f"{n} x {n} is left out: its contenders need {needed:.1f} GiB, "
                f"{free / 2**30:.1f} are free"
            )
            continue
        for share, title, the_race in (
            (0.45, "others", others),
            (0.2, "fields", fields),
            (0.1, "planning", planning),
            (0.25, "threads", threads),
        ):
            say(f"{n} x {n}, {title}")
            readings += the_race(n, options.backends, share * options.seconds)
    return readings


def others(n: int, backends: Sequence[str], seconds: float) -> list[Reading]:
    """
    Time full frames of every library against other implementations and bare transforms.
    """
    entries, pairs, own = [], [], None
    for backend in backends:
        own = ocean(n, backend=backend)
        at = conditions("others", n, backend)
        full = Entry("full frame", Fast(own), at)
        entries.append(full)
        bare = floor(n, backend)
        entries.append(Entry("floor", bare, {"n": n, "backend": backend, "how": bare.how}))
        pairs.append(Pair("full frame / floor", full, entries[-1]))
    assert own is not None
    textbook, careful = Textbook(own), Careful(own)
    require_same_water(own, {"textbook": textbook, "careful": careful}, within=WITHIN)
    usual = [
        Entry("textbook", textbook, {"n": n}),
        Entry("textbook, its eight ifft2 alone", textbook.transforms(), {"n": n}),
        Entry("careful", careful, {"n": n}),
    ]
    copy = Entry("copy of the outputs", copy_of_outputs(own), {"n": n})
    for full in [entry for entry in entries if entry.what == "full frame"]:
        pairs += [Pair(f"{other.what} / full frame", other, full) for other in usual]
        pairs.append(Pair("copy of the outputs / full frame", copy, full))
    return race([*entries, *usual, copy], pairs, clock="cpu", seconds=seconds)


def copy_of_outputs(own: Ocean) -> Callable[[], None]:
    """Return a function that copies the arrays of a full frame to others: memory traffic alone."""
    frame = own.frame(0.0, FULL)
    pairs = [(frame[name], frame[name].copy()) for name in FULL]

    def copy() -> None:
        for source, to in pairs:
            to[...] = source

    return copy


def fields(n: int, backends: Sequence[str], seconds: float) -> list[Reading]:
    """Time fewer fields, and float64."""
    own, double = ocean(n, backend=backends[0]), ocean(n, backend=backends[0], dtype="float64")
    at = conditions("fields", n, backends[0])
    full = Entry("full frame", Fast(own), at)
    eight, height = (
        Entry("eight linear fields", Fast(own, EIGHT), at),
        Entry("height only", Fast(own, ("height",)), at),
    )
    wide = Entry("full frame", Fast(double), {**at, "dtype": "float64"})
    pairs = [
        Pair("eight linear fields / full frame", eight, full),
        Pair("height only / full frame", height, full),
        Pair("float64 / float32", wide, full),
    ]
    return race([full, eight, height, wide], pairs, clock="cpu", seconds=seconds)


def planning(n: int, backends: Sequence[str], seconds: float) -> list[Reading]:
    """Time a measured plan against an estimated one."""
    backend = backends[0]
    at = conditions("planning", n, backend)
    full = Entry("full frame", Fast(ocean(n, backend=backend)), at)
    quick = Entry(
        "full frame",
        Fast(ocean(n, backend=backend, planning="estimate")),
        {**at, "planning": "estimate"},
    )
    return race(
        [full, quick], [Pair("estimate / measure", quick, full)], clock="cpu", seconds=seconds
    )


def threads(n: int, backends: Sequence[str], seconds: float) -> list[Reading]:
    """Time one thread against several, in elapsed time."""
    counts = sorted({2, host.cores()} - {1})
    readings = []
    for backend in backends:
        entries = [
            Entry(
                "full frame",
                Fast(ocean(n, backend=backend, threads=count)),
                {**conditions("threads", n, backend), "threads": count},
            )
            for count in (1, *counts)
        ]
        pairs = [Pair("one thread / more", entries[0], more) for more in entries[1:]]
        readings += race(entries, pairs, clock="wall", seconds=seconds / len(backends))
    return readings


def conditions(of: str, n: int, backend: str) -> dict[str, Condition]:
    """Return the conditions of a full frame in a race."""
    return {
        "race": of,
        "n": n,
        "backend": backend,
        "planning": "measure",
        "dtype": "float32",
        "threads": 1,
    }


def draw(result: Result, path: Path) -> None:
    """Draw the cost against n of every contender, and its ratio to the full frame."""
    backends = result.settings["backends"]
    shades = dict(zip(backends, (BLUE, "#00805d", "#56b4e9"), strict=False))
    best = min(backends, key=lambda name: sum(r.median for r in mains(result, name)))
    with sheet(path, ASKS, result, width=12.5, height=6.0) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.2, 1.0))
        lines = []
        for what, label, colour in (
            ("textbook", "textbook NumPy", COLOURS["textbook"]),
            ("careful", "careful SciPy", COLOURS["careful"]),
        ):
            lines.append(curve(label, result.all(what), colour))
        for name in backends:
            lines.append(curve(f"fftocean, {name}", mains(result, name), shades[name], width=2.6))
            if bare := result.all("floor", backend=name):
                lines.append(
                    curve(f"bare transforms, {name}", bare, shades[name], style=":", marker="")
                )
        curves(
            left,
            lines,
            xlabel="samples a side, n",
            ylabel="one full frame, one thread [ms]",
            sizes=result.settings["n"],
        )
        left.set_title("Cost against resolution")
        measured = sorted(int(r.at["n"]) for r in mains(result, best))
        n = 512 if 512 in measured else measured[-1]
        ours = result.find("full frame", race="others", n=n, backend=best).median
        rows = []
        for label, what, at, colour in (
            ("textbook NumPy", "textbook / full frame", {"backend": best}, COLOURS["textbook"]),
            (
                "its eight ifft2 alone",
                "textbook, its eight ifft2 alone / full frame",
                {"backend": best},
                COLOURS["textbook"],
            ),
            ("careful SciPy", "careful / full frame", {"backend": best}, COLOURS["careful"]),
            ("ours in float64", "float64 / float32", {}, "#7fb8d8"),
            ("ours", "", {}, BLUE),
            ("eight linear fields", "eight linear fields / full frame", {}, "#7fb8d8"),
            ("height only", "height only / full frame", {}, "#7fb8d8"),
        ):
            times = result.find(what, n=n, **at).median if what else 1.0
            rows.append(
                (
                    label,
                    times,
                    f"{plain(round(times, 2))}" if what else f"1, {duration(ours)} with {best}",
                    colour,
                )
            )
        for r in result.all("one thread / more", n=n, backend=best):
            rows.append(
                (
                    f"{r.at['threads']} threads",
                    1.0 / r.median,
                    f"{1.0 / r.median:.2f} ({r.median:.2f} times as fast)",
                    "#7fb8d8",
                )
            )
        bars(right, rows)
        right.set_title(f"{n} x {n}: how many times as long as our full frame")


def mains(result: Result, backend: str) -> list[Reading]:
    """Return the full frames of the main race."""
    return result.all("full frame", race="others", backend=backend)


def curve(label: str, readings: Sequence[Reading], colour: str, **how: str | float) -> Line:
    """Return a line through readings, by n, with their quartiles as a band."""
    rows = sorted(readings, key=lambda r: r.at["n"])
    return Line(
        label,
        [r.at["n"] for r in rows],
        [r.median for r in rows],
        colour,
        [r.low for r in rows],
        [r.high for r in rows],
        **how,
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "frame", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
