"""Pages of docs/: links, pictures and formulas, the gallery, and the check of the built site."""

import re

import gallery
import pytest
import site_check
from builders import ROOT

import fftocean as fo

DOCS = ROOT / "docs"
OWN = [p for p in sorted(DOCS.rglob("*.md")) if not {"_build", "names"} & set(p.parts)]
IDS = [p.relative_to(DOCS).as_posix() for p in OWN]
CONCEPTS = [p for p in OWN if p.parent.name == "concepts" and p.stem != "index"]


@pytest.mark.parametrize("page", OWN, ids=IDS)
def test_linked_files_exist(page):
    text = page.read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", text):
        assert (page.parent / target).exists(), target


@pytest.mark.parametrize("page", OWN, ids=IDS)
def test_every_picture_has_a_text(page):
    for text, source in re.findall(r"!\[(.*?)\]\((\S+?)\)", page.read_text(encoding="utf-8")):
        assert len(text) > 10, source


@pytest.mark.parametrize("page", CONCEPTS, ids=lambda page: page.stem)
def test_a_concept_has_formula_source_and_picture(page):
    """The source as an author with a year; the picture is one of tools/concept_pictures.py."""
    import concept_pictures

    text = page.read_text(encoding="utf-8")
    assert re.search(r"^\$\$\n.*?^\$\$$", text, re.MULTILINE | re.DOTALL)
    assert re.search(r"[A-Z]\w+[^.]{0,40}? (1[89]|20)\d\d", text)
    assert f"]({page.stem}.png)" in text
    assert page.stem in concept_pictures.PICTURES


def test_formulas_are_mathml():
    """Each formula of the pages is one that docutils can write, and none loses a symbol."""
    tex2mathml = pytest.importorskip("docutils.utils.math.latex2mathml").tex2mathml

    count = 0
    for page in OWN:
        for formula in re.findall(r"^\$\$\n(.*?)^\$\$$", page.read_text("utf-8"), re.M | re.S):
            markup = tex2mathml(formula.strip(), as_block=True)
            assert markup.startswith("<math")
            assert "\\" not in markup
            count += 1
    assert count >= len(CONCEPTS)


def test_the_page_of_the_gallery_is_current():
    assert gallery.PAGE.read_text(encoding="utf-8") == gallery.page(), "run python tools/gallery.py"


def test_the_gallery_has_every_job():
    assert sorted(gallery.ORDER) == sorted(p.stem for p in gallery.JOBS.glob("*.toml"))
    assert len(gallery.ORDER) >= 12


@pytest.mark.parametrize("name", gallery.ORDER)
def test_a_sea_of_the_gallery_fits_its_tile_and_its_loop(name):
    """No warning is given: at least four peak periods, depth and steepness as real seas have."""
    job = fo.Job.read(gallery.JOBS / f"{name}.toml")
    sea = job.sea()
    assert job.settings["ocean.loop"] >= 4.0 * sea.tp
    length = 2.0 * 3.141593 / float(fo.dispersion.wavenumber(2.0 * 3.141593 / sea.tp, sea.depth))
    assert job.settings["ocean.size"] >= 4.0 * length
    fo.Ocean(sea, n=32, size=job.settings["ocean.size"], loop=job.settings["ocean.loop"])
    assert (gallery.PICTURES / f"{name}.webp").stat().st_size <= gallery.BYTES


GOOD = '<a href="b.html#here">b</a><img src="p.png" alt="a picture">'
BAD = {
    '<a href="c.html">c</a>': "no file c.html",
    '<a href="b.html#there">b</a>': "no place b.html#there",
    '<a href="#there">b</a>': "no place #there",
    '<img src="q.png" alt="a picture">': "no file q.png",
    '<img src="p.png">': "picture without text: p.png",
    '<script src="https://example.org/a.js"></script>': "loads https://example.org/a.js",
    '<link rel="stylesheet" href="//example.org/a.css">': "loads //example.org/a.css",
}


@pytest.mark.parametrize("page", [GOOD, *BAD])
def test_the_check_of_the_built_site(tmp_path, page):
    (tmp_path / "a.html").write_text(page + '<a href="https://example.org">elsewhere</a>')
    (tmp_path / "b.html").write_text('<h1 id="here">b</h1>')
    (tmp_path / "p.png").write_bytes(b"")
    found = site_check.problems(tmp_path.resolve())
    assert found == ([f"a.html: {BAD[page]}"] if page in BAD else [])
