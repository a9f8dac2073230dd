"""Small values that many tests need: folders, jobs, tiles."""

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SPECTRA = ROOT / "tests" / "data" / "spectra"
"""Measured and modelled spectra, a file or two of each format."""


def lazy(name):
    """
    Return a module that is imported at its first use.

    Modules that are slow to import are got so by tests that need them inside functions only:
    collecting the suite then does not pay for them.
    """
    if name in sys.modules:
        return sys.modules[name]
    spec = importlib.util.find_spec(name)
    if spec is None or spec.loader is None:
        raise ModuleNotFoundError(f"no module named {name!r}", name=name)
    spec.loader = importlib.util.LazyLoader(spec.loader)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def job(changes=None, **more):
    """
    Return the default job with changes, by keys with their dots, or with `__` in place of them.

    `job({"ocean.n": 16}, bake__frames=4)`
    """
    import fftocean as fo

    more = {key.replace("__", "."): value for key, value in more.items()}
    return fo.Job.default().replaced({**(changes or {}), **more})


def job_text(*systems, **keys):
    """
    Return the text of a job file: keys with `__` in place of dots, and wave systems as TOML.

    `job_text("spectrum = { kind = 'jonswap', hs = 1.0, tp = 6.0 }", ocean__n=16)`
    """
    lines = [f"{key.replace('__', '.')} = {toml(value)}" for key, value in keys.items()]
    return "\n".join([*lines, *(f"[[sea.systems]]\n{system}" for system in systems), ""])


def toml(value):
    """Return a value as TOML spells it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(toml, value))}]"
    return f'"{value}"' if isinstance(value, str) else repr(value)


def wind_sea(**changes):
    """Return the sea of a fresh breeze over 100 km, from 30 degrees off the x axis."""
    import fftocean as fo

    return fo.Sea.from_wind(**{"speed": 10.0, "fetch": 100e3, "direction": 30.0, **changes})


def ocean(sea=None, **arguments):
    """Return a small tile in double precision, of `wind_sea` unless told otherwise."""
    import fftocean as fo

    small = {"n": 16, "size": 60.0, "seed": 4, "dtype": "float64"}
    return fo.Ocean(wind_sea() if sea is None else sea, **{**small, **arguments})


def environment(**more):
    """Return this process's environment, in which processes find this package."""
    import fftocean as fo

    return {**os.environ, "PYTHONPATH": str(Path(fo.__file__).parent.parent), **more}


def tree(folder):
    """Return the bytes of every file under a folder, by its path there."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(Path(folder).rglob("*"))
        if path.is_file()
    }


def run(*command, cwd):
    """Return what a program prints; it must succeed."""
    done = subprocess.run(
        list(map(str, command)),
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=300,
        stdin=subprocess.DEVNULL,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def require(found, reason):
    """Skip the test if a client is missing; fail it if FFTOCEAN_REQUIRE_CLIENTS is set."""
    import pytest

    if found:
        return
    if os.environ.get("FFTOCEAN_REQUIRE_CLIENTS", "0") not in ("", "0"):
        pytest.fail(f"{reason}, and FFTOCEAN_REQUIRE_CLIENTS is set", pytrace=False)
    pytest.skip(f"{reason}: see tests/clients/README.md")
