"""Entries of a manifest about the sea beside its statistics: limits of real seas, and foam."""

import numpy as np
import pytest
from builders import job

import fftocean as fo
from fftocean.foam_coverage import mean_coverage

SMALL = {"ocean__n": 16, "bake__frames": 4, "bake__pictures": []}


def baked(folder, **more):
    made = job(**{**SMALL, **more})
    return made, fo.bake(made, folder / "out", executor="serial")


@pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
def test_the_limits_of_real_seas(tmp_path):
    made, manifest = baked(tmp_path, sea__depth=1.2, sea__wind__speed=20.0)
    found = manifest["plausibility"]
    assert found["hs_over_depth"] == pytest.approx(made.sea().hs / 1.2, rel=1e-3)
    assert found["steepness_limit"] == [pytest.approx(1.0 / 15.0)]
    assert found["notes"] == []
    steep = "[[sea.systems]]\nspectrum = { kind = 'jonswap', hs = 2.0, tp = 4.0 }\n"
    steep += "[ocean]\nn = 16\nloop = 16.0\n[bake]\nframes = 2\npictures = []\n"
    manifest = fo.bake(fo.Job.from_toml(steep), tmp_path / "steep", executor="serial")
    assert "steeper than those of real seas" in manifest["plausibility"]["notes"][0]


@pytest.mark.filterwarnings("ignore:a loop of:fftocean.errors.SeaWarning")
def test_foam_that_follows_the_wind(tmp_path):
    """The threshold is that of the tile's own waves, and the map is the foam of that threshold."""
    changes = {"ocean__n": 32, "ocean__size": 60.0, "sea__wind__speed": 15.0}
    changes |= {"bake__maps": ["foam"], "bake__format": "npz"}
    made, manifest = baked(tmp_path, **changes)
    told, ocean = manifest["foam"], made.ocean()
    assert told["wind"] == 15.0
    assert told["coverage"] == pytest.approx(3.84e-6 * 15.0**3.41, rel=0.01)
    assert told["coverage"] == pytest.approx(mean_coverage(ocean, told["threshold"]), rel=1e-9)
    foam = fo.Foam(tau=3.5, threshold=told["threshold"], strength=60.0)
    maps = fo.load(tmp_path / "out").maps["foam"]
    for j, expected in enumerate(foam.loop(ocean, 4)):
        assert np.max(np.abs(maps[j][:, :, 0] - expected)) < 1e-3
    assert manifest["job"]["bake.foam.threshold"] == "wind"
    again = fo.Job.from_description(manifest["job"])
    assert again.foam_on(ocean) == foam


def test_a_bake_without_foam_says_nothing_of_it(tmp_path):
    assert "foam" not in baked(tmp_path)[1]
