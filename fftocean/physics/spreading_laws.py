"""
D(omega, theta) beyond cos^2 and Donelan-Banner: what the wind's age makes of it, plain bells,
swell, and anything you write.

Two powers of a cosine are in use and often mixed up. `CosinePower(s)` is cos^2s(theta/2), all round
the compass; `CosineN(n)` is cos^n(theta), front half only. They are different curves, also where
their widths agree.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Protocol, runtime_checkable

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.limits import ANGLE, FRACTION, SPREADING_EXPONENT, WIND_SPEED, Quantity, keep_checked
from fftocean.physics.spreading import (
    CosinePower,
    DonelanBanner,
    Spreading,
    cosine_2s,
    require_spreading,
    wrapped,
)

SPREAD = Quantity("degrees", 0.1, 180.0)

SHARPEST = 1e4
"""
The exponent s at which the laws of the wind are held: 0.8 degrees wide, narrower than any swell
that was ever measured.
"""

Function = Callable[[Real, Real, float], RealLike]
"""f(omega, theta, peak) >= 0, of any size."""


@runtime_checkable
class _CosinePowerLaw(Protocol):
    """A spreading that is cos^2s(theta/2) at every frequency."""

    def exponent(self, omega: RealLike, peak: float) -> Real:
        """The exponent s [-] at `omega`."""


@dataclass(frozen=True, slots=True)
class Mitsuyasu:
    """
    cos^2s(theta/2) with s = s_p x^5 up to the peak and s_p x^-2.5 beyond, x = omega/omega_p, s_p =
    11.5 (U/c_p)^-2.5.

    The older the sea (the slower the wind beside its waves), the narrower. c_p = g/omega_p.

    Source: Mitsuyasu et al., J. Phys. Oceanogr. 5 (1975), 750-760,
    doi:10.1175/1520-0485(1975)005<0750:OOTDSO>2.0.CO;2.
    """

    speed: float  # U10 [m/s]

    def __post_init__(self) -> None:
        keep_checked(self, speed=WIND_SPEED)

    def exponent(self, omega: RealLike, peak: float) -> Real:
        """The exponent s [-] at `omega` [rad/s]; at most `SHARPEST`."""
        inverse_age = max(
            self.speed * peak / GRAVITY, 1e-2
        )  # a hundredth makes s_p a million already
        return _peaked_exponent(_relative(omega, peak), 11.5 * inverse_age**-2.5)

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `omega` and `theta`, [1/rad]."""
        return cosine_2s(self.exponent(omega, peak), wrapped(theta))


@dataclass(frozen=True, slots=True)
class GodaSuzuki:
    """
    Mitsuyasu's law with its s at the peak named outright: 10 for wind waves, 25 for young swell, 75
    for swell from far away.

    Source: Goda & Suzuki 1975; Goda, Random Seas and Design of Maritime Structures.
    """

    s_max: float  # s at the peak [-]

    def __post_init__(self) -> None:
        keep_checked(self, s_max=SPREADING_EXPONENT)

    def exponent(self, omega: RealLike, peak: float) -> Real:
        """The exponent s [-] at `omega` [rad/s]; at most `SHARPEST`."""
        return _peaked_exponent(_relative(omega, peak), self.s_max)

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `omega` and `theta`, [1/rad]."""
        return cosine_2s(self.exponent(omega, peak), wrapped(theta))


def _peaked_exponent(x: Real, s_peak: float) -> Real:
    """s_p x^5 below the peak, s_p x^-2.5 above."""
    # np.power, not **, which rounds a lone number otherwise than one in an array
    return np.minimum(
        s_peak
        * np.where(x <= 1.0, np.power(np.minimum(x, 1.0), 5.0), np.power(np.maximum(x, 1.0), -2.5)),
        SHARPEST,
    )


@dataclass(frozen=True, slots=True)
class Hasselmann:
    """
    cos^2s(theta/2) with s = 6.97 x^4.06 below x = omega/omega_p = 1.05 and 9.77 x^mu from there, mu
    = -2.33 - 1.45 (U/c_p - 1.17).

    The age of the wind (U/c_p, c_p = g/omega_p) sets how fast the short waves scatter, not how
    narrow the peak is. At 1.05 the published fit steps by 3 %; splitting at 1, as is often printed,
    makes that a step of 40 % at the very peak.

    Source: Hasselmann, Dunckel & Ewing, J. Phys. Oceanogr. 10 (1980), 1264-1280,
    doi:10.1175/1520-0485(1980)010<1264:DWSODJ>2.0.CO;2.
    """

    speed: float  # U10 [m/s]

    def __post_init__(self) -> None:
        keep_checked(self, speed=WIND_SPEED)

    def exponent(self, omega: RealLike, peak: float) -> Real:
        """The exponent s [-] at `omega` [rad/s]."""
        x = _relative(omega, peak)
        mu = -2.33 - 1.45 * (self.speed * peak / GRAVITY - 1.17)
        return np.where(
            x < 1.05,
            6.97 * np.power(np.minimum(x, 1.05), 4.06),
            9.77 * np.power(np.maximum(x, 1.05), mu),
        )

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `omega` and `theta`, [1/rad]."""
        return cosine_2s(self.exponent(omega, peak), wrapped(theta))


@dataclass(frozen=True, slots=True, kw_only=True)
class CosineN:
    """
    D = Gamma(n/2 + 1) / (sqrt(pi) Gamma((n + 1)/2)) cos^n(theta) in the front half, 0 behind. Not
    cos^2s(theta/2).

    n = 2 is `CosineSquared`, n = 0 the even half circle. Source: Pierson, Neumann & James 1955 (n =
    2); the general n in DNV-RP-C205.
    """

    n: float  # exponent [-]

    def __post_init__(self) -> None:
        keep_checked(self, n=SPREADING_EXPONENT)

    def __call__(self, omega: RealLike, theta: RealLike, _peak: float, /) -> Real:
        """D at `theta`, [1/rad]."""
        _, theta = np.broadcast_arrays(np.asarray(omega, dtype=np.float64), wrapped(theta))
        front = np.abs(theta) < 0.5 * np.pi
        # cos^n(theta) is cos^2s(phi/2) with s = n/2 and phi = 2 theta, and d phi = 2 d theta.
        return np.where(
            front, 2.0 * cosine_2s(np.float64(0.5 * self.n), np.where(front, 2.0 * theta, 0.0)), 0.0
        )


@dataclass(frozen=True, slots=True)
class WrappedNormal:
    """
    A normal distribution wound round the compass: the sum of exp(-(theta + 2 pi j)^2 / (2 sigma^2))
    over the turns j.

    Its circular spread (Kuik et al. 1988), which `moments.mean_direction_and_spread` measures, is
    sqrt(2 (1 - exp(-sigma^2/2))): a little less than sigma. Source: Mardia, Statistics of
    Directional Data (1972); Briggs et al. 1995 for waves.
    """

    spread: float  # sigma, the standard deviation before winding [degrees]

    def __post_init__(self) -> None:
        keep_checked(self, spread=SPREAD)

    def __call__(self, omega: RealLike, theta: RealLike, _peak: float, /) -> Real:
        """D at `theta`, [1/rad]."""
        _, theta = np.broadcast_arrays(np.asarray(omega, dtype=np.float64), wrapped(theta))
        sigma = math.radians(self.spread)
        turns = math.ceil(
            (8.5 * sigma + np.pi) / (2.0 * np.pi) - 0.5
        )  # what is left out lies beyond 8.5 sigma: under 1e-16
        total = np.zeros_like(theta)
        for j in range(-turns, turns + 1):
            total += np.exp(-0.5 * np.square((theta + 2.0 * np.pi * j) / sigma))
        return total / (sigma * math.sqrt(2.0 * np.pi))


@dataclass(frozen=True, slots=True)
class CustomSpreading:
    """
    Any function of (omega, theta, peak), brought to integral 1 at every frequency.

    The norm comes from Gauss quadrature on panels that narrow toward theta = 0 and toward `breaks`,
    so a bell round any of them of any width down to 0.1 degree is good to 1e-12, and so is anything
    smooth; a function with a kink or a jump that `breaks` does not name is refused when the
    quadrature sees it. Between frequencies the norm is interpolated, to 1e-12 as well.
    """

    function: Function  # f(omega, theta, peak) >= 0, any size; theta [rad] in [-pi, pi]
    breaks: Sequence[
        float
        # where it has a kink, a jump or a narrow bell in theta [rad], besides 0, +-pi/2 and +-pi
    ] = ()

    def __post_init__(self) -> None:
        if not callable(self.function) or isinstance(self.function, type):
            raise ParameterError(
                f"function must be callable as function(omega, theta, peak), got {self.function!r:.60}"
            )
        if isinstance(self.breaks, str) or not isinstance(self.breaks, Sequence):
            raise ParameterError(f"breaks must be a list of angles [rad], got {self.breaks!r:.60}")
        object.__setattr__(
            self, "breaks", tuple(ANGLE.check("every break", b) for b in self.breaks)
        )

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `omega` and `theta`, [1/rad]."""
        omega = _held(omega, peak)
        frequency, angle = (
            np.array(a, order="C") for a in np.broadcast_arrays(omega, wrapped(theta))
        )
        density: Real = self._checked(frequency, angle, peak) / _circle_integral(
            self._checked, omega, peak, tuple(self.breaks)
        )
        return density

    def _checked(self, omega: Real, theta: Real, peak: float) -> Real:
        """The function, or the reason why it will not do."""
        values = np.asarray(self.function(omega, theta, peak))
        if values.dtype.kind not in "iuf":
            raise ParameterError(
                f"the custom spreading must return real numbers, got {values!r:.60}"
            )
        if values.shape not in (omega.shape, ()):
            raise ParameterError(
                f"the custom spreading must return the shape it is given, {omega.shape}, got {values.shape}"
            )
        bad = ~((values >= 0.0) & (values < np.inf))
        if np.any(bad):
            raise ParameterError(
                f"the custom spreading must be finite and at least 0, got {values[bad].flat[0]}"
            )
        return np.broadcast_to(values.astype(np.float64), omega.shape)


@dataclass(frozen=True, slots=True)
class SwellElongation:
    """
    Another spreading drawn out along the swell: D cos^2s(theta/2) with s = 16 tanh(omega_p/omega)
    xi^2, brought back to integral 1.

    xi = 0 leaves it as it is, xi = 1 makes long parallel swells of the low frequencies. Where the
    base is itself a power of cos(theta/2) the exponents add and the norm is closed; else it is a
    quadrature like `CustomSpreading`'s.

    Source: Horvath, Empirical directional wave spectra for computer graphics, DigiPro 2015,
    doi:10.1145/2791261.2791267 (his own code has 16.1 for 16 and a norm over the front half only).
    """

    base: Spreading = field(default_factory=DonelanBanner)
    xi: float = field(default=0.5, kw_only=True)  # swell [-], 0 to 1

    def __post_init__(self) -> None:
        require_spreading("base", self.base)
        keep_checked(self, xi=FRACTION)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The directions at which the base has a kink or a jump [rad]."""
        return tuple(getattr(self.base, "breaks", ()))

    @property
    def frequency_breaks(self) -> tuple[float, ...]:
        """The frequencies at which the base has a kink [rad/s]."""
        return tuple(getattr(self.base, "frequency_breaks", ()))

    def exponent_added(self, omega: RealLike, peak: float) -> Real:
        """16 tanh(omega_p/omega) xi^2 [-] at `omega`."""
        s: Real = 16.0 * np.tanh(1.0 / _relative(omega, peak)) * self.xi**2
        return s

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """D at `omega` and `theta`, [1/rad]."""
        if self.xi == 0.0:
            return self.base(omega, theta, peak)
        own = self._own_exponent(omega, peak)
        if own is not None:
            return cosine_2s(own + self.exponent_added(omega, peak), wrapped(theta))
        omega = _held(omega, peak)
        density: Real = self._product(omega, theta, peak) / _circle_integral(
            self._product, omega, peak, self.breaks
        )
        return density

    def _own_exponent(self, omega: RealLike, peak: float) -> Real | None:
        """The base's s where it is a power of cos(theta/2)."""
        if isinstance(self.base, CosinePower):
            return np.full_like(np.asarray(omega, dtype=np.float64), self.base.s)
        return self.base.exponent(omega, peak) if isinstance(self.base, _CosinePowerLaw) else None

    def _product(self, omega: RealLike, theta: RealLike, peak: float) -> Real:
        """D cos^2s(theta/2), not yet normed."""
        cosine = np.maximum(np.abs(np.cos(0.5 * np.asarray(theta, dtype=np.float64))), 1e-300)
        drawn: Real = self.base(omega, theta, peak) * np.exp(
            2.0 * self.exponent_added(omega, peak) * np.log(cosine)
        )
        return drawn


def _held(omega: RealLike, peak: float) -> Real:
    """
    Frequencies [rad/s] held at a millionth of the peak from below and far beyond any wave: no law
    has a use for 0 or inf.
    """
    return np.clip(np.asarray(omega, dtype=np.float64), 1e-6 * peak, 1e50)


def _relative(omega: RealLike, peak: float) -> Real:
    """omega/omega_p, so held."""
    return _held(omega, peak) / peak


# ---- the norm: an integral over theta for each frequency, and a table of it where there are many

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


def _integrals(
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


def _circle_integral(
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
    coarse, fine = (_integrals(function, probes, peak, breaks, order) for order in (16, 23))
    wrong = ~(np.abs(coarse - fine) <= 1e-11 * fine) | ~(fine > 0.0)
    if np.any(wrong):
        i = int(np.argmax(wrong))
        raise ParameterError(
            "the spreading must have an integral over theta that quadrature can find: more than 0, and with every kink named in "
            f"breaks; got {coarse[i]:.12g} and {fine[i]:.12g} at omega = {probes[i]:g} rad/s"
        )
    values = _tabulated(function, unique, peak, breaks)
    if not np.all(values > 0.0):
        raise ParameterError(
            "the spreading must have an integral over theta that is more than 0, got "
            f"{np.min(values):g} at omega = {unique[np.argmin(values)]:g} rad/s"
        )
    return values[place].reshape(omega.shape)


def _tabulated(function: Function, omega: Real, peak: float, breaks: tuple[float, ...]) -> Real:
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
        values = _integrals(function, nodes.ravel(), peak, breaks).reshape(nodes.shape)
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
    out[pending] = _integrals(function, omega[pending], peak, breaks)
    return out
