"""Folds and water properties in the manifest and on the command line."""

import math
from pathlib import Path

import builders
import numpy as np
import pytest

import fftocean as fo
from fftocean.cli import main


def job(**changes):
    """A small job of the default sea on short waves."""
    small = {"ocean.n": 16, "ocean.size": 25.0, "bake.frames": 3, "bake.maps": ["height", "normal"]}
    return builders.job({**small, "bake.pictures": [], **changes})


@pytest.mark.parametrize("lookup", ["lagrangian", "eulerian"])
def test_folds_are_in_the_manifest_and_in_what_the_command_line_says(lookup, tmp_path, capsys):
    """
    Over all frames, by the eigenvalues of the ocean's own stretches; the check notes them and finds
    nothing wrong.
    """
    sea_job = job(**{"ocean.choppiness": 6.0, "bake.lookup": lookup})
    extremes = fo.bake(sea_job, tmp_path / "out")["extremes"]
    ocean = sea_job.ocean()
    frames = [ocean.loop_frame(j, 3) for j in range(3)]
    gradients = np.stack(
        [[f.stretch_xx, f.stretch_xy, f.stretch_xy, f.stretch_yy] for f in frames], axis=-1
    ).astype(float)
    lowest = np.linalg.eigvalsh(np.moveaxis(gradients.reshape(2, 2, -1), -1, 0))[:, 0]
    assert extremes["folded"] == pytest.approx(np.mean(1.0 + 6.0 * lowest < 0.0))
    assert extremes["folded"] > 0.0
    assert extremes["largest_choppiness"] == pytest.approx(-1.0 / lowest.min(), rel=1e-6)
    assert extremes["min_jacobian"] < 0.0
    capsys.readouterr()
    assert main(["check", str(tmp_path / "out")]) == 0
    _, err = capsys.readouterr()
    share, limit = 100.0 * extremes["folded"], extremes["largest_choppiness"]
    assert (
        f"note: {share:.2g} % of the water is folded, smallest Jacobian "
        f"{extremes['min_jacobian']:.3g}" in err
    )
    assert f"choppiness up to {math.floor(limit * 100) / 100:g} does not fold it" in err
    flat = fo.bake(job(**{"ocean.choppiness": 0.0, "bake.lookup": lookup}), tmp_path / "flat")[
        "extremes"
    ]
    assert flat["folded"] == 0.0
    capsys.readouterr()
    assert main(["check", str(tmp_path / "flat")]) == 0
    assert "fold" not in capsys.readouterr().err


def test_a_bake_says_at_once_that_water_is_folded(tmp_path, capsys):
    flags = ["--n", "16", "--size", "25", "--frames", "2", "--executor", "serial", "--choppiness"]
    assert main(["bake", "-o", str(tmp_path / "out"), *flags, "8"]) == 0
    assert "% of the water is folded" in capsys.readouterr().err
    assert main(["info", *flags[:6], "--choppiness", "8"]) == 0
    assert "% of the water is folded" in capsys.readouterr().out
    assert main(["info", *flags[:6], "--choppiness", "0.5"]) == 0
    assert "none of the water is folded" in capsys.readouterr().out


def test_the_manifest_names_the_part_that_states_the_water(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("job.toml").write_text(
        "[sea]\ndepth = 12.0\nsurface_tension = 0.074\n[[sea.systems]]\nspectrum = { kind "
        "= 'elfouhaily', speed = 6.0 }\n"
    )
    shallow = fo.Job.read("job.toml").replaced(
        {"ocean.n": 8, "ocean.loop": 60.0, "bake.frames": 1, "bake.pictures": []}
    )
    tile = fo.bake(shallow, "out")["ocean"]
    assert (tile["depth"], tile["surface_tension"]) == (12.0, 0.074)
    part = "systems[0].spectrum (Elfouhaily)"
    assert tile["stated_by"] == {"depth": part, "surface_tension": part}
