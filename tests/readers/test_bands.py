"""The frequency bands of a file: Hs, Tm01 and Tm02 of the sea are those of the file's own sums."""

import math
from itertools import pairwise

import numpy as np
import pytest
import wavespectra  # noqa: F401  the accessor `spec`
from builders import lazy
from hypothesis import given, settings
from hypothesis import strategies as st
from spectrum_files import DATA, FREQUENCY, TO, sea, ww3

from fftocean import readers
from fftocean.errors import ReaderError
from fftocean.physics.spectra import JONSWAP
from fftocean.physics.spreading import CosinePower
from fftocean.readers import Realised, bands

xr = lazy("xarray")

LONG_CRESTED = {"direction": 0.0, "spreading": CosinePower(s=20.0)}


def moments_of(spectrum):
    """
    Return the integrals of f^n S(f), n = 0, 1, 2, [m2 Hz^n]: Simpson's rule between corners, exact
    for a cubic.
    """
    total = np.zeros(3)
    for a, b in pairwise(sorted(spectrum.breaks)):
        width = b - a
        for x, weight in ((a + 1e-9 * width, 1.0), (0.5 * (a + b), 4.0), (b - 1e-9 * width, 1.0)):
            total += width / 6.0 * weight * float(spectrum(x)) * (x / (2.0 * np.pi)) ** np.arange(3)
    return total


def require_own_sums(made, density, frequency, width):
    """Assert Hs, Tm01 and Tm02, in the order of a buoy's data sheet, against explicit sums."""
    m0, m1, m2 = (float(np.sum(density * width * frequency**n)) for n in range(3))
    got = moments_of(made.sea.systems[0].spectrum)
    close = 1e-7  # the corners are approached to 1e-9 of a step
    assert 4.0 * math.sqrt(got[0]) == pytest.approx(4.0 * math.sqrt(m0), rel=close)
    assert got[0] / got[1] == pytest.approx(m0 / m1, rel=close)
    assert math.sqrt(got[0] / got[2]) == pytest.approx(math.sqrt(m0 / m2), rel=close)
    assert (made.hs_source, made.tm01_source, made.tm02_source) == pytest.approx(
        (4.0 * math.sqrt(m0), m0 / m1, math.sqrt(m0 / m2)), rel=1e-9
    )


def half_way(f):
    """Return widths of bands half way to the neighbours, the outermost symmetric."""
    return np.concatenate([[f[1] - f[0]], 0.5 * (f[2:] - f[:-2]), [f[-1] - f[-2]]])


@pytest.mark.parametrize("station", [0, 1])
def test_a_wavewatch_file(station):
    """Without bands of its own; read here by xarray alone, in float64 from the file's float32."""
    with xr.open_dataset(DATA / "ww3file.nc", engine="scipy") as raw:
        f = raw.frequency.values.astype(float)
        density = raw.efth.values[:, station].astype(float).sum(axis=2) * np.radians(15.0)
    data = readers.open(DATA / "ww3file.nc", site=station)
    for time in range(data.sizes["time"]):
        require_own_sums(Realised.from_spectrum(data, time=time), density[time], f, half_way(f))


def test_buoys():
    """Numbers taken out of the text by splitting lines."""
    rows = [line.split() for line in (DATA / "44004w2000.txt").read_text().splitlines()]
    f = np.array([float(x) for x in rows[0][4:]])
    data = readers.open(DATA / "44004w2000.txt")
    for time, row in enumerate(rows[1:]):
        require_own_sums(
            Realised.from_spectrum(data, time=time, **LONG_CRESTED),
            np.array(row[4:], dtype=float),
            f,
            half_way(f),
        )
    newest = (
        (DATA / "41010.data_spec")
        .read_text()
        .splitlines()[1]
        .replace("(", " ")
        .replace(")", " ")
        .split()[6:]
    )
    f, density = np.array(newest[1::2], dtype=float), np.array(newest[0::2], dtype=float)
    require_own_sums(
        Realised.from_spectrum(readers.open(DATA / "41010.data_spec"), time=-1),
        density,
        f,
        half_way(f),
    )


@pytest.mark.parametrize("name", ["swanfile.spec", "wavespectra.nc"])
def test_files_against_the_wavespectra_package(name):
    """Its mean periods are sums of its own over the same bands."""
    data = readers.open(DATA / name)
    for time in range(0, data.sizes["time"], 3):
        made = Realised.from_spectrum(data, time=time)
        one = data.efth.isel(time=time)
        got = moments_of(made.sea.systems[0].spectrum)
        assert got[0] / got[1] == pytest.approx(float(one.spec.tm01()), rel=1e-6)
        assert math.sqrt(got[0] / got[2]) == pytest.approx(float(one.spec.tm02()), rel=1e-6)


# --- bands that the file states

HALVED = np.concatenate([FREQUENCY[:1], 0.5 * (FREQUENCY[1:] + FREQUENCY[:-1]), FREQUENCY[-1:]])


def young():
    """Return a wind sea with its peak near the last frequency, where half a band weighs most."""
    s = 2.0 * np.pi * JONSWAP.from_sea_state(hs=0.15, tp=2.6)(2.0 * np.pi * FREQUENCY)
    spread = np.abs(np.cos(np.radians(TO - 90.0) / 2.0)) ** 10
    return s, s[:, None] * spread / (spread.sum() * 15.0)


def stated(how, low, high):
    """Return the young sea with its bands in one of the ways of netCDF files."""
    _, density = young()
    data = ww3(sea())
    back = np.argsort(-((TO - 90.0) % 360.0))
    data["efth"] = (
        data.efth.dims,
        np.stack([density[None, :, back]] * 2) * 180.0 / np.pi,
        data.efth.attrs,
    )
    hertz = {"units": "s-1"}
    if how == "frequency1 and frequency2":
        return data.assign(
            frequency1=("frequency", low, hertz), frequency2=("frequency", high, hertz)
        )
    if how == "bounds":
        data["edges"] = (("frequency", "two"), np.stack([low, high], axis=1))
        data["frequency"].attrs["bounds"] = "edges"
        return data
    data["df"] = ("frequency", high - low, {"units": "Hz"})
    return data


@pytest.mark.parametrize("how", ["frequency1 and frequency2", "bounds"])
@pytest.mark.parametrize("descending", [False, True])
@pytest.mark.parametrize("engine", [None, "scipy", "h5netcdf"])
def test_half_bands_at_both_ends(how, descending, engine, tmp_path):
    """
    As WAVEWATCH III writes them: without, the first and last would count twice, and Hs come out 12
    % too high.
    """
    data = stated(how, HALVED[:-1], HALVED[1:])
    if descending:
        data = data.isel(frequency=slice(None, None, -1))
    if engine:
        data.to_netcdf(tmp_path / "a.nc", engine=engine)
        data = readers.open(tmp_path / "a.nc")
        assert data.freq_bnds.values == pytest.approx(
            np.stack([HALVED[:-1], HALVED[1:]], axis=1), rel=1e-12
        )
    require_own_sums(Realised.from_spectrum(data), young()[0], FREQUENCY, np.diff(HALVED))


def test_widths_of_bands():
    """`df`, a tenth of each frequency: nowhere half way to the neighbours."""
    width = 0.1 * FREQUENCY
    data = stated("df", FREQUENCY - 0.5 * width, FREQUENCY + 0.5 * width)
    for dataset in (data, readers.netcdf.to_layout(data)):
        require_own_sums(Realised.from_spectrum(dataset), young()[0], FREQUENCY, width)


def test_bands_go_with_the_dataset_through_a_file(tmp_path):
    first = readers.netcdf.to_layout(stated("bounds", HALVED[:-1], HALVED[1:]))
    first.to_netcdf(tmp_path / "own.nc", engine="h5netcdf")
    assert np.array_equal(readers.open(tmp_path / "own.nc").freq_bnds, first.freq_bnds)
    part = Realised.from_spectrum(first.isel(freq=slice(0, 28)))
    require_own_sums(part, young()[0][:28], FREQUENCY[:28], np.diff(HALVED)[:28])


def test_beside_a_missing_frequency_bands_meet_in_the_middle():
    data = readers.netcdf.to_layout(stated("bounds", HALVED[:-1], HALVED[1:]))
    data.efth[0, 12] = np.nan
    made = Realised.from_spectrum(data)
    low, high = np.delete(HALVED[:-1], 12), np.delete(HALVED[1:], 12)
    high[11] = low[12] = 0.5 * (FREQUENCY[11] + FREQUENCY[13])
    require_own_sums(made, np.delete(young()[0], 12), np.delete(FREQUENCY, 12), high - low)
    assert any("1 missing frequencies" in note for note in made.notes)


def test_the_factor_says_how_much_straight_lines_lack():
    """Bands half as wide as the steps between frequencies hold half of what straight lines do."""
    middle = 0.5 * half_way(FREQUENCY)
    low = FREQUENCY - 0.5 * middle
    made = Realised.from_spectrum(stated("bounds", low, low + middle))
    lines = (
        np.trapezoid(young()[0], FREQUENCY)
        + young()[0][0] * 0.5 * middle[0]
        + young()[0][-1] * 0.5 * middle[-1]
    )
    assert made.factor == pytest.approx(np.sum(young()[0] * middle) / lines, rel=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda e: np.put(e, 7, e.flat[7] - 0.05), "must hold its frequency"),
        (lambda e: np.put(e, 8, np.nan), "must be finite"),
        (lambda e: np.put(e, [8, 9], FREQUENCY[4]), "must have a width above 0"),
        (lambda e: np.put(e, 8, e.flat[6]), "must begin where the one below it ends"),
    ],
)
def test_bands_that_cannot_be_are_refused(change, message):
    edges = np.stack([HALVED[:-1], HALVED[1:]], axis=1)
    change(edges)
    with pytest.raises(ReaderError, match=f"variable edges.* {message}"):
        readers.netcdf.to_layout(stated("bounds", edges[:, 0], edges[:, 1]))


def test_units_of_bands_are_read():
    data = stated("frequency1 and frequency2", HALVED[:-1], HALVED[1:])
    data.frequency2.attrs["units"] = "m"
    with pytest.raises(ReaderError, match="variable frequency2 must have units Hz or s-1, got 'm'"):
        readers.netcdf.to_layout(data)


# --- straight lines


@given(
    st.lists(st.floats(0.0, 100.0), min_size=2, max_size=40),
    st.floats(1.01, 1.8),
)
@settings(max_examples=60, deadline=None)
def test_the_energy_is_exact_whatever_the_densities(density, ratio):
    """Never negative; m0 to round-off; and as much of m1 and m2 as is promised."""
    density = np.where(np.array(density) < 1e-6, 0.0, density)
    f = 0.03 * ratio ** np.arange(density.size)
    lines = bands.straight_lines(f, density, bands.between_neighbours(f))
    assert np.all(lines.density >= 0.0)
    assert lines.frequency[0] > 0.0
    a, b = lines.frequency[:-1], lines.frequency[1:]
    u, v = lines.density[:-1], lines.density[1:]
    own = [float(np.sum(density * half_way(f) * f**n)) for n in range(3)]
    got = [
        float(
            np.sum(
                (b - a) / 6.0 * (u * a**n + 4.0 * 0.5 * (u + v) * (0.5 * (a + b)) ** n + v * b**n)
            )
        )
        for n in range(3)
    ]
    for n in range(lines.matched + 1):
        assert got[n] == pytest.approx(own[n], rel=1e-9, abs=1e-12)


def test_a_single_band_is_a_triangle():
    """
    With three nodes m0 is exact, Tm01 off by a third of the difference of the steps beside it.
    """
    density = np.zeros(30)
    density[10] = 0.1
    lines = bands.straight_lines(FREQUENCY, density, bands.between_neighbours(FREQUENCY))
    assert np.array_equal(lines.density[1:-1] > 0.0, density > 0.0)
    assert np.trapezoid(lines.density, lines.frequency) == pytest.approx(
        0.1 * half_way(FREQUENCY)[10], rel=1e-12
    )
    assert lines.matched == 0
