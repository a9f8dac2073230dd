"""Results as files: they are read back as written, and other files are refused."""

import copy
import json

import numpy as np
import pytest

from fftocean.bench.results import BUSY, Entry, Pair, Reading, Result, answer, parse, race, read
from fftocean.bench.timing import Summary
from fftocean.errors import ReaderError


def result():
    readings = [
        Reading("full frame", "ms", 2.0, 1.5, 3.0, 7, "cpu", {"n": 64, "backend": "scipy"}),
        Reading("full frame", "ms", 9.0, 8.0, 9.5, 7, "cpu", {"n": 128, "backend": "scipy"}),
        Reading(
            "full frame",
            "ms",
            5.0,
            4.0,
            6.0,
            5,
            "wall",
            {"n": 128, "backend": "scipy", "threads": 2},
        ),
        Reading.single("peak", "MiB", 12.5, {}),
    ]
    return answer(
        "frame",
        "What does a frame cost?",
        readings,
        {"seconds": 1.0, "n": [64, 128]},
        {"utc": "2026-01-31 12:00", "load": 0.5},
    )


def test_results_are_read_back_as_written(tmp_path):
    path = tmp_path / "frame.json"
    one = result()
    one.write(path)
    assert read(path) == one
    assert read(path).plain() == json.loads(path.read_text())
    assert path.read_text().endswith("}\n")


def test_a_reading_is_found_by_its_conditions():
    one = result()
    assert one.find("full frame", n=64).median == 2.0
    assert one.find("full frame", n=128, clock="wall").median == 5.0
    assert [r.at["n"] for r in one.all("full frame", clock="cpu")] == [64, 128]
    assert one.all("full frame", n=256) == []
    with pytest.raises(LookupError, match="holds 2 readings of 'full frame'"):
        one.find("full frame", n=128)
    with pytest.raises(LookupError, match="holds 0 readings of 'nothing'"):
        one.find("nothing")


def test_a_reading_of_a_summary_is_in_its_unit():
    r = Reading.of("x", "ms", Summary(0.002, 0.001, 0.004, 5), {"n": 4}, scale=1e3, clock="cpu")
    assert (r.low, r.median, r.high, r.count) == (1.0, 2.0, 4.0, 5)
    twice = r.scaled(2.0)
    assert (twice.low, twice.median, twice.high, twice.count, twice.at) == (
        2.0,
        4.0,
        8.0,
        5,
        {"n": 4},
    )


@pytest.mark.parametrize(
    "change",
    [
        {"median": 0.5},  # below the lower quartile
        {"high": float("inf")},
        {"low": float("nan")},
        {"count": 0},
        {"unit": "parsec"},
        {"clock": "sundial"},
    ],
)
def test_an_impossible_reading_is_refused(change):
    values = {
        "what": "x",
        "unit": "ms",
        "median": 2.0,
        "low": 1.0,
        "high": 3.0,
        "count": 1,
        "clock": "cpu",
        **change,
    }
    with pytest.raises(ReaderError, match="x: "):
        Reading(**values)


@pytest.mark.parametrize(
    ("where", "value"),
    [
        (["schema"], 2),
        (["question"], None),
        (["machine"], []),
        (["readings"], {}),
        (["readings", 0, "median"], "2.0"),
        (["readings", 0, "median"], True),
        (["readings", 0, "quartiles"], [1.0]),
        (["readings", 0, "quartiles"], [3.0, 4.0]),
        (["readings", 0, "count"], 2.5),
        (["readings", 0, "unit"], "furlong"),
        (["readings", 0, "n"], [64]),
        (["readings", 0], "a reading"),
        (["surplus"], 1),
    ],
)
def test_an_altered_file_is_refused(where, value):
    tree = copy.deepcopy(result().plain())
    part = tree
    for key in where[:-1]:
        part = part[key]
    part[where[-1]] = value
    with pytest.raises(ReaderError, match=r"bent\.json"):
        parse(tree, "bent.json")


@pytest.mark.parametrize(
    "key", ["schema", "question", "asks", "machine", "before", "after", "settings", "readings"]
)
def test_a_missing_part_is_named(key):
    tree = result().plain()
    del tree[key]
    with pytest.raises(ReaderError, match=key):
        parse(tree)


@pytest.mark.parametrize("text", ["", "[", "[]", "null", '{"schema": 1}'])
def test_other_files_are_refused(tmp_path, text):
    path = tmp_path / "x.json"
    path.write_text(text)
    with pytest.raises(ReaderError, match=r"x\.json"):
        read(path)


def test_a_race_has_times_ratios_and_the_load():
    """
    Two contenders that are one and the same: their ratio is taken between the right two, under the
    right conditions.
    """
    runs = []
    slow = Entry("slow", lambda: runs.append("slow"), {"n": 8})
    fast = Entry("fast", lambda: runs.append("fast"), {"n": 8, "backend": "scipy"})
    readings = race([slow, fast], [Pair("slow / fast", slow, fast)], clock="cpu", seconds=0.0)
    assert [(r.what, r.unit) for r in readings] == [
        ("slow", "ms"),
        ("fast", "ms"),
        ("slow / fast", "x"),
        (BUSY, "x"),
    ]
    assert readings[2].at == fast.at
    assert (
        readings[3].median > 0.9
    )  # the wall cannot be faster than one thread's processor but for their ticks
    assert set(runs) == {"slow", "fast"}
    assert [r.what for r in race([slow], clock="wall", seconds=0.0)] == ["slow"]


def test_the_ratio_of_a_race_is_slow_over_fast(monkeypatch):
    from fftocean.bench import results
    from fftocean.bench.timing import Rounds

    made = Rounds(
        {"0": np.array([6.0, 8.0, 10.0]), "1": np.array([2.0, 2.0, 2.0])},
        {"0": np.ones(3), "1": np.ones(3)},
    )
    monkeypatch.setattr(results, "alternate", lambda *_, **__: made)
    slow, fast = Entry("slow", int, {}), Entry("fast", int, {})
    times = race([slow, fast], [Pair("slow / fast", slow, fast)], clock="cpu", seconds=1.0)
    assert [r.median for r in times[:3]] == [8000.0, 2000.0, 4.0]
    assert (times[2].low, times[2].high) == (3.5, 4.5)


def test_a_result_is_frozen():
    with pytest.raises(AttributeError):
        result().question = "memory"
    assert isinstance(result(), Result)
