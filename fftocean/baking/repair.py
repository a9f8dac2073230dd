"""Repair of a bake: damaged files are written again, with the same bytes."""

import os
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fftocean.baking.bake import bake_packed
from fftocean.baking.cascade import bake_tiles
from fftocean.baking.cascade_setup import summable
from fftocean.baking.finished.check import check
from fftocean.baking.finished.contents import Contents
from fftocean.baking.finished.manifest import read_manifest
from fftocean.baking.folder import layout, listing
from fftocean.baking.folder.identity import HEADER, differences
from fftocean.baking.folder.journal import Listen, Progress
from fftocean.baking.folder.rows import unpacked
from fftocean.baking.folder.sealed import CHECK, read_sealed, sealed
from fftocean.errors import IntegrityError, OutputError, SeaWarning
from fftocean.files import as_json, path_of, remove, write_whole
from fftocean.job.job import Job


def repair(
    folder: str | Path,
    job: Job | None = None,
    *,
    executor: str = "auto",
    workers: int | None = None,
    progress: Progress | None = None,
    listen: Listen | None = None,
) -> dict[str, Any]:
    """
    Repair a bake: write missing and changed files again, and remove extra ones.

    `check` finds these files; all others stay.

    Args:
        folder: the folder of a bake, or the one around the tiles of a cascade.
        job: the job that was baked, read from its file, if it has measured spectra, which are
            looked up next to that file. None takes the job from the folder.
        executor, workers, progress, listen: as for `bake`.

    Returns:
        The manifest as plain data.

    Raises:
        IntegrityError: neither manifest.json nor job.json is readable, or a file that was written
            again has other bytes.
        OutputError: a file cannot be written, or this installation would write other bytes.
        FolderInUseError: another process bakes into the folder.
    """
    folder = path_of("folder", folder)
    findings = check(folder)
    if layout.is_cascade(folder):
        for finding in findings:
            if (
                finding.kind == "extra"
                and "/" not in finding.path
                and not (folder / finding.path).is_dir()
            ):
                remove(folder / finding.path)
        tiles = [
            name
            for name in layout.tile_folders(folder)
            if any(_within(finding.path, name) for finding in findings)
        ]
        return _repair_tiles(
            folder, tiles, job, executor=executor, workers=workers, progress=progress, listen=listen
        )
    manifest: dict[str, Any] | None
    try:
        manifest = read_manifest(folder)
        Contents.of(folder, manifest)
        header: Mapping[str, Any] = {key: manifest[key] for key in HEADER}
    except (IntegrityError, KeyError):
        manifest = None
        try:
            header = read_sealed(folder / layout.JOB_FILE)
        except IntegrityError as error:
            raise IntegrityError(
                f"{folder} cannot be repaired: neither "
                f"{layout.MANIFEST_FILE} nor {layout.JOB_FILE} is readable ({error})"
            ) from None
    job = job or Job.from_description(header["job"])
    if manifest is not None and any(finding.path == layout.JOB_FILE for finding in findings):
        if os.path.lexists(folder / layout.JOB_FILE) and not (folder / layout.JOB_FILE).is_file():
            raise OutputError(f"{folder / layout.JOB_FILE} must be a file, and is not")
        write_whole(folder / layout.JOB_FILE, as_json(sealed(header)))
    for finding in findings:
        if finding.kind == "extra":
            remove(folder / finding.path)
    subset = None if header["subset"] == "all" else header["subset"]
    downsample = header["downsample"]
    again = bake_packed(
        job,
        folder,
        frames=subset,
        downsample=downsample,
        executor=executor,
        workers=workers,
        progress=progress,
        listen=listen,
    )
    if manifest is not None and {**again, CHECK: None} != {**manifest, CHECK: None}:
        changes = differences(manifest, again) or "checksums of frames"
        raise IntegrityError(f"{folder} was repaired, and differs from the first bake: {changes}")
    return unpacked(again)


def _within(path: str, name: str) -> bool:
    """Return whether a path is a folder or lies in it."""
    return path == name or path.startswith(f"{name}/")


def _repair_tiles(
    folder: Path, broken: Sequence[str], job: Job | None, **options: Any
) -> dict[str, Any]:
    """
    Repair a cascade: its damaged tiles one by one, then its list and previews.

    Args:
        folder: of the cascade.
        broken: folders of the tiles in which a problem was found.
        job: the job, if its measured spectra lie next to its file; None takes that of the folder.
        options: executor, workers, progress and listen of `bake_tiles`.

    Raises:
        IntegrityError: neither list nor job is readable, or a repaired file has other bytes.
    """
    try:
        header = read_sealed(folder / layout.CASCADE_JOB)
    except IntegrityError:
        header = None
    try:
        before: dict[str, Any] | None = listing.read_listing(folder)
    except IntegrityError as error:
        before = None
        if header is None:
            raise IntegrityError(
                f"{folder} cannot be repaired: neither "
                f"{layout.CASCADE_FILE} nor {layout.CASCADE_JOB} is readable ({error})"
            ) from None
    if header is None:
        assert before is not None
        header = {key: before[key] for key in listing.HEADER}
        write_whole(folder / layout.CASCADE_JOB, as_json(sealed(header)))
    own, tiles = listing.job_of(header, source=str(folder / layout.CASCADE_JOB))
    tile_options = {
        key: value for key, value in options.items() if key in ("executor", "workers", "listen")
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SeaWarning)  # given when it was baked
        tile_jobs = {
            tile.path: tile.job
            for tile in listing.jobs_of_tiles(own if job is None else summable(job), tiles)
        }
        for name in broken:
            if name not in tile_jobs:
                listing.remove_bake(folder / name)
            elif _is_described(folder / name):
                repair(folder / name, tile_jobs[name], **tile_options)
        subset = None if header["subset"] == "all" else header["subset"]
        again = bake_tiles(
            job or own, tiles, folder, frames=subset, downsample=header["downsample"], **options
        )
    if before is not None and again != sealed(before):
        raise IntegrityError(
            f"{folder} was repaired, and its {layout.CASCADE_FILE} differs from the first one"
        )
    return again


def _is_described(folder: Path) -> bool:
    """Return whether the manifest or the job of a bake is readable."""
    for read, path in ((read_manifest, folder), (read_sealed, folder / layout.JOB_FILE)):
        try:
            read(path)
        except IntegrityError:
            continue
        return True
    return False
