"""
A run-time package, evolved by NumPy alone: `sea.json` and its `tileN.waves`.

The mesh has its vertices where rows and columns cross, so that the sum of all waves at all vertices
is two products of matrices a tile: no interpolation, and any spacing of rows and columns. Waves
that are too short for the spacing at a vertex are left out there, and become roughness.
"""

import hashlib
import json
import math
import sys
from pathlib import Path

import numpy as np

RECORD = np.dtype([("mx", "<i2"), ("my", "<i2"), ("cycles", "<u2"), ("re", "<f4"), ("im", "<f4")])
FIELDS = (
    *("height", "displace_x", "displace_y", "slope_x", "slope_y"),
    *("stretch_xx", "stretch_xy", "stretch_yy"),
)


class Sea:
    """The waves of a package, by tile."""

    def __init__(self, folder):
        """Read a package; exit with the reason if it is not one, or is damaged."""
        folder = Path(folder)
        try:
            document = json.loads((folder / "sea.json").read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            sys.exit(f"{folder} must hold a run-time package with its sea.json: {error}")
        kind = document.get("format"), document.get("version")
        if kind != ("fftocean-runtime", 1):
            sys.exit(f"{folder}/sea.json must be fftocean-runtime 1, got {kind[0]} {kind[1]}")
        self.document = document
        self.loop, self.ticks = document["loop"], document["ticks"]
        self.choppiness = document["choppiness"]
        sums = {file["name"]: file["sha256"] for file in document["files"]}
        self.tiles = [
            Tile(read_checked(folder / f"tile{i}.waves", sums), tile, document)
            for i, tile in enumerate(document["tiles"])
        ]

    def tick(self, frame, frames):
        """Return the moment of a frame from 0, when `frames` of them are the loop."""
        return round(self.ticks * (frame % frames) / frames)


def read_checked(file, sums):
    """Return the bytes of a file of a package; exit if they are not those of its document."""
    try:
        data = file.read_bytes()
    except OSError as error:
        sys.exit(f"{file} must be there: {error}")
    if hashlib.sha256(data).hexdigest() != sums.get(file.name):
        sys.exit(f"{file} must be the file of sea.json, and its SHA-256 differs")
    return data


class Tile:
    """The waves of a tile, as a plane of the rows and columns that have any."""

    def __init__(self, data, tile, document):
        waves = np.frombuffer(data, RECORD)
        (lx, ly), depth = tile["size"], document["depth"] or math.inf
        rows, row = np.unique(waves["my"], return_inverse=True)
        columns, column = np.unique(waves["mx"], return_inverse=True)
        self.ky, self.kx = 2.0 * np.pi * rows / ly, 2.0 * np.pi * columns / lx
        self.h0 = np.zeros((rows.size, columns.size), complex)
        self.h0[row, column] = waves["re"] + 1j * waves["im"].astype(float)
        self.cycles = np.zeros(self.h0.shape, np.uint32)
        self.cycles[row, column] = waves["cycles"]
        kx, ky = self.kx[None, :], self.ky[:, None]
        k = np.hypot(kx, ky)
        k[k == 0.0] = 1.0  # no wave is there
        f = 1.0 / (k * np.tanh(k * depth))
        x, y = 1j * kx, 1j * ky
        self.factors = dict(
            zip(
                FIELDS,
                np.broadcast_arrays(
                    *(np.ones_like(k), x * f, y * f, x, y, x * x * f, x * y * f, y * y * f)
                ),
                strict=True,
            )
        )
        self.slope_variance = 2.0 * np.abs(self.h0) ** 2 * k**2

    def at(self, tick, ticks):
        """Return h0 e^(-i omega t) of every wave; the field is twice the real part of their sum."""
        turn = (self.cycles * np.uint32(tick)) & np.uint32(ticks - 1)
        return self.h0 * np.exp(-2j * np.pi * turn / ticks)


class Surface:
    """
    The water of a sea whose rest positions are the crossings of columns x and rows y [m].

    Args:
        sea: of a package.
        x, y: increasing, in metres from the sea's origin.
        filtered: leave out waves that the spacing of rows and columns does not resolve.
    """

    def __init__(self, sea, x, y, filtered=True):
        self.sea, self.x, self.y = sea, np.asarray(x, float), np.asarray(y, float)
        self._exact, self._mesh = [], []
        self.rough = np.zeros((self.y.size, self.x.size))
        for tile in sea.tiles:
            across = np.exp(1j * np.outer(tile.kx, self.x))
            along = np.exp(1j * np.outer(self.y, tile.ky))
            self._exact.append((along.astype(np.complex64), across.astype(np.complex64)))
            if filtered:
                kept_x = resolved(np.outer(tile.kx, np.gradient(self.x)))
                kept_y = resolved(np.outer(np.gradient(self.y), tile.ky))
                self._mesh.append((along * kept_y, across * kept_x))
                kept = kept_y**2 @ tile.slope_variance @ kept_x**2
                self.rough += np.maximum(tile.slope_variance.sum() - kept, 0.0)
            else:
                self._mesh.append((along, across))

    def fields(self, tick, names=FIELDS, exact=False):
        """
        Return fields (rows, columns) at a moment, by name, before choppiness.

        Args:
            tick: the moment.
            names: of fields.
            exact: with all waves, in single precision; else those that the spacing resolves.
        """
        total = {name: np.zeros(self.rough.shape) for name in names}
        for tile, (along, across) in zip(
            self.sea.tiles, self._exact if exact else self._mesh, strict=True
        ):
            waves = tile.at(tick, self.sea.ticks).astype(along.dtype)
            for name in names:
                factor = tile.factors[name].astype(along.dtype)
                total[name] += 2.0 * ((along @ (waves * factor)) @ across).real
        return total

    def vertices(self, fields):
        """Return the displaced vertices, (rows, columns, 3) [m]."""
        c = self.sea.choppiness
        return np.stack(
            [
                self.x[None, :] + c * fields["displace_x"],
                self.y[:, None] + c * fields["displace_y"],
                fields["height"],
            ],
            axis=-1,
        )

    def normals(self, fields):
        """Return the normals of the displaced surface, (rows, columns, 3)."""
        a, b, d = gradient(fields, self.sea.choppiness)
        sx, sy = fields["slope_x"], fields["slope_y"]
        jacobian = np.maximum(a * d - b * b, 0.05)  # in a fold, that of steep water
        normal = np.stack([b * sy - d * sx, b * sx - a * sy, jacobian], axis=-1)
        return normal / np.linalg.norm(normal, axis=-1, keepdims=True)

    def missing(self):
        """Return the slope variance that the mesh does not have, both axes, (rows, columns)."""
        xx, yy, _ = self.sea.document["slope_variance"]["beyond"]
        return self.rough + max(xx + yy, 0.0)

    def breaking(self, tick):
        """Return the rate at which foam is made, of all waves (rows, columns) [1/s]."""
        foam = self.sea.document["foam"]
        names = "stretch_xx", "stretch_xy", "stretch_yy"
        a, b, d = gradient(self.fields(tick, names, exact=True), self.sea.choppiness)
        smallest = 0.5 * (a + d) - np.hypot(0.5 * (a - d), b)
        return foam["strength"] * np.maximum(foam["threshold"] - smallest, 0.0)


def gradient(fields, choppiness):
    """Return xx, xy, yy of the gradient of the displaced position."""
    return (
        1.0 + choppiness * fields["stretch_xx"],
        choppiness * fields["stretch_xy"],
        1.0 + choppiness * fields["stretch_yy"],
    )


def resolved(step):
    """Return the share of a wave that vertices k step apart carry: 1 to pi/2, 0 from pi."""
    return np.cos(np.clip(np.abs(step) - 0.5 * np.pi, 0.0, 0.5 * np.pi)) ** 2


class Foam:
    """
    Coverage of foam on a surface: what broke in the last seconds and has not decayed.

    The foam of a frame is a function of that frame alone, so frames may come in any order, and the
    loop closes. It adds up three decays, in steps of a tenth of a second at most; rates of earlier
    frames are kept.
    """

    def __init__(self, surface, frames):
        self.surface, self.frames, self._rates = surface, frames, {}
        sea = surface.sea
        self.decay = sea.document["foam"]["decay"]
        # A crest moves on by less than a patch of foam in a tenth of a second; with longer steps
        # neighbouring frames would have other patches.
        self.stride = max(1, int(0.1 * frames / sea.loop))
        self.step = self.stride * sea.loop / frames

    def coverage(self, frame):
        """Return the share of the water that is white, (rows, columns)."""
        left = math.exp(-self.step / self.decay)
        count = math.ceil(3.0 * self.decay / self.step)
        total = 0.0
        for m in range(count):
            total = total + self._rate((frame - m * self.stride) % self.frames) * left**m
        return 1.0 - np.exp(-total * self.decay * (1.0 - left) / (1.0 - left**count))

    def _rate(self, frame):
        if frame not in self._rates:
            tick = self.surface.sea.tick(frame, self.frames)
            self._rates[frame] = self.surface.breaking(tick).astype(np.float32)
        return self._rates[frame]


def graded(near, ratio, low, high):
    """
    Return increasing positions from `low` to `high` around 0 [m].

    Neighbours are `near` apart at 0, and farther off `ratio` times the distance.
    """

    def half(end):
        count = math.ceil(math.asinh(ratio * end / near) / ratio)
        steps = np.sinh(np.linspace(0.0, math.asinh(ratio * end / near), count + 1))
        return steps * near / ratio

    return np.concatenate([-half(-low)[:0:-1], half(high)])
