"""Files of the page, as the server and the static page take them from the package."""

from dataclasses import dataclass
from importlib import resources
from importlib.resources.abc import Traversable
from typing import Final

from fftocean.errors import OutputError

PARTS: Final = (
    "accessibility.js",
    "bake.js",
    "blend.js",
    "buoy.js",
    "comparison.js",
    "dialogs.js",
    "files.js",
    "heads_up.js",
    "interface.js",
    "verification.js",
    "views.js",
    "worker_simulation.js",
)
"""Modules that the page loads when they are wanted; `core.js` is what they and it share."""

_SCRIPT: Final = "text/javascript; charset=utf-8"

TYPES: Final = {
    "index.html": "text/html; charset=utf-8",
    "page.css": "text/css; charset=utf-8",
    **dict.fromkeys(("page.js", "core.js", *PARTS, "worker.js"), _SCRIPT),
}
"""The closed list of files that are served, with their types."""


@dataclass(frozen=True, slots=True)
class PageFile:
    """One file as it is served."""

    data: bytes
    type: str


def built_page() -> Traversable:
    """Return the folder of the built page."""
    return resources.files("fftocean.view").joinpath("page")


def read_text(name: str, folder: Traversable | None = None) -> str:
    """
    Return the text of a file of the built page.

    Args:
        name: of the file.
        folder: that of the page; None for the package's.

    Raises:
        OutputError: the page is not built.
    """
    file = (folder or built_page()).joinpath(name)
    try:
        return file.read_text(encoding="utf-8")
    except OSError:
        raise OutputError(
            f"the page's {name} must be beside the package and is not; in a checkout, build it: "
            "npm ci && npm run build in fftocean/view/web"
        ) from None


def served_files(folder: Traversable | None = None) -> dict[str, PageFile]:
    """
    Return the files that are served, by their paths.

    Raises:
        OutputError: the page is not built.
    """
    files = {
        "/" + name: PageFile(read_text(name, folder).encode(), kind) for name, kind in TYPES.items()
    }
    files["/"] = files.pop("/index.html")
    return files
