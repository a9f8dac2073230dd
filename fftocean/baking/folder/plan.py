"""
What a bake asks of those who work for it: which water, which frames, into which folder, and what is
known beforehand.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from fftocean.errors import JobError
from fftocean.files import as_json, digest
from fftocean.job.job import Job

Entry = dict[str, Any]
"""
One thing that is finished, as the journal has it: {"foam": ...}, {"range": ...} or {"row": ...}.
"""

Kind = Literal["foam", "range", "frame"]


@dataclass(frozen=True, slots=True)
class Order:
    """One bake, as plain values that can be sent to another machine."""

    job: Job  # as it was ordered
    downsample: int  # how many times fewer samples a side are baked
    header: Mapping[str, Any]  # what makes the bytes what they are; see `claim.header_of`
    frames: tuple[int, ...]  # of the loop's `job.frames`
    folder: str
    token: str  # of the hold on it
    ranges: Mapping[str, tuple[float, float]] = field(
        default_factory=dict
    )  # of the maps that are stored scaled, over the whole loop

    @property
    def claim(self) -> str:
        """The SHA-256 of the header."""
        return claim_of(self.header)

    @property
    def step(self) -> int:
        """How many frames of the loop it is from one that is baked to the next."""
        return self.frames[1] - self.frames[0] if len(self.frames) > 1 else 1

    def place(self, frame: int) -> int:
        """Where in the sequence a frame of the loop stands."""
        return self.frames.index(frame)


@dataclass(frozen=True, slots=True)
class Task:
    """Some frames, and what is to be found out about them or made of them."""

    kind: Kind
    frames: tuple[int, ...]


def claim_of(header: Mapping[str, Any]) -> str:
    """The name under which a header is known."""
    return digest(as_json(header))


def tasks_of(kind: Kind, frames: Sequence[int], size: int) -> list[Task]:
    """
    Share frames out among tasks: those between two multiples of `size` go together.

    So a task never reaches across a span of foam, if `size` divides its length.
    """
    shares: dict[int, list[int]] = {}
    for frame in frames:
        shares.setdefault(frame // size, []).append(frame)
    return [Task(kind, tuple(share)) for share in shares.values()]


def frames_of(text: str | None, count: int) -> tuple[int, ...]:
    """
    Parse `start:stop:step` as Python slices the loop's `count` frames; None is all of them.

    Raises:
        JobError: it is no slice, goes backward, or leaves no frame.
    """
    if text is None:
        return tuple(range(count))
    try:
        parts = [int(part) if part.strip() else None for part in text.split(":")]
        if len(parts) not in (2, 3):
            raise ValueError
        chosen = tuple(range(count))[slice(*parts)]
    except (ValueError, OverflowError):
        raise JobError(
            f"frames must be a count, or start:stop or start:stop:step such as 0:64:2, got {text!r:.60}"
        ) from None
    if not chosen or chosen[0] > chosen[-1]:
        raise JobError(
            f"frames must choose some of the loop's {count} in rising order, got {text!r:.60}"
        )
    return chosen
