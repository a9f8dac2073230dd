"""
Wave systems of a job: the tables [[sea.systems]], each a spectrum, a spreading and a direction, or
a measured spectrum from a file.
"""

import datetime
import difflib
import math
import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from fftocean.errors import JobError, ParameterError, ReaderError
from fftocean.job.parameters import spelled
from fftocean.limits import DIRECTION, Count
from fftocean.physics import presets
from fftocean.physics.kinds import Part, Registry
from fftocean.physics.sea import WaveSystem
from fftocean.physics.spectra import SPECTRA
from fftocean.physics.spectra.tabulated import TAIL
from fftocean.physics.spreading import SPREADINGS, Spreading

if TYPE_CHECKING:
    from fftocean.readers import Realised

M = TypeVar("M")
Water = Mapping[str, float]
"""The depth [m] and the surface tension [N/m], by the names in `kinds.WATER`."""

KEYS = ("spectrum", "measured", "spreading", "direction")
INDEX = Count("", -(10**6), 10**6)
MAX_NESTED = 8  # models within models


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
        key: the full name of the table, for messages.
        table: as in the job file.
        depth, tension: of the sea's water [m], [N/m].
        folder: that from which the names of measured files start.
        measured: the table's measurement, where it has been realised already.

    Raises:
        JobError: an unknown key, or a value that breaks its rule.
        ReaderError: a measured file that cannot be read.
    """
    for name in table:
        if name not in KEYS:
            raise JobError(unknown_key(f"{key}.{name}", [f"{key}.{n}" for n in KEYS]))
    if ("spectrum" in table) == ("measured" in table):
        raise JobError(
            f"{key}.spectrum must be given, such as {{ kind = 'jonswap', hs = 1.5, tp = 14.0 }}, "
            f"or {key}.measured, such as {{ file = 'buoy.data_spec' }}, and not both"
        )
    water = {"depth": depth, "surface_tension": tension}
    try:
        if "measured" in table:
            return (measured or measurement(key, table, folder)).sea.systems
        direction = DIRECTION.check(f"{key}.direction", table.get("direction", 0.0))
        spreading = _spreading(key, table.get("spreading", {"kind": "blend"}), water)
        spectrum = _made(f"{key}.spectrum", table["spectrum"], SPECTRA, water)
        if spectrum is None:
            return ()
        return (WaveSystem(spectrum=spectrum, spreading=spreading, direction=direction),)
    except JobError:
        raise
    except ParameterError as error:
        if error.exit_code != JobError.exit_code:
            raise  # the message of a measured file names it already
        raise JobError(str(error)) from None


def measurement(key: str, table: Mapping[str, Any], folder: Path) -> "Realised":
    """
    Realise the measured spectrum of one table; one without directions takes the table's.

    Args:
        key: the full name of the table, for messages.
        table: as in the job file, with `measured`.
        folder: that from which the names of measured files start.

    Raises:
        JobError: a key or value that the table may not have, or that its file does not have.
        ReaderError: a file that cannot be read; the message names the key and the file.
    """
    from fftocean import readers

    source = table["measured"]
    if (
        not isinstance(source, dict)
        or not {"file"} <= set(source) <= {"file", "time", "site", "tail"}
        or not isinstance(source["file"], str)
    ):
        raise JobError(
            f"{key}.measured must be a table with a file, and perhaps time and site counted "
            f"from 0, and the exponent of a tail, got {source!r:.80}"
        )
    site = INDEX.check(f"{key}.measured.site", source.get("site", 0))
    when = source.get("time", 0)
    dated = isinstance(when, (str, datetime.date))
    if not dated:
        INDEX.check(f"{key}.measured.time", when)
    try:
        tail = source.get("tail")
        tail = None if tail is None else TAIL.check(f"{key}.measured.tail", tail)
    except ParameterError as error:
        raise JobError(str(error)) from None
    direction, spreading = None, None
    if "direction" in table:
        direction = DIRECTION.check(f"{key}.direction", table["direction"])
    if "spreading" in table:
        # The depth is not known before the file is read; the sea refuses a spreading of another.
        deep = {"depth": math.inf, "surface_tension": 0.0}
        spreading = _spreading(key, table["spreading"], deep)
    where = f"{key}.measured, file {source['file']!r:.80}"
    try:
        if os.path.isdir(folder / source["file"]):  # noqa: PTH112  false for impossible names
            raise ReaderError("must be a file, got a directory")
        dataset = readers.open(folder / source["file"], site=site)
        time = readers.nearest_time(dataset, str(when)) if dated else int(when)
        if "efth" not in dataset and (direction is None or spreading is None):
            raise JobError(
                "the file has no directions; beside `measured` a job must have direction [degrees, "
                "toward, counter-clockwise from +x] and spreading, such as direction = 90.0 and "
                "spreading = { kind = 'blend' }; without a job file, --toward"
            )
        return readers.Realised.from_spectrum(
            dataset,
            time=time,
            depth=math.inf,
            direction=direction,
            spreading=spreading,
            tail=tail,
        )
    except ReaderError as error:
        raise ReaderError(f"{where}: {_without_name(error, source['file'])}") from None
    except ParameterError as error:
        raise JobError(f"{where}: {_without_name(error, source['file'])}") from None


def _without_name(error: Exception, file: str) -> str:
    """Return a message without the name of its file at the beginning."""
    text = str(error)
    for name in (file, os.path.basename(file)):  # noqa: PTH119  for impossible names too
        for end in (": ", ", ", " "):
            if name and text.startswith(name + end):
                return text[len(name + end) :]
    return text


def _spreading(key: str, table: Any, water: Water) -> Spreading:
    """Make the spreading of the wave system `key`."""
    return _made(f"{key}.spreading", table, SPREADINGS, water)


def _made(key: str, table: Any, kinds: Registry[M], water: Water, nested: int = 0) -> M:
    """Make the model that a table names by its `kind`, in the first way that its keys fit."""
    name = table.get("kind") if isinstance(table, dict) else table
    name = spelled(name, kinds) or name if isinstance(name, str) else name
    if not isinstance(table, dict) or not isinstance(name, str) or name not in kinds:
        raise JobError(
            f"{key} must be a table whose kind is one of {', '.join(kinds)}, got {name!r:.60}"
        )
    if nested > MAX_NESTED:
        raise JobError(f"{key} must have at most {MAX_NESTED} models within one another, got more")
    values = {k: v for k, v in table.items() if k != "kind"}
    ways = kinds[name].ways
    way = next((way for way in ways if way.fits(set(values))), None)
    if way is None:
        raise JobError(
            f"{key} of kind {name!r} must have the keys {' or '.join(map(str, ways))}, "
            f"got {{{', '.join(map(str, values))}}}"
        )
    checked: dict[str, Any] = {}
    for k, value in values.items():
        rule = way.keys[k]
        if isinstance(rule, Part):
            inner: Registry[Any] = _BY_ROLE[rule.role]
            value = _made(f"{key}.{k}", value, inner, water, nested + 1)
            if value is None:
                raise JobError(f"{key}.{k} must have waves, got a calm")
        checked[k] = rule.check(f"{key}.{k}", value)
    try:
        return way.make(**checked, **{k: water[k] for k in way.water})
    except ParameterError as error:
        raise JobError(f"{key}: {error}") from None


_BY_ROLE: dict[str, Registry[Any]] = {kinds.role: kinds for kinds in (SPECTRA, SPREADINGS)}


def winds_of(table: Any) -> Iterator[float]:
    """Yield the winds that the table of a spectrum names [m/s]: by speed, or by a number."""
    if not isinstance(table, dict):
        return
    numbered = {"beaufort": presets.beaufort, "sea-state": presets.sea_state}
    preset = numbered.get(spelled(str(table.get("kind")), numbered) or "")
    if preset is not None and isinstance(table.get("number"), int):
        yield preset(table["number"]).wind
    elif isinstance(table.get("speed"), (int, float)):
        yield float(table["speed"])
    yield from winds_of(table.get("spectrum"))


def unknown_key(key: str, known: Iterable[str]) -> str:
    """Return the message about an unknown key, with the key that may have been meant."""
    close = difflib.get_close_matches(key, list(known), n=1, cutoff=0.5)
    hint = f"; did you mean {close[0]}?" if close else f"; known are {', '.join(known)}"
    return f"unknown key {key!r:.80}{hint}"
