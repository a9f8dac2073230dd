"""A mesh in Blender that shows a run-time package, evolved at every frame."""

import bpy
import numpy as np
from meshes import grid_mesh
from package import Foam, Surface, graded

NEAR = 50.0  # distance to which single ripples can be told apart [m]


class EvolvedSea:
    """
    An object of the rows and columns of a surface, whose vertices follow the scene's frame.

    Frame 1 of Blender is the moment 0; `frames` of them are the loop.
    """

    def __init__(self, surface, frames, eye=(0.0, 0.0), foam=True):
        self.surface, self.frames = surface, frames
        self.foam = Foam(surface, frames) if foam else None
        rows, columns = surface.rough.shape
        self.mesh = grid_mesh(rows, columns)
        rest = np.zeros((rows, columns, 3), np.float32)
        rest[..., 0], rest[..., 1] = surface.x[None, :], surface.y[:, None]
        self._set("rest", "FLOAT_VECTOR", "vector", rest)
        distance = np.hypot(rest[..., 0] - eye[0], rest[..., 1] - eye[1])
        near = np.exp(-distance / NEAR)
        self._set("near", "FLOAT", "value", near)
        # Facets of slope variance s^2 are Beckmann's of alpha = s, and Blender's roughness is the
        # square root of alpha. Near the eye the slopes are ripples instead (look.ripples).
        rough = np.clip(surface.missing() * (1.0 - 0.9 * near), 1e-6, 1.0) ** 0.25
        self._set("roughness", "FLOAT", "value", rough)
        self.object = bpy.data.objects.new("sea", self.mesh)
        bpy.context.scene.collection.objects.link(self.object)
        self.show(0)

    def show(self, frame):
        """Move the vertices to a frame from 0, with its normals and foam."""
        fields = self.surface.fields(self.surface.sea.tick(frame, self.frames))
        where = self.surface.vertices(fields).astype(np.float32)
        self.mesh.attributes["position"].data.foreach_set("vector", where.ravel())
        self._set("custom_normal", "FLOAT_VECTOR", "vector", self.surface.normals(fields))
        if self.foam:
            self._set("foam", "FLOAT", "value", self.foam.coverage(frame))
        self.mesh.update()

    def follow(self):
        """Follow the scene's frame from now on, in the window and in renders."""

        def changed(scene, *_):
            self.show(scene.frame_current - scene.frame_start)

        bpy.app.handlers.frame_change_pre.append(changed)

    def _set(self, name, kind, part, values):
        attribute = self.mesh.attributes.get(name) or self.mesh.attributes.new(name, kind, "POINT")
        attribute.data.foreach_set(part, np.asarray(values, np.float32).ravel())


def view_surface(sea, place, ratio, near=0.12, far=12e3):
    """Return a surface around a place, finest there, to the horizon in the north."""
    x, y = graded(near, ratio, -0.65 * far, 0.65 * far), graded(near, ratio, -8.0, far)
    return Surface(sea, x + place[0], y + place[1])
