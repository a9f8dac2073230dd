"""Loops over pairs of waves and over cells, against their NumPy twins."""

import math

import numpy as np
import pytest

from fftocean.amplitudes import place_modes
from fftocean.bound_waves import ELEVATION, POTENTIAL, SURFACE, BoundWaves
from fftocean.grid import Grid
from fftocean.kernels import bound
from fftocean.physics.second_order import Components, interaction

pytestmark = pytest.mark.nojit
GRID = Grid.of((20, 16), (60.0, 40.0))
# two runs of mx = 1, one of 2, a wave that runs back, and one along y
WAVES = [(1, 1), (1, 2), (1, 3), (1, -2), (2, 0), (2, 1), (-3, 1), (0, 2)]


def waves(depth=5.0):
    rng = np.random.default_rng(2)
    listed = [
        (mx, my, a, phase)
        for (mx, my), a, phase in zip(
            WAVES, rng.uniform(0.05, 0.2, 8), rng.uniform(0.0, 6.0, 8), strict=True
        )
    ]
    return BoundWaves(place_modes(listed, GRID, depth=depth), 0.6, 100, "float64")


def by_pairs(made, kind, t):
    """The spectrum of all ordered pairs of signed components, {(mx, my): value}."""
    p, found = made.parents, {}
    z = p.h0 * np.exp(-1j * p.running * t)
    signed = [
        (s * mx, s * my, s * w, a if s > 0 else np.conj(a))
        for mx, my, w, a in zip(p.mx, p.my, p.omega, z, strict=True)
        for s in (1, -1)
    ]
    for mx1, my1, w1, a1 in signed:
        for mx2, my2, w2, a2 in signed:
            one, two = (
                Components(*(np.array([v]) for v in (mx * GRID.dkx, my * GRID.dky, w)))
                for mx, my, w in ((mx1, my1, w1), (mx2, my2, w2))
            )
            pair = interaction(one, two, made.amplitudes.depth)
            factor = {
                SURFACE: pair.elevation - 0.6 * pair.displaced,
                ELEVATION: pair.elevation,
                POTENTIAL: 1j * pair.potential,
            }[kind]
            key = (mx1 + mx2, my1 + my2)
            found[key] = found.get(key, 0.0) + complex(factor[0]) * a1 * a2
    return found


@pytest.mark.parametrize("depth", [math.inf, 5.0])
@pytest.mark.parametrize("kind", [SURFACE, ELEVATION, POTENTIAL])
def test_all_ordered_pairs(kind, depth):
    """Runs, triangles and folds against a plain sum; rates against differences in time."""
    made, t, h = waves(depth), 1.3, 1e-4
    cells = made.cells(kind, t, (0, 1, 2), beyond=True)
    truth = by_pairs(made, kind, t)
    size = max(abs(v) for v in truth.values())
    seen = 0.0
    for kx, ky, value in zip(cells.kx, cells.ky, cells.values[0], strict=True):
        key = (round(kx / GRID.dkx), round(ky / GRID.dky))
        assert abs(value - 2.0 * truth.get(key, 0.0)) < 1e-14 * size
        seen += abs(value)
    assert seen == pytest.approx(sum(abs(v) for v in truth.values()))  # both halves, once
    early, late = (made.cells(kind, t + step, (0, 1), beyond=True).values for step in (-h, h))
    rates = (late - early) / (2.0 * h)
    assert np.max(np.abs(rates - cells.values[1:])) < 1e-7 * np.max(np.abs(cells.values[2]))


@pytest.mark.parametrize("columns", [1, 3, 11])
def test_folding_into_blocks_of_columns(columns):
    rng = np.random.default_rng(3)
    g = rng.normal(size=(9, 13)) + 1j * rng.normal(size=(9, 13))
    gain, ny, first = rng.normal(size=(11, 10)), 10, 2
    real, imag = np.ones((columns, ny)), np.zeros((columns, ny))
    bound.add_folded(g.real.copy(), g.imag.copy(), first, gain, True, 0.5, real, imag)
    for b in range(columns):
        x = first + b
        for y in range(-4, 5):
            inside = x <= 4
            sums = g[4 + x, 6 + y] + np.conj(g[4 - x, 6 - y]) if inside else 0.0
            expected = 1.0 + 0.5 * gain[x, y % ny] * sums if inside else 1.0
            assert real[b, y % ny] + 1j * imag[b, y % ny] == pytest.approx(expected)
    assert np.all(real[:, 5] == 1.0)  # the Nyquist row


def test_phasors_turn():
    z, f = np.array([1.0 + 2.0j, -0.5j]), np.array([0.3, 2.0])
    out = np.empty((2, 2))
    bound.turn(np.cos(f), np.sin(f), z.real.copy(), z.imag.copy(), *out)
    assert np.allclose(out[0] + 1j * out[1], z * np.exp(-1j * f), rtol=0.0, atol=1e-15)


@pytest.mark.parametrize("depth", [math.inf, 3.0])
def test_sums_over_cells_at_points(depth):
    rng = np.random.default_rng(4)
    kx, ky, x, y = rng.normal(size=(4, 6))
    z = -rng.uniform(0.0, 2.0, 6)
    values = rng.normal(size=(2, 6)) + 1j * rng.normal(size=(2, 6))
    parts = np.stack([values.real, values.imag], axis=1)
    wave = np.exp(1j * (np.outer(x, kx) + np.outer(y, ky)))
    out = np.empty((6, 2))
    bound.sum_cells(kx, ky, parts, x, y, out)
    assert np.allclose(out.T, (values @ wave.T).real, rtol=0.0, atol=1e-13)
    k = np.hypot(kx, ky)
    if math.isinf(depth):
        level = slope = np.exp(np.outer(z, k))
    else:
        level = np.cosh(k * (z[:, None] + depth)) / np.cosh(k * depth)
        slope = np.sinh(k * (z[:, None] + depth)) / np.cosh(k * depth)
    out = np.empty((6, 7))
    bound.sum_below(kx, ky, parts, depth, x, y, z, out)
    for i, v in enumerate(values):
        truth = [
            ((wave * level) @ (1j * kx * v)).real,
            ((wave * level) @ (1j * ky * v)).real,
            ((wave * slope) @ (k * v)).real,
        ]
        assert np.allclose(out.T[3 * i : 3 * i + 3], truth, rtol=0.0, atol=1e-13)
    assert np.allclose(out[:, 6], -((wave * level) @ values[1]).real, rtol=0.0, atol=1e-13)
