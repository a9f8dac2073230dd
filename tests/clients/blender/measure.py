"""
Run by Blender's Python: build the example's scene from a bake and save where its vertices are at
each frame, and one further.
"""

import importlib.util
import json
import sys
from pathlib import Path

import bpy
import numpy as np
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

example, folder, out = map(Path, sys.argv[1:])
spec = importlib.util.spec_from_file_location("displace", example)
displace = importlib.util.module_from_spec(spec)
spec.loader.exec_module(displace)
sea, _ = displace.animated_sea(folder)
frames = len(json.loads((folder / "manifest.json").read_text())["frames"])
still = np.empty(3 * len(sea.data.vertices), dtype=np.float32)
sea.data.vertices.foreach_get("co", still)
np.savez(
    out,
    still=still.reshape(-1, 3),
    moved=np.stack([displace.vertices(sea, frame) for frame in range(frames + 1)]),
)

# where east and north appear when a camera looks down, as one does that is not turned
camera = bpy.data.objects.new("above", bpy.data.cameras.new("above"))
camera.location = 0.0, 0.0, 20.0
bpy.context.scene.collection.objects.link(camera)
bpy.context.view_layer.update()
look = [
    list(world_to_camera_view(bpy.context.scene, camera, Vector(p)))
    for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0))
]
scene = bpy.context.scene
user = sea.modifiers["waves"].texture.image_user
print(
    json.dumps(
        {
            "version": bpy.app.version_string,
            "look": look,
            "fps": scene.render.fps / scene.render.fps_base,
            "frame_end": scene.frame_end,
            "frame_offset": user.frame_offset,
        }
    )
)
