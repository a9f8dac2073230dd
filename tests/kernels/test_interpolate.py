"""
Periodic interpolation: against scipy's splines, polynomials that must come out exactly, and the
seam.
"""

import numpy as np
import pytest
from scipy import ndimage

from fftocean.kernels import interpolate

pytestmark = pytest.mark.nojit
RNG = np.random.default_rng(1)
NY, NX, CHANNELS = 6, 9, 5


def texels(dtype=np.float64, shape=(NY, NX)):
    return RNG.standard_normal((*shape, CHANNELS)).astype(dtype)


def points(count=40, far=3.0):
    return RNG.uniform(-far * NX, far * NX, count), RNG.uniform(-far * NY, far * NY, count)


def by_scipy(field, u, v, order, **options):
    return ndimage.map_coordinates(
        field.astype(float), [v, u], order=order, mode="grid-wrap", **options
    )


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("order", [1, 3])
def test_against_scipy(order, dtype):
    """Round-off: ten operations on values up to 3, and the wrap of u, up to 27."""
    field, (u, v) = texels(dtype), points()
    out = np.ones((u.size, CHANNELS))  # what is there is added to
    if order == 1:
        interpolate.bilinear(field, u, v, out)
    else:
        interpolate.bicubic(field, u, v, True, out)
    for c in range(CHANNELS):
        expected = by_scipy(
            field[:, :, c], u, v, order, prefilter=False
        )  # coefficients, as ours are
        assert np.max(np.abs(out[:, c] - 1.0 - expected)) < 1e-13


def test_spline_goes_through_what_its_response_was_divided_out_of():
    """
    Waves over `spline_response` are the coefficients that scipy's recursive prefilter finds; the
    prefilter's own error is 1e-15.
    """
    x = np.arange(NX)
    wave = np.cos(2 * np.pi * 2 * x / NX + 0.3)
    ours = wave / interpolate.spline_response(2 / NX)
    assert np.max(np.abs(ours - ndimage.spline_filter1d(wave, order=3, mode="grid-wrap"))) < 1e-13


def test_catmull_rom_goes_through_its_texels_and_reproduces_a_parabola():
    field = texels()
    i, j = (a.ravel().astype(float) for a in np.meshgrid(np.arange(NX), np.arange(NY)))
    out = np.zeros((i.size, CHANNELS))
    interpolate.bicubic(field, i, j, False, out)
    assert np.array_equal(out, field.reshape(-1, CHANNELS))
    parabola = (
        np.arange(NX)[None, :] ** 2.0 - 3.0 * np.arange(NY)[:, None]
    )  # away from the seam, where it is no parabola
    u, v = RNG.uniform(1, NX - 2, 30), RNG.uniform(1, NY - 2, 30)
    out = np.zeros((30, 1))
    interpolate.bicubic(parabola[:, :, None], u, v, False, out)
    assert np.max(np.abs(out[:, 0] - (u**2 - 3.0 * v))) < 1e-12


@pytest.mark.parametrize("shape", [(1, 1), (1, 4), (2, 3)])
@pytest.mark.parametrize("spline", [False, True])
def test_tiles_smaller_than_the_four_texels(shape, spline):
    """The neighbours of a texel may be itself: as if the tile were laid out three times."""
    field = texels(shape=shape)
    many = np.ascontiguousarray(np.tile(field, (5, 5, 1)))
    u, v = RNG.uniform(0, shape[1], 20), RNG.uniform(0, shape[0], 20)
    small, large = np.zeros((2, 20, CHANNELS))
    interpolate.bicubic(field, u, v, spline, small)
    interpolate.bicubic(many, u + 2 * shape[1], v + 2 * shape[0], spline, large)
    assert np.max(np.abs(small - large)) < 1e-13
    small, large = np.zeros((2, 20, CHANNELS))
    interpolate.bilinear(field, u, v, small)
    interpolate.bilinear(many, u + 2 * shape[1], v + 2 * shape[0], large)
    assert np.max(np.abs(small - large)) < 1e-13


def test_what_is_not_finite_stays_alone():
    field = texels()
    u, v = np.array([1.5, np.nan, 2.0, np.inf, 1.5]), np.array([0.5, 1.0, -np.inf, 1.0, 0.5])
    for run in (
        lambda out: interpolate.bilinear(field, u, v, out),
        lambda out: interpolate.bicubic(field, u, v, True, out),
    ):
        out = np.zeros((5, CHANNELS))
        run(out)
        assert np.all(np.isnan(out[1:4]))
        assert np.all(np.isfinite(out[[0, 4]]))
        assert np.array_equal(out[0], out[4])


def framed(field):
    """Return a tile in a frame of its repetitions, by NumPy."""
    return np.pad(field, ((1, 2), (1, 2), (0, 0)), mode="wrap")


@pytest.mark.parametrize("shape", [(NY, NX), (2, 5), (5, 1)])
def test_a_frame_repeats_the_tile(shape):
    field = RNG.standard_normal((*shape, 4))
    expected = framed(field)
    given = np.full_like(expected, np.nan)
    given[1:-2, 1:-2] = field
    interpolate.frame_texels(given)
    assert given.shape == (shape[0] + interpolate.FRAME, shape[1] + interpolate.FRAME, 4)
    assert np.array_equal(given, expected)


@pytest.mark.parametrize("far", [0.9, 3.0])  # in periods: a tile can be smaller than an offset
@pytest.mark.parametrize("spline", [False, True])
def test_gradients_are_those_of_the_interpolant(spline, far):
    """
    Value from the general routine, slopes from its central differences: h^2 of a third derivative,
    h = 1e-5, and rounding / h.
    """
    field = np.ascontiguousarray(RNG.standard_normal((NY, NX, 4)))
    # another tile before it
    flat = np.concatenate([np.full(7 * 4, np.nan), framed(field).ravel()])
    gradient = interpolate.spline_gradient if spline else interpolate.bilinear_gradient

    def at(u, v):
        out = np.zeros((1, 4))
        if spline:
            interpolate.bicubic(field, np.array([u]), np.array([v]), True, out)
        else:
            interpolate.bilinear(field, np.array([u]), np.array([v]), out)
        return out[0]

    h = 1e-5
    for u, v in zip(*points(10, far), strict=True):
        a, b, c, a_u, a_v, b_u, b_v = gradient(flat, 7, NX, NY, u, v)
        assert np.max(np.abs(at(u, v)[:3] - [a, b, c])) < 1e-13
        along, across = (
            (at(u + h, v) - at(u - h, v)) / (2 * h),
            (at(u, v + h) - at(u, v - h)) / (2 * h),
        )
        assert np.max(np.abs(along[:2] - [a_u, b_u])) < 1e-8
        assert np.max(np.abs(across[:2] - [a_v, b_v])) < 1e-8


@pytest.mark.parametrize("far", [0.9, 3.0])
@pytest.mark.parametrize("spline", [False, True])
def test_many_gradients_at_once_are_those_of_one(spline, far):
    """
    The same numbers as point by point, added to what is there; round-off of another order of sums.
    """
    flat = framed(RNG.standard_normal((NY, NX, 4))).ravel()
    count, block = 50, interpolate.BLOCK
    one, many = (
        (interpolate.spline_gradient, interpolate.spline_gradients)
        if spline
        else (interpolate.bilinear_gradient, interpolate.bilinear_gradients)
    )
    workspace = np.full(interpolate.ROWS * block, 7.0)
    rows = workspace.reshape(-1, block)
    rows[:2, :count] = points(count, far)
    many(flat, 0, NX, NY, 2.0, 3.0, count, workspace)
    expected = (
        np.array([one(flat, 0, NX, NY, u, v) for u, v in rows[:2, :count].T]).T
        * np.array([[1, 1, 1, 2, 3, 2, 3]]).T
    )
    assert np.max(np.abs(rows[2:9, :count] - 7.0 - expected)) < 1e-13
    assert np.all(rows[2:9, count:] == 7.0)
