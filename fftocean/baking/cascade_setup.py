"""
Tiles of a cascade's job, set up for baking; their list, and previews of their sum.

A texture of one tile cannot hold a quantity that is not linear in the waves. Normal, Jacobian and
foam of the surface follow from the SUMS of slopes and stretches over all tiles, and tiles whose
sizes do not divide one another never combine twice in the same way. So the linear maps of each tile
are baked; a request for another map is refused, with the names of the maps to form it from.
"""

import math
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from fftocean import blend_loss as blend
from fftocean.baking.bake import require_usable, scene_for
from fftocean.baking.folder import layout, listing
from fftocean.baking.folder.listing import TileJob
from fftocean.baking.folder.plan import frames_of
from fftocean.baking.folder.sealed import sealed
from fftocean.baking.previews import previews, sheets
from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene
from fftocean.cascade import Cascade, Tile, from_oceans
from fftocean.errors import JobError, SeaWarning
from fftocean.export import rules
from fftocean.files import write_whole
from fftocean.job.job import Job, finite_or_word
from fftocean.job.parameters import BY_KEY
from fftocean.physics.plausibility import plausibility
from fftocean.physics.sea import Sea
from fftocean.statistics import Statistics, measure

INGREDIENTS = ("displacement", "derivative", "stretch")
"""
Maps by which a shader displaces and lights the sum of the tiles; baked where no maps are named.
"""

INSTEAD = {
    "normal": "bake derivative and stretch, and form the normal of their sums",
    "jacobian": "bake stretch, and form the Jacobian of the sums",
    "foam": "bake stretch, and let the shader make foam of the sums, "
    "or take fo.Foam().loop(fo.Window(cascade), frames)",
}
HOW_TO_ADD = (
    "Displacements, heights, slopes (derivative), stretches and velocities of the tiles add "
    "up; slope covariances do in the mean. Normal, Jacobian and foam do not: form them of the"
    " sums. With slope_1, slope_2 along the two horizontal axes and the summed stretch (xx, "
    "xy, yy): Jacobian = (1 + xx) (1 + yy) - xy xy; normal ~ (xy slope_2 - (1 + yy) slope_1, "
    "xy slope_1 - (1 + xx) slope_2, Jacobian) along axis 1, axis 2 and up; squeeze = 1 + (xx "
    "+ yy)/2 - sqrt((xx - yy)^2/4 + xy xy), and foam f decays as e^(-t/tau) and grows by "
    "strength max(threshold - squeeze, 0) a second; coverage = 1 - e^-f."
)


class TileSet:
    """The tiles of a job, set up, and the statistics of their sum."""

    def __init__(
        self,
        job: Job,
        tile_jobs: Sequence[TileJob],
        scenes: Sequence[Scene],
        chosen: range,
        downsample: int,
    ) -> None:
        self.job, self.tile_jobs, self.scenes, self.chosen = job, tile_jobs, scenes, chosen
        self.header = listing.header_of(job, tile_jobs, frames=chosen, downsample=downsample)
        oceans = tuple(scene.ocean for scene in scenes)
        sea = oceans[0].sea
        assert sea is not None  # a job has a sea
        self.sea: Sea = sea
        self.cascade: Cascade = from_oceans(sea, job.settings["ocean.seed"], oceans)
        self.rarity = tile_jobs[0].rarity
        self.statistics: Statistics = measure(self.cascade)

    def listed(
        self,
        rows: Sequence[Mapping[str, Any]],
        manifests: Sequence[Mapping[str, Any]],
        pictures: Mapping[str, Any],
        players: Sequence[Mapping[str, Any]] = (),
    ) -> dict[str, Any]:
        """
        Return the list of a cascade's tiles as plain data.

        Args:
            rows: of the tiles, in order.
            manifests: of the tiles, in order.
            pictures: entries of the previews of the summed tiles, by name.
            players: entries of the files that play the tiles in their engine.
        """
        profile, cascade = self.scenes[0].profile, self.cascade
        step = self.chosen[1] - self.chosen[0] if len(self.chosen) > 1 else 1
        bounds = {
            key: sum(m["extremes"][key] for m in manifests)
            for key in ("max_height", "max_horizontal")
        }
        return sealed(
            {
                **self.header,
                "ocean": {
                    "seed": cascade.seed,
                    "depth": finite_or_word(cascade.depth),
                    "loop": cascade.loop,
                    "choppiness": cascade.choppiness,
                    "frames": len(self.chosen),
                },
                "statistics": self.statistics.as_plain(),
                **({} if self.rarity is None else {"constrained": self.rarity.as_plain()}),
                "plausibility": plausibility(self.sea).as_plain(),
                "conventions": rules.conventions(profile),
                "how_to_add": f"{rules.cascade_text(profile)} {HOW_TO_ADD}",
                "sampling": rules.cascade(profile),
                "foam": self.job.describe_foam(cascade),
                "blend": blend.describe(cascade, max(1, round(self.job.frames / step))),
                "extremes": {
                    "unit": {
                        "max_height": "m",
                        "max_horizontal": "m",
                        "min_jacobian": "1",
                        "folded": "1",
                        "largest_choppiness": "1",
                    },
                    **bounds,
                    **self._folding(),
                },
                "tiles": list(rows),
                "tile_units": {"size": "m", "band": "rad/m", "m0": "m^2"},
                "video_memory": {
                    key: sum(m["video_memory"][key] for m in manifests)
                    for key in ("bytes", "bytes_a_frame", "bytes_with_all_levels")
                },
                **pictures,
                **({"engine_files": list(players)} if players else {}),
            }
        )

    def _folding(self) -> dict[str, Any]:
        """Return the folds and the least Jacobian of the summed tiles."""
        found = self.statistics.folding
        largest = found.largest_choppiness
        return {
            "min_jacobian": found.min_jacobian,
            "folded": found.share,
            "largest_choppiness": largest if math.isfinite(largest) else None,
            "sampled": f"folds: of the summed water, {found.samples} places and moments; "
            "bounds: sums over the tiles",
        }

    def write_previews(self, folder: Path) -> dict[str, dict[str, Any]]:
        """
        Write the previews of the summed tiles that the job asks for; return their entries.

        Raises:
            OutputError: one cannot be written.
        """
        frames, images, foam = self.job.frames, {}, previews.foam_of(self.job, self.cascade)
        if "sheet" in self.job.pictures:
            sizes = ", ".join(f"{ocean.grid.lx:g}" for ocean in self.cascade.oceans)
            text = previews.caption(self.job, self.statistics, f"tiles {sizes} m")
            images["preview"] = (
                layout.SHEET,
                sheets.contact_sheet(self.cascade, frames, text, **foam),
            )
        if "animation" in self.job.pictures:
            images["animation"] = (layout.ANIMATION, sheets.animation(self.cascade, frames, **foam))
        return {
            key: {"path": name, "bytes": len(data), "sha256": write_whole(folder / name, data)}
            for key, (name, data) in images.items()
        }

    def rows(self) -> Iterator[tuple[str, str]]:
        """Yield the rows of the table that `info` prints: a name and a text each."""
        s = self.statistics
        assert s.specified is not None  # a job has a sea
        for tile, ocean in zip(self.tile_jobs, self.cascade.oceans, strict=True):
            yield (
                tile.path,
                tile_in_words(
                    ocean.grid.nx, ocean.grid.ny, ocean.grid.lx, ocean.grid.ly, tile.band
                ),
            )
        yield (
            "significant wave height Hs",
            f"{s.specified.hs:.3f} m specified, {s.hs:.3f} m realised by all tiles",
        )
        yield "peak period Tp", f"{s.specified.tp:.2f} s specified, {s.tp:.2f} s realised"
        yield "energy outside the bands", outside(s.as_plain())
        yield "wave height and steepness", str(plausibility(self.sea))
        if (second := self.cascade.oceans[0].bound_waves) is not None:
            yield "second order", f"of the largest tile alone, {second.report}"
        yield "folds", str(s.folding)
        if self.rarity is not None:
            yield "fixed values", str(self.rarity)
        yield (
            "maps",
            f"{', '.join(self.job.maps)} of each tile; "
            "normal, Jacobian and foam are formed of the sums",
        )
        yield "between frames", blend.sentence(blend.describe(self.cascade, self.job.frames))


def prepare(
    job: Job, tiles: Iterable[Tile], *, frames: str | None = None, downsample: int = 1
) -> TileSet:
    """
    Return the tiles of a job, set up; write nothing.

    Raises:
        JobError: as `bake_tiles`.
    """
    if not isinstance(job, Job):
        raise JobError(
            f"a job must be a Job, such as Job.default() or Job.read('sea.toml'), got {job!r:.60}"
        )
    job = summable(job)
    require_usable(job)
    chosen = frames_of(frames, job.frames)
    try:
        given = list(tiles)
    except TypeError:
        raise JobError(f"tiles must be a list of (n, size), got {tiles!r:.80}") from None
    tile_jobs = listing.jobs_of_tiles(job, given)
    scenes = [scene_for(tile.job, downsample, len(chosen)) for tile in tile_jobs]
    return TileSet(job, tile_jobs, scenes, chosen, downsample)


def summable(job: Job) -> Job:
    """
    Return the job, with maps that add up over tiles.

    Raises:
        JobError: the job has a map that does not add up, the eulerian lookup, or a band.
    """
    source = job.source
    for key in ("ocean.band_low", "ocean.band_high"):
        if job.settings[key] != BY_KEY[key].default:
            raise JobError(
                f"{source}: {key} must be left out where there are tiles, "
                "whose bands follow from their sizes"
            )
    if job.lookup != "lagrangian":
        raise JobError(
            f"{source}: bake.lookup 'eulerian' cannot be baked for tiles: the water at a "
            f"place depends "
            "on the sum of all tiles' displacements; bake lagrangian maps, or use fo.Query(cascade)"
        )
    if job.maps == BY_KEY["bake.maps"].default:
        warnings.warn(
            f"the maps of each tile are {', '.join(INGREDIENTS)} in place of "
            f"{', '.join(job.maps)}: the "
            "normal of the sum is formed of summed slopes and stretches (cascade.json "
            "describes it)",
            SeaWarning,
            stacklevel=4,
        )
        return job.replaced({"bake.maps": list(INGREDIENTS)})
    for name in job.maps:
        if not MAPS[name].adds:
            raise JobError(
                f"{source}: bake.maps {name!r} cannot be baked for tiles: it is not linear in the "
                f"waves, so those of the tiles do not add up; {INSTEAD[name]}"
            )
    return job


def tile_in_words(nx: int, ny: int, lx: float, ly: float, band: Sequence[Any]) -> str:
    """Return samples, size and band of a tile in words."""
    return (
        f"{nx} x {ny} over {lx:g} x {ly:g} m, waves of {band[0]:.4g} to {float(band[1]):.4g} rad/m"
    )


def outside(statistics: Mapping[str, Any]) -> str:
    """Return in words the energy of the sea outside the bands of the tiles."""
    m0 = statistics["ordered"]["m0"]
    below, above = (statistics[key] / m0 if m0 else 0.0 for key in ("energy_below", "energy_above"))
    return (
        f"{100.0 * below:.2f} % in waves too long for the largest tile, "
        f"{100.0 * above:.2f} % in waves too short for the smallest"
    )
