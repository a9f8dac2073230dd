"""
Time series at probes, against a sum over the waves at each time that is written here, and against
`kinematics`, which sums points in compiled loops.
"""

import itertools
import math

import numpy as np
import pytest
from builders import lazy

import fftocean as fo
from fftocean import probe_series
from fftocean.errors import OutputError, ParameterError

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")  # of short loops
xr = lazy("xarray")

DEPTH = 12.0
SEA = fo.Sea.from_wind(speed=10.0, fetch=100e3, depth=DEPTH, direction=40.0)
X, Y = np.array([0.0, 37.5, -4000.25]), np.array([0.0, -11.0, 1234.5])
BELOW = [name for name in probe_series.UNITS if name not in probe_series.SURFACE]


def ocean(loop, **more):
    return fo.Ocean(SEA, n=(24, 18), size=(90.0, 70.0), seed=3, loop=loop, **more)


def summed(source, x, y, t):
    """Return the height at one probe and some times, and the slopes there, wave by wave."""
    waves = source.modes()
    phase = waves.kx * x + waves.ky * y - np.outer(t, waves.omega) - waves.phase
    slope = -waves.amplitude * np.sin(phase)
    return {
        "height": np.sum(waves.amplitude * np.cos(phase), axis=1),
        "slope_x": np.sum(waves.kx * slope, axis=1),
        "slope_y": np.sum(waves.ky * slope, axis=1),
    }


STEPS = {
    "loop": (40.0, 0.25 * np.arange(160)),
    "part of a loop, from elsewhere": (40.0, 1003.7 + 0.25 * np.arange(33)),
    "more than a loop": (40.0, -7.0 + 0.25 * np.arange(500)),
    "three loops in whole steps": (40.0, 0.3 * np.arange(410)),
    "steps that do not divide it": (40.0, 0.1 * math.pi * np.arange(300)),
    "no loop": (None, 0.2 * np.arange(1000)),
    "no loop, from elsewhere": (None, 86400.0 + 0.2 * np.arange(70)),
    "any times": (None, np.array([5.0, 0.0, -3.3, 100.25, 100.26])),
    "any times on a loop": (40.0, np.array([5.0, 0.0, -3.3, 100.25, 100.26])),
    "one time": (40.0, np.array([3.7])),
}


@pytest.mark.parametrize("steps", STEPS)
def test_series_are_the_sum_of_the_waves(steps):
    """To 1e-9 of the height: the sum here rounds omega t, 1e-11 rad after a day."""
    loop, t = STEPS[steps]
    water = ocean(loop)
    found = fo.series(water, X, Y, t, ("height", "slope_x", "slope_y"))
    for probe, (x, y) in enumerate(zip(X, Y, strict=True)):
        for name, values in summed(water, x, y, t).items():
            assert np.max(np.abs(found[name][:, probe] - values)) < 1e-9, name


def test_each_way_is_taken(monkeypatch):
    """The transforms and the sum at any time give the same, and each is used above."""
    taken = []
    for name in ("_by_transform", "_between_frequencies"):
        real = getattr(probe_series, name)
        monkeypatch.setattr(
            probe_series, name, lambda *a, _n=name, _r=real: (taken.append(_n), _r(*a))[1]
        )
    expected = {
        "loop": "_by_transform",
        "three loops in whole steps": "_by_transform",
        "steps that do not divide it": "_between_frequencies",
        "no loop": "_between_frequencies",
        "any times": None,
    }
    for steps, way in expected.items():
        taken.clear()
        loop, t = STEPS[steps]
        fo.series(ocean(loop), 0.0, 0.0, t)
        assert set(taken) == ({way} if way else set()), steps


@pytest.mark.parametrize(("depth", "loop"), [(DEPTH, 40.0), (math.inf, None)])
def test_fields_below_the_surface_are_those_of_kinematics(depth, loop):
    sea = fo.Sea.from_wind(speed=10.0, fetch=100e3, depth=depth)
    water = fo.Ocean(sea, n=24, size=90.0, seed=3, loop=loop)
    t, z = 0.5 * np.arange(80), np.array([0.0, -1.5, -11.0])
    found = fo.series(water, X, Y, t, BELOW, z=z)
    assert found["pressure"].shape == (80, 3, 3)
    some = [0, 7, 79]
    for probe, level in itertools.product(range(3), range(3)):
        here = fo.kinematics.at(water, X[probe], Y[probe], z[level], t[some])
        for i, axis in enumerate("xyz"):
            for name, values in (
                ("velocity", here.velocities),
                ("acceleration", here.accelerations),
            ):
                got = found[f"{name}_{axis}"][some, probe, level]
                # a point at z = 0 in a trough is in the air for `kinematics`
                assert got[here.wet] == pytest.approx(values[here.wet, i], rel=1e-9, abs=1e-9)
        got = found["pressure"][some, probe, level]
        assert got[here.wet] == pytest.approx(here.pressures[here.wet], rel=1e-9, abs=1e-6)


def test_velocity_and_pressure_obey_euler():
    """rho d(velocity)/dt = -grad p, by central differences over 1e-3 s and 1e-3 m: 1e-7 of it."""
    water = ocean(None)
    d = 1e-3
    t = 30.0 + np.array([-d, 0.0, d])
    moved = fo.series(water, [5.0], [9.0], t, ("velocity_x", "velocity_z"), z=-3.0)
    rate = {k: (v[2] - v[0]) / (2.0 * d) for k, v in moved.values.items()}
    beside = fo.series(water, [5.0 - d, 5.0 + d], [9.0, 9.0], 30.0, ("pressure",), z=-3.0)[
        "pressure"
    ]
    levels = fo.series(water, [5.0], [9.0], 30.0, ("pressure",), z=[-3.0 - d, -3.0 + d])["pressure"]
    gradient = (beside[0, 1, 0] - beside[0, 0, 0]) / (2 * d), np.diff(levels[0, 0])[0] / (2 * d)
    assert 1025.0 * rate["velocity_x"][0, 0] == pytest.approx(-gradient[0], rel=1e-5)
    assert 1025.0 * rate["velocity_z"][0, 0] == pytest.approx(-gradient[1], rel=1e-5)


def test_the_pressure_at_the_surface_is_the_weight_of_the_water():
    """rho g height at z = 0 for waves that obey the dispersion relation."""
    found = fo.series(ocean(None), X, Y, 0.7 * np.arange(20), ("height", "pressure"))
    weight = 1025.0 * 9.80665 * found["height"]
    assert found["pressure"][:, :, 0] == pytest.approx(weight, rel=1e-9, abs=1e-6)


def test_tiles_of_a_cascade_add_up_each_on_its_own_loop():
    cascade = fo.Cascade(SEA, [(16, 90.0), (16, 20.0)], seed=4, loop=[40.0, 15.0])
    t = 0.25 * np.arange(200)
    found = fo.series(cascade, X, Y, t)
    parts = sum(fo.series(tile, X, Y, t)["height"] for tile in cascade.oceans)
    assert np.max(np.abs(found["height"] - parts)) < 1e-12
    expected = sum(summed(tile, X[2], Y[2], t)["height"] for tile in cascade.oceans)
    assert np.max(np.abs(found["height"][:, 2] - expected)) < 1e-9


@pytest.mark.parametrize("depth", [DEPTH, math.inf])
def test_second_order_is_that_of_kinematics(depth):
    """
    `kinematics` adds the bound waves cell by cell at each time; here the pairs of equal cycles are
    one number, in whatever order: 1e-9 m are roundings. Slopes by central differences, 1e-6.
    """
    sea = fo.Sea.from_wind(speed=10.0, fetch=100e3, depth=depth)
    tile = {"n": 24, "size": (90.0, 110.0), "seed": 3, "loop": 40.0, "dtype": "float64"}
    water = fo.Ocean(sea, order=2, bound=60, **tile)
    linear = fo.series(water.linear(), X, Y, [0.0])["height"]
    for t in (0.25 * np.arange(160), 3.0 + 0.1 * math.pi * np.arange(50), np.array([2.0, -7.7])):
        found = fo.series(water, X, Y, t, ("height", "slope_x", "slope_y"))
        some = np.arange(t.size)[:: max(1, t.size // 4)]
        for probe in range(3):
            expected = fo.kinematics.at(water, X[probe], Y[probe], 0.0, t[some]).heights
            assert found["height"][some, probe] == pytest.approx(expected, abs=1e-9)
        d = 1e-3
        for name, (dx, dy) in {"slope_x": (d, 0.0), "slope_y": (0.0, d)}.items():
            rise = [fo.series(water, X + s * dx, Y + s * dy, t)["height"] for s in (1.0, -1.0)]
            assert found[name] == pytest.approx((rise[0] - rise[1]) / (2.0 * d), abs=1e-6)
    second = fo.series(water, X, Y, [0.0])["height"] - linear
    assert np.max(np.abs(second)) > 1e-3


def test_many_probes_are_taken_in_turn(monkeypatch):
    monkeypatch.setattr(probe_series, "_PHASORS", 1)
    t = 0.25 * np.arange(160)
    one = fo.series(ocean(40.0), X, Y, t)["height"]
    monkeypatch.undo()
    assert np.max(np.abs(one - fo.series(ocean(40.0), X, Y, t)["height"])) < 1e-12


def test_waves_of_a_list_and_of_a_few_wave_model():
    waves = ocean(None).modes()
    t = 0.5 * np.arange(30)
    found = fo.series(waves, X, Y, t, depth=DEPTH)["height"]
    assert np.max(np.abs(found - fo.series(ocean(None), X, Y, t)["height"])) < 1e-9


@pytest.mark.parametrize(
    ("change", "rule"),
    [
        ({"source": 3}, "waves must come from"),
        ({"x": [0.0, 1.0], "y": [0.0, 1.0, 2.0]}, "x and y must be of one length, got 2 and 3"),
        ({"x": [[0.0]]}, "x must be a number or a list"),
        ({"times": [0.0, math.nan]}, r"times\[1\] must be"),
        ({"fields": "height"}, "fields must be a list of names"),
        ({"fields": ("depth",)}, "fields must be of height, slope_x"),
        ({"z": 0.1}, "z must be from the bed at -12 m to 0, got 0.1 to 0.1 m"),
        ({"z": -12.5}, "z must be from the bed"),
        ({"source": fo.Ocean(SEA, n=8, size=90.0, order=2)}, "needs an ocean that loops"),
        (
            {"source": fo.Ocean(SEA, n=8, size=90.0, order=2, loop=40.0), "fields": ("pressure",)},
            "must be of height, slope_x, slope_y, got 'pressure'",
        ),
    ],
)
def test_bad_arguments_are_refused(change, rule):
    given = {"source": ocean(40.0), "x": 0.0, "y": 0.0, "times": [0.0, 1.0], **change}
    with pytest.raises(ParameterError, match=rule):
        fo.series(**given)


# Files


def few(fields=("height", "pressure")):
    t = 0.25 * np.arange(12)
    return fo.series(ocean(40.0), X[:2], Y[:2], t, fields, z=[0.0, -2.0])


def test_a_table_holds_every_digit(tmp_path):
    made = few()
    made.write(tmp_path / "a.csv")
    lines = (tmp_path / "a.csv").read_text().splitlines()
    comments = [line for line in lines if line.startswith("#")]
    assert comments[1] == "# probe 2: x = 37.5 m, y = -11.0 m"
    assert comments[-1] == "# units: time s, height m, pressure Pa"
    names = lines[len(comments)].split(",")
    assert names[:4] == ["time", "height_1", "height_2", "pressure_1_z1"]
    table = np.genfromtxt(lines[len(comments) + 1 :], delimiter=",")
    assert np.array_equal(table[:, 0], made.times)
    assert np.array_equal(table[:, names.index("height_2")], made["height"][:, 1])
    assert np.array_equal(table[:, names.index("pressure_2_z2")], made["pressure"][:, 1, 1])


@pytest.mark.parametrize("ending", ["nc", "zarr"])
def test_data_sets_come_back(tmp_path, ending):
    pytest.importorskip("xarray")
    made, file = few(), tmp_path / f"a.{ending}"
    made.write(file)
    opened = xr.open_dataset(file) if ending == "nc" else xr.open_zarr(file, consolidated=False)
    with opened:
        assert np.array_equal(opened.height.values, made["height"])
        assert opened.pressure.dims == ("time", "probe", "z")
        assert np.array_equal(opened.pressure.values, made["pressure"])
        assert opened.pressure.units == "Pa"
        assert np.array_equal(opened.x.values, X[:2])
    if ending == "zarr":
        with pytest.raises(OutputError, match="exists"):
            made.write(file)


def test_another_ending_is_refused(tmp_path):
    with pytest.raises(ParameterError, match=r"ends in \.csv, \.nc, \.zarr, got 'a\.mat'"):
        few().write(tmp_path / "a.mat")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("loop", [None, 40.0], ids=["free", "loop"])
@pytest.mark.parametrize("step", [0.2, 7.7])
def test_blocks_of_time_join(monkeypatch, loop, step):
    """
    Steps in several blocks, the last of another length, also steps in which waves turn more than
    once: as the sum of the waves at each time.
    """
    monkeypatch.setattr(probe_series, "_BLOCK", 64)
    monkeypatch.setattr(probe_series, "_TOGETHER", 400)
    water, t = ocean(loop), 0.1 * math.pi + step * np.arange(64 + 64 + 9)
    found = fo.series(water, X, Y, t, probe_series.SURFACE)
    for probe in range(X.size):
        for name, values in summed(water, X[probe], Y[probe], t).items():
            assert np.max(np.abs(found[name][:, probe] - values)) < 1e-9


def test_a_point_of_a_circle_is_spread_and_found_again():
    """One frequency anywhere on the circle, also next to its seam, to 1e-12 of its amplitude."""
    turn = np.array([0.0, 0.49999, -0.5, 1e-9, -0.3])
    n = np.arange(-40, 40)
    fine = 180
    response = probe_series._response_of_kernel(n * (np.pi * probe_series._WIDTH / fine))
    spread = probe_series._spreading(turn, fine)
    for i in range(turn.size):
        one = np.zeros(turn.size, dtype=complex)
        one[i] = 0.6 + 0.8j
        found = np.fft.fft(spread @ one)[n % fine] / response
        expected = one[i] * np.exp(-2j * np.pi * n * turn[i])
        assert np.max(np.abs(found - expected)) < 1e-12
