"""
Animated sea in Blender from a bake, with a check of its vertices.

Blender's Displace modifier moves a grid by the displacement maps, as an image sequence that loops.
The scene has lit water, smooth by the bake's normals and with its foam if these maps are there, a
sky with its sun, and a camera; `render_sea.py` renders it. Blender is a Python module
of its own version and with its own numpy, so it has an environment to itself:

    python3.11 -m venv blender-env && blender-env/bin/pip install bpy==5.0.1 "numpy<2"
    fftocean bake sea.toml -o sea --engine blender --maps displacement
    blender-env/bin/python examples/blender/displace.py sea --save sea.blend

With `--expected FILE.npy`, (frames, ny, nx, 3) of displacements in metres by any other way, it
prints the largest distance of the vertices from them. A bake that this script does not support is
an error, which names the flag to change.
"""

import argparse
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))  # Blender does not

FORMATS = ("exr", "exr-float")
PACKED = {"normal_X": "(2 * R - 1)", "normal_Y": "(2 * G - 1)", "normal_Z": "(2 * B - 1)"}
SAMPLES = "u = X / size_x + 0.5 / nx, v = Y / size_y + 0.5 / ny, repeated"  # what `sea_mesh` does


def read_bake(folder):
    """
    Return the manifest of a bake; exit with the reason if this script does not support it.
    """
    try:
        manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        sys.exit(f"{folder} must be a finished bake with its manifest.json: {error}")
    try:
        conventions, job = manifest["conventions"], manifest["job"]
        axes, samples = conventions["axes"], conventions["samples"]
        maps, subset, rows = manifest["maps"], manifest["subset"], manifest["frames"]
        tool, count = manifest["tool"], job["bake.frames"]
        manifest["ocean"]["n"], manifest["ocean"]["size"], manifest["ocean"]["loop"]
    except (KeyError, TypeError) as error:
        sys.exit(f"{folder}/manifest.json must be a bake's of fftocean, and has no {error}")
    if tool != "fftocean":
        sys.exit(f"{folder}/manifest.json must be of fftocean, got {tool!r}")
    if not axes.startswith("X east, Y north, Z up") or conventions["unit"] != "m":
        sys.exit(
            f"{folder} is not in Blender's axes and metres ({axes}): bake with --engine blender"
        )
    if samples != SAMPLES:
        sys.exit(
            f"{folder} must be sampled at {SAMPLES}, got {samples}: bake with --engine blender"
        )
    if "displacement" not in maps:
        sys.exit(
            f"{folder} must have displacement maps, got {', '.join(maps)}: bake with --maps "
            "displacement"
        )
    if maps["displacement"]["format"] not in FORMATS:
        got = maps["displacement"]["format"]
        sys.exit(
            f"{folder} must have the format {' or '.join(FORMATS)}, "
            f"got {got}: bake with --format exr"
        )
    if maps["displacement"]["unit"] != "m" or list(maps["displacement"]["channels"]) != [
        "R",
        "G",
        "B",
    ]:
        sys.exit(f"{folder} must have displacements in metres in R, G and B")
    if subset != "all" or len(rows) != count:
        sys.exit(
            f"{folder} must hold the whole loop, got frames {subset} of {count}: bake without "
            "start:stop:step"
        )
    if [row["frame"] for row in rows] != list(range(count)):
        sys.exit(f"{folder} must hold frames 0 to {count - 1} in order")
    return manifest


def sea_mesh(n, size, counts=None):
    """
    Return a grid of vertices on texels, each with the middle of its texel as UV.

    Args:
        n, size: texels and metres of a tile, (x, y).
        counts: vertices along x and y; those of one tile if None. More repeat it.
    """
    import numpy as np
    from meshes import grid_mesh

    (nx, ny), (lx, ly), (across, along) = n, size, counts or n
    i, j = np.meshgrid(np.arange(across), np.arange(along))
    still = np.stack([i * lx / nx, j * ly / ny, np.zeros_like(i, float)], axis=-1)
    mesh = grid_mesh(along, across)
    mesh.vertices.foreach_set("co", still.astype(np.float32).ravel())
    uv = np.stack([(i + 0.5) / nx, (j + 0.5) / ny], axis=-1).reshape(-1, 2)
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    mesh.uv_layers.new(name="texels").data.foreach_set("uv", uv[corners].astype(np.float32).ravel())
    return mesh


def sequence_image(files):
    """Return the image of a sequence of maps, read as numbers."""
    import bpy

    image = bpy.data.images.load(str(files[0].resolve()), check_existing=False)
    image.source = "SEQUENCE"
    image.colorspace_settings.name = "Non-Color"
    image.use_half_precision = False
    return image


def play(user, files):
    """Let an image's user play the files of a loop for ever."""
    user.frame_start, user.frame_duration = 1, len(files)
    user.use_cyclic, user.use_auto_refresh = True, True
    user.frame_offset = int(files[0].stem) - 1  # Blender's first frame is 1, a bake's 0


def sequence_texture(files):
    """Return a texture of the maps: no colour space, no clamping, repeated in space and in time."""
    import bpy

    texture = bpy.data.textures.new("displacement", "IMAGE")
    texture.image = sequence_image(files)
    texture.use_clamp = False  # clamping would set values below 0 to 0
    # Vertices lie at the centres of texels; a finer grid needs interpolation.
    texture.use_interpolation = False
    texture.extension = "REPEAT"
    play(texture.image_user, files)
    return texture


def map_files(folder, manifest, name):
    """Return the files of a map in the sequence of frames, or None if there is none to show."""
    if name not in manifest["maps"] or manifest["maps"][name]["format"] not in FORMATS:
        return None
    return [folder / row["files"][name]["path"] for row in manifest["frames"]]


def map_colour(nodes, files):
    """Return the socket of a map's colour at the texels of the mesh."""
    place = nodes.new("ShaderNodeUVMap", uv_map="texels").outputs[0]
    node = nodes.new("ShaderNodeTexImage", {"Vector": place}, image=sequence_image(files))
    play(node.image_user, files)
    return node.outputs["Color"]


def bake_material(folder, manifest):
    """Return water with the bake's own foam and normals, where it has these maps."""
    import look

    foam, normal = (map_files(folder, manifest, name) for name in ("foam", "normal"))

    def exact(nodes):
        """Return the normals of the map: those of the displaced surface, in its object's axes."""
        colour = map_colour(nodes, normal)
        return nodes.new("ShaderNodeNormalMap", {"Color": colour}, space="OBJECT").outputs[0]

    return look.water_material(
        (lambda nodes: map_colour(nodes, foam)) if foam else None,
        place=look.attribute("rest", 1),
        roughness=0.25,
        normal=exact if normal and manifest["maps"]["normal"]["world"] == PACKED else None,
    )


def animated_sea(folder, counts=None):
    """
    Return the object with its modifier, in a new scene, and the manifest of its bake.

    Args:
        folder: of a bake.
        counts: of vertices, as in `sea_mesh`.
    """
    manifest = read_bake(folder)
    import bpy
    import look

    bpy.ops.wm.read_factory_settings(use_empty=True)
    size = manifest["ocean"]["size"]
    mesh = sea_mesh(manifest["ocean"]["n"], size, counts)
    sea = bpy.data.objects.new("sea", mesh)
    rest = mesh.attributes.new("rest", "FLOAT_VECTOR", "POINT").data
    rest.foreach_set("vector", positions(mesh))
    sea.data.materials.append(bake_material(folder, manifest))
    bpy.context.scene.collection.objects.link(sea)
    modifier = sea.modifiers.new("waves", "DISPLACE")
    modifier.texture = sequence_texture(map_files(folder, manifest, "displacement"))
    modifier.texture_coords, modifier.uv_layer = "UV", "texels"
    modifier.direction, modifier.mid_level, modifier.strength = "RGB_TO_XYZ", 0.0, 1.0
    middle = 0.5 * size[0], 0.5 * size[1], 0.0
    high = manifest["extremes"]["max_height"]
    look.sky(elevation=25.0, azimuth=60.0, exposure=-4.5)
    look.camera((middle[0], -0.4 * size[1], 0.35 * size[1] + 2.0 * high), middle)
    look.quality(960, 540, 64, len(manifest["frames"]), manifest["ocean"]["loop"])
    return sea, manifest


def positions(mesh):
    """Return the places of a mesh's vertices, flat, single precision."""
    import numpy as np

    out = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", out)
    return out


def vertices(sea, frame):
    """Return the vertices at a frame, counted from 0, (vertices, 3)."""
    import bpy

    bpy.context.scene.frame_set(frame + 1)
    mesh = sea.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    out = positions(mesh)
    sea.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh_clear()
    return out.reshape(-1, 3)


def report_distances(sea, manifest, path):
    """Print the distance of the vertices from displacements in a file."""
    import numpy as np

    still = positions(sea.data)
    expected = np.load(path).reshape(len(manifest["frames"]), -1, 3).astype(np.float64)
    apart = [
        np.abs(vertices(sea, j) - still.reshape(-1, 3).astype(np.float64) - e)
        for j, e in enumerate(expected)
    ]
    # One frame past the end is the first.
    again = np.abs(vertices(sea, len(expected)).astype(np.float64) - vertices(sea, 0))
    height, width = (
        np.max(np.abs(expected[..., 2])),
        np.max(np.hypot(expected[..., 0], expected[..., 1])),
    )
    # Step of a half float; a map of halves has an error of at most half of it.
    step = np.spacing(np.abs(expected).astype(np.float16)).astype(np.float64)
    print(
        f"{len(expected)} frames of {expected.shape[1]} vertices, height to {height:.3f} m, "
        f"horizontal to {width:.3f} m"
    )
    print(f"largest distance along an axis: {np.max(apart):.3g} m")
    print(
        f"beyond the half step that a half may be off: {max(0.0, np.max(apart - 0.5 * step)):.3g} m"
    )
    print(f"frame F against frame 0: {np.max(again):.3g} m")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="a bake for Blender, with displacement maps")
    parser.add_argument(
        "--expected",
        type=Path,
        help="the displacements that the vertices must show, (frames, ny, nx, 3) [m]",
    )
    parser.add_argument("--save", type=Path, help="write the scene to this .blend file")
    options = parser.parse_args()
    sea, manifest = animated_sea(options.folder)
    if options.expected:
        report_distances(sea, manifest, options.expected)
    if options.save:
        import bpy

        bpy.ops.wm.save_as_mainfile(filepath=str(options.save.resolve()))


if __name__ == "__main__":
    main()
