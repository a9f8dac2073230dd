"""Weighted mean of two spreadings."""

from dataclasses import dataclass, field

from fftocean.arrays import Real, RealLike
from fftocean.limits import FRACTION, keep_checked
from fftocean.physics.kinds import Part, Way
from fftocean.physics.spreading.base import SPREADINGS, Spreading, require_spreading
from fftocean.physics.spreading.cosine_squared import CosineSquared
from fftocean.physics.spreading.donelan_banner import DonelanBanner


@dataclass(frozen=True, slots=True)
class Blend:
    """
    (1 - weight) first + weight second: from the first model at weight 0 to the second at weight 1.

    Args:
        first: model at weight 0.
        second: model at weight 1.
        weight: share of `second` [-].

    Raises:
        ParameterError: a weight outside 0 to 1.
    """

    first: Spreading = field(default_factory=DonelanBanner)
    second: Spreading = field(default_factory=CosineSquared)
    weight: float = field(default=0.5, kw_only=True)

    def __post_init__(self) -> None:
        require_spreading("first", self.first)
        require_spreading("second", self.second)
        keep_checked(self, weight=FRACTION)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The directions at which one of the two has a kink or a jump [rad]."""
        return tuple(b for model in (self.first, self.second) for b in getattr(model, "breaks", ()))

    @property
    def frequency_breaks(self) -> tuple[float, ...]:
        """The frequencies at which one of the two has a kink [rad/s]."""
        return tuple(
            b for model in (self.first, self.second) for b in getattr(model, "frequency_breaks", ())
        )

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """Return D at `omega` and `theta`, [1/rad]."""
        return (1.0 - self.weight) * self.first(omega, theta, peak) + self.weight * self.second(
            omega, theta, peak
        )


SPREADINGS.add(
    "blend",
    Blend,
    Way(Blend, first=Part("spreading"), second=Part("spreading"), weight=FRACTION),
)
