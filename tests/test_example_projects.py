"""Files of the example projects, in a checkout and in a wheel."""

import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

from fftocean import example_projects
from fftocean.errors import OutputError

ROOT = Path(__file__).parent.parent


def test_a_project_of_the_checkout_is_found_without_what_its_tools_made(tmp_path, monkeypatch):
    for name in ("one/b.txt", "one/a/c.txt", "one/node_modules/d.js", "one/.godot/e"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    monkeypatch.setattr(example_projects, "PLACES", (tmp_path / "none", tmp_path))
    files = example_projects.project_files("one")
    assert list(files) == ["a/c.txt", "b.txt"]
    assert files["b.txt"].read_text() == "one/b.txt"


def test_an_absent_project_is_named():
    with pytest.raises(OutputError, match="example project no-such-engine"):
        example_projects.project_files("no-such-engine")


@pytest.mark.process
def test_the_wheel_packs_every_file_of_every_project(tmp_path):
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True, timeout=600)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as packed:
        names = set(packed.namelist())
    build = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]
    packed_projects = build["build"]["targets"]["wheel"]["force-include"]
    assert packed_projects
    for folder in packed_projects:
        project = Path(folder).name
        assert packed_projects[folder] == f"fftocean/projects/{project}"
        wanted = {
            f"fftocean/projects/{project}/{name}"
            for name in example_projects.project_files(project)
        }
        assert wanted
        assert wanted <= names


def test_files_of_git_are_not_copied(tmp_path, monkeypatch):
    """Those are of the checkout: the user's project has its own."""
    for name in (".gitignore", ".gitattributes", "inner/.gitkeep", "gitar.txt", ".import/x"):
        (tmp_path / "one" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "one" / name).write_text("x")
    monkeypatch.setattr(example_projects, "PLACES", (tmp_path,))
    assert list(example_projects.project_files("one")) == ["gitar.txt"]


def test_an_installed_wheel_has_its_own_projects():
    """In the folder in the package to which the wheel packs them, and before any other."""
    packed = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]
    folders = packed["build"]["targets"]["wheel"]["force-include"].values()
    package = Path(example_projects.__file__).parent
    assert example_projects.PLACES[0].parent == package
    assert {ROOT / Path(folder).parent for folder in folders} == {example_projects.PLACES[0]}
