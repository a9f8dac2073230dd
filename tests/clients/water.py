"""The water of these tests, by our own frames; and the text of sidecars, read to the letter."""

import json
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import fftocean as fo

N, LOOP, FRAMES, SEED = (32, 16), 20.0, 4, 7
OBLONG, SQUARE = (50.0, 20.0), (40.0, 40.0)  # [m]


def job(**keys):
    """Return a small, steep sea on an oblong tile; keys with `_` for `.`, such as bake_engine="three"."""
    settings = {
        "ocean.n": N,
        "ocean.size": OBLONG,
        "ocean.loop": LOOP,
        "ocean.seed": SEED,
        "bake.frames": FRAMES,
        "sea.wind.speed": 7.0,
        "sea.wind.direction": 30.0,
    }
    return fo.Job.default().replaced({**settings, **{k.replace("__", "."): v for k, v in keys.items()}})


FIELDS = ("height", "displace_x", "displace_y", "slope_x", "slope_y", "stretch_xx", "stretch_xy", "stretch_yy")


def truth(baked, name):
    """Return a map in our own axes, metres, row 0 south: (frames, ny, nx, channels), float64, from the job's ocean alone."""
    ocean = baked.ocean(dtype="float64")
    frames = [ocean.frame(j * LOOP / FRAMES, FIELDS) for j in range(FRAMES)]
    c = ocean.choppiness
    made = {
        "height": lambda f: [f.height],
        "displacement": lambda f: [c * f.displace_x, c * f.displace_y, f.height],
        "normal": lambda f: np.moveaxis(fo.normals(f), -1, 0),
        "derivative": lambda f: [f.slope_x, f.slope_y, c * f.stretch_xx, c * f.stretch_yy],
    }[name]
    return np.stack([np.stack(list(made(f)), axis=-1) for f in frames]).astype(float)


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
    Return x and y [m], and where they are samples: all samples of the tile, the same some tiles away, and the middles between samples
    along each axis and along both.
    """
    (nx, ny), (lx, ly) = N, size
    j, i = (a.ravel() for a in np.mgrid[0:ny, 0:nx])
    shifts = ((0, 0), (2 * nx, -ny), (-3 * nx, 2 * ny), (0.5, 0), (0, 0.5), (0.5, 0.5))
    x, y = (np.concatenate([(k + s[axis]) * side / n for s in shifts]) for axis, k, side, n in ((0, i, lx, nx), (1, j, ly, ny)))
    return x, y, np.arange(x.size) < 3 * i.size


COMPASS = {"east": ("x", 1.0), "west": ("x", -1.0), "north": ("y", 1.0), "south": ("y", -1.0), "up": ("z", 1.0), "down": ("z", -1.0)}


@dataclass
class Text:
    """Conventions of a manifest or sidecar: each sentence as numbers and expressions."""

    said: dict

    @property
    def axes(self):
        """Return where each of the engine's axes points: {"X": ("x", 1.0), ...}."""
        found = dict(re.findall(r"\b([XYZ]) (east|west|north|south|up|down)\b", self.said["axes"]))
        assert sorted(found) == ["X", "Y", "Z"], self.said["axes"]
        return {letter: COMPASS[word] for letter, word in found.items()}

    @property
    def handed(self):
        """Return "left" or "right"."""
        (word,) = re.findall(r"(left|right)-handed", self.said["axes"])
        return word

    @property
    def per_metre(self):
        """Return the engine's units in a metre."""
        return {"m": 1.0, "cm": 100.0}[self.said["unit"]]

    @property
    def rule(self):
        """Return the two expressions of u and v, in the names that the pages' shaders give to sizes and counts."""
        both = re.fullmatch(r"\s*u = (.+?), v = (.+?)(?:, repeated)?\s*", self.said["samples"])
        assert both, self.said["samples"]
        u, v = (re.sub(r"\bsize(?:_[xyuv]|\[[01]\])?", f"size_{axis}", text) for axis, text in zip("uv", both.groups(), strict=True))
        return {"u": u, "v": v}

    def world(self, x, y, z=0.0):
        """Return our x, y, z [m] in the engine's own axes and unit, (places, 3)."""
        ours = {"x": x, "y": y, "z": np.broadcast_to(z, np.shape(x))}
        return np.stack([sign * self.per_metre * np.asarray(ours[axis]) for axis, sign in (self.axes[letter] for letter in "XYZ")], axis=-1)

    def ours(self, vectors):
        """Return vectors in the engine's axes and unit in ours, metres."""
        out = np.empty_like(vectors)
        for column, letter in enumerate("XYZ"):
            axis, sign = self.axes[letter]
            out[..., "xyz".index(axis)] = sign * vectors[..., column] / self.per_metre
        return out


def text(folder, name=None):
    """Return what a bake says of its frame: the sidecar of a map where it has one, else the manifest."""
    sidecar = Path(folder) / f"{name}.json"
    tree = json.loads((sidecar if name and sidecar.exists() else Path(folder) / "manifest.json").read_text(encoding="utf-8"))
    return Text(tree["conventions"])


def shader_rule(said, size, n=N):
    """Return the sampling rule with its numbers put in, as expressions of X, Y and Z alone."""
    numbers = {"size_u": size[0] * said.per_metre, "size_v": size[1] * said.per_metre, "columns": n[0], "rows": n[1]}
    return {axis: re.sub(r"\b(size_u|size_v|columns|rows)\b", lambda m: f"{float(numbers[m[1]])!r}", rule) for axis, rule in said.rule.items()}


def half_step(values):
    """Return the distance of neighbouring half floats at some values."""
    return np.spacing(np.abs(values).astype(np.float16)).astype(float)


def steepest(field):
    """Return the largest difference of neighbouring samples, per channel, (channels,)."""
    return np.maximum(*(np.max(np.abs(field - np.roll(field, 1, axis)), axis=(-3, -2)).reshape(-1, field.shape[-1]).max(axis=0) for axis in (-3, -2)))


WORDS = {
    "height": ("height",),
    "displacement": ("x", "y", "height"),
    "normal": ("x", "y", "z"),
    "derivative": ("d height/dx", "d height/dy", "d displacement x/dx", "d displacement y/dy"),
}


def stored(baked, folder, name):
    """
    Return what the channels of a map must hold by the manifest's own words for them, (frames, ny, nx, channels): our arrays, row 0
    south, in our order of rows, but with the file's channels, signs and unit; and the unit's size.
    """
    tree = json.loads((Path(folder) / "manifest.json").read_text(encoding="utf-8"))["maps"][name]
    ours, channels = truth(baked, name), []
    for letter in "RGBA"[: max(3, ours.shape[-1])]:
        word = tree["channels"].get(letter) or tree["channels"]["Y"]
        inner = re.fullmatch(r"minus \((.*)\)", word)
        (index,) = [k for k, known in enumerate(WORDS[name]) if re.match(rf"{known}\b", inner[1] if inner else word)]
        channels.append((-1.0 if inner else 1.0) * ours[..., index])
    unit = 100.0 if tree["unit"].startswith("cm") else 1.0
    return unit * np.stack(channels, axis=-1), unit
