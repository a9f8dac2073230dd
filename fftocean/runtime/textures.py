"""Textures of waves, float32, in the formats that engines open; and the table of a transform."""

from typing import Any

import numpy as np

from fftocean.arrays import Real
from fftocean.engine_projects import TEXTURES
from fftocean.errors import IntegrityError, ParameterError
from fftocean.export import exr, ktx2


def textures_ending(textures: Any) -> str | None:
    """
    Return the format of textures: that which was asked for, "bin" for True, None for False.

    Raises:
        ParameterError: it is no such format.
    """
    if isinstance(textures, (bool, np.bool_)):
        return "bin" if textures else None
    if not isinstance(textures, str) or textures not in TEXTURES:
        raise ParameterError(
            f"textures must be True, False or one of {', '.join(TEXTURES)}, got {textures!r:.40}"
        )
    return textures


def encode(pixels: Real, ending: str) -> tuple[bytes, str]:
    """
    Return the bytes of a texture, and the name of what they are.

    Row 0 of the array is row 0 of the file. An EXR image has three channels at least: of a texture
    of two, the third is 0.

    Args:
        pixels: (rows, columns, 2 or 4) float32.
        ending: of the file, one of `TEXTURES`.
    """
    if ending == "ktx2":
        return ktx2.encode_float(pixels), "ktx2, float32"
    if ending == "exr":
        rows, columns, channels = pixels.shape
        wide = np.zeros((rows, columns, max(channels, 3)), np.float32)
        wide[..., :channels] = pixels
        return exr.encode(wide, periodic=False), "exr, float32"
    return pixels.tobytes(), "float32"


def decode(data: bytes, ending: str, shape: tuple[int, int, int]) -> Real:
    """
    Return the pixels of a texture.

    Raises:
        IntegrityError: the bytes hold no such texture.
    """
    if ending == "ktx2":
        return ktx2.decode_float(data, shape)
    if ending == "exr":
        pixels = exr.read(data, shape[:2])
        if pixels.dtype != np.float32 or pixels.shape[2] != max(shape[2], 3):
            raise IntegrityError(f"a texture must hold float32, got {pixels.dtype}")
        return np.asarray(pixels[..., : shape[2]])
    if len(data) != 4 * int(np.prod(shape)):
        raise IntegrityError(f"a texture must have {4 * int(np.prod(shape))} bytes")
    return np.frombuffer(data, "<f4").reshape(shape)


def twiddle(n: int) -> Real:
    """Return cosine and sine of 2 pi i/n, (n, 2) float32, for transforms of up to n samples."""
    turn = np.arange(n) / n
    # Multiples of an eighth of a turn are right to the last bit.
    angle = 2.0 * np.pi * turn
    table = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    table[np.abs(table) < 1e-9] = 0.0
    return table.astype(np.float32)
