"""
The kernels of queries: reduction far away, the inversion of displacements that are known in closed
form, sums against NumPy.
"""

import math

import numpy as np
import pytest
from scipy import optimize

from fftocean.kernels import interpolate, query

pytestmark = pytest.mark.nojit
RNG = np.random.default_rng(3)
NO_TEXELS = np.zeros((0, 3), np.int64), np.zeros(0)


def invert(
    waves, x, y, choppiness, aim=1e-14, limit=1e-9, reach=5.0, sizes=((np.inf, np.inf),), first=None
):
    n = len(x)
    sizes = np.array(sizes, dtype=float)
    first = np.array([0, waves.shape[1]]) if first is None else first
    offsets, (heights, residuals, jacobians) = np.empty((n, 2)), np.empty((3, n))
    query.invert(
        query.WAVES,
        tuple(query.Tiles(sizes, *NO_TEXELS, first, waves)),
        np.asarray(x, float),
        np.asarray(y, float),
        tuple(query.Search(choppiness, aim, limit, reach)),
        np.empty(sizes.shape),
        tuple(query.Found(offsets, heights, residuals, jacobians)),
    )
    return offsets, heights, residuals, jacobians


@pytest.mark.parametrize("x", [0.0, 3.5, -3.5, 1e6 + 0.25, -1e9, 2.0**60, 1e300])
@pytest.mark.parametrize("size", [10.0, 0.7, 3e5])
def test_reduction(x, size):
    """
    In the first period, and a whole number of periods away: by Python's own remainder, to the
    rounding of x; beyond 2^52 exactly.
    """
    reduced = query.reduced(x, size)
    rounding = 2 * np.spacing(abs(x) if abs(x) < query.FAR * size else size)
    if abs(x) < query.FAR * size:  # floor, not trunc: below 0, too
        assert -rounding <= reduced <= size + rounding
    else:
        assert abs(reduced) <= size
    apart = (reduced - math.fmod(x, size)) / size
    assert abs(apart - round(apart)) * size <= rounding
    assert query.reduced(x, np.inf) == x


@pytest.mark.parametrize("steepness", [0.1, 0.6, 0.99])
def test_one_wave_against_a_bracketed_root(steepness):
    """
    x0 - a sin(k x0) = x has one root while a k < 1: scipy's Brent finds it without a derivative.
    """
    k = 0.7
    a = steepness / k
    waves = np.array([[k], [0.0], [a], [a / k], [0.0]])
    x = np.linspace(-9.0, 9.0, 41)
    offsets, heights, residuals, jacobians = invert(waves, x, 0.0 * x, 1.0)
    for p, point in enumerate(x):
        x0 = optimize.brentq(
            lambda q, point=point: q - a * np.sin(k * q) - point,
            point - 2 * a,
            point + 2 * a,
            xtol=1e-15,
        )
        slack = 1e-13 / (1 - steepness)  # the root's own condition
        assert point + offsets[p, 0] == pytest.approx(x0, abs=slack)
        assert heights[p] == pytest.approx(a * np.cos(k * x0), abs=slack)
        assert jacobians[p] <= 1 - steepness * np.cos(k * x0) + 10 * slack  # the least on the way
    assert np.max(residuals) < 1e-13
    assert np.all(jacobians > 0.0)


@pytest.mark.parametrize("steepness", [1.0, 1.3, 2.0, 4.0])
def test_folded_waves_still_have_water_everywhere(steepness):
    """
    A periodic displacement cannot leave a hole: an answer is found at every point, crests included,
    and its residual is true.
    """
    k = 1.0
    waves = np.array(
        [[k, 0.3], [0.0, 0.8], [steepness, 0.4], [steepness / k, 0.4 / 0.73], [0.0, 1.0]]
    )
    x, y = RNG.uniform(-20, 20, (2, 500))
    x[:50], y[:50] = np.linspace(-0.5, 0.5, 50), 0.0
    offsets, _, residuals, _ = invert(waves, x, y, 1.0, aim=1e-11)
    x0, y0 = x + offsets[:, 0], y + offsets[:, 1]
    f = waves[0][:, None] * x0 + waves[1][:, None] * y0 - waves[4][:, None]
    potential = waves[3][:, None] * np.sin(f)
    apart = np.hypot(
        x0 - np.sum(waves[0][:, None] * potential, 0) - x,
        y0 - np.sum(waves[1][:, None] * potential, 0) - y,
    )
    assert np.max(np.abs(apart - residuals)) < 1e-13
    assert np.max(residuals) < 1e-9


@pytest.mark.parametrize("steepness", [1.1, 1.5, 2.0])
def test_every_folded_point_is_flagged(steepness):
    """
    x0 - a sin(k x0) turns back at cos(k x0) = 1/(a k): within that turning point's x there are
    three answers, and the least Jacobian on the way is negative, up to twice the steepness that
    folds. Beyond, but for a strip beside the fold, it is not.
    """
    waves = np.array([[1.0], [0.0], [steepness], [steepness], [0.0]])
    turn = np.arccos(1.0 / steepness)
    width = steepness * np.sin(turn) - turn
    x = np.linspace(-np.pi, np.pi, 301)
    *_, jacobians = invert(waves, x, 0.0 * x, 1.0)
    assert np.all(jacobians[np.abs(x) < width] < 0.0)
    assert np.all(jacobians[np.abs(x) > max(2 * turn, width + turn)] > 0.0)


def test_texels_and_waves_of_several_tiles_add_up():
    """
    A wave on each of two tiles: the kernel that interpolates finds what the one that sums does, to
    the spline's error on 64 samples.
    """
    n, sizes = 64, np.array([[20.0, 20.0], [7.0, 7.0]])
    k = 2 * np.pi / sizes[:, 0]
    waves = np.array([k, 0 * k, [0.5, 0.1], 0.5 * np.array([0.5, 0.1]) / k, [0.3, 0.7]])
    flat = []
    for i in range(2):
        f = k[i] * np.arange(n) * sizes[i, 0] / n - waves[4, i]
        response = (2 + np.cos(2 * np.pi / n)) / 3
        row = (
            np.stack(
                [-waves[3, i] * k[i] * np.sin(f), 0 * f, waves[2, i] * np.cos(f), 0 * f], axis=-1
            )
            / response
        )
        tile = np.pad(np.tile(row, (n, 1, 1)), ((1, 2), (1, 2), (0, 0)), mode="wrap")
        flat.append(tile.ravel())
    layout = np.array([[0, n, n], [(n + 3) ** 2, n, n]])
    x, y = RNG.uniform(-50, 50, (2, 30))
    expected = invert(waves, x, y, 1.0, sizes=sizes, first=np.array([0, 1, 2]))
    offsets, (heights, residuals, jacobians) = np.empty((30, 2)), np.empty((3, 30))
    first = np.zeros(3, np.int64)
    query.invert(
        query.SPLINE,
        tuple(query.Tiles(sizes, layout, np.concatenate(flat), first, np.zeros((5, 0)))),
        x,
        y,
        tuple(query.Search(choppiness=1.0, aim=1e-13, limit=1e-9, reach=1.0)),
        np.empty((2, 2)),
        tuple(query.Found(offsets, heights, residuals, jacobians)),
    )
    assert (
        np.max(np.abs(offsets - expected[0])) < 1e-5
    )  # (2 pi/64)^4/384 of the amplitude, and a little more off the texels
    assert np.max(np.abs(heights - expected[1])) < 1e-5
    assert np.max(residuals) < 1e-12


def test_sums_against_numpy():
    m = 6
    kx, ky, a, start, omega = RNG.uniform(0.2, 1.0, (5, m))
    potential = 0.7 * a / np.hypot(kx, ky)
    waves = np.array([kx, ky, a, potential, start])
    x, y = RNG.uniform(-5, 5, (2, 7))
    offsets = RNG.uniform(-1, 1, (7, 2))
    tiles = tuple(query.Tiles(np.full((1, 2), np.inf), *NO_TEXELS, np.array([0, m]), waves))
    origin = np.empty((1, 2))
    out = np.empty((7, 14))
    query.sum_waves(tiles, omega, x, y, offsets, origin, out)
    f = np.outer(x + offsets[:, 0], kx) + np.outer(y + offsets[:, 1], ky) - start
    c, s = np.cos(f), np.sin(f)
    columns = [
        -kx * a * s,
        -ky * a * s,
        -kx * kx * potential * c,
        -kx * ky * potential * c,
        -ky * ky * potential * c,
    ]
    columns += [-kx * potential * s, -ky * potential * s, a * c]
    columns += [omega * kx * potential * c, omega * ky * potential * c, omega * a * s]
    columns += [omega**2 * kx * potential * s, omega**2 * ky * potential * s, -(omega**2) * a * c]
    assert (
        np.max(np.abs(out - np.stack([np.sum(column, axis=1) for column in columns], axis=-1)))
        < 1e-13
    )


def test_what_is_not_finite_is_nan():
    waves = np.array([[1.0], [0.0], [0.1], [0.1], [0.0]])
    x = np.array([0.0, np.nan, np.inf, 0.0])
    offsets, heights, residuals, jacobians = invert(
        waves, x, np.array([0.0, 0.0, 0.0, -np.inf]), 1.0
    )
    for found in (offsets[:, 0], heights, residuals, jacobians):
        assert np.array_equal(np.isnan(found), [False, True, True, True])


def test_newton_s_step_solves_the_linear_problem():
    """
    With D linear the step lands on the root: against NumPy's solver; and who is near enough leaves
    with what it has.
    """
    n, c, block = 5, 1.3, interpolate.BLOCK
    moved, at, gradient = (
        RNG.uniform(-1, 1, (2, block)),
        RNG.uniform(-1, 1, (n, 2)),
        RNG.uniform(-0.2, 0.2, (n, 2, 2)),
    )
    workspace = np.zeros(interpolate.ROWS * block)
    rows = workspace.reshape(-1, block)
    s = moved[:, :n].T.copy()
    rows[2:4, :n], rows[4, :n], rows[5:9, :n] = at.T, np.arange(n), gradient.reshape(n, 4).T
    points, offsets, (heights, residuals), jacobians = (
        np.arange(block),
        np.zeros((n, 2)),
        np.zeros((2, n)),
        np.full(n, np.inf),
    )
    rows[2:4, 2] = -s[2] / c  # this one is there
    at[2] = -s[2] / c
    buffers = query.Workspace(np.empty((1, 2, block)), moved, workspace, points)
    found = query.Found(offsets, heights, residuals, jacobians)
    kept = query._newton_step(c, 1e-9, 0, n, buffers, found)
    assert kept == 4
    assert list(points[:4]) == [0, 1, 3, 4]
    assert np.array_equal(offsets[2], s[2])
    assert heights[2] == 2.0
    full = np.eye(2) + c * gradient
    assert np.allclose(jacobians, np.linalg.det(full), rtol=1e-13)
    for q, p in enumerate(points[:4]):
        assert np.allclose(
            moved[:, q], s[p] - np.linalg.solve(full[p], s[p] + c * at[p]), rtol=1e-12
        )
