"""Splines, their inversion and the folds, against scipy's splines and against plain geometry."""

import numpy as np
import pytest
from scipy.interpolate import BSpline

from fftocean.kernels import resample

pytestmark = pytest.mark.nojit
RNG = np.random.default_rng(8)


def test_weights_and_rates_are_scipy_s_quintic():
    spline = BSpline.basis_element(np.arange(-3.0, 4.0), extrapolate=False)
    w = np.empty(6)
    for f in (0.0, 1e-9, 0.25, 0.5, 0.9, 1.0 - 1e-12):
        at = f + np.array([2.0, 1.0, 0.0, -1.0, -2.0, -3.0])
        resample.weights(f, w)
        assert np.allclose(w, np.nan_to_num(spline(at)), atol=1e-15)
        assert np.sum(w) == pytest.approx(1.0, abs=1e-15)
        resample.rates(f, w)
        assert np.allclose(w, np.nan_to_num(spline.derivative()(at)), atol=1e-15)


def test_sample_wraps_round_every_edge():
    """
    A sum of 36 shares, each sample found by its remainder: twins in numpy, far outside the grid,
    and on a grid of one sample.
    """
    for rows, columns in ((7, 5), (2, 9), (1, 1)):
        coefficients = RNG.standard_normal((rows, columns, 3)).astype(np.float32)
        u, v = RNG.uniform(-20.0, 20.0, (2, 11))
        out = np.empty((11, 3))
        resample.sample(coefficients, u, v, out)
        wu, wv = np.empty(6), np.empty(6)
        for p in range(11):
            i, j = int(np.floor(u[p])), int(np.floor(v[p]))
            resample.weights(u[p] - i, wu)
            resample.weights(v[p] - j, wv)
            around = coefficients[
                np.ix_((j + np.arange(-2, 4)) % rows, (i + np.arange(-2, 4)) % columns)
            ]
            assert np.allclose(
                out[p], np.einsum("b,a,baf->f", wv, wu, around.astype(float)), atol=1e-14
            )


def test_invert_finds_the_position():
    """
    Positions are recovered: random gentle shifts, positions anywhere; the residual is what remains
    of the equation.
    """
    shift = 0.3 * RNG.standard_normal((9, 12, 2))
    u, v = RNG.uniform(-5.0, 20.0, (2, 40))
    moved = np.empty((40, 2))
    resample.sample(shift, u, v, moved)
    x, y = u + moved[:, 0], v + moved[:, 1]
    found_u, found_v, residual = x.copy(), y.copy(), np.empty(40)
    resample.invert(shift, x, y, 30, 1e-13, found_u, found_v, residual)
    assert np.max(residual) < 1e-13
    assert np.allclose(found_u, u, atol=1e-12)
    assert np.allclose(found_v, v, atol=1e-12)
    resample.invert(
        shift, x, y, 0, 1e-13, found_u, found_v, residual
    )  # no step: the start is measured and kept
    assert np.max(residual) < 1e-13


def test_invert_keeps_the_best_where_there_is_no_position():
    """
    x = u - 2.4 sin u covers all, but from a fold's rim Newton runs off; what is kept is never worse
    than the start.
    """
    u = np.arange(12.0)
    shift = np.zeros((1, 12, 2))
    shift[0, :, 0] = -2.4 * np.sin(2 * np.pi * u / 12)
    x, start = np.full(50, 3.05), RNG.uniform(0.0, 12.0, 50)
    at, before, after = start.copy(), np.empty(50), np.empty(50)
    y = np.zeros(50)
    resample.invert(shift, x, y, 0, 1e-13, at.copy(), y.copy(), before)
    resample.invert(shift, x, y, 8, 1e-13, at, y.copy(), after)
    assert np.all(after <= before)
    assert np.all(np.isfinite(at))


def places(tall, wide):
    u, v, top = (
        np.full((tall, wide), np.nan),
        np.full((tall, wide), np.nan),
        np.full((tall, wide), -np.inf),
    )
    return u, v, top, np.zeros((tall, wide), dtype=bool)


@pytest.mark.parametrize(("east", "north"), [(0.0, 0.0), (0.4, -0.7), (-13.3, 29.9)])
def test_uncover_still_water_that_was_pushed(east, north):
    """
    All water moved alike: each place finds the water that was that far away, on the lap that lies
    next to it, and no fold.
    """
    rows, columns = 6, 8
    v, u = np.meshgrid(np.arange(6.0), np.arange(8.0), indexing="ij")
    z = RNG.standard_normal((rows, columns))
    found_u, found_v, top, folded = places(3, 4)
    resample.uncover(u + east, v + north, z, 2, found_u, found_v, top, folded)
    assert not folded.any()
    assert np.allclose(found_u + east, u[::2, ::2], atol=1e-9)
    assert np.allclose(found_v + north, v[::2, ::2], atol=1e-9)
    if east == north == 0.0:
        assert np.allclose(
            top, z[::2, ::2], atol=1e-8
        )  # a triangle reaches 1e-9 beyond its corners


def test_uncover_takes_the_highest_of_three_sheets():
    """
    x = u - 3 sin u on a row of 64: sheets are found by brute force on a dense curve; the fold is
    where there are three.
    """
    n = 64
    u = np.arange(n, dtype=float)
    k = 2 * np.pi / n
    x, z = u - 1.8 / k * np.sin(k * u), np.cos(k * u)
    found_u, found_v, top, folded = places(1, n)
    resample.uncover(x[None, :], np.zeros((1, n)), z[None, :], 1, found_u, found_v, top, folded)
    dense = np.linspace(-n, 2 * n, 600_001)
    where, height = dense - 1.8 / k * np.sin(k * dense), np.cos(k * dense)
    for place in range(n):
        crossing = np.flatnonzero(np.diff(np.sign(where - place - 1e-7)))
        assert folded[0, place] == (crossing.size > 1)
        assert top[0, place] == pytest.approx(
            np.max(height[crossing]), abs=5e-3
        )  # chords of the curve
    assert 5 < folded.sum() < n / 2


def test_world_slopes():
    """
    The plane through both tangents; upright and overhanging water has the steepest slope; without a
    normal it is level.
    """
    sx, sy, xx, xy, yy = 0.4 * RNG.standard_normal((5, 4, 5))
    xx, yy = np.abs(xx), np.abs(yy)
    out = np.empty((2, 4, 5))
    resample.world_slopes(sx, sy, xx, 0.1 * xy, yy, 1.2, 1e3, *out)
    tangents = np.stack(
        [np.stack([1 + 1.2 * xx, 0.12 * xy], -1), np.stack([0.12 * xy, 1 + 1.2 * yy], -1)], -2
    )
    exact = np.linalg.solve(tangents, np.stack([sx, sy], -1)[..., None])[..., 0]
    assert np.allclose(out, np.moveaxis(exact, -1, 0), atol=1e-13)
    one, zero = np.ones((1, 1)), np.zeros((1, 1))
    for stretch in (-one, -1.5 * one):
        resample.world_slopes(one, zero, stretch, zero, zero, 1.0, 50.0, *out[:, :1, :1])
        assert np.allclose(out[:, 0, 0], [50.0, 0.0])
    resample.world_slopes(zero, zero, -one, zero, -one, 1.0, 50.0, *out[:, :1, :1])
    assert np.array_equal(out[:, 0, 0], [0.0, 0.0])
