"""The picture on top of a bake: the sea in perspective, and the tile from above through its loop."""

import io
import math

import numpy as np
import numpy.typing as npt

from fftocean.arrays import Real
from fftocean.ocean import Frame, Ocean

Picture = npt.NDArray[np.float64]
"""(rows, columns, 3) linear light, row 0 at the top."""

WIDTH, VIEW_HEIGHT, THUMBNAIL, COLUMNS = 1280, 460, 208, 6
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

    fields = ("height", "displace_x", "displace_y", "normal")
    pictures = min(2 * COLUMNS, frames)
    shown = [i * frames // pictures for i in range(pictures)]
    gap = (WIDTH - COLUMNS * THUMBNAIL) // (COLUMNS + 1)
    rows = math.ceil(len(shown) / COLUMNS)
    sheet = Image.new("RGB", (WIDTH, VIEW_HEIGHT + 40 + rows * (THUMBNAIL + 26) + 8), (16, 20, 24))
    still = ocean.loop_frame(0, frames, fields)
    sheet.paste(Image.fromarray(_developed(perspective(still, WIDTH, VIEW_HEIGHT))), (0, 0))
    draw, font, small = ImageDraw.Draw(sheet), ImageFont.load_default(17), ImageFont.load_default(13)
    draw.text((gap, VIEW_HEIGHT + 10), caption, fill=(225, 232, 238), font=font)
    for i, j in enumerate(shown):
        frame = ocean.loop_frame(j, frames, fields)
        picture = Image.fromarray(_developed(from_above(frame)))
        size = (THUMBNAIL, max(1, round(THUMBNAIL * frame.grid.ly / frame.grid.lx))) if frame.grid.lx >= frame.grid.ly else None
        size = size or (max(1, round(THUMBNAIL * frame.grid.lx / frame.grid.ly)), THUMBNAIL)
        corner = gap + (i % COLUMNS) * (THUMBNAIL + gap), VIEW_HEIGHT + 40 + (i // COLUMNS) * (THUMBNAIL + 26)
        sheet.paste(picture.resize(size, Image.Resampling.LANCZOS), corner)
        draw.text((corner[0] + 1, corner[1] + THUMBNAIL + 4), f"t = {frame.t:.2f} s", fill=(150, 162, 172), font=small)
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
    distance = np.geomspace(nearest, farthest, 1400)[:, None]
    across = (np.arange(width) + 0.5 - 0.5 * width)[None, :] / focal
    x, y = across * distance + 0.37 * grid.lx, distance + np.zeros_like(across)
    dx, dy = _sampled(frame.displace_x, x, y, frame), _sampled(frame.displace_y, x, y, frame)
    x, y = x - frame.choppiness * dx, y - frame.choppiness * dy  # one step back to the undisplaced position
    z = _sampled(frame.height, x, y, frame)
    screen = horizon + focal * (eye - z) / distance  # picture row at which each sample appears
    seen = np.minimum.accumulate(screen, axis=0)
    rows = np.arange(height) + 0.5
    hit = np.stack([np.searchsorted(-seen[:, c], -rows) for c in range(width)], axis=1)  # first sample at or above the row
    sky = hit >= distance.shape[0]
    hit = np.minimum(hit, distance.shape[0] - 1)
    columns = np.arange(width)[None, :]
    n = np.stack([_sampled(frame.normal[..., i], x[hit, columns], y[hit, columns], frame) for i in range(3)], axis=-1)
    far = distance[hit, 0]
    # far waves are smaller than a pixel: their slopes average out, and the water turns to the colour of the low sky
    calm = np.clip(far * far / (focal * eye) / (0.12 * grid.ly), 0.0, 1.0)[..., None]
    n = _unit(n * (1.0 - 0.82 * calm) + np.array([0.0, 0.0, 1.0]) * 0.82 * calm)
    toward_eye = np.stack([-across * far, -far, eye - z[hit, columns]], axis=-1)
    lit = _water(n, _unit(toward_eye), z[hit, columns], scale)
    haze = np.clip((far / farthest) ** 0.7, 0.0, 1.0)[..., None]
    lit = lit * (1.0 - 0.85 * haze) + HORIZON * 0.85 * haze
    elevation = np.clip((horizon - rows) / height, 0.0, 1.0)[:, None, None]
    picture: Picture = np.where(sky[..., None], _sky(np.broadcast_to(elevation[..., 0] * 0.8, sky.shape)), lit)
    return picture


def _water(normal: Real, view: Real, height: Real, scale: float) -> Picture:
    """Light from the water: what it mirrors of sky and sun, and what comes out of it, shared out by Fresnel's law (Schlick 1994)."""
    facing = np.clip(np.sum(normal * view, axis=-1), 0.0, 1.0)
    mirror = 2.0 * facing[..., None] * normal - view
    fresnel = (0.02 + 0.98 * (1.0 - facing) ** 5)[..., None]
    sparkle = np.clip(np.sum(mirror * SUN, axis=-1), 0.0, 1.0)
    glint = (2.2 * sparkle**220 + 0.10 * sparkle**18)[..., None] * np.array([1.0, 0.93, 0.78])
    lift = np.clip(0.45 + 0.42 * height / scale, 0.0, 1.0)[..., None]
    body = (DEEP * (1.0 - lift) + SHALLOW * lift) * (0.55 + 0.75 * np.clip(np.sum(normal * SUN, axis=-1), 0.0, 1.0))[..., None]
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
    """A field between its samples, bilinear and periodic."""
    grid = frame.grid
    u, v = x * (grid.nx / grid.lx), y * (grid.ny / grid.ly)
    i, j = np.floor(u), np.floor(v)
    fu, fv = u - i, v - j
    i0, j0 = i.astype(np.int64) % grid.nx, j.astype(np.int64) % grid.ny
    i1, j1 = (i0 + 1) % grid.nx, (j0 + 1) % grid.ny
    south = field[j0, i0] * (1.0 - fu) + field[j0, i1] * fu
    north = field[j1, i0] * (1.0 - fu) + field[j1, i1] * fu
    result: Real = south * (1.0 - fv) + north * fv
    return result


def _unit(vectors: Real) -> Real:
    """The same vectors at length 1."""
    result: Real = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return result


def _developed(light: Picture) -> npt.NDArray[np.uint8]:
    """Linear light to sRGB bytes, highlights rolled off."""
    exposed = 1.0 - np.exp(-1.9 * np.maximum(light, 0.0))
    srgb = np.where(exposed <= 0.0031308, 12.92 * exposed, 1.055 * np.maximum(exposed, 1e-9) ** (1.0 / 2.4) - 0.055)
    return np.asarray(np.rint(255.0 * np.clip(srgb, 0.0, 1.0)), dtype=np.uint8)
