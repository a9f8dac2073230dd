"""
A full frame beside EncinoWaves, the C++ of Horvath's 2015 paper.

Both compute height, two displacements, a measure of folding and unit normals, in single precision,
with plans of FFTW that were measured. EncinoWaves is built here from a checkout of its sources,
https://github.com/blackencino/EncinoWaves, with the C++ compiler's -O3 -march=native; it needs the
headers of FFTW, oneTBB, Imath and Boost (on Debian: libfftw3-dev libtbb-dev libimath-dev
libboost-dev). Before it is timed, its displacements are compared with those of its own heights.

    python benchmarks/encino_waves.py --source FOLDER [--n 256 512 1024] [--seconds 20]
        [--json FILE] [--plot FILE]
"""

import argparse
import ctypes
import itertools
import subprocess
import tempfile
import weakref
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import script

from fftocean.arrays import Real
from fftocean.bench.charts import bars, sheet
from fftocean.bench.contenders import Fast
from fftocean.bench.quick import ocean
from fftocean.bench.results import Condition, Entry, Pair, Reading, Result, race
from fftocean.errors import ParameterError
from fftocean.plots.theme import BLUE

ASKS = "What does a frame cost beside EncinoWaves?"
HERE = Path(__file__).resolve().parent
OURS, THEIRS, RATIO = "full frame", "EncinoWaves", "EncinoWaves / full frame"
LIBRARIES = ("-ltbb", "-lfftw3f_threads", "-lfftw3f", "-lfftw3_threads", "-lfftw3", "-lpthread")


def flags(parser: argparse.ArgumentParser) -> None:
    """Add the flags of this question."""
    script.sizes(parser, 256, 512, 1024)
    parser.add_argument("--seconds", type=float, default=20.0, help="for each n (default: 20)")
    parser.add_argument(
        "--source", type=Path, required=True, metavar="FOLDER", help="checkout of EncinoWaves"
    )
    parser.add_argument("--compiler", default="g++", help="of C++ (default: g++)")


def measure(options: argparse.Namespace, say: script.Say) -> list[Reading]:
    """Build EncinoWaves and race it at each n, one thread each."""
    readings: list[Reading] = []
    with tempfile.TemporaryDirectory() as folder:
        say("EncinoWaves is built")
        library = build(options.source, options.compiler, Path(folder))
        for n in options.n:
            say(f"{n} x {n}")
            theirs = Encino(library, n)
            theirs.require_waves()
            own = ocean(n, backend="pyfftw")
            at: dict[str, Condition] = {"n": n, "backend": "pyfftw", "threads": 1}
            entries = [Entry(OURS, Fast(own), at), Entry(THEIRS, theirs, {"n": n, "threads": 1})]
            pairs = [Pair(RATIO, entries[1], entries[0])]
            readings += race(entries, pairs, clock="cpu", seconds=options.seconds)
    return readings


def build(source: Path, compiler: str, folder: Path) -> ctypes.CDLL:
    """
    Return EncinoWaves as a library.

    Raises:
        ParameterError: the sources are not there, or do not compile.
    """
    sources = source / "src"
    if not (sources / "EncinoWaves" / "Propagation.h").is_file():
        raise ParameterError(f"--source: {source} is no checkout of EncinoWaves")
    path = folder / "libencino.so"
    units = [*sources.glob("EncinoWaves/*.cpp"), *sources.glob("Util/*.cpp")]
    includes = [HERE / "encino", sources, "/usr/include/Imath", "/usr/local/include/Imath"]
    command = [
        *(compiler, "-std=c++17", "-O3", "-march=native", "-DNDEBUG", "-fPIC", "-shared"),
        *("-w", "-fpermissive", *(f"-I{include}" for include in includes)),
        *(str(HERE / "encino" / "sea.cpp"), *map(str, units), "-o", str(path), *LIBRARIES),
    ]
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise ParameterError(f"--compiler: {compiler} could not be run: {error}") from None
    if done.returncode:
        raise ParameterError(f"EncinoWaves does not compile: {done.stderr[:600]}")
    library = ctypes.CDLL(str(path))
    library.sea_new.restype = ctypes.c_void_p
    library.sea_field.restype = ctypes.POINTER(ctypes.c_float)
    library.sea_free.argtypes = [ctypes.c_void_p]
    library.sea_frame.argtypes = [ctypes.c_void_p, ctypes.c_float]
    library.sea_field.argtypes = [ctypes.c_void_p, ctypes.c_int]
    return library


class Encino:
    """Frames of EncinoWaves at successive times, one thread."""

    def __init__(self, library: ctypes.CDLL, n: int) -> None:
        power = n.bit_length() - 1
        if n != 2**power:
            raise ParameterError(f"EncinoWaves needs a power of two samples a side, got {n}")
        self._library, self._n = library, n
        self._sea = ctypes.c_void_p(library.sea_new(power, 1))
        weakref.finalize(self, library.sea_free, self._sea)
        self._times = itertools.count()

    def __call__(self) -> None:
        self._library.sea_frame(self._sea, 0.05 * next(self._times))

    def field(self, number: int) -> Real:
        """Return a field of the last frame: 0 height, 1 and 2 displacements, 3 eigenvalue."""
        side = self._n + 1
        padded = np.ctypeslib.as_array(self._library.sea_field(self._sea, number), (side, side))
        field: Real = padded[:-1, :-1].astype(np.float64)
        return field

    def require_waves(self) -> None:
        """
        Require that displacements are those of the heights, and normals of length 1.

        Raises:
            ParameterError: they are not: another work would be timed.
        """
        self()
        height = np.fft.fft2(self.field(0))
        k = np.fft.fftfreq(self._n)
        kx, ky = k[None, :], k[:, None]
        size = np.hypot(kx, ky)
        size[0, 0] = 1.0
        for number, along in ((1, kx), (2, ky)):
            expected = np.fft.ifft2(-1j * along / size * height).real
            off = float(np.max(np.abs(self.field(number) - expected)))
            # It keeps waves at the Nyquist wavenumber, whose derivatives are not defined.
            if not off <= 0.02 * float(np.max(np.abs(expected))):
                raise ParameterError(f"displacement {number} of EncinoWaves is off by {off:.3g} m")
        count = 3 * (self._n + 1) ** 2
        normals = np.ctypeslib.as_array(self._library.sea_field(self._sea, 4), (count,))
        if not np.allclose(np.linalg.norm(normals.reshape(-1, 3), axis=1), 1.0, atol=1e-5):
            raise ParameterError("normals of EncinoWaves are not of length 1")


def draw(result: Result, path: Path) -> None:
    """Draw both costs at each n."""
    with sheet(path, ASKS, result, width=11.0, height=2.6) as figure:
        panels = np.atleast_1d(figure.subplots(1, len(result.settings["n"])))
        for ax, n in zip(panels, result.settings["n"], strict=True):
            times = [(what, result.find(what, n=n).median) for what in (OURS, THEIRS)]
            colours = (BLUE, "#56707a")
            bars(
                ax,
                [
                    (what, median, f"{median:.2f} ms", colour)
                    for (what, median), colour in zip(times, colours, strict=True)
                ],
            )
            ax.set_title(f"{n} x {n}: {result.find(RATIO, n=n).median:.2f} x")


def main(arguments: Sequence[str] | None = None) -> int:
    """Ask the question from the command line; return the exit code."""
    return script.run(
        "encino_waves", ASKS, __doc__, flags=flags, measure=measure, draw=draw, arguments=arguments
    )


if __name__ == "__main__":
    raise SystemExit(main())
