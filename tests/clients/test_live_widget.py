"""
Notebook widget in headless Chromium, with a stub of the notebook's model.
"""

import json

import builders
import numpy as np
import pytest
from web import floats

import fftocean as fo
from fftocean.runtime import pack
from fftocean.view import widget as module

pytestmark = [
    pytest.mark.client,
    pytest.mark.filterwarnings("ignore::fftocean.errors.SeaWarning"),
]
pytest.importorskip("anywidget")

SEA = fo.Sea.from_wind(speed=8.0, fetch=60e3, direction=20.0)
TILES = [(32, 300.0), (32, 41.0)]


def water(seed):
    """A small cascade in float64."""
    return fo.Cascade(SEA, TILES, loop=32.0, seed=seed, dtype="float64")


@pytest.fixture(scope="module", autouse=True)
def unbuilt():
    """Make widgets without the built page: here the sources are the page."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "read_text", lambda _: "")
        module._widget_class.cache_clear()
        yield
    module._widget_class.cache_clear()


@pytest.fixture(scope="module")
def widgets(browser):
    """Write what a widget carries to the server of the tests; return the folder's address."""
    folder = browser.site.folders["bakes"] / "widget"
    folder.mkdir()
    widget = fo.view(water(1))
    (folder / "about.json").write_text(json.dumps(widget.about))
    (folder / "first.bin").write_bytes(widget.sea)
    widget.show(water(2))
    (folder / "second.bin").write_bytes(widget.sea)
    return f"{browser.site.address}/bakes/widget"


def test_the_sea_of_the_kernel_is_shown_and_changed(browser, widgets):
    """
    Fields are those of the cascade, though its bytes lie at an odd offset of a message; the end
    frees the context and everything else.
    """
    value, _ = browser.run("widget.html", {"scene": "sea", "folder": widgets})
    ticks = pack(water(1)).document["ticks"]
    right = water(1).oceans[0].loop_frame(12345, ticks)
    for name, text in value["first"].items():
        found, exact = floats(text, 32, 32), getattr(right, name)
        assert np.linalg.norm(found - exact) <= 5e-7 * np.linalg.norm(exact)
    exact = water(2).oceans[0].loop_frame(12345, ticks).height
    found = floats(value["second"], 32, 32)
    assert np.linalg.norm(found - exact) <= 5e-7 * np.linalg.norm(exact)
    assert value["height"] == 160
    assert value["verdict"]
    assert value["error"] == 0
    assert (value["before"], value["lost"]) == (False, True)
    assert value["left"] == [0, 0, 0]


def test_a_notebook_keeps_few_contexts(browser, widgets):
    """A widget that is shown twice is live once; of too many the oldest become pictures."""
    value, _ = browser.run("widget.html", {"scene": "many", "folder": widgets})
    assert value["twice"] == {"lost": True, "parked": 'url("data:image/png;base64', "live": 1}
    assert value["canvases"] == 2
    assert value["again"] == {"live": 1, "canvases": 2}


def test_a_parked_view_shows_the_still(browser, widgets):
    value, _ = browser.run("widget.html", {"scene": "still", "folder": widgets})
    assert value["image"].startswith('url("blob:')
    assert value["canvases"] == 0


def test_a_bake_is_played_by_the_kernel(browser, tmp_path):
    recipe = builders.job(
        ocean__n=16, bake__frames=3, bake__maps=("displacement",), bake__pictures=[]
    )
    fo.bake(recipe, tmp_path / "sea", executor="serial")
    widget = fo.view(tmp_path / "sea")
    folder = browser.site.folders["bakes"] / "widget-bake"
    folder.mkdir()
    (folder / "about.json").write_text(json.dumps(widget.about))
    for j in range(3):
        (folder / f"0_{j}.bin").write_bytes(widget._shown.playback.frame(0, j))
    value, _ = browser.run(
        "widget.html", {"scene": "bake", "folder": f"{browser.site.address}/bakes/widget-bake"}
    )
    # a slow machine may ask twice
    asked = {(one["frame"]["tile"], one["frame"]["frame"]) for one in value["asked"]}
    assert asked == {(0, 0), (0, 1), (0, 2)}
    assert value["shownFrame"] in (0, 1, 2)
    assert "not <b>so</b>" in value["refusal"]  # as text
