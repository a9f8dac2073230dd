"""
Parameters and keys of the live page, in one table.

The server checks every message against `PARAMETERS` and serves the table as `/parameters.json`; the
static page embeds it. So a control, its key, its range and the check of its value come from one
row. Local parameters (camera, light, view) are never sent to the server.
"""

import math
import numbers
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from fftocean import limits
from fftocean.errors import ParameterError
from fftocean.limits import Count, Quantity

MODELS = ("fft", "pms", "cwr", "slides", "steepness")
"""The sea by FFT, and the classic models of few waves."""

VIEWS = (
    "sea",
    "height",
    "slopes",
    "normals",
    "jacobian",
    "foam",
    "roughness",
    "tiles",
    "wireframe",
)
"""The water as it looks, and false colours."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """One control of the page."""

    name: str
    label: str
    default: Any
    group: str
    help: str = ""
    quantity: Quantity | None = None  # unit, and the range of the library
    low: float | None = None  # of the control; None for the quantity's
    high: float | None = None
    step: float = 0.0  # of a key and a slider; of a logarithmic one, the factor
    key_down: str | None = None
    key_up: str | None = None
    choices: tuple[str, ...] = ()  # for words
    logarithmic: bool = False
    wraps: bool = False  # the upper end is followed by the lower
    infinite: str | None = None  # word for an infinite value, which messages write as null
    local: bool = False  # never sent

    @property
    def kind(self) -> str:
        """Kind of its value: "number", "choice" or "switch"."""
        if self.quantity is not None:
            return "number"
        return "choice" if self.choices else "switch"

    @property
    def range(self) -> Quantity | None:
        """Unit and permitted values of the control; None for words and switches."""
        if self.quantity is None:
            return None
        low = self.quantity.low if self.low is None else self.low
        high = self.quantity.high if self.high is None else self.high
        return type(self.quantity)(self.quantity.unit, low, high)

    @property
    def rule(self) -> str:
        """Permitted values, in words."""
        if (allowed := self.range) is None:
            return f"one of {', '.join(self.choices)}" if self.choices else "true or false"
        noun = "a whole number" if isinstance(allowed, Count) else "a number"
        end = f", or null for {self.infinite}" if self.infinite else ""
        return f"{noun} {allowed.rule}{end}"

    def check(self, value: Any) -> Any:
        """
        Return a value of the parameter, in its final type; null is infinity where that is allowed.

        Raises:
            ParameterError: the value is not permitted; the message names parameter, rule and value.
        """
        allowed = self.range
        if allowed is None:
            good = isinstance(value, str) and value in self.choices
            if not (good if self.choices else isinstance(value, bool)):
                raise ParameterError(f"{self.name} must be {self.rule}, got {value!r:.60}")
            return value
        if value is None and self.infinite:
            return math.inf
        long = isinstance(value, int) and value.bit_length() > 64  # hundreds of digits in a message
        if long or not isinstance(value, numbers.Real) or isinstance(value, bool):
            raise ParameterError(
                f"{self.name} must be {self.rule}, got {value!r:.60} ({type(value).__name__})"
            )
        return allowed.check(self.name, value)

    def plain(self, value: Any) -> Any:
        """Return a value as JSON can hold it: an infinite one as null."""
        return None if isinstance(value, float) and math.isinf(value) else value

    def as_row(self) -> dict[str, Any]:
        """Return the row of the table as JSON."""
        row: dict[str, Any] = {
            "name": self.name,
            "label": self.label,
            "kind": self.kind,
            "group": self.group,
            "help": self.help,
            "default": self.plain(self.default),
        }
        if (allowed := self.range) is not None:
            row |= {
                "unit": allowed.unit,
                "low": allowed.low,
                "high": allowed.high,
                "step": self.step,
                "whole": isinstance(allowed, Count),
            }
        if self.choices:
            row["choices"] = list(self.choices)
        for name in ("key_down", "key_up", "infinite"):
            if (value := getattr(self, name)) is not None:
                row[name] = value
        for name in ("logarithmic", "wraps", "local"):
            if getattr(self, name):
                row[name] = True
        return row


@dataclass(frozen=True, slots=True)
class Action:
    """One key that does something else than to change a parameter."""

    name: str
    key: str
    label: str
    held: bool = False  # acts as long as the key is down

    def as_row(self) -> dict[str, Any]:
        """Return the action as JSON."""
        return {"name": self.name, "key": self.key, "label": self.label, "held": self.held}


LIGHT_ANGLE = Quantity("degrees", -360.0, 360.0)
FACTOR = Quantity("", 0.0, 1e6)
CHLOROPHYLL = Quantity("mg/m^3", 0.0, 1e3)
TILES = Count("", 1, 8)

_WIND = "Local wind sea"
_SWELL = "Swell"
_WATER = "Water"
_TILES = "Tiles and chance"
_LIGHT = "Light"
_CAMERA = "View"
_FEW = "Few-wave lighting"

SENT = (
    Parameter(
        name="wind_speed",
        label="wind speed",
        quantity=limits.WIND_SPEED,
        low=0.0,
        high=40.0,
        step=0.5,
        default=11.0,
        key_down="o",
        key_up="p",
        group=_WIND,
        help="local wind 10 m above the water; 0 is no wind sea",
    ),
    Parameter(
        name="wind_direction",
        label="wind direction",
        quantity=limits.DIRECTION,
        low=0.0,
        high=360.0,
        step=5.0,
        default=30.0,
        key_down="u",
        key_up="i",
        wraps=True,
        group=_WIND,
        help="direction toward which the local wind blows, counter-clockwise from east",
    ),
    Parameter(
        name="fetch",
        label="fetch",
        quantity=limits.FETCH,
        low=100.0,
        high=5e6,
        step=1.2,
        default=150e3,
        logarithmic=True,
        group=_WIND,
        help="distance over which the local wind blows",
    ),
    Parameter(
        name="swell_speed",
        label="swell wind speed",
        quantity=limits.WIND_SPEED,
        low=0.0,
        high=40.0,
        step=0.5,
        default=12.0,
        key_down="k",
        key_up="l",
        group=_SWELL,
        help="wind of the distant storm whose fully developed sea became the swell; 0 is no swell",
    ),
    Parameter(
        name="swell_direction",
        label="swell direction",
        quantity=limits.DIRECTION,
        low=0.0,
        high=360.0,
        step=5.0,
        default=75.0,
        key_down="h",
        key_up="j",
        wraps=True,
        group=_SWELL,
        help="direction toward which the swell runs, counter-clockwise from east",
    ),
    Parameter(
        name="swell_share",
        label="height left of the swell",
        quantity=limits.FRACTION,
        low=0.02,
        high=1.0,
        step=0.01,
        default=0.3,
        group=_SWELL,
        help="height of the swell here, as a share of its height in the storm",
    ),
    Parameter(
        name="choppiness",
        label="choppiness",
        quantity=limits.CHOPPINESS,
        low=0.0,
        high=2.0,
        step=0.05,
        default=1.0,
        key_down=",",
        key_up=".",
        group=_WATER,
        help="factor on the horizontal displacement; 1 is wave theory",
    ),
    Parameter(
        name="depth",
        label="depth",
        quantity=limits.DEPTH,
        low=1.0,
        high=1000.0,
        step=1.2,
        default=math.inf,
        logarithmic=True,
        infinite="deep water",
        group=_WATER,
        help="still-water depth",
    ),
    Parameter(
        name="loop",
        label="loop",
        quantity=limits.LOOP,
        low=8.0,
        high=600.0,
        step=1.2,
        default=64.0,
        logarithmic=True,
        group=_TILES,
        help="period after which the water repeats",
    ),
    Parameter(
        name="seed",
        label="random seed",
        quantity=limits.SEED,
        low=0,
        high=999_999,
        step=1,
        default=7,
        key_up="r",
        wraps=True,
        group=_TILES,
        help="another seed is another draw of the same sea",
    ),
    Parameter(
        name="tiles",
        label="tiles",
        quantity=TILES,
        low=1,
        high=4,
        step=1,
        default=3,
        key_up="t",
        wraps=True,
        group=_TILES,
        help="tiles that add up to the sea: fewer leave out its shortest waves",
    ),
    Parameter(
        name="model",
        label="model",
        choices=MODELS,
        default="fft",
        key_up="g",
        wraps=True,
        group=_FEW,
        help="the sea by FFT alone, or beside a sum of few waves of the same spectrum",
    ),
)

LOCAL = (
    Parameter(
        name="time_scale",
        label="time scale",
        quantity=FACTOR,
        low=0.0,
        high=4.0,
        step=0.25,
        default=1.0,
        key_down="[",
        key_up="]",
        local=True,
        group=_CAMERA,
        help="speed of the clock",
    ),
    Parameter(
        name="view",
        label="view",
        choices=VIEWS,
        default="sea",
        key_up="v",
        wraps=True,
        local=True,
        group=_CAMERA,
        help="the water as it looks, or a field in false colours",
    ),
    Parameter(
        name="camera_height",
        label="camera height",
        quantity=limits.SIZE,
        low=1.0,
        high=2000.0,
        step=1.2,
        default=12.0,
        logarithmic=True,
        local=True,
        group=_CAMERA,
        help="height of the eye above still water",
    ),
    Parameter(
        name="field_of_view",
        label="field of view",
        quantity=LIGHT_ANGLE,
        low=15.0,
        high=100.0,
        step=5.0,
        default=50.0,
        local=True,
        group=_CAMERA,
        help="angle between the upper and the lower edge of the picture",
    ),
    Parameter(
        name="buoy",
        label="2 m buoy",
        default=False,
        local=True,
        group=_CAMERA,
        help="a buoy of 2 m on the water, to show the scale",
    ),
    Parameter(
        name="blend_frames",
        label="blend frames",
        default=False,
        local=True,
        group=_CAMERA,
        help="blend linearly between two frames of a bake: smoother, but short waves lose height",
    ),
    Parameter(
        name="sun_elevation",
        label="sun elevation",
        quantity=LIGHT_ANGLE,
        low=-2.0,
        high=90.0,
        step=1.0,
        default=24.0,
        local=True,
        group=_LIGHT,
        help="angle of the sun above the horizon",
    ),
    Parameter(
        name="sun_azimuth",
        label="sun direction",
        quantity=LIGHT_ANGLE,
        low=0.0,
        high=360.0,
        step=5.0,
        default=130.0,
        wraps=True,
        local=True,
        group=_LIGHT,
        help="direction in which the sun stands, counter-clockwise from east",
    ),
    Parameter(
        name="chlorophyll",
        label="chlorophyll",
        quantity=CHLOROPHYLL,
        low=0.03,
        high=10.0,
        step=1.2,
        default=0.3,
        logarithmic=True,
        local=True,
        group=_LIGHT,
        help="colour of the water: 0.03 is clear blue ocean, 10 a green coast",
    ),
    Parameter(
        name="foam",
        label="foam",
        quantity=FACTOR,
        low=0.0,
        high=4.0,
        step=0.1,
        default=1.0,
        local=True,
        group=_LIGHT,
        help="factor on the foam that breaking crests leave; 1 is that of the wind",
    ),
    Parameter(
        name="haze",
        label="haze",
        quantity=FACTOR,
        low=0.0,
        high=4.0,
        step=0.1,
        default=1.0,
        local=True,
        group=_LIGHT,
        help="factor on the haze of the air",
    ),
    Parameter(
        name="exposure",
        label="exposure",
        quantity=Quantity("stops", -16.0, 16.0),
        low=-4.0,
        high=4.0,
        step=0.25,
        default=0.0,
        local=True,
        group=_LIGHT,
        help="brightness of the picture",
    ),
    Parameter(
        name="crest_light",
        label="light through crests",
        default=True,
        local=True,
        group=_LIGHT,
        help="light of a low sun through the crests",
    ),
    *(
        Parameter(
            name=name,
            label=label,
            quantity=FACTOR,
            low=low,
            high=high,
            step=step,
            default=default,
            local=True,
            group=_FEW,
            help=text,
        )
        for name, label, low, high, step, default, text in (
            ("ambient", "ambient", 0.0, 1.0, 0.05, 1.0, "share of the light of the sky"),
            ("diffuse", "diffuse", 0.0, 1.0, 0.05, 0.6, "share of light scattered to all sides"),
            ("specular", "specular", 0.0, 1.0, 0.05, 0.5, "share of light mirrored"),
            ("shininess", "shininess", 1.0, 256.0, 1.0, 180.0, "exponent of the mirrored light"),
            (
                "noise_amplitude",
                "noise amplitude",
                0.0,
                1.0,
                0.05,
                0.3,
                "largest turn of the normal by ripples [rad]",
            ),
            (
                "noise_frequency",
                "noise frequency",
                0.0,
                8.0,
                0.25,
                1.0,
                "ripples a metre",
            ),
        )
    ),
)

PARAMETERS = (*SENT, *LOCAL)
BY_NAME = {p.name: p for p in PARAMETERS}

ACTIONS = (
    Action("pause", " ", "pause or go on"),
    Action("copy_job", "c", "copy the sea as a job file"),
    Action("copy_command", "b", "copy the command that bakes this sea"),
    Action("screenshot", "x", "save a screenshot"),
    Action("help", "?", "show or hide the keys"),
    Action("forward", "w", "move forward", held=True),
    Action("back", "s", "move back", held=True),
    Action("left", "a", "move left", held=True),
    Action("right", "d", "move right", held=True),
    Action("down", "q", "move down", held=True),
    Action("up", "e", "move up", held=True),
)


def table(presets: Sequence[dict[str, Any]] = ()) -> dict[str, Any]:
    """Return parameters, actions and presets as JSON."""
    return {
        "parameters": [p.as_row() for p in PARAMETERS],
        "actions": [a.as_row() for a in ACTIONS],
        "presets": list(presets),
    }
