"""Values of flags, and the flags that several commands share."""

import argparse
from pathlib import Path


def whole_number(text: str) -> int:
    """Return a whole number of at least 1."""
    if not (text.isascii() and text.isdigit() and int(text[:9]) > 0 and len(text) < 10):
        raise argparse.ArgumentTypeError(f"must be a whole number from 1 on, got {text!r:.40}")
    return int(text)


def path(text: str) -> Path:
    """
    Return a path that is not empty.

    An empty one is nearly always a shell variable that is not set, and would be the current folder.
    """
    if not text:
        raise argparse.ArgumentTypeError("must not be empty")
    return Path(text)


def tile_list(text: str) -> list[tuple[int, float]]:
    """Return the tiles of `n:size,n:size` as (samples a side, width [m])."""
    try:
        return [(int(n), float(size)) for n, size in (tile.split(":") for tile in text.split(","))]
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"must be n:size,n:size such as 512:500,512:71,256:9.3, got {text!r:.80}"
        ) from None


def add_tiles_flag(parser: argparse.ArgumentParser) -> None:
    """Add the flag for a cascade."""
    parser.add_argument(
        "--tiles",
        type=tile_list,
        metavar="N:SIZE,...",
        help="one sea on several tiles, such as 512:500,512:71,256:9.3, instead of --n and --size",
    )


def add_worker_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags for the executor and its workers."""
    parser.add_argument(
        "--executor",
        default="auto",
        metavar="NAME",
        help="serial, processes, dask, a scheduler's tcp://..., or auto: processes if they are "
        "faster (default: auto)",
    )
    parser.add_argument(
        "--workers",
        type=whole_number,
        metavar="N",
        help="number of workers (default: one for each processor)",
    )
