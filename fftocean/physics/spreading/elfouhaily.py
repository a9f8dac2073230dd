"""Spreading of the unified spectrum of Elfouhaily et al. (1997)."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.constants import GRAVITY, SURFACE_TENSION
from fftocean.limits import DEPTH, WIND_SPEED, Quantity, check_bool, keep_checked
from fftocean.limits import SURFACE_TENSION as SURFACE_TENSION_RANGE
from fftocean.physics.dispersion import wavenumber
from fftocean.physics.kinds import Switch, Way
from fftocean.physics.spreading.base import SPREADINGS, wrapped

FRICTION_VELOCITY = Quantity("m/s", 0.0, 20.0)

SHORT_PEAK: Final = 370.0
"""
k_m [rad/m]: the wavenumber of the slowest wave, 1.7 cm long, where gravity and surface tension pull
alike  (Elfouhaily et al. 1997).
"""

SLOWEST: Final = 0.23
"""c_m [m/s]: its speed."""


def friction_velocity(speed: float) -> float:
    """Return u* [m/s] under a wind of `speed` (U10) [m/s]  (Wu 1982)."""
    return speed * math.sqrt((0.8 + 0.065 * speed) * 1e-3)


def phase_speed(k: Real) -> Real:
    """Return the phase speed c of deep water in the unified spectrum [m/s]: slowest at k_m."""
    c: Real = np.sqrt(GRAVITY / k * (1.0 + (k / SHORT_PEAK) ** 2))
    return c


@dataclass(frozen=True, slots=True, kw_only=True)
class ElfouhailySpreading:
    """
    D = (1 + Delta cos 2 theta) / pi in the front half, Delta = tanh(ln2/4 + 4 (c/c_p)^2.5 + 0.13
    (u*/c_m) (c_m/c)^2.5).

    Narrow at the peak, nearly all round between, and narrow again at the ripples, which the wind
    combs.

    The paper writes it over the whole circle, as D/2, because a photograph cannot tell a wave from
    its opposite; taken at its word, half of the energy runs against the wind and the sea stands
    still. `both_ways=True` takes it at its word.

    Source: Elfouhaily et al. 1997, eq. 49, 57 and 59.
    """

    friction_velocity: float  # u* [m/s], as `Elfouhaily.friction_velocity` gives it
    both_ways: bool = False  # as many waves against the wind as with it
    depth: float = math.inf  # of the Sea [m]
    surface_tension: float = SURFACE_TENSION  # of the Sea [N/m]

    def __post_init__(self) -> None:
        keep_checked(
            self,
            friction_velocity=FRICTION_VELOCITY,
            depth=DEPTH,
            surface_tension=SURFACE_TENSION_RANGE,
        )
        check_bool("both_ways", self.both_ways)

    def delta(self, omega: RealLike, peak: float) -> Real:
        """Return Delta [-] at `omega` [rad/s]: (D(0) - D(90 degrees)) / (D(0) + D(90 degrees))."""
        omega = np.clip(np.asarray(omega, dtype=np.float64), 1e-4 * peak, 1e20)
        c = phase_speed(wavenumber(omega, self.depth, self.surface_tension))
        c_p = phase_speed(wavenumber(peak, self.depth, self.surface_tension))
        ripples = 0.13 * self.friction_velocity / SLOWEST
        delta: Real = np.tanh(
            math.log(2.0) / 4.0 + 4.0 * (c / c_p) ** 2.5 + ripples * (SLOWEST / c) ** 2.5
        )
        return delta

    def __call__(self, omega: RealLike, theta: RealLike, peak: float, /) -> Real:
        """Return D at `omega` and `theta`, [1/rad]."""
        theta = wrapped(theta)
        d = (1.0 + self.delta(omega, peak) * np.cos(2.0 * theta)) / np.pi
        return 0.5 * d if self.both_ways else np.where(np.abs(theta) < 0.5 * np.pi, d, 0.0)


def _from_wind(
    *, speed: float, depth: float, surface_tension: float, both_ways: bool = False
) -> ElfouhailySpreading:
    """Return the spreading under a wind of `speed` (U10) [m/s]."""
    return ElfouhailySpreading(
        friction_velocity=friction_velocity(speed),
        both_ways=both_ways,
        depth=depth,
        surface_tension=surface_tension,
    )


SPREADINGS.add(
    "elfouhaily",
    ElfouhailySpreading,
    Way(_from_wind, water=("depth", "surface_tension"), speed=WIND_SPEED, both_ways=Switch()),
    Way(
        ElfouhailySpreading,
        water=("depth", "surface_tension"),
        friction_velocity=FRICTION_VELOCITY,
        both_ways=Switch(),
    ),
)
