"""Job: a sea, a tile of it, and maps to write. Read from TOML, checked key by key, immutable."""

import json
import math
import tomllib
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fftocean.arrays import shortened
from fftocean.cascade import Cascade, Tile
from fftocean.constraints import constrained
from fftocean.errors import JobError, ParameterError, ReaderError, described
from fftocean.files import digest_of, path_of
from fftocean.fixed_values import Crest, Fix
from fftocean.job import fixed_tables
from fftocean.job.parameters import BY_KEY, FOAM, PARAMETERS, WIND, Parameter
from fftocean.job.wave_systems import measurement, systems_of, unknown_key, winds_of
from fftocean.ocean import Ocean
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.physics.spectra import TMA
from fftocean.physics.spreading import Blend, CosineSquared, DonelanBanner

if TYPE_CHECKING:
    from fftocean.cascade import Cascade
    from fftocean.foam import Foam
    from fftocean.readers import Realised

_KNOWN = (*BY_KEY, "sea.systems", fixed_tables.CREST, fixed_tables.FIX)
MAX_BYTES = 64 * 1024
MAX_LINE = 2048  # the standard parser takes time quadratic in the length of a dotted key
FIXED_THRESHOLD = 0.72  # of foam on a sea that names no wind; that of `Foam`
MAX_SYSTEMS = 64  # the finest partitions of measured seas have 20


@dataclass(frozen=True, slots=True)
class Job:
    """
    Settings of a bake: sea, tile, maps and files.

    `settings` holds every key of `parameters.PARAMETERS` with its value; `systems` the wave systems
    besides the wind sea; `crests` and `fixes` what the water is made to have at places and times.

    Make one with `Job.default()`, `Job.read(path)` or `Job.from_toml(text)`; change one with
    `job.replaced({"ocean.n": 512})`.

    Args:
        settings: every key of `parameters.PARAMETERS` with its value, in SI units.
        wind: True if there is a wind sea.
        systems: wave systems besides the wind sea, as in the file.
        source: name of the job in messages: its file.
        crests: crests that the water is made to have, `[[ocean.crest]]`.
        fixes: values that the water is made to have, `[[ocean.fix]]`.
    """

    settings: Mapping[str, Any]
    wind: bool
    systems: tuple[Mapping[str, Any], ...]
    source: str = "job"
    crests: tuple[Crest, ...] = ()
    fixes: tuple[Fix, ...] = ()

    def __repr__(self) -> str:
        s, waves = (
            self.settings,
            [
                *(["a wind sea"] if self.wind else []),
                *([f"{len(self.systems)} systems"] if self.systems else []),
            ],
        )
        return shortened(
            f"Job({self.source!r}: {' and '.join(waves)}, n={s['ocean.n']}, "
            f"size={s['ocean.size']}, {self.frames} frames of "
            f"{', '.join(self.maps)} as {self.format} for {self.engine})"
        )

    @classmethod
    def default(cls) -> "Job":
        """Return the embedded sea: a moderate breeze on a large lake."""
        return cls.from_toml(
            resources.files("fftocean.job").joinpath("default.toml").read_text(encoding="utf-8"),
            source="the default sea",
        )

    @classmethod
    def read(cls, path: str | Path) -> "Job":
        """
        Read a job file.

        Raises:
            JobError: the file cannot be read, is too large, is not UTF-8 or not TOML, or has an
                unknown key or a value out of range.
        """
        path = path_of("path", path)
        try:
            if not path.is_file():
                raise JobError(
                    f"{path} must be a TOML file, and "
                    f"{'is a folder or device' if path.exists() else 'does not exist'}"
                )
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
    def from_toml(cls, text: str, *, source: str = "job", at_sea: bool = True) -> "Job":
        """
        Parse a job; errors are those of `read`. A byte-order mark at the start is skipped.

        With `at_sea` its sea is set up and checked too, for which its measured files must exist.

        Raises:
            JobError: text that is not TOML, an unknown key, or a value that is not permitted; the
                message names key, rule and value.
        """
        if not isinstance(text, str):
            raise JobError(f"a job must be TOML text, got {described(text)}")
        text = text.removeprefix("\ufeff")
        if len(text) > MAX_BYTES:
            raise JobError(f"{source} must have at most {MAX_BYTES} bytes, got {len(text)}")
        for number, line in enumerate(
            text.split("\n"), 1
        ):  # as TOML has them: `splitlines` would break a key at U+2028
            if len(line) > MAX_LINE:
                raise JobError(
                    f"{source}, line {number}: a line must have at most {MAX_LINE} "
                    f"characters, got {len(line)}"
                )
        try:
            tree = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise JobError(f"{source} must be TOML: {error}") from None
        except (RecursionError, ValueError) as error:
            raise JobError(
                f"{source} must be TOML that is not nested so deeply: {error!s:.80}"
            ) from None
        return cls.from_tree(tree, source=source, at_sea=at_sea)

    @classmethod
    def from_tree(
        cls, tree: Mapping[str, Any], *, source: str = "job", at_sea: bool = True
    ) -> "Job":
        """
        Return the job of a parsed TOML tree, checked key by key.

        With `at_sea` its sea is set up and checked too, for which its measured files must exist.

        Raises:
            JobError: an unknown key, or a value that is not permitted; the message names key, rule
                and value.
        """
        given: dict[str, Any] = {}
        systems: tuple[Mapping[str, Any], ...] = ()
        crests: tuple[Crest, ...] = ()
        fixes: tuple[Fix, ...] = ()
        for key, value in _flatten(tree):
            if key == fixed_tables.CREST:
                crests = fixed_tables.crests_of(value, source)
            elif key == fixed_tables.FIX:
                fixes = fixed_tables.fixes_of(value, source)
            elif key == "sea.systems":
                if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
                    raise JobError(
                        f"{source}: sea.systems must be tables, written [[sea.systems]], "
                        f"got {value!r:.60}"
                    )
                if len(value) > MAX_SYSTEMS:
                    raise JobError(
                        f"{source}: sea.systems must be at most {MAX_SYSTEMS} tables, got "
                        f"{len(value)}"
                    )
                systems = tuple(value)
            elif key in BY_KEY:
                given[key] = BY_KEY[key].check(value)
            else:
                raise JobError(f"{source}: {unknown_key(key, _KNOWN)}")
        wind = not systems or _brings_wind(given, source)
        settings = {p.key: given.get(p.key, p.default) for p in PARAMETERS}
        job = cls(settings, wind, systems, source, crests, fixes)
        if at_sea:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # given once, when it is used
                measured = job.measurements()
                if "sea.depth" not in given:
                    job = job._at_measured_depth(measured)
                job.sea(measured)
        return job

    def measurements(self) -> "dict[str, Realised]":
        """
        Return the measured spectra of sea.systems as they are realised, in SI units, by the full
        names of their tables.

        Raises:
            JobError, ReaderError: as `systems.measurement`.
        """
        folder = (
            Path(self.source).parent
        )  # of the job file, where measured files are looked for; here, for a job without one
        tables = {f"sea.systems[{i}]": table for i, table in enumerate(self.systems)}
        return {
            key: measurement(key, table, folder)
            for key, table in tables.items()
            if "measured" in table and "spectrum" not in table
        }

    def _at_measured_depth(self, measured: "Mapping[str, Realised]") -> "Job":
        """
        Return the job with the depth of its measured files, where it names no sea.depth itself.
        """
        depths = {key: m.depth_source for key, m in measured.items() if m.depth_source is not None}
        if not depths:
            return self
        first, *others = depths.items()
        for key, depth in others:
            if not math.isclose(depth, first[1], rel_tol=1e-3):
                raise JobError(
                    f"{self.source}: sea.depth must be given where measured files differ "
                    f"in it, got {first[1]:g} m of {first[0]} "
                    f"and {depth:g} m of {key}"
                )
        return self.replaced({"sea.depth": first[1]})

    def measured_notes(self) -> dict[str, list[str]]:
        """
        Return notes on masked, repaired or assumed values of the measured systems, by the full
        names of their tables.
        """
        notes = {}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the notes contain it
            measured = self.measurements()
        for key, made in measured.items():
            depth, own = self.settings["sea.depth"], made.depth_source
            if own is None:
                note = f"the file has no water depth; sea.depth is {depth:g} m"
            elif math.isclose(own, depth, rel_tol=1e-9):
                note = f"sea.depth is the file's own, {own:g} m"
            else:
                note = f"sea.depth is {depth:g} m; the file's own is {own:g} m"
            notes[key] = [note, *made.notes]
        return notes

    def replaced(self, changes: Mapping[str, Any]) -> "Job":
        """
        Return the job with some keys changed; sea.wind.speed adds a wind sea where there is none.

        Raises:
            JobError: an unknown key, a value out of range, or another key of sea.wind where there
                is no wind sea.
        """
        if not isinstance(changes, Mapping):
            raise JobError(
                f"changes must be keys with values, such as {{'ocean.n': 512}}, got "
                f"{described(changes)}"
            )
        for key in changes:
            if key in ("sea.systems", fixed_tables.CREST, fixed_tables.FIX):
                raise JobError(f"{key} must be given in a job file, as [[{key}]]")
            if key not in BY_KEY:
                raise JobError(unknown_key(key, BY_KEY))
        settings = {
            **self.settings,
            **{key: BY_KEY[key].check(value) for key, value in changes.items()},
        }
        wind = self.wind or _brings_wind(changes, self.source)
        return replace(self, settings=settings, wind=wind)

    def sea(self, measured: "Mapping[str, Realised] | None" = None) -> Sea:
        """
        Return the specified sea; `measured`, if given, are the spectra that `measurements` returns.

        Raises:
            JobError: wave systems that make no sea: none, or of different depths.
            ReaderError: a measured file that cannot be read.
        """
        s, depth = self.settings, self.settings["sea.depth"]
        waves: list[WaveSystem] = []
        try:
            if self.wind:
                spectrum = TMA.from_wind(
                    speed=s["sea.wind.speed"],
                    fetch=s["sea.wind.fetch"],
                    depth=depth,
                    gamma=s["sea.wind.gamma"],
                    growth=s["sea.wind.growth"],
                )
                spreading = Blend(DonelanBanner(), CosineSquared(), weight=s["sea.wind.blend"])
                waves.append(
                    WaveSystem(
                        spectrum=spectrum,
                        spreading=spreading,
                        direction=s["sea.wind.direction"],
                    )
                )
            folder = (
                Path(self.source).parent
            )  # of the job file, where measured files are looked for; here, for a job without one
            for i, table in enumerate(self.systems):
                key = f"sea.systems[{i}]"
                done = (measured or {}).get(key)
                waves += systems_of(
                    key,
                    table,
                    depth=depth,
                    tension=s["sea.surface_tension"],
                    folder=folder,
                    measured=done,
                )
            return Sea(*waves, depth=depth, surface_tension=s["sea.surface_tension"])
        except (JobError, ReaderError):
            raise
        except ParameterError as error:
            raise JobError(f"{self.source}: sea.wind.{error}") from None

    def ocean(self, *, dtype: str = "float32", backend: str | None = None) -> Ocean:
        """
        Return the ocean of the tile, with the crests and values that the job fixes.

        Args:
            dtype: of the fields; float64 is computed on the CPU, whatever the job's backend.
            backend: as in `Ocean`, instead of the job's; the waves do not depend on it.

        Raises:
            JobError: a sea, tile or crest that cannot be; the message names the job.
        """
        s = self.settings
        if backend is None:
            on_device = s["ocean.backend"] in ("gpu", "gpu-or-cpu")
            backend = "auto" if on_device and dtype == "float64" else s["ocean.backend"]
        low, high = s["ocean.band_low"], s["ocean.band_high"]
        if not low < high:
            raise JobError(
                f"{self.source}: ocean.band_low must be below ocean.band_high, got "
                f"{low:g} and {high:g} rad/m"
            )
        try:
            ocean = Ocean(
                self.sea(),
                n=s["ocean.n"],
                size=s["ocean.size"],
                seed=s["ocean.seed"],
                loop=s["ocean.loop"],
                choppiness=s["ocean.choppiness"],
                amplitudes=s["ocean.amplitudes"],
                dtype=dtype,
                band=(low, high),
                order=s["ocean.order"],
                bound=s["ocean.bound"],
                backend=backend,
            )
            return constrained(ocean, *self.fixed) if self.fixed else ocean
        except (JobError, ReaderError):
            raise
        except ParameterError as error:
            raise JobError(f"{self.source}: ocean: {error}") from None

    def cascade(self, tiles: Iterable[Tile]) -> Cascade:
        """
        Return the cascade of the sea on some tiles, with the crests and values that the job fixes.

        Args:
            tiles: (n, size [m]) of each, from the largest to the smallest, instead of the job's.

        Raises:
            JobError: tiles that cannot share the sea, or a band beside tiles.
        """
        s = self.settings
        for key in ("ocean.band_low", "ocean.band_high"):
            if s[key] != BY_KEY[key].default:
                raise JobError(
                    f"{self.source}: {key} must be left out where there are tiles, "
                    "whose bands follow from their sizes"
                )
        try:
            cascade = Cascade(
                self.sea(),
                tiles,
                seed=s["ocean.seed"],
                loop=s["ocean.loop"],
                choppiness=s["ocean.choppiness"],
                amplitudes=s["ocean.amplitudes"],
                order=s["ocean.order"],
                bound=s["ocean.bound"],
                backend=s["ocean.backend"],
            )
            return constrained(cascade, *self.fixed) if self.fixed else cascade
        except JobError:
            raise
        except ParameterError as error:
            raise JobError(f"{self.source}: {error}") from None

    @property
    def fixed(self) -> tuple[Crest | Fix, ...]:
        """Crests and single values that the water is made to have."""
        return (*self.crests, *self.fixes)

    @property
    def frames(self) -> int:
        """Frames in the loop."""
        return int(self.settings["bake.frames"])

    @property
    def maps(self) -> tuple[str, ...]:
        """Names of the maps to write."""
        return tuple(self.settings["bake.maps"])

    @property
    def format(self) -> str:
        """File format."""
        return str(self.settings["bake.format"])

    @property
    def engine(self) -> str:
        """Engine whose conventions the files have."""
        return str(self.settings["bake.engine"])

    @property
    def lookup(self) -> str:
        """Index of maps: lagrangian (rest position) or eulerian (world position)."""
        return str(self.settings["bake.lookup"])

    @property
    def normals(self) -> str:
        """Encoding of normal maps: signed, packed, or what the engine's stock materials read."""
        return str(self.settings["bake.normals"])

    @property
    def mips(self) -> bool:
        """True if mip levels are written."""
        return bool(self.settings["bake.mips"])

    @property
    def pictures(self) -> tuple[str, ...]:
        """Names of the previews to write."""
        return tuple(self.settings["bake.pictures"])

    @property
    def foam(self) -> dict[str, float]:
        """
        Parameters of foam: tau [s], threshold [-] and strength [1/s]. Where the threshold follows
        the wind, `foam_on` has it, and here is the fixed one of seas without a wind.
        """
        given = {p.key.removeprefix("bake.foam."): self.settings[p.key] for p in FOAM}
        return given | ({"threshold": FIXED_THRESHOLD} if self.foam_follows_wind else {})

    @property
    def foam_follows_wind(self) -> bool:
        """True if the threshold of foam is the one that covers what whitecaps do in the wind."""
        return bool(self.settings["bake.foam.threshold"] == "wind")

    @property
    def wind_speed(self) -> float | None:
        """
        Wind 10 m above the sea [m/s]: the strongest of those that the wind sea and the tables of
        systems name, by speed or by a number on a scale; None if none does.
        """
        named = [self.settings["sea.wind.speed"]] if self.wind else []
        named += [wind for table in self.systems for wind in winds_of(table.get("spectrum"))]
        return max(named, default=None)

    def foam_on(self, water: "Ocean | Cascade") -> "Foam":
        """
        Return the foam of the job on its water.

        A threshold that follows the wind is solved for the waves of the water, and rounded to 1e-4;
        without a wind it is fixed.
        """
        from fftocean.foam import Foam

        given, wind = self.foam, self.wind_speed
        if not self.foam_follows_wind or wind is None:
            return Foam(**given)
        solved = Foam.whitecaps(water, wind, tau=given["tau"], strength=given["strength"])
        return replace(solved, threshold=round(solved.threshold, 4))

    def describe_foam(self, water: "Ocean | Cascade") -> dict[str, Any]:
        """
        Return the foam of the job on its water as plain data: parameters, the mean coverage that
        they specify, the wind if they follow it, and the origin of the threshold in words.
        """
        from fftocean.foam_coverage import mean_coverage

        foam, wind = self.foam_on(water), self.wind_speed
        given = {"tau": foam.tau, "threshold": foam.threshold, "strength": foam.strength}
        covered = mean_coverage(water, foam.threshold, tau=foam.tau, strength=foam.strength)
        if not self.foam_follows_wind:
            origin = "as the job has it"
        elif wind is None:
            origin = "fixed, as the sea names no wind"
        else:
            origin = f"that of the whitecaps of {wind:g} m/s (Monahan & O'Muircheartaigh 1980)"
        return {
            **given,
            "coverage": covered,
            "wind": wind if self.foam_follows_wind else None,
            "threshold_from": origin,
        }

    def downsampled(self, factor: int) -> "Job":
        """
        Return the job with 1/`factor` of the samples a side; waves too short for that grid are
        dropped.

        Its samples lie on every `factor`-th of this job's. Height and displacement there are this
        job's, low-passed; nothing is aliased. Fixed values are those of the waves that are left.

        Raises:
            JobError: `factor` does not divide the samples.
        """
        n = self.settings["ocean.n"]
        sides = n if isinstance(n, tuple) else (n,)
        if (
            isinstance(factor, bool)
            or not isinstance(factor, int)
            or factor < 1
            or any(side % factor for side in sides)
        ):
            raise JobError(
                f"downsample must be a whole number that divides ocean.n = "
                f"{', '.join(map(str, sides))}, got {factor!r:.40}"
            )
        return (
            self
            if factor == 1
            else self.replaced(
                {
                    "ocean.n": tuple(side // factor for side in sides)
                    if isinstance(n, tuple)
                    else n // factor
                }
            )
        )

    def inputs(self) -> dict[str, str]:
        """
        Return the SHA-256 of each measured file, by the name that the job gives it, with those that
        belong to it.

        Raises:
            ReaderError: one cannot be read.
        """
        folder, found = Path(self.source).parent, {}
        for table in self.systems:
            if "measured" in table:
                name = table["measured"]["file"]
                for path in measured_files(folder / name):
                    try:
                        sha256 = digest_of(path)
                    except OSError as error:
                        raise ReaderError(
                            f"{path.name} cannot be read: {error.strerror or error}"
                        ) from error
                    found[name if path == folder / name else f"{name} ({path.name})"] = sha256
        return found

    @classmethod
    def from_description(
        cls, described: Mapping[str, Any], *, source: str = "job", at_sea: bool = True
    ) -> "Job":
        """
        Return the job of a `describe`; without `at_sea` its measured files need not exist.

        Raises:
            JobError: the description is not that of a job.
        """
        tree: dict[str, Any] = {}
        for key, value in described.items():
            *tables, name = str(key).split(".")
            inner = tree
            for table in tables:
                inner = inner.setdefault(table, {})
                if not isinstance(inner, dict):
                    raise JobError(f"{source}: {key!r:.80} is not a key of a job")
            number = key in BY_KEY and BY_KEY[key].quantity is not None
            inner[name] = (
                float(value)
                if number and isinstance(value, str) and value in ("inf", "-inf")
                else value
            )
        return cls.from_tree(tree, source=source, at_sea=at_sea)

    def describe(self) -> dict[str, Any]:
        """
        Return the job as plain data for a manifest: every key, with `inf` as a word.
        """
        shown = {p.key: self.settings[p.key] for p in PARAMETERS if self.wind or p not in WIND}
        tree: dict[str, Any] = json.loads(
            json.dumps(
                _worded(
                    {
                        **shown,
                        "sea.systems": list(self.systems),
                        **fixed_tables.described(self.crests, self.fixes),
                    }
                ),
                default=str,
            )
        )
        return tree


def measured_files(path: Path) -> list[Path]:
    """Return a measured file, and those that a buoy has beside it."""
    from fftocean import readers

    return [path, *sorted(other for other in readers.files_of(path) if other != path)]


def _brings_wind(given: Mapping[str, Any], source: str) -> bool:
    """
    Return whether keys of sea.wind ask for a wind sea besides sea.systems.

    Raises:
        JobError: another key of sea.wind is given without its speed, which has no default there.
    """
    keys = [p.key for p in WIND if p.key in given]
    if keys and "sea.wind.speed" not in given:
        raise JobError(
            f"{source}: sea.wind.speed must be given where {keys[0]} is, as sea.systems "
            f"alone have no wind"
        )
    return bool(keys)


def _flatten(tree: Mapping[str, Any], prefix: str = "") -> Iterable[tuple[str, Any]]:
    """Yield the dotted keys of a parsed TOML tree, with their values."""
    for name, value in tree.items():
        key = f"{prefix}{name}"
        if isinstance(value, dict) and key not in _KNOWN:
            if not any(known.startswith(key + ".") for known in _KNOWN):
                raise JobError(unknown_key(key, _KNOWN))
            yield from _flatten(value, key + ".")
        else:
            yield key, value


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
    """Parse a TOML value; other text is a string, and `a,b` is a list."""
    if len(text) <= MAX_LINE:
        for attempt in (text, f"[{text}]"):
            try:
                tree = tomllib.loads(f"v = {attempt}")
            except (RecursionError, ValueError):
                continue
            if len(tree) == 1:  # and not a value and further lines
                return tree["v"]
    return [part.strip() for part in text.split(",")] if "," in text else text


def _worded(tree: Any) -> Any:
    """Return a tree with words for infinite numbers."""
    if isinstance(tree, Mapping):
        return {key: _worded(value) for key, value in tree.items()}
    if isinstance(tree, (list, tuple)):
        return [_worded(value) for value in tree]
    return finite_or_word(tree) if isinstance(tree, float) else tree


def finite_or_word(value: float) -> float | str:
    """Return a number as JSON can hold it: inf as a word."""
    return value if math.isfinite(value) else str(value)


__all__ = ["Job", "Parameter", "finite_or_word", "parse_setting", "parse_value"]
