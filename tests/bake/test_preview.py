"""The pictures beside a bake: they open, they show the sea that was baked, north up, and they are the same every time."""

import io
import itertools

import numpy as np
import pytest
from PIL import Image

import fftocean as fo
from fftocean.bake import preview
from fftocean.ocean import Frame

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


def test_the_view_shows_the_water_where_it_was_displaced_to():
    """Pushed sideways by a quarter of a wave, heights and normals as before: the picture of the waves that run across is another."""
    still = fo.Ocean.from_modes([(1, 1, 0.5, 0.0)], n=32, size=60.0, loop=8.0, choppiness=1.0).loop_frame(0, 1, FIELDS)
    fields = {name: still[name] for name in FIELDS}
    pushed = {**fields, "displace_x": np.full_like(still.displace_x, 15.0), "displace_y": np.zeros_like(still.displace_y)}
    rolled = {**fields, "displace_x": np.zeros_like(still.displace_x), "displace_y": np.zeros_like(still.displace_y)}
    for name in ("height", "normal"):
        rolled[name] = np.roll(still[name], 8, axis=1)  # a quarter of the tile east, by moving the samples
    pictures = [preview.perspective(Frame(0.0, still.grid, 1.0, arrays), 48, 40) for arrays in (pushed, rolled, fields)]
    assert np.allclose(pictures[0], pictures[1], atol=1e-6)  # float32
    assert not np.allclose(pictures[0], pictures[2], atol=1e-2)


def test_sampling_between_samples_and_round_the_seam():
    """A field that is a plane within the tile: halfway between two samples lies their mean, past the edge the other side follows."""
    frame = fo.Ocean.from_modes([], n=(4, 2), size=(8.0, 6.0), loop=1.0).loop_frame(0, 1, FIELDS)
    field = np.stack([np.arange(8.0).reshape(2, 4), np.ones((2, 4))], axis=-1)
    x, y = np.array([[0.0, 1.0, 7.0], [8.0, -1.0, 2.0]]), np.array([[0.0, 0.0, 0.0], [6.0, 0.0, 1.5]])
    sampled = preview._sampled(field, x, y, frame)
    assert sampled[..., 0] == pytest.approx(np.array([[0.0, 0.5, 1.5], [0.0, 1.5, 3.0]]))
    assert np.all(sampled[..., 1] == 1.0)


def test_the_developed_picture_is_srgb():
    """Black is 0, much light is 255, darkness rises linearly; nothing below 0 or above 255."""
    light = np.array([-1.0, 0.0, 1e-4, 0.1, 1e9])[None, :, None] * np.ones(3)
    shown = preview._developed(light)[0, :, 0]
    assert shown[0] == shown[1] == 0
    assert shown[-1] == 255
    exposed = 1.0 - np.exp(-0.19)
    assert shown[3] == round(255 * (1.055 * exposed ** (1 / 2.4) - 0.055))


# The loop in motion


@pytest.fixture
def short_film(monkeypatch):
    monkeypatch.setattr(preview, "FILM", (64, 32))
    monkeypatch.setattr(preview, "FILM_FRAMES", 6)


def film(data):
    """An animated WebP: its pictures, and how long each is shown [ms]."""
    image = Image.open(io.BytesIO(data))
    assert image.format == "WEBP"
    assert image.info["loop"] == 0  # for ever
    pictures, lasting = [], []
    for i in range(image.n_frames):
        image.seek(i)
        pictures.append(np.asarray(image.convert("RGB")).astype(int))
        lasting.append(image.info["duration"])
    return pictures, lasting


@pytest.mark.usefixtures("short_film")
@pytest.mark.parametrize(("frames", "shown"), [(2, [0, 1]), (6, [0, 1, 2, 3, 4, 5]), (7, [0, 2, 4, 6]), (24, [0, 4, 8, 12, 16, 20])])
def test_the_film_runs_through_the_loop_in_its_own_time(frames, shown, monkeypatch):
    """Its pictures are the frames in perspective, of a lossy coder: 4 of 255 on average; together they last as long as the loop."""
    asked = []
    real = fo.Ocean.loop_frame
    monkeypatch.setattr(fo.Ocean, "loop_frame", lambda self, j, *a: asked.append(j) or real(self, j, *a))
    sea = ocean(ocean__loop=2.0)
    pictures, lasting = film(preview.animation(sea, frames))
    assert asked == shown
    assert len(pictures) == len(shown)
    assert sum(lasting) == 2000
    for j, picture, duration in zip(shown, pictures, lasting, strict=True):
        drawn = preview._developed(preview.perspective(real(sea, j, frames, FIELDS), *preview.FILM))
        assert np.mean(np.abs(picture - drawn)) < 4.0
        assert abs(duration - 2000.0 * (min(j + shown[1], frames) - j) / frames) <= 1.0
    assert min(np.mean(np.abs(a - b)) for a, b in itertools.pairwise(pictures)) > 0.5  # it moves


def test_the_film_is_small_and_looks_like_the_sea():
    """Three frames at full size: bounded as promised, sky above water, and nothing of the coder's blocks in the sky."""
    data = preview.animation(ocean(ocean__n=64), 3)
    assert len(data) < 3 * 1e6 / preview.FILM_FRAMES
    pictures, _ = film(data)
    assert pictures[0].shape == (preview.FILM[1], preview.FILM[0], 3)
    sky, water = pictures[0][: preview.FILM[1] // 4], pictures[0][preview.FILM[1] // 2 :]
    assert np.mean(sky) > np.mean(water) + 10.0
    assert water.std() > 10.0
    assert np.max(np.std(sky.mean(axis=-1), axis=1)) < 3.0


@pytest.mark.usefixtures("short_film")
def test_films_of_strange_loops_can_be_watched():
    """From 20 ms to 2 s a picture, whatever the loop; the same bytes each time."""
    for loop, frames, each in ((1e-2, 2, 20), (1e9, 3, 2000), (3.0, 1, 2000)):
        sea = ocean(ocean__loop=loop)
        data = preview.animation(sea, frames)
        assert data == preview.animation(sea, frames)
        image = Image.open(io.BytesIO(data))
        image.load()
        assert image.n_frames == frames
        if frames > 1:  # a single picture stands still
            assert set(film(data)[1]) == {each}


def test_a_pillow_without_webp_is_named(monkeypatch):
    from PIL import features

    monkeypatch.setattr(features, "check", lambda _: False)
    with pytest.raises(fo.OutputError, match="needs a Pillow that can write WebP"):
        preview.animation(ocean(ocean__n=4), 2)


# Four tiles side by side


@pytest.mark.parametrize(("size", "shape"), [(100.0, (80, 80)), ((50.0, 100.0), (80, 40)), ((100.0, 20.0), (16, 80))])
def test_the_tiling_shows_the_tile_four_times(size, shape, monkeypatch):
    """Each quarter is the tile from above, frame 0, to the byte that resizing rounds away; where they meet there is no other step."""
    monkeypatch.setattr(preview, "TILE", 40)
    sheet = pixels(preview.tiling(ocean(ocean__size=size), 24))
    m = preview.MARGIN
    assert sheet.shape == (shape[0] + 2 * m, shape[1] + 2 * m, 3)
    tiles = sheet[m:-m, m:-m].astype(int)
    rows, columns = shape[0] // 2, shape[1] // 2
    # the middle of each quarter: at the rim of the whole the resizing kernel is cut off
    inner = np.s_[rows // 4 : -(rows // 4), columns // 4 : -(columns // 4)]
    quarters = [tiles[a : a + rows, b : b + columns][inner] for a in (0, rows) for b in (0, columns)]
    assert all(np.max(np.abs(quarter - quarters[0])) <= 1 for quarter in quarters)
    assert quarters[0].std() > 2.0
    across = np.mean(np.abs(np.diff(tiles, axis=1)), axis=(0, 2))
    along = np.mean(np.abs(np.diff(tiles, axis=0)), axis=(1, 2))
    assert across[columns - 1] < 2.0 * np.median(across)
    assert along[rows - 1] < 2.0 * np.median(along)
    marked = np.any(sheet != np.array(preview.BACKGROUND), axis=-1)
    assert marked[:m].any(axis=0).nonzero()[0] == pytest.approx(m + columns, abs=1)
    assert marked[:, :m].any(axis=1).nonzero()[0] == pytest.approx(m + rows, abs=1)


def test_a_seam_would_be_seen(monkeypatch):
    """Light that grows across the tile and so does not repeat: the step at the seam stands out from all others."""
    monkeypatch.setattr(preview, "TILE", 64)
    real = preview.from_above
    ramp = np.linspace(0.0, 0.05, 32)[None, :, None]
    monkeypatch.setattr(preview, "from_above", lambda frame: real(frame) + ramp)
    flat = fo.Ocean.from_modes([(1, 0, 0.01, 0.0)], n=32, size=50.0, loop=8.0)
    tiles = pixels(preview.tiling(flat, 4))[preview.MARGIN : -preview.MARGIN, preview.MARGIN : -preview.MARGIN].astype(int)
    across = np.mean(np.abs(np.diff(tiles, axis=1)), axis=(0, 2))
    assert np.argmax(across) in (62, 63, 64)
    assert np.max(across) > 5.0 * np.median(across)
