"""
Keys of a job: name, permitted values, default and help text of each.

The TOML reader, the command line's flags, the manifest's units and the documentation all use this
table.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from fftocean import limits
from fftocean.errors import JobError, ParameterError, suggestion
from fftocean.limits import Count, Quantity

MAPS = (
    "height",
    "displacement",
    "normal",
    "derivative",
    "stretch",
    "jacobian",
    "foam",
    "velocity",
    "surface_velocity",
    "slope_covariance",
)
FORMATS = ("exr", "exr-float", "exr-atlas", "png16", "r16", "npz", "bin", "ktx2", "zarr")
ENGINES = (
    "canonical",
    "blender",
    "unity",
    "unreal",
    "godot",
    "bevy",
    "gltf",
    "three",
    "three-exr",
    "babylon",
    "houdini",
)
BACKENDS = ("auto", "mkl", "pyfftw", "scipy", "gpu", "gpu-or-cpu")
GROWTHS = ("jonswap", "kahma-calkoen", "young-verhagen")
PICTURES = ("sheet", "animation", "tiling", "spectrum")
# repeated here so that the command line's help need not import the modules that define them; those
# compare at import, or a test does


@dataclass(frozen=True, slots=True)
class Parameter:
    """One key of a job file."""

    key: str
    default: Any
    help: str
    quantity: Quantity | None = None  # for numbers
    choices: tuple[str, ...] = ()  # for words; beside a quantity, words in place of a number
    many: bool = False  # a list of choices
    none: bool = False  # which may be empty
    switch: bool = False  # true or false
    pair: bool = False  # one number or two, (x, y)
    flag: str | None = None  # the command line's short way to it

    @property
    def unit(self) -> str:
        """SI unit; "" for pure numbers and words."""
        return self.quantity.unit if self.quantity else ""

    @property
    def rule(self) -> str:
        """Permitted values, in words."""
        if self.switch:
            return "true or false"
        if self.quantity is None:
            return f"{'some' if self.many else 'one'} of {', '.join(self.choices)}"
        whole = "a whole number " if isinstance(self.quantity, Count) else ""
        words = "".join(f", or {word!r}" for word in self.choices)
        return whole + self.quantity.rule + (", or two such, [x, y]" if self.pair else "") + words

    def check(self, value: Any) -> Any:
        """
        Return a value of the key, in its final type.

        Raises:
            JobError: the value is not permitted; the message names key, rule and value.
        """
        try:
            if self.pair and isinstance(value, (list, tuple)):
                if len(value) != 2:
                    raise ParameterError(
                        f"{self.key} must be one value or two, [x, y], got {value!r:.80}"
                    )
                return tuple(self._check_one(v) for v in value)
            if self.many:
                if (
                    isinstance(value, str)
                    or not isinstance(value, (list, tuple))
                    or not (value or self.none)
                ):
                    raise ParameterError(
                        f"{self.key} must be a list of {self.rule}, got {value!r:.80}"
                    )
                return tuple(dict.fromkeys(self._check_one(v) for v in value))
            return self._check_one(value)
        except ParameterError as error:
            raise JobError(str(error)) from None

    def _check_one(self, value: Any) -> Any:
        if self.quantity is not None and not (self.choices and isinstance(value, str)):
            return self.quantity.check(self.key, value)
        if self.switch:
            if not isinstance(value, bool):
                raise ParameterError(f"{self.key} must be {self.rule}, got {value!r:.80}")
            return value
        word = spelled(value, self.choices) if isinstance(value, str) else None
        if word is None:
            near = suggestion(value, self.choices)
            raise ParameterError(f"{self.key} must be {self.rule}, got {value!r:.80}{near}")
        return word


def spelled(word: str, names: Iterable[str]) -> str | None:
    """Return the name that equals a word apart from case; None if there is none."""
    return next((name for name in names if name.casefold() == word.strip().casefold()), None)


WIND = (
    Parameter(
        "sea.wind.speed", 7.0, "wind 10 m above the water; 0 is a flat sea", limits.WIND_SPEED
    ),
    Parameter("sea.wind.fetch", 35e3, "distance over which the wind blows", limits.FETCH),
    Parameter(
        "sea.wind.direction",
        0.0,
        "direction toward which the wind blows, counter-clockwise from +x (east); the default job "
        "has 25",
        limits.DIRECTION,
    ),
    Parameter(
        "sea.wind.gamma",
        3.3,
        "JONSWAP peak enhancement while the sea grows",
        limits.PEAK_ENHANCEMENT,
    ),
    Parameter(
        "sea.wind.growth",
        GROWTHS[0],
        "law of growth with fetch in deep water; Young and Verhagen's holds in finite depth",
        choices=GROWTHS,
    ),
    Parameter("sea.wind.blend", 0.5, "spreading: 0 is Donelan-Banner, 1 is cos^2", limits.FRACTION),
)
WATER = (
    Parameter("sea.depth", math.inf, "still-water depth; inf is deep water", limits.DEPTH),
    Parameter(
        "sea.surface_tension",
        0.0,
        "surface tension of the water; 0.074 adds capillary ripples",
        limits.SURFACE_TENSION,
    ),
)
TILE = (
    Parameter("ocean.n", 256, "samples a side", limits.SAMPLES, pair=True, flag="n"),
    Parameter("ocean.size", 100.0, "width of the tile", limits.SIZE, pair=True, flag="size"),
    Parameter("ocean.seed", 1, "random seed", limits.SEED, flag="seed"),
    Parameter("ocean.loop", 16.0, "period after which the water repeats", limits.LOOP, flag="loop"),
    Parameter(
        "ocean.choppiness",
        1.0,
        "factor on horizontal displacement; 1 is wave theory",
        limits.CHOPPINESS,
        flag="choppiness",
    ),
    Parameter("ocean.band_low", 0.0, "lowest wavenumber that the tile holds", limits.BAND_START),
    Parameter(
        "ocean.band_high", math.inf, "highest wavenumber that the tile holds", limits.BAND_EDGE
    ),
    Parameter(
        "ocean.amplitudes",
        "gaussian",
        "gaussian, as in nature, or fixed: random phases alone",
        choices=("gaussian", "fixed"),
    ),
    Parameter(
        "ocean.order",
        1,
        "1 for linear waves; 2 adds second-order waves, which make crests higher and troughs "
        "flatter",
        limits.ORDER,
        flag="order",
    ),
    Parameter(
        "ocean.bound",
        1000,
        "number of waves whose pairs have second-order waves, the strongest",
        limits.BOUND_WAVES,
    ),
    Parameter(
        "ocean.backend",
        "auto",
        "FFT library, auto for the fastest that is installed; or gpu, a graphics processor; or "
        "gpu-or-cpu, auto where that cannot compute",
        choices=BACKENDS,
        flag="backend",
    ),
)
OUTPUT = (
    Parameter(
        "bake.frames",
        240,
        "frames in the loop; `fftocean bake` also takes a part of it, START:STOP:STEP",
        limits.FRAMES,
        flag="frames",
    ),
    Parameter("bake.maps", MAPS[:3], "maps to write", choices=MAPS, many=True, flag="maps"),
    Parameter("bake.format", "exr", "file format", choices=FORMATS, flag="format"),
    Parameter(
        "bake.engine",
        "canonical",
        "target engine (sets axes, row order, unit, normal-map green)",
        choices=ENGINES,
        flag="engine",
    ),
    Parameter(
        "bake.lookup",
        "lagrangian",
        "index maps by rest position (lagrangian) or by world position (eulerian)",
        choices=("lagrangian", "eulerian"),
        flag="lookup",
    ),
    Parameter(
        "bake.normals",
        "engine",
        "values of normal maps: signed (-1 to 1), packed (0 to 1), "
        "or engine: as the engine's stock materials read",
        choices=("engine", "signed", "packed"),
        flag="normals",
    ),
    Parameter(
        "bake.mips", False, "mip levels of each map; with the format ktx2", switch=True, flag="mips"
    ),
    Parameter(
        "bake.engine_files",
        True,
        "files that play the bake in its engine, beside the maps",
        switch=True,
        flag="engine-files",
    ),
    Parameter(
        "bake.pictures",
        ("sheet", "animation"),
        "preview images, beside the maps",
        choices=PICTURES,
        many=True,
        none=True,
    ),
)
FOAM = (
    Parameter("bake.foam.tau", 3.5, "time in which foam decays to 1/e", limits.FOAM_TAU),
    Parameter(
        "bake.foam.threshold",
        "wind",
        "smallest eigenvalue of the deformation gradient below which water foams: 1 is at rest, "
        "0 folds; 'wind' is that which covers what whitecaps do",
        limits.FOAM_THRESHOLD,
        choices=("wind",),
    ),
    Parameter(
        "bake.foam.strength",
        60.0,
        "foam per second and unit of that eigenvalue below the threshold",
        limits.FOAM_STRENGTH,
    ),
)
PARAMETERS = (*WIND, *WATER, *TILE, *OUTPUT, *FOAM)
BY_KEY = {p.key: p for p in PARAMETERS}
