"""
What a finished bake holds: its files, frame by frame, back out of every format, in the files' own
frame or in ours.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
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
    A finished bake by its manifest. Where each file stands follows from the job; the manifest's own
    paths are only compared.
    """

    folder: Path
    manifest: Mapping[str, Any]
    job: Job  # as it is baked: made smaller already, where that was asked
    frames: tuple[int, ...]
    form: Format
    profile: Profile
    shape: tuple[int, int]  # (rows, columns)

    @classmethod
    def of(cls, folder: Path, manifest: Mapping[str, Any]) -> "Contents":
        """
        Find out what a manifest says is there.

        Raises:
            IntegrityError: it is not what a bake could have written.
        """
        try:
            ordered = Job.from_description(
                manifest["job"], source=str(folder / layout.MANIFEST_FILE), at_sea=False
            )
            job = ordered.downsampled(manifest["downsample"])
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
            what = (
                f"{error}"
                if isinstance(error, ParameterError)
                else f"{type(error).__name__} {error}"
            )
            raise IntegrityError(
                f"{folder / layout.MANIFEST_FILE} does not say what a bake's does: {what:.200}"
            ) from None
        return found

    def _require_consistent(self) -> None:
        """Whether what the manifest says twice it says alike."""
        rows = self.manifest["frames"]
        if [row["frame"] for row in rows] != list(self.frames):
            raise ValueError("its frames are not those of its job")
        if list(self.manifest["maps"]) != list(self.job.maps):
            raise ValueError("its maps are not those of its job")
        loop = self.manifest["ocean"]["loop"]
        for place, row in enumerate(rows):
            if row["t"] != loop * row["frame"] / self.job.frames:
                raise ValueError(f"frame {row['frame']} is not at {row['t']} s")
            for name in self.job.maps:
                if row["files"][name]["bytes"] < 0 or row["files"][name]["path"] != self.path(
                    name, place
                ):
                    raise ValueError(
                        f"{name} of frame {row['frame']} is not in {row['files'][name]['path']}"
                    )
        beside = [
            entry for entries in self.manifest.get("containers", {}).values() for entry in entries
        ]
        for entry in [
            *beside,
            *(self.manifest[key] for key in layout.DRAWN if key in self.manifest),
        ]:
            if not isinstance(entry["path"] + entry["sha256"], str) or entry["bytes"] < 0:
                raise ValueError(f"a file is listed as {entry}")
        for name, m in self.manifest["maps"].items():
            if tuple(m["shape"]) != (*self.shape, len(MAPS[name].names)):
                raise ValueError(f"{name} has not the shape {m['shape']}")
            parts = [row["files"][name]["range"] for row in rows]
            whole = [
                [min(part[c][0] for part in parts), max(part[c][1] for part in parts)]
                for c in range(len(parts[0]))
            ]
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
        """Where a map of the frame at a place of the sequence stands."""
        if self.form.scope == "sequence":
            return layout.container(self.form, name)
        return layout.frame_file(self.form, name, self.frames[place], place)

    def entry(self, name: str, place: int) -> Mapping[str, Any]:
        """What the manifest says of it."""
        found: Mapping[str, Any] = self.manifest["frames"][place]["files"][name]
        return found

    def levels(self, name: str) -> int:
        """How many levels a map has."""
        return int(self.manifest["maps"][name]["levels"])

    def range(self, name: str) -> tuple[float | None, float | None]:
        """What a scaled map is scaled by."""
        scaled = self.manifest["maps"][name].get("scaled")
        return (None, None) if scaled is None else (scaled["low"], scaled["high"])

    def data(self, name: str, places: Sequence[int]) -> Iterator[bytes | None]:
        """
        The bytes of a map's frames at some places of the sequence; None for one that is not there.

        Raises:
            IntegrityError: a container is missing, or so cut or bent that its frames cannot be told
                apart.
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
        Each frame's part out of a container's bytes.

        Raises:
            IntegrityError: it is missing, or so cut or bent that its frames cannot be told apart.
        """
        shape = (len(self.frames), *self.shape, len(MAPS[name].names))
        return formats.payloads(
            self.form.name, data, shape=shape, levels=self.levels(name), gutter=self.profile.gutter
        )

    def read(self, path: str) -> bytes | None:
        """
        A file of the folder; None where there is none of that name, or a link on the way to it.
        """
        at = self.folder
        for part in path.split("/")[:-1]:
            at = at / part
            if at.is_symlink():
                return None
        return read_whole(self.folder / path)

    def pixels(self, name: str, data: bytes) -> npt.NDArray[Any]:
        """
        A map of a frame as the file has it: (rows, columns, channels), in the type that is stored,
        or float32.

        Raises:
            IntegrityError: it is cut or bent, or holds what is no number.
        """
        low, high = self.range(name)
        shape = (*self.shape, len(MAPS[name].names))
        return formats.decode(
            self.form.name, data, shape=shape, lo=low, hi=high, levels=self.levels(name)
        )

    def restored(self, name: str, pixels: npt.NDArray[Any]) -> Real:
        """The same in our own frame: row 0 south, our axes, metres; float32."""
        return profiles.restore(
            self.profile, MAPS[name].kind, np.ascontiguousarray(pixels, dtype=np.float32)
        )

    def chosen(self, frames: Sequence[int] | None) -> list[int]:
        """
        The places of some frames of the loop; None is all.

        Raises:
            JobError: one is not in the bake.
        """
        if frames is None:
            return list(range(len(self.frames)))
        missing = [j for j in frames if j not in self.frames]
        if missing:
            raise JobError(
                f"frames must be some of the {len(self.frames)} that were baked, got {missing[0]!r:.40}"
            )
        return [self.frames.index(j) for j in frames]
