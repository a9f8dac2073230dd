"""`fftocean info`: its tables and its notes."""

from pathlib import Path

import pytest
from command_line import SWELL

import fftocean as fo


def test_notes_name_the_unresolved_energy(run):
    """
    A short loop, a small tile and large samples each have one line on stderr.
    """
    code, _, err = run(
        "info", "--n", "8", "--size", "40", "--loop", "2", "--set", "sea.wind.speed=20"
    )
    assert code == 0
    notes = err.splitlines()
    assert all(note.startswith("note: ") for note in notes)
    assert "a loop of 2 s is less than four peak periods" in err
    assert "waves longer than the tile; a larger --size holds them" in err
    assert "waves shorter than two samples" in run("info", "--n", "4", "--size", "100")[2]


@pytest.mark.parametrize("n", ["1", "2", "31,12"])
def test_info_describes_any_tile(run, n):
    code, out, _ = run("info", "--n", n)
    assert code == 0
    for part in (
        "sea.wind.speed",
        "7 m/s",
        "significant wave height Hs",
        "loop frequency error",
        "724 files of 3 maps",
        "MB",
        "time to bake",
    ):
        assert part in out
    assert "nan" not in out
    assert "inf m" in out
    assert "inf rad/m" in out
    assert out.count("inf") == 2  # the depth and the band, and nothing else


def test_info_describes_a_job_with_systems_and_without_waves(run):
    Path("job.toml").write_text("sea.depth = 8.0\n" + SWELL + "direction = 45\n")
    code, out, _ = run("info", "job.toml", "--n", "16")
    assert code == 0
    assert "Job: job.toml" in out
    assert "sea.systems[0]" in out
    assert "'hs': 1.5" in out
    assert "sea.wind" not in out
    code, out, err = run("info", "--n", "8", "--set", "sea.wind.speed=0")
    assert code == 0
    assert "the sea is exactly flat" in err
    assert "nan" not in out


STEEP = "spectrum = { kind = 'jonswap', hs = 3.0, tp = 5.0 }\n"


@pytest.mark.parametrize("command", [("info",), ("verify",), ("info", "--tiles", "16:60,16:9")])
def test_impossible_seas_are_named(run, command):
    """Each limit in one note, whatever the number of tiles; troughs that bare the bed refuse it."""
    Path("steep.toml").write_text("sea.depth = 4.0\n[[sea.systems]]\n" + STEEP)
    few = () if "--tiles" in command else ("--n", "16")
    code, out, err = run(command[0], "steep.toml", *few, *command[1:])
    assert code == 0
    assert err.count("steeper than those of real seas") == 1
    assert err.count("0.75 of the depth of 4 m") == 1
    if command[0] == "info":
        assert "wave height and steepness" in out
    Path("bare.toml").write_text("sea.depth = 2.0\n[[sea.systems]]\n" + STEEP)
    code, _, err = run(command[0], "bare.toml", *few, *command[1:])
    assert code == 2
    assert "troughs bare the bed, got 2 m for waves of 3 m" in err


def test_foam_is_described_where_it_is_baked(run):
    out = run("info", "--n", "16", "--maps", "foam")[1]
    # 3.84e-6 x 7^3.41 is 0.29 %
    assert "covers 0.29 % of the water on average; threshold 0." in " ".join(out.split())
    assert "whitecaps of 7 m/s" in " ".join(out.split())
    assert "whitecaps" not in run("info", "--n", "16")[1]


def row(out, name):
    """Return the rest of the line of a table that begins with a name."""
    (line,) = (line for line in out.splitlines() if line.startswith(name))
    return line.removeprefix(name).split()


@pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
def test_figures_of_the_tile_and_of_the_sea_are_in_their_columns(run):
    """As `measure` has them: specified before realised, percent, and the narrow side."""
    flags = ("--n", "32,16", "--size", "24,16", "--set", "sea.wind.speed=12")
    _, out, _ = run("info", *flags, "--frames", "2")
    settings = {"ocean.n": (32, 16), "ocean.size": (24.0, 16.0), "sea.wind.speed": 12.0}
    ocean = fo.Job.default().replaced({**settings, "bake.frames": 2}).ocean()
    found = fo.measure(ocean, frames=2)
    assert found.specified.tp != pytest.approx(found.tp, abs=0.02)
    assert row(out, "peak period Tp")[::2] == [f"{found.specified.tp:.2f}", f"{found.tp:.2f}"]
    assert row(out, "significant wave height Hs")[:3:2] == [
        f"{found.specified.hs:.3f}",
        f"{found.hs:.3f}",
    ]
    shares = row(out, "unresolved energy")
    assert [float(shares[0]), float(shares[5])] == [
        pytest.approx(100.0 * share, abs=0.006) for share in (found.share_below, found.share_above)
    ]
    assert found.share_below > 0.01
    length, _, across, *_ = row(out, "peak wavelength")
    assert float(across) == pytest.approx(16.0 / float(length), abs=0.06)
