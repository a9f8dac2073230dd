"""
Contents of a finished bake: files and pixels of each map and frame, from every format.

Pixels are returned as the file has them, in an engine's conventions, or restored to those of the
package.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.baking.finished.manifest import merged
from fftocean.baking.folder import layout
from fftocean.baking.folder.plan import frames_of
from fftocean.baking.scene.maps import MAPS
from fftocean.errors import IntegrityError, JobError, ParameterError
from fftocean.export import engines, formats, profiles
from fftocean.export.formats import Format
from fftocean.export.profiles import Profile
from fftocean.files import read_whole
from fftocean.job.job import Job


@dataclass(frozen=True, slots=True)
class Contents:
    """
    A finished bake as its manifest describes it.

    The path of each file follows from the job; the manifest's own paths are only compared.
    """

    folder: Path
    manifest: Mapping[str, Any]
    job: Job  # as it is baked: downsampled already
    frames: range
    form: Format
    profile: Profile
    shape: tuple[int, int]  # (rows, columns)

    @classmethod
    def of(cls, folder: Path, manifest: Mapping[str, Any]) -> "Contents":
        """
        Return the contents that a manifest describes.

        Raises:
            IntegrityError: no bake could have written the manifest.
        """
        try:
            original = Job.from_description(
                manifest["job"], source=str(folder / layout.MANIFEST_FILE), at_sea=False
            )
            job = original.downsampled(manifest["downsample"])
            subset = manifest["subset"]
            frames = frames_of(None if subset == "all" else subset, job.frames)
            form = formats.FORMATS[job.format]
            n = job.settings["ocean.n"]
            columns, rows = n if isinstance(n, tuple) else (n, n)
            profile = engines.profile_for(job.engine, job.format, job.normals)
            profile = profiles.recorded(profile, manifest["conventions"])
            found = cls(folder, manifest, job, frames, form, profile, (rows, columns))
            found._require_consistent()
        except (
            ParameterError,
            KeyError,
            TypeError,
            ValueError,
            AttributeError,
            IndexError,
        ) as error:
            reason = (
                f"{error}"
                if isinstance(error, ParameterError)
                else f"{type(error).__name__} {error}"
            )
            raise IntegrityError(
                f"{folder / layout.MANIFEST_FILE} does not describe a bake: {reason:.200}"
            ) from None
        return found

    def _require_consistent(self) -> None:
        """Raise if redundant entries of the manifest disagree."""
        rows = self.manifest["frames"]
        if len(rows) != len(self.frames):
            raise ValueError("its frames are not those of its job")
        if list(self.manifest["maps"]) != list(self.job.maps):
            raise ValueError("its maps are not those of its job")
        loop = self.manifest["ocean"]["loop"]
        for place, row in enumerate(rows):
            if row["frame"] != self.frames[place]:
                raise ValueError("its frames are not those of its job")
            if row["t"] != loop * row["frame"] / self.job.frames:
                raise ValueError(f"frame {row['frame']} is not at {row['t']} s")
            for name in self.job.maps:
                if row["files"][name]["bytes"] < 0 or row["files"][name]["path"] != self.path(
                    name, place
                ):
                    raise ValueError(
                        f"{name} of frame {row['frame']} is not in {row['files'][name]['path']}"
                    )
        containers = [
            entry for entries in self.manifest.get("containers", {}).values() for entry in entries
        ]
        for entry in [
            *containers,
            *(self.manifest[key] for key in layout.PREVIEWS if key in self.manifest),
            *self.manifest.get("engine_files", ()),
        ]:
            if not isinstance(entry["path"] + entry["sha256"], str) or entry["bytes"] < 0:
                raise ValueError(f"a file is listed as {entry}")
        for name, m in self.manifest["maps"].items():
            if tuple(m["shape"]) != (*self.shape, len(MAPS[name].names)):
                raise ValueError(f"{name} has not the shape {m['shape']}")
            whole = merged(row["files"][name]["range"] for row in rows)
            if m["channel_ranges"] != whole or m["range"] != [
                min(low for low, _ in whole),
                max(high for _, high in whole),
            ]:
                raise ValueError(f"the range of {name} is not that of its frames")
        extremes = self.manifest["extremes"]
        for key, most in (("min_jacobian", min), ("max_height", max), ("max_horizontal", max)):
            if extremes[key] != most(row["extremes"][key] for row in rows):
                raise ValueError(f"{key} is not that of its frames")

    def path(self, name: str, place: int) -> str:
        """Return the file of a map, for the frame at a place of the sequence."""
        if self.form.scope == "sequence":
            return layout.container(self.form, name)
        return layout.frame_file(self.form, name, self.frames[place], place)

    def holds(self, path: str) -> bool:
        """Return whether a file is that of a map of a frame."""
        if self.form.scope == "sequence":
            return path in {layout.container(self.form, name) for name in self.job.maps}
        name = re.split(r"[/.]", path, maxsplit=1)[0]
        places = range(len(self.frames)) if self.form.numbered == "place" else self.frames
        numbers = {int(digits[:18]) for digits in re.findall("[0-9]+", path)}
        return name in self.job.maps and any(
            number in places and path == layout.frame_file(self.form, name, number, number)
            for number in numbers
        )

    def entry(self, name: str, place: int) -> Mapping[str, Any]:
        """Return the manifest's entry of a map, for the frame at a place of the sequence."""
        found: Mapping[str, Any] = self.manifest["frames"][place]["files"][name]
        return found

    def levels(self, name: str) -> int:
        """Return the number of mip levels of a map."""
        return int(self.manifest["maps"][name]["levels"])

    def range(self, name: str) -> tuple[float | None, float | None]:
        """Return the range that a map is scaled by; (None, None) if it is not scaled."""
        scaled = self.manifest["maps"][name].get("scaled")
        return (None, None) if scaled is None else (scaled["low"], scaled["high"])

    def data(self, name: str, places: Sequence[int]) -> Iterator[bytes | None]:
        """
        Yield the bytes of a map's frames at some places of the sequence; None for a missing file.

        Raises:
            IntegrityError: a container is missing, or too damaged to separate its frames.
        """
        if self.form.scope == "frame":
            for place in places:
                yield self.read(self.path(name, place))
            return
        parts = self.parts(name, self.read(layout.container(self.form, name)))
        for place in places:
            yield parts[place]

    def parts(self, name: str, data: bytes | None) -> list[bytes]:
        """
        Return the part of each frame from a container's bytes.

        Raises:
            IntegrityError: the container is missing, or too damaged to separate its frames.
        """
        shape = (len(self.frames), *self.shape, len(MAPS[name].names))
        return formats.payloads(
            self.form.name, data, shape=shape, levels=self.levels(name), gutter=self.profile.gutter
        )

    def read(self, path: str) -> bytes | None:
        """
        Return the bytes of a file of the folder; None if it does not exist, or lies behind a link.
        """
        at = self.folder
        for part in path.split("/")[:-1]:
            at = at / part
            if at.is_symlink():
                return None
        return read_whole(self.folder / path)

    def pixels(self, name: str, data: bytes) -> npt.NDArray[Any]:
        """
        Return a map of a frame as the file has it: (rows, columns, channels), in the stored type or
        float32.

        Raises:
            IntegrityError: the data are damaged, or hold NaN.
        """
        low, high = self.range(name)
        shape = (*self.shape, len(MAPS[name].names))
        return formats.decode(
            self.form.name, data, shape=shape, lo=low, hi=high, levels=self.levels(name)
        )

    def restored(self, name: str, pixels: npt.NDArray[Any]) -> Real:
        """Return pixels in the conventions of the package: row 0 south, x east, metres; float32."""
        return profiles.restore(
            self.profile, MAPS[name].kind, np.ascontiguousarray(pixels, dtype=np.float32)
        )

    def chosen(self, frames: Sequence[int] | None) -> list[int]:
        """
        Return the places of some frames of the loop; None is all of them.

        Raises:
            JobError: a frame is not in the bake.
        """
        if frames is None:
            return list(range(len(self.frames)))
        missing = [j for j in frames if j not in self.frames]
        if missing:
            raise JobError(
                f"frames must be some of the {len(self.frames)} that were baked, "
                f"got {missing[0]!r:.40}"
            )
        return [self.frames.index(j) for j in frames]
