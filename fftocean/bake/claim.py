"""Whose folder it is: what makes a bake's bytes what they are, and the refusal of a folder that holds anything else."""

import itertools
import json
import os
import platform
import shutil
import zlib
from collections.abc import Mapping, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any

import fftocean
from fftocean.bake.files import as_json, digest, read_json, read_whole, remove, sweep, write_whole
from fftocean.bake.job import Job
from fftocean.bake.layout import JOB_FILE, MANIFEST_FILE, WORK_FOLDER, leftovers, rooms
from fftocean.bake.parameters import PARAMETERS
from fftocean.errors import IntegrityError, OutputError
from fftocean.export.formats import FORMATS
from fftocean.transforms import library

CHECK = "check"
"""The key that holds the SHA-256 of all the others."""

MAX_BYTES = 2**33  # a million frames of all maps


def header_of(job: Job, *, frames: Sequence[int], downsample: int, backend: str) -> dict[str, Any]:
    """
    Return what makes the bytes of a bake what they are: the job, which part of it, the measured files, and the libraries.

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
    packer = {"encoder": f"OpenEXR {_version('openexr')}"} if FORMATS[job.format].suffix == ".exr" else {}
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
        raise IntegrityError(f"{path} is not JSON as a bake writes it: it was cut or changed") from None
    if not same or tree.pop(CHECK, None) != digest(as_json(tree)):
        raise IntegrityError(f"{path} was changed after it was written")
    return tree  # type: ignore[no-any-return]


def differences(old: Mapping[str, Any], new: Mapping[str, Any]) -> str:
    """Which keys of two headers differ, with both values; "" where none does."""
    there, here = _flat(old), _flat(new)
    differing = sorted(key for key in {*there, *here} if there.get(key) != here.get(key))
    return "; ".join(f"{key}: {there.get(key, 'not set')} there, {here.get(key, 'not set')} here" for key in differing[:6])


def _flat(header: Mapping[str, Any]) -> dict[str, Any]:
    """A header's values by the names under which a user knows them."""
    flat = {key: header[key] for key in ("version", "subset", "downsample") if key in header}
    for group, prefix in (("job", ""), ("inputs", "inputs."), ("made_with", "made_with.")):
        values = header.get(group)
        flat |= {f"{prefix}{key}": value for key, value in values.items()} if isinstance(values, dict) else {}
    return flat


def require_claimable(folder: Path, header: Mapping[str, Any]) -> None:
    """
    Refuse a folder that holds anything but this bake.

    Raises:
        OutputError: another one is marked there, or none and yet files that this one would replace.
    """
    if not os.path.lexists(folder / JOB_FILE):
        there = [folder / MANIFEST_FILE] if os.path.lexists(folder / MANIFEST_FILE) else [*itertools.islice(leftovers(folder), 1)]
        for path in there:
            name = path.relative_to(folder).as_posix()
            raise OutputError(f"{folder} holds a {name} and is no bake, for want of {JOB_FILE}; choose another folder, or --overwrite")
        return
    before = read_json(folder / JOB_FILE)
    if changes := differences(before if isinstance(before, dict) else {}, header):
        raise OutputError(f"{folder} holds the bake of another job ({changes:.400}); choose another folder, or --overwrite")


def claim(folder: Path, header: Mapping[str, Any], *, overwrite: bool) -> None:
    """
    Mark a folder as this bake's, before its first frame. The caller holds the lock, and has saved in the journal what is to be kept.

    The manifest goes first of all: from then on the folder is no finished bake, whatever happens.
    """
    remove(folder / MANIFEST_FILE)
    for room in rooms(folder):
        sweep(room)
    if overwrite:
        for stale in leftovers(folder):
            remove(stale)
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
        raise OutputError(f"{error.filename or work} could not be removed: {error.strerror or error}") from error
