"""
Project of an engine beside a package: files that the user may edit, move or remove.

The document lists them under `project`, apart from the package's own files: a changed one is no
damage, and an export never replaces one that was edited.
"""

from collections.abc import Iterable, Mapping
from pathlib import PurePosixPath
from typing import Any

from fftocean.engine_projects import Engine
from fftocean.errors import OutputError
from fftocean.example_projects import project_files
from fftocean.files import digest
from fftocean.runtime.layout import DOCUMENT, is_project_name

READERS = "readers"
"""Folder in `examples/` of the readers that several projects share."""


def files_of(engine: Engine) -> dict[str, bytes]:
    """
    Return the files of an engine's project by relative path with slashes.

    Raises:
        OutputError: the project is not installed, or has a file that no package can list.
    """
    found = {}
    for name, path in project_files(engine.project).items():
        found[engine.readme if name == "README.md" else name] = path.read_bytes()
    if engine.readers:
        shared = project_files(READERS)
        for name in engine.readers:
            if name not in shared:
                raise OutputError(f"the reader {name} is not installed with fftocean")
            found.setdefault(name, shared[name].read_bytes())
    for name in found:
        if not is_project_name(name) or name == DOCUMENT:
            raise OutputError(f"the project of engine {engine.name} cannot have a file {name}")
    return dict(sorted(found.items()))


def describe(engine: Engine, files: Mapping[str, bytes]) -> dict[str, Any]:
    """Return the entry of a document for an engine's project."""
    return {
        "engine": engine.name,
        "about": "files copied beside the package: yours to edit, move or remove",
        "files": [
            {"name": name, "bytes": len(data), "sha256": digest(data)}
            for name, data in files.items()
        ],
    }


def listed_in(document: Mapping[str, Any]) -> dict[str, str]:
    """Return the SHA-256 of the files of a project as a document lists them; {} without one."""
    project = document.get("project")
    rows = project.get("files") if isinstance(project, dict) else None
    return {
        str(row["name"]): str(row.get("sha256"))
        for row in rows or ()
        if isinstance(row, dict) and is_project_name(row.get("name"))
    }


def folders_of(names: Iterable[str]) -> set[str]:
    """Return the folders that files are in, by relative path with slashes."""
    return {
        parent.as_posix()
        for name in names
        for parent in PurePosixPath(name).parents
        if parent.as_posix() != "."
    }
