"""From a frame to the pictures that are written: which field goes into which channel, and in what unit."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from fftocean.arrays import Real
from fftocean.ocean import Frame


@dataclass(frozen=True, slots=True)
class Map:
    """A picture of the sea: the fields it needs, its three channels, and what they mean."""

    needs: tuple[str, ...]
    channels: Callable[[Frame], tuple[Real, Real, Real]]
    meaning: tuple[str, str, str]
    unit: str

    def describe(self) -> dict[str, Any]:
        """For the manifest."""
        return {"channels": dict(zip("RGB", self.meaning, strict=True)), "unit": self.unit}


MAPS: dict[str, Map] = {
    "height": Map(
        ("height",),
        lambda f: (f.height, f.height, f.height),
        ("height", "height", "height"),
        "m",
    ),
    "displacement": Map(
        ("displace_x", "displace_y", "height"),
        lambda f: (f.displace_x * f.choppiness, f.displace_y * f.choppiness, f.height),
        ("x, choppiness applied", "y, choppiness applied", "height"),
        "m",
    ),
    "normal": Map(
        ("normal",),
        lambda f: (f.normal[..., 0], f.normal[..., 1], f.normal[..., 2]),
        ("x", "y", "z of the displaced surface at the undisplaced position, signed"),
        "1",
    ),
    "jacobian": Map(
        ("jacobian",),
        lambda f: (f.jacobian, f.jacobian, f.jacobian),
        ("jacobian", "jacobian", "jacobian"),
        "1",
    ),
}
