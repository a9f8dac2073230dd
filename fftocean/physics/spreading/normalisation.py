"""Integral of a spreading function over the circle, by Gauss quadrature at each frequency."""

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

_DEGREE = 16  # of the table's polynomials
_WIDEST = 0.5  # panel of the table, in ln(omega/omega_p)
_HALVINGS = 23  # down to a panel 6e-8 wide, which is a mere edge


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
    """
    Return the integral over theta at each of a list of frequencies; in blocks, to spare memory.

    Each is a sum of its own, so that its bits depend on no other frequency of the list.
    """
    theta, weights = _panels(breaks, order)
    out = np.empty(omega.size)
    for start in range(0, omega.size, 512):
        some = omega[start : start + 512]
        frequency = np.repeat(some[:, None], theta.size, axis=1)
        values = np.asarray(function(frequency, np.tile(theta, (some.size, 1)), peak))
        out[start : start + 512] = np.sum(np.ascontiguousarray(values) * weights, axis=1)
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
            "the spreading must have an integral over theta that quadrature can find: more than 0, "
            f"and with every kink named in breaks; "
            f"got {coarse[i]:.12g} and {fine[i]:.12g} at omega = {probes[i]:g} rad/s"
        )
    values = interpolated_integrals(function, unique, peak, breaks)
    if not np.all(values > 0.0):
        raise ParameterError(
            "the spreading must have an integral over theta that is more than 0, got "
            f"{np.min(values):g} at omega = {unique[np.argmin(values)]:g} rad/s"
        )
    return values[place].reshape(omega.shape)


def interpolated_integrals(
    function: Function, omega: Real, peak: float, breaks: tuple[float, ...]
) -> Real:
    """
    Return the integral at many frequencies, by Chebyshev interpolation in ln omega.

    The panels are `_WIDEST` wide, counted from the peak, and are halved until the polynomial holds:
    until its last three coefficients are under 1e-13 of the first. Which panel a frequency lies in,
    and so the bits of its integral, depends on no other frequency of the list. Both ends of a panel
    are nodes, so a jump of the base (Donelan-Banner steps at 0.95) cannot hide beyond the last one;
    what lies in a panel that does not hold after `_HALVINGS` is integrated one by one.
    """
    u = np.log(omega / peak)
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
    out: Real = np.empty(u.shape)
    pending = np.arange(u.size)
    for halvings in range(_HALVINGS):
        width = _WIDEST * 0.5**halvings  # a power of 2: panels of all levels have exact ends
        number, place = np.unique(np.floor(u[pending] / width), return_inverse=True)
        middle = (number + 0.5) * width
        nodes = peak * np.exp(middle[:, None] + 0.5 * width * x)
        values = integrals(function, nodes.ravel(), peak, breaks).reshape(nodes.shape)
        c = np.sum(values[:, None, :] * to_coefficients, axis=2)
        holds = np.max(np.abs(c[:, -3:]), axis=1) <= 1e-13 * np.abs(c[:, 0])
        done = holds[place]
        inside, panel = pending[done], place[done]
        out[inside] = np.polynomial.chebyshev.chebval(
            (u[inside] - middle[panel]) / (0.5 * width), c[panel].T, tensor=False
        )
        pending = pending[~done]
        if not pending.size:
            break
    out[pending] = integrals(function, omega[pending], peak, breaks)
    return out
