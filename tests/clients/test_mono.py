"""
The C# reader, compiled and run by mono, beside a stand-in for the few names of Unity that it uses.
"""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from heights import heights_bake, questions

pytestmark = pytest.mark.client

HERE = Path(__file__).resolve().parent
READER = HERE.parents[1] / "examples" / "readers" / "SeaHeights.cs"


def test_the_c_sharp_reader_finds_the_water_and_refuses_what_it_does_not_understand(mono, tmp_path):
    """
    At samples, between them, far outside the tile and the loop; and a sidecar of another lookup is
    refused.
    """
    said, heights = heights_bake("unity", tmp_path / "sea")
    points, expected, tolerance = questions(said, heights)
    (tmp_path / "points").write_text("".join(f"{x!r} {z!r} {t!r}\n" for x, z, t in points.tolist()))
    compiler, runtime = mono
    sources = [READER, HERE / "unity" / "UnityEngine.cs", HERE / "unity" / "Ask.cs"]
    for command in (
        [compiler, "-out:ask.exe", *map(str, sources)],
        [runtime, "ask.exe", "sea/height.json", "points"],
    ):
        done = subprocess.run(
            command,
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=300,
            stdin=subprocess.DEVNULL,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr
    found = np.array(done.stdout.split(), dtype=float)
    assert found.shape == expected.shape
    print(f"mono: largest {np.abs(found - expected).max():.3g} m, allowed {tolerance:.3g} m")
    assert np.abs(found - expected).max() <= tolerance
    assert np.ptp(expected) > 100 * tolerance
    sidecar = json.loads((tmp_path / "sea" / "height.json").read_text())
    (tmp_path / "sea" / "other.json").write_text(json.dumps({**sidecar, "lookup": "lagrangian"}))
    done = subprocess.run(
        [runtime, "ask.exe", "sea/other.json", "points"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
        check=True,
    )
    assert done.stdout == "refused: lookup must be eulerian, got lagrangian\n"
