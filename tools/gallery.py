"""
Gallery of the documentation: docs/gallery.md and its pictures, from the jobs of examples/gallery.

    python tools/gallery.py              writes the page
    python tools/gallery.py --pictures [NAME ...]   draws the pictures named, or all

The text of a sea is the comment at the head of its job; figures are those of its spectrum. Pictures
are the head of a bake's contact sheet, by the same renderer. `--check` fails if the page is stale.
"""

import io
import math
import sys
import warnings
from pathlib import Path

from PIL import Image

import fftocean as fo
from fftocean.baking.previews.previews import foam_of
from fftocean.baking.previews.sheets import VIEW_HEIGHT, WIDTH, contact_sheet

ROOT = Path(__file__).resolve().parents[1]
JOBS = ROOT / "examples" / "gallery"
PAGE = ROOT / "docs" / "gallery.md"
PICTURES = ROOT / "docs" / "gallery"
ORDER = (
    "pond",
    "lake",
    "estuary",
    "trade_wind",
    "fresh_breeze",
    "buoy_41010",
    "crossing_seas",
    "norwegian_shelf",
    "old_swell",
    "gale",
    "rare_crest",
    "southern_storm",
)
SIZE = (720, 320)
BYTES = 60_000
HEAD = """\
<!-- made by tools/gallery.py -->

# Gallery

Twelve seas, from ripples to a storm, each with the job that makes it. All are seen from 10 m above
the water, as in the preview of a bake; the bands of the buoy are 1 m high. Any of them is a start
for your own: copy the file, or change a key on the command line.

```bash
fftocean info examples/gallery/gale.toml --set sea.wind.speed=22
fftocean bake examples/gallery/lake.toml -o lake --n 128 --frames 24
```

"""


def words_of(text: str) -> str:
    """Return the comment at the head of a job as one paragraph."""
    lines: list[str] = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# "))
    return " ".join(lines)


def section(name: str) -> str:
    """Return the part of the page that shows one sea."""
    path = JOBS / f"{name}.toml"
    text = path.read_text(encoding="utf-8")
    job = fo.Job.read(path)
    sea = job.sea()
    title = name.replace("_", " ").capitalize()
    peak = 2.0 * math.pi / sea.tp
    length = 2.0 * math.pi / float(fo.dispersion.wavenumber(peak, sea.depth))
    figures = f"Hs {sea.hs:.2g} m, Tp {sea.tp:.2g} s, waves of {length:.2g} m at the peak"
    return (
        f"## {title}\n\n{words_of(text)}\n\n![{title}: {figures}](gallery/{name}.webp)\n\n"
        f"{figures}. [`{name}.toml`](../examples/gallery/{name}.toml):\n\n"
        f"```toml\n{text.partition(chr(10) + '[')[1].strip()}"
        f"{text.partition(chr(10) + '[')[2]}```\n"
    )


def page() -> str:
    """Return the page."""
    return HEAD + "\n".join(section(name) for name in ORDER)


def draw(name: str) -> bytes:
    """Return the picture of a sea as WebP, as good as its size allows."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fo.SeaWarning)
        job = fo.Job.read(JOBS / f"{name}.toml")
        ocean = job.ocean()
        sheet = contact_sheet(ocean, 1, "", **foam_of(job, ocean))
    view = Image.open(io.BytesIO(sheet)).convert("RGB").crop((0, 24, WIDTH, VIEW_HEIGHT))
    view = view.resize(
        (SIZE[0], round(SIZE[0] * view.height / view.width)), Image.Resampling.LANCZOS
    )
    for quality in range(85, 20, -5):
        data = io.BytesIO()
        view.save(data, "WEBP", quality=quality, method=6)
        if data.tell() <= BYTES:
            break
    return data.getvalue()


def main(arguments: list[str]) -> int:
    """Write or check the page, or draw pictures."""
    if arguments[:1] == ["--pictures"]:
        PICTURES.mkdir(exist_ok=True)
        for name in arguments[1:] or ORDER:
            (PICTURES / f"{name}.webp").write_bytes(draw(name))
            print(f"{name}.webp")
        return 0
    if arguments == ["--check"]:
        return int(PAGE.read_text(encoding="utf-8") != page())
    PAGE.write_text(page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
