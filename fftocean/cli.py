"""The command line: `fftocean bake | info | verify | plot | presets`. The only room that prints."""

import argparse
import contextlib
import math
import os
import signal
import sys
import threading
import time
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import fftocean
from fftocean.errors import FFTOceanError, OutputError, SeaWarning

if TYPE_CHECKING:
    from rich.console import Console

    from fftocean.bake.job import Job

EPILOG = """\
exit codes: 0 ok, 2 usage or job, 3 bad input file, 4 output, 5 integrity, 6 folder in use, 130 interrupted
"""
EXAMPLES = {
    "bake": "fftocean bake -o sea\nfftocean bake gale.toml -o gale --n 512 --set sea.wind.speed=22",
    "info": "fftocean info\nfftocean info gale.toml --size 800",
    "verify": "fftocean verify\nfftocean verify gale.toml --n 128",
    "plot": "fftocean plot\nfftocean plot gale.toml -o gale.png",
    "presets": "fftocean presets",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; return its exit code."""
    try:
        with _sigterm_leaves(), warnings.catch_warnings():
            warnings.simplefilter("always", SeaWarning)
            warnings.showwarning = _show_warning
            options = _parser().parse_args(arguments)
            code: int = options.run(options)
            if sys.stdout:
                sys.stdout.flush()  # what cannot be printed shows here, not after the last line
            return code
    except FFTOceanError as error:
        return _fail(str(error), error.exit_code)
    except KeyboardInterrupt:
        return _fail("interrupted; a folder without manifest.json is not a finished bake", 130)
    except MemoryError:
        return _fail("not enough memory; a smaller --n needs less", 2)
    except BrokenPipeError:  # the reader of a pipe went away: nothing to say, and nowhere to say it
        _drop_stdout()
        return 0
    except OSError as error:
        _drop_stdout()
        return _fail(f"{error.filename or 'output'}: {error.strerror or error}", OutputError.exit_code)


@contextlib.contextmanager
def _sigterm_leaves() -> Iterator[None]:
    """Let SIGTERM leave as Ctrl-C does, past all that cleans up; only a main thread can, and it gives the signal back."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, _terminated)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL if before is None else before)


def _terminated(*_: object) -> NoReturn:
    """SIGTERM: leave as for Ctrl-C, with the shell's own code for it."""
    raise SystemExit(128 + signal.SIGTERM)


def _drop_stdout() -> None:
    """Let what is still to be printed go nowhere, so that leaving does not fail for it a second time."""
    with contextlib.suppress(OSError, ValueError, AttributeError):  # a stdout without a file, or none
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def _fail(message: str, code: int) -> int:
    print(f"fftocean: {_plain(message)}", file=sys.stderr)
    return code


def _show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    print(f"note: {_plain(message)}", file=sys.stderr)


def _plain(text: object) -> str:
    """Text on one line, with nothing in it that a terminal would obey or could not show: names of files may hold anything."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text))


def _parser() -> argparse.ArgumentParser:
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(
        prog="fftocean",
        description="Order a sea in the words of oceanography, get a tile of water that repeats without a seam in space and in time.",
        epilog="example:\n  fftocean bake -o sea\n\n" + EPILOG,
        formatter_class=raw,
    )
    parser.add_argument("--version", action="version", version=f"fftocean {fftocean.__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, run, summary in (
        ("bake", _bake, "write a looping sequence of maps, a manifest and a contact sheet"),
        ("info", _info, "say what a job means: the sea, the tile, the loop, the files, the time it takes"),
        ("verify", _verify, "prove the tile: FFT against the direct sum, seam, loop, Parseval, energy"),
        ("plot", _plot, "draw the sea that is ordered, and what the tile delivers of it"),
        ("presets", _presets, "list the Beaufort scale and the sea states, with the height each promises and delivers"),
    ):
        examples = "\n".join("  " + line for line in EXAMPLES[name].splitlines())
        command = commands.add_parser(
            name, help=summary, description=summary, epilog=f"example:\n{examples}\n\n{EPILOG}", formatter_class=raw
        )
        command.set_defaults(run=run)
        if name == "presets":
            continue
        command.add_argument("job", nargs="?", metavar="JOB.toml", type=Path, help="a job file; without one, the embedded default sea")
        _add_job_flags(command)
        if name == "bake":
            command.add_argument("-o", "--output", type=_path, default=Path("out"), metavar="DIR", help="folder to write to (default: out)")
            command.add_argument("--overwrite", action="store_true", help="bake over another job's folder")
            command.add_argument("--quiet", action="store_true", help="no progress bar and no summary")
        if name == "plot":
            help_ = "picture to write, .png, .svg or .pdf (default: sea.png)"
            command.add_argument("-o", "--output", type=_path, default=Path("sea.png"), metavar="FILE", help=help_)
        if name == "verify":
            command.add_argument("--t", type=float, default=3.7, metavar="T", help="time to look at [s] (default: 3.7)")
            command.add_argument("--dtype", choices=("float32", "float64"), default="float64", help="precision (default: float64)")
    return parser


def _path(text: str) -> Path:
    """A path that was really given: an empty one is nearly always a shell variable that is not set, and would be the current folder."""
    if not text:
        raise argparse.ArgumentTypeError("must not be empty")
    return Path(text)


def _add_job_flags(command: argparse.ArgumentParser) -> None:
    """Flags for the keys that have one, and --set for all."""
    from fftocean.bake.parameters import PARAMETERS

    group = command.add_argument_group("keys of the job (flags override the file)")
    for p in PARAMETERS:
        if p.flag:
            unit = f" [{p.unit}]" if p.unit else ""
            default = ",".join(p.default) if p.many else f"{p.default:g}" if isinstance(p.default, float) else p.default
            group.add_argument(f"--{p.flag}", metavar=p.flag.upper(), help=f"{p.help}{unit} (default: {default})".replace("%", "%%"))
    group.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="any key of a job file, such as sea.wind.speed=12")


def _job(options: argparse.Namespace) -> "Job":
    """The job of a command: file or default, then --set, then flags."""
    from fftocean.bake.job import Job, parse_setting, parse_value
    from fftocean.bake.parameters import BY_KEY, PARAMETERS

    job = Job.default() if options.job is None else Job.read(options.job)
    changes = dict(parse_setting(text) for text in options.set)
    for p in PARAMETERS:
        if p.flag and (text := getattr(options, p.flag)) is not None:
            changes[p.key] = parse_value(text)
    for key, value in changes.items():
        if key in BY_KEY and BY_KEY[key].many and isinstance(value, str):
            changes[key] = [value]
    return job.replaced(changes)


def _bake(options: argparse.Namespace) -> int:
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    from fftocean.bake.baker import PREVIEW_FILE, bake

    job = _job(options)
    console = _console(stderr=True)
    shown = console.is_terminal and sys.stderr.isatty() and not options.quiet  # colours may be forced on a file, a bar may not
    start = time.perf_counter()
    columns = (TextColumn("baking"), BarColumn(), MofNCompleteColumn(), TextColumn("frames"), TimeRemainingColumn())
    with Progress(*columns, console=console, disable=not shown, transient=True) as bar:
        task = bar.add_task("frames", total=job.frames)
        manifest = bake(job, options.output, overwrite=options.overwrite, progress=lambda done, _: bar.update(task, completed=done))
    if not options.quiet:
        files = sum(len(row["files"]) for row in manifest["frames"])
        statistics = manifest["statistics"]
        _advise(manifest["statistics"])
        print(f"Hs {statistics['ordered']['hs']:.3g} m ordered, {statistics['hs']:.3g} m delivered; Tp {statistics['ordered']['tp']:.3g} s")
        nx, ny = manifest["ocean"]["n"]
        print(f"{files} maps of {nx} x {ny} in {time.perf_counter() - start:.1f} s: {_plain(options.output)}")
        print(f"look at {_plain(options.output / PREVIEW_FILE)}")
    return 0


def _advise(statistics: dict[str, Any]) -> None:
    """Say on stderr what the tile cannot hold, where that is much."""
    ordered = statistics["ordered"]["m0"]
    if ordered == 0.0:
        print("note: the sea is exactly flat", file=sys.stderr)
        return
    for key, words in (
        ("energy_below", "longer than the tile; a larger --size holds them"),
        ("energy_above", "shorter than two samples; a larger --n holds them"),
    ):
        if (share := statistics[key] / ordered) > 0.02:
            print(f"note: {100 * share:.0f} % of the energy is in waves {words}", file=sys.stderr)


def _info(options: argparse.Namespace) -> int:
    from dataclasses import asdict

    from rich.table import Table
    from rich.text import Text

    from fftocean import dispersion
    from fftocean.bake.maps import MAPS
    from fftocean.bake.parameters import PARAMETERS
    from fftocean.export import exr
    from fftocean.ocean import memory_needed
    from fftocean.statistics import measure

    job = _job(options)
    ocean = job.ocean()
    statistics, grid = measure(ocean), ocean.grid
    console = _console()
    table = Table(title=Text(f"Job: {_plain(job.source)}"), title_justify="left", show_header=False, box=None, pad_edge=False)
    units = {p.key: p.unit for p in PARAMETERS}
    for key, value in job.describe().items():
        if key == "sea.systems":
            for i, system in enumerate(value):
                table.add_row(f"sea.systems[{i}]", Text(_short(system)))
        else:
            table.add_row(key, f"{_words(value)} {units[key]}".rstrip())
    console.print(table)
    ordered = statistics.ordered
    assert ordered is not None  # a job has a sea
    table = Table(title="\nSea", title_justify="left", box=None, pad_edge=False)
    for heading in ("", "ordered", "delivered by this draw", "expect to scatter by"):
        table.add_column(heading, justify="left" if not heading else "right")
    scatter = 0.5 * statistics.sampling_error * statistics.hs
    table.add_row("significant wave height Hs", f"{ordered.hs:.3f} m", f"{statistics.hs:.3f} m", f"{scatter:.3f} m")
    table.add_row("peak period Tp", f"{ordered.tp:.2f} s", f"{statistics.tp:.2f} s")
    table.add_row("mean direction, toward", f"{ordered.mean_direction:.1f} deg", f"{statistics.mean_direction:.1f} deg")
    table.add_row("directional spread", f"{ordered.spread:.1f} deg", f"{statistics.spread:.1f} deg")
    console.print(table)
    table = Table(title="\nTile", title_justify="left", show_header=False, box=None, pad_edge=False)
    if ordered.m0 > 0.0:
        length = 2.0 * math.pi / float(dispersion.wavenumber(2.0 * math.pi / ordered.tp, ocean.depth, ocean.amplitudes.surface_tension))
        table.add_row("peak wavelength", f"{length:.3g} m: {min(grid.lx, grid.ly) / length:.1f} of them across the tile")
    table.add_row("smallest wave", f"{2.0 * max(grid.lx / grid.nx, grid.ly / grid.ny):.3g} m, two samples")
    lost = (statistics.energy_below / ordered.m0, statistics.energy_above / ordered.m0) if ordered.m0 else (0.0, 0.0)
    table.add_row("energy it cannot hold", f"{100 * lost[0]:.2f} % in longer waves, {100 * lost[1]:.2f} % in shorter ones")
    if statistics.loop:
        e = statistics.loop
        better = f"; {e.better_period:g} s would have {100 * e.better_rms:.1f} %" if e.better_period != e.period else ""
        table.add_row("loop frequency error", f"{100 * e.rms:.1f} % rms, {100 * e.bias:+.1f} % bias{better}")
    table.add_row("FFT library", ocean.backend)
    needs = tuple(dict.fromkeys([*(need for name in job.maps for need in MAPS[name].needs), "height", "jacobian"]))
    frame = ocean.loop_frame(0, job.frames, needs)
    start = time.perf_counter()
    frame = ocean.loop_frame(min(1, job.frames - 1), job.frames, needs, out=frame)
    sizes = [len(exr.encode_half(*MAPS[name].channels(frame))) for name in job.maps]
    seconds = (time.perf_counter() - start) * job.frames + 3.0
    table.add_row("files", f"{len(job.maps) * job.frames} EXR + manifest and preview, about {sum(sizes) * job.frames / 1e6:.0f} MB")
    table.add_row("memory", f"about {memory_needed(grid, ocean.dtype) / 2**20:.0f} MiB")
    table.add_row("time to bake", f"about {seconds:.0f} s here")
    console.print(table)
    _advise(asdict(statistics))
    return 0


def _verify(options: argparse.Namespace) -> int:
    from rich.table import Table
    from rich.text import Text

    from fftocean.limits import TIME
    from fftocean.proof import verify

    t = TIME.check("t", options.t)
    job = _job(options)
    ocean = job.ocean(dtype=options.dtype)
    checks = verify(ocean, t)
    title = f"{_plain(job.source)}: {ocean.grid.nx} x {ocean.grid.ny}, {ocean.dtype}, t = {t:g} s"
    table = Table(title=Text(title), title_justify="left")
    for heading in ("what", "against", "apart", "allowed", "because", ""):
        table.add_column(heading, justify="right" if heading in ("apart", "allowed") else "left")
    for c in checks:
        verdict = "[green]ok[/]" if c.passed else "[bold red]FAILED[/]"
        table.add_row(c.name, c.against, f"{c.figure:.1e}", f"{c.bound:.1e}", c.reason, verdict)
    _console().print(table)
    failed = [c.name for c in checks if not c.passed]
    print(f"{len(checks) - len(failed)} of {len(checks)} checks passed" + (f"; failed: {', '.join(failed)}" if failed else ""))
    return 5 if failed else 0


def _plot(options: argparse.Namespace) -> int:
    from fftocean import plots

    path = plots.save(plots.plot_job(_job(options).ocean()), options.output)
    print(f"look at {_plain(path)}")
    return 0


def _presets(_: argparse.Namespace) -> int:
    from rich.table import Table

    from fftocean.physics import presets

    console = _console()
    for title, call, rows in (
        ("Beaufort scale: U10, and the probable wave height of the open sea", "Sea.beaufort", presets.beaufort_table()),
        ("Sea states, WMO code table 3700: middle of the range, fully developed", "Sea.sea_state", presets.sea_state_table()),
    ):
        table = Table(title=title, title_justify="left", box=None, pad_edge=False)
        for heading in ("call", "name", "wind m/s", "knots", "Hs promised m", "Hs by quadrature m", "Tp s"):
            table.add_column(heading, justify="left" if heading in ("call", "name") else "right")
        for row in rows:
            numbers = (f"{row.wind:.1f}", f"{row.wind_knots:.0f}", f"{row.hs:.3f}", f"{row.measured_hs:.9f}", f"{row.tp:.1f}")
            table.add_row(f"{call}({row.number})", row.name, *numbers)
        console.print(table)
        console.print()
    return 0


def _console(*, stderr: bool = False) -> "Console":
    """A console that is as wide as it needs where there is no terminal to fit."""
    from rich.console import Console

    console = Console(stderr=stderr, highlight=False)
    return console if console.is_terminal else Console(stderr=stderr, highlight=False, width=140)


def _words(value: Any) -> str:
    """A value of a job as one writes it."""
    if isinstance(value, list):
        return ", ".join(_words(v) for v in value)
    return f"{value:g}" if isinstance(value, float) else str(value)


def _short(value: Any) -> str:
    """A wave system on one line, long lists cut."""
    text = str(value)
    return text if len(text) <= 110 else text[:107] + "..."


if __name__ == "__main__":
    sys.exit(main())
