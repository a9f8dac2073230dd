"""
MuJoCo's model of bodies on a sea, and pictures of it without a window.

The sea is a height field that nothing collides with. Each picture takes its heights from `fo.Query`
at the places of the height field, and its colours, as a texture, from the normals there: the sky's
reflection by Fresnel's law, the sun's, and the light from below.
"""

import math

import mujoco
import numpy as np
from panels import GRAVITY, Body

import fftocean as fo

SKY, ZENITH, DEEP, SUN = (
    np.array(colour)
    for colour in ((0.70, 0.80, 0.90), (0.22, 0.42, 0.70), (0.01, 0.075, 0.11), (1.0, 0.93, 0.8))
)
SUNLIGHT = np.array([-0.45, 0.62, 0.64])  # direction to the sun
PAINT = {"hull": "0.85 0.25 0.12 1", "buoy": "0.95 0.75 0.1 1"}
REACH = 20.0  # the height field holds heights from -REACH to REACH [m]


def numbers(array: np.ndarray) -> str:
    """Return an array as MJCF writes it."""
    return " ".join(f"{value:.6g}" for value in np.ravel(array))


def body_xml(name: str, body: Body, place: tuple[float, float]) -> tuple[str, str]:
    """Return the mesh and the body of a shape, with a free joint."""
    triangles = np.concatenate([body.quads[:, [0, 1, 2]], body.quads[:, [0, 2, 3]]])
    inertia = body.mass * np.square(body.radii)
    x, y, high = *place, body.vertices[:, 2].max()
    mast = 1.6 if name == "buoy" else 2.2
    paint = PAINT.get(name, "0.8 0.8 0.8 1")
    mesh = (
        f'<mesh name="{name}" inertia="shell" vertex="{numbers(body.vertices)}" '
        f'face="{" ".join(map(str, triangles.ravel()))}"/>'
    )
    house = (
        f'<geom type="box" class="look" size="0.9 0.6 0.5" pos="-0.8 0 {high + 0.45}" '
        'rgba="0.93 0.93 0.9 1"/>'
        f'<geom type="box" class="look" size="0.7 0.62 0.16" pos="-0.75 0 {high + 0.62}" '
        'rgba="0.1 0.14 0.2 1"/>'
        if name == "hull"
        else ""
    )
    return (
        mesh,
        f"""
    <body name="{name}" pos="{x} {y} 0">
      <joint type="free"/>
      <inertial pos="0 0 {body.centre}" mass="{body.mass}" diaginertia="{numbers(inertia)}"/>
      <geom type="mesh" mesh="{name}" class="look" pos="0 0 0" rgba="{paint}"/>
      {house}
      <geom type="capsule" class="look" size="0.05" rgba="0.9 0.9 0.9 1"
        fromto="-0.8 0 {high} -0.8 0 {high + mast}"/>
      <geom type="sphere" class="look" size="0.14" rgba="1 0.9 0.3 1"
        pos="-0.8 0 {high + mast}"/>
    </body>""".replace("-0.8 0", "0 0" if name == "buoy" else "-0.8 0"),
    )


def model_of(
    bodies: dict[str, Body],
    places: dict[str, tuple[float, float]],
    *,
    timestep: float = 0.02,
    size: float = 60.0,
    cells: int = 240,
    eye: tuple[float, float, float] = (-4.0, -12.0, 4.4),
) -> mujoco.MjModel:
    """
    Return a model of bodies at places on a sea of some size [m].

    Args:
        bodies, places: by name; places are x and y [m].
        timestep: of the simulation [s].
        size: side of the square of sea that is drawn, around the origin [m].
        cells: samples of the height field along a side.
        eye: position of the camera, which looks at the origin [m].
    """
    parts = [body_xml(name, body, places[name]) for name, body in bodies.items()]
    ahead = -np.array(eye)
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    axes = numbers(np.concatenate([right, np.cross(right, ahead)]))
    return mujoco.MjModel.from_xml_string(f"""
<mujoco model="sea">
  <option timestep="{timestep}" gravity="0 0 {-GRAVITY}"/>
  <visual>
    <global offwidth="1280" offheight="720" fovy="40"/>
    <map znear="0.01" zfar="20" fogstart="0.6" fogend="1.6"/>
    <rgba fog="{numbers(SKY)} 1" haze="{numbers(SKY)} 1"/>
    <quality shadowsize="2048"/>
    <headlight ambient="0.35 0.35 0.38" diffuse="0 0 0" specular="0 0 0"/>
  </visual>
  <default>
    <default class="look"><geom contype="0" conaffinity="0" mass="0" group="0"/></default>
  </default>
  <asset>
    <hfield name="sea" nrow="{cells}" ncol="{cells}" size="{size / 2} {size / 2} {2 * REACH} 1"/>
    <texture name="sea" type="2d" builtin="flat" width="{cells}" height="{cells}" rgb1="0 0 0"/>
    <texture name="sky" type="skybox" builtin="gradient" width="256" height="256"
      rgb1="{numbers(SKY)}" rgb2="{numbers(ZENITH)}"/>
    <material name="sea" texture="sea" emission="1" specular="0" shininess="0"
      rgba="0.62 0.62 0.62 1"/>
    {"".join(mesh for mesh, _ in parts)}
  </asset>
  <worldbody>
    <light directional="true" dir="{numbers(-SUNLIGHT)}" diffuse="0.75 0.72 0.66"
      specular="0.2 0.2 0.2" castshadow="true"/>
    <camera name="eye" pos="{numbers(np.array(eye))}" xyaxes="{axes}"/>
    <geom name="sea" class="look" type="hfield" hfield="sea" material="sea"
      pos="0 0 {-REACH}"/>
    {"".join(body for _, body in parts)}
  </worldbody>
</mujoco>""")


class Picture:
    """Pictures of a model on the sea of a query, with `MUJOCO_GL` as egl or osmesa."""

    def __init__(self, model: mujoco.MjModel, query: fo.Query, width: int = 640, height: int = 360):
        self.model, self.query = model, query
        self.renderer = mujoco.Renderer(model, height, width)
        cells, half = int(model.hfield_nrow[0]), float(model.hfield_size[0, 0])
        side = np.linspace(-half, half, cells)
        self.x, self.y = np.meshgrid(side, side)  # row 0 is the south
        eye = np.array(model.camera("eye").pos)
        self.view = np.stack([eye[0] - self.x, eye[1] - self.y, np.full_like(self.x, eye[2])], -1)
        self.view /= np.linalg.norm(self.view, axis=-1, keepdims=True)

    def __enter__(self) -> "Picture":
        return self

    def __exit__(self, *_: object) -> None:
        self.renderer.close()

    def lift(self, t: float) -> fo.query.Answer:
        """Set the height field to the water at a time; return that water."""
        found = self.query.at(self.x, self.y, t, ("heights", "normals"))
        # MuJoCo holds heights from 0 to 1 of the field's range
        self.model.hfield_data[:] = np.clip((found.heights / REACH + 1.0) / 2.0, 0.0, 1.0).ravel()
        return found

    def take(self, data: mujoco.MjData) -> np.ndarray:
        """Return a picture, (height, width, 3) of bytes."""
        mujoco.mj_kinematics(self.model, data)  # a step leaves the places before it
        found = self.lift(data.time)
        texture = self.model.texture("sea")
        colours = np.round(255.0 * water_colour(found.normals, self.view)).astype(np.uint8)
        first = int(texture.adr[0])
        self.model.tex_data[first : first + colours.size] = colours.ravel()
        context = self.renderer._mjr_context
        self.renderer.update_scene(data, camera="eye")
        mujoco.mjr_uploadHField(self.model, context, 0)
        mujoco.mjr_uploadTexture(self.model, context, texture.id)
        return self.renderer.render()


def water_colour(normals: np.ndarray, view: np.ndarray) -> np.ndarray:
    """Return the colour of water with normals seen along directions to the eye, (..., 3)."""
    facing = np.sum(normals * view, axis=-1, keepdims=True)
    mirrored = 2.0 * facing * normals - view
    fresnel = 0.02 + 0.98 * np.clip(1.0 - facing, 0.0, 1.0) ** 5
    up = np.clip(mirrored[..., 2:], 0.0, 1.0)
    sky = SKY + (ZENITH - SKY) * up**0.5
    sun = SUNLIGHT / math.hypot(*SUNLIGHT)
    glitter = np.clip(mirrored @ sun, 0.0, 1.0)[..., None] ** 120 * 6.0 * SUN
    lit = DEEP * (0.7 + 0.6 * np.clip(normals @ sun, 0.0, 1.0))[..., None]
    colour = lit + fresnel * (sky + glitter - lit)
    return np.clip(colour, 0.0, 1.0)
