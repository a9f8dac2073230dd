"""
Whether a bake is still what was written, and whether what was written is water: every fault by its
name and the frame it is in.
"""

import functools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from fftocean.arrays import Real
from fftocean.baking.finished.containers import INSEPARABLE, still_says
from fftocean.baking.finished.contents import Contents
from fftocean.baking.finished.manifest import read_manifest
from fftocean.baking.folder import layout, listing
from fftocean.baking.folder.identity import HEADER, read_checked
from fftocean.baking.folder.lock import require_free
from fftocean.baking.scene.maps import MAPS
from fftocean.errors import IntegrityError, OutputError
from fftocean.files import digest, path_of, read_whole

Kind = Literal[
    "unfinished",
    "manifest",
    "job",
    "missing",
    "cut",
    "swapped",
    "changed",
    "extra",
    "values",
    "range",
    "normal",
    "seam",
    "loop",
    "crest",
]
"""
unfinished: there is no manifest.  manifest, job: those files were changed, or contradict
themselves. missing, cut, swapped, changed: a file or a frame of it is not there; is shorter; holds
another frame; has other bytes. extra: a file that would be taken for a frame.  values: what is no
number, or cannot be decoded.  range: values beyond those promised. normal: normals that are not of
length 1.  seam, loop: a step across the tile's edge, from the last frame to the first. crest:
troughs that are sharper than crests.
"""

ROUGHER = 2.0
"""
How many times the roughest step inside a step across an edge may be. The sea is as rough there as
anywhere: of any two steps of a sea, all frames together, the roughest was at most 1.6 times the
second (60 seas of 10 to 32 samples a side).
"""

FEWEST = 8  # steps inside, before there is anything to compare with


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong."""

    kind: Kind
    path: str  # in the folder
    detail: str
    map: str | None = None
    frame: int | None = None  # of the loop

    def __str__(self) -> str:
        return f"{self.kind}: {self.path}{f', frame {self.frame}' if self.frame is not None else ''}: {self.detail}"


def check(
    folder: str | Path, *, progress: Callable[[int, int], None] | None = None
) -> tuple[Finding, ...]:
    """
    Check a bake: whether every file is there and is what was written, and whether that is a sea.

    Of a cascade every tile is checked so, and that the tiles belong together.

    Args:
        folder: that `bake` wrote, or the folder around the tiles of a cascade.
        progress: called with (maps of frames looked at, all of them).

    Returns:
        What is wrong; nothing, if all is well.

    Raises:
        FolderInUseError: a bake is under way there.
        OutputError: a file is there and cannot be read.
    """
    folder = path_of("folder", folder)
    require_free(folder)
    if not folder.is_dir():
        raise OutputError(
            f"{folder} must be the folder of a bake, and is {'no folder' if folder.exists() else 'not there'}"
        )
    return _cascade(folder, progress) if layout.is_cascade(folder) else _bake(folder, progress)


def _bake(folder: Path, progress: Callable[[int, int], None] | None) -> tuple[Finding, ...]:
    """Check the bake of one tile."""
    try:
        contents = Contents.of(folder, read_manifest(folder))
    except IntegrityError as error:
        return (*_without_manifest(folder, str(error)),)
    found = [*_job(folder, contents), *_beside(contents)]
    total = len(contents.job.maps) * len(contents.frames)
    for i, name in enumerate(contents.job.maps):
        done = i * len(contents.frames)
        found += _map(
            contents, name, functools.partial(_tell, progress, done, total) if progress else None
        )
    return (*found, *_extra(contents))


def _cascade(folder: Path, progress: Callable[[int, int], None] | None) -> tuple[Finding, ...]:
    """
    Check the bake of a cascade: its job and list, each of its tiles, and that they belong together.
    """
    found: list[Finding] = []
    header: dict[str, Any] | None = None
    listed: dict[str, Any] | None = None
    try:
        header = read_checked(folder / layout.CASCADE_JOB)
    except IntegrityError as error:
        there = (folder / layout.CASCADE_JOB).is_file()
        found.append(Finding("job" if there else "missing", layout.CASCADE_JOB, str(error)))
    try:
        listed = read_checked(folder / layout.CASCADE_FILE)
    except IntegrityError as error:
        if (folder / layout.CASCADE_FILE).is_file():
            found.append(Finding("manifest", layout.CASCADE_FILE, str(error)))
        else:
            why = "it is not there: the bake was stopped, and the same command goes on with it"
            found.append(Finding("unfinished", layout.CASCADE_FILE, why))
    names = layout.tile_folders(folder)
    known = {} if listed is None else {row["path"]: row for row in listed["tiles"]}
    for name in known:
        if name not in names:
            found.append(
                Finding(
                    "missing",
                    f"{name}/{layout.MANIFEST_FILE}",
                    f"it is in the list of {layout.CASCADE_FILE}",
                )
            )
    for index, name in enumerate(names):
        if listed is not None and name not in known:
            found.append(
                Finding(
                    "extra",
                    name,
                    f"it would be taken for a tile, and is not in {layout.CASCADE_FILE}",
                )
            )
            continue
        tell = functools.partial(_share, progress, index, len(names)) if progress else None
        require_free(folder / name)
        found += [
            replace(finding, path=f"{name}/{finding.path}")
            for finding in _bake(folder / name, tell)
        ]
    if listed is not None:
        reference = {key: listed.get(key) for key in listing.HEADER} if header is None else header
        found += [
            Finding("manifest", path, detail)
            for path, detail in listing.faults(folder, reference, listed)
        ]
        for key in layout.DRAWN:
            if key in listed and (
                fault := _fault(read_whole(folder / listed[key]["path"]), listed[key], {})
            ):
                found.append(Finding(fault[0], listed[key]["path"], fault[1]))
    drawn = (
        {listed[key]["path"] for key in layout.DRAWN if key in listed}
        if listed
        else set(layout.PICTURES)
    )
    for path in layout.leftovers(folder):
        if (relative := path.relative_to(folder).as_posix()) not in drawn:
            found.append(
                Finding(
                    "extra",
                    relative,
                    f"it would be taken for a file of this bake, and is not in {layout.CASCADE_FILE}",
                )
            )
    for path in sorted(folder.glob(".*.[0-9]*.tmp")):
        found.append(Finding("extra", path.name, "somebody was stopped while writing it"))
    return tuple(found)


def _share(
    progress: Callable[[int, int], None], index: int, tiles: int, done: int, total: int
) -> None:
    """Tell how far all tiles are, each taken for as long as this one."""
    progress(index * total + done, tiles * total)


def _tell(progress: Callable[[int, int], None], before: int, total: int, done: int) -> None:
    progress(before + done, total)


def _without_manifest(folder: Path, why: str) -> Iterator[Finding]:
    """All that can be said of a folder whose manifest is no help."""
    if (folder / layout.MANIFEST_FILE).is_file():
        yield Finding("manifest", layout.MANIFEST_FILE, why)
    elif (folder / layout.JOB_FILE).is_file():
        yield Finding(
            "unfinished",
            layout.MANIFEST_FILE,
            "it is not there: the bake was stopped, and the same command goes on with it",
        )
    else:
        yield Finding(
            "unfinished",
            layout.MANIFEST_FILE,
            f"neither it nor {layout.JOB_FILE} is there: this is no bake",
        )
    if (folder / layout.JOB_FILE).is_file():
        try:
            read_checked(folder / layout.JOB_FILE)
        except (IntegrityError, OutputError) as error:
            yield Finding("job", layout.JOB_FILE, str(error))


def _job(folder: Path, contents: Contents) -> Iterator[Finding]:
    """Whether the job's own file is there and is that of the manifest."""
    try:
        job = read_checked(folder / layout.JOB_FILE)
    except (IntegrityError, OutputError) as error:
        there = (folder / layout.JOB_FILE).is_file()
        yield Finding("job" if there else "missing", layout.JOB_FILE, str(error))
        return
    if job != {key: contents.manifest.get(key) for key in HEADER}:
        yield Finding("job", layout.JOB_FILE, "it is not the job of the manifest")


def _beside(contents: Contents) -> Iterator[Finding]:
    """
    Pictures, and what stands beside the frames; containers too, where no frame of theirs tells.
    """
    pictures = [contents.manifest[key] for key in layout.DRAWN if key in contents.manifest]
    containers = (
        {layout.container(contents.form, name) for name in contents.job.maps}
        if contents.form.scope == "sequence"
        else set()
    )
    beside = [
        entry for entries in contents.manifest.get("containers", {}).values() for entry in entries
    ]
    for entry in [*pictures, *beside]:
        path = entry["path"]
        ours = path in layout.PICTURES or any(
            path.startswith((f"{name}.", f"{name}/")) for name in contents.job.maps
        )
        if not ours or ".." in path.split("/"):
            yield Finding(
                "manifest",
                layout.MANIFEST_FILE,
                f"it lists {path!r:.80}, which is no file of a bake",
            )
        elif path not in containers:
            data = contents.read(path)
            fault = _fault(data, entry, {})
            if fault and not (data and still_says(contents, path, data)):
                yield Finding(fault[0], path, fault[1])


def _fault(
    data: bytes | None, entry: Mapping[str, Any], known: Mapping[str, str]
) -> tuple[Kind, str] | None:
    """
    What is wrong with some bytes, by size and checksum; `known` says whose checksums there are.
    """
    if data is None:
        return "missing", "it is not there"
    if (sha256 := digest(data)) == entry["sha256"]:
        return None
    if sha256 in known:
        return "swapped", f"it holds {known[sha256]}"
    if len(data) < entry["bytes"]:
        return "cut", f"it has {len(data)} of {entry['bytes']} bytes"
    if len(data) > entry["bytes"]:
        return (
            "changed",
            f"it has {len(data)} bytes, {len(data) - entry['bytes']} more than were written",
        )
    return "changed", "its bytes are not those that were written"


@dataclass(slots=True)
class _Water:
    """What is gathered of a map, frame by frame, to say at the end whether it is water."""

    steps: list[float] = field(default_factory=list)  # from each frame to the next
    first: Real | None = None
    last: Real | None = None
    unbroken: bool = True
    inside: list[Real | float] = field(
        default_factory=lambda: [0.0, 0.0]
    )  # along each axis: mean squares of the steps between samples
    across: list[float] = field(
        default_factory=lambda: [0.0, 0.0]
    )  # and of the one across the tile's edge
    sharpness: float = (
        0.0  # sum of height times how far the water is drawn apart: negative where crests are sharp
    )
    strength: float = 0.0  # what that could be at most


def _map(contents: Contents, name: str, progress: Callable[[int], None] | None) -> list[Finding]:
    """All that is wrong with a map."""
    found: list[Finding] = []
    places, water = range(len(contents.frames)), _Water()
    known = {
        contents.entry(other, place)["sha256"]: f"{other} of frame {contents.frames[place]}"
        for other in contents.job.maps
        for place in places
    }
    source = contents.data(name, places)
    if contents.form.scope == "sequence":
        found, parts = _container(contents, name)
        source = iter(parts)
    for place, data in zip(
        places, source, strict=False
    ):  # none of a container that cannot be taken apart
        entry, path, frame = (
            contents.entry(name, place),
            contents.path(name, place),
            contents.frames[place],
        )
        if fault := _fault(data, entry, known):
            found.append(Finding(fault[0], path, fault[1], name, frame))
            water.unbroken = False
        else:
            assert data is not None  # else it were missing
            found += [
                Finding(kind, path, detail, name, frame)
                for kind, detail in _frame(contents, name, place, data, water)
            ]
        if progress:
            progress(place + 1)
    return found + [
        Finding(kind, contents.path(name, 0), detail, name)
        for kind, detail in _sequence(contents, name, water)
    ]


def _container(contents: Contents, name: str) -> tuple[list[Finding], list[bytes]]:
    """
    What is wrong with a container as a whole, and its frames' parts, so far as they can be told
    apart.
    """
    path = layout.container(contents.form, name)
    entry = next((e for e in contents.manifest["containers"][name] if e["path"] == path), None)
    if entry is None:
        return [Finding("manifest", layout.MANIFEST_FILE, f"it does not list {path}", name)], []
    data = contents.read(path)
    fault = _fault(data, entry, {})
    if fault and contents.form.name in INSEPARABLE:
        return [Finding(fault[0], path, fault[1], name)], []
    try:
        parts = contents.parts(name, data)
    except IntegrityError as error:
        kind, detail = fault or ("values", str(error))
        return [Finding(kind, path, detail, name)], []
    told = any(
        digest(part) != contents.entry(name, place)["sha256"] for place, part in enumerate(parts)
    )
    return [
        Finding(fault[0], path, f"{fault[1]}, though those of its frames are", name)
    ] if fault and not told else [], parts


def _frame(
    contents: Contents, name: str, place: int, data: bytes, water: _Water
) -> Iterator[tuple[Kind, str]]:
    """What is wrong with a frame whose bytes are those that were written."""
    try:
        pixels = contents.pixels(name, data)
    except IntegrityError as error:
        water.unbroken = False
        yield "values", str(error)
        return
    half_step = _half_step(contents, name)
    for c, (low, high) in enumerate(contents.entry(name, place)["range"]):
        least, most = float(pixels[..., c].min()), float(pixels[..., c].max())
        if not (abs(least - low) <= half_step * 1.001 and abs(most - high) <= half_step * 1.001):
            yield (
                "range",
                f"channel {c} goes from {least:g} to {most:g}, and is listed with {low:g} to {high:g}",
            )
    values = contents.restored(name, pixels)
    if MAPS[name].kind == "normal":
        off = float(np.max(np.abs(np.linalg.norm(values.astype(np.float64), axis=-1) - 1.0)))
        if not off <= _length_error(contents):
            yield "normal", f"a normal's length is {off:.2g} off 1"
    for axis in (0, 1):
        water.inside[axis] += np.mean(
            np.square(np.diff(values, axis=axis), dtype=np.float64), axis=(1 - axis, 2)
        )
        water.across[axis] += _rms(np.take(values, 0, axis) - np.take(values, -1, axis)) ** 2
    if name == "displacement":
        _weigh_crests(values, contents, water)
    if water.first is None:
        water.first = values
    if water.last is not None:
        water.steps.append(_rms(values - water.last))
    water.last = values


def _sequence(contents: Contents, name: str, water: _Water) -> Iterator[tuple[Kind, str]]:
    """What is wrong with all frames of a map together."""
    frames, count = contents.frames, contents.job.frames
    step = frames[1] - frames[0] if len(frames) > 1 else count
    closes = water.unbroken and frames[0] + count - frames[-1] == step
    first, last = water.first, water.last
    if not closes or first is None or last is None:
        pass
    elif name == "foam":
        if contents.job.lookup == "lagrangian" and (
            fault := _foam_forgotten(last, first, step / count, contents)
        ):
            yield "loop", fault
    elif len(water.steps) >= FEWEST:
        home, roughest = _rms(first - last), max(water.steps)
        if home > ROUGHER * roughest + _half_step(contents, name):
            yield (
                "loop",
                f"the step from the last frame to the first is {home / max(roughest, 1e-300):.1f} times the largest before",
            )
    for axis, edge in ((0, "north"), (1, "east")):
        inside, across = np.atleast_1d(water.inside[axis]), water.across[axis]
        if (
            inside.size >= FEWEST
            and across
            > ROUGHER**2 * (roughest := float(inside.max())) + _half_step(contents, name) ** 2
        ):
            excess = np.sqrt(across / max(roughest, 1e-300))
            yield (
                "seam",
                f"the step across the {edge} edge is {excess:.1f} times the roughest inside",
            )
    if water.strength > 0.0 and water.sharpness > 0.0:
        yield (
            "crest",
            "the water is drawn together in the troughs and apart at the crests: an axis is mirrored",
        )


def _foam_forgotten(last: Real, first: Real, share: float, contents: Contents) -> str | None:
    """
    Foam comes at once, but goes no faster than it decays: what of the last frame's must be left in
    the first, and is not.
    """
    decay = np.exp(-share * contents.manifest["ocean"]["loop"] / contents.job.foam["tau"])
    left = (
        1.0 - (1.0 - np.clip(last.astype(np.float64), 0.0, 1.0)) ** decay
    )  # coverage is 1 - e^{-foam}
    lost = float(np.max(left - first))
    # a coverage that is rounded up to nearly 1 stands for any amount of foam
    return (
        f"foam of the last frame is gone in the first, up to {lost:.2g} of the water too much"
        if lost > 0.02
        else None
    )


def _rms(values: Real) -> float:
    return float(np.sqrt(np.mean(np.square(values, dtype=np.float64))))


def _half_step(contents: Contents, name: str) -> float:
    """Half a step of what is stored, at the largest value: what a value may have moved."""
    low, high = contents.range(name)
    if low is not None and high is not None:
        return 0.5 * (high - low) / 65535.0 + 1e-6 * max(
            abs(low), abs(high)
        )  # and what float32 makes of it
    largest = max(abs(value) for value in contents.manifest["maps"][name]["range"])
    return (
        float(
            np.spacing(np.float16(largest))
            if contents.form.stored == "float16"
            else np.spacing(np.float32(largest))
        )
        / 2.0
    )


def _length_error(contents: Contents) -> float:
    """
    How far three components rounded to what is stored can take a unit normal from length 1, and as
    far again for its own rounding.
    """
    step = {"float16": 2.0**-12, "float32": 2.0**-22, "uint16": 1.0 / 65535.0}[contents.form.stored]
    packed = contents.profile.normals == "packed"  # n = 2 c - 1 doubles what c was rounded by
    return (4.0 if packed else 2.0) * float(np.sqrt(3.0)) * step


def _weigh_crests(values: Real, contents: Contents, water: _Water) -> None:
    """Put a displacement map on the scales: crests are sharp where high water is drawn together."""
    v = values.astype(np.float64)
    lx, ly = contents.manifest["ocean"]["size"]
    along = (np.roll(v[..., 0], -1, 1) - np.roll(v[..., 0], 1, 1)) * (v.shape[1] / lx)
    up = (np.roll(v[..., 1], -1, 0) - np.roll(v[..., 1], 1, 0)) * (v.shape[0] / ly)
    apart = along + up
    water.sharpness += float(np.sum(v[..., 2] * apart))
    water.strength += float(np.sqrt(np.sum(v[..., 2] ** 2) * np.sum(apart**2)))


def _extra(contents: Contents) -> Iterator[Finding]:
    """Files that look like ours and are not in the manifest."""
    listed = {
        contents.path(name, place)
        for name in contents.job.maps
        for place in range(len(contents.frames))
    }
    listed |= {
        entry["path"]
        for entries in contents.manifest.get("containers", {}).values()
        for entry in entries
    }
    listed |= {contents.manifest[key]["path"] for key in layout.DRAWN if key in contents.manifest}
    for path in layout.leftovers(contents.folder):
        relative = path.relative_to(contents.folder).as_posix()
        if relative not in listed:
            yield Finding(
                "extra",
                relative,
                "it would be taken for a file of this bake, and is in no manifest",
            )
    for room in layout.rooms(contents.folder):
        for path in sorted(room.glob(".*.[0-9]*.tmp")):
            yield Finding(
                "extra",
                path.relative_to(contents.folder).as_posix(),
                "somebody was stopped while writing it",
            )
