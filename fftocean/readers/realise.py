"""From a measured spectrum to a `Sea`: straight lines between its points, its own variance, our directions."""

import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ParameterError, ReaderError, SeaWarning
from fftocean.limits import SIGNIFICANT_WAVE_HEIGHT
from fftocean.physics.moments import mean_direction_and_spread
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.physics.spectra import TabulatedSpectrum
from fftocean.physics.spreading import Spreading
from fftocean.physics.tabulated import TabulatedSpreading, bin_widths
from fftocean.readers.layout import announce
from fftocean.readers.netcdf import tidy

if TYPE_CHECKING:
    from xarray import DataArray, Dataset


@dataclass(frozen=True, slots=True, kw_only=True)
class Realised:
    """A sea made from a measured spectrum, and what was done to make it."""

    sea: Sea
    hs_source: float  # significant wave height of the source's own sum over bands [m]; what `sea` has
    factor: float  # on the densities, so that the straight lines between them hold as much as the bands [-]

    @classmethod
    def from_spectrum(
        cls,
        dataset: "Dataset | DataArray",
        *,
        time: int = 0,
        site: int = 0,
        depth: float | None = None,
        direction: float | None = None,
        spreading: Spreading | None = None,
        negative: str = "refuse",
    ) -> "Realised":
        """
        Realise one spectrum of a dataset.

        Between its frequencies and directions the spectrum is drawn in straight lines; outside them it is 0. The source's variance
        is the sum of S(f) df over its bands, each reaching half way to its neighbours and the outermost as far out as in: so buoys
        sum it, and the wavespectra package (`hs(tail=False)`). The straight lines hold a little more or less; the densities are
        multiplied by one `factor` to make up for it. A frequency that is missing altogether is bridged; single missing bins are
        empty, as in ERA5.

        Args:
            dataset: from `readers.open`, the wavespectra package, or opened by xarray: dimensions freq, dir, perhaps time, site.
            time: which time, from 0; -1 is the last. (By name: `dataset.sel(time=...)` before.)
            site: which place, from 0.
            depth: still-water depth [m]; None takes `dpt` of the dataset, and deep water where it has none.
            direction: toward which the waves go, counter-clockwise from +x [degrees]: for a spectrum without directions.
            spreading: how they spread: for a spectrum without directions, which needs both.
            negative: "refuse" negative densities, or "clip" them to 0 and keep the energy of each frequency: for
                directions that were drawn as a cut Fourier series (`wavespectra.read_ndbc`).

        Raises:
            ReaderError: nothing measured at that time, or a dataset that is not a wave spectrum.
            ParameterError: a time, site or depth that cannot be; directions missing, or given twice.
        """
        spectrum = announce(tidy(dataset, site=site, time=time, negative=negative))
        if depth is None:
            depth = float(spectrum["dpt"][0]) if "dpt" in spectrum else math.inf
            depth = math.inf if math.isnan(depth) else depth
        frequency = np.asarray(spectrum["freq"].values)
        compass = None
        if "efth" in spectrum:
            if direction is not None or spreading is not None:
                raise ParameterError(f"a spectrum with directions takes no others, got direction={direction!r}, spreading={spreading!r}")
            compass, density = _whole_circle(np.asarray(spectrum["dir"].values), np.asarray(spectrum["efth"].values[0]))
            measured = ~np.all(np.isnan(density), axis=1)
            frequency, density = frequency[measured], np.nan_to_num(density[measured], nan=0.0)
            total = density @ bin_widths(compass)
        else:
            if direction is None or spreading is None:
                raise ParameterError(
                    "a spectrum without directions needs direction (toward, counter-clockwise from +x, degrees) and spreading "
                    f"(DonelanBanner(), CosinePower(s=...), ...), got direction={direction!r}, spreading={spreading!r}"
                )
            total = np.asarray(spectrum["ef"].values[0])
            measured = ~np.isnan(total)
            frequency, total = frequency[measured], total[measured]
        if frequency.size < 2:
            raise ReaderError(
                f"time {time} must have at least 2 frequencies that are not missing (land, ice, a silent buoy?), got {frequency.size}"
            )

        m0 = float(np.sum(total * np.gradient(frequency)))
        hs = 4.0 * math.sqrt(m0)
        if hs > SIGNIFICANT_WAVE_HEIGHT.high:
            raise ReaderError(
                f"time {time}: the significant wave height must be {SIGNIFICANT_WAVE_HEIGHT.rule}, got {hs:g} (in other units?)"
            )
        lines = float(np.sum(0.5 * (total[1:] + total[:-1]) * np.diff(frequency)))
        if not lines > 0.0:
            warnings.warn("the spectrum holds no energy: the sea is exactly flat", SeaWarning, stacklevel=2)
            return cls(sea=Sea(depth=depth), hs_source=0.0, factor=1.0)
        factor = m0 / lines
        if compass is not None:
            toward = 270.0 - compass  # clockwise from north, FROM -> counter-clockwise from east, TOWARD
            energy = density * np.gradient(frequency)[:, np.newaxis] * bin_widths(compass)
            direction, _ = mean_direction_and_spread(energy, np.radians(np.broadcast_to(toward, energy.shape)))
            spreading = TabulatedSpreading(frequency=frequency.tolist(), direction=(toward - direction).tolist(), density=density.tolist())
        assert direction is not None
        assert spreading is not None
        straight = TabulatedSpectrum(frequency=frequency.tolist(), density=(total * factor).tolist())
        system = WaveSystem(spectrum=straight, spreading=spreading, direction=direction)
        return cls(sea=Sea(system, depth=depth), hs_source=hs, factor=factor)


def sea_from_spectrum(
    dataset: "Dataset | DataArray",
    *,
    time: int = 0,
    site: int = 0,
    depth: float | None = None,
    direction: float | None = None,
    spreading: Spreading | None = None,
    negative: str = "refuse",
) -> Sea:
    """The sea of one measured spectrum: `Realised.from_spectrum(...)`, which has the arguments, without its report."""
    return Realised.from_spectrum(
        dataset,
        time=time,
        site=site,
        depth=depth,
        direction=direction,
        spreading=spreading,
        negative=negative,
    ).sea


def _whole_circle(compass: Real, density: Real) -> tuple[Real, Real]:
    """
    Close a sector: where directions leave out more than twice their usual step, nothing was computed and nothing comes from there.

    Args:
        compass: (d,) ascending in [0, 360) [degrees].
        density: (f, d).
    """
    gaps = np.diff(compass, append=compass[0] + 360.0)
    step = float(np.median(gaps))
    wide = np.flatnonzero(gaps > 2.5 * step)
    if not wide.size:
        return compass, density
    ends = np.concatenate([compass[wide] + step, compass[(wide + 1) % compass.size] - step]) % 360.0
    silent = np.all(np.isnan(density), axis=1, keepdims=True)
    compass = np.concatenate([compass, ends])
    density = np.concatenate([density, np.where(silent, np.nan, np.zeros(ends.size))], axis=1)
    order = np.argsort(compass)
    return compass[order], density[:, order]
