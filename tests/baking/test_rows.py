"""Rows of many frames: packed, written and read row by row, the same bytes and values as a list."""

import dataclasses
import itertools
import json
import os
import random
import threading
import tracemalloc

import builders
import pytest

import fftocean as fo
from fftocean.baking import bake as baker
from fftocean.baking.bake import bake_packed
from fftocean.baking.finished.manifest import read_manifest
from fftocean.baking.folder import rows as rows_module
from fftocean.baking.folder.plan import Task, tasks_of
from fftocean.baking.folder.rows import BLOCK, PackedRows, RowList
from fftocean.baking.folder.sealed import CHECK, read_sealed, sealed, write_sealed
from fftocean.baking.workers import local
from fftocean.errors import IntegrityError
from fftocean.files import as_json
from fftocean.statistics import SeaState

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")


def row(j):
    """A row of a manifest in its form; its checksum and numbers are incompressible."""
    chance = random.Random(j)
    return {
        "frame": j,
        "t": 0.1 * j,
        "extremes": {"min_jacobian": chance.random(), "largest_choppiness": None, "folded": 0.0},
        "files": {
            "height": {
                "path": f"height/{j:04d}.exr",
                "sha256": f"{chance.getrandbits(256):064x}",
                "range": [[-chance.random(), chance.random()]],
            }
        },
    }


def test_rows_are_those_that_were_put(monkeypatch):
    """In any order, over each other, and from more blocks than are held unpacked."""
    monkeypatch.setattr(rows_module, "OPEN", 2)
    places = [*range(0, 5 * BLOCK, 3), *range(7, 400 * BLOCK, 23 * BLOCK)]
    random.Random(3).shuffle(places)
    packed, plain = PackedRows(), {}
    for place in [*places, *places[::5]]:
        value = row(place + 10_000 * (place in plain))
        packed.put(place, value)
        plain[place] = value
    assert len(packed) == len(plain)
    assert dict(packed) == plain
    assert list(packed) == sorted(plain)
    assert all((place in packed) == (place in plain) for place in range(-1, 401 * BLOCK))
    with pytest.raises(KeyError):
        packed[1]


def test_a_list_of_rows_is_a_sequence():
    rows = [row(j) for j in range(2 * BLOCK + 3)]
    packed = RowList(PackedRows.of(iter(rows)))
    assert packed == rows
    assert packed == RowList(PackedRows.of(rows))
    assert packed != rows[:-1]
    assert packed != [*rows[:-1], row(0)]
    assert (packed[-1], packed[5:8]) == (rows[-1], rows[5:8])
    assert list(reversed(packed)) == rows[::-1]
    with pytest.raises(IndexError):
        packed[len(rows)]


def test_threads_share_rows(monkeypatch):
    monkeypatch.setattr(rows_module, "OPEN", 1)
    rows = [row(j) for j in range(4 * BLOCK)]
    packed, wrong = RowList(PackedRows.of(rows)), []

    def read(seed):
        chance = random.Random(seed)
        for _ in range(300):
            j = chance.randrange(len(rows))
            if packed[j] != rows[j]:
                wrong.append(j)

    threads = [threading.Thread(target=read, args=(seed,)) for seed in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


TREES = [
    {"tool": "t", "job": {"frames": [{"x": 1}]}, "frames": None, "last": [1, {}]},
    {"frames": None},
    {"a": "é\u2028", "empty": {}, "frames": None},
]


@pytest.mark.parametrize("count", [0, 1, BLOCK + 1])
@pytest.mark.parametrize("tree", TREES, ids=["within", "alone", "last"])
def test_a_sealed_file_has_the_same_bytes_row_by_row(tmp_path, tree, count):
    rows = [
        {**row(j), "text": "\n  ]\n    },", "none": [], "of": {"frames": []}} for j in range(count)
    ]
    plain = {**tree, "frames": rows}
    expected = as_json(sealed(plain))
    for value in (rows, RowList(PackedRows.of(rows))):
        written = write_sealed(tmp_path / "file", {**tree, "frames": value})
        assert (tmp_path / "file").read_bytes() == expected
        assert written[CHECK] == json.loads(expected)[CHECK]
    read = read_sealed(tmp_path / "file")
    assert list(read) == list(plain)
    assert read == plain
    assert isinstance(read["frames"], RowList) == (count > 0)


def test_no_changed_byte_of_a_sealed_file_passes(tmp_path):
    """A flipped bit of any byte, a cut at any place, a line more, less, or in another's place."""
    path = tmp_path / "file"
    tree = {"tool": "t", "frames": [{"frame": 0, "t": 1.5}, {"frame": 1, "t": 2.5}], "z": [1]}
    data = as_json(sealed(tree))
    lines = data.splitlines(keepends=True)
    swapped = [[*lines[:i], lines[i + 1], lines[i], *lines[i + 2 :]] for i in range(len(lines) - 1)]
    damaged = itertools.chain(
        (
            data[:i] + bytes([data[i] ^ 1 << bit]) + data[i + 1 :]
            for i in range(len(data))
            for bit in (0, 5)
        ),
        (data[:i] for i in range(len(data))),
        (b"".join([*lines[:i], *lines[i + 1 :]]) for i in range(len(lines))),
        (b"".join([*lines[:i], lines[i], *lines[i:]]) for i in range(len(lines))),
        (b"".join(some) for some in swapped if some != lines),
        [data + b"\n", b"", json.dumps(sealed(tree)).encode()],
    )
    for other in damaged:
        path.write_bytes(other)
        with pytest.raises(IntegrityError, match=r"changed|cut"):
            read_sealed(path)
    path.write_bytes(data)
    assert read_sealed(path) == tree


def test_tasks_of_a_range_are_ranges():
    """So the numbers of a loop's frames take no memory."""
    assert tasks_of("frame", range(3, 20, 2), 8) == [
        Task("frame", range(3, 8, 2)),
        Task("frame", range(9, 16, 2)),
        Task("frame", range(17, 20, 2)),
    ]
    assert tasks_of("frame", [0, 1, 9], 8) == [Task("frame", (0, 1)), Task("frame", (9,))]
    assert tasks_of("frame", range(0), 8) == []


def traced(action):
    """Return the most bytes that an action held at a time, and what it returned."""
    tracemalloc.start()
    try:
        found = action()
        return tracemalloc.get_traced_memory()[1], found
    finally:
        tracemalloc.stop()


def test_frames_cost_a_bake_little_memory(tmp_path, monkeypatch):
    """
    Bake, resumption, check: a frame more takes 300 bytes at most, of which 110 are the packed row
    and as many again the earlier run's; as plain data a row takes 1,500.
    """
    monkeypatch.setattr(rows_module, "OPEN", 1)
    monkeypatch.setattr(os, "fsync", lambda _: None)
    # Encoders hold 350 kB each: how many are at work at a time is chance.
    monkeypatch.setattr(local, "cores", lambda: 1)
    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    specified = SeaState(m0=0.1, hs=1.26, tp=5.0, mean_direction=0.0, spread=30.0)
    monkeypatch.setattr(baker, "measure", lambda _: dataclasses.replace(still, specified=specified))
    job = builders.job({"ocean.n": 4, "bake.maps": ["height"], "bake.pictures": []})
    most = {}
    for count in (BLOCK, 2 * BLOCK, 10 * BLOCK):  # what is imported comes with the first
        folder, many = tmp_path / str(count), job.replaced({"bake.frames": count})
        bake = lambda: bake_packed(many, folder, executor="serial")  # noqa: B023, E731
        first, manifest = traced(bake)
        again, same = traced(bake)
        check, found = traced(lambda: fo.check(folder))  # noqa: B023
        assert found == ()
        assert manifest == same == {**read_manifest(folder), CHECK: manifest[CHECK]}
        most[count] = first, again, check
    for less, more in zip(most[2 * BLOCK], most[10 * BLOCK], strict=True):
        assert (more - less) / (8 * BLOCK) < 300.0


def test_a_public_manifest_is_plain_data(tmp_path):
    job = builders.job({"ocean.n": 8, "bake.maps": ["height"], "bake.pictures": []}, bake__frames=4)
    manifest = fo.bake(job, tmp_path / "out", executor="serial")
    text = (tmp_path / "out" / "manifest.json").read_text(encoding="utf-8")
    assert json.dumps(manifest) == json.dumps(json.loads(text))
    assert json.dumps(fo.load(tmp_path / "out").manifest["frames"]) == json.dumps(
        manifest["frames"]
    )
