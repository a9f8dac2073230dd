"""Bakes of seas with crests: maps, manifest, list of a cascade, check, resume and repair."""

import json

import numpy as np
import pytest
from builders import job_text

import fftocean as fo
from fftocean.baking.cascade import bake_tiles
from fftocean.baking.folder.sealed import CHECK, sealed
from fftocean.files import as_json
from fftocean.fixed_values import duration, one_in

CREST = "[[ocean.crest]]\nheight = 1.5\nx = 50.0\ny = 25.0\nt = 10.0\n"
TILES = [(32, 100.0), (32, 17.3)]


def read(**keys):
    settings = {
        "ocean__n": 32,
        "ocean__size": 100.0,
        "ocean__loop": 40.0,
        "ocean__choppiness": 0.8,
        "sea__wind__speed": 8.0,
        "bake__frames": 4,
        "bake__maps": ["displacement"],
        "bake__format": "npz",
        "bake__pictures": [],
    }
    return fo.Job.from_toml(job_text(**{**settings, **keys}) + CREST)


def test_a_bake_has_the_crest_and_says_so(tmp_path):
    """1.5 m at that sample of that frame, in single precision; not moved sideways."""
    manifest = fo.bake(read(), tmp_path)
    x, y, height = fo.load(tmp_path)["displacement"][1, 8, 16]
    assert height == pytest.approx(1.5, abs=1e-5)
    assert abs(x) + abs(y) < 1e-5
    assert manifest["job"]["ocean.crest"] == [{"height": 1.5, "x": 50.0, "y": 25.0, "t": 10.0}]
    said = manifest["constrained"]
    assert said["in_words"].startswith("crest of 1.5 m at (50, 25) m, 10 s:")
    assert said["exceedance"] == pytest.approx(
        np.exp(-0.5 * 1.5**2 / read().ocean().amplitudes.variance)
    )
    assert fo.check(tmp_path) == ()
    assert fo.bake(read(), tmp_path) == manifest  # the same header: nothing to do


def test_workers_write_the_same_bytes(tmp_path):
    one, two = (
        fo.bake(read(), tmp_path / executor, executor=executor, workers=2)
        for executor in ("serial", "processes")
    )
    assert one["frames"] == two["frames"]


def test_the_tiles_of_a_cascade_have_it_together(tmp_path):
    """
    The sum of the baked displacements at the place is the crest; the list says how rare it is, is
    checked against the tiles' shares, and is the same after a repair.
    """
    listed = bake_tiles(read(), TILES, tmp_path)
    baked = fo.load(tmp_path)
    large = baked.tiles[0]["displacement"][1, 8, 16]
    cascade = fo.constrained(
        fo.Cascade(read().sea(), TILES, seed=1, loop=40.0, choppiness=0.8),
        fo.Crest(height=1.5, x=50.0, y=25.0, t=10.0),
    )
    small = fo.gerstner.surface(cascade.oceans[1], 50.0, 25.0, 10.0)
    assert large[2] + float(small.height) == pytest.approx(1.5, abs=1e-5)
    frame = cascade.oceans[1].frame(10.0, ("height",)).height
    assert np.allclose(baked.tiles[1]["displacement"][1, ..., 2], frame, atol=1e-6)
    assert listed["constrained"]["in_words"] == str(cascade.rarity)
    assert fo.check(tmp_path) == ()
    for path in (tmp_path / "tile1").rglob("*.npz"):
        path.unlink()
    assert fo.check(tmp_path) != ()
    assert fo.repair(tmp_path) == listed
    assert fo.check(tmp_path) == ()


def test_shares_that_do_not_add_up_are_found(tmp_path):
    """A list whose values are not those of its tiles, with a checksum that is its own."""
    bake_tiles(read(), TILES, tmp_path)
    path = tmp_path / "cascade.json"
    listed = json.loads(path.read_text("utf-8"))
    listed["constrained"]["values"][0]["value"] = 1.6
    del listed[CHECK]
    path.write_bytes(as_json(sealed(listed)))
    assert "add up to 1.5" in " ".join(str(found) for found in fo.check(tmp_path))


@pytest.mark.parametrize(
    ("share", "words"),
    [
        (0.5, "1 in 2"),
        (1.0 / 1234.4, "1 in 1,234"),
        (1.0 / 9_999_000.0, "1 in 9,999,000"),
        (1e-12, "1 in 1.0e+12"),
        (0.0, "less than 1 in 1e300"),
    ],
)
def test_a_probability_is_said_as_one_in_a_number(share, words):
    assert one_in(share) == words


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (59.6, "59.6 s"),
        (119.0, "119 s"),
        (120.0, "2 minutes"),
        (7200.0, "2 hours"),
        (47.0 * 3600.0, "47 hours"),
        (48.0 * 3600.0, "2 days"),
        (2.0 * 365.25 * 86400.0, "2 years"),
        (1234.0 * 365.25 * 86400.0, "1,234 years"),
        (1e8 * 365.25 * 86400.0, "1.0e+08 years"),
    ],
)
def test_a_length_of_time_is_said_in_the_unit_that_suits_it(seconds, words):
    assert duration(seconds) == words
