"""Babylon.js in a browser: its loaders and a shader read every kind of file by the sidecar's rule; its materials light a normal map."""

import numpy as np
import pytest
from lookups import MAPS, hold, look_up, on_screen

pytestmark = pytest.mark.client

FORMATS = {"exr": MAPS, "exr-float": MAPS, "exr-atlas": MAPS, "bin": MAPS}
FRAMES = (0, 3)


@pytest.fixture(scope="module")
def found(browser):
    """Return the lookups of one page, and what else it said."""
    return look_up(browser, "babylon", "babylon.html", FORMATS, FRAMES)


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize(("format_", "name"), [(f, m) for f, maps in FORMATS.items() for m in maps])
def test_the_formulas_of_the_sidecar_find_the_water(found, format_, name, frame):
    """At every sample, the same some tiles away, and between samples, the channels are what the manifest says they are."""
    hold(found[0][format_, name, frame])


def test_the_axes_lie_on_the_screen_as_the_manifest_says(browser, found):
    """A left-handed frame with Y up: the engine's own camera puts the axes where "east" and "north" are."""
    from water import Text
    said = Text.of(browser.site.folders["bakes"] / "babylon-bin-sea", "height")
    assert said.handed == "left"
    on_screen(found[1], said)
