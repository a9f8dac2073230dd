"""Errors for damaged, impossible and contradictory files."""

import gzip
import os
import re
import sys
import time
import tracemalloc
from pathlib import Path

import h5netcdf
import numpy as np
import pytest
from builders import lazy
from spectrum_files import (
    DATA,
    FREQUENCY,
    TO,
    era5,
    sea,
    write_ndbc,
    write_swan,
    write_wavespectra,
    ww3,
)

from fftocean import readers
from fftocean.errors import ParameterError, ReaderError
from fftocean.readers import bounded_reads

xr = lazy("xarray")

# --- what is no file of spectra at all


def test_no_file_there(tmp_path):
    with pytest.raises(ReaderError, match=r"must be a file that exists, got .*none\.nc"):
        readers.open(tmp_path / "none.nc")


def test_a_directory(tmp_path):
    with pytest.raises(ReaderError, match="a directory"):
        readers.open(tmp_path)


@pytest.mark.parametrize("device", ["/dev/zero", "/dev/null"])
def test_a_device(device):
    with pytest.raises(ReaderError, match="a device"):
        readers.open(device)


def test_a_pipe(tmp_path):
    """Opening it would wait for ever."""
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(ReaderError, match="must be a regular file"):
        readers.open(tmp_path / "pipe")


@pytest.mark.parametrize("path", [3, None, 2.5, ["a.nc"]])
def test_not_even_a_name(path):
    with pytest.raises(ReaderError, match="must be the name of a file"):
        readers.open(path)


@pytest.mark.parametrize("path", ["", "a\0b", "x" * 5000])
def test_impossible_names(path):
    with pytest.raises(ReaderError, match=r"must be a (regular )?file|cannot be read"):
        readers.open(path)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is empty"),
        (b"\n", "must be wave spectra in a known format"),
        (b"hello\n", "must be wave spectra in a known format .*, got 'hello'"),
        (b"hello", "must be wave spectra in a known format .*, got 'hello'"),
        (bytes(range(256)) * 8, "UTF-8|must be wave"),
        (b"#YY  MM DD hh mm Sep_Freq < spec_1 >\n2020 01 01 00 00 9.999 1.0 \xff\xfe\n",
         "line 2 must be UTF-8 text, got the byte 0xff"),
        (b"SWAN   1\n$ caf\xe9\n", "line 2 must be UTF-8"),
        (b"\x1f\x8b\x08\x00rubbish", "cannot be read"),
        (gzip.compress(b"SWAN   1\n" * 1000)[:40], "cannot be read"),
        (gzip.compress(b""), "must be wave spectra in a known format"),
        (b"CDF\x05" + bytes(100), "must be netCDF 3 .* or 4, got CDF version 5"),
        (b"CDF\x01" + bytes(100), "cannot be read as netCDF|must hold one wave spectrum"),
        (b"\x89HDF\r\n\x1a\n" + bytes(100), "cannot be read as netCDF"),
    ],
)  # fmt: skip
def test_rubbish(data, message, tmp_path):
    (tmp_path / "rubbish").write_bytes(data)
    with pytest.raises(ReaderError, match=message) as caught:
        readers.open(tmp_path / "rubbish")
    assert "rubbish" in str(caught.value)


def require_cheap_refusal(path, message):
    """Assert that a file is refused within 2 s of this process and 16 MiB."""
    tracemalloc.start()
    start = time.process_time()
    with pytest.raises(ReaderError, match=message):
        readers.open(path)
    assert time.process_time() - start < 2.0
    assert tracemalloc.get_traced_memory()[1] < 16 * 2**20
    tracemalloc.stop()


@pytest.mark.parametrize(
    "head", [b"", b"SWAN   1 ", b"#YY  MM DD hh mm Sep_Freq  < spec_1", b"YYYY MM DD hh "]
)
def test_a_line_of_300_megabytes(head, tmp_path):
    with (tmp_path / "long").open("wb") as file:
        file.write(head)
        file.truncate(300 * 2**20)  # a hole: read as zeros
    require_cheap_refusal(tmp_path / "long", "line 1 must be at most 1048576 bytes long")


@pytest.mark.parametrize("head", [b"", b"SWAN   1 ", b"YYYY MM DD hh "])
def test_a_packed_line_of_300_megabytes(head, tmp_path):
    """300 MB of zeros in 300 kB of gzip, member after member."""
    (tmp_path / "bomb.gz").write_bytes(gzip.compress(head) + gzip.compress(bytes(2**20)) * 300)
    require_cheap_refusal(tmp_path / "bomb.gz", "line 1 must be at most 1048576 bytes long")


def test_a_bomb_of_short_lines(tmp_path):
    """Line breaks only: refused at the second, not counted to the end."""
    (tmp_path / "bomb.gz").write_bytes(
        gzip.compress(b"SWAN   1\n") + gzip.compress(b"\n" * 2**20) * 300
    )
    require_cheap_refusal(tmp_path / "bomb.gz", "line 2 is empty")


@pytest.mark.parametrize("name", ["ww3file.nc", "wavespectra.nc", "swanfile.spec"])
def test_no_more_is_unpacked_than_the_limit(name, tmp_path, monkeypatch):
    (tmp_path / "a.gz").write_bytes(gzip.compress((DATA / name).read_bytes()))
    assert "efth" in readers.open(tmp_path / "a.gz")
    monkeypatch.setattr(bounded_reads, "MAX_BYTES", 20_000)
    with pytest.raises(ReaderError, match=r"a\.gz.* at most 0 MiB"):
        readers.open(tmp_path / "a.gz")


@pytest.mark.parametrize("size", [10**8, 10**12])
def test_hdf5_that_declares_more_than_there_is(size, tmp_path):
    """
    A file of some kB with an axis of 10^8 entries, none of them written: xarray would read them all
    for its index.
    """
    with h5netcdf.File(tmp_path / "huge.nc", "w") as file:
        file.dimensions = {"freq": size, "dir": 24}
        file.create_variable("freq", ("freq",), "f8", chunks=(1000,))
        file.create_variable("efth", ("freq", "dir"), "f4", chunks=(1000, 24))
    assert (tmp_path / "huge.nc").stat().st_size < 10**5
    require_cheap_refusal(tmp_path / "huge.nc", r"variable \w+ must be at most 10000000 long")


def test_a_heap_on_which_the_hdf5_library_would_walk_for_ever(tmp_path):
    """
    One bit in the size of an object, found by bending files at random: HDF5 2.0 does not come back
    from it.
    """
    data = bytearray((DATA / "wavespectra.nc").read_bytes())
    heap = data.find(b"GCOL")
    assert heap > 0
    readers.hdf5.require_sound_heaps("whole", bytes(data))
    for at in range(heap + 25, heap + 32):  # the first object's size, but for its lowest byte
        wrong = bytearray(data)
        wrong[at] ^= 0x81
        (tmp_path / "bent.nc").write_bytes(wrong)
        with pytest.raises(ReaderError, match=f"heap at byte {heap} has wrong sizes"):
            readers.open(tmp_path / "bent.nc")


@pytest.mark.parametrize("module", ["xarray", "h5py"])
def test_without_the_extra_it_is_named(module, monkeypatch):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ReaderError, match=r"pip install '\.\[science\]'"):
        readers.open(DATA / "wavespectra.nc")


@pytest.mark.parametrize(
    ("name", "given", "message"),
    [
        ("ww3file.nc", {"site": 2}, "site must be a whole number between 0 and 1, got 2"),
        ("ww3file.nc", {"site": 0.5}, "site must be a whole number"),
        ("swanfile.spec", {"site": 1}, "site must be a whole number between 0 and 0, got 1"),
        ("44004w2000.txt", {"site": 1}, "site must be a whole number between 0 and 0, got 1"),
        ("41010.data_spec", {"bins": 4}, "bins must be a whole number between 8 and 720, got 4"),
    ],
)
def test_what_is_asked_for_must_be_there(name, given, message):
    with pytest.raises(ParameterError, match=message):
        readers.open(DATA / name, **given)


# --- NDBC

HISTORICAL = (
    "YYYY MM DD hh   .050   .100   .150   .200\n"
    "2000 01 01 00   0.10   2.50   1.00   0.20\n"
    "2000 01 01 01   0.20   3.50   1.50   0.30\n"
)


def historical(tmp_path, *changes, name="44004w2000.txt"):
    text = HISTORICAL
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    (tmp_path / name).write_text(text)
    return tmp_path / name


@pytest.mark.parametrize("fill", ["999.00", "99.00", "MM", "999", "9999.0"])
def test_a_buoys_fill_values_are_masked_and_counted(fill, tmp_path):
    data = readers.open(historical(tmp_path, ("2.50", fill), ("0.30", fill)))
    assert data.attrs["masked_values"] == 2
    assert np.argwhere(np.isnan(data.ef.values)).tolist() == [[0, 1], [1, 3]]


def test_ninety_nine_degrees_is_a_direction(tmp_path):
    data = readers.open(write_ndbc(tmp_path, source=99.0))
    assert data.attrs["masked_moments"] == 0
    assert float(data.efth[0].sum("freq").idxmax()) == 100.0  # the nearest bin


@pytest.mark.parametrize("fill", ["99.00", "999.00", "MM"])
@pytest.mark.parametrize("suffix", ["swr1", "swr2"])
def test_a_coherence_of_99_is_missing(fill, suffix, tmp_path):
    """
    Without r1 the energy goes all round, is not lost, and is counted; without r2 it keeps its
    direction.
    """
    path = write_ndbc(tmp_path, source=90.0)
    whole = readers.open(path).efth[0]
    broken = path.with_suffix("." + suffix)
    text = broken.read_text()
    value = "0.90" if suffix == "swr1" else "0.65"
    broken.write_text(text.replace(f"{value} (0.1", f"{fill} (0.1"))
    data = readers.open(path)
    changed = (data.freq >= 0.0995).values & (data.freq < 0.1995).values
    assert data.attrs["masked_moments"] == np.sum(changed) > 3
    assert data.attrs["undirected_densities"] == (np.sum(changed) if suffix == "swr1" else 0)
    density = data.efth[0]
    assert density.sum("dir").values == pytest.approx(whole.sum("dir").values, rel=1e-12)
    assert np.array_equal(density[~changed], whole[~changed])
    if suffix == "swr1":
        assert np.ptp(density.values[changed], axis=1) == pytest.approx(
            np.zeros(np.sum(changed)), abs=1e-12
        )
    else:
        assert set(density.dir.values[density[changed].argmax("dir").values]) == {90.0}


def test_descending_frequencies_are_sorted(tmp_path):
    up = readers.open(historical(tmp_path))
    down = (
        "YYYY MM DD hh   .200   .150   .100   .050\n"
        "2000 01 01 00   0.20   1.00   2.50   0.10\n"
        "2000 01 01 01   0.30   1.50   3.50   0.20\n"
    )
    (tmp_path / "44004w2000.txt").write_text(down)
    assert readers.open(tmp_path / "44004w2000.txt").identical(up)


def test_the_newest_record_may_come_first_and_twice(tmp_path):
    lines = HISTORICAL.splitlines(keepends=True)
    (tmp_path / "a").write_text(
        "".join([lines[0], lines[2], lines[1], lines[2].replace("3.50", "9.00")])
    )
    data = readers.open(tmp_path / "a")
    assert data.attrs["repeated_times"] == 1
    assert data.ef.values[:, 1].tolist() == [2.5, 3.5]


@pytest.mark.parametrize(
    ("header", "year"),
    [("YY MM DD hh", "98"), ("#YY MM DD hh mm", "1998 "), ("#yr MM DD hh", "1998")],
)
def test_older_and_newer_headers(header, year, tmp_path):
    minutes = " 30" if "mm" in header else ""
    (tmp_path / "a").write_text(f"{header}  .05  .10\n{year} 02 03 04{minutes} 1.0 2.0\n")
    assert (
        str(readers.open(tmp_path / "a").time.values[0])
        == f"1998-02-03T04:{'30' if minutes else '00'}:00.000000000"
    )


def test_negative_zero_point_nothing_is_rounding(tmp_path):
    data = readers.open(historical(tmp_path, ("0.10", "-1e-21")))
    assert float(data.ef[0, 0]) == 0.0
    assert data.attrs["rounded_negatives"] == 1


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ([(".100", ".050")],
         r"the header must ascend or descend without repeats \[Hz\], got 0.05 twice"),
        ([(".100", ".170")], "must ascend or descend without repeats .* got 0.17 before 0.15"),
        ([(".050", ".000")], "the header must be between 1e-06 and 100000 Hz, got 0.0"),
        ([("   .100   .150   .200", ""), ("   2.50   1.00   0.20", ""),
          ("   3.50   1.50   0.30", "")],
         "at least 2 frequencies, got 1"),
        ([("   .200", "")], "line 2 must hold 3 values after the date, got 4"),
        ([("   1.50", "")], "line 3 must hold 4 values after the date, got 3"),
        ([("2.50", "-0.001")], r"line 2: spec must be between 0 and 3.6e\+08 m2/Hz, got -0.001"),
        ([("2.50", "4e8")], "line 2: spec must be between 0 and"),
        ([("2.50", "2.5O")], "line 2 must hold a number here, got '2.5O'"),
        ([("2.50", "nan")], "line 2 must hold a number here, got 'nan'"),
        ([("2.50", "inf")], "line 2 must hold a number here, got 'inf'"),
        ([("2.50", "2_5")], "line 2 must hold a number here, got '2_5'"),
        ([("2.50", "٢")], "line 2 must hold a number here"),
        ([("2000 01 01 01", "2000 13 01 01")],
         "line 3 must begin with a date, got '2000 13 01 01'"),
        ([("2000 01 01 01", "2000 01 01 xx")], "line 3 must begin with a date in 4 whole numbers"),
        ([("2000 01 01 01", "0205 01 01 01")],
         "line 3 must begin with a date between 1900 and 2200"),
        ([("2000 01 01 01", "\n2000 01 01 01")], "line 3 is empty"),
        ([("0.30\n", "0.3")],
         "line 3 has no end, and its last number '0.3' has fewer decimals .* "
         "the file is cut short"),
        ([("0.30\n", "0")], "line 3 has no end, and its last number '0' has fewer decimals"),
        ([("   0.30\n", "   ")], "line 3 must hold 4 values after the date, got 3"),
        ([(HISTORICAL.partition("\n")[2], "")], "at least one record after its header"),
    ],
)  # fmt: skip
def test_broken_historical_files(changes, message, tmp_path):
    with pytest.raises(ReaderError, match=message) as caught:
        readers.open(historical(tmp_path, *changes))
    assert str(caught.value).startswith("44004w2000.txt")


@pytest.mark.parametrize("kind", "dijk")
def test_historical_directions_are_not_taken_for_densities(kind, tmp_path):
    """
    The values look like densities; only the name tells them apart, and the error says what is
    missing.
    """
    with pytest.raises(ReaderError, match=r"missing: 44004w2000\.txt"):
        readers.open(historical(tmp_path, name=f"44004{kind}2000.txt"))


@pytest.mark.parametrize(
    ("suffix", "old", "new", "message"),
    [
        ("swr1", "0.90 (0.0", "90.0 (0.0",
         "12345.swr1: line 2: r1 must be between 0 and 1.1, got 90.0"),
        ("swr2", "0.65 (0.0", "-0.65 (0.0",
         "12345.swr2: line 2: r2 must be between 0 and 1.1, got -0.65"),
        ("swdir", "270.0 (0.0", "370.0 (0.0",
         "12345.swdir: line 2: alpha1 must be between 0 and 360 degrees, got 370.0"),
        ("swdir2", "(0.035", "(0.036", "12345.swdir2 must have the frequencies of 12345.data_spec"),
        ("swr1", "r1_1", "alpha1_1", "12345.swr1: line 1 must name r1_1, got alpha1_1"),
        ("swr1", "2020 01 01 00 40", "2020 01 01 01 40", "records of the same times, got none"),
        ("data_spec", "(0.035)", "(0.035", "line 2 must hold pairs like"),
        ("data_spec", "(0.035)", "", "line 2 must hold pairs like"),
        ("data_spec", "(0.035)", "(0.350)", "without repeats"),
        ("data_spec", "(0.035)", "(0.000)", "must be between 1e-06 and 100000 Hz, got 0.0"),
        ("data_spec", "9.999 0.000", "9.999 -0.001",
         "12345.data_spec: line 2: spec must be between 0"),
        ("data_spec", "#YY", "2020", "must be wave spectra in a known format"),
        ("swdir", "#YY", "2020", "12345.swdir: line 1 must be a header"),
    ],
)  # fmt: skip
def test_broken_realtime_sets(suffix, old, new, message, tmp_path):
    path = write_ndbc(tmp_path)
    broken = path.with_suffix("." + suffix)
    text = broken.read_text()
    assert old in text
    broken.write_text(text.replace(old, new, 1))
    with pytest.raises(ReaderError, match=message):
        readers.open(path)


def test_frequencies_that_change_in_the_middle(tmp_path):
    path = write_ndbc(tmp_path)
    head, row = path.read_text().splitlines()
    path.write_text(f"{head}\n{row}\n{row.replace('2020', '2021').replace('(0.035)', '(0.034)')}\n")
    with pytest.raises(ReaderError, match="line 3 must have the frequencies of the first record"):
        readers.open(path)


def test_half_a_set_is_refused_and_none_is_a_buoy_without_directions(tmp_path):
    path = write_ndbc(tmp_path)
    path.with_suffix(".swr2").unlink()
    with pytest.raises(
        ReaderError, match=r"all four files of directions beside it, or none; missing: 12345\.swr2"
    ):
        readers.open(path)
    for suffix in (".swr1", ".swdir", ".swdir2"):
        path.with_suffix(suffix).unlink()
    assert readers.open(path).ef.dims == ("time", "freq")


@pytest.mark.parametrize("suffix", ["swdir", "swdir2", "swr1", "swr2"])
def test_a_file_of_a_set_stands_for_the_set(suffix, tmp_path):
    """Or names the file with the densities, where that is missing."""
    first = write_ndbc(tmp_path)
    want = readers.open(first)
    assert readers.open(first.with_suffix("." + suffix)).identical(want)
    first.unlink()
    with pytest.raises(ReaderError, match=rf"12345\.{suffix} must have 12345\.data_spec beside it"):
        readers.open(first.with_suffix("." + suffix))


def test_records_without_their_directions_are_left_out_and_counted(tmp_path):
    path = write_ndbc(tmp_path)
    head, row = path.read_text().splitlines()
    path.write_text(f"{head}\n{row}\n{row.replace('2020', '2021')}\n")
    data = readers.open(path)
    assert (data.sizes["time"], data.attrs["unpaired_times"]) == (1, 1)


# --- SWAN


def swan(tmp_path, *changes):
    path = write_swan(tmp_path / "swan.spec", sea())
    text = path.read_text()
    for old, new in changes:
        assert re.search(old, text, re.MULTILINE)
        text = re.sub(old, new, text, count=1, flags=re.MULTILINE)
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ([("^SWAN   1", "SWAN   2")], "must be wave spectra in a known format"),
        ([("^     1\nLONLAT", "     3\nLONLAT")], "line 4: the time coding must be 1"),
        ([("^LONLAT", "LOCS")], "line 5 must be LONLAT or LOCATIONS, got 'LOCS'"),
        ([("^  -30.0  45.0", "  -30.0")], "line 7 must hold 2 numbers for places"),
        ([("^AFREQ", "WAVES")], "line 8 must be AFREQ or RFREQ"),
        ([("^AFREQ\n    30", "AFREQ\n    29")], "must be NDIR or CDIR, got '0.5"),
        ([("^AFREQ\n    30", "AFREQ\n    31")], "must hold a number here, got 'NDIR'"),
        ([("^AFREQ\n    30", "AFREQ\n    3O")],
         "must begin with a whole number between 1 and 1000000, got '3O'"),
        ([("^AFREQ\n    30", "AFREQ\n    99999999999")], "must begin with a whole number"),
        ([("0.034530000000", "0.0")], "AFREQ must be between 1e-06 and 100000 Hz, got 0.0"),
        ([("0.034530000000", "0.037983000000")],
         "AFREQ must ascend or descend without repeats .* twice"),
        ([("^187.5000", "202.5000")], "NDIR must hold each direction once .* got 202.5 twice"),
        ([("^187.5000", "1875.000")], "NDIR must be between -360 and 720 degrees, got 1875"),
        ([("^NDIR", "QUANT")], "must begin with a whole number between 1 and 3, got .24."),
        ([("^QUANT\n     1", "QUANT\n     3")], "must hold 1 quantity"),
        ([("^VaDens", "AcDens")], "must be VaDens in m2/Hz/degr or EnDens .* got AcDens"),
        ([("^m2/Hz/degr", "m2/Hz/rad")], "must be VaDens in m2/Hz/degr .* got VaDens in m2/Hz/rad"),
        ([("^20200101.000000", "20201301.000000")], "must begin with a time like"),
        ([("^20200101.000000", "2020-01-01")], "must begin with a time like"),
        ([("^FACTOR", "FACTORS")], "must be FACTOR, ZERO or NODATA, got 'FACTORS'"),
        ([("^FACTOR\n.*", "FACTOR\nNaN")], "must hold a number here, got 'NaN'"),
        ([("^FACTOR\n.*", "FACTOR\n0.0")],
         "the factor must be above 0 for densities that are not 0"),
        ([("^FACTOR\n.*", "FACTOR\n-1.0")], "the factor must be at least 0, got -1.0"),
        ([("^FACTOR\n.*", "FACTOR\n1e9")], "must be between 0 and 1e[+]06 m2/Hz/degree"),
        ([("^FACTOR\n(.*)\n0 ", r"FACTOR\n\1\n-1 ")],
         r"a density must be at least 0 \(or -99, missing\), got -1"),
        ([("^FACTOR\n(.*)\n0 ", r"FACTOR\n\1\n0 0 ")],
         "must hold 24 densities, one a direction, got 25"),
        ([("^FACTOR\n(.*)\n0 ", r"FACTOR\n\1\n")],
         "must hold 24 densities, one a direction, got 47"),
        ([("^FACTOR\n(.*)\n0 ", r"FACTOR\n\1\nO ")], "must hold a number here, got 'O'"),
        ([("^20200101(.|\n)*", "")], "must hold at least one spectrum"),
    ],
)  # fmt: skip
def test_broken_swan_files(changes, message, tmp_path):
    with pytest.raises(ReaderError, match=message) as caught:
        readers.open(swan(tmp_path, *changes))
    assert "swan.spec" in str(caught.value)


def test_a_swan_file_cut_between_any_two_lines(tmp_path):
    """Whole again only after the last line of a spectrum."""
    path = swan(tmp_path)
    text = path.read_text().splitlines(keepends=True)
    whole = []
    for lines in range(1, len(text)):
        path.write_text("".join(text[:lines]))
        try:
            whole.append(readers.open(path).sizes["time"])
        except ReaderError as error:
            whole.append(0)
            assert re.search(r"cut short|at least one spectrum", str(error))  # noqa: PT017
    assert [(i + 1, n) for i, n in enumerate(whole) if n] == [
        (len(text) - 33, 1)
    ]  # time, FACTOR, factor and 30 rows before the end


def test_swans_exceptions_zero_and_nodata(tmp_path):
    """-99 is masked and counted, bin by bin; ZERO is a flat sea; NODATA a missing one."""
    data = readers.open(swan(tmp_path, ("^FACTOR\n(.*)\n0 0 ", r"FACTOR\n\1\n-99 -99 ")))
    assert data.attrs["masked_values"] == 2
    assert int(np.isnan(data.efth[0, 0]).sum()) == 2
    block = r"^20200101.000000\n(.*\n){32}"
    assert (
        float(readers.open(swan(tmp_path, (block, "20200101.000000\nZERO\n"))).efth[0].sum()) == 0.0
    )
    data = readers.open(swan(tmp_path, (block, "20200101.000000\nNODATA\n")))
    assert bool(np.all(np.isnan(data.efth[0])))
    assert data.attrs["masked_values"] == FREQUENCY.size * TO.size


def test_swans_energy_and_relative_frequencies_and_places_in_metres(tmp_path):
    """J/m2 are rho g m2, with SWAN's own 1025 kg/m3 and 9.81 m/s2."""
    want = readers.open(swan(tmp_path))
    data = readers.open(
        swan(tmp_path, ("^VaDens\n", "EnDens\nJ/"), ("^AFREQ", "RFREQ"), ("^LONLAT", "LOCATIONS"))
    )
    assert data.efth.values * 1025.0 * 9.81 == pytest.approx(want.efth.values, rel=1e-12)
    assert (float(data.x), float(data.y)) == (-30.0, 45.0)


def test_the_second_of_two_places_and_no_times(tmp_path):
    """
    Rows may be broken over lines, places may have names, and a file without TIME has one spectrum
    each.
    """
    rows = "\n".join("1 2\n3 4" if i == 1 else "0 0 0 0" for i in range(3))
    axes = "AFREQ\n3\n.1\n.2\n.3\nNDIR\n4\n0\n90\n180\n270\nQUANT\n1\nVaDens\nm2/Hz/degr\n-99\n"
    text = f"SWAN 1\nLOCATIONS\n2\n0 0 first\n10 20 second\n{axes}ZERO\nFACTOR\n0.5\n{rows}\n"
    (tmp_path / "two").write_text(text)
    data = readers.open(tmp_path / "two", site=1)
    assert data.efth.values.tolist() == [[[0, 0, 0, 0], [0.5, 1.0, 1.5, 2.0], [0, 0, 0, 0]]]
    assert (float(data.x), "time" in data.coords) == (10.0, False)
    assert float(readers.open(tmp_path / "two").efth.sum()) == 0.0
    (tmp_path / "two").write_text(text + "ZERO\n")
    with pytest.raises(ReaderError, match="must be the end of a file without TIME"):
        readers.open(tmp_path / "two")


# --- netCDF


def with_attrs(data, name, **attrs):
    """Return the dataset with attributes of one variable changed; None removes one."""
    out = data.copy()
    kept = {k: v for k, v in (out[name].attrs | attrs).items() if v is not None}
    if name in out.indexes:
        return out.assign_coords({name: (name, out[name].values, kept)})
    out[name].attrs = kept
    return out


def with_values(data, name, change):
    values = data[name].values.astype(float)
    values = change(values)
    if name in data.indexes:
        return data.assign_coords({name: (name, values, data[name].attrs)})
    return data.assign({name: (data[name].dims, values, data[name].attrs)})


def put(value, *index):
    def change(values):
        values[index] = value
        return values

    return change


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda d: with_attrs(d, "efth", units="kg"),
         "variable efth must have units m2/Hz per degree or radian, got 'kg'"),
        (lambda d: with_attrs(d, "efth", units=None), "variable efth must have units"),
        (lambda d: with_attrs(d, "efth", units="m2 s"), "variable efth must have units"),
        (lambda d: with_attrs(d, "efth", units="m s rad-1"), "variable efth must have units"),
        (lambda d: with_attrs(d, "efth", units="J/m2/Hz/degr"), "variable efth must have units"),
        (lambda d: with_attrs(d, "frequency", units="rad/s"),
         "variable frequency must have units Hz or s-1, got 'rad/s'"),
        (lambda d: with_attrs(d, "frequency", units=None), "variable frequency must have units"),
        (lambda d: with_attrs(d, "direction", units="grad"),
         "variable direction must have units degree or radian, got 'grad'"),
        (lambda d: with_attrs(d, "direction", units=None), "variable direction must have units"),
        (lambda d: with_values(d, "direction", np.radians), "is it in radians"),
        (lambda d: with_attrs(d, "direction", standard_name=None, long_name=None),
         "must state whether waves come from there or go there"),
        (lambda d: with_attrs(d, "direction", standard_name="sea_surface_wave_from_direction"),
         "must state one sense"),
        (lambda d: with_attrs(d, "direction", long_name="direction the waves come from"),
         "must state one sense"),
        (lambda d: with_attrs(d, "direction", standard_name="wind_to_direction"),
         "must be a wave direction, got standard_name 'wind_to"),
        (lambda d: with_values(d, "direction", put(97.5, 1)),
         "variable direction must hold each direction once"),
        (lambda d: with_values(d, "direction", put(np.nan, 1)),
         "variable direction must be between -360 and 720 degrees, got nan"),
        (lambda d: d.isel(direction=slice(0, 3)),
         "variable direction must hold at least 4 directions, got 3"),
        (lambda d: with_values(d, "frequency", put(-0.1, 0)),
         "variable frequency must be between 1e-06 and 100000 Hz, got -0.1"),
        (lambda d: with_values(d, "frequency", put(0.0345, 1)),
         "variable frequency must ascend or descend without repeats"),
        (lambda d: with_values(d, "frequency", put(np.nan, 3)),
         "variable frequency must be between .* got nan"),
        (lambda d: d.isel(frequency=slice(0, 1)), "at least 2 frequencies, got 1"),
        (lambda d: with_values(d, "efth", put(-1e-3, 1, 0, 2, 3)),
         r"between 0 and 1e\+06 m2/Hz/degree, got -1.7\d*e-05 at \(1, 2, \d*\)"),
        (lambda d: with_values(d, "efth", put(1e9, 1, 0, 2, 3)),
         "variable efth must be between 0 and"),
        (lambda d: with_values(d, "efth", put(np.inf, 1, 0, 2, 3)), None),
        (lambda d: d.drop_vars("direction"),
         "dimension direction must have a coordinate variable along itself"),
        (lambda d: d.rename(efth="waves").assign(waves=("station", [1.0])),
         "must hold one wave spectrum .* got "),
        (lambda d: d.isel(time=slice(0, 0)), "must hold at least one time"),
        (lambda d: d.isel(station=slice(0, 0)), "must hold at least one place"),
        (lambda d: d.assign_coords(time=("time", [1.0, 2.0])),
         "variable time must be a time of the usual calendar"),
        (lambda d: d.assign(efth=d.efth.astype(str)), "variable efth must hold numbers"),
    ],
)  # fmt: skip
def test_broken_netcdf(make, message, tmp_path):
    make(ww3(sea())).to_netcdf(tmp_path / "bad.nc", engine="h5netcdf")
    if message is None:  # a fill value like any other
        assert readers.open(tmp_path / "bad.nc").attrs["masked_values"] == 1
        return
    with pytest.raises(ReaderError, match=message) as caught:
        readers.open(tmp_path / "bad.nc")
    assert str(caught.value).startswith("bad.nc")


@pytest.mark.parametrize("fill", [9.999e20, 9.96921e36, 1e20, -9.999e20])
@pytest.mark.parametrize("declared", [True, False])
def test_netcdf_fill_values_are_masked_and_counted(fill, declared, tmp_path):
    """Declared by _FillValue or not declared by anyone."""
    data = with_values(ww3(sea()), "efth", put(np.nan if declared else fill, 1, 0, slice(2, 4), 3))
    data.to_netcdf(
        tmp_path / "a.nc",
        engine="scipy",
        encoding={"efth": {"_FillValue": fill}} if declared else {"efth": {"_FillValue": None}},
    )
    got = readers.open(tmp_path / "a.nc")
    assert got.attrs["masked_values"] == 2
    assert int(np.isnan(got.efth).sum()) == 2
    assert readers.sea_from_spectrum(got, time=1).hs > 1.0


def test_rounding_below_zero_is_forgiven_and_counted():
    """-1e-21, and the last bit of float32 of the largest density."""
    data = ww3(sea())
    tiny = 0.5e-7 * float(data.efth.max())
    for value in (-1e-21, -tiny):
        got = readers.netcdf.to_layout(with_values(data, "efth", put(value, 1, 0, 2, 3)))
        assert got.attrs["rounded_negatives"] == 1
        assert float(got.efth.min()) == 0.0


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda d: with_values(d, "d2fd", lambda v: 10.0 ** (v + 10.0)),
         "must be log10 of a density, at most 7.7"),
        (lambda d: with_attrs(d, "d2fd", units="m2 s"), "must have units"),
        (lambda d: with_attrs(d, "d2fd", units="m2/Hz/degree"),
         r"must have units m\*\*2 s radian\*\*-1"),
        (lambda d: with_values(d, "directionNumber", lambda v: v + 1.0),
         "must hold bin numbers between 1 and 24, got 2 to 25"),
        (lambda d: with_values(d, "frequencyNumber", lambda v: v - 1.0),
         "must hold bin numbers between 1 and 30, got 0 to 29"),
        (lambda d: with_attrs(d, "directionNumber", long_name="coming from"), None),
    ],
)  # fmt: skip
def test_broken_era5(make, message, tmp_path):
    make(era5(sea())).to_netcdf(tmp_path / "bad.nc", engine="h5netcdf")
    if message is None:  # what it says itself goes before what is documented
        turned = (
            readers.sea_from_spectrum(readers.open(tmp_path / "bad.nc", site=1))
            .systems[0]
            .direction
        )
        assert abs(turned) == pytest.approx(180.0, abs=1e-6)
        return
    with pytest.raises(ReaderError, match=message):
        readers.open(tmp_path / "bad.nc", site=1)


def test_era5_counts_what_was_below_its_threshold():
    """Nothing is 0 inside a spectrum, missing where all of it is."""
    data = era5(sea())
    got = readers.netcdf.to_layout(data, site=1)
    assert (
        got.attrs["below_threshold_values"] == int(np.isnan(data.d2fd.isel(latitude=1)).sum()) > 0
    )
    assert (got.attrs["masked_values"], float(got.efth.min())) == (0, 0.0)
    land = readers.netcdf.to_layout(data, site=0)
    assert land.attrs["masked_values"] == land.efth.size == int(np.isnan(land.efth).sum())


def test_part_of_era5s_bins_keep_their_numbers():
    """Bins 5 to 20 are not taken for 1 to 16."""
    part = readers.netcdf.to_layout(era5(sea()).isel(frequencyNumber=slice(4, 20)), site=1)
    assert part.freq.values == pytest.approx(FREQUENCY[4:20], rel=1e-12)


def test_a_packed_dataset_must_be_decoded_first(tmp_path):
    packing = {
        "dtype": "int16",
        "scale_factor": 2e-4,
        "add_offset": -4.0,
        "_FillValue": np.int16(-32767),
    }
    era5(sea()).to_netcdf(tmp_path / "packed.nc", engine="scipy", encoding={"d2fd": packing})
    with (
        xr.open_dataset(tmp_path / "packed.nc", engine="scipy", mask_and_scale=False) as raw,
        pytest.raises(ReaderError, match="must be decoded"),
    ):
        readers.sea_from_spectrum(raw)


def test_errors_name_the_file_and_nothing_is_left_open(tmp_path):
    """A file that was refused, and one that was read, can be deleted and written again at once."""
    path = write_wavespectra(tmp_path / "a.nc", sea())
    readers.open(path)
    data = path.read_bytes()
    path.write_bytes(data[:-100])
    with pytest.raises(ReaderError, match=r"^a\.nc"):
        readers.open(path)
    path.write_bytes(data)
    readers.open(path)
    descriptors = Path("/proc/self/fd")
    assert not any(os.path.realpath(fd) == str(path) for fd in descriptors.iterdir())


# --- units that contradict the numbers


@pytest.mark.parametrize("keyword", ["NDIR", "CDIR"])
@pytest.mark.parametrize("count", [24, 6, 4])
def test_radians_under_swans_degrees(keyword, count, tmp_path):
    """All round, in radians: within 6.3 degrees, if they were degrees."""
    step = 24 // count
    text = (
        write_swan(tmp_path / "a.spec", sea(), cartesian=keyword == "CDIR").read_text().splitlines()
    )
    at = text.index(keyword)
    angles = [f"{np.radians(float(a)):.4f}" for a in text[at + 2 : at + 26 : step]]
    first = next(i for i, line in enumerate(text) if line == "FACTOR") + 2
    rows = [
        " ".join(line.split()[::step]) if i >= first and len(line.split()) == 24 else line
        for i, line in enumerate(text)
    ]
    for values, refused in ((angles, True), (text[at + 2 : at + 26 : step], False)):
        (tmp_path / "a.spec").write_text(
            "\n".join([*rows[: at + 1], f"{count:6d}", *values, *rows[at + 26 :]]) + "\n"
        )
        if refused:
            with pytest.raises(
                ReaderError,
                match=rf"a\.spec: {keyword} must be in degrees, as its unit says, but spans .* "
                r"is it in radians\?",
            ):
                readers.open(tmp_path / "a.spec")
        else:
            assert readers.open(tmp_path / "a.spec").sizes["dir"] == count


@pytest.mark.parametrize("count", [24, 6, 4])
def test_radians_under_netcdfs_degrees_and_degrees_under_its_radians(count):
    data = ww3(sea()).isel(direction=slice(0, 24, 24 // count))
    with pytest.raises(
        ReaderError,
        match=r"variable direction must be in degrees, as its unit says, .* is it in radians",
    ):
        readers.netcdf.to_layout(with_values(data, "direction", np.radians))
    with pytest.raises(
        ReaderError,
        match=r"variable direction must be in radians, as its unit says, but reaches .* "
        r"is it in degrees",
    ):
        readers.netcdf.to_layout(with_attrs(data, "direction", units="radian"))


@pytest.mark.parametrize("name", ["efth", "frequency", "direction"])
@pytest.mark.parametrize("engine", ["scipy", "h5netcdf"])
@pytest.mark.parametrize(
    ("attrs", "message"),
    [
        ({"scale_factor": 0.0}, "scale_factor must be a number between 1e-30 and 1e"),
        ({"scale_factor": 1e-40}, "scale_factor must be a number between"),
        ({"scale_factor": -1.0}, "scale_factor must be a number between"),
        ({"scale_factor": np.nan}, "scale_factor must be a number between"),
        ({"add_offset": np.inf}, "add_offset must be a number of a size up to"),
    ],
)
def test_absurd_packing(name, engine, attrs, message, tmp_path):
    """A zero makes a flat sea of any file, a negative one turns it round."""
    with_attrs(ww3(sea()), name, **attrs).to_netcdf(tmp_path / "a.nc", engine=engine)
    with pytest.raises(ReaderError, match=rf"a\.nc: variable {name}: attribute {message}"):
        readers.open(tmp_path / "a.nc")
