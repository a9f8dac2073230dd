"""
Seas of the page as binary messages, made in a worker thread; the newest state wins.

While values change, seas follow at once, by a quick method where there is one. When they rest, the
exact sea is made. The last two exact seas are kept, so that the page can ask for their fields.
"""

import asyncio
import time
import warnings
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np

from fftocean.cascade import Cascade, from_oceans
from fftocean.errors import ParameterError, SeaWarning
from fftocean.foam import Foam
from fftocean.moving_amplitudes import MovingAmplitudes
from fftocean.physics.sea import Sea
from fftocean.polar_spectrum import polar_spectrum
from fftocean.runtime import pack, to_bytes
from fftocean.slope_variance import slope_variance
from fftocean.view import protocol
from fftocean.view.state import State
from fftocean.view.worker import Worker

REST: Final = 0.15  # seconds without a change, after which the exact sea is made
PAUSE: Final = 0.05  # shortest time between two seas while values change [s]
KEPT: Final = 2  # exact seas

_POLAR_RINGS, _POLAR_SECTORS = 20, 36
_POLAR_PEAKS = 5.0  # highest frequency of the polar plot, in peaks


@dataclass(frozen=True, slots=True, eq=False)
class MadeSea:
    """A sea as the page gets it."""

    number: int  # rises from sea to sea
    state: State
    quality: str  # "exact" or "moving"
    data: bytes  # the container
    document: dict[str, Any]
    notes: tuple[str, ...]  # warnings of the library
    cascade: Cascade | None  # of an exact sea


def make_exact(
    state: State, number: int, *, points: int = 0, before: MadeSea | None = None
) -> MadeSea:
    """
    Return the exact sea of a state.

    Args:
        state: values and job.
        number: of the sea, in its document.
        points: points a tile at which the package has fields to check it by; 0 for none.
        before: an exact sea whose waves are used again where they are the same.

    Raises:
        ParameterError: no such sea can be made, or it cannot be packed; the message has the rule.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", SeaWarning)
        cascade = _cascade_of(state, before)
        package = pack(
            cascade,
            reference=points,
            job=state.toml(),
            quality="exact",
            wind=_wind_of(state),
            foam=_foam_of(state, cascade),
        )
        few = _few_waves_of(state, cascade.sea, package.document["ticks"])
    package.document.update(id=number, few_waves=few, slope_variance=_roughness_of(state, cascade))
    _add_polar(package.document, cascade.sea)
    notes = tuple(
        dict.fromkeys(str(w.message) for w in caught if issubclass(w.category, SeaWarning))
    )
    if before is not None and cascade is before.cascade:
        notes = before.notes
    data = to_bytes(package)
    return MadeSea(number, state, "exact", data, package.document, notes, cascade)


def _add_polar(document: dict[str, Any], sea: Sea | None) -> None:
    """
    Add the specified density by frequency and direction to a document's spectrum.

    `highest` is the frequency at the outer edge of the last ring [Hz], where the first one begins
    at 0; sectors begin at east, counter-clockwise; densities are relative to the largest one.
    """
    specified, spectrum = document["statistics"]["specified"], document["spectrum"]
    if sea is None or spectrum is None or not specified["tp"] > 0.0:
        return
    highest = _POLAR_PEAKS / specified["tp"]
    density = polar_spectrum(sea, highest, _POLAR_RINGS, _POLAR_SECTORS).density
    relative = np.round(density / max(float(density.max()), 1e-300), 3)
    spectrum["polar"] = {"highest": highest, "density": relative.tolist()}


def _cascade_of(state: State, before: MadeSea | None) -> Cascade:
    """Return the cascade of a state, with the waves of the one before where they are the same."""
    if before is None or before.cascade is None or not state.has_waves_of(before.state):
        return state.cascade(dtype="float64")
    given, choppiness = before.cascade, state.values["choppiness"]
    if choppiness == given.choppiness:
        return given
    oceans = tuple(
        ocean.with_amplitudes(ocean.amplitudes, choppiness=choppiness) for ocean in given.oceans
    )
    return from_oceans(given.sea, given.seed, oceans)


class MovingSeas:
    """Seas of states that follow a slider: amplitudes from a lattice of the spectrum."""

    def __init__(self) -> None:
        self._given: MadeSea | None = None
        self._moving: MovingAmplitudes | None = None

    def start(self, exact: MadeSea) -> None:
        """Take the tiles and the random numbers of an exact sea, where they are new."""
        if self._given is None or not exact.state.has_random_numbers_of(self._given.state):
            self._moving = None
        self._given = exact

    def can_make(self, state: State) -> bool:
        """Return True for a state that differs from the exact sea in its specified sea alone."""
        return (
            self._given is not None
            and state.has_random_numbers_of(self._given.state)
            and not state.has_waves_of(self._given.state)
            and not (state.base.crests or state.base.fixes)  # each sea is constrained anew
        )

    def make(self, state: State, number: int) -> MadeSea:
        """Return the sea of a state that `can_make` allows."""
        given = self._given
        assert given is not None
        assert given.cascade is not None
        if self._moving is None:
            self._moving = MovingAmplitudes(given.cascade)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SeaWarning)  # the exact sea tells
            sea = state.sea()
            cascade = self._moving.cascade(sea, choppiness=state.values["choppiness"])
            package = pack(
                cascade,
                reference=False,
                quality="moving",
                wind=_wind_of(state),
                foam=_foam_of(state, cascade),
            )
            few = _few_waves_of(state, sea, package.document["ticks"])
        package.document.update(
            id=number, few_waves=few, slope_variance=_roughness_of(state, cascade)
        )
        return MadeSea(number, state, "moving", to_bytes(package), package.document, (), None)


def _few_waves_of(state: State, sea: Sea | None, ticks: int) -> dict[str, Any] | None:
    """Return the waves of the few-wave model of a state, or None."""
    if sea is None or state.values["model"] == "fft":
        return None
    from fftocean.view.few_waves import few_waves

    made = few_waves(
        sea,
        state.values["model"],
        loop=state.values["loop"],
        ticks=ticks,
        seed=state.values["seed"],
    )
    return made.document()


def _roughness_of(state: State, cascade: Cascade) -> dict[str, list[float]]:
    """Return the slope variance of the tiles, of the whole sea, and beyond the tiles, as JSON."""
    wind = _wind_of(state)
    found = slope_variance(
        cascade,
        wind_speed=None if wind is None else wind[0],
        wind_direction=0.0 if wind is None else wind[1],
    )
    return {name: list(getattr(found, name)) for name in ("captured", "total", "beyond")}


def _foam_of(state: State, cascade: Cascade) -> Foam:
    """
    Return the foam of a sea: that of a job that bakes foam, else as much as its wind's whitecaps.

    In still air nothing foams. Wave systems of a job, and measured spectra, may have had a wind
    that is not known: without one they have the threshold of `Foam`. All waves count: the page's
    windows of foam take the tiles' samples as they are, unfiltered.
    """
    own, wind = state.base.foam, _wind_of(state)
    fixed = "foam" in state.base.maps and not state.base.foam_follows_wind
    if fixed or (wind is None and state.base.systems):
        return Foam(**own)
    speed = 0.0 if wind is None else wind[0]
    return Foam.whitecaps(cascade, speed, tau=own["tau"], strength=own["strength"])


def _wind_of(state: State) -> tuple[float, float] | None:
    """Return the speed [m/s] and the direction [degrees] of the local wind, or None."""
    speed, direction = state.values["wind_speed"], state.values["wind_direction"]
    return (speed, direction) if speed > 0.0 else None


def reference_fields(sea: MadeSea, tick: int) -> list[bytes]:
    """
    Return the fields of every tile of an exact sea at a tick, as binary messages.

    They are computed in float64 and rounded to float32.
    """
    assert sea.cascade is not None  # it is exact
    ticks = sea.document["ticks"]
    frames = sea.cascade.loop_frame(tick % ticks, ticks, protocol.REFERENCE_FIELDS)
    return [
        protocol.reference(frame, tick=tick, ticks=ticks, tile=i, sea=sea.number)
        for i, frame in enumerate(frames)
    ]


class SeaMaker:
    """
    Maker of the newest sea.

    `want` sets what is to be made, `run` makes it until it is cancelled. `made` is called with each
    sea, `failed` with a state of which none can be made and the reason.
    """

    def __init__(
        self,
        worker: Worker,
        made: Callable[[MadeSea], None],
        failed: Callable[[State, Exception], None],
    ) -> None:
        self._worker, self._made, self._failed = worker, made, failed
        self._moving = MovingSeas()
        self._wanted: State | None = None
        self._changed = asyncio.Event()
        self._number = 0
        self._exact: OrderedDict[int, MadeSea] = OrderedDict()

    @property
    def busy(self) -> bool:
        """True while the newest state has no exact sea."""
        return self._wanted is not None

    def want(self, state: State) -> None:
        """Ask for the sea of a state, instead of any that was asked for before."""
        self._wanted = state
        self._changed.set()

    def exact(self, number: int | None) -> MadeSea:
        """
        Return an exact sea by its number; None is the newest.

        Raises:
            ParameterError: there is none, or it is no longer kept.
        """
        if not self._exact:
            raise ParameterError("verify must wait for the first exact sea")
        if number is None:
            return next(reversed(self._exact.values()))
        if number not in self._exact:
            known = ", ".join(map(str, self._exact))
            raise ParameterError(
                f"verify must name an exact sea that is kept ({known}), got {number}"
            )
        return self._exact[number]

    async def run(self) -> None:
        """Make seas until cancelled."""
        while True:
            await self._changed.wait()
            self._changed.clear()
            if (state := self._wanted) is None:
                continue
            began = time.monotonic()
            if self._moving.can_make(state):
                if not await self._make(self._moving.make, state):
                    continue
                if await self._changes_within(REST):
                    await asyncio.sleep(max(0.0, PAUSE - (time.monotonic() - began)))
                    continue
            before = next(reversed(self._exact.values()), None)
            await self._make(partial(make_exact, before=before), state)

    async def _make(self, make: Callable[[State, int], MadeSea], state: State) -> bool:
        """Make one sea and hand it on, or the reason why there is none; return True for a sea."""
        self._number += 1
        number = self._number
        try:
            sea = await self._worker.run(lambda: make(state, number))
        except Exception as error:  # whatever it is, the server goes on with the sea before
            if self._wanted is state:
                self._wanted = None
            self._failed(state, error)
            return False
        if sea.quality == "exact":
            if self._wanted is state:
                self._wanted = None
            self._exact[number] = sea
            while len(self._exact) > KEPT:
                self._exact.popitem(last=False)
            self._moving.start(sea)
        self._made(sea)
        return True

    async def _changes_within(self, seconds: float) -> bool:
        """Return True as soon as another state is wanted, False if none is for a time."""
        try:
            await asyncio.wait_for(self._changed.wait(), seconds)
        except TimeoutError:
            return False
        return True
