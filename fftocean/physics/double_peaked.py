"""
S(omega) beyond Pierson-Moskowitz and JONSWAP, from one bell: Bretschneider, Ochi-Hubble,
Torsethaugen.
"""

import math
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.limits import PERIOD, SIGNIFICANT_WAVE_HEIGHT, Quantity, keep_checked
from fftocean.physics.moments import moment

TAIL = Quantity(
    "", 1.4, 1000.0
)  # N: m0 exists above 1; below 1.4 half of it would lie beyond ten times the peak
FRONT = Quantity("", 1.0, 16.0)  # M
ENHANCEMENT = Quantity(
    "", 1.0, 100.0
)  # Torsethaugen's regression reaches 50 in the steepest seas that can be
SHAPE = Quantity("", 0.1, 100.0)  # Ochi and Hubble's lambda
FAMILY_WAVE_HEIGHT = Quantity(
    "m", 0.0, 20.0
)  # at 20 m Ochi and Hubble's exponentials leave one tail at omega^-1.5
TORSETHAUGEN_WAVE_HEIGHT = Quantity(
    "m", 0.0, 50.0
)  # at 54 m the fully developed sea would be longer than the longest swell

STEEPEST = 4.0 / math.sqrt(5.0)
"""
Hs omega_p^2 / g at which a Pierson-Moskowitz sea has a Phillips constant of 1: the door that
`spectra` keeps, in other words.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class GammaSpectrum:
    """
    One bell: a front, a tail, and between them a peak that may be raised.

    S = (Hs^2/16) (A G / omega_p) x^-N exp(-(N/M) x^-M) gamma^r,  x = omega/omega_p,
    with r and its widths 0.07 and 0.09 as in JONSWAP, G = M (N/M)^((N-1)/M) / Gamma((N-1)/M), and A
    = 1 where gamma = 1.

    N = 5, M = 4 is Bretschneider's; M = 4 Wallop's and Ochi and Hubble's; with gamma it is each
    half of Torsethaugen's. m0 is Hs^2/16 by construction: A comes from quadrature, or
    (`exact=False`) from the regression that Torsethaugen published.

    Source: Torsethaugen 1996; DNV-RP-C205 (2010), appendix A, gives it with the regression.
    """

    hs: float  # significant wave height [m]
    tp: float  # peak period [s] (of the bell without gamma, to be exact; gamma sits on its top)
    tail: float = 5.0  # N: S falls as omega^-N [-]
    front: float = 4.0  # M: how steeply it rises [-]
    gamma: float = 1.0  # peak enhancement [-]
    exact: bool = field(
        default=True, repr=False
    )  # Hs to the last digit, not as the published regression has it

    def __post_init__(self) -> None:
        keep_checked(
            self, hs=SIGNIFICANT_WAVE_HEIGHT, tp=PERIOD, tail=TAIL, front=FRONT, gamma=ENHANCEMENT
        )
        _require_possible(self.hs, self.tp)
        _require_bool("exact", self.exact)

    @property
    def peak(self) -> float:
        """omega_p [rad/s]."""
        return 2.0 * math.pi / self.tp

    @property
    def breaks(self) -> tuple[float, ...]:
        """
        The scales on which the bell bends: its peak, where the width changes, and an octave each
        way [rad/s].
        """
        return 0.5 * self.peak, self.peak, 2.0 * self.peak

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`, [m^2 s/rad]."""
        norm = _regression if not self.exact else _quadrature
        scale = self.hs**2 / 16.0 / self.peak * norm(self.tail, self.front, self.gamma)
        omega = np.minimum(
            np.asarray(omega, dtype=np.float64), 1e50
        )  # nothing is left there, nor is infinity a frequency
        return scale * _bell(omega / self.peak, self.tail, self.front, self.gamma)


def _bell(x: Real, tail: float, front: float, gamma: float) -> Real:
    """
    G x^-N exp(-(N/M) x^-M) gamma^r, in logarithms: N = 401 (lambda = 100) overflows otherwise.
    """
    a = (tail - 1.0) / front
    log_g = math.log(front) + a * math.log(tail / front) - math.lgamma(a)
    x = np.maximum(x, 1e-3)  # there the front is 0 in double precision
    bell: Real = np.exp(log_g - tail * np.log(x) - tail / front * x**-front)
    if gamma > 1.0:
        bell *= gamma ** np.exp(
            -0.5 * ((np.minimum(x, 5.0) - 1.0) / np.where(x <= 1.0, 0.07, 0.09)) ** 2
        )  # 0 at 5 peaks
    return bell


@lru_cache(maxsize=1024)
def _quadrature(tail: float, front: float, gamma: float) -> float:
    """A = 1 / integral of the bell: exactly 1 where gamma is."""
    if gamma == 1.0:
        return 1.0
    return 1.0 / moment(_Shape(tail, front, gamma), 0)


@dataclass(frozen=True, slots=True)
class _Shape:
    """The bell as a spectrum of its own, with its peak at 1, for the quadrature."""

    tail: float
    front: float
    gamma: float
    peak: float = 1.0
    breaks: tuple[float, ...] = (
        0.5,
        0.8,
        1.0,
        1.3,
        2.0,
    )  # gamma^r ends within 3 widths of the peak

    def __call__(self, x: RealLike, /) -> Real:
        return _bell(np.asarray(x, dtype=np.float64), self.tail, self.front, self.gamma)


def _regression(tail: float, front: float, gamma: float) -> float:
    """
    A = (1 + f1 ln^f2 gamma)/gamma, within 5 % of the quadrature up to gamma = 20  (Torsethaugen
    1996; DNV-RP-C205 A.2).
    """
    f1 = 4.1 * (tail - 2.0 * front**0.28 + 5.3) ** (0.96 - 1.45 * front**0.1)
    f2 = (
        (2.2 * front**-3.3 + 0.57) * tail ** (0.53 - 0.58 * front**0.37) + 0.94 - 1.04 * front**-1.9
    )
    return float((1.0 + f1 * math.log(gamma) ** f2) / gamma)


@dataclass(frozen=True, slots=True, kw_only=True)
class Bretschneider:
    """
    The two-parameter spectrum of the ITTC: S = (5/16) Hs^2 omega_p^4 omega^-5 exp(-5/4
    (omega_p/omega)^4).

    Pierson-Moskowitz with height and period set free: any wind sea, developed or not. m0 = Hs^2/16
    in closed form.

    Source: Bretschneider 1959; 15th ITTC (1978), S = A omega^-5 exp(-B omega^-4) with A = 173
    Hs^2/T1^4, B = 691/T1^4.
    Pinned by tests/physics/test_double_peaked.py: 173, 691, and the closed m0.
    """

    hs: float  # significant wave height [m]
    tp: float  # peak period [s]

    def __post_init__(self) -> None:
        keep_checked(self, hs=SIGNIFICANT_WAVE_HEIGHT, tp=PERIOD)
        _require_possible(self.hs, self.tp)

    @classmethod
    def from_mean_period(cls, *, hs: float, t1: float) -> "Bretschneider":
        """Sea of mean period `t1` = 2 pi m0/m1 [s]: Tp = (5/4)^(1/4) Gamma(3/4) T1 = 1.296 T1."""
        return cls(hs=hs, tp=PERIOD.check("t1", t1) * 1.25**0.25 * math.gamma(0.75))

    @classmethod
    def from_zero_crossing_period(cls, *, hs: float, tz: float) -> "Bretschneider":
        """
        Sea of zero-crossing period `tz` = 2 pi sqrt(m0/m2) [s]: Tp = (5 pi/4)^(1/4) Tz = 1.408 Tz.
        """
        return cls(hs=hs, tp=PERIOD.check("tz", tz) * (1.25 * math.pi) ** 0.25)

    @property
    def peak(self) -> float:
        """omega_p [rad/s]."""
        return 2.0 * math.pi / self.tp

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`, [m^2 s/rad]."""
        return GammaSpectrum(hs=self.hs, tp=self.tp)(omega)


@dataclass(frozen=True, slots=True, kw_only=True)
class OchiHubble:
    """
    Swell and wind sea, three parameters each: a bell with M = 4, N = 4 lambda + 1 at low frequency
    and one at high.

    S = 1/4 sum ((4 lambda + 1)/4 omega_p^4)^lambda / Gamma(lambda) Hs^2 omega^-(4 lambda + 1)
    exp(-(4 lambda + 1)/4 (omega_p/omega)^4). Each half has m0 = Hs^2/16; lambda = 1 is
    Bretschneider, larger is narrower.

    Source: Ochi & Hubble, On six-parameter wave spectra, Proc. 15th Coastal Engineering Conf.
    (1976), 301-328, doi:10.9753/icce.v15.18.
    """

    hs_low: float  # significant wave height of the low-frequency half [m]
    tp_low: float  # its peak period [s], the longer
    lambda_low: float  # its shape [-]
    hs_high: float  # the same of the high-frequency half
    tp_high: float
    lambda_high: float
    _halves: tuple[GammaSpectrum, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        keep_checked(self, hs_low=SIGNIFICANT_WAVE_HEIGHT, tp_low=PERIOD, lambda_low=SHAPE)
        keep_checked(self, hs_high=SIGNIFICANT_WAVE_HEIGHT, tp_high=PERIOD, lambda_high=SHAPE)
        if self.tp_low < self.tp_high:
            raise ParameterError(
                f"tp_low must be at least tp_high, {self.tp_high:g} s, got {self.tp_low:g} s"
            )
        low = GammaSpectrum(hs=self.hs_low, tp=self.tp_low, tail=4.0 * self.lambda_low + 1.0)
        high = GammaSpectrum(hs=self.hs_high, tp=self.tp_high, tail=4.0 * self.lambda_high + 1.0)
        object.__setattr__(self, "_halves", (low, high))

    @classmethod
    def most_probable(cls, *, hs: float) -> "OchiHubble":
        """The sea most often found with `hs` [m] in the North Atlantic."""
        return cls.family(hs=hs)[0]

    @classmethod
    def family(cls, *, hs: float) -> "tuple[OchiHubble, ...]":
        """
        Return the eleven seas of one `hs` [m] for design: the most probable first (weight 0.50),
        then ten of weight 0.05.

        The published shares of height are rounded to two digits, so that their squares sum to 0.995
        ... 1.004; here they are divided by the root of that sum, so that each member has exactly
        `hs`.

        Raises:
            ParameterError: `hs` out of range (`FAMILY_WAVE_HEIGHT`; the data end near 15 m).
        """
        hs = FAMILY_WAVE_HEIGHT.check("hs", hs)
        members = []
        for share_low, share_high, (w_low, fall_low), (w_high, fall_high), lambda_low, (
            lambda_high,
            fall,
        ) in _FAMILY:
            whole = math.hypot(share_low, share_high)
            members.append(
                cls(
                    hs_low=hs * share_low / whole,
                    tp_low=2.0 * math.pi / w_low * math.exp(fall_low * hs),
                    lambda_low=lambda_low,
                    hs_high=hs * share_high / whole,
                    tp_high=2.0 * math.pi / w_high * math.exp(fall_high * hs),
                    lambda_high=lambda_high * math.exp(-fall * hs),
                )
            )
        return tuple(members)

    @property
    def peak(self) -> float:
        """omega_p of the half that stands higher [rad/s]."""
        return max(self._halves, key=lambda half: float(half(half.peak))).peak

    @property
    def breaks(self) -> tuple[float, ...]:
        """The scales of both halves [rad/s]."""
        return _breaks(self._halves)

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`, [m^2 s/rad]."""
        return _total(self._halves, omega)


# Share of hs, (omega_p at hs = 0 [rad/s], its decay [1/m]) and lambda of each half; Ochi & Hubble
# 1976, the table of the family.
_FAMILY = (
    (0.84, 0.54, (0.70, 0.046), (1.15, 0.039), 3.00, (1.54, 0.062)),
    (0.95, 0.31, (0.70, 0.046), (1.50, 0.046), 1.35, (2.48, 0.102)),
    (0.65, 0.76, (0.61, 0.039), (0.94, 0.036), 4.95, (2.48, 0.102)),
    (0.84, 0.54, (0.93, 0.056), (1.50, 0.046), 3.00, (2.77, 0.112)),
    (0.84, 0.54, (0.41, 0.016), (0.88, 0.026), 2.55, (1.82, 0.089)),
    (0.90, 0.44, (0.81, 0.052), (1.60, 0.033), 1.80, (2.95, 0.105)),
    (0.77, 0.64, (0.54, 0.039), (0.61, 0.000), 4.50, (1.95, 0.082)),
    (0.73, 0.68, (0.70, 0.046), (0.99, 0.039), 6.40, (1.78, 0.069)),
    (0.92, 0.39, (0.70, 0.046), (1.37, 0.039), 0.70, (1.78, 0.069)),
    (0.84, 0.54, (0.74, 0.052), (1.30, 0.039), 2.65, (3.90, 0.085)),
    (0.84, 0.54, (0.62, 0.039), (1.03, 0.030), 2.60, (0.53, 0.069)),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Torsethaugen:
    """
    Wind sea and swell of the Norwegian shelf, from nothing but `hs` and `tp`.

    A sea of height Hs that has stopped growing peaks at Tf = 6.6 Hs^(1/3) (fetch 370 km). A shorter
    `tp` is a wind sea with some swell under it, a longer one a swell with some wind sea on it; the
    further from Tf, the more the second system has.

    `form="simplified"` (Torsethaugen & Haver 2004): tails omega^-4 in both. `form="full"`
    (Torsethaugen 1996, as DNV-RP-C205 gives it): tails steepen with Hs. Fitted to seas of 0.5 to 11
    m and 3.5 to 19 s; elsewhere it is an extrapolation. Where the regression for gamma falls below
    1 (long low swell), gamma is 1.

    With `exact=True` both systems integrate to their share and Hs is `hs` to the last digit.
    `exact=False` norms gamma with the published regression (rounded to (1 + 1.1 ln^1.19
    gamma)/gamma in the simplified form): Hs is then up to 2.5 % off.

    Source: Torsethaugen, SINTEF report STF22 A96204 (1996); Torsethaugen & Haver, Simplified double
    peak spectral model for ocean waves, Proc. 14th ISOPE (2004), paper 2004-JSC-193; DNV-RP-C205
    (2010), appendix A. None of them has a doi. Pinned by tests/physics/test_double_peaked.py,
    against an independent implementation's figures.
    """

    hs: float  # significant wave height of everything [m]
    tp: float  # peak period of the higher system, nearly always [s]
    form: str = "simplified"  # or "full"
    exact: bool = True  # Hs to the last digit, not as the published norms have it
    _systems: tuple[GammaSpectrum, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        keep_checked(self, hs=TORSETHAUGEN_WAVE_HEIGHT, tp=PERIOD)
        _require_possible(self.hs, self.tp)
        _require_bool("exact", self.exact)
        if self.form not in ("simplified", "full"):
            raise ParameterError(f"form must be 'simplified' or 'full', got {self.form!r:.60}")
        object.__setattr__(
            self,
            "_systems",
            _torsethaugen(self.hs, self.tp, self.form == "full", self.exact) if self.hs else (),
        )

    @property
    def peak(self) -> float:
        """omega_p of the ordered `tp` [rad/s]."""
        return 2.0 * math.pi / self.tp

    @property
    def breaks(self) -> tuple[float, ...]:
        """The scales of both systems [rad/s]."""
        return _breaks(self._systems)

    @property
    def systems(self) -> tuple[GammaSpectrum, ...]:
        """The primary system, then the secondary: hs, tp and gamma of each. None on a flat sea."""
        return self._systems

    def __call__(self, omega: RealLike, /) -> Real:
        """S at `omega`, [m^2 s/rad]."""
        return _total(self._systems, omega)


def _torsethaugen(
    hs: float, tp: float, full: bool, exact: bool
) -> tuple[GammaSpectrum, GammaSpectrum]:
    """Share `hs` out among a primary and a secondary system."""
    developed = 6.6 * hs ** (1.0 / 3.0)  # Tf [s]
    # Bulk parameters of the two forms: the tail, the front of a secondary wind sea, and what lifts
    # gamma in low seas.
    tail = 0.5 * math.sqrt(hs) + 3.2 if full else 4.0
    front = 4.0 * (1.0 - 0.7 * math.exp(-hs / 3.0)) if full else 4.0
    lift = 1.0 + 3.5 * math.exp(-hs) if full else 1.0

    def gamma(steepness: float) -> float:
        return 35.0 * lift * math.pow(2.0 * math.pi / GRAVITY * steepness, 6.0 / 7.0)

    if tp <= developed:
        shortness = min((developed - tp) / (developed - 2.0 * math.sqrt(hs)), 1.0)
        share = 0.7 + 0.3 * math.exp(-((shortness / 0.5) ** 2))
        second_hs = hs * math.sqrt(1.0 - share**2)
        peakedness = gamma(share * hs / tp**2)
        second_front, second_tp = 4.0, developed + 2.0
    else:
        longness = min((tp - developed) / (25.0 - developed), 1.0)
        share = 0.6 + 0.4 * math.exp(-((longness / 0.3) ** 2))
        second_hs = hs * math.sqrt(1.0 - share**2)
        peakedness = gamma(hs / developed**2) * (1.0 + 6.0 * longness)
        second_front = front
        second_tp = (
            _sea_on_swell(hs, second_hs, tail, front) if full else 6.6 * second_hs ** (1.0 / 3.0)
        )
    # A share so small that no period fits it has no energy either: any period will do.
    second_tp = max(second_tp, 0.1)
    return (
        GammaSpectrum(hs=share * hs, tp=tp, tail=tail, gamma=max(peakedness, 1.0), exact=exact),
        GammaSpectrum(hs=second_hs, tp=second_tp, tail=tail, front=second_front),
    )


def _sea_on_swell(hs: float, second_hs: float, tail: float, front: float) -> float:
    """
    Peak period [s] at which a wind sea of `second_hs` has the density s4 at 0.4 Hz: its tail is
    saturated (full form only).
    """
    saturation = max(0.01, 0.08 * (1.0 - math.exp(-hs / 3.0)))  # s4 [m^2/Hz]
    a = (tail - 1.0) / front
    g = front * (tail / front) ** a / math.gamma(a)
    return max(
        2.5, math.pow(g * second_hs**2 / (16.0 * saturation * 0.4**tail), 1.0 / (tail - 1.0))
    )


def _total(parts: tuple[GammaSpectrum, ...], omega: RealLike) -> Real:
    """The sum of the parts' S; 0 of none."""
    omega = np.asarray(omega, dtype=np.float64)
    return sum((part(omega) for part in parts), np.zeros_like(omega))


def _breaks(parts: tuple[GammaSpectrum, ...]) -> tuple[float, ...]:
    return tuple(sorted({b for part in parts for b in part.breaks}))


def _require_possible(hs: float, tp: float) -> None:
    """Refuse waves steeper than can be."""
    steepness = hs * (2.0 * math.pi / tp) ** 2 / GRAVITY
    if steepness > STEEPEST:
        raise ParameterError(
            f"hs and tp must make waves that can be (hs at most {STEEPEST / (2.0 * math.pi):.3f} of the wavelength), "
            f"got {hs:g} m with {tp:g} s ({steepness / (2.0 * math.pi):.3g})"
        )


def _require_bool(name: str, value: object) -> None:
    if not isinstance(value, bool):
        raise ParameterError(f"{name} must be True or False, got {value!r:.60}")
