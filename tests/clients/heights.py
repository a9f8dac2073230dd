"""A baked height field, questions for a reader, and the answers."""

import numpy as np
from water import FRAMES, LOOP, OBLONG, Text, between, half_step, job

import fftocean as fo


def heights_bake(engine, folder):
    """
    Bake heights by position for an engine; return the sidecar, and the heights (frames, ny, nx)
    [m].
    """
    baked = job(
        bake__engine=engine, bake__format="bin", bake__maps=["height"], bake__lookup="eulerian"
    )
    fo.bake(baked, folder, executor="serial")
    water = fo.Eulerian(baked.ocean(dtype="float64"))
    fields = [
        water.frame(j * LOOP / FRAMES, ("height",)).height.astype(float) for j in range(FRAMES)
    ]
    return Text.of(folder, "height"), np.stack(fields)


def questions(said, heights):
    """
    Return places X, Z and times, (points, 3), with the heights there in the engine's unit, and
    their tolerance.

    At samples, between them, outside the tile, before the start and after the loop. A reader weighs
    halves, each off by half its step.
    """
    rng = np.random.default_rng(5)
    x = np.concatenate([[0.0, OBLONG[0] / 32, -0.001, 1234.5], rng.uniform(-100, 100, 40)])
    y = np.concatenate([[0.0, OBLONG[1] / 16, -0.001, 987.6], rng.uniform(-60, 60, 40)])
    t = np.concatenate([[0.0, LOOP / FRAMES, -0.5, 100.3], rng.uniform(-30, 50, 40)])
    at = t / LOOP * FRAMES
    low = np.floor(at).astype(int)
    each = np.stack([between(h[..., None], x, y, OBLONG)[:, 0] for h in heights])
    k = np.arange(x.size)
    expected = (1 - (at - low)) * each[low % FRAMES, k] + (at - low) * each[(low + 1) % FRAMES, k]
    place = said.world(x, y)
    horizontal = ["XYZ".index(letter) for letter, (axis, _) in said.axes.items() if axis != "z"]
    rounding = 0.5 * half_step(np.abs(heights).max())
    return (
        np.column_stack([place[:, horizontal], t]),
        said.per_metre * expected,
        said.per_metre * (rounding + 1e-5),
    )
