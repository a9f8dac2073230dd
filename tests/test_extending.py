"""The recipes of docs/extending.md run, and each adds one thing to one table."""

import re

import pytest
from builders import ROOT

PAGE = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
RECIPES = {
    title: "\n".join(re.findall(r"```python\n(.*?)```", body, re.DOTALL))
    for title, body in re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", PAGE, re.DOTALL | re.MULTILINE)
}
ADDED = {
    "A spectrum": "gaussian-swell",
    "A spreading": "von-mises",
    "A map": "steepness",
    "A file format": "f32",
    "An engine": "stride",
    "A reader": "two columns",
}


@pytest.fixture
def names(monkeypatch):
    """Return a function from a recipe to the names in its table; restore the tables afterwards."""
    from fftocean import readers
    from fftocean.baking.scene.maps import MAPS
    from fftocean.export.engines import CELLS, TABLE
    from fftocean.export.formats import FORMATS
    from fftocean.export.profiles import PROFILES
    from fftocean.physics.spectra import SPECTRA
    from fftocean.physics.spreading import SPREADINGS

    kinds = [SPECTRA._kinds, SPREADINGS._kinds]  # nothing in the package removes a kind
    tables = [*kinds, MAPS, FORMATS, PROFILES, CELLS, *CELLS.values(), TABLE]
    before = [dict(table) for table in tables]
    monkeypatch.setattr(readers, "FORMATS", readers.FORMATS)
    yield lambda title: {
        "A spectrum": list(SPECTRA),
        "A spreading": list(SPREADINGS),
        "A map": list(MAPS),
        "A file format": list(FORMATS),
        "An engine": list(PROFILES),
        "A reader": [reader.name for reader in readers.FORMATS],
    }[title]
    for table, rows in zip(tables, before, strict=True):
        table.clear()
        table.update(rows)


@pytest.mark.parametrize("title", ADDED)
def test_a_recipe_runs_and_adds_one_name(title, names, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = names(title)
    namespace = {"__name__": "recipe"}
    exec(compile(RECIPES[title], f"docs/extending.md, {title}", "exec"), namespace)
    assert set(names(title)) - set(before) == {ADDED[title]}
    assert set(before) <= set(names(title))


def test_every_recipe_is_tried_and_asserts_something():
    assert list(RECIPES) == list(ADDED)
    assert all("\nassert " in code for code in RECIPES.values())


def test_the_places_that_the_page_names_exist():
    """The tables of the recipes; a place with < > is a pattern."""
    named = re.findall(r"`((?:fftocean|physics|baking|export|readers|job|tests)/[^`<>]*)`", PAGE)
    assert len(set(named)) > 10
    for place in named:
        assert (ROOT / place).exists() or (ROOT / "fftocean" / place).exists(), place
