"""Goda-Suzuki spreading, Mitsuyasu's law with a given exponent at the peak."""

from dataclasses import dataclass

from fftocean.arrays import Real, RealLike
from fftocean.limits import SPREADING_EXPONENT, keep_checked
from fftocean.physics.kinds import Way
from fftocean.physics.spreading.base import SPREADINGS, relative, wrapped
from fftocean.physics.spreading.cosine_power import cosine_2s
from fftocean.physics.spreading.mitsuyasu import peaked_exponent


@dataclass(frozen=True, slots=True)
class GodaSuzuki:
    """
    Mitsuyasu's law with a given s at the peak: 10 for wind waves, 25 for young swell, 75 for swell
    from far away.

    Args:
        s_max: s at the peak [-].

    Raises:
        ParameterError: an exponent out of its range.

    Source: Goda & Suzuki 1975; Goda, Random Seas and Design of Maritime Structures.
    """

    s_max: float

    def __post_init__(self) -> None:
        keep_checked(self, s_max=SPREADING_EXPONENT)

    def exponent(self, omega: RealLike, peak: float) -> Real:
        """Return the exponent s [-] at `omega` [rad/s], at most `SHARPEST`, shaped like it."""
        return peaked_exponent(relative(omega, peak), self.s_max)

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """Return D at `omega` and `theta`, [1/rad]."""
        return cosine_2s(self.exponent(omega, peak), wrapped(theta))


SPREADINGS.add("goda-suzuki", GodaSuzuki, Way(GodaSuzuki, s_max=SPREADING_EXPONENT))
