"""`fftocean bench`, `plot` and `report`: what they hand on, and what they write."""

import io
from pathlib import Path

import pytest

from fftocean.cli import main


@pytest.fixture
def asked(monkeypatch):
    """Return the keywords with which the benchmark is called, which takes minutes."""
    calls = []
    monkeypatch.setattr("fftocean.bench.main", lambda _console, **k: calls.append(k) or 0)
    return calls


def test_a_benchmark_takes_two_minutes_and_draws_a_plot(run, asked):
    assert run("bench")[0] == 0
    assert asked == [
        {
            "seconds": 120.0,
            "sizes": None,
            "picture": Path("bench.png"),
            "json": None,
            "status": None,  # no terminal, no bar
        }
    ]


def test_flags_of_a_benchmark_are_handed_on(run, asked):
    flags = ("--seconds", "5", "--n", "64", "128", "-o", "a.svg", "--json", "a.json")
    assert run("bench", *flags)[0] == 0
    assert run("bench", *flags, "--no-plot")[0] == 0
    first, second = asked
    assert (first["seconds"], first["sizes"]) == (5.0, [64, 128])
    assert (first["picture"], first["json"]) == (Path("a.svg"), Path("a.json"))
    assert second["picture"] is None


@pytest.mark.parametrize("quiet", [False, True])
def test_a_benchmark_shows_a_bar_on_a_terminal_alone(quiet, asked, monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr("sys.stderr", Terminal())
    assert main(["bench", *(["--quiet"] if quiet else [])]) == 0
    assert (asked[0]["status"] is None) == quiet


def test_a_plot_is_the_sheet_of_a_job(run, monkeypatch):
    seen = []
    monkeypatch.setattr("fftocean.plots.plot_job", lambda ocean: seen.append(ocean) or "sheet")
    monkeypatch.setattr("fftocean.plots.save", lambda figure, path: Path(f"{path}-{figure}"))
    assert run("plot", "--n", "8", "-o", "a.png") == (0, "plot: a.png-sheet\n", "")
    assert run("plot", "--n", "8") == (0, "plot: sea.png-sheet\n", "")
    assert {ocean.grid.nx for ocean in seen} == {8}


@pytest.mark.usefixtures("fast_bakes")
def test_a_report_has_the_files_of_a_bake_and_of_nothing_else(run, monkeypatch):
    seen = []

    def write(job, path, *, folder):
        seen.append((job.settings["ocean.n"], path, folder))
        return 3 * 2**20

    monkeypatch.setattr("fftocean.report.write_report", write)
    Path("job.toml").write_text("[ocean]\nn = 8\n")
    assert run("report", "job.toml", "-o", "a.html") == (0, "report: a.html, 3 MiB\n", "")
    assert run("bake", "job.toml", "-o", "out", "--frames", "1", "--quiet")[0] == 0
    assert run("report", "out") == (0, "report: report.html, 3 MiB\n", "")
    assert seen == [(8, Path("a.html"), None), (8, Path("report.html"), Path("out"))]
