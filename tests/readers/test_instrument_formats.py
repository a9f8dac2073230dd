"""Formats of instruments and of models' text: one sea in all of them, and real files."""

import gzip
import re
import shutil

import numpy as np
import pytest
from builders import lazy
from instrument_files import (
    EDGES,
    FROM,
    cdip,
    fourier,
    ndbc_netcdf,
    undirected,
    write_archive,
    write_datawell,
    write_octopus,
    write_spotter,
    write_swan_1d,
    write_triaxys,
    write_ww3_text,
)
from spectrum_files import DATA, FREQUENCY, TIMES, TO, sea, write_ndbc, ww3

import fftocean as fo
from fftocean import readers
from fftocean.errors import ReaderError, SeaWarning

xr = lazy("xarray")

SPECIFIED = sea(toward=100.0)  # skew against the bins


def require_moments(data, *, c2=True, rounding=1e-8, within=2e-6):
    """
    Assert E(f) to the decimals of the file, and both moments of the directions to the precision
    that they allow.
    """
    density = data.efth.values
    step = 360.0 / data.sizes["dir"]
    total = density.sum(axis=2) * step
    want = undirected(SPECIFIED)[: data.sizes["time"]]
    assert total == pytest.approx(want, rel=1e-6, abs=rounding)
    some = want > 1e-6 * want.max()  # of less than that the decimals leave few figures
    for n in (1, 2) if c2 else (1,):
        wave = np.exp(1j * n * np.radians(data.dir.values))
        got = density @ wave * step / np.where(total > 0.0, total, 1.0)
        apart = np.abs(got - fourier(SPECIFIED, n)[: data.sizes["time"]])
        assert np.max(apart[some]) < within


# --- one sea, closed: tables by direction


def test_wavewatch_text(tmp_path):
    """
    Radians TO and per radian become degrees FROM and per degree; the second point holds twice as
    much.
    """
    path = write_ww3_text(tmp_path / "station.spec", SPECIFIED, points=2)
    for site in (0, 1):
        data = readers.open(path, site=site)
        came = np.argsort(FROM)
        assert data.dir.values == pytest.approx(FROM[came], abs=1e-5)
        assert data.freq.values == pytest.approx(FREQUENCY, rel=1e-9)
        assert data.efth.values == pytest.approx(
            (site + 1) * SPECIFIED.density[:, :, came], rel=1e-8
        )
        assert data.time.values.tolist() == TIMES.tolist()
        assert data.dpt.values.tolist() == [30.0, 30.0]
        assert (float(data.lat), float(data.lon)) == (45.0, -130.0)  # they touch in the file
        assert (data.attrs["station"], data.attrs["sites"]) == (f"P{site}", 2)


def test_wavewatch_text_in_degrees_is_refused(tmp_path):
    """All directions of such a file would be turned into others."""
    path = write_ww3_text(tmp_path / "station.spec", SPECIFIED)
    title, *lines = path.read_text().splitlines()
    first, count = -(-FREQUENCY.size // 8), -(-TO.size // 7)
    assert float(lines[first].split()[0]) == pytest.approx(np.radians(TO[0]), rel=1e-8)
    degrees = [" ".join(f"{d:.3E}" for d in TO[i : i + 7]) for i in range(0, TO.size, 7)]
    path.write_text("\n".join([title, *lines[:first], *degrees, *lines[first + count :]]) + "\n")
    with pytest.raises(ReaderError, match="the directions must be in radians, got 3"):
        readers.open(path)


def test_wavewatch_text_with_three_figures_has_equal_directions(tmp_path):
    """
    As the model writes it: 0.148E+01 rad is good to 0.3 degrees, and the directions were equally
    spaced.
    """
    data = readers.open(write_ww3_text(tmp_path / "station.spec", SPECIFIED, figures=2))
    assert np.diff(data.dir.values) == pytest.approx(15.0, abs=1e-4)
    assert data.dir.values == pytest.approx(np.sort(FROM), abs=0.3)


def test_fortran_leaves_the_letter_out_of_long_exponents(tmp_path):
    path = write_ww3_text(tmp_path / "a.spec", SPECIFIED)
    text = path.read_text()
    assert " 0.000000000E+00" in text
    path.write_text(text.replace(" 0.000000000E+00", " 0.123-100"))
    assert readers.open(path).efth.values == pytest.approx(readers.open(path).efth.values)


def test_octopus(tmp_path):
    data = readers.open(write_octopus(tmp_path / "a.oct", SPECIFIED))
    came = np.argsort(FROM)
    assert data.efth.values == pytest.approx(SPECIFIED.density[:, :, came], rel=1e-4, abs=1e-9)
    assert data.freq_bnds.values == pytest.approx(
        np.stack([EDGES[:-1], EDGES[1:]], axis=1), rel=1e-8
    )
    assert data.dir.values == pytest.approx(FROM[came])
    assert (float(data.dpt[0]), float(data.lat), float(data.lon)) == (30.0, 45.0, -30.0)
    assert "height_note" not in data.attrs


def test_triaxys(tmp_path):
    data = readers.open(write_triaxys(tmp_path / "a.DIRSPEC", SPECIFIED))
    assert (data.sizes["freq"], data.sizes["dir"]) == (39, 24)
    assert data.attrs["zero_frequencies_left_out"] == 1
    assert data.freq_bnds.values[0].tolist() == pytest.approx([0.005, 0.015])
    assert (float(data.lat), float(data.lon)) == (48.5, -130.5)
    assert data.time.values[0] == np.datetime64("2020-01-01T00:00")
    flat = readers.open(write_triaxys(tmp_path / "a.NONDIRSPEC", SPECIFIED, directed=False))
    assert flat.ef.values == pytest.approx(data.efth.values.sum(axis=2) * 15.0, rel=1e-6)
    peak = float(data.dir[np.argmax(data.efth[0].sum("freq").values)])
    assert abs(peak - 280.0) <= 15.0  # FROM, of a sea toward 100 degrees


# --- one sea, by its moments


def test_spotter(tmp_path):
    data = readers.open(write_spotter(tmp_path / "spotter.csv", SPECIFIED))
    require_moments(data)
    assert (float(data.lat), float(data.lon)) == (45.0, -30.0)
    assert data.time.values.tolist() == TIMES.tolist()
    assert data.attrs["stated_hs_difference"] < 5e-4


def test_spotter_without_moments(tmp_path):
    """Direction and spread alone keep the first moment."""
    path = write_spotter(tmp_path / "spotter.csv", SPECIFIED)
    lines = [line.split(",") for line in path.read_text().splitlines()]
    kept = [i for i, name in enumerate(lines[0]) if name[:2] not in ("a1", "b1", "a2", "b2")]
    path.write_text("".join(",".join(line[i] for i in kept) + "\n" for line in lines))
    require_moments(readers.open(path), c2=False)


def test_datawell(tmp_path):
    path = write_datawell(tmp_path / "buoy}2020-01-01T00h00Z.spt", SPECIFIED)
    data = readers.open(path)
    require_moments(data)
    assert data.time.values[0] == np.datetime64("2020-01-01T00:00")
    path.rename(tmp_path / "unnamed.spt")
    assert "time" not in readers.open(tmp_path / "unnamed.spt").coords


@pytest.mark.parametrize("cartesian", [False, True])
@pytest.mark.parametrize("energy", [False, True])
def test_swan_1d(cartesian, energy, tmp_path):
    path = write_swan_1d(tmp_path / "a.sp1", SPECIFIED, cartesian=cartesian, energy=energy)
    data = readers.open(path)
    require_moments(data, c2=False)
    assert (float(data.lon), float(data.lat), data.attrs["sites"]) == (-30.0, 45.0, 2)
    assert bool(np.all(np.isnan(readers.open(path, site=1).efth)))


def test_swan_1d_without_directions_or_with_exceptions(tmp_path):
    path = write_swan_1d(tmp_path / "a.sp1", SPECIFIED)
    text = path.read_text()
    row = text.split("LOCATION     1\n")[1].splitlines()[0]
    path.write_text(text.replace(row, "  -99  -999  -9", 1))
    assert readers.open(path).attrs["masked_values"] == 1
    path.write_text(text.replace(row, " ".join([row.split()[0], "-999", "-9"]), 1))
    data = readers.open(path)
    assert np.ptp(data.efth.values[0, 0]) == 0.0  # all round, for want of a direction
    assert data.attrs["undirected_densities"] in (0, 1)  # counted where there is energy
    names, _, rest = text.partition("QUANT\n 3")
    cut = rest.split("-0.9900E+02  exception value\n")[0] + "-0.9900E+02  exception value\n"
    body = rest.split("-0.9000E+01\n")[1]
    lines = [line.split()[0] if line.startswith("  ") else line for line in body.splitlines()]
    path.write_text(names + "QUANT\n 1" + cut + "\n".join(lines) + "\n")
    assert readers.open(path).ef.values == pytest.approx(undirected(SPECIFIED), rel=1e-8)


@pytest.mark.parametrize("kind", "wdijk")
def test_ndbc_archive_given_by_any_of_its_files(kind, tmp_path):
    write_archive(tmp_path, SPECIFIED)
    data = readers.open(tmp_path / f"12345{kind}2020.txt")
    require_moments(data, rounding=6e-7)  # six decimals
    assert data.attrs["source_format"] == "NDBC historical text with directions"


@pytest.mark.parametrize("bins", [16, 90])
@pytest.mark.parametrize("form", ["archive", "realtime", "datawell", "spotter", "swan"])
def test_moments_become_as_many_directions_as_asked_for(form, bins, tmp_path):
    """Evenly round the compass, from north on; the energy does not depend on their number."""
    if form == "realtime":
        write_ndbc(tmp_path)
        path = tmp_path
    else:
        name, write = {
            "archive": ("", write_archive),
            "datawell": ("a.spt", write_datawell),
            "spotter": ("a.csv", write_spotter),
            "swan": ("a.spec1d", write_swan_1d),
        }[form]
        path = write(tmp_path / name, SPECIFIED)
    data, usual = readers.open(path, bins=bins), readers.open(path)
    assert (data.sizes["dir"], usual.sizes["dir"]) == (bins, 72)
    assert data.dir.values == pytest.approx(360.0 / bins * np.arange(bins))
    energy = [(made.efth.sum("dir") * 360.0 / made.sizes["dir"]).values for made in (data, usual)]
    assert energy[0] == pytest.approx(energy[1], rel=1e-9, abs=1e-12)


def test_ndbc_archive_given_by_its_folder_or_packed(tmp_path):
    path = write_archive(tmp_path, SPECIFIED)
    want = readers.open(path)
    assert readers.open(tmp_path).identical(want)
    for other in tmp_path.iterdir():
        other.with_name(other.name + ".gz").write_bytes(gzip.compress(other.read_bytes()))
        other.unlink()
    assert readers.open(tmp_path / "12345k2020.txt.gz").efth.equals(want.efth)
    (tmp_path / "readme").write_text("not a spectrum")
    assert readers.open(tmp_path).efth.equals(want.efth)
    for other in list(tmp_path.glob("12345*")):
        shutil.copyfile(other, tmp_path / other.name.replace("12345", "54321"))
    with pytest.raises(
        ReaderError, match=r"one NDBC buoy .* got those of 12345w2020.txt, 54321w2020.txt"
    ):
        readers.open(tmp_path)


def test_an_archive_that_is_not_in_hundredths_is_refused(tmp_path):
    """A hundredth of the coherences would spread the sea all round, and look like a sea."""
    path = write_archive(tmp_path, SPECIFIED)
    other = tmp_path / "12345j2020.txt"
    head, *rows = other.read_text().splitlines()
    rows = [
        " ".join(row.split()[:5] + [f"{float(v) / 100.0:.4f}" for v in row.split()[5:]])
        for row in rows
    ]
    other.write_text("\n".join([head, *rows]) + "\n")
    with pytest.raises(
        ReaderError, match=r"12345j2020.txt must hold r in hundredths, got none above 0.9"
    ):
        readers.open(path)


def test_missing_files_of_an_archive_set_are_named(tmp_path):
    write_archive(tmp_path, SPECIFIED)
    (tmp_path / "12345j2020.txt").unlink()
    (tmp_path / "12345i2020.txt").unlink()
    for kind in "wdk":
        with pytest.raises(ReaderError, match=r"missing: 12345i2020.txt, 12345j2020.txt"):
            readers.open(tmp_path / f"12345{kind}2020.txt")
    for kind in "dk":
        (tmp_path / f"12345{kind}2020.txt").unlink()
    assert readers.open(tmp_path / "12345w2020.txt").ef.values == pytest.approx(
        undirected(SPECIFIED), abs=1e-6
    )


@pytest.mark.parametrize("make", [ndbc_netcdf, cdip])
def test_netcdf_of_buoys(make, tmp_path):
    raw = make(SPECIFIED)
    raw.to_netcdf(tmp_path / "buoy.nc", engine="scipy")
    data = readers.open(tmp_path / "buoy.nc")
    require_moments(data)
    assert data.attrs["source_format"] in ("NDBC netCDF", "CDIP netCDF")
    assert readers.open(tmp_path / "buoy.nc", bins=36).sizes["dir"] == 36
    made = readers.Realised.from_spectrum(raw, time=1)
    assert made.hs_source == pytest.approx(
        readers.Realised.from_spectrum(data, time=1).hs_source, rel=1e-9
    )
    assert made.sea.systems[0].direction == pytest.approx(
        -10.0, abs=1e-3
    )  # toward 100 of the compass


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.drop_vars("wave_spectrum_r2"), "or none; missing: wave_spectrum_r2"),
        (lambda d: d.assign(wave_spectrum_r1=d.wave_spectrum_r1 * 100.0),
         "variable wave_spectrum_r1 must be between 0 and 1.1"),
        (lambda d: d.assign(mean_wave_dir=d.mean_wave_dir.isel(longitude=0)),
         "mean_wave_dir must have the dimensions"),
        (lambda d: d.assign(mean_wave_dir=d.mean_wave_dir.assign_attrs(units="m")),
         "mean_wave_dir must be in degrees"),
    ],
)  # fmt: skip
def test_netcdf_of_buoys_with_variables_that_do_not_fit(change, message):
    with pytest.raises(ReaderError, match=message):
        readers.netcdf.to_layout(change(ndbc_netcdf(SPECIFIED)))


def test_cdip_moments_are_checked_against_its_mean_direction():
    raw = cdip(SPECIFIED)
    turned = raw.assign(waveMeanDirection=(raw.waveMeanDirection + 180.0) % 360.0)
    with pytest.raises(ReaderError, match="waveMeanDirection must be the direction of waveA1Value"):
        readers.netcdf.to_layout(turned)


@pytest.mark.parametrize(
    ("unit", "base", "offset", "name"),
    [
        ("log10(m2 s rad-1 +1E-12)", 10.0, 1e-12, {}),
        ("lg(re 1 m2 s rad-1)", 10.0, 0.0, {}),
        ("ln(re m2 s rad-1)", np.e, 0.0, {}),
        ("m2 s rad-1", 10.0, 0.0, {"long_name": "base ten logarithm of the spectral density"}),
        ("m2 s rad-1", np.e, 0.0, {"long_name": "natural logarithm of the spectral density"}),
    ],
)
def test_wavewatch_netcdf_of_logarithms(unit, base, offset, name, tmp_path):
    """ww3_ounp's default packs log10 of the density + 1e-12 in short integers of 4e-4."""
    raw = ww3(SPECIFIED)
    want = readers.netcdf.to_layout(raw)
    floor = raw.efth.where(raw.efth > 0.0, 1e-12) if not offset else raw.efth + offset
    log = (np.log(floor) / np.log(base)).assign_attrs({**raw.efth.attrs, "units": unit, **name})
    packing = {"dtype": "int16", "scale_factor": 4e-4, "_FillValue": np.int16(-32767)}
    raw.assign(efth=log).to_netcdf(
        tmp_path / "log.nc", engine="scipy", encoding={"efth": packing} if base == 10.0 else {}
    )
    got = readers.open(tmp_path / "log.nc")
    step = 2e-4 * np.log(10.0) if base == 10.0 else 1e-9
    assert got.efth.values == pytest.approx(want.efth.values, rel=1.01 * step, abs=1e-12)


def test_a_logarithm_must_say_its_base():
    raw = ww3(SPECIFIED)
    raw.efth.attrs["long_name"] = "logarithm of the density"
    with pytest.raises(ReaderError, match="must state the base of its logarithm"):
        readers.netcdf.to_layout(raw)


# --- real files, against their own statements and an independent reader


@pytest.fixture(scope="module")
def wavespectra():
    import wavespectra

    return wavespectra


def unpacked(name, folder):
    """Return a file unpacked, because wavespectra reads some formats only so."""
    path = folder / name
    path.write_bytes(gzip.decompress((DATA / (name + ".gz")).read_bytes()))
    return path


def require_same_sea(ours, theirs, *, degrees, rel=2e-7, spread=None):
    """
    Assert Hs, mean direction and spread against the integrals of wavespectra over its own bands.
    """
    spec, want = ours.efth.spec, theirs.efth.spec
    assert spec.hs(tail=False).values.ravel() == pytest.approx(
        want.hs(tail=False).values.ravel(), rel=rel
    )
    turn = (spec.dm().values.ravel() - want.dm().values.ravel() + 180.0) % 360.0 - 180.0
    assert np.max(np.abs(turn)) < degrees
    assert spec.dspr().values.ravel() == pytest.approx(
        want.dspr().values.ravel(), abs=spread or degrees
    )


@pytest.mark.filterwarnings("ignore")
def test_octopus_of_a_model(wavespectra):
    """
    The sums in the file: fSpec is what bands hold, den that over their widths (five decimals each).

    ETot and HSig also count a tail of f^-5 beyond the last frequency: den f / 4.
    """
    ours = readers.open(DATA / "octopusfile.oct")
    require_same_sea(
        ours, wavespectra.read_octopus(str(DATA / "octopusfile.oct")), degrees=1.0, rel=2e-3
    )
    lines = [line.split(",") for line in (DATA / "octopusfile.oct").read_text().splitlines()]
    den = np.array([[float(v) for v in line[1:25]] for line in lines if line[0] == "den"])
    bulk = [line for line in lines if line[0].isdigit() and len(line[0]) == 6]
    width = np.diff(ours.freq_bnds.values, axis=1)[:, 0]
    got = ours.efth.values.sum(axis=2) * 10.0
    assert np.max(np.abs(got - den) * width) < 36 * 0.5e-5 + 1e-5  # 36 bins of five decimals
    m0 = np.sum(got * width, axis=1) + den[:, -1] * ours.freq.values[-1] / 4.0
    assert m0 == pytest.approx([float(line[5]) for line in bulk], abs=3e-4)
    assert 4.0 * np.sqrt(m0) == pytest.approx([float(line[16]) for line in bulk], rel=2e-3)
    # VMD, the direction FROM of the sums weighted with 1/f, to its decimal
    energy = ours.efth * xr.DataArray(width / ours.freq.values, dims="freq")
    mean = (energy.sum("freq") * np.exp(1j * np.radians(ours.dir))).sum("dir").values
    assert np.degrees(np.angle(mean)) % 360.0 == pytest.approx(
        [float(line[7]) for line in bulk], abs=0.1
    )


@pytest.mark.filterwarnings("ignore")
def test_spotter_of_a_buoy(wavespectra):
    """Hs and mean period of the file are the sums over its own df, to its three decimals."""
    ours = readers.open(DATA / "spotter.csv")
    theirs = wavespectra.read_spotter(str(DATA / "spotter.csv"))
    require_same_sea(ours, theirs, degrees=1e-3, spread=0.05)
    for time in range(ours.sizes["time"]):
        made = readers.Realised.from_spectrum(ours, time=time)
        assert made.hs_source == pytest.approx(float(theirs.hs[time]), abs=6e-4)
        assert made.tm01_source == pytest.approx(float(theirs.tm[time]), abs=6e-4)
    assert float(ours.lat) == pytest.approx(36.739, abs=0.01)


@pytest.mark.filterwarnings("ignore")
def test_datawell_of_a_buoy(wavespectra, tmp_path):
    """85.0 cm stands in the file; mean direction and spread of each frequency are the file's."""
    path = tmp_path / "buoy}2024-09-09T01h15Z.spt"
    shutil.copyfile(DATA / "datawell.spt", path)
    ours = readers.open(path)
    theirs = wavespectra.read_datawell(str(path), dd=None)
    assert float(ours.efth.spec.hs(tail=False)[0]) == pytest.approx(0.85, abs=0.0015)
    assert float(ours.efth.spec.hs(tail=False)[0]) == pytest.approx(
        float(theirs.efth.spec.hs(tail=False)[0]), rel=1e-9
    )
    assert ours.time.values.tolist() == theirs.time.values.astype("datetime64[ns]").tolist()
    c1 = (ours.efth[0] * np.exp(1j * np.radians(ours.dir))).sum("dir") / ours.efth[0].sum("dir")
    assert np.degrees(np.angle(c1.values)) % 360.0 == pytest.approx(
        theirs.dmf[0].values % 360.0, abs=1e-4
    )
    assert np.degrees(np.sqrt(2.0 - 2.0 * np.abs(c1.values))) == pytest.approx(
        theirs.dsprf[0].values, abs=1e-4
    )


@pytest.mark.filterwarnings("ignore")
def test_triaxys_of_a_buoy(wavespectra, tmp_path):
    """Theirs holds 360 degrees beside 0, one direction too many: 1/360 of Hs, and of the spread."""
    ours = readers.open(DATA / "triaxys.DIRSPEC.gz")
    theirs = wavespectra.read_triaxys(str(unpacked("triaxys.DIRSPEC", tmp_path)))
    require_same_sea(ours, theirs.isel(freq=slice(1, None), dir=slice(0, -1)), degrees=1e-3)
    flat = readers.open(DATA / "triaxys.NONDIRSPEC")
    want = wavespectra.read_triaxys(str(DATA / "triaxys.NONDIRSPEC"))
    assert float(flat.ef.spec.hs(tail=False)[0]) == pytest.approx(
        float(want.efth.spec.hs(tail=False)[0]), rel=1e-9
    )
    # The same hour by the buoy's two analyses: 63 frequencies against 65.
    assert float(ours.efth.spec.hs(tail=False)[0]) == pytest.approx(
        float(flat.ef.spec.hs(tail=False)[0]), rel=0.01
    )
    assert (float(ours.lat), float(ours.lon)) == pytest.approx((-48.961113, -166.528062), abs=1e-6)


@pytest.mark.filterwarnings("ignore")
def test_wavewatch_text_of_a_model(wavespectra, tmp_path):
    """Theirs takes the first rounded step, 9.74 degrees, for the width of all: 1.3 % less Hs."""
    ours = readers.open(DATA / "ww3station.spec.gz")
    theirs = wavespectra.read_ww3_station(str(unpacked("ww3station.spec", tmp_path)))
    assert np.diff(ours.dir.values) == pytest.approx(10.0, abs=1e-4)
    theirs = (
        theirs.isel(lat=0, lon=0).drop_vars(["lat", "lon", "site"], errors="ignore").sortby("dir")
    )
    assert ours.dir.values == pytest.approx(theirs.dir.values, abs=0.3)
    assert ours.efth.values == pytest.approx(theirs.efth.values.reshape(ours.efth.shape), rel=1e-12)
    assert ours.time.values.tolist() == theirs.time.values.astype("datetime64[ns]").tolist()
    assert (float(ours.lat), float(ours.lon), float(ours.dpt[0])) == (40.98, -71.12, 46.6)


@pytest.mark.filterwarnings("ignore")
def test_ndbc_archive_of_a_buoy(wavespectra, tmp_path):
    """
    Theirs takes r1 and r2 as they stand, in hundredths; given a hundredth of that, the same sea.
    """
    names = [f"41010{kind}2019.txt" for kind in "wdijk"]
    for name in names:
        lines = (DATA / name).read_text().splitlines()
        if name[5] in "jk":
            lines[1:] = [
                " ".join(line.split()[:5] + [f"{float(v) / 100.0:.2f}" for v in line.split()[5:]])
                for line in lines[1:]
            ]
        (tmp_path / name).write_text("\n".join(lines) + "\n")
    theirs = wavespectra.read_ndbc_ascii([str(tmp_path / name) for name in names])
    ours = readers.open(DATA / "41010d2019.txt", bins=36)
    require_same_sea(ours, theirs, degrees=1e-3)
    assert ours.attrs["limited_moments"] == 0


@pytest.mark.filterwarnings("ignore")
def test_ndbc_netcdf_of_a_buoy(wavespectra):
    ours = readers.open(DATA / "42098w9999.nc", bins=36)
    theirs = wavespectra.read_ndbc(str(DATA / "42098w9999.nc")).isel(lat=0, lon=0)
    measured = ~np.isnan(theirs.efth.values).any(axis=(1, 2))
    assert measured.any()
    for time in np.flatnonzero(measured):
        require_same_sea(ours.isel(time=[time]), theirs.isel(time=[time]), degrees=2e-2, spread=0.2)
    assert (float(ours.lat), float(ours.lon)) == pytest.approx((27.59, -82.931), abs=1e-3)


@pytest.mark.parametrize(
    "name",
    [
        "datawell.spt",
        "octopusfile.oct",
        "spotter.csv",
        "triaxys.DIRSPEC.gz",
        "ww3station.spec.gz",
        "41010w2019.txt",
        "42098w9999.nc",
    ],
)
def test_every_format_becomes_a_sea(name):
    data = readers.open(DATA / name)
    made = readers.Realised.from_spectrum(data, time=-1)
    assert made.sea.hs == pytest.approx(made.hs_source, rel=1e-6)


def test_a_stated_height_that_does_not_fit_is_a_warning(tmp_path):
    lines = (DATA / "datawell.spt").read_text().split("\n")
    lines[1] = "170.0"
    (tmp_path / "a.spt").write_text("\n".join(lines))
    with pytest.warns(SeaWarning, match=r"0.849 m, but the file states 1.7 m"):
        readers.open(tmp_path / "a.spt")


def test_realtime_sets_are_given_by_their_folder(tmp_path):
    first = write_ndbc(tmp_path)
    assert readers.open(tmp_path).identical(readers.open(first))


def test_units_of_depth_are_read():
    raw = ww3(SPECIFIED)
    raw.dpt.attrs["units"] = "km"
    assert readers.netcdf.to_layout(raw).dpt.values.tolist() == [30000.0, 30000.0]
    assert TO.size == 24


def test_xarray_is_what_comes_out():
    assert isinstance(readers.open(DATA / "datawell.spt"), xr.Dataset)
    assert fo.Sea.from_spectrum(readers.open(DATA / "datawell.spt")).hs == pytest.approx(
        0.849, abs=1e-3
    )


# --- the page that lists them


@pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
def test_the_page_of_formats_is_true(tmp_path, monkeypatch):
    """Every example runs, every reader has one, and the program below them too."""
    page = (DATA.parents[2] / "docs" / "readers.md").read_text()
    for path in DATA.iterdir():
        shutil.copyfile(path, tmp_path / path.name)
    write_swan_1d(tmp_path / "swanfile.sp1", SPECIFIED)
    monkeypatch.chdir(tmp_path)
    used = set()
    for call, name in re.findall(r'`(fo\.readers\.open\("([^"]+)".*?\))`', page):
        data = eval(call, {"fo": fo})
        assert isinstance(data, xr.Dataset)
        head = readers.Head.of(tmp_path / name)
        used.add(next(reader.name for reader in readers.FORMATS if reader.sniff(head)))
    assert used == {reader.name for reader in readers.FORMATS}
    program = re.findall(r"```python\n(.*?)```", page, re.DOTALL)[0]
    names = {}
    exec(program, names)
    assert names["sea"].hs > 0.5
    assert names["other"].hs > 0.5
