"""
Pictures to judge a bake by: a contact sheet, the loop in motion, and four tiles side by side.

All are made of the ocean itself, frame by frame; the same ocean gives the same bytes.
"""

import io
import math
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.errors import OutputError
from fftocean.kernels import interpolate
from fftocean.ocean import Frame, Ocean

Picture = npt.NDArray[np.float64]
"""(rows, columns, 3) linear light, row 0 at the top."""

FIELDS = ("height", "displace_x", "displace_y", "normal")
WIDTH, VIEW_HEIGHT, THUMBNAIL, COLUMNS = 1280, 460, 208, 6
FILM, FILM_FRAMES, FILM_QUALITY = (432, 160), 128, 60
"""Size [pixels], frames at most, and WebP quality of the animation: less than 1 MB, and some 10 s on one core."""
TILE, MARGIN = 400, 18
BACKGROUND = (16, 20, 24)
DEEP, SHALLOW, ZENITH, HORIZON = (
    np.array(c) for c in ((0.003, 0.016, 0.030), (0.012, 0.085, 0.092), (0.07, 0.17, 0.36), (0.60, 0.68, 0.74))
)
SUN = np.array([-0.24, 0.90, 0.36]) / math.sqrt(0.24**2 + 0.90**2 + 0.36**2)


def contact_sheet(ocean: Ocean, frames: int, caption: str) -> bytes:
    """
    Draw a PNG: frame 0 in perspective, tiled to the horizon, above up to twelve frames of the loop from above, north up.

    Args:
        ocean: what was baked.
        frames: how many frames the loop has; the pictures are taken from among them.
        caption: one line of text.
    """
    from PIL import Image, ImageDraw, ImageFont

    shown = _spread(frames, 2 * COLUMNS)
    gap = (WIDTH - COLUMNS * THUMBNAIL) // (COLUMNS + 1)
    rows = math.ceil(len(shown) / COLUMNS)
    sheet = Image.new("RGB", (WIDTH, VIEW_HEIGHT + 40 + rows * (THUMBNAIL + 26) + 8), BACKGROUND)
    still = ocean.loop_frame(0, frames, FIELDS)
    sheet.paste(Image.fromarray(_developed(perspective(still, WIDTH, VIEW_HEIGHT))), (0, 0))
    draw, font, small = ImageDraw.Draw(sheet), ImageFont.load_default(17), ImageFont.load_default(13)
    draw.text((gap, VIEW_HEIGHT + 10), caption, fill=(225, 232, 238), font=font)
    for i, j in enumerate(shown):
        frame = ocean.loop_frame(j, frames, FIELDS)
        picture = Image.fromarray(_developed(from_above(frame)))
        corner = gap + (i % COLUMNS) * (THUMBNAIL + gap), VIEW_HEIGHT + 40 + (i // COLUMNS) * (THUMBNAIL + 26)
        sheet.paste(picture.resize(_fitted(frame, THUMBNAIL), Image.Resampling.LANCZOS), corner)
        draw.text((corner[0] + 1, corner[1] + THUMBNAIL + 4), f"t = {frame.t:.2f} s", fill=(150, 162, 172), font=small)
    stream = io.BytesIO()
    sheet.save(stream, format="PNG")
    return stream.getvalue()


def animation(ocean: Ocean, frames: int) -> bytes:
    """
    Draw an animated WebP: the sea in perspective through its loop, in its own time, for ever.

    At most `FILM_FRAMES` of the frames are drawn, every second or third of them, so that neither time nor size grow with the bake. A
    loop that is too long to be watched in its own time, 2 s a frame, runs faster; one that is too quick, slower.

    Raises:
        OutputError: this Pillow cannot write WebP.
    """
    from PIL import Image, features

    if not features.check("webp"):
        raise OutputError("an animated preview needs a Pillow that can write WebP (pip install --upgrade pillow)")
    assert ocean.loop is not None  # what is baked is a loop
    shown = range(0, frames, math.ceil(frames / FILM_FRAMES))
    ends = [1000.0 * ocean.loop * j / frames for j in [*shown, frames]]
    lasting = [min(max(round(end) - round(start), 20), 2000) for start, end in pairwise(ends)]
    film = (Image.fromarray(_developed(perspective(ocean.loop_frame(j, frames, FIELDS), *FILM))) for j in shown)
    stream = io.BytesIO()
    first = next(film)
    first.save(stream, format="WEBP", save_all=True, append_images=film, duration=lasting, loop=0, quality=FILM_QUALITY, method=2)
    return stream.getvalue()


def tiling(ocean: Ocean, frames: int) -> bytes:
    """
    Draw a PNG of frame 0 from above, two tiles wide and two high: a seam would show between the marks on the rim.

    The four are one picture before it is made smaller or larger, so that nothing but the tile itself can make a seam.
    """
    from PIL import Image, ImageDraw

    frame = ocean.loop_frame(0, frames, FIELDS)
    four = np.tile(_developed(from_above(frame)), (2, 2, 1))
    width, height = (2 * side for side in _fitted(frame, TILE))
    sheet = Image.new("RGB", (width + 2 * MARGIN, height + 2 * MARGIN), BACKGROUND)
    sheet.paste(Image.fromarray(four).resize((width, height), Image.Resampling.LANCZOS), (MARGIN, MARGIN))
    draw = ImageDraw.Draw(sheet)
    x, y = MARGIN + width // 2, MARGIN + height // 2
    for mark in ((x, 4, x, MARGIN - 4), (x, height + MARGIN + 4, x, height + 2 * MARGIN - 4)):
        draw.line(mark, fill=(225, 232, 238), width=2)
    for mark in ((4, y, MARGIN - 4, y), (width + MARGIN + 4, y, width + 2 * MARGIN - 4, y)):
        draw.line(mark, fill=(225, 232, 238), width=2)
    stream = io.BytesIO()
    sheet.save(stream, format="PNG")
    return stream.getvalue()


def from_above(frame: Frame) -> Picture:
    """Shade the tile as seen from high up in the south, sun in the north; row 0 is the north edge."""
    view = np.array([0.0, -0.86, 0.51])
    n = frame.normal.astype(np.float64)
    lit = _water(n, np.broadcast_to(view, n.shape), frame.height.astype(np.float64), _scale(frame))
    return lit[::-1]


def perspective(frame: Frame, width: int, height: int) -> Picture:
    """
    Shade the sea in perspective, looking north from a few metres up, the tile repeated out to the horizon.

    Each picture column is a ray of ground positions running away from the eye; where the surface rises above all that is nearer,
    it is seen. The horizontal displacement moves the sample a ray hits, so crests are as sharp as they are in the sea.
    """
    grid = frame.grid
    scale = _scale(frame)
    eye = max(4.0 * scale, 0.020 * grid.ly)
    nearest, farthest = 1.0 * eye, 40.0 * grid.ly
    focal, horizon = 0.9 * width, 0.30 * height
    distance = np.geomspace(nearest, farthest, max(200, 3 * height))[:, None]
    across = (np.arange(width) + 0.5 - 0.5 * width)[None, :] / focal
    x, y = across * distance + 0.37 * grid.lx, distance + np.zeros_like(across)
    moved = _sampled(np.stack([frame.displace_x, frame.displace_y], axis=-1), x, y, frame)
    x, y = x - frame.choppiness * moved[..., 0], y - frame.choppiness * moved[..., 1]  # one step back to the undisplaced position
    z = _sampled(frame.height[..., None], x, y, frame)[..., 0]
    screen = horizon + focal * (eye - z) / distance  # picture row at which each sample appears
    seen = np.minimum.accumulate(screen, axis=0)
    rows = np.arange(height) + 0.5
    hit = np.stack([np.searchsorted(-seen[:, c], -rows) for c in range(width)], axis=1)  # first sample at or above the row
    sky = hit >= distance.shape[0]
    hit = np.minimum(hit, distance.shape[0] - 1)
    columns = np.arange(width)[None, :]
    n = _sampled(frame.normal, x[hit, columns], y[hit, columns], frame)
    far = distance[hit, 0]
    # far waves are smaller than a pixel: their slopes average out, and the water turns to the colour of the low sky
    calm = np.clip(far * far / (focal * eye) / (0.12 * grid.ly), 0.0, 1.0)[..., None]
    n = _unit(n * (1.0 - 0.82 * calm) + np.array([0.0, 0.0, 1.0]) * 0.82 * calm)
    toward_eye = np.stack([-across * far, -far, eye - z[hit, columns]], axis=-1)
    lit = _water(n, _unit(toward_eye), z[hit, columns], scale)
    haze = np.clip((far / farthest) ** 0.7, 0.0, 1.0)[..., None]
    lit = lit * (1.0 - 0.85 * haze) + HORIZON * 0.85 * haze
    elevation = np.clip((horizon - rows) / height, 0.0, 1.0)
    picture: Picture = np.where(sky[..., None], _sky(0.8 * elevation)[:, None], lit)
    return picture


def _water(normal: Real, view: Real, height: Real, scale: float) -> Picture:
    """Light from the water: what it mirrors of sky and sun, and what comes out of it, shared out by Fresnel's law (Schlick 1994)."""
    facing = np.clip(_dot(normal, view), 0.0, 1.0)
    mirror = 2.0 * facing[..., None] * normal - view
    fresnel = (0.02 + 0.98 * (1.0 - facing) ** 5)[..., None]
    sparkle = np.clip(_dot(mirror, SUN), 0.0, 1.0)
    glint = (2.2 * sparkle**220 + 0.10 * sparkle**18)[..., None] * np.array([1.0, 0.93, 0.78])
    lift = np.clip(0.45 + 0.42 * height / scale, 0.0, 1.0)[..., None]
    body = (DEEP * (1.0 - lift) + SHALLOW * lift) * (0.55 + 0.75 * np.clip(_dot(normal, SUN), 0.0, 1.0))[..., None]
    light: Picture = (1.0 - fresnel) * body + fresnel * _sky(np.maximum(mirror[..., 2], 0.0)) + glint * (0.25 + fresnel)
    return light


def _sky(elevation: Real) -> Picture:
    """Bright at the horizon, blue overhead; `elevation` is the sine of the angle above the horizon."""
    blend = (np.clip(elevation, 0.0, 1.0) ** 0.42)[..., None]
    light: Picture = HORIZON * (1.0 - blend) + ZENITH * blend
    return light


def _scale(frame: Frame) -> float:
    """A height to measure the waves by: twice their standard deviation, or a sliver of the tile where there are none [m]."""
    return max(2.0 * float(np.std(frame.height, dtype=np.float64)), 1e-3 * frame.grid.ly)


def _sampled(field: Real, x: Real, y: Real, frame: Frame) -> Real:
    """A field (ny, nx, channels) between its samples, bilinear and periodic; of the shape of x and y, and the channels."""
    grid = frame.grid
    out = np.zeros((x.size, field.shape[-1]))
    interpolate.bilinear(field, np.ravel(x * (grid.nx / grid.lx)), np.ravel(y * (grid.ny / grid.ly)), out)
    return out.reshape(*x.shape, -1)


def _spread(frames: int, most: int) -> list[int]:
    """At most so many of a loop's frames, evenly spread, the first among them."""
    pictures = min(most, frames)
    return [i * frames // pictures for i in range(pictures)]


def _fitted(frame: Frame, side: int) -> tuple[int, int]:
    """Width and height in pixels of the tile's picture, the longer of them `side`."""
    longer = max(frame.grid.lx, frame.grid.ly)
    return max(1, round(side * frame.grid.lx / longer)), max(1, round(side * frame.grid.ly / longer))


def _unit(vectors: Real) -> Real:
    """The same vectors at length 1."""
    result: Real = vectors / np.sqrt(_dot(vectors, vectors))[..., None]
    return result


def _dot(a: Real, b: Real) -> Real:
    """Scalar products along the last axis, of three."""
    result: Real = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]
    return result


def _developed(light: Picture) -> npt.NDArray[np.uint8]:
    """Linear light to sRGB bytes, highlights rolled off."""
    exposed = 1.0 - np.exp(-1.9 * np.maximum(light, 0.0))
    srgb = np.where(exposed <= 0.0031308, 12.92 * exposed, 1.055 * np.maximum(exposed, 1e-9) ** (1.0 / 2.4) - 0.055)
    return np.asarray(np.rint(255.0 * np.clip(srgb, 0.0, 1.0)), dtype=np.uint8)
