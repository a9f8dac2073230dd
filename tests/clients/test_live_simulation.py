"""
Fields that the live page computes of a sea, on the GPU and in its Worker, beside those of Python.
"""

import functools
import json
import shutil
import struct
import subprocess
import warnings

import numpy as np
import pytest
from conftest import LIVE, require
from web import floats

import fftocean as fo
from fftocean.fields import EIGHT
from fftocean.runtime import amplitude_planes, pack, to_bytes

pytestmark = pytest.mark.client

# Relative errors in the L2 norm. A field in single precision loses 6e-8 in each of its steps, of
# which there are 10 to 20, and the rounding errors of those add up at random.
GPU, WORKER = 5e-7, 2e-7
LOOP = 64.0
SEAS = {
    "deep-64": {"n": 64, "size": 200.0, "depth": np.inf},
    "shallow-128": {"n": 128, "size": 300.0, "depth": 8.0},
    "oblong": {"n": (128, 64), "size": (250.0, 90.0), "depth": 40.0},
    "large-256": {"n": 256, "size": 500.0, "depth": 40.0},
    "nearly-along-x": {"n": 64, "size": 200.0, "depth": 40.0, "spread": 2e4},
    "along-x": {
        "n": 64,
        "size": 200.0,
        "depth": 40.0,
        "modes": [(3, 0, 1.1, 0.3), (-7, 0, 0.2, 1)],
    },
    "along-y": {"n": 64, "size": 200.0, "depth": 40.0, "modes": [(0, 4, 0.7, 2.0)]},
    "cascade": {"tiles": [(64, 400.0), (64, 57.0), (64, 8.3)], "depth": 25.0},
}


@functools.cache
def sea(name, speed=14.0):
    """Return the oceans of a sea in double precision, and its package."""
    made = {"loop": LOOP, "dtype": "float64", "choppiness": 1.5, **SEAS[name]}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)  # of a loop that is short for the waves
        if "modes" in made:
            water = fo.Ocean.from_modes(made.pop("modes"), **made)
        else:
            water = random_sea(speed, **made)
        package = pack(water)
    return getattr(water, "oceans", (water,)), package


def random_sea(speed, *, depth, spread=None, **made):
    """Return an ocean or a cascade of a wind sea; with `spread`, of one that runs along x."""
    wind = fo.Sea.from_wind(speed=speed, fetch=200e3, depth=depth, direction=30.0)
    if spread:
        (system,) = wind.systems
        narrow = fo.WaveSystem(
            spectrum=system.spectrum, spreading=fo.CosinePower(s=spread), direction=0.0
        )
        wind = fo.Sea(narrow, depth=depth)
    return (fo.Cascade if "tiles" in made else fo.Ocean)(wind, seed=7, **made)


@pytest.fixture(scope="module")
def page(browser):
    """Return a function that runs a task of the page with a sea."""

    def run(task, name, *, speed=14.0, **args):
        value, log = browser.run(
            "simulation.html", {"task": task, "name": placed(browser, name, speed), **args}
        )
        assert value["error"] == 0, log
        return value["value"]

    return run


def placed(browser, name, speed=14.0):
    """Return the name of a sea's container, which lies where the page finds it."""
    file = browser.site.folders["bakes"] / f"live-{name}-{speed:g}.ffto"
    if not file.exists():
        file.write_bytes(to_bytes(sea(name, speed)[1]))
    return file.name


def five(ticks):
    """Return five moments of a loop, the first and the last among them."""
    return [0, 12345, ticks // 3, 5 * ticks // 7, ticks - 1]


def errors(oceans, tick, ticks, fields):
    """Return the relative error of each field of each tile; the absolute one of a field of 0."""
    found = {}
    for i, (ocean, tile) in enumerate(zip(oceans, fields, strict=True)):
        frame = ocean.loop_frame(tick, ticks)
        for name in EIGHT:
            seen = floats(tile[name], *ocean.grid.shape)
            size = np.linalg.norm(frame[name])
            found[i, name] = np.linalg.norm(seen - frame[name]) / (size if size > 0.0 else 1.0)
    return found


def worst(oceans, moments, ticks, frames):
    """Return the largest relative error of any field, tile and moment."""
    return max(
        max(errors(oceans, tick, ticks, frame["fields"]).values())
        for tick, frame in zip(moments, frames, strict=True)
    )


@pytest.mark.parametrize("name", SEAS)
def test_every_field_equals_that_of_python(page, name):
    """At five moments of the loop, in every tile."""
    oceans, package = sea(name)
    ticks = package.document["ticks"]
    assert ticks == 2**20 or ticks * package.document["tiles"][-1]["most_cycles"] >= 2**31
    seen = page("fields", name, ticks=five(ticks))
    assert (seen["kind"], seen["note"]) == ("gpu", "")
    assert worst(oceans, five(ticks), ticks, seen["frames"]) <= GPU


def test_sines_of_the_platform_are_too_coarse(page):
    """With them in the shaders, the comparison above fails: by much."""
    oceans, package = sea("deep-64")
    ticks = package.document["ticks"]
    seen = page("fields", "deep-64", ticks=[12345], options={"platformSine": True})
    assert worst(oceans, [12345], ticks, seen["frames"]) > 10 * GPU


@pytest.mark.parametrize("name", ["cascade", "oblong", "shallow-128"])
def test_the_worker_computes_every_field(page, name):
    """The Worker takes over where the GPU has no target of 32-bit floats, and the note says so."""
    oceans, package = sea(name)
    ticks = package.document["ticks"]
    seen = page("fields", name, ticks=five(ticks), missing="EXT_color_buffer_float")
    assert seen["kind"] == "worker"
    assert "32-bit floats" in seen["note"]
    assert "left out" not in seen["note"]
    assert worst(oceans, five(ticks), ticks, seen["frames"]) <= WORKER


def test_the_worker_halves_what_is_too_large(page):
    """
    Every other sample shows the waves that 128 samples can hold; the page says how many it cannot.
    """
    (ocean,), package = sea("large-256")
    ticks = package.document["ticks"]
    seen = page("fields", "large-256", ticks=[12345], options={"prefer": "worker"})
    a = ocean.amplitudes
    mx, my = ocean.grid.mx[None, :], ocean.grid.my[:, None]
    kept = (mx < 64) & (np.abs(my) < 64)
    forward, backward = (np.where(kept, part, 0.0) for part in (a.forward, a.backward))
    less = ocean.with_amplitudes(
        a.__class__(
            a.grid,
            a.depth,
            a.surface_tension,
            a.loop,
            forward,
            backward,
            a.variance_forward,
            a.variance_backward,
            a.draw,
            a.band,
        )
    )
    frame = less.loop_frame(12345, ticks)
    for name in EIGHT:
        half = frame[name][::2, ::2]
        apart = floats(seen["frames"][0]["fields"][0][name], 128, 128) - half
        assert np.linalg.norm(apart) <= WORKER * np.linalg.norm(half)
    lost = ocean.modes().kx.size - less.modes().kx.size
    assert f"the {lost} shortest waves are left out" in seen["note"]


def test_the_worker_starts_from_a_text_in_the_page(page, browser, live_tools):
    """As in the page that is one file: the bundle's text in place of a file of a server."""
    bundle = browser.site.folders["bakes"] / "live-worker.js"
    subprocess.run(
        [live_tools / ".bin" / "esbuild", LIVE / "worker.js", "--bundle", "--minify",
         "--format=iife", f"--outfile={bundle}", "--log-level=error"],
        check=True,
    )  # fmt: skip
    oceans, package = sea("deep-64")
    ticks = package.document["ticks"]
    options = {"prefer": "worker", "workerSource": bundle.name}
    seen = page("fields", "deep-64", ticks=[ticks - 1], options=options)
    assert worst(oceans, [ticks - 1], ticks, seen["frames"]) <= WORKER


@pytest.mark.parametrize("prefer", ["gpu", "worker"])
def test_the_loop_closes_to_the_bit(page, prefer):
    """Tick 0 and the one after the last give the same bits in every field and map."""
    ticks = sea("deep-64")[1].document["ticks"]
    seen = page("fields", "deep-64", ticks=[0, ticks, 1], options={"prefer": prefer}, maps=True)
    first, last, other = seen["frames"]
    assert first == last
    assert first["maps"] != other["maps"]


def test_a_clock_that_ran_for_decades_shows_the_right_moment(page):
    """After 1e9 s the tick is that of the remainder of the division by the loop."""
    (ocean,), package = sea("deep-64")
    ticks = package.document["ticks"]
    seconds = 1_000_000_017.25
    seen = page("clock", "deep-64", seconds=seconds)
    assert seen["tick"] == int(seconds % LOOP * ticks / LOOP)
    assert max(errors((ocean,), seen["tick"], ticks, seen["fields"]).values()) <= GPU


@pytest.mark.parametrize("prefer", ["gpu", "worker"])
@pytest.mark.parametrize("level", [0, 1, 3])
def test_maps_hold_displacements_slopes_and_their_squares(page, prefer, level):
    """With the choppiness, in half precision; each level is the average of squares of samples."""
    (ocean,), package = sea("oblong")
    ticks, c = package.document["ticks"], 0.8
    seen = page(
        "fields", "oblong", ticks=[999], options={"prefer": prefer}, choppiness=c, level=level,
        maps=True,
    )["frames"][0]["maps"][0]  # fmt: skip
    f = ocean.loop_frame(999, ticks)
    zero = np.zeros_like(f.height)
    expected = {
        "displacement": (c * f.displace_x, c * f.displace_y, f.height, c * f.stretch_xy),
        "slopes": (f.slope_x, f.slope_y, c * f.stretch_xx, c * f.stretch_yy),
        "moments": (f.slope_x**2, f.slope_y**2, f.slope_x * f.slope_y, zero),
    }
    side = 2**level
    ny, nx = (n // side for n in ocean.grid.shape)
    for name, channels in expected.items():
        full = np.stack(channels, axis=-1)
        averages = full.reshape(ny, side, nx, side, 4).mean(axis=(1, 3))
        apart = np.abs(floats(seen[name], ny, nx, 4) - averages)
        # a half has 11 digits; each level may be rounded, of the one before
        assert np.all(apart <= (level + 1) * 2.0**-11 * np.abs(full).max(axis=(0, 1)))
        assert np.abs(averages[..., 0]).max() > 0.01 * np.abs(full[..., 0]).max()


@pytest.mark.parametrize("prefer", ["gpu", "worker"])
def test_one_sea_changes_into_another_linearly(page, browser, prefer):
    """The fields are the weighted averages of both seas, and in the end those of the later one."""
    (first,), package = sea("deep-64")
    (second,), _ = sea("deep-64", 9.0)
    ticks = package.document["ticks"]
    names = [placed(browser, "deep-64"), placed(browser, "deep-64", 9.0)]
    seen = page(
        "blend", "deep-64", names=names, tick=4321, advances=[0.0, 0.075, 0.15, 0.2],
        options={"prefer": prefer},
    )  # fmt: skip
    assert [round(frame["weight"], 9) for frame in seen] == [1, 0, 0.25, 0.75, 1]
    before, after = (ocean.loop_frame(4321, ticks) for ocean in (first, second))
    for frame, weight in zip(seen[1:], (0, 0.25, 0.75, 1), strict=True):
        for name in EIGHT:
            expected = (1 - weight) * before[name] + weight * after[name]
            apart = floats(frame["fields"][0][name], *first.grid.shape) - expected
            assert np.linalg.norm(apart) <= GPU * np.linalg.norm(expected)


def test_a_lost_context_comes_back(page):
    """From the sea that was kept, with the same bits."""
    seen = page("loss", "deep-64", tick=777)
    assert seen["events"] == ["lost"]
    assert seen["after"] == seen["before"]


def test_the_page_verifies_itself(page, browser):
    """
    A reference of Python passes; one with a field that is off by 1e-6 fails; another moment and a
    sea that is changing are refused.
    """
    (ocean,), package = sea("deep-64")
    ticks, tick = package.document["ticks"], 54321
    folder = browser.site.folders["bakes"]
    frame = ocean.loop_frame(tick, ticks)
    (folder / "live-right.fftr").write_bytes(answer(frame, tick, ticks))
    frame.slope_y[...] *= 1.0 + 1e-6
    (folder / "live-wrong.fftr").write_bytes(answer(frame, tick, ticks))
    seen = page(
        "verify", "deep-64", tick=tick, reference="live-right.fftr", wrong="live-wrong.fftr",
        other=placed(browser, "deep-64", 9.0),
    )  # fmt: skip
    assert seen["found"]["passed"]
    assert seen["found"]["worst"] <= GPU
    assert set(seen["found"]["errors"]) == set(EIGHT)
    assert not seen["failing"]["passed"]
    assert max(seen["failing"]["errors"], key=seen["failing"]["errors"].get) == "slope_y"
    assert seen["moved"] == f"a reference must have tick {tick + 1}, got {tick}"
    assert "changing into another" in seen["blending"]


def answer(frame, tick, ticks):
    """Return a reference answer of one tile."""
    ny, nx = frame.height.shape
    header = json.dumps(
        {"tick": tick, "ticks": ticks, "tile": 0, "nx": nx, "ny": ny, "fields": EIGHT, "sea": 1}
    ).encode()
    header += b" " * (-len(header) % 16)
    data = np.stack([frame[name] for name in EIGHT]).astype("<f4").tobytes()
    return struct.pack("<4sIII", b"FFTR", 1, len(header), 0) + header + data


@pytest.mark.parametrize("name", ["oblong", "cascade"])
def test_the_page_decodes_the_waves_of_a_container(name, tmp_path):
    """The tables have the bits of the package's textures, and the document is the same."""
    require(shutil.which("node"), "node is not installed")
    oceans, package = sea(name)
    container, tables = tmp_path / "sea.ffto", tmp_path / "tables.bin"
    container.write_bytes(to_bytes(package))
    script = LIVE.parents[3] / "tests" / "clients" / "decode_sea.mjs"
    run = subprocess.run(
        ["node", script, LIVE, container, tables], check=True, capture_output=True, timeout=300
    )
    # JavaScript has no integers beyond 2^53, which seeds of a cascade's tiles can be
    found = json.loads(run.stdout, parse_int=float)
    assert found["document"] == json.loads(json.dumps(package.document), parse_int=float)
    assert found["reference"] == json.loads(package.files["check.json"], parse_int=float)
    seen = np.fromfile(tables, "<f4")
    for ocean, about in zip(oceans, found["sizes"], strict=True):
        grid = ocean.grid
        assert about["n"] == [grid.nx, grid.ny]
        assert about["size"] == [grid.lx, grid.ly]
        h0, wave = amplitude_planes(ocean)
        mine, seen = seen[: h0.size].reshape(h0.shape), seen[h0.size :]
        assert np.array_equal(mine, h0)
        mine, seen = seen[: wave.size].reshape(wave.shape), seen[wave.size :]
        assert np.array_equal(mine[..., 0], wave[..., 0])
        # tanh and hypot of two libraries
        assert np.abs(mine[..., 1] - wave[..., 1]).max() <= 2.0**-22 * wave[..., 1].max()
    assert not seen.size
