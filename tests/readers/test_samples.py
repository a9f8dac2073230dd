"""Real files, against the wavespectra package, an independent reader of the same formats."""

import gzip

import numpy as np
import pytest
from builders import lazy
from spectrum_files import DATA

from fftocean import readers

xr = lazy("xarray")

# The oracle leaves files open and uses what pandas and xarray are about to retire; that is not ours
# to mend.
pytestmark = [
    pytest.mark.filterwarnings("ignore"),
]


@pytest.fixture(scope="module")
def wavespectra():
    import wavespectra

    return wavespectra


def require_same_sea(ours, theirs, *, direction=2e-4):
    """
    Hs, mean direction and spread, by the oracle's own integrals.

    They reckon in float32 where their file does: 1e-7 of Hs, some 1e-5 degrees of directions.
    """
    spec, want = ours.efth.spec, theirs.efth.spec
    assert spec.hs().values == pytest.approx(want.hs().values, rel=2e-7)
    turn = (spec.dm().values - want.dm().values + 180.0) % 360.0 - 180.0
    assert np.max(np.abs(turn)) < direction
    assert spec.dspr().values == pytest.approx(want.dspr().values, abs=direction)
    assert ours.time.values.tolist() == theirs.time.values.astype("datetime64[ns]").tolist()


def require_our_layout(data):
    assert data.efth.dims == ("time", "freq", "dir")
    assert np.all(np.diff(data.freq) > 0.0)
    assert np.all(np.diff(data.dir) > 0.0)
    assert data.dir.attrs["standard_name"] == "sea_surface_wave_from_direction"
    assert data.efth.attrs["units"] == "m2 s degree-1"
    assert float(data.efth.min()) >= 0.0


@pytest.mark.parametrize("site", [0, 1])
def test_wavewatch(wavespectra, site):
    ours = readers.open(DATA / "ww3file.nc", site=site)
    require_our_layout(ours)
    require_same_sea(ours, wavespectra.read_ww3(str(DATA / "ww3file.nc")).isel(site=site))
    assert ours.attrs["sites"] == 2
    raw = xr.open_dataset(DATA / "ww3file.nc", engine="scipy")
    assert ours.dpt.values == pytest.approx(raw.dpt.values[:, site])
    assert (float(ours.lon), float(ours.lat)) == (
        raw.longitude.values[0, site],
        raw.latitude.values[0, site],
    )


@pytest.mark.parametrize("site", [0, 1])
def test_the_wavespectra_layout(wavespectra, site):
    ours = readers.open(DATA / "wavespectra.nc", site=site)
    require_our_layout(ours)
    require_same_sea(
        ours, wavespectra.read_wavespectra(str(DATA / "wavespectra.nc")).isel(site=site)
    )


def test_two_files_of_one_sea_agree():
    """
    The wavespectra sample was made from the WAVEWATCH one: radians and TO against degrees and FROM,
    stored in float32.
    """
    a, b = readers.open(DATA / "ww3file.nc"), readers.open(DATA / "wavespectra.nc")
    assert a.efth.values == pytest.approx(b.efth.values, rel=3e-7)
    assert np.array_equal(a.dir, b.dir)


def test_swan(wavespectra):
    ours = readers.open(DATA / "swanfile.spec")
    require_our_layout(ours)
    require_same_sea(
        ours, wavespectra.read_swan(str(DATA / "swanfile.spec"), as_site=True).isel(site=0)
    )
    assert (float(ours.lon), float(ours.lat)) == (174.672501, -38.173599)


@pytest.mark.parametrize("bins", [36, 72])
def test_a_buoy_with_directions(wavespectra, bins):
    """
    Theirs is the cut Fourier series, ours positive: the moments are the same, and so are Hs, mean
    direction and spread.

    Where the moments could not be met (`limited_moments`) they differ a little: nowhere in these
    records.
    """
    set_of_five = [
        str(DATA / f"41010.{s}") for s in ("data_spec", "swdir", "swdir2", "swr1", "swr2")
    ]
    theirs = wavespectra.read_ndbc_ascii(set_of_five, dirs=np.arange(0.0, 360.0, 360.0 / bins))
    assert float(theirs.efth.min()) < -0.001  # what is wrong with the series
    ours = readers.open(DATA / "41010.data_spec", bins=bins)
    require_our_layout(ours)
    assert ours.attrs["limited_moments"] == 0
    require_same_sea(ours, theirs, direction=1e-3)
    assert ours.sizes == {"time": 20, "freq": 46, "dir": bins}
    # Where the buoy gives no directions it gives no energy either; both are counted.
    assert ours.attrs["undirected_densities"] == 0
    assert ours.attrs["masked_moments"] == sum(
        (DATA / f"41010.{s}").read_text().count(" 999.")
        for s in ("swdir", "swdir2", "swr1", "swr2")
    )


def test_a_buoy_without_directions(wavespectra):
    ours = readers.open(DATA / "44004w2000.txt")
    theirs = wavespectra.read_ndbc_ascii(str(DATA / "44004w2000.txt"))
    assert ours.ef.dims == ("time", "freq")
    assert "efth" not in ours
    assert ours.ef.spec.hs().values == pytest.approx(theirs.efth.spec.hs().values, rel=2e-7)
    assert ours.time.values.tolist() == theirs.time.values.astype("datetime64[ns]").tolist()


@pytest.mark.parametrize(
    "name", ["ww3file.nc", "wavespectra.nc", "swanfile.spec", "41010.data_spec", "44004w2000.txt"]
)
def test_the_name_does_not_matter(name, tmp_path):
    """Recognised by what is in it, without a suffix or with a wrong one."""
    (tmp_path / "sea.csv").write_bytes((DATA / name).read_bytes())
    got = readers.open(tmp_path / "sea.csv")
    assert got.attrs["source_format"].startswith(readers.open(DATA / name).attrs["source_format"])


@pytest.mark.parametrize(
    ("name", "reader"),
    [
        ("ww3file.nc", "read_ww3"),
        ("wavespectra.nc", "read_wavespectra"),
        ("swanfile.spec", "read_swan"),
    ],
)
def test_a_dataset_straight_from_the_package_gives_the_same_sea(wavespectra, name, reader):
    """
    Lazy arrays, its own attributes (and WAVEWATCH's left over on `dir`, which would turn the sea
    round), its site dimensions.
    """
    theirs = getattr(wavespectra, reader)(str(DATA / name))
    a = readers.sea_from_spectrum(theirs, time=2)
    b = readers.sea_from_spectrum(readers.open(DATA / name), time=2)
    omega, theta = 2.0 * np.pi * np.geomspace(0.04, 0.4, 31)[:, None], np.linspace(-3.0, 3.0, 25)
    want = b.density(omega, theta)
    assert np.max(np.abs(a.density(omega, theta) - want)) < 1e-6 * want.max()  # float32


@pytest.mark.parametrize(
    "name", ["ww3file.nc", "wavespectra.nc", "swanfile.spec", "41010.data_spec"]
)
def test_the_sea_has_the_height_and_direction_that_the_oracle_reports(name):
    data = readers.open(DATA / name)
    for time in (0, -1):
        made = readers.Realised.from_spectrum(data, time=time)
        assert made.hs_source == pytest.approx(
            float(data.efth.spec.hs(tail=False)[time]), rel=1e-12
        )
        assert made.sea.hs == pytest.approx(
            made.hs_source, rel=1e-9
        )  # quadrature of straight lines
        turn = made.sea.systems[0].direction - (270.0 - float(data.efth.spec.dm()[time]))
        assert abs((turn + 180.0) % 360.0 - 180.0) < 1e-9
        assert made.factor == pytest.approx(1.0, abs=0.01)


TEXTS = sorted(
    p.name for p in DATA.iterdir() if p.is_file() and p.suffix not in (".md", ".nc", ".gz")
)


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("name", TEXTS)
def test_a_text_file_may_begin_with_a_byte_order_mark(name, packed, tmp_path):
    """As some editors save it; packed or not."""
    for other in TEXTS:  # sets of files belong together
        marked = b"\xef\xbb\xbf" + (DATA / other).read_bytes()
        (tmp_path / other).write_bytes(gzip.compress(marked) if packed else marked)
    assert readers.open(tmp_path / name).equals(readers.open(DATA / name))
