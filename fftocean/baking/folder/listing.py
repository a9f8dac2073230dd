"""Job and list of a baked cascade, and their agreement with the manifests of its tiles."""

import math
import os
import shutil
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import fftocean
from fftocean.baking.folder import engine_files, layout
from fftocean.baking.folder.identity import differences
from fftocean.baking.folder.ownership import engine_files_in, files_of_bake, remove_workspace
from fftocean.baking.folder.sealed import read_sealed
from fftocean.cascade import from_oceans, tile_jobs
from fftocean.cells import Band
from fftocean.constraints import constrained
from fftocean.errors import IntegrityError, JobError, OutputError, ParameterError, SeaWarning
from fftocean.files import digest_whole, read_json, remove, remove_temporary_files
from fftocean.fixed_values import Rarity
from fftocean.grid import Grid
from fftocean.job import fixed_tables
from fftocean.job.job import Job, finite_or_word
from fftocean.job.parameters import PARAMETERS

REPLACED = ("ocean.n", "ocean.size", "ocean.band_low", "ocean.band_high")
"""
Keys of a job that each tile replaces; the seeds of tiles follow from the job's.
"""

HEADER = ("tool", "version", "job", "units", "subset", "downsample", "inputs")
"""Keys of the header: all of `cascade-job.json`, and the beginning of `cascade.json`."""


@dataclass(frozen=True, slots=True)
class TileJob:
    """One tile of a cascade, as a job of its own."""

    path: str  # of its folder in the cascade's
    grid: Grid
    seed: int
    band: Band
    job: Job
    rarity: Rarity | None = None  # of the values that the sum of all tiles is made to have

    def row(self, sha256: str | None, manifest: Mapping[str, Any]) -> dict[str, Any]:
        """Return a tile's entry of the list, from its manifest and that file's SHA-256."""
        return {
            "path": self.path,
            "n": [self.grid.nx, self.grid.ny],
            "size": [self.grid.lx, self.grid.ly],
            "seed": self.seed,
            "band": [self.band[0], finite_or_word(self.band[1])],
            "m0": manifest["statistics"]["resolved"],
            "maps": sorted(manifest["maps"]),
            "sha256": sha256,
        }


def jobs_of_tiles(job: Job, tiles: Sequence[Any], *, fixed: bool = True) -> list[TileJob]:
    """
    Return the tiles of a cascade as jobs, each with its share of the values that the job fixes.

    Without `fixed`, no tile has any: to find the shares, the waves of all tiles are needed.

    Raises:
        JobError: tiles that cannot share a sea.
    """
    pictures = [name for name in job.pictures if name not in SUMMED]
    jobs = []
    try:
        grids = tile_jobs(tiles, job.settings["ocean.seed"])
    except ParameterError as error:
        raise JobError(f"{job.source}: {error}") from None
    for index, (grid, seed, band) in enumerate(grids):
        own = {
            "ocean.n": (grid.nx, grid.ny),
            "ocean.size": (grid.lx, grid.ly),
            "ocean.seed": seed,
            "ocean.band_low": band[0],
            "ocean.band_high": band[1],
            "bake.pictures": pictures,
            "bake.engine_files": False,  # those of the cascade play all tiles
        }
        if index:
            own["ocean.order"] = 1  # as in a `Cascade`
        tile = replace(job.replaced(own), crests=(), fixes=())
        jobs.append(TileJob(layout.tile_folder(index), grid, seed, band, tile))
    return _with_fixed_values(job, jobs) if fixed and job.fixed else jobs


def _with_fixed_values(job: Job, jobs: list[TileJob]) -> list[TileJob]:
    """
    Return the tiles with their shares of the values that the job fixes for their sum.

    Waves that are made to have those shares tile by tile are the waves of the constrained cascade.
    """
    settings = job.settings
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SeaWarning)  # given once, when the tiles are set up
            free = from_oceans(
                None, settings["ocean.seed"], tuple(tile.job.ocean(backend="auto") for tile in jobs)
            )
        cascade = constrained(free, *job.fixed)
    except JobError:
        raise
    except ParameterError as error:
        raise JobError(f"{job.source}: ocean: {error}") from None
    return [
        replace(tile, job=replace(tile.job, fixes=ocean.amplitudes.fixed), rarity=cascade.rarity)
        for tile, ocean in zip(jobs, cascade.oceans, strict=True)
    ]


def _wrong_shares(listing: Mapping[str, Any], jobs: Sequence[Mapping[str, Any]]) -> str:
    """Return what is wrong with the tiles' shares of the values that their sum has, or ""."""
    values = listing.get("constrained", {}).get("values", [])
    shares = [job.get(fixed_tables.FIX, []) for job in jobs]
    if any(len(share) != len(values) for share in shares):
        return f"the {len(values)} fixed values are not those of its tiles"
    for value, *own in zip(values, *shares, strict=True):
        if any({**part, "value": value["value"]} != value for part in own):
            return f"the tiles do not have {value!r:.120}"
        total = math.fsum(part["value"] for part in own)
        size = max(abs(part["value"]) for part in own)
        if abs(total - value["value"]) > 1e-9 * max(1.0, size):
            return f"the tiles' shares of {value!r:.120} add up to {total!r}"
    return ""


SUMMED = ("sheet", "animation")
"""Previews of a cascade that show the sum of all tiles; the others show one tile."""


def header_of(
    job: Job, jobs: Sequence[TileJob], *, frames: Sequence[int], downsample: int
) -> dict[str, Any]:
    """
    Return the header of a cascade: its job, its tiles, and the measured files.

    The manifests of the tiles name the libraries.
    """
    step = frames[1] - frames[0] if len(frames) > 1 else 1
    described = {key: value for key, value in job.describe().items() if key not in REPLACED}
    listed = [[[s.grid.nx, s.grid.ny], [s.grid.lx, s.grid.ly]] for s in jobs]
    return {
        "tool": "fftocean",
        "version": fftocean.__version__,
        "job": {"tiles": listed, **described},
        "units": {p.key: p.unit for p in PARAMETERS if p.unit and p.key not in REPLACED},
        "subset": "all" if len(frames) == job.frames else f"{frames[0]}:{frames[-1] + 1}:{step}",
        "downsample": downsample,
        "inputs": job.inputs(),
    }


def job_of(
    header: Mapping[str, Any], *, source: str = "job", at_sea: bool = True
) -> tuple[Job, list[Any]]:
    """
    Return the job and the tiles that a header describes.

    Raises:
        IntegrityError: the header describes no cascade.
    """
    try:
        described = dict(header["job"])
        tiles = [(tuple(n), tuple(size)) for n, size in described.pop("tiles")]
        return Job.from_description(described, source=source, at_sea=at_sea), tiles
    except (JobError, KeyError, TypeError, ValueError, AttributeError) as error:
        raise IntegrityError(f"{source} does not describe a cascade: {error!s:.200}") from None


def read_listing(folder: Path) -> dict[str, Any]:
    """
    Read the list of a finished cascade.

    Raises:
        OutputError: the file cannot be read.
        IntegrityError: the file does not exist, or one of its bytes was changed.
    """
    return read_sealed(folder / layout.CASCADE_FILE)


def listed_tiles(folder: Path, listed: Mapping[str, Any]) -> Iterator[Path]:
    """
    Return the folders of the tiles of a list, each when its manifest is found to be the listed one.

    Raises:
        IntegrityError: the manifest of a tile is another one, or does not exist.
    """
    for row in listed["tiles"]:
        path = folder / row["path"] / layout.MANIFEST_FILE
        if digest_whole(path) != row["sha256"]:
            raise IntegrityError(
                f"{path} is not the manifest that {layout.CASCADE_FILE} lists; "
                "`fftocean check` names all problems"
            )
        yield folder / row["path"]


def require_same_cascade(folder: Path, header: Mapping[str, Any]) -> None:
    """
    Raise if a folder holds anything but the cascade of this header.

    Raises:
        OutputError: the folder holds another cascade, the bake of one tile, or files that this
            cascade would replace.
    """
    other = "choose another folder, or --overwrite"
    for name in (layout.JOB_FILE, layout.MANIFEST_FILE):
        if os.path.lexists(folder / name):
            raise OutputError(f"{folder} holds the bake of one tile ({name}); {other}")
    if not os.path.lexists(folder / layout.CASCADE_JOB):
        there = [layout.CASCADE_FILE] if os.path.lexists(folder / layout.CASCADE_FILE) else []
        there += [path.relative_to(folder).as_posix() for path in layout.bake_files(folder)]
        there += layout.tile_folders(folder)
        there += [
            path.name
            for path in engine_files.existing(folder, engine_files.names_for(header["job"]))
        ]
        if there:
            raise OutputError(f"{folder} contains {there[0]} but no {layout.CASCADE_JOB}; {other}")
        return
    before = read_json(folder / layout.CASCADE_JOB)
    if changes := differences(before if isinstance(before, dict) else {}, header):
        raise OutputError(f"{folder} holds the cascade of another job ({changes:.400}); {other}")


def remove_cascade(folder: Path) -> None:
    """
    Remove a cascade's tiles, list, job and previews from its folder; other files stay.

    Raises:
        OutputError: one cannot be removed.
    """
    for path in engine_files_in(folder):
        remove(path)
    remove(folder / layout.CASCADE_FILE)
    for name in layout.tile_folders(folder):
        remove_bake(folder / name)
    for picture in layout.PREVIEW_FILES:
        remove(folder / picture)
    remove(folder / layout.CASCADE_JOB)


def remove_bake(folder: Path) -> None:
    """
    Remove the files of a bake from a folder, and the folder itself if it is empty then.

    Raises:
        OutputError: a file cannot be removed.
    """
    for path in files_of_bake(folder):
        remove(path)
    remove(folder / layout.MANIFEST_FILE)
    remove_workspace(folder)
    for path in layout.bake_files(folder):
        remove(path)
    remove(folder / layout.JOB_FILE)
    for inner in reversed([*layout.folders_of(folder)]):
        remove_temporary_files(inner)
        if not any(inner.iterdir()):
            shutil.rmtree(inner, ignore_errors=True)


def replace_cascade(folder: Path, *, overwrite: bool) -> None:
    """
    Remove a cascade from a folder for the bake of one tile, or raise without `overwrite`.

    Raises:
        OutputError: the folder holds a cascade and `overwrite` is False.
    """
    if not overwrite:
        raise OutputError(
            f"{folder} holds the tiles of a cascade; choose another folder, or --overwrite"
        )
    remove_cascade(folder)


def inconsistencies(
    folder: Path, header: Mapping[str, Any], listing: Mapping[str, Any]
) -> Iterator[tuple[str, str]]:
    """
    Yield (path, detail) of each disagreement between the list of a cascade and its tiles.

    Checked: the job; that bands are disjoint and cover all wavenumbers; sizes, seeds and bands of
    the tiles, made again from the job; the SHA-256 of each manifest; that all tiles are of one sea,
    loop, subset and version; that bounds are the sums of the tiles' bounds.
    """
    name = layout.CASCADE_FILE
    if any(header.get(key) != listing.get(key) for key in HEADER):
        yield name, f"it is not the list of the job in {layout.CASCADE_JOB}"
        return
    try:
        job, tiles = job_of(header, source=name, at_sea=False)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SeaWarning)  # given when it was baked
            jobs = jobs_of_tiles(job, tiles, fixed=False)
        rows = listing["tiles"]
        edges = [edge for row in rows for edge in map(float, row["band"])]
    except (JobError, IntegrityError, KeyError, TypeError, ValueError) as error:
        yield name, f"it does not describe a cascade: {error!s:.200}"
        return
    if (
        edges[0] != 0.0
        or edges[-1] != float("inf")
        or edges[1:-1:2] != edges[2::2]
        or edges != sorted(edges)
    ):
        yield name, f"the bands of its tiles do not adjoin from 0 to inf rad/m: {edges}"
    if [row.get("path") for row in rows] != [tile.path for tile in jobs]:
        yield name, f"its tiles are not the {len(jobs)} of its job"
        return
    bounds, found = {"max_height": 0.0, "max_horizontal": 0.0}, []
    for tile, row in zip(jobs, rows, strict=True):
        path = f"{tile.path}/{layout.MANIFEST_FILE}"
        try:
            manifest = read_sealed(folder / path)
            expected = tile.row(digest_whole(folder / path), manifest)
            for key in bounds:
                bounds[key] += manifest["extremes"][key]
        except (IntegrityError, KeyError, TypeError):
            bounds = {}
            continue  # named by the tile's own check
        if row["sha256"] != expected["sha256"]:
            yield path, f"its SHA-256 is not the one in {name}"
        for key, value in expected.items():
            if key != "sha256" and row.get(key) != value:
                yield (
                    name,
                    f"{key} of {tile.path} is listed as {row.get(key)!r:.80} and is {value!r:.80}",
                )
        described = {k: v for k, v in manifest["job"].items() if k != fixed_tables.FIX}
        found.append(manifest["job"])
        if described != tile.job.describe():
            yield (
                path,
                f"its job is not that of {tile.path}: "
                f"{_first_difference(tile.job.describe(), described)}",
            )
        for key in ("version", "subset", "downsample", "inputs"):
            if manifest[key] != listing[key]:
                yield path, f"{key} is {manifest[key]!r:.80}, and {listing[key]!r:.80} in {name}"
    if len(found) == len(jobs) and (wrong := _wrong_shares(listing, found)):
        yield name, wrong
    for key, total in bounds.items():
        if listing["extremes"][key] != total:
            yield (
                name,
                f"{key} is listed as {listing['extremes'][key]} and the tiles' add up to {total}",
            )


def _first_difference(one: Mapping[str, Any], other: Mapping[str, Any]) -> str:
    """Return the first key in which two jobs differ, with both values."""
    keys = [key for key in {**one, **other} if one.get(key) != other.get(key)]
    return (
        f"{keys[0]} is {other.get(keys[0])!r:.80}, and should be {one.get(keys[0])!r:.80}"
        if keys
        else ""
    )
