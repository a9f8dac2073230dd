"""Bakes that a page's shader looks up by the sidecar's rule, and what it must find."""

from dataclasses import dataclass

import numpy as np
from water import OBLONG, between, half_step, job, places, shader_rule, steepest, stored, text
from web import floats

import fftocean as fo

MAPS = ("displacement", "derivative", "height")
SUFFIX = {"exr": "/{frame:04d}.exr", "exr-float": "/{frame:04d}.exr", "r16": "/{frame:04d}.r16", "bin": ".bin", "ktx2": ".ktx2"}


@dataclass
class Lookup:
    """One map of one format and frame: the numbers that the engine found, those that it must find, and their tolerance."""

    seen: np.ndarray
    expected: np.ndarray
    tolerance: np.ndarray


def baked(browser, engine, format_, maps, label, **keys):
    """Bake into the site's folder; return the job and the folder."""
    asked = job(bake__engine=engine, bake__format=format_, bake__maps=list(maps), **keys)
    folder = browser.site.folders["bakes"] / f"{engine}-{format_}-{label}"
    fo.bake(asked, folder, executor="serial")
    return asked, folder


def texture(folder, format_, name, frame, **more):
    """Return how a page loads one map of a bake: by the loader of the format, from these addresses."""
    path = f"{name}{SUFFIX[format_].format(frame=frame)}"
    assert (folder / path).is_file()
    return {"loader": format_, "url": f"/bakes/{folder.name}/{path}", "sidecar": f"/bakes/{folder.name}/{name}.json", **more}


def look_up(browser, engine, page, formats, frames):
    """
    Return {(format, map, frame): Lookup}, of all formats by one page, and the page's other answers.

    A half is off by half its step at most. Between samples, the weights of a filter are fractions of 8 bits or more, so that 1/256 of
    the difference of neighbours may be added along each axis. At samples some tiles away, u has single precision: 2e-5 of a texel.
    """
    x, y, exact = places()
    weights = np.where(exact, 5e-5, 2 / 256)[:, None]
    textures, samples, expected = {}, [], {}
    for format_, maps in formats.items():
        asked, folder = baked(browser, engine, format_, maps, "sea")
        for name in maps:
            said, (fields, unit) = text(folder, name), stored(asked, folder, name)
            for frame in frames:
                key = f"{format_} {name} {frame}"
                textures[key] = texture(folder, format_, name, frame)
                samples.append({"texture": key, "rule": shader_rule(said, OBLONG), "layer": frame, "places": said.world(x, y).tolist()})
                # single precision has no step to speak of; 16 bits of a range have one of a 65535th
                rounding = {"exr-float": 1e-6 * unit, "r16": np.ptp(fields) / 65535}.get(format_, 0.5 * half_step(np.abs(fields).max()))
                expected[format_, name, frame] = between(fields[frame], x, y, OBLONG), rounding + weights * steepest(fields)
    value, _ = browser.run(page, {"textures": textures, "samples": samples})
    assert value["error"] == 0
    answers = {}
    for (key, (values, tolerance)), seen in zip(expected.items(), value["samples"], strict=True):
        channels = 1 if key[0] == "r16" else values.shape[1]
        answers[key] = Lookup(floats(seen, len(x), 4)[:, :channels], values[:, :channels], tolerance[:, :channels])
    return answers, value


def hold(answer):
    """Hold what an engine found against what it must find, and see that the map is not so flat that anything would pass."""
    apart = np.abs(answer.seen - answer.expected)
    worst = np.unravel_index(np.argmax(apart / answer.tolerance), apart.shape)
    assert np.all(apart <= answer.tolerance), f"off by {apart[worst]:.3g} at place and channel {worst}, allowed {answer.tolerance[worst]:.3g}"
    assert np.all(np.ptp(answer.expected, axis=0) > 20 * answer.tolerance.max(axis=0))
