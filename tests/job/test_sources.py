"""Jobs of spectrum files and of bakes, records by date."""

import numpy as np
import pytest

import fftocean as fo
from fftocean.job.sources import is_spectrum_file, spectrum_job
from fftocean.readers import nearest_time

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.SeaWarning")


@pytest.fixture
def buoy(tmp_path):
    """Return a spectrum file of three hours, of two partly different seas."""
    path = tmp_path / "buoy.nc"
    freq, direction = np.linspace(0.05, 0.4, 36), np.arange(0.0, 360.0, 10.0)
    spread = np.cos(np.radians((direction - 270.0) / 2.0)) ** 8
    shape = np.exp(-(((freq - 0.1) / 0.02) ** 2))
    density = np.stack([a * np.outer(shape, spread) for a in (0.1, 0.2, 0.4)])
    import xarray

    times = np.array(["2020-06-03T11:00", "2020-06-03T12:00", "2020-06-03T13:00"], "datetime64[ns]")
    dataset = xarray.Dataset(
        {"efth": (("time", "freq", "dir"), density)},
        coords={"time": times, "freq": freq, "dir": direction},
    )
    dataset["efth"].attrs["units"] = "m2 s deg-1"
    dataset.to_netcdf(path)
    return path


def test_a_spectrum_file_is_a_job_with_a_tile_of_its_own(buoy):
    assert is_spectrum_file(buoy)
    job = spectrum_job(buoy)
    sea = job.sea()
    length = 9.80665 * sea.tp**2 / (2.0 * np.pi)
    assert 6.0 * length <= job.settings["ocean.size"] < 6.0 * length * 1.1
    assert 4.0 * sea.tp <= job.settings["ocean.loop"] < 4.0 * sea.tp * 1.1
    assert job.settings["bake.frames"] == np.ceil(15.0 * job.settings["ocean.loop"])


def test_a_record_is_named_by_number_or_by_date(buoy):
    first, last = (spectrum_job(buoy, time=time).sea().hs for time in (0, -1))
    assert last == pytest.approx(2.0 * first)
    for date in ("2020-06-03T13:00", "2020-06-03 12:40", "2020-06-03T15:59Z"):
        assert spectrum_job(buoy, time=date).sea().hs == pytest.approx(last)


@pytest.mark.parametrize(
    ("time", "message"),
    [
        ("2020-06-03T16:01", "the file has 3, from 2020-06-03T11:00 to 2020-06-03T13:00"),
        ("noon", "a number from 0 or a date such as 2020-06-03T12:40, got 'noon'"),
        ("", "a number from 0 or a date"),
        (3, "time"),
    ],
)
def test_an_absent_record_is_refused(buoy, time, message):
    with pytest.raises(fo.ParameterError, match=message):
        spectrum_job(buoy, time=time)


def test_a_dataset_without_dates_has_numbers_only(buoy):
    from fftocean import readers

    dataset = readers.open(buoy).drop_vars("time")
    with pytest.raises(fo.ReaderError, match="the file has no dates"):
        nearest_time(dataset, "2020-06-03")
