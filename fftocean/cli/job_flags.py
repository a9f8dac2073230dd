"""Flags that make a job: a job file, keys with a flag of their own, --set for every key."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fftocean.errors import JobError

if TYPE_CHECKING:
    from fftocean.cascade import Cascade
    from fftocean.job.job import Job
    from fftocean.job.parameters import Parameter
    from fftocean.ocean import Ocean


def add_job_flags(parser: argparse.ArgumentParser) -> None:
    """Add the job file, the flags of `PARAMETERS`, --fps and --set."""
    from fftocean.job.parameters import PARAMETERS

    parser.add_argument(
        "job",
        nargs="?",
        metavar="JOB.toml",
        type=Path,
        help="a job file; without one, the embedded default sea",
    )
    group = parser.add_argument_group("keys of the job (flags override the file)")
    for parameter in PARAMETERS:
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
    from fftocean.job.job import Job, parse_setting, parse_value
    from fftocean.job.parameters import BY_KEY, PARAMETERS

    job = Job.default() if options.job is None else Job.read(options.job)
    changes: dict[str, Any] = dict(parse_setting(text) for text in options.set)
    for parameter in PARAMETERS:
        if parameter.flag and (given := getattr(options, parameter.flag)) is not None:
            changes[parameter.key] = given if parameter.switch else parse_value(given)
    for key, value in changes.items():
        if key in BY_KEY and BY_KEY[key].many and isinstance(value, str):
            changes[key] = [value]
    job = job.replaced(changes)
    if options.fps is None:
        return job
    if "bake.frames" in changes:
        raise JobError("--fps and a number of frames must not be given together; leave one out")
    return with_frame_rate(job, options.fps)


def water_of(job: "Job", tiles: list[tuple[int, float]] | None) -> "Ocean | Cascade":
    """
    Return the ocean of a job, or the cascade of its sea on some tiles.

    Raises:
        JobError: tiles that cannot share the sea, or a band beside tiles.
    """
    if not tiles:
        return job.ocean()
    from fftocean.cascade import Cascade
    from fftocean.errors import JobError, ParameterError
    from fftocean.job.parameters import BY_KEY

    s = job.settings
    for key in ("ocean.band_low", "ocean.band_high"):
        if s[key] != BY_KEY[key].default:
            raise JobError(
                f"{job.source}: {key} must be left out where there are tiles, "
                "whose bands follow from their sizes"
            )
    try:
        return Cascade(
            job.sea(),
            tiles,
            seed=s["ocean.seed"],
            loop=s["ocean.loop"],
            choppiness=s["ocean.choppiness"],
            amplitudes=s["ocean.amplitudes"],
            order=s["ocean.order"],
            bound=s["ocean.bound"],
        )
    except JobError:
        raise
    except ParameterError as error:
        raise JobError(f"{job.source}: {error}") from None
