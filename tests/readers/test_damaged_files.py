"""Damaged files give a dataset or a `ReaderError`, never another exception."""

import random
import shutil

import numpy as np
import pytest
from spectrum_files import DATA, era5, sea, write_ndbc

from fftocean import readers
from fftocean.errors import ReaderError, SeaWarning
from fftocean.physics.spreading import CosinePower

SAMPLES = [
    "ww3file.nc",
    "wavespectra.nc",
    "swanfile.spec",
    "44004w2000.txt",
    "41010.data_spec",
    "41010.swr2",
    "era5.nc",
    "12345.swdir",
]


@pytest.fixture(scope="module")
def originals(tmp_path_factory):
    """
    Return a folder of samples, with the buoy's cut to three records, ERA5 (packed, netCDF 3) and
    one more buoy set.
    """
    folder = tmp_path_factory.mktemp("originals")
    for path in DATA.iterdir():
        if path.name.startswith("41010"):
            (folder / path.name).write_text("".join(path.read_text().splitlines(keepends=True)[:4]))
        else:
            shutil.copyfile(path, folder / path.name)
    packing = {
        "dtype": "int16",
        "scale_factor": 2e-4,
        "add_offset": -4.0,
        "_FillValue": np.int16(-32767),
    }
    era5(sea()).to_netcdf(folder / "era5.nc", engine="scipy", encoding={"d2fd": packing})
    write_ndbc(folder)
    return folder


def require_dataset_or_refusal(path):
    """Open a file; if that succeeds, make a sea of it."""
    refusal = ""
    try:
        data = readers.open(path)
    except ReaderError as error:
        refusal = str(error)
    if refusal:
        assert path.stem in refusal
        assert 20 < len(refusal) < 500
        return
    assert np.all(data.freq.values > 0.0)
    assert np.all(np.diff(data.freq.values) > 0.0)
    density = (data.efth if "efth" in data else data.ef).values
    assert np.all(np.isnan(density) | (density >= 0.0))
    assert np.all(np.isnan(density) | np.isfinite(density))
    given = {}
    if "dir" in data.coords:
        assert np.all((data.dir.values >= 0.0) & (data.dir.values < 360.0))
        assert np.all(np.diff(data.dir.values) > 0.0)
    else:
        given = {"direction": 0.0, "spreading": CosinePower(s=4.0)}
    try:
        made = readers.Realised.from_spectrum(data, **given)
    except (ReaderError, SeaWarning):  # too high, all missing; flat
        return
    assert np.isfinite(made.sea.hs)


def bent(data, rng):
    """Return data with one to thirty flipped bits, half of the time in the header."""
    out = bytearray(data)
    for _ in range(rng.choice([1, 1, 3, 30])):
        out[rng.randrange(len(out) if rng.random() < 0.5 else min(len(out), 4000))] ^= (
            1 << rng.randrange(8)
        )
    return bytes(out)


@pytest.mark.parametrize("name", SAMPLES)
@pytest.mark.parametrize("how", ["cut", "bent"])
def test_broken_files(name, how, originals, tmp_path):
    shutil.copytree(originals, tmp_path, dirs_exist_ok=True)
    path = tmp_path / name
    opened = next(path.parent.glob(f"{path.stem}.data_spec"), path)
    data = path.read_bytes()
    rng = random.Random(f"{name} {how}")
    for _ in range(50):
        path.write_bytes(data[: rng.randrange(len(data))] if how == "cut" else bent(data, rng))
        require_dataset_or_refusal(opened)


@pytest.mark.parametrize(
    "name", ["44004w2000.txt", "41010.data_spec", "41010.swdir", "swanfile.spec"]
)
def test_a_text_file_cut_inside_a_line_is_refused_or_whole_records(name, originals, tmp_path):
    """
    Cut anywhere but at the end of a line.

    What is left either ends with a whole number, of which at most the last digits of SWAN's last
    whole number can be missing, and then says that its last line has no end; or it is refused.
    """
    shutil.copytree(originals, tmp_path, dirs_exist_ok=True)
    path = tmp_path / name
    opened = next(path.parent.glob(f"{path.stem}.data_spec"), path)
    data = path.read_bytes()
    whole = readers.open(opened)
    lengths = random.Random(name).sample(range(1, len(data)), 40) + list(
        range(len(data) - 12, len(data))
    )
    kept = 0
    for length in lengths:
        if data[length - 1 : length] != b"\n":
            path.write_bytes(data[:length])
            try:
                part = readers.open(opened)
            except ReaderError:
                continue
            kept += 1
            assert path.name in part.attrs["unterminated"]
            first, second = (
                d["ef" if "ef" in d else "efth"].values.ravel()
                for d in (whole.sel(time=part.time), part)
            )
            same = (first == second) | (np.isnan(first) & np.isnan(second))
            assert np.count_nonzero(~same) <= (1 if name == "swanfile.spec" else 0)
    assert kept >= 1


@pytest.mark.parametrize(
    "name", ["44004w2000.txt", "41010.data_spec", "41010.swr2", "swanfile.spec"]
)
def test_a_file_without_its_final_newline_is_the_same_file(name, originals, tmp_path):
    """Editors and mail leave it off; the dataset is the same, and says so."""
    shutil.copytree(originals, tmp_path, dirs_exist_ok=True)
    path = tmp_path / name
    opened = next(path.parent.glob(f"{path.stem}.data_spec"), path)
    whole = readers.open(opened)
    path.write_text(path.read_text().rstrip("\n"))
    part = readers.open(opened)
    assert name in part.attrs.pop("unterminated")
    assert part.identical(whole)


@pytest.mark.parametrize("name", ["ww3file.nc", "wavespectra.nc", "era5.nc"])
def test_a_cut_netcdf_file_is_always_refused(name, originals, tmp_path):
    """At any length; the last bytes of netCDF 3 may be padding, so not within four of the end."""
    data = (originals / name).read_bytes()
    for length in random.Random(name).sample(range(1, len(data) - 4), 40):
        (tmp_path / name).write_bytes(data[:length])
        with pytest.raises(ReaderError):
            readers.open(tmp_path / name)
