"""
Settings of an engine for an atlas of frames: Godot's `.import`, and pages for Unity and Unreal.

Every figure, unit and rule of a page comes from the sidecar.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from fftocean.export.profiles import PROFILES, Profile


@dataclass(frozen=True, slots=True)
class Page:
    """File beside an atlas: the suffix to the atlas' name, and a function for its text."""

    suffix: str
    text: Callable[[str, Mapping[str, Any]], str]


def files_beside(profile: Profile, file: str, facts: Mapping[str, Any]) -> dict[str, bytes]:
    """
    Return the files beside an atlas in an engine's project, by name.

    Args:
        profile: conventions of the atlas.
        file: name of the atlas, without a folder.
        facts: contents of its sidecar.
    """
    if profile.name not in PAGES:
        return {}
    page = PAGES[profile.name]
    return {file + page.suffix: page.text(file, facts).encode()}


def godot_import(across: int, down: int) -> bytes:
    """Return Godot's settings for cutting an atlas into a texture array."""
    return _GODOT.format(across=across, down=down).encode()


def files_beside_frames(profile: Profile, frames: Iterable[str]) -> dict[str, bytes]:
    """
    Return the files beside the images of single frames in an engine's project, by path.

    Args:
        profile: conventions of the images.
        frames: their paths.
    """
    if profile.name != "godot":
        return {}
    return {path + FRAME_SUFFIX: GODOT_FRAME for path in frames if path.endswith(".exr")}


def _facts(facts: Mapping[str, Any]) -> str:
    """Return the facts for playing and sampling a map, one a line."""
    rule, conventions = facts["sampling"], facts["conventions"]
    values, time = rule["values"], facts["time_unit"]
    letters = ", ".join(f"{letter}: {word}" for letter, word in facts["channels"].items())
    lines = [
        f"Channels    {letters}",
        f"Unit        {'none (a pure number)' if facts['unit'] == '1' else facts['unit']}; linear",
        f"Axes        {conventions['axes']}",
        f"Lookup      {facts['lookup']}",
        f"Time        starts at {facts['start']:g} {time}, plays for {facts['loop']:g} {time}, "
        f"{facts['frames_per_second']:.6g} frames a second"
        + ("" if facts["closes"] else "; a part of the loop: the last frame does not lead on"),
    ]
    if facts["kind"] == "normal":
        lines.append(f"Normals     {conventions['normals']}; green {conventions['normal_green']}")
    if "bounds" in facts:
        bounds = facts["bounds"]
        lines.append(
            f"Culling     widen the mesh's bounds by {bounds['horizontal']:.6g} {bounds['unit']} "
            f"along the horizontal axes, by {bounds['vertical']:.6g} {bounds['unit']} up and down"
        )
    lines.append("Sample with (repeat wrap; place at rest and sizes in " + facts["size_unit"] + ")")
    lines += [f"    {name} = {text}" for name, text in rule.items() if name != "values"]
    lines.append("where " + ", ".join(f"{name} = {value:.12g}" for name, value in values.items()))
    lines.append("The whole part of frame is index; blend it with mod(index + 1, frames).")
    lines.append("The channels give")
    lines += [f"    {name} = {text}" for name, text in facts["world"].items()]
    return "\n".join(lines)


# compress/mode 3 is VRAM Uncompressed, which keeps the halves. Mode 2 is BC6H, which is coarse, and
# unsigned on some cards.
_GODOT = """[remap]

importer="2d_array_texture"
type="CompressedTexture2DArray"

[params]

compress/mode=3
compress/high_quality=false
compress/lossy_quality=1.0
compress/hdr_compression=0
compress/channel_pack=0
mipmaps/generate=false
mipmaps/limit=-1
slices/horizontal={across}
slices/vertical={down}
"""

FRAME_SUFFIX = ".import"
GODOT_FRAME = b"""[remap]

importer="texture"
type="CompressedTexture2D"

[params]

compress/mode=3
compress/high_quality=false
compress/lossy_quality=1.0
compress/hdr_compression=0
compress/normal_map=2
compress/channel_pack=0
mipmaps/generate=false
mipmaps/limit=-1
roughness/mode=0
process/fix_alpha_border=false
process/premult_alpha=false
process/normal_map_invert_y=false
process/hdr_as_srgb=false
process/hdr_clamp_exposure=false
process/size_limit=0
detect_3d/compress_to=0
"""
"""
Godot's settings for the image of one frame: data, uncompressed, also where a 3D material uses it.
"""

_UNITY = """Unity: {file} as a Texture2DArray (not run in Unity: \
compare slice 0 with the first cell)

Inspector of the texture:
    Texture Type      Default
    Texture Shape     2D Array, Columns {across}, Rows {down} (cells of frames)
    sRGB              off
    Alpha Source      {alpha}
    Alpha Is Transparency  off
    Non-Power of 2    None
    Read/Write        as you need
    Generate Mipmaps  off
    Wrap Mode         Repeat
    Filter Mode       Bilinear
    Max Size          at least the larger side of the file
    Format            RGBA Half (Default tab: override, no compression)

Or by script, in an Editor folder:
    var importer = (TextureImporter)AssetImporter.GetAtPath(path);
    var settings = new TextureImporterSettings();
    importer.ReadTextureSettings(settings);
    settings.textureShape = TextureImporterShape.Texture2DArray;
    settings.flipbookColumns = {across};
    settings.flipbookRows = {down};
    settings.sRGBTexture = false;
    settings.alphaSource = TextureImporterAlphaSource.{source};
    settings.alphaIsTransparency = false;
    settings.mipmapEnabled = false;
    settings.npotScale = TextureImporterNPOTScale.None;
    settings.wrapMode = TextureWrapMode.Repeat;
    importer.SetTextureSettings(settings);
    var platform = importer.GetDefaultPlatformTextureSettings();
    platform.format = TextureImporterFormat.RGBAHalf;
    platform.maxTextureSize = 16384;
    importer.SetPlatformTextureSettings(platform);
    importer.SaveAndReimport();

Cells run from left to right, then down.
{facts}
"""

_UNREAL = """Unreal: {file} as a flipbook in one texture (not run in Unreal: \
compare frame 0 with the first cell)

Details of the texture:
    Compression Settings   HDR (RGBA16F, no BC6H)
    sRGB                   off
    Mip Gen Settings       NoMipmaps
    Texture Group          any; LOD Bias 0; Maximum Texture Size 0
    Power Of Two Mode      None
    Never Stream           on
    X- and Y-axis Tiling   Wrap

{across} cells across and {down} down, from left to right, then down; around each frame stand
texels of its opposite edges, so that a bilinear sampler wraps.
{facts}
"""


def _filled(template: str) -> Callable[[str, Mapping[str, Any]], str]:
    """Return a function that fills in a page from an atlas' name and sidecar."""

    def text(file: str, facts: Mapping[str, Any]) -> str:
        across, down = facts["tiles"]
        four = "A" in facts["channels"]
        return template.format(
            file=file,
            across=across,
            down=down,
            alpha="Input Texture Alpha" if four else "None",
            source="FromInput" if four else "None",
            facts=_facts(facts) if "{facts}" in template else "",
        )

    return text


def pages_of(pages: Mapping[str, Page]) -> Mapping[str, Page]:
    """
    Return pages by profile.

    Raises:
        ImportError: a page for an unknown profile, without a suffix, or with that of another page.
    """
    if not pages.keys() <= PROFILES.keys():
        raise ImportError(f"pages must be for profiles, got {', '.join(pages)}")
    suffixes = [page.suffix for page in pages.values()]
    if len({*suffixes, ""}) <= len(suffixes):
        raise ImportError(f"each page must have a suffix of its own, got {', '.join(suffixes)}")
    return pages


PAGES = pages_of(
    {
        "godot": Page(".import", _filled(_GODOT)),
        "unity": Page(".unity.txt", _filled(_UNITY)),
        "unreal": Page(".unreal.txt", _filled(_UNREAL)),
    }
)
