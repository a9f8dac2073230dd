"""
Pictures of the tutorials: what the code and the commands of each page draw.

    python tools/tutorial_pictures.py [PAGE ...]

Blocks of a page are run in order, in a folder that has the checkout's examples and buoy files;
then the files that they wrote become pictures. Blender is its Python module of tests/clients, or
$FFTOCEAN_BLENDER_PYTHON; Godot is the web build of tests/clients.
"""

import base64
import contextlib
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

import fftocean as fo

ROOT = Path(__file__).resolve().parents[1]
PAGES = ROOT / "docs" / "tutorials"
CLIENTS = ROOT / "tests" / "clients"
BLENDER = os.environ.get("FFTOCEAN_BLENDER_PYTHON", str(ROOT / ".venv-blender/bin/python"))
BLOCK = re.compile(r"^```(python|bash)\n(.*?)^```", re.MULTILINE | re.DOTALL)
GODOT = "project/lake"

# of each page: the file that its code writes, the picture, and its width [pixels]
MADE = {
    "artists": {
        "lake/preview.webp": ("artists_preview", 480),
        "still.png": ("artists_blender", 640),
        "godot.png": ("artists_godot", 640),
    },
    "robotics": {"ride.png": ("robotics_ride", 880)},
    "engineers": {
        "buoy/preview.png": ("engineers_preview", 880),
        "buoy.png": ("engineers_spectrum", 880),
    },
    "teachers": {"waves.png": ("teachers_waves", 880), "times.png": ("teachers_times", 770)},
}


def command(line: str) -> str | None:
    """Return a command of a page as it is run here, or None for one that is not."""
    if "pip install" in line or "mujoco" in line or line.startswith("blender --python"):
        return None
    if line.startswith("blender "):
        return line.replace("blender --background --python", BLENDER).replace(" -- ", " ")
    return line


def run(page: str) -> None:
    """Run the blocks of a page in the current folder."""
    scope: dict[str, object] = {"__name__": "__main__"}
    text = (PAGES / f"{page}.md").read_text(encoding="utf-8")
    for language, code in BLOCK.findall(text):
        if language == "python":
            exec(compile(code, page, "exec"), scope)
            continue
        for line in filter(None, map(command, code.splitlines())):
            print("$", line, flush=True)
            path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
            subprocess.run(line, shell=True, check=True, env={**os.environ, "PATH": path})


def picture_of_godot(folder: Path, path: Path) -> None:
    """Take a picture of the scene of a bake in Godot's web build."""
    sys.path.insert(0, str(CLIENTS))
    from pck import pack
    from web import Browser, Site

    package = Path("package")  # which the scripts of the tests' project ask for
    ocean = fo.Ocean.from_modes([(1, 0, 0.1, 0.0)], n=8, size=10.0, loop=8.0)
    fo.export_sea(ocean, package, engine="godot")
    files = {f.name: f.read_bytes() for f in (CLIENTS / "godot_project").iterdir()}
    for name, place in (("bake", folder), ("live", package)):
        for file in place.rglob("*"):
            if file.is_file() and file.suffix not in (".png", ".webp", ".import"):
                files[f"{name}/{file.relative_to(place).as_posix()}"] = file.read_bytes()
    scene = {"path": "res://bake/sea_bake.tscn", "time": 3.0, "picture": [640, 360]}
    scene |= {"points": [[0.0, 0.0]], "places": [0.0] * 4, "probes": {}}
    compute = {"tick": 0, "seconds": 0.0, "about": [0.0, 0.0]}
    ask = {"scenes": {"bake": scene}, "textures": {}, "compute": compute}
    files["ask.json"] = json.dumps(ask).encode()
    with tempfile.TemporaryDirectory() as temporary:
        there = Path(temporary)
        (there / "godot-project.pck").write_bytes(pack(files))
        folders = {
            "npm": CLIENTS / "node_modules",
            "pages": CLIENTS / "pages",
            "bakes": there,
        }
        chromium = shutil.which("chromium") or shutil.which("google-chrome")
        with (
            Site(folders) as site,
            Browser(chromium, folders["npm"], site, log=there / "driver.log") as browser,
        ):
            value, _ = browser.run("godot.html", {"pack": "/bakes/godot-project.pck"})
    path.write_bytes(base64.b64decode(value["answers"]["bake picture"]))


def smaller(source: Path, name: str, width: int) -> None:
    """Save a picture, or a moving one, as WebP of at most a width."""
    image = Image.open(source)
    frames = []
    for i in range(getattr(image, "n_frames", 1)):
        image.seek(i)
        frame = image.convert("RGB")
        size = (width, round(width * frame.height / frame.width))
        frames.append(frame if frame.width <= width else frame.resize(size, Image.LANCZOS))
    moving = {"save_all": True, "append_images": frames[1::2], "loop": 0, "duration": 125}
    data = io.BytesIO()
    options = moving if len(frames) > 1 else {}
    frames[0].save(data, "WEBP", quality=60 if options else 82, method=6, **options)
    (PAGES / f"{name}.webp").write_bytes(data.getvalue())
    print(f"{name}.webp {len(data.getvalue())} bytes", flush=True)


def main(pages: list[str]) -> None:
    """Draw the pictures of the pages named, or of all."""
    os.environ.setdefault("MPLBACKEND", "Agg")
    for page in pages or MADE:
        with tempfile.TemporaryDirectory() as name, contextlib.chdir(name):
            Path("examples").symlink_to(ROOT / "examples")
            Path("tests").symlink_to(ROOT / "tests")
            run(page)
            if page == "artists":
                picture_of_godot(Path(GODOT), Path("godot.png"))
            for file, (picture, width) in MADE[page].items():
                smaller(Path(file), picture, width)


if __name__ == "__main__":
    main(sys.argv[1:])
