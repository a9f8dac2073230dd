"""
The live page as one file, with the sea in it: no server, no request, no Python.

The container of the sea stands as deflated base64 in a script element that browsers do not run.
The content security policy allows the page's own script and style by their hashes, and nothing
from anywhere else.
"""

import base64
import hashlib
import html
import json
import re
import zlib
from collections.abc import Mapping
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, Final

import numpy as np

import fftocean
from fftocean.errors import OutputError
from fftocean.files import make_folder, write_whole
from fftocean.view import parameters
from fftocean.view.one_file import one_script
from fftocean.view.page_files import read_text
from fftocean.view.seas import MadeSea, make_exact
from fftocean.view.state import State

POINTS: Final = 16
"""Points a tile at which the page checks itself: fewer than in a package, for the file's size."""

PLANES: Final = 14
"""Planes of bytes of the container: as many as a record of a wave has bytes."""


def static_page(state: State, *, folder: Traversable | None = None) -> bytes:
    """
    Return the page of a sea as one HTML file.

    Args:
        state: values and job of the sea.
        folder: that of the built page; None for the package's.

    Raises:
        ParameterError: no such sea can be made.
        OutputError: the page is not built.
    """
    return page_of(make_exact(state, 1, points=POINTS), folder=folder)


def page_of(sea: MadeSea, *, folder: Traversable | None = None) -> bytes:
    """Return the page of a sea that is made."""
    page = read_text("index.html", folder)
    style, script = read_text("page.css", folder).strip(), one_script("static.js", folder=folder)
    about = about_sea(sea)
    page = _replaced(
        page,
        r'<link\s+rel="stylesheet"\s+href="page\.css"\s*/?>',
        f"<style>{_style(style)}</style>",
    )
    page = _replaced(page, r'<script\s+type="module"\s+src="page\.js"\s*></script>', "")
    page = _replaced(
        page,
        r'<meta\s+charset="utf-8"\s*/?>',
        f'<meta charset="utf-8"><meta http-equiv="Content-Security-Policy" '
        f'content="{html.escape(policy(script, style))}">',
    )
    page = _replaced(
        page,
        r"<title>.*?</title>",
        f"<title>{html.escape(about['title'])}</title>"
        f'<meta name="description" content="{html.escape(about["description"])}">'
        f'<meta name="generator" content="fftocean {about["version"]}">',
    )
    carried = (
        _data("parameters", "application/json", _json(parameters.table())),
        _data("about", "application/json", _json(about)),
        _data("sea", "application/octet-stream", _packed(sea.data), planes=PLANES),
        f"<script>{_script(script)}</script>",
    )
    return _replaced(page, "</body>", "\n".join((*carried, "</body>"))).encode()


def about_sea(sea: MadeSea) -> dict[str, Any]:
    """Return what a page without a server says about its sea."""
    specified = sea.document["statistics"]["specified"]
    hs = specified["hs"] if specified else None
    seed = sea.state.values["seed"]
    waves = f"Hs {hs:.2f} m" if hs is not None else "waves"
    return {
        "title": f"{sea.state.source}: {waves}",
        "description": (
            f"{sea.state.source}, {waves}, seed {seed}, computed by fftocean "
            f"{fftocean.__version__} and evolved in the page"
        ),
        "source": sea.state.source,
        "hs": hs,
        "seed": seed,
        "version": fftocean.__version__,
        "command": sea.state.command(),
        "state": sea.state.plain(),
        "notes": list(sea.notes),
    }


def policy(script: str, style: str) -> str:
    """Return the content security policy of a page with these texts in it."""
    return "; ".join(
        (
            "default-src 'none'",
            f"script-src '{_hash(_script(script))}'",
            f"style-src '{_hash(_style(style))}'",
            "img-src data: blob:",
            "worker-src blob:",
            "base-uri 'none'",
            "form-action 'none'",
        )
    )


def write_static(
    state: State, path: Path, *, as_folder: bool, folder: Traversable | None = None
) -> dict[str, int]:
    """
    Write the page as one file, or a folder with the page and the run-time package beside it.

    Args:
        state: values and job of the sea.
        path: the file or the folder.
        as_folder: write a folder.
        folder: that of the built page; None for the package's.

    Returns:
        The size of each file [bytes], by its path.

    Raises:
        ParameterError: no such sea can be made.
        OutputError: the page is not built, or a file could not be written.
    """
    sea = make_exact(state, 1, points=POINTS)
    page = page_of(sea, folder=folder)
    if not as_folder:
        if path.is_dir():
            raise OutputError(
                f"{path} must be a file, and is a folder; name a folder with a / after it"
            )
        write_whole(path, page)
        return {str(path): len(page)}
    from fftocean.runtime.folder import export_sea

    make_folder(path)
    package = path / "sea"
    assert sea.cascade is not None  # it is exact
    wind = sea.document["wind"]
    export_sea(
        sea.cascade,
        package,
        job=state.toml(),
        wind=None if wind is None else (wind["speed"], wind["direction"]),
    )
    write_whole(path / "index.html", page)
    files = [path / "index.html", *sorted(package.iterdir())]
    return {str(file): file.stat().st_size for file in files}


def _replaced(page: str, pattern: str, text: str) -> str:
    """Return the page with the only match of a pattern replaced."""
    made, count = re.subn(pattern, lambda _: text, page, flags=re.DOTALL)
    if count != 1:
        raise OutputError(
            f"the page's index.html must have {pattern} once, and has it {count} times"
        )
    return made


def _data(name: str, kind: str, text: str, **attributes: int) -> str:
    """Return a script element that carries data and is not run."""
    more = "".join(f' data-{key}="{value}"' for key, value in attributes.items())
    return f'<script type="{kind}" id="{name}"{more}>{text}</script>'


def _packed(data: bytes) -> str:
    """
    Return a container as base64 of deflated planes; plane i holds every `PLANES`-th byte from i on.

    The whole numbers of the waves are then beside their like and nearly vanish: 0.55 of the size.
    """
    rows = -(-len(data) // PLANES)
    padded = np.frombuffer(data.ljust(rows * PLANES, b"\0"), np.uint8)
    planes = np.ascontiguousarray(padded.reshape(rows, PLANES).T)
    return base64.b64encode(zlib.compress(planes.tobytes(), 9)).decode()


def _json(tree: Mapping[str, Any]) -> str:
    """Return JSON that cannot end the element that it stands in."""
    text = json.dumps(tree, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _script(text: str) -> str:
    """
    Return a script that can stand in an element: `</script` would end it, `<!--` change it.

    Both can only be in texts and patterns of a script, where the escape means the same.
    """
    return re.sub(r"<(?=/script|!--)", r"\\x3c", text, flags=re.IGNORECASE)


def _style(text: str) -> str:
    """Return a style sheet that can stand in an element."""
    if "</style" in text.lower():
        raise OutputError("the page's page.css must not have </style in it")
    return text


def _hash(text: str) -> str:
    """Return the hash of an inline text as a policy names it."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
