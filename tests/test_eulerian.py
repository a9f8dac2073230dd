"""Eulerian frames against the parametric surface summed wave by wave, without a grid."""

import numpy as np
import pytest

import fftocean as fo
from fftocean.eulerian import STEEPEST, Eulerian

ALL = (
    "height",
    "slope_x",
    "slope_y",
    "velocity_x",
    "velocity_y",
    "velocity_z",
    "normal",
    "jacobian",
)


def surface_over(ocean, x, y, t):
    """
    Return the parametric surface over (x, y), by a fixed-point iteration on exact sums.
    """
    x0, y0 = x.copy(), y.copy()
    for _ in range(200):
        s = fo.gerstner.surface(ocean, x0, y0, t)
        off_x, off_y = x - s.x, y - s.y
        x0, y0 = x0 + off_x, y0 + off_y
        if max(np.max(np.abs(off_x)), np.max(np.abs(off_y))) < 1e-10:
            return s
    raise AssertionError("the fixed point was not found")


def some_positions(ocean, count, seed=0):
    rng = np.random.default_rng(seed)
    iy, ix = rng.integers(0, ocean.grid.ny, count), rng.integers(0, ocean.grid.nx, count)
    return iy, ix, ocean.grid.x[ix], ocean.grid.y[iy]


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_a_realistic_sea_to_a_tenth_of_a_millimetre(dtype):
    """
    A fresh breeze, 256 samples over 200 m: the spline's own error is 5e-4 of the shortest waves,
    which are some millimetres high.

    Derivatives weigh the shortest waves by their wavenumber, 4 rad/m, and velocities by their
    frequency, 6 rad/s.
    """
    ocean = fo.Ocean(
        fo.Sea.from_wind(speed=10.0, fetch=100e3), n=256, size=200.0, seed=2, dtype=dtype
    )
    iy, ix, x, y = some_positions(ocean, 12)
    truth = surface_over(ocean, x, y, 3.3)
    euler = Eulerian(ocean)
    frame = euler.frame(3.3, ALL)
    assert frame.height.dtype == dtype
    assert not euler.folded.any()
    assert euler.residual < 1e-6
    assert np.max(np.abs(frame.height[iy, ix] - truth.z)) < 1e-4
    assert np.std(truth.z) > 0.3
    for name, error in (
        ("velocity_x", 6e-4),
        ("velocity_y", 6e-4),
        ("velocity_z", 6e-4),
        ("jacobian", 1e-3),
    ):
        assert np.max(np.abs(frame[name][iy, ix] - getattr(truth, name))) < error
    assert np.max(np.abs(frame.normal[iy, ix] - truth.normal)) < 5e-4
    slopes = -truth.normal[:, :2] / truth.normal[:, 2:]
    assert np.max(np.abs(np.stack([frame.slope_x, frame.slope_y], -1)[iy, ix] - slopes)) < 5e-4
    x0, y0 = euler.positions
    moved = fo.gerstner.surface(ocean, x0[iy, ix], y0[iy, ix], 3.3)
    assert np.max(np.hypot(moved.x - x, moved.y - y)) < 1e-4


@pytest.mark.parametrize(
    ("n", "size"), [((9, 14), (30.0, 50.0)), ((16, 16), (40.0, 40.0)), ((5, 3), (20.0, 11.0))]
)
def test_waves_of_any_length_on_any_tile(n, size):
    """
    Odd, even and oblong; waves as short as the grid holds, in shallow water: 1e-3 of their height,
    as the spline's error says.
    """
    reach = [(m - 1) // 2 for m in n]
    modes = [
        (1, 0, 0.3, 0.2),
        (-1, 1, 0.2, 1.0),
        (reach[0], -reach[1], 0.02, 2.0),
        (0, reach[1], 0.02, 3.0),
    ]
    ocean = fo.Ocean.from_modes(
        modes, n=n, size=size, depth=3.0, choppiness=0.8, dtype="float64", loop=12.0
    )
    x, y = np.meshgrid(ocean.grid.x, ocean.grid.y)
    frame = Eulerian(ocean).loop_frame(5, 8, ("height", "normal"))
    truth = surface_over(ocean, x, y, frame.t)
    assert frame.t == 7.5
    assert np.max(np.abs(frame.height - truth.z)) < 1e-3 * 0.04
    assert np.max(np.abs(frame.normal - truth.normal)) < 1e-3


def test_without_choppiness_it_is_the_ocean_s_own_frame():
    ocean = fo.Ocean(
        fo.Sea.from_wind(speed=8.0, fetch=50e3), n=32, size=60.0, dtype="float64", choppiness=0.0
    )
    ours, own = Eulerian(ocean).frame(1.0, ALL), ocean.frame(1.0, ALL)
    for name in ALL:
        assert np.allclose(ours[name], own[name], atol=1e-12), (
            name
        )  # the spline goes through its samples


def test_normals_agree_with_slopes_and_the_jacobian_is_that_of_the_water():
    """
    Normals by place and by the slopes agree; the Jacobian is that of the water, and there is no
    stretch to make another of.
    """
    ocean = fo.Ocean(fo.Sea.from_wind(speed=8.0, fetch=50e3), n=32, size=60.0, choppiness=1.2)
    euler = Eulerian(ocean)
    frame = euler.frame(1.0, ALL)
    assert type(frame) is fo.EulerianFrame
    assert not isinstance(frame, fo.Frame)
    assert frame.choppiness == ocean.choppiness
    assert frame.grid == ocean.grid
    assert set(frame.fields) == set(ALL)
    assert np.max(np.abs(fo.normals(frame) - frame.normal)) < 1e-6  # float32
    x0, y0 = euler.positions
    water = fo.gerstner.surface(ocean, x0, y0, 1.0).jacobian
    assert np.ptp(water) > 0.1
    assert np.max(np.abs(fo.jacobian(frame) - water)) < 5e-3  # of a coarse tile's splines
    assert not np.shares_memory(fo.jacobian(frame), frame.jacobian)


@pytest.mark.parametrize(
    "name", ["displace_x", "displace_y", "stretch_xx", "stretch_xy", "stretch_yy"]
)
def test_fields_that_a_height_field_lacks_are_refused_by_name(name):
    euler = Eulerian(fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=10.0))
    reason = f"{name}: a height field over places has no displacement"
    with pytest.raises(fo.ParameterError, match=reason):
        euler.frame(0.0, ("height", name))
    frame = euler.frame(0.0)
    for ask in (lambda: frame[name], lambda: getattr(frame, name)):
        with pytest.raises(fo.FieldError, match=reason):
            ask()
    for make in (fo.minimum_eigenvalue, fo.folding):
        with pytest.raises(fo.FieldError, match="an eulerian frame has no stretch_xx"):
            make(frame)
    with pytest.raises(
        fo.FieldError, match=r"for jacobian ask frame\(t, fields=\('jacobian', ...\)\)$"
    ):
        fo.jacobian(frame)
    assert not hasattr(frame, "anything")
    with pytest.raises(fo.ParameterError, match="out must be a frame"):
        euler._ocean.frame(0.0, ("height",), out=frame)


def test_crests_are_narrower_than_troughs():
    """
    One wave: the water above the mean level, half of the still one, is compressed to 1/2 - c a
    k/pi of the places.
    """
    ocean = fo.Ocean.from_modes([(1, 0, 0.6, 0.4)], n=(512, 3), size=20.0, choppiness=1.2)
    above = np.mean(Eulerian(ocean).frame(0.0, ("height",)).height > 0.0)
    assert above == pytest.approx(0.5 - 1.2 * 0.6 * 2 * np.pi / 20.0 / np.pi, abs=1.5 / 512)
    assert np.mean(ocean.frame(0.0, ("height",)).height > 0.0) == pytest.approx(0.5, abs=1.5 / 512)


def test_folds_are_found_and_the_upper_sheet_is_taken():
    """
    One wave folded at its crest, c k a = 1.6: x = x0 - c a sin k x0. Under the fold three sheets
    lie over each place, found here on a dense curve; the middle of the crest is 1.6 times turned
    over, and the highest water is still that of the curve.
    """
    size, a = 20.0, 1.6 * 20.0 / (2 * np.pi)
    ocean = fo.Ocean.from_modes([(1, 0, a, np.pi)], n=(128, 4), size=(size, 5.0), dtype="float64")
    euler = Eulerian(ocean)
    frame = euler.frame(0.0, ALL)
    k = 2 * np.pi / size
    dense = np.linspace(-size, 2 * size, 300_001)
    where, height = dense + a * np.sin(k * dense), -a * np.cos(k * dense)
    turn = np.arccos(-1.0 / 1.6)  # k x0 where the curve turns back: dx/dx0 = 0
    rim_at = abs((turn + 1.6 * np.sin(turn)) / k - 0.5 * size)
    for ix, x in enumerate(ocean.grid.x):
        crossing = np.flatnonzero(np.diff(np.sign(where - x - 1e-9)))
        beside = abs(abs(x - 0.5 * size) - rim_at) < 0.16
        if not beside:  # within a sample of the rim, triangles and curve may differ
            assert euler.folded[0, ix] == (crossing.size > 1)
            assert frame.height[0, ix] == pytest.approx(
                np.max(height[crossing]), abs=5e-4
            )  # of the dense curve
    assert 10 < euler.folded[0].sum() < 40
    assert np.array_equal(euler.folded, euler.folded[:1].repeat(4, axis=0))
    assert all(np.all(np.isfinite(frame[name])) for name in ALL)
    assert max(np.max(np.abs(frame.slope_x)), np.max(np.abs(frame.slope_y))) <= STEEPEST * (
        1.0 + 1e-12
    )


def test_a_surface_with_many_folds_stays_finite():
    ocean = fo.Ocean(fo.Sea.from_wind(speed=30.0, fetch=500e3), n=32, size=60.0, choppiness=10.0)
    euler = Eulerian(ocean)
    frame = euler.frame(2.0, ALL)
    assert euler.folded.mean() > 0.1
    assert all(np.all(np.isfinite(frame[name])) for name in ALL)
    assert np.max(np.abs(frame.height)) <= np.max(np.abs(ocean.frame(2.0).height)) * 1.5


def test_frames_come_in_any_order_with_the_same_bits():
    ocean = fo.Ocean(fo.Sea.from_wind(speed=8.0, fetch=50e3), n=24, size=60.0, loop=20.0)
    one, two = Eulerian(ocean), Eulerian(ocean)
    first = one.loop_frame(3, 8, ALL)
    kept = {name: first[name].copy() for name in ALL}
    one.loop_frame(5, 8, ("height",))
    two.loop_frame(7, 8, ("normal", "height"))
    again, other = one.loop_frame(11, 8, ALL), two.loop_frame(3, 8, ALL)
    for name in ALL:
        assert np.array_equal(kept[name], first[name])  # a frame once returned is left alone
        assert np.array_equal(kept[name], again[name])
        assert np.array_equal(kept[name], other[name])
    assert np.array_equal(two.loop_frame(3, 8, ("height",)).height, kept["height"])


def test_another_field_is_resampled_at_the_same_positions():
    """
    The undisplaced x as a field of its own, then foam: within its range, and where the positions
    say.
    """
    ocean = fo.Ocean(fo.Sea.from_wind(speed=8.0, fetch=50e3), n=32, size=64.0)
    euler = Eulerian(ocean)
    euler.frame(1.0, ("height",))
    x0, y0 = euler.positions
    wave = (
        np.sin(2 * np.pi * ocean.grid.x / 64.0)[None, :]
        * np.cos(2 * np.pi * ocean.grid.y / 64.0)[:, None]
    )
    exact = np.sin(2 * np.pi * x0 / 64.0) * np.cos(2 * np.pi * y0 / 64.0)
    assert (
        np.max(np.abs(euler.resample(wave) - exact)) < (2 * np.pi / 32) ** 2 / 8 * 2
    )  # of two linear interpolations
    foam = (np.random.default_rng(1).uniform(size=(32, 32)) > 0.9).astype(np.float32)
    carried = euler.resample(foam)
    assert carried.dtype == np.float32
    assert carried.min() >= 0.0
    assert carried.max() <= 1.0
    with pytest.raises(fo.ParameterError, match=r"tile's shape \(32, 32\), got \(16, 32\)"):
        euler.resample(foam[:16])


def test_flat_water_is_flat_on_the_smallest_tile():
    flat = Eulerian(fo.Ocean.from_modes([], n=(3, 1), size=10.0))
    frame = flat.frame(0.0, ALL)
    assert not frame.height.any()
    assert np.array_equal(frame.normal, np.broadcast_to([0.0, 0.0, 1.0], (1, 3, 3)))
    assert np.array_equal(frame.jacobian, np.ones((1, 3)))
    assert not flat.folded.any()


def test_unknown_fields_and_other_types_are_refused():
    euler = Eulerian(fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=10.0))
    with pytest.raises(fo.ParameterError, match=r"a field must be one of height, .* got 'foam'"):
        euler.frame(0.0, ("foam",))
    with pytest.raises(fo.ParameterError, match="needs an ocean that loops"):
        euler.loop_frame(0, 4)
    with pytest.raises(fo.ParameterError, match="t must be"):
        euler.frame(float("nan"))


@pytest.mark.parametrize(
    ("speed", "n", "size"),
    [
        (25.0, 48, 120.0),
        (40.0, 32, 600.0),
        (40.0, (128, 16), 400.0),  # samples of other lengths along x and y
        (40.0, (16, 128), 400.0),
    ],
)
def test_a_storm_on_few_samples_is_as_exact(speed, n, size):
    """
    The steepest waves have two samples: the splines are made finer until the promised 1e-4 m hold,
    against the sum of all waves.
    """
    ocean = fo.Ocean(
        fo.Sea.from_wind(speed=speed, fetch=500e3),
        n=n,
        size=size,
        seed=3,
        choppiness=0.6,
        dtype="float64",
    )
    seen = Eulerian(ocean)
    frame = seen.frame(2.0, ("height",))
    assert not np.any(seen.folded)
    x, y = np.meshgrid(ocean.grid.x, ocean.grid.y)
    assert np.max(np.abs(frame.height - surface_over(ocean, x, y, 2.0).z)) < 1e-4
