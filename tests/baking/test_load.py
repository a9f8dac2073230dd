"""Loading of bakes: the same arrays from every format and engine, and damaged files refused."""

import shutil

import builders
import numpy as np
import pytest

import fftocean as fo
from fftocean.baking import bake as baker
from fftocean.baking.finished.load import Bake, BakedCascade, load
from fftocean.baking.previews import sheets as preview
from fftocean.baking.scene.maps import MAPS
from fftocean.errors import IntegrityError, JobError
from fftocean.export.formats import FORMATS
from fftocean.export.profiles import PROFILES
from fftocean.fields import FIELDS

pytestmark = pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning")
N, SIZE, FRAMES = (12, 10), (60.0, 45.0), 5


def job(**changes):
    small = {
        "ocean.n": N,
        "ocean.size": SIZE,
        "bake.frames": FRAMES,
        "bake.pictures": ["tiling"],
        "ocean.choppiness": 1.3,
    }
    return builders.job(small, **changes)


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """No picture, and no integrals over the sea."""
    still = fo.measure(fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=8, size=50.0))
    monkeypatch.setattr(baker, "measure", lambda _: still)
    monkeypatch.setattr(preview, "tiling", lambda *_: b"picture")


def truth(sea_job, name, j):
    """
    A map of a frame from the ocean itself, float64: what it is, without the room that makes
    pictures.
    """
    f = sea_job.ocean().loop_frame(j, sea_job.frames, (*FIELDS, "normal", "jacobian"))
    c = sea_job.settings["ocean.choppiness"]
    channels = {
        "height": [f.height],
        "displacement": [c * f.displace_x, c * f.displace_y, f.height],
        "normal": [f.normal[..., i] for i in range(3)],
        "derivative": [f.slope_x, f.slope_y, c * f.stretch_xx, c * f.stretch_yy],
        "stretch": [c * f.stretch_xx, c * f.stretch_xy, c * f.stretch_yy],
        "jacobian": [f.jacobian],
        "velocity": [f.velocity_x, f.velocity_y, f.velocity_z],
        "surface_velocity": [c * f.velocity_x, c * f.velocity_y, f.velocity_z],
    }
    return np.stack([np.asarray(channel, dtype=np.float64) for channel in channels[name]], axis=-1)


STEPS = {"float16": 2.0**-10, "float32": 2.0**-22}  # of a value, at most


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_gives_back_what_was_put_in(name, tmp_path):
    """
    To half a step of what it stores: a half, a float, or a 65535th of the map's range; float32's
    own rounding is in the factor.
    """
    held = [
        m
        for m in (
            "height",
            "displacement",
            "normal",
            "derivative",
            "stretch",
            "jacobian",
            "velocity",
            "surface_velocity",
        )
        if len(MAPS[m].names) in FORMATS[name].channels
    ]
    sea_job = job(bake__format=name, bake__maps=held)
    manifest = fo.bake(sea_job, tmp_path)
    loaded = load(tmp_path)
    assert tuple(loaded.maps) == tuple(held)
    assert loaded.times == pytest.approx(16.0 * np.arange(FRAMES) / FRAMES)
    assert loaded.frames == tuple(range(FRAMES))
    for m in held:
        assert loaded[m].dtype == np.float32
        assert loaded[m].shape == (FRAMES, N[1], N[0], len(MAPS[m].names))
        for j in range(FRAMES):
            expected = truth(sea_job, m, j)
            low, high = manifest["maps"][m].get("scaled", {"low": 0.0, "high": 0.0}).values()
            step = (
                (high - low) / 65535.0
                if FORMATS[name].scaled
                else STEPS[FORMATS[name].stored] * np.abs(expected) + 6e-8
            )
            assert np.all(
                np.abs(loaded[m][j] - expected) <= 0.5001 * step + 4e-7 * np.abs(expected).max()
            )


@pytest.mark.parametrize("engine", PROFILES)
def test_every_engine_s_frame_is_turned_back(engine, tmp_path):
    """Centimetres and back cost a rounding each way."""
    held = ["height", "displacement", "normal", "derivative", "velocity"]
    sea_job = job(bake__engine=engine, bake__format="npz", bake__maps=held)
    fo.bake(sea_job, tmp_path)
    loaded = load(tmp_path)
    for m in held:
        expected = truth(sea_job, m, 3)
        assert np.allclose(
            loaded[m][3], expected, rtol=3 * 2.0**-23, atol=4e-7 * np.abs(expected).max()
        )


def test_a_choice_of_maps_and_frames(tmp_path):
    fo.bake(job(), tmp_path)
    everything = load(tmp_path)
    some = load(tmp_path, maps=["normal"], frames=[4, 1])
    assert list(some.maps) == ["normal"]
    assert some.frames == (4, 1)
    assert np.array_equal(some.times, everything.times[[4, 1]])
    assert np.array_equal(some["normal"], everything["normal"][[4, 1]])
    assert np.array_equal(load(tmp_path, maps="height")["height"], everything["height"])
    assert some.manifest["version"] == fo.__version__
    for attempt in (
        lambda: load(tmp_path, maps=["foam"]),
        lambda: load(tmp_path, frames=[5]),
        lambda: some["height"],
    ):
        with pytest.raises(JobError, match="got"):
            attempt()


def test_a_part_of_the_loop_knows_which_frames_it_has(tmp_path):
    """
    The same frames as the whole has; a smaller grid shows the longer of the same waves at every
    second sample.
    """
    fo.bake(job(bake__format="npz", bake__maps=["height"]), tmp_path / "whole")
    fo.bake(job(bake__format="npz", bake__maps=["height"]), tmp_path / "part", frames="1:5:2")
    whole, part = load(tmp_path / "whole"), load(tmp_path / "part")
    assert part.frames == (1, 3)
    assert np.array_equal(part["height"], whole["height"][[1, 3]])
    assert np.array_equal(part.times, whole.times[[1, 3]])


def test_fewer_samples_are_the_longer_of_the_same_waves(tmp_path):
    """
    Low-passed and not picked: the fine picture without the waves that the coarse grid cannot hold,
    at every second sample.
    """
    even = {"ocean__n": (16, 12), "bake__format": "npz", "bake__maps": ["height"]}
    fo.bake(job(**even), tmp_path / "fine")
    manifest = fo.bake(job(**even), tmp_path / "coarse", downsample=2)
    fine, coarse = (
        load(tmp_path / "fine")["height"][2, ..., 0].astype(float),
        load(tmp_path / "coarse")["height"][2, ..., 0],
    )
    spectrum = np.fft.fft2(fine)
    my, mx = (np.abs(np.fft.fftfreq(n) * n) for n in fine.shape)
    spectrum[(my[:, None] > 2) | (mx[None, :] > 3)] = (
        0.0  # (6 - 1) // 2 and (8 - 1) // 2 are the largest that the coarse grid tells apart
    )
    low_passed = np.fft.ifft2(spectrum).real
    assert coarse.shape == (6, 8)
    assert np.abs(coarse - low_passed[::2, ::2]).max() < 1e-6 * np.abs(fine).max()  # float32
    assert np.abs(low_passed - fine).max() > 0.01 * np.abs(fine).max()
    assert (manifest["downsample"], manifest["job"]["ocean.n"], manifest["ocean"]["n"]) == (
        2,
        [16, 12],
        [8, 6],
    )


@pytest.mark.parametrize("factor", [0, -1, 3, 1.0, "2", True, 16])
def test_samples_that_cannot_be_shared_out_are_refused(factor, tmp_path):
    with pytest.raises(
        JobError, match=r"downsample must be a whole number that divides ocean\.n = 16, 12"
    ):
        fo.bake(job(ocean__n=(16, 12)), tmp_path / "out", downsample=factor)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", ["exr", "bin", "zarr"])
def test_what_is_not_what_was_written_is_refused(name, tmp_path):
    """By its checksum; without asking for that, by what the format itself can tell."""
    fo.bake(job(bake__format=name, bake__maps=["height"]), tmp_path / "out")
    form = FORMATS[name]
    path = tmp_path / "out" / form.file.format(stem="height", frame=2)
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 8
    path.write_bytes(data)
    with pytest.raises(
        IntegrityError,
        match=r"frame 2: the file was changed after it was written; `fftocean "
        r"check`",
    ):
        load(tmp_path / "out")
    if name == "zarr":  # has a checksum of its own; an EXR tells most changes, bare numbers none
        with pytest.raises(IntegrityError, match="frame 2"):
            load(tmp_path / "out", verify=False)
    path.unlink()
    for verify in (True, False):
        with pytest.raises(IntegrityError, match="missing"):
            load(tmp_path / "out", verify=verify)


def test_an_absent_chunk_is_no_flat_sea(tmp_path):
    """As a Zarr reader would have it, which fills in zeros."""
    fo.bake(job(bake__format="zarr", bake__maps=["height"]), tmp_path)
    shutil.rmtree(tmp_path / "height.zarr/c/3")
    with pytest.raises(IntegrityError, match="frame 3: the file is missing"):
        load(tmp_path)


def test_an_unfinished_or_changed_bake_is_refused(tmp_path):
    fo.bake(job(bake__maps=["height"]), tmp_path)
    text = (tmp_path / "manifest.json").read_bytes()
    (tmp_path / "manifest.json").write_bytes(text.replace(b'"loop": 16.0', b'"loop": 17.0'))
    with pytest.raises(IntegrityError, match="was changed after it was written"):
        load(tmp_path)
    (tmp_path / "manifest.json").unlink()
    with pytest.raises(IntegrityError, match="does not exist"):
        load(tmp_path)


def test_more_than_there_is_memory_for_is_refused(tmp_path, monkeypatch):
    fo.bake(job(bake__maps=["height"]), tmp_path)
    monkeypatch.setattr("fftocean.host.available_memory", lambda: 1000.0)
    with pytest.raises(fo.ParameterError, match="GiB"):
        load(tmp_path)


def test_each_tile_is_got_by_its_number():
    """The largest first; frames and times are those of all tiles."""
    tiles = tuple(Bake({}, np.arange(2.0), (0, 3), {"tile": i}) for i in range(3))
    baked = BakedCascade(tiles, {})
    assert [baked[i].manifest["tile"] for i in (0, 1, 2, -1)] == [0, 1, 2, 2]
    assert len(baked) == 3
    assert baked.frames == (0, 3)
    with pytest.raises(IndexError):
        baked[3]


def test_baked_foam_is_that_of_the_loop(tmp_path):
    """
    Across three spans, of which the last is shorter: the foam at the start of each carries all
    that the frames before it left behind. Halves of a file are exact to 1 / 2048.
    """
    made = job(bake__format="npz", bake__maps=["foam"], bake__frames=40, bake__foam__threshold=0.9)
    fo.bake(made, tmp_path / "out")
    expected = np.stack(list(made.foam_on(made.ocean()).loop(made.ocean(), 40)))
    baked = load(tmp_path / "out", maps=["foam"])["foam"]
    assert np.max(expected) > 0.1
    assert np.max(np.abs(baked[..., 0] - expected)) < 1e-3
