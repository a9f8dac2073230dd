"""The benchmark of robots: it answers, and the table of docs/robots.md is that of its results."""

import importlib
import sys
from pathlib import Path

import pytest

from fftocean.bench.results import read

ROOT = Path(__file__).resolve().parents[2]
PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture
def robots(monkeypatch):
    """Import the script as Python does when it is run; forget it afterwards."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    before = set(sys.modules)
    yield importlib.import_module("robots")
    for name in {"robots", "script"} & (set(sys.modules) - before):
        del sys.modules[name]


@pytest.mark.process
def test_it_answers_for_each_sea_and_number_of_points(robots, tmp_path):
    files = tmp_path / "robots.json", tmp_path / "robots.png"
    flags = ["--n", "8", "16", "--points", "1", "3", "--tiles", "1", "2", "--seconds", "0"]
    assert robots.main([*flags, "--json", str(files[0]), "--plot", str(files[1])]) == 0
    result = read(files[0])
    assert files[1].read_bytes()[:8] == PNG
    for mode in ("bicubic", "bilinear"):
        found = {(r.at["tiles"], r.at["n"], r.at["points"]) for r in result.all(mode)}
        assert len(found) == 8
    assert {r.at["points"] for r in result.all("exact")} == {3}
    table = robots.markdown(result).splitlines()
    assert table[0].startswith("| tiles | samples a side | 1 point | 3 points | all waves at 3 ")
    assert len(table) == 2 + 4


def test_the_page_has_the_table_of_the_results(robots):
    page = (ROOT / "docs" / "robots.md").read_text(encoding="utf-8")
    table = page.partition("<!-- robots -->\n")[2].partition("<!-- /robots -->")[0]
    assert table == robots.markdown(read(ROOT / "benchmarks" / "results" / "robots.json"))
