"""
Mean foam coverage of a sea, and the threshold that gives the coverage of a wind.

At a rest position the displacement gradient of many waves is a Gaussian process in time. Its
covariance at each frequency is a sum over the waves, so time series at random positions cost a
Fourier transform each, and no frame is computed. The foam equation (see `foam`) is linear in the
state f, so the mean of f is tau times strength times the mean of max(threshold - eigenvalue, 0), an
integral over three Gaussian variables. From the series comes only the coverage for each unit of f:
the mean of 1 - e^{-f} by the mean of f, which is near 1 for little foam and changes slowly.

The threshold depends on the shortest waves that are seen. With the waves of 11 m/s, say, and three
tiles of 128^2 over 420, 61 and 8.3 m, it is 0.65 with all waves, 0.68 without those shorter than
0.25 m, 0.70 from 0.5 m, 0.72 from 1 m, 0.74 from 2 m and 0.77 from 4 m on.
"""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from fftocean.amplitudes import Amplitudes
from fftocean.arrays import Real
from fftocean.cascade import Cascade
from fftocean.errors import ParameterError, described
from fftocean.fields import potential_factor
from fftocean.kernels import foam as kernel
from fftocean.limits import FOAM_STRENGTH, FOAM_TAU, FOAM_THRESHOLD, WIND_SPEED, Quantity
from fftocean.ocean import Ocean
from fftocean.physics import dispersion
from fftocean.physics.panels import gauss_rule

_WAVELENGTH = Quantity("m", 0.0, math.inf)
_MOST_COVERED = 0.95  # that a threshold is looked for
COVERAGE = Quantity("", 0.0, _MOST_COVERED)
_VALUES = 2**18  # of all time series together: short waves have longer ones, at fewer points
_PERIOD = 64.0  # of the time series [s]
_SAMPLES = 1024  # of a time series, at least
_MOST_SAMPLES = 8192
_EVERY = 2  # samples between two values of coverage
_RADII, _ANGLES = 64, 64  # of the integral over two Gaussian variables
_FARTHEST = 9.0  # standard deviations


class GivenWaves(NamedTuple):
    """Waves of tiles that no ocean is made of."""

    tiles: tuple[Amplitudes, ...]
    choppiness: float  # [-]


def whitecap_coverage(wind_speed: float) -> float:
    """
    Return the mean share of the sea that whitecaps cover, 3.84e-6 U^3.41, at most 1.

    It is the robust biweight fit of the paper, whose fit by least squares, 2.95e-6 U^3.52, is
    within 11 % of it from 4 to 20 m/s.

    Args:
        wind_speed: 10 m above the sea [m/s].

    Source: Monahan & O'Muircheartaigh, Optimal power-law description of oceanic whitecap coverage
    dependence on wind speed, J. Phys. Oceanogr. 10 (1980), 2094-2099.
    """
    wind_speed = WIND_SPEED.check("wind_speed", wind_speed)
    return min(3.84e-6 * float(wind_speed**3.41), 1.0)


def threshold_for(
    source: Cascade | Ocean | GivenWaves,
    wind_speed: float,
    *,
    tau: float = 3.5,
    strength: float = 60.0,
    shortest: float = 0.0,
) -> float:
    """
    Return the threshold at which the foam of summed tiles covers what whitecaps cover in a wind.

    Args:
        source: the water; the threshold is that of its realised waves and its choppiness.
        wind_speed: 10 m above the sea [m/s]; in still air no water foams.
        tau, strength, shortest: as of `threshold_of_coverage`.

    Returns:
        That of `threshold_of_coverage`. Coverages above 95 %, which the law has for winds from 38
        m/s on, are taken as 95 %.

    Raises:
        ParameterError: no cascade or ocean, or a value out of range.
    """
    target = min(whitecap_coverage(wind_speed), _MOST_COVERED)
    return threshold_of_coverage(source, target, tau=tau, strength=strength, shortest=shortest)


def threshold_of_coverage(
    source: Cascade | Ocean | GivenWaves,
    coverage: float,
    *,
    tau: float = 3.5,
    strength: float = 60.0,
    shortest: float = 0.0,
) -> float:
    """
    Return the threshold at which the foam of summed tiles covers a share of the water on average.

    It does not depend on the samples of a grid, but on the waves: finer tiles have steeper water
    and a lower threshold.

    Args:
        source: the water; the threshold is that of its realised waves and its choppiness.
        coverage: the share, 0 to 0.95; for 0 no water foams.
        tau, strength: as of `Foam`.
        shortest: waves shorter than this are left out [m], as by `Window`.

    Returns:
        At most 1: where even that gives less foam, as on flat water, it is 1.

    Raises:
        ParameterError: no cascade or ocean, or a value out of range.

    Pinned by tests/test_foam_coverage.py, against the foam of windows.
    """
    target = COVERAGE.check("coverage", coverage)
    foam = _FoamStatistics(source, tau, strength, shortest)
    if target == 0.0:
        return FOAM_THRESHOLD.low
    ratio, threshold = 1.0, 1.0
    # -ln(1 - coverage) by the mean of f is near 1, and so changes slowly, from no foam to all foam
    for _ in range(20):
        before, threshold = threshold, foam.threshold_of_mean(-math.log1p(-target) / ratio)
        if abs(threshold - before) < 1e-6 or threshold == 1.0:
            break
        ratio = -math.log1p(-foam.coverage(threshold)) / foam.mean(threshold)
    return threshold


def mean_coverage(
    source: Cascade | Ocean,
    threshold: float,
    *,
    tau: float = 3.5,
    strength: float = 60.0,
    shortest: float = 0.0,
) -> float:
    """
    Return the mean over time and space of the foam coverage, 0 to 1; arguments as of
    `threshold_for`.
    """
    threshold = FOAM_THRESHOLD.check("threshold", threshold)
    return _FoamStatistics(source, tau, strength, shortest).coverage(threshold)


class _FoamStatistics:
    """The foam of Gaussian water that has the displacement gradients of some waves."""

    def __init__(
        self, source: Cascade | Ocean | GivenWaves, tau: float, strength: float, shortest: float
    ) -> None:
        if not isinstance(source, (Cascade, Ocean, GivenWaves)):
            raise ParameterError(f"source must be a Cascade or an Ocean, got {described(source)}")
        self._tau = FOAM_TAU.check("tau", tau)
        self._strength = FOAM_STRENGTH.check("strength", strength)
        shortest = _WAVELENGTH.check("shortest", shortest)
        self._period = min(max(_PERIOD, 8.0 * self._tau), 8.0 * _PERIOD)
        stretch, omega = _stretches(source, shortest)
        self._covariance = _covariance(stretch, omega, self._period)
        self._water = _Water.of(stretch)
        self._eigenvalue: Real | None = None

    def mean(self, threshold: float) -> float:
        """Return the mean of the state f."""
        return self._tau * self._strength * self._water.mean_below(threshold)

    def threshold_of_mean(self, mean: float) -> float:
        """Return the threshold at which f has a given mean > 0; 1 where there is none below."""
        from scipy.optimize import brentq

        if not self.mean(1.0) > mean:
            return 1.0
        low = 0.5
        while self.mean(low) > mean:
            low -= 0.5

        def misfit(threshold: float) -> float:
            return math.log(max(self.mean(threshold), 1e-300) / mean)

        return float(brentq(misfit, low, 1.0, xtol=1e-8))

    def coverage(self, threshold: float) -> float:
        """
        Return the mean of 1 - e^{-f}: the mean of f, times the coverage by f in time series.
        """
        if self._eigenvalue is None:
            self._eigenvalue = _series(self._covariance, self._period)
        step = self._period / self._eigenvalue.shape[1]
        decay = math.exp(-step / self._tau)
        gain = -math.expm1(-step / self._tau) * self._tau * self._strength
        covered, total = kernel.means_on_loop(self._eigenvalue, threshold, gain, decay, _EVERY)
        mean = self.mean(threshold)
        return min(mean * covered / total if total > 0.0 else mean, 1.0 - 1e-9)


@dataclass(frozen=True, slots=True)
class _Water:
    """
    The smallest eigenvalue 1 + m - sqrt(d^2 + o^2) of the deformation gradient of many waves.

    m and d are half the sum and half the difference of the entries on the diagonal, o is the one
    beside it. They are Gaussian; with d and o given, m is Gaussian about a linear function of both.
    A wave of given amplitude is not: the sum of many has a negative kurtosis, and extremes are a
    little rarer. By how much is taken from the direction in which the water is stretched most.
    """

    distance: Real  # sqrt(d^2 + o^2) less the mean of m, at points (d, o)
    weight: Real  # of each point
    deviation: float  # of m about its mean at given d and o
    largest: float  # standard deviation of the stretch along any direction
    kurtosis: float  # excess, in that direction

    @classmethod
    def of(cls, stretch: Real) -> "_Water":
        """Return the distribution for root mean square stretches (xx, yy, xy) of waves, (3, m)."""
        turned = np.array([[0.5, 0.5, 0.0], [0.5, -0.5, 0.0], [0.0, 0.0, 1.0]])
        covariance = stretch @ stretch.T
        whole = turned @ covariance @ turned.T
        inner = whole[1:, 1:]
        values, vectors = np.linalg.eigh(inner)
        spread = vectors * np.sqrt(np.maximum(values, 0.0))
        slope = np.linalg.pinv(inner, rcond=1e-9, hermitian=True) @ whole[1:, 0]
        # long-crested water has no scatter: a little rounds the corner at the threshold
        scatter = max(whole[0, 0] - slope @ whole[1:, 0], 1e-3 * whole[0, 0], 1e-18)
        x, w = gauss_rule(_RADII)
        radius = 0.5 * _FARTHEST * (1.0 + x)
        angle = (np.arange(_ANGLES) + 0.5) * (2.0 * np.pi / _ANGLES)
        weight = 0.5 * _FARTHEST * w * radius * np.exp(-0.5 * radius**2) / _ANGLES
        circle = spread @ np.stack([np.cos(angle), np.sin(angle)])
        d, o = (radius[:, None] * component for component in circle)
        distance = np.hypot(d, o) - slope[0] * d - slope[1] * o
        along = np.stack([np.cos(angle) ** 2, np.sin(angle) ** 2, np.sin(2.0 * angle)])
        most = along[:, np.argmax(np.einsum("ia,ij,ja->a", along, covariance, along))]
        largest = math.sqrt(max(float(most @ covariance @ most), 1e-18))
        kurtosis = -1.5 * float(np.sum((most @ stretch / largest) ** 4))
        deviation = math.sqrt(float(scatter))
        return cls(distance.ravel(), np.repeat(weight, _ANGLES), deviation, largest, kurtosis)

    def mean_below(self, threshold: float) -> float:
        """Return the mean of max(threshold - eigenvalue, 0)."""
        from scipy.special import ndtr

        y = (threshold - 1.0 + self.distance) / self.deviation
        mean = self.deviation * float(np.sum(self.weight * (y * ndtr(y) + _normal(y))))
        # the Edgeworth series of one stretch: the fourth derivative of its mean by the mean itself,
        # times kurtosis / 24, and in an exponent, so that the mean stays positive
        z = min((1.0 - threshold) / self.largest, _FARTHEST)
        one = _normal(z) - z * ndtr(-z)
        return mean * math.exp(self.kurtosis / 24.0 * (z * z - 1.0) * _normal(z) / one)


def _normal(x: Any) -> Any:
    """Return the density of the normal distribution."""
    return np.exp(-0.5 * np.square(x)) / math.sqrt(2.0 * math.pi)


def _stretches(source: Cascade | Ocean | GivenWaves, shortest: float) -> tuple[Real, Real]:
    """
    Return the root mean square stretch (xx, yy, xy), (3, m), and omega, (m,), of the waves, with
    choppiness.
    """
    if isinstance(source, GivenWaves):
        tiles = source.tiles
    else:
        oceans = source.oceans if isinstance(source, Cascade) else (source,)
        tiles = tuple(ocean.amplitudes for ocean in oceans)
    stretches, omegas = [], []
    for a in tiles:
        grid = a.grid
        variance = 2.0 * a.squares
        variance[:, 0] *= 0.5  # the column mx = 0 holds both k and -k
        k = grid.k
        rows, columns = np.nonzero((variance > 0.0) & (k * shortest <= 2.0 * np.pi))
        k, kx, ky = k[rows, columns], grid.kx[columns], grid.ky[rows]
        factor = potential_factor(k, a.depth) * np.sqrt(variance[rows, columns])
        stretches.append(source.choppiness * factor * np.stack([kx * kx, ky * ky, kx * ky]))
        omegas.append(dispersion.angular_frequency(k, a.depth, a.surface_tension))
    return np.concatenate(stretches, axis=1), np.concatenate(omegas)


def _covariance(stretch: Real, omega: Real, period: float) -> Real:
    """Return the covariance of stretches by the cycles of the waves in a period, (cycles, 3, 3)."""
    cycle = np.rint(omega * (period / (2.0 * np.pi))).astype(np.int64)
    # waves too fast for the longest series: slower ones have the same sum at every moment
    cycle = np.minimum(cycle, _MOST_SAMPLES // 2 - 1)
    count = int(np.max(cycle, initial=0)) + 1
    covariance = np.empty((count, 3, 3))
    for i in range(3):
        for j in range(i + 1):
            summed = np.bincount(cycle, stretch[i] * stretch[j], count)
            covariance[:, i, j] = covariance[:, j, i] = summed
    return covariance


def _series(covariance: Real, period: float) -> Real:
    """
    Return time series of the smallest eigenvalue at random points, (points, samples), float32.

    The numbers behind them are always the same, so that a threshold follows a slider smoothly.
    """
    from scipy import fft

    cycles = covariance.shape[0]
    least = max(_SAMPLES * period / _PERIOD, 2.0 * cycles)
    samples = min(2 ** math.ceil(math.log2(least)), _MOST_SAMPLES)
    points = _VALUES // samples
    values, vectors = np.linalg.eigh(covariance)
    spread = (vectors * np.sqrt(np.maximum(values, 0.0))[:, None, :]).astype(np.float32)
    chance = np.random.default_rng(0)
    # one frequency after another, so that a longer series keeps the numbers of a shorter one
    normals = chance.standard_normal((cycles, 3, 2 * points), dtype=np.float32)
    summed = np.matmul(spread, normals)
    spectra = np.zeros((3, points, samples // 2 + 1), dtype=np.complex64)
    parts = summed.reshape(cycles, 3, 2, points).transpose(1, 3, 0, 2)
    spectra[:, :, :cycles].real, spectra[:, :, :cycles].imag = parts[..., 0], parts[..., 1]
    xx, yy, xy = fft.irfft(spectra, samples, axis=2, overwrite_x=True) * np.float32(0.5 * samples)
    eigenvalue: Real = 1.0 + 0.5 * (xx + yy) - np.sqrt(np.square(0.5 * (xx - yy)) + np.square(xy))
    return eigenvalue
