"""
Sampling rules as formulas: texture coordinates, texel indices, frames and atlas cells.

Each rule is a string over named numbers, with + - * / and the functions floor(a) and mod(a, b)
(never negative for b > 0). Sidecars, manifests, `cascade.json`, the pages for engines and the
documentation all show these strings, and a test evaluates them against the sea.

Sample i of a map was computed at x = i size / n, and engines have texel i at u = (i + 0.5) / n;
hence the half texel in u and v.
"""

from typing import Any

from fftocean.export.profiles import KINDS, Kind, Profile


def sampling(profile: Profile) -> dict[str, str]:
    """
    Return the rules for sampling files of a profile.

    Their variables are the profile's horizontal axes (`X`, and `Y` or `Z`) at rest, in its unit, as
    `size_x` and `size_y` are; `nx` and `ny`, texels of one frame; `time`, `start` and `loop` in
    seconds; `frames`. `column` and `row` count texels of the file from its first one, for code
    without a sampler.
    """
    one, two = profile.horizontal
    minus = "" if profile.v_north * profile.north > 0 else "-"
    half = "+" if profile.v_north > 0 else "-"
    first = "0" if profile.first_row == "south" else "-1"
    along = "-" if row_sign(profile) < 0 else "+"
    return {
        "u": f"{one} / size_x + 0.5 / nx",
        "v": f"{minus}{two} / size_y {half} 0.5 / ny",
        "column": f"mod({one} / size_x * nx, nx)",
        "row": f"mod({first} {along} {two} / size_y * ny, ny)",
        "frame": "mod((time - start) / loop * frames, frames)",
    }


def numbers(
    profile: Profile,
    size: tuple[float, float],
    n: tuple[int, int],
    frames: int,
    loop: float,
    start: float,
) -> dict[str, float]:
    """
    Return the values of the variables in the rules of `sampling`.

    Args:
        profile: conventions of the files.
        size: size of the tile along x and y [m].
        n: texels of a frame along x and y.
        frames: number of frames.
        loop: duration of all frames [s].
        start: time of the first frame [s].
    """
    return {
        "size_x": profile.scale * size[0],
        "size_y": profile.scale * size[1],
        "nx": n[0],
        "ny": n[1],
        "loop": loop,
        "start": start,
        "frames": frames,
    }


def atlas(profile: Profile) -> dict[str, str]:
    """
    Return the rules for finding frame `index` (integer, 0 to frames - 1) in an atlas.

    Without a gutter the engine cuts the atlas into layers, each sampled at (u, v) and repeated.
    With one, (atlas_u, atlas_v) is a position in the whole texture, and the texels around each
    frame make a bilinear sampler wrap. Variables besides those of `sampling`: `tiles_across`,
    `tiles_down`, `gutter`.
    """
    if not profile.gutter:
        return {"layer": "index"}
    place = "floor(index / tiles_across)"
    down = place if profile.first_v == 0 else f"tiles_down - 1 - {place}"
    wide, high = "(nx + 2 * gutter)", "(ny + 2 * gutter)"
    return {
        "atlas_u": (
            f"(mod(index, tiles_across) + (gutter + mod(u, 1) * nx) / {wide}) / tiles_across"
        ),
        "atlas_v": f"({down} + (gutter + mod(v, 1) * ny) / {high}) / tiles_down",
    }


def world(profile: Profile, kind: Kind) -> dict[str, str]:
    """Return formulas of a map's values along the engine's axes in terms of R, G, B, A."""
    return KINDS[kind].world(profile)


def row_sign(profile: Profile) -> int:
    """Return the sign of the second horizontal axis along the rows of a file."""
    return profile.north * (-1 if profile.first_row == "north" else 1)


def cascade(profile: Profile) -> dict[str, Any]:
    """
    Return the rules for sampling the tiles of a cascade, for `cascade.json`.

    These are the rules of `sampling`, with formulas of their variables in terms of a tile's own
    `size` [m] and `n`: `size[0]` is the first number of `size`.
    """
    rule = sampling(profile)
    scale = f"{profile.scale} * " if profile.scale != 1 else ""
    return {
        "profile": profile.name,
        "axes": profile.compass,
        "unit": profile.unit,
        "u": rule["u"],
        "v": rule["v"],
        "size_x": f"{scale}size[0]",
        "size_y": f"{scale}size[1]",
        "nx": "n[0]",
        "ny": "n[1]",
        "wrap": "repeat",
    }


def cascade_text(profile: Profile) -> str:
    """Return the rules of `cascade` in a sentence."""
    one, two = profile.horizontal
    rule = sampling(profile)
    return (
        f"Sample every tile at u = {rule['u']}, v = {rule['v']}, repeated, with its own size "
        f"(size_x, size_y in {profile.unit}) and its own n (nx, ny), where {one} points "
        f"{profile.compass[one]} and {two} {profile.compass[two]}, in {profile.unit}, at rest."
    )


def conventions(profile: Profile) -> dict[str, str]:
    """Return the conventions of a profile in words, for manifests and sidecars."""
    axes = ", ".join(f"{c} {points}" for c, points in profile.compass.items())
    green = "up (toward row 0)" if profile.green > 0 else "down (away from row 0)"
    placed = "the loader puts it" if profile.loaded else "uploaded raw, it is"
    rule = sampling(profile)
    packed = profile.normals == "packed"
    return {
        "profile": profile.name,
        "axes": f"{axes}, {profile.handed}-handed",
        "unit": profile.unit,
        "rows": (
            f"row 0 of a file is the {profile.first_row} edge; {placed} at v = {profile.first_v}"
        ),
        "columns": "column 0 is the west edge, at u = 0",
        "normals": "packed: n = 2 c - 1" if packed else "signed: n = c",
        "normal_green": f"{green}, which is {'north' if profile.green_north > 0 else 'south'}",
        "samples": f"u = {rule['u']}, v = {rule['v']}, repeated",
        "loading": profile.note,
    }
