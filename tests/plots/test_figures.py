"""Figures that can be read, their files, and matplotlib left as it was."""

import os
import subprocess
import sys
from itertools import combinations

import matplotlib
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Annotation, Text
from plotted import CROSSED, MEASURED, found, plotted, words

import fftocean as fo
from fftocean import plots

SUBJECTS = {
    plots.plot_spectrum: "sea",
    plots.plot_directions: "sea",
    plots.plot_realised: "ocean",
    plots.plot_dispersion: "ocean",
}


def labels(figure):
    """Return the boxes of the words beside the curves [pixels]."""
    figure.draw_without_rendering()
    texts = [a for ax in figure.axes for a in ax.texts if a.get_text() and a.get_rotation() == 0.0]
    return {a.get_text(): Text.get_window_extent(a) for a in texts}


@pytest.mark.parametrize("plot", SUBJECTS, ids=lambda plot: plot.__name__)
@pytest.mark.parametrize("which", ["crossed", "measured", "given", "flat"])
def test_labels_neither_overlap_nor_leave_the_figure(plot, which, request):
    """
    No warning (they are errors); a title; units; no label outside the picture or over another.
    """
    ocean = request.getfixturevalue(which)
    if SUBJECTS[plot] == "sea" and ocean.sea is None:
        return
    figure = plotted(plot, ocean.sea if SUBJECTS[plot] == "sea" else ocean)
    boxes = labels(figure)
    width, height = figure.canvas.get_width_height()
    assert width == 1200
    for text, box in boxes.items():
        assert box.x0 >= 0, text
        assert box.x1 <= width, text
        assert box.y0 >= 0, text
        assert box.y1 <= height, text
    for axes in figure.axes:
        for label in axes.texts:
            if (
                isinstance(label, Annotation) and axes.name == "rectilinear"
            ):  # a curve's: not over the axis of periods
                assert boxes[label.get_text()].y1 <= axes.get_window_extent().y1 + 1, (
                    label.get_text()
                )
    for (a, first), (b, second) in combinations(boxes.items(), 2):
        assert not first.overlaps(second), (a, b)
    assert figure.get_suptitle()
    if which == "flat":
        assert "flat" in figure.get_suptitle()
    else:
        named = [
            ax.get_xlabel() + ax.get_ylabel()
            for ax in figure.axes
            if ax.name == "rectilinear" and ax.axison
        ]
        assert all("[" in name for name in named if name)
        assert any(named)


def test_a_sheet_has_all_four_plots(tmp_path, measured, given, flat):
    sheet = plots.plot_job(measured)
    for gid in ("sea", "density", "specified", "realised", "waves", "measured"):
        found(sheet, gid)
    assert words(plots.plot_job(flat)).count("exactly flat") == 4
    sheet = plots.plot_job(given)
    assert "given waves" in words(sheet)
    assert (
        int.from_bytes(plots.save(sheet, tmp_path / "sheet.png").read_bytes()[16:20]) == 2400
    )  # IHDR


def test_the_title_of_a_sheet_is_that_of_the_tile(given, flat):
    """Sides and samples in the order x, y; depth and loop in words."""
    title = plots.plot_job(given).get_suptitle()
    assert title.startswith("A tile of 90 × 70 m, 32 × 24 samples, 4 m deep; repeats every 25 s")
    assert plots.plot_job(flat).get_suptitle().endswith("deep water; never repeats in time")


def test_the_same_sea_gives_the_same_bytes_whatever_the_user_s_style(tmp_path):
    first = plots.save(plots.plot_spectrum(MEASURED), tmp_path / "1.png").read_bytes()
    with matplotlib.rc_context({"font.size": 25.0, "axes.facecolor": "red", "savefig.dpi": 40}):
        second = plots.save(plots.plot_spectrum(MEASURED), tmp_path / "2.png").read_bytes()
    assert first == second
    assert first.startswith(b"\x89PNG\r\n\x1a\n")
    assert int.from_bytes(first[16:20]) == 1200


@pytest.mark.parametrize(
    ("suffix", "start"),
    [(".png", b"\x89PNG"), (".svg", b"<?xml"), (".pdf", b"%PDF"), (".PNG", b"\x89PNG")],
)
def test_files_of_each_kind_are_whole_and_the_same_each_time(tmp_path, suffix, start):
    one, two = (tmp_path / f"{i}{suffix}" for i in range(2))
    for path in (one, two):
        assert plots.save(plots.plot_spectrum(fo.Sea()), path) == path
    assert one.read_bytes() == two.read_bytes()
    assert one.read_bytes().startswith(start)
    assert sorted(p.name for p in tmp_path.iterdir()) == [one.name, two.name]


def test_the_user_s_style_is_left_as_it_was(tmp_path):
    before = dict(matplotlib.rcParams)
    plots.save(plots.plot_spectrum(fo.Sea()), tmp_path / "a.png")
    assert dict(matplotlib.rcParams) == before


@pytest.mark.parametrize("name", ["a.gif", "a", "a.png.txt", ".png"])
def test_other_suffixes_are_refused(tmp_path, name):
    with pytest.raises(fo.ParameterError, match=r"must end in \.png, \.svg or \.pdf, got"):
        plots.save(plots.plot_spectrum(fo.Sea()), tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_failed_write_leaves_the_old_file(tmp_path, monkeypatch):
    figure, path = plots.plot_spectrum(fo.Sea()), tmp_path / "a.png"
    path.write_bytes(b"old")

    def full(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(fo.OutputError, match=r"a\.png could not be written: No space left"):
        plots.save(figure, path)
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.png"]
    with pytest.raises(fo.OutputError, match="could not be written"):
        plots.save(figure, tmp_path / "nowhere" / "a.png")


def test_other_types_are_refused(crossed, tmp_path):
    for plot in (plots.plot_spectrum, plots.plot_directions):
        with pytest.raises(fo.ParameterError, match="sea must be a Sea, got Ocean"):
            plot(crossed)
    for plot in (plots.plot_realised, plots.plot_dispersion, plots.plot_job):
        with pytest.raises(fo.ParameterError, match="ocean must be an Ocean, got Sea"):
            plot(CROSSED)
    with pytest.raises(fo.ParameterError, match="figure must be a matplotlib Figure, got 'sea'"):
        plots.save("sea", tmp_path / "a.png")
    assert isinstance(plots.plot_spectrum(fo.Sea()), Figure)


def test_without_matplotlib_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(
        fo.ParameterError,
        match=r"plots need matplotlib: in a checkout of fftocean, pip install '\.\[plot\]'",
    ):
        plots.plot_spectrum(CROSSED)


@pytest.mark.process
def test_no_display_no_pyplot_and_no_matplotlib_before_it_is_needed(tmp_path):
    code = f"""
import sys
import fftocean as fo
from fftocean import plots
assert not any(name.startswith("matplotlib") for name in sys.modules)
plots.save(plots.plot_spectrum(fo.Sea()), {str(tmp_path / "a.png")!r})
assert "matplotlib.pyplot" not in sys.modules
"""
    environment = {
        key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")
    }
    subprocess.run(
        [sys.executable, "-c", code],
        check=True,
        timeout=600,
        env={**environment, "MPLBACKEND": "tkagg"},
    )
    assert (tmp_path / "a.png").is_file()
