"""
Seas from measured spectra.
"""

import math
import numbers
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ParameterError, ReaderError, SeaWarning
from fftocean.limits import SIGNIFICANT_WAVE_HEIGHT
from fftocean.physics.moments import mean_direction_and_spread
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.physics.spectra import TabulatedSpectrum
from fftocean.physics.spectra.tabulated import TAIL
from fftocean.physics.spreading import Spreading, TabulatedSpreading
from fftocean.physics.spreading.tabulated import bin_widths
from fftocean.readers import bands
from fftocean.readers.dataset_layout import warn_of_notes
from fftocean.readers.netcdf import to_layout

if TYPE_CHECKING:
    from xarray import DataArray, Dataset


@dataclass(frozen=True, slots=True, kw_only=True)
class Realised:
    """A sea from a measured spectrum, with a report of the conversion."""

    sea: Sea
    # significant wave height of the source's own sum over bands, as of `sea` without a tail [m]
    hs_source: float
    factor: float  # m0 of the source's bands / m0 of straight lines through its densities [-]
    tm01_source: float = 0.0  # m0/m1 of the source's own sums [s]; 0 for a flat sea
    tm02_source: float = 0.0  # sqrt(m0/m2) of the source's own sums [s]; 0 for a flat sea
    depth_source: float | None = None  # water depth of the measurement [m]; None if unknown
    tail_variance: float = 0.0  # m0 that a tail adds to the source's [m^2]
    notes: tuple[str, ...] = ()  # masked, repaired or assumed values, in words

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
        tail: float | None = None,
    ) -> "Realised":
        """
        Realise one spectrum of a dataset.

        The source's moments are sums over its bands of S(f) f^n df. Bands are the dataset's own
        if it has them (`freq_bnds`, or their names in netCDF files); else each reaches half way to
        its neighbours and the outermost are symmetric, as buoys and the wavespectra package
        (`hs(tail=False)`) sum them. The sea is piecewise linear in frequency and direction, with
        the same m0, m1 and m2, hence Hs, Tm01 and Tm02 (`bands.straight_lines`); outside the bands
        it is 0. A frequency that is missing altogether is interpolated; single missing bins are
        empty, as in ERA5.

        Args:
            dataset: from `readers.open`, the wavespectra package, or opened by xarray: dimensions
                freq, dir, perhaps time, site.
            time: index of the time, from 0; -1 is the last. (By date: `dataset.sel(time=...)`.)
            site: index of the place, from 0.
            depth: still-water depth [m]; None takes `dpt` of the dataset, or deep water without it.
            direction: toward which the waves go, counter-clockwise from +x [degrees]: for a
                spectrum without directions.
            spreading: directional spreading: for a spectrum without directions, which needs both.
            negative: "refuse" negative densities, or "clip" them to 0 and keep the energy of each
                frequency: for directional spectra from a truncated Fourier series
                (`wavespectra.read_ndbc`).
            tail: exponent n of a tail S(f_last) (f/f_last)^-n beyond the last frequency, 5 for the
                waves of a local wind; it takes the place of the upper half of the last band, and
                its directions are those of the last frequency. None adds none: what was not
                measured is not there. `tail_variance` and a note have the energy that it adds.

        Raises:
            ReaderError: nothing measured at that time, or a dataset that is not a wave spectrum.
            ParameterError: a time, site or depth out of range; directions missing, or given
                twice.
        """
        if tail is not None:
            tail = TAIL.check("tail", tail)
        spectrum = warn_of_notes(to_layout(dataset, site=site, time=time, negative=negative))
        notes = _notes_of(spectrum, getattr(dataset, "attrs", {}))
        own_depth = _own_depth(spectrum)
        depth = _depth(own_depth, depth, notes)
        frequency = np.asarray(spectrum["freq"].values)
        own = np.asarray(spectrum["freq_bnds"].values) if "freq_bnds" in spectrum.coords else None
        compass = None
        if "efth" in spectrum:
            if direction is not None or spreading is not None:
                raise ParameterError(
                    "a spectrum with directions must be given without others, "
                    f"got direction={direction!r}, spreading={spreading!r}"
                )
            compass, density = _whole_circle(
                np.asarray(spectrum["dir"].values), np.asarray(spectrum["efth"].values[0]), notes
            )
            measured = ~np.all(np.isnan(density), axis=1)
            density = density[measured]
            if empty := int(np.count_nonzero(np.isnan(density))):
                notes.append(f"{empty} missing bins of frequency and direction were taken as empty")
            density = np.nan_to_num(density, nan=0.0)
            total = np.sum(density * bin_widths(compass), axis=1)
        else:
            if direction is None or spreading is None:
                raise ParameterError(
                    "a spectrum without directions needs direction (toward, "
                    "counter-clockwise from +x, degrees) and spreading "
                    f"(CosineSquared(), CosinePower(s=...), ...), got direction={direction!r}, "
                    f"spreading={spreading!r}"
                )
            total = np.asarray(spectrum["ef"].values[0])
            measured = ~np.isnan(total)
            total = total[measured]
        edges = bands.remaining(frequency, own, measured)
        frequency = frequency[measured]
        if frequency.size < 2:
            raise ReaderError(
                f"time {time} must have at least 2 frequencies that are not missing (land, ice, "
                f"a silent buoy?), got {frequency.size}"
            )
        if missing := int(np.count_nonzero(~measured)):
            notes.append(f"{missing} missing frequencies were bridged, or left out at the ends")

        lines = bands.straight_lines(frequency, total, edges)
        m0, m1, m2 = lines.moments
        hs = 4.0 * math.sqrt(m0)
        if hs > SIGNIFICANT_WAVE_HEIGHT.high:
            raise ReaderError(
                f"time {time}: the significant wave height must be "
                f"{SIGNIFICANT_WAVE_HEIGHT.rule}, got {hs:g} (in other units?)"
            )
        if not m0 > 0.0:
            warnings.warn(
                "the spectrum holds no energy: the sea is exactly flat", SeaWarning, stacklevel=2
            )
            return cls(
                sea=Sea(depth=depth),
                hs_source=0.0,
                factor=1.0,
                depth_source=own_depth,
                notes=(*notes, "the spectrum holds no energy"),
            )
        if lines.matched < 2:
            kept = "Hs and Tm01" if lines.matched else "Hs"
            notes.append(
                f"the energy lies in so few frequencies that the sea keeps {kept} of the bands' "
                "own sums, and not Tm02"
            )
        if compass is not None:
            # From FROM, clockwise from north, to TOWARD, counter-clockwise from east.
            toward = 270.0 - compass
            energy = density * (edges[:, 1] - edges[:, 0])[:, np.newaxis] * bin_widths(compass)
            direction, _ = mean_direction_and_spread(
                energy, np.radians(np.broadcast_to(toward, energy.shape))
            )
            spreading = TabulatedSpreading(
                frequency=frequency.tolist(),
                direction=(toward - direction).tolist(),
                density=density.tolist(),
            )
        assert direction is not None
        assert spreading is not None
        straight = TabulatedSpectrum(
            frequency=lines.frequency.tolist(), density=lines.density.tolist()
        )
        added = 0.0
        if tail is not None:
            straight, added = _with_tail(straight, float(frequency[-1]), tail)
            notes.append(
                f"a tail f^-{tail:g} beyond {frequency[-1]:.3g} Hz adds {added:.3g} m^2 to the "
                f"variance, {100.0 * added / m0:.2g} % (Hs {4.0 * math.sqrt(m0 + added):.4g} m "
                f"in place of {hs:.4g} m)"
            )
        system = WaveSystem(spectrum=straight, spreading=spreading, direction=direction)
        return cls(
            sea=Sea(system, depth=depth),
            hs_source=hs,
            factor=lines.factor,
            tm01_source=m0 / m1,
            tm02_source=math.sqrt(m0 / m2),
            depth_source=own_depth,
            tail_variance=added,
            notes=tuple(notes),
        )


def _with_tail(
    spectrum: TabulatedSpectrum, last: float, tail: float
) -> tuple[TabulatedSpectrum, float]:
    """
    Return a spectrum with a tail beyond the last measured frequency [Hz], and the m0 that it adds.

    Points beyond that frequency, which are the upper half of its band, give way to the tail.
    """
    f, s = np.array(spectrum.frequency), np.array(spectrum.density)
    kept = f <= last * (1.0 + 1e-9)
    beyond = np.append(last, f[~kept])
    cut = float(np.trapezoid(np.append(s[kept][-1], s[~kept]), beyond))
    tailed = TabulatedSpectrum(f[kept].tolist(), s[kept].tolist(), tail=tail)
    return tailed, tailed.tail_variance - cut


_COUNTED: Final = {
    "rounded_negatives": "values a rounding below 0 were taken as 0",
    "below_threshold_values": (
        "values that the file leaves out for being almost nothing were taken as 0"
    ),
    "limited_moments": "pairs of directional moments that no sea can have were limited",
    "undirected_densities": "densities without a direction were spread all round",
}
"""
Counts among a dataset's attributes that are reported; those of a reader are of all times.
"""


def _notes_of(spectrum: "Dataset", given: Mapping[str, Any]) -> list[str]:
    """
    Return notes on doubts, assumptions, and masked or repaired values, from attributes.

    Args:
        spectrum: one time of the dataset, in `dataset_layout`.
        given: the attributes of the dataset as its reader left them.
    """
    attrs = {**given, **spectrum.attrs}
    notes = [str(text) for key, text in attrs.items() if str(key).endswith("_note")]
    if "assumed" in attrs:
        notes.append(f"assumed, for want of attributes: {attrs['assumed']}")
    if "unterminated" in attrs:
        notes.append(str(attrs["unterminated"]))
    if masked := given.get("masked_values", 0):
        notes.append(f"{masked} values of the file are missing")
    for key, words in _COUNTED.items():
        counts = (source.get(key, 0) for source in (given, spectrum.attrs))
        if count := max(int(n) if isinstance(n, numbers.Integral) else 0 for n in counts):
            notes.append(f"{count} {words}")
    f = np.asarray(spectrum["freq"].values)
    if f[0] > 0.15 and f[-1] > 3.0:
        text = (
            f"frequencies go from {f[0]:.3g} to {f[-1]:.3g} Hz, which is rare at sea: "
            "are they in rad/s?"
        )
        warnings.warn(text, SeaWarning, stacklevel=4)
        notes.append(text)
    return notes


def _own_depth(spectrum: "Dataset") -> float | None:
    """Return the depth of a dataset of one time [m], or None if unknown."""
    own = float(spectrum["dpt"][0]) if "dpt" in spectrum else math.nan
    return None if math.isnan(own) else own


def _depth(own: float | None, depth: float | None, notes: list[str]) -> float:
    """
    Return the specified depth, else the dataset's own, else deep water; add a note of it.
    """
    if depth is not None:
        return depth
    if own is None:
        notes.append("no depth is known: the water is taken as deep")
        return math.inf
    notes.append(f"the depth is the measurement's own, {own:g} m")
    return own


def sea_from_spectrum(
    dataset: "Dataset | DataArray",
    *,
    time: int = 0,
    site: int = 0,
    depth: float | None = None,
    direction: float | None = None,
    spreading: Spreading | None = None,
    negative: str = "refuse",
    tail: float | None = None,
) -> Sea:
    """
    Return the sea of one measured spectrum; `direction` is in [degrees], `depth` in [m].

    `Realised.from_spectrum` documents the arguments, and returns a report too.
    """
    return Realised.from_spectrum(
        dataset,
        time=time,
        site=site,
        depth=depth,
        direction=direction,
        spreading=spreading,
        negative=negative,
        tail=tail,
    ).sea


def _whole_circle(compass: Real, density: Real, notes: list[str]) -> tuple[Real, Real]:
    """
    Return directions and densities with zeros at the ends of gaps in the circle of directions.

    A gap is more than twice the usual step: the model computed nothing there.

    Args:
        compass: (d,) ascending in [0, 360) [degrees].
        density: (f, d).
        notes: list that receives a note of the gaps.
    """
    gaps = np.diff(compass, append=compass[0] + 360.0)
    step = float(np.median(gaps))
    wide = np.flatnonzero(gaps > 2.5 * step)
    if not wide.size:
        return compass, density
    notes.append(
        f"directions leave out {float(np.sum(gaps[wide] - 2.0 * step)):g} degrees of the "
        "circle: nothing comes from there"
    )
    ends = np.concatenate([compass[wide] + step, compass[(wide + 1) % compass.size] - step]) % 360.0
    silent = np.all(np.isnan(density), axis=1, keepdims=True)
    compass = np.concatenate([compass, ends])
    density = np.concatenate([density, np.where(silent, np.nan, np.zeros(ends.size))], axis=1)
    order = np.argsort(compass)
    return compass[order], density[:, order]
