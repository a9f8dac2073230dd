"""Textures of waves in each format, and the table of the transform."""

import builders_of_packages as build
import numpy as np
import pytest

import fftocean as fo
from fftocean import runtime
from fftocean.engine_projects import TEXTURES
from fftocean.errors import IntegrityError
from fftocean.files import digest
from fftocean.runtime.textures import decode, encode, twiddle


@pytest.mark.parametrize("ending", TEXTURES)
def test_textures_hold_the_planes_to_the_bit_in_every_format(ending):
    package = runtime.pack(build.cascade(), textures=ending, reference=False)
    rows = {row["name"]: row for row in package.document["files"]}
    for i, ocean in enumerate(build.cascade().oceans):
        expected = runtime.amplitude_planes(ocean)
        for kind, array in zip(("h0", "wave"), expected, strict=True):
            name = f"tile{i}_{kind}.{ending}"
            assert rows[name]["shape"] == list(array.shape)
            assert rows[name]["dtype"] == {"bin": "float32"}.get(ending, f"{ending}, float32")
            assert np.array_equal(decode(package.files[name], ending, array.shape), array)
    assert len([name for name in rows if name.endswith(ending)]) >= 6


@pytest.mark.parametrize("ending", TEXTURES)
def test_the_check_knows_every_format(ending, tmp_path):
    fo.export_sea(build.cascade(), tmp_path, textures=ending)
    assert fo.check(tmp_path) == ()
    name = f"tile1_h0.{ending}"
    package = runtime.pack(build.cascade(), textures=ending)
    array = runtime.amplitude_planes(build.cascade().oceans[1])[0].copy()
    array[1, 2, 0] += 0.1
    package.files[name] = encode(array, ending)[0]
    row = next(row for row in package.document["files"] if row["name"] == name)
    row["bytes"], row["sha256"] = len(package.files[name]), digest(package.files[name])
    (found,) = fo.check(build.put(package, tmp_path / "other"))
    assert (found.kind, found.path) == ("values", name)


def test_the_table_has_cosine_and_sine_of_each_part_of_a_turn(tmp_path):
    """To half a step of float32 near 1, which is 3e-8; whole quarters are exact."""
    package = runtime.pack(build.cascade(), textures=True)
    table = np.frombuffer(package.files["twiddle.bin"], "<f4").reshape(32, 2)
    turns = np.exp(2j * np.pi * np.arange(32) / 32)
    assert np.abs(table[:, 0] + 1j * table[:, 1] - turns).max() <= 3.1e-8
    assert table[::8].tolist() == [[1, 0], [0, 1], [-1, 0], [0, -1]]
    assert np.array_equal(twiddle(64)[::2], table)
    package.files["twiddle.bin"] = table[::-1].tobytes()
    row = next(row for row in package.document["files"] if row["name"] == "twiddle.bin")
    row["sha256"] = digest(package.files["twiddle.bin"])
    (found,) = fo.check(build.put(package, tmp_path))
    assert (found.kind, found.path) == ("values", "twiddle.bin")
    assert found.detail == "it does not hold cosine and sine of 2 pi i/32"


@pytest.mark.parametrize("ending", TEXTURES)
def test_bytes_of_another_texture_are_refused(ending):
    data = encode(np.zeros((4, 8, 4), np.float32), ending)[0]
    for wrong, shape in ((data[:-3], (4, 8, 4)), (data, (4, 4, 4)), (data, (4, 8, 2))):
        with pytest.raises(IntegrityError):
            decode(wrong, ending, shape)
