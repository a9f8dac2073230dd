"""
Limits that real seas keep: of wave height in water of some depth, and of steepness.

Waves of more than about 0.6 of the depth have broken, and a sea whose significant wave height is
more than that cannot last. (Single waves reach 0.78: McCowan 1894; seas in shallow water 0.5 to
0.6: Nelson 1994.) Where it is more than the depth itself, one linear trough in exp(8) = 3000 is
deeper than the water, and no linear surface can stand for such a sea.

The average wave steepness Sp = 2 pi Hs / (g Tp^2) of a sea is at most 1/15 up to Tp = 8 s and 1/25
from 15 s on, linear between (DNV-RP-C205, 3.5.5.3). The limit by Tp is taken and not that of Ss by
Tz, since Tz depends on where a measured or a capillary tail ends. Each wave system has its own.
"""

import math
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError, SeaWarning
from fftocean.physics.panels import gauss
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.physics.spectra.growth import BREAKING

_SLACK = 1.002  # of the quadrature below, and of a sea exactly at a limit
_ROUNDED = 1.02  # of the limits of steepness, which are given as whole fractions


@dataclass(frozen=True, slots=True)
class Plausibility:
    """A sea beside the limits that real seas keep."""

    hs: float  # significant wave height, within 1e-3 [m]
    depth: float  # [m]
    steepness: tuple[float, ...]  # 2 pi Hs / (g Tp^2) of each wave system [-]
    limits: tuple[float, ...]  # of each steepness [-]
    notes: tuple[str, ...]  # what passes a limit, in words

    def __str__(self) -> str:
        if self.notes:
            return "; ".join(self.notes)
        if not self.steepness:
            return "a flat sea"
        parts = [f"steepness {max(self.steepness):.2g}"]
        if math.isfinite(self.depth):
            parts.append(f"Hs {self.hs / self.depth:.2g} of the depth")
        return ", ".join(parts) + ": as real seas have"

    def as_plain(self) -> dict[str, Any]:
        """Return the numbers and the notes as plain data for JSON."""
        return {
            "hs_over_depth": self.hs / self.depth,
            "steepness": list(self.steepness),
            "steepness_limit": list(self.limits),
            "notes": list(self.notes),
        }


def plausibility(sea: Sea) -> Plausibility:
    """
    Return a sea beside the limits that real seas keep.

    Pinned by tests/physics/test_plausibility.py.
    """
    heights = [_height(system) for system in sea.systems]
    hs, periods = math.hypot(*heights), [2.0 * math.pi / s.spectrum.peak for s in sea.systems]
    steepness = tuple(
        2.0 * math.pi * h / (GRAVITY * tp**2) for h, tp in zip(heights, periods, strict=True)
    )
    limits = tuple(steepest(tp) for tp in periods)
    notes = []
    if hs > BREAKING * _SLACK * sea.depth:
        notes.append(
            f"the significant wave height of {hs:.3g} m is {hs / sea.depth:.2g} of the depth of "
            f"{sea.depth:g} m: above {BREAKING:g} most of such waves have broken"
        )
    for i, (value, limit) in enumerate(zip(steepness, limits, strict=True)):
        if value > _ROUNDED * limit:
            kind = type(sea.systems[i].spectrum).__name__
            notes.append(
                f"the waves of systems[{i}] ({kind}) are steeper than those of real seas: "
                f"2 pi Hs/(g Tp^2) is {value:.3g} for Hs {heights[i]:.3g} m and Tp "
                f"{periods[i]:.3g} s, and at most {limit:.3g} there (DNV-RP-C205)"
            )
    return Plausibility(hs, sea.depth, steepness, limits, tuple(notes))


def steepest(tp: float) -> float:
    """Return the largest 2 pi Hs / (g Tp^2) of a sea at a peak period [s]."""
    return float(np.interp(tp, [8.0, 15.0], [1.0 / 15.0, 1.0 / 25.0]))


def require_plausible(sea: Sea, *, stacklevel: int) -> None:
    """
    Warn of a sea beyond the limits of real seas, and refuse one whose troughs bare the bed.

    Args:
        sea: the sea that is about to be realised.
        stacklevel: as of `warnings.warn`, from the caller on.

    Raises:
        ParameterError: the significant wave height is more than the depth.
    """
    found = plausibility(sea)
    if found.hs > _SLACK * sea.depth:
        raise ParameterError(
            f"depth must be at least the significant wave height, as else troughs bare the bed, "
            f"got {sea.depth:g} m for waves of {found.hs:.3g} m"
        )
    for note in found.notes:
        warnings.warn(note, SeaWarning, stacklevel=stacklevel + 1)


def _height(system: WaveSystem) -> float:
    """
    Return 4 sqrt(m0) of a wave system [m], within 1e-3: Gauss panels in the logarithm of frequency,
    and none of the warnings and checks that `moments.moment` has.
    """
    spectrum = system.spectrum
    peak = float(spectrum.peak)
    breaks = np.asarray([peak, *getattr(spectrum, "breaks", ())], dtype=np.float64)
    edges = np.log(peak * np.array([0.02, *np.geomspace(0.2, 20.0, 41), 60.0, 200.0, 1000.0]))
    breaks = np.log(breaks[(breaks > 0.02 * peak) & (breaks < 1000.0 * peak)])
    edges = np.unique(np.concatenate([edges, breaks]))
    points, weights = gauss(edges[:-1], edges[1:], 4)
    omega = np.exp(points)
    with np.errstate(all="ignore"):
        density = np.asarray(spectrum(omega.ravel()), dtype=np.float64)
        m0 = float(np.sum(weights.ravel() * density * omega.ravel()))
    # what is no finite number >= 0 is refused where waves are made of it
    return 4.0 * math.sqrt(m0) if 0.0 <= m0 < math.inf else 0.0
