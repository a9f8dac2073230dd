"""Every format with every profile: round trips, refusals and damaged data."""

import dataclasses
import hashlib
import io
import json
import re

import numpy as np
import OpenEXR
import pytest

from fftocean.errors import IntegrityError, OutputError, ParameterError
from fftocean.export import formats, rules
from fftocean.export.formats import (
    FORMATS,
    Format,
    assemble,
    decode,
    decode_levels,
    encode,
    payloads,
    require,
)
from fftocean.export.profiles import PROFILES, Profile, arrange, restore
from fftocean.export.registry import by_name

ROWS, COLUMNS, FRAMES = 13, 10, 6
EVERY = pytest.mark.parametrize("name", FORMATS)
# a KTX2 file's first byte of them, about: before it stand header, index, descriptor, and what is
# only for show
TEXELS = 300
SEQUENCES = [name for name, format_ in FORMATS.items() if format_.scope == "sequence"]


def water(channels, frames=FRAMES, rows=ROWS, columns=COLUMNS, seed=0):
    """Return a sequence of maps, float32: metres of both signs, some of them tiny."""
    rng = np.random.default_rng(seed)
    return (
        rng.standard_normal((frames, rows, columns, channels))
        * 10.0 ** rng.uniform(-6, 1, (frames, rows, columns, 1))
    ).astype(np.float32)


def span(sequence):
    """Return the range that a scaled format needs."""
    return {"lo": float(sequence.min()), "hi": float(sequence.max())}


def options(name, sequence):
    return span(sequence) if FORMATS[name].scaled else {}


def through(name, sequence):
    """Return a sequence stored and read back like in a bake: by its files, or by its container."""
    scale = options(name, sequence)
    parts = [encode(name, frame, **scale) for frame in sequence]
    if FORMATS[name].scope == "sequence":
        files = assemble(name, iter(parts), stem="map", shape=sequence.shape)
        again = payloads(
            name, files[FORMATS[name].file.format(stem="map", frame=0)], shape=sequence.shape
        )
        assert again == parts
        parts = again
    return np.stack([decode(name, part, shape=sequence.shape[1:], **scale) for part in parts])


@EVERY
@pytest.mark.parametrize(
    "profile", ["canonical", "unreal"]
)  # in metres, in centimetres: all that a format could notice
@pytest.mark.parametrize(("kind", "channels"), [("height", 1), ("vector", 3), ("derivative", 4)])
def test_stored_and_read_back(name, profile, kind, channels):
    """
    float32 to the bit, half to half an ulp, sixteen bits to half a step; and restored, the same of
    our own map.
    """
    if channels not in FORMATS[name].channels:
        with pytest.raises(
            ParameterError, match=f"format {name} holds maps of .* channels, got {channels}"
        ):
            require(name, (FRAMES, ROWS, COLUMNS, channels))
        return
    ours = water(channels)
    arranged = np.stack([arrange(PROFILES[profile], kind, frame) for frame in ours])
    stored = through(name, arranged)
    exact = arranged.astype(np.float64)
    if FORMATS[name].stored == "float32":
        assert stored.dtype == np.float32
        assert stored.tobytes() == arranged.tobytes()
        allowed = np.zeros_like(exact)
    elif FORMATS[name].stored == "float16":
        assert stored.dtype == np.float16
        allowed = 0.5 * np.spacing(np.abs(stored)).astype(np.float64)
    else:
        assert stored.dtype == np.float32
        allowed = 0.5 * (exact.max() - exact.min()) / 65535 + np.spacing(np.abs(arranged)).astype(
            np.float64
        )  # it is read back as a float32
    assert np.all(np.abs(stored.astype(np.float64) - exact) <= allowed)
    back = np.stack([restore(PROFILES[profile], kind, frame) for frame in stored])
    scale = PROFILES[profile].scale if kind in ("height", "vector") else 1
    there = np.stack(
        [
            restore(PROFILES[profile], kind, frame)
            for frame in np.broadcast_to(allowed, ours.shape).astype(np.float32)
        ]
    )
    rounding = (
        2.0
        * np.spacing(np.abs(ours)).astype(np.float64)
        * (scale != 1 or FORMATS[name].stored != "float32")
    )
    assert np.all(np.abs(back.astype(np.float64) - ours) <= np.abs(there) * (1 + 1e-6) + rounding)


@EVERY
def test_the_same_pixels_are_the_same_bytes(name, monkeypatch):
    """
    At another time of day, from another layout in memory, from halves packed before: no clock and
    no chance in any file.
    """
    sequence = water(1)
    scale = options(name, sequence)
    first = [encode(name, frame, **scale) for frame in sequence]
    monkeypatch.setattr("time.time", lambda: 2e9)
    assert [encode(name, np.asfortranarray(frame), **scale) for frame in sequence] == first
    if FORMATS[name].stored == "float16":
        assert [encode(name, frame.astype(np.float16)) for frame in sequence] == first
    whole = [
        {
            k: bytes(v)
            for k, v in assemble(name, first, stem="m", shape=sequence.shape, **scale).items()
        }
        for _ in range(2)
    ]
    assert whole[0] == whole[1]


@pytest.mark.parametrize("name", [n for n in FORMATS if 3 in FORMATS[n].channels])
@pytest.mark.parametrize(
    "view",
    [
        lambda a: a.transpose(1, 0, 2).copy().transpose(1, 0, 2),
        lambda a: a.transpose(2, 0, 1).copy().transpose(1, 2, 0),
        lambda a: np.repeat(np.repeat(a, 2, axis=0), 3, axis=1)[::2, ::3],
        lambda a: a[::-1].copy()[::-1],
        lambda a: a[..., ::-1].copy()[..., ::-1],
        lambda a: (
            np.frombuffer(b"\0" + a.tobytes(), dtype=np.uint8)[1:].view(a.dtype).reshape(a.shape)
        ),
    ],
    ids=["transposed", "planar", "strided", "upside-down", "mirrored", "misaligned"],
)
def test_arrays_of_any_layout_give_their_own_pixels(name, view):
    """Encoders read memory in order, whatever the layout of the array that they are given."""
    for dtype in (np.float16, np.float32, np.float64):
        plain = np.arange(5 * 7 * 3, dtype=dtype).reshape(5, 7, 3)
        assert encode(name, view(plain), **options(name, plain)) == encode(
            name, plain, **options(name, plain)
        )
        got = decode(
            name,
            encode(name, view(plain), **options(name, plain)),
            shape=plain.shape,
            **options(name, plain),
        )
        assert np.array_equal(np.rint(got), plain)


@EVERY
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e30])
def test_what_cannot_be_held_is_refused(name, bad):
    """
    NaN and infinity everywhere; 1e30 where halves are stored, or a range is given. Never clipped.
    """
    frame = np.ones((4, 5, 1), dtype=np.float32)
    frame[2, 3, 0] = bad
    scale = {"lo": -1.0, "hi": 1.0} if FORMATS[name].scaled else {}
    if bad == 1e30 and FORMATS[name].stored == "float32":
        assert decode(name, encode(name, frame), shape=frame.shape)[2, 3, 0] == np.float32(1e30)
        return
    with pytest.raises(
        OutputError, match=r"values must (be finite|lie between|stay within).* got "
    ) as caught:
        encode(name, frame, **scale)
    assert caught.value.exit_code == 4


@pytest.mark.parametrize("name", [n for n in FORMATS if FORMATS[n].stored == "float16"])
def test_the_edge_of_a_half(name):
    edge = np.full((2, 2, 1), 65504.0)
    assert np.all(decode(name, encode(name, edge), shape=edge.shape) == 65504.0)
    with pytest.raises(
        OutputError, match=r"values must stay within \+-65504 to be half floats, got 65504.1"
    ):
        encode(name, edge + 0.1)
    with (
        np.errstate(over="ignore"),
        pytest.raises(
            OutputError, match="values must be finite as float16, got inf at row 0, column 0"
        ),
    ):
        encode(name, (edge * 2).astype(np.float16))  # packed before, and overflown there


@pytest.mark.parametrize("name", ["png16", "r16"])
def test_the_range_is_for_each_channel_or_for_all_and_must_hold(name):
    frame = np.linspace(-2.0, 3.0, 20, dtype=np.float32).reshape(4, 5, 1)
    assert encode(name, frame, lo=-2.0, hi=3.0) == encode(name, frame, lo=[-2.0], hi=[3.0])
    steps = (
        decode(name, encode(name, frame, lo=-2.0, hi=3.0), shape=frame.shape, lo=0.0, hi=65535.0)
    ).astype(int)
    assert (steps.min(), steps.max()) == (0, 65535)
    for lo, hi in ((-1.9999, 3.0), (-2.0, 2.9999)):
        with pytest.raises(
            OutputError, match=r"values must lie between .* got \[-2.0\] to \[3.0\]"
        ):
            encode(name, frame, lo=lo, hi=hi)
    for lo, hi in ((None, 1.0), (0.0, None), (1.0, -1.0), (-np.inf, 1.0), (np.nan, 1.0)):
        with pytest.raises(ParameterError, match="range"):
            encode(name, frame, lo=lo, hi=hi)
    flat = np.full((4, 5, 1), 0.1, dtype=np.float32)
    again = decode(
        name,
        encode(name, flat, lo=flat[0, 0, 0], hi=flat[0, 0, 0]),
        shape=flat.shape,
        lo=flat[0, 0, 0],
        hi=flat[0, 0, 0],
    )
    assert np.array_equal(again, flat)


def test_a_range_for_each_channel():
    frame = (
        np.stack([np.linspace(-1, 1, 12), np.linspace(0, 100, 12), np.zeros(12)], axis=-1)
        .reshape(3, 4, 3)
        .astype(np.float32)
    )
    lo, hi = frame.min(axis=(0, 1)).tolist(), frame.max(axis=(0, 1)).tolist()
    again = decode("png16", encode("png16", frame, lo=lo, hi=hi), lo=lo, hi=hi)
    assert np.all(
        np.abs(again - frame)
        <= 0.5 * (np.array(hi) - lo) / 65535 * (1 + 1e-6) + np.spacing(np.abs(frame))
    )


def file_of(name, sequence):
    """
    Return the one file that a reader opens, a frame's own or the container, and a function that
    reads it.
    """
    scale = options(name, sequence)
    parts = [encode(name, frame, **scale) for frame in sequence]
    if FORMATS[name].scope == "frame":
        return parts[0], lambda data: decode(name, data, shape=sequence.shape[1:], **scale)
    files = assemble(name, parts, stem="m", shape=sequence.shape)
    data = bytes(files[FORMATS[name].file.format(stem="m", frame=0)])
    return data, lambda data: np.stack(
        [
            decode(name, part, shape=sequence.shape[1:])
            for part in payloads(name, data, shape=sequence.shape)
        ]
    )


@EVERY
def test_a_cut_or_missing_file_is_refused(name):
    data, read = file_of(name, water(1))
    read(data)
    for end in sorted(
        {0, 1, 7, 8, 100, len(data) // 2, len(data) - 5, len(data) - 1} & set(range(len(data)))
    ):
        with pytest.raises(IntegrityError):
            read(data[:end])
    with pytest.raises(IntegrityError, match="missing"):
        read(None)
    if name not in (
        "exr",
        "exr-float",
        "exr-atlas",
        "npz",
    ):  # their libraries look no further than they need to
        with pytest.raises(IntegrityError):
            read(data + b"\0")


@pytest.mark.parametrize("name", [n for n in FORMATS if n not in ("bin", "r16")])
def test_a_flipped_bit_is_never_other_water(name):
    """
    Refused; or it stood where no water is. Bare texels cannot tell, in KTX2 either: the manifest's
    SHA-256 is for them.
    """
    rows = 40  # enough that ZIP does compress its blocks, which have no checksum otherwise
    smooth = np.sin(np.arange(rows * 30) / 50.0).reshape(1, rows, 30, 1).astype(np.float32)
    sequence = np.concatenate([smooth, 2 * smooth])
    data, read = file_of(name, sequence)
    plain = read(data)
    rng = np.random.default_rng(1)
    refused = 0
    for at in np.concatenate(
        [np.arange(0, min(400, len(data)), 3), rng.integers(0, len(data), 150)]
    ):
        bent = bytearray(data)
        bent[at] ^= 1 << rng.integers(8)
        try:
            found = read(bytes(bent))
        except IntegrityError:
            refused += 1
            continue
        assert np.array_equal(found, plain) or (name == "ktx2" and at >= TEXELS), f"byte {at}"
    assert refused > (60 if name == "ktx2" else 150)


@EVERY
@pytest.mark.parametrize(
    "shape",
    [(ROWS + 1, COLUMNS, 1), (ROWS, COLUMNS - 1, 1), (COLUMNS, ROWS, 1), (ROWS, COLUMNS, 3)],
)
def test_another_shape_is_refused(name, shape):
    """A bare format cannot tell where the bytes alone would fit, as with sides exchanged."""
    sequence = water(3 if shape[2] == 1 and 3 in FORMATS[name].channels else 1)
    data = encode(name, sequence[0], **options(name, sequence))
    if name in ("r16",) and shape in ((COLUMNS, ROWS, 1), (ROWS, COLUMNS, 3)):
        return
    if sequence.shape[3] == shape[2] and shape[:2] == (ROWS, COLUMNS):
        return
    if name in ("exr", "exr-float", "bin", "ktx2") and shape == (
        ROWS,
        COLUMNS,
        3,
    ):  # one channel stands in all three
        assert np.all(
            decode(name, data, shape=shape) == decode(name, data, shape=(ROWS, COLUMNS, 1))
        )
        return
    with pytest.raises(IntegrityError):
        decode(name, data, shape=shape, **options(name, sequence))


@pytest.mark.parametrize("name", ["exr", "exr-float", "bin", "ktx2"])
def test_one_channel_must_stand_in_all_three(name):
    frame = np.zeros((4, 4, 3), dtype=np.float32)
    frame[1, 1, 2] = 1.0
    with pytest.raises(IntegrityError, match=r"must hold a map of shape \(4, 4, 1\)"):
        decode(name, encode(name, frame), shape=(4, 4, 1))


@pytest.mark.parametrize(("name", "other"), [("exr", "exr-float"), ("exr-float", "exr")])
def test_another_precision_is_another_format(name, other):
    frame = water(3)[0]
    with pytest.raises(IntegrityError, match=f"format {name} must hold {FORMATS[name].stored}"):
        decode(name, encode(other, frame))


@pytest.mark.parametrize("name", ["bin", "ktx2"])
def test_alpha_is_one_and_stays_one(name):
    frame = water(3)[0]
    texels = np.frombuffer(encode(name, frame), dtype="<f2").reshape(ROWS, COLUMNS, 4)
    assert np.all(texels[..., 3] == 1.0)
    assert np.array_equal(texels[..., :3], frame.astype(np.float16))
    bent = texels.copy()
    bent[3, 3, 3] = 0.5
    with pytest.raises(IntegrityError, match=f"format {name} must have a 1 in A"):
        decode(name, bent.tobytes(), shape=frame.shape)
    bent = texels.copy()
    bent[3, 3, 1] = np.nan
    with pytest.raises(IntegrityError, match="finite"):
        decode(name, bent.tobytes(), shape=frame.shape)


@pytest.mark.parametrize("name", SEQUENCES)
def test_too_few_too_many_or_wrong_frames(name):
    sequence = water(3)
    parts = [encode(name, frame) for frame in sequence]
    for wrong in (parts[:-1], [*parts, parts[0]], [*parts[:-1], parts[-1][:-2]], []):
        with pytest.raises(ValueError, match="frame"):
            assemble(name, wrong, stem="m", shape=sequence.shape)


def test_frames_of_an_atlas_stand_in_reading_order():
    """
    By OpenEXR itself: frame i is the i-th tile from the left, then down; as square as the number of
    frames allows.
    """
    sequence = water(3, frames=6, rows=4, columns=8)
    files = assemble(
        "exr-atlas",
        [encode("exr-atlas", f) for f in sequence],
        stem="displacement",
        shape=sequence.shape,
        loop=2.0,
    )
    file = OpenEXR.File(io.BytesIO(bytes(files["displacement.exr"])), separate_channels=True)
    assert "wrapmodes" not in file.header()  # its tiles repeat, it does not
    side = json.loads(files["displacement.json"])
    across, down = side["tiles"]
    assert (across, down) == (2, 3)  # 20 x 18 rather than 30 x 12
    assert side["gutter"] == 1
    for c, letter in enumerate("RGB"):
        picture = file.channels()[letter].pixels
        for i, frame in enumerate(sequence):
            cell = picture[i // across * 6 :, i % across * 10 :][:6, :10]
            wrapped = np.take(
                np.take(frame[..., c], range(-1, 5), 0, mode="wrap"), range(-1, 9), 1, mode="wrap"
            )
            assert np.array_equal(cell, wrapped.astype(np.float16))
    assert side["seconds_per_frame"] == pytest.approx(1 / 3)
    assert side["sha256"] == hashlib.sha256(files["displacement.exr"]).hexdigest()


@pytest.mark.parametrize(
    ("frames", "rows", "columns", "tiles"),
    [
        (1, 8, 8, (1, 1)),
        (64, 256, 256, (8, 8)),
        (60, 256, 256, (6, 10)),
        (240, 512, 512, (15, 16)),
        (61, 256, 256, (1, 61)),
        (2, 4, 16384, (1, 2)),
    ],
)
def test_an_atlas_is_full_and_fits(frames, rows, columns, tiles):
    assert formats.atlas(frames, rows, columns) == tiles


@pytest.mark.parametrize(
    ("frames", "rows", "columns"), [(67, 256, 256), (1, 16385, 4), (240, 4096, 4096)]
)
def test_an_atlas_that_cannot_be(frames, rows, columns):
    with pytest.raises(
        ParameterError,
        match=r"do not fill an atlas of at most 16384 x 16384: choose a number of frames",
    ):
        require("exr-atlas", (frames, rows, columns, 3))


def test_names_and_shapes_that_no_format_has():
    with pytest.raises(
        ParameterError, match=r"format must be one of exr, exr-float, png16, .* got 'jpeg'"
    ):
        require("jpeg", (1, 2, 2, 1))
    with pytest.raises(ParameterError, match="format must be one of"):
        decode("jpeg", b"")
    with pytest.raises(
        ParameterError, match=r"format r16 holds maps of 1 channels, got 3; choose one of exr, "
    ):
        require("r16", (1, 2, 2, 3))
    with pytest.raises(ParameterError, match="format png16 holds maps of 1 or 3 channels, got 4"):
        require("png16", (1, 2, 2, 4))
    with pytest.raises(ParameterError, match=r"holds maps of 1 or 3 or 4 channels, got 2$"):
        require("exr", (1, 2, 2, 2))
    with pytest.raises(ParameterError, match="at least one frame, row, column and channel"):
        require("exr", (0, 2, 2, 1))
    with pytest.raises(ParameterError, match=r"\(rows, columns, channels\), got shape \(2, 2\)"):
        encode("exr", np.zeros((2, 2)))
    with pytest.raises(
        ParameterError, match="format exr holds 1 to 1 mip levels of 2 rows of 2, got 2"
    ):
        encode("exr", np.zeros((2, 2, 1)), levels=[np.zeros((1, 1, 1))])
    with pytest.raises(ParameterError, match="format bin does not store the shape"):
        decode("bin", encode("bin", np.zeros((2, 2, 1))))
    with pytest.raises(ParameterError, match="one file a frame and no container"):
        payloads("exr", b"", shape=(1, 2, 2, 1))


@pytest.mark.parametrize("name", ["bin", "r16", "png16", "exr-atlas", "ktx2", "zarr"])
def test_the_sidecar_says_all_that_a_reader_needs(name):
    """Half a tile of Unreal's heights: centimetres, its own axes, and where to sample them."""
    sequence = 100.0 * water(1)
    scale = options(name, sequence)
    files = assemble(
        name,
        [encode(name, frame, **scale) for frame in sequence],
        stem="height",
        shape=sequence.shape,
        profile=PROFILES["unreal"],
        names=("height",),
        unit="cm",
        size=(500.0, 250.0),
        loop=12.0,
        **scale,
    )
    side = json.loads(files["height.zarr/zarr.json" if name == "zarr" else "height.json"])
    side = side["attributes"] if name == "zarr" else side
    assert (side["frames"], side["rows"], side["columns"]) == (FRAMES, ROWS, COLUMNS)
    assert (side["loop"], side["seconds_per_frame"]) == (12.0, 2.0)
    assert (side["size"], side["size_unit"], side["unit"]) == ([50000.0, 25000.0], "cm", "cm")
    assert side["conventions"] == rules.conventions(PROFILES["unreal"])
    letters = {"bin": "RGBA", "ktx2": "RGBA", "exr-atlas": "RGB"}.get(name, "Y")
    assert side["channels"] == {letter: "1" if letter == "A" else "height" for letter in letters}
    if FORMATS[name].scaled:
        assert (side["lo"], side["hi"]) == ([scale["lo"]], [scale["hi"]])
    if name in ("bin", "ktx2"):
        assert side["shape"] == [FRAMES, ROWS, COLUMNS, 4]
        assert side["sha256"] == hashlib.sha256(files[side["file"]]).hexdigest()


def test_bare_halves_are_what_they_say():
    """Frame, row, column, RGBA: by NumPy's own reader of bare files."""
    sequence = water(3)
    files = assemble(
        "bin", [encode("bin", frame) for frame in sequence], stem="d", shape=sequence.shape
    )
    whole = np.frombuffer(files["d.bin"], dtype="<f2").reshape(FRAMES, ROWS, COLUMNS, 4)
    assert np.array_equal(whole[..., :3], sequence.astype(np.float16))


def test_a_bare_height_file_is_what_terrain_readers_take():
    sequence = water(1)
    words = np.frombuffer(encode("r16", sequence[0], **span(sequence)), dtype="<u2").reshape(
        ROWS, COLUMNS
    )
    lo, hi = sequence.min(), sequence.max()
    assert (
        np.max(np.abs(lo + words / 65535 * (hi - lo) - sequence[0, ..., 0]))
        <= 0.5 * (hi - lo) / 65535 * 1.0001
    )


def test_numpy_reads_an_npz():
    frame = water(3)[0]
    with np.load(io.BytesIO(encode("npz", frame))) as archive:
        assert archive.files == ["pixels"]
        assert archive["pixels"].tobytes() == frame.tobytes()


def test_paths_are_one_a_frame_and_within_the_folder():
    for format_ in FORMATS.values():
        paths = {format_.file.format(stem="height", frame=j) for j in range(12)}
        assert len(paths) == (12 if format_.scope == "frame" else 1)
        assert all(path.startswith("height") and ".." not in path for path in paths)
        assert format_.suffix in next(iter(paths))


@pytest.mark.parametrize("levels", [2, 4])
def test_mip_levels_come_back(levels):
    rng = np.random.default_rng(0)
    sizes = [(13, 10), (6, 5), (3, 2), (1, 1)][:levels]
    chain = [rng.standard_normal((*size, 3)).astype(np.float32) for size in sizes]
    data = encode("ktx2", chain[0], levels=chain[1:])
    again = decode_levels("ktx2", data, shape=(13, 10, 3), levels=levels)
    assert [a.shape for a in again] == [c.shape for c in chain]
    assert all(np.array_equal(a, c.astype(np.float16)) for a, c in zip(again, chain, strict=True))
    assert np.array_equal(decode("ktx2", data, shape=(13, 10, 3), levels=levels), again[0])
    with pytest.raises(IntegrityError):
        decode("ktx2", data, shape=(13, 10, 3))
    with pytest.raises(
        ParameterError, match=r"a mip level must have shape \(6, 5, 3\), got \(7, 5, 3\)"
    ):
        encode("ktx2", chain[0], levels=[np.zeros((7, 5, 3))])
    with pytest.raises(
        ParameterError, match="format ktx2 holds 1 to 4 mip levels of 13 rows of 10, got 5"
    ):
        require("ktx2", (1, 13, 10, 3), 5)


def test_a_format_without_all_of_its_parts_cannot_be_made():
    """
    A part that is left out, and parts that contradict one another, are errors where the format is
    made: at import.
    """
    parts = {
        field.name: getattr(FORMATS["bin"], field.name) for field in dataclasses.fields(Format)
    }
    assert Format(**parts) == FORMATS["bin"]
    for name in parts:
        with pytest.raises(TypeError, match=name):
            Format(**{key: part for key, part in parts.items() if key != name})
    for changes, why in (
        ({"container": None}, "must have either {frame} or a container"),
        ({"file": "{stem}/{frame:04d}.bin"}, "must have either {frame} or a container"),
        ({"file": "all.bin"}, "must be named after {stem}"),
        ({"sidecar": "all.json"}, "must be named after {stem}"),
    ):
        with pytest.raises(ImportError, match=re.escape(why)):
            dataclasses.replace(FORMATS["bin"], **changes)


def test_two_formats_or_profiles_of_one_name_are_an_error_at_import():
    for known in (FORMATS, PROFILES):
        assert by_name(known.values()) == known
        with pytest.raises(ImportError, match=r"names must differ, got '.+' twice"):
            by_name([*known.values(), next(iter(known.values()))])


def test_a_profile_without_a_part_cannot_be_made():
    parts = {f.name: getattr(PROFILES["godot"], f.name) for f in dataclasses.fields(Profile)}
    assert Profile(**parts) == PROFILES["godot"]
    for field in dataclasses.fields(Profile):
        if field.default is dataclasses.MISSING:
            with pytest.raises(TypeError, match=field.name):
                Profile(**{key: part for key, part in parts.items() if key != field.name})


def test_a_new_format_is_its_own_object_and_one_entry(monkeypatch):
    """Bytes are those of its own functions, whatever its name and its type of numbers."""
    doubled = dataclasses.replace(
        FORMATS["npz"],
        name="text",
        file="{stem}/{frame:04d}.txt",
        encode=lambda pixels, _scale, _levels: ",".join(
            f"{float(v)!r}" for v in pixels.ravel()
        ).encode(),
        decode=lambda data, shape, _scale, _levels: [
            np.array(data.decode().split(","), dtype=np.float32).reshape(shape)
        ],
    )
    monkeypatch.setitem(FORMATS, "text", doubled)
    frame = water(3)[0]
    data = encode("text", frame)
    assert data.decode().split(",")[0] == repr(float(frame[0, 0, 0]))
    assert np.array_equal(decode("text", data, shape=frame.shape), frame)
    assert doubled.suffix == ".txt"
    assert assemble("text", (), stem="m", shape=(1, *frame.shape)) == {}
