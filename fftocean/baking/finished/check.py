"""
Check of a bake: unchanged files, and pixels that are a seamless, looping sea surface.

Each problem is named with its kind, its file and its frame.
"""

import functools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from fftocean.arrays import Real
from fftocean.baking.finished.containers import INSEPARABLE, has_written_lines
from fftocean.baking.finished.contents import Contents
from fftocean.baking.finished.manifest import read_manifest
from fftocean.baking.folder import engine_files, layout, listing
from fftocean.baking.folder.identity import HEADER
from fftocean.baking.folder.lock import require_free
from fftocean.baking.folder.sealed import read_sealed
from fftocean.baking.scene.maps import MAPS
from fftocean.errors import IntegrityError, OutputError
from fftocean.files import digest, path_of, read_whole, temporary_files

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
unfinished: the manifest does not exist. manifest, job: those files were changed, or contradict
themselves. missing, cut, swapped, changed: a file, or a frame in it, does not exist; is shorter;
holds another frame; has other bytes. extra: a file is named like one of the bake, and is not listed
in the manifest. values: NaN, or data that cannot be decoded. range: values beyond the listed range.
normal: normals whose length is not 1. seam, loop: a step across the tile's edge, or from the last
frame to the first. crest: troughs that are sharper than crests.
"""

LARGEST_STEP = 2.0
"""
Largest ratio of the step across an edge to the roughest step inside. The sea is as rough there as
anywhere: of any two steps of a sea, all frames together, the roughest was at most 1.6 times the
second (60 seas of 10 to 32 samples a side).
"""

UNFINISHED = "it does not exist: the bake was stopped; run the same command again to resume"

MIN_STEPS = 8  # steps inside that the step across an edge is compared with


@dataclass(frozen=True, slots=True)
class Finding:
    """
    One problem of a bake.

    Args:
        kind: kind of the problem.
        path: path in the folder.
        detail: the problem in words.
        map: map that the file belongs to.
        frame: frame of the loop.
    """

    kind: Kind
    path: str
    detail: str
    map: str | None = None
    frame: int | None = None

    def __str__(self) -> str:
        frame = "" if self.frame is None else f", frame {self.frame}"
        return f"{self.kind}: {self.path}{frame}: {self.detail}"


def check(
    folder: str | Path, *, progress: Callable[[int, int], None] | None = None
) -> tuple[Finding, ...]:
    """
    Check that the files of a bake are unchanged, and that their pixels are a sea surface.

    Of a cascade every tile is checked, and that the tiles belong together. The folder of a
    run-time package is checked too (see `runtime.check`).

    Args:
        folder: the folder of a bake, or the one around the tiles of a cascade.
        progress: called with (maps of frames checked, all of them).

    Returns:
        The problems found; () if there are none.

    Raises:
        FolderInUseError: another process bakes into the folder.
        OutputError: the folder does not exist, or a file exists and cannot be read.
    """
    folder = path_of("folder", folder)
    require_free(folder)
    if not folder.is_dir():
        reason = "is not a folder" if folder.exists() else "does not exist"
        raise OutputError(f"{folder} must be the folder of a bake, and {reason}")
    from fftocean.runtime.check import check_package, is_package

    if is_package(folder):
        return check_package(folder)
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
            contents, name, functools.partial(_report, progress, done, total) if progress else None
        )
    return (*found, *_extra(contents))


def _cascade(folder: Path, progress: Callable[[int, int], None] | None) -> tuple[Finding, ...]:
    """
    Check a baked cascade: its job and list, each of its tiles, and that they belong together.
    """
    found: list[Finding] = []
    header: dict[str, Any] | None = None
    listed: dict[str, Any] | None = None
    try:
        header = read_sealed(folder / layout.CASCADE_JOB)
    except IntegrityError as error:
        exists = (folder / layout.CASCADE_JOB).is_file()
        found.append(Finding("job" if exists else "missing", layout.CASCADE_JOB, str(error)))
    try:
        listed = read_sealed(folder / layout.CASCADE_FILE)
    except IntegrityError as error:
        if (folder / layout.CASCADE_FILE).is_file():
            found.append(Finding("manifest", layout.CASCADE_FILE, str(error)))
        else:
            found.append(Finding("unfinished", layout.CASCADE_FILE, UNFINISHED))
    names = layout.tile_folders(folder)
    known = {} if listed is None else {row["path"]: row for row in listed["tiles"]}
    for name in known:
        if name not in names:
            found.append(
                Finding(
                    "missing",
                    f"{name}/{layout.MANIFEST_FILE}",
                    f"it is listed in {layout.CASCADE_FILE} and does not exist",
                )
            )
    for index, name in enumerate(names):
        if listed is not None and name not in known:
            found.append(
                Finding(
                    "extra",
                    name,
                    f"a tile that is not listed in {layout.CASCADE_FILE}",
                )
            )
            continue
        report = functools.partial(_report_tile, progress, index, len(names)) if progress else None
        require_free(folder / name)
        found += [
            replace(finding, path=f"{name}/{finding.path}")
            for finding in _bake(folder / name, report)
        ]
    if listed is not None:
        reference = {key: listed.get(key) for key in listing.HEADER} if header is None else header
        found += [
            Finding("manifest", path, detail)
            for path, detail in listing.inconsistencies(folder, reference, listed)
        ]
        found += _player(folder, listed, layout.CASCADE_FILE)
        for key in layout.PREVIEWS:
            if key in listed and (
                fault := _fault(read_whole(folder / listed[key]["path"]), listed[key])
            ):
                found.append(Finding(fault[0], listed[key]["path"], fault[1]))
    previews = (
        {listed[key]["path"] for key in layout.PREVIEWS if key in listed}
        if listed
        else set(layout.PREVIEW_FILES)
    )
    there = (path.relative_to(folder).as_posix() for path in layout.bake_files(folder))
    for relative in sorted(path for path in there if path not in previews):
        found.append(
            Finding(
                "extra",
                relative,
                f"not listed in {layout.CASCADE_FILE}",
            )
        )
    for path in sorted(temporary_files(folder)):
        found.append(Finding("extra", path.name, "left-over temporary file"))
    return tuple(found)


def _report_tile(
    progress: Callable[[int, int], None], index: int, tiles: int, done: int, total: int
) -> None:
    """Report the progress of all tiles, taking each for as long as this one."""
    progress(index * total + done, tiles * total)


def _report(progress: Callable[[int, int], None], before: int, total: int, done: int) -> None:
    progress(before + done, total)


def _inside(folder: Path) -> str:
    """Return the names of bakes and run-time packages in a folder, in words; "" for none."""
    documents = (layout.MANIFEST_FILE, layout.CASCADE_FILE, "sea.json")
    found = [
        path.name
        for path in sorted(folder.iterdir())
        if any((path / name).is_file() for name in documents)
    ]
    return f"; check the folder in it: {', '.join(found[:4])}" if found else ""


def _without_manifest(folder: Path, why: str) -> Iterator[Finding]:
    """Yield the problems of a folder whose manifest is missing or damaged."""
    if (folder / layout.MANIFEST_FILE).is_file():
        yield Finding("manifest", layout.MANIFEST_FILE, why)
    elif (folder / layout.JOB_FILE).is_file():
        yield Finding(
            "unfinished",
            layout.MANIFEST_FILE,
            UNFINISHED,
        )
    else:
        yield Finding(
            "unfinished",
            layout.MANIFEST_FILE,
            f"neither it nor {layout.JOB_FILE} exists: this is no bake{_inside(folder)}",
        )
    if (folder / layout.JOB_FILE).is_file():
        try:
            read_sealed(folder / layout.JOB_FILE)
        except (IntegrityError, OutputError) as error:
            yield Finding("job", layout.JOB_FILE, str(error))


def _job(folder: Path, contents: Contents) -> Iterator[Finding]:
    """Yield a problem if the job's own file is missing, or is not that of the manifest."""
    try:
        job = read_sealed(folder / layout.JOB_FILE)
    except (IntegrityError, OutputError) as error:
        exists = (folder / layout.JOB_FILE).is_file()
        yield Finding("job" if exists else "missing", layout.JOB_FILE, str(error))
        return
    if job != {key: contents.manifest.get(key) for key in HEADER}:
        yield Finding("job", layout.JOB_FILE, "it is not the job of the manifest")


def _beside(contents: Contents) -> Iterator[Finding]:
    """
    Yield the problems of previews and sidecars, and of containers whose frames are not checked.
    """
    previews = [contents.manifest[key] for key in layout.PREVIEWS if key in contents.manifest]
    containers = (
        {layout.container(contents.form, name) for name in contents.job.maps}
        if contents.form.scope == "sequence"
        else set()
    )
    beside = [
        entry for entries in contents.manifest.get("containers", {}).values() for entry in entries
    ]
    yield from _player(contents.folder, contents.manifest, layout.MANIFEST_FILE)
    for entry in [*previews, *beside]:
        path = entry["path"]
        is_known = path in layout.PREVIEW_FILES or any(
            path.startswith((f"{name}.", f"{name}/")) for name in contents.job.maps
        )
        if not is_known or ".." in path.split("/"):
            yield Finding(
                "manifest",
                layout.MANIFEST_FILE,
                f"it lists {path!r:.80}, which is not named like a file of a bake",
            )
        elif path not in containers:
            data = contents.read(path)
            fault = _fault(data, entry)
            if fault and not (data and has_written_lines(contents, path, data)):
                yield Finding(fault[0], path, fault[1])


def _player(folder: Path, listed: Mapping[str, Any], document: str) -> Iterator[Finding]:
    """Yield the problems of the files that play a bake or a cascade in its engine."""
    entries, names = listed.get("engine_files", ()), engine_files.names_for(listed["job"])
    if tuple(entry["path"] for entry in entries) != names:
        detail = f"its engine_files are not those of its job: {', '.join(names) or 'none'}"
        yield Finding("manifest", document, detail)
        return
    for entry in entries:
        if fault := _fault(read_whole(folder / entry["path"]), entry):
            yield Finding(fault[0], entry["path"], fault[1])


def _fault(
    data: bytes | None, entry: Mapping[str, Any], known: Callable[[], Mapping[str, str]] = dict
) -> tuple[Kind, str] | None:
    """
    Return the problem of a file's bytes, by size and checksum, or None.

    `known` returns the names of frames by their checksums.
    """
    if data is None:
        return "missing", "it does not exist"
    if (sha256 := digest(data)) == entry["sha256"]:
        return None
    if sha256 in known():
        return "swapped", f"it holds {known()[sha256]}"
    if len(data) < entry["bytes"]:
        return "cut", f"it has {len(data)} of {entry['bytes']} bytes"
    if len(data) > entry["bytes"]:
        return (
            "changed",
            f"it has {len(data)} bytes, {len(data) - entry['bytes']} more than were written",
        )
    return "changed", "its bytes were changed after it was written"


@dataclass(slots=True)
class _Sequence:
    """Sums over the frames of a map, for the checks of the whole sequence."""

    steps: int = 0  # from one frame to the next: their number and the roughest
    roughest: float = 0.0
    first: Real | None = None
    last: Real | None = None
    unbroken: bool = True
    inside: list[Real | float] = field(
        default_factory=lambda: [0.0, 0.0]
    )  # along each axis: mean squares of the steps between samples
    across: list[float] = field(
        default_factory=lambda: [0.0, 0.0]
    )  # and of the one across the tile's edge
    sharpness: float = 0.0  # sum of height times divergence: negative where crests are sharp
    strength: float = 0.0  # its largest possible magnitude


def _map(contents: Contents, name: str, progress: Callable[[int], None] | None) -> list[Finding]:
    """Return the problems of a map."""
    found: list[Finding] = []
    places, sequence = range(len(contents.frames)), _Sequence()

    @functools.cache
    def known() -> dict[str, str]:  # read if there is a fault: it names every file of a bake
        return {
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
    ):  # none of a container whose frames cannot be separated
        entry, path, frame = (
            contents.entry(name, place),
            contents.path(name, place),
            contents.frames[place],
        )
        if fault := _fault(data, entry, known):
            found.append(Finding(fault[0], path, fault[1], name, frame))
            sequence.unbroken = False
        else:
            assert data is not None  # else it is missing
            found += [
                Finding(kind, path, detail, name, frame)
                for kind, detail in _frame(contents, name, place, data, sequence)
            ]
        if progress:
            progress(place + 1)
    return found + [
        Finding(kind, contents.path(name, 0), detail, name)
        for kind, detail in _whole(contents, name, sequence)
    ]


def _container(contents: Contents, name: str) -> tuple[list[Finding], list[bytes]]:
    """
    Return the problems of a container as a whole, and the parts of its frames if they can be
    separated.
    """
    path = layout.container(contents.form, name)
    entry = next((e for e in contents.manifest["containers"][name] if e["path"] == path), None)
    if entry is None:
        return [Finding("manifest", layout.MANIFEST_FILE, f"it does not list {path}", name)], []
    data = contents.read(path)
    fault = _fault(data, entry)
    if fault and contents.form.name in INSEPARABLE:
        return [Finding(fault[0], path, fault[1], name)], []
    try:
        parts = contents.parts(name, data)
    except IntegrityError as error:
        kind, detail = fault or ("values", str(error))
        return [Finding(kind, path, detail, name)], []
    damaged_part = any(
        digest(part) != contents.entry(name, place)["sha256"] for place, part in enumerate(parts)
    )
    return [
        Finding(fault[0], path, f"{fault[1]}, though its frames are unchanged", name)
    ] if fault and not damaged_part else [], parts


def _frame(
    contents: Contents, name: str, place: int, data: bytes, sequence: _Sequence
) -> Iterator[tuple[Kind, str]]:
    """Yield the problems of a frame whose bytes are unchanged."""
    try:
        pixels = contents.pixels(name, data)
    except IntegrityError as error:
        sequence.unbroken = False
        yield "values", str(error)
        return
    half_step = _half_step(contents, name)
    for c, (low, high) in enumerate(contents.entry(name, place)["range"]):
        least, most = float(pixels[..., c].min()), float(pixels[..., c].max())
        if not (abs(least - low) <= half_step * 1.001 and abs(most - high) <= half_step * 1.001):
            yield (
                "range",
                f"channel {c} goes from {least:g} to {most:g}, and is listed with {low:g} "
                f"to {high:g}",
            )
    values = contents.restored(name, pixels)
    if MAPS[name].kind == "normal":
        off = float(np.max(np.abs(np.linalg.norm(values.astype(np.float64), axis=-1) - 1.0)))
        if not off <= _length_error(contents):
            yield "normal", f"a normal's length is {off:.2g} off 1"
    for axis in (0, 1):
        sequence.inside[axis] += np.mean(
            np.square(np.diff(values, axis=axis), dtype=np.float64), axis=(1 - axis, 2)
        )
        sequence.across[axis] += _rms(np.take(values, 0, axis) - np.take(values, -1, axis)) ** 2
    if name == "displacement":
        _weigh_crests(values, contents, sequence)
    if sequence.first is None:
        sequence.first = values
    if sequence.last is not None:
        sequence.steps += 1
        sequence.roughest = max(sequence.roughest, _rms(values - sequence.last))
    sequence.last = values


def _whole(contents: Contents, name: str, sequence: _Sequence) -> Iterator[tuple[Kind, str]]:
    """Yield the problems of all frames of a map together."""
    frames, count = contents.frames, contents.job.frames
    step = frames[1] - frames[0] if len(frames) > 1 else count
    closes = sequence.unbroken and frames[0] + count - frames[-1] == step
    first, last = sequence.first, sequence.last
    if not closes or first is None or last is None:
        pass
    elif name == "foam":
        if contents.job.lookup == "lagrangian" and (
            fault := _foam_forgotten(last, first, step / count, contents)
        ):
            yield "loop", fault
    elif sequence.steps >= MIN_STEPS:
        home, roughest = _rms(first - last), sequence.roughest
        if home > LARGEST_STEP * roughest + _half_step(contents, name):
            yield (
                "loop",
                f"the step from the last frame to the first is "
                f"{home / max(roughest, 1e-300):.1f} times the largest before",
            )
    for axis, edge in ((0, "north"), (1, "east")):
        inside, across = np.atleast_1d(sequence.inside[axis]), sequence.across[axis]
        if (
            inside.size >= MIN_STEPS
            and across
            > LARGEST_STEP**2 * (roughest := float(inside.max())) + _half_step(contents, name) ** 2
        ):
            excess = np.sqrt(across / max(roughest, 1e-300))
            yield (
                "seam",
                f"the step across the {edge} edge is {excess:.1f} times the roughest inside",
            )
    if sequence.strength > 0.0 and sequence.sharpness > 0.0:
        yield (
            "crest",
            "troughs are sharper than crests: an axis is mirrored",
        )


def _foam_forgotten(last: Real, first: Real, share: float, contents: Contents) -> str | None:
    """
    Return a problem if foam of the last frame is missing in the first, or None.

    Foam may grow at once, but goes no faster than it decays.
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
    """Return half a step of the stored type at the largest value: the largest rounding error."""
    low, high = contents.range(name)
    if low is not None and high is not None:
        return 0.5 * (high - low) / 65535.0 + 1e-6 * max(
            abs(low), abs(high)
        )  # and the rounding to float32
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
    Return the largest error of a unit normal's length: that of rounding three components to the
    stored type, and as much again for the normal's own rounding.
    """
    step = {"float16": 2.0**-12, "float32": 2.0**-22, "uint16": 1.0 / 65535.0}[contents.form.stored]
    packed = contents.profile.normals == "packed"  # n = 2 c - 1 doubles what c was rounded by
    return (4.0 if packed else 2.0) * float(np.sqrt(3.0)) * step


def _weigh_crests(values: Real, contents: Contents, sequence: _Sequence) -> None:
    """Add a displacement map to the sum that is negative where crests are sharper than troughs."""
    v = values.astype(np.float64)
    lx, ly = contents.manifest["ocean"]["size"]
    along = (np.roll(v[..., 0], -1, 1) - np.roll(v[..., 0], 1, 1)) * (v.shape[1] / lx)
    up = (np.roll(v[..., 1], -1, 0) - np.roll(v[..., 1], 1, 0)) * (v.shape[0] / ly)
    apart = along + up
    sequence.sharpness += float(np.sum(v[..., 2] * apart))
    sequence.strength += float(np.sqrt(np.sum(v[..., 2] ** 2) * np.sum(apart**2)))


def _extra(contents: Contents) -> Iterator[Finding]:
    """Yield the files that are named like those of a bake, and are not listed in the manifest."""
    listed = {
        entry["path"]
        for entries in contents.manifest.get("containers", {}).values()
        for entry in entries
    }
    listed |= {
        contents.manifest[key]["path"] for key in layout.PREVIEWS if key in contents.manifest
    }
    names = (
        path.relative_to(contents.folder).as_posix() for path in layout.bake_files(contents.folder)
    )
    for relative in sorted(
        name for name in names if name not in listed and not contents.holds(name)
    ):
        yield Finding(
            "extra",
            relative,
            "not listed in the manifest",
        )
    for inner in layout.folders_of(contents.folder):
        for path in sorted(temporary_files(inner)):
            yield Finding(
                "extra",
                path.relative_to(contents.folder).as_posix(),
                "left-over temporary file",
            )
