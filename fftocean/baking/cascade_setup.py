"""
Water of a cascade's job: its tiles set up, the list of them, and pictures and figures of their sum.

A texture of one tile cannot hold what is not linear in the waves. The normal, the Jacobian and the
foam of the water are made of the SUMS of slopes and stretches over all tiles, and tiles whose sizes
do not divide one another never meet twice in the same way. So the linear maps of each tile are
baked, and the others are refused with the maps that they are formed from.
"""

import math
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from fftocean import blend_loss as blend
from fftocean.baking.bake import require_usable, scene_for
from fftocean.baking.folder import layout, listing
from fftocean.baking.folder.identity import checked
from fftocean.baking.folder.listing import Share
from fftocean.baking.folder.plan import frames_of
from fftocean.baking.previews import previews as pictures
from fftocean.baking.previews import sheets as preview
from fftocean.baking.scene.maps import MAPS
from fftocean.baking.scene.scene import Scene
from fftocean.cascade import Cascade, Tile, from_oceans
from fftocean.errors import JobError, SeaWarning
from fftocean.export import rules
from fftocean.files import write_whole
from fftocean.job.job import Job, finite_or_word
from fftocean.job.parameters import BY_KEY
from fftocean.statistics import Statistics, measure

INGREDIENTS = ("displacement", "derivative", "stretch")
"""
What a shader displaces and lights the water of several tiles with; baked where no maps are named.
"""

INSTEAD = {
    "normal": "bake derivative and stretch, and form the normal of their sums",
    "jacobian": "bake stretch, and form the Jacobian of the sums",
    "foam": "bake stretch, and let the shader make foam of the sums, or take fo.Foam().loop(fo.Window(cascade), frames)",
}
HOW_TO_ADD = (
    "Displacements, heights, slopes (derivative), stretches and velocities of the tiles add up; slope covariances do in the mean. "
    "Normal, Jacobian and foam do not: form them of the sums. With slope_1, slope_2 along the two horizontal axes and the summed "
    "stretch (xx, xy, yy): Jacobian = (1 + xx) (1 + yy) - xy xy; normal ~ (xy slope_2 - (1 + yy) slope_1, xy slope_1 - (1 + xx) slope_2, "
    "Jacobian) along axis 1, axis 2 and up; squeeze = 1 + (xx + yy)/2 - sqrt((xx - yy)^2/4 + xy xy), and foam f decays as e^(-t/tau) "
    "and grows by strength max(threshold - squeeze, 0) a second; coverage = 1 - e^-f."
)


class Water:
    """The tiles of a job, set up: all that is known of a cascade before and beside its maps."""

    def __init__(
        self,
        job: Job,
        shares: Sequence[Share],
        scenes: Sequence[Scene],
        chosen: tuple[int, ...],
        downsample: int,
    ) -> None:
        self.job, self.shares, self.scenes, self.chosen = job, shares, scenes, chosen
        self.header = listing.header_of(job, shares, frames=chosen, downsample=downsample)
        oceans = tuple(scene.ocean for scene in scenes)
        sea = oceans[0].sea
        assert sea is not None  # a job has a sea
        self.cascade: Cascade = from_oceans(sea, job.settings["ocean.seed"], oceans)
        self.statistics: Statistics = measure(self.cascade)

    def listed(
        self,
        rows: Sequence[Mapping[str, Any]],
        manifests: Sequence[Mapping[str, Any]],
        pictures: Mapping[str, Any],
    ) -> dict[str, Any]:
        """
        Return the list of a cascade's tiles as plain data.

        Args:
            rows: of the tiles, in order.
            manifests: of the tiles, in order.
            pictures: of the summed water, by name.
        """
        profile, cascade = self.scenes[0].profile, self.cascade
        step = self.chosen[1] - self.chosen[0] if len(self.chosen) > 1 else 1
        bounds = {
            key: sum(m["extremes"][key] for m in manifests)
            for key in ("max_height", "max_horizontal")
        }
        return checked(
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
                "conventions": rules.conventions(profile),
                "how_to_add": f"{rules.cascade_text(profile)} {HOW_TO_ADD}",
                "sampling": rules.cascade(profile),
                "foam": self.job.foam,
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
                **pictures,
            }
        )

    def _folding(self) -> dict[str, Any]:
        """Return the folds and the least Jacobian of the summed water."""
        found = self.statistics.folding
        largest = found.largest_choppiness
        return {
            "min_jacobian": found.min_jacobian,
            "folded": found.share,
            "largest_choppiness": largest if math.isfinite(largest) else None,
            "sampled": f"folds: of the summed water, {found.samples} places and moments; bounds: sums over the tiles",
        }

    def draw(self, folder: Path) -> dict[str, dict[str, Any]]:
        """
        Draw the pictures of the summed water that the job asks for.

        Raises:
            OutputError: one cannot be written.
        """
        frames, drawn, foam = self.job.frames, {}, pictures.foam_of(self.job)
        if "sheet" in self.job.pictures:
            sizes = ", ".join(f"{ocean.grid.lx:g}" for ocean in self.cascade.oceans)
            text = pictures.caption(self.job, self.statistics, f"tiles {sizes} m")
            drawn["preview"] = (
                layout.SHEET,
                preview.contact_sheet(self.cascade, frames, text, **foam),
            )
        if "animation" in self.job.pictures:
            drawn["animation"] = (layout.ANIMATION, preview.animation(self.cascade, frames, **foam))
        return {
            key: {"path": name, "bytes": len(data), "sha256": write_whole(folder / name, data)}
            for key, (name, data) in drawn.items()
        }

    def rows(self) -> Iterator[tuple[str, str]]:
        """Yield what `info` says of a cascade: a name and a text each."""
        s = self.statistics
        assert s.ordered is not None  # a job has a sea
        for share, ocean in zip(self.shares, self.cascade.oceans, strict=True):
            yield (
                share.path,
                tile_in_words(
                    ocean.grid.nx, ocean.grid.ny, ocean.grid.lx, ocean.grid.ly, share.band
                ),
            )
        yield (
            "significant wave height Hs",
            f"{s.ordered.hs:.3f} m specified, {s.hs:.3f} m realised by all tiles",
        )
        yield "peak period Tp", f"{s.ordered.tp:.2f} s specified, {s.tp:.2f} s realised"
        yield "energy outside the bands", outside(s.as_plain())
        yield (
            "maps",
            f"{', '.join(self.job.maps)} of each tile; normal, Jacobian and foam are formed of the sums",
        )
        yield "between frames", blend.sentence(blend.loss(self.cascade, self.job.frames))


def prepare(
    job: Job, tiles: Iterable[Tile], *, frames: str | None = None, downsample: int = 1
) -> Water:
    """
    Set up the tiles of a job, and refuse what cannot be before anything is written.

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
    shares = listing.shares_of(job, given)
    scenes = [scene_for(share.job, downsample, len(chosen)) for share in shares]
    return Water(job, shares, scenes, chosen, downsample)


def summable(job: Job) -> Job:
    """
    Return the job with maps that add up over tiles.

    Raises:
        JobError: a map that does not is asked for, maps are to be by place, or a band is given.
    """
    source = job.source
    for key in ("ocean.band_low", "ocean.band_high"):
        if job.settings[key] != BY_KEY[key].default:
            raise JobError(
                f"{source}: {key} must be left out where there are tiles, whose bands follow from their sizes"
            )
    if job.lookup != "lagrangian":
        raise JobError(
            f"{source}: bake.lookup 'eulerian' cannot be had for tiles: which water is at a place follows from the sum of all tiles' "
            "displacements; bake lagrangian maps, or ask fo.Query(cascade) for the water at places"
        )
    if job.maps == BY_KEY["bake.maps"].default:
        warnings.warn(
            f"the maps of each tile are {', '.join(INGREDIENTS)} in place of {', '.join(job.maps)}: the normal of the sum is formed of "
            "summed slopes and stretches (cascade.json says how)",
            SeaWarning,
            stacklevel=4,
        )
        return job.replaced({"bake.maps": list(INGREDIENTS)})
    for name in job.maps:
        if not MAPS[name].adds:
            raise JobError(
                f"{source}: bake.maps {name!r} cannot be had for tiles: it is not linear in the waves, so that of a tile says nothing of "
                f"the sum of all; {INSTEAD[name]}"
            )
    return job


def tile_in_words(nx: int, ny: int, lx: float, ly: float, band: Sequence[Any]) -> str:
    """Return a tile in words."""
    return (
        f"{nx} x {ny} over {lx:g} x {ly:g} m, waves of {band[0]:.4g} to {float(band[1]):.4g} rad/m"
    )


def outside(statistics: Mapping[str, Any]) -> str:
    """Return in words what the tiles cannot hold of the sea."""
    m0 = statistics["ordered"]["m0"]
    below, above = (statistics[key] / m0 if m0 else 0.0 for key in ("energy_below", "energy_above"))
    return f"{100.0 * below:.2f} % in waves too long for the largest tile, {100.0 * above:.2f} % in waves too short for the smallest"
