"""
Pictures of the live page in a browser: no hole in the water, the same brightness at any size, no
repetition from above, foam of the coverage of its wind.

The seas are small and so are the pictures: the browser draws without a graphics card.
"""

import base64
import math
import warnings

import numpy as np
import pytest
from scipy import integrate, ndimage, stats
from web import floats

import fftocean as fo
from fftocean.runtime import pack, to_bytes

pytestmark = pytest.mark.client

EARTH = 6371e3
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
# the colour behind false colours, which no colour map holds
PLAIN = (23, 23, 26)
N = 64
TICKS = tuple(range(20000, 520000, 80000))


def cox_munk(speed, direction):
    """Return the slope covariance of a clean sea (Cox & Munk 1954), a matrix."""
    c, s = math.cos(math.radians(direction)), math.sin(math.radians(direction))
    turn = np.array([[c, -s], [s, c]])
    return turn @ np.diag([0.00316 * speed, 0.003 + 0.00192 * speed]) @ turn.T


def sea_of(speed, sizes, fetch=150e3):
    """Return a cascade of a wind sea toward 30 degrees."""
    sea = fo.Sea.from_wind(speed=speed, fetch=fetch, direction=30.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a short loop and coarse tiles: enough to look at
        return fo.Cascade(sea, tiles=[(N, size) for size in sizes], seed=7, loop=64.0)


@pytest.fixture(scope="module")
def show(browser):
    """Return a function that packs a sea, draws pictures of it and returns the answers."""
    packed = {}

    def drawn(name, pictures, *, speed=11.0, sizes=(420.0, 61.0, 8.3), **document):
        if name not in packed:
            packed[name] = pack(sea_of(speed, sizes), wind=(speed, 30.0), reference=False)
            path = browser.site.folders["bakes"] / f"{name}.sea"
            path.write_bytes(to_bytes(packed[name]))
        captured = packed[name].document["slope_variance"]["captured"]
        total = cox_munk(speed, 30.0)[[0, 1, 0], [0, 1, 1]]
        variance = {"total": list(total), "captured": captured, "beyond": list(total - captured)}
        common = {
            "name": f"/bakes/{name}.sea",
            "quality": "low",
            "document": {"slope_variance": variance, **document},
        }
        answers, _ = browser.run(
            "picture.html", {"pictures": [{**common, **picture} for picture in pictures]}
        )
        for answer in answers:
            assert answer["error"] == 0
        return answers

    return drawn


def colours(answer, picture):
    """Return the pixels of a picture, (height, width, 3), row 0 at the top."""
    texels = np.frombuffer(base64.b64decode(answer["colours"]), np.uint8)
    return texels.reshape(picture["height"], picture["width"], 4)[::-1, :, :3]


def luminance(answer, picture):
    """Return the luminance of a picture of radiance, (height, width), row 0 at the top."""
    radiance = floats(answer["radiance"], picture["height"], picture["width"], 4)
    return radiance[::-1, :, :3] @ LUMINANCE


def elevations(picture):
    """Return the elevation of the ray of each pixel [rad], (height, width), row 0 on top."""
    width, height = picture["width"], picture["height"]
    camera = picture["camera"]
    pitch, half = math.radians(camera["pitch"]), math.radians(camera["fieldOfView"] / 2)
    x = (np.arange(width) + 0.5) / width * 2 - 1
    y = 1 - (np.arange(height) + 0.5) / height * 2
    right, up = np.meshgrid(x * math.tan(half) * width / height, y * math.tan(half))
    rise = math.sin(pitch) + up * math.cos(pitch)
    return np.arcsin(rise / np.sqrt(1 + right**2 + up**2))


def views():
    """Return 24 cameras: below the crests and high above, from straight down to level."""
    for height in (0.5, 3.0, 30.0, 800.0):
        for pitch, field in ((-90, 50), (-65, 70), (-35, 50), (-12, 90), (-3, 40), (0, 50)):
            yield {
                "camera": {
                    "height": height,
                    "pitch": pitch,
                    "fieldOfView": field,
                    "yaw": 37.0 * height + 11.0 * pitch,
                    "east": 13.0 * height,
                },
                "width": 96,
                "height": 54,
                "look": {"view": "height"},
                "answer": "colours",
            }


def test_no_sky_is_seen_below_the_horizon(show):
    """
    Over 24 cameras in a gale, every pixel that looks at least a pixel below the horizon shows
    water.
    """
    pictures = list(views())
    answers = show("gale", pictures, speed=20.0, sizes=(620.0, 83.0, 11.3))
    for picture, answer in zip(pictures, answers, strict=True):
        camera = picture["camera"]
        # the eye may have been lifted to a crest of at most 12 m
        dip = math.sqrt(2 * max(camera["height"], 12.0) / EARTH)
        pixel = 2 * math.tan(math.radians(camera["fieldOfView"] / 2)) / picture["height"]
        below = elevations(picture) < -dip - pixel
        plain = (colours(answer, picture) == PLAIN).all(axis=-1)
        assert not (plain & below).any(), camera
        assert below.any()
        if camera["pitch"] == 0 and camera["height"] > 20:
            assert plain.any()  # the sky is there where it belongs


@pytest.mark.parametrize(("height", "sun"), [(6.0, 60.0), (60.0, 60.0), (6.0, 215.0)])
def test_a_small_picture_is_as_bright_as_a_large_one(show, height, sun):
    """
    Rows of a picture of a quarter of the size, against the same rows of the full one averaged
    down: within 5 %, but for what so few facets leave to chance.

    What filtering takes from the waves must come back as roughness, in the reflected sky, in the
    share that is reflected and in what the water hides of itself. A row of the small picture holds
    no more than some crests: rows are averaged over moments far apart, whose differences tell how
    far the mean may be off. Toward the sun a few facets make most of the light: there one moment of
    a row differs by 2 to 19 %, and 30 moments by 1.0 +- 0.3 % in the mean over rows.
    """
    look = {"sunElevation": 30.0, "sunAzimuth": sun, "clouds": 0.0}
    camera = {"height": height, "yaw": 215.0, "pitch": -8.0, "fieldOfView": 50.0}
    pictures = [
        {
            "camera": camera,
            "look": look,
            "width": 384 // part,
            "height": 216 // part,
            "tick": tick,
            "answer": "radiance",
        }
        for part in (1, 4)
        for tick in TICKS
    ]
    answers = show("breeze", pictures, foam=None)
    seen = [luminance(a, picture) for a, picture in zip(answers, pictures, strict=True)]
    moments = len(TICKS)
    full = np.array(seen[:moments]).reshape(moments, 54, 4, 96, 4).mean(axis=4)
    small = np.array(seen[moments:]).mean(axis=2)
    # rows whose upper edge lies a pixel below the horizon
    row = 27 - 27 * math.tan(math.radians(8.0)) / math.tan(math.radians(25.0))
    water = slice(math.ceil(row) + 2, None)
    rows = full.mean(axis=(2, 3))[:, water]
    apart = (small[:, water] - rows) / rows.mean(axis=0)
    bias, scatter = apart.mean(axis=0), apart.std(axis=0, ddof=1)
    toward_sun = sun == camera["yaw"]
    chance = 3.0 * scatter / math.sqrt(moments) if toward_sun else 0.0
    assert (np.abs(bias) < 0.05 + chance).all()
    assert abs(bias.mean()) < (0.03 if toward_sun else 0.02)
    # filtering beats the choice of one row of pixels in four
    chosen = (full.mean(axis=3)[:, water] - rows[:, :, None]) / rows.mean(axis=0)[:, None]
    assert scatter.mean() < np.sqrt((chosen**2).mean())


def test_nothing_repeats_from_400_m(show):
    """
    Straight down from 400 m, the picture and itself one tile further are not alike, nor are they
    up to six tiles further; the largest tile is 12 wavelengths of the peak wide.
    """
    speed = 7.0
    peak = fo.Sea.from_wind(speed=speed, fetch=150e3).tp ** 2 * 9.80665 / (2 * math.pi)
    sizes = (12 * peak, 1.7 * peak, 0.24 * peak)
    pixels, metres = 400, 2.5 * 12 * peak
    picture = {
        "camera": {
            "height": 400.0,
            "pitch": -90.0,
            "yaw": 90.0,
            "fieldOfView": 2 * math.degrees(math.atan(metres / 2 / 400.0)),
        },
        "look": {"sunElevation": 4.0, "sunAzimuth": 0.0, "clouds": 0.0},
        "width": pixels,
        "height": pixels,
        "answer": "radiance",
    }
    pictures = [{**picture, "tick": 75000 * i} for i in range(1, 7)]
    answers = show("light-wind", pictures, speed=speed, sizes=sizes, foam=None)
    seen = np.array([luminance(answer, picture) for answer in answers])
    # what the light does without waves is the mean over moments
    waves = seen - seen.mean(axis=0)
    waves /= np.sqrt(ndimage.gaussian_filter((waves**2).mean(axis=0), 12))
    for size, most in ((sizes[0], 1), (sizes[1], 6)):
        for axis in (1, 2):
            for times in range(1, most + 1):
                # a tile is no whole number of pixels: the largest of the neighbouring shifts
                step = round(times * size / metres * pixels)
                alike = []
                for shift in range(step - 1, step + 2):
                    first = np.take(waves, range(pixels - shift), axis)
                    second = np.take(waves, range(shift, pixels), axis)
                    alike.append(np.corrcoef(first.ravel(), second.ravel())[0, 1])
                assert max(alike) < 0.1, (size, axis, times)


def test_two_pictures_of_a_still_sea_are_equal(show):
    """Paused: two pictures have equal pixels; at another tick they differ."""
    picture = {
        "camera": {"height": 5.0, "yaw": 100.0, "pitch": -8.0, "fieldOfView": 50.0},
        "look": {"buoy": True},
        "width": 160,
        "height": 90,
        "answer": "colours",
        "foam": {"steps": 2, "seconds": 0.5},
    }
    later = {**picture, "tick": 140000}
    first, second, third = (
        colours(answer, picture) for answer in show("breeze", [picture, picture, later])
    )
    assert np.array_equal(first, second)
    assert not np.array_equal(first, third)


def test_every_view_shows_something_of_its_own(show):
    """Each view draws without an error, and no two look alike."""
    names = [
        "sea",
        "height",
        "slopes",
        "normals",
        "jacobian",
        "foam",
        "roughness",
        "tiles",
        "wireframe",
    ]
    pictures = [
        {
            "camera": {"height": 8.0, "yaw": 215.0, "pitch": -14.0, "fieldOfView": 50.0},
            "look": {"view": name},
            "width": 256,
            "height": 144,
            "answer": "colours",
        }
        for name in names
    ]
    seen = [
        colours(answer, picture).astype(float)
        for answer, picture in zip(show("breeze", pictures), pictures, strict=True)
    ]
    for i, first in enumerate(seen):
        assert first[80:].std() > 1.0 or names[i] == "foam"
        for second in seen[:i]:
            assert np.abs(first - second).mean() > 2.0


def test_the_sky_has_no_bands(show):
    """
    The sky's colours change by less than one step from pixel to pixel: noise of half a step hides
    the steps, and rows of equal colour do not occur.
    """
    picture = {
        "camera": {"height": 5.0, "yaw": 240.0, "pitch": 25.0, "fieldOfView": 40.0},
        "look": {"sunElevation": 30.0, "sunAzimuth": 60.0, "clouds": 0.0},
        "width": 160,
        "height": 90,
        "answer": "colours",
    }
    (answer,) = show("breeze", [picture])
    blue = colours(answer, picture)[..., 2].astype(float)
    assert np.unique(blue).size > 10
    assert (blue[:60].std(axis=1) > 0).mean() > 0.9
    # noise and no more: a smooth surface is left over when it is averaged out
    smooth = ndimage.uniform_filter(blue, 9)
    assert np.abs(blue - smooth)[5:-5, 5:-5].max() < 3.0


def test_a_sunset_does_not_burn_out(show):
    """Less than 5 % of the sky's pixels have a channel at its end, the sun in the picture."""
    for elevation in (2.0, 8.0, 25.0):
        picture = {
            "camera": {"height": 5.0, "yaw": 200.0, "pitch": 12.0, "fieldOfView": 45.0},
            "look": {"sunElevation": elevation, "sunAzimuth": 204.0},
            "width": 160,
            "height": 90,
            "answer": "colours",
        }
        (answer,) = show("breeze", [picture])
        sky = colours(answer, picture)[elevations(picture) > 0.01]
        assert (sky.max(axis=-1) == 255).mean() < 0.05, elevation


@pytest.mark.parametrize("mean", [-2.9, -1.0, 0.0, 0.5, 2.0, 5.5, 7.0, 30.0])
def test_the_facets_that_are_seen_have_the_moments_of_all(browser, mean):
    """
    Projected area y is normal with this mean and deviation 1, and facets count by y where it is
    positive: the shader's mean and its rule of four facets against quadrature.
    """
    moments = [
        integrate.quad(
            lambda y, order=order: y**order * stats.norm.pdf(y - mean),
            max(0.0, mean - 12),
            max(mean, 0.0) + 12,
            epsabs=1e-13,
        )[0]
        for order in range(1, 6)
    ]
    (answer,), _ = browser.run(
        "picture.html", {"pictures": [{"answer": "visible", "numbers": [mean]}]}
    )
    first, areas, weights = floats(answer["statistics"], 3, 4)
    # single precision, a tail good to 1e-7 of its own, a table of half floats
    assert first[0] == pytest.approx(moments[0], rel=2e-3)
    for order in range(5):
        found = float(weights @ areas**order)
        assert found == pytest.approx(moments[order] / moments[0], rel=1e-2), order


@pytest.mark.parametrize(("metres", "pixels"), [(73.7, 512), (737.0, 256)])
def test_broken_up_foam_covers_as_much(browser, metres, pixels):
    """
    Of water covered alike, the noise leaves the mean: near by, where its cells are seen, and from
    afar, where it is averaged out. The square holds whole periods of the noise.
    """
    covers = [0.01, 0.05, 0.3, 0.7, 0.97]
    picture = {"answer": "brokenUp", "covers": covers, "metres": metres, "pixels": pixels}
    (answer,), _ = browser.run("picture.html", {"pictures": [picture]})
    assert answer["error"] == 0
    for cover, mean in zip(covers, answer["means"], strict=True):
        assert mean == pytest.approx(cover, rel=0.08, abs=0.002)


@pytest.mark.parametrize("speed", [7.0, 10.0, 15.0, 20.0])
def test_foam_covers_what_whitecaps_cover(browser, speed):
    """
    The two windows of foam, over 40 s with the threshold of the sea's document, cover together
    3.84e-6 U^3.41 of the water (Monahan & O'Muircheartaigh 1980), within 25 %.
    """
    covered = covered_by_foam(browser, speed, (420.0, 61.0, 8.3))
    assert covered == pytest.approx(3.84e-6 * speed**3.41, rel=0.25)


@pytest.mark.parametrize(("speed", "sizes"), [(0.5, (60.0, 5.3, 0.47)), (2.5, (85.0, 7.5, 0.66))])
def test_light_winds_leave_the_water_dark(browser, speed, sizes):
    """On tiles whose waves are decimetres long: by the law 3e-7 and 7e-5, too rare to be met."""
    assert covered_by_foam(browser, speed, sizes) < 5e-4


def covered_by_foam(browser, speed, sizes):
    """Return the mean coverage in the windows of foam of a wind's package."""
    packed = pack(sea_of(speed, sizes, fetch=300e3), wind=(speed, 30.0), reference=False)
    name = f"foam-{speed:g}.sea"
    (browser.site.folders["bakes"] / name).write_bytes(to_bytes(packed))
    picture = {
        "name": f"/bakes/{name}",
        "quality": "low",
        "answer": "coverage",
        "foam": {"steps": 150, "seconds": 0.35, "averaged": 120},
    }
    (answer,), _ = browser.run("picture.html", {"pictures": [picture]})
    assert answer["error"] == 0
    return float(np.mean(answer["coverage"]))
