"""
Heave, pitch and roll of a floating box, from the water pressure under a grid of points at 50 Hz.

    python examples/buoyancy.py [--seconds 60] [--picture buoyancy.png | --no-picture]

The picture needs matplotlib (in a checkout: pip install ".[plot]"); without it the run is the same.

The box stays above one position. At each point the pressure is rho g times the depth to which the
point is submerged; the sum of these forces and of their moments, with damping relative to the
water's vertical velocity, moves the box. Waves shorter than the box's beam are left out of the
query: they act on a point, but average out over a hull. First the box is released above its
equilibrium in calm water: its period must be that of the closed form.
"""

import argparse
import importlib.util
import math
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import fftocean as fo

GRAVITY, WATER = 9.80665, 1025.0
RATE = 50.0  # steps a second


@dataclass(frozen=True)
class Box:
    """A box of uniform density, with points on its bottom, each for an equal part of it."""

    length: float = 12.0  # along x [m]
    beam: float = 5.0  # along y [m]
    height: float = 2.4  # [m]
    draught: float = 1.2  # of it in calm water [m]
    damping: float = 0.15  # of critical, in heave; pitch and roll are damped by the same forces
    points: tuple[int, int] = (9, 5)

    @property
    def mass(self) -> float:
        """Mass of the water displaced in calm water [kg]."""
        return WATER * self.length * self.beam * self.draught

    @property
    def inertia(self) -> tuple[float, float]:
        """Moments of inertia about the x (roll) and y (pitch) axes of the box [kg m^2]."""
        return self.mass / 12.0 * (self.beam**2 + self.height**2), self.mass / 12.0 * (
            self.length**2 + self.height**2
        )

    @property
    def heave_period(self) -> float:
        """
        Period of heave without added mass [s].

        2 pi sqrt(m / (rho g A)) = 2 pi sqrt(draught / g): the water acts as a spring.
        """
        return 2.0 * math.pi * math.sqrt(self.draught / GRAVITY)

    def bottom(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the points in the box's own coordinates, each the centre of its part [m]."""
        nx, ny = self.points
        x = ((np.arange(nx) + 0.5) / nx - 0.5) * self.length
        y = ((np.arange(ny) + 0.5) / ny - 0.5) * self.beam
        return tuple(a.ravel() for a in np.meshgrid(x, y))


def ride(box: Box, query: fo.Query | None, seconds: float, heave: float = 0.0) -> np.ndarray:
    """
    Return time, heave [m], roll and pitch [rad], and the height of the water at the centre.

    Semi-implicit Euler: the current forces change the velocity, and the new velocity moves the box.
    It conserves the energy of a spring, which the explicit rule increases, and needs the water once
    a step. The period of heave is 2.2 s, 110 steps.

    Args:
        box: the box.
        query: the water; None for calm water.
        seconds: the duration [s].
        heave: at the start [m].

    Returns:
        (steps, 5).
    """
    x, y = box.bottom()
    part = box.length * box.beam / x.size
    drag = (
        2.0 * box.damping * math.sqrt(WATER * GRAVITY * box.length * box.beam * box.mass) / x.size
    )
    roll_inertia, pitch_inertia = box.inertia
    # the centre of mass lies above that of the displaced water
    tipping = box.mass * GRAVITY * 0.5 * (box.height - box.draught)
    state = np.array([heave, 0.0, 0.0])  # heave, roll, pitch
    speed = np.zeros(3)
    steps = int(seconds * RATE)
    out = np.empty((steps, 5))
    for step in range(steps):
        t = step / RATE
        if query is None:
            water, rising, middle = np.zeros(x.size), np.zeros(x.size), 0.0
        else:  # one call a step; angles are small: the points stay above their (x, y)
            found = query.at(np.append(x, 0.0), np.append(y, 0.0), t, ("heights", "velocities"))
            water, rising, middle = found.heights[:-1], found.velocities[:-1, 2], found.heights[-1]
        # of each point: roll lifts port (y), pitch lowers the bow (x)
        level = state[0] - box.draught + y * state[1] - x * state[2]
        moving = speed[0] + y * speed[1] - x * speed[2]
        submerged = np.clip(water - level, 0.0, box.height)
        force = WATER * GRAVITY * part * submerged + np.where(
            submerged > 0.0, drag * (rising - moving), 0.0
        )
        roll = (np.sum(y * force) + tipping * state[1]) / roll_inertia
        pitch = (-np.sum(x * force) + tipping * state[2]) / pitch_inertia
        speed = speed + np.array([np.sum(force) / box.mass - GRAVITY, roll, pitch]) / RATE
        state = state + speed / RATE
        out[step] = t, *state, middle
    return out


def period_of(heave: np.ndarray) -> float:
    """Return the mean time between upward crossings of zero [s]."""
    up = np.flatnonzero((heave[:-1] < 0.0) & (heave[1:] >= 0.0))
    exact = up + heave[up] / (heave[up] - heave[up + 1])
    return float(np.mean(np.diff(exact)) / RATE)


def main() -> None:
    """Let the box float in calm water, then on a sea."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--picture", type=Path, default=Path("buoyancy.png"))
    parser.add_argument("--no-picture", action="store_true", help="draw nothing")
    options = parser.parse_args()
    drawn = not options.no_picture
    if drawn and importlib.util.find_spec("matplotlib") is None:
        print(
            "matplotlib is not installed, so no picture is drawn; "
            "in a checkout: pip install '.[plot]'"
        )
        drawn = False
    box = Box()
    damped = box.heave_period / math.sqrt(1.0 - box.damping**2)
    measured = period_of(ride(box, None, 20.0, heave=0.3)[:, 1])
    print(
        f"heave in calm water: {measured:.3f} s between crossings; "
        f"the closed form has {damped:.3f} s"
    )

    sea = fo.Sea.from_wind(speed=9.0, fetch=60e3, direction=25.0)
    cascade = fo.Cascade(sea, tiles=[(128, 400.0), (128, 57.0)], seed=7, choppiness=1.0)
    query = fo.Query(cascade, mode="bicubic", shortest=box.beam)
    query.at(0.0, 0.0, 0.0)  # compiles the kernels
    start = time.perf_counter()
    track = ride(box, query, options.seconds)
    took = time.perf_counter() - start
    steps = track.shape[0]
    print(
        f"{steps} steps at {RATE:g} Hz in {took:.1f} s: {1e3 * took / steps:.2f} ms each, "
        f"{options.seconds / took:.1f} x real time"
    )
    heave, roll, pitch = np.std(track[:, 1:4], axis=0)
    angles = (
        f"4 sigma of roll {np.degrees(4 * roll):.0f}, of pitch {np.degrees(4 * pitch):.0f} degrees"
    )
    print(f"Hs {sea.hs:.2f} m; heave {4 * heave:.2f} m; {angles}")
    if drawn:
        draw(query, box, track, options.picture)


def draw(query: fo.Query, box: Box, track: np.ndarray, picture: Path) -> None:
    """Draw heave and water, both angles, and the box on the water at the last step."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    t, heave, roll, pitch, water = track.T
    figure = plt.figure(figsize=(12, 7), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(1.5, 1))
    up, turn, sea = (
        figure.add_subplot(grid[0, 0]),
        figure.add_subplot(grid[1, 0]),
        figure.add_subplot(grid[:, 1]),
    )
    up.plot(t, water, color="0.65", label="water at the middle")
    up.plot(t, heave, color="C0", label="heave")
    up.set(ylabel="[m]", title=f"A box of {box.length:g} x {box.beam:g} m, 50 steps a second")
    turn.plot(t, np.degrees(roll), color="C1", label="roll")
    turn.plot(t, np.degrees(pitch), color="C2", label="pitch")
    turn.set(xlabel="t [s]", ylabel="[degrees]")
    for axes in (up, turn):
        axes.legend(loc="upper right", ncols=2)
        axes.grid(alpha=0.3)
        axes.set_xlim(t[0], t[-1])
    side = np.linspace(-40.0, 40.0, 200)
    x, y = np.meshgrid(side, side)
    shown = sea.pcolormesh(
        x, y, query.at(x, y, t[-1], "heights").heights, cmap="Blues_r", shading="auto"
    )
    figure.colorbar(shown, ax=sea, label="height [m]", shrink=0.6)
    sea.add_patch(
        plt.Rectangle(
            (-box.length / 2, -box.beam / 2), box.length, box.beam, facecolor="C1", edgecolor="k"
        )
    )
    px, py = box.bottom()
    sea.plot(px, py, ".", color="k", markersize=3)
    sea.set(
        aspect="equal",
        xlabel="x [m]",
        ylabel="y [m]",
        title=f"t = {t[-1]:.0f} s: waves longer than the beam",
    )
    figure.savefig(picture, dpi=110)
    print(f"drawn: {picture}")


if __name__ == "__main__":
    main()
