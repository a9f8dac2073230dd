"""`fftocean series`: write time series of the water at probes."""

import argparse
from typing import TYPE_CHECKING

from fftocean.cli.arguments import add_tiles_flag, path
from fftocean.cli.command import Command
from fftocean.cli.console import plain
from fftocean.cli.job_flags import add_job_flags, job_of, water_of

if TYPE_CHECKING:
    from fftocean.arrays import Real


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `fftocean series`."""
    parser.add_argument(
        "--at",
        type=_place,
        action="append",
        required=True,
        metavar="X,Y",
        help="place of a probe [m]; repeat it for more, and write --at=-10,5 where x is negative",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=path,
        required=True,
        metavar="FILE",
        help="file to write: .csv, .nc (netCDF) or .zarr",
    )
    parser.add_argument(
        "--fields",
        type=_words,
        default=["height"],
        metavar="NAME,...",
        help="height, slope_x, slope_y; below the surface velocity_x, _y, _z, acceleration_x, _y, "
        "_z, pressure (default: height)",
    )
    parser.add_argument(
        "--depths",
        type=_numbers,
        default=[0.0],
        metavar="D,...",
        help="depths of the fields below the surface [m], down from the still water (default: 0)",
    )
    parser.add_argument("--start", type=float, default=0.0, help="first time [s] (default: 0)")
    parser.add_argument("--duration", type=float, help="length [s] (default: the loop)")
    parser.add_argument(
        "--rate", type=float, default=5.0, help="samples a second [Hz] (default: 5)"
    )
    parser.add_argument("--quiet", action="store_true", help="no summary")
    add_tiles_flag(parser)
    add_job_flags(parser)


def _place(text: str) -> tuple[float, float]:
    """Return the two coordinates of a probe."""
    numbers = _numbers(text)
    if len(numbers) != 2:
        raise argparse.ArgumentTypeError(f"must be X,Y such as 120,35.5, got {text!r:.80}")
    return numbers[0], numbers[1]


def _numbers(text: str) -> list[float]:
    """Return numbers between commas."""
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"must be numbers such as 0,5,10, got {text!r:.80}"
        ) from None


def _words(text: str) -> list[str]:
    """Return words between commas."""
    return [part.strip() for part in text.split(",")]


def run(options: argparse.Namespace) -> int:
    """Write time series of a job's water."""
    from fftocean.files import make_folder
    from fftocean.probe_series import require_writable, series

    require_writable(options.output)
    water = water_of(job_of(options), options.tiles)
    duration = options.duration if options.duration is not None else water.loop
    times = _times(options.start, duration, options.rate)
    x, y = zip(*options.at, strict=True)
    levels = [-depth if depth else 0.0 for depth in options.depths]
    found = series(water, x, y, times, options.fields, z=levels)
    make_folder(options.output.parent)
    found.write(options.output)
    if not options.quiet:
        probes = "probe" if len(x) == 1 else "probes"
        print(
            f"{plain(options.output)}: {', '.join(found.values)} at {len(x)} {probes}, "
            f"{times.size} times from {times[0]:g} to {times[-1]:g} s"
        )
    return 0


def _times(start: float, duration: float | None, rate: float) -> "Real":
    """
    Return equal steps of time from a start, without the end of the duration.

    Raises:
        JobError: a duration or a rate out of range.
    """
    import numpy as np

    from fftocean.errors import JobError
    from fftocean.limits import MOMENTS, Quantity

    rate = Quantity("Hz", 1e-6, 1e6).check("--rate", rate)
    start = Quantity("s", -1e12, 1e12).check("--start", start)
    if duration is None:
        raise JobError("--duration must be given for tiles that have no common loop")
    duration = Quantity("s", 1e-6, 1e12).check("--duration", duration)
    count = MOMENTS.check("--duration times --rate", max(1, round(duration * rate)))
    return start + np.arange(count) / rate


COMMAND = Command(
    name="series",
    arguments="[JOB.toml] --at X,Y -o FILE",
    summary="write time series at probes: height, slopes, velocities, pressure at depths",
    examples=(
        "fftocean series gale.toml --at 0,0 --at 50,0 -o gale.csv",
        "fftocean series --at 10,20 --fields height,pressure --depths 0,5 --duration 600 -o p.nc",
    ),
    run=run,
    add_flags=add_flags,
)
