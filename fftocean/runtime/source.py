"""Waves that a run-time package can hold: those of an ocean or a cascade, or given ones."""

from dataclasses import dataclass
from typing import Any

from fftocean.amplitudes import Amplitudes
from fftocean.cascade import Cascade, from_oceans
from fftocean.computation import Computation
from fftocean.errors import ParameterError, described
from fftocean.limits import CHOPPINESS
from fftocean.ocean import Ocean, from_amplitudes
from fftocean.physics.sea import Sea
from fftocean.runtime.layout import MOST_TILES
from fftocean.statistics import loop_error
from fftocean.wave_list import require_linear

PROPOSED = 64.0
"""Period near which a loop is proposed for waves without one [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """The waves to be packed: those of a sea, or of one that is still being changed."""

    tiles: tuple[Amplitudes, ...]
    choppiness: float
    sea: Sea | None = None
    seeds: tuple[int | None, ...] = ()  # of the tiles; () where they are unknown
    given: Ocean | Cascade | None = None  # of which these are the waves

    def __post_init__(self) -> None:
        object.__setattr__(self, "choppiness", CHOPPINESS.check("choppiness", self.choppiness))
        for tile in self.tiles:
            if not isinstance(tile, Amplitudes):
                raise ParameterError(f"tiles must be Amplitudes, got {described(tile)}")
        seeds = self.seeds or (None,) * len(self.tiles)
        object.__setattr__(self, "seeds", seeds)
        if not 1 <= len(self.tiles) <= MOST_TILES or len(seeds) != len(self.tiles):
            raise ParameterError(
                f"tiles must be 1 to {MOST_TILES}, got {len(self.tiles)} with {len(seeds)} seeds"
            )
        loops = {tile.loop for tile in self.tiles}
        if None in loops:
            raise ParameterError(
                "waves must repeat to be written as a run-time package: "
                f"give the ocean or cascade a loop, such as {_proposal(self.tiles[0])}"
            )
        if len(loops) > 1:
            raise ParameterError(
                f"tiles must have one loop in common in a run-time package, got {loops} s"
            )
        for name in ("depth", "surface_tension"):
            values = {getattr(tile, name) for tile in self.tiles}
            if len(values) > 1:
                raise ParameterError(f"tiles must have one {name}, got {sorted(values)}")

    @classmethod
    def of(cls, given: Any) -> "Source":
        """
        Return the source of an ocean or a cascade, or a source as it is.

        Raises:
            ParameterError: it is something else; the message says what to give instead.
        """
        if isinstance(given, cls):
            return given
        if type(given) not in (Ocean, Cascade):
            kind = type(given).__name__
            raise ParameterError(
                f"a run-time package holds the linear waves of an Ocean or a Cascade, "
                f"got {_INSTEAD.get(kind, described(given))}"
            )
        require_linear(given, "a run-time package")
        oceans = given.oceans if isinstance(given, Cascade) else (given,)
        return cls(
            tiles=tuple(ocean.amplitudes for ocean in oceans),
            choppiness=oceans[0].choppiness,
            sea=given.sea,
            seeds=tuple(ocean.seed for ocean in oceans),
            given=given,
        )

    @property
    def loop(self) -> float:
        """Period after which the water repeats [s]."""
        loop = self.tiles[0].loop
        assert loop is not None  # checked when it was made
        return loop

    def water(self) -> Ocean | Cascade:
        """Return the ocean or the cascade of these waves."""
        if self.given is not None:
            return self.given
        computation = Computation()
        oceans = tuple(
            from_amplitudes(self.sea, seed, tile, self.choppiness, computation)
            for tile, seed in zip(self.tiles, self.seeds, strict=True)
        )
        return oceans[0] if len(oceans) == 1 else from_oceans(self.sea, 0, oceans)


def _proposal(tile: Amplitudes) -> str:
    """Return a loop for waves, with the error of its frequencies."""
    found = loop_error(tile, PROPOSED)
    error = 100.0 * found.better_rms
    return f"loop={found.better_period:g}, whose frequencies are off by {error:.2g} % (rms)"


_INSTEAD = {
    "Eulerian": "an Eulerian, whose fields over places are not linear; give its ocean",
    "Window": "a Window, which shows a part of its source; give its source",
    "Query": "a Query; give the ocean or cascade that it asks",
    "Job": "a Job; give job.ocean()",
    "Sea": "a Sea, which has no waves yet; give Ocean(sea, ...) or Cascade(sea, ...)",
}
