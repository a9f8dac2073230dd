"""
A hull and a buoy of MuJoCo on the sea of a job, at 50 steps a second, and pictures of it.

    python examples/mujoco/ride.py examples/mujoco/breeze.toml --picture ride.webp --film ride.gif

Needs `pip install "fftocean[robots]"`: MuJoCo, and for pictures EGL or OSMesa (`MUJOCO_GL=osmesa`).
Prints the time of a step and how the bodies move. `--picture` writes a contact sheet, `--film` an
animation of one loop of the sea after the bodies have settled on it, which leads back into itself
as far as they do.
"""

import argparse
import os
import sys
import time
from pathlib import Path

if sys.platform == "linux":
    os.environ.setdefault("MUJOCO_GL", "egl")  # read where MuJoCo is imported

import mujoco
import numpy as np
from bodies import buoy, hull
from panels import Body, Forces, LinearWater, SurfaceWater, add_mass
from scene import Picture, model_of

import fftocean as fo

RATE = 50.0  # steps a second
PLACES = {"hull": (0.0, 0.0), "buoy": (3.2, -4.5)}
HOLD = 20.0  # period of the spring that keeps a body in its place [s]


def tiles(text: str) -> list[tuple[int, float]]:
    """Return the tiles N:SIZE,... of a text."""
    return [(int(n), float(size)) for n, size in (tile.split(":") for tile in text.split(","))]


def sea_of(job: fo.Job, given: list[tuple[int, float]] | None = None) -> fo.Cascade:
    """Return the sea of a job on tiles: those given, or one of its size and one of a seventh."""
    s = job.settings
    size = float(np.max(s["ocean.size"]))
    return fo.Cascade(
        job.sea(),
        given or [(128, size), (128, size / 7.3)],
        seed=s["ocean.seed"],
        loop=s["ocean.loop"],
        choppiness=s["ocean.choppiness"],
    )


class Simulation:
    """Bodies on the water; each is held in its place by a slow spring, as by a long mooring."""

    def __init__(
        self,
        bodies: dict[str, Body],
        water: SurfaceWater | LinearWater,
        *,
        places: dict[str, tuple[float, float]] = PLACES,
        hold: float = HOLD,
        **scene: float,
    ):
        self.model = model_of(bodies, places, timestep=1.0 / RATE, **scene)
        self.data = mujoco.MjData(self.model)
        for name, body in bodies.items():
            add_mass(self.model, self.data, name, body)
        self.forces = Forces(self.model, bodies, water)
        self.bodies, self.places, self.hold = bodies, places, hold

    def step(self) -> None:
        """
        Advance by one step.

        Between `mj_step1`, which puts the bodies where they are now, and `mj_step2`: forces of the
        places of the step before would take the damping away.
        """
        mujoco.mj_step1(self.model, self.data)
        self.forces.apply(self.model, self.data)
        for name, body in self.bodies.items():
            joint, i = self.data.joint(self.model.body(name).jntadr[0]), self.model.body(name).id
            away = joint.qpos[:2] - self.places[name]
            w, x, y, z = joint.qpos[3:]
            yaw = np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
            omega = 2.0 * np.pi / self.hold
            moved = body.mass + np.array(body.added)[[0, 1]]
            self.data.xfrc_applied[i, :2] -= moved * omega * (omega * away + joint.qvel[:2])
            turned = body.mass * body.radii[2] ** 2 + body.added[5]
            self.data.xfrc_applied[i, 5] -= turned * omega * (omega * yaw + 2.0 * joint.qvel[5])
        mujoco.mj_step2(self.model, self.data)

    def heave(self, name: str) -> float:
        """Return the height of a body's water line above the mean level [m]."""
        return float(self.data.joint(self.model.body(name).jntadr[0]).qpos[2])


def sheet(pictures: list[np.ndarray], columns: int = 3, gap: int = 4) -> np.ndarray:
    """Return pictures of one size side by side, in rows."""
    height, width, _ = pictures[0].shape
    rows = -(-len(pictures) // columns)
    out = np.full((rows * (height + gap) - gap, columns * (width + gap) - gap, 3), 255, np.uint8)
    for i, picture in enumerate(pictures):
        top, left = i // columns * (height + gap), i % columns * (width + gap)
        out[top : top + height, left : left + width] = picture
    return out


def main() -> None:
    """Let both bodies ride the sea of a job."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("job", type=Path, nargs="?", help="TOML file of a sea")
    parser.add_argument("--tiles", type=tiles, metavar="N:SIZE,...", help="tiles of the cascade")
    parser.add_argument("--seconds", type=float, default=30.0, help="default: 30")
    parser.add_argument(
        "--linear", action="store_true", help="sum all waves at each panel (fo.kinematics)"
    )
    parser.add_argument("--picture", type=Path, help="contact sheet of six moments")
    parser.add_argument("--film", type=Path, help="animation of one loop: .webp or .gif")
    parser.add_argument("--rate", type=float, default=12.5, help="pictures a second of the film")
    parser.add_argument("--width", type=int, default=640, help="of a picture (default: 640)")
    options = parser.parse_args()

    job = fo.Job.read(options.job) if options.job else fo.Job.default()
    sea = sea_of(job, options.tiles)
    if options.film and not (sea.loop and sea.loop <= options.seconds):
        parser.error(f"--film needs --seconds of the loop at least, got {options.seconds:g} s")
    water = (LinearWater if options.linear else SurfaceWater)(sea, shortest=3.0)
    ride = Simulation({"hull": hull(), "buoy": buoy(drag=0.6)}, water)
    ride.step()  # compiles the kernels
    steps, spent, track = int(options.seconds * RATE), 0.0, []
    film_from = steps - round(sea.loop * RATE) if options.film else steps
    shots = {int(i) for i in np.linspace(steps // 2, steps - 1, 6)} if options.picture else set()
    every = max(1, round(RATE / options.rate))
    stills, film = [], []
    drawn = bool(options.picture or options.film)
    picture = (
        Picture(ride.model, fo.Query(sea), options.width, options.width * 9 // 16)
        if drawn
        else None
    )
    for i in range(steps):
        start = time.perf_counter()
        ride.step()
        spent += time.perf_counter() - start
        track.append([ride.heave("hull"), ride.heave("buoy")])
        filmed = i >= film_from and (i - film_from) % every == 0
        if picture and (i in shots or filmed):
            shot = picture.take(ride.data)
            stills += [shot] if i in shots else []
            film += [shot] if filmed else []
    points = sum(len(body.panels.areas) for body in ride.bodies.values())
    print(
        f"Hs {job.sea().hs:.2f} m",
        f"on {len(sea.oceans)} tiles; {points} panels; {1e3 * spent / steps:.2f} ms a step, "
        f"{steps / RATE / spent:.1f} x real time at {RATE:g} Hz",
    )
    for name, heave in zip(ride.bodies, np.array(track)[steps // 4 :].T, strict=True):
        print(f"{name}: 4 sigma of heave {4.0 * heave.std():.2f} m")
    save(options, stills, film, every)


def save(options: argparse.Namespace, stills: list, film: list, every: int) -> None:
    """Write the contact sheet and the film."""
    from PIL import Image

    if stills:
        Image.fromarray(sheet(stills)).save(options.picture, quality=80)
        print(f"drawn: {options.picture}")
    if film:
        first, *rest = (Image.fromarray(shot) for shot in film)
        first.save(
            options.film,
            save_all=True,
            append_images=rest,
            duration=int(1000 * every / RATE),
            loop=0,
            quality=60,
            method=4,
        )
        print(f"drawn: {options.film}")


if __name__ == "__main__":
    main()
