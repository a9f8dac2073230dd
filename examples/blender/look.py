"""Light, water and camera of the scenes: what a sea looks like in Blender."""

import math

import bpy
from mathutils import Vector

IOR = 1.333
FOAM = (0.62, 0.65, 0.66, 1.0)
CHANNELS = (  # of red, green and blue: wavelength [nm], and of pure sea water: absorption (Pope &
    # Fry 1997), backscattering (Smith & Baker 1981) [1/m], phytoplankton's absorption (Morel 1991)
    (610.0, 0.264, 0.00061, 0.24),
    (550.0, 0.0565, 0.00095, 0.36),
    (465.0, 0.0101, 0.0020, 0.89),
)


def depth_colour(chlorophyll):
    """
    Return the share of light that deep water sends back, (red, green, blue).

    With u = bb/(a + bb) the reflectance below the surface is (0.0949 + 0.0794 u) u (Gordon et al.
    1988), above it 0.52 r/(1 - 1.7 r) (Lee et al. 2002); times pi it is an albedo.

    Args:
        chlorophyll: 0.03 (blue ocean) to 10 (green coast) [mg/m^3].
    """
    particles = 0.30 * chlorophyll**0.62  # their scattering at 550 nm [1/m] (Morel 1988)
    backward = 0.002 + 0.02 * (0.5 - 0.25 * math.log10(chlorophyll))
    colour = []
    for wavelength, absorbed, scattered, plankton in CHANNELS:
        dissolved = 1.0 + 0.2 * math.exp(-0.014 * (wavelength - 440.0))
        a = (absorbed + 0.06 * plankton * chlorophyll**0.65) * dissolved
        bb = scattered + particles * backward * 550.0 / wavelength
        u = bb / (a + bb)
        r = (0.0949 + 0.0794 * u) * u
        colour.append(math.pi * 0.52 * r / (1.0 - 1.7 * r))
    return tuple(colour)


class Nodes:
    """A shader's nodes: make one with its settings, and link it."""

    def __init__(self, tree):
        self.tree = tree

    def new(self, kind, inputs=None, **settings):
        """Return a new node; inputs are values, or sockets to link."""
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for name, value in (inputs or {}).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[name])
            else:
                node.inputs[name].default_value = value
        return node

    def math(self, operation, a, b):
        """Return the socket of an operation on two values or sockets."""
        return self.new("ShaderNodeMath", {0: a, 1: b}, operation=operation).outputs[0]


def fresh_nodes(owner):
    """Return the nodes of a material or a world, without any."""
    if bpy.app.version < (5, 0, 0):
        owner.use_nodes = True
    owner.node_tree.nodes.clear()
    return Nodes(owner.node_tree)


def water_material(coverage, *, place, roughness=0.1, normal=None, chlorophyll=0.4):
    """
    Return water with foam on it: two Principled shaders and a mask.

    Args:
        coverage, place, roughness, normal: functions of the nodes, to the socket of the share of
            foam, of the rest position [m], of roughness and of the normal; `coverage` and `normal`
            may be None, and roughness a number.
        chlorophyll: in the water [mg/m^3].
    """
    material = bpy.data.materials.new("water")
    nodes = fresh_nodes(material)
    inputs = {
        "Base Color": (*depth_colour(chlorophyll), 1.0),
        "IOR": IOR,
        "Roughness": roughness(nodes) if callable(roughness) else roughness,
    }
    if normal:
        inputs["Normal"] = normal(nodes)
    shown = nodes.new("ShaderNodeBsdfPrincipled", inputs, name="water").outputs[0]
    if coverage:
        white = {"Base Color": FOAM, "Roughness": 0.9, "IOR": IOR}
        foam = nodes.new("ShaderNodeBsdfPrincipled", white, name="foam").outputs[0]
        mask = broken_up(nodes, coverage(nodes), place(nodes))
        shown = nodes.new("ShaderNodeMixShader", {0: mask, 1: shown, 2: foam}).outputs[0]
    nodes.new("ShaderNodeOutputMaterial", {"Surface": shown})
    return material


def broken_up(nodes, coverage, place):
    """Return a mask of patches with holes and threads that covers about that share of the water."""
    patches = {"Vector": place, "Scale": 1.1, "Detail": 9.0, "Roughness": 0.68, "Distortion": 0.9}
    noise = nodes.new("ShaderNodeTexNoise", patches).outputs[0]
    # noise lies between these nearly everywhere: spread evenly, a threshold is a share
    even = {"Value": noise, "From Min": 0.36, "From Max": 0.64, "To Min": 0.0, "To Max": 1.0}
    even = nodes.new("ShaderNodeMapRange", even).outputs[0]
    over = nodes.math("SUBTRACT", nodes.math("ADD", coverage, even), 1.0)
    edge = {"Value": over, "From Min": -0.2, "From Max": 0.2, "To Min": 0.0, "To Max": 1.0}
    soft = nodes.new("ShaderNodeMapRange", edge, interpolation_type="SMOOTHSTEP").outputs[0]
    there = nodes.math("MINIMUM", nodes.math("MULTIPLY", coverage, 8.0), 1.0)
    return nodes.math("MULTIPLY", soft, there)


def ripples(nodes, place, near, drift, rms=0.16):
    """
    Return the normal with ripples that are too short for the mesh, where they can be told apart.

    A picture of them by noise, not waves: their slope is that of the waves left out. They drift
    with the value of the node `drift`, which goes once around a circle in the loop.
    """
    moved = nodes.new("ShaderNodeVectorMath", {0: place, 1: drift}, operation="ADD").outputs[0]
    fine = {"Vector": moved, "Scale": 3.0, "Detail": 4.0, "Roughness": 0.55, "Distortion": 0.2}
    height = nodes.math("MULTIPLY", nodes.new("ShaderNodeTexNoise", fine).outputs[0], 0.65 * rms)
    height = nodes.math("MULTIPLY", height, near)
    return nodes.new("ShaderNodeBump", {"Height": height, "Distance": 1.0}).outputs[0]


def drift_node(nodes, frames):
    """
    Return the socket of a vector that goes once around a circle in the loop, by its own curve.

    Its radius is 0.5 m: ripples move with some decimetres a second.
    """
    node = nodes.new("ShaderNodeCombineXYZ", name="drift")
    for axis, phase in ((0, 0.0), (1, 0.5 * math.pi)):
        socket = node.inputs[axis]
        # one driver of simple arithmetic, which Blender runs without leave for scripts
        curve = socket.driver_add("default_value").driver
        curve.expression = (
            f"0.5 * sin({2.0 * math.pi / frames:.12f} * ((frame - 1) % {frames}) + {phase:.9f})"
        )
    return node.outputs[0]


def attribute(name, output=2):
    """Return a function of nodes to the socket of a mesh's attribute: 1 a vector, 2 a number."""
    return lambda nodes: nodes.new("ShaderNodeAttribute", attribute_name=name).outputs[output]


def sky(elevation, azimuth, exposure):
    """
    Light the scene by a sky with its sun.

    Args:
        elevation, azimuth: of the sun [degrees]; azimuth counter-clockwise from east (+x).
        exposure: of the picture, in stops.
    """
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    nodes = fresh_nodes(world)
    modern = bpy.app.version >= (5, 0, 0)
    air = nodes.new(
        "ShaderNodeTexSky",
        sky_type="MULTIPLE_SCATTERING" if modern else "NISHITA",
        sun_elevation=math.radians(elevation),
        sun_rotation=math.radians(90.0 - azimuth),  # clockwise from north (+y)
        altitude=10.0,
    )
    background = nodes.new("ShaderNodeBackground", {"Color": air.outputs[0], "Strength": 1.0})
    nodes.new("ShaderNodeOutputWorld", {"Surface": background.outputs[0]})
    view = bpy.context.scene.view_settings
    view.exposure, view.look = exposure, "AgX - Medium High Contrast"


def camera(eye, target, lens=32.0, far=50e3):
    """Add the camera that looks from `eye` at `target` [m]."""
    seeing = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    seeing.location = eye
    seeing.rotation_euler = (Vector(target) - Vector(eye)).to_track_quat("-Z", "Y").to_euler()
    seeing.data.lens, seeing.data.clip_start, seeing.data.clip_end = lens, 0.1, far
    bpy.context.scene.collection.objects.link(seeing)
    bpy.context.scene.camera = seeing


def quality(width, height, samples, frames, seconds):
    """Set size, samples, and a loop of frames from 1 that lasts some seconds."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = True
    scene.cycles.max_bounces, scene.cycles.sample_clamp_indirect = 4, 10.0
    scene.cycles.seed = 0  # the same grain in each frame, so that a loop closes to the pixel
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.use_persistent_data = True
    scene.frame_start, scene.frame_end = 1, frames
    rate = frames / seconds
    scene.render.fps = max(1, round(rate))
    scene.render.fps_base = scene.render.fps / rate
