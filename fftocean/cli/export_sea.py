"""`fftocean export-sea`: write the waves of a sea for programs that run it."""

import argparse
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fftocean.cli.arguments import add_tiles_flag, path
from fftocean.cli.command import Command
from fftocean.cli.console import plain, size_in_words
from fftocean.cli.job_flags import add_job_flags, job_of, water_of
from fftocean.cli.progress import json_events

if TYPE_CHECKING:
    from fftocean.job.job import Job


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `fftocean export-sea`."""
    from fftocean.engine_projects import ENGINES, TEXTURES

    parser.add_argument(
        "-o",
        "--output",
        type=path,
        default=Path("sea"),
        metavar="DIR",
        help="folder to write to (default: sea)",
    )
    parser.add_argument(
        "--overwrite", action="store_true", help="replace a folder that holds another sea"
    )
    parser.add_argument(
        "--textures",
        nargs="?",
        const="bin",
        metavar="FORMAT",
        help=f"add the waves as float32 textures: {', '.join(TEXTURES)} (without a value: bin)",
    )
    parser.add_argument(
        "--engine",
        type=str.lower,
        choices=tuple(ENGINES),
        help="add the kernels and a project that opens in this engine, beside the package",
    )
    parser.add_argument(
        "--ticks",
        type=int,
        metavar="N",
        help="moments of the loop, a power of two (default: the most that keep phases exact)",
    )
    add_tiles_flag(parser)
    parser.add_argument(
        "--json", action="store_true", help="print events as lines of JSON: done, error"
    )
    parser.add_argument("--quiet", action="store_true", help="no summary")
    add_job_flags(parser, own=("engine",))


def run(options: argparse.Namespace) -> int:
    """Write a sea as a run-time package."""
    from fftocean.engine_projects import TEXTURES
    from fftocean.errors import JobError
    from fftocean.runtime.folder import export_sea

    if options.textures not in (None, *TEXTURES) and options.job is None:
        # `--textures JOB.toml`: a bare flag before the job
        if not options.textures.lower().endswith(".toml") and not os.path.exists(options.textures):  # noqa: PTH110
            raise JobError(
                f"--textures must be one of {', '.join(TEXTURES)}, got {options.textures!r:.60}"
            )
        options.job, options.textures = path(options.textures), "bin"
    with json_events(options.json) as print_json:
        job = job_of(options)
        wind = None
        if job.wind:
            wind = job.settings["sea.wind.speed"], job.settings["sea.wind.direction"]
        water = water_of(job, options.tiles)
        document = export_sea(
            water,
            options.output,
            textures=options.textures or False,
            engine=options.engine,
            job=_job_text(job, options.tiles),
            ticks=options.ticks,
            foam=job.foam_on(water),
            wind=wind,
            overwrite=options.overwrite,
        )
        if print_json:
            print_json({"event": "done", "folder": str(options.output), **_sizes(document)})
        elif not options.quiet:
            _summarise(options.output, document)
            _next_step(options.output, document)
    return 0


def _job_text(job: "Job", tiles: list[tuple[int, float]] | None) -> str:
    """Return the job as TOML; tiles, which a job does not have, in a comment."""
    from fftocean.job.job_text import job_text

    given = ",".join(f"{n}:{size:g}" for n, size in tiles or ())
    flags = f" --tiles {given}" if tiles else ""
    return job_text(job, comments=[f"fftocean export-sea job.toml -o sea{flags}"])


def _sizes(document: Mapping[str, Any]) -> dict[str, int]:
    """Return the number of tiles, waves and bytes of a package."""
    return {
        "tiles": len(document["tiles"]),
        "waves": sum(tile["waves"] for tile in document["tiles"]),
        "bytes": sum(file["bytes"] for file in document["files"]),
    }


def _summarise(folder: Path, document: Mapping[str, Any]) -> None:
    """Print what a package holds."""
    specified, realised = (document["statistics"][key] for key in ("specified", "realised"))
    print(
        f"Hs {specified['hs']:.3g} m specified, {realised['hs']:.3g} m realised; "
        f"Tp {realised['tp']:.3g} s"
    )
    sizes = _sizes(document)
    print(
        f"{sizes['waves']} waves on {sizes['tiles']} tile{'s' * (sizes['tiles'] != 1)}, loop "
        f"{document['loop']:g} s in {document['ticks']} ticks, {size_in_words(sizes['bytes'])}: "
        f"{plain(folder)}"
    )


def _next_step(folder: Path, document: Mapping[str, Any]) -> None:
    """Print what to do with the project of an engine, and which of its files were kept."""
    from fftocean.engine_projects import ENGINES
    from fftocean.runtime.folder import edited_files

    if "project" not in document:
        return
    engine = ENGINES[document["project"]["engine"]]
    if edited := edited_files(folder, document):
        print(f"kept as edited: {', '.join(map(plain, edited))}")
    print(f"{engine.caption}: {engine.first_step}")


COMMAND = Command(
    name="export-sea",
    arguments="[JOB.toml] [-o DIR]",
    summary="write the waves of a sea for programs that evolve them: pages, engines",
    examples=(
        "fftocean export-sea -o waves --n 256",
        "fftocean export-sea gale.toml -o gale-waves --tiles 256:420,256:61,256:8 --textures ktx2",
        "fftocean export-sea gale.toml -o gale-godot --n 256 --engine godot",
    ),
    run=run,
    add_flags=add_flags,
)
