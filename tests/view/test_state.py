"""Values of the page as a sea, a job and a command line, there and back."""

import json
import math
import shlex
import subprocess
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import fftocean as fo
from fftocean.cli import main
from fftocean.errors import JobError, ParameterError
from fftocean.job.job_text import toml_value
from fftocean.view.numbered_seas import preset_rows
from fftocean.view.state import State, peak_wavelength, power_of_two, tile_sizes
from fftocean.view.swell import Swell, storm_height, swell_of, table_of

LISTED = [(16, 400.0), (16, 57.0)]


def amplitudes_of(cascade):
    """Return the waves of every tile."""
    return [ocean.amplitudes.forward for ocean in cascade.oceans]


def tiles_of(command):
    """Return the tiles in a command line, as the flag has them."""
    words = shlex.split(command.splitlines()[-1])
    text = words[words.index("--tiles") + 1]
    return [(int(n), float(size)) for n, size in (tile.split(":") for tile in text.split(","))]


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"wind_speed": 7.3, "wind_direction": 123.4, "fetch": 33333.3},
        {"swell_speed": 17.7, "swell_share": 0.1234, "swell_direction": 301.0},
        {"swell_speed": 0.0},
        {"wind_speed": 0.0},
        {"depth": 20.0, "seed": 999_999, "loop": 97.0, "choppiness": 0.35},
    ],
)
def test_a_copied_job_is_the_same_sea(changes):
    """State -> TOML -> Job -> Cascade: the same amplitudes to the bit, by the library's own way."""
    state = State.default(tiles=LISTED).changed(changes)
    job = fo.Job.from_toml(state.toml())
    v = state.values
    again = fo.Cascade(
        job.sea(),
        LISTED,
        seed=job.settings["ocean.seed"],
        loop=job.settings["ocean.loop"],
        choppiness=job.settings["ocean.choppiness"],
    )
    for ours, theirs in zip(amplitudes_of(state.cascade()), amplitudes_of(again), strict=True):
        np.testing.assert_array_equal(ours, theirs)
    assert (again.seed, again.loop, again.choppiness) == (v["seed"], v["loop"], v["choppiness"])
    assert tiles_of(state.command()) == LISTED


def test_the_sea_of_the_page_is_a_wind_sea_and_a_swell():
    """Built by hand from the public names."""
    state = State.default(tiles=LISTED).changed({"depth": 30.0})
    v = state.values
    wind = fo.Sea.from_wind(
        speed=v["wind_speed"], fetch=v["fetch"], depth=30.0, direction=v["wind_direction"]
    )
    wp = 0.877 / 1.026 * 9.80665 / v["swell_speed"]
    storm = 4.0 * math.sqrt(8.1e-3 * 9.80665**2 / (5.0 * wp**4))
    swell = fo.WaveSystem(
        spectrum=fo.TMA(
            fo.JONSWAP.from_sea_state(
                hs=v["swell_share"] * storm, tp=2.0 * math.pi / wp, gamma=7.0
            ),
            depth=30.0,
        ),
        spreading=fo.CosinePower(s=25.0),
        direction=v["swell_direction"],
    )
    sea = fo.Sea(*wind.systems, swell, depth=30.0)
    expected = fo.Cascade(sea, LISTED, seed=v["seed"], loop=v["loop"])
    for ours, theirs in zip(amplitudes_of(state.cascade()), amplitudes_of(expected), strict=True):
        # the swell's height and period are written with nine digits
        np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=1e-7 * np.abs(theirs).max())


def test_one_tile_is_that_of_a_bake():
    state = State.default(tiles=[(32, 300.0)])
    ocean = fo.Job.from_toml(state.toml()).ocean()
    np.testing.assert_array_equal(
        state.cascade().oceans[0].amplitudes.forward, ocean.amplitudes.forward
    )


@pytest.mark.parametrize("changes", [{"swell_speed": 0.0}, {}, {"swell_speed": 20.0}])
def test_a_copied_job_gives_its_values_back(changes):
    state = State.default(tiles=LISTED).changed(changes)
    again = State.of_job(fo.Job.from_toml(state.toml()), tiles=LISTED)
    assert {**again.values} == {
        **state.values,
        # a job without a swell does not say where one would go
        **({} if state.values["swell_speed"] else {"swell_direction": 30.0}),
    }
    assert again.job().describe() == state.job().describe()


@pytest.mark.parametrize("speed", [0.5, 3.25, 11.0, 12.345678, 39.5])
@pytest.mark.parametrize("share", [0.02, 0.3, 1.0])
def test_a_swell_is_known_by_its_table(speed, share):
    """Values with up to six digits come back to the bit, others within the digits written."""
    swell = Swell(speed, share, 12.5)
    found = swell_of(json.loads(json.dumps(table_of(swell))))
    if found is None:  # more digits than are kept
        assert speed == 12.345678
    else:
        assert found == pytest.approx(swell, rel=1e-6)


def test_another_system_is_no_swell_of_the_page():
    table = table_of(Swell(12.0, 0.3, 75.0))
    assert swell_of(table) is not None
    table["spreading"] = {"kind": "cosine-power", "s": 24.0}
    assert swell_of(table) is None
    assert swell_of({"spectrum": {"kind": "jonswap", "hs": 1.0, "tp": 9.0}}) is None
    assert swell_of({"measured": {"file": "buoy"}}) is None


def test_height_in_the_storm_is_that_of_the_fully_developed_sea():
    sea = fo.Sea(fo.WaveSystem(spectrum=fo.PiersonMoskowitz.from_wind(speed=13.0)))
    assert storm_height(13.0) == pytest.approx(sea.hs, rel=1e-9)


JOB = """
[sea]
depth = 25.0
[sea.wind]
speed = 9.0
direction = -40.0
gamma = 2.0
blend = 0.25
[ocean]
n = 32
size = 250.0
seed = 11
amplitudes = "fixed"
[bake]
frames = 60
maps = ["height"]
[[sea.systems]]
spectrum = { kind = "bretschneider", hs = 0.8, tp = 12.0 }
direction = 200.0
"""


def test_a_job_is_shown_on_its_own_tile():
    job = fo.Job.from_toml(JOB)
    state = State.of_job(job)
    assert state.tiles == ((32, 250.0),)
    assert state.values["wind_direction"] == 320.0
    assert state.values["swell_speed"] == 0.0
    np.testing.assert_allclose(
        state.cascade().oceans[0].amplitudes.forward,
        job.ocean().amplitudes.forward,
        rtol=1e-12,  # -40 degrees and 320
        atol=0.0,
    )


def test_keys_change_the_wind_of_a_job_and_leave_the_rest():
    state = State.of_job(fo.Job.from_toml(JOB)).changed({"wind_speed": 12.0, "swell_speed": 15.0})
    job = fo.Job.from_toml(state.toml())
    assert job.settings["sea.wind.speed"] == 12.0
    assert job.settings["sea.wind.gamma"] == 2.0
    assert job.settings["sea.wind.blend"] == 0.25
    assert job.settings["ocean.amplitudes"] == "fixed"
    assert (job.frames, job.maps) == (60, ("height",))
    assert [dict(s) for s in job.systems] == [
        fo.Job.from_toml(JOB).systems[0],
        table_of(Swell(15.0, state.values["swell_share"], state.values["swell_direction"])),
    ]


def test_a_job_of_systems_alone_has_no_wind_until_a_key_raises_it():
    text = '[[sea.systems]]\nspectrum = { kind = "bretschneider", hs = 0.8, tp = 12.0 }\n'
    state = State.of_job(fo.Job.from_toml(text), n=16)
    assert state.values["wind_speed"] == 0.0
    assert len(state.sea().systems) == 1
    assert len(state.changed({"wind_speed": 8.0}).sea().systems) == 2


def test_a_job_with_a_band_has_one_tile():
    state = State.of_job(fo.Job.from_toml("[ocean]\nn = 16\nband_high = 0.3\n"))
    assert state.cascade().bands == ((0.0, 0.3),)
    with pytest.raises(ParameterError, match=r"tiles must be 1 for a job with ocean\.band_low"):
        state.changed({"tiles": 2})


@pytest.mark.parametrize("n", [100, 384, 9])
def test_samples_that_are_no_power_of_two_are_refused_with_the_next(n):
    after = 2 ** math.ceil(math.log2(n))
    with pytest.raises(
        JobError, match=f"n must be a power of two on a page, got {n}; the next is {after}$"
    ):
        power_of_two("n", n)
    with pytest.raises(JobError, match=f"ocean.n must be a power of two.*the next is {after}"):
        State.of_job(fo.Job.default().replaced({"ocean.n": n}))


@pytest.mark.parametrize("n", [0, -8, 4, 2048, 16.0, True, "16", None])
def test_samples_out_of_range_are_refused(n):
    with pytest.raises(JobError, match="n must be a power of two from 8 to 1024 on a page"):
        power_of_two("n", n)


def test_a_rectangular_job_has_one_tile():
    state = State.of_job(fo.Job.from_toml("[ocean]\nn = [32, 16]\nsize = [200.0, 100.0]\n"))
    assert state.tiles == (((32, 16), (200.0, 100.0)),)
    with pytest.raises(ParameterError, match="tiles must be at most 1"):
        state.changed({"tiles": 2})


@pytest.mark.parametrize("speed", [0.0, 2.0, 6.0, 11.0, 20.0, 35.0])
def test_the_largest_tile_holds_twelve_waves_of_the_peak(speed):
    state = State.default(n=64).changed({"wind_speed": speed, "swell_speed": 0.0})
    assert state.tiles[0][1] >= 12.0 * peak_wavelength(state.sea())


def test_tiles_keep_their_sizes_while_the_sea_changes_little():
    state = State.default(n=64).changed({"swell_speed": 0.0})
    assert state.changed({"wind_speed": 11.5}).sizes == state.sizes
    assert state.changed({"wind_speed": 30.0}).sizes != state.sizes
    assert State.default(tiles=LISTED).changed({"wind_speed": 30.0}).tiles == tuple(LISTED)


@pytest.mark.parametrize("n", [16, 64, 128, 256, 1024])
def test_tiles_of_every_number_make_a_cascade_without_whole_ratios(n, recwarn):
    sizes = tile_sizes(n, 960.0, 4)
    state = State.default(tiles=sizes)  # refuses tiles that make no cascade
    assert all(a > b for (_, a), (_, b) in pairwise(sizes))
    if n <= 64:
        fo.Cascade(state.sea(), sizes)
    assert not [w for w in recwarn if "times as wide" in str(w.message)]


@pytest.mark.parametrize("row", preset_rows(), ids=lambda row: row["name"])
def test_a_preset_has_the_wave_height_of_its_number(row):
    """The scale's own height, by quadrature of the sea that the values make in deep water."""
    state = State.default(tiles=LISTED).changed({**row["values"], "depth": math.inf})
    scale = {"Beaufort": fo.presets.beaufort, "Sea state": fo.presets.sea_state}[row["scale"]]
    assert state.sea().hs == pytest.approx(scale(row["number"]).hs, rel=1e-8, abs=1e-12)


def test_a_command_of_flags_is_the_same_job(tmp_path, monkeypatch, capsys):
    state = State.default(tiles=[(16, 200.0)]).changed({"swell_speed": 0.0, "depth": 12.0})
    command = state.command()
    assert "\n" not in command
    monkeypatch.chdir(tmp_path)
    words = shlex.split(command)
    assert words[:4] == ["fftocean", "bake", "-o", "sea"]
    settings = dict(
        fo.job.job.parse_setting(words[i + 1]) for i, w in enumerate(words) if w == "--set"
    )
    job = fo.Job.default().replaced(settings)
    assert job.settings == state.job().settings
    assert main([*words[1:], "--dry-run"]) == 0
    capsys.readouterr()


def test_a_command_with_a_job_writes_the_job(tmp_path):
    """A shell reads the text between the marks, and nothing in it is run."""
    state = State.default(tiles=[(16, 200.0)])
    *writing, last = state.command().splitlines()
    subprocess.run(["sh", "-c", "\n".join(writing)], cwd=tmp_path, check=True)
    assert (tmp_path / "sea.toml").read_text() == state.toml()
    assert last == "fftocean bake sea.toml -o sea"


EVIL = "$(touch here)`touch here`\n'; touch here #\nEND_OF_JOB\ntouch here\n\x7f\u2028\"\\"


def test_names_in_a_job_cannot_leave_its_text(tmp_path):
    state = State.default(tiles=[(16, 200.0)])
    table = {"spectrum": {"kind": EVIL, EVIL: 1.0}}
    base = fo.Job(state.base.settings, False, (table,), "job")
    *writing, _ = replace(state, base=base).command().splitlines()
    subprocess.run(["sh", "-c", "\n".join(writing)], cwd=tmp_path, check=True)
    assert [path.name for path in tmp_path.iterdir()] == ["sea.toml"]
    import tomllib

    tree = tomllib.loads((tmp_path / "sea.toml").read_text())
    assert tree["sea"]["systems"][0] == table


@pytest.mark.parametrize(
    "value",
    [
        1.0,
        -0.0,
        math.inf,
        5e-324,
        7,
        2**63,
        True,
        "a",
        EVIL,
        "😀",
        [1.0] * 30,
        [[1.0, 2.0], [3.0, 4.0]],
        {"a": {"b": [1, 2]}, "c d": "e"},
        {},
        [],
        [{"a": [0.5] * 20}],
    ],
)
def test_toml_of_a_value_is_read_back(value):
    import tomllib

    text = f"v = {toml_value(value)}\n"
    assert tomllib.loads(text)["v"] == value
    assert max(len(line) for line in text.splitlines()) < 2048


def test_a_spectrum_keeps_the_tiles_and_the_seed(tmp_path):
    data = Path(__file__).parents[1] / "data"
    file = next(p for p in sorted(data.rglob("*")) if p.name.endswith(".data_spec"))
    before = State.default(n=16).changed({"seed": 5, "tiles": 2})
    state = State.of_spectrum(file, before, source=file.name, dropped=True)
    assert (state.values["seed"], state.values["tiles"]) == (5, 2)
    assert state.values["wind_speed"] == 0.0
    direct = fo.Sea.from_spectrum(fo.readers.open(file))
    assert state.sea().hs == pytest.approx(direct.hs, rel=1e-9)
    assert f'file = "{file.name}"' in state.toml()
    assert str(file.parent) not in state.toml()
    del tmp_path
