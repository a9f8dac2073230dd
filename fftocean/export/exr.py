"""
OpenEXR in the one profile that opens everywhere: single part, scanline, ZIP, channels R, G, B, half precision.

Row 0 of a picture is its top, the north of the tile; our arrays begin in the south. The flip happens here.
"""

import io

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import OutputError

HALF_MAX = 65504.0


def encode_half(red: Real, green: Real, blue: Real) -> bytes:
    """
    Encode three channels, each (ny, nx), row 0 south, as a half-float EXR file, row 0 north.

    Values are rounded to the nearest half, ties to even; data is marked as data, not colour, and as periodic.

    Raises:
        OutputError: a value is not finite or too large for a half, which would be clipped silently.
    """
    import OpenEXR

    channels = {}
    for name, values in (("R", red), ("G", green), ("B", blue)):
        extreme = float(np.max(np.abs(values), initial=0.0))
        if not extreme <= HALF_MAX:
            raise OutputError(f"channel {name} must stay within +-{HALF_MAX:g} to be a half float, got {extreme:g}")
        # OpenEXR writes wrong pixels from any array that is not C-contiguous, and does not say so
        channels[name] = np.ascontiguousarray(values[::-1], dtype=np.float16)
    header = {
        "compression": OpenEXR.ZIP_COMPRESSION,
        "type": OpenEXR.scanlineimage,
        "wrapmodes": "periodic,periodic",
        "colorInteropID": "data",
    }
    stream = io.BytesIO()
    OpenEXR.File(header, channels, 1).write(stream)
    return stream.getvalue()


def decode(data: bytes) -> tuple[Real, Real, Real]:
    """Return the three channels of an EXR file, row 0 south again, in the precision they are stored in."""
    import OpenEXR

    channels = OpenEXR.File(io.BytesIO(data), separate_channels=True).channels()
    red, green, blue = (np.ascontiguousarray(channels[name].pixels[::-1]) for name in ("R", "G", "B"))
    return red, green, blue
