"""
The documentation as a site: `python -m sphinx -W -b html docs docs/_build`.

Nothing is fetched while it is built: fonts and scripts are the theme's own.
"""

import inspect
from pathlib import Path
from typing import Any

import fftocean

project = "fftocean"
author = "the fftocean authors"
copyright = author
version = release = fftocean.__version__
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
]
html_theme = "furo"
html_title = "fftocean"
html_theme_options = {"navigation_with_keys": True}
exclude_patterns = ["_build", "_names.rst"]
myst_heading_anchors = 3
myst_fence_as_directive: list[str] = []
autodoc_member_order = "bysource"
autodoc_typehints = "description"
napoleon_google_docstring = True
napoleon_numpy_docstring = False
nitpicky = False
suppress_warnings = ["misc.highlighting_failure"]  # the drawing in Mermaid is shown as text


def _directive(name: str) -> str:
    """Return the directive that documents a public name."""
    value = getattr(fftocean, name)
    if inspect.ismodule(value):
        return f".. automodule:: {value.__name__}\n   :members:\n   :no-index:\n"
    kind = "autoclass" if inspect.isclass(value) else "autofunction"
    members = "   :members:\n" if kind == "autoclass" else ""
    return f".. {kind}:: {value.__module__}.{value.__qualname__}\n{members}   :no-index:\n"


def _sections() -> str:
    """Return a section for each public name."""
    found = []
    for name in fftocean.__all__:
        title = f"fo.{name}"
        found += [title, "-" * len(title), "", _directive(name)]
    return "\n".join(found)


def _plain_bars(*arguments: Any) -> None:
    """Let |k| in a docstring be a magnitude, not a substitution."""
    lines: list[str] = arguments[-1]
    lines[:] = [line.replace("|", r"\|") for line in lines]


def setup(app: Any) -> None:
    """Write the list of public names that `reference.md` includes."""
    app.connect("autodoc-process-docstring", _plain_bars, priority=999)
    Path(__file__).with_name("_names.rst").write_text(_sections(), encoding="utf-8")
