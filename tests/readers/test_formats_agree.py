"""One sea from every format, and a sea from the west that travels to +x."""

import numpy as np
import pytest
from builders import lazy
from spectrum_files import (
    FREQUENCY,
    TO,
    era5,
    packed,
    sea,
    write_era5,
    write_ndbc,
    write_swan,
    write_wavespectra,
    write_ww3,
    ww3,
)

from fftocean import readers
from fftocean.ocean import Ocean

xr = lazy("xarray")

OMEGA = 2.0 * np.pi * np.geomspace(0.03, 0.6, 97)
THETA = np.linspace(-np.pi, np.pi, 101)


def density(dataset, **which):
    return readers.sea_from_spectrum(dataset, **which).density(OMEGA[:, None], THETA)


WRITERS = {
    "wavespectra": (write_wavespectra, {}),
    "ww3": (write_ww3, {}),
    "era5 by number": (write_era5, {"site": 1}),
    "era5 in Hz": (lambda path, specified: write_era5(path, specified, numbers=False), {"site": 1}),
    "swan nautical": (write_swan, {}),
    "swan cartesian": (lambda path, specified: write_swan(path, specified, cartesian=True), {}),
}


@pytest.mark.parametrize("name", WRITERS)
def test_the_numbers_are_those_specified(name, tmp_path):
    """
    Each value, found again by the direction it comes FROM and its frequency: units, orders and
    conventions all undone.
    """
    write, which = WRITERS[name]
    specified = sea(toward=200.0)
    got = readers.open(write(tmp_path / "file", specified), **which)
    assert got.efth.dims == ("time", "freq", "dir")
    for time in range(2):
        for i in (0, 12, 29):
            for j in (0, 5, 23):
                value = got.efth.isel(time=time).sel(
                    freq=FREQUENCY[i], dir=(TO[j] + 180.0) % 360.0, method="nearest"
                )
                # log10 and 10** lose 1e-15 times ln(10) times 9 figures; SWAN's nine figures 1e-9
                # of the largest
                assert float(value) == pytest.approx(
                    specified.density[time, i, j], rel=1e-12, abs=1e-9 * specified.density.max()
                )


@pytest.mark.parametrize("name", WRITERS)
def test_the_same_sea_in_every_format(name, tmp_path):
    """
    S(omega) D(omega, theta) of the `Sea` agrees to 1e-6 of its largest value (SWAN's nine figures;
    the others agree to round-off).
    """
    specified = sea(toward=70.0)
    write, which = WRITERS[name]
    got = density(readers.open(write(tmp_path / "file", specified), **which), time=1)
    # Not read from anywhere: the layout itself, made by hand.
    made = xr.Dataset(
        {"efth": (("dir", "freq"), specified.density[1].T)},
        {"freq": FREQUENCY, "dir": (TO + 180.0) % 360.0},
    )
    want = density(made)
    assert np.max(np.abs(got - want)) <= 1e-6 * np.max(want)


def test_the_same_surface_from_every_format(tmp_path):
    """
    wavespectra, WAVEWATCH III and ERA5 files of one sea realise one surface: heights within 1e-6 of
    the largest.
    """
    specified = sea(toward=70.0)
    heights = []
    for name in ("wavespectra", "ww3", "era5 in Hz"):
        write, which = WRITERS[name]
        got = readers.sea_from_spectrum(
            readers.open(write(tmp_path / name.replace(" ", "_"), specified), **which),
            time=1,
            depth=np.inf,
        )  # only some files know a depth
        heights.append(
            Ocean(got, n=64, size=900.0, seed=5, dtype="float64").frame(3.0, ("height",)).height
        )
    assert np.std(heights[0]) > 0.1
    for height in heights[1:]:
        assert np.max(np.abs(height - heights[0])) <= 1e-6 * np.max(np.abs(heights[0]))


@pytest.mark.parametrize("name", [*WRITERS, "ndbc"])
def test_a_sea_from_the_west_travels_to_plus_x(name, tmp_path):
    """
    A sea from 270 degrees goes toward 90, direction 0 here. Nearly all energy goes forward, hardly
    any back.
    """
    if name == "ndbc":
        got = readers.sea_from_spectrum(readers.open(write_ndbc(tmp_path)))
    else:
        write, which = WRITERS[name]
        got = readers.sea_from_spectrum(
            readers.open(write(tmp_path / "file", sea(toward=90.0)), **which), time=1
        )
    assert got.systems[0].direction == pytest.approx(0.0, abs=1e-6)
    theta = np.linspace(-np.pi, np.pi, 721)
    energy = got.density(2.0 * np.pi * 0.1, theta)
    assert np.sum(energy * np.cos(theta)) > 0.85 * np.sum(energy)
    assert theta[np.argmax(energy)] == pytest.approx(
        0.0, abs=np.radians(7.5)
    )  # bins stand 7.5 degrees off the west


@pytest.mark.parametrize(
    ("toward", "ours"), [(0.0, 90.0), (90.0, 0.0), (180.0, -90.0), (120.0, -30.0)]
)
def test_compass_directions_become_ours(toward, ours):
    """
    TOWARD, clockwise from north -> toward, counter-clockwise from east: 90 - toward. Bins straddle
    each of these evenly.
    """
    assert readers.sea_from_spectrum(ww3(sea(toward=toward))).systems[0].direction == pytest.approx(
        ours, abs=1e-6
    )


def test_any_order_of_dimensions_and_either_way_round(tmp_path):
    """Dimensions are found by name; frequencies and directions may descend."""
    data = ww3(sea(toward=70.0))
    want = density(data)
    turned = data.transpose("direction", "frequency", "station", "time").isel(
        frequency=slice(None, None, -1), direction=slice(None, None, -1)
    )
    assert np.array_equal(density(turned), want)
    turned.to_netcdf(tmp_path / "turned.nc", engine="scipy")
    assert np.array_equal(density(readers.open(tmp_path / "turned.nc")), want)


def test_directions_in_radians_and_from_where_they_say_so():
    """The attribute decides: radians, and FROM in a file of WAVEWATCH's names."""
    data = ww3(sea(toward=70.0))
    want = density(data)
    radians = data.assign_coords(
        direction=(
            "direction",
            np.radians(data.direction.values),
            data.direction.attrs | {"units": "radian"},
        )
    )
    assert density(radians) == pytest.approx(want, rel=1e-6, abs=1e-12)
    came = {"standard_name": "sea_surface_wave_from_direction", "units": "degree"}
    turned = data.assign_coords(
        direction=("direction", (data.direction.values + 180.0) % 360.0, came)
    )
    assert np.array_equal(density(turned), want)


@pytest.mark.parametrize(
    ("unit", "per_radian"),
    [
        ("m2 s rad-1", 1),
        ("m**2 s radian**-1", 1),
        ("m2/Hz/rad", 1),
        ("m^2/(Hz radian)", 1),
        ("m2 s degree-1", 0),
        ("m^{2}.s.degree^{-1}", 0),
    ],
)
def test_units_of_the_density_are_read_not_assumed(unit, per_radian):
    data = ww3(sea(toward=70.0))
    want = density(data)
    data["efth"] = data.efth * (1.0 if per_radian else np.pi / 180.0)
    data.efth.attrs["units"] = unit
    assert density(data) == pytest.approx(want, rel=1e-12)


def test_packed_integers_are_unpacked(tmp_path):
    """
    int16 with scale_factor and add_offset, as the Climate Data Store packs: half a step of log10
    off in S, as much in D.
    """
    data = era5(sea(toward=70.0))
    packing = {
        "dtype": "int16",
        "scale_factor": 2e-4,
        "add_offset": -4.0,
        "_FillValue": np.int16(-32767),
    }
    data.to_netcdf(tmp_path / "packed.nc", engine="scipy", encoding={"d2fd": packing})
    got, want = density(readers.open(tmp_path / "packed.nc", site=1)), density(data, site=1)
    assert got == pytest.approx(want, rel=2.0 * 1e-4 * np.log(10.0), abs=1e-12 * want.max())


@pytest.mark.parametrize("name", ["wavespectra", "ww3", "swan nautical"])
def test_gzip_makes_no_difference(name, tmp_path):
    plain = WRITERS[name][0](tmp_path / "file", sea())
    assert readers.open(packed(plain)).identical(readers.open(plain).assign_attrs(source="file.gz"))


def test_a_packed_buoy_finds_its_packed_siblings(tmp_path):
    plain = readers.open(write_ndbc(tmp_path))
    for path in sorted(tmp_path.iterdir()):
        packed(path)
        path.unlink()
    assert readers.open(tmp_path / "12345.data_spec.gz").identical(
        plain.assign_attrs(source="12345.data_spec.gz")
    )


@pytest.mark.parametrize("engine", ["scipy", "h5netcdf"])
def test_our_own_layout_is_read_back(engine, tmp_path):
    first = readers.open(write_ww3(tmp_path / "ww3.nc", sea()))
    first.to_netcdf(tmp_path / "own.nc", engine=engine)
    again = readers.open(tmp_path / "own.nc")
    assert again.drop_attrs(deep=False).identical(first.drop_attrs(deep=False))
