"""
The water of these tests by the library's frames, and the text of sidecars evaluated literally.
"""

import json
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import fftocean as fo

N, LOOP, FRAMES, SEED = (32, 16), 20.0, 4, 7
OBLONG, SQUARE = (50.0, 20.0), (40.0, 40.0)  # [m]


def job(**keys):
    """
    Return a small, steep sea on an oblong tile; keys with `_` for `.`, such as bake_engine="three".
    """
    settings = {
        "ocean.n": N,
        "ocean.size": OBLONG,
        "ocean.loop": LOOP,
        "ocean.seed": SEED,
        "bake.frames": FRAMES,
        "bake.pictures": [],
        "sea.wind.speed": 7.0,
        "sea.wind.direction": 30.0,
    }
    return fo.Job.default().replaced(
        {**settings, **{k.replace("__", "."): v for k, v in keys.items()}}
    )


FIELDS = (
    "height",
    "displace_x",
    "displace_y",
    "slope_x",
    "slope_y",
    "stretch_xx",
    "stretch_xy",
    "stretch_yy",
)


def truth(baked):
    """
    Return the job's water by names, in library axes, metres, row 0 south, each (frames, ny, nx),
    float64, from its ocean alone.
    """
    ocean = baked.ocean(dtype="float64")
    frames = [ocean.frame(j * LOOP / FRAMES, FIELDS) for j in range(FRAMES)]
    of = lambda name: np.stack([getattr(f, name) for f in frames]).astype(float)  # noqa: E731
    c, normal = ocean.choppiness, np.stack([fo.normals(f) for f in frames]).astype(float)
    return {
        **{axis: c * of(f"displace_{axis}") for axis in "xy"},
        "z": of("height"),
        **{f"slope_{axis}": of(f"slope_{axis}") for axis in "xy"},
        **{f"stretch_{axis}{axis}": c * of(f"stretch_{axis}{axis}") for axis in "xy"},
        **{f"normal_{axis}": normal[..., k] for k, axis in enumerate("xyz")},
    }


def between(field, x, y, size):
    """Return a periodic field (ny, nx, channels) at x and y [m], linear between its samples."""
    ny, nx = field.shape[:2]
    rows, columns = np.asarray(y) / size[1] * ny, np.asarray(x) / size[0] * nx
    j, i = np.floor(rows).astype(int), np.floor(columns).astype(int)
    b, a = (rows - j)[:, None], (columns - i)[:, None]
    at = lambda dj, di: field[(j + dj) % ny, (i + di) % nx]  # noqa: E731
    return (1 - b) * ((1 - a) * at(0, 0) + a * at(0, 1)) + b * ((1 - a) * at(1, 0) + a * at(1, 1))


def places(size=OBLONG):
    """
    Return x and y [m], and where they are samples: all samples of the tile, the same some tiles
    away, and the middles between samples along each axis and along both.
    """
    (nx, ny), (lx, ly) = N, size
    j, i = (a.ravel() for a in np.mgrid[0:ny, 0:nx])
    shifts = ((0, 0), (2 * nx, -ny), (-3 * nx, 2 * ny), (0.5, 0), (0, 0.5), (0.5, 0.5))
    x, y = (
        np.concatenate([(k + s[axis]) * side / n for s in shifts])
        for axis, k, side, n in ((0, i, lx, nx), (1, j, ly, ny))
    )
    return x, y, np.arange(x.size) < 3 * i.size


COMPASS = {
    "east": ("x", 1.0),
    "west": ("x", -1.0),
    "north": ("y", 1.0),
    "south": ("y", -1.0),
    "up": ("z", 1.0),
    "down": ("z", -1.0),
}


@dataclass
class Text:
    """Text of a bake about a map: the axes of its numbers, and its sampling formulas."""

    conventions: dict
    sampling: dict  # formulas for places and times, and the numbers in them
    meaning: dict  # formulas for what the channels give

    @classmethod
    def of(cls, folder, name):
        """Read the sidecar of a map, or the manifest if it has none."""
        folder = Path(folder)
        tree = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
        meaning = tree["maps"][name]["world"]
        if (folder / f"{name}.json").exists():
            tree = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
            assert tree["world"] == meaning
        return cls(tree["conventions"], tree["sampling"], meaning)

    @property
    def axes(self):
        """Return the direction of each of the engine's axes: {"X": ("x", 1.0), ...}."""
        found = dict(
            re.findall(r"\b([XYZ]) (east|west|north|south|up|down)\b", self.conventions["axes"])
        )
        assert sorted(found) == ["X", "Y", "Z"], self.conventions["axes"]
        return {letter: COMPASS[word] for letter, word in found.items()}

    @property
    def handed(self):
        """Return "left" or "right"."""
        (word,) = re.findall(r"(left|right)-handed", self.conventions["axes"])
        return word

    @property
    def per_metre(self):
        """Return the engine's units in a metre."""
        return {"m": 1.0, "cm": 100.0}[self.conventions["unit"]]

    def world(self, x, y, z=0.0):
        """Return x, y, z [m] in the engine's own axes and unit, (places, 3)."""
        ours = {"x": x, "y": y, "z": np.broadcast_to(z, np.shape(x))}
        return np.stack(
            [
                sign * self.per_metre * np.asarray(ours[axis])
                for axis, sign in (self.axes[letter] for letter in "XYZ")
            ],
            axis=-1,
        )

    def expected(self, fields, key):
        """
        Return the expected value of the formula for `key` from the library's fields (frames, ny,
        nx): "X", "slope_X", "stretch_X" or "normal_X".
        """
        kind, _, letter = key.rpartition("_")
        axis, sign = self.axes[letter]
        if kind == "stretch":
            return fields[f"stretch_{axis}{axis}"]  # mirrored twice
        if kind:
            return sign * fields[f"{kind}_{axis}"]
        return sign * self.per_metre * fields[axis]


def half_step(values):
    """Return the distance of neighbouring half floats at some values."""
    return np.spacing(np.abs(values).astype(np.float16)).astype(float)


def steepest(field):
    """Return the largest difference of neighbouring samples, per channel, (channels,)."""
    return np.maximum(
        *(
            np.max(np.abs(field - np.roll(field, 1, axis)), axis=(-3, -2))
            .reshape(-1, field.shape[-1])
            .max(axis=0)
            for axis in (-3, -2)
        )
    )
