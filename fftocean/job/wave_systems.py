"""
The tables [[sea.systems]] of a job: each a spectrum, a spreading and a direction, or a measurement
out of a file.
"""

import difflib
import math
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from fftocean.errors import JobError, ParameterError, ReaderError
from fftocean.job.parameters import spelled
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
    Count,
    Quantity,
)
from fftocean.physics import presets
from fftocean.physics.double_peaked import Bretschneider, OchiHubble, Torsethaugen
from fftocean.physics.sea import WaveSystem
from fftocean.physics.spectra import (
    JONSWAP,
    TMA,
    FrequencySpectrum,
    PiersonMoskowitz,
    TabulatedSpectrum,
)
from fftocean.physics.spreading import (
    Blend,
    CosinePower,
    CosineSquared,
    DonelanBanner,
    LongCrested,
    Spreading,
)
from fftocean.physics.spreading_laws import (
    CosineN,
    Hasselmann,
    Mitsuyasu,
    SwellElongation,
    WrappedNormal,
)
from fftocean.physics.wind_wavenumber import Elfouhaily, Phillips

if TYPE_CHECKING:
    from fftocean.readers import Realised

Made = TypeVar("Made")
Rules = Mapping[str, Quantity | None]
"""The keys a kind may have, each with its range; None leaves the check to the model."""

KEYS = ("spectrum", "measured", "spreading", "direction")
STATE: Rules = {"hs": SIGNIFICANT_WAVE_HEIGHT, "tp": PERIOD}
WIND: Rules = {"speed": WIND_SPEED, "fetch": FETCH}
GAMMA: Rules = {"gamma": PEAK_ENHANCEMENT}
OPTIONAL = {"gamma", "weight", "xi"}
INDEX = Count("", -(10**6), 10**6)

SPREADINGS: dict[str, tuple[Rules, Callable[..., Spreading]]] = {
    "cosine-squared": ({}, CosineSquared),
    "cosine-power": ({"s": SPREADING_EXPONENT}, CosinePower),
    "cosine-n": ({"n": SPREADING_EXPONENT}, CosineN),
    "donelan-banner": ({}, DonelanBanner),
    "mitsuyasu": ({"speed": WIND_SPEED}, Mitsuyasu),
    "hasselmann": ({"speed": WIND_SPEED}, Hasselmann),
    "long-crested": ({}, LongCrested),
    "wrapped-normal": ({"spread": None}, WrappedNormal),
    "swell": ({"xi": FRACTION}, lambda xi=0.5: SwellElongation(DonelanBanner(), xi=xi)),
    "blend": (
        {"weight": FRACTION},
        lambda weight=0.5: Blend(DonelanBanner(), CosineSquared(), weight=weight),
    ),
}


def spectra_in(
    depth: float, tension: float
) -> dict[str, list[tuple[Rules, Callable[..., FrequencySpectrum | None]]]]:
    """The kinds of spectrum in this water, each with the sets of keys that it can be made of."""
    tma: Rules = {**STATE, **GAMMA}
    halves = {f"{name}_{half}": None for half in ("low", "high") for name in ("hs", "tp", "lambda")}
    return {
        "jonswap": [
            ({**STATE, **GAMMA}, JONSWAP.from_sea_state),
            ({**WIND, **GAMMA}, JONSWAP.from_wind),
        ],
        "tma": [
            (tma, lambda **v: TMA.from_sea_state(depth=DEPTH.check("sea.depth", depth), **v)),
            ({**WIND, **GAMMA}, lambda **v: TMA(JONSWAP.from_wind(**v), depth)),
        ],
        "pierson-moskowitz": [
            (STATE, PiersonMoskowitz.from_sea_state),
            ({"speed": WIND_SPEED}, PiersonMoskowitz.from_wind),
        ],
        "bretschneider": [(STATE, Bretschneider)],
        "ochi-hubble": [
            ({"hs": SIGNIFICANT_WAVE_HEIGHT}, OchiHubble.most_probable),
            (halves, OchiHubble),
        ],
        "torsethaugen": [(STATE, Torsethaugen)],
        "phillips": [
            (
                {"hs": SIGNIFICANT_WAVE_HEIGHT, "speed": WIND_SPEED},
                lambda **v: Phillips.from_height(depth=depth, surface_tension=tension, **v),
            )
        ],
        "elfouhaily": [
            (
                {"speed": WIND_SPEED},
                lambda speed: Elfouhaily(speed=speed, depth=depth, surface_tension=tension),
            ),
            (
                WIND,
                lambda speed, fetch: Elfouhaily(
                    speed=speed, fetch=fetch, depth=depth, surface_tension=tension
                ),
            ),
        ],
        "beaufort": [
            (
                {"number": presets.BEAUFORT},
                lambda number: presets.beaufort(int(number)).spectrum(depth),
            )
        ],
        "sea-state": [
            (
                {"number": presets.SEA_STATE},
                lambda number: presets.sea_state(int(number)).spectrum(depth),
            )
        ],
        "tabulated": [({"frequency": None, "density": None}, TabulatedSpectrum)],
    }


def systems_of(
    key: str,
    table: Mapping[str, Any],
    *,
    depth: float,
    tension: float,
    folder: Path,
    measured: "Realised | None" = None,
) -> tuple[WaveSystem, ...]:
    """
    Make the wave systems of one table: one, or none where its spectrum is a calm.

    Args:
        key: the table's full name, for messages.
        table: as in the job file.
        depth, tension: of the sea's water [m], [N/m].
        folder: where the names of measured files start.
        measured: the table's measurement, where it has been realised already.

    Raises:
        JobError: a key or value that it may not have.
        ReaderError: a measured file that is not what it should be.
    """
    for name in table:
        if name not in KEYS:
            raise JobError(unknown_key(f"{key}.{name}", [f"{key}.{n}" for n in KEYS]))
    if ("spectrum" in table) == ("measured" in table):
        raise JobError(
            f"{key}.spectrum must be given, such as {{ kind = 'jonswap', hs = 1.5, tp = 14.0 }}, or {key}.measured, such as "
            f"{{ file = 'buoy.data_spec' }}, and not both"
        )
    try:
        if "measured" in table:
            return (measured or measurement(key, table, folder)).sea.systems
        direction = DIRECTION.check(f"{key}.direction", table.get("direction", 0.0))
        spreading = _one_of(
            f"{key}.spreading",
            table.get("spreading", {"kind": "blend"}),
            {k: [way] for k, way in SPREADINGS.items()},
        )
        spectrum = _one_of(f"{key}.spectrum", table["spectrum"], spectra_in(depth, tension))
        assert spreading is not None  # every kind of spreading makes one
        return (
            ()
            if spectrum is None
            else (WaveSystem(spectrum=spectrum, spreading=spreading, direction=direction),)
        )
    except JobError:
        raise
    except ParameterError as error:
        if error.exit_code != JobError.exit_code:
            raise  # a measured file says itself what is wrong with it
        raise JobError(str(error)) from None


def measurement(key: str, table: Mapping[str, Any], folder: Path) -> "Realised":
    """
    Realise the measured spectrum of one table; one without directions takes the table's.

    Args:
        key: the table's full name, for messages.
        table: as in the job file, with `measured`.
        folder: where the names of measured files start.

    Raises:
        JobError: a key or value that the table may not have, or that its file does not have.
        ReaderError: a file that is not what it should be; the message names the key and the file.
    """
    from fftocean import readers

    source = table["measured"]
    if (
        not isinstance(source, dict)
        or not {"file"} <= set(source) <= {"file", "time", "site"}
        or not isinstance(source["file"], str)
    ):
        raise JobError(
            f"{key}.measured must be a table with a file, and perhaps time and site counted from 0, got {source!r:.80}"
        )
    time, site = (
        INDEX.check_whole(f"{key}.measured.{name}", source.get(name, 0))
        for name in ("time", "site")
    )
    direction, spreading = None, None
    if "direction" in table:
        direction = DIRECTION.check(f"{key}.direction", table["direction"])
    if "spreading" in table:
        spreading = _one_of(
            f"{key}.spreading", table["spreading"], {k: [way] for k, way in SPREADINGS.items()}
        )
    where = f"{key}.measured, file {source['file']!r:.80}"
    try:
        if os.path.isdir(folder / source["file"]):  # noqa: PTH112  which is false for impossible names
            raise ReaderError("must be a file, got a directory")
        dataset = readers.open(folder / source["file"], site=site)
        return readers.Realised.from_spectrum(
            dataset, time=time, depth=math.inf, direction=direction, spreading=spreading
        )
    except ReaderError as error:
        raise ReaderError(f"{where}: {error}") from None
    except ParameterError as error:
        raise JobError(f"{where}: {error}") from None


def _one_of(
    key: str, table: Any, kinds: Mapping[str, list[tuple[Rules, Callable[..., Made]]]]
) -> Made:
    """Make what an inline table names by its `kind`, from the first set of keys that fits."""
    got = table.get("kind") if isinstance(table, dict) else table
    got = spelled(got, kinds) or got if isinstance(got, str) else got
    if not isinstance(table, dict) or not isinstance(got, str) or got not in kinds:
        raise JobError(
            f"{key} must be a table whose kind is one of {', '.join(kinds)}, got {got!r:.60}"
        )
    kind, values = got, {k: v for k, v in table.items() if k != "kind"}
    for rules, make in kinds[kind]:
        if set(rules) - OPTIONAL <= set(values) <= set(rules):
            checked = {
                name: _checked(f"{key}.{name}", rules[name], value)
                for name, value in values.items()
            }
            try:
                return make(**checked)
            except ParameterError as error:
                raise JobError(f"{key}: {error}") from None
    accepted = " or ".join("{" + ", ".join(rules) + "}" for rules, _ in kinds[kind])
    raise JobError(
        f"{key} of kind {kind!r} must have the keys {accepted}, got {{{', '.join(map(str, values))}}}"
    )


def _checked(name: str, rule: Quantity | None, value: Any) -> Any:
    """A value under its full name."""
    if rule is None:
        return value
    return rule.check_whole(name, value) if isinstance(rule, Count) else rule.check(name, value)


def unknown_key(key: str, known: Iterable[str]) -> str:
    """Say that a key is unknown, and which one may have been meant."""
    close = difflib.get_close_matches(key, list(known), n=1, cutoff=0.5)
    hint = f"; did you mean {close[0]}?" if close else f"; known are {', '.join(known)}"
    return f"unknown key {key!r:.80}{hint}"
