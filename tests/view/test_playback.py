"""
Frames of a bake for the live page, against the ocean that was baked.
"""

import json
import struct
import threading
from pathlib import Path

import numpy as np
import pytest
from builders import job

import fftocean as fo
from fftocean.baking.cascade import bake_tiles
from fftocean.errors import IntegrityError, JobError, OutputError, ParameterError
from fftocean.foam_coverage import threshold_for
from fftocean.view.playback import open_bake

N, SIZE, COUNT = (24, 16), (60.0, 50.0), 6
HALF, STEPS = 2.0**-12, 2.0**-15  # rounding of values up to 1 m: of a half float; of 65,535 steps
FORMATS = {  # maps, and the rounding of what is stored
    "exr": (("displacement", "derivative", "stretch"), HALF),
    "exr-float": (("height",), 0.0),
    "npz": (("displacement",), 0.0),
    "zarr": (("height", "displacement", "derivative"), 0.0),
    "ktx2": (("displacement", "derivative"), HALF),
    "bin": (("displacement", "derivative"), HALF),
    "exr-atlas": (("displacement", "stretch"), HALF),
    "png16": (("height",), STEPS),
}
EIGHT = (
    *("displace_x", "displace_y", "height", "stretch_xy"),
    *("slope_x", "slope_y", "stretch_xx", "stretch_yy"),
)  # in the channels of the first two maps


def recipe(form="exr", maps=("displacement", "derivative", "stretch"), **more):
    """A small job without previews."""
    keys = {
        "ocean__n": N,
        "ocean__size": SIZE,
        "ocean__choppiness": 0.8,
        "sea__depth": 6.0,
        "bake__frames": COUNT,
        "bake__maps": maps,
        "bake__format": form,
        "bake__pictures": [],
        **more,
    }
    return job(**keys)


@pytest.fixture(scope="module")
def bakes(tmp_path_factory):
    """One bake for each format: {format: folder}."""
    folder = tmp_path_factory.mktemp("bakes")
    for form, (maps, _) in FORMATS.items():
        fo.bake(recipe(form, maps), executor="serial", folder=folder / form)
    return folder


def opened(message):
    """Return the header and the three maps of a message, (3, ny, nx, 4)."""
    magic, version, length, zero = struct.unpack("<4sIII", message[:16])
    assert (magic, version, zero) == (b"FFTB", 1, 0)
    assert length % 16 == 0
    header = json.loads(message[16 : 16 + length])
    texels = header["ny"] * header["nx"] * 4
    padded = -(-2 * texels // 16) * 16
    assert len(message) == 16 + length + 3 * padded
    parts = [
        np.frombuffer(message, "<f2", texels, 16 + length + i * padded).astype(float)
        for i in range(3)
    ]
    return header, np.stack(parts).reshape(3, header["ny"], header["nx"], 4)


def expected(ocean, j, count):
    """Return the three maps of an ocean's frame, in float64."""
    frame = ocean.loop_frame(j, count)
    c = ocean.choppiness
    sx, sy = frame.slope_x, frame.slope_y
    displacement = [c * frame.displace_x, c * frame.displace_y, frame.height, c * frame.stretch_xy]
    slopes = [sx, sy, c * frame.stretch_xx, c * frame.stretch_yy]
    moments = [sx * sx, sy * sy, sx * sy, 0.0 * sx]
    return np.stack([np.stack(maps, axis=-1) for maps in (displacement, slopes, moments)])


def require_equal(found, right, fields, stored, steepest):
    """
    Require texels to be right to the rounding of a half float, and of the fields that they come of.

    Half floats that were stored come back as they are. Where a field is derived from one of them,
    its rounding errors are differentiated: by `steepest`, the highest k, at most.
    """
    derived = np.array([fields[name].startswith("derived") for name in EIGHT]).reshape(2, 1, 1, 4)
    half = np.maximum(np.abs(right) * 2.0**-11, 2.0**-25)
    single = 3e-6  # the ocean that was baked is one of 32-bit floats
    own = 0.0 if stored == HALF else stored
    allowed = half[:2] + single + np.where(derived, 2.0 * max(1.0, steepest) * stored, own)
    assert np.all(np.abs(found - right)[:2] <= allowed)
    slope = np.abs(right[1, ..., :2]).max()
    error = allowed[1, ..., :2].max()
    assert np.all(np.abs(found - right)[2] <= half[2] + (2.0 * slope + error) * error)
    sx, sy = found[1, ..., 0], found[1, ..., 1]
    moments = np.stack([sx * sx, sy * sy, sx * sy, 0.0 * sx], axis=-1)
    np.testing.assert_allclose(found[2], moments, rtol=0.0, atol=2.0**-9 * slope**2)
    assert np.all(found[2, ..., 3] == 0.0)


@pytest.mark.parametrize("form", FORMATS)
def test_texels_are_those_of_the_ocean(bakes, form):
    """Every map at every frame, whatever was baked: derived fields too are those of the waves."""
    playback = open_bake(bakes / form)
    ocean = recipe(form).ocean(dtype="float64")
    assert len(playback) == COUNT
    for j in range(COUNT):
        header, found = opened(playback.frame(0, j))
        assert header == {
            "tile": 0, "frame": j, "nx": N[0], "ny": N[1], "lx": SIZE[0], "ly": SIZE[1],
        }  # fmt: skip
        right = expected(ocean, j, COUNT)
        fields = playback.manifest()["tiles"][0]["fields"]
        require_equal(found, right, fields, FORMATS[form][1], np.pi * N[0] / SIZE[0])
    assert np.std(right[0, ..., 2]) > 0.05


def test_the_manifest_says_what_was_derived(bakes):
    fields = open_bake(bakes / "exr").manifest()["tiles"][0]["fields"]
    assert fields["height"] == fields["displace_x"] == "displacement"
    assert fields["slope_x"] == "derivative"
    assert {fields[f"stretch_{axes}"] for axes in ("xx", "xy", "yy")} == {"stretch"}
    fields = open_bake(bakes / "ktx2").manifest()["tiles"][0]["fields"]
    assert fields["stretch_xx"] == "derivative"
    assert fields["stretch_xy"] == "derived from displacement"
    fields = open_bake(bakes / "png16").manifest()["tiles"][0]["fields"]
    assert fields["height"] == "height"
    assert set(fields) == set(EIGHT)
    assert {fields[name] for name in EIGHT if name != "height"} == {"derived from height"}


def test_the_manifest_is_a_document_for_the_page(bakes):
    """Plain JSON, whose numbers are those of the job and of the waves."""
    document = json.loads(json.dumps(open_bake(bakes / "exr").manifest(), allow_nan=False))
    assert (document["format"], document["version"]) == ("fftocean-playback", 1)
    assert document["frames"] == COUNT
    assert document["loop"] == 16.0
    assert document["ticks"] == 2**20
    assert (document["depth"], document["choppiness"]) == (6.0, 0.8)
    assert document["wind"] == {"speed": 7.0, "direction": 25.0}
    assert document["tiles"][0]["n"] == list(N)
    assert document["tiles"][0]["band"] == [0.0, None]
    ocean = recipe().ocean()
    state = fo.measure(ocean)
    assert document["statistics"]["realised"]["hs"] == pytest.approx(state.hs, rel=1e-3)
    waves = ocean.modes()
    rough = 0.5 * np.sum(waves.amplitude**2 * waves.kx**2)
    roughness = document["slope_variance"]
    assert roughness["captured"][0] == pytest.approx(rough, rel=0.35)  # the mean over seeds
    # Cox & Munk (1954): upwind and crosswind variances add up to 0.003 + 0.00508 U
    assert roughness["total"][0] + roughness["total"][1] == pytest.approx(0.003 + 0.00508 * 7.0)
    for name in ("captured", "beyond"):
        roughness["total"] = [
            a - b for a, b in zip(roughness["total"], roughness[name], strict=True)
        ]
    assert roughness["total"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


def test_foam_is_that_of_the_wind_or_of_the_bake(bakes, tmp_path):
    foam = open_bake(bakes / "exr").manifest()["foam"]
    right = threshold_for(recipe().ocean(), 7.0)
    assert foam["threshold"] == pytest.approx(right, rel=1e-12)
    fo.bake(
        recipe(maps=("height", "foam"), bake__frames=1, bake__foam__threshold=0.6),
        folder=tmp_path / "foam",
        executor="serial",
    )
    foam = open_bake(tmp_path / "foam").manifest()["foam"]
    assert foam == {"decay": 3.5, "threshold": 0.6, "strength": 60.0}


def test_frames_repeat(bakes):
    """Frame F is frame 0, and -1 the last."""
    playback = open_bake(bakes / "exr")
    assert playback.frame(0, COUNT) == playback.frame(0, 0)
    assert playback.frame(0, -1) == playback.frame(0, COUNT - 1)
    assert playback.frame(0, 0) != playback.frame(0, 1)


def test_a_cascade_is_played_tile_by_tile(tmp_path):
    """Each tile has its own waves; what is derived has no noise beyond the band of its tile."""
    tiles = [(24, 90.0), (16, 13.0)]
    base = recipe(maps=("height",), ocean__n=16, ocean__size=60.0)
    bake_tiles(base, tiles, tmp_path / "sea", executor="serial")
    playback = open_bake(tmp_path / "sea")
    document = playback.manifest()
    assert [tile["n"] for tile in document["tiles"]] == [[24, 24], [16, 16]]
    assert document["tiles"][0]["band"][1] == document["tiles"][1]["band"][0] > 0.0
    state = document["statistics"]
    assert state["specified"]["direction"] == pytest.approx(25.0)
    cascade = fo.Cascade(base.sea(), tiles, seed=1, loop=16.0, choppiness=0.8, dtype="float64")
    assert state["realised"]["hs"] == pytest.approx(fo.measure(cascade).hs, rel=1e-3)
    for i, ocean in enumerate(cascade.oceans):
        header, found = opened(playback.frame(i, 2))
        assert (header["tile"], header["lx"]) == (i, tiles[i][1])
        right = expected(ocean, 2, COUNT)
        fields = document["tiles"][i]["fields"]
        require_equal(found, right, fields, HALF, np.pi * ocean.grid.nx / ocean.grid.lx)
        spectrum = np.abs(np.fft.rfft2(found[1, ..., 0])) / found[1, ..., 0].size
        k = (
            2.0
            * np.pi
            * np.hypot(
                np.fft.rfftfreq(ocean.grid.nx, ocean.grid.lx / ocean.grid.nx),
                np.fft.fftfreq(ocean.grid.ny, ocean.grid.ly / ocean.grid.ny)[:, None],
            )
        )
        low, high = ocean.amplitudes.band
        margin = 2.0 * np.pi / ocean.grid.lx
        outside = (k < low - margin) | (k > high + margin)
        assert np.any(outside)
        assert spectrum[outside].max() < 2.0**-11 * np.abs(found[1, ..., 0]).max()


def test_a_part_of_the_loop_is_played(tmp_path):
    fo.bake(recipe(maps=("height",)), executor="serial", folder=tmp_path / "part", frames="1:6:2")
    playback = open_bake(tmp_path / "part")
    document = playback.manifest()
    assert document["frames"] == 3
    assert document["loop"] == pytest.approx(16.0)  # steps of two sixths
    assert document["times"] == pytest.approx([16.0 / 6 * j for j in (1, 3, 5)])
    right = expected(recipe().ocean(dtype="float64"), 3, COUNT)
    _, found = opened(playback.frame(0, 1))
    assert np.all(np.abs(found - right)[0, ..., 2] <= 2.0**-11 * np.abs(right[0, ..., 2]) + 1e-6)


def test_what_cannot_be_played_is_refused_with_the_reason(bakes, tmp_path):
    fo.bake(
        recipe(maps=("height",), bake__lookup="eulerian"),
        executor="serial",
        folder=tmp_path / "places",
    )
    with pytest.raises(JobError, match="maps are eulerian, by world position"):
        open_bake(tmp_path / "places")
    fo.bake(recipe(maps=("normal", "foam")), executor="serial", folder=tmp_path / "normals")
    with pytest.raises(JobError, match="without a height or displacement map; it has normal, foam"):
        open_bake(tmp_path / "normals")
    (tmp_path / "empty").mkdir()
    with pytest.raises((IntegrityError, OutputError), match="manifest"):
        open_bake(tmp_path / "empty")
    playback = open_bake(bakes / "exr")
    with pytest.raises(ParameterError, match="tile must be"):
        playback.frame(1, 0)
    for wrong in (0.5, True, "0", None):
        with pytest.raises(ParameterError, match="frame must be"):
            playback.frame(0, wrong)


@pytest.mark.parametrize("form", ["exr", "npz"])
def test_a_damaged_frame_is_named_and_the_others_are_played(tmp_path, form):
    fo.bake(recipe(form), executor="serial", folder=tmp_path / "sea")
    playback = open_bake(tmp_path / "sea")
    file = next(iter(sorted((tmp_path / "sea").rglob(f"displacement*/*3.{form}"))), None)
    if file is None:  # one file holds all frames
        file = next((tmp_path / "sea").rglob("displacement.npz"))
    whole = file.read_bytes()
    file.write_bytes(whole[:-7])
    with pytest.raises(IntegrityError, match=rf"{file.name}, frame 3: .*fftocean check"):
        playback.frame(0, 3)
    if form == "exr":
        playback.frame(0, 2)
        file.unlink()
        with pytest.raises(IntegrityError, match="the file is missing"):
            playback.frame(0, 3)
    file.write_bytes(whole)
    playback.frame(0, 3)


def test_memory_is_bounded_and_frames_used_last_are_kept(bakes, monkeypatch):
    size = len(open_bake(bakes / "exr").frame(0, 0))
    playback = open_bake(bakes / "exr", memory=3 * size + 10)
    reads = []
    read = playback._read
    monkeypatch.setattr(playback, "_read", lambda *key: reads.append(key) or read(*key))
    for j in (0, 1, 2, 0, 3, 0):
        playback.frame(0, j)
    assert reads == [(0, 0), (0, 1), (0, 2), (0, 3)]  # 0 was used after 1
    playback.frame(0, 1)
    assert reads[-1] == (0, 1)
    assert playback._held <= 3 * size + 10
    assert playback._held == sum(map(len, playback._frames.values()))
    least = open_bake(bakes / "npz", memory=0)
    for j in range(2 * COUNT):
        least.frame(0, j)
        assert len(least._frames) == 1


def test_threads_share_a_playback(bakes):
    playback = open_bake(bakes / "ktx2", memory=10**5)
    right = [open_bake(bakes / "ktx2").frame(0, j) for j in range(COUNT)]
    wrong = []

    def watch(start):
        for j in range(start, start + 20):
            if playback.frame(0, j) != right[j % COUNT]:
                wrong.append(j)

    threads = [threading.Thread(target=watch, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_a_link_out_of_the_bake_is_not_followed(tmp_path):
    fo.bake(recipe(), executor="serial", folder=tmp_path / "sea")
    folder = tmp_path / "sea" / "displacement"
    folder.rename(tmp_path / "elsewhere")
    Path(folder).symlink_to(tmp_path / "elsewhere")
    with pytest.raises(IntegrityError, match="the file is missing"):
        open_bake(tmp_path / "sea").frame(0, 0)
