"""
Any source of waves as lists of what can be summed: an ocean, a cascade, a few-wave model, or a list
of waves as it is.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.amplitudes import Modes
from fftocean.arrays import Integer, Real, RealLike, brief_repr
from fftocean.cascade import Cascade
from fftocean.errors import ParameterError, described
from fftocean.fields import potential_factor
from fftocean.gerstner.waves import Waves
from fftocean.kernels import passes
from fftocean.limits import CHOPPINESS, DEPTH
from fftocean.ocean import Ocean
from fftocean.physics import dispersion

Part = tuple[Modes, Real, tuple[float, float], float | None]
"""The waves of one tile, their push, lx and ly, and the loop."""


@dataclass(frozen=True, slots=True, eq=False)
class Trains:
    """
    The waves of one or more tiles, end to end; float64.

    height = sum of amplitude cos f, displacement = -sum of push (kx, ky) sin f before choppiness, f
    = kx x + ky y - omega t - phase.
    """

    sizes: Real  # (tiles, 2): lx, ly of each [m], inf where nothing repeats
    first: Integer  # (tiles + 1,): where the waves of each begin
    kx: Real  # (waves,) [rad/m]
    ky: Real
    amplitude: Real  # [m]
    push: Real  # [m^2]: the amplitude of the displacement over k
    phase: Real  # [rad]
    omega: Real  # [rad/s]
    loops: tuple[float | None, ...]  # of each tile [s]
    depth: float  # [m]
    choppiness: float  # [-]
    model: Waves | None = None  # which may start from rest

    __repr__ = brief_repr

    def turned(self, t: float) -> Real:
        """
        Return omega t + phase for every wave, less its whole turns [rad].

        A wave is where the frames of its ocean have it, even after years: its frequency in turns is
        rounded as theirs is, and on a loop it is a whole number.
        """
        turns = np.empty((1, self.omega.size))
        for i, loop in enumerate(self.loops):
            part = slice(self.first[i], self.first[i + 1])
            frequency = dispersion.turns_per_second(self.omega[None, part])
            if loop is None:
                passes.phases_at(frequency, t, turns[:, part])
            else:
                passes.phases_at(
                    np.rint(frequency * loop), math.fmod(t, loop) / loop, turns[:, part]
                )
        result: Real = 2.0 * np.pi * turns[0] + self.phase
        return result


def oceans_of(source: Any) -> tuple[Ocean, ...]:
    """The tiles of an ocean or a cascade; none of anything else."""
    if isinstance(source, Ocean):
        return (source,)
    return source.oceans if isinstance(source, Cascade) else ()


def trains_of(
    source: Any,
    *,
    depth: float | None = None,
    choppiness: float | None = None,
    shortest: float = 0.0,
) -> Trains:
    """
    List the waves of a source that are at least `shortest` long [m].

    Args:
        source: an `Ocean`; a `Cascade`; `gerstner.Waves`, or a model that has them as `waves`; or
            `Modes`.
        depth: still-water depth of `Modes` [m], deep if None; the others have their own.
        choppiness: of `Modes`, 1 if None; the others have their own.

    Raises:
        ParameterError: anything else, or a depth or choppiness where it is not asked for.
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
        return _listed(
            [(modes, modes.amplitude * potential_factor(k, depth), (math.inf, math.inf), None)],
            depth,
            choppiness,
            shortest,
        )
    if depth is not None or choppiness is not None:
        raise ParameterError(
            "depth and choppiness go with Modes only: an ocean, a cascade and a few-wave model have their own"
        )
    if oceans:
        parts: list[Part] = []
        for ocean in oceans:
            modes = ocean.modes()
            push = modes.amplitude * potential_factor(np.hypot(modes.kx, modes.ky), ocean.depth)
            parts.append((modes, push, (ocean.grid.lx, ocean.grid.ly), ocean.loop))
        return _listed(parts, oceans[0].depth, oceans[0].choppiness, shortest)
    if isinstance(model, Waves):
        modes = Modes(model.kx, model.ky, model.amplitude, model.phase, model.omega)
        push = model.sharpness * model.amplitude / model.wavenumber
        return _listed([(modes, push, (math.inf, math.inf), None)], math.inf, 1.0, shortest, model)
    raise ParameterError(
        f"waves must come from an Ocean, a Cascade, a few-wave model or Modes, got {described(source)}"
    )


def _listed(
    parts: list[Part], depth: float, choppiness: float, shortest: float, model: Waves | None = None
) -> Trains:
    """Put tiles end to end, without the waves that are too short."""
    kept = [np.hypot(modes.kx, modes.ky) * shortest <= 2.0 * np.pi for modes, *_ in parts]
    columns = [
        np.concatenate([modes[i][keep] for (modes, *_), keep in zip(parts, kept, strict=True)])
        for i in range(5)
    ]
    kx, ky, amplitude, phase, omega = columns
    return Trains(
        sizes=np.array([size for _, _, size, _ in parts]),
        first=np.cumsum([0, *(int(np.count_nonzero(keep)) for keep in kept)], dtype=np.int64),
        kx=kx,
        ky=ky,
        amplitude=amplitude,
        push=np.concatenate([push[keep] for (_, push, *_), keep in zip(parts, kept, strict=True)]),
        phase=phase,
        omega=omega,
        loops=tuple(loop for *_, loop in parts),
        depth=depth,
        choppiness=choppiness,
        model=model,
    )


def coordinates(name: str, values: RealLike) -> Real:
    """
    Return a float64 array of what may be coordinates, NaN and inf included.

    Raises:
        ParameterError: anything but numbers.
    """
    try:
        array = (
            np.ma.filled(np.ma.asarray(values, dtype=np.float64), np.nan)
            if np.ma.isMaskedArray(values)
            else np.asarray(values)
        )
    except ValueError:
        raise ParameterError(
            f"{name} must be numbers in a regular array, got {values!r:.60}"
        ) from None
    if array.dtype.kind not in "iuf":
        raise ParameterError(f"{name} must be numbers, got {values!r:.60} ({array.dtype})")
    return array.astype(np.float64, copy=False)


def moments_of(
    t: Real, shape: tuple[int, ...]
) -> "Iterator[tuple[float, slice | npt.NDArray[np.intp]]]":
    """Each different time, with the points that ask for it."""
    if t.size == 1:
        yield float(t.reshape(())), slice(None)
        return
    if 0 in shape:  # nobody asks
        return
    times, inverse = np.unique(np.broadcast_to(t, shape).ravel(), return_inverse=True)
    if times.size == 1:
        yield float(times[0]), slice(None)
        return
    order = np.argsort(inverse, kind="stable")
    for moment, here in zip(
        times, np.split(order, np.cumsum(np.bincount(inverse))[:-1]), strict=True
    ):
        yield float(moment), here
