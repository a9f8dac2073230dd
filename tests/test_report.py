"""The report: one file that asks for nothing: words, images, the check of a bake."""

import base64
import io
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from PIL import Image

import fftocean as fo
from fftocean import report
from fftocean.report import write_report

SMALL = {"ocean.n": 16, "bake.frames": 3, "bake.pictures": []}


class Page(HTMLParser):
    """Collects headings, images, text, and every address that a browser would ask for."""

    def __init__(self, html):
        super().__init__()
        self.headings, self.images, self.asked, self.text, self.tag = [], [], [], "", ""
        self.feed(html)

    def handle_starttag(self, tag, attributes):
        self.tag = tag
        values = dict(attributes)
        if tag == "img":
            assert values["alt"]
            self.images.append(values["src"])
        self.asked += [values[name] for name in ("href", "src") if name in values]

    def handle_data(self, data):
        self.text += data
        if self.tag == "h2":
            self.headings.append(data)
            self.tag = ""


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    job = fo.Job.default().replaced(SMALL)
    fo.bake(job, folder / "sea", executor="serial")
    size = write_report(job, folder / "sea.html", folder=folder / "sea")
    assert size == (folder / "sea.html").stat().st_size
    return Page((folder / "sea.html").read_text(encoding="utf-8"))


def test_it_asks_for_nothing(page):
    assert all(address.startswith("data:image/") for address in page.asked)


def test_the_images_are_whole(page):
    kinds = []
    for source in page.images:
        kind, data = re.fullmatch(r"data:image/(\w+);base64,(.*)", source).groups()
        with Image.open(io.BytesIO(base64.b64decode(data))) as image:
            image.load()
            kinds.append((kind, getattr(image, "n_frames", 1)))
    assert kinds == [("png", 1)] * 4 + [("webp", 3)]


def test_it_says_what_the_sea_is_and_that_the_bake_is_whole(page):
    assert page.headings == [
        "Statistics", "Spectra", "Images", "Loop", "Checks", "Files", "Job",
    ]  # fmt: skip
    assert "The sea of a wind of 7 m/s (Beaufort 4): significant wave height 0.8" in page.text
    assert "running toward ENE" in page.text
    assert "Every file agrees with its checksum." in page.text
    assert "FAILED" not in page.text
    assert "ocean.n16" in page.text.replace("\n", "")


def test_a_changed_bake_is_said(tmp_path):
    job = fo.Job.default().replaced({**SMALL, "bake.maps": ["height"]})
    fo.bake(job, tmp_path / "sea", executor="serial")
    image = next((tmp_path / "sea" / "height").iterdir())
    image.write_bytes(image.read_bytes()[:-1])
    write_report(job, tmp_path / "sea.html", folder=tmp_path / "sea")
    text = Path(tmp_path / "sea.html").read_text(encoding="utf-8")
    assert "Problems: 1." in text
    assert "Every file agrees" not in text


@pytest.fixture
def short(monkeypatch):
    """Leave out all sections of a report, which take seconds."""
    for name in ("_statistics", "_spectra", "_images", "_loop", "_checks", "_files", "_job"):
        monkeypatch.setattr(report, name, lambda *_: "")


@pytest.mark.usefixtures("short")
def test_a_name_is_no_markup(tmp_path):
    """In the title and in the heading."""
    name = '<b>"&amp;.toml'
    (tmp_path / name).write_text("[ocean]\nn = 8\n", encoding="utf-8")
    write_report(fo.Job.read(tmp_path / name), tmp_path / "sea.html")
    text = (tmp_path / "sea.html").read_text(encoding="utf-8")
    assert "<b>" not in text
    assert text.count("&lt;b&gt;&quot;&amp;amp;.toml") == 2


def test_energy_outside_the_tile_is_in_percent():
    found = fo.measure(fo.Job.default().replaced({"ocean.n": 8, "ocean.size": 12.0}).ocean())
    assert found.share_below > 0.02
    text = report._statistics(found)
    assert f"{100.0 * found.share_below:.2f} %" in text
    assert f"{100.0 * found.share_above:.2f} %" in text


def test_a_large_tile_is_not_verified_for_minutes(monkeypatch):
    monkeypatch.setattr(report, "verify", lambda _: ())
    job = fo.Job.default()
    assert "Not made here" not in report._checks(job.replaced({"ocean.n": 256}))
    assert "Not made here" in report._checks(job.replaced({"ocean.n": (512, 256)}))
