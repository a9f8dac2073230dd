"""
Forces of water on the panels of floating bodies.

Each panel has a pressure along its normal, and all forces are made of it:

    p + linear v + 1/2 rho drag v |v|        v: of the panel into the water, along its normal [m/s]

p is the pressure of the undisturbed wave, from the free surface down: hydrostatic and Froude-Krylov
force in one. The second term is the damping by the waves that a body makes, the third its drag.
The water that a body carries along is its added mass A: A (acceleration of the water - of the body)
acts besides. The part with the body's acceleration is added to the masses of its joint
(`add_mass`), so that the step stays stable.
"""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import mujoco
import numpy as np

import fftocean as fo

GRAVITY, DENSITY = 9.80665, 1025.0


class Flow(NamedTuple):
    """The undisturbed water at points."""

    pressure: np.ndarray  # above that of the air, 0 outside the water (points,) [Pa]
    velocity: np.ndarray  # (points, 3) [m/s]
    acceleration: np.ndarray  # (points, 3) [m/s^2]


class Water(Protocol):
    """A source of flow at points (points, 3) and a time."""

    def at(self, points: np.ndarray, t: float) -> Flow: ...


class LinearWater:
    """
    Linear theory below the surface, with Wheeler's stretching: the sum of all waves at each point.

    For few waves, and to compare with theory. `shortest` leaves out waves that a body does not
    feel [m].
    """

    def __init__(self, source, shortest: float = 0.0):
        self.source, self.shortest = source, shortest

    def at(self, points: np.ndarray, t: float) -> Flow:
        """Return the flow of linear theory."""
        found = fo.kinematics.at(
            self.source, *points.T, t, stretching="wheeler", shortest=self.shortest
        )
        still = DENSITY * GRAVITY * points[:, 2]
        pressure = np.where(found.wet, np.maximum(found.pressures - still, 0.0), 0.0)
        return Flow(pressure, found.velocities, found.accelerations)


class SurfaceWater:
    """
    The displaced surface, which is the one that is drawn, and the waves' decay below it.

    At a depth d under the surface, where the water accelerates upward by a, the pressure is

        rho (g d + a (1 - exp(-kappa d)) / kappa)

    which is right to first order in d for all waves, and exactly rho g (height exp(-k d) - z) for
    one of wavenumber kappa, that of the sea's vertical accelerations. One frame serves all points
    of a time, so that a thousand points cost little more than one.
    """

    def __init__(self, source, shortest: float = 0.0, threads: int = 1):
        self.query = fo.Query(source, shortest=shortest, threads=threads)
        self.kappa = decay_of(source, shortest)

    def at(self, points: np.ndarray, t: float) -> Flow:
        """Return the flow from that at the surface."""
        x, y, z = points.T
        found = self.query.at(x, y, t, ("heights", "velocities", "accelerations"))
        under = np.maximum(found.heights - z, 0.0)
        decay = np.exp(-self.kappa * under)
        reach = (1.0 - decay) / self.kappa if self.kappa else under
        pressure = DENSITY * (GRAVITY * under + found.accelerations[:, 2] * reach)
        decay = decay[:, None]
        return Flow(
            np.maximum(pressure, 0.0), decay * found.velocities, decay * found.accelerations
        )


def decay_of(source, shortest: float) -> float:
    """Return the wavenumber of a sea's vertical accelerations, rms omega^2/g [rad/m]."""
    oceans = source.oceans if isinstance(source, fo.Cascade) else [source]
    energy = moved = 0.0
    for modes in (ocean.modes() for ocean in oceans):
        felt = np.hypot(modes.kx, modes.ky) * shortest <= 2.0 * np.pi
        square = modes.amplitude[felt] ** 2
        energy += square.sum()
        moved += np.sum(square * modes.omega[felt] ** 4)
    return float(np.sqrt(moved / energy) / GRAVITY) if energy > 0.0 else 0.0


class Panels(NamedTuple):
    """The surface of a body in its own coordinates."""

    centres: np.ndarray  # (panels, 3) [m]
    areas: np.ndarray  # area times outward normal, (panels, 3) [m^2]

    @classmethod
    def of(cls, vertices: np.ndarray, quads: np.ndarray) -> "Panels":
        """Return the panels of quads, counter-clockwise seen from outside."""
        a, b, c, d = (vertices[quads[:, i]] for i in range(4))
        return cls((a + b + c + d) / 4.0, np.cross(c - a, d - b) / 2.0)


@dataclass(frozen=True)
class Body:
    """A floating body: shape, mass and coefficients, about the water line of still water."""

    vertices: np.ndarray  # (vertices, 3) [m], z = 0 at the water line
    quads: np.ndarray  # (panels, 4)
    mass: float  # that of the displaced water [kg]
    centre: float  # height of the centre of mass [m]
    radii: tuple[float, float, float]  # of gyration about x, y, z through it [m]
    added: tuple[float, float, float, float, float, float]  # mass [kg] along, inertia about x, y, z
    linear: float = 0.0  # [Pa s/m]
    drag: float = 0.0  # [-]

    def __post_init__(self) -> None:
        """Check that the water line is that of the mass."""
        panels = self.panels
        below = panels.centres[:, 2] < 0.0
        volume = np.sum(panels.centres[below, 2] * panels.areas[below, 2])
        if abs(DENSITY * volume / self.mass - 1.0) > 0.02:
            raise ValueError(
                f"mass must be that of the water below z = 0, {DENSITY * volume:.0f} kg, "
                f"got {self.mass:.0f} kg"
            )

    @property
    def panels(self) -> Panels:
        """The surface as panels."""
        return Panels.of(self.vertices, self.quads)


def add_mass(model: mujoco.MjModel, data: mujoco.MjData, name: str, body: Body) -> None:
    """
    Add the added mass of a body to its free joint.

    Along x, y and z of the world, so that of x and y should be alike, and about the axes of the
    body. It has no weight.
    """
    first = model.body(name).dofadr[0]
    model.dof_armature[first : first + 6] = body.added
    mujoco.mj_setConst(model, data)


class Forces:
    """The forces of one water on some bodies of a model, at one call a step."""

    def __init__(self, model: mujoco.MjModel, bodies: dict[str, Body], water: Water):
        self.water = water
        self.bodies = [(model.body(name).id, body, body.panels) for name, body in bodies.items()]
        self.ends = np.cumsum([panels.centres.shape[0] for *_, panels in self.bodies])[:-1]

    def apply(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Set `xfrc_applied` of each body: force and torque about its centre of mass."""
        turned = [data.xmat[i].reshape(3, 3) for i, *_ in self.bodies]
        points = [
            data.xpos[i] + panels.centres @ r.T
            for (i, _, panels), r in zip(self.bodies, turned, strict=True)
        ]
        flow = self.water.at(np.concatenate(points), data.time)
        parts = zip(*(np.split(field, self.ends) for field in flow), strict=True)
        for (i, body, panels), r, point, here in zip(
            self.bodies, turned, points, parts, strict=True
        ):
            data.xfrc_applied[i] = self._wrench(
                model, data, i, body, panels.areas @ r.T, point, Flow(*here)
            )

    @staticmethod
    def _wrench(model, data, i, body, areas, points, flow) -> np.ndarray:
        """Return force and torque on a body, (6,)."""
        motion = np.empty(6)  # angular and linear velocity of the centre of mass
        mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, i, motion, 0)
        arms = points - data.xipos[i]
        area = np.linalg.norm(areas, axis=1)
        wet = flow.pressure > 0.0
        normal = areas / area[:, None]
        through = np.cross(motion[:3], arms) + motion[3:] - flow.velocity
        v = np.sum(through * normal, axis=1) * wet
        pressure = flow.pressure + body.linear * v + 0.5 * DENSITY * body.drag * v * np.abs(v)
        forces = -pressure[:, None] * areas
        # mean acceleration of the water at the wet panels that face along each axis
        facing = np.abs(areas) * wet[:, None]
        water = np.sum(facing * flow.acceleration, axis=0) / np.maximum(facing.sum(axis=0), 1e-9)
        force = forces.sum(axis=0) + np.array(body.added[:3]) * water
        return np.concatenate([force, np.cross(arms, forces).sum(axis=0)])
