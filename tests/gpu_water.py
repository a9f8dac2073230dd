"""Water on a graphics processor, real or in NumPy, beside the same water in double precision."""

import numpy as np

import fftocean as fo
from fftocean.fields import FIELDS

ALL = (*FIELDS, "normal", "jacobian")
GALE = fo.Sea.from_wind(speed=14.0, fetch=200e3, depth=40.0, direction=30.0)
TILES = {
    "usual": {"n": 64, "size": 200.0},
    "oblong": {"n": (128, 32), "size": (250.0, 90.0)},
    "least": {"n": (2, 16), "size": (40.0, 200.0)},
    "longest-line-in-one-step": {"n": (512, 8), "size": (500.0, 20.0)},
    "two-steps-along-x": {"n": (1024, 8), "size": (900.0, 15.0)},
    "two-steps-along-y": {"n": (8, 2048), "size": (15.0, 1500.0)},
}


def pair(**given):
    """Return an ocean of the graphics processor, and the same one in double precision."""
    given = {"seed": 7, "choppiness": 0.9, **given}
    return fo.Ocean(GALE, backend="gpu", **given), fo.Ocean(GALE, dtype="float64", **given)


def apart(seen, frame, fields=ALL):
    """Return the largest relative error of a field; fields without waves must be exactly 0."""
    found = 0.0
    for name in fields:
        size = np.linalg.norm(frame[name])
        error = np.linalg.norm(seen[name] - frame[name])
        found = max(found, error / size if size > 0.0 else np.inf if error > 0.0 else 0.0)
    return found
