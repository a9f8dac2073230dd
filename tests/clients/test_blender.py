"""
Blender, as a Python module in its own environment: the example's Displace modifier moves vertices
to where the water is.
"""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from water import FRAMES, LOOP, OBLONG, N, half_step, job, truth

import fftocean as fo

pytestmark = pytest.mark.client

HERE = Path(__file__).resolve().parent
EXAMPLE = HERE.parents[1] / "examples" / "blender" / "displace.py"


def run(blender, *arguments, folder):
    """
    Return the last line of a script's output, run without the environment's own Python settings.
    """
    command = [str(blender), "-I", *map(str, arguments)]
    done = subprocess.run(
        command,
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        stdin=subprocess.DEVNULL,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


@pytest.mark.parametrize("format_", ["exr-float", "exr"])
def test_vertices_are_where_the_water_is_at_every_frame(blender, tmp_path, format_):
    """
    Every vertex at every frame, the frames in order, and frame F again frame 0.

    Blender holds positions in single precision: half a step at 50 m is 1.9e-6 m, and some steps of
    a displacement below 1 m add 6e-8 m each. A half adds half its step.
    """
    baked = job(bake__engine="blender", bake__format=format_, bake__maps=["displacement"])
    fo.bake(baked, tmp_path / "sea", executor="serial")
    said = json.loads(
        run(
            blender,
            HERE / "blender" / "measure.py",
            EXAMPLE,
            tmp_path / "sea",
            tmp_path / "out.npz",
            folder=tmp_path,
        ).splitlines()[-1]
    )
    found = np.load(tmp_path / "out.npz")
    water = truth(baked)
    expected = np.stack([water[axis] for axis in "xyz"], axis=-1).reshape(FRAMES, -1, 3)
    j, i = np.mgrid[0 : N[1], 0 : N[0]]
    rest = np.stack([i * OBLONG[0] / N[0], j * OBLONG[1] / N[1], 0.0 * i], axis=-1).reshape(-1, 3)
    order = np.lexsort(
        found["still"].T[:2].round(4)
    )  # by y, then x, however the mesh counts its vertices
    assert np.abs(found["still"][order] - rest).max() <= 2e-6
    moved = found["moved"][:, order].astype(float)
    rounding = (
        0.5 * float(np.spacing(np.float32(OBLONG[0])))
        + 2e-7
        + (0.5 * half_step(np.abs(expected).max()) if format_ == "exr" else 0.0)
    )
    apart = np.abs(moved[:FRAMES] - rest - expected)
    print(
        f"Blender {said['version']} {format_}: largest {apart.max():.3g} m, "
        f"allowed {rounding:.3g} m"
    )
    assert apart.max() <= rounding
    assert np.array_equal(moved[FRAMES], moved[0])
    assert said["frame_offset"] == -1
    assert said["frame_end"] == FRAMES
    assert said["fps"] == pytest.approx(FRAMES / LOOP, rel=1e-5)
    zero, east, north = np.array(said["look"])[:, :2]
    assert (east - zero)[0] > 0
    assert abs((east - zero)[1]) < 1e-6
    assert (north - zero)[1] > 0
    assert abs((north - zero)[0]) < 1e-6
    if format_ == "exr-float":
        np.save(tmp_path / "expected.npy", expected.reshape(FRAMES, N[1], N[0], 3))
        run(
            blender,
            EXAMPLE,
            "sea",
            "--expected",
            "expected.npy",
            "--save",
            "sea.blend",
            folder=tmp_path,
        )
        assert (tmp_path / "sea.blend").stat().st_size > 0
