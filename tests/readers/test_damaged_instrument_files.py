"""Damaged files of instruments and models give a dataset or an error that names the file."""

import gzip
import random
import re

import pytest
from instrument_files import (
    ndbc_netcdf,
    write_archive,
    write_datawell,
    write_octopus,
    write_spotter,
    write_swan_1d,
    write_triaxys,
    write_ww3_text,
)
from spectrum_files import sea
from test_damaged_files import bent, require_dataset_or_refusal

from fftocean import readers
from fftocean.errors import ReaderError

pytestmark = [pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")]
SPECIFIED = sea()
WRITERS = {
    "station.spec": write_ww3_text,
    "swan.sp1": write_swan_1d,
    "spotter.csv": write_spotter,
    "datawell.spt": write_datawell,
    "triaxys.DIRSPEC": write_triaxys,
    "triaxys.NONDIRSPEC": lambda path, specified: write_triaxys(path, specified, directed=False),
    "octopus.oct": write_octopus,
    "12345w2020.txt": lambda path, specified: write_archive(path.parent, specified),
    "buoy.nc": lambda path, specified: ndbc_netcdf(specified).to_netcdf(path, engine="scipy"),
}


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.parametrize("how", ["cut", "bent"])
def test_broken_files(name, how, tmp_path):
    path = tmp_path / name
    WRITERS[name](path, SPECIFIED)
    data = path.read_bytes()
    rng = random.Random(f"{name} {how}")
    for _ in range(25):
        path.write_bytes(data[: rng.randrange(len(data))] if how == "cut" else bent(data, rng))
        require_dataset_or_refusal(path)


@pytest.mark.parametrize("name", ["12345i2020.txt", "12345k2020.txt"])
def test_broken_sisters(name, tmp_path):
    first = write_archive(tmp_path, SPECIFIED)
    data = (tmp_path / name).read_bytes()
    rng = random.Random(name)
    for _ in range(25):
        (tmp_path / name).write_bytes(bent(data, rng))
        try:
            readers.open(first)
        except ReaderError as error:
            assert "12345" in str(error)  # noqa: PT017


@pytest.mark.parametrize("name", [n for n in WRITERS if n not in ("buoy.nc", "12345w2020.txt")])
def test_a_file_without_its_final_newline_is_read_and_says_so(name, tmp_path):
    path = tmp_path / name
    WRITERS[name](path, SPECIFIED)
    want = readers.open(path)
    path.write_bytes(path.read_bytes().rstrip(b"\r\n"))
    got = readers.open(path)
    assert f"{name}: the last line has no end" in got.attrs.pop("unterminated")
    assert got.identical(want)


@pytest.mark.parametrize("name", [n for n in WRITERS if n not in ("buoy.nc", "12345w2020.txt")])
def test_a_file_cut_between_lines_is_refused_or_has_fewer_records(name, tmp_path):
    """Half a table, or half a header, is never taken for a whole one."""
    path = tmp_path / name
    WRITERS[name](path, SPECIFIED)
    lines = path.read_bytes().splitlines(keepends=True)
    whole = readers.open(path)
    for count in sorted(random.Random(name).sample(range(1, len(lines)), min(30, len(lines) - 1))):
        path.write_bytes(b"".join(lines[:count]))
        try:
            got = readers.open(path)
        except ReaderError:
            continue
        if name == "datawell.spt":  # one line a frequency, and no count of them
            assert got.sizes["freq"] < whole.sizes["freq"]
            continue
        key = "efth" if "efth" in whole else "ef"
        assert got.sizes["time"] < whole.sizes["time"]
        assert got[key].identical(whole[key].isel(time=slice(0, got.sizes["time"])))


def lines_changed(text, *changes):
    for old, new in changes:
        assert re.search(old, text, re.MULTILINE), old
        text = re.sub(old, new, text, count=1, flags=re.MULTILINE)
    return text


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("station.spec", ("SPECTRA'    30", "SPECTRA'    31"),
         "line [0-9]+: there must be 31 frequencies, got|hold numbers only"),
        ("station.spec", ("SPECTRA'    30    24     1", "SPECTRA'    30"),
         "line 1 must be 'WAVEWATCH III SPECTRA' and three counts"),
        ("station.spec", ("SPECTRA'    30", "SPECTRA' 99999"), "must count 2 to 10000 frequencies"),
        ("station.spec", ("^20200101", "20201301"), "must be a time like 20220912 060000"),
        ("station.spec", ("^'P0", "P0"), "must be a point"),
        ("station.spec", (" 45.00-130.00      30.0   5.00 270.0   0.10  90.0", " 45.00"),
         "latitude, longitude and depth"),
        ("station.spec", (r"^'P0        '(.*)\n(.*\n)", r"'P0        '\1\n x\n\2"),
         "must hold numbers only, got 'x'"),
        ("station.spec", (r"(20200101 060000\n)'P0", r"\1'Q0"),
         "must be 'P0' at all times, got 'Q0'"),
        ("swan.sp1", ("^VaDens  variance", "VaDens\nm2/Hz/degr\n"), "VaDens must be in m2/Hz"),
        ("swan.sp1", ("^DSPRDEGR", "DSPRPOWER"),
         "must be one of VaDens, EnDens, NDIR, CDIR, DSPRDEGR, got 'DSPRPOWER'"),
        ("swan.sp1", ("^LOCATION     1", "LOCATION     7"), "must be LOCATION 1 or NODATA"),
        ("swan.sp1", ("^NDIR\ndegr", "NDIR\nrad"), "the unit of NDIR must be degr"),
        ("swan.sp1", (r"(LOCATION     1\n  \S+  \S+)  \S+", r"\1"), "must hold 3 numbers, got 2"),
        ("swan.sp1", (r"(LOCATION     1\n  \S+  \S+)  \S+", r"\1  200.0"),
         "DSPRDEGR must be between 0 and 180"),
        ("swan.sp1", ("^NDIR\ndegr\n -0.9990E.03", "VaDens\nm2/Hz\n -99"),
         "must be one density and one direction at most"),
        ("spotter.csv", ("varianceDensity_29", "density_29"),
         "as many varianceDensity_i as f_i, got 29"),
        ("spotter.csv", ("Epoch Time", "Epoch"), "known format"),
        ("spotter.csv", ("df_3 ", "df_2 "), "must name each column once, got 'df_2' twice"),
        ("spotter.csv", ("^1577836800,", "1577836800,1,"),
         "line 2 must hold 274 cells, as line 1 does, got 275"),
        ("spotter.csv", ("^1577836800,", "9e99,"), "Epoch Time must be seconds since 1970"),
        ("spotter.csv", (r"^(1577836800(?:,[^,]+){3}),[^,]+", r"\1,0.0299"),
         "line 3 must have the frequencies of line 2, got others"),
        ("spotter.csv", ("^1577836800,", "soon,"),
         "line 2, column Epoch Time, must hold a number here, got 'soon'"),
        ("datawell.spt", (r"(\n|^)10\r\n", "ten\n"), "known format"),
        ("datawell.spt", (r",(-?[0-9.]+)\r\n", "\r\n"), "must hold 6 numbers"),
        ("datawell.spt", (r"^(0\.0345\S*?,\S*?),[0-9.]+,", r"\1,999.0,"),
         "the direction must be between -360 and 720 degrees, got 999"),
        ("triaxys.DIRSPEC", ("NUMBER OF FREQUENCIES = 40", "NUMBER OF FREQUENCIES = 41"),
         "must hold 41 rows, got 40: is it cut"),
        ("triaxys.DIRSPEC", ("NUMBER OF DIRECTIONS = 25", "NUMBER OF DIRECTIONS = 24"),
         "must be 24 directions 15 degrees apart"),
        ("triaxys.DIRSPEC", ("^TYPE\t= DIRECTIONAL", "TYPE\t= MEAN"),
         "must be a DIRECTIONAL or NON-DIRECTIONAL SPECTRUM"),
        ("triaxys.DIRSPEC", ("^DATE .*", "DATE = yesterday"), "DATE must be like 2018-01-31 21:00"),
        ("triaxys.DIRSPEC", ("^FREQUENCY SPACING .*\n", ""),
         r"must state FREQUENCY SPACING \(HZ\)"),
        ("triaxys.DIRSPEC", (r"(\d\.\d+E-0\d)$", "9.9E+00"),
         "columns 0 and 360 degrees must be equal"),
        ("triaxys.NONDIRSPEC", ("^0.100 ", "0.190 "), "row 11 must be at 0.1 Hz, got 0.19"),
        ("octopus.oct", ("^nrecs,2", "nrecs,3"),
         "ends where a record must follow: the file is cut short"),
        ("octopus.oct", ("^nrecs,2", "nrecs,1"), "must be the end, after 1 records"),
        ("octopus.oct", ("^nrecs,2", "nrecs,many"), "must begin with a whole number"),
        ("octopus.oct", ("^ndir,24", "ndir,23"), "must begin with fSpec or den"),
        ("octopus.oct", ("^202001,'01", "202013,'01"), "must begin with a time like 201803,110000"),
        ("octopus.oct", ("^22.5,", "23.5,"), "record 2 must have the axes of the first"),
        ("12345w2020.txt", ("^2020 01 01 00 00 ", "2020 01 01 00 00 -1 "),
         "must hold 30 values after the date, got 31"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(name, change, message, tmp_path):
    path = tmp_path / name
    WRITERS[name](path, SPECIFIED)
    text = lines_changed(path.read_bytes().decode(), change)
    path.write_bytes(text.encode())
    with pytest.raises(ReaderError, match=message) as caught:
        readers.open(path)
    assert name in str(caught.value)


@pytest.mark.parametrize(
    "head",
    [
        b"'WAVEWATCH III SPECTRA' 5000 5000 5000 ''\n",
        b"TRIAXYS BUOY DATA REPORT\n",
        b"a\nnfreqs,9999\nndir,9999\nnrecs,9999\n",
    ],
)
def test_counts_are_bounded_before_anything_is_made(head, tmp_path):
    """
    A header can declare any size, and a packed file hold any number of lines: refused within a few
    MB.
    """
    import tracemalloc

    (tmp_path / "bomb.gz").write_bytes(
        gzip.compress(head) + gzip.compress(b"0 0 0 0\n" * 10**5) * 5
    )
    tracemalloc.start()
    with pytest.raises(ReaderError, match="bomb"):
        readers.open(tmp_path / "bomb.gz")
    assert tracemalloc.get_traced_memory()[1] < 64 * 2**20
    tracemalloc.stop()


def test_names_out_of_a_broken_file_neither_fill_nor_steer_the_terminal(tmp_path):
    """
    A variable's name may be anything: a bent length makes it half of the header, with all its
    zeros.
    """
    raw = ndbc_netcdf(SPECIFIED).rename(mean_wave_dir="\x1b[2J" + "x" * 900)
    raw.to_netcdf(tmp_path / "buoy.nc", engine="scipy")
    raw["spectral_wave_density"].attrs["units"] = "\x1b[2J" + "y" * 900
    raw.to_netcdf(tmp_path / "other.nc", engine="scipy")
    for name in ("buoy.nc", "other.nc"):
        with pytest.raises(ReaderError) as caught:
            readers.open(tmp_path / name)
        assert str(caught.value).isprintable()
        assert str(caught.value).startswith(name)
        assert len(str(caught.value)) <= 480
    assert readers.bounded_reads.printable("a\tb\x1b[2J\u202e") == r"a\tb\x1b[2J\u202e"


def test_octopus_directions_must_go_round(tmp_path):
    path = write_octopus(tmp_path / "a.oct", SPECIFIED)
    path.write_text(path.read_text().replace("\n22.5,", "\n23.5,"))
    with pytest.raises(
        ReaderError, match=r"a\.oct: the directions must be equally spaced all round"
    ):
        readers.open(path)
