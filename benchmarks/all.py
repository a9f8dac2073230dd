"""
All benchmarks: results/*.json, results/*.png and RESULTS.md.

Each question runs in a process of its own; all of them take about an hour on two cores, half of it
`many_frames`. On a busy machine the ratios still hold, and RESULTS.md states the load. A question
that fails keeps its earlier answer; `--only frame` runs one again and leaves the others unchanged.

    python benchmarks/all.py [--only frame memory] [--quick]
"""

import argparse
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import report
from rich.console import Console

HERE = Path(__file__).resolve().parent
QUICK = {  # a minute, to test that everything runs; the figures are meaningless
    "frame": ("--n", "64", "128", "--seconds", "2"),
    "direct_sum": (
        "--n",
        "4",
        "6",
        "8",
        "12",
        "16",
        "24",
        "32",
        "96",
        "128",
        "192",
        "--seconds",
        "0",
        "--limit",
        "2e6",
    ),
    "scaling": ("--n", "64", "100", "127", "128", "256", "--seconds", "2"),
    "memory": ("--n", "64", "128", "--runs", "1"),
    "startup": ("--runs", "2", "--cold", "1", "--n", "64"),
    "seeding": ("--n", "64", "128", "--tile", "64", "--runs", "2"),
    "bake": ("--n", "64", "--frames", "8"),
    "second_order": ("--n", "64", "--waves", "20", "50", "--seconds", "0"),
    "series": ("--n", "32", "--hours", "0.05", "--probes", "2", "--seconds", "0"),
    "query": ("--n", "64", "--points", "2000", "--seconds", "0"),
    "bake_peers": ("--n", "64", "--frames", "12", "--rounds", "1"),
    "many_frames": ("--frames", "10", "40"),
    "robots": ("--n", "16", "--points", "1", "5", "--tiles", "1", "--seconds", "0"),
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the benchmarks and write the report; return the exit code."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--only",
        nargs="+",
        choices=report.QUESTIONS,
        default=list(report.QUESTIONS),
        help="default: all",
    )
    parser.add_argument(
        "--quick",
        action="store_true",
        help="a minute, to test that everything runs; the figures are meaningless",
    )
    parser.add_argument(
        "--output",
        type=Path,
        default=HERE,
        metavar="DIR",
        help="folder for RESULTS.md and results/ (default: benchmarks)",
    )
    options = parser.parse_args(arguments)
    console, start = Console(stderr=True, highlight=False), time.perf_counter()
    results = options.output / "results"
    results.mkdir(parents=True, exist_ok=True)
    failed = []
    for i, name in enumerate(options.only):
        console.print(
            f"[bold]{name}[/], {i + 1} of {len(options.only)}, "
            f"after {time.perf_counter() - start:.0f} s"
        )
        flags = QUICK[name] if options.quick else ()
        files = ("--json", str(results / f"{name}.json"), "--plot", str(results / f"{name}.png"))
        done = subprocess.run(
            [sys.executable, str(HERE / f"{name}.py"), *flags, *files],
            stdout=subprocess.DEVNULL,
            check=False,
        )
        failed += [name] if done.returncode else []
    page = options.output / "RESULTS.md"
    page.write_text(report.report(report.gather(results)), encoding="utf-8")
    console.print(
        f"report: {page}, {time.perf_counter() - start:.0f} s"
        + (f"; failed: {', '.join(failed)}" if failed else ""),
        markup=False,
    )
    return 1 if failed else 0


if __name__ == "__main__":
    raise SystemExit(main())
