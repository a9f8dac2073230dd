"""EXR files: the given pixels, rounded once, north row on top, never clipped."""

import io
import struct

import numpy as np
import OpenEXR
import pytest

import fftocean as fo
from fftocean.baking.scene.maps import MAPS
from fftocean.errors import IntegrityError, OutputError
from fftocean.export import exr
from fftocean.export.formats import encode
from fftocean.export.profiles import PROFILES, arrange
from fftocean.fields import EIGHT

pytestmark = pytest.mark.nojit

SHAPES = [(1, 1), (1, 7), (7, 1), (2, 2), (31, 31), (80, 48), (17, 256)]  # (ny, nx)


def raw(data):
    """Return header and pixels as OpenEXR reads them, without reordering rows."""
    file = OpenEXR.File(io.BytesIO(data), separate_channels=True)
    return file.header(), {name: channel.pixels for name, channel in file.channels().items()}


def fields(shape, dtype=np.float64, seed=0):
    """
    Return three channels of all magnitudes that a half can hold, from subnormals to thousands, of
    both signs.
    """
    rng = np.random.default_rng(seed)
    return [
        (rng.choice([-1.0, 1.0], shape) * 10.0 ** rng.uniform(-8.0, 4.8, shape)).astype(dtype)
        for _ in range(3)
    ]


def rounded(values):
    """
    Return the nearest half of each value, ties to even, by C's packing, because the NumPy cast is
    under test.
    """
    flat = [struct.unpack("<e", struct.pack("<e", float(v)))[0] for v in np.ravel(values)]
    return np.array(flat, dtype=np.float64).reshape(np.shape(values))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("shape", SHAPES)
def test_pixels_are_the_fields_rounded_once_and_row_0_is_north(shape, dtype):
    """
    By the raw reader: R, G, B as given, the last row of a field (the northmost) first, every value
    its nearest half.
    """
    channels = fields(shape, dtype)
    _, pixels = raw(exr.encode_half(*channels))
    assert sorted(pixels) == ["B", "G", "R"]
    for name, values in zip("RGB", channels, strict=True):
        assert pixels[name].dtype == np.float16
        assert pixels[name].shape == shape
        assert np.array_equal(pixels[name].astype(np.float64), rounded(values)[::-1])


def test_rounding_is_at_most_half_a_step():
    """
    |stored - given| <= 0.5 ulp of the stored half, ties and the smallest subnormals (2^-24)
    included.
    """
    steps = np.arange(-4096, 4096) * 2.0**-25  # every second one is a tie between two subnormals
    values = np.concatenate([steps, *(np.ravel(c) for c in fields((64, 64)))])[None, :]
    stored, _, _ = exr.decode(exr.encode_half(values, values, values))
    ulp = np.abs(np.spacing(stored)).astype(np.float64)
    assert np.all(np.abs(stored.astype(np.float64) - values) <= 0.5 * ulp)


def test_every_half_survives_to_the_bit():
    """All 63 488 finite halves, -0 among them."""
    bits = np.arange(2**16, dtype=np.uint16)
    halves = bits[(bits & 0x7C00) != 0x7C00].view(np.float16).reshape(248, 256)
    red, green, blue = exr.decode(
        exr.encode_half(halves.astype(np.float32), halves.astype(np.float64), halves)
    )
    for channel in (red, green, blue):
        assert np.array_equal(channel.view(np.uint16), halves.view(np.uint16))


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
@pytest.mark.parametrize(
    "view",
    [
        lambda a: a.T.copy().T,
        lambda a: np.asfortranarray(a),
        lambda a: np.repeat(np.repeat(a, 2, axis=0), 3, axis=1)[::2, ::3],
        lambda a: a[::-1].copy()[::-1],
        lambda a: a[:, ::-1].copy()[:, ::-1],
        lambda a: np.stack([a, a + 1, a + 2], axis=-1)[..., 0],
        lambda a: np.broadcast_to(a[:1], a.shape),
        lambda a: (
            np.frombuffer(b"\0" + a.tobytes(), dtype=np.uint8)[1:].view(a.dtype).reshape(a.shape)
        ),
    ],
    ids=[
        "transposed",
        "fortran",
        "strided",
        "upside-down",
        "mirrored",
        "interleaved",
        "broadcast",
        "misaligned",
    ],
)
@pytest.mark.parametrize("shape", [(5, 7), (1, 7), (7, 1)])
def test_arrays_of_any_layout_give_their_own_pixels(shape, view, dtype):
    """The encoder reads memory in order, whatever the layout of the array that it is given."""
    values = view(np.arange(shape[0] * shape[1], dtype=dtype).reshape(shape))
    _, pixels = raw(exr.encode_half(values, values, values))
    for name in "RGB":
        assert np.array_equal(pixels[name], values[::-1].astype(np.float16))


def test_header_is_one_that_every_engine_opens():
    """
    One part, scanlines, ZIP, marked as data and as periodic; and no clock in it: the same pixels
    are the same bytes.
    """
    channels = fields((9, 4), np.float32)
    data = exr.encode_half(*channels)
    header, _ = raw(data)
    assert header["compression"] == OpenEXR.ZIP_COMPRESSION
    assert header["type"] == OpenEXR.scanlineimage
    assert header["wrapmodes"] == "periodic,periodic"
    assert header["colorInteropID"] == "data"
    assert header["deflate"] == "ISA-L, level 3"
    assert struct.unpack("<II", data[:8]) == (
        20000630,
        2,
    )  # magic number; version 2 without flags for tiles, deep or several parts
    assert exr.encode_half(*channels) == data


def by_openexr(red, green, blue):
    """Return the file that the OpenEXR library writes of the same pixels."""
    channels = {
        name: np.ascontiguousarray(values[::-1], dtype=np.float16)
        for name, values in (("R", red), ("G", green), ("B", blue))
    }
    header = {
        "compression": OpenEXR.ZIP_COMPRESSION,
        "type": OpenEXR.scanlineimage,
        "wrapmodes": "periodic,periodic",
        "colorInteropID": "data",
    }
    stream = io.BytesIO()
    OpenEXR.File(header, channels, 1).write(stream)
    return stream.getvalue()


@pytest.mark.parametrize("shape", SHAPES)
def test_header_and_pixels_are_those_that_openexr_writes(shape):
    """By the raw reader; only the remark on deflate is another."""
    red, green, blue = fields(shape, np.float32)
    expected_header, expected = raw(by_openexr(red, green, blue))
    header, found = raw(exr.encode_half(red, green, blue))
    assert header.pop("deflate").startswith("ISA-L")
    assert repr(header) == repr(expected_header)
    for name in "RGB":
        assert np.array_equal(found[name].view(np.uint16), expected[name].view(np.uint16))


@pytest.mark.parametrize("shape", SHAPES)
def test_the_same_pixels_are_the_same_bytes(shape):
    """Interleaved or plane by plane, from one channel or from three: the file is the same."""
    red, green, blue = fields(shape, np.float32)
    pixels = np.stack([red, green, blue], axis=-1)[::-1].astype(np.float16)
    assert exr.encode(pixels) == exr.encode_half(red, green, blue)
    assert exr.encode(pixels[..., :1]) == exr.encode_half(red, red, red)


@pytest.mark.parametrize("dtype", [np.uint16, np.uint32])
def test_noise_is_stored_without_compression(dtype):
    """
    Random bits do not become fewer by deflate: a block of full size is read as it stands, so that
    a file exceeds its pixels by its header and eight bytes a block, and eight for its offset.
    """
    rng = np.random.default_rng(2)
    bits = rng.integers(0, np.iinfo(dtype).max, (40, 33, 3), dtype=dtype, endpoint=True)
    real = {np.uint16: np.float16, np.uint32: np.float32}[dtype]
    data = exr.encode(bits.view(real))
    _, found = raw(data)
    for i, name in enumerate("RGB"):
        assert np.array_equal(found[name].view(dtype), bits[..., i])
    blocks = -(-40 // 16)
    assert bits.nbytes < len(data) <= bits.nbytes + 16 * blocks + 500


def test_a_block_that_stays_as_large_is_stored_plain(monkeypatch):
    """Of exactly its full size, a reader would take it for one without compression."""
    monkeypatch.setattr(exr, "_deflated", lambda planes: [bytes(len(planes))])
    pixels = np.random.default_rng(4).standard_normal((35, 9, 3)).astype(np.float32)
    _, found = raw(exr.encode(pixels))
    for i, name in enumerate("RGB"):
        assert np.array_equal(found[name], pixels[..., i])


@pytest.mark.parametrize("name", ["height", "displacement", "normal"])
def test_files_are_hardly_larger_than_those_of_openexr(name):
    """
    At its standard level: at 128 x 128, 1 to 4 % smaller with this sea. The bound is what a few
    per cent allow.
    """
    frame = fo.Ocean(fo.Sea.from_wind(speed=12.0, fetch=100e3), n=128, size=250.0, seed=3).frame(
        0.0, (*EIGHT, "normal")
    )
    entry = MAPS[name]
    pixels = arrange(PROFILES["canonical"], entry.kind, entry.channels(frame))
    planes = [pixels[::-1, :, min(c, pixels.shape[2] - 1)] for c in range(3)]
    assert len(exr.encode_half(*planes)) <= 1.03 * len(by_openexr(*planes))


@pytest.mark.parametrize("dtype", [np.float16, np.float32])
@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize("shape", SHAPES)
def test_pixels_stand_as_given(shape, channels, dtype):
    """
    Row 0 on top, in the precision given, RGB or RGBA; one channel stands in all three. By the raw
    reader, and by ours.
    """
    pixels = np.random.default_rng(1).standard_normal((*shape, channels)).astype(dtype)
    header, found = raw(exr.encode(pixels, periodic=False))
    assert "wrapmodes" not in header
    assert set(found) == set("RGBA" if channels == 4 else "RGB")
    for i, name in enumerate("RGBA"[: max(3, channels)]):
        assert found[name].dtype == dtype
        assert np.array_equal(found[name], pixels[..., min(i, channels - 1)])
    again = exr.read(exr.encode(pixels), shape)
    assert again.dtype == dtype
    assert np.array_equal(again, np.broadcast_to(pixels, again.shape))


def test_another_size_or_other_channels_are_refused():
    with pytest.raises(IntegrityError, match="an EXR image must be 4 rows of 6, got 6 of 4"):
        exr.read(exr.encode(np.zeros((6, 4, 3), np.float16)), (4, 6))
    stream = io.BytesIO()
    OpenEXR.File({"type": OpenEXR.scanlineimage}, {"Y": np.zeros((4, 4), np.float16)}).write(stream)
    with pytest.raises(IntegrityError, match="an EXR image cannot be read: 'R'"):
        exr.read(stream.getvalue())
    stream = io.BytesIO()
    mixed = {
        "R": np.zeros((4, 4), np.float16),
        "G": np.zeros((4, 4), np.float32),
        "B": np.zeros((4, 4), np.float16),
    }
    OpenEXR.File({"type": OpenEXR.scanlineimage}, mixed).write(stream)
    with pytest.raises(
        IntegrityError, match=r"must have channels R, G, B \(, A\) of one type, got B, G, R"
    ):
        exr.read(stream.getvalue())


def test_decode_turns_south_up_again():
    channels = fields((6, 5), np.float32)
    for given, got in zip(channels, exr.decode(exr.encode_half(*channels)), strict=True):
        assert got.flags.c_contiguous
        assert np.array_equal(got, given.astype(np.float16))


def test_a_cut_or_flipped_file_is_never_other_water():
    """
    Cut anywhere, it is refused; with a bit flipped too, or the flip was in a remark of the header:
    ZIP has a checksum for the rest.
    """
    values = np.random.default_rng(0).normal(size=(40, 30)).astype(np.float32)
    data = exr.encode_half(values, values, values)
    for end in range(0, len(data), 211):
        with pytest.raises(IntegrityError, match="an EXR image cannot be read"):
            exr.decode(data[:end])
    for i in range(0, len(data), 101):
        try:
            channels = exr.decode(data[:i] + bytes([data[i] ^ 4]) + data[i + 1 :])
        except IntegrityError:
            continue
        assert all(np.array_equal(c, values.astype(np.float16)) for c in channels)


@pytest.mark.parametrize("bad", [65505.0, -65505.0, 65520.0, 1e30, np.inf, -np.inf, np.nan])
@pytest.mark.parametrize("where", [0, 1, 2])
def test_what_a_half_cannot_hold_is_refused(where, bad):
    """
    Beyond +-65504 a half is infinite: one such value in any channel is an error that names the
    channel and the value.
    """
    channels = [np.zeros((3, 4), np.float32) for _ in range(3)]
    channels[where][1, 2] = bad
    with pytest.raises(
        OutputError, match=rf"channel {'RGB'[where]} must stay within \+-65504 .* got "
    ) as caught:
        exr.encode_half(*channels)
    assert caught.value.exit_code == 4


def test_the_largest_half_passes():
    edge = np.array([[65504.0, -65504.0]])
    for channel in exr.decode(exr.encode_half(edge, edge, edge)):
        assert np.array_equal(channel, edge.astype(np.float16))


def baked(name, frame):
    """Return a map of a frame as the canonical image."""
    entry = MAPS[name]
    return encode("exr", arrange(PROFILES["canonical"], entry.kind, entry.channels(frame)))


@pytest.mark.parametrize("n", [1, 8, 31, (6, 10)])
def test_a_flat_sea_points_exactly_up(n):
    """Height 0, normal (0, 0, 1), Jacobian 1, without a rounding."""
    ocean = fo.Ocean.from_modes([], n=n, size=10.0, loop=4.0)
    frame = ocean.loop_frame(1, 3, (*EIGHT, "normal", "jacobian"))
    x, y, z = exr.decode(baked("normal", frame))
    assert not x.any()
    assert not y.any()
    assert np.all(z == 1.0)
    for name, value in (("height", 0.0), ("displacement", 0.0), ("jacobian", 1.0)):
        for channel in exr.decode(baked(name, frame)):
            assert np.all(channel == value)


def test_north_is_up_in_a_baked_map():
    """
    A wave whose crest lies on the row iy = ny/4: in the file it is 3/4 of the way down, whichever
    map it is read from.
    """
    ocean = fo.Ocean.from_modes(
        [(0, 1, 1.0, 0.5 * np.pi)], n=(8, 16), size=(8.0, 16.0), loop=100.0, dtype="float64"
    )  # cos(ky - pi/2)
    frame = ocean.frame(0.0)
    _, pixels = raw(baked("displacement", frame))
    assert np.all(np.argmax(pixels["B"], axis=0) == 16 - 1 - 4)  # blue is the height
    toward_crest = pixels["G"][
        :, 0
    ]  # green is the displacement north: south of the crest water is drawn north
    assert toward_crest[16 - 1 - 3] > 0.0
    assert toward_crest[16 - 1 - 5] < 0.0
