"""The distribution: files of its archive, its type marker, files outside version control."""

import subprocess
import sys
import tarfile
import tomllib
from importlib import resources
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_the_package_is_marked_as_typed():
    assert resources.files("fftocean").joinpath("py.typed").is_file()
    assert "Typing :: Typed" in PROJECT["project"]["classifiers"]


def test_the_archive_packs_only_folders_of_the_root():
    """A pattern without a leading slash also means folders of that name in stray environments."""
    assert all(
        pattern.startswith("/")
        for pattern in PROJECT["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]
    )


@pytest.mark.process
def test_an_archive_holds_no_stray_environment(tmp_path):
    """
    Built from a small copy of the tree, with an environment in it whose folders have our names.
    """
    for name in (
        "pyproject.toml",
        "README.md",
        "LICENSE",
        "CHANGELOG.md",
        "fftocean/__init__.py",
        "fftocean/py.typed",
    ):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes((ROOT / name).read_bytes())
    for stray in ("env/lib/fftocean/a.py", "env/docs/b.md", "fftocean/__pycache__/c.pyc"):
        (tmp_path / stray).parent.mkdir(parents=True)
        (tmp_path / stray).write_text("")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", "dist"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, timeout=600)
    (archive,) = (tmp_path / "dist").glob("*.tar.gz")
    with tarfile.open(archive) as packed:
        names = {name.partition("/")[2] for name in packed.getnames()}
    assert {"fftocean/py.typed", "fftocean/__init__.py", "README.md", "LICENSE"} <= names
    assert not [name for name in names if name.startswith("env") or "__pycache__" in name]


def test_files_of_documented_commands_are_ignored_by_git():
    """Folders and images that the commands in README and help write are in .gitignore."""
    ignored = (ROOT / ".gitignore").read_text(encoding="utf-8").splitlines()
    for name in (
        "/sea/",
        "/out/",
        "/gale/",
        "/part/",
        "/sea.png",
        "/gale.png",
        "/bench.png",
        "/buoyancy.png",
        "/here.png",
        "/here.json",
    ):
        assert name in ignored
