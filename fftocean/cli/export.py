"""`fftocean export`: write the waves of a job for engineers' programs."""

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from fftocean.cli.arguments import add_tiles_flag, path, whole_number
from fftocean.cli.command import Command
from fftocean.cli.console import plain, size_in_words
from fftocean.cli.job_flags import add_job_flags, job_of, water_of

if TYPE_CHECKING:
    from fftocean.cascade import Cascade
    from fftocean.ocean import Ocean

FORMATS = ("swd", "openfast", "components")
_GRID = "XHALF,YHALF,DEPTH,NX,NY,NZ"


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `fftocean export`."""
    parser.add_argument(
        "kind",
        type=str.lower,
        choices=FORMATS,
        metavar="KIND",
        help="swd: spectral_wave_data of DNV; openfast: SeaState's files; components: CSV",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=path,
        required=True,
        metavar="FILE",
        help="file to write; with openfast the root name of the files",
    )
    parser.add_argument(
        "--steps",
        type=whole_number,
        metavar="N",
        help="swd: amplitudes of the looping sea at N steps of time (shapes 4 and 5); without it a "
        "list of waves that run freely, without a loop (shape 6)",
    )
    parser.add_argument("--dt", type=float, help="time between steps, or WaveDT of openfast [s]")
    parser.add_argument("--tmax", type=float, help="openfast: WaveTMax [s] (default: the loop)")
    parser.add_argument(
        "--grid",
        type=_grid,
        metavar=_GRID,
        help="openfast: half widths and depth of the wave grid [m], and its NX, NY, NZ",
    )
    parser.add_argument(
        "--wave-mod",
        type=whole_number,
        default=6,
        metavar="6|7",
        help="openfast: 6 for kinematics on the grid, 7 for the waves of one direction (default: "
        "6)",
    )
    parser.add_argument("--quiet", action="store_true", help="no summary")
    add_tiles_flag(parser)
    add_job_flags(parser)


def _grid(text: str) -> tuple[float, float, float, int, int, int]:
    """Return the numbers of a wave grid."""
    parts = text.split(",")
    try:
        x, y, z = (float(part) for part in parts[:3])
        nx, ny, nz = (int(part) for part in parts[3:])
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"must be {_GRID} such as 100,50,40,5,3,10, got {text!r:.80}"
        ) from None
    return x, y, z, nx, ny, nz


def run(options: argparse.Namespace) -> int:
    """Write the waves of a job in one of the formats."""
    from fftocean import export
    from fftocean.errors import JobError
    from fftocean.files import make_folder
    from fftocean.job.job_text import job_text

    used = {
        "swd": {"steps", "dt"},
        "openfast": {"dt", "tmax", "grid"},
        "components": set[str](),
    }[options.kind]
    for name in ("steps", "dt", "tmax", "grid"):
        if getattr(options, name) is not None and name not in used:
            raise JobError(f"--{name} must not be given with {options.kind}")
    job = job_of(options)
    water = water_of(job, options.tiles)
    target: Path = options.output
    make_folder(target.parent)
    if options.kind == "swd":
        comment = job_text(job).encode("ascii", "backslashreplace").decode()
        if options.steps is None:
            water = _running_freely(water)
        export.swd(water, target, steps=options.steps, dt=options.dt, comment=comment)
        names = [target.name]
    elif options.kind == "components":
        export.components(water, target)
        names = [target.name]
    else:
        grid = None if options.grid is None else export.SeaStateGrid(*options.grid)
        if grid is None and options.wave_mod == 6:
            raise JobError(f"--grid {_GRID} must be given with openfast")
        names = list(
            export.openfast(
                water,
                grid,
                target,
                tmax=options.tmax,
                dt=options.dt,
                wave_mod=options.wave_mod,
            )
        )
    if not options.quiet:
        files = [target.with_name(name) for name in names]
        size = size_in_words(sum(file.stat().st_size for file in files))
        print(f"{', '.join(plain(file) for file in files)}: {size}")
    return 0


def _running_freely(water: "Ocean | Cascade") -> "Ocean | Cascade":
    """Return the same waves with the frequencies of the dispersion relation, without a loop."""
    from fftocean.cascade import Cascade, from_oceans

    if isinstance(water, Cascade):
        return from_oceans(water.sea, water.seed, tuple(_free(tile) for tile in water.oceans))
    return _free(water)


def _free(ocean: "Ocean") -> "Ocean":
    """Return an ocean without its loop."""
    return ocean.with_amplitudes(replace(ocean.amplitudes, loop=None))


COMMAND = Command(
    name="export",
    arguments="KIND [JOB.toml] -o FILE",
    summary="write the waves for engineers' programs: SWD, OpenFAST, a table",
    examples=(
        "fftocean export swd gale.toml -o gale.swd --steps 241",
        "fftocean export openfast gale.toml -o waves/gale --grid 100,50,40,5,3,10 --dt 0.25",
        "fftocean export components gale.toml -o waves.csv",
    ),
    run=run,
    add_flags=add_flags,
)
