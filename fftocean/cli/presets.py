"""`fftocean presets`: list the seas that have a number."""

import argparse

from fftocean.cli.command import Command
from fftocean.cli.console import console_for


def run(_: argparse.Namespace) -> int:
    """Print the Beaufort scale and the sea states."""
    from rich.table import Table

    from fftocean.physics import presets

    console = console_for()
    for title, call, rows in (
        (
            "Beaufort scale: U10, and the probable wave height of the open sea",
            "Sea.beaufort",
            presets.beaufort_table(),
        ),
        (
            "Sea states, WMO code table 3700: middle of the range, fully developed",
            "Sea.sea_state",
            presets.sea_state_table(),
        ),
    ):
        table = Table(title=title, title_justify="left", box=None, pad_edge=False)
        for heading in ("call", "name", "U10 m/s", "knots", "Hs m", "computed m", "Tp s"):
            words = heading in ("call", "name")
            table.add_column(heading, justify="left" if words else "right", no_wrap=True)
        for row in rows:
            numbers = (
                f"{row.wind:.1f}",
                f"{row.wind_knots:.0f}",
                f"{row.hs:.3f}",
                f"{row.measured_hs:.7f}",
                f"{row.tp:.1f}",
            )
            table.add_row(f"{call}({row.number})", row.name, *numbers)
        console.print(table)
        console.print()
    return 0


COMMAND = Command(
    name="presets",
    arguments="",
    summary="list the Beaufort scale and the sea states, with wind, wave height and period",
    examples=("fftocean presets",),
    run=run,
)
