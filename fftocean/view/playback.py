"""
Frames of a bake for the live page, in the layout of the maps that its renderer samples.

Whatever a bake does not have is derived from what it has: horizontal displacement from height,
slopes and stretches from displacements. On a periodic tile without waves at the Nyquist frequency
that is exact for the pixels as they are stored; what they were rounded by is differentiated too,
except beyond the band of the tile, where there is no wave.
"""

import functools
import json
import math
import struct
import threading
import warnings
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import fftocean
from fftocean.arrays import Complex, Real
from fftocean.baking.finished.contents import Contents
from fftocean.baking.finished.load import read_frames
from fftocean.baking.finished.manifest import read_manifest
from fftocean.baking.folder import layout, listing
from fftocean.cascade import Cascade, from_oceans
from fftocean.constants import GRAVITY
from fftocean.errors import FFTOceanError, IntegrityError, JobError, ParameterError, SeaWarning
from fftocean.fields import potential_factor
from fftocean.files import path_of
from fftocean.foam_coverage import threshold_for
from fftocean.frame import Frame
from fftocean.grid import Grid
from fftocean.limits import Count
from fftocean.ocean import Ocean
from fftocean.runtime.folder import is_package
from fftocean.slope_variance import FLOOR, slope_variance

FORMAT, VERSION = "fftocean-playback", 1
MAGIC = b"FFTB"
TICKS = 2**20
MEMORY = 256 * 2**20
"""Bytes of frames that a playback keeps."""

_ALIGNMENT = 16
_HEAD = struct.Struct("<4sIII")
_RUN = 8  # frames that are read at a time from a container, which is read as a whole
_SAMPLED = 4  # frames whose slopes are measured
_BYTES = Count("bytes", 0, 2**50)

FIELDS = ("height", "displace_x", "displace_y", "slope_x", "slope_y")
STRETCHES = ("stretch_xx", "stretch_xy", "stretch_yy")
_CHANNELS = {
    "height": ("height",),
    "displacement": ("displace_x", "displace_y", "height"),
    "derivative": ("slope_x", "slope_y", "stretch_xx", "stretch_yy"),
    "stretch": STRETCHES,
}
"""Maps that are read, the preferred one of two last, with the fields in their channels."""


@dataclass(frozen=True, slots=True)
class _Tile:
    """One tile of a bake, and the origin of each of its fields."""

    contents: Contents
    grid: Grid
    depth: float  # [m]
    choppiness: float  # in the maps already
    band: tuple[float, float]  # of |k| [rad/m]
    maps: tuple[str, ...]  # that are read
    origin: Mapping[str, str]  # of each field: a map, or the fields that it is derived from


class Playback:
    """
    The frames of a bake, or of the tiles of a baked cascade, ready for the page.

    Threads can share a playback. At most `memory` bytes of frames are kept, those used last; and
    one frame of each tile, at least.
    """

    def __init__(
        self, folder: Path, tiles: Sequence[_Tile], whole: Mapping[str, Any], memory: int
    ) -> None:
        self.folder, self._tiles = folder, tuple(tiles)
        self._whole = whole  # manifest of the tile, or list of the tiles
        self._memory, self._held = memory, 0
        self._frames: OrderedDict[tuple[int, int], bytes] = OrderedDict()
        self._lock = threading.Lock()

    def __len__(self) -> int:
        """Return the number of frames."""
        return len(self._tiles[0].contents.frames)

    def manifest(self) -> dict[str, Any]:
        """
        Return the document that the page is given in place of a sea's, ready for JSON.

        Raises:
            IntegrityError: one of the frames whose slopes are measured is damaged.
        """
        first, wind = self._tiles[0], self._wind
        manifest = first.contents.manifest
        roughness, foam = self._roughness(), self._foam()
        times = [row["t"] for row in manifest["frames"]]
        return {
            "format": FORMAT,
            "version": VERSION,
            "tool": f"fftocean {fftocean.__version__}",
            "quality": "baked",
            "source": self.folder.name,
            "file_format": first.contents.form.name,
            "loop": _duration(first.contents),
            "ticks": TICKS,
            "frames": len(self),
            "times": times,
            "choppiness": first.choppiness,
            "depth": first.depth if math.isfinite(first.depth) else None,
            "gravity": GRAVITY,
            "statistics": self._statistics(),
            "slope_variance": roughness,
            "foam": {
                "decay": foam["tau"],
                "threshold": foam["threshold"],
                "strength": foam["strength"],
            },
            "wind": None if wind is None else {"speed": wind[0], "direction": wind[1]},
            "bounds": self._bounds(),
            "spectrum": None,
            "tiles": [
                {
                    "n": [tile.grid.nx, tile.grid.ny],
                    "size": [tile.grid.lx, tile.grid.ly],
                    "band": [tile.band[0], tile.band[1] if math.isfinite(tile.band[1]) else None],
                    "seed": tile.contents.job.settings["ocean.seed"],
                    "fields": dict(tile.origin),
                }
                for tile in self._tiles
            ],
        }

    def frame(self, tile: int, frame: int) -> bytes:
        """
        Return one frame of a tile as the message of the page.

        "FFTB", then three unsigned integers of 32 bits, little-endian: the version 1, the length H
        of the header, and 0; then H bytes of JSON {tile, frame, nx, ny, lx, ly}, padded with spaces
        to a multiple of 16; then three maps of float16, (ny, nx, 4), row 0 south, each padded with
        zeros to a multiple of 16: (c dx, c dy, h, c dxy), (sx, sy, c dxx, c dyy) and (sx^2, sy^2,
        sx sy, 0), where c is the choppiness of the bake.

        Args:
            tile: number of the tile, the largest first.
            frame: number of the frame in the order of the bake; any whole number, as the frames
                repeat.

        Raises:
            ParameterError: there is no such tile, or a number is not whole.
            IntegrityError: a file is missing or was changed; the message names it and the frame.
        """
        tile = Count("", 0, len(self._tiles) - 1).check("tile", tile)
        place = Count("", -(2**53), 2**53).check("frame", frame) % len(self)
        with self._lock:
            data = self._frames.get((tile, place))
            if data is None:
                data = self._read(tile, place)
            else:
                self._frames.move_to_end((tile, place))
        return data

    def fields(self, frame: int) -> list[Frame]:
        """Return the eight fields of every tile at a frame of the bake, choppiness applied."""
        place = frame % len(self)
        found = []
        for tile in self._tiles:
            (arrays,) = _fields(tile, [place])
            t = tile.contents.manifest["frames"][place]["t"]
            found.append(Frame(t, tile.grid, 1.0, arrays))
        return found

    def _read(self, number: int, place: int) -> bytes:
        """Return a frame from the files, and keep it and others that come with it."""
        tile = self._tiles[number]
        whole = tile.contents.form.scope == "sequence"  # the file is read whole for any frame
        places = [(place + i) % len(self) for i in range(min(_RUN, len(self)) if whole else 1)]
        try:
            read = _fields(tile, places)
        except IntegrityError:  # perhaps of another frame, which is named when it is asked for
            places = [place]
            read = _fields(tile, places)
        messages = [_message(tile, number, *pair) for pair in zip(places, read, strict=True)]
        for at, message in zip(reversed(places), reversed(messages), strict=True):
            self._keep((number, at), message)
        return messages[0]

    def _keep(self, key: tuple[int, int], message: bytes) -> None:
        """Keep a frame, and drop those that were used longest ago if there are too many."""
        self._held += len(message) - len(self._frames.pop(key, b""))
        self._frames[key] = message
        while self._held > self._memory and len(self._frames) > len(self._tiles):
            _, dropped = self._frames.popitem(last=False)
            self._held -= len(dropped)

    @functools.cached_property
    def _water(self) -> Ocean | Cascade | None:
        """The water that was baked; None if a measured file of its job is gone."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SeaWarning)  # told when it was baked
            try:
                oceans = tuple(tile.contents.job.ocean(backend="auto") for tile in self._tiles)
            except FFTOceanError:
                return None
        first = oceans[0]
        if len(oceans) == 1 or first.sea is None:
            return first
        return from_oceans(first.sea, first.seed or 0, oceans)

    @property
    def _wind(self) -> tuple[float, float] | None:
        """Speed [m/s] and direction [degrees] of the wind of the job."""
        job = self._tiles[0].contents.job
        if not job.wind:
            return None
        return job.settings["sea.wind.speed"], job.settings["sea.wind.direction"]

    def _roughness(self) -> dict[str, list[float]]:
        """Return the slope variance of the tiles, of the whole sea, and beyond the tiles."""
        wind, water = self._wind, self._water
        if water is None:
            captured = self._measured_slopes()
            beyond = [FLOOR, FLOOR, 0.0]
            total = [a + b for a, b in zip(captured, beyond, strict=True)]
            return {"captured": captured, "total": total, "beyond": beyond}
        found = slope_variance(
            water,
            wind_speed=None if wind is None else wind[0],
            wind_direction=0.0 if wind is None else wind[1],
        )
        return {name: list(getattr(found, name)) for name in ("captured", "total", "beyond")}

    def _foam(self) -> dict[str, float]:
        """
        Return the parameters of foam: those of a job that bakes foam, else such that it covers what
        whitecaps do at the job's wind.
        """
        job = self._tiles[0].contents.job
        foam = dict(job.foam)
        wind, water = self._wind, self._water
        fixed = "foam" in job.maps and not job.foam_follows_wind
        if wind is not None and water is not None and not fixed:
            foam["threshold"] = threshold_for(
                water, wind[0], tau=foam["tau"], strength=foam["strength"]
            )
        return foam

    def _measured_slopes(self) -> list[float]:
        """Return the covariance of the slopes of all tiles, [xx, yy, xy], over some frames."""
        total = np.zeros(3)
        step = max(1, len(self) // _SAMPLED)
        for tile in self._tiles:
            some = _fields(tile, range(0, len(self), step))
            for fields in some:
                sx, sy = fields["slope_x"], fields["slope_y"]
                total += [float(np.mean(one)) / len(some) for one in (sx * sx, sy * sy, sx * sy)]
        return [float(value) for value in total]

    def _statistics(self) -> dict[str, Any]:
        """Return specified and realised state of the sea, of all tiles together."""
        realised = self._whole["statistics"]
        specified = realised.get("ordered")
        return {"specified": specified and _state(specified), "realised": _state(realised)}

    def _bounds(self) -> dict[str, Any]:
        """Return the largest displacements [m], summed over tiles, and the least Jacobian."""
        extremes = self._whole["extremes"]
        return {
            "height": extremes["max_height"],
            "displacement": extremes["max_horizontal"],
            "jacobian": extremes["min_jacobian"],
        }


def open_bake(folder: str | Path, *, memory: int = MEMORY) -> Playback:
    """
    Open a finished bake, or the folder around the tiles of a baked cascade, for the page.

    Args:
        folder: of the bake, in any format and for any engine.
        memory: bytes of frames to keep.

    Raises:
        OutputError: a file exists and cannot be read.
        IntegrityError: the bake is not finished, or its manifest was changed.
        JobError: the bake is one of height fields by world position, or has neither height nor
            displacement; or the folder is that of a run-time package.
    """
    folder = path_of("folder", folder)
    memory = _BYTES.check("memory", memory)
    if is_package(folder):
        raise JobError(
            f"{folder} is a run-time package, which has waves and no frames to play; "
            "`fftocean check` checks it, `fftocean.load_sea` loads it, and `fftocean view` shows "
            "the job from which it was exported"
        )
    if not layout.is_cascade(folder):
        tile = _tile(folder)
        return Playback(folder, [tile], tile.contents.manifest, memory)
    listed = listing.read_listing(folder)
    tiles = [_tile(path) for path in listing.listed_tiles(folder, listed)]
    return Playback(folder, tiles, listed, memory)


def _tile(folder: Path) -> _Tile:
    """Return one tile of a bake, from its manifest."""
    contents = Contents.of(folder, read_manifest(folder))
    job, ocean = contents.job, contents.manifest["ocean"]
    if job.lookup != "lagrangian":
        raise JobError(
            f"{folder} cannot be played: its maps are {job.lookup}, by world position, and the "
            "page moves the water from its rest position; bake with lookup = 'lagrangian'"
        )
    if not {"height", "displacement"} & set(job.maps):
        raise JobError(
            f"{folder} cannot be played without a height or displacement map; "
            f"it has {', '.join(job.maps)}"
        )
    try:
        depth, choppiness = float(ocean["depth"]), float(ocean["choppiness"])
        grid = Grid(*map(int, ocean["n"]), *map(float, ocean["size"]))
    except (KeyError, TypeError, ValueError, ParameterError) as error:
        raise IntegrityError(
            f"{folder / layout.MANIFEST_FILE} does not describe a tile: {error}"
        ) from None
    origin = _origins(job.maps)
    maps = tuple(name for name in _CHANNELS if name in origin.values())
    low, high = job.settings["ocean.band_low"], job.settings["ocean.band_high"]
    return _Tile(contents, grid, depth, choppiness, (low, high), maps, origin)


def _origins(maps: Sequence[str]) -> dict[str, str]:
    """Return the map that holds each field, or the field that it is derived from."""
    derived = "height" if "displacement" not in maps else "displacement"
    origin = dict.fromkeys(("displace_x", "displace_y"), "derived from height")
    origin |= dict.fromkeys(("slope_x", "slope_y"), "derived from height")
    origin |= dict.fromkeys(STRETCHES, f"derived from {derived}")
    for name, fields in _CHANNELS.items():
        if name in maps:
            origin |= dict.fromkeys(fields, name)
    return origin


def _fields(tile: _Tile, places: Sequence[int]) -> list[dict[str, Real]]:
    """Return the eight fields of some frames, choppiness applied, (ny, nx) each."""
    found: list[dict[str, Real]] = [{} for _ in places]
    for name in tile.maps:
        for fields, pixels in zip(found, read_frames(tile.contents, name, places), strict=True):
            for channel, field in enumerate(_CHANNELS[name]):
                if tile.origin[field] == name:
                    fields[field] = pixels[..., channel]
    for fields in found:
        _derive(tile, fields)
    return found


def _derive(tile: _Tile, fields: dict[str, Real]) -> None:
    """Add the fields that were not baked."""
    missing = [name for name in (*FIELDS, *STRETCHES) if name not in fields]
    if not missing:
        return
    kx, ky, k, wave = _wavenumbers(tile)
    height = np.where(wave, np.fft.rfft2(fields["height"]), 0.0)
    shift: dict[str, Complex] = {}
    for name, along in (("displace_x", kx), ("displace_y", ky)):
        if name in fields:
            shift[name] = np.where(wave, np.fft.rfft2(fields[name]), 0.0)
        else:
            factor = tile.choppiness * potential_factor(k, tile.depth)
            shift[name] = 1j * along * factor * height
    gradients = {
        "slope_x": (height, kx),
        "slope_y": (height, ky),
        "stretch_xx": (shift["displace_x"], kx),
        "stretch_yy": (shift["displace_y"], ky),
    }
    shape = tile.grid.shape
    for name in missing:
        if name in shift:
            whole = shift[name]
        elif name == "stretch_xy":  # both are the same field, and their mean is less noisy
            whole = 0.5j * (ky * shift["displace_x"] + kx * shift["displace_y"])
        else:
            amplitudes, along = gradients[name]
            whole = 1j * along * amplitudes
        fields[name] = np.fft.irfft2(whole, s=shape)


def _wavenumbers(tile: _Tile) -> tuple[Real, Real, Real, Any]:
    """
    Return kx, ky and |k| of the half plane [rad/m], and True where the tile can have waves.

    There are none at k = 0, in the Nyquist row and column, and outside the band of the tile by more
    than half a cell.
    """
    grid = tile.grid
    mx = np.arange(grid.nx // 2 + 1.0)
    my = np.fft.fftfreq(grid.ny, 1.0 / grid.ny)[:, None]
    kx, ky = mx * grid.dkx, my * grid.dky
    k = np.hypot(kx, ky)
    margin = 0.5 * math.hypot(grid.dkx, grid.dky)
    low, high = tile.band
    wave = (k >= low - margin) & (k <= high + margin) & (k > 0.0)
    wave &= (2.0 * mx < grid.nx) & (2.0 * np.abs(my) < grid.ny)
    return kx, ky, k, wave


def _message(tile: _Tile, number: int, place: int, fields: Mapping[str, Real]) -> bytes:
    """Return the bytes of a frame; see `Playback.frame`."""
    grid = tile.grid
    header = json.dumps(
        {
            "tile": number,
            "frame": place,
            "nx": grid.nx,
            "ny": grid.ny,
            "lx": grid.lx,
            "ly": grid.ly,
        },
        separators=(",", ":"),
    ).encode()
    header += b" " * (-len(header) % _ALIGNMENT)
    sx, sy = fields["slope_x"], fields["slope_y"]
    maps = (
        (fields["displace_x"], fields["displace_y"], fields["height"], fields["stretch_xy"]),
        (sx, sy, fields["stretch_xx"], fields["stretch_yy"]),
        (sx * sx, sy * sy, sx * sy, np.zeros(grid.shape)),
    )
    parts = [_HEAD.pack(MAGIC, VERSION, len(header), 0), header]
    for channels in maps:
        with np.errstate(over="ignore"):
            texels = np.stack(channels, axis=-1).astype("<f2")
        if not np.all(np.isfinite(texels)):
            raise IntegrityError(
                f"{tile.contents.folder}, frame {tile.contents.frames[place]}: a value is beyond "
                "65504, the largest that the page can show"
            )
        data = texels.tobytes()
        parts += [data, bytes(-len(data) % _ALIGNMENT)]
    return b"".join(parts)


def _duration(contents: Contents) -> float:
    """Return the time in which the baked frames play through [s]."""
    loop: float = contents.manifest["ocean"]["loop"]
    frames, count = contents.frames, contents.job.frames
    if len(frames) == count:
        return loop
    step = frames[1] - frames[0] if len(frames) > 1 else 1
    return loop * step * len(frames) / count


def _state(numbers: Mapping[str, Any]) -> dict[str, Any]:
    """Return significant wave height [m], peak period [s] and direction [degrees]."""
    return {
        "hs": numbers["hs"],
        "tp": numbers["tp"],
        "direction": numbers["mean_direction"],
    }
