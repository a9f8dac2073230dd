"""Flags that make a job: a job file, keys with a flag of their own, --set for every key."""

import argparse
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fftocean.errors import JobError

if TYPE_CHECKING:
    from fftocean.cascade import Cascade
    from fftocean.job.job import Job
    from fftocean.job.parameters import Parameter
    from fftocean.ocean import Ocean


def add_job_flags(parser: argparse.ArgumentParser, *, own: tuple[str, ...] = ()) -> None:
    """
    Add the job file, the flags of `PARAMETERS`, --fps and --set.

    Args:
        parser: of the command.
        own: flags of the command itself, which are not those of the job.
    """
    from fftocean.job.parameters import PARAMETERS

    parser.set_defaults(own_flags=own)

    parser.add_argument(
        "job",
        nargs="?",
        metavar="JOB.toml",
        type=Path,
        help="a job file, a file of measured spectra, or the folder of a bake; without one, the "
        "embedded default sea",
    )
    measured = parser.add_argument_group("for a file of measured spectra")
    measured.add_argument(
        "--time",
        metavar="TIME",
        help="record: its number from 0, -1 for the last, or its date, as 2020-06-03T12:40 "
        "(default: 0)",
    )
    measured.add_argument(
        "--toward",
        type=float,
        metavar="DEGREES",
        help="direction of the waves, counter-clockwise from east, where the file has none",
    )
    group = parser.add_argument_group("keys of the job (flags override the file)")
    for parameter in PARAMETERS:
        if parameter.flag in own:
            continue
        if parameter.flag and parameter.switch:
            group.add_argument(
                f"--{parameter.flag}",
                action=argparse.BooleanOptionalAction,
                help=f"{parameter.help} (default: {'yes' if parameter.default else 'no'})",
            )
        elif parameter.flag:
            group.add_argument(
                f"--{parameter.flag}", metavar=parameter.flag.upper(), help=_help_of(parameter)
            )
        if parameter.key == "bake.frames":
            group.add_argument(
                "--fps",
                type=float,
                metavar="RATE",
                help="frames a second, instead of --frames; loop times rate must be a whole number",
            )
    group.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="any key of a job file, such as sea.wind.speed=12",
    )


def _help_of(parameter: "Parameter") -> str:
    """Return the help of a key's flag: meaning, choices, unit, default."""
    default = parameter.default
    if parameter.many:
        default = ",".join(default)
    elif isinstance(default, float):
        default = f"{default:g}"
    choices = f": {', '.join(parameter.choices)}" if parameter.choices else ""
    unit = f" [{parameter.unit}]" if parameter.unit else ""
    text = f"{parameter.help}{choices}{unit} (default: {default})"
    return text.replace("%", "%%")  # argparse formats it


def job_of(options: argparse.Namespace) -> "Job":
    """
    Return the job of a command: the file or the default sea, then --set, then flags.

    Raises:
        JobError: a key or value that a job may not have, or --fps beside a number of frames.
    """
    from fftocean.job.frame_rate import with_frame_rate
    from fftocean.job.job import parse_setting, parse_value
    from fftocean.job.parameters import BY_KEY, PARAMETERS

    job = _given_job(options)
    changes: dict[str, Any] = dict(parse_setting(text) for text in options.set)
    for parameter in PARAMETERS:
        if not parameter.flag or parameter.flag in options.own_flags:
            continue
        if (given := getattr(options, parameter.flag.replace("-", "_"))) is not None:
            changes[parameter.key] = given if parameter.switch else parse_value(given)
    if getattr(options, "tiles", None):
        for key in ("ocean.n", "ocean.size"):
            if key in changes:
                raise JobError(
                    f"{key} and tiles must not be given together, as tiles have their own: leave "
                    f"out --{BY_KEY[key].flag}, or give --tiles"
                )
    for key, value in changes.items():
        if key in BY_KEY and BY_KEY[key].many and isinstance(value, str):
            changes[key] = [value]
    job = job.replaced(changes)
    if options.fps is None:
        return job
    if "bake.frames" in changes:
        raise JobError("--fps and a number of frames must not be given together; leave one out")
    return with_frame_rate(job, options.fps)


def _given_job(options: argparse.Namespace) -> "Job":
    """
    Return the job of a job file, a spectrum file or a bake; the default sea where none is given.

    The tiles of a cascade that was baked become those of the command, if it takes tiles.
    """
    from fftocean.job.job import Job
    from fftocean.job.sources import is_spectrum_file, spectrum_job

    path: Path | None = options.job
    if path is not None and is_spectrum_file(path):
        time: str | None = options.time
        number = time is not None and time.strip().lstrip("-").isdecimal()
        return spectrum_job(
            path, time=int(time) if number and time else time, direction=options.toward
        )
    for flag, value in (("time", options.time), ("toward", options.toward)):
        if value is not None:
            raise JobError(
                f"--{flag} must be given with a file of measured spectra, got "
                f"{'no file' if path is None else path}"
            )
    if path is None:
        return Job.default()
    return _baked_job(path, options) if os.path.isdir(path) else Job.read(path)  # noqa: PTH112


def _baked_job(folder: Path, options: argparse.Namespace) -> "Job":
    """
    Return the job of a bake.

    Measured files are looked for beside the folder, where the job file usually is.

    Raises:
        JobError: no bake is in the folder, or the tiles of a cascade that the command cannot take.
    """
    from fftocean.baking.folder import layout, listing
    from fftocean.baking.folder.sealed import read_sealed
    from fftocean.job.job import Job

    if layout.is_cascade(folder):
        if not hasattr(options, "tiles"):
            raise JobError(f"{folder} is a bake of several tiles; name one, as {folder / 'tile0'}")
        job, tiles = listing.job_of(listing.read_listing(folder), source=str(folder))
        options.tiles = options.tiles or tiles
        return job
    if not (folder / layout.MANIFEST_FILE).is_file():
        raise JobError(f"{folder} must be a job file or the folder of a bake, and has no manifest")
    header = read_sealed(folder / layout.MANIFEST_FILE)
    return Job.from_description(header["job"], source=str(folder))


def water_of(job: "Job", tiles: list[tuple[int, float]] | None) -> "Ocean | Cascade":
    """
    Return the ocean of a job, or the cascade of its sea on some tiles.

    Raises:
        JobError: tiles that cannot share the sea, or a band beside tiles.
    """
    return job.cascade(tiles) if tiles else job.ocean()
