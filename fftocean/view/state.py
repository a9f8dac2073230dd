"""
Sea of the live page: values of its parameters over a job.

The job is a user's, or the default of every key. The parameters of the local wind sea are the keys
of its `sea.wind`; depth, loop, seed and choppiness are its own too. Its other wave systems stay as
they are. The swell of the page is one more system, written last; a job whose last system is such a
swell, as every copied job, gives the swell its values back. A state is turned into a job first and
that job into a sea, so a copied job is baked as the sea that was seen.
"""

import math
import shlex
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

from fftocean.cascade import Cascade, Tile, tile_jobs
from fftocean.constraints import constrained
from fftocean.errors import JobError, ParameterError, ReaderError, SeaWarning
from fftocean.job.job import Job
from fftocean.job.job_text import job_text, toml_value
from fftocean.job.parameters import PARAMETERS as JOB_PARAMETERS
from fftocean.job.parameters import WIND
from fftocean.physics import dispersion
from fftocean.physics.sea import Sea
from fftocean.view.parameters import BY_NAME, SENT
from fftocean.view.swell import Swell, swell_of, table_of

if TYPE_CHECKING:
    from fftocean.readers import Realised

MOST_SAMPLES: Final = 1024  # a side of a tile, on a page
WAVES_ACROSS: Final = 12.0  # fewest peak wavelengths across the largest tile
SMALLEST_LARGE_TILE: Final = 60.0  # [m]
LADDER: Final = math.sqrt(2.0)  # sizes of the largest tile are steps of this factor
_KEPT: Final = 2.5  # a size is kept while the tile is at most so many times as wide as it must be

_KEYS: Final = {
    "wind_speed": "sea.wind.speed",
    "wind_direction": "sea.wind.direction",
    "fetch": "sea.wind.fetch",
    "choppiness": "ocean.choppiness",
    "depth": "sea.depth",
    "loop": "ocean.loop",
    "seed": "ocean.seed",
}
"""Parameters that are keys of a job."""

_OF_THE_SEA: Final = frozenset(
    p.name for p in SENT if p.name not in ("choppiness", "loop", "seed", "tiles", "model")
)
"""Parameters on which the specified sea depends; the others are those of its realisation."""


@dataclass(frozen=True, slots=True)
class State:
    """
    Values of the sent parameters, the job under them, and the tiles.

    Make one with `State.default` or `State.of_job`; change one with `changed`.
    """

    values: Mapping[str, Any]
    base: Job  # without the swell of the page
    sizes: tuple[Tile, ...]  # (n, size) of every tile that can be shown, the largest first
    chosen: bool  # True where the tiles were given; False where they follow the sea
    source: str  # in words
    dropped: bool = False  # True if its measured file was dropped on the page
    measured: Mapping[str, "Realised"] = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def default(
        cls, *, n: int = 128, tiles: Sequence[Tile] | None = None, count: int | None = None
    ) -> "State":
        """
        Return the sea with which the page begins: a local wind sea and a swell.

        Args:
            n: samples a side of each tile; a power of two.
            tiles: (n, size) of each; None for sizes that follow the sea.
            count: number of tiles that are shown; None for the parameter's default.

        Raises:
            JobError: `n` is not a power of two, or tiles that make no cascade.
        """
        values = {p.name: p.default for p in SENT}
        sizes = _checked_tiles(tiles) if tiles else ()
        values["tiles"] = count or (len(sizes) if sizes else values["tiles"])
        base = Job.from_tree({}, source="the page")
        made = cls(MappingProxyType(values), base, sizes, bool(sizes), "wind sea and swell")
        return made if sizes else made._with_sizes(power_of_two("n", n))

    @classmethod
    def of_job(
        cls,
        job: Job,
        *,
        n: int | None = None,
        tiles: Sequence[Tile] | None = None,
        source: str | None = None,
        dropped: bool = False,
    ) -> "State":
        """
        Return the sea of a job, on its own tile.

        Args:
            job: any job.
            n: samples a side instead of the job's.
            tiles: (n, size) of each tile instead of the job's one.
            source: its name, as the page shows it.
            dropped: its measured file was dropped on the page, and is known by name alone.

        Raises:
            JobError: `n` is not a power of two or more than a page can hold, or tiles that make no
                cascade.
        """
        settings = job.settings
        if settings["ocean.order"] > 1:
            raise JobError(
                f"{job.source}: ocean.order must be 1 for the live page, whose programs evolve "
                f"linear waves, got {settings['ocean.order']}"
            )
        swell = swell_of(job.systems[-1]) if job.systems else None
        systems = job.systems[:-1] if swell else job.systems
        values = {name: settings[key] for name, key in _KEYS.items()}
        values["wind_speed"] = settings["sea.wind.speed"] if job.wind else 0.0
        values["wind_direction"] %= 360.0
        values |= {
            "swell_speed": swell.speed if swell else 0.0,
            "swell_direction": (swell or Swell(0.0, 0.0, values["wind_direction"])).direction
            % 360.0,
            "swell_share": swell.share if swell else BY_NAME["swell_share"].default,
            "model": BY_NAME["model"].default,
        }
        if tiles:
            sizes = _checked_tiles(tiles)
            values["tiles"] = len(sizes)
        else:
            sizes = _own_tile(job, n)
            values["tiles"] = 1
        base = Job(settings, job.wind, systems, job.source, job.crests, job.fixes)
        return cls(
            MappingProxyType({p.name: values[p.name] for p in SENT}),
            base,
            sizes,
            True,
            source or job.source,
            dropped,
            job.measurements(),
        )

    @classmethod
    def of_spectrum(
        cls, file: Path, before: "State", *, source: str, dropped: bool = False
    ) -> "State":
        """
        Return the sea of a measured spectrum, with the seed, loop and tiles of another state.

        Tiles that follow the sea follow this one.

        Args:
            file: the spectrum, in any format of `fftocean.readers`.
            before: the other state.
            source: the name of the file, as the page shows it.
            dropped: the file was dropped on the page, and is known by name alone.

        Raises:
            ReaderError: a file that cannot be read; the message names the rule.
        """
        tree = {"sea": {"systems": [{"measured": {"file": file.name}}]}}
        kept = {_KEYS[name]: before.values[name] for name in ("seed", "loop", "choppiness")}
        try:
            job = Job.from_tree(tree, source=str(file.with_name("sea.toml")))
            made = cls.of_job(
                job.replaced(kept),
                n=before.samples,
                tiles=before.tiles if before.chosen and before.is_square else None,
                source=source,
                dropped=dropped,
            )
        except (ReaderError, JobError) as error:
            raise type(error)(_about_file(str(error), file.name, source)) from None
        values = {**made.values, "tiles": before.values["tiles"], "model": before.values["model"]}
        made = replace(made, values=MappingProxyType(values), chosen=before.chosen)
        return made if before.chosen else made._with_sizes(before.samples)

    def changed(self, changes: Mapping[str, Any]) -> "State":
        """
        Return the state with other values of some parameters, checked by making its sea.

        Args:
            changes: values in their final type, by name.

        Raises:
            ParameterError: no sea can be made of the values.
        """
        made = replace(self, values=MappingProxyType({**self.values, **changes}))
        if made.values["tiles"] > 1:
            made._require_tiles()
        if changes.keys().isdisjoint(_OF_THE_SEA):
            return made
        made.sea()
        return made if self.chosen else made._with_sizes(self.samples)

    @property
    def tiles(self) -> tuple[Tile, ...]:
        """(n, size) of the tiles that are shown, the largest first."""
        return self.sizes[: self.values["tiles"]]

    def has_waves_of(self, other: "State") -> bool:
        """Return True if the waves are those of another state, whatever their choppiness."""
        return self.has_random_numbers_of(other) and all(
            self.values[name] == other.values[name] for name in _OF_THE_SEA
        )

    def has_random_numbers_of(self, other: "State") -> bool:
        """Return True if tiles, phases and loop are those of another state, whatever the sea."""
        return (self.base, self.tiles) == (other.base, other.tiles) and all(
            self.values[name] == other.values[name] for name in ("seed", "loop")
        )

    def job(self) -> Job:
        """Return the job of the sea, on the largest tile."""
        v, base = self.values, self.base
        swell = Swell(v["swell_speed"], v["swell_share"], v["swell_direction"])
        systems = (*base.systems, *([table_of(swell)] if swell.speed else []))
        wind = v["wind_speed"] > 0.0 or not systems
        settings = {**base.settings, **{key: v[name] for name, key in _KEYS.items()}}
        if not wind:
            settings |= {p.key: p.default for p in WIND}
        n, size = self.sizes[0]
        settings |= {"ocean.n": n, "ocean.size": size}
        for parameter in JOB_PARAMETERS:
            parameter.check(settings[parameter.key])
        return Job(settings, wind, systems, base.source, base.crests, base.fixes)

    def sea(self) -> Sea:
        """
        Return the sea.

        Raises:
            ParameterError: no sea can be made of the values.
        """
        return self.job().sea(self.measured)

    def cascade(self, *, dtype: str = "float32") -> Cascade:
        """
        Return the sea on its tiles.

        Raises:
            ParameterError: tiles that make no cascade, or too little memory.
        """
        job, settings = self.job(), self.base.settings
        low, high = settings["ocean.band_low"], settings["ocean.band_high"]
        cascade = Cascade(
            job.sea(self.measured),
            self.tiles,
            bands=[(low, high)] if len(self.tiles) == 1 else None,
            seed=self.values["seed"],
            loop=self.values["loop"],
            choppiness=self.values["choppiness"],
            amplitudes=settings["ocean.amplitudes"],
            dtype=dtype,
        )
        return constrained(cascade, *job.fixed) if job.fixed else cascade

    def toml(self) -> str:
        """Return the job file of the sea."""
        folder = Path(self.base.source).parent
        files = {
            name: str((folder / name).resolve())
            for table in self.base.systems
            if isinstance(measured := table.get("measured"), Mapping)
            and isinstance(name := measured.get("file"), str)
            and not self.dropped
        }
        comments = ["fftocean bake sea.toml -o sea" + self._tiles_flag()]
        return job_text(self.job(), comments=comments, files=files)

    def command(self) -> str:
        """
        Return the command line that bakes the sea: flags alone, or a job file and the command.
        """
        job = self.job()
        if job.systems or job.crests or job.fixes:
            text = self.toml()
            return (
                f"cat > sea.toml <<'END_OF_JOB'\n{text}END_OF_JOB\n"
                f"fftocean bake sea.toml -o sea{self._tiles_flag()}"
            )
        default = Job.default().settings
        flags = [
            f"--set {shlex.quote(f'{p.key}={toml_value(value)}')}"
            for p in JOB_PARAMETERS
            if (value := job.settings[p.key]) != default[p.key]
        ]
        return " ".join(["fftocean bake -o sea", *flags]) + self._tiles_flag()

    def plain(self) -> dict[str, Any]:
        """Return every value as JSON can hold it."""
        return {name: BY_NAME[name].plain(value) for name, value in self.values.items()}

    @property
    def samples(self) -> int:
        """Samples a side of the largest tile, the larger of two."""
        n = self.sizes[0][0]
        return n if isinstance(n, int) else max(n)

    @property
    def is_square(self) -> bool:
        """True if every tile is square."""
        return not any(isinstance(value, tuple) for tile in self.sizes for value in tile)

    def _tiles_flag(self) -> str:
        """Return the flag for the tiles of a command, or nothing for one tile."""
        if len(self.tiles) < 2:
            return ""
        return " --tiles " + ",".join(f"{n}:{size!r}" for n, size in self.tiles)

    def _with_sizes(self, n: int) -> "State":
        """Return the state with tiles that fit the peak of the sea."""
        sizes = self.sizes or ((n, SMALLEST_LARGE_TILE),)
        made = replace(self, sizes=sizes)
        longest = peak_wavelength(made.sea())
        largest = sizes[0][1]
        assert isinstance(largest, float)  # square
        least = max(WAVES_ACROSS * longest, SMALLEST_LARGE_TILE)
        if not (self.sizes and least <= largest <= _KEPT * least):
            steps = math.ceil(math.log(least / SMALLEST_LARGE_TILE, LADDER) - 1e-9)
            largest = SMALLEST_LARGE_TILE * LADDER**steps
        most = BY_NAME["tiles"].high
        assert most is not None
        return replace(self, sizes=tile_sizes(n, largest, int(most)))

    def _require_tiles(self) -> None:
        """Raise if the job cannot be shown on several tiles, or there are not so many."""
        settings, count = self.base.settings, self.values["tiles"]
        if (settings["ocean.band_low"], settings["ocean.band_high"]) != (0.0, math.inf):
            raise ParameterError(
                f"tiles must be 1 for a job with ocean.band_low or ocean.band_high, got {count}"
            )
        if count > len(self.sizes):
            raise ParameterError(
                f"tiles must be at most {len(self.sizes)}, which were given, got {count}"
            )


def _about_file(message: str, name: str, source: str) -> str:
    """Return a message about the only measured file of a job, without the keys of that job."""
    _, found, rest = message.partition(f"sea.systems[0].measured, file {name!r:.80}: ")
    if not found:
        return message
    if rest.startswith("the file has no directions"):
        # the flags of other commands are not those of the page
        rest = (
            rest.removesuffix("; without a job file, --toward")
            + "; start `fftocean view` with such a job"
        )
    return f"{source} {rest}" if rest.startswith(("must ", "cannot ")) else f"{source}: {rest}"


def tile_sizes(n: int, largest: float, count: int) -> tuple[Tile, ...]:
    """
    Return the tiles of a cascade, each of the same samples, down from the size of the largest.

    The ratio of two sizes is no whole number, and such that two neighbours overlap in wavenumbers.
    From 64 samples on, about 25 of the shortest wave of a tile fit across it.
    """
    ratio = _RATIOS.get(n, 7.06)
    return tuple((n, round(largest / ratio**i, 3 + i)) for i in range(count))


_RATIOS: Final = {8: 2.7, 16: 5.3, 64: 11.3, 128: 11.3}
"""Ratio of the sizes of two tiles by their samples, where it is not 7.06."""


def peak_wavelength(sea: Sea) -> float:
    """Return the wavelength at the peak of a sea [m]; 0 for a flat one."""
    if not sea.systems or not float(sea(sea.peak)) > 0.0:
        return 0.0
    return 2.0 * math.pi / float(dispersion.wavenumber(sea.peak, sea.depth))


def power_of_two(name: str, n: Any) -> int:
    """
    Return a number of samples that a page can transform.

    Raises:
        JobError: it is not a power of two from 8 to `MOST_SAMPLES`; the message names the next.
    """
    if isinstance(n, bool) or not isinstance(n, int) or not 8 <= n <= MOST_SAMPLES:
        raise JobError(
            f"{name} must be a power of two from 8 to {MOST_SAMPLES} on a page, got {n!r:.40}"
        )
    if n & (n - 1):
        raise JobError(
            f"{name} must be a power of two on a page, got {n}; the next is {1 << n.bit_length()}"
        )
    return n


def _own_tile(job: Job, n: int | None) -> tuple[Tile, ...]:
    """Return the tile of a job, and finer ones where it is square and whole."""
    own, size = job.settings["ocean.n"], job.settings["ocean.size"]
    if n is not None:
        own = power_of_two("n", n)
    elif isinstance(own, tuple):
        own = tuple(power_of_two("ocean.n", side) for side in own)
    else:
        own = power_of_two("ocean.n", own)
    if isinstance(own, tuple) or isinstance(size, tuple):
        return ((own, size),)
    most = BY_NAME["tiles"].high
    assert most is not None
    return ((own, size), *tile_sizes(own, size, int(most))[1:])


def _checked_tiles(tiles: Sequence[Tile]) -> tuple[Tile, ...]:
    """Return given tiles, whose samples a page can transform."""
    most = BY_NAME["tiles"].high
    assert most is not None
    if len(tiles) > most:
        raise JobError(f"tiles must be at most {int(most)}, got {len(tiles)}")
    checked: list[Tile] = []
    for n, size in tiles:
        if isinstance(size, tuple):
            raise JobError(f"a tile must be square where there are several, got {size}")
        checked.append((power_of_two("the samples of a tile", n), float(size)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SeaWarning)  # told when the sea is made
        tile_jobs(checked, 0)
    return tuple(checked)
