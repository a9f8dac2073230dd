"""Command `fftocean bench`."""

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
    Run the quick benchmark, and print its table.

    Args:
        console: for the table.
        seconds: approximate duration [s].
        sizes: samples a side of the frames; None for 128 to 1024.
        picture: a .png, .svg or .pdf plot to write, or None; without matplotlib a line is printed
            instead.
        json: a file for every reading with its quartiles, or None.
        status: for a progress bar; None for no bar.

    Returns:
        The exit code, 0.

    Raises:
        ParameterError: a value out of range, or an unknown suffix of the plot.
        OutputError: a file could not be written.
    """
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    from fftocean.bench import quick, quick_report
    from fftocean.bench.charts import SUFFIXES

    # checked before the measurement, which takes minutes
    if picture is not None and picture.suffix.lower() not in SUFFIXES:
        raise ParameterError(
            f"the name of a plot must end in {', '.join(SUFFIXES)}, got {picture.name!r:.80}"
        )
    columns = (TextColumn("measuring {task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=status, disable=status is None, transient=True) as bar:
        task = bar.add_task("", total=1.0)
        result = quick.quick(
            seconds=seconds,
            sizes=quick.SIZES if sizes is None else sizes,
            progress=lambda part, share: bar.update(task, description=part, completed=share),
        )
    console.print(quick_report.table(result))
    if json is not None:
        result.write(json)
        console.print(f"all readings: {json}", highlight=False, markup=False)
    if picture is not None:
        try:
            quick_report.draw(result, picture)
        except ParameterError as error:
            console.print(f"no plot: {error}", highlight=False, markup=False)
        else:
            console.print(f"plot: {picture}", highlight=False, markup=False)
    return 0
