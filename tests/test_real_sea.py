"""A measured sea: NDBC buoy 44004, 1 January 2000, from its file to a baked tile."""

import math
from pathlib import Path

import numpy as np
import pytest

import fftocean as fo
from fftocean.export import exr

DATA = Path(__file__).parent / "data" / "44004w2000.txt"
EXAMPLE = Path(__file__).parent.parent / "examples" / "buoy_44004.toml"


@pytest.fixture(scope="module")
def record():
    """Frequencies [Hz] and the last record's densities [m^2/Hz]."""
    lines = DATA.read_text().splitlines()
    return np.array(lines[0].split()[4:], dtype=float), np.array(lines[-1].split()[4:], dtype=float)


def test_the_example_is_the_buoy_s_record(record):
    spectrum = fo.Job.read(EXAMPLE).sea().systems[0].spectrum
    assert np.array_equal(spectrum.frequency, record[0])
    assert np.array_equal(spectrum.density, record[1])


def test_specified_height_is_the_buoy_s_own(record):
    """
    The buoy's 4 sqrt(m0) sums bands of 0.01 Hz; straight lines between the points differ by half a
    band at either end: 0.2 %.
    """
    buoy = 4.0 * math.sqrt(np.sum(record[1]) * 0.01)
    assert fo.Job.read(EXAMPLE).sea().hs == pytest.approx(buoy, rel=2e-3)


def test_baked_height_is_the_buoy_s_own(record, tmp_path):
    """
    Fixed amplitudes give the tile's m0 for every seed, and the mean over the frames of a loop
    averages beats. Left are the band edges (0.2 %), the unresolved energy, and the beats of waves
    with equal loop frequencies (1 % here).
    """
    job = fo.Job.read(EXAMPLE).replaced(
        {"ocean.n": 128, "ocean.amplitudes": "fixed", "bake.frames": 40, "bake.maps": ["height"]}
    )
    manifest = fo.bake(job, tmp_path / "sea")
    frames = [
        exr.decode((tmp_path / "sea" / row["files"]["height"]["path"]).read_bytes())[0].astype(
            float
        )
        for row in manifest["frames"]
    ]
    buoy = 4.0 * math.sqrt(np.sum(record[1]) * 0.01)
    assert 4.0 * math.sqrt(np.mean(np.square(frames))) == pytest.approx(buoy, rel=0.02)
