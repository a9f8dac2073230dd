"""Meshes of a grid, made at once."""

import bpy
import numpy as np


def grid_mesh(rows, columns):
    """Return a smooth mesh of quads between rows * columns vertices, counted along the rows."""
    j, i = np.mgrid[: rows - 1, : columns - 1]
    corner = (j * columns + i).reshape(-1, 1)
    quads = (corner + np.array([0, 1, columns + 1, columns])).astype(np.int32)
    mesh = bpy.data.meshes.new("sea")
    mesh.vertices.add(rows * columns)
    mesh.loops.add(quads.size)
    mesh.loops.foreach_set("vertex_index", quads.ravel())
    mesh.polygons.add(len(quads))
    mesh.polygons.foreach_set("loop_start", np.arange(0, quads.size, 4, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(len(quads), bool))
    mesh.update(calc_edges=True)
    return mesh
