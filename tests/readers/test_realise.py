"""A measured spectrum as a `Sea`."""

import math
from itertools import pairwise

import numpy as np
import pytest
from builders import lazy
from spectrum_files import DATA, FREQUENCY, TIMES, TO, era5, sea, write_ndbc, ww3

from fftocean import readers
from fftocean.errors import ParameterError, ReaderError, SeaWarning
from fftocean.physics import moments
from fftocean.physics.spectra import JONSWAP
from fftocean.physics.spreading import CosinePower
from fftocean.readers import Realised, sea_from_spectrum

xr = lazy("xarray")


def dataset_of(density, *, frequency=FREQUENCY, toward=TO, **coords):
    """Return the layout of the wavespectra package, without any attributes."""
    return xr.Dataset(
        {"efth": (("freq", "dir"), density)},
        {"freq": frequency, "dir": (toward + 180.0) % 360.0, **coords},
    )


def test_at_the_points_it_is_the_source():
    """
    S D [m^2 s/rad^2] = efth [m^2/Hz/degree] (180/pi)/(2 pi), but for a smooth factor of frequency
    alone.

    It makes up for straight lines being wider than bands: (df/f)^2/6, 0.2 % of m2, where bands are
    10 % wide; most of it in the tail.
    """
    specified = sea(toward=200.0)
    made = Realised.from_spectrum(ww3(specified), time=0)
    got = made.sea.density(2.0 * np.pi * FREQUENCY[:, None], np.radians(90.0 - TO))
    want = specified.density[0] * (180.0 / np.pi) / (2.0 * np.pi)
    some = want.sum(axis=1) > 1e-6 * want.max()
    factor = got.sum(axis=1)[some] / want.sum(axis=1)[some]
    assert factor == pytest.approx(np.ones(factor.size), abs=0.03)
    assert got[some] == pytest.approx(
        want[some] * factor[:, None], rel=1e-9, abs=1e-12 * want.max()
    )  # angles are turned there and back


def test_its_variance_is_the_sum_over_the_bands_of_the_source():
    """
    Sum of E df dtheta, df half way to the neighbours and symmetric at the ends, dtheta 15 degrees.
    """
    specified = sea()
    made = Realised.from_spectrum(ww3(specified), time=1)
    f = FREQUENCY
    df = np.concatenate([[f[1] - f[0]], 0.5 * (f[2:] - f[:-2]), [f[-1] - f[-2]]])
    want = 4.0 * math.sqrt(np.sum(specified.density[1] * df[:, None]) * 15.0)
    assert made.hs_source == pytest.approx(want, rel=1e-12)
    assert made.sea.hs == pytest.approx(want, rel=1e-9)
    # Over frequency and direction, by another rule: the trapezoid on eight panels to every straight
    # line (1/64 of a bend of 1 %).
    omega = (
        2.0
        * np.pi
        * np.concatenate([np.linspace(a, b, 8, endpoint=False) for a, b in pairwise(f)] + [f[-1:]])
    )
    theta = np.linspace(-np.pi, np.pi, 24 * 8 + 1)
    density = made.sea.density(omega[:, None], theta)
    over_theta = np.sum(0.5 * (density[:, 1:] + density[:, :-1]), axis=1) * (theta[1] - theta[0])
    m0 = np.sum(0.5 * (over_theta[1:] + over_theta[:-1]) * np.diff(omega))
    assert 4.0 * math.sqrt(m0) == pytest.approx(want, rel=2e-4)


def test_a_known_sea_comes_back():
    """
    JONSWAP, Hs = 2 m, measured in fine bands: Hs but for what lies above 0.6 Hz, 0.2 %; Tp to a
    band.
    """
    spectrum = JONSWAP.from_sea_state(hs=2.0, tp=9.0)
    f = np.arange(0.03, 0.6, 0.002)
    dirs = np.arange(0.0, 360.0, 5.0)
    spread = CosinePower(s=10.0)(1.0, np.radians(90.0 - dirs) - np.radians(20.0), 1.0)
    density = spectrum(2.0 * np.pi * f)[:, None] * spread * (2.0 * np.pi) * (np.pi / 180.0)
    made = sea_from_spectrum(dataset_of(density, frequency=f, toward=dirs))
    assert made.hs == pytest.approx(2.0, rel=2e-3)
    assert made.tp == pytest.approx(9.0, abs=0.2)
    assert made.systems[0].direction == pytest.approx(20.0, abs=1e-6)


def test_a_masked_frequency_is_bridged_and_a_masked_bin_is_empty():
    specified = sea().density[0].copy()
    specified[12] = np.nan
    specified[14, 3] = np.nan
    made = Realised.from_spectrum(dataset_of(specified))
    f = np.delete(FREQUENCY, 12)
    rest = np.nan_to_num(np.delete(specified, 12, axis=0)).sum(axis=1) * 15.0
    assert made.hs_source == pytest.approx(
        4.0 * math.sqrt(np.sum(rest * np.gradient(f))), rel=1e-12
    )
    ends = [float(made.sea(2.0 * np.pi * FREQUENCY[i])) for i in (11, 13)]
    between = np.interp(FREQUENCY[12], FREQUENCY[[11, 13]], ends)
    assert made.sea(2.0 * np.pi * FREQUENCY[12]) == pytest.approx(between, rel=1e-9)
    assert [note for note in made.notes if "missing" in note] == [
        "1 missing bins of frequency and direction were taken as empty",
        "1 missing frequencies were bridged, or left out at the ends",
    ]


def test_a_sector_is_closed_with_nothing():
    """
    SWAN may compute a quarter of the circle: nothing comes from the rest, least of all a straight
    line right round it.
    """
    quarter = np.arange(50.0, 140.0, 10.0)
    f = np.array([0.05, 0.1, 0.15])
    density = np.tile([0.5, 1.0, 2.0, 3.0, 4.0, 3.0, 2.0, 1.0, 0.5], (3, 1))
    made = Realised.from_spectrum(dataset_of(density, frequency=f, toward=quarter))
    assert made.hs_source == pytest.approx(4.0 * math.sqrt(17.0 * 10.0 * 0.15), rel=1e-12)
    got = made.sea.density(2.0 * np.pi * 0.1, np.radians(np.arange(0.0, 360.0, 5.0)))
    toward = (90.0 - np.arange(0.0, 360.0, 5.0)) % 360.0
    assert np.all(
        got[(toward < 39.9) | (toward > 140.1)] < 1e-12
    )  # the angles are turned and turned back, in round-off
    assert np.all(got[(toward > 41.0) & (toward < 139.0)] > 0.0)


def test_an_empty_spectrum_is_a_flat_sea_and_says_so():
    with pytest.warns(SeaWarning, match="holds no energy: the sea is exactly flat"):
        made = Realised.from_spectrum(dataset_of(np.zeros((30, 24))))
    assert made.sea.systems == ()
    assert (made.hs_source, made.factor) == (0.0, 1.0)


def test_a_spectrum_that_is_missing_is_refused_not_flat():
    """ERA5 over land: no values at all. The grid's other point is the sea."""
    with pytest.raises(ReaderError, match=r"at least 2 frequencies that are not missing \(land"):
        sea_from_spectrum(era5(sea()), site=0)
    assert sea_from_spectrum(era5(sea()), site=1).hs > 1.0


def test_a_spectrum_without_directions_asks_for_them():
    data = readers.open(DATA / "44004w2000.txt")
    for given in ({}, {"direction": 30.0}, {"spreading": CosinePower(s=8.0)}):
        with pytest.raises(ParameterError, match=r"needs direction .* and spreading"):
            sea_from_spectrum(data, **given)
    made = sea_from_spectrum(data, time=1, direction=30.0, spreading=CosinePower(s=8.0))
    assert made.hs == pytest.approx(4.0 * math.sqrt(float(np.sum(data.ef[1] * 0.01))), rel=1e-9)
    assert made.systems[0].direction == 30.0
    assert made.systems[0].spreading == CosinePower(s=8.0)
    with pytest.raises(
        ParameterError, match=r"must be given without others, got direction=30\.0, spreading=None"
    ):
        sea_from_spectrum(dataset_of(sea().density[0]), direction=30.0)


def test_one_direction_only_is_none_as_the_wavespectra_package_has_it():
    """The package reads a buoy without directions as efth with dir = [0], in m2/Hz."""
    total = sea().density[0].sum(axis=1) * 15.0
    data = xr.Dataset(
        {"efth": (("freq", "dir"), total[:, None])}, {"freq": FREQUENCY, "dir": [0.0]}
    )
    with pytest.raises(ParameterError, match="needs direction"):
        sea_from_spectrum(data)
    assert sea_from_spectrum(data, direction=0.0, spreading=CosinePower(s=8.0)).hs == pytest.approx(
        sea_from_spectrum(ww3(sea())).hs
    )


def test_depth_is_that_of_the_dataset_unless_it_is_said():
    assert sea_from_spectrum(ww3(sea())).depth == 30.0
    assert sea_from_spectrum(ww3(sea()), depth=math.inf).depth == math.inf
    assert sea_from_spectrum(era5(sea()), site=1).depth == math.inf
    with pytest.raises(ParameterError, match="depth must be"):
        sea_from_spectrum(ww3(sea()), depth=-3.0)


def test_times_and_places_are_picked():
    """The second time is specified with twice the energy."""
    one, two = (sea_from_spectrum(ww3(sea()), time=t).variance for t in (0, 1))
    assert two == pytest.approx(2.0 * one, rel=1e-9)
    assert sea_from_spectrum(ww3(sea()), time=-1).variance == two
    assert (
        sea_from_spectrum(ww3(sea()).sel(time=TIMES[1])).variance == two
    )  # a caller's own choice, by name
    assert sea_from_spectrum(ww3(sea()).isel(time=1, station=0)).variance == two
    for which, message in (
        ({"time": 2}, "time must be a whole number between -2 and 1, got 2"),
        ({"site": 1}, "site must be .* got 1"),
    ):
        with pytest.raises(ParameterError, match=message):
            sea_from_spectrum(ww3(sea()), **which)


@pytest.mark.parametrize("left", [{"globwave_name": "direction"}, {"axis": "Z"}])
def test_attributes_left_over_from_wavewatch_do_not_turn_the_sea_round(left):
    """
    The wavespectra package turns directions and leaves WAVEWATCH's attributes on them: FROM all the
    same, with a warning.
    """
    data = dataset_of(sea(toward=70.0).density[0])
    want = sea_from_spectrum(data).systems[0].direction
    assert want == pytest.approx(20.0, abs=0.5)
    data.efth.attrs["units"] = "m2 s degree-1"
    data.dir.attrs.update({"standard_name": "sea_surface_wave_to_direction"} | left)
    with pytest.warns(SeaWarning, match="the attribute is left over"):
        assert sea_from_spectrum(data).systems[0].direction == want
    # Per radian it has not been through that package's hands: then the attribute is right.
    data.efth.attrs["units"] = "m2 s rad-1"
    assert abs(sea_from_spectrum(data).systems[0].direction - want) == pytest.approx(180.0)


def test_an_explicit_direction_is_believed_and_said():
    """
    In a layout whose documents say FROM, a file that says TO, and its unit, and that no package
    left it behind.
    """
    data = dataset_of(sea(toward=70.0).density[0])
    want = sea_from_spectrum(data).systems[0].direction
    data.efth.attrs["units"] = "m2 s degree-1"
    data.dir.attrs["standard_name"] = "sea_surface_wave_to_direction"
    with pytest.warns(SeaWarning, match="go to there, and so it is taken"):
        made = Realised.from_spectrum(data)
    assert abs(made.sea.systems[0].direction - want) == pytest.approx(180.0)
    assert any("go to there, and so it is taken" in note for note in made.notes)
    data.dir.attrs["standard_name"] = "sea_surface_wave_from_direction"
    assert sea_from_spectrum(data).systems[0].direction == want


def test_what_attributes_do_not_say_is_noted():
    """Nothing is said in a dataset made by hand; all is in what WAVEWATCH writes."""
    (note,) = (
        n for n in Realised.from_spectrum(dataset_of(sea().density[0])).notes if "assumed" in n
    )
    for word in (
        "densities per degree",
        "frequencies in Hz",
        "directions in degrees",
        "directions from which waves come",
    ):
        assert word in note
    assert not any("assumed" in n for n in Realised.from_spectrum(ww3(sea())).notes)
    by_number = Realised.from_spectrum(era5(sea()), site=1).notes
    assert any("directions to which waves go" in n for n in by_number)
    assert any("almost nothing" in n for n in by_number)


def test_what_a_reader_masked_or_repaired_is_still_said_of_the_sea(tmp_path):
    path = write_ndbc(tmp_path, r1=1.05)
    made = Realised.from_spectrum(readers.open(path))
    limited = readers.open(path).attrs["limited_moments"]
    assert limited > 0
    assert f"{limited} pairs of directional moments that no sea can have were limited" in made.notes
    assert "no depth is known: the water is taken as deep" in made.notes
    assert "the depth is the measurement's own, 30 m" in Realised.from_spectrum(ww3(sea())).notes
    assert not any("depth" in note for note in Realised.from_spectrum(ww3(sea()), depth=20.0).notes)


def test_half_a_circle_is_closed_with_nothing_and_said():
    half = np.arange(0.0, 190.0, 10.0)
    density = np.tile(np.sin(np.radians(half)) + 1e-3, (3, 1))
    made = Realised.from_spectrum(
        dataset_of(density, frequency=np.array([0.05, 0.1, 0.15]), toward=half)
    )
    assert "directions leave out 160 degrees of the circle: nothing comes from there" in made.notes


def test_frequencies_that_may_be_in_radians_are_doubted():
    """
    0.22 to 3.5, as rad/s under the name of Hz; a buoy's do not reach so far, nor does a tank's
    begin so low as a buoy's.
    """
    data = dataset_of(1e-3 * sea().density[0], frequency=2.0 * np.pi * FREQUENCY)
    with pytest.warns(
        SeaWarning,
        match=r"frequencies go from 0\.217 to 3\.44 Hz, which is rare at sea: are they in rad/s\?",
    ):
        made = Realised.from_spectrum(data)
    assert any("rad/s" in note for note in made.notes)


def test_a_buoys_sea_has_its_spread(tmp_path):
    """
    r1 = 0.9 at every frequency: spread sqrt(2 (1 - r1)); straight lines between bins x apart make
    r1 less by (sin(x/2)/(x/2))^2.
    """
    made = sea_from_spectrum(readers.open(write_ndbc(tmp_path, source=200.0, r1=0.9, r2=0.65)))
    theta = np.linspace(-np.pi, np.pi, 7200, endpoint=False)
    direction, spread = moments.mean_direction_and_spread(
        made.density(2.0 * np.pi * 0.1, theta), theta
    )
    assert direction == pytest.approx(70.0, abs=1e-3)
    x = np.radians(5.0)
    assert spread == pytest.approx(
        np.degrees(math.sqrt(2.0 * (1.0 - 0.9 * (2.0 * math.sin(x / 2.0) / x) ** 2))), rel=1e-4
    )


def test_a_height_that_no_sea_has_is_refused():
    with pytest.raises(
        ReaderError,
        match=r"significant wave height must be between 0 and 100 m, got .* \(in other units",
    ):
        sea_from_spectrum(dataset_of(1e4 * sea().density[0]))


@pytest.mark.parametrize(
    ("what", "message"),
    [
        (None, "must be an xarray.Dataset or DataArray, got NoneType"),
        (xr.DataArray([1.0]), "must have a frequency dimension"),
        (xr.Dataset({"hs": ((), 1.0)}), "must hold one wave spectrum .* got hs"),
        (xr.Dataset({"efth": (("x", "dir"), np.ones((3, 4)))}), "must have a frequency dimension"),
        (
            xr.Dataset({"efth": (("freq", "dir"), np.ones((3, 4)))}),
            "dimension freq must have a coordinate",
        ),
    ],
)
def test_what_is_no_spectrum_is_refused(what, message):
    with pytest.raises(ReaderError, match=message):
        sea_from_spectrum(what)


# A tail beyond the last frequency


def sounded(tail=None):
    """Return a sea realised from a one-dimensional JONSWAP spectrum, cut at 0.3 Hz, and S there."""
    spectrum = JONSWAP.from_sea_state(hs=2.0, tp=6.0)
    f = np.arange(0.05, 0.3001, 0.01)
    dataset = xr.Dataset({"ef": ("freq", 2.0 * np.pi * spectrum(2.0 * np.pi * f))}, {"freq": f})
    made = Realised.from_spectrum(
        dataset, direction=0.0, spreading=CosinePower(s=5.0), depth=math.inf, tail=tail
    )
    return made, spectrum


@pytest.mark.parametrize("n", [4.0, 5.0, 7.5])
def test_a_tail_adds_its_closed_integral(n):
    """
    S f/(n - 1) beyond f, less the upper half of the last band, 0.005 Hz of S; the integral of any
    band beyond f, and the whole by quadrature.
    """
    (cut, _), (tailed, _) = sounded(), sounded(n)
    one = tailed.sea.systems[0].spectrum
    last = 0.3
    level = float(one(2.0 * np.pi * last)) * 2.0 * np.pi
    added = level * last / (n - 1.0) - 0.005 * level
    assert tailed.tail_variance == pytest.approx(added, rel=1e-9)
    assert tailed.sea.variance == pytest.approx(cut.sea.variance + added, rel=1e-9)
    assert tailed.hs_source == cut.hs_source
    band = moments.moment(one, 0, 2.0 * np.pi * 0.4, 2.0 * np.pi * 0.9)
    exact = level * last**n / (n - 1.0) * (0.4 ** (1.0 - n) - 0.9 ** (1.0 - n))
    assert band == pytest.approx(exact, rel=1e-9)
    assert float(one(2.0 * np.pi * (last + 1e-9))) == pytest.approx(level / (2.0 * np.pi), rel=1e-7)
    inside = 2.0 * np.pi * np.linspace(0.05, 0.3, 77)
    assert np.array_equal(one(inside), cut.sea.systems[0].spectrum(inside))


def test_a_tail_gives_back_the_energy_that_the_instrument_cut():
    """At 0.3 Hz, 1.8 peaks, a JONSWAP is 11 % below f^-5 (exp(-1.25/1.8^4)), and here loses 5 %."""
    made, spectrum = sounded(5.0)
    whole, cut = moments.moment(spectrum, 0), sounded()[0].sea.variance
    assert made.sea.variance == pytest.approx(whole, rel=1e-2)
    assert cut < 0.94 * whole
    (note,) = (note for note in made.notes if "tail" in note)
    assert "a tail f^-5 beyond 0.3 Hz adds" in note
    with_tail, without = (4.0 * math.sqrt(m0) for m0 in (made.sea.variance, cut))
    assert f"(Hs {with_tail:.4g} m in place of {without:.4g} m)" in note
    assert f"variance, {100.0 * (made.sea.variance / cut - 1.0):.2g} %" in note


def test_without_a_tail_nothing_is_added():
    made, _ = sounded()
    assert made.tail_variance == 0.0
    assert not any("tail" in note for note in made.notes)
    assert made.sea.systems[0].spectrum(2.0 * np.pi * 0.5) == 0.0


@pytest.mark.parametrize("tail", [1.0, -5.0, math.inf, "5", True])
def test_a_tail_of_impossible_exponent_is_refused(tail):
    with pytest.raises(ParameterError, match="tail must be"):
        sounded(tail)


def test_a_tail_goes_where_the_last_frequency_goes():
    """The directions beyond are those of the last frequency."""
    specified = sea(toward=200.0)
    made = Realised.from_spectrum(ww3(specified), time=0, tail=5)
    theta = np.linspace(-np.pi, np.pi, 49)
    last = 2.0 * np.pi * FREQUENCY[-1]
    there, beyond = (made.sea.density(x * last, theta) for x in (1.0, 2.0))
    assert beyond == pytest.approx(there / 32.0, rel=1e-9)
