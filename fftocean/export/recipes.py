"""What to set in an engine for an atlas of frames: Godot's `.import` beside it, and a page of steps for Unity and Unreal."""

from fftocean.export.profiles import Profile


def beside(profile: Profile, file: str, *, columns: int, rows: int, loop: float) -> dict[str, bytes]:
    """
    Return the files that belong beside an atlas in one engine's project, by name; none for an engine that needs none.

    Args:
        profile: whose.
        file: the atlas' own name, without a folder.
        columns, rows: of frames in it.
        loop: what they take to play through [s].
    """
    frames = columns * rows
    play = f"frame = floor(time / {loop:g} * {frames}) mod {frames}; between two frames blend frame and (frame + 1) mod {frames}"
    sample = "\n".join(f"    {line}" for line in profile.describe()["samples"].removesuffix(", repeated").split(", "))
    if profile.name == "godot":
        return {f"{file}.import": _GODOT.format(columns=columns, rows=rows).encode()}
    if profile.name == "unity":
        return {f"{file}.unity.txt": _UNITY.format(file=file, columns=columns, rows=rows, play=play, sample=sample).encode()}
    if profile.name == "unreal":
        return {f"{file}.unreal.txt": _UNREAL.format(file=file, columns=columns, rows=rows, play=play, sample=sample).encode()}
    return {}


# compress/mode 3 is VRAM Uncompressed: the halves as they are. Mode 2 would be BC6H, which is coarse and unsigned on some cards.
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
slices/horizontal={columns}
slices/vertical={rows}
"""

_UNITY = """Unity: {file} as a Texture2DArray (not run in Unity: compare slice 0 with the first tile)

Inspector of the texture:
    Texture Type      Default
    Texture Shape     2D Array, Columns {columns}, Rows {rows}
    sRGB              off
    Alpha Source      None
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
    settings.flipbookColumns = {columns};
    settings.flipbookRows = {rows};
    settings.sRGBTexture = false;
    settings.mipmapEnabled = false;
    settings.npotScale = TextureImporterNPOTScale.None;
    settings.wrapMode = TextureWrapMode.Repeat;
    importer.SetTextureSettings(settings);
    var platform = importer.GetDefaultPlatformTextureSettings();
    platform.format = TextureImporterFormat.RGBAHalf;
    platform.maxTextureSize = 16384;
    importer.SetPlatformTextureSettings(platform);
    importer.SaveAndReimport();

Frames run from left to right, then down. Values are metres, signed, linear.
    {play}
Sample, in metres of the world, X and Z:
{sample}
"""

_UNREAL = """Unreal: {file} as a flipbook in one texture (not run in Unreal: compare frame 0 with the first tile)

Details of the texture:
    Compression Settings   HDR (RGBA16F, no BC6H)
    sRGB                   off
    Mip Gen Settings       NoMipmaps
    Texture Group          any; LOD Bias 0; Maximum Texture Size 0
    Power Of Two Mode      None
    Never Stream           on
    X- and Y-axis Tiling   Wrap

{columns} columns and {rows} rows of frames, from left to right, then down. Values are centimetres, signed, linear.
    {play}
Sample, in centimetres of the world, X and Y:
{sample}
then in the atlas, with frac() of u and v held half a texel inside the tile:
    U = (frac(u) + frame mod {columns}) / {columns}
    V = (frac(v) + floor(frame / {columns})) / {rows}
A Texture 2D Array made of the single frames needs none of this, and filters across the tile's edge: prefer it where you can.
"""
