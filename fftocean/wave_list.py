"""The wave list of any source: an ocean, a cascade, a few-wave model, or `Modes`."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fftocean.amplitudes import Modes
from fftocean.arrays import Integer, Real, brief_repr
from fftocean.bound_waves import BoundWaves
from fftocean.cascade import Cascade
from fftocean.errors import ParameterError, described
from fftocean.fields import potential_factor
from fftocean.gerstner.waves import Waves
from fftocean.kernels import passes, query
from fftocean.limits import CHOPPINESS, DEPTH
from fftocean.ocean import Ocean
from fftocean.physics import dispersion

Part = tuple[Modes, Real, tuple[float, float], float | None]
"""The waves of a tile, their potential amplitudes [m^2], (lx, ly) [m], and the loop [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class WaveList:
    """
    The waves of one or more tiles, end to end; float64.

    With f = kx x + ky y - omega t - phase, height = sum of amplitude cos f, and before choppiness
    displacement = -sum of potential (kx, ky) sin f.
    """

    sizes: Real  # (tiles, 2): lx, ly [m], inf where nothing repeats
    first: Integer  # (tiles + 1,): number of the first wave of each
    kx: Real  # (waves,) [rad/m]
    ky: Real
    amplitude: Real  # [m]
    potential: (
        Real  # amplitude of the displacement potential: that of the displacement over k [m^2]
    )
    phase: Real  # [rad]
    omega: Real  # [rad/s]
    loops: tuple[float | None, ...]  # of each tile [s]
    depth: float  # [m]
    choppiness: float  # [-]
    model: Waves | None = None  # the few-wave model, which can start from rest
    bound: BoundWaves | None = None  # waves of second order, of the first tile
    shortest: float = 0.0  # wavelength below which waves were left out [m]

    __repr__ = brief_repr

    def phases(self, t: float) -> Real:
        """
        Return omega t + phase of every wave, less whole cycles of omega t [rad].

        The waves agree with the frames of their ocean even after years: the frequency in cycles is
        rounded as theirs, and on a loop it is a whole number.
        """
        cycles = np.empty((1, self.omega.size))
        for i, loop in enumerate(self.loops):
            part = slice(self.first[i], self.first[i + 1])
            frequency = dispersion.turns_per_second(self.omega[None, part])
            if loop is None:
                passes.phases_at(frequency, t, cycles[:, part])
            else:
                passes.phases_at(
                    np.rint(frequency * loop), math.fmod(t, loop) / loop, cycles[:, part]
                )
        result: Real = 2.0 * np.pi * cycles[0] + self.phase
        return result


def oceans_of(source: Any) -> tuple[Ocean, ...]:
    """Return the tiles of an ocean or a cascade; () for anything else."""
    if isinstance(source, Ocean):
        return (source,)
    return source.oceans if isinstance(source, Cascade) else ()


def list_waves(
    source: Any,
    *,
    depth: float | None = None,
    choppiness: float | None = None,
    shortest: float = 0.0,
) -> WaveList:
    """
    Return the waves of a source.

    Args:
        source: an `Ocean`; a `Cascade`; `gerstner.Waves`, or a model that has them as `waves`; or
            `Modes`.
        depth: still-water depth of `Modes` [m], deep if None; the others have their own.
        choppiness: of `Modes` [-], 1 if None; the others have their own.
        shortest: wavelength below which waves are left out [m].

    Raises:
        ParameterError: a source without waves, or a depth or choppiness for other than `Modes`.
    """
    oceans = oceans_of(source)
    model = getattr(source, "waves", source)
    if isinstance(source, Modes):
        depth = DEPTH.check("depth", math.inf if depth is None else depth)
        choppiness = CHOPPINESS.check("choppiness", 1.0 if choppiness is None else choppiness)
        modes = Modes(*(np.array(column, dtype=np.float64, ndmin=1) for column in source))
        if not all(
            column.shape == modes.kx.shape and column.ndim == 1 and np.all(np.isfinite(column))
            for column in modes
        ):
            raise ParameterError("modes must be five columns of finite numbers, all of one length")
        k = np.hypot(modes.kx, modes.ky)
        if not np.all(k > 0.0):
            raise ParameterError("modes must all have a wavenumber above 0")
        return _joined(
            [(modes, modes.amplitude * potential_factor(k, depth), (math.inf, math.inf), None)],
            depth,
            choppiness,
            shortest,
        )
    if depth is not None or choppiness is not None:
        raise ParameterError(
            "depth and choppiness go with Modes only: "
            "an ocean, a cascade and a few-wave model have their own"
        )
    if oceans:
        parts: list[Part] = []
        for ocean in oceans:
            modes = ocean.modes()
            potential = modes.amplitude * potential_factor(
                np.hypot(modes.kx, modes.ky), ocean.depth
            )
            parts.append((modes, potential, (ocean.grid.lx, ocean.grid.ly), ocean.loop))
        linear = _joined(parts, oceans[0].depth, oceans[0].choppiness, shortest)
        return replace(linear, bound=oceans[0].bound_waves, shortest=shortest)
    if isinstance(model, Waves):
        modes = Modes(model.kx, model.ky, model.amplitude, model.phase, model.omega)
        potential = model.sharpness * model.amplitude / model.wavenumber
        return _joined(
            [(modes, potential, (math.inf, math.inf), None)], math.inf, 1.0, shortest, model
        )
    raise ParameterError(
        "waves must come from an Ocean, a Cascade, a few-wave model or Modes, "
        f"got {described(source)}"
    )


def require_linear(source: Any, user: str) -> None:
    """
    Raise if a source has waves of second order, which `user` cannot hold.

    Raises:
        ParameterError: an ocean or a cascade of order 2.
    """
    if any(ocean.order > 1 for ocean in oceans_of(source)):
        given = "ocean" if isinstance(source, Ocean) else "cascade"
        raise ParameterError(
            f"{user} holds linear waves, and those of second order change with every pair of "
            f"waves: give {given}.linear(), on the command line --order 1; got order 2"
        )


def _joined(
    parts: list[Part], depth: float, choppiness: float, shortest: float, model: Waves | None = None
) -> WaveList:
    """Return the waves of some tiles end to end, without those that are too short."""
    kept = [np.hypot(modes.kx, modes.ky) * shortest <= 2.0 * np.pi for modes, *_ in parts]
    columns = [
        np.concatenate([modes[i][keep] for (modes, *_), keep in zip(parts, kept, strict=True)])
        for i in range(5)
    ]
    kx, ky, amplitude, phase, omega = columns
    return WaveList(
        sizes=np.array([size for _, _, size, _ in parts]),
        first=np.cumsum([0, *(int(np.count_nonzero(keep)) for keep in kept)], dtype=np.int64),
        kx=kx,
        ky=ky,
        amplitude=amplitude,
        potential=np.concatenate(
            [potential[keep] for (_, potential, *_), keep in zip(parts, kept, strict=True)]
        ),
        phase=phase,
        omega=omega,
        loops=tuple(loop for *_, loop in parts),
        depth=depth,
        choppiness=choppiness,
        model=model,
    )


def as_tiles(waves: WaveList, t: float) -> tuple[Any, ...]:
    """Return the fields of `kernels.query.Tiles` for waves at time t [s]."""
    table = np.stack([waves.kx, waves.ky, waves.amplitude, waves.potential, waves.phases(t)])
    return tuple(query.Tiles(waves.sizes, _NO_LAYOUT, _NO_TEXELS, waves.first, table))


_NO_LAYOUT, _NO_TEXELS = np.zeros((0, 3), np.int64), np.zeros(0)
