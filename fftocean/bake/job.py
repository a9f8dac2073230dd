"""A job: a sea, a tile of it, and what to write. Read from TOML, checked key by key, frozen."""

import json
import math
import tomllib
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any, TypeVar

from fftocean.bake.parameters import BY_KEY, PARAMETERS, WIND, Parameter
from fftocean.errors import JobError, ParameterError
from fftocean.limits import (
    DEPTH,
    DIRECTION,
    FETCH,
    FRACTION,
    PEAK_ENHANCEMENT,
    PERIOD,
    SIGNIFICANT_WAVE_HEIGHT,
    SPREADING_EXPONENT,
    WIND_SPEED,
)
from fftocean.ocean import Ocean
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.physics.spectra import JONSWAP, TMA, FrequencySpectrum, PiersonMoskowitz, TabulatedSpectrum
from fftocean.physics.spreading import Blend, CosinePower, CosineSquared, DonelanBanner, Spreading

Made = TypeVar("Made")
MAX_BYTES = 64 * 1024
MAX_LINE = 2048  # the standard parser takes time quadratic in the length of a dotted key


@dataclass(frozen=True, slots=True)
class Job:
    """
    What to bake. `settings` holds every key of `parameters.PARAMETERS` with its value; `systems` the waves beside the wind sea.

    Make one with `Job.default()`, `Job.read(path)` or `Job.from_toml(text)`; change one with `job.replaced({"ocean.n": 512})`.
    """

    settings: Mapping[str, Any]
    wind: bool  # whether there is a wind sea
    systems: tuple[Mapping[str, Any], ...]  # as in the file
    source: str = "job"

    @classmethod
    def default(cls) -> "Job":
        """The embedded sea: a fresh breeze on a large lake."""
        return cls.from_toml(
            resources.files("fftocean.bake").joinpath("default.toml").read_text(encoding="utf-8"), source="the default sea"
        )

    @classmethod
    def read(cls, path: str | Path) -> "Job":
        """
        Read a job file.

        Raises:
            JobError: it cannot be read, is too large, is not UTF-8 or not TOML, or holds a key or value that it may not.
        """
        path = Path(path)
        if not path.is_file():
            raise JobError(f"{path} must be a TOML file, and is {'a folder or device' if path.exists() else 'not there'}")
        try:
            with path.open("rb") as file:
                data = file.read(MAX_BYTES + 1)
        except OSError as error:
            raise JobError(f"{path} cannot be read: {error.strerror}") from error
        if len(data) > MAX_BYTES:
            raise JobError(f"{path} must have at most {MAX_BYTES} bytes, and has more")
        try:
            return cls.from_toml(data.decode("utf-8"), source=str(path))
        except UnicodeDecodeError as error:
            raise JobError(f"{path} must be UTF-8 text, and is not at byte {error.start}") from None

    @classmethod
    def from_toml(cls, text: str, *, source: str = "job") -> "Job":
        """Parse a job; see `read` for what is refused."""
        if len(text) > MAX_BYTES:
            raise JobError(f"{source} must have at most {MAX_BYTES} bytes, got {len(text)}")
        for number, line in enumerate(text.splitlines(), 1):
            if len(line) > MAX_LINE:
                raise JobError(f"{source}, line {number}: a line must have at most {MAX_LINE} characters, got {len(line)}")
        try:
            tree = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise JobError(f"{source} must be TOML: {error}") from None
        except (RecursionError, ValueError) as error:
            raise JobError(f"{source} must be TOML that is not nested so deeply: {error!s:.80}") from None
        return cls.from_tree(tree, source=source)

    @classmethod
    def from_tree(cls, tree: Mapping[str, Any], *, source: str = "job") -> "Job":
        """Check a parsed job, key by key."""
        given: dict[str, Any] = {}
        systems: tuple[Mapping[str, Any], ...] = ()
        for key, value in _flatten(tree):
            if key == "sea.systems":
                if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
                    raise JobError(f"{source}: sea.systems must be tables, written [[sea.systems]], got {value!r:.60}")
                systems = tuple(value)
            elif key in BY_KEY:
                given[key] = BY_KEY[key].check(value)
            else:
                raise JobError(f"{source}: {_unknown(key, [*BY_KEY, 'sea.systems'])}")
        wind = not systems or any(p.key in given for p in WIND)
        if systems and wind and "sea.wind.speed" not in given:
            raise JobError(f"{source}: sea.wind.speed must be given where other keys of sea.wind are and sea.systems too")
        job = cls({p.key: given.get(p.key, p.default) for p in PARAMETERS}, wind, systems, source)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # said once, when it is used
            job.sea()
        return job

    def replaced(self, changes: Mapping[str, Any]) -> "Job":
        """
        Return the job with some keys changed; a key of sea.wind brings in a wind sea where there is none.

        Raises:
            JobError: an unknown key, or a value that it may not have.
        """
        for key in changes:
            if key not in BY_KEY:
                raise JobError(_unknown(key, BY_KEY))
        settings = {**self.settings, **{key: BY_KEY[key].check(value) for key, value in changes.items()}}
        return Job(settings, self.wind or any(p.key in changes for p in WIND), self.systems, self.source)

    def sea(self) -> Sea:
        """The sea that is ordered."""
        s, depth = self.settings, self.settings["sea.depth"]
        waves = []
        try:
            if self.wind:
                deep = JONSWAP.from_wind(speed=s["sea.wind.speed"], fetch=s["sea.wind.fetch"], gamma=s["sea.wind.gamma"])
                spreading = Blend(DonelanBanner(), CosineSquared(), weight=s["sea.wind.blend"])
                waves.append(WaveSystem(spectrum=TMA(deep, depth), spreading=spreading, direction=s["sea.wind.direction"]))
            waves += [_system(f"sea.systems[{i}]", table, depth) for i, table in enumerate(self.systems)]
            return Sea(*waves, depth=depth, surface_tension=s["sea.surface_tension"])
        except JobError:
            raise
        except ParameterError as error:
            raise JobError(f"{self.source}: sea.wind.{error}") from None

    def ocean(self) -> Ocean:
        """The tile, in float32."""
        s = self.settings
        try:
            return Ocean(
                self.sea(),
                n=s["ocean.n"],
                size=s["ocean.size"],
                seed=s["ocean.seed"],
                loop=s["ocean.loop"],
                choppiness=s["ocean.choppiness"],
                amplitudes=s["ocean.amplitudes"],
            )
        except JobError:
            raise
        except ParameterError as error:
            raise JobError(f"{self.source}: ocean: {error}") from None

    @property
    def frames(self) -> int:
        """Frames in the loop."""
        return int(self.settings["bake.frames"])

    @property
    def maps(self) -> tuple[str, ...]:
        """What to write."""
        return tuple(self.settings["bake.maps"])

    def describe(self) -> dict[str, Any]:
        """The whole job as plain data for a manifest: every key, with `inf` as a word, as JSON has no such number."""
        shown = {p.key: self.settings[p.key] for p in PARAMETERS if self.wind or p not in WIND}
        tree: dict[str, Any] = json.loads(
            json.dumps({**shown, "sea.systems": list(self.systems)}, default=str).replace("Infinity", '"inf"')
        )
        return tree


_SPREADINGS: dict[str, tuple[dict[str, Any], Callable[..., Spreading]]] = {
    "cosine-squared": ({}, CosineSquared),
    "cosine-power": ({"s": SPREADING_EXPONENT}, CosinePower),
    "donelan-banner": ({}, DonelanBanner),
    "blend": ({"weight": FRACTION}, lambda weight=0.5: Blend(DonelanBanner(), CosineSquared(), weight=weight)),
}
_STATE, _WIND = {"hs": SIGNIFICANT_WAVE_HEIGHT, "tp": PERIOD}, {"speed": WIND_SPEED, "fetch": FETCH}
_GAMMA = {"gamma": PEAK_ENHANCEMENT}


def _system(key: str, table: Mapping[str, Any], depth: float) -> WaveSystem:
    """Make one wave system of a [[sea.systems]] table."""
    for name in table:
        if name not in ("spectrum", "spreading", "direction"):
            raise JobError(_unknown(f"{key}.{name}", [f"{key}.{n}" for n in ("spectrum", "spreading", "direction")]))
    if "spectrum" not in table:
        raise JobError(f"{key}.spectrum must be given, such as {{ kind = 'jonswap', hs = 1.5, tp = 14.0 }}")
    try:
        direction = DIRECTION.check(f"{key}.direction", table.get("direction", 0.0))
        spreading = _spreading(f"{key}.spreading", table.get("spreading", {"kind": "blend"}))
        return WaveSystem(spectrum=_spectrum(f"{key}.spectrum", table["spectrum"], depth), spreading=spreading, direction=direction)
    except JobError:
        raise
    except ParameterError as error:
        raise JobError(str(error)) from None


def _spectrum(key: str, table: Any, depth: float) -> FrequencySpectrum:
    """Make a spectrum of an inline table: its `kind`, and either hs and tp, or a wind, or a list of measured densities."""
    kind, values = _kind(key, table, ("jonswap", "tma", "pierson-moskowitz", "tabulated"))
    ways: dict[str, list[tuple[dict[str, Any], Callable[..., FrequencySpectrum]]]] = {
        "jonswap": [({**_STATE, **_GAMMA}, JONSWAP.from_sea_state), ({**_WIND, **_GAMMA}, JONSWAP.from_wind)],
        "tma": [
            ({**_STATE, **_GAMMA}, lambda **v: TMA.from_sea_state(depth=DEPTH.check("sea.depth", depth), **v)),
            ({**_WIND, **_GAMMA}, lambda **v: TMA(JONSWAP.from_wind(**v), depth)),
        ],
        "pierson-moskowitz": [(_STATE, PiersonMoskowitz.from_sea_state), ({"speed": WIND_SPEED}, PiersonMoskowitz.from_wind)],
        "tabulated": [({"frequency": None, "density": None}, TabulatedSpectrum)],
    }
    for rules, make in ways[kind]:
        required = [name for name in rules if name != "gamma"]
        if set(required) <= set(values) <= set(rules):
            return _make(key, make, rules, values)
    accepted = " or ".join("{" + ", ".join(rules) + "}" for rules, _ in ways[kind])
    raise JobError(f"{key} of kind {kind!r} must have the keys {accepted}, got {{{', '.join(map(str, values))}}}")


def _spreading(key: str, table: Any) -> Spreading:
    """Make a spreading of an inline table."""
    kind, values = _kind(key, table, tuple(_SPREADINGS))
    rules, make = _SPREADINGS[kind]
    if not set(values) <= set(rules) or (kind == "cosine-power" and not values):
        raise JobError(f"{key} of kind {kind!r} must have the keys {{{', '.join(rules)}}}, got {{{', '.join(map(str, values))}}}")
    return _make(key, make, rules, values)


def _kind(key: str, table: Any, kinds: tuple[str, ...]) -> tuple[str, dict[str, Any]]:
    """Split an inline table in its kind and the rest."""
    if not isinstance(table, dict) or table.get("kind") not in kinds:
        got = table.get("kind") if isinstance(table, dict) else table
        raise JobError(f"{key} must be a table whose kind is one of {', '.join(kinds)}, got {got!r:.60}")
    return str(table["kind"]), {k: v for k, v in table.items() if k != "kind"}


def _make(key: str, make: Callable[..., Made], rules: Mapping[str, Any], values: Mapping[str, Any]) -> Made:
    """Check each value under its full name, then build."""
    checked = {name: value if rules[name] is None else rules[name].check(f"{key}.{name}", value) for name, value in values.items()}
    try:
        return make(**checked)
    except ParameterError as error:
        raise JobError(f"{key}: {error}") from None


def _flatten(tree: Mapping[str, Any], prefix: str = "") -> Iterable[tuple[str, Any]]:
    """Walk a parsed TOML tree as dotted keys."""
    for name, value in tree.items():
        key = f"{prefix}{name}"
        if isinstance(value, dict) and key not in BY_KEY:
            if not any(known.startswith(key + ".") for known in [*BY_KEY, "sea.systems"]):
                raise JobError(_unknown(key, BY_KEY))
            yield from _flatten(value, key + ".")
        else:
            yield key, value


def _unknown(key: str, known: Iterable[str]) -> str:
    """Say that a key is unknown, and which one may have been meant."""
    import difflib

    close = difflib.get_close_matches(key, list(known), n=1, cutoff=0.5)
    hint = f"; did you mean {close[0]}?" if close else f"; known are {', '.join(known)}"
    return f"unknown key {key!r:.80}{hint}"


def parse_setting(text: str) -> tuple[str, Any]:
    """
    Parse `key=value` from the command line; the value as in TOML, a bare word as a string.

    Raises:
        JobError: there is no `=`.
    """
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        raise JobError(f"a setting must be key=value, such as sea.wind.speed=12, got {text!r:.80}")
    return key.strip(), parse_value(value.strip())


def parse_value(text: str) -> Any:
    """Parse a TOML value; what is none is a string, and `a,b` is a list."""
    if len(text) <= MAX_LINE:
        for attempt in (text, f"[{text}]"):
            try:
                return tomllib.loads(f"v = {attempt}")["v"]
            except (tomllib.TOMLDecodeError, RecursionError, ValueError):
                continue
    return [part.strip() for part in text.split(",")] if "," in text else text


def finite_or_word(value: float) -> float | str:
    """A number that JSON can hold: inf as a word."""
    return value if math.isfinite(value) else str(value)


__all__ = ["Job", "Parameter", "finite_or_word", "parse_setting", "parse_value"]
