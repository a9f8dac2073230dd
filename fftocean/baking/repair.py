"""A bake mended: what is no longer what was written is written again, with the same bytes."""

import os
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fftocean.baking.bake import bake
from fftocean.baking.cascade import bake_tiles
from fftocean.baking.cascade_setup import summable
from fftocean.baking.finished.check import check
from fftocean.baking.finished.contents import Contents
from fftocean.baking.finished.manifest import read_manifest
from fftocean.baking.folder import layout, listing
from fftocean.baking.folder.identity import HEADER, checked, differences, read_checked
from fftocean.baking.folder.run_log import Listen, Progress
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
    Write again all of a bake that `check` finds missing or changed, and remove what it finds extra;
    everything else stays.

    Args:
        folder: that `bake` wrote, or the folder around the tiles of a cascade.
        job: what was baked, where it must be known from which file: its measured spectra are looked
            for beside that. None takes the folder's own word for it.
        executor, workers, progress, listen: as for `bake`.

    Returns:
        The manifest.

    Raises:
        IntegrityError: neither the manifest nor the job's file is what was written, or what was
            written again has other bytes.
        OutputError: a file cannot be written, or this installation would not write the same bytes.
        FolderInUseError: a bake is under way there.
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
        return _mend_tiles(
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
            header = read_checked(folder / layout.JOB_FILE)
        except IntegrityError as error:
            raise IntegrityError(
                f"{folder} cannot be repaired, for it does not say what it is of: {error}"
            ) from None
    job = job or Job.from_description(header["job"])
    if manifest is not None and any(finding.path == layout.JOB_FILE for finding in findings):
        if os.path.lexists(folder / layout.JOB_FILE) and not (folder / layout.JOB_FILE).is_file():
            raise OutputError(f"{folder / layout.JOB_FILE} must be a file, and is not")
        write_whole(folder / layout.JOB_FILE, as_json(checked(header)))
    for finding in findings:
        if finding.kind == "extra":
            remove(folder / finding.path)
    subset = None if header["subset"] == "all" else header["subset"]
    downsample = header["downsample"]
    again = bake(
        job,
        folder,
        frames=subset,
        downsample=downsample,
        executor=executor,
        workers=workers,
        progress=progress,
        listen=listen,
    )
    if manifest is not None and again != checked(manifest):
        what = differences(manifest, again) or "its frames' checksums"
        raise IntegrityError(f"{folder} was repaired, and is not what it was: {what}")
    return again


def _within(path: str, name: str) -> bool:
    """Return whether a path is a folder or lies in it."""
    return path == name or path.startswith(f"{name}/")


def _mend_tiles(
    folder: Path, broken: Sequence[str], job: Job | None, **options: Any
) -> dict[str, Any]:
    """
    Mend a cascade: its broken tiles one by one, then what stands beside them, with the same bytes.

    Args:
        folder: of the cascade.
        broken: folders of the tiles in which something is wrong.
        job: the job, where its measured spectra lie beside its file; None is the folder's own.
        options: executor, workers, progress and listen of `bake_tiles`.

    Raises:
        IntegrityError: neither list nor job is what was written, or other bytes came out.
    """
    try:
        header = read_checked(folder / layout.CASCADE_JOB)
    except IntegrityError:
        header = None
    try:
        before: dict[str, Any] | None = listing.read_listing(folder)
    except IntegrityError as error:
        before = None
        if header is None:
            raise IntegrityError(
                f"{folder} cannot be repaired, for it does not say what it is of: {error}"
            ) from None
    if header is None:
        assert before is not None
        header = {key: before[key] for key in listing.HEADER}
        write_whole(folder / layout.CASCADE_JOB, as_json(checked(header)))
    own, tiles = listing.job_of(header, source=str(folder / layout.CASCADE_JOB))
    work = {
        key: value for key, value in options.items() if key in ("executor", "workers", "listen")
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SeaWarning)  # said when it was baked
        shares = {
            share.path: share.job
            for share in listing.shares_of(own if job is None else summable(job), tiles)
        }
        for name in broken:
            if name not in shares:
                listing.discard_bake(folder / name)
            elif _names_itself(folder / name):
                repair(folder / name, shares[name], **work)
        subset = None if header["subset"] == "all" else header["subset"]
        again = bake_tiles(
            job or own, tiles, folder, frames=subset, downsample=header["downsample"], **options
        )
    if before is not None and again != checked(before):
        raise IntegrityError(
            f"{folder} was repaired, and its {layout.CASCADE_FILE} is not what it was"
        )
    return again


def _names_itself(folder: Path) -> bool:
    """Return whether a bake still says what it is of."""
    for read, path in ((read_manifest, folder), (read_checked, folder / layout.JOB_FILE)):
        try:
            read(path)
        except IntegrityError:
            continue
        return True
    return False
