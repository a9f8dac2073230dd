"""Values that the waves of a sea are made to have at given places and times, and their rarity."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from fftocean.arrays import shortened
from fftocean.errors import ParameterError, described, suggestion
from fftocean.fields import FIELDS
from fftocean.limits import LENGTH, TIME, Quantity, keep_checked

PLACE = Quantity("m", -1e9, 1e9)
VALUE = Quantity("", -1e6, 1e6)

_AT_REST = ("slope_x", "slope_y", "velocity_z")
_IN_PLACE = ("displace_x", "displace_y")


@dataclass(frozen=True, slots=True)
class Fix:
    """
    One value of a field, at the water whose rest position is (x, y), at time t.

    Args:
        field: a field of `Ocean.frame` that is linear in the waves: "height", "slope_x",
            "displace_y", "velocity_z", ...; horizontal ones are before choppiness.
        x, y: rest position [m].
        t: time [s].
        value: in the unit of the field.

    Raises:
        ParameterError: another field, or a value that is not finite.
    """

    field: str
    x: float
    y: float
    t: float
    value: float

    def __post_init__(self) -> None:
        if not isinstance(self.field, str) or self.field not in FIELDS:
            raise ParameterError(
                f"field must be one of {', '.join(FIELDS)}, got {described(self.field)}"
                f"{suggestion(self.field, FIELDS)}"
            )
        keep_checked(self, x=PLACE, y=PLACE, t=TIME, value=VALUE)

    @property
    def place(self) -> tuple[float, float, float]:
        """x, y [m] and t [s]."""
        return self.x, self.y, self.t

    def __str__(self) -> str:
        unit = FIELDS[self.field].unit
        number = f"{self.value:.6g}" + (f" {unit}" if unit != "1" else "")
        return f"{self.field} = {number} at ({self.x:g}, {self.y:g}) m, {self.t:g} s"


@dataclass(frozen=True, slots=True, kw_only=True)
class Crest:
    """
    A crest of given height at a place and a time: the surface stands level there, and does not
    rise or fall; where there is choppiness, the water there is not displaced, so that the crest of
    the displaced surface stands at that place, too.

    Args:
        height: of the surface in frames [m]; below 0 it is a trough. See `constrain` for a height
            above the still-water level, or of another surface that follows from the waves.
        x, y: place [m].
        t: time [s].

    Raises:
        ParameterError: a value that is not finite, or a height of 0.
    """

    height: float
    x: float = 0.0
    y: float = 0.0
    t: float = 0.0

    def __post_init__(self) -> None:
        keep_checked(self, height=LENGTH, x=PLACE, y=PLACE, t=TIME)
        if self.height == 0.0:
            raise ParameterError("height must not be 0: a crest or a trough has a height")

    def fixes(self, choppiness: float, height: float | None = None) -> tuple[Fix, ...]:
        """
        Return the values that make the crest, of which the first is its height.

        Args:
            choppiness: of the sea.
            height: of the sum of waves [m]; None for the crest's own.
        """
        where = self.x, self.y, self.t
        level = (*_AT_REST, *(_IN_PLACE if choppiness > 0.0 else ()))
        return (
            Fix("height", *where, self.height if height is None else height),
            *(Fix(name, *where, 0.0) for name in level),
        )

    def __str__(self) -> str:
        kind = "crest" if self.height > 0.0 else "trough"
        return f"{kind} of {abs(self.height):.3g} m at ({self.x:g}, {self.y:g}) m, {self.t:g} s"


@dataclass(frozen=True, slots=True, kw_only=True)
class Rarity:
    """
    Probabilities of values that a sea was made to have, and what it took.

    `chi2` measures the change: how far the waves of this seed had to be moved, as the squared
    length of the change in standard deviations of the waves. `chi2_of_values` measures the values
    alone, whatever the seed: in a Gaussian sea it has a chi-squared distribution with `degrees`
    degrees of freedom, and so `probability` is the probability that values at a place and time
    chosen beforehand are that unusual. For the crests `exceedance` is Rayleigh's law.

    Args:
        fixes: the values that were fixed.
        crests: the crests that were fixed.
        linear_heights: height of the sum of waves at each crest [m].
        chi2: (b - l) Lambda^-1 (b - l), b being the values and l those of the seed's own waves [-].
        chi2_of_values: b Lambda^-1 b [-].
        degrees: number of independent values.
        m0: variance of the height over seeds, without the fixed values [m^2].
        period: mean zero-upcrossing period at a place, 2 pi sqrt(m0/m2) [s].
        min_jacobian: least Jacobian of the surface at the times of the values [-].
    """

    fixes: tuple[Fix, ...]
    crests: tuple[Crest, ...]
    linear_heights: tuple[float, ...]
    chi2: float
    chi2_of_values: float
    degrees: int
    m0: float
    period: float
    min_jacobian: float

    def __repr__(self) -> str:
        return shortened(f"Rarity({self})")

    @property
    def probability(self) -> float:
        """Probability of values so unusual [-], at a place and time chosen beforehand."""
        from scipy.special import gammaincc  # half a second, which most runs do not need

        return float(gammaincc(0.5 * self.degrees, 0.5 * self.chi2_of_values))

    @property
    def exceedance(self) -> float | None:
        """
        Share of this sea's crests that are as high as the highest here [-]: exp(-A^2/(2 m0)).

        None without a crest. This is Rayleigh's law, that of a narrow band of waves, and of the sum
        of waves alone.
        """
        if not self.linear_heights:
            return None
        return math.exp(-0.5 * max(h * h for h in self.linear_heights) / self.m0)

    @property
    def return_period(self) -> float | None:
        """Mean time between such crests at one place, if the sea stayed as it is [s], or None."""
        share = self.exceedance
        if share is None:
            return None
        return self.period / share if share > 0.0 else math.inf

    def as_plain(self) -> dict[str, Any]:
        """Return what a manifest says: numbers in SI units, and the whole in words."""
        share, period = self.exceedance, self.return_period
        return {
            "values": [
                {"field": f.field, "x": f.x, "y": f.y, "t": f.t, "value": f.value}
                for f in self.fixes
            ],
            "chi2": self.chi2,
            "chi2_of_values": self.chi2_of_values,
            "degrees": self.degrees,
            "probability": self.probability,
            "exceedance": share,
            "return_period": None if period is None or math.isinf(period) else period,
            "min_jacobian": self.min_jacobian,
            "in_words": str(self),
        }

    def __str__(self) -> str:
        parts = [str(crest) for crest in self.crests]
        others = len(self.fixes) - sum(fix.place in _places(self.crests) for fix in self.fixes)
        if others:
            parts.append(f"{others} fixed values" if others > 1 else "1 fixed value")
        text = ", ".join(parts)
        if self.crests:
            highest = max(abs(h) for h in self.linear_heights)
            share, period = self.exceedance, self.return_period
            assert share is not None
            assert period is not None
            text += (
                f": {highest / math.sqrt(self.m0):.2f} standard deviations, "
                f"{one_in(share)} crests is as high (Rayleigh), "
                f"at one place one in {duration(period)}"
            )
        else:
            text += f": {one_in(self.probability)} places and times is that unusual"
        return f"{text}; least Jacobian {self.min_jacobian:.2f}"


def _places(crests: Iterable[Crest]) -> set[tuple[float, float, float]]:
    return {(crest.x, crest.y, crest.t) for crest in crests}


def one_in(share: float) -> str:
    """Return a probability as "1 in 1,200"."""
    if share <= 0.0:
        return "less than 1 in 1e300"
    count = 1.0 / share
    return f"1 in {count:,.0f}" if count < 1e7 else f"1 in {count:.1e}"


def duration(seconds: float) -> str:
    """Return a length of time in the unit that suits it."""
    for unit, length in (("s", 1.0), ("minutes", 60.0), ("hours", 3600.0), ("days", 86400.0)):
        limit = {"s": 120.0, "minutes": 7200.0, "hours": 172800.0, "days": 2.0 * 365.25 * 86400.0}
        if seconds < limit[unit]:
            return f"{seconds / length:.3g} {unit}"
    years = seconds / (365.25 * 86400.0)
    return f"{years:,.0f} years" if years < 1e7 else f"{years:.1e} years"
