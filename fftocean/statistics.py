"""
Statistics of a sea: specified by its spectra, realised by the frames of an ocean.

The realised ones are measured on the fields themselves, not on the amplitudes they are made of.
"""

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fftocean.amplitudes import Amplitudes
from fftocean.arrays import Real
from fftocean.cascade import Cascade
from fftocean.cells import WHOLE, Band, Cells
from fftocean.errors import ParameterError, described
from fftocean.fields import DISPLACEMENT_GRADIENT
from fftocean.grid import Grid
from fftocean.kernels import interpolate
from fftocean.limits import FRAMES, LOOP
from fftocean.ocean import Frame, Ocean
from fftocean.physics import dispersion, moments, second_order
from fftocean.physics.panels import (
    direction_panels,
    energetic_frequencies,
    frequency_panels,
    gauss,
    parts_of,
)
from fftocean.physics.sea import Sea
from fftocean.physics.second_order import Components
from fftocean.physics.spreading import LongCrested
from fftocean.products import Folding, folding_of


@dataclass(frozen=True, slots=True)
class SeaState:
    """A sea in five numbers."""

    m0: float  # variance of the height [m^2]
    hs: float  # significant wave height, 4 sqrt(m0) [m]
    tp: float  # peak period [s]; 0 for a flat sea
    # toward which the energy goes, counter-clockwise from +x, in (-180, 180] [degrees]
    mean_direction: float
    spread: float  # circular standard deviation of the directions [degrees]


@dataclass(frozen=True, slots=True)
class LoopError:
    """
    Relative errors of the frequencies in a loop, weighted with energy.

    A loop of T seconds holds only frequencies of whole cycles in T.
    """

    period: float  # [s]
    rms: float  # [-]
    bias: float  # [-]; positive: the waves run too fast
    better_period: float  # within a tenth of `period`, the one with the least rms [s]
    better_rms: float  # [-]


@dataclass(frozen=True, slots=True)
class Skewness:
    """
    Skewness of the elevation over places, <eta^3>/<eta^2>^1.5, which linear waves have not.
    """

    specified: float | None  # of the sea, whose waves all interact; None for given waves [-]
    resolved: float  # of the waves that have bound waves, averaged over seeds [-]
    expected: float  # of the waves of this seed, averaged over time [-]
    realised: float  # in the frames that were measured; one has few waves, and scatters [-]

    @property
    def share(self) -> float:
        """Share of the specified skewness that the waves with bound waves have [-]."""
        return self.resolved / self.specified if self.specified else 0.0


@dataclass(frozen=True, slots=True)
class Statistics:
    """
    Statistics of one realisation, beside those of the specified sea.

    m0, hs, mean_direction and spread are those of the waves of this seed. A single frame of the
    same waves scatters further, since crossing waves beat: see `snapshot_error`.

    Args:
        m0: variance, averaged over time [m^2].
        hs: significant wave height, 4 sqrt(m0) [m].
        tp: peak period [s].
        mean_direction: mean direction, toward, counter-clockwise from +x [degrees].
        spread: directional spread [degrees].
        specified: statistics of the sea itself; None for an ocean of given waves.
        resolved: m0 of the part that the tile can hold, averaged over seeds [m^2].
        energy_below: m0 of waves longer than the tile, which it cannot hold [m^2].
        energy_above: m0 of waves shorter than two samples [m^2].
        sampling_error: relative standard deviation of m0 from seed to seed [-]; that of hs is half
            of it.
        snapshot_error: relative standard deviation of the variance of one frame [-].
        loop: error of the loop's frequencies; None without a loop, and for several tiles: measure
            each of `cascade.oceans`.
        folding: folds of the water at its choppiness, in the frames that were measured.
        skewness: skewness of a sea of order 2 on one tile.
    """

    m0: float
    hs: float
    tp: float
    mean_direction: float
    spread: float
    specified: SeaState | None
    resolved: float
    energy_below: float
    energy_above: float
    sampling_error: float
    snapshot_error: float
    loop: LoopError | None
    folding: Folding
    skewness: Skewness | None = None

    @property
    def ordered(self) -> SeaState | None:
        """The specified sea: the earlier name of `specified`."""
        return self.specified

    @property
    def hs_scatter(self) -> float:
        """Standard deviation of Hs from seed to seed [m]."""
        return 0.5 * self.sampling_error * self.hs

    @property
    def share_below(self) -> float:
        """Share of the specified energy in waves longer than the tile [-]; 0 for a flat sea."""
        return self._share(self.energy_below)

    @property
    def share_above(self) -> float:
        """Share of the specified energy in waves shorter than two samples [-]; 0 for a flat sea."""
        return self._share(self.energy_above)

    def _share(self, energy: float) -> float:
        m0 = 0.0 if self.specified is None else self.specified.m0
        return energy / m0 if m0 > 0.0 else 0.0

    def as_plain(self) -> dict[str, Any]:
        """
        Return the statistics as plain data for JSON, with None for infinity.

        The specified sea has the key "ordered", as in the manifests of all versions.
        """
        plain = {
            "ordered" if key == "specified" else key: value for key, value in asdict(self).items()
        }
        if math.isinf(self.folding.largest_choppiness):
            plain["folding"]["largest_choppiness"] = None
        if self.skewness is None:
            del plain["skewness"]
        return plain

    def _repr_html_(self) -> str:
        """Return a table of specified and realised statistics for notebooks."""
        from fftocean import notebook_html

        rows = []
        for name, key, unit, digits in (
            ("Hs", "hs", "m", 3),
            ("Tp", "tp", "s", 3),
            ("mean direction", "mean_direction", "degrees", 4),
            ("spread", "spread", "degrees", 3),
        ):
            values = [
                "" if state is None else f"{getattr(state, key):.{digits}g} {unit}"
                for state in (self.specified, self)
            ]
            scatter = f"{self.hs_scatter:.2g} m" if key == "hs" else ""
            rows.append((name, *values, scatter))
        heads = ("", "specified", "realised", "expected scatter")
        shown = notebook_html.table("Statistics", rows, heads=heads)
        return shown + notebook_html.line(str(self.folding))

    def __repr__(self) -> str:
        specified = "" if self.specified is None else f" of {self.specified.hs:.3g} m specified"
        return (
            f"Statistics(hs={self.hs:.3g} m{specified}, tp={self.tp:.3g} s, "
            f"mean_direction={self.mean_direction:.4g}, spread={self.spread:.3g} degrees, "
            f"folded={self.folding.share:.2g}, "
            f"largest_choppiness={self.folding.largest_choppiness:.3g})"
        )


def measure(ocean: Ocean | Cascade, *, frames: int = 1) -> Statistics:
    """
    Measure the realised statistics of an ocean, or of all tiles of a cascade together.

    Height and vertical velocity of the frame at t = 0 go through a forward FFT, which tells the
    waves along +k from those along -k (f, b = (H +- i H'/omega)/2); their energies give m0, the
    mean direction and spread, and the spectrum whose peak is Tp.

    Args:
        ocean: an ocean, or a cascade: its tiles have different waves, so their energies add up.
        frames: number of frames in which folds are looked for, equally spaced over the loop, or
            over ten peak periods.

    Returns:
        `Statistics`.

    Raises:
        ParameterError: neither an ocean nor a cascade, or a number of frames out of range.

    Source: mean direction and spread as Kuik et al. 1988; Tp = 2 pi (int S^4 / int omega S^4) as
    Young 1995.
    """
    if not isinstance(ocean, (Ocean, Cascade)):
        raise ParameterError(f"ocean must be an Ocean or a Cascade, got {described(ocean)}")
    given, ocean = ocean, ocean.linear()
    tiles = ocean.oceans if isinstance(ocean, Cascade) else (ocean,)
    forward, backward, omega, theta = (
        np.concatenate(column) for column in zip(*map(_measured_waves, tiles), strict=True)
    )
    energy = np.concatenate([forward, backward])
    m0 = float(np.sum(energy))
    direction, spread = moments.mean_direction_and_spread(
        energy, np.concatenate([theta, theta + np.pi])
    )
    sea, first, last = ocean.sea, tiles[0], tiles[-1]
    below = 0.0 if sea is None else outside_band(sea, first.grid, first.amplitudes.band)[0]
    above = 0.0 if sea is None else outside_band(sea, last.grid, last.amplitudes.band)[1]
    sampling, snapshot = _scatter([tile.amplitudes for tile in tiles])
    tp = peak_period(energy, np.concatenate([omega, omega]))
    return Statistics(
        m0=m0,
        hs=4.0 * math.sqrt(m0),
        tp=tp,
        mean_direction=direction,
        spread=spread,
        specified=None if sea is None else specified(sea),
        resolved=sum(tile.amplitudes.variance for tile in tiles),
        energy_below=below,
        energy_above=above,
        sampling_error=sampling,
        snapshot_error=snapshot,
        loop=None
        if len(tiles) > 1 or ocean.loop is None
        else loop_error(first.amplitudes, ocean.loop),
        folding=folding_over(tiles, FRAMES.check("frames", frames), 10.0 * tp),
        skewness=_skewness(given, frames, 10.0 * tp) if isinstance(given, Ocean) else None,
    )


def _skewness(ocean: Ocean, frames: int, span: float) -> Skewness | None:
    """Return the skewness of an ocean of order 2; frames as in `folding_over`."""
    if ocean.bound_waves is None:
        return None
    report = ocean.bound_waves.report
    period = span if ocean.loop is None else ocean.loop
    moments = np.zeros(4)
    for j in range(frames):
        moments += _area_moments(ocean.frame(j * period / frames, ("height", "jacobian")))
    first, second, third = (moments[1:] / moments[0]).tolist()
    variance = second - first**2
    central = third - 3.0 * first * second + 2.0 * first**3
    return Skewness(
        specified=None if ocean.sea is None else sea_skewness(ocean.sea),
        resolved=report.skewness,
        expected=report.realised,
        realised=central / variance**1.5 if variance > 0.0 else 0.0,
    )


def _area_moments(frame: Frame) -> Real:
    """
    Return the sums of 1, height, its square and its cube, over equal areas of the still level.

    A sample of the displaced surface stands for an area in proportion to its Jacobian. The lower
    sheet of a fold counts negative, so that of three sheets one is left.
    """
    height, area = frame.height.astype(np.float64), frame.jacobian.astype(np.float64)
    return np.array([float(np.sum(area * height**power)) for power in range(4)])


def sea_skewness(sea: Sea) -> float:
    """
    Return the skewness of the surface elevation of a sea at second order [-].

    Frequencies and directions are taken together in classes of equal ratio and of equal angle, of
    their mean wavenumber each; more and finer ones change it by 0.3 %.

    Source: Longuet-Higgins 1963.
    """
    variance, omega, theta = _classes(sea)
    if variance.size == 0:
        return 0.0
    # kernels are those of gravity waves
    k = dispersion.wavenumber(omega, sea.depth)
    waves = Components(k * np.cos(theta), k * np.sin(theta), omega)
    return second_order.skewness(waves, variance, sea.depth)


_WIDTHS = 1000.0
"""Widths of the largest tile over which the points are spread."""
_POINTS = 2**16
"""Points at which the water of several tiles is summed to look for folds."""


def folding_over(tiles: tuple[Ocean, ...], count: int, span: float) -> Folding:
    """
    Return the folds of all tiles together, in `count` frames over the loop, or over `span` [s].

    One tile is examined in all its samples. Several are summed at samples of the finest one, chosen
    at random over many widths of the largest, since tiles of different sizes meet differently in
    every width. The others, whose waves are longer, are interpolated.
    """
    period = tiles[0].loop if len({tile.loop for tile in tiles}) == 1 else None
    points = _points(tiles)
    total: Folding | None = None
    for j in range(count):
        t = j * (span if period is None else period) / count
        frames = [tile.frame(t, DISPLACEMENT_GRADIENT) for tile in tiles]
        if len(frames) == 1:
            xx, xy, yy = (frames[0][name] for name in DISPLACEMENT_GRADIENT)
        else:
            summed = np.zeros((_POINTS, 3))
            for frame, (u, v) in zip(frames, points, strict=True):
                texels = np.stack([frame[name] for name in DISPLACEMENT_GRADIENT], axis=-1)
                interpolate.bilinear(texels, u, v, summed)
            xx, xy, yy = (np.ascontiguousarray(column)[None] for column in summed.T)
        one = folding_of(xx, xy, yy, tiles[0].choppiness)
        total = one if total is None else total + one
    assert total is not None  # count is at least 1
    return total


def _points(tiles: tuple[Ocean, ...]) -> list[tuple[Real, Real]]:
    """
    Return the same points as sample numbers (u, v) of each tile; whole numbers of the finest.

    One tile needs none.
    """
    if len(tiles) == 1:
        return []
    large, fine = tiles[0].grid, tiles[-1].grid
    chance = np.random.default_rng(0)  # a fixed choice, independent of the sea's own seed
    step_x, step_y = fine.lx / fine.nx, fine.ly / fine.ny
    x = np.floor(chance.uniform(0.0, _WIDTHS * large.lx * fine.nx / fine.lx, _POINTS)) * step_x
    y = np.floor(chance.uniform(0.0, _WIDTHS * large.ly * fine.ny / fine.ly, _POINTS)) * step_y
    grids = [tile.grid for tile in tiles]
    scaled = [(x * (g.nx / g.lx) % g.nx, y * (g.ny / g.ly) % g.ny) for g in grids[:-1]]
    return [
        *scaled,
        (np.rint(x * (fine.nx / fine.lx)) % fine.nx, np.rint(y * (fine.ny / fine.ly)) % fine.ny),
    ]


def specified(sea: Sea) -> SeaState:
    """Return the state of a sea from its own integrals over frequency and direction."""
    variance, theta = _polar(sea)
    direction, spread = moments.mean_direction_and_spread(variance, theta)
    # by panels: adaptive quadrature takes a tenth of a second for a spectrum that inverts the
    # dispersion relation at each frequency
    m0 = float(np.sum(variance))
    return SeaState(
        m0=m0, hs=4.0 * math.sqrt(m0), tp=sea.tp, mean_direction=direction, spread=spread
    )


def peak_wavelength(ocean: Ocean) -> float:
    """Return the wavelength at the specified peak period [m]; 0 for a flat sea or given waves."""
    tp = 0.0 if ocean.sea is None else ocean.sea.tp
    if not tp > 0.0:
        return 0.0
    tension = ocean.amplitudes.surface_tension
    return 2.0 * math.pi / float(dispersion.wavenumber(2.0 * math.pi / tp, ocean.depth, tension))


def shortest_wavelength(grid: Grid) -> float:
    """Return the shortest wavelength that a grid holds along both of its axes [m]: two samples."""
    return 2.0 * max(grid.lx / grid.nx, grid.ly / grid.ny)


def outside_band(sea: Sea, grid: Grid, band: Band = WHOLE) -> tuple[float, float]:
    """
    Return the variance [m^2] of a sea outside a tile: (of longer waves, of shorter waves).

    The tile's cells cover a rectangle of wavenumbers without the cell around k = 0. In every
    direction the sea's energy is summed along |k| up to the edges of the two rectangles, without
    cells. A band limits the tile further.
    """
    reach_x, reach_y = grid.reach
    cells = Cells(sea, grid.dkx, grid.dky)
    inner, outer = (
        (0.5 * grid.dkx, 0.5 * grid.dky),
        ((reach_x + 0.5) * grid.dkx, (reach_y + 0.5) * grid.dky),
    )
    # below: all up to the lower edge of the band, and the part of the band in the inner rectangle
    below = cells.inside(*outer, (0.0, band[0])) + cells.inside(*inner, band)
    return below, max(sea.variance - cells.inside(*outer, (0.0, band[1])), 0.0)


_RATIO, _ANGLES = 1.1, 32
"""Frequencies of a class, the last over the first; classes of direction."""
_NEGLIGIBLE = 1e-6
"""Share of the variance of the largest class, below which a class is left out."""


def _classes(sea: Sea) -> tuple[Real, Real, Real]:
    """
    Return variance [m^2], frequency [rad/s] and direction [rad] of classes of a sea's waves.
    """
    columns: list[tuple[Real, Real, Real]] = []
    for whole in sea.systems:
        for share, system in parts_of(whole):
            edges = frequency_panels(system).edges
            omega, d_omega = (a.ravel() for a in gauss(edges[:-1], edges[1:]))
            energy = share * system.spectrum(omega) * d_omega
            some = energy > 1e-12 * np.max(energy, initial=0.0)
            if not np.any(some):
                continue
            omega, energy = omega[some], energy[some]
            theta: Real
            if isinstance(system.spreading, LongCrested):
                theta, spread = np.zeros(1), np.ones((omega.size, 1))
            else:
                panels = direction_panels(system, energetic_frequencies(system, edges)[0]).edges
                theta, weight = (a.ravel() for a in gauss(panels[:-1], panels[1:]))
                peak = float(system.spectrum.peak)
                spread = weight * system.spreading(omega[:, None], theta, peak)
            variance = energy[:, None] * spread
            columns.append(
                (
                    variance.ravel(),
                    np.repeat(omega, theta.size),
                    np.tile(theta + math.radians(system.direction % 360.0), omega.size),
                )
            )
    if not columns:
        return np.zeros(0), np.zeros(0), np.zeros(0)
    variance, omega, angle = (np.concatenate(column) for column in zip(*columns, strict=True))
    along = np.floor(np.log(omega / np.min(omega)) / math.log(_RATIO)).astype(np.int64)
    around = np.floor(angle / (2.0 * np.pi / _ANGLES)).astype(np.int64) % _ANGLES
    number = along * _ANGLES + around
    total = np.bincount(number, variance).astype(np.float64)
    some = total > _NEGLIGIBLE * np.max(total, initial=0.0)
    mean: Real = np.bincount(number, variance * omega)[some] / total[some]
    east, north = (np.bincount(number, variance * f(angle))[some] for f in (np.cos, np.sin))
    return total[some], mean, np.arctan2(north, east)


def _polar(sea: Sea) -> tuple[Real, Real]:
    """
    Return the sea's variance by direction, with the directions [rad]; two arrays of one shape.
    """
    variance: list[Real] = [np.zeros(0)]
    theta: list[Real] = [np.zeros(0)]
    around: Real
    weight: Real
    along: Real
    for whole in sea.systems:
        for share, system in parts_of(whole):
            direction = math.radians(system.direction % 360.0)
            edges = frequency_panels(system).edges
            if isinstance(system.spreading, LongCrested):
                around, weight = np.zeros(1), np.ones(1)
                along = np.array([np.sum(energetic_frequencies(system, edges)[1])])
            else:
                panels = direction_panels(system, energetic_frequencies(system, edges)[0]).edges
                around, weight = (a.ravel() for a in gauss(panels[:-1], panels[1:]))
                omega, d_omega = (a.ravel() for a in gauss(edges[:-1], edges[1:]))
                energy = system.spectrum(omega) * d_omega
                some = energy > 1e-12 * np.max(energy, initial=0.0)
                spread = system.spreading(omega[some][:, None], around, float(system.spectrum.peak))
                along = np.sum(energy[some][:, None] * spread, axis=0)
            variance.append(share * along * weight)
            theta.append(around + direction)
    return np.concatenate(variance), np.concatenate(theta)


def _measured_waves(ocean: Ocean) -> tuple[Real, Real, Real, Real]:
    """
    Return energies a^2/2 [m^2] along +k and along -k, omega [rad/s] and direction of +k [rad].

    Each wavenumber of the half plane occurs once; the four arrays have one axis.
    """
    grid = ocean.grid
    frame = ocean.frame(0.0, fields=("height", "velocity_z"))
    height, rate = (
        np.fft.rfft2(f.astype(np.float64)) / f.size for f in (frame.height, frame.velocity_z)
    )
    once = grid.active & ((grid.mx[None, :] > 0) | (grid.my[:, None] > 0))
    omega = ocean.amplitudes.running_omega[once]
    forward = 2.0 * np.abs(0.5 * (height[once] + 1j * rate[once] / omega)) ** 2
    backward = 2.0 * np.abs(0.5 * (height[once] - 1j * rate[once] / omega)) ** 2
    kx, ky = np.broadcast_arrays(grid.kx[None, :], grid.ky[:, None])
    return forward, backward, omega, np.arctan2(ky[once], kx[once])


def peak_period(energy: Real, omega: Real) -> float:
    """
    Return Tp = 2 pi int S^4 d omega / int omega S^4 d omega [s], S from bins 6 % wide.

    Source: Young 1995.
    """
    if not np.any(energy > 0.0):
        return 0.0
    some = energy > 0.0
    edges = np.exp(
        np.arange(math.log(np.min(omega[some])) - 0.03, math.log(np.max(omega[some])) + 0.09, 0.06)
    )
    total, _ = np.histogram(omega, bins=edges, weights=energy)
    first, _ = np.histogram(omega, bins=edges, weights=energy * omega)
    width = np.diff(edges)
    full = total > 0.0
    weight = (total[full] / np.max(total / width) / width[full]) ** 4 * width[full]
    return 2.0 * math.pi * float(np.sum(weight) / np.sum(weight * first[full] / total[full]))


def _scatter(tiles: list[Amplitudes]) -> tuple[float, float]:
    """
    Return the relative standard deviations of m0 from seed to seed, and of one frame's variance.

    Gaussian amplitudes make a^2 exponential: var(sum a^2/2) = sum E^2. In one frame the waves at +k
    and -k share one Fourier coefficient, whose energy is exponential with mean E_k + E_-k; waves of
    fixed modulus beat there with variance 2 E_k E_-k.
    """
    pairs = []
    for a in tiles:
        once = a.grid.active & ((a.grid.mx[None, :] > 0) | (a.grid.my[:, None] > 0))
        pairs.append((a.variance_forward[once], a.variance_backward[once]))
    forward, backward = (np.concatenate(column) for column in zip(*pairs, strict=True))
    total = float(np.sum(forward) + np.sum(backward))
    if not total > 0.0:
        return 0.0, 0.0
    if tiles[0].draw in ("fixed", "given"):
        return 0.0, math.sqrt(2.0 * float(np.sum(forward * backward))) / total
    sampling = math.sqrt(float(np.sum(forward**2) + np.sum(backward**2))) / total
    snapshot = math.sqrt(float(np.sum((forward + backward) ** 2))) / total
    return sampling, snapshot


def loop_error(amplitudes: Amplitudes, period: float) -> LoopError:
    """
    Return the frequency errors of a loop of `period` [s], and the best period within a tenth of it.
    """
    half = amplitudes.variance_forward.copy()
    half[:, 1:] += amplitudes.variance_backward[:, 1:]  # the column mx = 0 holds both k and -k
    energy, omega = half[amplitudes.grid.active], amplitudes.omega[amplitudes.grid.active]
    if not np.any(energy > 0.0):
        return LoopError(period, 0.0, 0.0, period, 0.0)
    strongest = np.argsort(energy)[-4096:]

    def errors(candidate: float, omega: Real, energy: Real) -> tuple[float, float]:
        relative = (
            dispersion.loop_cycles(omega, candidate) * (2.0 * np.pi / candidate) / omega - 1.0
        )
        weight = energy / np.sum(energy)
        return math.sqrt(float(np.sum(weight * relative**2))), float(np.sum(weight * relative))

    candidates = [round(period * (0.9 + 0.001 * i), 2) for i in range(201)]
    tried = {
        c: errors(c, omega[strongest], energy[strongest])[0]
        for c in candidates
        if LOOP.low <= c <= LOOP.high
    }
    better = min(tried, key=lambda c: (tried[c], abs(c - period))) if tried else period
    rms, bias = errors(period, omega, energy)
    better_rms = errors(better, omega, energy)[0]
    if not better_rms < rms:
        better, better_rms = period, rms
    return LoopError(period=period, rms=rms, bias=bias, better_period=better, better_rms=better_rms)
