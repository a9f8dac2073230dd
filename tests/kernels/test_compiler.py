"""The cache of compiled code: a read-only, cut, bent or foreign one costs time and nothing else."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

FUNCTION = """
import numpy as np
from fftocean.kernels.compiler import compiled

@compiled
def twice(x):
    return x + x

assert twice(np.arange(3.0)).tolist() == [0.0, 2.0, 4.0]
print(sum(getattr(twice, "_cache_hits", {}).values()))
"""


def run(folder: Path, **environment: str) -> int:
    """Compile and call a kernel in a process of its own; how often the cache was of use."""
    env = {**os.environ, "NUMBA_CACHE_DIR": str(folder / "cache"), **environment}
    env.pop("NUMBA_DISABLE_JIT", None)
    script = folder / "script.py"
    done = subprocess.run(
        [sys.executable, "-W", "error", str(script)],
        env=env,
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stderr
    return int(done.stdout)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    script = tmp_path / "script.py"
    script.write_text(FUNCTION)
    os.utime(script, (1e9, 1e9))
    assert run(tmp_path) == 0
    assert run(tmp_path) == 1
    return tmp_path


def files(folder: Path, ending: str) -> list[Path]:
    return [path for path in (folder / "cache").rglob(f"*{ending}") if path.is_file()]


@pytest.mark.parametrize("ending", [".nbi", ".nbc"])
def test_cut_and_bent_files_are_done_without_and_replaced(folder, ending):
    (file,) = files(folder, ending)
    whole = file.read_bytes()
    middle = len(whole) // 2
    for spoilt in (
        b"",
        whole[:middle],
        whole[:-1],
        whole[:middle] + bytes([whole[middle] ^ 16]) + whole[middle + 1 :],
        b"\x80garbage" * 50,
    ):
        file.write_bytes(spoilt)
        assert run(folder) == 0  # compiled anew
        assert run(folder) == 1  # and kept


def test_without_a_place_for_a_cache(folder):
    """A cache folder that is a file: nothing is kept, nothing stops."""
    (folder / "occupied").write_text("")
    assert run(folder, NUMBA_CACHE_DIR=str(folder / "occupied")) == 0


LITTLE_SPACE = """
import resource, signal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))
"""


@pytest.mark.skipif(os.name == "nt", reason="needs a limit on the size of files")
def test_a_full_disk_costs_the_cache_and_nothing_else(tmp_path):
    (tmp_path / "script.py").write_text(LITTLE_SPACE + FUNCTION)
    assert run(tmp_path) == 0
    assert files(tmp_path, ".nbc") == []


PAIR = """
import math, sys
import numpy as np
from fftocean.kernels.compiler import compiled

@compiled
def waved(x):
    return np.sin(x) + math.hypot(x[0], 2.0)

@compiled
def twice(x):
    return 2.0 * waved(x)

x = np.arange(3.0)
for kernel, factor in ((waved, 1.0), (twice, 2.0)):
    off = kernel(x) - factor * (np.sin(x) + 2.0)
    assert np.max(np.abs(off)) < 1e-15 * 8, off  # a few roundings of numbers up to 6
    print(sum(getattr(kernel, "_cache_hits", {}).values()), "numba.np.linalg" in sys.modules)
"""


def test_kernels_are_loaded_without_the_compiler_and_compile_with_one_that_was(tmp_path):
    """
    Of two kernels the second calls the first: both from the cache load nothing that only compiling
    needs; with the second's file gone, the first is loaded, and then the second compiled.
    """
    (tmp_path / "script.py").write_text(PAIR)
    os.utime(tmp_path / "script.py", (1e9, 1e9))

    def hits() -> list[str]:
        env = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
        env.pop("NUMBA_DISABLE_JIT", None)
        command = [sys.executable, "-W", "error", str(tmp_path / "script.py")]
        done = subprocess.run(command, env=env, capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, done.stderr
        return done.stdout.split("\n")[:2]

    assert hits() == ["0 True", "0 True"]
    assert hits() == ["1 False", "1 False"]
    for file in files(tmp_path, ".nbc"):
        if "twice" in file.name:
            file.unlink()
    assert hits() == ["1 False", "0 True"]
