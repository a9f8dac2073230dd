"""Sea state as a sum of wave systems, wind seas and swells, over one depth of water."""

import math
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fftocean.arrays import Real, RealLike
from fftocean.errors import ParameterError, SeaWarning, described
from fftocean.limits import DEPTH, DIRECTION, SURFACE_TENSION, keep_checked
from fftocean.physics import moments, presets
from fftocean.physics.spectra import TMA, FrequencySpectrum, require_spectrum
from fftocean.physics.spreading import Blend, DonelanBanner, Spreading, require_spreading
from fftocean.physics.water import SAME, Statement, agreed, statements

if TYPE_CHECKING:
    from xarray import DataArray, Dataset


def from_compass(bearing: float) -> float:
    """
    Return the direction in the library's convention of a meteorological bearing.

    Args:
        bearing: where the waves or the wind come FROM [degrees], clockwise from north, as forecasts
            and buoys give it.

    Returns:
        Where they go TO [degrees], counter-clockwise from east (+x), in [0, 360): a westerly, 270,
        is 0.

    Raises:
        ParameterError: a bearing that is not finite.
    """
    return (270.0 - DIRECTION.check("bearing", bearing)) % 360.0


def _short(model: object) -> str:
    """Return the repr of a model where it is short; else its name and those of its parts."""
    text = repr(model)
    if len(text) <= 90:
        return text
    inner = [type(getattr(model, name)).__name__ for name in _WRAPPED if hasattr(model, name)]
    return f"{type(model).__name__}({', '.join([*inner, '...'])})"


_WRAPPED = ("spectrum", "base", "first", "second")


def _by(part: str | None) -> str:
    return f" by {part}" if part else ""


@dataclass(frozen=True, slots=True, kw_only=True)
class WaveSystem:
    """
    One wind sea or swell: a spectrum, its spreading and its mean direction.

    Args:
        spectrum: S(omega) [m^2 s/rad].
        spreading: D(omega, theta) [1/rad].
        direction: direction toward which the waves go, counter-clockwise from +x [degrees].

    Raises:
        ParameterError: a spectrum or a spreading that is none, or a direction that is not finite.
    """

    spectrum: FrequencySpectrum
    spreading: Spreading = field(default_factory=DonelanBanner)
    direction: float = 0.0

    def __post_init__(self) -> None:
        require_spectrum("spectrum", self.spectrum)
        require_spreading("spreading", self.spreading)
        keep_checked(self, direction=DIRECTION)
        for name, words in _WIND.items():
            spectral = next(statements(name, "spectrum", self.spectrum), None)
            for other in statements(name, "spreading", self.spreading):
                if spectral and not math.isclose(spectral.value, other.value, rel_tol=SAME):
                    warnings.warn(
                        f"the {words} of a wave system is {spectral.value:g} m/s for its "
                        f"{spectral} and {other.value:g} m/s for its {other}: its directions are "
                        "those of another wind",
                        SeaWarning,
                        stacklevel=3,
                    )

    def density(self, omega: RealLike, theta: RealLike) -> Real:
        """
        Return S(omega) D(omega, theta) [m^2 s/rad^2]; theta [rad] is absolute, counter-clockwise
        from +x. The shape is that of omega and theta broadcast.
        """
        return self.spectrum(omega) * self.spreading(
            omega, np.asarray(theta) - math.radians(self.direction % 360.0), self.spectrum.peak
        )

    def __repr__(self) -> str:
        spectrum, spreading = _short(self.spectrum), _short(self.spreading)
        return (
            f"WaveSystem(spectrum={spectrum}, spreading={spreading}, direction={self.direction:g})"
        )


_WIND = {"speed": "wind speed", "friction_velocity": "friction velocity"}
"""The properties of the wind that a spectrum and its spreading may both state."""


@dataclass(frozen=True, slots=True, init=False)
class Sea:
    """
    Several wave systems over one depth of water. No system is a flat sea.

    A `Sea` is itself a frequency spectrum: call it with omega for the sum over its systems.

    Depth and surface tension belong to the water, and drive the dispersion of all waves. A spectrum
    or spreading that states one of them (`TMA.depth`, `Elfouhaily.surface_tension`, or any model's
    attribute of that name, also within a `Blend` or another model) must state that of the sea.
    Where the sea is given none it takes the value stated, and `depth_from` and
    `surface_tension_from` say by which part.

    Args:
        waves: the wave systems.
        systems: further wave systems, in a tuple.
        depth: still-water depth [m], inf for deep water; None is the depth that the parts state, or
            else deep water.
        surface_tension: [N/m], 0 without capillary waves; None is that which the parts state, or
            else 0.

    Raises:
        ParameterError: a value out of its range, or two different ones for the same water.
    """

    systems: tuple[WaveSystem, ...]
    depth: float  # still-water depth [m]; inf is deep water
    surface_tension: float  # [N/m]; 0 leaves capillary waves out

    def __init__(
        self,
        *waves: WaveSystem,
        systems: tuple[WaveSystem, ...] = (),
        depth: float | None = None,
        surface_tension: float | None = None,
    ) -> None:
        systems = (*waves, *systems) if isinstance(systems, Iterable) else (*waves, systems)
        for system in systems:
            if not isinstance(system, WaveSystem):
                raise ParameterError(
                    f"a sea must be made of WaveSystem values, got {described(system)}"
                )
        object.__setattr__(self, "systems", systems)
        for name, given, quantity, default in (
            ("depth", depth, DEPTH, math.inf),
            ("surface_tension", surface_tension, SURFACE_TENSION, 0.0),
        ):
            value = agreed(name, given, list(self._stated(name)), quantity, default)
            object.__setattr__(self, name, value)

    @classmethod
    def from_wind(
        cls,
        *,
        speed: float,
        fetch: float,
        depth: float = math.inf,
        direction: float = 0.0,
        gamma: float = 3.3,
        growth: str = "jonswap",
        spreading: Spreading | None = None,
    ) -> "Sea":
        """
        Return a TMA sea, spread by an even blend of Donelan-Banner and cos^2.

        In water of finite depth it grows as Young and Verhagen (1996) measured: `TMA.from_wind`.

        Args:
            speed: wind 10 m above the sea [m/s]; 0 is an exactly flat sea, with a warning that says
                so.
            fetch: distance over which it blows [m].
            depth: still-water depth [m].
            direction: toward which the wind blows, counter-clockwise from +x [degrees].
            gamma: peak enhancement of the growing sea [-].
            growth: law of growth in deep water: "jonswap", "kahma-calkoen" or "young-verhagen".
            spreading: another model of directional spreading.

        Raises:
            ParameterError: a value out of its range, or an unknown law of growth.
        """
        spectrum = TMA.from_wind(speed=speed, fetch=fetch, depth=depth, gamma=gamma, growth=growth)
        return cls(
            WaveSystem(
                spectrum=spectrum,
                spreading=Blend() if spreading is None else spreading,
                direction=direction,
            ),
            depth=depth,
        )

    @classmethod
    def beaufort(
        cls,
        number: int,
        *,
        direction: float = 0.0,
        depth: float = math.inf,
        spreading: Spreading | None = None,
    ) -> "Sea":
        """
        Return the open sea of a Beaufort number, 0 (flat) to 12, with exactly the scale's probable
        wave height; see `presets.beaufort`.

        Args:
            number: on the Beaufort scale.
            direction: toward which wind and waves go, counter-clockwise from +x [degrees].
            depth: still-water depth [m]; the promised height is then that in this depth.
            spreading: another model than the even blend of Donelan-Banner and cos^2.

        Raises:
            ParameterError: a number that is not on the scale, or waves that would be too steep in
                so little water.
        """
        return cls._preset(presets.beaufort(number), direction, depth, spreading)

    @classmethod
    def sea_state(
        cls,
        number: int,
        *,
        direction: float = 0.0,
        depth: float = math.inf,
        spreading: Spreading | None = None,
    ) -> "Sea":
        """
        Return the sea of a state of WMO code table 3700, 0 (flat) to 9; direction [degrees] and
        depth [m] as of `beaufort`, see `presets.sea_state`.
        """
        return cls._preset(presets.sea_state(number), direction, depth, spreading)

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
    ) -> "Sea":
        """
        Return the sea of one measured spectrum: an xarray.Dataset from `readers.open` or straight
        from the wavespectra package.

        Linear between its frequencies and directions, with exactly the Hs, Tm01 and Tm02 of its own
        bands; with a `tail`, say 5, it goes on beyond the last frequency as f^-5.
        `depth` is in [m], `direction` in [degrees] toward which the waves go.
        `readers.Realised.from_spectrum` has the same arguments, their meaning, and reports what was
        masked, repaired, assumed or added.

        Raises:
            ReaderError: nothing measured at that time, or a dataset that is not a wave spectrum.
            ParameterError: a time, site or depth that cannot be; directions missing, or given
                twice.
        """
        from fftocean.readers.realise import sea_from_spectrum

        return sea_from_spectrum(
            dataset,
            time=time,
            site=site,
            depth=depth,
            direction=direction,
            spreading=spreading,
            negative=negative,
            tail=tail,
        )

    @classmethod
    def _preset(
        cls, preset: presets.Preset, direction: float, depth: float, spreading: Spreading | None
    ) -> "Sea":
        spectrum = preset.spectrum(DEPTH.check("depth", depth))
        if spectrum is None:
            return cls(depth=depth)
        return cls(
            WaveSystem(
                spectrum=spectrum,
                spreading=Blend() if spreading is None else spreading,
                direction=direction,
            ),
            depth=depth,
        )

    def _stated(self, name: str) -> Iterator[Statement]:
        """Yield the statements of all parts about the water."""
        for i, system in enumerate(self.systems):
            yield from statements(name, f"systems[{i}].spectrum", system.spectrum)
            yield from statements(name, f"systems[{i}].spreading", system.spreading)

    @property
    def depth_from(self) -> str | None:
        """
        The first spectrum or spreading that states the depth, such as "systems[0].spectrum (TMA)";
        None where none does.
        """
        return next(map(str, self._stated("depth")), None)

    @property
    def surface_tension_from(self) -> str | None:
        """The first spectrum or spreading that states the surface tension; None where none does."""
        return next(map(str, self._stated("surface_tension")), None)

    def _repr_html_(self) -> str:
        """Return a table of the sea and its spectrum for notebooks."""
        from fftocean import notebook_html

        rows = [
            *(
                (f"system {i}", f"{_short(system.spectrum)}, {_short(system.spreading)}")
                for i, system in enumerate(self.systems[:8])
            ),
            ("Hs", f"{self.hs:.3g} m"),
            ("Tp", f"{self.tp:.3g} s"),
            ("depth", f"{self.depth:g} m"),
        ]
        shown = notebook_html.table("Sea", rows)
        if not self.tp > 0.0:
            return shown
        f = np.linspace(0.4, 4.0, 120) / self.tp
        density = 2.0 * np.pi * self(2.0 * np.pi * f)
        label = f"S(f) from {f[0]:.3g} to {f[-1]:.3g} Hz, at most {np.max(density):.3g} m²/Hz"
        return shown + notebook_html.curve(f, density, label)

    def __repr__(self) -> str:
        shown = [_short(system.spectrum) for system in self.systems[:3]]
        more = [f"{len(self.systems) - 3} more systems"] if len(self.systems) > 3 else []
        water = [
            f"depth={self.depth:g}" + (_by(self.depth_from) if math.isfinite(self.depth) else "")
        ]
        if self.surface_tension:
            water.append(
                f"surface_tension={self.surface_tension:g}" + _by(self.surface_tension_from)
            )
        return f"Sea({', '.join([*shown, *more, *water])})"

    @property
    def peak(self) -> float:
        """omega_p [rad/s] of the system whose own peak is highest; 1 for a sea without systems."""
        return (
            max(self.systems, key=lambda s: float(s.spectrum(s.spectrum.peak))).spectrum.peak
            if self.systems
            else 1.0
        )

    @property
    def breaks(self) -> tuple[float, ...]:
        """The frequencies of sharp bends of the sum: the systems' peaks and corners [rad/s]."""
        return tuple(
            sorted(
                {
                    b
                    for s in self.systems
                    for b in (s.spectrum.peak, *getattr(s.spectrum, "breaks", ()))
                }
            )
        )

    def __call__(self, omega: RealLike, /) -> Real:
        """Return S(omega) of all systems together, [m^2 s/rad]."""
        omega = np.asarray(omega, dtype=np.float64)
        return sum((s.spectrum(omega) for s in self.systems), np.zeros_like(omega))

    def density(self, omega: RealLike, theta: RealLike) -> Real:
        """
        Return S(omega) D(omega, theta) of all systems together [m^2 s/rad^2]; theta [rad] is
        counter-clockwise from +x. The shape is that of omega and theta broadcast.
        """
        omega, theta = np.broadcast_arrays(
            np.asarray(omega, dtype=np.float64), np.asarray(theta, dtype=np.float64)
        )
        return sum((s.density(omega, theta) for s in self.systems), np.zeros_like(omega))

    @property
    def variance(self) -> float:
        """m0 [m^2]: the sum of the systems' own, each by quadrature."""
        return sum(moments.moment(s.spectrum, 0) for s in self.systems)

    @property
    def hs(self) -> float:
        """Significant wave height, 4 sqrt(m0) [m]."""
        return 4.0 * math.sqrt(self.variance)

    @property
    def tp(self) -> float:
        """Peak period of all systems together [s]; 0 for a flat sea."""
        return moments.peak_period(self) if self.systems else 0.0
