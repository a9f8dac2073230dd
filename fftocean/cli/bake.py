"""`fftocean bake`: write a looping sequence of maps."""

import argparse
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fftocean.cli import notes
from fftocean.cli.arguments import add_tiles_flag, add_worker_flags, path, whole_number
from fftocean.cli.command import Command
from fftocean.cli.console import note, plain
from fftocean.cli.job_flags import add_job_flags, job_of
from fftocean.cli.progress import Event, ShowProgress, json_events, print_event, progress_bar

if TYPE_CHECKING:
    from fftocean.job.job import Job


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `fftocean bake`."""
    parser.add_argument(
        "-o",
        "--output",
        type=path,
        default=Path("out"),
        metavar="DIR",
        help="folder to write to (default: out)",
    )
    parser.add_argument(
        "--overwrite",
        action="store_true",
        help="replace a folder that holds another job (resuming needs no flag)",
    )
    parser.add_argument(
        "--downsample",
        type=whole_number,
        default=1,
        metavar="K",
        help="bake 1/K of the samples a side; waves too short for that grid are dropped",
    )
    add_tiles_flag(parser)
    parser.add_argument(
        "--dry-run",
        action="store_true",
        help="print what would be written; refuse what a bake would refuse",
    )
    add_worker_flags(parser)
    parser.add_argument(
        "--json",
        action="store_true",
        help="print events as lines of JSON: start, survey, frame, done, error",
    )
    parser.add_argument("--quiet", action="store_true", help="no progress bar and no summary")
    add_job_flags(parser)


def run(options: argparse.Namespace) -> int:
    """Bake a job on one tile or several, or estimate the bake."""
    from fftocean.baking.folder.lock import require_free

    require_free(options.output)  # before anything is loaded that takes time
    subset = None
    if options.frames is not None and ":" in options.frames:
        subset, options.frames = options.frames, None
    with json_events(options.json) as print_json:
        job = job_of(options)
        if options.dry_run:
            _dry_run(options, job, subset)
        elif options.tiles:
            _bake_cascade(options, job, subset, print_json)
        else:
            _bake_tile(options, job, subset, print_json)
    return 0


def _dry_run(options: argparse.Namespace, job: "Job", subset: str | None) -> None:
    """Print the estimate of a bake."""
    from fftocean.baking.dry_run import dry_run

    cost = dry_run(
        job,
        options.output,
        tiles=options.tiles,
        overwrite=options.overwrite,
        **_work(options, subset),
    )
    if options.json:
        print_event({"event": "estimate", "folder": str(options.output), **asdict(cost)})
        return
    print(
        f"would write {cost.files} files, about {cost.bytes / 1e6:.3g} MB, "
        f"for {cost.frames} frames to {plain(options.output)}"
    )
    by = "one process" if cost.executor == "serial" else f"{cost.workers} {cost.executor}"
    print(f"time: about {cost.seconds:.0f} s here, by {by}")
    print(f"memory: {notes.memory(cost)}")
    print(f"video memory of the maps in an engine: {notes.video_memory(cost)}")
    notes.print_loading(job)


def _work(options: argparse.Namespace, subset: str | None) -> dict[str, Any]:
    """Return the keywords that every kind of bake takes."""
    return {
        "frames": subset,
        "downsample": options.downsample,
        "executor": options.executor,
        "workers": options.workers,
    }


class _Follower:
    """Listener of a bake's events: shows them as progress and knows how far the bake is."""

    def __init__(self, show: ShowProgress, print_json: Callable[[Event], None] | None) -> None:
        self._show, self._print_json = show, print_json
        self.done: int = 0
        self.frames: int = 0
        self.kept: int = 0
        self.tile = ""  # of a cascade, in words

    def __call__(self, event: Event) -> None:
        """Follow one event."""
        if event["event"] in ("start", "frame"):
            if event["event"] == "start":
                self.kept = event["kept"]
            self.done = event["kept" if event["event"] == "start" else "done"]
            self.frames = event["frames"]
            if "tile" in event:
                self.tile = f" tile {event['tile'] + 1} of {event['tiles']}"
        if event["event"] == "survey":
            self._show(event["done"], event["total"], f"surveying {event['what']}{self.tile}")
        elif self.frames:
            finished = self.done == self.frames
            doing = "rendering previews" if finished and not self.tile else f"baking{self.tile}"
            self._show(self.done, self.frames, doing)
        if self._print_json:
            self._print_json(event)

    def note_interruption(self) -> None:
        """Print how far the bake is."""
        if self.frames:
            of = f" of{self.tile}" if self.tile else ""
            note(
                f"{self.done} of {self.frames} frames{of} are finished; "
                "run the same command again to resume"
            )


def _bake_tile(
    options: argparse.Namespace,
    job: "Job",
    subset: str | None,
    print_json: Callable[[Event], None] | None,
) -> None:
    """Bake one tile, with a progress bar and a summary."""
    from fftocean.baking.bake import bake_packed

    start = time.perf_counter()
    silent = options.quiet or options.json
    with progress_bar("baking", "frames", shown=not silent) as show:
        follower = _Follower(show, print_json)
        try:
            manifest = bake_packed(
                job,
                options.output,
                overwrite=options.overwrite,
                listen=follower,
                **_work(options, subset),
            )
        except (KeyboardInterrupt, SystemExit):
            follower.note_interruption()
            raise
    if not silent:
        _summarise(options.output, manifest, time.perf_counter() - start, follower.kept)
        notes.print_loading(job)


def _summarise(folder: Path, manifest: Mapping[str, Any], seconds: float, kept: int) -> None:
    """
    Print what a bake made.

    Args:
        folder: the folder of the bake.
        manifest: its manifest.
        seconds: the time that it took [s].
        kept: the number of frames that an earlier run had finished.
    """
    from fftocean.baking.folder.layout import SHEET

    statistics, frames = manifest["statistics"], manifest["frames"]
    notes.note_energy_of_bake(statistics)
    specified = statistics["ordered"]
    print(
        f"Hs {specified['hs']:.3g} m specified, {statistics['hs']:.3g} m realised; "
        f"Tp {specified['tp']:.3g} s"
    )
    nx, ny = manifest["ocean"]["n"]
    maps = f"{sum(len(row['files']) for row in frames)} maps of {nx} x {ny}"
    if kept == len(frames):
        print(f"nothing to bake: all {maps} exist already: {plain(folder)}")
    else:
        before = f", {kept} of {len(frames)} frames from an earlier run" if kept else ""
        print(f"{maps} in {seconds:.1f} s{before}: {plain(folder)}")
    notes.note_folds(manifest["extremes"])
    notes.print_blending(manifest["blend"])
    notes.print_video_memory(manifest, len(frames))
    if "preview" in manifest:
        print(f"preview: {plain(folder / SHEET)}")


def _bake_cascade(
    options: argparse.Namespace,
    job: "Job",
    subset: str | None,
    print_json: Callable[[Event], None] | None,
) -> None:
    """Bake one sea on several tiles, one after the other, with a progress bar and a summary."""
    from fftocean.baking.cascade import bake_tiles, summary
    from fftocean.baking.folder.layout import CASCADE_FILE

    silent = options.quiet or options.json
    with progress_bar("baking", "frames", shown=not silent) as show:
        follower = _Follower(show, print_json)
        try:
            listed = bake_tiles(
                job,
                options.tiles,
                options.output,
                overwrite=options.overwrite,
                listen=follower,
                **_work(options, subset),
            )
        except (KeyboardInterrupt, SystemExit):
            follower.note_interruption()
            raise
    if silent:
        return
    notes.note_energy_of_bake(listed["statistics"])
    for line in summary(listed):
        print(line)
    notes.note_folds(listed["extremes"])
    notes.print_blending(listed["blend"])
    notes.print_video_memory(listed, listed["ocean"]["frames"])
    if "preview" in listed:
        print(f"preview: {plain(options.output / listed['preview']['path'])}")
    notes.print_loading(job)
    print(f"rules for adding the tiles: {plain(options.output / CASCADE_FILE)}")


COMMAND = Command(
    name="bake",
    arguments="[JOB.toml] [-o DIR]",
    summary="write a looping sequence of maps, a manifest and previews",
    examples=(
        "fftocean bake -o sea",
        "fftocean bake gale.toml -o gale --n 512 --set sea.wind.speed=22",
        "fftocean bake -o out --fps 30 --engine godot --format exr-atlas",
        "fftocean bake gale.toml -o part --frames 0:64:2 --downsample 2 --dry-run",
    ),
    run=run,
    add_flags=add_flags,
)
