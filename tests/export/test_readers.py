"""Readers in other languages return the water that was written, in every engine's axes."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from fftocean.export.formats import assemble, encode
from fftocean.export.profiles import PROFILES, arrange

READERS = Path(__file__).resolve().parents[2] / "examples" / "readers"
FRAMES, NY, NX, LX, LY, LOOP, START = 3, 5, 8, 40.0, 20.0, 6.0, 0.5
# how each engine's two horizontal axes lie: (X, Z) of the point x east, y north of the tile's
# corner, and its units in a metre
SECOND = {
    name: -1.0
    if name in ("unreal", "godot", "bevy", "gltf", "three", "three-exr", "houdini")
    else 1.0
    for name in PROFILES
}
UNITS = {name: 100.0 if name == "unreal" else 1.0 for name in PROFILES}


def bake(folder, name):
    """Write a small sequence of heights like a bake for one engine; return the arrays as stored."""
    heights = np.random.default_rng(3).uniform(-4, 4, (FRAMES, NY, NX)).astype(np.float16)
    parts = [
        encode("bin", arrange(PROFILES[name], "height", h[..., None].astype(np.float32)))
        for h in heights
    ]
    for path, data in assemble(
        "bin",
        parts,
        stem="height",
        shape=(FRAMES, NY, NX, 1),
        profile=PROFILES[name],
        names=("height",),
        unit="m",
        size=(LX, LY),
        loop=LOOP,
        start=START,
        lookup="eulerian",
    ).items():
        (folder / path).write_bytes(data)
    return heights.astype(float)


def trilinear(heights, x, y, t):
    """Return heights between samples, one axis after the other."""
    for axis, at in enumerate(((t - START) / LOOP * FRAMES, y / LY * NY, x / LX * NX)):
        low = int(np.floor(at))
        n = heights.shape[0]
        heights = (1 - (at - low)) * heights[low % n] + (at - low) * heights[(low + 1) % n]
        assert heights.ndim == 2 - axis
    return float(heights)


REFUSED = [
    ({"schema": 2}, "schema must be 1, got 2"),
    ({"dtype": "float32"}, "dtype must be float16, little-endian, got float32"),
    ({"levels": 3}, "levels must be 1, got 3"),
    ({"lookup": "lagrangian"}, "lookup must be eulerian, got lagrangian"),
    ({"closes": False}, "closes must be true, got false"),
    ({"channels": {"R": "coverage"}}, "R must be height, got coverage"),
]
"""Sidecars that a reader of heights at places does not understand, and its words."""

POINTS = [
    (0.0, 0.0, 0.0),
    (5.0, 4.0, 2.0),
    (12.3, 7.7, 1.1),
    (39.9, 19.9, 5.9),
    (-3.0, -1.0, -0.5),
    (1234.5, 987.6, 100.3),
]


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
@pytest.mark.process
def test_javascript_finds_the_water_in_every_engines_frame(tmp_path):
    """
    One run of node over all profiles: at samples, between them, and far outside the tile; and a cut
    file is refused.
    """
    expected, questions = [], []
    for name in PROFILES:
        (tmp_path / name).mkdir()
        heights = bake(tmp_path / name, name)
        for x, y, t in POINTS:
            questions.append([name, x * UNITS[name], SECOND[name] * y * UNITS[name], t])
            expected.append(trilinear(heights, x, y, t) * UNITS[name])
    script = tmp_path / "ask.mjs"
    shutil.copy(READERS / "sea_heights.js", tmp_path / "sea_heights.mjs")
    script.write_text(
        "import { readFileSync } from 'node:fs';\n"
        "import { SeaHeights } from './sea_heights.mjs';\n"
        "const open = (name) => {\n"
        "  const json = JSON.parse(readFileSync(`${name}/height.json`)), "
        "bytes = readFileSync(`${name}/${json.file}`);\n"
        "  return [json, bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length)];\n"
        "};\n"
        f"const answers = {json.dumps(questions)}.map(([name, "
        "...at]) => new SeaHeights(...open(name)).at(...at));\n"
        "const refused = [];\n"
        "const attempt = (change, cut) => {\n"
        "  const [json, bytes] = open('godot');\n"
        "  try { new SeaHeights({ ...json, ...change }, bytes.slice(cut)); } catch (error) { "
        "refused.push(error.message); }\n"
        "};\n"
        "attempt({}, 8);\n"
        f"for (const change of {json.dumps([change for change, _ in REFUSED])}) attempt(change, "
        "0);\n"
        "console.log(JSON.stringify({ answers, refused }));\n"
    )
    run = subprocess.run(
        ["node", "ask.mjs"], cwd=tmp_path, capture_output=True, text=True, timeout=600, check=True
    )
    said = json.loads(run.stdout)
    assert len(said["answers"]) == len(expected)
    scale = np.array([UNITS[name] for name, *_ in questions])
    apart = np.abs(np.array(said["answers"]) - expected) / scale
    # centimetres are rounded to half anew: half a step at 400 is 0.125; metres are the very halves
    # that were written
    assert np.all(apart <= np.where(scale > 1, 0.00126, 1e-12))
    first, *others = said["refused"]
    assert others == [why for _, why in REFUSED]
    assert (
        first
        == f"height.bin must have {8 * FRAMES * NY * NX} bytes, got {8 * (FRAMES * NY * NX - 1)}"
    )


@pytest.mark.parametrize("file", ["SeaHeights.cs", "sea_heights.gd", "sea_heights.js"])
def test_what_a_reader_asks_of_the_sidecar_is_there(file, tmp_path):
    """
    Two of the three cannot be run here: at least every key they use is one that is written, and
    they use all that matter.
    """
    bake(tmp_path, "unity")
    sidecar = json.loads((tmp_path / "height.json").read_text())
    source = (READERS / file).read_text()
    code = "\n".join(line for line in source.splitlines() if not re.match(r"\s*(//|#)", line))
    if file.endswith(".cs"):
        asked = set(re.findall(r"\bs\.(\w+)", code))
        (declared,) = re.findall(r"struct Sidecar\s*\{(.*?)\}", code, re.DOTALL)
        assert re.search(r"struct Channels \{ public string R; \}", code)
        assert asked <= set(re.findall(r"\w+", declared))
    elif file.endswith(".gd"):
        asked = set(re.findall(r"s\[\"(\w+)\"\]", code))
        expected = re.search(r"const EXPECTED := \{(.*?)\}", code, re.DOTALL)[1]
        asked |= set(re.findall(r"\"(\w+)\":", expected))
    else:
        (unpacked,) = re.findall(r"const \{(.*?)\} = this\.s", code)
        asked = set(re.findall(r"\w+", unpacked)) | set(re.findall(r"sidecar\.(\w+)", code))
        expected = re.search(r"const expected = \{(.*?)\}", code, re.DOTALL)[1]
        asked |= set(re.findall(r"(\w+):", expected))
    placed = {"frames", "rows", "columns", "row_origin", "row_sign", "loop", "start", "size"}
    assert asked == placed | {"file", "schema", "dtype", "levels", "lookup", "closes", "channels"}
    assert asked <= sidecar.keys()
