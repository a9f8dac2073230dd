"""A cascade as bakes: each tile is the cascade's own, the sum of the maps is the sea, and the list says how to add them."""

import json

import numpy as np
import pytest

import fftocean as fo
from fftocean.bake.tiles import bake_tiles
from fftocean.cli import main

TILES = [(32, 200.0), (32, 29.0), (16, 4.1)]
JOB = fo.Job.default().replaced({"bake.frames": 2, "bake.maps": ["height", "displacement"], "bake.format": "exr-float"})


def test_each_tile_is_the_cascade_s_own(tmp_path):
    """What is on the disk is what `Cascade` shows, to the bit: the same seeds, the same bands."""
    listed = bake_tiles(JOB, TILES, tmp_path / "sea", executor="serial")
    cascade = fo.Cascade(JOB.sea(), TILES, seed=JOB.settings["ocean.seed"], loop=JOB.settings["ocean.loop"])
    assert [tuple(map(float, tile["band"])) for tile in listed["tiles"]] == list(cascade.bands)
    for tile, ocean in zip(listed["tiles"], cascade.oceans, strict=True):
        folder = tmp_path / "sea" / tile["path"]
        assert fo.check(folder) == ()
        baked = fo.load(folder)
        for j in range(2):
            assert np.array_equal(baked.maps["height"][j][..., 0], ocean.loop_frame(j, 2).height)
    assert json.loads((tmp_path / "sea" / "cascade.json").read_text()) == listed
    energy = sum(tile["m0"] for tile in listed["tiles"])
    assert energy == pytest.approx(sum(ocean.amplitudes.variance for ocean in cascade.oceans), rel=1e-12)


def test_from_the_command_line(tmp_path, capsys):
    folder = str(tmp_path / "sea")
    flags = ["bake", "-o", folder, "--frames", "1", "--maps", "height", "--executor", "serial"]
    assert main([*flags, "--tiles", "16:100,16:15"]) == 0
    assert "tile1: 16 x 16 over 15 x 15 m" in capsys.readouterr().out
    assert main([*flags, "--tiles", "16:100,16:15"]) == 0  # goes on, or finds all done
    assert main([*flags, "--tiles", "16:100,16:1"]) == 2
    assert "tiles must overlap in wavenumbers" in capsys.readouterr().err
    assert main([*flags, "--tiles", "16:100", "--dry-run"]) == 2
    with pytest.raises(SystemExit, match="2"):
        main([*flags, "--tiles", "16x100"])


def test_a_band_of_one_tile_keeps_its_waves():
    sea = JOB.sea()
    whole = fo.Ocean(sea, n=32, size=200.0, seed=3).amplitudes
    part = fo.Ocean(sea, n=32, size=200.0, seed=3, band=(0.2, 0.4)).amplitudes
    k = part.grid.k
    inside, outside = (k > 0.25) & (k < 0.35), (k < 0.15) | (k > 0.45)
    assert np.array_equal(part.forward[inside], whole.forward[inside])
    assert not np.any(part.forward[outside])
    for bad in ((0.4, 0.2), (1.0,), 3.0, (-1.0, 2.0), (0.2, np.nan)):
        with pytest.raises(fo.ParameterError, match="band"):
            fo.Ocean(sea, n=8, size=10.0, band=bad)
