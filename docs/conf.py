"""
The documentation as a site: `python -m sphinx -W -b html docs docs/_build`.

Nothing is fetched while it is built or read: fonts and scripts are the theme's own, and formulas
are MathML. Notebooks are shown with the outputs that they store; none is run.
"""

import inspect
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import fftocean

DOCS = Path(__file__).resolve().parent
sys.path.insert(0, str(DOCS / "_ext"))

project = "fftocean"
author = "the fftocean authors"
copyright = author
version = release = fftocean.__version__
extensions = [
    "myst_nb",
    "mathml",
    "sphinx_design",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
]
html_theme = "furo"
html_title = "fftocean"
html_theme_options = {"navigation_with_keys": True}
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
exclude_patterns = ["_build", "jupyter_execute"]
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "off"
autodoc_member_order = "bysource"
autodoc_typehints = "description"
napoleon_google_docstring = True
napoleon_numpy_docstring = False
suppress_warnings = ["misc.highlighting_failure"]  # the drawing in Mermaid is shown as text


def _directive(name: str) -> str:
    """Return the directive that documents a public name."""
    value = getattr(fftocean, name)
    if inspect.ismodule(value):
        members = ", ".join(_members(value))
        return f".. automodule:: {value.__name__}\n   :members: {members}\n   :no-index:\n"
    if inspect.isclass(value):
        return f".. autoclass:: fftocean.{name}\n   :members:\n"
    return f".. autofunction:: fftocean.{name}\n"


def _members(module: Any) -> list[str]:
    """Return the names that a public module defines or lists."""
    listed = getattr(module, "__all__", None)
    if listed is None:
        listed = [
            name
            for name, value in vars(module).items()
            if not name.startswith("_")
            and (inspect.isclass(value) or inspect.isfunction(value))
            and value.__module__.startswith(module.__name__)
        ]
    return [name for name in listed if not inspect.ismodule(getattr(module, name))]


def _write_names() -> None:
    """Write a page of docstrings for each section of api.md, whose tables list the names."""
    folder = DOCS / "names"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    sections = (DOCS / "api.md").read_text(encoding="utf-8").split("\n## ")[1:]
    for section in sections:
        title, _, text = section.partition("\n")
        if "| `fo." not in text:
            continue
        lines = [f"# {title}: units, shapes, errors", ""]
        for name in re.findall(r"^\| `fo\.(\w+)` \|", text, re.MULTILINE):
            lines += [f"## fo.{name}", "", "```{eval-rst}", _directive(name), "```", ""]
        slug = re.sub(r"\W+", "_", title.lower())
        (folder / f"{slug}.md").write_text("\n".join(lines), encoding="utf-8")


def _copy_notebooks() -> None:
    """Copy the notebooks, as Sphinx reads no pages outside its own folder."""
    folder = DOCS / "notebooks"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for path in sorted((DOCS.parent / "notebooks").glob("*.ipynb")):
        shutil.copyfile(path, folder / path.name)


def _as_written(*arguments: Any) -> None:
    """Show what a docstring sets in as it stands there, and its |k| and c* as characters."""
    lines: list[str] = arguments[-1]
    shown: list[str] = []
    literal = False
    for line in lines:
        indented = line.startswith("    ")
        if indented and len(shown) > 1 and not shown[-1] and shown[-2][:1].strip():
            shown += ["::", ""]
            literal = True
        elif line and not indented:
            literal = False
        if not literal:
            line = re.sub(r"(?<=\S)[*|]|(?<=\S )[*|](?=\S)|^\|", r"\\\g<0>", line)
            line = re.sub(r"(?<=\w)_(?=\W|$)", r"\\_", line)
        shown.append(line)
    lines[:] = shown


def setup(app: Any) -> None:
    """Write what `names/` and `notebooks/` of the site hold."""
    app.connect("autodoc-process-docstring", _as_written, priority=100)  # before napoleon
    _write_names()
    _copy_notebooks()
