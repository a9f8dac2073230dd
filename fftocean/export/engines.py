"""
Table of engines and formats: how each engine opens files of each format, or why it cannot.

A cell is a profile (with a note on how such a file gets into the engine), or a refusal with its
reason and an alternative format. A pair that is not listed is an error at import.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from fftocean.errors import ParameterError
from fftocean.export.formats import FORMATS
from fftocean.export.profiles import PROFILES, Normals, Profile


@dataclass(frozen=True, slots=True)
class Refusal:
    """A format that an engine cannot use."""

    reason: str
    instead: str  # format to choose instead


PLAIN_LOADER = "by the engine's own loader of pictures"
_EXR_FORMATS = "exr", "exr-float", "exr-atlas"
_ARRAYS = "npz", "zarr"
_PYTHON = "by your own Python code: row 0 of the array at v = 0"
_TOOLS = "for your own tools on the way: the engine has no loader for it, and takes bin"
PLAIN_BYTES = "by your own code, which uploads the bytes: row 0 at v = 0"
_EIGHT_BITS = "it reads PNG with 8 bits"
_NO_KTX2 = "it has no loader for a KTX 2.0 array of half floats"
_NO_WORDS = "it has no filtered texture of 16-bit integers"


def _loader(note: str = PLAIN_LOADER, **changes: Any) -> dict[str, Any]:
    """Return a cell: the engine's own loader opens the file."""
    return {"loaded": True, "note": note, **changes}


def _upload(note: str) -> dict[str, Any]:
    """Return a cell: the user's code reads the bytes and uploads them, row 0 at v = 0."""
    return {"loaded": False, "first_v": 0, "note": note}


def _row(**cells: dict[str, Any] | Refusal) -> dict[str, dict[str, Any] | Refusal]:
    """Return a row by format names; `_` in a keyword means `-`."""
    return {name.replace("_", "-"): cell for name, cell in cells.items()}


_WEB = _row(
    png16=Refusal(_EIGHT_BITS, "exr"),
    r16=Refusal(_NO_WORDS, "bin"),
    npz=_upload(_TOOLS),
    zarr=_upload(_TOOLS),
    bin=_upload(PLAIN_BYTES),
)

CELLS: dict[str, Mapping[str, dict[str, Any] | Refusal]] = {
    "canonical": {
        **{name: _loader("as an image viewer shows it") for name in (*_EXR_FORMATS, "png16")},
        **{name: _upload(PLAIN_BYTES) for name in ("r16", *_ARRAYS, "bin", "ktx2")},
    },
    "blender": _row(
        exr=_loader(),
        exr_float=_loader(),
        exr_atlas=_loader("for shader nodes, by the rule for the atlas; Displace wants exr"),
        png16=_loader("16 bit: strength hi - lo, midlevel -lo / (hi - lo)"),
        r16=_upload(_PYTHON),
        npz=_upload(_PYTHON),
        zarr=_upload(_PYTHON),
        bin=_upload(_PYTHON),
        ktx2=Refusal(_NO_KTX2, "exr"),
    ),
    "unity": _row(
        exr=_loader(),
        exr_float=_loader("choose the texture format RGBA Float"),
        exr_atlas=_loader("cut into a Texture2DArray by the importer"),
        png16=Refusal("its importer makes 8 bits of PNG unless told otherwise", "exr"),
        r16=_upload(f"{PLAIN_BYTES}; or Terrain's Import Raw, Flip Vertically on: row 0 is north"),
        npz=_upload(_TOOLS),
        zarr=_upload(_TOOLS),
        bin=_upload(PLAIN_BYTES),
        ktx2=Refusal(_NO_KTX2, "exr-atlas"),
    ),
    "unreal": _row(
        exr=_loader(),
        exr_float=_loader("Compression Settings HDR (RGBA32F); HDR alone keeps halves"),
        exr_atlas=_loader(),
        png16=_loader("16 bit with Compression Settings HDR, sRGB off"),
        r16=_upload("Landscape's import from file: row 0 is the edge of least Y"),
        npz=_upload(_TOOLS),
        zarr=_upload(_TOOLS),
        bin=_upload(PLAIN_BYTES),
        ktx2=Refusal(_NO_KTX2, "exr-atlas"),
    ),
    "godot": _row(
        exr=_loader(),
        exr_float=_loader(),
        exr_atlas=_loader("cut into a Texture2DArray by the importer"),
        png16=Refusal(_EIGHT_BITS, "exr"),
        r16=_upload("by a terrain plug-in or your own code: row 0 is the edge of least Z"),
        npz=_upload(_TOOLS),
        zarr=_upload(_TOOLS),
        bin=_upload(PLAIN_BYTES),
        ktx2=Refusal("its KTX loader refuses arrays", "exr-atlas"),
    ),
    "bevy": {
        **_WEB,
        **{name: _loader("by Bevy's feature exr, is_srgb false") for name in _EXR_FORMATS},
        "png16": Refusal("it makes unfilterable integers of gray 16-bit PNG", "exr"),
        "ktx2": _loader("by Bevy's feature ktx2, as a texture array"),
    },
    "gltf": {
        **_WEB,
        **{
            name: _loader("no texture of core glTF: by an EXR loader with row 0 at v = 0")
            for name in _EXR_FORMATS
        },
        "ktx2": Refusal("KHR_texture_basisu takes Basis Universal alone", "bin"),
    },
    "three": {
        **_WEB,
        **{name: _loader("by EXRLoader", **{"as": "three-exr"}) for name in _EXR_FORMATS},
        "ktx2": _upload("read by ktx-parse into a DataArrayTexture; KTX2Loader takes no array"),
    },
    "three-exr": {
        **{name: _loader("by EXRLoader") for name in _EXR_FORMATS},
        **{name: _upload("for your own tools on the way") for name in _ARRAYS},
        **{
            name: Refusal("its rows are those of EXRLoader; engine three has the others", "exr")
            for name in ("png16", "r16", "bin", "ktx2")
        },
    },
    "babylon": {
        **_WEB,
        **{
            name: _loader("by Texture, whose invertY is true", first_row="north", first_v=1)
            for name in _EXR_FORMATS
        },
        "ktx2": Refusal(_NO_KTX2, "bin"),
    },
    "houdini": _row(
        exr=_loader(),
        exr_float=_loader(),
        exr_atlas=_loader("by the rule for the atlas; a sequence of exr plays by itself"),
        png16=_loader("16 bit, raw colour space"),
        r16=_upload(_PYTHON),
        npz=_upload(_PYTHON),
        zarr=_upload(_PYTHON),
        bin=_upload(_PYTHON),
        ktx2=Refusal(_NO_KTX2, "exr"),
    ),
}


def _profile(engine: str, cell: dict[str, Any]) -> Profile:
    """Return an engine's profile for the files of one cell."""
    changes = dict(cell)
    return replace(PROFILES[changes.pop("as", engine)], **changes)


def table_of(
    cells: Mapping[str, Mapping[str, dict[str, Any] | Refusal]],
) -> dict[tuple[str, str], Profile | Refusal]:
    """
    Return the table by (engine, format), complete.

    Raises:
        ImportError: an engine or a format is missing, unknown, or refused without an alternative.
    """
    if cells.keys() != PROFILES.keys():
        raise ImportError(f"engines must be {', '.join(PROFILES)}, got {', '.join(cells)}")
    table: dict[tuple[str, str], Profile | Refusal] = {}
    for engine, row in cells.items():
        if row.keys() != FORMATS.keys():
            odd = ", ".join(sorted(row.keys() ^ FORMATS.keys()))
            raise ImportError(f"engine {engine} must have a cell for every format, not so: {odd}")
        for name, cell in row.items():
            if isinstance(cell, Refusal) and isinstance(row.get(cell.instead), Refusal | None):
                raise ImportError(f"engine {engine} cannot use {cell.instead} instead of {name}")
            table[engine, name] = cell if isinstance(cell, Refusal) else _profile(engine, cell)
    return table


TABLE = table_of(CELLS)


def profile_for(engine: str, format_name: str, normals: str = "engine") -> Profile:
    """
    Return the conventions of an engine's files of one format.

    Args:
        engine: by name.
        format_name: of the files.
        normals: "signed" or "packed"; "engine" is the encoding of its stock materials.

    Raises:
        ParameterError: no such engine, format or encoding, or the engine cannot use the format.
    """
    if engine not in PROFILES:
        raise ParameterError(f"engine must be one of {', '.join(PROFILES)}, got {engine!r:.40}")
    if format_name not in FORMATS:
        known = ", ".join(FORMATS)
        raise ParameterError(f"format must be one of {known}, got {format_name!r:.40}")
    cell = TABLE[engine, format_name]
    if isinstance(cell, Refusal):
        raise ParameterError(
            f"engine {engine} cannot use format {format_name}: {cell.reason}; choose format "
            f"{cell.instead}"
        )
    choices: dict[str, Normals] = {"engine": cell.normals, "signed": "signed", "packed": "packed"}
    if normals not in choices:
        raise ParameterError(f"normals must be one of {', '.join(choices)}, got {normals!r:.40}")
    return replace(cell, normals=choices[normals])
