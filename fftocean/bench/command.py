"""`fftocean bench`: measure for two minutes, show a table, draw one picture."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from fftocean.errors import ParameterError

if TYPE_CHECKING:
    from rich.console import Console

SECONDS = 120.0
PICTURE = Path("bench.png")


def main(
    console: "Console",
    *,
    seconds: float = SECONDS,
    sizes: Sequence[int] | None = None,
    picture: Path | None = PICTURE,
    json: Path | None = None,
    status: "Console | None" = None,
) -> int:
    """
    Run the two-minute version and show it.

    Args:
        console: where the table goes.
        seconds: about how long to measure [s].
        sizes: samples a side of the frames; None for 128 to 1024.
        picture: a .png, .svg or .pdf to write, or None; without matplotlib there is none, and a
            line that says so.
        json: a file for every reading with its quartiles, or None.
        status: where a progress bar goes while it measures; None for none.

    Returns:
        The exit code, 0.

    Raises:
        ParameterError: a value out of range, or a suffix that is no picture's.
        OutputError: a file could not be written.
    """
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    from fftocean.bench import quick, shown
    from fftocean.bench.pictures import SUFFIXES

    if (
        picture is not None and picture.suffix.lower() not in SUFFIXES
    ):  # before two minutes have gone by
        raise ParameterError(
            f"a picture's name must end in {', '.join(SUFFIXES)}, got {picture.name!r:.80}"
        )
    columns = (TextColumn("measuring {task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=status, disable=status is None, transient=True) as bar:
        task = bar.add_task("", total=1.0)
        result = quick.quick(
            seconds=seconds,
            sizes=quick.SIZES if sizes is None else sizes,
            progress=lambda what, share: bar.update(task, description=what, completed=share),
        )
    console.print(shown.table(result))
    if json is not None:
        result.write(json)
        console.print(f"every reading: {json}", highlight=False, markup=False)
    if picture is not None:
        try:
            shown.picture(result, picture)
        except ParameterError as error:
            console.print(f"no picture: {error}", highlight=False, markup=False)
        else:
            console.print(f"look at {picture}", highlight=False, markup=False)
    return 0
