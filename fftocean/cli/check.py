"""`fftocean check`: find what is wrong with a bake or a run-time package, and repair a bake."""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING

from fftocean.cli.arguments import add_worker_flags, path
from fftocean.cli.command import Command
from fftocean.cli.console import console_for, plain
from fftocean.cli.notes import note_folds
from fftocean.cli.progress import Event, json_events, progress_bar

if TYPE_CHECKING:
    from fftocean.baking.finished.check import Finding


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `fftocean check`."""
    parser.add_argument("folder", metavar="DIR", type=path, help="folder of a bake or of a package")
    parser.add_argument(
        "--repair", action="store_true", help="write wrong files again, with the same bytes"
    )
    parser.add_argument(
        "--job",
        metavar="JOB.toml",
        type=path,
        help="job file; measured spectra are looked up next to it",
    )
    add_worker_flags(parser)
    parser.add_argument(
        "--json",
        action="store_true",
        help="print findings as lines of JSON: finding, frame, done, error",
    )
    parser.add_argument(
        "--quiet", action="store_true", help="no progress bar; print nothing if there is no problem"
    )


def run(options: argparse.Namespace) -> int:
    """Check a bake, and repair it if asked to; return 5 if a problem is left."""
    from fftocean.baking.finished.check import check
    from fftocean.baking.finished.manifest import read_manifest
    from fftocean.baking.folder.layout import is_cascade
    from fftocean.baking.folder.listing import read_listing
    from fftocean.errors import JobError
    from fftocean.runtime.folder import is_package

    with json_events(options.json) as print_json:
        package = is_package(options.folder)
        if package and options.repair:
            raise JobError(
                f"{options.folder} must be a bake to be repaired, and is a run-time package: "
                "export it again"
            )
        silent = options.quiet or options.json
        with progress_bar("checking", "maps", shown=not silent) as show:
            findings = check(
                options.folder, progress=lambda done, total: show(done, total, "checking")
            )
        _report(findings, options, print_json)
        if findings and options.repair:
            _repair(options, print_json)
            findings = check(options.folder)
            _report(findings, options, print_json)
        if not findings and not options.json and not package:
            read = read_listing if is_cascade(options.folder) else read_manifest
            note_folds(read(options.folder)["extremes"])
        if print_json:
            print_json({"event": "done", "findings": len(findings)})
    return 5 if findings else 0


def _repair(options: argparse.Namespace, print_json: Callable[[Event], None] | None) -> None:
    """Write the wrong files of a bake again."""
    from fftocean.baking.repair import repair
    from fftocean.job.job import Job

    repaired: list[int] = []

    def listen(event: Event) -> None:
        if event["event"] == "frame":
            repaired.append(event["frame"])
        if print_json:
            print_json(event)

    repair(
        options.folder,
        None if options.job is None else Job.read(options.job),
        executor=options.executor,
        workers=options.workers,
        listen=listen,
    )
    if not options.json:
        print(f"repaired: {len(repaired)} frame{'s' * (len(repaired) != 1)} written again")


def _report(
    findings: Sequence["Finding"],
    options: argparse.Namespace,
    print_json: Callable[[Event], None] | None,
) -> None:
    """Print findings as a table, or as lines of JSON."""
    if print_json:
        for finding in findings:
            print_json({"event": "finding", **asdict(finding)})
        return
    if not findings:
        if not options.quiet:
            print(f"no problems found: {plain(options.folder)}")
        return
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False)
    for heading in ("problem", "file", "frame", "detail"):
        number = heading == "frame"
        table.add_column(heading, justify="right" if number else "left", overflow="fold")
    for finding in findings:
        table.add_row(
            finding.kind,
            Text(plain(finding.path)),
            "" if finding.frame is None else str(finding.frame),
            Text(plain(finding.detail)),
        )
    console_for().print(table)
    print(f"{len(findings)} problem{'s' * (len(findings) != 1)}: {plain(options.folder)}")


COMMAND = Command(
    name="check",
    arguments="DIR",
    summary="find missing or changed files of a bake or package, and maps that fail "
    "physical checks (seam, loop, range, normals)",
    examples=("fftocean check sea", "fftocean check sea --repair"),
    run=run,
    add_flags=add_flags,
)
