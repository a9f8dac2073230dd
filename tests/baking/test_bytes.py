"""
Bytes of the default bake in every format: n = 64, four frames.

`tests/data/bytes.json` has the SHA-256 of each map's files, and what they were made with: versions
of the libraries, and the instruction sets in use. Where all of that is the same, so must the bytes
be. Elsewhere last bits of floats may differ, so the pixels are read back and compared with
`tests/data/bytes.npz`, a sixteenth of them in single precision.

A deliberate change of the bytes is recorded with

    python tests/baking/test_bytes.py
"""

import hashlib
import json
import os
import platform
import tempfile
import zlib
from importlib import metadata
from pathlib import Path

import builders
import numpy as np
import pytest
from llvmlite import binding as llvm

import fftocean as fo
from fftocean.export.formats import FORMATS

DATA = Path(__file__).resolve().parents[1] / "data"
LIST, PIXELS = DATA / "bytes.json", DATA / "bytes.npz"
EVERY = 4  # n-th row and column is stored for other machines
SETTINGS = ("NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES", "NUMBA_DISABLE_JIT", "OPENBLAS_CORETYPE")
BESIDE = ("job.json", "manifest.json")  # they name versions and machine
# of a single-precision transform of 64 x 64, which sums in another order on another processor
FFT_ROUNDING = 32 * float(np.finfo(np.float32).eps)


def signature() -> dict[str, str]:
    """Return what the last bits of a bake may depend on beside the code."""
    packages = ("numpy", "scipy", "numba", "llvmlite", "pyfftw", "isal")
    simd = np.show_config(mode="dicts")["SIMD Extensions"]
    features = [*simd.get("baseline", ()), *simd.get("found", ())]
    return {
        **{package: metadata.version(package) for package in packages},
        "zlib": zlib.ZLIB_RUNTIME_VERSION,
        "machine": f"{platform.system()} {platform.machine()}",
        "numpy's instruction sets": hashlib.sha256(" ".join(features).encode()).hexdigest(),
        "compiler's processor": hashlib.sha256(llvm.get_host_cpu_name().encode()).hexdigest(),
        "fft": str(builders.job({"ocean.n": 16}).ocean().backend),
        "set by the user": " ".join(
            f"{key}={os.environ[key]}" for key in SETTINGS if key in os.environ
        ),
    }


def baked(form: str, folder: Path) -> tuple[dict[str, str], fo.Bake]:
    """Bake the default sea; return the SHA-256 of each map's files, and the maps."""
    maps = ["height"] if form == "r16" else ["displacement", "normal"]
    changes = {"ocean.n": 64, "bake.frames": 4, "bake.pictures": [], "bake.maps": maps}
    job = builders.job({**changes, "bake.format": form})
    fo.bake(job, folder, executor="serial")
    files = {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name not in BESIDE
    }
    return files, fo.load(folder)


def step_of(form: str, values: np.ndarray) -> np.ndarray:
    """Return one step of what a format stores, at each value."""
    stored = FORMATS[form].stored
    if stored == "uint16":  # of the range over the whole loop; 2 covers that of a normal, -1 to 1
        return np.full_like(values, max(2.0, 2.0 * float(np.abs(values).max())) / 65535.0)
    return np.spacing(np.abs(values).astype(stored)).astype(np.float32)


def differing(form: str, name: str, values: np.ndarray, reference: np.ndarray) -> int:
    """Return how many of the stored pixels are more than one step away."""
    sampled = values[:, ::EVERY, ::EVERY]
    allowed = step_of(form, reference) + FFT_ROUNDING * float(np.abs(reference).max())
    assert sampled.shape == reference.shape, name
    return int(np.count_nonzero(~(np.abs(sampled - reference) <= allowed)))


@pytest.fixture(scope="module")
def listed():
    return json.loads(LIST.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def reference():
    with np.load(PIXELS) as pixels:
        return dict(pixels)


@pytest.mark.parametrize("form", FORMATS)
def test_the_default_bake_is_the_recorded_one(form, listed, reference, tmp_path):
    files, maps = baked(form, tmp_path)
    assert files.keys() == listed["sha256"][form].keys()
    if listed["made with"] == signature():
        assert files == listed["sha256"][form]
    for name, values in maps.maps.items():
        assert differing(form, name, values, reference[name]) == 0, f"{name} as {form}"


@pytest.mark.parametrize(("form", "harm"), [("exr", 2e-3), ("exr-float", 1e-5), ("png16", 1e-4)])
def test_the_comparison_of_pixels_sees_a_small_change(form, harm, reference):
    """A scale factor as a changed constant would bring it, below what an eye sees."""
    reference = reference["displacement"]
    values = np.repeat(np.repeat(reference, EVERY, axis=1), EVERY, axis=2)
    assert differing(form, "displacement", values, reference) == 0
    assert differing(form, "displacement", values * np.float32(1.0 + harm), reference) > 0


def renew() -> None:
    """Record the bytes and pixels of this code on this machine."""
    sums, pixels = {}, {}
    for form in FORMATS:
        with tempfile.TemporaryDirectory() as folder:
            sums[form], maps = baked(form, Path(folder))
            if FORMATS[form].stored == "float32":
                pixels |= {name: m[:, ::EVERY, ::EVERY] for name, m in maps.maps.items()}
            elif form == "r16":
                exact = builders.job({"ocean.n": 64}).ocean()
                heights = [exact.loop_frame(j, 4, ("height",)).height.copy() for j in range(4)]
                pixels["height"] = np.stack(heights)[:, ::EVERY, ::EVERY, None]
    text = json.dumps({"made with": signature(), "sha256": sums}, indent=1)
    LIST.write_text(text + "\n", encoding="utf-8")
    np.savez_compressed(PIXELS, **{name: np.float32(values) for name, values in pixels.items()})


if __name__ == "__main__":
    renew()
