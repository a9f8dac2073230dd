"""Ocean or cascade of a run-time package: of its own waves, with nothing made from a seed."""

from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.amplitudes import Amplitudes, with_cycles
from fftocean.cascade import Cascade, from_oceans
from fftocean.computation import Computation
from fftocean.errors import IntegrityError, ParameterError
from fftocean.grid import Grid
from fftocean.host import require_memory
from fftocean.ocean import Ocean, from_amplitudes, memory_needed
from fftocean.runtime.contents import Contents, Tile
from fftocean.runtime.layout import RECORD, waves_file
from fftocean.runtime.package import SeaPackage
from fftocean.runtime.planes import half_of, waves_from_planes
from fftocean.runtime.records import Records


def ocean_of(
    package: SeaPackage,
    *,
    dtype: str = "float32",
    backend: str = "auto",
    planning: str = "estimate",
    threads: int = 1,
) -> Ocean | Cascade:
    """
    Return the ocean of a package with one tile, or the cascade of one with several.

    Its waves are those of the package, in single precision, and its frequencies the whole cycles
    stored with them. `sea` is None, since a package has no spectra.

    Args:
        package: a package, from anywhere.
        dtype, backend, planning, threads: as in `Ocean`.

    Raises:
        IntegrityError: the document or the waves are damaged; the message names the entry.
        ParameterError: a value out of range, or too little memory.
    """
    computation = Computation(dtype, backend, planning, threads)
    contents = Contents.of(package.document)
    needed = sum(memory_needed(tile.grid, computation.dtype) for tile in contents.tiles)
    require_memory(f"a sea of {len(contents.tiles)} tiles", needed)
    oceans = []
    for i, tile in enumerate(contents.tiles):
        name = waves_file(i)
        if name not in package.files:
            raise IntegrityError(f"{name} is missing: the waves of tile {i}")
        waves = amplitudes_of(package.files[name], tile, contents, name)
        try:
            ocean = from_amplitudes(None, tile.seed, waves, contents.choppiness, computation)
        except ParameterError as error:
            raise IntegrityError(f"{name} has waves of no sea: {error}") from None
        oceans.append(ocean)
    return oceans[0] if len(oceans) == 1 else from_oceans(None, oceans[0].seed, tuple(oceans))


def amplitudes_of(data: bytes, tile: Tile, contents: Contents, name: str) -> Amplitudes:
    """
    Return the waves of a tile.

    Args:
        data: its records.
        tile: the tile that they belong to.
        contents: the package that it belongs to.
        name: of the file, for messages.

    Raises:
        IntegrityError: bytes that no package has; the message names the record.
    """
    grid = tile.grid
    if len(data) != tile.waves * RECORD.itemsize:
        raise IntegrityError(
            f"{name} must have {tile.waves * RECORD.itemsize} bytes for {tile.waves} waves, "
            f"and has {len(data)}"
        )
    records = np.frombuffer(data, RECORD)
    _require_records(records, tile, name)
    h0 = np.zeros(grid.shape, np.complex64)
    for part, key in ((h0.real, "re"), (h0.imag, "im")):  # as they are, signs of 0 too
        part[records["my"], records["mx"]] = records[key]
    try:
        made = waves_from_planes(
            h0,
            grid,
            loop=contents.loop,
            depth=contents.depth,
            surface_tension=contents.surface_tension,
            band=tile.band,
        )
    except ParameterError as error:
        raise IntegrityError(f"{name} has waves of no sea: {error}") from None
    return with_cycles(made, _cycles(records, made, name))


def _require_records(records: Records, tile: Tile, name: str) -> None:
    """
    Raise if a record is none that the tile can have.

    Raises:
        IntegrityError: the message names the first such record and its rule.
    """
    grid = tile.grid
    reach_x, reach_y = grid.reach
    mx, my = (records[key].astype(np.int64) for key in ("mx", "my"))
    place = (my % grid.ny) * grid.nx + mx % grid.nx
    rules: dict[str, npt.NDArray[Any]] = {
        f"have |mx| <= {reach_x} and |my| <= {reach_y}, not both 0": (np.abs(mx) <= reach_x)
        & (np.abs(my) <= reach_y)
        & ((mx != 0) | (my != 0)),
        "follow the one before in the plane": np.diff(place, prepend=-1) > 0,
        "have a finite amplitude, not 0": np.isfinite(records["re"])
        & np.isfinite(records["im"])
        & ((records["re"] != 0.0) | (records["im"] != 0.0)),
        f"have 1 to {tile.most_cycles} cycles": (records["cycles"] >= 1)
        & (records["cycles"] <= tile.most_cycles),
    }
    for rule, kept in rules.items():
        if not np.all(kept):
            first = int(np.flatnonzero(~kept)[0])
            shown = ", ".join(f"{key} {records[first][key]}" for key in RECORD.names or ())
            raise IntegrityError(f"record {first} of {name} must {rule}, got {shown}")
    if records.size and int(np.max(records["cycles"])) != tile.most_cycles:
        raise IntegrityError(
            f"the fastest wave of {name} must have {tile.most_cycles} cycles, "
            f"got {int(np.max(records['cycles']))}"
        )


def _cycles(records: Records, made: Amplitudes, name: str) -> npt.NDArray[np.int64]:
    """
    Return the cycles of each wave on the half plane, those of the records where there are any.

    They can differ by one from what this machine makes of the dispersion relation, since a
    frequency half way between two whole numbers of cycles is rounded by its last bit.

    Raises:
        IntegrityError: other cycles, or two for the waves along +k and -k.
    """
    grid: Grid = made.grid
    stored = np.zeros(grid.shape, np.int64)
    stored[records["my"], records["mx"]] = records["cycles"]
    assert made.cycles is not None  # it loops
    ahead, behind = half_of(grid, stored)
    both = np.where(ahead > 0, ahead, behind)
    cycles = np.where(both > 0, both, made.cycles)
    wrong = ((behind > 0) & (behind != cycles)) | (np.abs(cycles - made.cycles) > 1)
    if np.any(wrong):
        row, column = (int(i) for i in np.argwhere(wrong)[0])
        raise IntegrityError(
            f"the waves of {name} along (mx, my) = ({grid.mx[column]}, {grid.my[row]}) and against "
            f"must have {made.cycles[row, column]} cycles in the loop, "
            f"got {ahead[row, column]} and {behind[row, column]}"
        )
    return cycles
