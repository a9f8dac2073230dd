"""The picture on top of a bake: it opens, it shows the sea that was baked, north up, and it is the same picture every time."""

import io

import numpy as np
import pytest
from PIL import Image

import fftocean as fo
from fftocean.bake import preview

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
FIELDS = ("height", "displace_x", "displace_y", "normal")


def ocean(**changes):
    return fo.Job.default().replaced({"ocean.n": 32, **{k.replace("__", "."): v for k, v in changes.items()}}).ocean()


def pixels(data):
    """A PNG as (rows, columns, 3) bytes, decoded to its end."""
    image = Image.open(io.BytesIO(data))
    assert image.format == "PNG"
    assert image.mode == "RGB"
    image.load()
    return np.asarray(image)


@pytest.fixture
def small(monkeypatch):
    """A sixteenth of the pixels: the picture's cost is in them."""
    for name, value in {"WIDTH": 320, "VIEW_HEIGHT": 115, "THUMBNAIL": 40}.items():
        monkeypatch.setattr(preview, name, value)


def thumbnail(sheet, i):
    """The i-th picture from above, at the places of a small sheet."""
    gap = (preview.WIDTH - preview.COLUMNS * preview.THUMBNAIL) // (preview.COLUMNS + 1)
    left = gap + (i % preview.COLUMNS) * (preview.THUMBNAIL + gap)
    top = preview.VIEW_HEIGHT + 40 + (i // preview.COLUMNS) * (preview.THUMBNAIL + 26)
    return sheet[top : top + preview.THUMBNAIL, left : left + preview.THUMBNAIL].astype(int)


def test_the_sheet_opens_and_is_not_blank():
    """At full size: the view above, twelve frames in two rows below it; all of them show something."""
    sheet = pixels(preview.contact_sheet(ocean(), 240, "Hs 1 m"))
    assert sheet.shape == (preview.VIEW_HEIGHT + 40 + 2 * (preview.THUMBNAIL + 26) + 8, preview.WIDTH, 3)
    assert sheet[: preview.VIEW_HEIGHT].std() > 10.0
    assert sheet[preview.VIEW_HEIGHT : preview.VIEW_HEIGHT + 40].max() > 200  # the caption
    for i in range(12):
        assert thumbnail(sheet, i).std() > 2.0


@pytest.mark.usefixtures("small")
def test_the_same_ocean_gives_the_same_bytes():
    one, two, other = (preview.contact_sheet(ocean(ocean__seed=seed), 24, "caption") for seed in (1, 1, 2))
    assert one == two
    assert one != other


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize(("frames", "rows"), [(1, 1), (2, 1), (5, 1), (6, 1), (7, 2), (11, 2), (12, 2), (16, 2), (240, 2)])
def test_the_frames_shown_are_spread_over_the_loop(frames, rows, monkeypatch):
    """All frames of a short loop, each once; of a long one twelve, evenly, the first among them."""
    asked = []
    real = fo.Ocean.loop_frame
    monkeypatch.setattr(fo.Ocean, "loop_frame", lambda self, j, *a: asked.append(j) or real(self, j, *a))
    monkeypatch.setattr(preview, "perspective", lambda _, width, height: np.zeros((height, width, 3)))
    sheet = pixels(preview.contact_sheet(ocean(ocean__n=4), frames, ""))
    assert sheet.shape[0] == preview.VIEW_HEIGHT + 40 + rows * (preview.THUMBNAIL + 26) + 8
    shown = asked[1:]  # after the still on top
    assert asked[0] == 0
    assert len(shown) == min(frames, 12)
    assert shown == sorted(set(shown))
    assert shown[0] == 0
    assert np.ptp(np.diff([*shown, frames])) <= 1  # even to one frame, across the seam of the loop too


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize(
    "changes",
    [
        {"ocean__n": 1},
        {"ocean__n": (1, 5)},
        {"ocean__n": (24, 40), "ocean__size": (30.0, 200.0)},
        {"ocean__n": 8, "ocean__size": (1e-3, 1e7)},
        {"ocean__n": 8, "ocean__size": (1e7, 1e-3)},
        {"sea__wind__speed": 0.0},
        {"sea__wind__speed": 150.0, "sea__wind__fetch": 5e7, "ocean__choppiness": 10.0, "ocean__size": 2e3},
        {"sea__depth": 1e-6, "ocean__size": 1.0},
    ],
    ids=str,
)
def test_any_ocean_has_a_picture(changes):
    """Nothing overflows or divides by zero on the way, which the suite would turn into an error, and all of it can be seen."""
    sheet = pixels(preview.contact_sheet(ocean(**changes), 2, "caption"))
    assert sheet.shape[1] == preview.WIDTH
    assert sheet[: preview.VIEW_HEIGHT].std() > 5.0  # sky and water at least


def test_thumbnails_keep_the_shape_of_the_tile(monkeypatch):
    """A tile twice as long as wide: its picture fills half the place."""
    for name, value in {"WIDTH": 320, "VIEW_HEIGHT": 30, "THUMBNAIL": 40}.items():
        monkeypatch.setattr(preview, name, value)
    background = np.array((16, 20, 24))
    for size, filled in (((50.0, 100.0), np.s_[:, :20]), ((100.0, 50.0), np.s_[:20])):
        picture = thumbnail(pixels(preview.contact_sheet(ocean(ocean__size=size), 1, "")), 0)
        drawn = np.any(picture != background, axis=-1)
        assert np.all(drawn[filled])
        drawn[filled] = False
        assert not np.any(drawn[:, 20:] if size[0] < size[1] else drawn[20:30])  # below it stands the time


def test_from_above_north_is_up_and_east_is_right():
    """One wave of 8 samples along x or y: the picture varies along columns or rows alone, and a crest is where the field has it."""
    for mx, my in ((1, 0), (0, 1)):
        sea = fo.Ocean.from_modes([(mx, my, 0.3, 1.0)], n=(16, 8), size=(16.0, 8.0), loop=8.0)
        frame = sea.loop_frame(0, 1, FIELDS)
        picture = preview.from_above(frame)
        assert picture.shape == (8, 16, 3)
        assert np.allclose(picture, picture[:1] if mx else picture[:, :1])
        assert np.ptp(picture[..., 1]) > 0.01
    lit = preview.from_above(frame)[:, 0, 1]
    turned = preview._water(
        frame.normal.astype(float), np.broadcast_to([0.0, -0.86, 0.51], frame.normal.shape), frame.height, preview._scale(frame)
    )
    assert np.allclose(lit, turned[::-1, 0, 1], atol=1e-6)  # float32 heights


def test_the_view_has_sky_above_and_water_below():
    """Seen across a flat sea, the horizon is where the eye's level says: 30 % of the way down; above it the sky of that elevation."""
    still = fo.Ocean.from_modes([], n=4, size=50.0, loop=8.0).loop_frame(0, 1, FIELDS)
    view = preview.perspective(still, 64, 50)
    assert view.shape == (50, 64, 3)
    assert np.all(np.isfinite(view))
    assert np.all(view >= 0.0)
    row = np.arange(50) + 0.5
    sky = preview._sky(np.broadcast_to(0.8 * (15.0 - row[:15]) / 50.0, (64, 15)).T)
    assert np.allclose(view[:14], sky[:14])
    assert not np.allclose(view[16:], preview.HORIZON)
    assert view[-1].mean() < 0.5 * view[0].mean()  # water at one's feet is darker than the sky


def test_waves_are_seen_below_the_horizon():
    """Their crests stay below the eye, so that the sky is that of the flat sea and the water is not."""
    waves = [(0, 2, 2.0, 0.0), (1, 1, 1.0, 0.3)]
    high, flat = (fo.Ocean.from_modes(m, n=32, size=60.0, loop=8.0).loop_frame(0, 1, FIELDS) for m in (waves, []))
    rough, calm = (preview.perspective(frame, 32, 50) for frame in (high, flat))
    assert np.array_equal(rough[:14], calm[:14])
    assert np.abs(rough - calm)[17:].max(axis=(1, 2)).min() > 1e-3  # in every row of water


def test_bilinear_sampling_is_exact_between_samples_and_round_the_seam():
    """A field that is a plane within the tile: halfway between two samples lies their mean, past the edge the other side follows."""
    frame = fo.Ocean.from_modes([], n=(4, 2), size=(8.0, 6.0), loop=1.0).loop_frame(0, 1, FIELDS)
    field = np.arange(8.0).reshape(2, 4)
    x, y = np.array([0.0, 1.0, 7.0, 8.0, -1.0, 2.0]), np.array([0.0, 0.0, 0.0, 6.0, 0.0, 1.5])
    assert preview._sampled(field, x, y, frame) == pytest.approx([0.0, 0.5, 1.5, 0.0, 1.5, 3.0])


def test_the_developed_picture_is_srgb():
    """Black is 0, much light is 255, darkness rises linearly; nothing below 0 or above 255."""
    light = np.array([-1.0, 0.0, 1e-4, 0.1, 1e9])[None, :, None] * np.ones(3)
    shown = preview._developed(light)[0, :, 0]
    assert shown[0] == shown[1] == 0
    assert shown[-1] == 255
    exposed = 1.0 - np.exp(-0.19)
    assert shown[3] == round(255 * (1.055 * exposed ** (1 / 2.4) - 0.055))
