"""
Pictures of the live page for the documentation: three stills and a moving one, in docs/

    python tools/page_pictures.py [NAME ...]

It needs the clients of tests/clients (Chromium and the packages of npm) and Pillow. Without a
graphics card a still takes about a minute.
"""

import base64
import io
import shutil
import sys
import tempfile
import warnings
from pathlib import Path

from PIL import Image

import fftocean as fo
from fftocean.runtime import pack, to_bytes
from fftocean.slope_variance import slope_variance

ROOT = Path(__file__).resolve().parents[1]
CLIENTS = ROOT / "tests" / "clients"
sys.path.insert(0, str(CLIENTS))

from web import Browser, Site  # noqa: E402

OUT = ROOT / "docs"
WIND = 30.0  # direction toward which the wind blows [degrees]
STILL_BYTES = 200_000
MOVING_FRAMES = 48

# of each picture: speed of the wind, fetch, sizes of the tiles, samples, loop, camera and look
SCENES = {
    "page_breeze": {
        "wind": (11.0, 150e3),
        "tiles": [(256, 420.0), (256, 61.0), (256, 8.3)],
        "loop": 64.0,
        "camera": {"height": 5.0, "yaw": 215.0, "pitch": -6.0, "fieldOfView": 48.0},
        "look": {"sunElevation": 30.0, "sunAzimuth": 150.0},
    },
    "page_gale": {
        "wind": (20.0, 300e3),
        "tiles": [(256, 620.0), (256, 83.0), (256, 11.3)],
        "loop": 64.0,
        "camera": {"height": 9.0, "yaw": 225.0, "pitch": -6.0, "fieldOfView": 50.0},
        "look": {"sunElevation": 22.0, "sunAzimuth": 160.0, "haze": 1.6},
    },
    "page_sunset": {
        "wind": (9.0, 150e3),
        "tiles": [(256, 360.0), (256, 53.0), (256, 7.7)],
        "loop": 64.0,
        "camera": {"height": 4.0, "yaw": 200.0, "pitch": -2.0, "fieldOfView": 45.0},
        "look": {"sunElevation": 3.5, "sunAzimuth": 206.0},
    },
    "page_moving": {
        "wind": (11.0, 150e3),
        "tiles": [(128, 230.0), (128, 31.0), (128, 4.3)],
        "loop": 6.0,
        "camera": {"height": 4.0, "yaw": 205.0, "pitch": -5.0, "fieldOfView": 48.0},
        "look": {"sunElevation": 24.0, "sunAzimuth": 172.0},
    },
}


def write_sea(scene, path):
    """Pack the sea of a scene, with the foam and the roughness of its wind."""
    speed, fetch = scene["wind"]
    sea = fo.Sea.from_wind(speed=speed, fetch=fetch, direction=WIND)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a loop that is short, to be seen whole
        cascade = fo.Cascade(sea, tiles=scene["tiles"], seed=7, loop=scene["loop"])
    package = pack(
        cascade, wind=(speed, WIND), foam=fo.Foam.from_wind(cascade, speed), reference=False
    )
    found = slope_variance(cascade, wind_speed=speed, wind_direction=WIND)
    package.document["slope_variance"] = {
        name: list(getattr(found, name)) for name in ("captured", "total", "beyond")
    }
    path.write_bytes(to_bytes(package))
    return package.document["ticks"]


def drawn(browser, name, scene, tick, size, foam):
    """Return one picture of a scene."""
    picture = {
        "name": f"/bakes/{name}.sea",
        "quality": "medium",
        "width": size[0],
        "height": size[1],
        "tick": tick,
        "camera": scene["camera"],
        "look": scene["look"],
        "foam": foam,
        "answer": "image",
    }
    (answer,), _ = browser.run("picture.html", {"pictures": [picture]})
    if answer["error"]:
        raise RuntimeError(f"{name}: WebGL error {answer['error']}")
    return Image.open(io.BytesIO(base64.b64decode(answer["image"]))).convert("RGB")


def save_still(image, path):
    """Save a picture as WebP, as good as its size allows."""
    for quality in range(90, 40, -4):
        data = io.BytesIO()
        image.save(data, "WEBP", quality=quality, method=6)
        if data.tell() <= STILL_BYTES:
            path.write_bytes(data.getvalue())
            return
    raise RuntimeError(f"{path.name} is larger than {STILL_BYTES} bytes")


def main(names):
    """Draw the pictures named, or all."""
    with tempfile.TemporaryDirectory() as temporary:
        seas = Path(temporary)
        folders = {
            "npm": CLIENTS / "node_modules",
            "pages": CLIENTS / "pages",
            "live": ROOT / "fftocean" / "view" / "web" / "src",
            "bakes": seas,
        }
        chromium = shutil.which("chromium") or shutil.which("google-chrome")
        with (
            Site(folders) as site,
            Browser(chromium, folders["npm"], site, log=seas / "driver.log") as browser,
        ):
            for name in names or SCENES:
                scene = SCENES[name]
                ticks = write_sea(scene, seas / f"{name}.sea")
                if name != "page_moving":
                    foam = {"steps": 6, "seconds": 0.6}
                    image = drawn(browser, name, scene, ticks // 5, (1280, 720), foam)
                    save_still(image, OUT / f"{name}.webp")
                    continue
                foam = {"steps": 4, "seconds": 0.8}
                frames = [
                    drawn(browser, name, scene, i * ticks // MOVING_FRAMES, (400, 225), foam)
                    for i in range(MOVING_FRAMES)
                ]
                frames[0].save(
                    OUT / f"{name}.webp",
                    save_all=True,
                    append_images=frames[1:],
                    duration=round(1000 * scene["loop"] / MOVING_FRAMES),
                    loop=0,
                    quality=70,
                    method=6,
                )


if __name__ == "__main__":
    main(sys.argv[1:])
