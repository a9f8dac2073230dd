"""
Folder of a run-time package: files that are complete or absent, and `sea.json` written last.

An export that was stopped leaves a mark, and no `sea.json`. The same export again keeps the files
that are there already, with the same bytes. Another one is refused, unless it may overwrite; even
then, files that no package lists are left alone, and files of a project that were edited.
"""

import contextlib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fftocean.baking.folder import layout as bake_layout
from fftocean.baking.folder.lock import locked, require_free
from fftocean.baking.folder.sealed import CHECK, read_sealed, sealed
from fftocean.cascade import Cascade
from fftocean.engine_projects import engine_of
from fftocean.errors import IntegrityError, OutputError
from fftocean.files import (
    as_json,
    digest,
    make_folder,
    make_parents,
    path_of,
    read_whole,
    remove,
    remove_temporary_files,
    write_whole,
)
from fftocean.foam import Foam
from fftocean.ocean import Ocean
from fftocean.runtime import project
from fftocean.runtime.container import require_same
from fftocean.runtime.contents import Contents
from fftocean.runtime.decode import ocean_of
from fftocean.runtime.layout import DOCUMENT, MOST_BYTES, MOST_DOCUMENT, README, is_file_name
from fftocean.runtime.package import SeaPackage, add_file, pack
from fftocean.runtime.readme import readme_of

MARK = ".export.json"
"""File by which an export that was stopped is known: it lists what is being written."""
OTHER = "choose another folder, or --overwrite"


def export_sea(
    source: Ocean | Cascade,
    folder: str | Path,
    *,
    textures: bool | str = False,
    engine: str | None = None,
    job: str | None = None,
    ticks: int | None = None,
    foam: Foam | None = None,
    wind: tuple[float, float] | None = None,
    overwrite: bool = False,
) -> dict[str, Any]:
    """
    Write the waves of a sea into a folder, for programs that run it; docs/runtime.md has the bytes.

    Files are complete or absent, and `sea.json`, with the SHA-256 of the others, is written last: a
    folder without it holds no package. The same call again finishes an export that was stopped.

    With an engine, its kernels are of the package, and the files of its project are copied beside
    it. These are the user's from then on: one that was edited is neither damage nor replaced.

    Args:
        source: an ocean or a cascade that loops.
        folder: the folder to write to; made if it does not exist.
        textures, engine, job, ticks, foam, wind: as in `runtime.pack`; a wind has a speed [m/s]
            and a direction [degrees].
        overwrite: replace another package, whose files are removed first.

    Returns:
        The contents of `sea.json` as plain data.

    Raises:
        ParameterError: waves that a package cannot hold; the message has the rule.
        OutputError: a file cannot be written, or the folder holds something else.
        FolderInUseError: another process writes to the folder.
    """
    folder = path_of("folder", folder)
    require_free(folder)
    package = pack(
        source, textures=textures, engine=engine, job=job, ticks=ticks, foam=foam, wind=wind
    )
    row = engine_of(engine)
    added = {} if row is None else project.files_of(row)
    if row is not None:
        package.document["project"] = project.describe(row, added)
    add_file(package, README, readme_of(package.document), "text", [], "")
    if both := sorted(set(added) & set(package.files)):
        raise OutputError(f"the project of engine {engine} has a file {both[0]} of the package")
    document = sealed(package.document)
    make_folder(folder)
    with locked(folder):
        try:
            kept = _make_way(folder, document, package.files, added, overwrite=overwrite)
            for name, data in package.files.items():
                if read_whole(folder / name, MOST_BYTES) != data:
                    write_whole(folder / name, data)
            for name, data in added.items():
                if name not in kept and read_whole(folder / name, MOST_BYTES) != data:
                    write_whole(make_parents(folder, name), data)
            write_whole(folder / DOCUMENT, as_json(document))
            remove(folder / MARK)
        finally:
            for inner in ["", *sorted(project.folders_of(added))]:
                remove_temporary_files(folder / inner)
    return document


def edited_files(folder: Path, document: Mapping[str, Any]) -> list[str]:
    """Return the files of a project that are no longer as an export wrote them."""
    return [
        name
        for name, sha256 in project.listed_in(document).items()
        if (data := read_whole(folder / name, MOST_BYTES)) is None or digest(data) != sha256
    ]


def load_sea(
    folder: str | Path,
    *,
    dtype: str = "float32",
    backend: str = "auto",
    planning: str = "estimate",
    threads: int = 1,
) -> Ocean | Cascade:
    """
    Return the sea of a package: an ocean, or the cascade of several tiles.

    Nothing is made from a seed: the waves are those of the package, whose amplitudes have single
    precision. So frames equal those of the exported ocean to round-off of float32, and are the
    same wherever the package is read. `sea` is None, since a package has no spectra.

    Args:
        folder: the folder of a package.
        dtype, backend, planning, threads: as in `Ocean`.

    Raises:
        OutputError: the folder does not exist, or a file cannot be read.
        IntegrityError: a file is missing, or was changed after it was written.
    """
    return ocean_of(
        read_package(folder), dtype=dtype, backend=backend, planning=planning, threads=threads
    )


def read_package(folder: str | Path) -> SeaPackage:
    """
    Read the package in a folder, all of whose files are unchanged.

    Raises:
        OutputError, IntegrityError: as `load_sea`.
    """
    folder = path_of("folder", folder)
    if not folder.is_dir():
        reason = "is not a folder" if folder.exists() else "does not exist"
        raise OutputError(f"{folder} must be the folder of a run-time package, and {reason}")
    document = read_sealed(folder / DOCUMENT, MOST_DOCUMENT)
    files = {}
    for file in Contents.of(document, str(folder / DOCUMENT)).files:
        data = read_whole(folder / file.name, MOST_BYTES)
        if file.sha256 is None:
            raise IntegrityError(f"{folder / DOCUMENT} must list the SHA-256 of {file.name}")
        if data is None:
            raise IntegrityError(f"{folder / file.name} does not exist")
        require_same(data, file)
        files[file.name] = data
    return SeaPackage(document, files)


def is_package(folder: Path) -> bool:
    """Return whether a folder holds a run-time package, or an export that was stopped."""
    return any(os.path.lexists(folder / name) for name in (DOCUMENT, MARK))


def _make_way(
    folder: Path,
    document: Mapping[str, Any],
    files: Mapping[str, bytes],
    added: Mapping[str, bytes],
    *,
    overwrite: bool,
) -> set[str]:
    """
    Mark an export, and remove another package if it may be overwritten; leave this one's files.

    Args:
        folder: the folder to write to.
        document: of the package that is written.
        files: of the package.
        added: of its project.
        overwrite: replace another package.

    Returns:
        The files of the project that were edited, and are kept.

    Raises:
        OutputError: the folder holds something else, or another package and may not be overwritten.
    """
    for name in (
        bake_layout.JOB_FILE,
        bake_layout.MANIFEST_FILE,
        bake_layout.CASCADE_JOB,
        bake_layout.CASCADE_FILE,
    ):
        if os.path.lexists(folder / name):
            raise OutputError(f"{folder} holds a bake ({name}); choose another folder")
    # By packages that are or were to be here: files of the package, and the SHA-256 of those of its
    # project.
    listed: set[str] = set()
    projects: dict[str, set[str]] = {}
    for name, words in ((DOCUMENT, "another sea"), (MARK, "an unfinished export of another sea")):
        if not os.path.lexists(folder / name):
            continue
        earlier = _earlier(folder, name)
        same = earlier == document or earlier.get("document") == document[CHECK]
        if not same and not overwrite:
            raise OutputError(f"{folder} holds {words} ({name}); {OTHER}")
        listed |= _names_in(earlier)
        for file, sha256 in project.listed_in(earlier).items():
            projects.setdefault(file, set()).add(sha256)
    kept: set[str] = set()
    replaced: set[str] = set()
    for name, digests in projects.items():
        data = read_whole(folder / name, MOST_BYTES)
        if data is not None and data != added.get(name):
            (replaced if digest(data) in digests else kept).add(name)
    known = listed | set(projects)
    for name, data in {**files, **added}.items():
        if name not in known and os.path.lexists(folder / name):
            if read_whole(folder / name, MOST_BYTES) == data:
                continue
            raise OutputError(
                f"{folder} holds {name}, which is not listed in a {DOCUMENT} there, and is not "
                "overwritten; move it away, or choose another folder"
            )
    other = os.path.lexists(folder / DOCUMENT) and _earlier(folder, DOCUMENT) != document
    if other:
        for name in sorted(listed):
            remove(folder / name)
    mark = {"document": document[CHECK], "files": list(files), "project": document.get("project")}
    write_whole(folder / MARK, as_json(sealed(mark)))
    gone = replaced - set(added)
    for name in sorted(gone):
        remove(folder / name)
    for inner in sorted(project.folders_of(gone), reverse=True):
        with contextlib.suppress(OSError):  # something else is in it
            (folder / inner).rmdir()
    if other:
        # last: until then it lists what is to be removed
        remove(folder / DOCUMENT)
    for name in sorted(listed - set(files)):
        remove(folder / name)
    return kept


def _earlier(folder: Path, name: str) -> dict[str, Any]:
    """
    Return the document or the mark of an earlier export, with its checksum.

    Raises:
        OutputError: it was changed, so what it lists is not known to be of a package.
    """
    try:
        tree = read_sealed(folder / name, MOST_DOCUMENT)
    except IntegrityError as error:
        raise OutputError(
            f"{error}; it is not overwritten: move it away, or choose another folder"
        ) from None
    return sealed(tree)


def _names_in(tree: Mapping[str, Any]) -> set[str]:
    """Return the names of files that a document or a mark lists."""
    rows = tree.get("files")
    names = [row.get("name") if isinstance(row, dict) else row for row in rows or ()]
    return {str(name) for name in names if is_file_name(name)}
