"""
What is drawn is what is there: the artists' own data against the sea, the tile and closed forms;
and the pictures as files.
"""

import math
import os
import subprocess
import sys
from functools import cache
from itertools import combinations

import numpy as np
import pytest

import fftocean as fo
from fftocean import plots
from fftocean.statistics import ordered

matplotlib = pytest.importorskip("matplotlib")
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.text import Annotation  # noqa: E402

SWELL = fo.WaveSystem(
    spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=11.0, gamma=7.0),
    spreading=fo.CosinePower(s=40.0),
    direction=110.0,
)
WIND = fo.WaveSystem(
    spectrum=fo.TMA(fo.JONSWAP.from_wind(speed=12.0, fetch=100e3), depth=12.0), direction=-30.0
)
CROSSED = fo.Sea(WIND, SWELL, depth=12.0)
BRIEF = fo.Sea(
    SWELL,
    fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=6.0), direction=-30.0),
    depth=12.0,
)  # quick to integrate
TABLE = fo.TabulatedSpectrum(
    frequency=(0.05, 0.08, 0.1, 0.15, 0.2, 0.3), density=(0.0, 1.0, 3.0, 1.2, 0.8, 0.1)
)
MEASURED = fo.Sea(fo.WaveSystem(spectrum=TABLE, spreading=fo.CosineSquared(), direction=200.0))
WAVES = [(3, 1, 0.5, 0.2), (-3, -1, 0.3, 1.0), (0, -5, 0.2, 2.0)]


@pytest.fixture(scope="module")
def crossed():
    return fo.Ocean(BRIEF, n=64, size=600.0, seed=3, loop=60.0)


@pytest.fixture(scope="module")
def measured():
    return fo.Ocean(MEASURED, n=48, size=400.0, seed=5, amplitudes="fixed", dtype="float64")


@pytest.fixture(scope="module")
def given():
    return fo.Ocean.from_modes(
        WAVES, n=(32, 24), size=(90.0, 70.0), depth=4.0, loop=25.0, dtype="float64"
    )


@pytest.fixture(scope="module")
def flat():
    return fo.Ocean(fo.Sea(), n=16, size=50.0)


@cache
def drawn(plot, subject):
    """A picture, made once for all the tests that look at it."""
    return plot(subject)


def found(figure, gid):
    """The one artist of that name."""
    artists = [a for a in figure.findobj() if a.get_gid() == gid]
    assert len(artists) == 1, f"{gid}: {len(artists)}"
    return artists[0]


def words(figure):
    """All that is written in a figure."""
    return "\n".join(a.get_text() for a in figure.findobj(matplotlib.text.Text))


def angular(k, ocean):
    return np.sqrt(9.80665 * k * np.tanh(k * ocean.depth))


# --- the spectrum


@pytest.mark.parametrize(
    "sea", [CROSSED, BRIEF, MEASURED], ids=["TMA and JONSWAP", "two JONSWAP", "measured"]
)
def test_the_spectrum_drawn_is_the_sea_s(sea):
    figure = drawn(plots.plot_spectrum, sea)
    omega, s = found(figure, "sea").get_data()
    assert np.array_equal(s, sea(omega))
    for i, system in enumerate(sea.systems if len(sea.systems) > 1 else ()):
        x, part = found(figure, f"system {i}").get_data()
        assert np.array_equal(part, system.spectrum(x))
    (x,), (y,) = found(figure, "peak").get_data()
    assert 2 * math.pi / x == pytest.approx(sea.tp)
    assert y == sea(x) >= np.max(s)
    hs = 4 * math.sqrt(np.trapezoid(s, omega))
    assert (
        0.98 < hs / sea.hs < 1.0001
    )  # all but a little is in the picture; trapezoids over some 1500 points are good to 1e-4
    assert f"{sea.hs:#.3g}" in words(figure)


def test_where_a_spectrum_comes_from():
    """
    TMA: the deep-water spectrum; JONSWAP: the same with gamma = 1, whose m0 is alpha g^2 / (5
        omega_p^4).
    """
    figure = drawn(plots.plot_spectrum, CROSSED)
    deep, under = found(figure, "in deep water 0"), found(figure, "Pierson-Moskowitz, γ = 1 1")
    assert np.array_equal(deep.get_ydata(), WIND.spectrum.spectrum(deep.get_xdata()))
    assert deep.get_linestyle() == ":"
    omega, pm = under.get_data()
    j = SWELL.spectrum
    closed = j.alpha * 9.80665**2 * omega**-5 * np.exp(-1.25 * (j.peak / omega) ** 4)
    assert pm == pytest.approx(closed, rel=1e-12, abs=1e-300)
    # depth that no wave feels is not worth a second curve
    deep_tma = fo.Sea.from_wind(speed=5.0, fetch=3e3, depth=200.0)
    assert "in deep water" not in words(plots.plot_spectrum(deep_tma))


def test_measured_points_are_drawn_where_they_were_measured():
    points = found(drawn(plots.plot_spectrum, MEASURED), "points 0")
    assert points.get_xdata() == pytest.approx(2 * np.pi * np.array(TABLE.frequency))
    assert points.get_ydata() == pytest.approx(np.array(TABLE.density) / (2 * np.pi))


def test_many_systems_are_drawn_and_counted():
    sea = fo.Sea(
        *[
            fo.WaveSystem(
                spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=4.0 + i), direction=40.0 * i
            )
            for i in range(7)
        ]
    )
    figure = plots.plot_spectrum(sea)
    total = sum(np.interp(1.1, *found(figure, f"system {i}").get_data()) for i in range(7))
    assert total == pytest.approx(
        float(sea(1.1)), rel=1e-3
    )  # straight lines between points 0.01 apart
    assert "7 wave systems" in words(figure)


def test_a_deep_water_spectrum_does_not_dwarf_the_sea():
    sea = fo.Sea.from_wind(speed=10.0, fetch=1e5, depth=0.1)  # holds 1/100 of what deep water would
    figure = plots.plot_spectrum(sea)
    assert figure.axes[0].get_ylim()[1] < 2.5 * np.max(found(figure, "sea").get_ydata())
    assert "in deep water" in words(figure)


# --- the directions


def cells(mesh):
    """Density of a polar mesh [m^2/Hz/degree] with the sizes of its cells, and their directions."""
    corners = mesh.get_coordinates()
    theta, f = corners[0, :, 0], corners[:, 0, 1]
    density = np.asarray(mesh.get_array()).reshape(f.size - 1, theta.size - 1)
    return (
        density,
        np.diff(f)[:, None] * np.degrees(np.diff(theta))[None, :],
        0.5 * (theta[1:] + theta[:-1]),
        f[-1],
    )


@pytest.mark.parametrize(
    "spreading", [fo.Blend(), fo.CosinePower(s=1e5)], ids=["broad", "narrower than a cell"]
)
def test_the_polar_mesh_holds_the_energy_of_its_disc(spreading):
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=9.0), spreading=spreading, direction=71.3
        )
    )
    density, area, theta, rim = cells(found(plots.plot_directions(sea), "density"))
    whole = fo.moments.moment(sea.systems[0].spectrum, 0, 0.0, 2 * math.pi * rim)
    assert np.sum(density * area) == pytest.approx(
        whole, rel=2e-3
    )  # midpoints 0.15 degrees and rim/480 apart
    mean = np.sum(density * area * np.exp(1j * theta))
    assert math.degrees(np.angle(mean)) == pytest.approx(71.3, abs=0.05)
    assert whole > 0.9 * sea.variance


def test_the_compass_is_the_right_way_round():
    """
    Our angle is counter-clockwise from east: E at 0, N at 90 degrees; the arrows point there, and
    go outward.
    """
    figure = drawn(plots.plot_directions, BRIEF)
    axes = figure.axes[0]
    assert (axes.get_theta_offset(), axes.get_theta_direction()) == (0.0, 1)
    letters = {
        round(math.degrees(t)): label.get_text()
        for t, label in zip(axes.get_xticks(), axes.get_xticklabels(), strict=True)
    }
    assert {angle: letters[angle][0] for angle in (0, 90, 180, 270)} == {
        0: "E",
        90: "N",
        180: "W",
        270: "S",
    }
    arrows = [a for a in figure.findobj(Annotation) if a.get_gid() == "direction"]
    assert sorted(round(math.degrees(a.xy[0])) % 360 for a in arrows) == [110, 330]
    assert all(a.xy[1] > a.xyann[1] for a in arrows)
    for tick, label in zip(axes.get_yticks(), axes.get_yticklabels(), strict=True):
        assert float(label.get_text().removesuffix(" s")) == pytest.approx(1.0 / tick)
    assert "2 wave systems" in words(figure)


def test_a_sea_that_goes_all_round_has_no_mean_direction():
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=9.0), spreading=fo.CosinePower(s=0.0)
        )
    )
    assert ordered(sea).spread > 80.0
    assert "all round" in words(plots.plot_directions(sea))


@pytest.mark.parametrize(
    ("direction", "point"),
    [
        (0, "E"),
        (90, "N"),
        (180, "W"),
        (-90, "S"),
        (25, "ENE"),
        (-35, "SE"),
        (359.0, "E"),
        (101, "N"),
    ],
)
def test_points_of_the_compass(direction, point):
    assert plots._compass(direction) == point


# --- what was delivered


@pytest.mark.parametrize("which", ["crossed", "measured"])
def test_the_steps_are_the_energy_of_the_waves(which, request):
    ocean = request.getfixturevalue(which)
    figure = drawn(plots.plot_delivered, ocean)
    density, edges, _ = found(figure, "delivered").get_data()
    m = ocean.modes()
    energy = m.amplitude**2 / 2
    assert np.sum(density * np.diff(edges)) == pytest.approx(np.sum(energy), rel=1e-12)
    for i in range(density.size):
        inside = (m.omega >= edges[i]) & (m.omega < edges[i + 1])
        assert density[i] * (edges[i + 1] - edges[i]) == pytest.approx(
            np.sum(energy[inside]), rel=1e-9, abs=1e-12 * np.sum(energy)
        )
    omega, s = found(figure, "ordered").get_data()
    assert np.array_equal(s, ocean.sea(omega))
    if ocean.loop:  # edges half way between the loop's frequencies
        turns = edges * ocean.loop / (2 * np.pi)
        assert turns - np.floor(turns) == pytest.approx(0.5, abs=1e-9)


def test_the_shade_is_where_the_tile_has_no_waves(measured):
    """Half a cell below the longest wave, half a cell above the shortest: omega^2 = g k."""
    figure = drawn(plots.plot_delivered, measured)
    dk, reach = 2 * math.pi / 400.0, 23
    low, high = found(figure, "longer than the tile"), found(figure, "shorter than two samples")
    assert low.get_x() + low.get_width() == pytest.approx(math.sqrt(9.80665 * dk / 2))
    assert high.get_x() == pytest.approx(math.sqrt(9.80665 * dk * (reach + 0.5)))


def test_the_table_says_what_measure_says(crossed):
    figure, s = drawn(plots.plot_delivered, crossed), fo.measure(crossed)
    text = words(figure)
    assert figure.get_suptitle().startswith(
        f"Delivered: Hs {s.hs:#.3g} m of {s.ordered.hs:#.3g} m ordered, "
    )
    for value in (
        f"{s.hs:#.3g} m",
        f"{s.ordered.hs:#.3g} m",
        f"{s.tp:#.3g} s",
        f"{s.spread:.1f}°",
        f"{s.ordered.spread:.1f}°",
    ):
        assert value in text
    assert f"± {0.5 * s.sampling_error * 4 * math.sqrt(s.resolved):.2g} m" in text
    assert f"{100 * s.loop.rms:.2g} % rms" in text


def test_the_expected_scatter_is_what_seeds_do():
    """
    Each bin over 100 draws: its mean is good to a tenth of its scatter, its standard deviation to
    1/sqrt(200) = 7 %.
    """
    sea = fo.Sea(
        fo.WaveSystem(
            spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=7.0), spreading=fo.CosinePower(s=0.0)
        )
    )
    edges, _, expected, scatter = plots._delivered_spectrum(fo.Ocean(sea, n=8, size=160.0))
    draws = []
    for seed in range(100):
        m = fo.Ocean(sea, n=8, size=160.0, seed=seed).modes()
        draws.append(np.histogram(m.omega, edges, weights=m.amplitude**2 / 2)[0])
    strong = expected > 0.02 * np.sum(expected)
    assert np.count_nonzero(strong) >= 3
    assert np.all(
        np.abs(np.mean(draws, axis=0) - expected)[strong] < 0.4 * scatter[strong]
    )  # four of them
    assert np.std(draws, axis=0)[strong] == pytest.approx(scatter[strong], rel=0.28)  # four of them
    assert not np.any(
        plots._delivered_spectrum(fo.Ocean(sea, n=8, size=160.0, amplitudes="fixed"))[3]
    )


def test_a_tile_too_small_says_so():
    ocean = fo.Ocean(MEASURED, n=16, size=20.0)
    assert "cannot hold" in words(drawn(plots.plot_delivered, ocean))
    none = fo.Ocean(MEASURED, n=1, size=20.0)
    assert "cannot hold any of it" in words(plots.plot_delivered(none))
    assert "holds no wave" in words(plots.plot_dispersion(none))


# --- the dispersion relation


def test_each_cell_of_the_ring_is_its_wave(given):
    """Three given waves: a^2/2 at (kx, ky), signs and all; no other cell is filled."""
    image = found(drawn(plots.plot_dispersion, given), "waves")
    energy, (left, right, bottom, top) = image.get_array(), image.get_extent()
    ny, nx = energy.shape
    for mx, my, a, _ in WAVES:
        column = (mx * 2 * math.pi / 90.0 - left) / (right - left) * nx
        row = (my * 2 * math.pi / 70.0 - bottom) / (top - bottom) * ny
        assert (column % 1, row % 1) == (
            pytest.approx(0.5),
            pytest.approx(0.5),
        )  # in the middle of its cell
        assert energy[int(row), int(column)] == pytest.approx(a**2 / 2, rel=1e-12)
    assert energy.count() == len(WAVES)


def test_the_ring_holds_97_percent(crossed):
    energy = found(drawn(plots.plot_dispersion, crossed), "waves").get_array()
    m = crossed.modes()
    assert (
        0.97 * np.sum(m.amplitude**2 / 2) < energy.sum() <= np.sum(m.amplitude**2 / 2) * (1 + 1e-12)
    )


def test_rings_are_circles_of_one_period(given):
    figure = drawn(plots.plot_dispersion, given)
    rings = [
        a for a in figure.findobj(matplotlib.patches.Circle) if str(a.get_gid()).startswith("ring ")
    ]
    assert len(rings) >= 2
    for ring in rings:
        assert 2 * math.pi / angular(ring.radius, given) == pytest.approx(
            float(ring.get_gid().split()[1]), rel=1e-12
        )


def test_the_law_and_its_limits(given):
    axes = drawn(plots.plot_dispersion, given).axes
    law = next(ax for ax in axes if ax.get_title(loc="left") == "the law")
    line = {a.get_gid(): a for a in law.lines}
    k, omega = line["law"].get_data()
    assert omega == pytest.approx(angular(k, given), rel=1e-12)
    assert line["deep"].get_ydata() == pytest.approx(np.sqrt(9.80665 * k), rel=1e-12)
    assert line["shallow"].get_ydata() == pytest.approx(k * math.sqrt(9.80665 * 4.0), rel=1e-12)
    k, omega = line["loop"].get_data()
    turns = omega * 25.0 / (2 * np.pi)
    assert turns == pytest.approx(np.rint(turns), abs=1e-7)  # drawn to nine decimals
    assert np.all(np.abs(omega - angular(k, given)) <= np.pi / 25.0 + 1e-7)


def test_the_frames_energy_is_found_where_the_waves_are(given):
    """
    On a loop nothing leaks: each wave's a^2/2 is in its own cell of (k, omega), also of two that
    run against each other.
    """
    measured = plots._measured_dispersion(given)
    m = given.modes()
    k, energy = np.hypot(m.kx, m.ky), m.amplitude**2 / 2
    mine, _, _ = np.histogram2d(m.omega, k, bins=(measured.omega, measured.k), weights=energy)
    assert measured.energy == pytest.approx(mine, abs=1e-12 * np.sum(energy))
    assert np.sum(mine) == pytest.approx(sum(a**2 / 2 for *_, a, _ in WAVES))
    assert measured.on_curve == pytest.approx(1.0, abs=1e-12)
    assert measured.tolerance == pytest.approx(np.pi / 25.0)
    mesh = found(drawn(plots.plot_dispersion, given), "measured")
    assert np.ma.filled(mesh.get_array(), 0.0).reshape(mine.shape) == pytest.approx(
        mine, abs=1e-5 * np.max(mine)
    )


@pytest.mark.parametrize("loop", [None, 3600.0])
def test_a_sea_that_runs_free_is_seen_through_a_window(loop):
    """The Hann window keeps the energy (Parseval) and all but 1e-3 of it within two steps."""
    ocean = fo.Ocean(BRIEF, n=32, size=400.0, seed=1, loop=loop, dtype="float64")
    measured = plots._measured_dispersion(ocean)
    m = ocean.modes()
    inside = np.hypot(m.kx, m.ky) <= measured.k_max
    # waves at +k and -k share a coefficient, and the window does not quite part them: 1e-3
    assert np.sum(measured.energy) == pytest.approx(np.sum(m.amplitude[inside] ** 2) / 2, rel=2e-3)
    assert 0.998 < measured.on_curve <= 1.0
    assert measured.frames <= 256


def test_frames_that_disobey_are_found_out(monkeypatch):
    """
    The frames of deep water, under the law of 2 m: the energy is measured, not computed from the
    law.
    """
    system = fo.WaveSystem(spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=8.0), direction=20.0)
    deep, shallow = (
        fo.Ocean(fo.Sea(system, depth=depth), n=32, size=300.0, loop=80.0)
        for depth in (math.inf, 2.0)
    )
    assert plots._measured_dispersion(shallow).on_curve > 0.999
    real = fo.Ocean.loop_frame
    monkeypatch.setattr(
        fo.Ocean, "loop_frame", lambda _, *arguments, **options: real(deep, *arguments, **options)
    )
    assert plots._measured_dispersion(shallow).on_curve < 0.1


# --- the pictures

DRAWN = {
    plots.plot_spectrum: "sea",
    plots.plot_directions: "sea",
    plots.plot_delivered: "ocean",
    plots.plot_dispersion: "ocean",
}


def labels(figure):
    """What is written beside the curves, as boxes in pixels."""
    figure.draw_without_rendering()
    texts = [a for ax in figure.axes for a in ax.texts if a.get_text() and a.get_rotation() == 0.0]
    return {a.get_text(): matplotlib.text.Text.get_window_extent(a) for a in texts}


@pytest.mark.parametrize("plot", DRAWN, ids=lambda plot: plot.__name__)
@pytest.mark.parametrize("which", ["crossed", "measured", "given", "flat"])
def test_every_picture_can_be_read(plot, which, request):
    """
    No warning (they are errors); a title; units; no label outside the picture or over another.
    """
    ocean = request.getfixturevalue(which)
    if DRAWN[plot] == "sea" and ocean.sea is None:
        return
    figure = drawn(plot, ocean.sea if DRAWN[plot] == "sea" else ocean)
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


def test_the_sheet_has_all_four(tmp_path, measured, given, flat):
    sheet = plots.plot_job(measured)
    for gid in ("sea", "density", "ordered", "delivered", "waves", "measured"):
        found(sheet, gid)
    assert words(plots.plot_job(flat)).count("exactly flat") == 4
    sheet = plots.plot_job(given)
    assert "given waves" in words(sheet)
    assert (
        int.from_bytes(plots.save(sheet, tmp_path / "sheet.png").read_bytes()[16:20]) == 2400
    )  # IHDR


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


def test_what_cannot_be_drawn_is_refused(crossed, tmp_path):
    for plot in (plots.plot_spectrum, plots.plot_directions):
        with pytest.raises(fo.ParameterError, match="sea must be a Sea, got Ocean"):
            plot(crossed)
    for plot in (plots.plot_delivered, plots.plot_dispersion, plots.plot_job):
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


# --- small things


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (5.8, "5.80"),
        (0.99999, "1.00"),
        (999.6, "1000"),
        (123.4, "123"),
        (1e-7, "1e-07"),
        (0.0123, "0.0123"),
    ],
)
def test_three_digits(value, text):
    assert plots._three(value) == text


@pytest.mark.parametrize(
    ("value", "text"), [(-0.01, "0.0°"), (-35.04, "−35.0°"), (180.0, "180.0°")]
)
def test_degrees(value, text):
    assert plots._degrees(value) == text


@pytest.mark.parametrize(("low", "high"), [(0.3, 3.0), (1e-3, 2e-3), (50.0, 700.0), (0.0, 2.0)])
def test_nice_periods_are_round_in_range_and_apart(low, high):
    periods = plots._nice_periods(low, high, 0.1 * (high - low))
    omega = 2 * np.pi / np.array(periods)
    assert len(periods) >= 3
    assert np.all((omega >= low) & (omega <= high))
    assert np.all(np.diff(omega) >= 0.1 * (high - low))
    assert all(
        len(f"{period:.1e}") == len("1.5e+00") and float(f"{period:.1e}") == period
        for period in periods
    )


@pytest.mark.parametrize(
    "spreading",
    [
        fo.LongCrested(),
        fo.CosinePower(s=1e6),
        fo.CustomSpreading(
            lambda _, t, __: np.exp(-0.5 * ((t - 1.101) / 2e-3) ** 2), breaks=[1.101]
        ),
    ],
    ids=["long-crested", "1e6", "beside"],
)
def test_the_picture_of_directions_keeps_the_energy_of_narrow_seas(spreading):
    """
    Its cells add up to the integral of S, whatever the direction: midpoints in frequency, 1e-3.
    """
    spectrum = fo.JONSWAP.from_sea_state(hs=2.0, tp=8.0)
    sea = fo.Sea(fo.WaveSystem(spectrum=spectrum, spreading=spreading, direction=10.07))
    frequency, theta, density = plots._polar_spectrum(sea, 0.5)
    total = np.sum(density) * (frequency[1] - frequency[0]) * math.degrees(theta[1] - theta[0])
    assert total == pytest.approx(fo.moments.moment(spectrum, 0, 0.0, np.pi), rel=1e-3)
