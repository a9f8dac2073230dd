"""
Whose folder it is: what makes a bake's bytes what they are, and the refusal of a folder that holds
anything else.
"""

import errno
import itertools
import json
import os
import platform
import shutil
import stat
import zlib
from collections.abc import Mapping, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any

import fftocean
from fftocean.baking.folder.layout import (
    DRAWN,
    JOB_FILE,
    MANIFEST_FILE,
    SHEET,
    SIDECARS,
    WORK_FOLDER,
    leftovers,
    rooms,
)
from fftocean.errors import IntegrityError, OutputError
from fftocean.export.formats import FORMATS
from fftocean.files import as_json, digest, read_json, read_whole, remove, sweep, write_whole
from fftocean.job.job import Job
from fftocean.job.parameters import PARAMETERS
from fftocean.transforms import library

FILES_OF_PICTURES = {"sheet": SHEET, **DRAWN}
"""The files of pictures, by the names that a job gives those."""

CHECK = "check"
"""The key that holds the SHA-256 of all the others."""

MAX_BYTES = 2**33  # a million frames of all maps


def header_of(job: Job, *, frames: Sequence[int], downsample: int, backend: str) -> dict[str, Any]:
    """
    Return what makes the bytes of a bake what they are: the job, which part of it, the measured
    files, and the libraries.

    Args:
        job: as it was ordered, before it was made smaller.
        frames: which of the loop's frames.
        downsample: how many times fewer samples than the job says.
        backend: the FFT library in use.

    Raises:
        ReaderError: a measured file that cannot be read.
    """
    units = {p.key: p.unit for p in PARAMETERS if p.unit}
    step = frames[1] - frames[0] if len(frames) > 1 else 1
    whole = len(frames) == job.frames
    return {
        "tool": "fftocean",
        "version": fftocean.__version__,
        "job": job.describe(),
        "units": units,
        "subset": "all" if whole else f"{frames[0]}:{frames[-1] + 1}:{step}",
        "downsample": downsample,
        "inputs": job.inputs(),
        "made_with": _libraries(job, backend),
    }


def _libraries(job: Job, backend: str) -> dict[str, str]:
    """The libraries whose next version may give other bits, by what they do here."""
    numba = "numba (off)" if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0") else "numba"
    packer = (
        {"encoder": f"OpenEXR {_version('openexr')}"}
        if FORMATS[job.format].suffix == ".exr"
        else {}
    )
    return {
        "fft": library(backend) or backend,
        "arrays": f"numpy {_version('numpy')}",
        "functions": f"scipy {_version('scipy')}",
        "compiler": f"{numba} {_version('numba')}",
        **packer,
        "deflate": f"zlib {zlib.ZLIB_RUNTIME_VERSION}",
        "pictures": f"pillow {_version('pillow')}",
        "machine": platform.machine(),
    }


def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "unknown"


HEADER = ("tool", "version", "job", "units", "subset", "downsample", "inputs", "made_with")
"""What says which bake a folder holds: all of its job's file, and the head of its manifest."""


def checked(tree: Mapping[str, Any]) -> dict[str, Any]:
    """A tree with the SHA-256 of all of it under `CHECK`: any change of the file can be told."""
    return {**tree, CHECK: digest(as_json(tree))}


def read_checked(path: Path) -> dict[str, Any]:
    """
    Read what `checked` made, without its check.

    Raises:
        OutputError: it cannot be read.
        IntegrityError: it is not there, or is not, to the byte, what was written.
    """
    data = read_whole(path, MAX_BYTES)
    if data is None:
        raise IntegrityError(f"{path} is not there")
    try:
        tree = json.loads(data)
        same = isinstance(tree, dict) and as_json(tree) == data
    except (ValueError, RecursionError):
        raise IntegrityError(
            f"{path} is not JSON as a bake writes it: it was cut or changed"
        ) from None
    if not same or tree.pop(CHECK, None) != digest(as_json(tree)):
        raise IntegrityError(f"{path} was changed after it was written")
    return tree  # type: ignore[no-any-return]


def differences(old: Mapping[str, Any], new: Mapping[str, Any]) -> str:
    """Which keys of two headers differ, with both values; "" where none does."""
    there, here = _flat(old), _flat(new)
    differing = sorted(key for key in {*there, *here} if there.get(key) != here.get(key))
    return "; ".join(
        f"{key}: {there.get(key, 'not set')} there, {here.get(key, 'not set')} here"
        for key in differing[:6]
    )


def _flat(header: Mapping[str, Any]) -> dict[str, Any]:
    """A header's values by the names under which a user knows them."""
    flat = {key: header[key] for key in ("version", "subset", "downsample") if key in header}
    for group, prefix in (("job", ""), ("inputs", "inputs."), ("made_with", "made_with.")):
        values = header.get(group)
        flat |= (
            {f"{prefix}{key}": value for key, value in values.items()}
            if isinstance(values, dict)
            else {}
        )
    return flat


def require_claimable(folder: Path, header: Mapping[str, Any]) -> None:
    """
    Refuse a folder that holds anything but this bake.

    Raises:
        OutputError: another one is marked there, or none and yet files that this one would replace.
    """
    if not os.path.lexists(folder / JOB_FILE):
        there = (
            [folder / MANIFEST_FILE]
            if os.path.lexists(folder / MANIFEST_FILE)
            else [*itertools.islice(leftovers(folder), 1)]
        )
        for path in there:
            name = path.relative_to(folder).as_posix()
            raise OutputError(
                f"{folder} holds a {name} and is no bake, for want of {JOB_FILE}; choose another folder, or --overwrite"
            )
        return
    before = read_json(folder / JOB_FILE)
    if changes := differences(before if isinstance(before, dict) else {}, header):
        raise OutputError(
            f"{folder} holds the bake of another job ({changes:.400}); choose another folder, or --overwrite"
        )


def claimed(folder: Path) -> list[Path]:
    """Return the files of an earlier bake in a folder: those that its manifest or its job lists."""
    listed: set[str] = set()
    jobs: list[Mapping[str, Any]] = []
    for file in (MANIFEST_FILE, JOB_FILE):
        try:
            tree = read_checked(folder / file)
        except (IntegrityError, OutputError):
            continue  # none of ours, or damaged: it claims nothing
        listed |= _paths_in(tree)
        jobs += [tree["job"]] if isinstance(tree.get("job"), dict) else []

    def ours(path: Path) -> bool:
        name = path.relative_to(folder).as_posix()
        return name in listed or any(_is_of(job, name) for job in jobs)

    return [path for path in leftovers(folder) if ours(path)]


def _paths_in(tree: Any) -> set[str]:
    """Return every path that a manifest gives."""
    if isinstance(tree, Mapping):
        here = {tree["path"]} if isinstance(tree.get("path"), str) else set()
        return here.union(*(_paths_in(value) for value in tree.values()))
    if isinstance(tree, list):
        return set().union(*(_paths_in(value) for value in tree))
    return set()


def _is_of(job: Mapping[str, Any], name: str) -> bool:
    """Return whether a bake of a job writes a file of that name, as far as the job says."""
    form = FORMATS.get(str(job.get("bake.format")))
    pictures, maps = job.get("bake.pictures"), job.get("bake.maps")
    if isinstance(pictures, list) and name in {FILES_OF_PICTURES.get(str(p)) for p in pictures}:
        return True
    if form is None or not isinstance(maps, list):
        return False
    for m in map(str, maps):
        if name in {m + suffix for suffix in (form.suffix, *SIDECARS)}:
            return True
        if name.startswith(f"{m}{form.suffix}/"):
            return True  # a folder that is one container
        number = name.removeprefix(f"{m}/").removesuffix(form.suffix)
        if name == f"{m}/{number}{form.suffix}" and number.isdigit():
            return int(number[:9]) < int(job.get("bake.frames") or 0)
    return False


def require_replaceable(folder: Path) -> None:
    """
    Refuse to bake over files that no bake claims, `--overwrite` or not.

    Raises:
        OutputError: the folder holds a file with a name of ours that neither a job nor a manifest
            there lists: it is somebody's own.
    """
    ours = set(claimed(folder))
    foreign = [path for path in leftovers(folder) if path not in ours]
    sealed = any(_is_sealed(folder / file) for file in (MANIFEST_FILE, JOB_FILE))
    if not sealed:
        foreign += [
            path for path in (folder / MANIFEST_FILE, folder / JOB_FILE) if os.path.lexists(path)
        ]
    for path in foreign:
        name = path.relative_to(folder).as_posix()
        raise OutputError(
            f"{folder} holds {name}, which is not listed in a {JOB_FILE} or {MANIFEST_FILE} of a bake "
            "there, and is not overwritten; move it away, or choose another folder"
        )


def _is_sealed(path: Path) -> bool:
    try:
        read_checked(path)
    except (IntegrityError, OutputError):
        return False
    return True


def require_possible(folder: Path, header: Mapping[str, Any], *, overwrite: bool) -> None:
    """
    Refuse, without writing anything, what `bake` would refuse of a folder.

    Raises:
        OutputError: it cannot be made or written to, or holds something else.
    """
    if folder.is_symlink():
        raise OutputError(
            f"{folder} must be a folder of its own, and is a link to {folder.resolve()}"
        )
    try:
        if os.path.lexists(folder) and not stat.S_ISDIR(folder.stat().st_mode):
            raise NotADirectoryError(errno.EEXIST, os.strerror(errno.EEXIST))
        there = next(
            place for place in (folder, *folder.absolute().parents) if os.path.lexists(place)
        )
        if not stat.S_ISDIR(there.stat().st_mode):
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
        if not os.access(there, os.W_OK | os.X_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    except OSError as error:
        raise OutputError(
            f"{folder} could not be made a folder: {error.strerror or error}"
        ) from None
    if overwrite:
        require_replaceable(folder)
    else:
        require_claimable(folder, header)


def claim(folder: Path, header: Mapping[str, Any], *, overwrite: bool) -> None:
    """
    Mark a folder as this bake's, before its first frame. The caller holds the lock, and has saved
    in the journal what is to be kept.

    The manifest goes first of all: from then on the folder is no finished bake, whatever happens.
    """
    stale = claimed(folder) if overwrite else []
    remove(folder / MANIFEST_FILE)
    for room in rooms(folder):
        sweep(room)
    for path in stale:
        remove(path)
    write_whole(folder / JOB_FILE, as_json(checked(header)))


def discard_work(folder: Path) -> None:
    """
    Remove what a bake keeps to itself while it runs.

    Raises:
        OutputError: it cannot be removed.
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
