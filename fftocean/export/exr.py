"""
OpenEXR in the profile that every program opens.

It is single part, scanline, ZIP, with channels R, G, B (, A) in half or single precision. Files are
written here, and read by the OpenEXR library. ISA-L deflates, without the GIL, in 0.4 of the time
of libdeflate at OpenEXR's level. Files are 1 % smaller, as low and high bytes have a code each.
"""

import io
import struct
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import IntegrityError, OutputError
from fftocean.export.form import (
    HALF_MAX as HALF_MAX,
)
from fftocean.export.form import (
    Format,
    Layout,
    Scale,
    as_finite,
    as_half,
    one_level,
    require_finite,
    select_channels,
)
from fftocean.kernels import byte_planes

ROWS = 16
"""Rows of a block, which OpenEXR compresses together: that of ZIP."""

LEVEL = 3
"""Level of ISA-L, its best; 2 takes 0.6 of the time, for files that are an eighth larger."""


def encode(pixels: Real, *, periodic: bool = True) -> bytes:
    """
    Encode pixels without conversion, row 0 on top, marked as data, not colour.

    Args:
        pixels: (rows, columns, 1, 3 or 4), float16 or float32, every value finite. One channel is
            written as R, G and B alike.
        periodic: mark it as repeating without a seam.
    """
    # the kernel reads words in order
    pixels = np.ascontiguousarray(pixels, dtype=pixels.dtype.newbyteorder("="))
    rows, columns, count = pixels.shape
    order = np.array({1: (0, 0, 0), 3: (2, 1, 0), 4: (3, 2, 1, 0)}[count])  # (A,) B, G, R
    words = pixels.view(np.uint16).reshape(rows, columns, count, -1)
    planes = np.empty(words[..., :1, :].size * order.size * 2, np.uint8)
    byte_planes.differences(words, order, ROWS, planes)
    head = _header(rows, columns, "RGBA"[: order.size], pixels.dtype, periodic)
    blocks: list[bytes] = []
    offsets: list[int] = []
    place = len(head) + 8 * -(-rows // ROWS)
    for top in range(0, rows, ROWS):
        size = planes.size * min(ROWS, rows - top) // rows
        start = planes.size * top // rows
        parts = _deflated(planes[start : start + size].data)
        if (length := sum(map(len, parts))) >= size:
            # a reader takes a block of full size for one without compression
            parts, length = [_plain(pixels[top : top + ROWS, :, order])], size
        blocks += (struct.pack("<ii", top, length), *parts)
        offsets.append(place)
        place += 8 + length
    return b"".join((head, struct.pack(f"<{len(offsets)}Q", *offsets), *blocks))


def _deflated(planes: memoryview) -> list[bytes]:
    """Return the parts of a zlib stream in which low and high bytes have a code table each."""
    from isal import isal_zlib

    middle = len(planes) // 2
    stream = isal_zlib.compressobj(LEVEL)
    return [
        stream.compress(planes[:middle]),
        stream.flush(isal_zlib.Z_SYNC_FLUSH),
        stream.compress(planes[middle:]),
        stream.flush(),
    ]


def _plain(pixels: npt.NDArray[Any]) -> bytes:
    """Return the bytes of a block without compression: in each row channel by channel."""
    return pixels.transpose(0, 2, 1).astype(pixels.dtype.newbyteorder("<")).tobytes()


def _header(rows: int, columns: int, channels: str, dtype: np.dtype[Any], periodic: bool) -> bytes:
    """
    Return magic number, version and attributes of a file.

    Source: OpenEXR, "OpenEXR File Layout" (attributes in the order of their names).
    """
    kind = {2: 1, 4: 2}[dtype.itemsize]  # half, float
    window = struct.pack("<4i", 0, 0, columns - 1, rows - 1)
    attributes = {
        "channels": (
            "chlist",
            b"".join(
                name.encode() + struct.pack("<xi4xii", kind, 1, 1) for name in sorted(channels)
            )
            + b"\0",
        ),
        "colorInteropID": ("string", b"data"),
        "compression": ("compression", b"\3"),  # ZIP
        "dataWindow": ("box2i", window),
        "deflate": ("string", f"ISA-L, level {LEVEL}".encode()),
        "displayWindow": ("box2i", window),
        "lineOrder": ("lineOrder", b"\0"),  # row 0 first
        "pixelAspectRatio": ("float", struct.pack("<f", 1.0)),
        "screenWindowCenter": ("v2f", struct.pack("<2f", 0.0, 0.0)),
        "screenWindowWidth": ("float", struct.pack("<f", 1.0)),
        "type": ("string", b"scanlineimage"),
        **({"wrapmodes": ("string", b"periodic,periodic")} if periodic else {}),
    }
    return (
        struct.pack("<II", 20000630, 2)
        + b"".join(
            name.encode() + b"\0" + form.encode() + b"\0" + struct.pack("<i", len(value)) + value
            for name, (form, value) in attributes.items()
        )
        + b"\0"
    )


def read(data: bytes, shape: tuple[int, int] | None = None) -> npt.NDArray[Any]:
    """
    Return the stored pixels of a file, (rows, columns, 3 or 4), in their stored precision.

    Args:
        data: the file.
        shape: required (rows, columns), checked before any pixel is read.

    Raises:
        IntegrityError: the file is cut or damaged, of another shape, or not of the kind that
            `encode` writes.
    """
    import OpenEXR

    try:
        if shape is not None:
            low, high = OpenEXR.File(io.BytesIO(data), header_only=True).header()["dataWindow"]
            found = int(high[1]) - int(low[1]) + 1, int(high[0]) - int(low[0]) + 1
            if found != tuple(shape):
                raise IntegrityError(
                    f"an EXR image must be {shape[0]} rows of {shape[1]}, "
                    f"got {found[0]} of {found[1]}"
                )
        channels = OpenEXR.File(io.BytesIO(data), separate_channels=True).channels()
        planes = [channels[name].pixels for name in ("RGBA" if len(channels) == 4 else "RGB")]
        if len(channels) != len(planes) or len({plane.dtype for plane in planes}) != 1:
            raise IntegrityError(
                "an EXR image must have channels R, G, B (, A) of one type, "
                f"got {', '.join(channels)}"
            )
        return np.stack(planes, axis=-1)
    except IntegrityError:
        raise
    except Exception as error:  # the library may raise anything on damaged bytes
        raise IntegrityError(f"an EXR image cannot be read: {f'{error}'.strip():.200}") from None


def encode_half(red: Real, green: Real, blue: Real) -> bytes:
    """
    Encode three channels, each (ny, nx), row 0 south, as a half-float EXR file, row 0 north.

    Values are rounded to the nearest half, ties to even.

    Raises:
        OutputError: a value is not finite or too large for a half, which would be clipped silently.
    """
    halves = []
    for name, values in (("R", red), ("G", green), ("B", blue)):
        extreme = float(np.max(np.abs(values), initial=0.0))
        if not extreme <= HALF_MAX:
            raise OutputError(
                f"channel {name} must stay within +-{HALF_MAX:g} to be a half float, "
                f"got {extreme:g}"
            )
        halves.append(values[::-1].astype(np.float16))
    return encode(np.stack(halves, axis=-1))


def decode(data: bytes) -> tuple[Real, Real, Real]:
    """
    Return the three channels of an EXR file, row 0 south, in their stored precision.

    Raises:
        IntegrityError: the file is cut or damaged.
    """
    pixels = read(data)[::-1]
    red, green, blue = (np.ascontiguousarray(pixels[..., c]) for c in range(3))
    return red, green, blue


def no_sidecar(_facts: Mapping[str, Any], _layout: Layout) -> bytes:
    """Return nothing: the manifest has all facts about such files."""
    return b""


def _format(
    name: str,
    stored: Literal["float16", "float32"],
    caption: str,
    rounded: Callable[[Real], npt.NDArray[Any]],
) -> Format:
    """Return a format of one file a frame, with numbers of one type."""

    def encode_frame(pixels: Real, _scale: Scale, _levels: Sequence[Real]) -> bytes:
        return encode(rounded(pixels))

    def decode_frame(
        data: bytes, shape: tuple[int, int, int] | None, _scale: Scale, _levels: int
    ) -> list[npt.NDArray[Any]]:
        pixels = read(data, None if shape is None else shape[:2])
        if pixels.dtype != stored:
            raise IntegrityError(f"format {name} must hold {stored}, got {pixels.dtype}")
        return [require_finite(select_channels(pixels, shape))]

    return Format(
        name=name,
        caption=caption,
        file="{stem}/{frame:04d}.exr",
        numbered="frame",
        stored=stored,
        channels=(1, 3, 4),
        least=3,
        sidecar="",
        sidecar_bytes=no_sidecar,
        most_levels=one_level,
        encode=encode_frame,
        decode=decode_frame,
        container=None,
    )


EXR = _format("exr", "float16", "OpenEXR, half, ZIP", as_half)
EXR_FLOAT = _format(
    "exr-float",
    "float32",
    "OpenEXR, single precision, ZIP",
    lambda pixels: as_finite(pixels, np.float32),
)
