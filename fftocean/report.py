"""Report of a job or a bake: one HTML file that needs nothing else."""

import base64
import datetime
from collections.abc import Callable, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import fftocean
from fftocean import plots
from fftocean.arrays import shortened
from fftocean.baking.finished.check import check
from fftocean.baking.folder.layout import MANIFEST_FILE
from fftocean.baking.folder.sealed import read_sealed
from fftocean.baking.previews import sheets
from fftocean.baking.previews.previews import beaufort_of, foam_of
from fftocean.files import path_of, write_whole
from fftocean.job.job import Job
from fftocean.job.parameters import PARAMETERS
from fftocean.notebook_html import table
from fftocean.ocean import Ocean
from fftocean.plots.text import compass_point
from fftocean.proof import verify
from fftocean.statistics import Statistics, measure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FILM_FRAMES = 96
_MOST_FILES = 12  # of a bake, in the table
_MOST_VERIFIED = 256**2  # samples: the direct sum of more takes minutes
_STYLE = """
:root { color-scheme: light; }
body { margin: 0 auto; max-width: 60rem; padding: 1rem 1.2rem 4rem; color: #1c2733;
  font: 1rem/1.5 system-ui, sans-serif; background: #fff; }
h1 { font-size: 1.7rem; margin: 1.2rem 0 .3rem; }
h2 { font-size: 1.2rem; margin: 2.2rem 0 .6rem; border-bottom: 1px solid #cfd8df; }
img { max-width: 100%; height: auto; display: block; margin: .6rem 0; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; margin: .6rem 0; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: #51606d; padding: .2rem 0; }
th, td { padding: .2rem .8rem .2rem 0; text-align: left; vertical-align: top;
  border-bottom: 1px solid #e6ebef; font-weight: normal; }
th { color: #51606d; }
.good { color: #14663b; } .bad { color: #a3181c; font-weight: bold; }
code { font-size: .92em; }
"""


def write_report(job: Job, path: str | Path, *, folder: Path | None = None) -> int:
    """
    Write the report of a job: its sea in words, spectra, statistics, loop, images, files.

    Args:
        job: the job.
        path: the HTML file, which is replaced if it exists; complete or absent.
        folder: the folder of a finished bake of the job; its files are checked and listed.

    Returns:
        The size of the file [bytes].

    Raises:
        ParameterError: matplotlib is not installed, or a job that cannot be set up.
        OutputError: the file could not be written.
    """
    file = path_of("path", path)
    ocean = job.ocean()
    statistics = measure(ocean, frames=min(job.frames, 8))
    sections: Sequence[tuple[str, Callable[[], str]]] = (
        ("Statistics", lambda: _statistics(statistics)),
        ("Spectra", lambda: _spectra(ocean)),
        ("Images", lambda: _images(job, ocean)),
        ("Loop", lambda: _loop(job, ocean, statistics)),
        ("Checks", lambda: _checks(job)),
        *((("Files", lambda: _files(folder)),) if folder else ()),
        ("Job", lambda: _job(job)),
    )
    body = "".join(f"<section><h2>{name}</h2>{make()}</section>" for name, make in sections)
    words = sentence(job, ocean, statistics)
    page = (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(job.source)}: a sea</title><style>{_STYLE}</style></head><body>"
        f"<h1>{escape(job.source)}</h1><p>{escape(words)}</p>{body}"
        f"<footer><p>fftocean {fftocean.__version__}, "
        f"{datetime.datetime.now(datetime.UTC):%Y-%m-%d}</p></footer></body></html>\n"
    ).encode()
    write_whole(file, page)
    return len(page)


def sentence(job: Job, ocean: Ocean, statistics: Statistics) -> str:
    """Return the sea of a job in words."""
    sea = ocean.sea
    assert sea is not None  # a job has a sea
    specified = statistics.specified
    assert specified is not None
    parts = []
    if job.wind:
        speed = job.settings["sea.wind.speed"]
        parts.append(f"a wind of {speed:g} m/s (Beaufort {beaufort_of(speed)})")
    if job.systems:
        count = len(job.systems)
        parts.append(f"{count} more wave system{'s' * (count != 1)}")
    if not specified.hs > 0.0:
        return f"Flat water over a depth of {ocean.depth:g} m."
    toward = compass_point(specified.mean_direction)
    return (
        f"The sea of {' and '.join(parts)}: significant wave height {specified.hs:.2f} m, peak "
        f"period {specified.tp:.1f} s, running toward {toward} with a spread of "
        f"{specified.spread:.0f} degrees, over "
        + ("deep water" if ocean.depth == float("inf") else f"{ocean.depth:g} m of water")
        + f". The tile of {ocean.grid.lx:g} x {ocean.grid.ly:g} m ({ocean.grid.nx} x "
        f"{ocean.grid.ny} samples) repeats after {ocean.loop:g} s."
    )


def _statistics(statistics: Statistics) -> str:
    """Return the table of specified and realised statistics."""
    shares = table(
        "Energy that the tile does not hold",
        [
            ("in longer waves", f"{100.0 * statistics.share_below:.2f} %"),
            ("in shorter waves", f"{100.0 * statistics.share_above:.2f} %"),
        ],
    )
    return f'<div class="wide">{statistics._repr_html_()}{shares}</div>'


def _spectra(ocean: Ocean) -> str:
    """Return the plots of the specified and the realised spectrum, and of the directions."""
    sea = ocean.sea
    assert sea is not None  # a job has a sea
    figures: Sequence[tuple[Callable[[], Figure], str]] = (
        (lambda: plots.plot_realised(ocean), "Spectrum of the tile beside the specified one"),
        (lambda: plots.plot_directions(sea), "Specified energy by direction and frequency"),
        (lambda: plots.plot_dispersion(ocean), "Waves of the tile on the dispersion relation"),
    )
    return "".join(
        _image(plots.encoded(make(), ".png"), "png", alternative) for make, alternative in figures
    )


def _images(job: Job, ocean: Ocean) -> str:
    """Return stills of the loop and its animation."""
    frames, foam = job.frames, foam_of(job, ocean)
    sheet = sheets.contact_sheet(ocean, frames, job.source, **foam)
    film = sheets.animation(ocean, min(frames, FILM_FRAMES), **foam)
    return _image(sheet, "png", "Stills: in perspective, and from above") + _image(
        film, "webp", "Animation of the loop"
    )


def _loop(job: Job, ocean: Ocean, statistics: Statistics) -> str:
    """Return what the loop costs."""
    rows = [
        ("period", f"{ocean.loop:g} s"),
        ("frames", f"{job.frames}, {job.frames / (ocean.loop or 1.0):.3g} a second"),
    ]
    if error := statistics.loop:
        rows.append(
            (
                "error of the frequencies",
                f"{100.0 * error.rms:.2f} % rms, {100.0 * error.bias:+.2f} % bias",
            )
        )
        if error.better_period != error.period:
            rows.append(
                (
                    "a better period",
                    f"{error.better_period:g} s: {100.0 * error.better_rms:.2f} % rms",
                )
            )
    rows.append(("folds", str(statistics.folding)))
    return f'<div class="wide">{table("Loop", rows)}</div>'


def _checks(job: Job) -> str:
    """Return the checks of the tile against independent computations."""
    ocean = job.ocean(dtype="float64")
    if ocean.grid.nx * ocean.grid.ny > _MOST_VERIFIED:
        return (
            "<p>Not made here: the direct sum of so many samples takes minutes. "
            "<code>fftocean verify</code> makes them.</p>"
        )
    rows = [
        (c.name, c.against, f"{c.error:.1e}", f"{c.tolerance:.1e}", "ok" if c.passed else "FAILED")
        for c in verify(ocean)
    ]
    heads = ("quantity", "against", "error", "tolerance", "")
    shown = table("Frame at 3.7 s, in double precision", rows, heads=heads)
    return f'<div class="wide">{shown}</div>'


def _files(folder: Path) -> str:
    """Return the check of a bake and its maps."""
    found = check(folder)
    verdict = (
        f'<p class="bad">Problems: {len(found)}. {escape(shortened(str(found[0])))}</p>'
        if found
        else '<p class="good">Every file agrees with its checksum.</p>'
    )
    manifest: dict[str, Any] = read_sealed(folder / MANIFEST_FILE)
    rows = [
        (
            name,
            entry["caption"],
            entry["unit"],
            entry["format"],
            " x ".join(map(str, entry["shape"])),
        )
        for name, entry in list(manifest["maps"].items())[:_MOST_FILES]
    ]
    heads = ("map", "contents", "unit", "format", "shape")
    return f'{verdict}<div class="wide">{table("Maps", rows, heads=heads)}</div>'


def _job(job: Job) -> str:
    """Return every key of the job with its value."""
    units = {p.key: p.unit for p in PARAMETERS}
    rows = [
        (key, f"{shortened(str(value))} {units.get(key, '')}".strip())
        for key, value in job.describe().items()
        if key != "sea.systems" or value
    ]
    return f'<div class="wide">{table("All keys", rows)}</div>'


def _image(data: bytes, kind: str, alternative: str) -> str:
    """Return an image within the page."""
    text = base64.b64encode(data).decode()
    return f'<img alt="{escape(alternative)}" src="data:image/{kind};base64,{text}">'
