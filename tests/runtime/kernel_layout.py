"""
Buffers of the kernels of docs/kernels.md: what a host prepares of a package, in NumPy alone.

Written after that page and not after the kernels, so that a wrong page fails the tests.
"""

import math
from dataclasses import dataclass, field

import numpy as np

SEA_BYTES, TILE_BYTES, TABLE = 1120, 64, 96
LINE = 512  # texels of a group of `rows` and `columns`


@dataclass
class Foam:
    """The window of foam of a step."""

    side: int  # cells
    cell: float  # [m]
    decay: float
    threshold: float
    strength: float
    seconds: float = 0.0
    corner: tuple[int, int] = (0, 0)
    corner_before: tuple[int, int] = (2**20, 2**20)
    corner_place: tuple[float, float] = (0.0, 0.0)


@dataclass
class Layout:
    """Places of tiles and planes in the buffers, and the bytes of the uniform block."""

    document: dict
    lifts: list = field(default_factory=list)  # of each tile
    foam_side: int = 0

    @property
    def tiles(self):
        """Return (nx, ny) of each tile."""
        return [tuple(tile["n"]) for tile in self.document["tiles"]]

    @property
    def twiddles(self):
        """Return the largest side of all tiles."""
        return max(max(n) for n in self.tiles)

    @property
    def texels(self):
        """Return the number of texels of all tiles."""
        return sum(nx * ny for nx, ny in self.tiles)

    def first(self, index):
        """Return the first texel of a tile in h0, wave and work."""
        return sum(nx * ny for nx, ny in self.tiles[:index])

    def plane(self, index):
        """Return the first texel of a plane in maps, and its sides."""
        at = 0
        sides = [n for n in self.tiles for _ in range(3)] + [(self.foam_side,) * 2]
        for n in sides[:index]:
            at += sum(w * h for w, h in levels(*n))
        return at, (sides[index] if index < len(sides) else (0, 0))

    @property
    def planes(self):
        """Return the number of planes."""
        return 3 * len(self.tiles) + (self.foam_side > 0)

    @property
    def map_texels(self):
        """Return the number of texels of all levels of all planes."""
        return self.plane(3 * len(self.tiles) + 1)[0] or 1

    def groups(self):
        """Return the groups of `rows` and `columns`."""
        return max(max(1, nx * ny // LINE) for nx, ny in self.tiles), len(self.tiles), 1

    def mip_groups(self, base):
        """Return the groups of `mips` (base 0) and `mips_far` (base 5)."""
        sides = [*self.tiles, (self.foam_side,) * 2]
        block = 32 << base
        across = [max(math.ceil(n[i] / block) for n in sides) for i in (0, 1)]
        return *across, self.planes

    def block(self, tick, *, choppiness=None, foam=None, points=0, iterations=4, origin=(0.0, 0.0)):
        """Return the bytes of the uniform block."""
        data = np.zeros(SEA_BYTES, np.uint8)
        u, i, f = (data.view(kind) for kind in ("<u4", "<i4", "<f4"))
        ticks = self.document["ticks"]
        u[0:4] = tick, ticks - 1, len(self.tiles), self.twiddles
        f[4:6] = 1 / ticks, self.document["choppiness"] if choppiness is None else choppiness
        u[6:8] = points, iterations
        if foam:
            i[8:12] = *foam.corner, *foam.corner_before
            f[12:16] = *foam.corner_place, foam.cell, foam.seconds
            f[16:19] = foam.decay, foam.threshold, foam.strength
            u[19:21] = foam.side, self.plane(3 * len(self.tiles))[0]
        for index, tile in enumerate(self.document["tiles"]):
            at = (TABLE + index * TILE_BYTES) // 4
            (nx, ny), (lx, ly) = tile["n"], tile["size"]
            u[at : at + 4] = nx, ny, self.first(index), self.plane(3 * index)[0]
            f[at + 4 : at + 8] = lx, ly, 2 * np.pi / lx, 2 * np.pi / ly
            lifts = self.lifts[index] if self.lifts else (1, tile["mixed"], 1, 1)
            f[at + 8 : at + 12] = lifts
            f[at + 12 : at + 14] = origin[0] / lx % 1.0, origin[1] / ly % 1.0
        return data.tobytes()


def levels(nx, ny):
    """Return the sides of all levels of a plane."""
    found = [(nx, ny)]
    while nx * ny > 1:
        nx, ny = max(1, nx // 2), max(1, ny // 2)
        found.append((nx, ny))
    return found if nx else []


def tables(package):
    """Return h0, (texels, 4), and wave, (texels, 2), of all tiles, from a package's records."""
    document = package.document
    depth = document["depth"] or math.inf
    h0s, waves = [], []
    for index, tile in enumerate(document["tiles"]):
        (nx, ny), (lx, ly) = tile["n"], tile["size"]
        h0 = np.zeros((ny, nx, 4), np.float32)
        wave = np.zeros((ny, nx, 2), np.float32)
        kx = 2 * np.pi * np.fft.fftfreq(nx, 1 / nx) / lx
        ky = 2 * np.pi * np.fft.fftfreq(ny, 1 / ny) / ly
        k = np.hypot(kx[None, :], ky[:, None])
        k[0, 0] = math.inf
        wave[..., 1] = 1 / (k * np.tanh(k * depth))
        records = np.frombuffer(package.files[f"tile{index}.waves"], "<i2,<i2,<u2,<f4,<f4")
        mx, my, cycles, re, im = (records[name] for name in records.dtype.names)
        h0[my, mx, 0], h0[my, mx, 1] = re, im
        h0[-my, -mx, 2], h0[-my, -mx, 3] = re, -im
        wave[my, mx, 0] = wave[-my, -mx, 0] = cycles
        h0s.append(h0.reshape(-1, 4))
        waves.append(wave.reshape(-1, 2))
    return np.concatenate(h0s), np.concatenate(waves)


def twiddle_table(n):
    """Return cos and sin of 2 pi i / n, (n, 2) float32."""
    turn = 2 * np.pi * np.arange(n) / n
    return np.stack([np.cos(turn), np.sin(turn)], axis=-1).astype(np.float32)


def lifts_of(package):
    """Return the four lifts of each tile, from the sizes of its fields."""
    found = []
    depth = package.document["depth"] or math.inf
    for index, tile in enumerate(package.document["tiles"]):
        records = np.frombuffer(package.files[f"tile{index}.waves"], "<i2,<i2,<u2,<f4,<f4")
        mx, my, _, re, im = (records[name].astype(float) for name in records.dtype.names)
        kx, ky = 2 * np.pi * mx / tile["size"][0], 2 * np.pi * my / tile["size"][1]
        k = np.hypot(kx, ky)
        potential = 1 / (k * np.tanh(k * depth))
        factors = [(kx * potential, ky * potential), (1.0, kx * ky * potential), (kx, ky)]
        factors.append((kx**2 * potential, ky**2 * potential))
        energy = re**2 + im**2
        row = []
        for first, second in factors:
            a, b = np.sum(energy * first**2), np.sum(energy * second**2)
            row.append(2.0 ** round(math.log2(a / b) / 2) if a > 0 and b > 0 else 1.0)
        found.append(row)
    return found
