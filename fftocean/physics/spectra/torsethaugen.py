"""Torsethaugen spectrum of wind sea and swell."""

import math
from dataclasses import dataclass, field

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.limits import PERIOD, Quantity, check_bool, keep_checked
from fftocean.physics.kinds import Choice, Switch, Way
from fftocean.physics.spectra.base import SPECTRA
from fftocean.physics.spectra.gamma import GammaSpectrum, breaks_of, require_possible, total

# at 54 m the fully developed sea would be longer than the longest swell
TORSETHAUGEN_WAVE_HEIGHT = Quantity("m", 0.0, 50.0)

FORMS = ("simplified", "full")


@dataclass(frozen=True, slots=True, kw_only=True)
class Torsethaugen:
    """
    Wind sea and swell of the Norwegian shelf, from `hs` and `tp` alone.

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

    Args:
        hs: significant wave height of everything [m].
        tp: peak period of the higher system, nearly always [s].
        form: "simplified" or "full".
        exact: True for an Hs that is exactly `hs`, False for the published norms.

    Raises:
        ParameterError: a height or a period out of its range, or an unknown form.

    Source: Torsethaugen, SINTEF report STF22 A96204 (1996); Torsethaugen & Haver, Simplified double
    peak spectral model for ocean waves, Proc. 14th ISOPE (2004), paper 2004-JSC-193; DNV-RP-C205
    (2010), appendix A. None of them has a doi. Pinned by tests/physics/test_composed_spectra.py,
    against an independent implementation's figures.
    """

    hs: float
    tp: float
    form: str = "simplified"
    exact: bool = True
    _systems: tuple[GammaSpectrum, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        keep_checked(self, hs=TORSETHAUGEN_WAVE_HEIGHT, tp=PERIOD)
        require_possible(self.hs, self.tp)
        check_bool("exact", self.exact)
        if self.form not in FORMS:
            raise ParameterError(f"form must be 'simplified' or 'full', got {self.form!r:.60}")
        object.__setattr__(
            self,
            "_systems",
            _torsethaugen(self.hs, self.tp, self.form == "full", self.exact) if self.hs else (),
        )

    @property
    def peak(self) -> float:
        """omega_p of the specified `tp` [rad/s]."""
        return 2.0 * math.pi / self.tp

    @property
    def breaks(self) -> tuple[float, ...]:
        """The scales of both systems [rad/s]."""
        return breaks_of(self._systems)

    @property
    def systems(self) -> tuple[GammaSpectrum, ...]:
        """The primary system, then the secondary: hs, tp and gamma of each. None on a flat sea."""
        return self._systems

    def __call__(self, omega: RealLike, /) -> Real:
        """Return S at `omega`, [m^2 s/rad]."""
        return total(self._systems, omega)


def _torsethaugen(
    hs: float, tp: float, full: bool, exact: bool
) -> tuple[GammaSpectrum, GammaSpectrum]:
    """Return the primary and the secondary system that share `hs`."""
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
    Return the peak period [s] at which a wind sea of `second_hs` has the density s4 at 0.4 Hz: its
    tail is saturated (full form only).
    """
    saturation = max(0.01, 0.08 * (1.0 - math.exp(-hs / 3.0)))  # s4 [m^2/Hz]
    a = (tail - 1.0) / front
    g = front * (tail / front) ** a / math.gamma(a)
    return max(
        2.5, math.pow(g * second_hs**2 / (16.0 * saturation * 0.4**tail), 1.0 / (tail - 1.0))
    )


SPECTRA.add(
    "torsethaugen",
    Torsethaugen,
    Way(
        Torsethaugen,
        hs=TORSETHAUGEN_WAVE_HEIGHT,
        tp=PERIOD,
        form=Choice(FORMS),
        exact=Switch(),
    ),
)
