"""HTML that notebooks show of a value: parsed, with the image decoded."""

import base64
import io
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

import fftocean as fo
from fftocean import notebook_html


class Tags(HTMLParser):
    """Counts opened and closed tags and keeps the text."""

    def __init__(self, html):
        super().__init__()
        self.open, self.text = [], ""
        self.feed(html)
        assert not self.open

    def handle_starttag(self, tag, _):
        if tag not in ("img", "polyline"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag != "polyline":
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def ocean(**arguments):
    return fo.Ocean.from_modes([(1, 0, 0.5, 0.0), (0, 2, 0.1, 1.0)], n=32, size=50.0, **arguments)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: fo.Sea.from_wind(speed=10.0, fetch=1e5), ["Hs", "Tp", "TMA", "m²/Hz"]),
        (lambda: fo.Sea(), ["Hs", "0 m"]),
        (lambda: ocean(), ["32 x 32", "50 x 50 m", "given waves"]),
        (lambda: ocean().frame(1.5), ["t = 1.5 s", "height"]),
        (lambda: ocean().frame(1.5, ["slope_x"]), ["slope_x"]),
        (lambda: fo.measure(ocean()), ["specified", "realised", "Hs"]),
    ],
)
def test_a_value_is_shown_as_well_formed_html(make, words):
    shown = Tags(make()._repr_html_())
    for word in words:
        assert word in shown.text


def test_the_image_is_the_height_north_up():
    frame = ocean().frame(0.0)
    data = re.search(r"base64,([^\"]+)", frame._repr_html_())[1]
    pixels = np.asarray(Image.open(io.BytesIO(base64.b64decode(data)))).astype(float).sum(axis=2)
    assert pixels.shape == (32, 32)
    seen = np.corrcoef(pixels[::-1].ravel(), frame.height.ravel())[0, 1]
    assert seen > 0.95


def test_large_fields_are_thinned_and_texts_escaped():
    assert notebook_html._colours(np.ones((1000, 500))).shape == (200, 100, 3)
    assert "<b>" not in notebook_html.table("<b>", [("<b>", "<b>")])
    large = fo.Ocean.from_modes([(1, 0, 0.5, 0.0)], n=(2048, 1024), size=50.0)
    assert "<img" not in large._repr_html_()
