"""
Frames of a job, rendered to maps and written to files: the work of every worker, wherever it runs.

The same task gives the same bytes.
"""

import io
import math
import threading
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from fftocean import foam as foam_module
from fftocean.arrays import Real
from fftocean.baking.folder import layout
from fftocean.baking.folder.identity import differences, header_of
from fftocean.baking.folder.journal import Entry
from fftocean.baking.folder.lock import require_held
from fftocean.baking.folder.plan import Plan, Task
from fftocean.baking.scene import maps
from fftocean.baking.scene.maps import MAPS
from fftocean.errors import OutputError
from fftocean.eulerian import Eulerian
from fftocean.export import engines, exr, formats, profiles
from fftocean.files import make_parents, write_whole
from fftocean.foam import Foam
from fftocean.frame import EulerianFrame, Frame
from fftocean.job.job import Job
from fftocean.kernels import half
from fftocean.ocean import Ocean
from fftocean.products import folding

AHEAD = 2
"""Most frames that are computed and not written yet, beside the one that is computed."""

STRETCHES = ("stretch_xx", "stretch_xy", "stretch_yy")
EXTREMES = ("height", "displace_x", "displace_y", *STRETCHES)
"""Fields that give bounds and folds of the surface, whichever maps are written."""


class Scene:
    """
    Ocean, foam and file conventions of a job, set up once to render maps of any frame.

    Not thread-safe: each thread has its own.
    """

    def __init__(self, job: Job) -> None:
        self.job = job
        self._count, self._maps, self._mips = job.frames, job.maps, job.mips
        self.ocean: Ocean = job.ocean()
        self.form = formats.FORMATS[job.format]
        self.profile = engines.profile_for(job.engine, job.format, job.normals)
        self._foam: Foam | None = None
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
        """Number of mip levels of each map: down to one sample, or 1 without mips."""
        return max(self.ocean.grid.shape).bit_length() if self._mips else 1

    @property
    def foam(self) -> Foam:
        """Foam of the job on its water; a threshold that follows the wind is solved at first."""
        if self._foam is None:
            self._foam = self.job.foam_on(self.ocean)
        return self._foam

    def frame(self, j: int) -> Frame | EulerianFrame:
        """Return the j-th frame of the loop; the next call may overwrite its arrays."""
        if self._eulerian is not None:
            return self._eulerian.loop_frame(j, self._count, self._needs)
        self._frame = self.ocean.loop_frame(j, self._count, self._needs, out=self._frame)
        return self._frame

    def extremes(self, j: int, frame: Frame | EulerianFrame) -> dict[str, float | None]:
        """
        Return bounds of the displacements of the j-th frame, for culling, and its folds.

        An eulerian frame is a height field, of which only the upper sheet of a fold is seen. Its
        folds are those of the displaced surface.
        """
        if isinstance(frame, EulerianFrame):
            moved, water = 0.0, self.ocean.loop_frame(j, self._count, STRETCHES)
        else:
            square = np.square(frame.displace_x)
            square += np.square(frame.displace_y)
            most = np.unravel_index(np.argmax(square), square.shape)
            moved = math.hypot(frame.displace_x[most], frame.displace_y[most])
            water = frame
        folds = folding(water)
        return {
            "min_jacobian": folds.min_jacobian,
            "folded": folds.share,
            "largest_choppiness": None
            if math.isinf(folds.largest_choppiness)
            else folds.largest_choppiness,
            "max_height": max(-float(frame.height.min()), float(frame.height.max())),
            "max_horizontal": frame.choppiness * moved,
        }

    def foam_states(self, frames: Sequence[int], folder: Path) -> Iterator[Real | None]:
        """
        Yield the foam at some frames of one span, in order; None where no map shows foam.

        Each array is valid until the next is made.
        """
        if "foam" not in self._maps:
            yield from (None for _ in frames)
            return
        span = frames[0] // foam_module.SPAN
        starts = np.load(folder / layout.FOAM_STARTS, mmap_mode="r", allow_pickle=False)
        start = np.array(starts[span])
        del starts  # a mapped file cannot be removed on Windows
        for j, state in self.foam.states(
            self.ocean, self._count, start, span * foam_module.SPAN, frames[-1] + 1
        ):
            if j in frames:
                yield state

    def maps(
        self, frame: Frame | EulerianFrame, state: Real | None
    ) -> Iterator[tuple[str, list[Real]]]:
        """
        Yield the name and the levels of each map of a frame, in the conventions of the files.

        A level is (rows, columns, channels), float32. Without mips there is one.
        """
        coverage = None
        if state is not None:
            coverage = foam_module.coverage(
                state if self._eulerian is None else self._eulerian.resample(state)
            )
        for name in self._maps:
            m = MAPS[name]
            state_now = frame, coverage, self._unresolved
            levels = m.levels(*state_now) if self._mips else [m.channels(*state_now)]
            yield name, [profiles.arrange(self.profile, m.kind, level) for level in levels]

    def stored(self, levels: list[Real]) -> list[Real]:
        """
        Return levels in the precision of the format, if that is half; else as they are.

        The encoder converts to all other types, and refuses values too large for a half. Of three
        maps of 512 x 512 this takes 1.4 of 31 ms of a frame's processor time, the encoder 20:
        frames that held halves from the start would save no more than that.
        """
        return [_halves(level) for level in levels] if self.form.stored == "float16" else levels


def _halves(values: Real) -> Real:
    """Return values rounded to halves; unchanged if one is NaN or too large for a half."""
    floats = np.ascontiguousarray(values, dtype=np.float32)
    if not max(-float(floats.min()), float(floats.max())) <= exr.HALF_MAX:
        return floats
    out = np.empty(floats.shape, dtype=np.uint16)
    half.pack(floats.reshape(-1).view(np.uint32), out.reshape(-1))
    return out.view(np.float16)


_thread = threading.local()  # each thread has its own scene


def set_scene(identity: str, scene: Scene) -> None:
    """Let this thread use a scene for the plan of an identity."""
    _thread.scene = identity, scene


def clear_scene() -> None:
    """Release this thread's scene."""
    _thread.__dict__.clear()


def scene_of(plan: Plan) -> Scene:
    """
    Return this thread's scene of a plan, set up anew if its last plan was another one.

    Raises:
        OutputError: this process would write other bytes, as its libraries or measured files are
            others.
    """
    identity, scene = getattr(_thread, "scene", ("", None))
    if scene is None or identity != plan.identity:
        scene = Scene(plan.job.downsampled(plan.downsample))
        mine = header_of(
            plan.job, frames=plan.frames, downsample=plan.downsample, backend=scene.ocean.backend
        )
        if changes := differences(plan.header, mine):
            raise OutputError(f"a worker would not write the same bytes ({changes:.400})")
        set_scene(plan.identity, scene)
    return scene


def work(plan: Plan, task: Task, *, threads: int = 1) -> Iterator[Entry]:
    """
    Carry out a task; yield an entry for the journal when its result is on the disk.

    A task may be repeated, by any worker.

    Args:
        plan: the plan of the bake.
        task: what to do of it.
        threads: number of threads that encode and write frames while the next are computed.

    Raises:
        OutputError: a file cannot be written, or cannot store a value.
        FolderInUseError: the bake was stopped, or another one has the folder.
    """
    scene, folder = scene_of(plan), Path(plan.folder)
    if task.kind == "foam":
        yield _write_foam(scene, folder, task.frames, plan.token)
    elif task.kind == "range":
        for j, state in zip(task.frames, scene.foam_states(task.frames, folder), strict=True):
            require_held(folder, plan.token)
            levels = scene.maps(scene.frame(j), state)
            yield {"range": {"frame": j, "maps": {name: _range_of(one) for name, one in levels}}}
    else:
        yield from _write_frames(plan, scene, folder, task.frames, threads)


def _write_frames(
    plan: Plan, scene: Scene, folder: Path, frames: Sequence[int], threads: int
) -> Iterator[Entry]:
    """
    Compute frames, and write them by other threads meanwhile; yield the entry of each in order.

    When this ends or is closed, no thread writes any more.
    """
    waiting: deque[tuple[dict[str, Any], dict[str, Future[dict[str, Any]]]]] = deque()
    pool = ThreadPoolExecutor(threads, "fftocean-writer")
    try:
        for j, state in zip(frames, scene.foam_states(frames, folder), strict=True):
            require_held(folder, plan.token)
            frame = scene.frame(j)
            files = {
                name: pool.submit(_write_map, plan, scene, folder, name, j, levels)
                for name, levels in scene.maps(frame, state)
            }
            row = {"frame": j, "t": frame.t, "extremes": scene.extremes(j, frame)}
            waiting.append((row, files))
            if len(waiting) > AHEAD:
                yield _finished(*waiting.popleft())
        while waiting:
            yield _finished(*waiting.popleft())
    finally:
        pool.shutdown(cancel_futures=True)


def _finished(row: dict[str, Any], files: dict[str, "Future[dict[str, Any]]"]) -> Entry:
    """Return the entry of a frame, once its files are on the disk."""
    return {"row": {**row, "files": {name: file.result() for name, file in files.items()}}}


def _write_foam(scene: Scene, folder: Path, frames: Sequence[int], token: str) -> Entry:
    """Write the foam response of a span of the loop; return its entry."""
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
            "sha256": write_whole(make_parents(folder, file), stream.getbuffer()),
        }
    }


def _write_map(
    plan: Plan, scene: Scene, folder: Path, name: str, j: int, levels: list[Real]
) -> dict[str, Any]:
    """Write a map of a frame, in a thread of its own; return its entry of the manifest."""
    require_held(folder, plan.token)
    place = plan.place(j)
    file = layout.frame_file(scene.form, name, j, place)
    low, high = plan.ranges.get(name, (None, None))
    stored = scene.stored(levels)
    try:
        data = formats.encode(scene.form.name, stored[0], lo=low, hi=high, levels=stored[1:])
    except OutputError as error:
        raise OutputError(f"{folder / file} could not be encoded: {error}") from None
    sha256 = write_whole(make_parents(folder, file), data)
    entry = (
        {"path": file}
        if scene.form.scope == "frame"
        else {"path": layout.container(scene.form, name), "index": place}
    )
    number = (
        np.float16 if scene.form.stored == "float16" else np.float32
    )  # a rounded half may exceed the value
    ranges = [[float(number(low)), float(number(high))] for low, high in _channel_ranges(levels[0])]
    return {**entry, "bytes": len(data), "sha256": sha256, "range": ranges}


def _channel_ranges(values: Real) -> list[tuple[float, float]]:
    """Return the least and the greatest value of each channel."""
    rows, channels = values.shape[0], values.shape[-1]
    lines = values.reshape(rows, -1)  # along rows first, where numbers lie side by side
    low = lines.min(axis=0).reshape(-1, channels).min(axis=0)
    high = lines.max(axis=0).reshape(-1, channels).max(axis=0)
    return list(zip(low.tolist(), high.tolist(), strict=True))


def _range_of(levels: list[Real]) -> list[float]:
    """Return the least and the greatest value of a map, all channels and levels."""
    return [
        min(float(level.min()) for level in levels),
        max(float(level.max()) for level in levels),
    ]
