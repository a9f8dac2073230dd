"""
Few-wave models in headless Chromium: vertices read back from the GPU against the direct sum.
"""

import base64

import numpy as np
import pytest
from web import floats

import fftocean as fo
from fftocean.view.few_waves import MODELS, few_waves

pytestmark = pytest.mark.client

SEA = fo.Sea.from_wind(speed=11.0, fetch=150e3, direction=30.0)
LOOP, TICKS = 64.0, 2**19
COLUMNS, RINGS = 40, 30
PLACES = {
    "low": {"east": 0.0, "north": 0.0, "height": 3.0, "yaw": 60.0, "pitch": -8.0},
    # 400 km away a 32-bit float has steps of 3 cm
    "far": {"east": 4e5 + 0.3, "north": -1e5, "height": 40.0, "yaw": 200.0, "pitch": -30.0},
    "down": {"east": 12.5, "north": 7.0, "height": 200.0, "yaw": 0.0, "pitch": -90.0},
}
TICK = {"low": 0, "far": 123457, "down": TICKS - 1}
CASES = [(model, number, place) for model in MODELS for number in (3, 64) for place in PLACES]
CASES = [case for i, case in enumerate(CASES) if i % 2 == 0 or case[1] == 64]
# a 32-bit float is good to 6e-8; a sum of 64 waves and their derivatives gathers several of those
ROUNDING = 1e-6


@pytest.fixture(scope="module")
def seen(browser):
    """Draw every case on one page: {case: vertices}, and their models."""
    models = {
        (model, number): few_waves(SEA, model, number=number, loop=LOOP, ticks=TICKS, seed=5)
        for model in MODELS
        for number in (3, 64)
    }
    names = {key: f"{key[0]}-{key[1]}" for key in models}
    views = [
        {
            "model": names[model, number],
            "tick": TICK[place],
            "place": PLACES[place],
            "look": {"choppiness": 1.0},
            "fade": False,
        }
        for model, number, place in CASES
    ]
    views.append({**views[0], "fade": True, "part": [0, 0, 96, 64]})
    views.append({**views[0], "look": {"choppiness": 0.5}})
    views.append({**views[0], "fade": True, "part": [0, 0, 48, 64]})
    value, _ = browser.run(
        "few_waves.html",
        {
            "models": {names[key]: model.document() for key, model in models.items()},
            "views": views,
            "columns": COLUMNS,
            "rings": RINGS,
        },
    )
    assert value["error"] == 0
    return models, value["seen"]


def read(one):
    """Return the vertices of one view: at rest, their displacements and normals."""
    count = COLUMNS * RINGS
    return (floats(one[name], count, n) for name, n in (("still", 2), ("moved", 3), ("normal", 3)))


def expected(seen, case):
    """Return the surface of the direct sum at the vertices of a view, and what was read back."""
    model, number, place = case
    still, moved, normal = read(seen[1][CASES.index(case)])
    x, y = still.T + np.array([[PLACES[place]["east"]], [PLACES[place]["north"]]])
    return still, moved, normal, seen[0][model, number].at(x, y, TICK[place])


def relative(found, right):
    """Return the relative error of vectors, in the mean square."""
    return np.linalg.norm(found - right) / np.linalg.norm(right)


@pytest.mark.parametrize("case", CASES, ids=lambda case: "-".join(map(str, case)))
def test_displacements_and_normals_are_those_of_the_direct_sum(seen, case):
    """At every vertex, from below the eye to the horizon, also far from the origin."""
    still, moved, normal, right = expected(seen, case)
    assert np.hypot(*still.T).max() > 100.0
    assert np.std(right.height) > 0.1
    exact = np.column_stack([right.displace_x, right.displace_y, right.height])
    for axis in range(3):
        assert relative(moved[:, axis], exact[:, axis]) <= ROUNDING
        assert relative(normal[:, axis], right.normal[:, axis]) <= ROUNDING
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, atol=3e-7)


def test_choppiness_scales_the_horizontal_motion_alone(seen):
    first, half = seen[1][0], seen[1][len(CASES) + 1]
    _, moved, normal = read(first)
    _, less, flatter = read(half)
    assert relative(2.0 * less[:, :2], moved[:, :2]) <= ROUNDING
    assert np.array_equal(less[:, 2], moved[:, 2])
    assert relative(flatter, normal) > 1e-3


def test_waves_that_the_mesh_cannot_hold_are_left_out(seen):
    """Near the eye, where vertices are close, all waves are there; at the horizon none is."""
    still, whole, _ = read(seen[1][0])
    _, faded, normal = read(seen[1][len(CASES)])
    distance = np.hypot(*still.T)
    last = distance > 0.9 * distance.max()
    assert np.abs(faded[last]).max() == 0.0
    assert np.all(normal[last] == [0.0, 0.0, 1.0])
    rings = distance.reshape(RINGS, COLUMNS)[:, COLUMNS // 2]
    gap = np.repeat(np.gradient(rings), COLUMNS)
    dense = gap < 1.0  # [m], against waves of at least 21 m
    assert np.count_nonzero(dense) > COLUMNS
    assert np.array_equal(faded[dense], whole[dense])


def test_the_picture_is_drawn_into_its_part_alone(seen):
    """Water below the horizon and sky above it; the other part keeps its colour."""
    one = seen[1][len(CASES) + 2]
    width, height = one["size"]
    pixels = np.frombuffer(base64.b64decode(one["picture"]), np.uint8).reshape(height, width, 4)
    red = np.all(pixels[..., :3] == [255, 0, 0], axis=-1)
    assert np.all(red[:, 48:])
    assert not np.any(red[:, :48])
    whole = np.frombuffer(base64.b64decode(seen[1][len(CASES)]["picture"]), np.uint8)
    assert np.array_equal(pixels[:, :48], whole.reshape(height, width, 4)[:, :48])
    sky, water = (
        part.astype(float).mean(axis=(0, 1)) for part in (pixels[-9:, :48], pixels[:9, :48])
    )
    assert sky.sum() > 1.3 * water.sum()
