"""Zarr chunks, read by the zarr library; a missing or damaged one is an error or NaN."""

import numpy as np
import pytest
import zarr

from fftocean.errors import IntegrityError
from fftocean.export.formats import FORMATS, assemble, decode, encode

SHAPE = (3, 6, 5, 3)


@pytest.fixture
def stored(tmp_path):
    """Return a map of three frames in its folder."""
    maps = np.random.default_rng(5).standard_normal(SHAPE).astype(np.float32)
    for name, data in assemble(
        "zarr", (), stem="normal", shape=SHAPE, names=("x", "y", "z"), size=(40.0, 30.0), loop=6.0
    ).items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(data)
    for j, frame in enumerate(maps):
        path = tmp_path / FORMATS["zarr"].file.format(stem="normal", frame=j)
        path.parent.mkdir(parents=True)
        path.write_bytes(encode("zarr", frame))
    return tmp_path / "normal.zarr", maps


def test_the_library_reads_it(stored):
    folder, maps = stored
    array = zarr.open_array(folder, mode="r")
    assert array.shape == SHAPE
    assert array.chunks == (1, *SHAPE[1:])
    assert array.metadata.dimension_names == ("frame", "row", "column", "channel")
    assert array.attrs["channels"] == {"R": "x", "G": "y", "B": "z"}
    assert array.attrs["seconds_per_frame"] == 2.0
    assert np.asarray(array[:]).tobytes() == maps.tobytes()


def test_it_is_what_the_library_writes(stored, tmp_path):
    folder, maps = stored
    theirs = zarr.create_array(
        tmp_path / "theirs",
        shape=SHAPE,
        chunks=(1, *SHAPE[1:]),
        dtype="float32",
        compressors=zarr.codecs.Crc32cCodec(),
        fill_value=np.nan,
    )
    theirs[:] = maps
    for j in range(SHAPE[0]):
        assert (folder / f"c/{j}/0/0/0").read_bytes() == (
            tmp_path / f"theirs/c/{j}/0/0/0"
        ).read_bytes()


def test_a_bent_chunk_is_refused_by_both(stored):
    folder, _ = stored
    chunk = folder / "c/1/0/0/0"
    data = bytearray(chunk.read_bytes())
    data[77] ^= 1
    chunk.write_bytes(data)
    with pytest.raises(IntegrityError, match="must match the checksum at its end"):
        decode("zarr", bytes(data), shape=SHAPE[1:])
    with pytest.raises(ValueError, match="checksum"):
        zarr.open_array(folder, mode="r")[1]


def test_an_absent_chunk_is_no_flat_sea(stored):
    folder, _ = stored
    (folder / "c/1/0/0/0").unlink()
    assert np.all(np.isnan(zarr.open_array(folder, mode="r")[1]))
    with pytest.raises(IntegrityError, match="missing"):
        decode("zarr", None, shape=SHAPE[1:])
