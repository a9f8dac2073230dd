"""Import scripts of a bake for Unity and Unreal: compiled against stubs; parsed."""

import ast
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = ROOT / "examples" / "bake_import"
STUBS = [
    Path(__file__).resolve().parent / "unity" / f"Unity{part}.cs" for part in ("Engine", "Editor")
]


@pytest.mark.client
def test_unitys_script_compiles(mono, tmp_path):
    """Against signatures of Unity's manual: it is not run."""
    command = [mono[0], "-define:UNITY_EDITOR", "-target:library", f"-out:{tmp_path / 'x.dll'}"]
    files = [*STUBS, SCRIPTS / "FFToceanBakeImport.cs"]
    done = subprocess.run(
        [*command, *map(str, files)], capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_scripts_that_were_not_run_say_so_in_their_first_line():
    for file in SCRIPTS.iterdir():
        if file.is_file():
            assert "ot run in Un" in file.read_text(encoding="utf-8").splitlines()[0], file.name


def test_unreals_script_parses():
    ast.parse((SCRIPTS / "fftocean_bake_import.py").read_text(encoding="utf-8"))
