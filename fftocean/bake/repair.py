"""A bake mended: what is no longer what was written is written again, with the same bytes."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fftocean.bake import layout
from fftocean.bake.baker import bake
from fftocean.bake.check import check
from fftocean.bake.claim import HEADER, checked, differences, read_checked
from fftocean.bake.contents import Contents
from fftocean.bake.files import as_json, path_of, remove, write_whole
from fftocean.bake.job import Job
from fftocean.bake.ledger import Listen, Progress
from fftocean.bake.manifest import read_manifest
from fftocean.errors import IntegrityError, OutputError


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
    Write again all of a bake that `check` finds missing or changed, and remove what it finds extra; everything else stays.

    Args:
        folder: that `bake` wrote.
        job: what was baked, where it must be known from which file: its measured spectra are looked for beside that. None takes the
            folder's own word for it.
        executor, workers, progress, listen: as for `bake`.

    Returns:
        The manifest.

    Raises:
        IntegrityError: neither the manifest nor the job's file is what was written, or what was written again has other bytes.
        OutputError: a file cannot be written, or this installation would not write the same bytes.
        FolderInUseError: a bake is under way there.
    """
    folder = path_of("folder", folder)
    findings = check(folder)
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
            raise IntegrityError(f"{folder} cannot be repaired, for it does not say what it is of: {error}") from None
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
    again = bake(job, folder, frames=subset, downsample=downsample, executor=executor, workers=workers, progress=progress, listen=listen)
    if manifest is not None and again != checked(manifest):
        what = differences(manifest, again) or "its frames' checksums"
        raise IntegrityError(f"{folder} was repaired, and is not what it was: {what}")
    return again
