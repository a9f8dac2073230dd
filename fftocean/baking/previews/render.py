"""
Images of the sea surface in perspective and from above, in linear light.

The camera stands at a fixed height with a fixed lens and the light is always the same, so that two
seas can be compared by eye. Slopes are filtered as mean and covariance over what a pixel covers
(Olano & Baker 2010): far water keeps its roughness. The Fresnel term of a rough sea is that of
Bruneton, Neyret & Holzschuch (2010), the sun's glitter that of Gaussian facets (Cox & Munk 1954).

All sampled quantities are linear (displacement, height, slopes, displacement gradient), so that the
surface may be a sum of tiles: `Water.of(frames)` takes one frame or those of a cascade.
"""

import functools
import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from fftocean import mips
from fftocean.arrays import Real
from fftocean.fields import EIGHT
from fftocean.host import cores
from fftocean.kernels import interpolate
from fftocean.ocean import Frame

Image = npt.NDArray[np.float64]
"""(rows, columns, 3) linear light, row 0 at the top."""

Flags = npt.NDArray[np.bool_]

FIELDS = EIGHT
"""Fields of a frame that an image needs."""

EYE = 10.0
"""Height of the camera above the water that it floats on [m], as from the bridge of a ship."""
FOCAL, HORIZON_ROW = 0.9, 0.30
"""
Focal length in image widths, and height of the horizon, as a share of the image's height.
"""
FARTHEST = 30e3
"""Distance of the farthest water that is rendered [m]."""

BUOY_DISTANCE, BUOY_ACROSS, BUOY_HEIGHT, BUOY_RADIUS = 42.0, 0.20, 4.0, 0.28
"""Spar buoy: distance [m], tangent of its bearing, height and radius [m]."""

HORIZON, ZENITH, BODY, CREST = (
    np.array(c)
    for c in ((0.60, 0.68, 0.74), (0.07, 0.17, 0.36), (0.004, 0.026, 0.042), (0.010, 0.075, 0.080))
)
SUN = np.array([-0.46, 0.78, 0.42]) / math.sqrt(0.46**2 + 0.78**2 + 0.42**2)
SUNLIGHT = 3.2 * np.array([1.0, 0.93, 0.80])  # irradiance across the beam, where the low sky is 0.7
GLITTER = 0.22  # of the sun's disc, seen through haze
SKYLIGHT = np.array([0.95, 1.15, 1.40])  # irradiance of the whole sky
FOAM_ALBEDO = 0.50

_SMOOTHEST = 2e-5  # slope variance of water that carries no waves: its mirror is never perfect
_SOFT = 0.3  # how gradually patches of foam end, in shares of their pattern
_STEPS = 3  # of the search for the water that was displaced to a place
_STRIP = 96  # columns that are drawn at a time
_RIPPLES_N = 512
_GRAIN_SIZE, _GRAIN_N = 16.0, 512  # [m], texels of the pattern that breaks foam up


@dataclass(frozen=True, slots=True)
class Layer:
    """One tile: levels of (ny, nx, 11) means, each half as fine as the one before."""

    size: tuple[float, float]
    levels: tuple[Real, ...]
    _parts: dict[tuple[int, int, int], Real] = field(default_factory=dict, repr=False)

    def part(self, level: int, channels: slice) -> Real:
        """Return some channels of a level side by side, copied once."""
        level = min(level, len(self.levels) - 1)
        key = level, channels.start, channels.stop
        if key not in self._parts:
            self._parts[key] = np.ascontiguousarray(self.levels[level][..., channels])
        return self._parts[key]


MOVED, HEIGHT, SURFACE, SLOPES = slice(0, 2), slice(2, 3), slice(2, 5), slice(3, 11)
"""Channels of a tile: displacement; height; height and slopes; slopes, gradient xx, xy, yy of the
displacement, and second moments xx, xy, yy of the slopes."""
ALL_SLOPES, ONE = slice(0, 8), slice(0, 1)
"""Channels of the ripples, as `SLOPES`; of foam."""


@dataclass(frozen=True, slots=True)
class Water:
    """The sea surface at one time, ready to render."""

    layers: tuple[Layer, ...]
    choppiness: float
    ripples: Layer | None  # slopes of waves too short for the tiles, and their moments
    foam: Layer | None  # coverage 0..1 by undisplaced position
    hs: float  # 4 standard deviations of the height [m]

    @classmethod
    def of(
        cls,
        frames: Frame | Sequence[Frame],
        *,
        rest: Real | None = None,
        foam: Real | None = None,
        foam_size: tuple[float, float] | None = None,
    ) -> "Water":
        """
        Return the water of a frame, or of the frames of a cascade's tiles, which add.

        Args:
            frames: with the fields `FIELDS`.
            rest: slope covariance (xx, xy, yy) of the waves that the tiles cannot hold; they are
                drawn as a pattern of that roughness, without motion of its own.
            foam: coverage (ny, nx) in 0..1 by undisplaced position, repeated over `foam_size`.
            foam_size: width of the foam's pattern along x and y [m]; the first frame's tile.
        """
        tiles = (frames,) if isinstance(frames, Frame) else tuple(frames)
        first = tiles[0].grid
        covered = None
        if foam is not None and float(np.max(foam)) > 0.0:
            levels = mips.chain(np.asarray(foam, dtype=np.float32)[..., None])
            covered = Layer(foam_size or (first.lx, first.ly), tuple(levels))
        variance = sum(float(np.var(tile.height, dtype=np.float64)) for tile in tiles)
        finest = tiles[-1].grid
        texel = max(finest.lx / finest.nx, finest.ly / finest.ny)
        return cls(
            tuple(_layer(tile) for tile in tiles),
            float(tiles[0].choppiness),
            None if rest is None else _ripples(*(float(v) for v in rest), texel),
            covered,
            4.0 * math.sqrt(variance),
        )


def _layer(frame: Frame) -> Layer:
    """Return a frame's fields side by side, with the second moments of its slopes, and averages."""
    sx, sy = frame.slope_x, frame.slope_y
    fields = [frame.displace_x, frame.displace_y, frame.height, sx, sy]
    fields += [frame.stretch_xx, frame.stretch_xy, frame.stretch_yy, sx * sx, sx * sy, sy * sy]
    texels = np.stack(fields, axis=-1).astype(np.float32)
    return Layer((frame.grid.lx, frame.grid.ly), tuple(mips.chain(texels)))


@functools.cache
def _slopes_of_noise() -> tuple[Real, Real]:
    """Return slopes (n, n) along x and y of a random surface, each of variance 1, uncorrelated."""
    chance = np.random.Generator(np.random.PCG64(5))
    kx, ky = np.meshgrid(*(np.fft.fftfreq(_RIPPLES_N, 1.0 / _RIPPLES_N),) * 2)
    k = np.hypot(kx, ky)
    band = (k >= _RIPPLES_N / 48) & (k < _RIPPLES_N / 3)  # from two texels of the tile on
    surface = np.fft.fft2(chance.standard_normal((_RIPPLES_N, _RIPPLES_N)))
    surface *= np.where(band, np.maximum(k, 1.0) ** -2.0, 0.0)  # each octave as steep as the next
    slopes = [np.fft.ifft2(1j * along * surface).real for along in (kx, ky)]
    return slopes[0] / slopes[0].std(), slopes[1] / slopes[1].std()


@functools.lru_cache(maxsize=4)
def _ripples(xx: float, xy: float, yy: float, texel: float) -> Layer | None:
    """
    Return a pattern of slopes with a covariance, whose longest waves are two texels of the tile.
    """
    if not xx + yy > 0.0:
        return None
    first, second = _slopes_of_noise()
    a = math.sqrt(xx)
    b = xy / a if a > 0.0 else 0.0
    sx, sy = a * first, b * first + math.sqrt(max(yy - b * b, 0.0)) * second
    flat = np.zeros_like(sx)
    texels = np.stack([sx, sy, flat, flat, flat, sx * sx, sx * sy, sy * sy], axis=-1)
    side = 2.0 * texel * _RIPPLES_N / 48
    return Layer((side, side), tuple(mips.chain(texels.astype(np.float32))))


def perspective(
    water: Water,
    width: int,
    height: int,
    *,
    place: tuple[float, float] | None = None,
    finer: int = 2,
    taps: int = 2,
) -> Image:
    """
    Return the sea in perspective, looking north, the tiles repeated out to the horizon.

    Each column is a ray of ground positions running away from the eye. The water that was displaced
    to a position is found by fixed-point iteration; where it rises above all that is nearer, it is
    seen, between two samples by linear interpolation.

    Args:
        water: the surface to render.
        width, height: of the image [pixels].
        place: x and y of the camera [m]; None is `trough(water)`.
        finer: samples a pixel has, one above the other.
        taps: places along the line of sight that each sample averages.
    """
    rows = height * finer
    focal, horizon = FOCAL * width, HORIZON_ROW * rows
    steepest = height * (1.0 - HORIZON_ROW) / focal
    nearest = max(0.3 * EYE, 0.8 * EYE / steepest - 2.0 * water.hs)
    distance = np.geomspace(nearest, FARTHEST, max(200, int(1.6 * rows)))
    view = _View(water, place or trough(water), focal, finer, taps, horizon, distance)
    image = np.empty((height, width, 3))

    def draw(first: int) -> None:
        across = (np.arange(first, min(first + _STRIP, width)) + 0.5 - 0.5 * width) / focal
        light = view.strip(across, rows).reshape(height, finer, across.size, 3)
        image[:, first : first + _STRIP] = _rolled_off(light).mean(axis=1)

    with ThreadPoolExecutor(min(cores(), 8)) as threads:
        list(threads.map(draw, range(0, width, _STRIP)))
    return _unrolled(image)


def trough(water: Water) -> tuple[float, float]:
    """Return x and y of a low place on the first tile, for the camera: waves rise before it [m]."""
    layer = water.layers[0]
    lx, ly = layer.size
    level = int(_lod(layer, np.array(10.0)))
    height = layer.part(level, HEIGHT)[..., 0]
    j, i = np.unravel_index(int(np.argmin(height)), height.shape)
    return (float(i) + 0.5) * lx / height.shape[1], (float(j) + 0.5) * ly / height.shape[0]


class _View:
    """One perspective view of the surface, rendered a strip of columns at a time."""

    def __init__(
        self,
        water: Water,
        place: tuple[float, float],
        focal: float,
        finer: int,
        taps: int,
        horizon: float,
        distance: Real,
    ) -> None:
        self.water, self.focal, self.horizon = water, focal, horizon
        self.steep = focal * finer  # samples to a unit of slope along a column
        self.distance, self.taps = distance, taps
        spacing = np.maximum(np.gradient(distance), distance / focal)
        self.spacing = spacing
        self.x0, self.y0 = place
        aside, ahead = np.array([[-5.0, 0.0, 5.0]]), np.linspace(-5.0, 10.0, 6)[:, None]
        below = self._surface(aside + 0.0 * ahead, ahead, np.full(6, 2.0))[2]
        self.eye = EYE + float(np.mean(below))
        x, y = np.array([[BUOY_ACROSS * BUOY_DISTANCE]]), np.array([[BUOY_DISTANCE]])
        _, _, z, tilt = self._surface(x, y, np.array([BUOY_DISTANCE / focal]), slopes=True)
        self.buoy = float(z[0, 0]), float(np.clip(0.5 * tilt[0, 0, 0], -0.4, 0.4))

    def _surface(
        self, x: Real, y: Real, spacing: Real, *, slopes: bool = False
    ) -> tuple[Real, Real, Real, Real]:
        """Return the undisplaced position of the water at places, its height, and its slopes."""
        qx, qy = x + self.x0, y + self.y0 + np.zeros_like(x)
        px, py = qx, qy
        for _ in range(_STEPS if self.water.choppiness else 0):
            moved = _by_rows(self.water.layers, qx, qy, spacing, MOVED)
            qx = px - self.water.choppiness * moved[..., 0]
            qy = py - self.water.choppiness * moved[..., 1]
        found = _by_rows(self.water.layers, qx, qy, spacing, SURFACE if slopes else HEIGHT)
        return qx, qy, found[..., 0], found[..., 1:]

    def strip(self, across: Real, rows: int) -> Image:
        """Return some columns of the image; `across` is the tangent of each one's bearing."""
        distance = self.distance[:, None]
        qx, qy, z, _ = self._surface(across[None, :] * distance, distance, self.spacing)
        screen = self.horizon + self.steep * (self.eye - z) / distance
        seen = np.minimum.accumulate(screen, axis=0)
        wanted = np.arange(rows) + 0.5
        hit = np.empty((rows, across.size), dtype=np.intp)
        for c in range(across.size):
            hit[:, c] = np.searchsorted(-seen[:, c], -wanted)
        sky = hit >= distance.shape[0]
        after = np.clip(hit, 1, distance.shape[0] - 1)
        before, column = after - 1, np.arange(across.size)[None, :]
        low, high = screen[before, column], screen[after, column]
        gap = np.where(low > high, low - high, 1.0)
        share = np.clip((low - wanted[:, None]) / gap, 0.0, 1.0)

        def between(a: Real) -> Real:
            near = a[before, column]
            result: Real = near + share * (a[after, column] - near)
            return result

        far = self.distance[before] + share * (self.distance[after] - self.distance[before])
        step = np.abs(np.diff(far, axis=0, prepend=np.inf, append=np.inf))
        long = np.minimum(step[1:], step[:-1])  # at a crest, that on the same side of it
        light = self._shaded(between(qx), between(qy), between(z), far, long, across, sky)
        elevation = np.clip((self.horizon - wanted) / self.steep, 0.0, None)
        light[sky] = np.broadcast_to(_sky(elevation)[:, None], light.shape)[sky]
        self._buoy(light, far, sky, across, wanted)
        return light

    def _shaded(
        self, qx: Real, qy: Real, z: Real, far: Real, long: Real, across: Real, sky: Flags
    ) -> Image:
        """Return the light from the visible water, given its undisplaced positions."""
        shape = far.shape
        light = np.zeros((*shape, 3))
        wet = np.logical_not(sky)
        qx, qy, z, far, long = (a[wet] for a in (qx, qy, z, far, long))
        side = np.broadcast_to(across[None, :], shape)[wet]
        view = np.stack([-side * far, -far, self.eye - z], axis=-1)
        length = np.sqrt(_dot(view, view))
        view /= length[:, None]
        # a pixel covers this much water across, and along the line of sight
        wide = length / self.focal
        long = np.clip(long, wide, 0.5 * far)
        direction = np.stack([side, np.ones_like(side)], axis=-1)
        direction /= np.sqrt(1.0 + side * side)[:, None]
        grain = np.maximum(wide, long / self.taps)
        mean, foam = np.zeros((far.size, 8)), np.zeros(far.size)
        for tap in range(self.taps):
            offset = ((tap + 0.5) / self.taps - 0.5) * long
            x, y = qx + offset * direction[:, 0], qy + offset * direction[:, 1]
            part, covered = _averages(self.water, x, y, grain)
            mean += part / self.taps
            foam += covered / self.taps
        lit = shade(mean, self.water, view, z, foam)
        haze = (1.0 - np.exp(-length / 17e3))[:, None]
        light[wet] = lit * (1.0 - haze) + 0.96 * HORIZON * haze
        return light

    def _buoy(self, light: Image, far: Real, sky: Flags, across: Real, rows: Real) -> None:
        """Draw the buoy over what lies behind it: a pole with bands of 1 m, on a float."""
        z, tilt = self.buoy
        up = self.eye - z - (rows - self.horizon)[:, None] * BUOY_DISTANCE / self.steep
        aside = (across[None, :] - BUOY_ACROSS) * BUOY_DISTANCE + tilt * up
        radius = np.where(up < 0.35, 3.0 * BUOY_RADIUS, BUOY_RADIUS)
        # edges in part of a pixel
        covered = np.clip((radius - np.abs(aside)) * self.focal / BUOY_DISTANCE + 0.5, 0.0, 1.0)
        covered *= (up > -0.6) & (up < BUOY_HEIGHT)
        covered *= np.logical_or(sky, far > BUOY_DISTANCE - 2.0 * BUOY_RADIUS)
        inside = covered > 0.0
        if not inside.any():
            return
        turned = np.clip(aside / radius, -1.0, 1.0)[inside]
        facing = np.clip(0.85 * np.sqrt(1.0 - turned**2) - 0.5 * turned, 0.08, None)
        band = np.floor(np.broadcast_to(up, inside.shape)[inside]).astype(int) % 2 == 0
        paint = np.where(band[:, None], [0.62, 0.055, 0.02], [0.72, 0.72, 0.70])
        paint = paint * (0.30 * SKYLIGHT + 0.17 * SUNLIGHT * facing[:, None])
        light[inside] += covered[inside][:, None] * (paint - light[inside])


def from_above(water: Water, width: int, height: int) -> Image:
    """
    Return a map of the first tile's area, north up, with the sun in the north.

    Every point is lit as for an eye in the south, 23 degrees above the horizon: lower, more of the
    sky's mirror image shows the waves; higher, foam stands out more.

    Args:
        water: the surface to render.
        width, height: of the image [pixels].
    """
    lx, ly = water.layers[0].size
    ny, nx = height, width
    x = np.broadcast_to(np.arange(nx) * (lx / nx), (ny, nx)).ravel()
    y = np.broadcast_to((np.arange(ny) * (ly / ny))[:, None], (ny, nx)).ravel()
    grain = np.full(x.size, min(lx / nx, ly / ny))
    mean, foam = _averages(water, x, y, grain)
    z = _points(water.layers, x, y, grain, HEIGHT)[:, 0]
    view = np.broadcast_to([0.0, -0.92, 0.39191836], (x.size, 3))
    return shade(mean, water, view, z, foam).reshape(ny, nx, 3)[::-1]


def _averages(water: Water, x: Real, y: Real, footprint: Real) -> tuple[Real, Real]:
    """Return the averages that `shade` needs at undisplaced positions, and the foam there."""
    mean = _points(water.layers, x, y, footprint, SLOPES, squares=True)
    if water.ripples is not None:
        mean += _points((water.ripples,), x, y, footprint, ALL_SLOPES, squares=True)
    if water.foam is None:
        return mean, np.zeros(x.size)
    return mean, _broken(_points((water.foam,), x, y, footprint, ONE)[:, 0], x, y, footprint)


def shade(mean: Real, water: Water, view: Real, z: Real, foam: Real) -> Image:
    """
    Return the light that comes from water toward the eye, (points, 3).

    Args:
        mean: averages over what each point covers, (points, 8): slopes, displacement gradient
            xx, xy, yy, and the covariance xx, xy, yy of slopes.
        water: whose choppiness counts.
        view: unit vectors toward the eye, (points, 3).
        z: height of the water [m].
        foam: coverage 0..1.
    """
    c = water.choppiness
    sx, sy = mean[:, 0], mean[:, 1]
    a, b, d = 1.0 + c * mean[:, 2], c * mean[:, 3], 1.0 + c * mean[:, 4]
    jacobian = np.maximum(a * d - b * b, 0.15)
    zx = np.clip((d * sx - b * sy) / jacobian, -2.2, 2.2)
    zy = np.clip((a * sy - b * sx) / jacobian, -2.2, 2.2)
    xx = np.maximum(mean[:, 5], 0.0) + _SMOOTHEST
    yy = np.maximum(mean[:, 7], 0.0) + _SMOOTHEST
    xy = np.clip(mean[:, 6], -0.95 * np.sqrt(xx * yy), 0.95 * np.sqrt(xx * yy))

    flat = np.sqrt(np.maximum(view[:, 0] ** 2 + view[:, 1] ** 2, 1e-12))
    hx, hy = view[:, 0] / flat, view[:, 1] / flat
    along = xx * hx * hx + 2.0 * xy * hx * hy + yy * hy * hy  # slope variance along the view
    steep = np.sqrt(1.0 + zx * zx + zy * zy)
    cosine = np.clip((view[:, 2] - zx * view[:, 0] - zy * view[:, 1]) / steep, 0.02, 1.0)
    tangent = np.sqrt(1.0 - cosine * cosine) / cosine
    # of a rough sea one sees the facets that turn toward the eye
    turned = along * tangent / (1.0 + 1.2 * np.sqrt(along) * tangent)
    nx, ny = -(zx - hx * turned), -(zy - hy * turned)
    length = np.sqrt(1.0 + nx * nx + ny * ny)
    facing = np.clip((nx * view[:, 0] + ny * view[:, 1] + view[:, 2]) / length, 0.02, 1.0)
    sigma = np.sqrt(along)
    fresnel = 0.02 + 0.98 * (1.0 - facing) ** (5.0 * np.exp(-2.69 * sigma)) / (
        1.0 + 22.7 * sigma**1.5
    )
    up = 2.0 * facing / length - view[:, 2]  # of the mirrored ray
    lifted = np.where(up >= 0.0, up, -0.6 * up)
    dim = np.where(up >= 0.0, 1.0, 0.6)  # it meets other water on its way
    spread = np.sqrt(lifted**2 + along)  # a rough mirror shows a wide piece of the sky
    mirrored = _sky(spread) * dim[:, None]

    # facets that mirror the sun
    half = view + SUN
    half /= np.sqrt(_dot(half, half))[:, None]
    gx, gy = -half[:, 0] / half[:, 2] - zx, -half[:, 1] / half[:, 2] - zy
    sxx, syy = xx + 4e-4, yy + 4e-4  # the sun is no point
    determinant = sxx * syy - xy * xy
    exponent = 0.5 * (syy * gx * gx - 2.0 * xy * gx * gy + sxx * gy * gy) / determinant
    dense = np.exp(-np.minimum(exponent, 80.0)) / (2.0 * math.pi * np.sqrt(determinant))
    toward = np.clip(_dot(half, view), 0.0, 1.0)
    mirror = 0.02 + 0.98 * (1.0 - toward) ** 5
    shadow = 1.0 + 2.0 * sigma * tangent
    glint = mirror * dense / (4.0 * half[:, 2] ** 4 * np.maximum(cosine, 0.05) * shadow)

    sunny = np.clip((nx * SUN[0] + ny * SUN[1] + SUN[2]) / length, 0.0, 1.0)
    crest = np.clip(z / 4.0, 0.0, 1.5)[:, None] * np.clip(0.3 + zy + 0.5, 0.2, 1.0)[:, None]
    body = (BODY + 0.30 * CREST * crest) * (0.5 + 1.1 * sunny)[:, None]
    f = fresnel[:, None]
    light: Image = (1.0 - f) * body + f * mirrored
    light += np.minimum(GLITTER * glint, 0.5)[:, None] * SUNLIGHT
    white = FOAM_ALBEDO / math.pi * (SKYLIGHT + SUNLIGHT * sunny[:, None])
    light += foam[:, None] * (white - light)
    return light


def developed(light: Image) -> npt.NDArray[np.uint8]:
    """
    Return sRGB bytes of linear light: highlights rolled off, a dither of half a level at most.

    The dither is the same each time; without it the sky shows bands.
    """
    exposed = _rolled_off(light)
    srgb = np.where(
        exposed <= 0.0031308,
        12.92 * exposed,
        1.055 * np.maximum(exposed, 1e-9) ** (1.0 / 2.4) - 0.055,
    )
    rows, columns = light.shape[:2]
    dither = np.tile(_dither(), (-(-rows // _DITHER), -(-columns // _DITHER)))[:rows, :columns]
    return np.clip(np.floor(255.0 * srgb + 0.5 + dither[..., None]), 0.0, 255.0).astype(np.uint8)


_DITHER = 64


@functools.cache
def _dither() -> Real:
    """Return the dither of a square of pixels, between -1/2 and 1/2."""
    return np.random.Generator(np.random.PCG64(7)).random((_DITHER, _DITHER)) - 0.5


def _rolled_off(light: Image) -> Image:
    """
    Return light with highlights rolled off, 0..1; averages over a pixel are taken of these values,
    so that edges stay smooth.
    """
    result: Image = 1.0 - np.exp(-1.9 * np.maximum(light, 0.0))
    return result


def _unrolled(exposed: Image) -> Image:
    """Return the inverse of `_rolled_off`."""
    result: Image = -np.log(np.maximum(1.0 - exposed, 1e-12)) / 1.9
    return result


def _sky(elevation: Real) -> Image:
    """Return the sky's light at sines of elevation: bright at the horizon, blue overhead."""
    blend = (np.clip(elevation, 0.0, 1.0) ** 0.55)[..., None]
    light: Image = HORIZON * (1.0 - blend) + ZENITH * blend
    return light


@functools.cache
def _grain() -> Layer:
    """Return a pattern of even distribution in 0..1 that breaks foam up: streaks and cells."""
    chance = np.random.Generator(np.random.PCG64(11))
    k = np.hypot(*np.meshgrid(*(np.fft.fftfreq(_GRAIN_N, 1.0 / _GRAIN_N),) * 2))
    # octaves from 2 m down to the texel, each as strong as the next
    filtered = np.where((k >= 6.0) & (k < _GRAIN_N / 3.0), np.maximum(k, 1.0) ** -1.25, 0.0)
    noise = np.fft.ifft2(np.fft.fft2(chance.standard_normal((_GRAIN_N, _GRAIN_N))) * filtered).real
    levels = []
    for level in mips.chain(noise[..., None]):
        rank = np.empty(level.size)
        rank[np.argsort(level.ravel(), kind="stable")] = (np.arange(level.size) + 0.5) / level.size
        levels.append(rank.reshape(level.shape).astype(np.float32))
    return Layer((_GRAIN_SIZE, _GRAIN_SIZE), tuple(levels))


def _broken(coverage: Real, x: Real, y: Real, footprint: Real) -> Real:
    """
    Return foam as patches of a given coverage; far away, where no patch is visible, as a mean.
    """
    pattern = _points((_grain(),), x, y, footprint, ONE)[:, 0]
    # so soft, and no softer than keeps the mean at the ends
    soft = np.clip(2.0 * np.minimum(coverage, 1.0 - coverage), 1e-3, _SOFT)
    patches = np.clip((coverage - pattern) / soft + 0.5, 0.0, 1.0) * (coverage > 0.0)
    even = np.clip(footprint / 1.0, 0.0, 1.0)
    result: Real = patches + even * (coverage - patches)
    return result


def _by_rows(layers: Sequence[Layer], x: Real, y: Real, spacing: Real, channels: slice) -> Real:
    """
    Return the sum of layers at (rows, columns) of places, as fine as each row's `spacing`, rising.
    """
    out = np.zeros((*x.shape, channels.stop - channels.start))
    for layer in layers:
        lod = _lod(layer, spacing)
        whole = np.floor(lod).astype(int)
        for level in range(int(whole.min()), int(whole.max()) + 1):
            rows = np.flatnonzero(whole == level)
            if not rows.size:
                continue
            part = slice(rows[0], rows[-1] + 1)
            share = (lod[part] - level)[:, None, None]
            found = _level(layer, level, x[part], y[part], channels)
            if np.any(share > 0.0):
                coarse = _level(layer, level + 1, x[part], y[part], channels)
                found += share * (coarse - found)
            out[part] += found
    return out


def _points(
    layers: Sequence[Layer],
    x: Real,
    y: Real,
    footprint: Real,
    channels: slice,
    *,
    squares: bool = False,
) -> Real:
    """
    Return the sum of layers at points, (points, channels), each averaged over its footprint.

    With `squares` the last three channels are second moments of the first two; of each layer their
    covariance is added, as tiles hold different waves.
    """
    out = np.zeros((x.size, channels.stop - channels.start))
    for layer in layers:
        lod = _lod(layer, footprint)
        whole = np.floor(lod).astype(int)
        for level in range(int(whole.min()), int(whole.max()) + 1):
            here = np.flatnonzero(whole == level)
            if not here.size:
                continue
            share = (lod[here] - level)[:, None]
            found = _level(layer, level, x[here], y[here], channels)
            if np.any(share > 0.0):
                coarse = _level(layer, level + 1, x[here], y[here], channels)
                found += share * (coarse - found)
            if squares:
                found[:, 5] -= found[:, 0] ** 2
                found[:, 6] -= found[:, 0] * found[:, 1]
                found[:, 7] -= found[:, 1] ** 2
            out[here] += found
    return out


def _lod(layer: Layer, footprint: Real) -> Real:
    """Return the level of a layer, with its fraction, whose texels are as wide as the footprint."""
    ny, nx, _ = layer.levels[0].shape
    texel = max(layer.size[0] / nx, layer.size[1] / ny)
    lod: Real = np.clip(np.log2(footprint / texel), 0.0, len(layer.levels) - 1.0)
    return lod


def _level(layer: Layer, level: int, x: Real, y: Real, channels: slice) -> Real:
    """Return one level of a layer at places, bilinear and periodic."""
    texels = layer.part(level, channels)
    fy, fx, _ = layer.levels[0].shape
    ny, nx, _ = texels.shape
    # the texels of a level lie in the middle of those that they are made of
    u = np.ravel(x) * (nx / layer.size[0]) + (0.5 * nx / fx - 0.5)
    v = np.ravel(y) * (ny / layer.size[1]) + (0.5 * ny / fy - 0.5)
    out = np.zeros((u.size, texels.shape[-1]))
    interpolate.bilinear(texels, u, v, out)
    return out.reshape(*x.shape, -1)


def _dot(a: Real, b: Real) -> Real:
    """Return scalar products along the last axis, of three."""
    result: Real = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]
    return result
