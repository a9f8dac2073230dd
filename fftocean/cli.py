"""The command line: `fftocean bake | check | info | verify | bench | plot | presets`."""

import argparse
import contextlib
import difflib
import json
import math
import os
import re
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import fftocean
from fftocean.errors import FFTOceanError, OutputError, SeaWarning

if TYPE_CHECKING:
    from rich.console import Console

    from fftocean.baking.estimate import Estimate
    from fftocean.baking.finished.check import Finding
    from fftocean.job.job import Job

EPILOG = """\
exit codes: 0 ok, 2 usage or job, 3 bad input file, 4 output, 5 integrity,
            6 folder in use, 130 interrupted
"""
EXAMPLES = {
    "bake": "fftocean bake -o sea\nfftocean bake gale.toml -o gale --n 512 --set sea.wind.speed=22\n"
    "fftocean bake -o sea --fps 30 --engine godot --format exr-atlas\n"
    "fftocean bake gale.toml -o part --frames 0:64:2 --downsample 2 --dry-run",
    "check": "fftocean check sea\nfftocean check sea --repair",
    "info": "fftocean info\nfftocean info gale.toml --size 800",
    "verify": "fftocean verify\nfftocean verify gale.toml --n 128",
    "bench": "fftocean bench\nfftocean bench --seconds 30 --n 256 512 -o here.png --json here.json",
    "plot": "fftocean plot\nfftocean plot gale.toml -o gale.png",
    "presets": "fftocean presets",
}
TRY = """\
usage: fftocean COMMAND [options]

try:
  fftocean bake -o sea        bake the default sea, then look at sea/preview.png
  fftocean info               describe it: waves, tile, loop, files, memory, time
  fftocean bake --help        every option of a command
  fftocean --help             all commands
"""


class _Parser(argparse.ArgumentParser):
    """A parser that answers with its own command's usage and the nearest word that it knows."""

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> tuple[Any, list[str]]:
        """Refuse here what this command does not know, before the main parser does."""
        known, unknown = super().parse_known_args(args, namespace)
        if unknown:
            flag = next((word for word in unknown if word.startswith("-")), "").partition("=")[0]
            hint = _nearest(flag, self._option_string_actions, 0.7) or _key_of(flag)
            self.error(f"unrecognized arguments: {' '.join(unknown)}{hint}")
        return known, unknown

    def error(self, message: str) -> NoReturn:
        """Print a short usage and the error on stderr; leave with 2."""
        if choice := re.search(r"invalid choice: '(.*?)' \(choose from (.*)\)", message):
            words = re.findall(r"[\w.-]+", choice[2])
            message += _nearest(choice[1], words)
        self.print_usage(sys.stderr)
        self.exit(2, f"{self.prog}: error: {_plain(message)}; see {self.prog} --help\n")


def _nearest(word: str, known: Iterable[str], cutoff: float = 0.6) -> str:
    """Return a suggestion for a misspelt word, or nothing."""
    near = difflib.get_close_matches(word, list(known), 1, cutoff)
    return f"; did you mean {near[0]}?" if near else ""


def _key_of(flag: str) -> str:
    """
    Return a suggestion for a flag that is a key of a job without a flag of its own, or nothing.
    """
    from fftocean.job.parameters import PARAMETERS

    word = flag.lstrip("-").replace("-", "_")
    keys = [p.key for p in PARAMETERS if word and word in p.key.split(".")]
    return f"; did you mean --set {keys[0]}=VALUE?" if keys else ""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; return its exit code."""
    try:
        with _sigterm_leaves(), warnings.catch_warnings():
            warnings.simplefilter("always", SeaWarning)
            warnings.showwarning = _show_warning
            given = sys.argv[1:] if arguments is None else arguments
            if not given:
                print(TRY, end="", file=sys.stderr)
                return 2
            options = _parser().parse_args(given)
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
        return _fail(
            f"{error.filename or 'output'}: {error.strerror or error}", OutputError.exit_code
        )


@contextlib.contextmanager
def _sigterm_leaves() -> Iterator[None]:
    """
    Let SIGTERM leave as Ctrl-C does, past all that cleans up; only a main thread can, and it gives
    the signal back.
    """
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
    """
    Let what is still to be printed go nowhere, so that leaving does not fail for it a second time.
    """
    with contextlib.suppress(
        OSError, ValueError, AttributeError
    ):  # a stdout without a file, or none
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def _fail(message: str, code: int) -> int:
    print(f"fftocean: {_plain(message)}", file=sys.stderr)
    return code


def _show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    print(f"note: {_plain(message)}", file=sys.stderr)


def _plain(text: object) -> str:
    """
    Text on one line, with nothing in it that a terminal would obey or could not show: names of
    files may hold anything.
    """
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text))


def _parser() -> argparse.ArgumentParser:
    raw = argparse.RawDescriptionHelpFormatter
    parser = _Parser(
        prog="fftocean",
        usage="fftocean COMMAND [options]",
        description="Specify a sea state; get a seamlessly tiling, looping ocean surface;\n"
        "verify that it has the statistics you asked for; export it to any game engine.",
        epilog="example:\n  fftocean bake -o sea\n\n" + EPILOG,
        formatter_class=raw,
    )
    parser.add_argument("--version", action="version", version=f"fftocean {fftocean.__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, run, given, summary, add_flags in (
        (
            "bake",
            _bake,
            "[JOB.toml] [-o DIR]",
            "write a looping sequence of maps, a manifest and previews",
            _add_bake_flags,
        ),
        (
            "check",
            _check,
            "DIR",
            "find files of a bake that are missing or changed, and maps that fail physical checks",
            _add_check_flags,
        ),
        (
            "info",
            _info,
            "[JOB.toml] [--tiles N:SIZE,...]",
            "describe a job: sea, tile, loop, files, memory, time",
            _add_info_flags,
        ),
        (
            "verify",
            _verify,
            "[JOB.toml]",
            "verify the tile: FFT against the direct sum, seam, loop, Parseval, energy",
            _add_verify_flags,
        ),
        (
            "bench",
            _bench,
            "[-o FILE]",
            "measure the cost of a frame here, beside a textbook FFT and the direct sum (two minutes)",
            _add_bench_flags,
        ),
        (
            "plot",
            _plot,
            "[JOB.toml] [-o FILE]",
            "plot the specified sea and what the tile realises of it",
            _add_plot_flags,
        ),
        (
            "presets",
            _presets,
            "",
            "list the Beaufort scale and the sea states, with wind, wave height and period",
            lambda _: None,
        ),
    ):
        examples = "\n".join("  " + line for line in EXAMPLES[name].splitlines())
        command = commands.add_parser(
            name,
            prog=f"fftocean {name}",
            usage=f"fftocean {name} {given} [options]".replace("  ", " "),
            help=summary,
            description=summary,
            epilog=f"example:\n{examples}\n\n{EPILOG}",
            formatter_class=raw,
        )
        command.set_defaults(run=run)
        add_flags(command)
    return parser


def _add_bake_flags(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "-o",
        "--output",
        type=_path,
        default=Path("out"),
        metavar="DIR",
        help="folder to write to (default: out)",
    )
    command.add_argument(
        "--overwrite",
        action="store_true",
        help="replace a folder that holds another job (resuming needs no flag)",
    )
    command.add_argument(
        "--downsample",
        type=_whole,
        default=1,
        metavar="K",
        help="bake 1/K of the samples a side; waves too short for it are dropped",
    )
    _add_tiles_flag(command)
    command.add_argument(
        "--dry-run",
        action="store_true",
        help="print what would be written; refuse what a bake would refuse",
    )
    _add_work_flags(command)
    command.add_argument(
        "--json",
        action="store_true",
        help="print events as lines of JSON: start, survey, frame, done, error",
    )
    command.add_argument("--quiet", action="store_true", help="no progress bar and no summary")
    _add_job_flags(command)


def _add_info_flags(command: argparse.ArgumentParser) -> None:
    _add_tiles_flag(command)
    _add_job_flags(command)


def _add_tiles_flag(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--tiles",
        type=_tiles,
        metavar="N:SIZE,...",
        help="one sea on several tiles, such as 512:500,512:71,256:9.3, instead of --n and --size",
    )


def _add_check_flags(command: argparse.ArgumentParser) -> None:
    command.add_argument("folder", metavar="DIR", type=_path, help="folder of a bake")
    command.add_argument(
        "--repair", action="store_true", help="write wrong files again, with the same bytes"
    )
    command.add_argument(
        "--job",
        metavar="JOB.toml",
        type=_path,
        help="job file; measured spectra are looked up next to it",
    )
    _add_work_flags(command)
    command.add_argument(
        "--json",
        action="store_true",
        help="print findings as lines of JSON: finding, frame, done, error",
    )
    command.add_argument(
        "--quiet", action="store_true", help="no progress bar; print nothing if there is no problem"
    )


def _add_work_flags(command: argparse.ArgumentParser) -> None:
    help_ = "serial, processes, dask, a scheduler's tcp://..., or auto: processes where that is faster (default: auto)"
    command.add_argument("--executor", default="auto", metavar="NAME", help=help_)
    command.add_argument(
        "--workers",
        type=_whole,
        metavar="N",
        help="number of workers (default: one for each processor)",
    )


def _add_verify_flags(command: argparse.ArgumentParser) -> None:
    _add_job_flags(command)
    command.add_argument(
        "--t",
        type=float,
        default=3.7,
        metavar="T",
        help="time of the frame to verify [s] (default: 3.7)",
    )
    command.add_argument(
        "--dtype",
        choices=("float32", "float64"),
        default="float64",
        help="precision (default: float64)",
    )


def _add_bench_flags(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--seconds",
        type=float,
        default=120.0,
        metavar="S",
        help="approximate time to take [s] (default: 120)",
    )
    command.add_argument(
        "--n",
        type=int,
        nargs="+",
        metavar="N",
        help="samples a side to measure (default: 128 256 512 1024)",
    )
    command.add_argument(
        "-o",
        "--output",
        type=_path,
        default=Path("bench.png"),
        metavar="FILE",
        help="picture to write (default: bench.png)",
    )
    command.add_argument("--no-picture", action="store_true", help="write no picture")
    command.add_argument("--json", type=_path, metavar="FILE", help="write the figures as JSON")
    command.add_argument("--quiet", action="store_true", help="no progress bar")


def _add_plot_flags(command: argparse.ArgumentParser) -> None:
    _add_job_flags(command)
    help_ = "picture to write, .png, .svg or .pdf (default: sea.png)"
    command.add_argument(
        "-o", "--output", type=_path, default=Path("sea.png"), metavar="FILE", help=help_
    )


def _whole(text: str) -> int:
    """A whole number, at least 1."""
    if not (text.isascii() and text.isdigit() and int(text[:9]) > 0 and len(text) < 10):
        raise argparse.ArgumentTypeError(f"must be a whole number from 1 on, got {text!r:.40}")
    return int(text)


def _path(text: str) -> Path:
    """
    A path that was really given: an empty one is nearly always a shell variable that is not set,
    and would be the current folder.
    """
    if not text:
        raise argparse.ArgumentTypeError("must not be empty")
    return Path(text)


def _add_job_flags(command: argparse.ArgumentParser) -> None:
    """Add the job file, flags for the keys that have one, and --set for all."""
    from fftocean.job.parameters import PARAMETERS

    command.add_argument(
        "job",
        nargs="?",
        metavar="JOB.toml",
        type=Path,
        help="a job file; without one, the embedded default sea",
    )
    group = command.add_argument_group("keys of the job (flags override the file)")
    for p in PARAMETERS:
        if p.flag and p.switch:
            group.add_argument(
                f"--{p.flag}",
                action=argparse.BooleanOptionalAction,
                help=f"{p.help} (default: {'yes' if p.default else 'no'})",
            )
        elif p.flag:
            unit = f" [{p.unit}]" if p.unit else ""
            default = (
                ",".join(p.default)
                if p.many
                else f"{p.default:g}"
                if isinstance(p.default, float)
                else p.default
            )
            choices = f": {', '.join(p.choices)}" if p.choices else ""
            group.add_argument(
                f"--{p.flag}",
                metavar=p.flag.upper(),
                help=f"{p.help}{choices}{unit} (default: {default})".replace("%", "%%"),
            )
        if p.key == "bake.frames":
            help_ = "frames a second, instead of --frames: loop times rate must be a whole number"
            group.add_argument("--fps", type=float, metavar="RATE", help=help_)
    group.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="any key of a job file, such as sea.wind.speed=12",
    )


def _job(options: argparse.Namespace) -> "Job":
    """The job of a command: file or default, then --set, then flags."""
    from fftocean.job.job import Job, parse_setting, parse_value
    from fftocean.job.parameters import BY_KEY, PARAMETERS

    job = Job.default() if options.job is None else Job.read(options.job)
    changes = dict(parse_setting(text) for text in options.set)
    for p in PARAMETERS:
        if p.flag and (given := getattr(options, p.flag)) is not None:
            changes[p.key] = given if p.switch else parse_value(given)
    for key, value in changes.items():
        if key in BY_KEY and BY_KEY[key].many and isinstance(value, str):
            changes[key] = [value]
    job = job.replaced(changes)
    return job if options.fps is None else _at_rate(job, options.fps, changes)


def _at_rate(job: "Job", rate: float, changes: dict[str, Any]) -> "Job":
    """Return a job with as many frames as its loop has at a rate [1/s]."""
    from fftocean.errors import JobError

    if "bake.frames" in changes:
        raise JobError("--fps and a number of frames must not be given together; leave one out")
    if not (math.isfinite(rate) and rate > 0.0):
        raise JobError(f"--fps must be above 0 and finite, got {rate:g}")
    loop = job.settings["ocean.loop"]
    frames = round(loop * rate) if loop * rate < 1e9 else 0
    if frames < 1 or abs(loop * rate - frames) > 1e-6 * frames:
        near = max(1, min(round(loop * rate), 10**9)) if math.isfinite(loop * rate) else 1
        raise JobError(
            f"--fps must give the loop a whole number of frames, got {loop * rate:.6g} for "
            f"{loop:g} s at {rate:g} a second; {near} frames want --loop {near / rate:.6g}"
        )
    return job.replaced({"bake.frames": frames})


def _bake(options: argparse.Namespace) -> int:
    from fftocean.baking.folder.lock import require_free

    require_free(options.output)  # before anything is loaded that takes time
    subset = None
    if options.frames is not None and ":" in options.frames:
        subset, options.frames = options.frames, None
    with _events(options.json) as tell:
        job = _job(options)
        if options.tiles:
            return _bake_cascade(options, job, subset, tell)
        if options.dry_run:
            return _dry_run(options, job, subset)
        return _bake_job(options, job, subset, tell)


def _bake_job(
    options: argparse.Namespace,
    job: "Job",
    subset: str | None,
    tell: "Callable[[dict[str, Any]], None] | None",
) -> int:
    """Bake, with a bar that shows how far it is and a summary of what it made."""
    from fftocean.baking.bake import bake

    start = time.perf_counter()
    with _bar("baking", "frames", shown=not (options.quiet or options.json)) as show:
        at = {"done": 0, "frames": 0, "kept": 0}

        def listen(event: dict[str, Any]) -> None:
            at.update(
                done=event.get("kept", event.get("done", 0)), frames=event["frames"]
            ) if event["event"] in (
                "start",
                "frame",
            ) else None
            at["kept"] = event.get("kept", at["kept"])
            if event["event"] == "survey":
                show(event["done"], event["total"], f"surveying {event['what']}")
            elif at["frames"]:
                all_done = at["done"] == at["frames"]
                show(at["done"], at["frames"], "drawing pictures" if all_done else "baking")
            if tell:
                tell(event)

        try:
            manifest = bake(
                job,
                options.output,
                overwrite=options.overwrite,
                frames=subset,
                downsample=options.downsample,
                executor=options.executor,
                workers=options.workers,
                listen=listen,
            )
        except (KeyboardInterrupt, SystemExit):
            if at["frames"]:
                finished = f"{at['done']} of {at['frames']} frames are finished"
                print(f"note: {finished}; the same command goes on from there", file=sys.stderr)
            raise
    if not (options.quiet or options.json):
        _sum_up(options, manifest, time.perf_counter() - start, kept=at["kept"])
        _say_loading(job)
    return 0


def _bake_cascade(
    options: argparse.Namespace,
    job: "Job",
    subset: str | None,
    tell: "Callable[[dict[str, Any]], None] | None",
) -> int:
    """Bake one sea on several tiles, one after the other."""
    from fftocean.baking.cascade import bake_tiles, summary
    from fftocean.baking.folder.layout import CASCADE_FILE

    if options.dry_run:
        return _dry_run(options, job, subset)
    at: dict[str, Any] = {}
    with _bar("baking", "frames", shown=not (options.quiet or options.json)) as show:

        def listen(event: dict[str, Any]) -> None:
            if event["event"] in ("start", "frame"):
                at.update(
                    done=event.get("kept", event.get("done")),
                    **{key: event[key] for key in ("frames", "tile", "tiles")},
                )
                show(at["done"], at["frames"], f"baking tile {at['tile'] + 1} of {at['tiles']}")
            if tell:
                tell(event)

        work = {
            name: getattr(options, name)
            for name in ("overwrite", "downsample", "executor", "workers")
        }
        try:
            listed = bake_tiles(
                job, options.tiles, options.output, frames=subset, listen=listen, **work
            )
        except (KeyboardInterrupt, SystemExit):
            if at:
                finished = f"{at['done']} of {at['frames']} frames of tile {at['tile'] + 1} of {at['tiles']} are finished"
                print(f"note: {finished}; the same command goes on from there", file=sys.stderr)
            raise
    if not (options.quiet or options.json):
        _advise(listed["statistics"])
        for line in summary(listed):
            print(line)
        _note_folds(listed["extremes"])
        print(_blending(listed["blend"]))
        if "preview" in listed:
            print(f"look at {_plain(options.output / listed['preview']['path'])}")
        _say_loading(job)
        print(f"how to add them stands in {_plain(options.output / CASCADE_FILE)}")
    return 0


def _tiles(text: str) -> list[tuple[int, float]]:
    """Tiles as n:size,n:size."""
    try:
        return [(int(n), float(size)) for n, size in (tile.split(":") for tile in text.split(","))]
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"must be n:size,n:size such as 512:500,512:71,256:9.3, got {text!r:.80}"
        ) from None


def _sum_up(
    options: argparse.Namespace, manifest: dict[str, Any], seconds: float, kept: int
) -> None:
    """Print what was made, in three lines, and what to look at."""
    from fftocean.baking.folder.layout import SHEET

    statistics = manifest["statistics"]
    _advise(statistics)
    maps = sum(len(row["files"]) for row in manifest["frames"])
    specified = statistics["ordered"]
    realised = f"{statistics['hs']:.3g} m realised; Tp {specified['tp']:.3g} s"
    print(f"Hs {specified['hs']:.3g} m specified, {realised}")
    nx, ny = manifest["ocean"]["n"]
    frames = len(manifest["frames"])
    if kept == frames:
        print(
            f"nothing to bake: all {maps} maps of {nx} x {ny} were there: {_plain(options.output)}"
        )
    else:
        again = f", {kept} of {frames} frames were there" if kept else ""
        print(f"{maps} maps of {nx} x {ny} in {seconds:.1f} s{again}: {_plain(options.output)}")
    _note_folds(manifest["extremes"])
    print(_blending(manifest["blend"]))
    if "preview" in manifest:
        print(f"preview: {_plain(options.output / SHEET)}")


def _note_folds(extremes: Mapping[str, Any]) -> None:
    """Say on stderr that water is folded, where some is."""
    from fftocean.products import folding_sentence

    if extremes.get("folded", 0.0) > 0.0:
        shown = (extremes[name] for name in ("folded", "min_jacobian", "largest_choppiness"))
        print(f"note: {folding_sentence(*shown)}", file=sys.stderr)


def _say_loading(job: "Job") -> None:
    """Print how files of the format get into the engine, where a job names one."""
    from fftocean.export.engines import profile_for

    if job.engine != "canonical":
        print(f"{job.format} in {job.engine}: {profile_for(job.engine, job.format).note}")


def _blending(blend: dict[str, Any]) -> str:
    """What players that blend two frames lose, in a line."""
    rate, enough = blend["frames_per_second"], blend["enough"]
    kept = f"{100.0 * blend['height']:.0f} % of the waves' height, {100.0 * blend['slopes']:.0f} % of their slopes"
    more = (
        f"; {enough['slopes']['frames']} frames would keep 97 %"
        if blend["slopes"] < enough["amplitude"]
        else ""
    )
    return f"blending frames at {rate:.3g} a second keeps {kept}{more}"


def _dry_run(options: argparse.Namespace, job: "Job", subset: str | None) -> int:
    """Print what a bake would write; refuse what it would refuse."""
    from dataclasses import asdict

    from fftocean.baking.bake import scene_for
    from fftocean.baking.cascade import estimate_tiles
    from fftocean.baking.estimate import estimate
    from fftocean.baking.folder.identity import header_of, require_possible
    from fftocean.baking.folder.plan import frames_of
    from fftocean.baking.workers.choice import check_executor

    options.executor = check_executor(options.executor, options.workers)
    work = {
        "frames": subset,
        **{name: getattr(options, name) for name in ("downsample", "executor", "workers")},
    }
    if options.tiles:
        e = estimate_tiles(job, options.tiles, **work)
    else:
        chosen = frames_of(subset, job.frames)
        scene = scene_for(job, options.downsample, len(chosen))
        header = header_of(
            job, frames=chosen, downsample=options.downsample, backend=scene.ocean.backend
        )
        require_possible(options.output, header, overwrite=options.overwrite)
        e = estimate(job, **work)
    if options.json:
        _print_event({"event": "estimate", "folder": str(options.output), **asdict(e)})
        return 0
    who = f"{e.workers} {e.executor}" if e.executor != "serial" else "one process"
    print(
        f"would write {e.files} files, about {e.bytes / 1e6:.3g} MB, for {e.frames} frames to {_plain(options.output)}"
    )
    print(f"about {e.seconds:.0f} s here, by {who}")
    print(f"memory: {_memory(e)}")
    print(f"video memory of the maps in an engine: {_video(e)}")
    _say_loading(job)
    return 0


def _memory(e: "Estimate") -> str:
    """Return the memory of a bake in words."""
    each = f"about {_mebibytes(e.memory)} in each of {e.workers} at work"
    return each + (f", then {_mebibytes(e.container)} for the container" if e.container else "")


def _video(e: "Estimate") -> str:
    """Return the video memory of a bake in words."""
    return f"{_mebibytes(e.video)} for {e.frames} frames, {_mebibytes(e.video / e.frames)} a frame"


def _mebibytes(size: float) -> str:
    """Return a number of bytes in MiB, or in GiB where it is that large."""
    number = size / 2**20
    return f"{number / 1024:.3g} GiB" if number >= 1000.0 else f"{number:.3g} MiB"


def _check(options: argparse.Namespace) -> int:
    from fftocean.baking.finished.check import check
    from fftocean.baking.finished.manifest import read_manifest
    from fftocean.baking.folder.layout import is_cascade
    from fftocean.baking.folder.listing import read_listing
    from fftocean.job.job import Job

    with _events(options.json) as tell:
        with _bar("checking", "maps", shown=not (options.quiet or options.json)) as show:
            findings = check(
                options.folder, progress=lambda done, total: show(done, total, "checking")
            )
        _report(findings, options, tell)
        if findings and options.repair:
            from fftocean.baking.repair import repair

            again: list[int] = []

            def listen(event: dict[str, Any]) -> None:
                if event["event"] == "frame":
                    again.append(event["frame"])
                if tell:
                    tell(event)

            job = None if options.job is None else Job.read(options.job)
            repair(
                options.folder,
                job,
                executor=options.executor,
                workers=options.workers,
                listen=listen,
            )
            if not options.json:
                print(f"repaired: {len(again)} frames were written again")
            findings = check(options.folder)
            _report(findings, options, tell)
        if not findings and not options.json:
            listed = is_cascade(options.folder)
            _note_folds((read_listing if listed else read_manifest)(options.folder)["extremes"])
        if tell:
            tell({"event": "done", "findings": len(findings)})
    return 5 if findings else 0


def _report(
    findings: "Sequence[Finding]",
    options: argparse.Namespace,
    tell: "Callable[[dict[str, Any]], None] | None",
) -> None:
    """What was found, for people or for programs."""
    if tell:
        from dataclasses import asdict

        for finding in findings:
            tell({"event": "finding", **asdict(finding)})
        return
    if not findings:
        if not options.quiet:
            print(f"no problems found: {_plain(options.folder)}")
        return
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False)
    for heading in ("what", "file", "frame", ""):
        table.add_column(
            heading, justify="right" if heading == "frame" else "left", overflow="fold"
        )
    for f in findings:
        table.add_row(
            f.kind,
            Text(_plain(f.path)),
            "" if f.frame is None else str(f.frame),
            Text(_plain(f.detail)),
        )
    _console().print(table)
    print(f"{len(findings)} problem{'s' * (len(findings) != 1)}: {_plain(options.folder)}")


def _bench(options: argparse.Namespace) -> int:
    from fftocean.bench import main as bench

    status = _console(stderr=True)
    shown = status.is_terminal and sys.stderr.isatty() and not options.quiet
    picture = None if options.no_picture else options.output
    code: int = bench(
        _console(),
        seconds=options.seconds,
        sizes=options.n or None,
        picture=picture,
        json=options.json,
        status=status if shown else None,
    )
    return code


@contextlib.contextmanager
def _events(wanted: bool) -> "Iterator[Callable[[dict[str, Any]], None] | None]":
    """
    Lines of JSON on stdout, the last of them the error where there is one; None where people are to
    read it.
    """
    if not wanted:
        yield None
        return
    try:
        yield _print_event
    except FFTOceanError as error:
        _print_event({"event": "error", "message": str(error), "exit_code": error.exit_code})
        raise
    except KeyboardInterrupt:
        _print_event({"event": "error", "message": "interrupted", "exit_code": 130})
        raise
    except SystemExit as leaving:
        _print_event({"event": "error", "message": "terminated", "exit_code": leaving.code})
        raise


def _print_event(event: dict[str, Any]) -> None:
    print(json.dumps(event, ensure_ascii=True, allow_nan=False), flush=True)


@contextlib.contextmanager
def _bar(title: str, things: str, *, shown: bool) -> "Iterator[Callable[[int, int, str], None]]":
    """
    A progress bar with its ETA on a terminal, and nothing anywhere else; called with (done, total,
    what).
    """
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeRemainingColumn,
    )

    console = _console(stderr=True)
    shown = (
        shown and console.is_terminal and sys.stderr.isatty()
    )  # colours may be forced on a file, a bar may not
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn(things),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, disable=not shown, transient=True) as bar:
        task = bar.add_task(title, total=None)
        yield lambda done, total, what: bar.update(
            task, completed=done, total=total, description=what
        )


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

    from fftocean import blend_loss as blend
    from fftocean import dispersion
    from fftocean.baking.bake import scene_for
    from fftocean.baking.estimate import estimate
    from fftocean.job.parameters import PARAMETERS
    from fftocean.statistics import measure

    job = _job(options)
    if options.tiles:
        return _info_of_tiles(options, job)
    scene = scene_for(job, 1, job.frames)
    ocean = scene.ocean
    statistics, grid = measure(ocean, frames=min(job.frames, 8)), ocean.grid
    console = _console()
    table = Table(
        title=Text(f"Job: {_plain(job.source)}"),
        title_justify="left",
        show_header=False,
        box=None,
        pad_edge=False,
    )
    units = {p.key: p.unit for p in PARAMETERS}
    for key, value in job.describe().items():
        if key == "sea.systems":
            for i, system in enumerate(value):
                table.add_row(f"sea.systems[{i}]", Text(_short(system)))
        else:
            table.add_row(key, f"{_words(value)} {units[key]}".rstrip())
    console.print(table)
    for key, notes in job.measured_notes().items():
        for note in notes:
            console.print(Text(f"{key}: {_plain(note)}"))
    ordered = statistics.ordered
    assert ordered is not None  # a job has a sea
    table = Table(title="\nSea", title_justify="left", box=None, pad_edge=False)
    for heading in ("", "specified", "realised", "expected scatter (1 sigma)"):
        table.add_column(heading, justify="left" if not heading else "right", no_wrap=not heading)
    scatter = 0.5 * statistics.sampling_error * statistics.hs
    table.add_row(
        "significant wave height Hs",
        f"{ordered.hs:.3f} m",
        f"{statistics.hs:.3f} m",
        f"{scatter:.3f} m",
    )
    table.add_row("peak period Tp", f"{ordered.tp:.2f} s", f"{statistics.tp:.2f} s")
    table.add_row(
        "mean direction, toward",
        f"{ordered.mean_direction:.1f} deg",
        f"{statistics.mean_direction:.1f} deg",
    )
    table.add_row("directional spread", f"{ordered.spread:.1f} deg", f"{statistics.spread:.1f} deg")
    console.print(table)
    table = Table(title="\nTile", title_justify="left", show_header=False, box=None, pad_edge=False)
    if ordered.m0 > 0.0:
        length = (
            2.0
            * math.pi
            / float(
                dispersion.wavenumber(
                    2.0 * math.pi / ordered.tp, ocean.depth, ocean.amplitudes.surface_tension
                )
            )
        )
        table.add_row(
            "peak wavelength",
            f"{length:.3g} m: {min(grid.lx, grid.ly) / length:.1f} of them across the tile",
        )
    table.add_row(
        "smallest wave", f"{2.0 * max(grid.lx / grid.nx, grid.ly / grid.ny):.3g} m, two samples"
    )
    lost = (
        (statistics.energy_below / ordered.m0, statistics.energy_above / ordered.m0)
        if ordered.m0
        else (0.0, 0.0)
    )
    table.add_row(
        "energy it cannot hold",
        f"{100 * lost[0]:.2f} % in longer waves, {100 * lost[1]:.2f} % in shorter ones",
    )
    if statistics.loop:
        e = statistics.loop
        better = (
            f"; {e.better_period:g} s would have {100 * e.better_rms:.1f} %"
            if e.better_period != e.period
            else ""
        )
        table.add_row(
            "loop frequency error", f"{100 * e.rms:.1f} % rms, {100 * e.bias:+.1f} % bias{better}"
        )
    table.add_row("folds", str(statistics.folding))
    assert ocean.sea is not None  # a job has a sea
    for part in dict.fromkeys((ocean.sea.depth_from, ocean.sea.surface_tension_from)):
        if part:
            table.add_row("water stated by", part)
    table.add_row("FFT library", ocean.backend)
    cost = estimate(job, scene=scene)
    table.add_row(
        "files", f"{cost.files} files of {len(job.maps)} maps, about {cost.bytes / 1e6:.0f} MB"
    )
    table.add_row("memory", _memory(cost))
    table.add_row("video memory", f"{_video(cost)}, as textures in an engine")
    table.add_row("time to bake", f"about {cost.seconds:.0f} s here")
    table.add_row("between frames", blend.sentence(blend.loss(ocean, job.frames)))
    console.print(table)
    _advise(asdict(statistics))
    return 0


def _info_of_tiles(options: argparse.Namespace, job: "Job") -> int:
    """Say what a job means as a cascade."""
    from rich.table import Table
    from rich.text import Text

    from fftocean.baking.cascade import water_estimate
    from fftocean.baking.cascade_setup import prepare

    water = prepare(job, options.tiles)
    cost = water_estimate(water)
    title = Text(f"Cascade: {_plain(job.source)}")
    table = Table(title=title, title_justify="left", show_header=False, box=None, pad_edge=False)
    for name, text in water.rows():
        table.add_row(name, Text(text))
    table.add_row("files", f"{cost.files} files, about {cost.bytes / 1e6:.0f} MB")
    table.add_row(
        "memory",
        f"about {cost.memory / 2**20:.0f} MiB for the largest tile, in each of {cost.workers} at work",
    )
    table.add_row("time to bake", f"about {cost.seconds:.0f} s here")
    _console().print(table)
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
    console = _console()
    wide = console.width >= 100  # the reasons are what a narrow terminal can do without
    for heading in ("quantity", "against", "error", "tolerance", *(["reason"] if wide else []), ""):
        number = heading in ("error", "tolerance")
        table.add_column(
            heading, justify="right" if number else "left", no_wrap=number or not heading
        )
    for c in checks:
        verdict = "[green]ok[/]" if c.passed else "[bold red]FAILED[/]"
        reason = [c.reason] if wide else []
        table.add_row(c.name, c.against, f"{c.figure:.1e}", f"{c.bound:.1e}", *reason, verdict)
    console.print(table)
    failed = [c.name for c in checks if not c.passed]
    print(
        f"{len(checks) - len(failed)} of {len(checks)} checks passed"
        + (f"; failed: {', '.join(failed)}" if failed else "")
    )
    return 5 if failed else 0


def _plot(options: argparse.Namespace) -> int:
    from fftocean import plots

    path = plots.save(plots.plot_job(_job(options).ocean()), options.output)
    print(f"plot: {_plain(path)}")
    return 0


def _presets(_: argparse.Namespace) -> int:
    from rich.table import Table

    from fftocean.physics import presets

    console = _console()
    for title, call, rows in (
        (
            "Beaufort scale: U10, and the probable wave height of the open sea",
            "Sea.beaufort",
            presets.beaufort_table(),
        ),
        (
            "Sea states, WMO code table 3700: middle of the range, fully developed",
            "Sea.sea_state",
            presets.sea_state_table(),
        ),
    ):
        table = Table(title=title, title_justify="left", box=None, pad_edge=False)
        for heading in ("call", "name", "U10 m/s", "knots", "Hs m", "computed m", "Tp s"):
            words = heading in ("call", "name")
            table.add_column(heading, justify="left" if words else "right", no_wrap=True)
        for row in rows:
            numbers = (
                f"{row.wind:.1f}",
                f"{row.wind_knots:.0f}",
                f"{row.hs:.3f}",
                f"{row.measured_hs:.7f}",
                f"{row.tp:.1f}",
            )
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
