"""The waves of a list by rings of one wavenumber, for sums at many points below the surface."""

from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Integer, Real
from fftocean.kernels import rings as kernels
from fftocean.wave_list import WaveList


@dataclass(frozen=True, slots=True, eq=False)
class _Tile:
    """The waves of a tile, in quartets (+-kx, +-ky), in rings."""

    size: tuple[float, float]  # [m]
    waves: slice  # in the list
    columns: Real  # the values of |kx| [rad/m]
    rows: Real  # of |ky| [rad/m]
    first: Integer  # these and the next are the fields of `kernels.rings.Quartets`
    k: Real
    omega: Real
    column: Integer
    row: Integer
    quartet: Integer  # of each wave
    signs: tuple[Real, Real]  # of each wave's kx, ky


class WaveRings:
    """All waves of a list, by rings."""

    def __init__(self, waves: WaveList) -> None:
        self.waves = waves
        self._tiles = [_by_rings(waves, tile) for tile in range(len(waves.loops))]

    def at(self, t: float) -> "RingsAtTime":
        """Return the waves at a time [s]."""
        phases, amplitude = self.waves.phases(t), self.waves.amplitude
        tiles = []
        for tile in self._tiles:
            sums = np.zeros((tile.column.size, 8))
            kernels.add_waves(
                tile.quartet, *tile.signs, amplitude[tile.waves], phases[tile.waves], sums
            )
            tiles.append(
                kernels.Quartets(tile.first, tile.k, tile.omega, tile.column, tile.row, sums)
            )
        return RingsAtTime(self.waves.depth, tuple(zip(self._tiles, tiles, strict=True)))


@dataclass(frozen=True, slots=True, eq=False)
class RingsAtTime:
    """Waves by rings at one time."""

    depth: float  # [m]
    tiles: tuple[tuple[_Tile, kernels.Quartets], ...]

    def near(self, x: Real, y: Real) -> "RingsAtPoints":
        """Return the waves at points (x, y), at most `kernels.rings.POINTS` [m]."""
        return RingsAtPoints(self, tuple(_tables(tile, x, y) for tile, _ in self.tiles), x.size)


@dataclass(frozen=True, slots=True, eq=False)
class RingsAtPoints:
    """Waves by rings at one time, with their cosines and sines at points."""

    rings: RingsAtTime
    tables: tuple[kernels.Tables, ...]  # of each tile
    points: int

    def heights(self) -> Real:
        """Return the height of linear theory [m]; NaN at points that are not finite."""
        out = np.zeros(self.points)
        for (_, quartets), tables in zip(self.rings.tiles, self.tables, strict=True):
            kernels.sum_heights(tuple(quartets), tuple(tables), out)
        return out

    def below(self, level: Real, rise: Real) -> Real:
        """
        Return velocity, acceleration and -d potential/dt, (points, 7).

        Args:
            level: where profiles are evaluated, from the bed to 0 [m].
            rise: how far they go on along their tangents at 0 [m].
        """
        out, buffer = np.zeros(kernels.OUTPUTS * self.points), np.empty(11 * self.points)
        bits = buffer[10 * self.points :].view(np.int64)
        for (tile, quartets), tables in zip(self.rings.tiles, self.tables, strict=True):
            kernels.sum_below(
                tuple(quartets),
                tuple(tables),
                tile.columns,
                tile.rows,
                self.rings.depth,
                level,
                rise,
                buffer,
                bits,
                out,
            )
        return np.ascontiguousarray(out.reshape(kernels.OUTPUTS, self.points).T)


def _by_rings(waves: WaveList, tile: int) -> _Tile:
    """Return the waves of one tile by rings, and quartets within."""
    part = slice(int(waves.first[tile]), int(waves.first[tile + 1]))
    kx, ky, omega = waves.kx[part], waves.ky[part], waves.omega[part]
    columns, column = np.unique(np.abs(kx), return_inverse=True)
    rows, row = np.unique(np.abs(ky), return_inverse=True)
    k = np.hypot(kx, ky)
    order = np.lexsort((row, column, omega, k))
    keys = np.stack([k[order], omega[order], column[order], row[order]])
    changed = np.ones((4, order.size), dtype=bool)
    changed[:, 1:] = keys[:, 1:] != keys[:, :-1]
    new_quartet, new_ring = np.any(changed, axis=0), np.any(changed[:2], axis=0)
    heads = np.flatnonzero(new_quartet)  # the first wave of each quartet
    quartet = np.empty(order.size, dtype=np.int64)
    quartet[order] = np.cumsum(new_quartet) - 1
    begins = np.flatnonzero(new_ring[heads])  # the first quartet of each ring
    lx, ly = waves.sizes[tile]
    return _Tile(
        size=(float(lx), float(ly)),
        waves=part,
        columns=columns,
        rows=rows,
        first=np.append(begins, heads.size).astype(np.int64),
        k=keys[0, heads[begins]],
        omega=keys[1, heads[begins]],
        column=column[order[heads]].astype(np.int64),
        row=row[order[heads]].astype(np.int64),
        quartet=quartet,
        signs=(np.where(kx < 0.0, -1.0, 1.0), np.where(ky < 0.0, -1.0, 1.0)),
    )


def _tables(tile: _Tile, x: Real, y: Real) -> kernels.Tables:
    """Return the cosines and sines of a tile at points."""
    out = []
    for values, size, numbers in zip((x, y), tile.size, (tile.columns, tile.rows), strict=True):
        cycles = np.empty((numbers.size + 1, values.size))
        cosine, sine = np.empty((2, numbers.size, values.size))
        kernels.tabulate(values, size, numbers, cycles, cosine, sine)
        out += [cosine, sine]
    return kernels.Tables(*out)
