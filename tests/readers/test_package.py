"""Datasets and arrays of the wavespectra package become seas of the height that it reports."""

import numpy as np
import pytest
from builders import lazy
from spectrum_files import DATA, sea, ww3

import fftocean as fo
from fftocean import readers
from fftocean.errors import ParameterError, ReaderError, SeaWarning
from fftocean.readers import dataset_layout

xr = lazy("xarray")

pytestmark = [pytest.mark.filterwarnings("ignore")]  # what the package warns of is its own
STRAIGHT = {"direction": 0.0, "spreading": fo.CosineSquared()}


@pytest.fixture(scope="module")
def ws():
    import wavespectra

    return wavespectra


@pytest.fixture(scope="module")
def spectra(ws):
    return ws.read_wavespectra(str(DATA / "wavespectra.nc"))


HANDED_OUT = {
    "efth itself": lambda w: w.efth,
    "rotate": lambda w: w.spec.rotate(45.0),
    "smooth": lambda w: w.spec.smooth(),
    "split": lambda w: w.spec.split(fmin=0.05, fmax=0.3),
    "interp": lambda w: w.spec.interp(freq=w.freq, dir=np.arange(0.0, 360.0, 15.0)),
    "scale_by_hs": lambda w: w.spec.scale_by_hs("2*hs"),
    "oned": lambda w: w.spec.oned(),
    "oned as efth": lambda w: w.spec.oned().to_dataset(name="efth"),
    "ptm3": lambda w: w.isel(site=0).spec.partition.ptm3(parts=2),
    "one place": lambda w: w.isel(time=3, site=1).efth,
}


@pytest.mark.parametrize("what", HANDED_OUT)
def test_arrays_and_transforms(what, spectra):
    given = HANDED_OUT[what](spectra)
    array = given.efth if isinstance(given, xr.Dataset) else given
    first = array.isel({d: 0 for d in array.dims if d not in ("freq", "dir")})
    made = readers.Realised.from_spectrum(given, **({} if "dir" in array.dims else STRAIGHT))
    assert made.hs_source == pytest.approx(float(first.spec.hs(tail=False)), rel=1e-6)  # float32
    if "dir" in array.dims:
        turn = made.sea.systems[0].direction - (270.0 - float(first.spec.dm()))
        assert abs((turn + 180.0) % 360.0 - 180.0) < 1e-3


def test_partitions_are_counted_as_places(spectra):
    """With those of one place and time the parts make up the whole, and `site` picks one."""
    one = spectra.isel(site=0, time=[2])
    parts = one.spec.partition.ptm3(parts=3)
    heights = [
        readers.Realised.from_spectrum(parts, site=i).hs_source
        for i in range(3)
        if float(parts.isel(part=i).sum()) > 0.0
    ]
    whole = readers.Realised.from_spectrum(one).hs_source
    assert np.sqrt(np.sum(np.square(heights))) == pytest.approx(whole, rel=1e-5)


def test_energies_of_bins_are_no_densities(spectra):
    with pytest.raises(ReaderError, match=r"must hold densities .* got energy in 'm2'"):
        fo.Sea.from_spectrum(spectra.spec.to_energy())


def test_left_over_attributes_give_way(ws):
    """
    `oned` keeps the unit of directions, `read_ncswan` radians on degrees, `read_wwm` prose as
    units.
    """
    bare = readers.netcdf.to_layout(ww3(sea())).drop_vars("freq_bnds", errors="ignore")
    want = readers.Realised.from_spectrum(bare).hs_source
    for axis, unit in (
        ("dir", "radians"),
        ("dir", "list of wave directions"),
        ("freq", "list of wave frequencies"),
    ):
        data = bare.assign_coords({axis: (axis, bare[axis].values, {"units": unit})})
        made = readers.Realised.from_spectrum(data)
        assert made.hs_source == pytest.approx(want, rel=1e-12)
    for unit in ("grad", "kHz"):  # a unit of another kind is no left-over
        with pytest.raises(ReaderError, match="must have units"):
            fo.Sea.from_spectrum(
                bare.assign_coords(freq=("freq", bare.freq.values, {"units": unit}))
            )
    assert ws is not None


def test_triaxys_by_the_package(ws, tmp_path):
    """From 0 Hz on, and with 360 degrees beside 0: both are left out, as our own reader does."""
    import gzip

    path = tmp_path / "triaxys.DIRSPEC"
    path.write_bytes(gzip.decompress((DATA / "triaxys.DIRSPEC.gz").read_bytes()))
    theirs = ws.read_triaxys(str(path))
    assert float(theirs.freq[0]) == 0.0
    made = readers.Realised.from_spectrum(theirs)
    ours = readers.Realised.from_spectrum(readers.open(path))
    assert made.hs_source == pytest.approx(ours.hs_source, rel=1e-9)
    flat = ws.read_triaxys(str(DATA / "triaxys.NONDIRSPEC"))
    assert readers.Realised.from_spectrum(flat, **STRAIGHT).hs_source == pytest.approx(
        3.43497, rel=1e-5
    )


def test_negative_lobes_are_refused_or_clipped_as_the_user_says(ws):
    """
    Clipped, each frequency keeps its energy: Hs is the package's own, and the sea says how much it
    took.
    """
    theirs = ws.read_ndbc_ascii(
        [str(DATA / f"41010.{s}") for s in ("data_spec", "swdir", "swdir2", "swr1", "swr2")]
    )
    assert float(theirs.efth.min()) < -0.001
    with pytest.raises(ReaderError, match=r'got -[0-9.e-]+ at .*negative="clip"'):
        fo.Sea.from_spectrum(theirs)
    with pytest.warns(
        SeaWarning,
        match=r"[0-9]+ negative densities .* were taken as 0, the energy of each frequency kept",
    ):
        made = readers.Realised.from_spectrum(theirs, negative="clip")
    assert made.hs_source == pytest.approx(
        float(theirs.isel(time=0).efth.spec.hs(tail=False)), rel=1e-9
    )
    assert any("negative densities" in note for note in made.notes)
    with pytest.warns(SeaWarning):
        assert fo.Sea.from_spectrum(theirs, negative="clip").hs == pytest.approx(made.sea.hs)
    with pytest.raises(ParameterError, match="negative must be one of refuse, clip, got 'ignore'"):
        fo.Sea.from_spectrum(theirs, negative="ignore")


def test_clipping_in_closed_form():
    """
    3 and -1 make 2 and 0, and all that is not above 0 makes nothing; without directions there is
    nothing to keep.
    """
    values = np.array([[[3.0, -1.0], [-3.0, 1.0], [np.nan, 2.0]]])
    got, notes = dataset_layout.densities("x", values, "m2/Hz/degree", negative="clip")
    assert got[0, :2].tolist() == [[2.0, 0.0], [0.0, 0.0]]
    assert got[0, 2, 1] == 2.0
    assert (notes["clipped_negatives"], notes["masked_values"]) == (2, 1)
    got, notes = dataset_layout.densities("x", np.array([[1.0, -1.0]]), "m2/Hz", negative="clip")
    assert got.tolist() == [[1.0, 0.0]]
    assert "kept" not in notes["negative_note"]
    assert (
        "negative_note"
        not in dataset_layout.densities("x", np.ones((1, 2)), "m2/Hz", negative="clip")[1]
    )


def test_zero_hertz_is_left_out_and_counted():
    data = readers.netcdf.to_layout(ww3(sea()))
    f = np.concatenate([[0.0], data.freq.values])
    values = np.concatenate([data.efth.values[:, :1], data.efth.values], axis=1)
    longer = xr.Dataset(
        {"efth": (("time", "freq", "dir"), values)}, {"freq": f, "dir": data.dir.values}
    )
    got = readers.netcdf.to_layout(longer)
    assert got.attrs["zero_frequencies_left_out"] == 1
    assert got.efth.values.tolist() == data.efth.values.tolist()
