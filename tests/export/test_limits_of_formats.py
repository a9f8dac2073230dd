"""Formats where they end: no level, a byte too many, another member, oblong frames, whole loops."""

import io
import zipfile

import numpy as np
import pytest

from fftocean.errors import IntegrityError, ParameterError, described
from fftocean.export import atlas, engines, rules
from fftocean.export.formats import FORMATS, decode, encode, require
from fftocean.export.profiles import PROFILES

MAP = np.random.default_rng(1).standard_normal((6, 4, 3)).astype(np.float32)


def test_a_file_of_no_level_is_refused():
    for name in FORMATS:
        with pytest.raises(ParameterError, match=r"mip levels of 6 rows of 4, got 0"):
            require(name, (1, 6, 4, FORMATS[name].channels[0]), 0)


def test_a_chunk_with_more_bytes_is_refused():
    data = encode("zarr", MAP)
    assert np.array_equal(decode("zarr", data, shape=MAP.shape), MAP)
    with pytest.raises(IntegrityError, match=f"must have {len(data)} bytes, got {len(data) + 1}"):
        decode("zarr", bytes(data) + b"\0", shape=MAP.shape)


def test_an_archive_of_another_member_is_refused():
    with zipfile.ZipFile(io.BytesIO(encode("npz", MAP))) as file:
        (member,) = file.infolist()
        content = file.read(member)
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as file:
        file.writestr(f"other_{member.filename}", content)
    with pytest.raises(IntegrityError, match=r"must hold .* got other_"):
        decode("npz", stream.getvalue(), shape=MAP.shape)


class Program:
    """An object whose unpickling makes a file."""

    def __init__(self, path):
        self.path = str(path)

    def __reduce__(self):
        return open, (self.path, "w")


def test_an_archive_with_a_program_is_refused(tmp_path):
    """NumPy's files may hold pickles, which can do anything when they are read."""
    content, stream = io.BytesIO(), io.BytesIO()
    array = np.array([Program(tmp_path / "made")], dtype=object)
    np.lib.format.write_array(content, array, allow_pickle=True)
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as file:
        file.writestr("pixels.npy", content.getvalue())
    with pytest.raises(IntegrityError, match="cannot be read"):
        decode("npz", stream.getvalue(), shape=MAP.shape)
    assert not list(tmp_path.iterdir())


def test_an_archive_has_no_time_of_its_own():
    """The first that ZIP can tell, so that the same pixels are the same bytes on every day."""
    with zipfile.ZipFile(io.BytesIO(encode("npz", MAP))) as file:
        assert [member.date_time for member in file.infolist()] == [(1980, 1, 1, 0, 0, 0)]


def test_an_atlas_of_oblong_frames_is_nearly_square():
    """
    Of all arrangements without an empty cell, the one whose longer side is shortest; gutters count
    on both sides of both axes.
    """
    for frames, rows, columns, gutter in ((12, 64, 16, 0), (12, 16, 64, 1), (8, 100, 30, 2)):
        across, down = atlas.tiles(frames, rows, columns, gutter)
        side = max(across * (columns + 2 * gutter), down * (rows + 2 * gutter))
        others = [(a, frames // a) for a in range(1, frames + 1) if frames % a == 0]
        assert across * down == frames
        assert side == min(
            max(a * (columns + 2 * gutter), d * (rows + 2 * gutter)) for a, d in others
        )
    assert atlas.tiles(256, 64, 1024)[0] * 1024 <= atlas.LARGEST_SIDE


def test_rules_of_an_oblong_tile():
    for profile in PROFILES.values():
        found = rules.numbers(profile, (300.0, 200.0), (64, 32), 10, 5.0, 0.0)
        assert found["size_x"] / found["size_y"] == pytest.approx(1.5, rel=1e-15)
        assert (found["nx"], found["ny"]) == (64, 32)


@pytest.mark.parametrize("change", ["missing", "unknown"])
def test_a_row_of_the_table_of_engines_has_every_format(change):
    cells = {name: {f: {"loaded": True, "note": ""} for f in FORMATS} for name in PROFILES}
    row = next(iter(cells.values()))
    if change == "missing":
        del row["zarr"]
    else:
        row["tga"] = dict(row["zarr"])
    with pytest.raises(ImportError, match="must have a cell for every format, not so: "):
        engines.table_of(cells)


def test_a_wrong_argument_is_shown_in_sixty_characters():
    """Also one that is shown by its type's own name."""
    for value in (set(range(100)), frozenset(range(100)), np.arange(100), bytearray(100)):
        assert len(described(value).removesuffix(f" ({type(value).__name__})")) <= 60
    assert described(frozenset({1})) == "frozenset({1})"


def test_steps_of_a_loop_end_where_they_began(tmp_path):
    import fftocean as fo
    from fftocean.wave_files import swd

    ocean = fo.Ocean.from_modes([(1, 2, 0.3, 0.4)], n=16, size=60.0, loop=20.0)
    path = tmp_path / "sea.swd"
    swd.swd(ocean, path, steps=41)
    data = path.read_bytes()
    assert np.float32(0.5).tobytes() in data
    assert np.float32(20.0 / 41.0).tobytes() not in data
