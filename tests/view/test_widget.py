"""
Notebook widget: what it carries, what it answers, and the still of a saved notebook.
"""

import base64
import io
import itertools
import json
import struct
import subprocess
import sys

import numpy as np
import pytest
from builders import job

import fftocean as fo
from fftocean.errors import JobError, ParameterError
from fftocean.view import widget as module

pytest.importorskip("anywidget")
SEA = fo.Sea.from_wind(speed=8.0, fetch=60e3, direction=20.0)


@pytest.fixture(autouse=True)
def page(monkeypatch):
    """Replace the built page, which these tests do not need; draw stills small."""
    monkeypatch.setattr(module, "read_text", lambda name: f"/* {name} */")
    monkeypatch.setattr(module, "STILL", (96, 54))
    module._widget_class.cache_clear()
    yield
    module._widget_class.cache_clear()


@pytest.fixture(scope="module")
def cascade():
    return fo.Cascade(SEA, [(32, 400.0), (16, 41.0)], loop=32.0, seed=5)


def container(data):
    """Return the document of a container."""
    magic, version, length, _ = struct.unpack("<4sIII", data[:16])
    assert (magic, version) == (b"FFTO", 1)
    return json.loads(data[16 : 16 + length])


class Page:
    """A page that sends messages and keeps what the widget sends."""

    def __init__(self, widget, monkeypatch):
        self.widget, self.sent = widget, []
        monkeypatch.setattr(
            widget, "send", lambda content, buffers=(): self.sent.append((content, list(buffers)))
        )

    def ask(self, message):
        """Send a message; return the answers."""
        self.sent.clear()
        self.widget._handle_custom_msg({"text": json.dumps(message)}, [])
        return list(self.sent)


def test_a_cascade_is_carried_as_a_container(cascade):
    widget = fo.view(cascade, height=300, wind=(8.0, 20.0))
    document = container(widget.sea)
    assert [tile["n"] for tile in document["tiles"]] == [[32, 32], [16, 16]]
    assert document["wind"] == {"speed": 8.0, "direction": 20.0}
    assert document["id"] == 1
    assert widget.height == 300
    assert widget.about["title"].startswith("cascade: Hs ")
    assert {row["name"] for row in widget.about["table"]["parameters"]} > {"sun_elevation"}
    json.dumps(widget.about, allow_nan=False)


def test_an_ocean_and_a_sea_are_shown():
    ocean = fo.Ocean(SEA, n=32, size=100.0, loop=20.0)
    assert container(fo.view(ocean).sea)["tiles"][0]["size"] == [100.0, 100.0]
    document = container(fo.view(SEA, seed=9).sea)
    assert len(document["tiles"]) == 3
    wavelength = 2.0 * np.pi / fo.dispersion.wavenumber(SEA.peak, SEA.depth)
    assert document["tiles"][0]["size"][0] >= 12.0 * wavelength
    assert document["tiles"][0]["seed"] == 9


def test_options_of_a_call_are_those_of_the_widget(cascade):
    """`fo.view` is a module that can be called."""
    widget = fo.view(cascade, height=500, wind=(3.0, 10.0))
    assert widget.height == 500
    assert container(widget.sea)["wind"] == {"speed": 3.0, "direction": 10.0}
    with pytest.raises(TypeError):
        fo.view(cascade, width=500)


@pytest.mark.parametrize("depth", [np.inf, 4.0])
def test_tiles_of_a_sea_hold_twelve_waves_of_its_peak(depth):
    """By the wavelength at the depth of the sea: omega^2 = g k tanh(k d), solved by bisection."""
    spectrum = fo.JONSWAP.from_sea_state(hs=0.6, tp=8.0)
    sea = fo.Sea(fo.WaveSystem(spectrum=spectrum), depth=depth)
    low, high = 1e-4, 10.0
    while high - low > 1e-12:
        k = 0.5 * (low + high)
        shallow = np.tanh(k * depth) if np.isfinite(depth) else 1.0
        low, high = (k, high) if 9.80665 * k * shallow < sea.peak**2 else (low, k)
    tiles = [tile.grid for tile in module._cascade(sea, 3).oceans]
    assert tiles[0].lx == pytest.approx(12.0 * 2.0 * np.pi / low, rel=1e-6)
    assert [tile.nx for tile in tiles] == [128] * 3
    ratios = [one.lx / other.lx for one, other in itertools.pairwise(tiles)]
    assert all(abs(ratio - round(ratio)) > 0.1 for ratio in ratios)


def test_the_still_is_a_picture_of_the_sea(cascade):
    """The saved notebook holds the widget, a PNG and a line of text."""
    from PIL import Image

    widget = fo.view(cascade)
    data, _ = widget._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in data
    assert data["text/plain"] == widget.about["title"]
    picture = np.asarray(Image.open(io.BytesIO(base64.b64decode(data["image/png"]))))
    assert picture.shape[:2] == module.STILL[::-1]
    assert np.std(picture) > 10.0
    assert widget.still == base64.b64decode(data["image/png"])


def test_another_sea_takes_its_place(cascade):
    widget = fo.view(cascade)
    widget._repr_mimebundle_()
    before, still = widget.sea, widget.still
    widget.show(fo.Cascade(SEA, [(32, 400.0), (16, 41.0)], loop=32.0, seed=6))
    assert container(widget.sea)["id"] == 2
    assert widget.sea != before
    assert widget._repr_mimebundle_()[0]["image/png"] != base64.b64encode(still).decode()


def test_the_page_can_ask_for_reference_fields(cascade, monkeypatch):
    """Fields are those of the cascade at the tick, computed in float64."""
    widget = fo.view(cascade)
    page = Page(widget, monkeypatch)
    ticks = container(widget.sea)["ticks"]
    answers = page.ask({"verify": {"tick": 777, "sea": 1}})
    assert [content for content, _ in answers] == [{"kind": "reference"}] * 2
    for i, (_, (data,)) in enumerate(answers):
        length = struct.unpack("<I", data[8:12])[0]
        header = json.loads(data[16 : 16 + length])
        assert (header["tile"], header["tick"], header["sea"]) == (i, 777, 1)
        fields = np.frombuffer(data, "<f4", offset=16 + length)
        fields = fields.reshape(8, header["ny"], header["nx"])
        right = cascade.oceans[i].loop_frame(777, ticks)
        error = fields[2] - right.height
        assert np.linalg.norm(error) <= 5e-7 * np.linalg.norm(right.height)
    ((content, _),) = page.ask({"verify": {"tick": 777, "sea": 4}})
    assert content["kind"] == "refused"
    assert "the sea was changed" in content["value"]["message"]


@pytest.mark.parametrize(
    "message",
    [{"set": {"wind_speed": 9}}, {"copy": "job"}, {"frame": {"tile": 0, "frame": 0}}, {"x": 1}, 7],
)
def test_other_messages_are_refused(cascade, monkeypatch, message):
    page = Page(fo.view(cascade), monkeypatch)
    ((content, buffers),) = page.ask(message)
    assert (content["kind"], buffers) == ("refused", [])
    assert content["value"]["message"]


def test_a_message_that_is_no_text_is_refused(cascade, monkeypatch):
    page = Page(fo.view(cascade), monkeypatch)
    for content in (None, [], {"text": 3}, {"text": "{"}):
        page.sent.clear()
        page.widget._handle_custom_msg(content, [])
        assert page.sent[0][0]["kind"] == "refused"


def test_a_bake_is_played(tmp_path, monkeypatch):
    recipe = job(
        ocean__n=16, bake__frames=3, bake__maps=("displacement",), bake__pictures=[],
    )  # fmt: skip
    fo.bake(recipe, tmp_path / "sea", executor="serial")
    widget = fo.view(tmp_path / "sea")
    assert widget.sea == b""
    assert widget.about["bake"]["frames"] == 3
    page = Page(widget, monkeypatch)
    ((content, (data,)),) = page.ask({"frame": {"tile": 0, "frame": 2}})
    assert content == {"kind": "frame"}
    assert data[:4] == b"FFTB"
    ((content, _),) = page.ask({"frame": {"tile": 1, "frame": 0}})
    assert "tile must be" in content["value"]["message"]
    assert base64.b64decode(widget._repr_mimebundle_()[0]["image/png"])[:4] == b"\x89PNG"
    with pytest.raises(ParameterError, match="go on with what it began"):
        widget.show(SEA)


def test_what_cannot_be_shown_is_refused(cascade, tmp_path):
    with pytest.raises(ParameterError, match=r"shows an Ocean, a Cascade, a Sea or .*, got 3"):
        fo.view(3)
    with pytest.raises(ParameterError, match="loop"):
        fo.view(fo.Ocean(SEA, n=16, size=100.0))
    with pytest.raises(ParameterError, match="power of two"):
        fo.view(fo.Ocean(SEA, n=24, size=100.0, loop=20.0))
    with pytest.raises(ParameterError, match="height must be"):
        fo.view(cascade, height=3)
    fo.bake(
        job(ocean__n=16, bake__frames=1, bake__maps=("normal",), bake__pictures=[]),
        tmp_path / "normals",
        executor="serial",
    )
    with pytest.raises(JobError, match="without a height or displacement map"):
        fo.view(str(tmp_path / "normals"))


def test_without_anywidget_a_sentence_says_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    with pytest.raises(ParameterError, match=r"needs anywidget, .*pip install '\.\[notebook\]'"):
        fo.view(SEA)


def test_the_widget_is_imported_when_it_is_needed():
    """Neither the package nor its view loads anywidget or IPython."""
    code = (
        "import sys, fftocean as fo; import fftocean.view; assert callable(fo.view);"
        "print([m for m in ('anywidget', 'IPython', 'traitlets', 'numba') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.process
def test_a_saved_notebook_holds_the_picture(tmp_path):
    """A kernel runs the cell; the file has the widget and, for readers without a kernel, a PNG."""
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    cells = [
        "import fftocean as fo, fftocean.view.widget as w\n"
        "w.read_text, w.STILL = lambda name: '', (96, 54)\n"
        "sea = fo.Sea.from_wind(speed=8.0, fetch=60e3)",
        "fo.view(fo.Ocean(sea, n=16, size=100.0, loop=20.0))",
    ]
    notebook = nbformat.v4.new_notebook(cells=list(map(nbformat.v4.new_code_cell, cells)))
    client = nbclient.NotebookClient(
        notebook, timeout=300, resources={"metadata": {"path": tmp_path}}
    )
    client.execute()
    file = tmp_path / "sea.ipynb"
    nbformat.write(notebook, file)
    saved = nbformat.read(file, as_version=4)
    nbformat.validate(saved)
    (output,) = saved.cells[1].outputs
    assert output.data["text/plain"].startswith("ocean: Hs ")
    assert base64.b64decode(output.data["image/png"])[:8] == b"\x89PNG\r\n\x1a\n"
    assert "application/vnd.jupyter.widget-view+json" in output.data
