"""
Protection of files in a bake's folder that the bake did not write.

A folder belongs to the bake that its `job.json` describes. Another bake is refused there, unless
the user asks to overwrite it; even then only files that the earlier job or manifest lists are
removed.
"""

import errno
import itertools
import os
import shutil
import stat
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fftocean.baking.folder import engine_files
from fftocean.baking.folder.identity import differences
from fftocean.baking.folder.layout import (
    CASCADE_FILE,
    CASCADE_JOB,
    JOB_FILE,
    MANIFEST_FILE,
    PREVIEWS,
    SHEET,
    SIDECARS,
    WORK_FOLDER,
    bake_files,
    folders_of,
    frame_settings,
)
from fftocean.baking.folder.rows import RowList
from fftocean.baking.folder.sealed import is_sealed, read_sealed, sealed
from fftocean.errors import IntegrityError, OutputError
from fftocean.export.formats import FORMATS
from fftocean.export.recipes import FRAME_SUFFIX
from fftocean.files import as_json, read_json, remove, remove_temporary_files, write_whole

PREVIEW_FILES = {"sheet": SHEET, **PREVIEWS}
"""Files of previews by their names in a job."""


def require_same_bake(folder: Path, header: Mapping[str, Any]) -> None:
    """
    Raise if a folder holds anything but the bake of this header.

    Raises:
        OutputError: the folder belongs to another bake, or to none and yet has files that this one
            would replace.
    """
    if not os.path.lexists(folder / JOB_FILE):
        found = (
            [folder / MANIFEST_FILE]
            if os.path.lexists(folder / MANIFEST_FILE)
            else [*itertools.islice(bake_files(folder), 1)]
            or engine_files.existing(folder, engine_files.names_for(header["job"]))
        )
        for path in found:
            name = path.relative_to(folder).as_posix()
            raise OutputError(
                f"{folder} contains {name}, named like a file of a bake, but no {JOB_FILE}; "
                "choose another folder, or --overwrite"
            )
        return
    before = read_json(folder / JOB_FILE)
    if changes := differences(before if isinstance(before, dict) else {}, header):
        raise OutputError(
            f"{folder} holds the bake of another job ({changes:.400}); "
            "choose another folder, or --overwrite"
        )


def files_of_bake(folder: Path) -> list[Path]:
    """Return the files of an earlier bake in a folder: those that its manifest or its job lists."""
    listed: set[str] = set()
    jobs: list[Mapping[str, Any]] = []
    for file in (MANIFEST_FILE, JOB_FILE):
        try:
            tree = read_sealed(folder / file)
        except (IntegrityError, OutputError):
            continue  # not written by a bake, or damaged: it lists nothing
        listed |= _paths_in(tree)
        jobs += [tree["job"]] if isinstance(tree.get("job"), dict) else []

    def is_listed(path: Path) -> bool:
        name = path.relative_to(folder).as_posix()
        return name in listed or any(_is_of(job, name) for job in jobs)

    candidates = (*bake_files(folder), *frame_settings(folder))
    found = [path for path in candidates if is_listed(path)]
    return [*found, *engine_files_in(folder)]


def engine_files_in(folder: Path) -> list[Path]:
    """
    Return the files of an engine's player in a folder: those that a bake or cascade there lists.
    """
    names: set[str] = set()
    for file in (MANIFEST_FILE, JOB_FILE, CASCADE_FILE, CASCADE_JOB):
        try:
            tree = read_sealed(folder / file)
        except (IntegrityError, OutputError):
            continue  # as in `files_of_bake`
        names |= _paths_in(tree) & engine_files.NAMES
        if isinstance(tree.get("job"), dict):
            names |= {*engine_files.names_for(tree["job"])}
    return engine_files.existing(folder, sorted(names))


def _paths_in(tree: Any) -> set[str]:
    """Return every path that a manifest gives."""
    if isinstance(tree, Mapping):
        here = {tree["path"]} if isinstance(tree.get("path"), str) else set()
        return here.union(*(_paths_in(value) for value in tree.values()))
    if isinstance(tree, (list, RowList)):
        return set().union(*(_paths_in(value) for value in tree))
    return set()


def _is_of(job: Mapping[str, Any], name: str) -> bool:
    """Return whether a bake of a job writes a file of that name, as far as the job says."""
    form = FORMATS.get(str(job.get("bake.format")))
    previews, maps = job.get("bake.pictures"), job.get("bake.maps")
    if isinstance(previews, list) and name in {PREVIEW_FILES.get(str(p)) for p in previews}:
        return True
    if form is None or not isinstance(maps, list):
        return False
    for m in map(str, maps):
        if name in {m + suffix for suffix in (form.suffix, *SIDECARS)}:
            return True
        if name.startswith(f"{m}{form.suffix}/"):
            return True  # a folder that is one container
        image = name.removesuffix(FRAME_SUFFIX) if job.get("bake.engine") == "godot" else name
        number = image.removeprefix(f"{m}/").removesuffix(form.suffix)
        if image == f"{m}/{number}{form.suffix}" and number.isdigit():
            return int(number[:9]) < int(job.get("bake.frames") or 0)
    return False


def require_replaceable(folder: Path, header: Mapping[str, Any]) -> None:
    """
    Raise if overwriting, by the bake of this header, would replace a file that no bake lists.

    Raises:
        OutputError: neither a job nor a manifest in the folder lists a file there that is named
            like one of a bake.
    """
    listed = set(files_of_bake(folder))
    written = engine_files.existing(folder, engine_files.names_for(header["job"]))
    foreign = [path for path in (*bake_files(folder), *written) if path not in listed]
    if not any(is_sealed(folder / file) for file in (MANIFEST_FILE, JOB_FILE)):
        foreign += [
            path for path in (folder / MANIFEST_FILE, folder / JOB_FILE) if os.path.lexists(path)
        ]
    for path in foreign:
        name = path.relative_to(folder).as_posix()
        raise OutputError(
            f"{folder} holds {name}, which is not listed in a {JOB_FILE} or {MANIFEST_FILE} of a "
            "bake there, and is not overwritten; move it away, or choose another folder"
        )


def require_possible(folder: Path, header: Mapping[str, Any], *, overwrite: bool) -> None:
    """
    Raise if `bake` would refuse a folder; write nothing.

    Raises:
        OutputError: the folder cannot be made or written to, or holds something else.
    """
    require_writable(folder)
    if overwrite:
        require_replaceable(folder, header)
    else:
        require_same_bake(folder, header)


def require_writable(folder: Path) -> None:
    """
    Raise if a folder cannot be made or written to; write nothing.

    Raises:
        OutputError: it is a link or no folder, or permission is missing.
    """
    if folder.is_symlink():
        raise OutputError(f"{folder} must be a folder, and is a link to {folder.resolve()}")
    try:
        if os.path.lexists(folder) and not stat.S_ISDIR(folder.stat().st_mode):
            raise NotADirectoryError(errno.EEXIST, os.strerror(errno.EEXIST))
        parent = next(
            place for place in (folder, *folder.absolute().parents) if os.path.lexists(place)
        )
        if not stat.S_ISDIR(parent.stat().st_mode):
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
        if not os.access(parent, os.W_OK | os.X_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    except OSError as error:
        raise OutputError(
            f"{folder} could not be made a folder: {error.strerror or error}"
        ) from None


def mark(folder: Path, header: Mapping[str, Any], *, overwrite: bool) -> None:
    """
    Write `job.json`, by which a folder belongs to this bake, before its first frame.

    The caller holds the lock, and has saved in the journal what is to be kept. The manifest is
    removed first of all: from then on the folder is no finished bake, whatever happens.

    Raises:
        OutputError: a file cannot be written or removed.
    """
    stale = files_of_bake(folder) if overwrite else []
    remove(folder / MANIFEST_FILE)
    for inner in folders_of(folder):
        remove_temporary_files(inner)
    for path in stale:
        remove(path)
    write_whole(folder / JOB_FILE, as_json(sealed(header)))


def remove_workspace(folder: Path) -> None:
    """
    Remove the files that a bake needs only while it runs.

    Raises:
        OutputError: one cannot be removed.
    """
    work = folder / WORK_FOLDER
    if work.is_symlink() or not work.is_dir():
        return
    try:
        shutil.rmtree(work)
    except OSError as error:
        raise OutputError(
            f"{error.filename or work} could not be removed: {error.strerror or error}"
        ) from error
