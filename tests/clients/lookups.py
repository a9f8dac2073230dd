"""Bakes that a page's shader looks up by the sidecar's formulas, and the expected values."""

import warnings
from dataclasses import dataclass

import numpy as np
from water import FRAMES, LOOP, OBLONG, Text, between, half_step, job, places, steepest, truth
from web import floats

import fftocean as fo

MAPS = ("displacement", "derivative", "normal", "height")
SUFFIX = {
    "exr": "/{frame:04d}.exr",
    "exr-float": "/{frame:04d}.exr",
    "exr-atlas": ".exr",
    "bin": ".bin",
    "ktx2": ".ktx2",
}


@dataclass
class Lookup:
    """
    One map of one format and frame: the engine's numbers, the expected ones, and their tolerance.
    """

    keys: list
    seen: np.ndarray
    expected: np.ndarray
    tolerance: np.ndarray


def baked(browser, engine, format_, maps, label, **keys):
    """Bake into the site's folder; return the job and the folder."""
    asked = job(bake__engine=engine, bake__format=format_, bake__maps=list(maps), **keys)
    folder = browser.site.folders["bakes"] / f"{engine}-{format_}-{label}"
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "wind speed 0 m/s", fo.SeaWarning)
        fo.bake(asked, folder, executor="serial")
    return asked, folder


def texture(folder, format_, name, frame, **more):
    """Return the page's description of one map of a bake: loader of the format, and addresses."""
    path = f"{name}{SUFFIX[format_].format(frame=frame)}"
    assert (folder / path).is_file()
    return {
        "loader": format_,
        "url": f"/bakes/{folder.name}/{path}",
        "sidecar": f"/bakes/{folder.name}/{name}.json",
        **more,
    }


def look_up(browser, engine, page, formats, frames):
    """
    Return {(format, map, frame): Lookup}, of all formats by one page, and the page's other answers.

    A half is off by half its step at most. Between samples, the weights of a filter are fractions
    of 8 bits or more, so that 1/256 of the difference of neighbours may be added along each axis.
    At samples some tiles away, u has single precision: 1e-4 of a texel.
    """
    x, y, exact = places()
    weights = np.where(exact, 1e-4, 2 / 256)[:, None]
    textures, samples, answers = {}, [], []
    for format_, maps in formats.items():
        asked, folder = baked(browser, engine, format_, maps, "sea")
        water = truth(asked)
        for name in maps:
            said = Text.of(folder, name)
            keys = sorted(
                key for key in said.meaning if name != "derivative" or not key.startswith("normal")
            )  # those are no sums
            fields = np.stack([said.expected(water, key) for key in keys], axis=-1)
            for frame in frames:
                at = f"{format_} {name} {frame}"
                textures[at] = texture(folder, format_, name, frame)
                time = frame * LOOP / FRAMES + 2 * LOOP
                rows = np.concatenate(
                    [said.world(x, y), np.full((x.size, 1), time)], axis=1
                ).tolist()
                meaning = [said.meaning[key] for key in keys]
                samples.append(
                    {"texture": at, "sampling": said.sampling, "meaning": meaning, "places": rows}
                )
                largest = np.abs(fields).max()
                rounding = 1e-6 * largest if format_ == "exr-float" else 0.5 * half_step(largest)
                if "packed" in said.conventions["normals"] and name == "normal":
                    rounding = (
                        2e-7 if format_ == "exr-float" else half_step(0.5)
                    )  # n = 2 c - 1, where c is below 1
                expected = between(fields[frame], x, y, OBLONG)
                answers.append(
                    ((format_, name, frame), keys, expected, rounding + weights * steepest(fields))
                )
    value, _ = browser.run(page, {"textures": textures, "samples": samples})
    assert value["error"] == 0
    found = {}
    for (cell, keys, expected, tolerance), seen in zip(answers, value["samples"], strict=True):
        found[cell] = Lookup(keys, floats(seen, x.size, 4)[:, : len(keys)], expected, tolerance)
    return found, value


def require_equal(found):
    """
    Assert that the engine's numbers are the expected ones, and that the map varies enough to tell.
    """
    apart = np.abs(found.seen - found.expected)
    place, channel = np.unravel_index(np.argmax(apart / found.tolerance), apart.shape)
    said = (
        f"{found.keys[channel]} is off by {apart[place, channel]:.3g} at place {place}, "
        f"allowed {found.tolerance[place, channel]:.3g}"
    )
    assert np.all(apart <= found.tolerance), said
    varied = np.ptp(found.expected, axis=0) > 10 * found.tolerance.max(axis=0)
    assert np.all(varied | (np.array(found.keys) == "normal_Y"))  # up is near 1 everywhere


def on_screen(value, said):
    """Assert that the engine draws X and Z, seen from above with north up, east to the right."""
    east, north = (next(k for k, (axis, _) in said.axes.items() if axis == a) for a in "xy")
    for axis, sign, index in ((east, said.axes[east][1], 0), (north, said.axes[north][1], 1)):
        direction = np.array(value["screen"][axis][:2])
        assert sign * direction[index] > 0
        assert abs(direction[1 - index]) < 1e-6 * abs(direction[index])
