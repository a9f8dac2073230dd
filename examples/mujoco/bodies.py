"""
Shapes with closed forms: a round buoy and Wigley's hull.

Both have vertical sides above the water line. Their stiffness, periods and response can be written
down, so that the simulation can be held against them.
"""

import math

import numpy as np
from panels import DENSITY, GRAVITY, Body, Panels


def grid_quads(rows: int, columns: int, first: int = 0) -> np.ndarray:
    """Return the quads of a grid of vertices that are counted along its rows."""
    j, i = np.mgrid[: rows - 1, : columns - 1]
    corner = (first + j * columns + i).reshape(-1, 1)
    return corner + np.array([0, 1, columns + 1, columns])


def linear_damping(
    share: float, vertices: np.ndarray, quads: np.ndarray, stiffness: float, mass: float
) -> float:
    """Return the damping of panels by which heave has a share of the critical one [Pa s/m]."""
    centres, areas = Panels.of(vertices, quads)
    below = areas[centres[:, 2] < 0.0]
    # a panel of slope n resists n v, and n of that is upward
    across = np.sum(below[:, 2] ** 2 / np.linalg.norm(below, axis=1))
    return share * 2.0 * math.sqrt(stiffness * mass) / across


def buoy(
    radius: float = 1.0, draught: float = 0.6, damping: float = 0.12, drag: float = 0.0
) -> Body:
    """
    Return an upright cylinder with a flat bottom.

    Its sides are those of a polygon with the area of the circle. Added mass in heave is that of a
    disc with water on one side, 4/3 rho r^3 (Lamb 1932, art. 102); in surge and sway that of the
    cylinder, rho pi r^2 d. `damping` is that of heave, as a part of the critical one.
    """
    around, top = 24, draught
    corner = radius * math.sqrt(2.0 * math.pi / (around * math.sin(2.0 * math.pi / around)))
    # the profile from the middle of the bottom to the middle of the lid: rings of panels
    profile = [(0.001, -draught), (0.25, -draught), (0.5, -draught), (0.75, -draught)]
    profile += [(1.0, z) for z in np.linspace(-draught, top, 7)] + [(0.5, top), (0.001, top)]
    angle = np.linspace(0.0, 2.0 * math.pi, around + 1)
    vertices = np.array(
        [
            (share * corner * math.cos(a), share * corner * math.sin(a), z)
            for share, z in profile
            for a in angle
        ]
    )
    quads = grid_quads(len(profile), around + 1)
    plane = math.pi * radius**2
    mass, heave = DENSITY * plane * draught, 4.0 / 3.0 * DENSITY * radius**3
    stiffness = DENSITY * GRAVITY * plane
    turning = 8.0 / 45.0 * DENSITY * radius**5  # of the disc about a diameter, one side
    return Body(
        vertices=vertices,
        quads=quads,
        mass=mass,
        centre=-0.15 * draught,
        radii=(0.5 * radius, 0.5 * radius, 0.7 * radius),
        added=(mass, mass, heave, turning, turning, 0.0),
        linear=linear_damping(damping, vertices, quads, stiffness, mass + heave),
        drag=drag,
    )


def hull(
    length: float = 9.0,
    beam: float = 2.6,
    draught: float = 0.8,
    freeboard: float = 0.8,
    damping: float = 0.15,
    drag: float = 0.6,
) -> Body:
    """
    Return Wigley's hull: y = beam/2 (1 - (2x/length)^2) (1 - (z/draught)^2), and a deck.

    Volume 4/9 length beam draught, water plane 2/3 length beam. Added mass and inertia are those of
    half circles over the beam of each section, rho pi/8 b(x)^2 (strip theory); along x and y it is
    a tenth of the mass, since one value serves both. `damping` is that of heave as a part of the
    critical one.
    """
    x = np.linspace(-1.0, 1.0, 25)
    z = np.concatenate([np.linspace(-1.0, 0.0, 7), [0.4, 0.8]])
    half = (1.0 - x[:, None] ** 2) * (1.0 - np.minimum(z, 0.0) ** 2)
    up = np.where(z < 0.0, z * draught, z / z.max() * freeboard)
    side = np.stack(np.broadcast_arrays(0.5 * length * x[:, None], 0.5 * beam * half, up), axis=-1)
    mirrored = side * (1.0, -1.0, 1.0)
    deck = np.stack([side[:, -1], mirrored[:, -1]], axis=1)
    quads, vertices = [], []
    for part, turned in ((side, False), (mirrored, True), (deck, False)):
        rows, columns = part.shape[:2]
        own = grid_quads(rows, columns, sum(len(v) for v in vertices))
        quads.append(own[:, ::-1] if turned else own)
        vertices.append(part.reshape(-1, 3))
    mass = DENSITY * 4.0 / 9.0 * length * beam * draught
    plane, strip = 2.0 / 3.0 * length * beam, DENSITY * math.pi / 8.0 * beam**2
    heave, pitch = strip * length * 8.0 / 15.0, strip * (0.5 * length) ** 3 * 16.0 / 105.0
    corners, panels, stiffness = (
        np.concatenate(vertices),
        np.concatenate(quads),
        DENSITY * GRAVITY * plane,
    )
    return Body(
        vertices=corners,
        quads=panels,
        mass=mass,
        centre=0.0,
        radii=(0.35 * beam, 0.25 * length, 0.25 * length),
        added=(0.1 * mass, 0.1 * mass, heave, 0.0, pitch, pitch),
        linear=linear_damping(damping, corners, panels, stiffness, mass + heave),
        drag=drag,
    )
