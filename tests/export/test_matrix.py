"""
Every engine with every format, map, lookup and tile: correct, or refused with an alternative.

Readers of this module alone decode the files and sample them like each engine's sampler, from the
engine's documented axes, unit and position of row 0. The text beside the files (rules for u and v,
rows and columns, frames, cells of an atlas, meaning of the channels) is evaluated literally, and
must give the water that was written.
"""

import io
import json
import struct
import zlib
from collections import Counter
from itertools import product
from typing import NamedTuple

import numpy as np
import OpenEXR
import pytest
from formulas import value_of

import fftocean as fo
from fftocean.baking.scene import maps
from fftocean.baking.scene.maps import MAPS
from fftocean.errors import ParameterError
from fftocean.eulerian import Eulerian
from fftocean.export import engines, formats, rules
from fftocean.export.engines import TABLE, Refusal, profile_for, table_of
from fftocean.export.formats import FORMATS
from fftocean.export.profiles import PROFILES, arrange, meaning, range_of_normals, unit_in


class Engine(NamedTuple):
    """An engine by its own documents."""

    world: str  # where its X, Y, Z point
    per_metre: float
    picture_v: int  # texture coordinate of row 0 of a picture that its loader opens
    cuts: bool = False  # an atlas into the layers of an array


ENGINES = {
    "canonical": Engine("east north up", 1, 1),
    "blender": Engine("east north up", 1, 1),
    "unity": Engine("east up north", 1, 1, cuts=True),
    "unreal": Engine("east south up", 100, 0),
    "godot": Engine("east up south", 1, 0, cuts=True),
    "bevy": Engine("east up south", 1, 0),
    "gltf": Engine("east up south", 1, 0),
    "three": Engine("east up south", 1, 1),
    "three-exr": Engine("east up south", 1, 1),
    "babylon": Engine("east up north", 1, 1),
    "houdini": Engine("east up south", 1, 1),
}
OPENED = {  # by a loader of the engine's own; everything else is bytes, which begin at v = 0
    **{name: {"exr", "exr-float", "exr-atlas"} for name in ENGINES},
    **{
        name: {"exr", "exr-float", "exr-atlas", "png16"}
        for name in ("canonical", "blender", "unreal", "houdini")
    },
    "bevy": {"exr", "exr-float", "exr-atlas", "ktx2"},
}
UNUSABLE = (
    {
        (name, "png16") for name in ("unity", "godot", "bevy", "gltf", "three", "babylon")
    }  # read with 8 bits, or as integers
    | {
        (name, "ktx2")
        for name in ("blender", "unity", "unreal", "godot", "gltf", "babylon", "houdini")
    }  # no loader for an array
    | {(name, "r16") for name in ("bevy", "gltf", "three", "babylon")}
    | {("three-exr", name) for name in ("png16", "r16", "bin", "ktx2")}
)
SIGN = {"east": (0, 1), "north": (1, 1), "south": (1, -1), "up": (2, 1)}
LOOKUPS = ("lagrangian", "eulerian")
NOWHERE = {("stretch", "eulerian")}  # a height field over places has no horizontal displacement
TILES = {0: ((8, 6), (40.0, 20.0)), 1: ((5, 7), (9.0, 7.0))}
FRAMES, FIRST, COUNT = 2, 1, 6  # two frames, 1 and 4 of a loop of 6
LOOP, START = 12.0, 2.0


def exr_pixels(data):
    channels = OpenEXR.File(io.BytesIO(bytes(data)), separate_channels=True).channels()
    return np.stack(
        [channels[letter].pixels for letter in "RGBA"[: len(channels)]], axis=-1
    ).astype(float)


def png_pixels(data):
    """
    Return the pixels of a PNG: 16 bit, gray or RGB, rows that are differences from the row above.
    """
    columns, rows, depth, colour = struct.unpack(">IIBB", data[16:26])
    assert depth == 16
    at, packed = 8, b""
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at : at + 8])
        packed += data[at + 8 : at + 8 + size] if name == b"IDAT" else b""
        at += 12 + size
    count = {0: 1, 2: 3}[colour]
    lines = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(rows, 1 + 2 * columns * count)
    assert np.all(lines[:, 0] == 2)
    return (
        np.cumsum(lines[:, 1:], axis=0, dtype=np.uint8)
        .copy()
        .view(">u2")
        .reshape(rows, columns, count)
        .astype(float)
    )


def ktx2_layers(data, count, rows, columns):
    """Return level 0 of an array of half RGBA, by the header's index of levels."""
    (format_,) = struct.unpack_from("<I", data, 12)
    assert format_ == 97
    offset, size, _ = struct.unpack_from("<3Q", data, 80)
    return (
        np.frombuffer(data, "<f2", size // 2, offset).reshape(count, rows, columns, 4).astype(float)
    )


def stored_layers(name, parts, files, rows, columns, channels):
    """Return each frame's stored texels, (rows, columns, channels), or those of the one atlas."""
    if name in ("exr", "exr-float"):
        return [exr_pixels(part) for part in parts]
    if name == "exr-atlas":
        return [exr_pixels(files["map.exr"])]
    if name == "png16":
        return [png_pixels(part) for part in parts]
    if name == "r16":
        return [
            np.frombuffer(part, "<u2").reshape(rows, columns, 1).astype(float) for part in parts
        ]
    if name == "npz":
        return [np.load(io.BytesIO(part))["pixels"].astype(float) for part in parts]
    if name == "zarr":
        return [
            np.frombuffer(part[:-4], "<f4").reshape(rows, columns, channels).astype(float)
            for part in parts
        ]
    if name == "bin":
        return list(
            np.frombuffer(files["map.bin"], "<f2").reshape(FRAMES, rows, columns, 4).astype(float)
        )
    assert name == "ktx2", f"this page has no reader for {name}"
    return list(ktx2_layers(bytes(files["map.ktx2"]), FRAMES, rows, columns))


def bilinear(texture, u, v, row0_v):
    """
    Sample with repeat and linear filter: texel (r, c) has its centre at ((c + 0.5) / columns, (r +
    0.5) / rows from row 0).
    """
    rows, columns = texture.shape[:2]
    x = u * columns - 0.5
    y = (v if row0_v == 0 else 1.0 - v) * rows - 0.5
    c, r = np.floor(x).astype(int), np.floor(y).astype(int)
    a, b = (x - c)[..., None], (y - r)[..., None]
    texel = lambda dr, dc: texture[(r + dr) % rows, (c + dc) % columns]  # noqa: E731
    return (1 - b) * ((1 - a) * texel(0, 0) + a * texel(0, 1)) + b * (
        (1 - a) * texel(1, 0) + a * texel(1, 1)
    )


def in_world(engine, kind, ours):
    """
    Return a map of the library, (..., channels), along the engine's axes, by the names of the
    sidecar.
    """
    world = ENGINES[engine].world.split()
    scale = ENGINES[engine].per_metre
    flat = [c for c, points in zip("XYZ", world, strict=True) if points != "up"]
    up = "XYZ"[world.index("up")]
    south = -1.0 if "south" in world else 1.0
    along = {c: SIGN[points] for c, points in zip("XYZ", world, strict=True)}
    one, two = flat
    match kind:
        case "vector":
            return {c: sign * scale * ours[..., axis] for c, (axis, sign) in along.items()}
        case "height":
            return {up: scale * ours[..., 0]}
        case "normal":
            return {f"normal_{c}": sign * ours[..., axis] for c, (axis, sign) in along.items()}
        case "derivative":
            return {
                f"slope_{one}": ours[..., 0],
                f"slope_{two}": south * ours[..., 1],
                f"stretch_{one}": ours[..., 2],
                f"stretch_{two}": ours[..., 3],
            }
        case "covariance" | "stretch":
            name = {"covariance": "slope_covariance", "stretch": "stretch"}[kind]
            return {
                f"{name}_{one}{one}": ours[..., 0],
                f"{name}_{one}{two}": south * ours[..., 1],
                f"{name}_{two}{two}": ours[..., 2],
            }
        case "scalar":
            return {"value": ours[..., 0]}
    raise AssertionError(f"this page does not know maps of kind {kind}")


@pytest.fixture(scope="module")
def water():
    """
    Return every map of two frames in library axes by (tile, lookup, map): (frames, ny, nx,
    channels).
    """
    found = {}
    for tile, (n, size) in TILES.items():
        ocean = fo.Ocean(fo.Sea.from_wind(speed=6.0, fetch=3e3), n=n, size=size, seed=3, loop=LOOP)
        for lookup in LOOKUPS:
            source = ocean if lookup == "lagrangian" else Eulerian(ocean)
            for name, m in MAPS.items():
                if (name, lookup) in NOWHERE:
                    continue
                frames = []
                for j in (FIRST, FIRST + COUNT // FRAMES):
                    frame = source.loop_frame(
                        j, COUNT, (*m.needed(mips=False, eulerian=lookup == "eulerian"), "height")
                    )
                    foam = 1 / (1 + np.exp(-frame.height)) if name == "foam" else None
                    frames.append(m.channels(frame, foam, np.array([0.02, -0.01, 0.03])).copy())
                found[tile, lookup, name] = np.stack(frames)
    return found


def written(engine, form, name, truth, tile, lookup):
    """Return a map of an engine in a format: parts, files, the profile, and the sidecar."""
    m = MAPS[name]
    profile = profile_for(engine, form)
    (nx, ny), size = TILES[tile]
    pixels = [arrange(profile, m.kind, frame) for frame in truth]
    scale = {}
    if FORMATS[form].scaled:
        whole = (
            range_of_normals(profile)
            if m.kind == "normal"
            else (min(p.min() for p in pixels), max(p.max() for p in pixels))
        )
        scale = {"lo": float(whole[0]), "hi": float(whole[1])}
    parts = [formats.encode(form, p, **scale) for p in pixels]
    files = formats.assemble(
        form, parts, stem="map", shape=(FRAMES, ny, nx, len(m.names)),
        profile=profile, kind=m.kind, names=meaning(profile, m.kind, m.names),
        unit=unit_in(profile, m.kind, m.unit), size=size, loop=LOOP, start=START,
        lookup=lookup, bounds={"horizontal": 1.5, "vertical": 2.5}, **scale,
    )  # fmt: skip
    if FORMATS[form].sidecar:
        said = json.loads(bytes(files["map.zarr/zarr.json" if form == "zarr" else "map.json"]))
        said = said["attributes"] if form == "zarr" else said
    else:  # the manifest's, held against a bake below
        values = rules.numbers(profile, size, (nx, ny), FRAMES, LOOP, START)
        said = {
            "sampling": {**rules.sampling(profile), "values": values},
            "world": rules.world(profile, m.kind),
        }
    return parts, files, profile, said


def places(tile):
    """
    Return points x, y, every sample and others between, across the edge and far outside, and the
    number of samples.
    """
    (nx, ny), (lx, ly) = TILES[tile]
    j, i = np.meshgrid(np.arange(ny), np.arange(nx), indexing="ij")
    rng = np.random.default_rng(8)
    x = np.concatenate(
        [(i * lx / nx).ravel(), rng.uniform(-2 * lx, 3 * lx, 20), [-0.01, lx - 0.01]]
    )
    y = np.concatenate(
        [(j * ly / ny).ravel(), rng.uniform(-2 * ly, 3 * ly, 20), [ly - 0.01, -0.01]]
    )
    return x, y, i.size


def between(truth, tile, x, y):
    """Return a map of the library between its samples, periodic and bilinear."""
    (nx, ny), (lx, ly) = TILES[tile]
    texture = np.asarray(truth, float)
    return bilinear(texture, x / lx + 0.5 / nx, y / ly + 0.5 / ny, 0)


def allowed(form, profile, kind, said, expected):
    """
    Return the tolerance of a value: half a step of the stored type, enlarged by the formulas, plus
    that of float32.
    """
    largest = max(float(np.max(np.abs(v))) for v in expected.values())
    if FORMATS[form].scaled:
        step = 0.5 * (said["hi"][0] - said["lo"][0]) / 65535
    else:
        step = 0.5 * float(
            np.spacing(np.float16(largest))
            if FORMATS[form].stored == "float16"
            else np.spacing(np.float32(largest))
        )
    if kind == "normal" and profile.normals == "packed":
        step = (
            2
            * 0.5
            * {"float16": 2.0**-11, "float32": 2.0**-24, "uint16": 1 / 65535}[FORMATS[form].stored]
        )
    return step * (1 + 1e-6) + 4 * float(np.spacing(np.float32(largest)))


def right(engine, form, name, truth, tile, lookup):
    """
    Assert that a cell's files, read and sampled by their text, are the water; return "right" or
    "noted".
    """
    m, facts = MAPS[name], ENGINES[engine]
    (nx, ny), _ = TILES[tile]
    parts, files, profile, said = written(engine, form, name, truth, tile, lookup)
    layers = stored_layers(form, parts, files, ny, nx, len(m.names))
    if FORMATS[form].scaled:
        names = {"lo": np.array(said["lo"]), "hi": np.array(said["hi"])}
        layers = [value_of(said["value"], {**names, "stored": layer}) for layer in layers]
    if FORMATS[form].sidecar:
        assert said["lookup"] == lookup
        assert said["bounds"] == {
            "horizontal": 1.5 * facts.per_metre,
            "vertical": 2.5 * facts.per_metre,
            "unit": said["size_unit"],
        }
        assert said["unit"] == m.unit.replace(
            "m", "cm" if facts.per_metre == 100 and m.kind in ("vector", "height") else "m"
        )
        assert (said["start"], said["loop"], said["frames_per_second"]) == (
            START,
            LOOP,
            FRAMES / LOOP,
        )
    row0_v = facts.picture_v if form in OPENED[engine] else 0
    x, y, samples = places(tile)
    rule, values = said["sampling"], said["sampling"]["values"]
    first, second = (
        c for c, points in zip("XYZ", facts.world.split(), strict=True) if points != "up"
    )
    south = -1 if "south" in facts.world else 1
    at = {**values, first: x * facts.per_metre, second: south * y * facts.per_metre}
    u, v = value_of(rule["u"], at), value_of(rule["v"], at)
    for k in range(FRAMES):
        number = value_of(
            rule["frame"], {**values, "time": START + (k + 7 * FRAMES) * LOOP / FRAMES}
        )
        assert number == pytest.approx(k, abs=1e-9)
        if form == "exr-atlas" and not facts.cuts:
            cell = {**at, "u": u, "v": v, "index": k}
            texels = bilinear(
                layers[0], value_of(rule["atlas_u"], cell), value_of(rule["atlas_v"], cell), row0_v
            )
        elif form == "exr-atlas":  # as the importer cuts it: full cells in reading order
            across = values["tiles_across"]
            assert value_of(rule["layer"], {"index": k}) == k
            assert layers[0].shape[:2] == (ny * values["tiles_down"], nx * across)
            texels = bilinear(
                layers[0][k // across * ny :, k % across * nx :][:ny, :nx], u, v, row0_v
            )
        else:
            texels = bilinear(layers[k], u, v, row0_v)
            row, column = (
                np.rint(value_of(rule[word], at)[:samples]).astype(int)
                for word in ("row", "column")
            )
            exact = bilinear(layers[k], u[:samples], v[:samples], row0_v)
            assert np.max(np.abs(layers[k][row % ny, column % nx] - exact)) < 1e-9 * (
                1 + np.max(np.abs(exact))
            )
        letters = dict(zip("RGBA", np.moveaxis(texels, -1, 0), strict=False))
        got = {key: value_of(text, letters) for key, text in said["world"].items()}
        expected = in_world(engine, m.kind, between(truth[k], tile, x, y))
        limit = allowed(form, profile, m.kind, said, expected)
        for key, want in expected.items():
            assert np.max(np.abs(got[key] - want)) <= limit, (engine, form, name, lookup, tile, key)
        if m.kind == "derivative":  # along (-slope / (1 + stretch), ..., 1), at the texels
            up = "XYZ"[facts.world.split().index("up")]
            assert np.all(np.asarray(got[f"normal_{up}"]) == 1)
            for c in (first, second):
                slope, stretch = expected[f"slope_{c}"], expected[f"stretch_{c}"]
                assert np.max(np.abs(got[f"normal_{c}"] * (1 + stretch) + slope)) <= 4 * limit
    return "right" if profile.note in (engines.PLAIN_LOADER, engines.PLAIN_BYTES) else "noted"


CELLS = list(product(ENGINES, FORMATS))


def test_the_pages_name_the_same_engines_and_formats():
    assert list(PROFILES) == list(ENGINES)
    assert {pair for pair, cell in TABLE.items() if isinstance(cell, Refusal)} == UNUSABLE
    assert set(TABLE) == set(CELLS)


@pytest.mark.parametrize("engine", ENGINES)
def test_every_cell_is_right_or_refused(engine, water):
    """
    All formats, maps, lookups and tiles of one engine, counted.

    A pair of engine and format that cannot be is refused before all else, with a format that can;
    so is a map that a format cannot hold.
    """
    counts = Counter()
    for form, name, lookup, tile in product(FORMATS, MAPS, LOOKUPS, TILES):
        if (engine, form) in UNUSABLE:
            with pytest.raises(
                ParameterError, match=rf"cannot use format {form}: .+; choose format "
            ) as caught:
                profile_for(engine, form)
            instead = str(caught.value).split()[-1]
            assert profile_for(engine, instead if engine != "three-exr" else "exr")
            counts["pair refused"] += 1
            continue
        if (name, lookup) in NOWHERE:
            with pytest.raises(
                ParameterError, match=f"{name}' cannot be baked with the lookup '{lookup}'"
            ):
                maps.needed((name,), eulerian=True)
            counts["lookup refused"] += 1
            continue
        channels = len(MAPS[name].names)
        if channels not in FORMATS[form].channels:
            with pytest.raises(
                ParameterError, match=f"format {form} holds maps of .* channels, got {channels}"
            ):
                formats.require(form, (FRAMES, 6, 8, channels))
            counts["map refused"] += 1
            continue
        counts[right(engine, form, name, water[tile, lookup, name], tile, lookup)] += 1
    assert sum(counts.values()) == len(FORMATS) * len(MAPS) * len(LOOKUPS) * len(TILES)
    assert all(
        cell.note for cell in TABLE.values() if not isinstance(cell, Refusal)
    )  # how its files get into the engine


@pytest.mark.parametrize("engine", ENGINES)
def test_the_rule_of_a_cascade_finds_every_tile(engine, water):
    """The text in `cascade.json` applies with each tile's own n and size [m]."""
    form = "exr" if engine == "three-exr" else "bin"
    facts, profile = ENGINES[engine], profile_for(engine, form)
    rule = rules.cascade(profile)
    for text in ("u", "v"):
        assert f"{text} = {rule[text]}" in rules.cascade_text(profile)
    first, second = (
        c for c, points in zip("XYZ", facts.world.split(), strict=True) if points != "up"
    )
    up = "XYZ"[facts.world.split().index("up")]
    south = -1 if "south" in facts.world else 1
    for tile, (n, size) in TILES.items():
        truth = water[tile, "lagrangian", "height"]
        parts, files, _, said = written(engine, form, "height", truth, tile, "lagrangian")
        texture = stored_layers(form, parts, files, n[1], n[0], 1)[0]
        names = {
            key: value_of(rule[key], {"n": n, "size": size})
            for key in ("nx", "ny", "size_x", "size_y")
        }
        x, y, _ = places(tile)
        names |= {first: x * facts.per_metre, second: south * y * facts.per_metre}
        row0_v = facts.picture_v if form in OPENED[engine] else 0
        got = bilinear(texture, value_of(rule["u"], names), value_of(rule["v"], names), row0_v)[
            ..., 0
        ]
        want = in_world(engine, "height", between(truth[0], tile, x, y))[up]
        assert np.max(np.abs(got - want)) <= allowed(form, profile, "height", said, {up: want})
        assert np.corrcoef(got, want)[0, 1] > 0.999  # a sign of v turned makes this 0.1


@pytest.mark.parametrize(
    "engine", [name for name in ENGINES if (name, "exr-atlas") not in UNUSABLE]
)
@pytest.mark.parametrize("channels", [1, 3])
def test_an_atlas_has_no_seam_between_its_cells(engine, channels):
    """
    Bilinear across a cell's border equals the frame alone, repeated: to the bit, in noise, where
    each texel is its own.
    """
    rng = np.random.default_rng(5)
    frames, rows, columns = 6, 4, 5
    noise = (
        rng.uniform(-1, 1, (frames, rows, columns, channels)).astype(np.float16).astype(np.float32)
    )
    profile = profile_for(engine, "exr-atlas")
    parts = [formats.encode("exr-atlas", frame) for frame in noise]
    files = formats.assemble("exr-atlas", parts, stem="map", shape=noise.shape, profile=profile)
    said = json.loads(bytes(files["map.json"]))
    texture, facts = exr_pixels(files["map.exr"])[..., :channels], ENGINES[engine]
    across, down = said["tiles"]
    high, wide = texture.shape[0] // down, texture.shape[1] // across
    u, v = rng.uniform(-1, 2, (2, 4000))
    u[:8], v[:8] = [0, 1, 1e-9, 1 - 1e-9, 0, 0.5, 1, 0.3], [0, 1, 1 - 1e-9, 1e-9, 0.3, 0, 0.7, 1]
    for k, frame in enumerate(noise):
        want = bilinear(frame, u, v, facts.picture_v)
        if facts.cuts:
            assert (high, wide) == (rows, columns)
            got = bilinear(
                texture[k // across * high :, k % across * wide :][:high, :wide],
                u,
                v,
                facts.picture_v,
            )
        else:
            names = {**said["sampling"]["values"], "u": u, "v": v, "index": k}
            place = [value_of(said["sampling"][name], names) for name in ("atlas_u", "atlas_v")]
            got = bilinear(texture, *place, facts.picture_v)
        assert np.max(np.abs(got - want)) < 1e-9


def test_an_unlisted_cell_is_an_error_at_import():
    cells = {engine: dict(row) for engine, row in engines.CELLS.items()}
    del cells["godot"]["bin"]
    with pytest.raises(
        ImportError, match="engine godot must have a cell for every format, not so: bin"
    ):
        table_of(cells)
    del cells["godot"]
    with pytest.raises(ImportError, match="engines must be canonical, "):
        table_of(cells)
    cells = {**engines.CELLS, "bevy": {**engines.CELLS["bevy"], "r16": Refusal("no", "png16")}}
    with pytest.raises(ImportError, match="engine bevy cannot use png16 instead of r16"):
        table_of(cells)


@pytest.mark.parametrize("form", [name for name in FORMATS if 3 in FORMATS[name].channels])
def test_a_flat_sea_is_up_in_a_stock_material(form):
    """
    A material computes 2 c - 1 of the stored value c.

    Half and single precision hold 1/2: exactly up. No step k of 65535 has 2 k / 65535 - 1 = 0: the
    nearest is 1/65535 off along x and y, 0.0012 degrees.
    """
    profile = profile_for("blender" if form == "png16" else "canonical", form, "packed")
    up = np.zeros((2, 3, 3), np.float32)
    up[..., 2] = 1.0
    lo, hi = range_of_normals(profile)
    scale = {"lo": lo, "hi": hi} if FORMATS[form].scaled else {}
    part = formats.encode(form, arrange(profile, "normal", up), **scale)
    pixels = formats.decode(form, part, shape=up.shape, **scale).astype(np.float64)
    seen = 2 * pixels - 1
    if form == "png16":
        assert png_pixels(part)[0, 0].tolist() == [32768, 32768, 65535]
        assert np.max(np.abs(seen - up)) == pytest.approx(1 / 65535, rel=1e-3)
    else:
        assert np.array_equal(seen, up)


def test_signed_normals_in_sixteen_bits_hold_zero_exactly():
    profile = profile_for("canonical", "png16", "signed")
    lo, hi = range_of_normals(profile)
    values = np.array([[[-1.0, 0.0, 1.0]]], np.float32)
    part = formats.encode("png16", values, lo=lo, hi=hi)
    assert png_pixels(part)[0, 0].tolist() == [0, 32767, 65534]
    assert formats.decode("png16", part, lo=lo, hi=hi).tolist() == [[[-1.0, 0.0, 1.0]]]
