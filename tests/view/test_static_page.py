"""The page as one file: nothing from outside, policy by hashes, the sea in it whole."""

import base64
import hashlib
import json
import zlib
from dataclasses import replace
from html.parser import HTMLParser

import pytest
from serving import PAGE, small_state

import fftocean as fo
from fftocean.errors import OutputError
from fftocean.runtime.container import from_bytes
from fftocean.view.page_files import built_page
from fftocean.view.state import State
from fftocean.view.static_page import POINTS, static_page, write_static


class Elements(HTMLParser):
    """The elements of a page with their attributes, and the texts of scripts and styles."""

    def __init__(self, page):
        super().__init__(convert_charrefs=True)
        self.found, self.texts = [], []
        self._inside = None
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))
        self._inside = tag
        if tag in ("script", "style", "title"):
            self.texts.append((tag, dict(attributes), ""))

    def handle_endtag(self, _tag):
        self._inside = None

    def handle_data(self, data):
        if self._inside in ("script", "style", "title"):
            tag, attributes, text = self.texts[-1]
            self.texts[-1] = (tag, attributes, text + data)

    def text(self, name):
        """Return the text of the element with an id."""
        return next(text for _, given, text in self.texts if given.get("id") == name)


def sea_in(elements):
    """Return the container in a page, taken apart with zlib and slices alone."""
    attributes = next(given for _, given in elements.found if given.get("id") == "sea")
    count = int(attributes["data-planes"])
    planes = zlib.decompress(base64.b64decode(elements.text("sea")))
    data = bytearray(len(planes))
    for i in range(count):
        data[i::count] = planes[i * len(planes) // count : (i + 1) * len(planes) // count]
    length = 16 + int.from_bytes(data[8:12], "little")
    files = json.loads(data[16:length])["files"]
    return bytes(data[: length + sum(-(-file["bytes"] // 16) * 16 for file in files)])


@pytest.fixture(scope="module")
def made(page):
    """Return the static page of the small sea."""
    return Elements(static_page(small_state(), folder=page).decode())


def test_nothing_is_asked_from_outside(made):
    for tag, attributes in made.found:
        assert "src" not in attributes, tag
        if tag != "link":
            assert "href" not in attributes, tag
        assert not [name for name in attributes if name.startswith("on")]
        assert "style" not in attributes
    assert not [a for tag, a in made.found if tag == "link" and a["rel"] == "stylesheet"]


def test_the_policy_allows_its_own_script_and_style_alone(made):
    (policy,) = (
        a["content"] for _, a in made.found if a.get("http-equiv") == "Content-Security-Policy"
    )
    rules = dict(part.split(" ", 1) for part in policy.split("; "))
    run = [text for tag, a, text in made.texts if tag == "script" and "type" not in a]
    styles = [text for tag, _, text in made.texts if tag == "style"]
    for name, texts in (("script-src", run), ("style-src", styles)):
        (text,) = texts
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert rules[name] == f"'sha256-{digest}'"
    assert rules["default-src"] == "'none'"
    assert "connect-src" not in rules
    assert "unsafe" not in policy
    places = [i for i, (tag, a) in enumerate(made.found) if tag == "script" or "http-equiv" in a]
    assert "http-equiv" in made.found[places[0]][1]  # before anything that it is about


def test_a_script_cannot_end_its_element(made):
    """The small page's script has `</script>` and `<!--` in a text, where an escape is the same."""
    assert "</script> <!--" in PAGE["static.js"]
    (run,) = (text for tag, a, text in made.texts if tag == "script" and "type" not in a)
    assert r"static \x3c/script> \x3c!-- in it" in run
    assert "<!--" not in run


def test_the_sea_in_the_page_is_that_of_the_state(made):
    package = from_bytes(sea_in(made))
    ocean = fo.Job.from_toml(package.document["job"]).ocean()
    assert package.document["tiles"][0]["waves"] == sum(
        int((w != 0).sum()) for w in (ocean.amplitudes.forward, ocean.amplitudes.backward[:, 1:])
    )
    assert package.document["statistics"]["specified"]["hs"] == pytest.approx(
        small_state().sea().hs, rel=1e-6
    )
    check = json.loads(package.files["check.json"])
    assert {len(tile["columns"]) for tile in check["tiles"]} == {POINTS}


def test_the_page_says_what_it_shows(made):
    about = json.loads(made.text("about"))
    assert about["seed"] == 7
    assert about["version"] == fo.__version__
    assert about["hs"] == pytest.approx(small_state().sea().hs, rel=1e-6)
    assert about["source"] == "wind sea and swell"
    assert about["command"] == small_state().command()
    (title,) = (text for tag, _, text in made.texts if tag == "title")
    assert title == f"wind sea and swell: Hs {about['hs']:.2f} m"
    rows = json.loads(made.text("parameters"))["parameters"]
    assert "chlorophyll" in [row["name"] for row in rows]


EVIL = '</script><script>alert(1)</script><!-- "\'> <b onclick="x">&amp;</title>'


def test_a_name_is_text_in_every_place(page):
    state = replace(small_state(), source=EVIL)
    elements = Elements(static_page(state, folder=page).decode())
    assert [tag for tag, _ in elements.found].count("script") == 4
    assert "b" not in [tag for tag, _ in elements.found]
    assert json.loads(elements.text("about"))["source"] == EVIL
    (title,) = (text for tag, _, text in elements.texts if tag == "title")
    assert title.startswith(EVIL)


@pytest.mark.parametrize(
    "name", ["</script x", "</SCRIPT/", "</script\n", "<!-- <script ", "&lt;/script ", "a</title b"]
)
def test_a_name_that_ends_no_element_by_itself_ends_none_of_the_page_s(page, name):
    """
    `</script` ends a script without the `>` of its own, which may come later in the page; `<!--`
    and `<script` together hide the end.
    """
    text = static_page(replace(small_state(), source=name), folder=page).decode()
    elements = Elements(text)
    assert [tag for tag, _ in elements.found].count("script") == 4
    about = elements.text("about")
    assert not set("<>&") & set(about)
    assert json.loads(about)["source"] == name


def test_a_calm_has_a_page(page):
    state = small_state(wind_speed=0.0, swell_speed=0.0)
    about = json.loads(Elements(static_page(state, folder=page).decode()).text("about"))
    assert about["hs"] == 0.0
    assert any("flat" in note for note in about["notes"])


def test_a_page_of_three_tiles_is_small(page):
    """The built page adds its own code and style, 150 kB at most, to make 450 kB."""
    size = len(static_page(State.default(n=128), folder=page))
    assert size <= 450_000 - 150_000


def test_the_built_page_is_small():
    folder = built_page()
    if not folder.joinpath("static.js").is_file():
        pytest.skip("the page is not built")
    assert sum(len(file.read_bytes()) for file in folder.iterdir()) <= 160_000
    assert len(static_page(State.default(n=128))) <= 450_000


def test_a_file_or_a_folder_is_written(page, tmp_path):
    state = small_state()
    sizes = write_static(state, tmp_path / "sea.html", as_folder=False, folder=page)
    assert sizes == {str(tmp_path / "sea.html"): (tmp_path / "sea.html").stat().st_size}
    sizes = write_static(state, tmp_path / "site", as_folder=True, folder=page)
    assert {str(p.relative_to(tmp_path / "site")) for p in (tmp_path / "site").rglob("*.*")} >= {
        "index.html",
        "sea/sea.json",
        "sea/tile0.waves",
    }
    assert not fo.check(tmp_path / "site" / "sea")
    again = fo.load_sea(tmp_path / "site" / "sea")
    assert again.modes().kx.size > 100
    assert write_static(state, tmp_path / "site", as_folder=True, folder=page) == sizes


def test_a_page_that_is_not_built_is_an_error(tmp_path):
    with pytest.raises(OutputError, match=r"index\.html must be beside the package .* build it"):
        static_page(small_state(), folder=tmp_path)


def test_a_page_of_another_form_is_an_error(tmp_path):
    for name, text in PAGE.items():
        (tmp_path / name).write_text(text.replace("<title>", "<h1>"))
    with pytest.raises(OutputError, match=r"must have <title>.* once, and has it 0 times"):
        static_page(small_state(), folder=tmp_path)
