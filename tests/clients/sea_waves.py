"""
Questions for the readers of a package's waves, and the answers.

`ask.txt` has a question a line: `sea FOLDER W` opens a package with its W strongest waves, -1 for
all; `at X Y T` asks for the water above a place, and `rest X Y T` for the water that rests there. A
reader answers with a line each: `ok RMS` or `error WORDS`, and ten numbers.
"""

from dataclasses import dataclass

import bad_packages as bad
import numpy as np

import fftocean as fo
from fftocean.amplitudes import Modes

STRONGEST = 200
COLUMNS = ("x0", "y0", "x", "y", "height", "nx", "ny", "nz", "residual", "jacobian")


def folder_of(case):
    """Return the name of the folder of a package with a fault."""
    return "bad-" + "".join(c if c.isalnum() else "-" for c in case)


def packages():
    """Return the files of all packages, {path: bytes}."""
    found = {f"good/{name}": data for name, data in bad.files().items()}
    for case, (make, _) in bad.CASES.items():
        found |= {f"{folder_of(case)}/{name}": data for name, data in make().items()}
    return found


def points(count):
    """
    Return places and times, (count, 3): in the tile, up to a thousand kilometres out, on both sides
    of 0, at whole ticks and between them, up to a year later.
    """
    rng = np.random.default_rng(11)
    near = rng.uniform(-300.0, 300.0, (count, 2))
    far = rng.uniform(-1e6, 1e6, (count, 2))
    place = np.where(rng.random(count)[:, None] < 0.5, near, far)
    ticks = 64.0 * rng.integers(0, 2**20, 10) / 2**20
    times = np.concatenate([ticks, rng.uniform(-100.0, 100.0, 8), [0.0, 3e7]])
    return np.column_stack([place, times[np.arange(count) % times.size]])


def questions(count):
    """Return the text of ask.txt for some points."""
    lines = ["sea good -1"]
    for word in ("at", "rest"):
        lines += [f"{word} {x!r} {y!r} {t!r}" for x, y, t in points(count).tolist()]
    lines.append(f"sea good {STRONGEST}")
    lines += [f"rest {x!r} {y!r} {t!r}" for x, y, t in points(count).tolist()]
    lines += [f"sea {folder_of(case)} -1" for case in bad.CASES]
    return "\n".join(lines) + "\n"


@dataclass
class Answers:
    """Answers of a reader."""

    at: np.ndarray  # (points, 10): of all waves
    rest: np.ndarray
    neglected: float  # by the strongest waves [m]
    strongest: np.ndarray  # (points, 10): `rest` of the strongest waves
    refusals: dict[str, str]  # by name of the fault


def answers(lines, count):
    """Return what a reader answered to the questions."""
    assert lines[0] == "ok 0" or float(lines[0].split()[1]) == 0.0, lines[0]
    table = lambda part: np.array([line.split() for line in part], dtype=float)  # noqa: E731
    first, second = 1 + count, 1 + 2 * count
    word, rms = lines[second].split()
    assert word == "ok"
    end = second + 1 + count
    cases = lines[end:]
    assert len(cases) == len(bad.CASES)
    return Answers(
        at=table(lines[1:first]),
        rest=table(lines[first:second]),
        neglected=float(rms),
        strongest=table(lines[second + 1 : end]),
        refusals=dict(zip(bad.CASES, cases, strict=True)),
    )


def require_right(found, folder, *, metres, unit):
    """
    Check answers against the library: the water above places by `fo.Query`, that which rests there
    by the direct sum.

    Args:
        found: of a reader.
        folder: of the good package.
        metres: largest error of heights and places [m].
        unit: largest error of normals [-].
    """
    x, y, t = points(len(found.at)).T
    sea = fo.load_sea(folder, dtype="float64")
    expected = fo.Query(sea, mode="exact", level="frame").at(x, y, t)
    assert not np.any(expected.folded)
    at = dict(zip(COLUMNS, found.at.T, strict=True))
    errors = {
        "height": np.abs(at["height"] - expected.heights).max(),
        "place": np.hypot(at["x0"] - expected.x0, at["y0"] - expected.y0).max(),
        "normal": np.abs(found.at[:, 5:8] - expected.normals).max(),
    }
    assert at["residual"].max() <= metres
    assert at["jacobian"].min() > 0.0
    surfaces = [
        fo.gerstner.surface(ocean, x[here], y[here], moment)
        for moment in np.unique(t)
        for here in [t == moment]
        for ocean in [Everything(sea)]
    ]
    rest = dict(zip(COLUMNS, found.rest.T, strict=True))
    for moment, surface in zip(np.unique(t), surfaces, strict=True):
        here = t == moment
        for name, value in (("x", surface.x), ("y", surface.y), ("height", surface.z)):
            error = np.abs(rest[name][here] - value).max()
            errors[f"rest {name}"] = max(error, errors.get(f"rest {name}", 0.0))
        error = np.abs(found.rest[here, 5:8] - surface.normal).max()
        errors["rest normal"] = max(error, errors.get("rest normal", 0.0))
    print({name: f"{error:.2g}" for name, error in errors.items()})
    for name, error in errors.items():
        assert error <= (unit if "normal" in name else metres), name


class Everything:
    """The waves of all tiles of a cascade as one list, at whole cycles of its loop."""

    def __init__(self, cascade):
        self.depth, self.choppiness = cascade.depth, cascade.choppiness
        self._tiles = [ocean.modes() for ocean in cascade.oceans]

    def modes(self):
        return Modes(*(np.concatenate(column) for column in zip(*self._tiles, strict=True)))


def require_strongest(found):
    """
    Check the strongest waves: `neglected_rms` is that of the waves left out, summed from the
    records, and the heights differ by it.

    The mean square of some points differs from the mean over all by its own chance: a third of the
    value for a few hundred.
    """
    squares = np.concatenate(
        [
            4.0 * (records["re"].astype(float) ** 2 + records["im"].astype(float) ** 2)
            for name, data in bad.files().items()
            if name.endswith(".waves")
            for records in [
                np.frombuffer(data, "<i2, <i2, <u2, <f4, <f4").view(
                    [("mx", "<i2"), ("my", "<i2"), ("cycles", "<u2"), ("re", "<f4"), ("im", "<f4")]
                )
            ]
        ]
    )
    expected = np.sqrt(np.sort(squares)[:-STRONGEST].sum() / 2.0)
    assert abs(found.neglected - expected) <= 1e-9
    lost = found.rest[:, 4] - found.strongest[:, 4]
    assert 0.7 < np.sqrt(np.mean(lost**2)) / expected < 1.3
