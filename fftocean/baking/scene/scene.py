"""
From an order to files, a frame at a time: all that a worker does, wherever it is. The same task
gives the same bytes.
"""

import io
import math
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fftocean import foam as foam_room
from fftocean.arrays import Real
from fftocean.baking.folder import layout
from fftocean.baking.folder.identity import differences, header_of
from fftocean.baking.folder.lock import require_held
from fftocean.baking.folder.plan import Entry, Order, Task
from fftocean.baking.scene import maps
from fftocean.baking.scene.maps import MAPS
from fftocean.errors import OutputError
from fftocean.eulerian import Eulerian
from fftocean.export import engines, exr, formats, profiles
from fftocean.files import make_rooms, write_whole
from fftocean.foam import Foam
from fftocean.frame import EulerianFrame, Frame
from fftocean.job.job import Job
from fftocean.kernels import half
from fftocean.ocean import Ocean
from fftocean.products import folding

STRETCHES = ("stretch_xx", "stretch_xy", "stretch_yy")
EXTREMES = ("height", "displace_x", "displace_y", *STRETCHES)
"""The fields that bound the water, for culling and for folds, whichever maps are written."""


class Scene:
    """
    The water of a job, set up once: every map of any frame, in the frame and unit of the files. For
    one thread.
    """

    def __init__(self, job: Job) -> None:
        self.job = job
        self.ocean: Ocean = job.ocean()
        self.form = formats.FORMATS[job.format]
        self.profile = engines.profile_for(job.engine, job.format, job.normals)
        self.foam = Foam(**job.foam)
        self._eulerian = Eulerian(self.ocean) if job.lookup == "eulerian" else None
        self._unresolved = (
            maps.unresolved(self.ocean) if job.mips or "slope_covariance" in job.maps else None
        )
        eulerian = self._eulerian is not None
        extremes = ("height",) if eulerian else EXTREMES
        self._needs = tuple(
            dict.fromkeys([*maps.needed(job.maps, mips=job.mips, eulerian=eulerian), *extremes])
        )
        self._frame: Frame | None = None

    @property
    def levels(self) -> int:
        """How many levels each map has, down to one sample where smaller ones are asked for."""
        return max(self.ocean.grid.shape).bit_length() if self.job.mips else 1

    def frame(self, j: int) -> Frame | EulerianFrame:
        """The j-th frame of the loop; good until the next."""
        if self._eulerian is not None:
            return self._eulerian.loop_frame(j, self.job.frames, self._needs)
        self._frame = self.ocean.loop_frame(j, self.job.frames, self._needs, out=self._frame)
        return self._frame

    def extremes(self, j: int, frame: Frame | EulerianFrame) -> dict[str, float | None]:
        """
        How far the water of the j-th frame goes, for culling, and its folds, which the maps of
        every lookup have.

        By place the water is a height field over its samples, and only the upper sheet of a fold is
        seen: its folds are those of the displaced surface that it shows.
        """
        if isinstance(frame, EulerianFrame):
            moved, water = 0.0, self.ocean.loop_frame(j, self.job.frames, STRETCHES)
        else:
            moved, water = float(np.max(np.hypot(frame.displace_x, frame.displace_y))), frame
        folds = folding(water)
        return {
            "min_jacobian": folds.min_jacobian,
            "folded": folds.share,
            "largest_choppiness": None
            if math.isinf(folds.largest_choppiness)
            else folds.largest_choppiness,
            "max_height": float(np.max(np.abs(frame.height))),
            "max_horizontal": frame.choppiness * moved,
        }

    def foam_states(self, frames: Sequence[int], folder: Path) -> Iterator[Real | None]:
        """
        The foam at some frames of one span, in order, each good until the next; None where no map
        shows it.
        """
        if "foam" not in self.job.maps:
            yield from (None for _ in frames)
            return
        span = frames[0] // foam_room.SPAN
        start = np.load(folder / layout.FOAM_STARTS, mmap_mode="r", allow_pickle=False)[span]
        for j, state in self.foam.states(
            self.ocean, self.job.frames, start, span * foam_room.SPAN, frames[-1] + 1
        ):
            if j in frames:
                yield state

    def pictures(
        self, frame: Frame | EulerianFrame, state: Real | None
    ) -> Iterator[tuple[str, list[Real]]]:
        """
        Each map of a frame as its file has it, (rows, columns, channels) float32: the map, and its
        smaller levels where asked for.
        """
        coverage = None
        if state is not None:
            coverage = foam_room.coverage(
                state if self._eulerian is None else self._eulerian.resample(state)
            )
        for name in self.job.maps:
            m = MAPS[name]
            moment = frame, coverage, self._unresolved
            levels = m.levels(*moment) if self.job.mips else [m.channels(*moment)]
            yield name, [profiles.arrange(self.profile, m.kind, level) for level in levels]

    def stored(self, pictures: list[Real]) -> list[Real]:
        """
        The same in the precision of the format: halves are packed here; all else, and what no half
        can hold, is the encoder's affair.
        """
        return (
            [_halves(picture) for picture in pictures]
            if self.form.stored == "float16"
            else pictures
        )


def _halves(picture: Real) -> Real:
    """Floats rounded to the nearest half; as they are, where one is too large or no number."""
    floats = np.ascontiguousarray(picture, dtype=np.float32)
    if not max(-float(floats.min()), float(floats.max())) <= exr.HALF_MAX:
        return floats
    out = np.empty(floats.shape, dtype=np.uint16)
    half.pack(floats.reshape(-1).view(np.uint32), out.reshape(-1))
    return out.view(np.float16)


_desk = threading.local()  # each thread has its own scene, as it has plans and buffers


def seat(claim: str, scene: Scene) -> None:
    """Let this thread work on a scene that it has already."""
    _desk.held = claim, scene


def leave() -> None:
    """Give back the memory of this thread's scene."""
    _desk.__dict__.clear()


def scene_of(order: Order) -> Scene:
    """
    Return this thread's scene of an order, set up anew only where it last worked on another one.

    Raises:
        OutputError: this process would not write the same bytes: other libraries, or another
            measured file.
    """
    claim, scene = getattr(_desk, "held", ("", None))
    if scene is None or claim != order.claim:
        scene = Scene(order.job.downsampled(order.downsample))
        mine = header_of(
            order.job, frames=order.frames, downsample=order.downsample, backend=scene.ocean.backend
        )
        if changes := differences(order.header, mine):
            raise OutputError(f"a worker would not write the same bytes ({changes:.400})")
        seat(order.claim, scene)
    return scene


def work(order: Order, task: Task) -> Iterator[Entry]:
    """
    Carry out a task, and yield what the journal is to have of it, each when it is on the disk. It
    may be done again, by anybody.

    Raises:
        OutputError: a file cannot be written, or a value not be stored in it; `FolderInUseError`,
            where the bake was given up.
    """
    scene, folder = scene_of(order), Path(order.folder)
    if task.kind == "foam":
        yield _foam_made(scene, folder, task.frames, order.token)
        return
    for j, state in zip(task.frames, scene.foam_states(task.frames, folder), strict=True):
        require_held(folder, order.token)
        frame = scene.frame(j)
        if task.kind == "range":
            yield {
                "range": {
                    "frame": j,
                    "maps": {
                        name: _range_of(levels) for name, levels in scene.pictures(frame, state)
                    },
                }
            }
        else:
            files = {
                name: _written(order, scene, folder, name, j, levels)
                for name, levels in scene.pictures(frame, state)
            }
            yield {
                "row": {
                    "frame": j,
                    "t": frame.t,
                    "extremes": scene.extremes(j, frame),
                    "files": files,
                }
            }


def _foam_made(scene: Scene, folder: Path, frames: Sequence[int], token: str) -> Entry:
    """What a span of the loop makes of foam, kept in a file."""
    require_held(folder, token)
    first, stop = frames[0], frames[-1] + 1
    stream = io.BytesIO()
    np.save(
        stream, scene.foam.response(scene.ocean, scene.job.frames, first, stop), allow_pickle=False
    )
    file = layout.foam_file(first)
    return {
        "foam": {
            "first": first,
            "path": file,
            "sha256": write_whole(make_rooms(folder, file), stream.getbuffer()),
        }
    }


def _written(
    order: Order, scene: Scene, folder: Path, name: str, j: int, levels: list[Real]
) -> dict[str, Any]:
    """Write a map of a frame; what the manifest says of it."""
    place = order.place(j)
    file = layout.frame_file(scene.form, name, j, place)
    low, high = order.ranges.get(name, (None, None))
    stored = scene.stored(levels)
    try:
        data = formats.encode(scene.form.name, stored[0], lo=low, hi=high, levels=stored[1:])
    except OutputError as error:
        raise OutputError(f"{folder / file} could not be encoded: {error}") from None
    sha256 = write_whole(make_rooms(folder, file), data)
    entry = (
        {"path": file}
        if scene.form.scope == "frame"
        else {"path": layout.container(scene.form, name), "index": place}
    )
    number = (
        np.float16 if scene.form.stored == "float16" else np.float32
    )  # a half may lie beyond the value that it was rounded from
    ranges = [[float(number(low)), float(number(high))] for low, high in _channel_ranges(levels[0])]
    return {**entry, "bytes": len(data), "sha256": sha256, "range": ranges}


def _channel_ranges(picture: Real) -> list[tuple[float, float]]:
    """The least and the greatest value of each channel."""
    return [
        (float(picture[..., c].min()), float(picture[..., c].max()))
        for c in range(picture.shape[-1])
    ]


def _range_of(levels: list[Real]) -> list[float]:
    """The least and the greatest value of a map, all channels and levels."""
    return [
        min(float(level.min()) for level in levels),
        max(float(level.max()) for level in levels),
    ]
