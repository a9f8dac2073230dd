"""The serialisable plan of a bake, and the tasks that it is divided into."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from fftocean.errors import JobError
from fftocean.files import as_json, digest
from fftocean.job.job import Job

TaskKind = Literal["foam", "range", "frame"]


@dataclass(frozen=True, slots=True)
class Plan:
    """One bake as plain values, which can be sent to another machine."""

    job: Job  # as the user gave it, before downsampling
    downsample: int  # factor by which the samples a side are fewer
    header: Mapping[str, Any]  # everything that determines the bytes; see `identity.header_of`
    frames: range  # of the loop's `job.frames`
    folder: str
    token: str  # of the lock on the folder
    ranges: Mapping[str, tuple[float, float]] = field(
        default_factory=dict
    )  # of the maps that are stored scaled, over the whole loop

    @property
    def identity(self) -> str:
        """SHA-256 of the header."""
        return identity_of(self.header)

    @property
    def step(self) -> int:
        """Number of frames of the loop from one that is baked to the next."""
        return self.frames[1] - self.frames[0] if len(self.frames) > 1 else 1

    def place(self, frame: int) -> int:
        """Return the position of a frame of the loop in the sequence that is baked."""
        return (frame - self.frames[0]) // self.step


@dataclass(frozen=True, slots=True)
class Task:
    """Some frames, to be surveyed or written."""

    kind: TaskKind
    frames: Sequence[int]


def identity_of(header: Mapping[str, Any]) -> str:
    """Return the SHA-256 of a header."""
    return digest(as_json(header))


def tasks_of(kind: TaskKind, frames: Sequence[int], size: int) -> list[Task]:
    """
    Divide rising frames into tasks: those between two multiples of `size` go together.

    So a task never reaches across a span of foam, if `size` divides its length.
    """
    ends = [i for i in range(1, len(frames)) if frames[i] // size != frames[i - 1] // size]
    parts = [frames[i:j] for i, j in itertools.pairwise([0, *ends, len(frames)])]
    # a range stays one: it takes no memory, however long it is
    return [Task(kind, part if isinstance(part, range) else tuple(part)) for part in parts if part]


def frames_of(text: str | None, count: int) -> range:
    """
    Parse `start:stop:step` as Python slices the loop's `count` frames; None is all of them.

    Raises:
        JobError: the text is no slice, goes backward, or leaves no frame.
    """
    if text is None:
        return range(count)
    try:
        parts = [int(part) if part.strip() else None for part in text.split(":")]
        if len(parts) not in (2, 3):
            raise ValueError
        chosen = range(count)[slice(*parts)]
    except (ValueError, OverflowError):
        raise JobError(
            "frames must be a count, or start:stop or start:stop:step such as 0:64:2, "
            f"got {text!r:.60}"
        ) from None
    if not chosen or chosen[0] > chosen[-1]:
        raise JobError(
            f"frames must choose some of the loop's {count} in rising order, got {text!r:.60}"
        )
    return chosen
