"""
Labelled data: the frames' own bits, CF's own words, files that give back every bit or say so;
spectra by wavespectra's sums.
"""

import dataclasses
import math
import subprocess
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

import fftocean as fo
from fftocean import host, science
from fftocean.errors import OutputError, ParameterError, SeaWarning
from fftocean.fields import FIELDS
from fftocean.statistics import specified

xr = pytest.importorskip("xarray", reason="the extra `science` is not installed")

ROOT = Path(__file__).resolve().parents[1]
ALL = (*FIELDS, "normal", "jacobian")
TIMES = [-2.0, 0.0, 1.0 / 3.0, 1e7]
SWELL = fo.WaveSystem(
    spectrum=fo.JONSWAP.from_sea_state(hs=1.0, tp=9.0),
    spreading=fo.CosinePower(s=12.0),
    direction=160.0,
)
WIND_SEA = fo.WaveSystem(
    spectrum=fo.JONSWAP.from_sea_state(hs=2.0, tp=5.0), spreading=fo.CosineSquared(), direction=20.0
)
SEA = fo.Sea(WIND_SEA, SWELL, depth=25.0)


def of_sea(**arguments):
    return fo.Ocean(
        SEA,
        **{
            "n": (16, 12),
            "size": (120.0, 90.0),
            "seed": 5,
            "loop": 60.0,
            "dtype": "float64",
            **arguments,
        },
    )


def ocean(**arguments):
    """
    The same tile with forty waves of no sea in particular: measuring what was ordered takes a
    second, which few tests need.
    """
    draw = np.random.default_rng(3)
    modes = [
        (mx, my, draw.uniform(0.01, 0.2), draw.uniform(0.0, 6.0))
        for mx, my in draw.integers(-5, 6, (40, 2)).tolist()
        if mx or my
    ]
    arguments = {
        "n": (16, 12),
        "size": (120.0, 90.0),
        "depth": 25.0,
        "loop": 60.0,
        "dtype": "float64",
        **arguments,
    }
    return fo.Ocean.from_modes(modes, **arguments)


def waves(*modes, **arguments):
    return fo.Ocean.from_modes(modes, **{"n": 32, "size": 200.0, "dtype": "float64", **arguments})


# Frames


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("loop", [None, 60.0])
def test_every_number_is_the_frame_s(dtype, loop):
    o = ocean(dtype=dtype, loop=loop)
    data = science.to_xarray(o, iter(TIMES), maps=ALL)
    assert tuple(data.data_vars) == ALL
    for i, t in enumerate(TIMES):
        frame = o.frame(t, ALL)
        for name in ALL:
            assert data[name].dtype == dtype
            assert data[name].dims == ("time", "y", "x", "component")[: data[name].ndim]
            assert data[name].values[i].tobytes() == frame[name].tobytes()
    assert data["normal"].shape == (4, 12, 16, 3)
    np.testing.assert_array_equal(data["time"], TIMES)
    np.testing.assert_array_equal(data["x"], o.grid.x)
    np.testing.assert_array_equal(data["y"], o.grid.y)


def test_maps_by_one_name_or_several():
    o = ocean()
    assert tuple(science.to_xarray(o, [0.0]).data_vars) == ("height",)
    assert tuple(science.to_xarray(o, [0.0], maps="jacobian").data_vars) == ("jacobian",)
    assert tuple(science.to_xarray(o, [0.0], maps=["slope_x", "height", "slope_x"]).data_vars) == (
        "slope_x",
        "height",
    )
    for wrong in ((), "heights", ("height", "foam"), ("height", 3), None, 3, [["height"]]):
        with pytest.raises(
            ParameterError, match=r"maps must be one or more of height, .*jacobian, got"
        ):
            science.to_xarray(o, [0.0], maps=wrong)


@pytest.mark.parametrize(
    ("times", "says"),
    [
        ([], "times must be 1 to 1000 numbers, got 0"),
        (3.0, "times must be a list of numbers between -1e.12 and 1e.12 s, got 3.0"),
        (None, "times must be a list of numbers .*, got None"),
        ("12", "times must be a list of numbers .*'12'"),
        ([0.0, math.nan], r"times\[1\] must be between .* s, got nan"),
        ([0.0, 1e13], r"times\[1\] must be between"),
        ([True], r"times\[0\] must be a number"),
        ([0.0, 2.0, 2.0, 3.0], "times must be strictly ascending or descending, got 2 s after 2 s"),
        ([0.0, 2.0, 1.0, 3.0], "ascending or descending, got 1 s after 2 s"),
        ([3.0, 1.0, 2.0], "ascending or descending, got 2 s after 1 s"),
        (np.array(["2020-01-01"], "datetime64[s]"), "times must be numbers .*datetime64"),
        (np.zeros((2, 2)), r"(?s)times must be a list of numbers .* of shape \(2, 2\)"),
        ((0.001 * i for i in range(10**9)), "times must be 1 to 1000 numbers, got more"),
    ],
    ids=range(13),
)
def test_invalid_times_are_refused(times, says, monkeypatch):
    monkeypatch.setattr(science, "_MOST", 1000)
    with pytest.raises(ParameterError, match=says):
        science.to_xarray(ocean(), times)


def test_valid_times_become_float64():
    for times in (
        [5, 3, 1],
        range(3),
        np.float32([1, 2]),
        (0.0,),
        np.arange(3),
        xr.DataArray([1.0, 2.0]),
    ):
        data = science.to_xarray(ocean(), times)
        assert data["time"].dtype == "float64"
        np.testing.assert_array_equal(data["time"], np.asarray(times, float))


def test_other_types_than_an_ocean_are_refused():
    for make in (lambda: science.to_xarray(SEA, [0.0]), lambda: science.realised_spectrum("ocean")):
        with pytest.raises(ParameterError, match="ocean must be an Ocean, got"):
            make()


def test_memory_is_refused_before_anything_is_computed(monkeypatch):
    """
    16 x 12 x 5 times in float64, one map: 7.7 kB and a frame of work; a bit less than the estimate
    is too little.
    """
    o, asked = ocean(), []
    monkeypatch.setattr(
        science, "require_memory", lambda what, needed: asked.append((what, needed))
    )
    science.to_xarray(o, range(5))
    ((what, needed),) = asked
    assert what == "5 times of 16 x 12 samples of height"
    monkeypatch.setattr(science, "require_memory", host.require_memory)
    monkeypatch.setattr(host, "available_memory", lambda: 0.999 * needed)
    with monkeypatch.context() as patch:
        patch.setattr(fo.Ocean, "frame", lambda *_, **__: pytest.fail("computed"))
        with pytest.raises(
            ParameterError,
            match=r"5 times of 16 x 12 samples of height needs about .* GiB of memory, but only",
        ):
            science.to_xarray(o, range(5))
        with pytest.raises(
            ParameterError, match=r"a spectrum of 1000 frequencies by 720 directions needs about"
        ):
            science.realised_spectrum(
                o, freq=np.linspace(0.01, 2.0, 1000), dir=np.arange(0.0, 360.0, 0.5)
            )
    data = science.to_xarray(o, range(4))
    monkeypatch.setattr(host, "available_memory", lambda: 10.0)
    with pytest.raises(ParameterError, match=r"encoding x.nc needs about"):
        science.write(data, "x.nc")


@pytest.mark.parametrize("maps", [("height",), ("normal", "height"), ALL])
def test_the_estimate_of_memory_is_that_used(maps, monkeypatch):
    """
    Peak of what Python allocates: never above the estimate (5 % for small change), and no less than
    the result itself.
    """
    o, asked = ocean(n=128), []
    monkeypatch.setattr(science, "require_memory", lambda _, needed: asked.append(needed))
    monkeypatch.setattr(
        science, "_attributes", lambda _: {}
    )  # measured before the arrays are made, and gone by then
    science.to_xarray(o, range(2), maps)
    tracemalloc.start()
    try:
        data = science.to_xarray(o, range(40), maps)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert data.nbytes <= peak <= 1.05 * asked[-1]
    assert asked[-1] < 1.5 * data.nbytes  # and it does not cry wolf


# What stands beside the numbers

# Names and canonical units, copied from the CF Standard Name Table, version 93.
CF_TABLE = {
    "sea_surface_height_above_mean_sea_level": "m",
    "surface_sea_water_x_velocity": "m s-1",
    "surface_sea_water_y_velocity": "m s-1",
    "upward_sea_water_velocity": "m s-1",
    "projection_x_coordinate": "m",
    "projection_y_coordinate": "m",
    "sea_surface_wave_directional_variance_spectral_density": "m2 s rad-1",
    "wave_frequency": "s-1",
    "sea_surface_wave_from_direction": "degree",
    "sea_floor_depth_below_sea_surface": "m",
}
SAME = {
    "m/s": "m s-1",
    "Hz": "s-1",
    "m2 s degree-1": "m2 s rad-1",
}  # physically equivalent, as CF asks


def test_attributes_are_those_of_cf():
    frames, spectrum = (
        science.to_xarray(ocean(), [0.0, 1.0], maps=ALL),
        science.realised_spectrum(ocean()),
    )
    for data in (frames, spectrum):
        assert data.attrs["Conventions"] == "CF-1.11"
        for name, variable in data.variables.items():
            assert variable.attrs["long_name"]
            units, word = variable.attrs.get("units"), variable.attrs.get("standard_name")
            assert (units is None) == (name == "component")
            if word is not None:
                assert SAME.get(units, units) == CF_TABLE[word]
    assert frames["height"].attrs["standard_name"] == "sea_surface_height_above_mean_sea_level"
    assert {name: frames[name].attrs["units"] for name in FIELDS} == {
        name: field.unit for name, field in FIELDS.items()
    }
    assert (frames["x"].attrs["axis"], frames["y"].attrs["axis"]) == ("X", "Y")
    component = frames["component"]
    meanings = component.attrs["flag_meanings"].split()
    assert (meanings, component.attrs["flag_values"].tolist()) == (
        ["x", "y", "z"],
        component.values.tolist(),
    )
    assert component.attrs["flag_values"].dtype == component.dtype  # CF 3.5


def test_time_is_not_a_calendar_date():
    """
    Units with `since`, axis T or the standard name would each ask for an epoch (CF 4.4); `seconds`
    would be read as a timedelta.
    """
    assert science.to_xarray(ocean(), [0.0])["time"].attrs == {
        "units": "s",
        "long_name": "time on the ocean's own clock",
    }


def test_attributes_hold_parameters_and_statistics():
    o = of_sea(choppiness=0.7, amplitudes="fixed")
    told, s = science.to_xarray(o, [0.0]).attrs, fo.measure(o)
    expected = {
        "n": [16, 12],
        "size": [120.0, 90.0],
        "depth": 25.0,
        "surface_tension": 0.0,
        "loop": 60.0,
        "choppiness": 0.7,
        "amplitudes": "fixed",
        "dtype": "float64",
        "backend": o.backend,
        "source": f"fftocean {fo.__version__}",
        "sea_system_1": repr(WIND_SEA),
        "sea_system_2": repr(SWELL),
    }
    assert {key: told[key] for key in expected} == expected
    for key in ("m0", "hs", "tp", "mean_direction", "spread", "energy_above"):
        assert told[f"measured_{key}"] == getattr(s, key)
    for key, value in dataclasses.asdict(specified(SEA)).items():
        assert told[f"ordered_{key}"] == value
    assert told["loop_period"] == 60.0
    assert told["loop_rms"] == s.loop.rms
    assert told["seed"] == str(o.seed)
    assert (
        "seed" not in science.to_xarray(waves((1, 2, 0.5, 0.0)), [0.0]).attrs
    )  # given waves have none
    assert science.to_xarray(of_sea(seed=2**64 - 1), [0.0]).attrs["seed"] == "18446744073709551615"


def test_infinities_and_missing_values_are_attributes_of_any_format():
    """
    Infinity is a word that `float` reads, None is left out, and nothing else than str, int, float
    and lists of them is left.
    """
    deep = science.to_xarray(waves((1, 2, 0.5, 0.0)), [0.0]).attrs
    assert float(deep["depth"]) == math.inf
    assert not {"loop", "loop_period", "ordered_hs", "sea_system_1"} & deep.keys()
    for told in (deep, science.realised_spectrum(of_sea()).attrs):
        for value in told.values():
            for item in value if isinstance(value, list) else [value]:
                assert type(item) in (str, int, float)
                assert isinstance(item, str) or math.isfinite(item)


# Files


@pytest.fixture(
    scope="module", params=["frames in float32", "frames in float64", "flat", "spectrum of a sea"]
)
def dataset(request):
    if request.param == "spectrum of a sea":
        return science.realised_spectrum(of_sea())
    if request.param == "flat":
        return science.to_xarray(fo.Ocean(fo.Sea(), n=4, size=10.0), [0.0, 1.0], maps=ALL)
    return science.to_xarray(ocean(dtype=request.param[-7:]), TIMES, maps=ALL)


def assert_same_bits(read, written):
    xr.testing.assert_identical(read, written)  # values, dimensions, attributes
    for name, variable in written.variables.items():
        values = read[name].values
        assert (
            values.dtype == variable.dtype
        )  # netCDF 3 is big-endian on the disk: equal, but for the order of bytes
        assert (
            np.ascontiguousarray(values, variable.dtype).tobytes()
            == np.ascontiguousarray(variable.values).tobytes()
        )


def test_netcdf_gives_back_every_bit(dataset, tmp_path):
    """Read as anyone would, without options, and without a warning."""
    pytest.importorskip("h5netcdf")
    science.write(dataset, tmp_path / "a.nc")
    with xr.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as read:
        assert_same_bits(read.load(), dataset)
        assert not any("_FillValue" in read[name].encoding for name in dataset.coords)  # CF 2.5.1
        assert all(
            read[name].encoding["fletcher32"] for name, v in dataset.variables.items() if v.ndim
        )
    assert [p.name for p in tmp_path.iterdir()] == ["a.nc"]


def test_zarr_gives_back_every_bit(dataset, tmp_path):
    zarr = pytest.importorskip("zarr")
    science.write(dataset, tmp_path / "a.zarr")
    with xr.open_dataset(tmp_path / "a.zarr", engine="zarr") as read:
        assert_same_bits(read.load(), dataset)
    with xr.open_zarr(tmp_path / "a.zarr", chunks=None) as read:
        assert_same_bits(read.load(), dataset)
    group = zarr.open_group(tmp_path / "a.zarr", mode="r")
    assert group.metadata.zarr_format == 3
    for name, array in group.arrays():
        assert [type(codec).__name__ for codec in array.metadata.codecs][-1] == "Crc32cCodec", name
    assert [p.name for p in tmp_path.iterdir()] == ["a.zarr"]


def test_netcdf_3_gives_back_every_bit_too(dataset, tmp_path):
    dataset.to_netcdf(tmp_path / "a.nc", engine="scipy")
    with xr.open_dataset(tmp_path / "a.nc", engine="scipy") as read:
        read = read.load()
    for name in read.variables:
        read[name] = read[name].astype(read[name].dtype.newbyteorder("="))
    assert_same_bits(read, dataset)


@pytest.mark.parametrize("suffix", [".nc", ".zarr"])
def test_a_flipped_bit_is_noticed(suffix, tmp_path):
    """
    One bit of one sample of `height`, found by its bytes, uncompressed: reading raises, in whatever
    words the library has.
    """
    pytest.importorskip("h5netcdf" if suffix == ".nc" else "zarr")
    data, place = science.to_xarray(ocean(), TIMES), tmp_path / f"a{suffix}"
    science.write(data, place)
    needle = data["height"].values[2].tobytes()
    files = [
        p
        for p in ([place] if place.is_file() else place.rglob("*"))
        if p.is_file() and needle in p.read_bytes()
    ]
    (file,) = files
    content = bytearray(file.read_bytes())
    content[content.index(needle) + 13] ^= 0x10
    file.write_bytes(content)
    with (
        pytest.raises((OSError, ValueError), match=r"(?i)checksum|filter"),
        xr.open_dataset(place, engine="h5netcdf" if suffix == ".nc" else "zarr") as read,
    ):
        read["height"].load()


def test_a_missing_chunk_is_no_flat_sea(tmp_path):
    pytest.importorskip("zarr")
    data = science.to_xarray(ocean(), TIMES, maps=("height", "normal"))
    science.write(data, tmp_path / "a.zarr")
    (tmp_path / "a.zarr/height/c/2/0/0").unlink()
    (tmp_path / "a.zarr/x/c/0").unlink()
    (tmp_path / "a.zarr/component/c/0").unlink()
    with xr.open_dataset(tmp_path / "a.zarr", engine="zarr") as read:
        assert np.isnan(read["height"][2]).all()
        assert np.isnan(read["x"]).all()
        assert (read["component"] == -128).all()
        np.testing.assert_array_equal(
            read["height"][[0, 1, 3]].values, data["height"][[0, 1, 3]].values
        )


def test_long_frames_are_cut_into_chunks_that_libraries_can_hold():
    """
    64 MiB at most: 16384 x 16384 in float64 would be 2 GiB, which is the most that codecs take.
    """
    wide = np.broadcast_to(np.float64(0.0), (2, 16384, 16384))
    encoding = science._encoding(
        xr.Dataset({"a": (("time", "y", "x"), wide)}), "chunks", lambda _: {}
    )
    assert encoding["a"]["chunks"] == (1, 512, 16384)
    assert 512 * 16384 * 8 == 2**26


@pytest.mark.parametrize("name", ["a.nc4", "a", "a.csv", "a.zarr.zip", "a.NC", ""])
def test_other_suffixes_are_refused(name, tmp_path):
    with pytest.raises(
        ParameterError, match=r"the name must end in \.nc \(netCDF\) or \.zarr, got"
    ):
        science.write(science.to_xarray(ocean(), [0.0]), tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_only_a_dataset_is_written(tmp_path):
    with pytest.raises(ParameterError, match=r"must be an xarray.Dataset, got DataArray"):
        science.write(science.to_xarray(ocean(), [0.0])["height"], tmp_path / "a.nc")


@pytest.mark.parametrize("suffix", [".nc", ".zarr"])
@pytest.mark.process
def test_a_full_disk_leaves_what_was_there(suffix, tmp_path):
    """
    A limit on the size of files stands in for a full disk, at every scale from the first byte to
    the last. The limit is the whole process's and HDF5 would take it down, so it is a process of
    its own.
    """
    pytest.importorskip("resource")
    pytest.importorskip("h5netcdf" if suffix == ".nc" else "zarr")
    script = f"""
import resource, sys
from pathlib import Path
import numpy as np, xarray as xr
from fftocean import host, science
from fftocean.errors import OutputError
def flat(z):
    height = (("time", "y", "x"), np.full((2, 32, 32), z))
    return xr.Dataset({{"height": height}}, {{"time": [0.0, 1.0]}})
first, second = flat(1.0), flat(2.0)
place = Path({str(tmp_path / ("a" + suffix))!r})
science.write(first, place.with_name("other{suffix}"))
if {suffix == ".nc"}:
    science.write(first, place)
before = sorted(p.name for p in place.parent.iterdir())
for most in (0, 1, 100, 1000, 4000):
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, resource.RLIM_INFINITY))
    try:
        science.write(second, place)
    except OutputError as error:
        assert str(place) in str(error), error
    else:
        sys.exit(f"no complaint with at most {{most}} bytes")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    assert sorted(p.name for p in place.parent.iterdir()) == before, before
if {suffix == ".nc"}:
    assert place.read_bytes() == place.with_name("other.nc").read_bytes()
science.write(second, place)
"""
    done = subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
        cwd=ROOT,
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_a_file_is_replaced_and_a_store_is_not(tmp_path):
    pytest.importorskip("h5netcdf")
    pytest.importorskip("zarr")
    first, second = (science.to_xarray(ocean(), [t]) for t in (0.0, 1.0))
    for name in ("a.nc", "a.zarr"):
        science.write(first, tmp_path / name)
    science.write(second, tmp_path / "a.nc")
    with pytest.raises(OutputError, match=r"a\.zarr exists already"):
        science.write(second, tmp_path / "a.zarr")
    for name, expected, engine in (("a.nc", second, "h5netcdf"), ("a.zarr", first, "zarr")):
        with xr.open_dataset(tmp_path / name, engine=engine) as read:
            xr.testing.assert_identical(read.load(), expected)
    for name in ("b.nc", "b.zarr"):
        with pytest.raises(OutputError, match="could not be written: No such file"):
            science.write(first, tmp_path / "nowhere" / name)


@pytest.mark.parametrize("package", ["xarray", "h5netcdf", "zarr"])
def test_a_missing_package_is_named_with_the_extra(package, tmp_path, monkeypatch):
    o = ocean()
    data = science.to_xarray(o, [0.0])
    for module in [name for name in sys.modules if name.partition(".")[0] == package]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, package, None)
    needs = {
        "xarray": lambda: science.realised_spectrum(o),
        "h5netcdf": lambda: science.write(data, tmp_path / "a.nc"),
        "zarr": lambda: science.write(data, tmp_path / "a.zarr"),
    }
    hint = r"in a checkout of fftocean, pip install '\.\[science\]'"
    with pytest.raises(
        ParameterError, match=rf"{package} must be installed for labelled data: {hint}"
    ):
        needs[package]()
    assert not list(tmp_path.iterdir())


def test_the_module_imports_without_the_extra():
    """
    Importing fftocean.science loads neither xarray nor zarr: it is done in a process that has
    loaded nothing else.
    """
    script = """
import sys
import fftocean.science
print(sorted({'xarray', 'zarr', 'h5netcdf', 'pandas', 'dask'} & sys.modules.keys()))
"""
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, cwd=ROOT
    )
    assert done.stdout.strip() == "[]"


# The realised spectrum: wavespectra's own integrals of it


@pytest.fixture(scope="module")
def spec():
    """The wavespectra package's accessor, on any dataset."""
    pytest.importorskip("wavespectra", reason="wavespectra is not installed")
    return lambda data: data.spec


def energies(o):
    m = o.modes()
    return m.amplitude**2 / 2, m.omega / (2 * np.pi), np.arctan2(m.ky, m.kx)


@pytest.mark.parametrize("loop", [None, 23.0])
@pytest.mark.parametrize(
    "bins",
    [
        {},
        {"dir": np.arange(7.5, 360.0, 15.0)},
        {"dir": np.arange(0.0, 360.0, 90.0), "freq": np.linspace(0.005, 1.0, 12)},
        {"freq": [0.01, 0.03, 0.05, 0.4, 0.41, 2.0]},
    ],
    ids=["default", "15 degrees", "coarse", "uneven"],
)
def test_energy_and_mean_frequency_are_exact(bins, loop, spec):
    """
    m0 and m1 by wavespectra's sums are those of the waves, whatever the bins: to the round-off of a
    sum of 200 numbers.
    """
    o = ocean(loop=loop)
    data = science.realised_spectrum(o, **bins)
    energy, hertz, _ = energies(o)
    s, m0 = spec(data), np.sum(energy)
    assert float((data.efth * s.df * s.dd).sum()) == pytest.approx(m0, rel=1e-14)
    assert float(s.momf(1)) == pytest.approx(np.sum(energy * hertz), rel=1e-13)
    assert float(s.tm01()) == pytest.approx(m0 / np.sum(energy * hertz), rel=1e-13)
    assert float(s.hs(tail=False)) == pytest.approx(4 * math.sqrt(m0), rel=1e-14)
    assert (data.efth >= 0.0).all()
    assert data.attrs["m0_outside"] == 0.0
    if not bins:  # the empty bin at the end keeps wavespectra from adding a tail
        assert float(s.hs()) == pytest.approx(4 * math.sqrt(m0), rel=1e-14)
        assert not data.efth[[0, -1]].any()


COMPASS = [
    ((3, 0), 270.0),
    ((0, 3), 180.0),
    ((-3, 0), 90.0),
    ((0, -3), 0.0),
    ((2, 2), 225.0),
    ((3, -4), 323.1301),
    ((-1, -9), 6.3402),
]


@pytest.mark.parametrize(("k", "comes_from"), COMPASS)
@pytest.mark.parametrize("bins", [5.0, 45.0])
def test_one_wave_has_its_own_direction(k, comes_from, bins, spec):
    """
    East-going waves come from 270, north-going ones from 180; also between bins, and across north,
    dm is the wave's own to round-off.
    """
    o = waves((*k, 0.8, 1.0), depth=20.0)
    s = spec(science.realised_spectrum(o, dir=np.arange(0.0, 360.0, bins)))
    exact = (270.0 - math.degrees(math.atan2(k[1], k[0]))) % 360.0
    assert exact == pytest.approx(comes_from, abs=1e-4)
    assert (float(s.dm()) - exact + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-9)
    assert float(s.hs()) == pytest.approx(4 * math.sqrt(0.32), rel=1e-14)
    assert float(s.tm01()) == pytest.approx(2 * math.pi / o.modes().omega[0], rel=1e-13)
    assert float(s.dspr()) <= bins / 2 + 1e-3  # half a bin, where it lies half way


def test_a_wave_on_a_bin_is_in_that_bin_alone():
    o = waves((2, 0, 1.0, 0.0))
    hertz = float(o.modes().omega[0] / (2 * np.pi))
    data = science.realised_spectrum(
        o, freq=[0.5 * hertz, hertz, 3.0 * hertz], dir=np.arange(0.0, 360.0, 10.0)
    )
    assert float(data.efth.sel(freq=hertz, dir=270.0)) == pytest.approx(
        0.5 / (1.25 * hertz * 10.0), rel=1e-13
    )
    assert np.count_nonzero(data.efth > 1e-13) == 1


def test_opposite_waves_are_told_apart():
    data = science.realised_spectrum(waves((2, 3, 1.0, 0.3), (-2, -3, 0.5, 2.0)))
    by_direction = data.efth.sum("freq")
    first = float(by_direction.sel(dir=slice(150.0, 250.0)).sum())
    assert first / float(by_direction.sum()) == pytest.approx(0.8, rel=1e-12)  # 1 : 0.25


def test_frequencies_are_those_at_which_the_waves_run(spec):
    """A loop of 3 s shifts this wave's period from 5.7 s to 3 s."""
    free, looped = (waves((4, 0, 1.0, 0.0), loop=loop) for loop in (None, 3.0))
    assert float(spec(science.realised_spectrum(free)).tm01()) == pytest.approx(
        math.sqrt(2 * math.pi * 50 / 9.80665), rel=1e-12
    )
    assert float(spec(science.realised_spectrum(looped)).tm01()) == pytest.approx(3.0, rel=1e-12)


def test_white_noise_comes_out_white():
    """
    Waves of equal energy, even in frequency and direction, on uneven bins: the same density
    everywhere, to the waves' own graininess.
    """
    f = np.array([0.05, 0.08, 0.1, 0.2, 0.22, 0.3])
    count = 20000
    hertz = (
        np.linspace(0.035, 0.34, count, endpoint=False) + 0.5 * 0.305 / count
    )  # from half a band below to half a band above
    turned = np.arange(count) * 137.50776405 % 360.0  # golden angles: evenly round the circle
    binned = science._distributed(
        np.full(count, 1.0), np.clip(hertz, f[0], f[-1]), turned, f, np.arange(0.0, 360.0, 30.0)
    )
    density = binned / (np.gradient(f)[:, None] * 30.0)
    np.testing.assert_allclose(
        density, count / (0.305 * 360.0), rtol=0.01
    )  # 80 waves in the smallest bin, evenly placed


@pytest.mark.parametrize(("direction", "s"), [(37.0, 8.0), (-90.0, 8.0), (200.0, 25.0)])
def test_wavespectra_finds_the_specified_sea(direction, s, spec, monkeypatch):
    """
    The ordered S(f) D(f, theta), sampled on the same bins, against one sea realised with amplitudes
    of fixed size, all by wavespectra: within 1 %. What differs in Hs are waves shorter than two
    samples (0.4 %); in the spread it is the width of the bins, which adds R h^2/6 to its square
    (hat functions leave 1 - h^2/12 of the resultant R = 1 - spread^2/2), and of the tile's own
    cells, 1/40 of k.
    """
    monkeypatch.setattr(
        science, "_attributes", lambda _: {}
    )  # measuring takes longer than all the rest
    system = fo.WaveSystem(
        spectrum=fo.JONSWAP.from_sea_state(hs=2.5, tp=8.0, gamma=3.3),
        spreading=fo.CosinePower(s=s),
        direction=direction,
    )
    sea = fo.Sea(system)
    realised = science.realised_spectrum(
        fo.Ocean(sea, n=256, size=1500.0, seed=3, amplitudes="fixed")
    )
    f, theta = realised.freq.values, np.radians(270.0 - realised.dir.values)
    density = 2 * np.pi * sea.density(2 * np.pi * f[:, None], theta) * np.pi / 180
    source = realised.assign(efth=(("freq", "dir"), density))
    ours, theirs = spec(realised), spec(source)
    assert float(theirs.hs(tail=False)) == pytest.approx(2.5, rel=1e-2)
    for name in ("hs", "dspr", "tp"):
        assert float(getattr(ours, name)()) == pytest.approx(
            float(getattr(theirs, name)()), rel=1e-2
        )
    spread, h = np.radians(float(theirs.dspr())), np.radians(5.0)
    widened = math.sqrt(spread**2 + (1 - spread**2 / 2) * h**2 / 6)
    assert float(ours.dspr()) == pytest.approx(
        np.degrees(widened), rel=3e-3
    )  # a cell's width in direction, 1/40, has 1/4 of h^2
    turned = (float(ours.dm()) - (270.0 - direction) + 180.0) % 360.0 - 180.0
    assert turned == pytest.approx(0.0, abs=1e-2 * float(theirs.dspr()))
    assert (float(theirs.dm()) - (270.0 - direction) + 180.0) % 360.0 - 180.0 == pytest.approx(
        0.0, abs=1e-6
    )


def test_energy_outside_the_bins_is_counted_with_a_warning():
    """
    A wave far out is left out and told; one that lies in the outer half of the last band belongs to
    it.
    """
    o = waves((1, 0, 0.1, 0.0), (4, 0, 1.0, 0.0), (12, 0, 0.3, 0.0))
    slow, middle, fast = np.sort(o.modes().omega) / (2 * np.pi)
    with pytest.warns(
        SeaWarning, match=r"9\.1% of the energy lies outside the frequencies .* Hz, and is left out"
    ):
        data = science.realised_spectrum(o, freq=[0.9 * middle, middle, 1.1 * middle])
    assert data.attrs["m0_outside"] == pytest.approx((0.01 + 0.09) / 2, rel=1e-12)
    assert float((data.efth * np.gradient(data.freq.values)[:, None]).sum() * 5.0) == pytest.approx(
        0.5, rel=1e-12
    )
    data = science.realised_spectrum(o, freq=[1.01 * slow, 1.05 * slow, middle, 0.99 * fast])
    assert data.attrs["m0_outside"] == 0.0
    assert (data.efth >= 0.0).all()
    assert float((data.efth * np.gradient(data.freq.values)[:, None]).sum() * 5.0) == pytest.approx(
        1.1 / 2, rel=1e-12
    )


def test_bins_are_those_of_the_tile():
    """
    Powers of 1.05 Hz, the same for every sea and seed on it; a flat sea has them too, and nothing
    in them.
    """
    tile = {"n": 32, "size": 200.0}
    first, second = (
        science.realised_spectrum(waves(wave, **tile))
        for wave in ((1, 2, 0.5, 0.0), (7, -3, 0.1, 0.0))
    )
    flat = science.realised_spectrum(fo.Ocean(fo.Sea(), **tile))
    np.testing.assert_array_equal(first.freq, second.freq)
    np.testing.assert_array_equal(first.freq, flat.freq)
    powers = np.log(first.freq) / math.log(1.05)
    np.testing.assert_allclose(powers, np.rint(powers), atol=1e-9)
    assert not flat.efth.any()
    assert science.realised_spectrum(fo.Ocean(fo.Sea(), n=1, size=1.0)).efth.sum() == 0.0


def test_depth_stands_beside_the_spectrum():
    assert float(science.realised_spectrum(ocean())["dpt"]) == 25.0
    assert "dpt" not in science.realised_spectrum(waves((1, 0, 1.0, 0.0)))


@pytest.mark.parametrize(
    ("bins", "says"),
    [
        ({"freq": [0.1]}, "freq must be 2 to 1000000 numbers, got 1"),
        ({"freq": 0.1}, "freq must be a list of numbers"),
        ({"freq": [0.1, 0.2, 0.2]}, "freq must be strictly ascending, got 0.2 Hz before 0.2 Hz"),
        ({"freq": [0.3, 0.2]}, "freq must be strictly ascending, got 0.3 Hz before 0.2 Hz"),
        ({"freq": [0.0, 0.2]}, r"freq\[0\] must be between 1e-06 and 100000 Hz, got 0.0"),
        ({"freq": [0.1, math.nan]}, r"freq\[1\] must be between"),
        ({"dir": [0.0, 180.0]}, "dir must be 4 to 1000000 numbers, got 2"),
        (
            {"dir": [0.0, 90.0, 180.0, 300.0]},
            "dir must be evenly spaced round the circle, got steps of 60 to 120 degrees",
        ),
        (
            {"dir": np.arange(0.0, 361.0, 10.0)},
            "dir must be evenly spaced round the circle, got steps of 0 to 10 degrees",
        ),
        (
            {"dir": np.arange(0.0, 180.0, 10.0)},
            "dir must be evenly spaced round the circle, got steps of 10 to 190 degrees",
        ),
        ({"dir": ["north"] * 4}, r"dir\[0\] must be a number"),
    ],
)
def test_invalid_bins_are_refused(bins, says):
    with pytest.raises(ParameterError, match=says):
        science.realised_spectrum(ocean(), **bins)


def test_directions_in_any_order_come_out_ascending(spec):
    """
    WAVEWATCH lists them clockwise down from 90; wavespectra takes the first two for the step, so
    they are sorted.
    """
    data = science.realised_spectrum(ocean(), dir=(90.0 - np.arange(0.0, 360.0, 10.0)) % 360.0)
    np.testing.assert_array_equal(data.dir, np.arange(0.0, 360.0, 10.0))
    xr.testing.assert_identical(
        data, science.realised_spectrum(ocean(), dir=np.arange(0.0, 360.0, 10.0))
    )
    assert spec(data).dd == 10.0


def test_a_sea_can_be_made_from_the_spectrum_again(tmp_path):
    """
    Out to a file, in through the readers: Hs as delivered, direction and depth too, and the spread
    but for the bins' own width.
    """
    from fftocean import readers

    o = fo.Ocean(SEA, n=64, size=600.0, seed=5)
    science.write(science.realised_spectrum(o), tmp_path / "a.nc")
    again = readers.sea_from_spectrum(readers.open(tmp_path / "a.nc"))
    energy, _, theta = energies(o)
    direction, spread = fo.moments.mean_direction_and_spread(energy, theta)
    state = specified(again)
    assert again.depth == 25.0
    assert again.hs == pytest.approx(
        4 * math.sqrt(np.sum(energy)), rel=1e-6
    )  # quadrature over a table with 150 corners
    assert state.mean_direction == pytest.approx(
        direction, abs=1.0
    )  # straight lines between the few waves of a small tile
    assert state.spread == pytest.approx(spread, rel=0.01)
