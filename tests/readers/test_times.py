"""Records by their date: the nearest one within three hours, and no other."""

import numpy as np
import pytest
from builders import lazy

from fftocean.errors import ParameterError, ReaderError
from fftocean.readers import nearest_time

xr = lazy("xarray")
HOURS = np.datetime64("2020-06-03T00:00", "ns") + np.array([0, 6, 12, 30]) * np.timedelta64(1, "h")


def dataset(times):
    return xr.Dataset(coords={"time": times})


@pytest.mark.parametrize(
    ("when", "index"),
    [
        ("2020-06-03", 0),
        ("2020-06-03T02:59", 0),
        ("2020-06-03T03:01", 1),
        ("2020-06-03 08:00Z", 1),
        ("2020-06-03T15:00", 2),
        ("2020-06-04T09:00", 3),
    ],
)
def test_the_nearest_record_is_found(when, index):
    assert nearest_time(dataset(HOURS), when) == index
    assert nearest_time(dataset(HOURS[::-1]), when) == 3 - index


@pytest.mark.parametrize("when", ["2020-06-03T15:01", "2020-06-04", "2020-06-02", "1970-01-01"])
def test_no_record_within_three_hours_is_an_error_that_names_the_range(when):
    with pytest.raises(
        ReaderError, match=r"within three hours .* from 2020-06-03T00:00 to 2020-06-04T06:00"
    ):
        nearest_time(dataset(HOURS), when)


def test_a_record_without_a_time_is_never_the_nearest():
    times = np.array(["NaT", "2020-06-03T06:00", "NaT"], dtype="datetime64[ns]")
    assert nearest_time(dataset(times), "2020-06-03T06:00") == 1
    with pytest.raises(ReaderError, match="the file has 1, from 2020-06-03T06:00"):
        nearest_time(dataset(times), "2021-01-01")
    with pytest.raises(ReaderError, match="the file has no dates"):
        nearest_time(dataset(times[:1]), "2020-06-03")


def test_one_record_may_be_a_single_value():
    assert nearest_time(dataset(HOURS[1]), "2020-06-03T05:00") == 0


@pytest.mark.parametrize("when", ["", "yesterday", "2020-13-01", "NaT", "12"])
def test_what_is_no_date_is_refused(when):
    with pytest.raises(ReaderError, match=r"time must be|within three hours"):
        nearest_time(dataset(HOURS), when)


def test_a_dataset_without_dates_is_refused():
    with pytest.raises(ReaderError, match="the file has no dates"):
        nearest_time(xr.Dataset(coords={"time": [0.0, 1.0]}), "2020-06-03")
    with pytest.raises(ReaderError, match="the file has no dates"):
        nearest_time(xr.Dataset(), "2020-06-03")
    with pytest.raises(ParameterError, match="dataset must be a Dataset"):
        nearest_time([1, 2], "2020-06-03")
