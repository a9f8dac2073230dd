"""The quick benchmark in two seconds; no figure of this machine is asserted."""

import io
import re
from types import SimpleNamespace

import pytest
from rich.console import Console

from fftocean.bench import command, main, quick, quick_report
from fftocean.bench.results import Reading, Result, answer, parse, read
from fftocean.errors import OutputError, ParameterError

DIRECT = (4, 6, 12)


@pytest.fixture(scope="module")
def measured():
    said = []
    return quick.quick(
        seconds=0.0, sizes=(16, 32), direct_sizes=DIRECT, progress=lambda *what: said.append(what)
    ), said


def made(*, cross=(8.0, 10.0), two=1.7, busy=1.0):
    """
    A result as the quick version makes it, of figures that we chose: 512 is 10 times as fast as the
    textbook.
    """
    at = {"n": 512, "backend": "scipy", "dtype": "float32", "threads": 1}
    readings = [
        Reading.single("full frame", "ms", 12.0, at, clock="cpu"),
        Reading.single("height only", "ms", 4.0, at, clock="cpu"),
        Reading.single("textbook", "ms", 120.0, {"n": 512}, clock="cpu"),
        Reading.single("careful", "ms", 30.0, {"n": 512}, clock="cpu"),
        Reading.single("textbook / full frame", "x", 10.0, at, clock="cpu"),
        Reading.single("careful / full frame", "x", 2.5, at, clock="cpu"),
        Reading.single("height only / full frame", "x", 0.33, at, clock="cpu"),
        Reading.single("wall time / CPU time", "x", busy, at),
        Reading.single("eight fields, FFT", "ms", 0.1, {"n": 8}, clock="cpu"),
        Reading.single("eight fields, FFT", "ms", 0.4, {"n": 64}, clock="cpu"),
        Reading.single(
            "eight fields, direct sum", "ms", 0.08, {"n": 8, "points": 64, "waves": 48}, clock="cpu"
        ),
        Reading.single(
            "eight fields, direct sum",
            "ms",
            320.0,
            {"n": 64, "points": 4096, "waves": 3968},
            clock="cpu",
        ),
        Reading.single("direct sum / FFT", "x", 0.8, {"n": 8}, clock="cpu"),
        Reading.single("direct sum / FFT", "x", 800.0, {"n": 64}, clock="cpu"),
    ]
    if two:
        readings.append(Reading.single("full frame", "ms", 7.0, {**at, "threads": 2}, clock="wall"))
        readings.append(
            Reading.single("one thread / two", "x", two, {**at, "threads": 2}, clock="wall")
        )
    if cross:
        readings.append(Reading("crossover", "n", sum(cross) / 2, *cross, 2, "cpu", {}))
    return answer(
        "bench",
        quick.ASKS,
        readings,
        {"sizes": [512], "direct_sizes": [8, 64]},
        {"utc": "2026-01-31 12:00", "load": 0.1},
    )


def text(renderable):
    stream = io.StringIO()
    Console(file=stream, width=170).print(renderable)
    return stream.getvalue()


def test_everything_is_measured(measured):
    result, said = measured
    for n in (16, 32):
        assert result.find("full frame", n=n, threads=1, clock="cpu").count >= 3
        for what in ("textbook", "careful", "height only"):
            assert result.find(what, n=n, clock="cpu").median > 0.0
    assert [r.at["n"] for r in result.all("direct sum / FFT")] == list(DIRECT)
    assert [r.at["points"] for r in result.all("eight fields, direct sum")] == [
        n * n for n in DIRECT
    ]
    assert said[-1] == ("done", 1.0)
    shares = [share for _, share in said]
    assert shares == sorted(shares)
    assert parse(result.plain()) == result


def test_a_part_of_the_direct_sum_is_scaled_to_the_whole(monkeypatch):
    """
    Of 32 x 32 points a tenth is summed; the reading is ten times what that took, and says of how
    many points.
    """
    monkeypatch.setattr(
        quick, "DIRECT_CALL", 960 * 102.5
    )  # waves x points: enough for 102 of the 1024
    seen = []
    real = quick.race
    monkeypatch.setattr(quick, "race", lambda *a, **k: seen.append(real(*a, **k)) or seen[-1])
    readings = quick.direct(32, 0.0)
    for what in ("eight fields, direct sum", "direct sum / FFT"):
        (raw,) = (r for r in seen[0] if r.what == what)
        (scaled,) = (r for r in readings if r.what == what)
        assert scaled.median == pytest.approx(raw.median * 1024 / seen_points(readings))
    assert 0 < seen_points(readings) < 1024


def seen_points(readings):
    return next(r.at["points"] for r in readings if r.what == "eight fields, direct sum")


def test_a_direct_sum_of_some_points_is_marked():
    """Measured at all points, scaled from some of them, or extrapolated as the fourth power."""

    def result(points):
        row = Reading.single("eight fields, direct sum", "ms", 5.0, {"n": 32, "points": points})
        return SimpleNamespace(all=lambda what: [row] if what == row.what else [])

    assert quick_report.direct_sum(result(1024), 32) == (5.0, True)
    assert quick_report.direct_sum(result(102), 32) == (5.0, False)
    assert quick_report.direct_sum(result(1024), 96) == (pytest.approx(5.0 * 81.0), False)


def test_the_crossing_is_that_of_the_ratios():
    ratios = [
        Reading.single("direct sum / FFT", "x", value, {"n": n})
        for n, value in ((4, 0.25), (8, 0.5), (16, 8.0), (32, 100.0))
    ]
    cross = quick.crossing(ratios[::-1])
    assert (cross.low, cross.high) == (8.0, 16.0)
    assert cross.median == pytest.approx(
        8.0 * 2.0**0.25
    )  # a quarter of the way from log 0.5 to log 8
    assert quick.crossing(ratios[:2]) is None


@pytest.mark.parametrize(
    "wrong",
    [
        {"seconds": -1.0},
        {"seconds": float("nan")},
        {"sizes": ()},
        {"sizes": (0,)},
        {"sizes": (16.5,)},
        {"direct_sizes": (8, 4)},
        {"direct_sizes": (4,)},
    ],
)
def test_settings_out_of_range_are_refused_before_the_measurement(wrong):
    with pytest.raises(ParameterError, match="must be"):
        quick.quick(**{"seconds": 0.0, "sizes": (8,), "direct_sizes": (4, 6), **wrong})


def test_sentences_have_the_figures_of_the_readings():
    said = " ".join(quick_report.sentences(made()))
    assert "A frame of 512 x 512 takes 12.0 ms here on one thread, 83.3 a second" in said
    assert "10.0 times as fast as NumPy as in textbooks, and 2.5 times as fast" in said
    assert "The height alone costs 33 %" in said
    assert "Two threads make it 1.70 times as fast." in said
    assert "64 x 64 takes 320 ms: 800 times as long as by FFT" in said
    assert "The FFT is faster from n = 10 on" in said
    assert "busy" not in said
    assert (
        quick_report.title(made())
        == "A frame of 512 x 512 takes 12.0 ms here: 10.0 times as fast as the textbook"
    )


def test_sentences_cover_a_busy_machine_one_core_and_no_crossing():
    said = " ".join(quick_report.sentences(made(cross=None, two=None, busy=1.8)))
    assert "Two threads" not in said.split("busy")[0]
    assert "Up to n = 64 the direct sum is never slower." in said
    assert "a second of work took 1.8 s" in said
    assert "at every n tried" in " ".join(quick_report.sentences(made(cross=(8.0, 8.0))))


def test_the_table_holds_the_figures():
    page = text(quick_report.table(made()))
    (row,) = (line for line in page.splitlines() if line.startswith("512 x 512"))
    for cell in (
        "12.0 ms",
        "83.3",
        "7.06 ms",
        "0.59 x",
        "4.00 ms",
        "30.0 ms",
        "2.5 x",
        "120 ms",
        "10.0 x",
    ):
        assert cell in row
    assert "~ 21.8 min" in row  # 0.32 s times (512 / 64)^4 = 1311 s: extrapolated, and marked so
    assert "one core only" in text(quick_report.table(made(two=None)))


def test_the_table_of_a_real_result_is_whole(measured):
    page = text(quick_report.table(measured[0]))
    assert re.search(r"^16 x 16 .*\n32 x 32 ", page, re.MULTILINE)
    assert "nan" not in page


def test_a_chart_is_drawn(measured, tmp_path):
    path = tmp_path / "bench.png"
    quick_report.draw(measured[0], path)
    assert path.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    quick_report.draw(made(two=None, cross=None), path)


def test_a_chart_has_its_figures_as_text(tmp_path):
    path = tmp_path / "bench.svg"
    quick_report.draw(made(), path)
    import xml.etree.ElementTree as ET

    comments = path.read_text()
    assert ET.fromstring(comments).tag.endswith("svg")
    for words in (
        "12.0 ms",
        "10.0 times as long",
        "they cross",
        "60 frames a second",
        "one frame [ms]",
        "times the first bar",
    ):
        assert words in comments, (
            words
        )  # matplotlib writes each text into a comment beside its glyphs


def run(monkeypatch, **how):
    """Run the command with made-up readings."""
    monkeypatch.setattr(quick, "quick", lambda **_: made())
    stream = io.StringIO()
    code = main(Console(file=stream, width=170), **how)
    return code, stream.getvalue()


def test_the_command_prints_a_table_and_writes_its_files(monkeypatch, tmp_path):
    picture, json = tmp_path / "b.png", tmp_path / "b.json"
    code, page = run(monkeypatch, picture=picture, json=json, status=Console(file=io.StringIO()))
    assert code == 0
    assert "512 x 512" in page
    assert f"plot: {picture}" in page
    assert f"all readings: {json}" in page
    assert isinstance(read(json), Result)
    assert picture.stat().st_size > 10_000


def test_without_matplotlib_the_command_prints_a_line_and_goes_on(monkeypatch, tmp_path):
    import sys

    monkeypatch.setitem(sys.modules, "matplotlib", None)
    code, page = run(monkeypatch, picture=tmp_path / "b.png")
    assert code == 0
    assert "no plot: plots need matplotlib" in page
    assert not (tmp_path / "b.png").exists()


def test_an_unknown_suffix_is_refused_before_the_measurement(monkeypatch):
    monkeypatch.setattr(quick, "quick", lambda **_: pytest.fail("it measured"))
    with pytest.raises(ParameterError, match=r"must end in \.png, \.svg, \.pdf, got 'b\.doc'"):
        main(Console(file=io.StringIO()), picture=command.PICTURE.with_name("b.doc"))


def test_a_file_that_cannot_be_written_is_an_error(monkeypatch, tmp_path):
    with pytest.raises(OutputError, match="could not be written"):
        run(monkeypatch, picture=None, json=tmp_path / "nowhere" / "b.json")
    with pytest.raises(OutputError, match="could not be written"):
        run(monkeypatch, picture=tmp_path / "nowhere" / "b.png")


def test_the_command_passes_its_arguments_on(monkeypatch):
    asked = {}
    monkeypatch.setattr(quick, "quick", lambda **how: asked.update(how) or made())
    main(Console(file=io.StringIO()), seconds=7.0, sizes=(8, 16), picture=None)
    assert (asked["seconds"], asked["sizes"]) == (7.0, (8, 16))
    main(Console(file=io.StringIO()), picture=None)
    assert (asked["seconds"], asked["sizes"]) == (120.0, quick.SIZES)


@pytest.mark.parametrize(
    ("milliseconds", "said"),
    [
        (0.0885, "88.5 µs"),
        (0.9999, "1.00 ms"),
        (4.14, "4.14 ms"),
        (12.04, "12.0 ms"),
        (640.0, "640 ms"),
        (13_700.0, "13.7 s"),
        (219_000.0, "3.65 min"),
    ],
)
def test_durations_have_a_suitable_unit(milliseconds, said):
    from fftocean.bench.charts import duration

    assert duration(milliseconds) == said


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (0.0, "0"),
        (0.5, "0.5"),
        (20.0, "20"),
        (3000.0, "3,000"),
        (1e-9, "1e-09"),
        (52945.3, "52,945"),
    ],
)
def test_numbers_have_no_needless_exponent(value, said):
    from fftocean.bench.charts import plain

    assert plain(value) == said
