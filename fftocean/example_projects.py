"""
Engine projects that exports copy: `examples/` of a checkout, `projects/` of an installed wheel.

They stand once, in `examples/`, where people look for them and tests run them; the wheel packs the
same files (`pyproject.toml`), so that an export finds them without a checkout.
"""

from pathlib import Path

from fftocean.errors import OutputError

_HERE = Path(__file__).resolve().parent
PLACES = (_HERE / "projects", _HERE.parent / "examples")
SKIPPED = ("__pycache__", "node_modules", ".godot", ".import")
"""Folders within a project that its tools make: they are not copied."""


def project_files(name: str) -> dict[str, Path]:
    """
    Return the files of a project: relative path with slashes -> file, in alphabetical order.

    Args:
        name: of the folder in `examples/`.

    Raises:
        OutputError: no such project is installed.
    """
    for place in PLACES:
        folder = place / name
        if folder.is_dir():
            files = {file.relative_to(folder): file for file in folder.rglob("*") if file.is_file()}
            return {
                path.as_posix(): file
                for path, file in sorted(files.items(), key=lambda item: item[0].as_posix())
                if not set(SKIPPED) & set(path.parts) and not path.name.startswith(".git")
            }
    raise OutputError(f"the files of the example project {name} are not installed with fftocean")
