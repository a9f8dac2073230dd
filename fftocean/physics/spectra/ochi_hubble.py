"""Ochi-Hubble spectrum of swell and wind sea."""

import math
from dataclasses import dataclass, field

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError
from fftocean.limits import PERIOD, SIGNIFICANT_WAVE_HEIGHT, Count, Quantity, keep_checked
from fftocean.physics.kinds import Way
from fftocean.physics.spectra.base import SPECTRA
from fftocean.physics.spectra.gamma import GammaSpectrum, breaks_of, total

SHAPE = Quantity("", 0.1, 100.0)  # Ochi and Hubble's lambda

# at 20 m Ochi and Hubble's exponentials leave one tail at omega^-1.5
FAMILY_WAVE_HEIGHT = Quantity("m", 0.0, 20.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class OchiHubble:
    """
    Swell and wind sea, three parameters each: a bell with M = 4, N = 4 lambda + 1 at low frequency
    and one at high.

    S = 1/4 sum ((4 lambda + 1)/4 omega_p^4)^lambda / Gamma(lambda) Hs^2 omega^-(4 lambda + 1)
    exp(-(4 lambda + 1)/4 (omega_p/omega)^4). Each half has m0 = Hs^2/16; lambda = 1 is
    Bretschneider, larger is narrower.

    Args:
        hs_low: significant wave height of the low-frequency half [m].
        tp_low: its peak period [s], the longer.
        lambda_low: its shape [-].
        hs_high: significant wave height of the high-frequency half [m].
        tp_high: its peak period [s].
        lambda_high: its shape [-].

    Raises:
        ParameterError: a height, period or shape out of its range.

    Source: Ochi & Hubble, On six-parameter wave spectra, Proc. 15th Coastal Engineering Conf.
    (1976), 301-328, doi:10.9753/icce.v15.18.
    """

    hs_low: float
    tp_low: float
    lambda_low: float
    hs_high: float
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
        """Return the most frequent sea of `hs` [m] in the North Atlantic."""
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
        """omega_p of the half with the higher peak [rad/s]."""
        return max(self._halves, key=lambda half: float(half(half.peak))).peak

    @property
    def breaks(self) -> tuple[float, ...]:
        """The scales of both halves [rad/s]."""
        return breaks_of(self._halves)

    def __call__(self, omega: RealLike, /) -> Real:
        """Return S at `omega`, [m^2 s/rad]."""
        return total(self._halves, omega)


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


def _member(*, hs: float, member: int = 0) -> OchiHubble:
    """Return one of the eleven seas of `OchiHubble.family`; 0 is the most probable."""
    return OchiHubble.family(hs=hs)[member]


SPECTRA.add(
    "ochi-hubble",
    OchiHubble,
    Way(_member, hs=FAMILY_WAVE_HEIGHT, member=Count("", 0, len(_FAMILY) - 1)),
    Way(
        OchiHubble,
        hs_low=SIGNIFICANT_WAVE_HEIGHT,
        tp_low=PERIOD,
        lambda_low=SHAPE,
        hs_high=SIGNIFICANT_WAVE_HEIGHT,
        tp_high=PERIOD,
        lambda_high=SHAPE,
    ),
)
