"""`fftocean view`: show a sea live in the browser, or write it as a page."""

import argparse
import asyncio
import os
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from fftocean.cli.arguments import add_tiles_flag, path, whole_number
from fftocean.cli.command import Command
from fftocean.cli.console import note, plain
from fftocean.errors import JobError

if TYPE_CHECKING:
    from fftocean.view.state import State
    from fftocean.view.viewer import Viewer


def add_flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of `fftocean view`."""
    parser.add_argument(
        "source",
        nargs="?",
        type=path,
        metavar="JOB.toml",
        help="a job file, a measured spectrum, or the folder of a bake to play; without one, a "
        "wind sea and a swell",
    )
    parser.add_argument(
        "--static",
        metavar="PATH",
        help="write the page with its sea as one HTML file and exit; a folder (with a / at its "
        "end) gets the page and the run-time package",
    )
    parser.add_argument(
        "--n",
        type=whole_number,
        metavar="N",
        help="samples a side of each tile, a power of two (default: 128, or the job's)",
    )
    add_tiles_flag(parser)
    parser.add_argument(
        "--port", type=int, default=0, metavar="PORT", help="port to listen on (default: any)"
    )
    parser.add_argument(
        "--no-browser", action="store_true", help="print the address and open no browser"
    )


def run(options: argparse.Namespace) -> int:
    """Serve the live page until it is stopped, or write the static page."""
    if options.n is not None and options.tiles:
        raise JobError("--n and --tiles must not be given together; --tiles has its own samples")
    if options.static is not None:
        return _write(options)
    from fftocean.view.page_files import served_files
    from fftocean.view.server import PageServer, require_websockets, serve_until_stopped

    require_websockets()
    viewer = _viewer(options)
    server = PageServer(viewer, served_files(), port=options.port)

    def ready(address: str) -> None:
        print(f"live page: {address}", flush=True)
        print("press Ctrl-C to stop", file=sys.stderr)
        if not options.no_browser:
            _open_browser(address)

    try:
        number = asyncio.run(serve_until_stopped(server, ready))
    except KeyboardInterrupt:  # a system without handlers of signals
        number = signal.SIGINT
    code = 0 if number == signal.SIGINT else 128 + number
    if not viewer.close(0.1):
        # a sea is still being made that nobody will see, and the interpreter would wait for it
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    return code


def _open_browser(address: str) -> None:
    """
    Open the page in the user's browser, or say that it could not be opened.

    Some browsers return only when they are closed, so they are started in a thread.
    """
    import threading

    def start() -> None:
        import webbrowser

        try:
            opened = webbrowser.open(address)
        except (webbrowser.Error, OSError):
            opened = False
        if not opened:
            note("no browser could be opened; open the address above in one on this machine")

    threading.Thread(target=start, daemon=True).start()


def _viewer(options: argparse.Namespace) -> "Viewer":
    """Return the viewer of a job, a spectrum, the page's own sea or a bake."""
    from fftocean.view.viewer import Viewer

    source: Path | None = options.source
    if source is not None and source.is_dir():
        from fftocean.view.playback import open_bake

        if options.n is not None or options.tiles:
            raise JobError("--n and --tiles must not be given for a bake, which has its own tiles")
        return Viewer(bake=open_bake(source), source=source.name or str(source))
    return Viewer(_state(options))


def _state(options: argparse.Namespace) -> "State":
    """Return the sea of a job, a spectrum, or the page's own."""
    from fftocean.job.job import Job
    from fftocean.view.state import State

    source: Path | None = options.source
    default = State.default(n=128 if options.n is None else options.n, tiles=options.tiles)
    if source is None:
        return default
    if source.suffix.lower() == ".toml" or not source.is_file():
        return State.of_job(Job.read(source), n=options.n, tiles=options.tiles, source=source.name)
    return State.of_spectrum(source, default, source=source.name)


def _write(options: argparse.Namespace) -> int:
    """Write the static page."""
    if not options.static:
        raise JobError("--static must be a file or a folder, and is empty")
    if options.source is not None and options.source.is_dir():
        raise JobError("--static must be given for a sea, not for a bake")
    from fftocean.view.static_page import write_static

    as_folder = options.static.endswith(("/", os.sep)) or Path(options.static).is_dir()
    sizes = write_static(_state(options), Path(options.static), as_folder=as_folder)
    for name, size in sizes.items():
        print(f"{size / 1e3:.0f} kB: {plain(name)}")
    return 0


COMMAND = Command(
    name="view",
    arguments="[JOB.toml | DIR] [--static PATH]",
    summary="show a sea live in the browser, play a bake, or write a page with a sea in it",
    examples=(
        "fftocean view",
        "fftocean view gale.toml --tiles 256:1200,256:170,256:25",
        "fftocean view --static sea.html",
        "fftocean view sea",
    ),
    run=run,
    add_flags=add_flags,
)
