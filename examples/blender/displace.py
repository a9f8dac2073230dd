"""
Animated sea in Blender from a bake, with a check of its vertices.

Blender's Displace modifier moves a grid by the displacement maps, as an image sequence that loops.
The scene has a lit, smooth-shaded material, a sun, a sky and a camera. Blender is a Python module
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
import math
import sys
from pathlib import Path

FORMATS = ("exr", "exr-float")
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


def sea_mesh(n, size):
    """Return a grid of nx times ny vertices, each with the middle of its texel as UV."""
    import bpy
    import numpy as np

    (nx, ny), (lx, ly) = n, size
    i, j = np.meshgrid(np.arange(nx), np.arange(ny))
    still = np.stack([i * lx / nx, j * ly / ny, np.zeros_like(i, float)], axis=-1).reshape(-1, 3)
    corner = (j[:-1, :-1] * nx + i[:-1, :-1]).reshape(-1, 1)
    mesh = bpy.data.meshes.new("sea")
    mesh.from_pydata(still.tolist(), [], (corner + np.array([0, 1, nx + 1, nx])).tolist())
    uv = np.stack([(i + 0.5) / nx, (j + 0.5) / ny], axis=-1).reshape(-1, 2)
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    mesh.uv_layers.new(name="texels").data.foreach_set(
        "uv", uv[corners].astype(np.float32).reshape(-1)
    )
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    return mesh


def sequence_texture(files):
    """Return a texture of the maps: no colour space, no clamping, repeated in space and in time."""
    import bpy

    image = bpy.data.images.load(str(files[0].resolve()))
    image.source = "SEQUENCE"
    image.colorspace_settings.name = "Non-Color"
    image.use_half_precision = False
    texture = bpy.data.textures.new("displacement", "IMAGE")
    texture.image = image
    texture.use_clamp = False  # clamping would set values below 0 to 0
    # Vertices lie at the centres of texels; a finer grid needs interpolation.
    texture.use_interpolation = False
    texture.extension = "REPEAT"
    user = texture.image_user
    user.frame_start, user.frame_duration, user.use_cyclic, user.use_auto_refresh = (
        1,
        len(files),
        True,
        True,
    )
    user.frame_offset = int(files[0].stem) - 1  # Blender's first frame is 1, a bake's 0
    return texture


def water_material():
    """Return a dark, shiny dielectric, lit by the scene."""
    import bpy

    material = bpy.data.materials.new("water")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (0.01, 0.05, 0.08, 1.0)
    shader.inputs["Roughness"].default_value = 0.08
    shader.inputs["IOR"].default_value = 1.333
    return material


def light_and_camera(size, height):
    """Add a sun, a sky and a camera around a tile [m]; `height` is that of its highest wave."""
    import bpy
    from mathutils import Vector

    scene, (lx, ly) = bpy.context.scene, size
    middle = Vector((0.5 * lx, 0.5 * ly, 0.0))
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3.0, (math.radians(65.0), 0.0, math.radians(20.0))
    world = bpy.data.worlds.new("sky")
    if bpy.app.version < (5, 0, 0):
        world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (0.45, 0.6, 0.8, 1.0)
    scene.world = world
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = middle + Vector((0.0, -0.9 * ly, 0.35 * ly + 2.0 * height))
    camera.rotation_euler = (middle - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.clip_end = 10.0 * (lx + ly)
    for thing in (sun, camera):
        scene.collection.objects.link(thing)
    scene.camera = camera


def animated_sea(folder):
    """Return the object with its modifier, in a new scene, and the manifest of its bake."""
    manifest = read_bake(folder)
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    size = manifest["ocean"]["size"]
    sea = bpy.data.objects.new("sea", sea_mesh(manifest["ocean"]["n"], size))
    sea.data.materials.append(water_material())
    scene = bpy.context.scene
    scene.collection.objects.link(sea)
    modifier = sea.modifiers.new("waves", "DISPLACE")
    modifier.texture = sequence_texture(
        [folder / row["files"]["displacement"]["path"] for row in manifest["frames"]]
    )
    modifier.texture_coords, modifier.uv_layer = "UV", "texels"
    modifier.direction, modifier.mid_level, modifier.strength = "RGB_TO_XYZ", 0.0, 1.0
    light_and_camera(size, manifest["extremes"]["max_height"])
    scene.frame_start, scene.frame_end = 1, len(manifest["frames"])
    frames_per_second = len(manifest["frames"]) / manifest["ocean"]["loop"]
    scene.render.fps = max(1, round(frames_per_second))
    scene.render.fps_base = scene.render.fps / frames_per_second
    return sea, manifest


def vertices(sea, frame):
    """Return the vertices at a frame, counted from 0, (vertices, 3)."""
    import bpy
    import numpy as np

    bpy.context.scene.frame_set(frame + 1)
    mesh = sea.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    out = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", out)
    sea.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh_clear()
    return out.reshape(-1, 3)


def report_distances(sea, manifest, path):
    """Print the distance of the vertices from displacements in a file."""
    import numpy as np

    still = np.empty(3 * len(sea.data.vertices), dtype=np.float32)
    sea.data.vertices.foreach_get("co", still)
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
