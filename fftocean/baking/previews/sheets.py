"""
Preview images of a bake: contact sheet, animation of the loop, and four tiles side by side.

All are rendered from the ocean itself, or from the sum of a cascade's tiles, frame by frame; the
same ocean gives the same bytes.
"""

import io
import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from fftocean import mips
from fftocean.arrays import Real
from fftocean.baking.previews import render, whitecaps
from fftocean.baking.previews.render import Water
from fftocean.baking.previews.whitecaps import Whitecaps
from fftocean.cascade import Cascade
from fftocean.errors import OutputError
from fftocean.fields import DISPLACEMENT_GRADIENT
from fftocean.foam import Foam
from fftocean.grid import Grid
from fftocean.ocean import Frame, Ocean

WIDTH, VIEW_HEIGHT, THUMBNAIL, COLUMNS = 1280, 460, 208, 6
FILM, FILM_FRAMES, FILM_QUALITY = (320, 120), 96, 55
"""Size [pixels], frames at most, and WebP quality of the animation: less than 1 MB."""
TILE, MARGIN = 400, 18
BACKGROUND, BRIGHT, FAINT = (16, 20, 24), (225, 232, 238), (150, 162, 172)

Sea = Ocean | Cascade
"""One tile, or the sum of several."""


def contact_sheet(
    ocean: Sea, frames: int, caption: str, *, foam: Foam | None = None, cover: float | None = None
) -> bytes:
    """
    Draw a PNG: frame 0 in perspective above up to twelve frames of the loop from above, north up.

    Args:
        ocean: the baked ocean or cascade.
        frames: number of frames in the loop; the images show some of them.
        caption: one line of text.
        foam: parameters of foam; None is the default.
        cover: share of the surface covered with foam; None keeps the threshold of `foam`.
    """
    from PIL import Image, ImageDraw, ImageFont

    shown = _spread(frames, 2 * COLUMNS)
    gap = (WIDTH - COLUMNS * THUMBNAIL) // (COLUMNS + 1)
    rows = math.ceil(len(shown) / COLUMNS)
    sheet = Image.new("RGB", (WIDTH, VIEW_HEIGHT + 40 + rows * (THUMBNAIL + 26) + 8), BACKGROUND)
    loop = _Frames(ocean, frames, foam or Foam(), cover)
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(17)
    small = ImageFont.load_default(13)
    scale = f"seen from {render.EYE:g} m above the water; the buoy's bands are 1 m high"
    draw.text((gap, VIEW_HEIGHT + 10), caption, fill=BRIGHT, font=font)
    tile = _grids(ocean)[0]
    size = _fitted(tile, THUMBNAIL)
    for i, (j, water) in enumerate(zip(shown, loop.waters(shown), strict=True)):
        if i == 0:
            view = render.perspective(water, WIDTH, VIEW_HEIGHT)
            sheet.paste(Image.fromarray(render.developed(view)), (0, 0))
            draw.text((WIDTH - gap, 8), scale, fill=(60, 70, 78), font=small, anchor="ra")
        above = render.from_above(water, *size)
        left = gap + (i % COLUMNS) * (THUMBNAIL + gap)
        top = VIEW_HEIGHT + 40 + (i // COLUMNS) * (THUMBNAIL + 26)
        sheet.paste(Image.fromarray(render.developed(above)), (left, top))
        time = f"t = {loop.time(j):.2f} s"
        draw.text((left + 1, top + THUMBNAIL + 4), time, fill=FAINT, font=small)
        if i == 0:
            _scale_bar(draw, tile, (left, top + THUMBNAIL), small)
    return _png(sheet)


def animation(
    ocean: Sea, frames: int, *, foam: Foam | None = None, cover: float | None = None
) -> bytes:
    """
    Draw an animated WebP: the loop in perspective, in real time, repeated for ever.

    At most `FILM_FRAMES` of the frames are drawn, every second or third of them, so that neither
    time nor size grow with the bake. Frames are shown for 20 ms to 2 s, so that a very long loop
    runs faster than in reality, and a very short one slower. See `contact_sheet` for arguments.

    Raises:
        OutputError: this Pillow cannot write WebP.
    """
    from PIL import Image, features

    if not features.check("webp"):
        raise OutputError(
            "an animated preview needs a Pillow that can write WebP (pip install --upgrade pillow)"
        )
    shown = range(0, frames, math.ceil(frames / FILM_FRAMES))
    period = _period(ocean)
    ends = [1000.0 * period * j / frames for j in [*shown, frames]]
    lasting = [min(max(round(end) - round(start), 20), 2000) for start, end in pairwise(ends)]
    loop = _Frames(ocean, frames, foam or Foam(), cover)

    def images() -> Iterator[Any]:
        place = None
        for water in loop.waters(shown):
            place = place or render.trough(water)
            view = render.perspective(water, *FILM, place=place, taps=1)
            yield Image.fromarray(render.developed(view))

    film = images()
    stream, first = io.BytesIO(), next(film)
    options = {"duration": lasting, "loop": 0, "quality": FILM_QUALITY, "method": 2}
    first.save(stream, format="WEBP", save_all=True, append_images=film, **options)
    return stream.getvalue()


def tiling(ocean: Sea, frames: int) -> bytes:
    """
    Draw a PNG of frame 0 from above, 2 x 2 tiles; marks in the margin show the seams.

    Of a cascade the first tile is shown without the others, which do not repeat with it.
    """
    from PIL import Image, ImageDraw

    first = ocean.oceans[0] if isinstance(ocean, Cascade) else ocean
    water = Water.of(first.loop_frame(0, frames, render.FIELDS))
    width, height = _fitted(first.grid, TILE)
    one = Image.fromarray(render.developed(render.from_above(water, width, height)))
    sheet = Image.new("RGB", (2 * (width + MARGIN), 2 * (height + MARGIN)), BACKGROUND)
    for corner in ((0, 0), (width, 0), (0, height), (width, height)):
        sheet.paste(one, (MARGIN + corner[0], MARGIN + corner[1]))
    draw = ImageDraw.Draw(sheet)
    x, y = MARGIN + width, MARGIN + height
    for rim in (4, 2 * height + MARGIN + 4):
        draw.line((x, rim, x, rim + MARGIN - 8), fill=BRIGHT, width=2)
    for rim in (4, 2 * width + MARGIN + 4):
        draw.line((rim, y, rim + MARGIN - 8, y), fill=BRIGHT, width=2)
    return _png(sheet)


class _Frames:
    """Frames of a loop with their foam, ready to render."""

    def __init__(self, ocean: Sea, frames: int, foam: Foam, cover: float | None) -> None:
        self.ocean, self.frames, self.foam, self.cover = ocean, frames, foam, cover
        self.period = _period(ocean)
        finest = ocean.oceans[-1] if isinstance(ocean, Cascade) else ocean
        self.rest = mips.unresolved_slopes(finest)
        grids = _grids(ocean)
        self.first = grids[0]
        samples = sum(grid.nx * grid.ny for grid in grids)
        if len(grids) > 1:
            samples += len(grids) * whitecaps.SIDE_OF_SUM**2
        self.steps = int(min(max(whitecaps.STEPS * 2**19 / samples, 8), whitecaps.STEPS))
        self.step = whitecaps.MEMORY * foam.tau / self.steps
        still = all(tile.amplitudes.variance == 0.0 for tile in _oceans(ocean))
        self.foams = foam.strength > 0.0 and cover != 0.0 and not still

    def time(self, j: int) -> float:
        """Return the time of a frame of the loop [s]."""
        return self.period * j / self.frames

    def waters(self, shown: Sequence[int]) -> Iterator[Water]:
        """Yield the surface of some frames in rising order; foam goes on from each to the next."""
        caps, last = None, 0.0
        for j in shown:
            fields = self.ocean.loop_frame(j, self.frames, render.FIELDS)
            if caps is not None:
                self._advance(caps, fields, last, self.time(j))
            elif self.foams:
                caps = self._initial_foam(self.time(j))
            last = self.time(j)
            covered = None if caps is None else caps.coverage
            yield Water.of(fields, rest=self.rest, foam=covered)

    def _initial_foam(self, t: float) -> Whitecaps:
        """Return the foam at a time [s], accumulated over the few decay times before it."""
        moments = [self._minimum_eigenvalue(t - i * self.step) for i in reversed(range(self.steps))]
        return Whitecaps.before(moments, self.step, self.foam, self.cover)

    def _advance(
        self, caps: Whitecaps, fields: Frame | Sequence[Frame], start: float, stop: float
    ) -> None:
        """Advance foam from one time to another, whose frame is given [s]."""
        parts = min(max(1, math.ceil((stop - start) / self.step)), self.steps)
        step = (stop - start) / parts
        for i in range(1, parts):
            caps.add(self._minimum_eigenvalue(start + i * step), step)
        caps.add(whitecaps.minimum_eigenvalue(fields), step)

    def _minimum_eigenvalue(self, t: float) -> Real:
        return whitecaps.minimum_eigenvalue(self.ocean.frame(t, DISPLACEMENT_GRADIENT))


def _oceans(ocean: Sea) -> tuple[Ocean, ...]:
    """Return the tiles of a sea, the largest first."""
    return ocean.oceans if isinstance(ocean, Cascade) else (ocean,)


def _grids(ocean: Sea) -> list[Grid]:
    """Return the grids of a sea's tiles."""
    return [tile.grid for tile in _oceans(ocean)]


def _period(ocean: Sea) -> float:
    """Return the period of a sea's loop [s]."""
    assert ocean.loop is not None  # only loops are baked
    return ocean.loop


def _scale_bar(draw: Any, tile: Grid, corner: tuple[int, int], font: Any) -> None:
    """Draw a bar of a round length, about a quarter of the tile, over an image from above."""
    longer = max(tile.lx, tile.ly)
    ten = 10.0 ** math.floor(math.log10(longer / 3.0))
    length = max(step * ten for step in (1.0, 2.0, 5.0) if step * ten <= longer / 3.0)
    x, y, width = corner[0] + 8, corner[1] - 10, round(THUMBNAIL * length / longer)
    draw.line((x, y, x + width, y), fill=(255, 255, 255), width=3)
    draw.text((x, y - 18), f"{length:g} m", fill=(255, 255, 255), font=font)


def _spread(frames: int, most: int) -> list[int]:
    """Return at most so many of a loop's frames, evenly spread, the first among them."""
    count = min(most, frames)
    return [i * frames // count for i in range(count)]


def _fitted(grid: Grid, side: int) -> tuple[int, int]:
    """Return width and height in pixels of the tile's image, the longer of them `side`."""
    longer = max(grid.lx, grid.ly)
    return max(1, round(side * grid.lx / longer)), max(1, round(side * grid.ly / longer))


def _png(image: Any) -> bytes:
    """Return an image as the bytes of a PNG."""
    stream = io.BytesIO()
    image.save(stream, format="PNG")
    return stream.getvalue()
