"""
Run by Blender's Python: where the vertices of an evolved package are, its normals and its pixels.

Arguments: the example's folder, a package of one tile, the frames of its loop, and a file to write;
with a folder of a bake as well, its pixels.
"""

import sys
from pathlib import Path

import bpy
import numpy as np

example, folder, frames, out, bake = sys.argv[1:]
sys.path.insert(0, example)
import look  # noqa: E402
import render_sea  # noqa: E402
from evolved import EvolvedSea  # noqa: E402
from package import Sea, Surface  # noqa: E402

frames = int(frames)
scene = bpy.context.scene


def pixels(name, frame):
    """Return the picture of a frame from 0, (height, width, 3)."""
    file = Path(out).with_name(f"{name}{frame}.png")
    render_sea.render_still(file, frame)
    image = bpy.data.images.load(str(file))
    width, height = image.size
    return np.array(image.pixels[:], np.float32).reshape(height, width, -1)[..., :3]


def of(mesh, collection, part, width):
    """Return an array of a mesh's data."""
    data = getattr(mesh, collection)
    values = np.empty(len(data) * width, np.float32)
    data.foreach_get(part, values)
    return values.reshape(-1, width)


found = {}
bpy.ops.wm.read_factory_settings(use_empty=True)
sea = Sea(folder)
(nx, ny), (lx, ly) = sea.document["tiles"][0]["n"], sea.document["tiles"][0]["size"]
water = EvolvedSea(
    Surface(sea, np.arange(nx) * lx / nx, np.arange(ny) * ly / ny, filtered=False), frames
)
water.follow()
moved, normals, foam = [], [], []
for frame in range(frames + 1):
    bpy.context.scene.frame_set(frame + 1)
    shown = water.object.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    moved.append(of(shown, "vertices", "co", 3))
    corner = np.empty(len(shown.loops), np.int32)
    shown.loops.foreach_get("vertex_index", corner)
    by_vertex = np.zeros_like(moved[0])
    by_vertex[corner] = of(shown, "corner_normals", "vector", 3)
    normals.append(by_vertex)
    foam.append(of(shown.attributes["foam"], "data", "value", 1)[:, 0])
found.update(moved=moved, normals=normals, foam=foam)

for name, arguments in (
    ("package", [folder, "--frames", str(frames), "--ratio", "0.2", "--near", "1"]),
    ("bake", [bake]),
):
    given = [*arguments, "--size", "64x36", "--samples", "2"]
    options = render_sea.flags().parse_args(given)
    count = (render_sea.package_scene if name == "package" else render_sea.bake_scene)(options)
    look.sky(*options.sun, options.exposure)
    scene = bpy.context.scene
    scene.cycles.use_denoising = False
    found[f"{name}_pixels"] = [pixels(name, frame) for frame in (0, 1, count)]
    found[f"{name}_frames"] = count, scene.frame_end, scene.render.fps / scene.render.fps_base
np.savez(out, **found)
