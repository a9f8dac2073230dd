"""
The summed water of a cascade against a sum of all its waves one by one, and foam made from the
sums.
"""

import math
import pickle

import numpy as np
import pytest

import fftocean as fo
from fftocean.fields import EIGHT, FIELDS

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
LOOP = 24.0
SEA = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
TILES = [(24, 120.0), ((20, 24), (31.0, 29.0)), (20, 7.3)]  # sizes that do not divide one another


@pytest.fixture(scope="module")
def cascade():
    return fo.Cascade(SEA, TILES, seed=7, loop=LOOP, choppiness=1.1, dtype="float64")


def summed(cascade, x, y, times):
    """
    Every linear field of the sum at points and times, (times, points): a cosine for each wave of
    each tile, deep water.
    """
    w = cascade.modes()
    k = np.hypot(w.kx, w.ky)
    place = w.amplitude * np.exp(
        1j * (np.outer(x, w.kx) + np.outer(y, w.ky) - w.phase)
    )  # (points, waves)
    turn = np.exp(-1j * np.outer(times, w.omega))
    factors = {
        "height": np.ones_like(k),
        "displace_x": 1j * w.kx / k,
        "displace_y": 1j * w.ky / k,
        "slope_x": 1j * w.kx,
        "slope_y": 1j * w.ky,
        "stretch_xx": -w.kx * w.kx / k,
        "stretch_xy": -w.kx * w.ky / k,
        "stretch_yy": -w.ky * w.ky / k,
        "velocity_x": w.omega * w.kx / k,
        "velocity_y": w.omega * w.ky / k,
        "velocity_z": -1j * w.omega,
    }
    return {name: np.real((turn * factor) @ place.T) for name, factor in factors.items()}


def off(ours, truth):
    """Root mean square of the difference over that of the truth."""
    return math.sqrt(np.mean((np.asarray(ours, float) - truth) ** 2) / np.mean(truth**2))


def places(window):
    x, y = np.meshgrid(window.x + window.grid.x, window.y + window.grid.y)
    return x.ravel(), y.ravel()


@pytest.mark.parametrize("corner", [(0.0, 0.0), (-431.7, 9e5 + 0.3)])
def test_every_linear_field_is_the_sum_over_tiles(cascade, corner):
    """
    Splines miss 0.6 % of the shortest waves at most, which slopes and stretches are made of; the
    height is far better.
    """
    window = fo.Window(cascade, n=(17, 12), size=(150.0, 61.0), x=corner[0], y=corner[1])
    frame = window.frame(5.3, tuple(FIELDS))
    truth = summed(cascade, *places(window), [5.3])
    for name in FIELDS:
        bound = 5e-4 if name in ("height", "displace_x", "displace_y") else 5e-3
        assert off(frame[name].ravel(), truth[name][0]) < bound, name


def test_normals_and_jacobian_are_made_from_the_sums(cascade):
    """
    The cross product of the summed surface's tangents; the same by `fo.normals` and by `fo.Query`
    at the displaced places.
    """
    window = fo.Window(cascade, n=(17, 12), size=(150.0, 61.0), x=40.0)
    frame = window.frame(5.3, (*EIGHT, "normal", "jacobian"))
    x, y = places(window)
    s, c = {name: values[0] for name, values in summed(cascade, x, y, [5.3]).items()}, 1.1
    along = np.stack([1 + c * s["stretch_xx"], c * s["stretch_xy"], s["slope_x"]], -1)
    up = np.stack([c * s["stretch_xy"], 1 + c * s["stretch_yy"], s["slope_y"]], -1)
    truth = np.cross(along, up)
    assert off(frame.jacobian.ravel() - 1.0, truth[:, 2] - 1.0) < 5e-3
    truth /= np.linalg.norm(truth, axis=-1, keepdims=True)
    assert np.sqrt(np.mean((frame.normal.reshape(-1, 3) - truth) ** 2)) < 5e-3 * np.sqrt(
        np.mean(truth[:, :2] ** 2)
    )
    assert np.array_equal(frame.normal, fo.normals(frame))
    assert np.array_equal(frame.jacobian, fo.jacobian(frame))
    found = fo.Query(cascade, mode="exact").at(
        x + c * s["displace_x"], y + c * s["displace_y"], 5.3
    )
    calm = ~found.folded
    assert np.mean(calm) > 0.95
    assert np.max(np.abs(found.normals[calm] - truth[calm])) < 1e-5


def test_a_tile_alone_has_another_jacobian(cascade):
    """
    The figure that a tile shows is not that of the water: the least Jacobian of the sum lies below
    that of every tile.
    """
    fields = ("jacobian",)
    least = min(float(ocean.frame(5.3, fields).jacobian.min()) for ocean in cascade.oceans)
    assert fo.Window(cascade, n=64).frame(5.3, fields).jacobian.min() < least - 0.05


def test_a_window_on_its_own_samples_is_the_ocean():
    ocean = fo.Ocean(SEA, n=24, size=60.0, seed=3, loop=LOOP, dtype="float64")
    frame, truth = fo.Window(ocean).loop_frame(3, 7), ocean.loop_frame(3, 7)
    assert frame.t == truth.t
    for name in truth.fields:
        assert off(frame[name], truth[name]) < 1e-12  # the spline goes through them


def test_short_waves_are_left_out(cascade):
    window = fo.Window(cascade, n=9, size=100.0, shortest=12.0)
    w = cascade.modes()
    long = np.hypot(w.kx, w.ky) * 12.0 <= 2.0 * np.pi
    x, y = places(window)
    k, phase = (
        np.hypot(w.kx, w.ky)[long],
        np.outer(x, w.kx[long]) + np.outer(y, w.ky[long]) - w.omega[long] * 2.0 - w.phase[long],
    )
    truth = -np.cos(phase) @ (w.amplitude[long] * w.kx[long] ** 2 / k)
    assert off(window.frame(2.0, ("stretch_xx",)).stretch_xx.ravel(), truth) < 5e-3


def test_the_foam_of_a_cascade_is_that_of_the_summed_displacement_gradient(cascade):
    """
    The integral over all the past of e^{-(t - s)/tau} source(s), with numpy's eigenvalues of the
    summed deformation gradient.

    3000 rectangles a loop; steps of a third of a radian and the splines are good for 2 % of the
    root mean square.
    """
    foam = fo.Foam(tau=2.0, threshold=0.8, strength=40.0)
    window = fo.Window(cascade, n=5, size=53.0, x=11.0, y=-7.0)
    dense, count = 3000, 12
    s, c = summed(cascade, *places(window), np.arange(dense) * (LOOP / dense)), 1.1
    xx, xy, yy = (c * s[f"stretch_{axes}"] for axes in ("xx", "xy", "yy"))
    deformation = np.stack([np.stack([1 + xx, xy], -1), np.stack([xy, 1 + yy], -1)], -1)
    source = 40.0 * np.maximum(0.8 - np.linalg.eigvalsh(deformation)[..., 0], 0.0)
    memory = np.exp(-np.arange(dense) * (LOOP / dense) / 2.0) / (1.0 - math.exp(-LOOP / 2.0))
    made = np.fft.ifft(np.fft.fft(source, axis=0) * np.fft.fft(memory)[:, None], axis=0).real[
        :: dense // count
    ] * (LOOP / dense)
    truth = 1.0 - np.exp(-made)
    ours = np.stack([cover.ravel() for cover in foam.loop(window, count)])
    assert np.mean(truth) > 0.02  # there is foam to speak of
    assert off(ours, truth) < 0.02


def test_foam_of_a_cascade_needs_a_common_loop_and_a_real_source(cascade):
    free = fo.Cascade(SEA, TILES[:2], seed=7)
    with pytest.raises(fo.ParameterError, match="loop"):
        next(fo.Foam().loop(free, 4))
    with pytest.raises(fo.ParameterError, match="an Ocean, a Cascade or a Window"):
        next(fo.Foam().loop(cascade.frame(0.0), 4))
    with pytest.raises(fo.ParameterError, match="loop_frame needs"):
        fo.Window(free).loop_frame(0, 4)
    assert fo.Foam().live(fo.Window(free, n=8, size=30.0), 2.0).at(2.5).shape == (8, 8)
    assert next(fo.Foam().loop(cascade, 1)).shape == (24, 24)  # the largest tile's window


def test_a_window_by_its_arguments(cascade):
    window = fo.Window(cascade, n=6, size=40.0, x=5.0, y=6.0, shortest=1.0)
    other = pickle.loads(pickle.dumps(window))
    assert np.array_equal(other.frame(1.0).height, window.frame(1.0).height)
    first = window.frame(1.0, ("height", "jacobian"))
    assert window.frame(2.0, ("height", "jacobian"), out=first) is first
    assert np.array_equal(first.height, window.frame(2.0).height)
    for bad in ({"n": 0}, {"size": -1.0}, {"x": math.nan}, {"shortest": -1.0}):
        with pytest.raises(fo.ParameterError):
            fo.Window(cascade, **bad)
    with pytest.raises(fo.ParameterError, match="a Cascade or an Ocean"):
        fo.Window(SEA)
    with pytest.raises(fo.ParameterError, match="field"):
        window.frame(0.0, ("foam",))


@pytest.mark.parametrize("name", ["normal", "jacobian"])
def test_a_cascade_gives_no_field_that_does_not_add_up(cascade, name):
    for call in (
        lambda: cascade.frame(1.0, ("height", name)),
        lambda: cascade.loop_frame(1, 4, (name,)),
    ):
        with pytest.raises(
            fo.ParameterError, match=rf"must add up over its tiles, got '{name}'.*fo\.Window"
        ):
            call()


def test_a_window_as_labelled_data(cascade):
    """
    Coordinates are those of the world; every number is the window's; attributes are those of all
    tiles together.
    """
    pytest.importorskip("xarray")
    window = fo.Window(cascade, n=(6, 5), size=(30.0, 20.0), x=100.0, y=-50.0)
    data = fo.to_xarray(window, [1.0, 2.5], ("height", "jacobian"))
    assert np.array_equal(data.jacobian.values[1], window.frame(2.5, ("jacobian",)).jacobian)
    assert data.x.values.tolist() == [100.0, 105.0, 110.0, 115.0, 120.0, 125.0]
    assert float(data.y[0]) == -50.0
    assert "Periodic" not in data.comment
    assert data.attrs["measured_m0"] == pytest.approx(fo.measure(cascade).m0)
    assert data.attrs["tiles"].count(" over ") == 3
    with pytest.raises(fo.ParameterError, match=r"no grid in common: take fo\.Window"):
        fo.to_xarray(cascade, [0.0])
    with pytest.raises(fo.ParameterError, match=r"each of cascade\.oceans"):
        fo.verify(cascade)


def test_more_samples_than_there_is_memory_for_are_refused(cascade, monkeypatch):
    """128 bytes a sample, for positions, sums and a frame: 2 GiB of 4096 x 4096."""
    monkeypatch.setattr("fftocean.host.available_memory", lambda: 2.0**30)
    with pytest.raises(
        fo.ParameterError, match=r"a window of n = 4096 x 4096 needs about 2\.\d GiB of memory"
    ):
        fo.Window(cascade, n=4096)
    fo.Window(cascade, n=64)


def test_a_frame_that_a_window_has_filled_is_checked_again_by_an_ocean(cascade):
    """A window puts arrays of its own into the frame, which may be smaller than the ocean's."""
    ocean = fo.Ocean(SEA, n=64, size=100.0, dtype="float64")
    window = fo.Window(cascade, n=16, size=30.0)
    out = ocean.frame(0.0, ("height",))
    assert window.frame(1.0, ("height",), out=out).height.shape == (16, 16)
    with pytest.raises(fo.ParameterError, match=r"of shape \(64, 64\), got float64 \(16, 16\)"):
        ocean.frame(1.0, ("height",), out=out)
    same = fo.Window(cascade, n=64, size=30.0)
    same.frame(1.0, ("height",), out=out)
    expected = ocean.frame(2.0, ("height",)).height
    assert np.array_equal(ocean.frame(2.0, ("height",), out=out).height, expected)
