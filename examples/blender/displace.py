"""
An animated sea in Blender from a bake, and a check that its vertices are where the water is.

Blender's Displace modifier moves a grid by the displacement maps, as an image sequence that loops. Blender is a Python module of
its own version and with its own numpy, so it has an environment to itself:

    python3.11 -m venv blender-env && blender-env/bin/pip install bpy==5.0.1 "numpy<2"
    fftocean bake sea.toml -o sea --engine blender --maps displacement
    blender-env/bin/python examples/blender/displace.py sea --save sea.blend

With `--expected FILE.npy`, (frames, ny, nx, 3) of displacements in metres by any other way, it says how far the vertices are from them.
"""

import argparse
import json
import sys
from pathlib import Path

import bpy
import numpy as np


def sea_mesh(n, size):
    """A grid of nx times ny vertices, each with the middle of its texel as UV: x = i lx/nx belongs to u = (i + 0.5)/nx."""
    (nx, ny), (lx, ly) = n, size
    i, j = np.meshgrid(np.arange(nx), np.arange(ny))
    still = np.stack([i * lx / nx, j * ly / ny, np.zeros_like(i, float)], axis=-1).reshape(-1, 3)
    corner = (j[:-1, :-1] * nx + i[:-1, :-1]).reshape(-1, 1)
    mesh = bpy.data.meshes.new("sea")
    mesh.from_pydata(still.tolist(), [], (corner + np.array([0, 1, nx + 1, nx])).tolist())
    uv = np.stack([(i + 0.5) / nx, (j + 0.5) / ny], axis=-1).reshape(-1, 2)
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    mesh.uv_layers.new(name="texels").data.foreach_set("uv", uv[corners].astype(np.float32).reshape(-1))
    return mesh


def sequence_texture(files):
    """The maps as they are: no colour space, no clamping, no filter between texels, repeated in space and in time."""
    image = bpy.data.images.load(str(files[0].resolve()))
    image.source = "SEQUENCE"
    image.colorspace_settings.name = "Non-Color"
    image.use_half_precision = False
    texture = bpy.data.textures.new("displacement", "IMAGE")
    texture.image = image
    texture.use_clamp = False  # else what is below 0 becomes 0
    texture.use_interpolation = False  # at a texel's middle there is nothing to interpolate; for a finer grid switch it on
    texture.extension = "REPEAT"
    user = texture.image_user
    user.frame_start, user.frame_duration, user.use_cyclic, user.use_auto_refresh = 1, len(files), True, True
    user.frame_offset = int(files[0].stem) - 1  # Blender's first frame is 1, ours 0
    return texture


def animated_sea(folder):
    """The object with its modifier in an empty scene, and the manifest it was made from."""
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    axes = manifest["conventions"]["axes"]
    if not axes.startswith("X east, Y north, Z up") or "north" not in manifest["conventions"]["rows"]:
        sys.exit(f"{folder} is not in Blender's frame ({axes}): bake with --engine blender")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    sea = bpy.data.objects.new("sea", sea_mesh(manifest["ocean"]["n"], manifest["ocean"]["size"]))
    bpy.context.scene.collection.objects.link(sea)
    modifier = sea.modifiers.new("waves", "DISPLACE")
    modifier.texture = sequence_texture([folder / row["files"]["displacement"]["path"] for row in manifest["frames"]])
    modifier.texture_coords, modifier.uv_layer = "UV", "texels"
    modifier.direction, modifier.mid_level, modifier.strength = "RGB_TO_XYZ", 0.0, 1.0
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, len(manifest["frames"])
    frames_per_second = len(manifest["frames"]) / manifest["ocean"]["loop"]
    scene.render.fps, scene.render.fps_base = max(1, round(frames_per_second)), max(1, round(frames_per_second)) / frames_per_second
    return sea, manifest


def vertices(sea, frame):
    """Where the vertices are at a frame, counted from 0, (vertices, 3)."""
    bpy.context.scene.frame_set(frame + 1)
    mesh = sea.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    out = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", out)
    sea.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh_clear()
    return out.reshape(-1, 3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="a bake for Blender, with displacement maps")
    parser.add_argument("--expected", type=Path, help="the displacements that the vertices must show, (frames, ny, nx, 3) [m]")
    parser.add_argument("--save", type=Path, help="write the scene to this .blend file")
    options = parser.parse_args()
    sea, manifest = animated_sea(options.folder)
    if options.expected:
        still = np.empty(3 * len(sea.data.vertices), dtype=np.float32)
        sea.data.vertices.foreach_get("co", still)
        expected = np.load(options.expected).reshape(len(manifest["frames"]), -1, 3).astype(np.float64)
        apart = [np.abs(vertices(sea, j) - still.reshape(-1, 3).astype(np.float64) - e) for j, e in enumerate(expected)]
        again = np.abs(vertices(sea, len(expected)).astype(np.float64) - vertices(sea, 0))  # one past the end is the beginning
        height, width = np.max(np.abs(expected[..., 2])), np.max(np.hypot(expected[..., 0], expected[..., 1]))
        step = np.spacing(np.abs(expected).astype(np.float16)).astype(np.float64)  # of a half: what a half map may be off by half of
        print(f"{len(expected)} frames of {expected.shape[1]} vertices, height to {height:.3f} m, horizontal to {width:.3f} m")
        print(f"largest distance along an axis: {np.max(apart):.3g} m")
        print(f"beyond the half step that a half may be off: {max(0.0, np.max(apart - 0.5 * step)):.3g} m")
        print(f"frame F against frame 0: {np.max(again):.3g} m")
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(options.save.resolve()))


if __name__ == "__main__":
    main()
