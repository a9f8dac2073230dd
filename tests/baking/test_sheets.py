"""Preview images: they open, show the baked sea, and have the same bytes every time."""

import io
import itertools

import numpy as np
import pytest
from PIL import Image

import fftocean as fo
from fftocean import mips
from fftocean.baking.previews import render, whitecaps
from fftocean.baking.previews import sheets as preview
from fftocean.fields import DISPLACEMENT_GRADIENT
from fftocean.ocean import Frame

pytestmark = [
    pytest.mark.full_pictures,
    pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning"),
]
FIELDS = render.FIELDS


def ocean(**changes):
    return (
        fo.Job.default()
        .replaced({"ocean.n": 32, **{k.replace("__", "."): v for k, v in changes.items()}})
        .ocean()
    )


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
    """
    At full size: the view above, twelve frames in two rows below it; all of them show something.
    """
    sheet = pixels(preview.contact_sheet(ocean(), 240, "Hs 1 m"))
    assert sheet.shape == (
        preview.VIEW_HEIGHT + 40 + 2 * (preview.THUMBNAIL + 26) + 8,
        preview.WIDTH,
        3,
    )
    assert sheet[: preview.VIEW_HEIGHT].std() > 10.0
    assert sheet[preview.VIEW_HEIGHT : preview.VIEW_HEIGHT + 40].max() > 200  # the caption
    for i in range(12):
        assert thumbnail(sheet, i).std() > 1.0


@pytest.mark.usefixtures("small")
def test_the_same_ocean_gives_the_same_bytes():
    one, two, other = (
        preview.contact_sheet(ocean(ocean__seed=seed), 24, "caption") for seed in (1, 1, 2)
    )
    assert one == two
    assert one != other


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize(
    ("frames", "rows"),
    [(1, 1), (2, 1), (5, 1), (6, 1), (7, 2), (11, 2), (12, 2), (16, 2), (240, 2)],
)
def test_the_frames_shown_are_spread_over_the_loop(frames, rows, monkeypatch):
    """All frames of a short loop, each once; of a long one twelve, evenly, the first among them."""
    asked = []
    real = fo.Ocean.loop_frame
    monkeypatch.setattr(
        fo.Ocean, "loop_frame", lambda self, j, *a: asked.append(j) or real(self, j, *a)
    )
    monkeypatch.setattr(
        render, "perspective", lambda _, width, height: np.zeros((height, width, 3))
    )
    sheet = pixels(preview.contact_sheet(ocean(ocean__n=4), frames, ""))
    assert sheet.shape[0] == preview.VIEW_HEIGHT + 40 + rows * (preview.THUMBNAIL + 26) + 8
    shown = asked
    assert len(shown) == min(frames, 12)
    assert shown == sorted(set(shown))
    assert shown[0] == 0
    assert (
        np.ptp(np.diff([*shown, frames])) <= 1
    )  # even to one frame, across the seam of the loop too


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
        {
            "sea__wind__speed": 150.0,
            "sea__wind__fetch": 5e7,
            "ocean__choppiness": 10.0,
            "ocean__size": 2e3,
        },
        {"sea__depth": 1e-6, "ocean__size": 1.0},
    ],
    ids=str,
)
def test_any_ocean_has_a_preview(changes):
    """
    Nothing overflows or divides by zero on the way, which the suite would turn into an error, and
    all of it can be seen.
    """
    sheet = pixels(preview.contact_sheet(ocean(**changes), 2, "caption"))
    assert sheet.shape[1] == preview.WIDTH
    assert sheet[: preview.VIEW_HEIGHT].std() > 5.0  # sky and water at least


def test_thumbnails_keep_the_shape_of_the_tile(monkeypatch):
    """A tile twice as long as wide: its picture fills half the place."""
    for name, value in {"WIDTH": 320, "VIEW_HEIGHT": 30, "THUMBNAIL": 40}.items():
        monkeypatch.setattr(preview, name, value)
    background = np.array((16, 20, 24))
    for size, filled in (((50.0, 100.0), np.s_[:, :20]), ((100.0, 50.0), np.s_[:20])):
        picture = thumbnail(pixels(preview.contact_sheet(ocean(ocean__size=size), 2, "")), 1)
        drawn = np.any(picture != background, axis=-1)
        assert np.all(drawn[filled])
        drawn[filled] = False
        assert not np.any(
            drawn[:, 20:] if size[0] < size[1] else drawn[20:30]
        )  # below it stands the time


def test_from_above_north_is_up_and_east_is_right():
    """One long wave: light changes along columns or rows alone, and is that of the slope there."""
    for mx, my in ((1, 0), (0, 1)):
        sea = fo.Ocean.from_modes([(mx, my, 0.3, 1.0)], n=(32, 16), size=(32.0, 16.0), loop=8.0)
        frame = sea.loop_frame(0, 1, FIELDS)
        water = render.Water.of(frame)
        picture = render.from_above(water, 32, 16)
        assert picture.shape == (16, 32, 3)
        assert np.allclose(picture, picture[:1] if mx else picture[:, :1])
        assert np.ptp(picture[..., 1]) > 0.001
    mean = np.zeros((16, 8))
    mean[:, 1], mean[:, 4] = frame.slope_y[:, 0], frame.stretch_yy[:, 0]
    view = np.broadcast_to([0.0, -0.92, 0.39191836], (16, 3))
    lit = render.shade(mean, water, view, frame.height[:, 0], np.zeros(16))
    assert np.allclose(picture[::-1, 0], lit, atol=1e-5)  # float32 fields


# The view


def flat(**more):
    still = fo.Ocean.from_modes([], n=4, size=50.0, loop=8.0).loop_frame(0, 1, FIELDS)
    return render.Water.of(still, **more)


def test_the_horizon_lies_at_eye_level_with_sky_above_and_water_below():
    view = render.perspective(flat(), 200, 100)
    assert view.shape == (100, 200, 3)
    assert np.all(np.isfinite(view))
    assert np.all(view >= 0.0)
    row = np.arange(200) + 0.5  # two samples a pixel
    sky = render._sky((60.0 - row[:60]) / (render.FOCAL * 400.0)).reshape(30, 2, 3)
    shown = 1.0 - np.exp(-1.9 * sky)
    wanted = -np.log(1.0 - shown.mean(axis=1)) / 1.9
    assert np.allclose(view[:29], wanted[:29, None])
    left = view[:, :100]  # beside the buoy
    assert left[-1, 60:].mean() < 0.5 * left[0, 60:].mean()  # water at one's feet is dark


def test_the_buoy_is_as_high_as_perspective_says():
    """
    4 m at 42 m, with a focal length of 0.9 x 600 pixels: 51 rows, on flat water 10 m below the eye.
    """
    with_buoy = render.developed(render.perspective(flat(), 600, 240)).astype(int)
    red = (with_buoy[..., 0] > with_buoy[..., 2] + 80).any(axis=1)
    focal, horizon = 0.9 * 600, 0.3 * 240
    rows = np.flatnonzero(red)
    bottom = horizon + focal * 10.0 / 42.0
    assert rows[-1] == pytest.approx(bottom, abs=2.0)  # a row is red where half of it is
    assert rows[0] == pytest.approx(
        bottom - focal * 3.0 / 42.0, abs=2.0
    )  # the topmost metre is white
    # red from 0 to 1 m and from 2 to 3 m
    assert rows.size == pytest.approx(2.0 * focal / 42.0, abs=3)


def test_waves_hide_the_horizon_where_they_rise_above_the_eye():
    """A wave of 8 m along the line of sight, seen from its trough, stands higher than 10 - 8 m."""
    high = fo.Ocean.from_modes([(0, 1, 8.0, 0.0)], n=32, size=200.0, loop=8.0, choppiness=0.0)
    view = render.perspective(render.Water.of(high.loop_frame(0, 1, FIELDS)), 60, 60)
    calm = render.perspective(flat(), 60, 60)
    horizon = 18
    assert np.abs(view - calm)[horizon - 2, :40].max() > 0.02  # two rows up it is water, not sky
    # the crest is 6 m above the eye, some 100 m away: 3.2 rows of 54 a unit
    assert np.abs(view - calm)[horizon - 6, :40].max() < 1e-9


def test_the_view_shows_the_water_where_it_was_displaced_to():
    """
    Pushed sideways by a quarter of a wave, slopes as before: the picture of the waves moved by
    that.
    """
    still = fo.Ocean.from_modes([(1, 1, 0.5, 0.0)], n=32, size=60.0, loop=8.0, choppiness=1.0)
    frame = still.loop_frame(0, 1, FIELDS)
    fields = {name: np.array(frame[name]) for name in FIELDS}
    for name in ("stretch_xx", "stretch_xy", "stretch_yy", "displace_y"):
        fields[name] = np.zeros_like(fields[name])
    pushed = {**fields, "displace_x": np.full_like(frame.displace_x, 15.0)}
    rolled = {name: np.roll(values, 8, axis=1) for name, values in fields.items()}
    for one in (rolled, fields):
        one["displace_x"] = np.zeros_like(frame.displace_x)
    waters = [render.Water.of(Frame(0.0, frame.grid, 1.0, one)) for one in (pushed, rolled, fields)]
    pictures = [render.perspective(water, 48, 40, place=(0.0, 0.0)) for water in waters]
    near = np.s_[-14:]  # farther away, texels are averaged by fours, and the shift is no whole one
    assert np.allclose(pictures[0][near], pictures[1][near], atol=1e-4)  # float32
    assert not np.allclose(pictures[0][near], pictures[2][near], atol=1e-2)


def test_displaced_water_is_found_where_it_is():
    """
    The default sea at 1,000 places: heights against `fo.Query`, which inverts to its residual.
    """
    sea = ocean(ocean__n=128)
    water = render.Water.of(sea.loop_frame(0, 1, FIELDS))
    view = render._View(water, (0.0, 0.0), 1000.0, 1, 1, 100.0, np.geomspace(3.0, 3e4, 50))
    chance = np.random.default_rng(4)
    x, y = chance.uniform(0.0, 100.0, (2, 1000, 1))
    _, _, z, _ = view._surface(x, y, np.full(1000, 1e-3))
    query = fo.Query(sea, mode="bilinear", level="frame")
    truth = query.at(x[:, 0], y[:, 0], 0.0, "heights").heights
    error = z[:, 0] - truth
    # three steps of an iteration that contracts by the steepness: 0.3^3 of what displacement does
    assert np.sqrt(np.mean(error**2)) < 0.03 * np.std(truth)


def test_far_water_keeps_its_roughness():
    """Mean and covariance over any footprint add up to the second moment of all slopes."""
    frame = ocean(ocean__n=64).loop_frame(0, 1, FIELDS)
    water = render.Water.of(frame)
    x, y = np.random.default_rng(2).uniform(0.0, 100.0, (2, 4000))
    total = np.mean(frame.slope_x.astype(float) ** 2)
    for footprint in (1e-3, 3.0, 12.0, 1e4):
        mean = render._points(
            water.layers, x, y, np.full(x.size, footprint), render.SLOPES, squares=True
        )
        # of 4,000 points; between texels the mean of squares is interpolated, too
        assert np.mean(mean[:, 0] ** 2 + mean[:, 5]) == pytest.approx(total, rel=0.06)
    assert np.allclose(mean[:, 5], total, rtol=1e-3)


def test_ripples_have_the_roughness_of_the_waves_that_the_tile_cannot_hold():
    wanted = np.array([0.010, -0.003, 0.006])
    layer = render.Water.of(flat_frame(), rest=wanted).ripples
    last = layer.levels[-1][0, 0]
    assert np.allclose(last[5:], wanted, atol=2e-4)  # one draw: xy of two uncorrelated patterns
    assert np.allclose(last[:5], 0.0, atol=1e-6)


def flat_frame():
    return fo.Ocean.from_modes([], n=4, size=50.0, loop=8.0).loop_frame(0, 1, FIELDS)


def test_a_cascade_is_drawn_as_the_sum_of_its_tiles():
    """One sea on one tile, or its waves on two frames of the same tile: the same picture."""
    waves = [(1, 2, 0.5, 0.0), (3, -1, 0.2, 1.0)]
    both, *each = (
        fo.Ocean.from_modes(some, n=32, size=60.0, loop=8.0).loop_frame(0, 1, FIELDS)
        for some in (waves, waves[:1], waves[1:])
    )
    one, two = render.Water.of(both), render.Water.of(each)
    pictures = [render.perspective(water, 40, 30, place=(0.0, 0.0)) for water in (one, two)]
    assert np.abs(pictures[0] - pictures[1])[:9].max() < 1e-12  # sky
    assert (
        np.mean(np.abs(pictures[0] - pictures[1])) < 2e-3
    )  # cross products of slopes within a pixel


@pytest.mark.usefixtures("small")
def test_a_cascade_has_all_previews():
    sea = fo.Sea.from_wind(speed=12.0, fetch=100e3)
    both = fo.Cascade(sea, [(32, 200.0), (32, 31.0)], seed=3, loop=16.0)
    sheet = pixels(preview.contact_sheet(both, 4, "two tiles"))
    assert sheet[: preview.VIEW_HEIGHT].std() > 5.0
    assert Image.open(io.BytesIO(preview.animation(both, 2))).n_frames == 2
    assert pixels(preview.tiling(both, 2)).std() > 2.0


def test_a_pond_is_not_a_storm():
    """A stronger wind shows: more waves above the horizon, more foam, a wider glitter."""
    views = {}
    for wind, fetch, size in ((3.0, 300.0, 12.0), (28.0, 800e3, 1200.0)):
        sea = fo.Ocean(
            fo.Sea.from_wind(speed=wind, fetch=fetch), n=64, size=size, seed=1, loop=32.0
        )
        moments = preview._Frames(sea, 8, fo.Foam(), whitecaps.whitecap_cover(wind))
        views[wind] = render.perspective(next(moments.waters([0])), 160, 60)
    horizon = 18
    above = {wind: view[: horizon - 1, :90].std(axis=1).max() for wind, view in views.items()}
    assert above[3.0] < 1e-3 < above[28.0]  # waves stand before the sky of the storm alone
    bright = {wind: np.mean(view[horizon + 6 :, 116:] > 0.35) for wind, view in views.items()}
    assert bright[28.0] > 5.0 * bright[3.0] + 0.005


# Foam


def test_foam_is_where_the_foam_is():
    """Half of the tile covered: there the water is white, and nowhere else."""
    foam = np.zeros((16, 16))
    foam[:, :8] = 1.0
    water = flat(foam=foam)
    picture = render.from_above(water, 64, 64)
    assert picture[:, 4:28].min() > 0.3
    assert picture[:, 38:58].max() < 0.3


def test_broken_foam_covers_as_much_of_the_water_as_it_should():
    """Patches of foam of even coverage, near and far: their mean is that coverage."""
    x, y = np.random.default_rng(3).uniform(0.0, 16.0, (2, 40_000))
    for footprint in (1e-3, 0.1, 5.0):
        for coverage in (0.1, 0.3, 0.5, 0.8):
            shown = render._broken(np.full(x.size, coverage), x, y, np.full(x.size, footprint))
            # where patches end gradually, over 0.3 of their pattern, those near 0 and 1 are cut
            assert np.mean(shown) == pytest.approx(coverage, abs=0.03)


@pytest.mark.parametrize("cover", [0.003, 0.05, 0.2])
def test_the_threshold_is_found_for_a_cover(cover):
    sea = ocean(ocean__n=64)
    moments = [
        whitecaps.minimum_eigenvalue(sea.frame(-0.25 * i, DISPLACEMENT_GRADIENT))
        for i in reversed(range(40))
    ]
    caps = whitecaps.Whitecaps.before(moments, 0.25, fo.Foam(), cover)
    assert np.mean(caps.coverage) == pytest.approx(cover, rel=0.05)  # all points were looked at


def test_foam_of_previews_is_the_foam_of_the_library():
    """Of the default sea at frame 0 of a loop, against `Foam.loop`, in steps of 0.25 s."""
    sea = ocean(ocean__n=64, ocean__loop=16.0)
    foam = fo.Foam(threshold=0.8)
    truth = next(iter(foam.loop(sea, 64)))
    moments = [
        whitecaps.minimum_eigenvalue(sea.frame(-0.25 * i, DISPLACEMENT_GRADIENT))
        for i in reversed(range(64))
    ]
    shown = whitecaps.Whitecaps.before(moments, 0.25, foam).coverage
    assert np.mean(truth) > 0.01
    # crests move half a metre in a step, so foam is as much, and nearly in the same places
    assert np.mean(shown) == pytest.approx(np.mean(truth), rel=0.15)
    assert np.corrcoef(shown.ravel(), truth.ravel())[0, 1] > 0.9


def test_minimum_eigenvalue_of_summed_tiles_is_that_of_the_sum():
    """Two waves on one tile, and each on a frame of its own."""
    waves = [(1, 2, 0.5, 0.0), (3, -1, 0.2, 1.0)]
    both, *each = (
        fo.Ocean.from_modes(some, n=64, size=60.0, loop=8.0).loop_frame(0, 1, DISPLACEMENT_GRADIENT)
        for some in (waves, waves[:1], waves[1:])
    )
    one = whitecaps.minimum_eigenvalue(both)
    two = whitecaps.minimum_eigenvalue(each)[::6, ::6]  # 384 to 64
    assert np.allclose(one, two, atol=1e-6)  # float32


def test_whitecaps_of_a_wind():
    """
    Monahan & O'Muircheartaigh (1980): 1 % at 10 m/s; none in a light air; no more than at 20 m/s.
    """
    assert whitecaps.whitecap_cover(10.0) == pytest.approx(0.00987, abs=1e-4)
    assert whitecaps.whitecap_cover(3.0) == 0.0
    assert whitecaps.whitecap_cover(60.0) == whitecaps.whitecap_cover(20.0) < 0.12


def test_the_developed_image_is_srgb():
    """
    Black is 0, much light is 255; a grey that lies between two levels is dithered between them.
    """
    light = np.array([-1.0, 0.0, 0.1, 1e9])[None, :, None] * np.ones((64, 1, 3))
    shown = render.developed(light)
    assert shown[:, :2].max() == 0
    assert shown[:, 3].min() == 255
    exposed = 1.0 - np.exp(-0.19)
    level = 255 * (1.055 * exposed ** (1 / 2.4) - 0.055)
    assert set(np.unique(shown[:, 2])) <= {np.floor(level), np.ceil(level)}
    assert shown[:, 2].mean() == pytest.approx(level, abs=0.15)  # of 64 pixels


def test_the_sky_has_no_bands():
    """
    Along a row, no run of equal bytes is longer than chance allows, though the sky is even there.
    """
    view = render.developed(render.perspective(flat(), 256, 100))[2:26, :150].astype(int)
    lengths = [len(list(run)) for row in view[..., 0] for _, run in itertools.groupby(row)]
    rows = view[..., 0].mean(axis=1)
    assert (
        np.max(np.abs(np.diff(rows, 2))) < 0.6
    )  # rises evenly from row to row, in parts of a level
    assert np.median(lengths) < 8


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
@pytest.mark.parametrize(
    ("frames", "shown"),
    [(2, [0, 1]), (6, [0, 1, 2, 3, 4, 5]), (7, [0, 2, 4, 6]), (24, [0, 4, 8, 12, 16, 20])],
)
def test_the_film_runs_through_the_loop_in_its_own_time(frames, shown, monkeypatch):
    """
    Its pictures are the frames in perspective, of a lossy coder: 4 of 255 on average; together they
    last as long as the loop.
    """
    asked = []
    real = fo.Ocean.loop_frame
    monkeypatch.setattr(
        fo.Ocean, "loop_frame", lambda self, j, *a: asked.append(j) or real(self, j, *a)
    )
    sea = ocean(ocean__loop=2.0)
    pictures, lasting = film(preview.animation(sea, frames, cover=0.0))
    first = None
    assert asked == shown
    assert len(pictures) == len(shown)
    assert sum(lasting) == 2000
    for j, picture, duration in zip(shown, pictures, lasting, strict=True):
        first = first or render.trough(render.Water.of(real(sea, 0, frames, FIELDS)))
        water = render.Water.of(real(sea, j, frames, FIELDS), rest=mips.unresolved_slopes(sea))
        drawn = render.developed(render.perspective(water, *preview.FILM, place=first, taps=1))
        assert np.mean(np.abs(picture - drawn)) < 4.0
        assert abs(duration - 2000.0 * (min(j + shown[1], frames) - j) / frames) <= 1.0
    assert min(np.mean(np.abs(a - b)) for a, b in itertools.pairwise(pictures)) > 0.2  # it moves


def test_the_film_is_small_and_looks_like_the_sea():
    """
    Three frames at full size: bounded as promised, sky above water, and nothing of the coder's
    blocks in the sky.
    """
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


@pytest.mark.parametrize(
    ("size", "shape"), [(100.0, (80, 80)), ((50.0, 100.0), (80, 40)), ((100.0, 20.0), (16, 80))]
)
def test_the_tiling_shows_the_tile_four_times(size, shape, monkeypatch):
    """
    Each quarter is the tile from above, frame 0, to the byte that resizing rounds away; where they
    meet there is no other step.
    """
    monkeypatch.setattr(preview, "TILE", 40)
    sheet = pixels(preview.tiling(ocean(ocean__size=size), 24))
    m = preview.MARGIN
    assert sheet.shape == (shape[0] + 2 * m, shape[1] + 2 * m, 3)
    tiles = sheet[m:-m, m:-m].astype(int)
    rows, columns = shape[0] // 2, shape[1] // 2
    # the middle of each quarter: at the rim of the whole the resizing kernel is cut off
    inner = np.s_[rows // 4 : -(rows // 4), columns // 4 : -(columns // 4)]
    quarters = [
        tiles[a : a + rows, b : b + columns][inner] for a in (0, rows) for b in (0, columns)
    ]
    assert all(np.max(np.abs(quarter - quarters[0])) <= 1 for quarter in quarters)
    assert quarters[0].std() > 2.0
    across = np.mean(np.abs(np.diff(tiles, axis=1)), axis=(0, 2))
    along = np.mean(np.abs(np.diff(tiles, axis=0)), axis=(1, 2))
    for steps, seam in ((across, columns - 1), (along, rows - 1)):
        assert steps[seam] < 1.6 * np.max(np.delete(steps, seam))
    marked = np.any(sheet != np.array(preview.BACKGROUND), axis=-1)
    assert marked[:m].any(axis=0).nonzero()[0] == pytest.approx(m + columns, abs=1)
    assert marked[:, :m].any(axis=1).nonzero()[0] == pytest.approx(m + rows, abs=1)


def test_a_seam_would_be_seen(monkeypatch):
    """
    Light that grows across the tile and so does not repeat: the step at the seam stands out from
    all others.
    """
    monkeypatch.setattr(preview, "TILE", 32)
    real = render.from_above
    ramp = np.linspace(0.0, 0.2, 32)[None, :, None]
    monkeypatch.setattr(render, "from_above", lambda *given: real(*given) + ramp)
    flat = fo.Ocean.from_modes([(1, 0, 0.01, 0.0)], n=32, size=50.0, loop=8.0)
    tiles = pixels(preview.tiling(flat, 4))[
        preview.MARGIN : -preview.MARGIN, preview.MARGIN : -preview.MARGIN
    ].astype(int)
    across = np.mean(np.abs(np.diff(tiles, axis=1)), axis=(0, 2))
    assert np.argmax(across) == 31
    assert np.max(across) > 5.0 * np.median(across)
