"""The registry of readers: each format once, complete, and chosen by a file's contents."""

from pathlib import Path

import pytest
from spectrum_files import DATA

from fftocean import readers
from fftocean.errors import ReaderError


@pytest.mark.parametrize(
    ("head", "message"),
    [
        ("#YY  MM DD hh mm WDIR WSPD GST  WVHT   DPD   APD MWD   PRES  ATMP  WTMP",
         "standard meteorological file.*data_spec"),
        ("YYYY MM DD hh WD   WSPD GST  WVHT  DPD   APD  MWD  BAR    ATMP",
         "standard meteorological file.*data_spec"),
        ("YY MM DD hh WD   WSPD GST  WVHT  DPD   APD  MWD  BAR    ATMP",
         "standard meteorological file.*data_spec"),
        ("#YY  MM DD hh mm WVHT  SwH  SwP  WWH  WWP SwD WWD  STEEPNESS  APD MWD",
         "summary of waves.*data_spec"),
        ("<!DOCTYPE html>", "is a web page"),
        ("GRIB\x00\x01", "is GRIB; convert it to netCDF"),
        ("PK\x03\x04", "is a zip archive; unpack it"),
        ('{"data":{"frequencyData":[]}}', "is a Spotter's JSON"),
        ("%\n%\n% Run:trki  Table:tahb    SWAN version:40.91", "is a table of SWAN"),
        ("$PNORI,4,a,b", "is NMEA telegrams"),
        ("hello", r"known format \(netCDF, SWAN 1-D ASCII, .*Octopus\), got 'hello'"),
    ],
)  # fmt: skip
def test_near_misses(head, message, tmp_path):
    (tmp_path / "near").write_text(head + "\nmore\n")
    with pytest.raises(ReaderError, match=f"near .*{message}"):
        readers.open(tmp_path / "near")


def test_every_sample_has_one_reader_that_knows_it():
    """
    The first of `FORMATS` that accepts a file reads it; where several do, the special stands first.
    """
    also = {"swan_1d": {"swan"}, "ndbc_archive": {"ndbc"}}
    names = {reader.name: module for module, reader in modules().items()}
    seen = set()
    for path in DATA.iterdir():
        if path.name == "README.md":
            continue
        head = readers.Head.of(path)
        known = [names[reader.name] for reader in readers.FORMATS if reader.sniff(head)]
        assert known, path.name
        assert set(known[1:]) <= also.get(known[0], set()), path.name
        seen.add(known[0])
    assert seen == set(names.values()) - {"swan_1d"}


def modules():
    """Return the readers by the module that holds each."""
    return {
        name: module.READER for name, module in vars(readers).items() if hasattr(module, "READER")
    }


def test_every_module_with_a_reader_is_registered():
    folder = (readers.__file__ or "").rpartition("/")[0]
    with_reader = {p.stem for p in Path(folder).glob("*.py") if "\nREADER" in p.read_text()}
    assert with_reader == set(modules())
    assert {id(r) for r in readers.FORMATS} == {id(r) for r in modules().values()}
    assert len({r.name for r in readers.FORMATS}) == len(readers.FORMATS)


@pytest.mark.parametrize("part", ["name", "extensions", "description", "sniff", "read"])
def test_a_reader_without_a_part_is_an_error(part):
    parts = {
        "name": "A",
        "extensions": (".a",),
        "description": "A.",
        "sniff": str,
        "read": str,
    }
    readers.Reader(**parts)
    with pytest.raises((TypeError, ValueError)):
        readers.Reader(**{k: v for k, v in parts.items() if k != part})
    with pytest.raises((TypeError, ValueError)):
        readers.Reader(**(parts | {part: () if part == "extensions" else ""}))


def test_the_command_line_says_what_a_file_is_and_exits_with_3(tmp_path, capsys):
    from fftocean.cli import main

    (tmp_path / "41010.txt").write_text(
        "#YY  MM DD hh mm WDIR WSPD GST  WVHT   DPD   APD MWD   PRES\n"
    )
    (tmp_path / "job.toml").write_text('[[sea.systems]]\nmeasured = { file = "41010.txt" }\n')
    assert main(["info", str(tmp_path / "job.toml")]) == 3
    assert "standard meteorological file" in capsys.readouterr().err
