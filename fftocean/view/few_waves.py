"""
Few-wave models of a sea for the live page: at most 64 waves with whole cycles in a loop.

Each model of `fftocean.gerstner` is set so that its waves have the variance, the peak period and
the mean direction of the sea. `SlideWaves` and `SteepnessWaves` take a wave for each of many bands
of its spectrum; `PMS` and `CWR` have a rule of their own for the waves beside the peak.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError, described
from fftocean.gerstner import CWR, PMS, SlideWaves, SteepnessWaves, Waves, WaveSurface
from fftocean.limits import LOOP, SEED, Count
from fftocean.noise import unit_phasors
from fftocean.physics.moments import mean_direction_and_spread
from fftocean.physics.panels import energetic_frequencies, frequency_panels
from fftocean.physics.sea import Sea
from fftocean.polar_spectrum import polar_spectrum

MOST_WAVES = 64
NUMBER = Count("", 1, MOST_WAVES)
TICKS = Count("", 2, 2**20)

_HIGHEST = 6.0  # peaks: the highest frequency of a wave that is taken from the spectrum
_RINGS, _SECTORS = 160, 72
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
_ANGLES = 0.8  # [rad] from the first to the last direction of PMS and CWR: the note's three waves
_FREQUENCIES = 4.0  # ratio of the last frequency to the first of PMS
_WAVELENGTHS = 16.0  # ratio of the longest wave to the shortest of CWR
_FARTHEST = 1e4  # [m] from the place where all crests of a model meet


@dataclass(frozen=True, slots=True)
class FewWaves:
    """
    The waves of a model as the page shows them, each with a whole number of cycles in the loop.

    At tick j of `ticks` the phase of a wave is k.x - 2 pi cycles j / ticks - phase, where the
    product of whole numbers is exact.
    """

    name: str  # of the model, a key of `MODELS`
    waves: Waves  # with the frequencies 2 pi cycles / loop
    cycles: Integer  # of each wave in a loop
    loop: float  # [s]
    ticks: int  # in a loop, a power of two

    def at(self, x0: Any, y0: Any, tick: int) -> WaveSurface:
        """Return the surface at rest positions at a tick, summed wave by wave in float64."""
        return self.waves.at(x0, y0, self.loop * (tick % self.ticks) / self.ticks)

    def document(self) -> dict[str, Any]:
        """Return the waves as the page reads them, ready for JSON: a column for each quantity."""
        columns = ("kx", "ky", "amplitude", "sharpness", "phase")
        return {
            "model": self.name,
            "caption": CAPTIONS[self.name],
            "loop": self.loop,
            "ticks": self.ticks,
            "variance": self.waves.variance,
            **{name: getattr(self.waves, name).tolist() for name in columns},
            "cycles": self.cycles.tolist(),
        }


@dataclass(frozen=True, slots=True)
class _Request:
    """Sea and settings that a model is made of."""

    sea: Sea
    variance: float  # of the sea [m^2]
    number: int
    seed: int
    steepness: float


def few_waves(
    sea: Sea,
    model: str,
    *,
    number: int = 48,
    loop: float,
    ticks: int = 2**19,
    seed: int = 0,
    steepness: float = 1.0,
) -> FewWaves:
    """
    Return the waves of a few-wave model with the variance and the peak of a sea.

    All waves are those of deep water, as in the models. The models let all crests meet at one
    place; the waves are those around another place, far from it, which `seed` selects.

    Args:
        sea: the specified sea.
        model: a key of `MODELS`.
        number: of waves, 1 to 64.
        loop: period after which all waves repeat [s].
        ticks: number of moments in a loop, a power of two.
        seed: of directions and phases, and of the place.
        steepness: of `PMS` and `CWR`: 0 is sines, 1 as sharp as can be without folding.

    Raises:
        ParameterError: a value out of its range, or a loop with too many cycles for its ticks.
    """
    if not isinstance(sea, Sea):
        raise ParameterError(f"few waves must be made of a Sea, got {described(sea)}")
    if not isinstance(model, str) or model not in MODELS:
        raise ParameterError(f"model must be one of {', '.join(MODELS)}, got {described(model)}")
    number, loop = NUMBER.check("number", number), LOOP.check("loop", loop)
    ticks, seed = TICKS.check("ticks", ticks), SEED.check("seed", seed)
    if ticks & (ticks - 1):
        raise ParameterError(f"ticks must be a power of two, got {ticks}")
    variance = _variance(sea)
    if variance > 0.0:
        made = MODELS[model](_Request(sea, variance, number, seed, steepness)).waves
    else:
        made = SlideWaves(A=0.0, k=1.0).waves
    return looped(model, _elsewhere(made, seed), loop, ticks)


def looped(name: str, waves: Waves, loop: float, ticks: int) -> FewWaves:
    """
    Return waves with each frequency moved to the nearest whole number of cycles in a loop.

    Raises:
        ParameterError: more than 64 waves, waves that start from rest, or cycles x ticks beyond
            2^32.
    """
    if len(waves) > MOST_WAVES:
        raise ParameterError(f"a few-wave model must have at most {MOST_WAVES}, got {len(waves)}")
    if waves.tau:
        raise ParameterError(f"waves of a loop must have no start, tau = 0, got {waves.tau} s")
    step = 2.0 * math.pi / loop
    cycles = np.maximum(np.rint(waves.omega / step), 1.0)
    if not cycles.max() * ticks < 2**32:
        raise ParameterError(
            f"cycles in the loop times ticks must be below 2^32, got {cycles.max():.0f} x {ticks}; "
            "a shorter loop has fewer cycles"
        )
    return FewWaves(name, replace(waves, omega=cycles * step), cycles.astype(np.int64), loop, ticks)


def _elsewhere(waves: Waves, seed: int) -> Waves:
    """Return the same waves around another place, which becomes the origin."""
    place = np.angle(unit_phasors(seed, np.array([1, 2]), np.array([0, 0]))) / math.pi * _FARTHEST
    away = waves.phase - waves.kx * place[0] - waves.ky * place[1]
    return replace(waves, phase=np.remainder(away, 2.0 * math.pi))


def _pms(request: _Request) -> PMS:
    """Return waves by the Pierson-Moskowitz rule around the sea's peak."""
    sea, number = request.sea, request.number
    model = PMS(
        number=number,
        period=sea.tp,
        scale=_FREQUENCIES ** (1.0 / (number - 1)) if number > 1 else 1.5,
        angle=_ANGLES / max(number - 1, 1),
        steepness=request.steepness,
    )
    gain = math.sqrt(request.variance / model.waves.variance)
    return replace(model, gain=gain, direction=_turned(sea, model.waves))


def _cwr(request: _Request) -> CWR:
    """Return waves of one ratio of height to length, of which the longest is at the sea's peak."""
    sea, number = request.sea, request.number
    scale = min(2.0, _WAVELENGTHS ** (1.0 / (number - 1))) if number > 1 else 2.0
    model = CWR(
        number=number,
        period=sea.tp * scale ** (-0.25 * (number - 1)),
        amplitude=1e-3,
        scale=scale,
        angle=_ANGLES / max(number - 1, 1),
        steepness=request.steepness,
    )
    amplitude = 1e-3 * math.sqrt(request.variance / model.waves.variance)
    return replace(model, amplitude=amplitude, direction=_turned(sea, model.waves))


def _slides(request: _Request) -> SlideWaves:
    """Return a wave for each band of the spectrum, with a random phase."""
    omega, theta, amplitude = _from_spectrum(request)
    index = np.arange(omega.size)
    return SlideWaves(
        A=amplitude.tolist(),
        k=(omega**2 / GRAVITY).tolist(),
        gamma=theta.tolist(),
        phi=np.angle(unit_phasors(request.seed, index, np.full_like(index, 3))).tolist(),
    )


def _steepness_waves(request: _Request) -> SteepnessWaves:
    """Return a wave for each band of the spectrum, by wavelength and steepness."""
    omega, theta, amplitude = _from_spectrum(request)
    k = omega**2 / GRAVITY
    return SteepnessWaves(
        wavelength=(2.0 * math.pi / k).tolist(),
        steepness=(k * amplitude).tolist(),
        direction=np.degrees(theta).tolist(),
    )


MODELS: dict[str, Callable[[_Request], PMS | CWR | SlideWaves | SteepnessWaves]] = {
    "pms": _pms,
    "cwr": _cwr,
    "slides": _slides,
    "steepness": _steepness_waves,
}
"""Every model by its name on the page."""

CAPTIONS = {
    "pms": "Pierson-Moskowitz sampling (PMS)",
    "cwr": "constant ratio of height to length (CWR)",
    "slides": "waves by amplitude, wavenumber and angle (SlideWaves)",
    "steepness": "waves by wavelength and steepness (SteepnessWaves)",
}


def _variance(sea: Sea) -> float:
    """
    Return m0 of a sea [m^2], to 1e-5: faster than `Sea.variance`, for a slider that is moved.
    """
    total = 0.0
    for system in sea.systems:
        energy = energetic_frequencies(system, frequency_panels(system).edges)[1]
        total += float(np.sum(energy))
    return total


def _turned(sea: Sea, waves: Waves) -> float:
    """Return the direction that gives waves made for direction 0 the mean one of a sea [deg]."""
    variance, _, theta = _cells(sea)
    wanted = mean_direction_and_spread(variance, np.broadcast_to(theta, variance.shape))[0]
    return wanted - mean_direction_and_spread(waves.amplitude**2, np.arctan2(waves.ky, waves.kx))[0]


def _cells(sea: Sea) -> tuple[Real, Real, Real]:
    """Return a sea's variance in cells of frequency and direction, and their middles."""
    peaks = [float(system.spectrum.peak) for system in sea.systems]
    cells = polar_spectrum(sea, _HIGHEST * max(peaks) / (2.0 * math.pi), _RINGS, _SECTORS)
    omega = math.pi * (cells.frequency[1:] + cells.frequency[:-1])
    return cells.density, omega, 0.5 * (cells.theta[1:] + cells.theta[:-1])


def _from_spectrum(request: _Request) -> tuple[Real, Real, Real]:
    """
    Return frequency [rad/s], direction [rad] and amplitude [m] of waves that sample a spectrum.

    Bands have equal shares of the integral of sqrt(omega S) over ln omega, so that most are near
    the peak and some are short waves. Each wave has the variance of its band; together they have
    that of the sea. Directions step through the distribution of their band by the golden ratio, so
    that they cover it evenly.
    """
    number, seed = request.number, request.seed
    density, omega, _ = _cells(request.sea)
    variance = np.sum(density, axis=1)
    weight = np.cumsum(np.sqrt(variance / omega))
    band = np.minimum((weight / weight[-1] * number).astype(int), number - 1)
    share = np.bincount(band, variance, minlength=number)
    kept = np.flatnonzero(share > 0.0)
    middle = np.bincount(band, variance * omega, minlength=number)[kept] / share[kept]
    start = float(np.angle(unit_phasors(seed, np.array([0]), np.array([4])))[0]) / (2.0 * math.pi)
    direction = np.empty(kept.size)
    for i, one in enumerate(kept):
        around = np.cumsum(np.sum(density[band == one], axis=0))
        level = (start + i * _GOLDEN) % 1.0
        edges = np.concatenate([[0.0], around / around[-1]])
        direction[i] = np.interp(level, edges, np.arange(_SECTORS + 1.0)) * 2.0 * math.pi / _SECTORS
    amplitude = np.sqrt(2.0 * share[kept] * (request.variance / np.sum(share)))
    return middle, direction, amplitude
