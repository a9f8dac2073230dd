"""OpenFAST's wave files against `fo.kinematics`, which sums wave by wave; what is refused."""

import math

import numpy as np
import pytest

import fftocean as fo

GRID = fo.export.SeaStateGrid(40.0, 20.0, 15.0, nx=3, ny=2, nz=4)
QUANTITIES = {
    ".Vxi": ("velocities", 0), ".Vyi": ("velocities", 1), ".Vzi": ("velocities", 2),
    ".Axi": ("accelerations", 0), ".Ayi": ("accelerations", 1), ".Azi": ("accelerations", 2),
    ".DynP": ("pressures", ...), ".Elev": ("heights", ...),
}  # fmt: skip


def ocean(**arguments):
    sea = fo.Sea.from_wind(
        speed=12.0, fetch=200e3, direction=35.0, depth=arguments.pop("depth", 20.0)
    )
    return fo.Ocean(sea, **{"n": 16, "size": (300.0, 240.0), "seed": 2, "loop": 60.0, **arguments})


def corner_first(levels):
    """Return x, y, z of the points in the order of the format: x fastest, then y, then z."""
    x, y = (-40.0, -20.0, 0.0, 20.0, 40.0), (-20.0, 0.0, 20.0)
    return np.array([(px, py, z) for z in levels for py in y for px in x]).T


@pytest.mark.parametrize("depth", [20.0, math.inf])
def test_every_file_is_the_sea(tmp_path, depth):
    """Eight digits are written; the sums are of some hundred waves in float64."""
    source = ocean(depth=depth)
    written = fo.export.openfast(source, GRID, tmp_path / "waves", dt=0.5)
    assert sorted(written) == sorted(f"waves{q}" for q in QUANTITIES)
    levels = [15.0 * (math.cos(n * math.pi / 6) - 1.0) for n in (3, 2, 1, 0)]
    times = np.arange(120) * 0.5
    for quantity, (name, axis) in QUANTITIES.items():
        table = np.loadtxt(tmp_path / f"waves{quantity}")
        x, y, z = corner_first([0.0] if quantity == ".Elev" else levels)
        below = fo.kinematics.at(source, x, y, z, times[:, None])
        values = getattr(below, name)
        values = values if axis is ... else values[..., axis]
        assert table.shape == (120, x.size)
        assert np.max(np.abs(table - values)) < 2e-7 * np.max(np.abs(values))


def test_a_cascade_adds_up(tmp_path):
    sea = fo.Sea.from_wind(speed=10.0, fetch=100e3)
    source = fo.Cascade(sea, [(16, 200.0), (16, 37.0)], seed=3)
    fo.export.openfast(source, GRID, tmp_path / "sum", tmax=2.0, dt=1.0)
    x, y, z = corner_first([0.0])
    expected = fo.kinematics.at(source, x, y, z, np.array([[0.0], [1.0]])).heights
    assert np.max(np.abs(np.loadtxt(tmp_path / "sum.Elev") - expected)) < 1e-6


def test_components_of_a_long_crested_sea_give_its_height_at_the_origin(tmp_path):
    """SeaState: sum of height/2 cos(omega t + phase) at the origin, a crest at phase 0."""
    modes = [(0, 2, 0.4, 0.3), (0, 3, 0.3, -2.0), (0, 5, 0.2, 4.0)]
    source = fo.Ocean.from_modes(modes, n=16, size=200.0, loop=300.0, dtype="float64")
    assert list(fo.export.openfast(source, None, tmp_path / "one", wave_mod=7)) == ["one.Comp"]
    omega, height, heading, phase = np.loadtxt(tmp_path / "one.Comp", comments="!").T
    assert heading == pytest.approx([90.0] * 3)
    assert omega * 300.0 / (2.0 * np.pi) == pytest.approx(np.rint(omega * 150.0 / np.pi), abs=1e-8)
    for t in (0.0, 12.3, 250.0):
        expected = source.frame(t, ["height"]).height[0, 0]
        assert np.sum(0.5 * height * np.cos(omega * t + np.deg2rad(phase))) == pytest.approx(
            float(expected), abs=1e-8
        )


def test_one_heading_a_frequency(tmp_path):
    crossing = fo.Ocean.from_modes(
        [(2, 1, 0.4, 0.3), (2, -1, 0.3, 0.0)], n=16, size=200.0, loop=300.0
    )
    with pytest.raises(fo.ParameterError, match="one wave a frequency, and 2 waves have"):
        fo.export.openfast(crossing, None, tmp_path / "two", wave_mod=7)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"dt": 0.7}, "whole multiple of dt, got 60 s and 0.7 s"),
        ({"dt": None}, "dt must be given"),
        ({"wave_mod": 5}, "wave_mod must be 6 or 7, got 5"),
        ({"grid": fo.export.SeaStateGrid(40.0, 20.0, 21.0, 3, 2, 4)}, "depth of the water, 20 m"),
        ({"grid": (40.0, 20.0)}, "grid must be a SeaStateGrid"),
        ({"grid": fo.export.SeaStateGrid(9.0, 9.0, 9.0, 200, 200, 9), "dt": 1e-3}, "4294967296"),
        ({"wave_mod": 7}, "takes neither grid"),
    ],
)
def test_values_out_of_range_are_refused(tmp_path, arguments, message):
    arguments = {"dt": 0.5, "grid": GRID, **arguments}
    with pytest.raises(fo.ParameterError, match=message):
        fo.export.openfast(ocean(), arguments.pop("grid"), tmp_path / "waves", **arguments)
    assert not list(tmp_path.iterdir())


def test_a_sea_without_a_loop_names_what_is_missing(tmp_path):
    source = ocean(loop=None)
    with pytest.raises(fo.ParameterError, match="tmax must be given"):
        fo.export.openfast(source, GRID, tmp_path / "waves", dt=0.5)
    with pytest.raises(fo.ParameterError, match=r"needs an Ocean that loops.*without a loop"):
        fo.export.openfast(source, None, tmp_path / "waves", wave_mod=7)


@pytest.mark.parametrize("arguments", [(0.0, 1.0, 1.0, 2, 2, 2), (1.0, 1.0, 1.0, 1, 2, 2)])
def test_a_grid_without_extent_is_refused(arguments):
    with pytest.raises(fo.ParameterError):
        fo.export.SeaStateGrid(*arguments)
