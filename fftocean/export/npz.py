"""NumPy archive of one frame, with one array, `pixels`, and a constant time stamp."""

import io
import zipfile
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import IntegrityError
from fftocean.export.exr import no_sidecar
from fftocean.export.form import Format, Scale, as_finite, one_level, require_finite

MEMBER = "pixels.npy"


def encode(pixels: npt.NDArray[np.float32]) -> bytes:
    """
    Return (rows, columns, channels) of float32 as an archive with the checksum of ZIP.

    The data are stored uncompressed, because floats hardly compress.
    """
    array, archive = io.BytesIO(), io.BytesIO()
    np.lib.format.write_array(array, pixels.astype("<f4", copy=False), version=(1, 0))
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_STORED) as file:
        file.writestr(zipfile.ZipInfo(MEMBER, (1980, 1, 1, 0, 0, 0)), array.getvalue())
    return archive.getvalue()


def read(data: bytes, shape: tuple[int, int, int] | None = None) -> npt.NDArray[np.float32]:
    """
    Return the pixels of an archive of `encode`.

    Args:
        data: the file.
        shape: required shape of the array.

    Raises:
        IntegrityError: the file is cut or damaged, of another shape, or from another program.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as file:
            (member,) = file.infolist()
            if member.filename != MEMBER or member.compress_type != zipfile.ZIP_STORED:
                raise IntegrityError(
                    f"an NPZ file of a bake must hold {MEMBER}, stored, got {member.filename:.60}"
                )
            content = file.read(member)  # verifies its checksum
        pixels = np.lib.format.read_array(io.BytesIO(content), allow_pickle=False)
    except IntegrityError:
        raise
    except Exception as error:  # the library may raise anything on damaged bytes
        raise IntegrityError(f"an NPZ file cannot be read: {error!s:.200}") from None
    if (
        pixels.dtype != np.float32
        or pixels.ndim != 3
        or (shape is not None and pixels.shape != tuple(shape))
    ):
        wanted = tuple(shape) if shape else "(rows, columns, channels)"
        raise IntegrityError(
            f"an NPZ file must hold float32 of shape {wanted}, got {pixels.dtype} of {pixels.shape}"
        )
    return np.asarray(pixels, dtype=np.float32)


def _encode_frame(pixels: Real, _scale: Scale, _levels: Sequence[Real]) -> bytes:
    return encode(as_finite(pixels, np.float32))


def _decode_frame(
    data: bytes, shape: tuple[int, int, int] | None, _scale: Scale, _levels: int
) -> list[npt.NDArray[Any]]:
    return [require_finite(read(data, shape))]


NPZ = Format(
    name="npz",
    caption="NumPy, single precision",
    file="{stem}/{frame:04d}.npz",
    numbered="frame",
    stored="float32",
    channels=(1, 3, 4),
    least=1,
    sidecar="",
    sidecar_bytes=no_sidecar,
    most_levels=one_level,
    encode=_encode_frame,
    decode=_decode_frame,
    container=None,
)
