"""Mip chains of tiles of any size: the mean, roughness and mean plane of every level."""

import math

import numpy as np
import pytest
from scipy import integrate

import fftocean as fo
from fftocean import mips
from fftocean.grid import Grid

GEOMETRY = ("slope_x", "slope_y", "stretch_xx", "stretch_xy", "stretch_yy")
SHAPES = [(16, 16), (1, 1), (2, 3), (7, 12), (5, 5), (31, 64), (1, 9), (100, 37)]


@pytest.mark.parametrize("shape", SHAPES)
def test_levels_have_the_sizes_of_a_gpu_s_and_keep_the_mean(shape):
    image = np.random.default_rng(1).standard_normal((*shape, 2))
    levels = mips.chain(image)
    assert levels[0] is image
    assert [level.shape for level in levels] == [
        (max(1, shape[0] >> i), max(1, shape[1] >> i), 2) for i in range(max(shape).bit_length())
    ]
    for level in levels:
        assert np.allclose(level.mean(axis=(0, 1)), image.mean(axis=(0, 1)), atol=1e-15)


def test_levels_have_the_precision_of_the_map():
    image = np.random.default_rng(1).standard_normal((8, 8, 1)).astype(np.float32)
    levels = mips.chain(image)
    assert {level.dtype for level in levels} == {np.dtype(np.float32)}
    assert levels[-1][0, 0, 0] == np.float32(
        np.mean(image, dtype=np.float64)
    )  # no rounding but the last


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("unresolved", [None, (3e-3, -1e-3, 2e-3)])
def test_roughness_is_kept_on_every_level(shape, unresolved):
    """
    Total covariance: that of the mean slopes over the level, and the mean of those within its
    texels, to round-off.
    """
    rng = np.random.default_rng(2)
    x, y = 0.1 * rng.standard_normal((2, *shape)) + 0.05
    beyond = None if unresolved is None else np.array(unresolved)
    means, within = mips.chain(np.stack([x, y], -1)), mips.slope_covariances(x, y, beyond)
    whole = np.cov(x.ravel(), y.ravel(), ddof=0) if x.size > 1 else np.zeros((2, 2))
    total = whole[[0, 0, 1], [0, 1, 1]] + (0.0 if beyond is None else beyond)
    assert len(within) == len(means)
    for mean, covariance in zip(means, within, strict=True):
        assert covariance.shape == (*mean.shape[:2], 3)
        a, b = (mean[..., i] - mean[..., i].mean() for i in (0, 1))
        spread = np.array([np.mean(a * a), np.mean(a * b), np.mean(b * b)])
        assert np.allclose(spread + covariance.mean(axis=(0, 1)), total, atol=1e-16)
        assert np.all(covariance[..., 0] >= 0.0)
        assert np.all(covariance[..., 0] * covariance[..., 2] - covariance[..., 1] ** 2 > -1e-16)
    assert np.allclose(within[0], 0.0 if beyond is None else beyond, atol=1e-17)


def test_the_roughness_of_one_wave_is_its_variance_of_slope():
    """
    Slope a k cos: over whole wavelengths its variance is (a k)^2/2, along its own direction, and is
    nothing across.
    """
    ocean = fo.Ocean.from_modes([(8, 0, 0.05, 0.3)], n=32, size=16.0, dtype="float64")
    frame = ocean.frame(0.0)
    last = mips.slope_covariances(frame.slope_x, frame.slope_y)[-1][0, 0]
    assert np.allclose(last, [(0.05 * 2 * np.pi / 2.0) ** 2 / 2, 0.0, 0.0], atol=1e-15)


def test_coarse_levels_keep_the_roughness_that_mean_slopes_lose():
    """At level 4 most of the slopes' variance is in the covariance."""
    frame = fo.Ocean(fo.Sea.from_wind(speed=10.0, fetch=100e3), n=64, size=60.0).frame(0.0)
    mean = mips.chain(np.stack([frame.slope_x, frame.slope_y], -1))
    within = mips.slope_covariances(frame.slope_x, frame.slope_y)
    assert np.mean(mean[4] ** 2) < 0.3 * np.mean(mean[0] ** 2)
    assert np.mean(within[4][..., 0]) > 0.7 * np.var(frame.slope_x)


@pytest.mark.parametrize("n", [(16, 16), (9, 6)])
def test_normals_are_those_of_the_mean_plane(n):
    """
    Against the surface itself: twice the vector area of a patch is the integral of r x dr along its
    rim, here summed wave by wave.

    A patch is the water of 2 x 2 samples, from half a sample before the first. Its inside is known
    at these four only: the mean of four cross products is the integral to the second order in the
    sample, (k h)^2/24 of the waves' own slopes.
    """
    ocean = fo.Ocean.from_modes(
        [(1, 0, 0.5, 0.2), (-1, 1, 0.3, 1.0)],
        n=n,
        size=(32.0, 24.0),
        dtype="float64",
        choppiness=1.1,
    )
    frame = ocean.frame(0.5, ("normal", *GEOMETRY))
    levels = mips.normals(frame.normal, tuple(frame[name] for name in GEOMETRY), frame.choppiness)
    assert levels[0] is frame.normal
    rows, columns = levels[1].shape[:2]
    along = np.linspace(0.0, 1.0, 400, endpoint=False)
    rim = np.concatenate(
        [
            np.stack(p, -1)
            for p in (
                (along, 0 * along),
                (1 + 0 * along, along),
                (1 - along, 1 + 0 * along),
                (0 * along, 1 - along),
            )
        ]
    )
    for q in range(rows):
        for p in range(columns):
            x = (p + rim[:, 0]) * 32.0 / columns - 16.0 / n[0]
            y = (q + rim[:, 1]) * 24.0 / rows - 12.0 / n[1]
            s = fo.gerstner.surface(ocean, x, y, 0.5)
            r = np.stack([s.x, s.y, s.z], -1)
            area = np.sum(np.cross(r, np.roll(r, -1, axis=0)), axis=0)
            assert np.allclose(levels[1][q, p], area / np.linalg.norm(area), atol=0.012)


def test_normals_of_a_level_have_length_1_and_the_last_is_up():
    """
    The vector area of a periodic tile is that of the flat one, folded or not: 1e-6 in float32.
    """
    for choppiness in (0.0, 1.0, 4.0):
        ocean = fo.Ocean(
            fo.Sea.from_wind(speed=15.0, fetch=100e3), n=(27, 40), size=80.0, choppiness=choppiness
        )
        frame = ocean.frame(0.0, ("normal", *GEOMETRY))
        levels = mips.normals(frame.normal, tuple(frame[name] for name in GEOMETRY), choppiness)
        for level in levels:
            assert np.max(np.abs(np.linalg.norm(level.astype(float), axis=-1) - 1.0)) < 3e-7
        assert np.allclose(levels[-1], [0.0, 0.0, 1.0], atol=1e-6)


def test_normals_without_choppiness_are_those_of_the_mean_slope():
    frame = fo.Ocean(
        fo.Sea.from_wind(speed=9.0, fetch=50e3), n=16, size=40.0, choppiness=0.0, dtype="float64"
    ).frame(0.0)
    normals = mips.normals(fo.normals(frame), tuple(frame[name] for name in GEOMETRY), 0.0)
    slopes = mips.chain(np.stack([frame.slope_x, frame.slope_y], -1))
    for normal, slope in zip(normals, slopes, strict=True):
        assert np.allclose(-normal[..., :2] / normal[..., 2:], slope, atol=1e-13)
    mean_of_normals = mips.chain(fo.normals(frame))[2]
    assert (
        np.max(np.abs(-mean_of_normals[..., :2] / mean_of_normals[..., 2:] - slopes[2])) > 1e-4
    )  # which would be something else


def test_slopes_beyond_the_tile_are_those_of_a_cartesian_sum():
    """
    Against a plain sum over a Cartesian grid of wavenumbers, 0.04 rad/m wide, outside the tile's
    rectangle and inside the circle.

    Cells that an edge cuts count whole or not at all: 1e-3 of the sum over some ten thousand of
    them.
    """
    sea = fo.Sea.from_wind(speed=10.0, fetch=100e3, direction=30.0)
    grid = Grid.of((48, 30), (24.0, 24.0))  # up to 6.2 rad/m along x and 3.8 along y
    shortest = 2 * np.pi / 12.0
    k = np.arange(-300, 301) * 0.04
    kx, ky = np.meshgrid(k, k)
    reach_x, reach_y = grid.reach
    outside = (np.abs(kx) > (reach_x + 0.5) * grid.dkx) | (np.abs(ky) > (reach_y + 0.5) * grid.dky)
    there = outside & (np.hypot(kx, ky) < 12.0)
    kx, ky = kx[there], ky[there]
    magnitude = np.hypot(kx, ky)
    omega = np.sqrt(9.80665 * magnitude)
    theta = np.arctan2(ky, kx)
    density = np.zeros_like(omega)
    for w in sea.systems:
        from_mean = np.angle(np.exp(1j * (theta - math.radians(w.direction))))
        density += w.spectrum(omega) * w.spreading(omega, from_mean, w.spectrum.peak)
    density *= 0.5 * omega / magnitude**2
    pairs = ((kx, kx), (kx, ky), (ky, ky))
    exact = np.array([np.sum(density * a * b) for a, b in pairs]) * 0.04**2
    assert np.allclose(mips.beyond(sea, grid, shortest), exact, atol=4e-3 * exact.sum())
    assert exact[0] > 1e-3


def test_resolved_and_unresolved_slopes_add_up_to_the_same_sea():
    """
    Resolved and unresolved slopes add up to the same sea, whatever the tile: the mean square slope
    down to 10 cm.
    """
    sea = fo.Sea.from_wind(speed=8.0, fetch=60e3, direction=20.0)
    totals = []
    for n in (32, 96):
        ocean = fo.Ocean(sea, n=n, size=40.0, amplitudes="fixed", dtype="float64")
        w = ocean.modes()
        resolved = np.array(
            [
                np.sum(0.5 * w.amplitude**2 * a * b)
                for a, b in ((w.kx, w.kx), (w.kx, w.ky), (w.ky, w.ky))
            ]
        )
        totals.append((resolved, mips.unresolved_slopes(ocean, 0.1)))
    (coarse, much), (fine, little) = totals
    assert np.sum(much[::2]) > np.sum(little[::2]) > 0.0
    assert np.allclose(coarse + much, fine + little, atol=0.01 * np.sum((fine + little)[::2]))


def test_given_waves_calm_seas_and_fine_tiles_have_no_slopes_beyond():
    assert not mips.unresolved_slopes(fo.Ocean.from_modes([(1, 0, 1.0, 0.0)], n=8, size=20.0)).any()
    with pytest.warns(fo.SeaWarning, match="flat"):
        calm = fo.Sea.from_wind(speed=0.0, fetch=1e4)
    assert not mips.unresolved_slopes(fo.Ocean(calm, n=8, size=20.0)).any()
    ripples = fo.Ocean(
        fo.Sea.from_wind(speed=3.0, fetch=1e4), n=64, size=0.5
    )  # 1.6 cm long, the shortest
    assert not mips.unresolved_slopes(ripples).any()
    narrow = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=8.0),
            spreading=fo.CosinePower(s=1e4),
            direction=33.3,
        )
    )
    beyond = mips.unresolved_slopes(fo.Ocean(narrow, n=16, size=100.0))
    assert beyond[1] / beyond[0] == pytest.approx(
        math.tan(math.radians(33.3)), rel=1e-2
    )  # all along one direction


@pytest.mark.parametrize("direction", [0.0, 33.0])
def test_slopes_beyond_the_tile_of_one_direction_are_those_of_an_integral(direction):
    """
    All slopes along the waves: the integral of k^2 S, by QUADPACK, from the edge of the rectangle
    on; a narrow bell has the same.
    """
    spectrum = fo.JONSWAP.from_wind(speed=10.0, fetch=100e3)
    grid = Grid.of((48, 30), (24.0, 30.0))
    c, s = math.cos(math.radians(direction)), math.sin(math.radians(direction))
    reach_x, reach_y = grid.reach
    edge = min((reach_x + 0.5) * grid.dkx / c, (reach_y + 0.5) * grid.dky / s if s else math.inf)
    low, high = math.sqrt(9.80665 * edge), math.sqrt(9.80665 * 2 * np.pi / 0.05)
    truth = integrate.quad(lambda w: (w * w / 9.80665) ** 2 * float(spectrum(w)), low, high)[0]
    for spreading in (fo.LongCrested(), fo.WrappedNormal(spread=0.1)):
        sea = fo.Sea(fo.WaveSystem(spectrum=spectrum, spreading=spreading, direction=direction))
        assert mips.beyond(sea, grid, 0.05) == pytest.approx(
            truth * np.array([c * c, c * s, s * s]), abs=1e-4 * truth
        )
