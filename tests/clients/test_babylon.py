"""Babylon.js in a browser: its loaders and a shader read every kind of file by the sidecar's rule; its materials light a normal map."""

import numpy as np
import pytest
from lookups import MAPS, hold, look_up

pytestmark = pytest.mark.client

FORMATS = {"exr": MAPS, "exr-float": MAPS, "bin": MAPS}
FRAMES = (0, 3)


@pytest.fixture(scope="module")
def found(browser):
    """Return the lookups of one page, and what else it said."""
    return look_up(browser, "babylon", "babylon.html", FORMATS, FRAMES)


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize(("format_", "name"), [(f, m) for f, maps in FORMATS.items() for m in maps])
def test_the_rule_of_the_sidecar_finds_the_water(found, format_, name, frame):
    """At every sample, the same some tiles away, and between samples, the channels are what the manifest says they are."""
    a = found[0][format_, name, frame]
    d=np.abs(a.seen-a.expected); print(format_, name, frame, d.max(axis=0), d[:512].max(axis=0), a.tolerance.min(axis=0))
    hold(found[0][format_, name, frame])
