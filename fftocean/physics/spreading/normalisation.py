"""Integral of a spreading function over the circle, by quadrature and by interpolation between frequencies."""

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError
from fftocean.physics.spreading.base import wrapped

Function = Callable[[Real, Real, float], RealLike]
"""f(omega, theta, peak) >= 0, of any size."""

Panels = tuple[Real, Real]
"""Nodes theta [rad] and their weights [rad]."""

_MANY = 1024  # frequencies from which on a table is cheaper

_DEGREE = 16  # of the table's polynomials


@lru_cache(maxsize=64)
def _panels(breaks: tuple[float, ...], order: int) -> Panels:
    """
    Return Gauss-Legendre nodes and weights on [-pi, pi], in panels that halve ten times toward 0,
    twelve toward every break.

    At +-pi the root of a cosine ends in (pi - |theta|)^2s, which no polynomial follows where s is
    small: there theta runs as the sixth power of the node, and the root becomes smooth.
    """
    edges = np.pi * np.concatenate([[0.0, 0.75, 0.875, 1.0], 0.5 ** np.arange(1, 11)])
    named = wrapped(np.array(breaks, dtype=np.float64))
    closer = np.concatenate([[0.0], np.pi * 0.5 ** np.arange(1, 13)])
    toward = wrapped(
        np.concatenate([named + side * closer[:, None] for side in (-1.0, 1.0)], axis=None)
    )
    edges = np.unique(np.concatenate([edges, -edges, toward]))
    edges = edges[np.concatenate([[True], np.diff(edges) > 1e-12])]
    edges[-1] = np.pi
    x, w = np.polynomial.legendre.leggauss(order)
    middle, half = 0.5 * (edges[1:-2] + edges[2:-1]), 0.5 * np.diff(edges[1:-1])
    theta, weights = [(middle[:, None] + half[:, None] * x).ravel()], [(half[:, None] * w).ravel()]
    t = 0.5 * (1.0 + x)
    for end, inner in ((edges[0], edges[1]), (edges[-1], edges[-2])):
        theta.append(end + (inner - end) * t**6)
        weights.append(0.5 * w * 6.0 * t**5 * abs(inner - end))
    return np.concatenate(theta), np.concatenate(weights)


def integrals(
    function: Function, omega: Real, peak: float, breaks: tuple[float, ...], order: int = 16
) -> Real:
    """The integral over theta at each of a list of frequencies; in blocks, to spare memory."""
    theta, weights = _panels(breaks, order)
    out = np.empty(omega.size)
    for start in range(0, omega.size, 512):
        some = omega[start : start + 512]
        frequency, angle = np.broadcast_arrays(some[:, None], theta)
        out[start : start + 512] = np.asarray(function(frequency, angle, peak)) @ weights
    return out


def circle_integral(
    function: Function, omega: Real, peak: float, breaks: tuple[float, ...]
) -> Real:
    """
    Return the integral of `function` over theta at every `omega`, shaped like it.

    Raises:
        ParameterError: the function is 0 all round, or has an edge that the quadrature sees and
            `breaks` does not name.
    """
    unique, place = np.unique(omega, return_inverse=True)
    if not unique.size:
        return np.ones_like(omega)
    probes = unique[:: max(unique.size // 8, 1)]
    coarse, fine = (integrals(function, probes, peak, breaks, order) for order in (16, 23))
    wrong = ~(np.abs(coarse - fine) <= 1e-11 * fine) | ~(fine > 0.0)
    if np.any(wrong):
        i = int(np.argmax(wrong))
        raise ParameterError(
            "the spreading must have an integral over theta that quadrature can find: more than 0, and with every kink named in "
            f"breaks; got {coarse[i]:.12g} and {fine[i]:.12g} at omega = {probes[i]:g} rad/s"
        )
    few = unique.size <= _MANY
    values = (
        integrals(function, unique, peak, breaks)
        if few
        else interpolated_integrals(function, unique, peak, breaks)
    )
    return values[place].reshape(omega.shape)


def interpolated_integrals(
    function: Function, omega: Real, peak: float, breaks: tuple[float, ...]
) -> Real:
    """
    The integral at many frequencies (ascending), by Chebyshev interpolation in ln omega on panels
    bisected until it holds.

    A panel holds when its last three coefficients are under 1e-13 of the first. Both its ends are
    nodes, so a jump of the base (Donelan-Banner steps at 0.95) cannot hide beyond the last one; it
    is bisected down to a width of 1e-7, where the few frequencies inside are integrated one by one.
    """
    u = np.log(omega)
    j = np.arange(_DEGREE + 1)
    x = np.cos(np.pi * j / _DEGREE)
    ends_halved = np.where((j == 0) | (j == _DEGREE), 0.5, 1.0)
    to_coefficients = (
        np.cos(np.pi / _DEGREE * np.outer(j, j))
        * ends_halved
        * ends_halved[:, None]
        * 2.0
        / _DEGREE
    )
    out = np.empty_like(u)
    pending = np.array([[u[0], u[-1]]])
    while pending.size:
        middle, half = 0.5 * pending.sum(axis=1), 0.5 * (pending[:, 1] - pending[:, 0])
        first, last = (
            np.searchsorted(u, pending[:, 0], "left"),
            np.searchsorted(u, pending[:, 1], "left"),
        )
        last = np.where(pending[:, 1] >= u[-1], u.size, last)
        # A panel with fewer frequencies than nodes is not worth a table; nor is one that has become
        # a mere edge.
        direct = (last - first <= _DEGREE) | (half <= 0.5e-7)
        for i in np.flatnonzero(direct):
            out[first[i] : last[i]] = integrals(function, omega[first[i] : last[i]], peak, breaks)
        keep = ~direct
        middle, half, first, last, pending = (
            middle[keep],
            half[keep],
            first[keep],
            last[keep],
            pending[keep],
        )
        if not half.size:
            break
        nodes = np.exp(middle[:, None] + half[:, None] * x)
        c = (
            integrals(function, nodes.ravel(), peak, breaks).reshape(nodes.shape)
            @ to_coefficients.T
        )
        holds = np.max(np.abs(c[:, -3:]), axis=1) <= 1e-13 * np.abs(c[:, 0])
        for i in np.flatnonzero(holds):
            inside = slice(first[i], last[i])
            out[inside] = np.polynomial.chebyshev.chebval((u[inside] - middle[i]) / half[i], c[i])
        broken, split = pending[~holds], middle[~holds]
        pending = np.concatenate(
            [np.column_stack([broken[:, 0], split]), np.column_stack([split, broken[:, 1]])]
        )
    return out
