"""One sea on several tiles: each a bake of its own, in a folder of its own, and beside them what a shader needs to add them up."""

import hashlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import fftocean
from fftocean.bake.baker import bake, require_usable
from fftocean.bake.files import as_json, make_folder, path_of, remove, write_whole
from fftocean.bake.job import Job, finite_or_word
from fftocean.bake.layout import MANIFEST_FILE
from fftocean.cascade import Tile, tile_jobs
from fftocean.errors import JobError, ParameterError
from fftocean.export import rules

CASCADE_FILE = "cascade.json"
HOW_TO_ADD = (
    "Heights, displacements, slopes, stretches and velocities of the tiles add. "
    "Normals and Jacobians do not: they follow from the sums of slopes and stretches. Foam: 1 - product of (1 - foam)."
)


def bake_tiles(job: Job, tiles: Iterable[Tile], folder: str | Path = "out", **options: Any) -> dict[str, Any]:
    """
    Bake a job as a cascade: the same sea on several tiles, whose bands of wavenumbers adjoin and do not overlap.

    Each tile is a bake in `tile0`, `tile1`, ..., from the largest to the smallest, and can be stopped, gone on with and checked as any. The
    list of them, `cascade.json`, is written last.

    Args:
        job: what to bake; its `ocean.n`, `ocean.size` and band are those of the tiles instead.
        tiles: (n, size) of each, as `Cascade` takes them.
        folder: where to.
        options: as `bake` takes them.

    Returns:
        The list, as plain data.

    Raises:
        JobError: tiles that cannot share a sea.
        OutputError, FolderInUseError: as `bake`.
    """
    folder = path_of("folder", folder)
    profile = require_usable(job)
    try:
        shares = tile_jobs(tiles, job.settings["ocean.seed"])
    except ParameterError as error:
        raise JobError(f"{job.source}: {error}") from None
    make_folder(folder)
    remove(folder / CASCADE_FILE)  # from here on the folder is no finished cascade
    rows = []
    for index, (grid, seed, band) in enumerate(shares):
        own = {
            "ocean.n": (grid.nx, grid.ny),
            "ocean.size": (grid.lx, grid.ly),
            "ocean.seed": seed,
            "ocean.band_low": band[0],
            "ocean.band_high": band[1],
        }
        name = f"tile{index}"
        manifest = bake(job.replaced(own), folder / name, **options)
        rows.append(
            {
                "path": name,
                "n": [grid.nx, grid.ny],
                "size": [grid.lx, grid.ly],
                "seed": seed,
                "band": [band[0], finite_or_word(band[1])],
                "m0": manifest["statistics"]["resolved"],
                "maps": sorted(manifest["maps"]),
                "sha256": hashlib.sha256((folder / name / MANIFEST_FILE).read_bytes()).hexdigest(),
            }
        )
    listed = {
        "tool": "fftocean",
        "version": fftocean.__version__,
        "how_to_add": f"{rules.cascade_text(profile)} {HOW_TO_ADD}",
        "sampling": rules.cascade(profile),
        "units": {"size": "m", "band": "rad/m", "m0": "m^2"},
        "tiles": rows,
    }
    write_whole(folder / CASCADE_FILE, as_json(listed))
    return listed
