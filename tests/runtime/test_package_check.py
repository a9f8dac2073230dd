"""Check of packages: every damage is found and named with its file."""

import copy
import json
import struct

import builders_of_packages as build
import numpy as np
import pytest

import fftocean as fo
from fftocean import runtime


@pytest.fixture
def folder(tmp_path):
    """Return a folder with the package of the cascade, and textures."""
    return build.put(build.changed(["version"], 1), tmp_path)


def kinds(folder):
    """Return (kind, path) of every finding."""
    return [(finding.kind, finding.path) for finding in fo.check(folder)]


def test_a_sound_package_has_no_problems(folder):
    assert fo.check(folder) == ()


def test_any_flipped_bit_of_any_file_is_found(folder):
    for path in sorted(folder.iterdir()):
        data = path.read_bytes()
        for at in (0, len(data) // 3, len(data) - 1):
            broken = bytearray(data)
            broken[at] ^= 0x10
            path.write_bytes(broken)
            expected = "manifest" if path.name == "sea.json" else "changed"
            assert kinds(folder) == [(expected, path.name)]
            with pytest.raises(fo.IntegrityError, match=path.name):
                fo.load_sea(folder)
        path.write_bytes(data)
    assert fo.check(folder) == ()


def test_missing_cut_longer_and_swapped_files_are_named(folder):
    before = build.tree(folder)
    (folder / "tile1.waves").unlink()
    assert kinds(folder) == [("missing", "tile1.waves")]
    (folder / "tile1.waves").write_bytes(before["tile1.waves"][:-1])
    assert kinds(folder) == [("cut", "tile1.waves")]
    (folder / "tile1.waves").write_bytes(before["tile1.waves"] + b"\0")
    assert kinds(folder) == [("changed", "tile1.waves")]
    (folder / "tile1.waves").write_bytes(before["tile0.waves"])
    assert kinds(folder) == [("swapped", "tile1.waves")]


def test_every_file_that_is_not_listed_is_foreign(folder):
    names = ("tile9.waves", "tile3_h0.bin", ".x.12-ab.tmp", ".export.json", "x.bin", "index.html")
    for name in names:
        (folder / name).write_bytes(b"")
    (folder / "more").mkdir()
    assert sorted(kinds(folder)) == [
        ("extra", ".export.json"),
        ("extra", ".x.12-ab.tmp"),
        ("extra", "index.html"),
        ("extra", "more"),
        ("extra", "tile3_h0.bin"),
        ("extra", "tile9.waves"),
        ("extra", "x.bin"),
    ]
    fo.load_sea(folder)  # the listed files are unchanged, and no others are read


def test_waves_that_no_sea_has_are_found_behind_right_checksums(tmp_path):
    data = bytearray(build.packed().files["tile0.waves"])
    struct.pack_into("<f", data, 6, float("nan"))
    folder = build.put(build.with_file("tile0.waves", bytes(data)), tmp_path)
    (finding,) = fo.check(folder)
    assert finding.kind == "values"
    assert "record 0 of tile0.waves must have a finite amplitude" in finding.detail


def test_other_waves_are_found_by_the_reference(tmp_path):
    """One wave of a thousand is a hundredth too high."""
    data = bytearray(build.packed().files["tile2.waves"])
    records = np.frombuffer(bytes(data), "<i2,<i2,<u2,<f4,<f4")
    i = int(np.argmax(np.abs(records["f3"])))
    struct.pack_into("<f", data, 14 * i + 6, 1.01 * float(records["f3"][i]))
    folder = build.put(build.with_file("tile2.waves", bytes(data)), tmp_path)
    found = {finding.path: finding for finding in fo.check(folder)}
    assert set(found) == {"check.json", "tile2_h0.bin"}
    assert "of tile 2 is off by" in found["check.json"].detail


def reference(**changes):
    """Return a package whose check.json is changed in the first tile."""
    tree = json.loads(build.packed().files["check.json"])
    tree["tiles"][0].update(changes)
    return build.with_file("check.json", json.dumps(tree).encode())


@pytest.mark.parametrize(
    "package",
    [
        *(build.with_file("check.json", text) for text in (b"", b"7", b"{}", b"[" * 100_000)),
        reference(columns=[]),
        reference(columns=[1e99] * 64),
        reference(rows=[[1]] * 64),
        reference(rows=[999] * 64),
        reference(fields={}),
        reference(columns=[0] * 5000, rows=[0] * 5000),
    ],
)
def test_a_reference_of_nothing_is_found(package, tmp_path):
    assert kinds(build.put(package, tmp_path)) == [("values", "check.json")]


def test_a_nan_in_the_reference_is_found(tmp_path):
    tree = json.loads(build.packed().files["check.json"])
    tree["tiles"][1]["fields"]["height"][0][0] = float("nan")
    package = build.with_file("check.json", json.dumps(tree).encode())
    assert kinds(build.put(package, tmp_path)) == [("values", "check.json")]


def test_the_reference_is_the_direct_sum_of_the_exported_sea():
    """The sum over modes in float64, which knows neither records nor planes."""
    tree = json.loads(build.packed().files["check.json"])
    ticks = build.packed().document["ticks"]
    assert (tree["ticks"], tree["moments"][0], tree["moments"][-1]) == (ticks, 0, ticks - 1)
    assert len(tree["moments"]) == 3
    for tile, ocean in zip(tree["tiles"], build.cascade().oceans, strict=True):
        places = list(zip(tile["columns"], tile["rows"], strict=True))
        assert len(set(places)) == 64
        modes = ocean.modes()
        for i, tick in enumerate(tree["moments"]):
            for p in (0, 17, 63):
                x, y = (
                    places[p][0] * ocean.grid.lx / ocean.grid.nx,
                    places[p][1] * ocean.grid.ly / ocean.grid.ny,
                )
                t = 64.0 * tick / ticks
                height = np.sum(
                    modes.amplitude
                    * np.cos(modes.kx * x + modes.ky * y - modes.omega * t - modes.phase)
                )
                assert tile["fields"]["height"][i][p] == pytest.approx(height, rel=1e-7, abs=1e-9)


def test_the_frames_are_those_of_the_reference():
    """Fields in float32 at the points of check.json, as a page computes them."""
    tree = json.loads(build.packed().files["check.json"])
    for i, tick in enumerate(tree["moments"]):
        frames = build.cascade().loop_frame(tick, tree["ticks"])
        for tile, frame in zip(tree["tiles"], frames, strict=True):
            for name, values in tile["fields"].items():
                found = frame[name][tile["rows"], tile["columns"]]
                assert np.linalg.norm(found - values[i]) <= 5e-7 * np.linalg.norm(values[i])


def test_fewer_points_may_be_asked_for():
    package = runtime.pack(build.cascade(), reference=16)
    tree = json.loads(package.files["check.json"])
    assert [len(tile["columns"]) for tile in tree["tiles"]] == [16, 16, 16]
    small = copy.deepcopy(tree["tiles"][0])
    assert len(small["fields"]["height"][0]) == 16


def test_a_package_is_not_repaired_as_a_bake(folder):
    with pytest.raises(fo.FFTOceanError):
        fo.repair(folder)
    assert fo.check(folder) == ()
