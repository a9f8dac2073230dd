"""Amplitudes of a cascade while its sea is being changed, fast and with the phases kept."""

import math

import numpy as np

from fftocean import noise
from fftocean.amplitudes import Amplitudes
from fftocean.arrays import Integer, Real
from fftocean.cascade import Cascade, from_oceans
from fftocean.cell_lattice import CellLattice, TileCells
from fftocean.cells import QUADRANTS
from fftocean.errors import ParameterError, described
from fftocean.ocean import Ocean
from fftocean.physics.sea import Sea


class MovingAmplitudes:
    """
    The tiles, bands, seed and loop of a cascade, ready for one sea after another.

    A `Cascade` integrates the spectrum over every wavenumber cell, in a tenth of a second or more.
    This takes the variances from a `CellLattice`, and multiplies random numbers that it has drawn
    once: so a sea can follow a slider. Each wave keeps its phase, which depends on the seed and the
    wave's own numbers alone, and the amplitudes of two seas can be blended on the way from one to
    the other.

    With amplitudes a of this and b of the cascade, sqrt(sum (a - b)^2 / sum b^2) is 0.2 % or less,
    and 2 % where the directions spread by a tenth of a degree; the variances differ by 0.3 % or
    less.

    Args:
        cascade: the cascade, of any sea.

    Raises:
        ParameterError: no cascade, or one of given waves, which no sea and seed describe.

    Pinned by tests/test_moving_amplitudes.py, against the amplitudes of cascades.
    """

    def __init__(self, cascade: Cascade) -> None:
        if not isinstance(cascade, Cascade):
            raise ParameterError(f"cascade must be a Cascade, got {described(cascade)}")
        amplitudes = [ocean.amplitudes for ocean in cascade.oceans]
        self._lattice = CellLattice([a.grid for a in amplitudes], [a.band for a in amplitudes])
        self._cascade = cascade
        self._tiles = [
            _Tile(ocean, cells)
            for ocean, cells in zip(cascade.oceans, self._lattice.tiles, strict=True)
        ]

    def amplitudes(self, sea: Sea) -> tuple[Amplitudes, ...]:
        """
        Return the waves of another sea on each tile, the largest first.

        Raises:
            ParameterError: no sea, or one whose density is negative or not finite.
        """
        if not isinstance(sea, Sea):
            raise ParameterError(f"sea must be a Sea, got {described(sea)}")
        variances = self._lattice.variances(sea)
        return tuple(
            tile.realise(sea, variance)
            for tile, variance in zip(self._tiles, variances, strict=True)
        )

    def cascade(self, sea: Sea, *, choppiness: float | None = None) -> Cascade:
        """
        Return the cascade of another sea.

        Args:
            sea: the sea.
            choppiness: factor on the horizontal displacement [-]; None for that of the cascade.

        Raises:
            ParameterError: as `amplitudes`, a choppiness out of range, or fields that overflow.
        """
        oceans = tuple(
            ocean.with_amplitudes(made, sea=sea, choppiness=choppiness)
            for ocean, made in zip(self._cascade.oceans, self.amplitudes(sea), strict=True)
        )
        return from_oceans(sea, self._cascade.seed, oceans)


class _Tile:
    """The random numbers of a tile, and the places of its waves in the half plane."""

    def __init__(self, ocean: Ocean, cells: TileCells) -> None:
        self._given = ocean.amplitudes
        if ocean.seed is None or self._given.draw == "given":
            raise ParameterError(
                f"cascade must be made of a sea and a seed, got the given waves of {ocean!r:.80}"
            )
        if self._given.draw == "constrained":
            raise ParameterError(
                "cascade must not be constrained: the waves of another sea would not have its "
                "fixed values; constrain each cascade that is made"
            )
        draw = noise.unit_phasors if self._given.draw == "fixed" else noise.complex_normals
        factor = math.sqrt(0.5) if self._given.draw == "fixed" else 0.5
        self._places: list[tuple[int, Integer, Integer]] = []
        self._random = np.empty((len(QUADRANTS), cells.ax.size), np.complex128)
        for random, (sx, sy) in zip(self._random, QUADRANTS, strict=True):
            mx, my = sx * cells.ax, sy * cells.ay
            random[:] = factor * draw(ocean.seed, mx, my)
            if sx < 0:
                np.conj(random, out=random)
            self._places.append((0 if sx > 0 else 1, sx * my, cells.ax))

    def realise(self, sea: Sea, variances: Real) -> Amplitudes:
        """Return the waves of a sea, from their variances in the cells."""
        given = self._given
        shape = given.grid.half_shape
        forward, backward = (np.zeros(shape, np.complex128, order="F") for _ in range(2))
        variance_forward, variance_backward = np.zeros(shape), np.zeros(shape)
        arrays = (forward, variance_forward), (backward, variance_backward)
        h0 = np.sqrt(variances) * self._random
        for (way, rows, columns), waves, variance in zip(self._places, h0, variances, strict=True):
            into, expected = arrays[way]
            into[rows, columns], expected[rows, columns] = waves, variance
        return Amplitudes(
            given.grid,
            sea.depth,
            sea.surface_tension,
            given.loop,
            forward,
            backward,
            variance_forward,
            variance_backward,
            given.draw,
            given.band,
        )
