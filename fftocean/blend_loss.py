"""
Loss of amplitude between two frames that are blended linearly, as most players of textures do.

Halfway between two frames dt apart, the mean of a wave's two phases is the wave itself times
cos(omega dt/2): the amplitude that is left at the worst moment. From omega dt = pi on, a wave turns
by half a period or more between frames: blending cannot follow it, and nothing is left. Over many
waves the squares count, weighted with energy for the heights; for the slopes, which the light sees,
with energy times k^2: short waves are quick, and it is they that flicker first.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from fftocean.arrays import Real
from fftocean.cascade import Cascade
from fftocean.errors import ParameterError
from fftocean.limits import FRAMES
from fftocean.ocean import Ocean

ENOUGH = 0.97
"""Share of the root mean square amplitude to keep: a loss of 3 % is not visible."""


@dataclass(frozen=True, slots=True)
class Blend:
    """Amplitude left by linear blending between frames, and numbers of frames that keep enough."""

    rate: float  # frames a second [1/s]
    # of the height of all waves of the tile, root mean square, halfway between two frames [-]
    kept: float
    kept_long: float  # of the height of the waves up to twice the peak frequency [-]
    kept_slopes: float  # of the slopes [-]
    enough_rate: float  # frames a second that keep 97 % of the height [1/s]
    enough_frames: int  # as many in a loop
    enough_rate_slopes: float  # that keep 97 % of the slopes [1/s]
    enough_frames_slopes: int


def loss(ocean: Ocean | Cascade, frames: int) -> Blend:
    """
    Return the amplitude left between the frames of a loop; of a cascade, that of all tiles.

    Raises:
        ParameterError: the ocean does not loop, or `frames` is out of range.

    Pinned by tests/test_blend_loss.py: the closed form on one wave, and blended frames of a sea.
    """
    if ocean.loop is None:
        raise ParameterError("blend loss needs an ocean that loops: Ocean(..., loop=16.0)")
    frames = FRAMES.check("frames", frames)
    energy, omega, k = _waves(ocean)
    long = omega <= 2.0 * _peak(ocean, energy, omega)
    step = ocean.loop / frames
    rate, rate_slopes = (1.0 / _longest_step(weight, omega) for weight in (energy, energy * k**2))
    return Blend(
        rate=1.0 / step,
        kept=_kept(energy, omega, step),
        kept_long=_kept(energy[long], omega[long], step),
        kept_slopes=_kept(energy * k**2, omega, step),
        enough_rate=rate,
        enough_frames=_frames(rate, ocean.loop),
        enough_rate_slopes=rate_slopes,
        enough_frames_slopes=_frames(rate_slopes, ocean.loop),
    )


def describe(ocean: Ocean | Cascade, frames: int) -> dict[str, Any]:
    """Return `loss` as plain data for the manifest."""
    b = loss(ocean, frames)
    return {
        "what": "amplitude left halfway between two frames that are blended linearly: root "
        "mean square of cos(omega dt/2) over the waves",
        "frames_per_second": b.rate,
        "height": b.kept,
        "height_up_to_twice_the_peak": b.kept_long,
        "slopes": b.kept_slopes,
        "enough": {
            "amplitude": ENOUGH,
            "height": {"frames_per_second": b.enough_rate, "frames": b.enough_frames},
            "slopes": {"frames_per_second": b.enough_rate_slopes, "frames": b.enough_frames_slopes},
        },
    }


def sentence(blend: Mapping[str, Any]) -> str:
    """Return one line on a loss that `describe` returned, or a manifest holds."""
    height, slopes, enough = blend["height"], blend["slopes"], blend["enough"]
    line = (
        f"blending frames at {blend['frames_per_second']:.3g} a second keeps "
        f"{100 * height:.1f} % of the waves' height and {100 * slopes:.1f} % of their slopes"
    )
    if slopes >= enough["amplitude"]:
        return line
    share = f"{100 * enough['amplitude']:.0f} %"
    if height < enough["amplitude"]:
        line += f"; {enough['height']['frames']} frames keep {share} of the height, "
    else:
        line += "; "
    return line + (
        f"{enough['slopes']['frames']} frames ({enough['slopes']['frames_per_second']:.3g} a "
        f"second) keep {share} of the slopes"
    )


def _waves(ocean: Ocean | Cascade) -> tuple[Real, Real, Real]:
    """
    Return energies, up to a factor, running frequencies and wavenumbers of the waves of the half
    plane of each tile, +k and -k together.
    """
    parts = []
    for tile in ocean.oceans if isinstance(ocean, Cascade) else (ocean,):
        a = tile.amplitudes
        energy = a.squares
        energy[:, 0] *= 0.5  # the column mx = 0 holds both k and -k, the others stand for theirs
        there = energy > 0.0
        parts.append((energy[there], a.running_omega[there], a.grid.k[there]))
    energy, omega, k = (np.concatenate(column) for column in zip(*parts, strict=True))
    return energy, omega, k


def _frames(rate: float, loop: float) -> int:
    """Return the least number of frames in a loop that gives a rate."""
    return max(1, math.ceil(rate * loop - 1e-9))


def _peak(ocean: Ocean | Cascade, energy: Real, omega: Real) -> float:
    """Return the peak frequency: the sea's, or the strongest wave's without a sea [rad/s]."""
    if ocean.sea is not None and (tp := ocean.sea.tp) > 0.0:
        return 2.0 * math.pi / tp
    return float(omega[np.argmax(energy)]) if energy.size else 0.0


def _kept(energy: Real, omega: Real, step: float) -> float:
    """Return the root mean square of max(cos(omega step/2), 0) over the energy; 1 without waves."""
    if not energy.size:
        return 1.0
    left = np.cos(np.minimum(0.5 * step * omega, 0.5 * math.pi))
    return math.sqrt(float(np.sum(energy * left**2) / np.sum(energy)))


def _longest_step(energy: Real, omega: Real) -> float:
    """
    The longest step that keeps `ENOUGH` [s], by bisection of its logarithm, as less is kept the
    longer it is; inf without waves.
    """
    if not energy.size:
        return math.inf
    short, long = (
        2.0 * math.acos(ENOUGH) / extreme
        for extreme in (float(np.max(omega)), float(np.min(omega)))
    )
    while long / short > 1.0 + 1e-12:
        middle = math.sqrt(short * long)
        short, long = (middle, long) if _kept(energy, omega, middle) >= ENOUGH else (short, middle)
    return short
