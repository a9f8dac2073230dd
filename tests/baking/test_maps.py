"""Maps: each channel against the ocean's own fields, by either lookup, and their mip levels."""

import dataclasses
from typing import get_args

import builders
import numpy as np
import pytest

import fftocean as fo
from fftocean.baking.scene import maps
from fftocean.baking.scene.maps import MAPS
from fftocean.eulerian import Eulerian
from fftocean.export.profiles import Kind
from fftocean.fields import FIELDS
from fftocean.job import parameters

EVERY = maps.needed(MAPS, mips=True)


@pytest.fixture(scope="module")
def ocean():
    return fo.Ocean(
        fo.Sea.from_wind(speed=10.0, fetch=100e3),
        n=(24, 14),
        size=(60.0, 35.0),
        seed=3,
        choppiness=1.3,
    )


@pytest.fixture(scope="module")
def foam(ocean):
    return np.random.default_rng(0).uniform(size=ocean.grid.shape).astype(np.float32)


@pytest.mark.parametrize("name", MAPS)
def test_every_map_has_what_it_says(name, ocean, foam):
    """
    With the fields it needs and no others: as many channels as names, float32, C-contiguous; levels
    down to one texel.
    """
    m = MAPS[name]
    frame = ocean.frame(1.0, maps.needed([name])) if m.needs else ocean.frame(1.0, "height")
    picture = m.channels(frame, foam, np.zeros(3))
    assert picture.shape == (14, 24, len(m.names))
    assert picture.dtype == np.float32
    assert picture.flags.c_contiguous
    assert m.kind in get_args(Kind)
    assert len(m.names) == {
        "vector": 3,
        "normal": 3,
        "derivative": 4,
        "stretch": 3,
        "covariance": 3,
    }.get(m.kind, 1)
    fields = maps.needed([name], mips=True)
    levels = m.levels(ocean.frame(1.0, fields) if fields else frame, foam, np.zeros(3))
    assert np.array_equal(levels[0], picture)
    assert [level.shape[:2] for level in levels] == [(14, 24), (7, 12), (3, 6), (1, 3), (1, 1)]
    assert all(
        level.dtype == np.float32 and level.flags.c_contiguous and np.all(np.isfinite(level))
        for level in levels
    )


def test_needed_is_each_field_once_and_known():
    assert len(set(EVERY)) == len(EVERY)
    assert set(EVERY) <= {*FIELDS, "normal", "jacobian"}
    assert maps.needed(["height", "displacement", "foam"]) == ("height", "displace_x", "displace_y")
    assert maps.needed(["normal"]) == ("normal",)
    assert set(maps.needed(["normal"], mips=True)) == {
        "normal",
        "slope_x",
        "slope_y",
        "stretch_xx",
        "stretch_xy",
        "stretch_yy",
    }


def test_channels_are_the_fields(ocean, foam):
    """
    The bits of the ocean's own arrays, in float32; displacement, stretches and the horizontal
    velocity of the surface, not that of the water, times choppiness.
    """
    f = ocean.frame(1.0, EVERY)
    c = ocean.choppiness
    expected = {
        "height": [f.height],
        "displacement": [f.displace_x * c, f.displace_y * c, f.height],
        "normal": [f.normal[..., i] for i in range(3)],
        "derivative": [f.slope_x, f.slope_y, f.stretch_xx * c, f.stretch_yy * c],
        "stretch": [f.stretch_xx * c, f.stretch_xy * c, f.stretch_yy * c],
        "jacobian": [f.jacobian],
        "foam": [foam],
        "velocity": [f.velocity_x, f.velocity_y, f.velocity_z],
        "surface_velocity": [f.velocity_x * c, f.velocity_y * c, f.velocity_z],
    }
    for name, channels in expected.items():
        picture = MAPS[name].channels(f, foam)
        for i, channel in enumerate(channels):
            assert np.array_equal(picture[..., i], channel), name
    assert not MAPS["slope_covariance"].channels(f).any()
    beyond = np.array([3e-3, 1e-3, 2e-3])
    assert np.array_equal(
        MAPS["slope_covariance"].channels(f, None, beyond)[3, 4], beyond.astype(np.float32)
    )


def test_the_derivative_map_gives_the_normal_of_one_wave():
    """
    As its caption says: exact where waves run along an axis, for there the stretch across them and
    the shear are 0.
    """
    ocean = fo.Ocean.from_modes([(0, 1, 0.4, 0.3)], n=16, size=20.0, choppiness=1.2)
    f = ocean.frame(0.0, EVERY)
    sx, sy, xx, yy = np.moveaxis(MAPS["derivative"].channels(f).astype(float), -1, 0)
    made = np.stack([-sx / (1 + xx), -sy / (1 + yy), np.ones_like(sx)], -1)
    assert np.allclose(
        made / np.linalg.norm(made, axis=-1, keepdims=True), MAPS["normal"].channels(f), atol=1e-6
    )


def test_the_surface_velocity_map_is_how_the_displacement_map_moves(ocean):
    """
    Central differences 1e-3 s apart of a double precision twin: (omega dt)^2/6 = 1e-6 of some m/s,
    and roundings.
    """
    twin = fo.Ocean(
        ocean.sea, n=(24, 14), size=(60.0, 35.0), seed=3, choppiness=1.3, dtype="float64"
    )
    fields = ("displace_x", "displace_y", "height")
    scaled = list(zip(fields, (1.3, 1.3, 1.0), strict=True))
    before, after = (
        np.stack([frame[name] * factor for name, factor in scaled], -1)
        for frame in (twin.frame(1.0 - 1e-3, fields), twin.frame(1.0 + 1e-3, fields))
    )
    velocity = MAPS["surface_velocity"].channels(ocean.frame(1.0, EVERY))
    assert np.allclose(velocity, (after - before) / 2e-3, atol=1e-5)


@pytest.mark.parametrize("choppiness", [0.0, 0.6, 1.0])
def test_the_velocity_map_is_that_of_the_water(choppiness):
    """
    Of one wave: a omega cos f along, a omega sin f up, in deep water, at any choppiness, and so by
    rest position as by place.
    """
    a, size, t = 0.2, 10.0, 1.3
    k = 2.0 * np.pi / size
    omega = np.sqrt(9.80665 * k)
    ocean = fo.Ocean.from_modes(
        [(1, 0, a, 0.0)], n=32, size=size, choppiness=choppiness, dtype="float64"
    )
    needed = MAPS["velocity"].needs
    euler = Eulerian(ocean)
    by_place = euler.frame(t, needed)
    for frame, x0 in (
        (ocean.frame(t, needed), ocean.grid.x[None, :] + np.zeros((32, 1))),
        (by_place, euler.positions[0]),
    ):
        f = k * x0 - omega * t
        water = np.stack([np.cos(f), 0.0 * f, np.sin(f)], -1) * a * omega
        assert np.allclose(MAPS["velocity"].channels(frame), water, atol=2e-5)


def test_levels_of_heights_and_foam_keep_their_mean(ocean, foam):
    f = ocean.frame(1.0, EVERY)
    for name, mean in (("height", f.height), ("foam", foam), ("jacobian", f.jacobian)):
        for level in MAPS[name].levels(f, foam):
            assert np.mean(level, dtype=float) == pytest.approx(
                np.mean(mean, dtype=float), abs=3e-8
            ), name  # float32


def test_levels_of_derivative_and_covariance_belong_together(ocean):
    """
    On every level: variance of the derivative map's slopes + mean of the covariance map = variance
    of all, and the waves beyond.
    """
    f = ocean.frame(1.0, EVERY)
    beyond = np.array([3e-3, 1e-3, 2e-3])
    slopes, within = MAPS["derivative"].levels(f), MAPS["slope_covariance"].levels(f, None, beyond)
    total = np.var(f.slope_x, dtype=float) + beyond[0], np.var(f.slope_y, dtype=float) + beyond[2]
    for mean, covariance in zip(slopes, within, strict=True):
        for axis, channel in ((0, 0), (1, 2)):
            kept = np.var(mean[..., axis], dtype=float) + np.mean(
                covariance[..., channel], dtype=float
            )
            assert kept == pytest.approx(total[axis], rel=1e-6)


def test_by_place_the_maps_are_those_of_a_height_field(ocean, foam):
    """
    Displaced by the map, the grid becomes the surface itself; normals, from the derivative map too,
    are its own.
    """
    euler = Eulerian(ocean)
    shown = [name for name in MAPS if name != "stretch"]
    f = euler.frame(1.0, maps.needed(shown, mips=True, eulerian=True))
    x, y = np.meshgrid(ocean.grid.x, ocean.grid.y)
    displacement = MAPS["displacement"].channels(f)
    assert not displacement[..., :2].any()
    x0, y0 = euler.positions
    surface = fo.gerstner.surface(ocean, x0, y0, 1.0)
    assert np.allclose(surface.x, x, atol=2e-3)  # a coarse tile: 5e-4 of its shortest waves
    assert np.allclose(surface.y, y, atol=2e-3)
    assert np.allclose(displacement[..., 2], surface.z, atol=1e-3)
    assert np.allclose(MAPS["normal"].channels(f), surface.normal, atol=2e-3)
    sx, sy, xx, yy = np.moveaxis(MAPS["derivative"].channels(f).astype(float), -1, 0)
    made = np.stack([-sx / (1 + xx), -sy / (1 + yy), np.ones_like(sx)], -1)
    assert np.allclose(
        made / np.linalg.norm(made, axis=-1, keepdims=True), MAPS["normal"].channels(f), atol=1e-6
    )
    assert np.allclose(MAPS["jacobian"].channels(f)[..., 0], surface.jacobian, atol=5e-3)
    velocity = np.stack([surface.velocity_x, surface.velocity_y, surface.velocity_z], -1)
    assert np.allclose(MAPS["velocity"].channels(f), velocity, atol=5e-3)
    velocity *= (1.3, 1.3, 1.0)
    assert np.allclose(MAPS["surface_velocity"].channels(f), velocity, atol=6e-3)
    assert all(
        np.all(np.isfinite(level))
        for name in shown
        for level in MAPS[name].levels(f, euler.resample(foam))
    )


def test_a_map_that_no_height_field_shows_is_refused(tmp_path):
    reason = (
        "the map 'stretch' cannot be baked with the lookup 'eulerian', as it shows "
        "stretch_xx: a height field"
    )
    with pytest.raises(fo.ParameterError, match=reason):
        maps.needed(["height", "stretch"], eulerian=True)
    job = builders.job(
        {"bake.lookup": "eulerian", "bake.maps": ["height", "stretch"], "ocean.n": 8}
    )
    with pytest.raises(fo.JobError, match=reason):
        fo.bake(job, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_unresolved_is_that_of_the_ocean_s_sea(ocean):
    xx, xy, yy = maps.unresolved(ocean)
    assert 0.0 < yy < xx < 0.1  # the wind goes east
    assert abs(xy) < 1e-3 * xx


def test_a_map_without_one_of_its_parts_is_refused():
    """At import: each name of a job has a row, each row a name, and each row all of its parts."""
    row = MAPS["displacement"]
    maps.require_registered(MAPS, parameters.MAPS)
    for table, names, says in (
        (MAPS, [*parameters.MAPS, "salt"], "differ in salt"),
        ({**MAPS, "salt": row}, parameters.MAPS, "differ in salt"),
        ({"a": dataclasses.replace(row, names=row.names[:2])}, "a", "must have 3 channels, got 2"),
        ({"a": dataclasses.replace(row, names=(), kind="scalar")}, "a", "some channels, got 0"),
        ({"a": dataclasses.replace(row, kind="salt")}, "a", "no known kind, got 'salt'"),
        ({"a": dataclasses.replace(row, caption="")}, "a", "must have a caption"),
        ({"a": dataclasses.replace(row, needs_levels=("slope_x",))}, "a", "no function of them"),
    ):
        with pytest.raises(ImportError, match=says):
            maps.require_registered(table, names)
