"""Files made to read others or to exhaust memory, refused within 2 s before any data are read."""

import gzip
import os
import struct
import time
import tracemalloc

import h5py
import numpy as np
import pytest
from spectrum_files import DATA, sea, write_swan, write_ww3

from fftocean import readers
from fftocean.errors import ReaderError
from fftocean.readers import bounded_reads, classic, hdf5


def refused(path, message):
    """Assert that a file is refused within 2 s of processor time and 64 MiB, by name."""
    tracemalloc.start()
    try:
        start = time.process_time()
        with pytest.raises(ReaderError, match=message) as caught:
            readers.open(path)
        assert time.process_time() - start < 2.0
        assert tracemalloc.get_traced_memory()[1] < 64 * 2**20
    finally:
        tracemalloc.stop()
    assert str(caught.value).startswith(path.name)


def write(path, put=None, extra=None, **how):
    """Write an HDF5 file like netCDF-4: axes, `efth` made by `put`, and additions by `extra`."""
    with h5py.File(path, "w", **how) as file:
        for name, values, unit in (
            ("freq", np.linspace(0.05, 0.3, 6), "Hz"),
            ("dir", np.arange(0.0, 360.0, 30.0), "degree"),
        ):
            file.create_dataset(name, data=values).make_scale(name)
            file[name].attrs["units"] = unit
        if extra:
            extra(file)
        if put:
            put(file)
        else:
            file.create_dataset("efth", data=np.ones((6, 12)))
        if isinstance(file.get("efth", getlink=True), h5py.HardLink):
            file["efth"].attrs["units"] = "m2 s degree-1"
            names = (
                ("freq", "dir") if file["efth"].id.rank == 2 else ("time", "freq", "dir", "site")
            )
            for i, name in enumerate(names):
                file["efth"].dims[i].attach_scale(file[name])
    return path


@pytest.fixture
def other(tmp_path):
    """Yield a foreign file, and a pipe, on which a reader would wait for ever."""
    (tmp_path / "secret.bin").write_bytes(bytes(range(72)))
    os.mkfifo(tmp_path / "pipe")
    write(tmp_path / "source.nc")
    return tmp_path


def test_the_file_that_the_others_are_made_of_is_read(tmp_path):
    assert float(readers.open(write(tmp_path / "a.nc")).efth.sum()) == 72.0


@pytest.mark.parametrize("target", ["secret.bin", "pipe", "/dev/zero", "absent"])
@pytest.mark.parametrize("name", ["efth", "dpt"])
def test_external_storage(target, name, other):
    where = [(str(other / target), 0, 72)]
    add = lambda f: f.create_dataset(name, (6, 12), "u1", external=where)  # noqa: E731
    path = write(other / "a.nc", add) if name == "efth" else write(other / "a.nc", None, add)
    refused(
        path,
        rf"variable {name} must lie in the file itself, got data in another file \(HDF5 "
        rf"external storage\)",
    )
    (other / "a.nc.gz").write_bytes(gzip.compress(path.read_bytes()))
    refused(other / "a.nc.gz", f"variable {name} must lie in the file itself")


@pytest.mark.parametrize("target", ["source.nc", "pipe"])
def test_virtual_datasets(target, other):
    def put(file):
        layout = h5py.VirtualLayout((6, 12), "f8")
        layout[:] = h5py.VirtualSource(str(other / target), "efth", (6, 12))
        file.create_virtual_dataset("efth", layout)

    refused(
        write(other / "a.nc", put, libver="latest"), r"variable efth .* \(HDF5 virtual dataset\)"
    )


@pytest.mark.parametrize("target", ["source.nc", "pipe", "/dev/zero"])
@pytest.mark.parametrize("place", ["efth", "dpt", "group/inside"])
def test_links_to_other_files(target, place, other):
    def extra(file):
        file[place] = h5py.ExternalLink(str(other / target), "efth")

    path = write(other / "a.nc", (lambda _: None) if place == "efth" else None, extra)
    refused(path, f"variable {place} must lie in the file itself, got a link to another file")


def test_soft_links_that_lead_in_a_circle(tmp_path):
    def extra(file):
        file["x"], file["y"] = h5py.SoftLink("/y"), h5py.SoftLink("/x")

    refused(
        write(tmp_path / "a.nc", None, extra),
        "variable x must lie in the file itself, got a soft link",
    )


def test_filters_of_others(tmp_path):
    """The library looks foreign filters up among plugins, which are code."""

    def extra(file):
        plan = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        plan.set_chunk((6, 12))
        plan.set_filter(32015, h5py.h5z.FLAG_OPTIONAL, (1,))
        h5py.h5d.create(file.id, b"dpt", h5py.h5t.IEEE_F64LE, h5py.h5s.create_simple((6, 12)), plan)

    refused(
        write(tmp_path / "a.nc", None, extra),
        r"variable dpt must be compressed by a filter of HDF5's own .* got filter 32015",
    )


def test_a_group_that_holds_itself_is_walked_once(tmp_path):
    path = write(tmp_path / "a.nc", None, lambda f: f.create_group("g").__setitem__("up", f["/"]))
    assert float(readers.open(path).efth.sum()) == 72.0


def nested(file):
    for _ in range(hdf5.MOST_OBJECTS + 1):
        file = file.create_group("g")


@pytest.mark.parametrize(
    "extra",
    [nested, lambda f: [f.create_group(f"g{i}") for i in range(hdf5.MOST_OBJECTS)]],
    ids=["deep", "wide"],
)
def test_too_many_objects(extra, tmp_path):
    refused(write(tmp_path / "a.nc", None, extra), "must hold at most 500 variables and groups")


def space(name, shape, chunks):
    return lambda f: f.create_dataset(name, shape, "f8", chunks=chunks, compression="gzip")


@pytest.mark.parametrize(
    ("extra", "message"),
    [
        (
            space("x", (20000, 20000), (5000, 5000)),
            "variable x must have chunks of at most 128 MiB",
        ),
        (space("x", (10**7 + 1, 2), (10, 2)), "variable x must be at most 10000000 long"),
        (space("x", (10**7,), (1000,)), "variable x must not be larger than its file can hold"),
        (
            lambda f: f["freq"].attrs.__setitem__("a", np.zeros(600_000)),
            "variable freq: attribute a must be at most 4096 KiB",
        ),
        (
            lambda f: f.attrs.__setitem__("a", np.zeros(600_000)),
            "the file: attribute a must be at most",
        ),
        (
            lambda f: [f["freq"].attrs.__setitem__(f"a{i}", 1) for i in range(201)],
            "variable freq must have at most 200 attributes",
        ),
    ],
)
def test_absurd_sizes(extra, message, tmp_path):
    refused(write(tmp_path / "a.nc", None, extra, libver="latest"), message)


def with_times(times, sites, chunks):
    def put(file):
        for name, count in (("time", times), ("site", sites)):
            file.create_dataset(
                name, data=np.zeros(count), chunks=(count,), compression="gzip"
            ).make_scale(name)
        file["time"].attrs["units"] = "hours since 2000-01-01"
        file.create_dataset("efth", (times, 6, 12, sites), "f8", chunks=chunks, compression="gzip")

    return put


def test_chunks_that_hold_all_places_are_counted_for_one(tmp_path):
    """Small in the file, and 5 GiB to unpack for a single place."""
    refused(
        write(tmp_path / "a.nc", with_times(1000, 10_000, (1, 6, 12, 10_000))),
        "variable efth must be readable for one place",
    )


def test_values_that_were_never_written(tmp_path):
    refused(
        write(tmp_path / "a.nc", with_times(300_000, 1, (100, 6, 12, 1))),
        r"variable efth must be readable .* got 164 MiB",
    )


def test_text_that_nobody_needs_is_not_read(tmp_path):
    path = write(
        tmp_path / "a.nc",
        None,
        lambda f: f.create_dataset("names", data=["x" * 10_000] * 1000, dtype=h5py.string_dtype()),
    )
    with path.open("rb") as stream:
        assert hdf5.require_sound("a.nc", stream) == ["names"]
    assert float(readers.open(path).efth.sum()) == 72.0


# --- netCDF 3


def test_the_header_of_a_real_file_is_sound():
    with (DATA / "ww3file.nc").open("rb") as stream:
        classic.require_sound("a", stream)
        assert stream.tell() == 0


def header(*variables, records=0, dims=((b"freq", 6),)):
    """Return a classic header: variables are (name, axes, type, begin)."""

    def text(word):
        return struct.pack(">I", len(word)) + word + bytes(-len(word) % 4)

    out = (
        b"CDF\x01"
        + struct.pack(">III", records, 10, len(dims))
        + b"".join(text(n) + struct.pack(">I", size) for n, size in dims)
    )
    out += struct.pack(">IIII", 0, 0, 11, len(variables))
    for name, axes, kind, begin in variables:
        out += (
            text(name)
            + struct.pack(f">I{len(axes)}I", len(axes), *axes)
            + struct.pack(">IIIII", 0, 0, kind, 48, begin)
        )
    return out


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (header((b"efth", (0,), 6, 100)) + bytes(20), "variable efth must lie in the file"),
        (
            header(*[(b"v%d" % i, (0,), 6, 60) for i in range(9)]),
            r"variable v\d must lie in the file",
        ),
        (header((b"efth", (3,), 6, 60)), "variable efth must have dimensions that the file has"),
        (header((b"efth", (0,), 9, 60)), "variable efth must be of a type between 1 and 6, got 9"),
        (
            header((b"efth", (0,), 6, 60), dims=((b"freq", 2**31),)),
            "variable efth must lie in the file",
        ),
        (
            header((b"efth", (0,), 6, 60), dims=((b"time", 0),), records=10**6),
            "variable efth must lie in the file",
        ),
        (
            b"CDF\x01" + struct.pack(">III", 0, 10, 2**31),
            "must have at most 500 dimensions, variables or attributes",
        ),
        (
            b"CDF\x01" + struct.pack(">IIII", 0, 10, 1, 2**31),
            "a name must be at most 4096 bytes long",
        ),
        (b"CDF\x01" + struct.pack(">III", 0, 7, 1), "has the tag 7, not 10"),
        (header((b"efth", (0,), 6, 60))[:-9], "its header is cut short"),
    ],
)
def test_netcdf_3_headers_that_lie(data, message, tmp_path):
    (tmp_path / "a.nc").write_bytes(data)
    refused(tmp_path / "a.nc", message)


def attribute(length, name=b"history"):
    """Return a classic header with one attribute of characters, all of which are there."""
    padded = name + bytes(-len(name) % 4)
    head = struct.pack(">IIIIII", 0, 0, 0, 12, 1, len(name)) + padded
    return b"CDF\x01" + head + struct.pack(">II", 2, length) + b"x" * length


def test_a_long_attribute_is_not_read(tmp_path):
    """Of what is only thrown away 4 MiB are read at most, though the file has more."""
    path = tmp_path / "a.nc"
    path.write_bytes(attribute(5 * 2**20))
    refused(path, "attribute history must be at most 4 MiB, got 5242880 bytes")
    path.write_bytes(attribute(2**22))
    refused(path, "its header is cut short")  # at the list of variables, behind the attribute
    path.write_bytes(attribute(4, b"n" * 4097))
    refused(path, "a name must be at most 4096 bytes long, got 4097")
    path.write_bytes(attribute(4, b"n" * 4096))
    refused(path, "its header is cut short")


def test_many_variables_on_the_same_bytes(tmp_path):
    """Each would be read whole: 100 times the file."""
    data = header(*[(b"v%d" % i, (0,), 6, 8000) for i in range(100)], dims=((b"x", 125_000),))
    (tmp_path / "a.nc").write_bytes(data + bytes(1_010_000 - len(data)))
    refused(tmp_path / "a.nc", "variable v1 must lie in the file")


# --- text


def test_a_swan_file_of_more_bins_than_fit(tmp_path):
    """2000 frequencies by 2000 directions, and then ZERO: one word for 32 MB."""
    text = write_swan(tmp_path / "a.spec", sea()).read_text().splitlines()
    at = text.index("AFREQ")
    many = [
        "AFREQ",
        "2000",
        *(f"{0.01 + 1e-4 * i:.4f}" for i in range(2000)),
        "NDIR",
        "2000",
        *(f"{0.18 * i:.2f}" for i in range(2000)),
    ]
    rest = text[text.index("QUANT") : text.index("FACTOR")]
    (tmp_path / "a.spec").write_text("\n".join([*text[:at], *many, *rest, "ZERO"]) + "\n")
    refused(
        tmp_path / "a.spec",
        "must have at most 1000000 frequencies times directions, got 2000 by 2000",
    )


def test_a_pipe_put_in_place_of_a_file(tmp_path):
    """After the file was looked at, before it is opened: no waiting, and no reading."""
    os.mkfifo(tmp_path / "pipe")
    with (
        pytest.raises(ReaderError, match="must be a regular file"),
        bounded_reads.opened(tmp_path / "pipe"),
    ):
        pass


def test_a_link_to_a_device_is_a_device_and_to_a_file_is_the_file(tmp_path):
    (tmp_path / "zero.nc").symlink_to("/dev/zero")
    with pytest.raises(ReaderError, match="a device"):
        readers.open(tmp_path / "zero.nc")
    write_ww3(tmp_path / "real.nc", sea())
    (tmp_path / "link.nc").symlink_to(tmp_path / "real.nc")
    assert "efth" in readers.open(tmp_path / "link.nc")
