"""Description of the machine on which times are measured."""

import contextlib
import os
import platform
import re
import time
from importlib import metadata
from pathlib import Path
from typing import Any

import fftocean
from fftocean import host, transforms

PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "pyFFTW", "mkl", "matplotlib", "OpenEXR", "isal")


def describe() -> dict[str, Any]:
    """Return the machine as plain data: strings, numbers, lists and dicts of them."""
    return {
        "cpu": host.processor(),
        "instructions": instructions(),
        "cores": os.cpu_count() or 1,
        "usable_cores": host.cores(),
        "caches": caches(),
        "memory_gib": round(memory() / 2**30, 1),
        "os": platform.platform(),
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        "packages": {"fftocean": fftocean.__version__, **versions()},
        "fft_libraries": fft_libraries(),
        "fft_default": backends()[0],
    }


def moment() -> dict[str, Any]:
    """
    Return the time and the load of the machine in the last minute, this measurement included.
    """
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    return {
        "utc": time.strftime("%Y-%m-%d %H:%M", time.gmtime()),
        "load": None if load is None else round(load, 2),
    }


def instructions() -> list[str]:
    """Return the vector instructions that matter to an FFT."""
    for line in host.read_system_file("/proc/cpuinfo").splitlines():
        if line.startswith(("flags", "Features")):
            flags = set(line.partition(":")[2].split())
            return [
                name
                for name in ("sse2", "avx", "avx2", "fma", "avx512f", "asimd", "sve")
                if name in flags
            ]
    return []


def caches() -> dict[str, str]:
    """Return the data caches of core 0 by level, with the number of cores that share each."""
    found = {}
    for folder in sorted(Path("/sys/devices/system/cpu/cpu0/cache").glob("index*")):
        kind, level, size = (
            host.read_system_file(folder / name).strip() for name in ("type", "level", "size")
        )
        if kind in ("Data", "Unified") and size:
            shared = _count(host.read_system_file(folder / "shared_cpu_list"))
            found[f"L{level}"] = size + (f", shared by {shared}" if shared > 1 else "")
    return found


def memory() -> float:
    """Return the memory of the machine [bytes]; 0 if unknown."""
    if hasattr(os, "sysconf") and {"SC_PHYS_PAGES", "SC_PAGE_SIZE"} <= os.sysconf_names.keys():
        return float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    return 0.0


def versions() -> dict[str, str]:
    """Return the versions of the packages that are installed."""
    found = {}
    for package in PACKAGES:
        with contextlib.suppress(metadata.PackageNotFoundError):
            found[package] = metadata.version(package)
    return found


def fft_libraries() -> dict[str, str]:
    """
    Return the names and versions of the FFT libraries installed, by backend, the default first.
    """
    return {
        backend: name
        for backend in transforms.BACKENDS
        if (name := transforms.library(backend)) is not None
    }


def backends() -> tuple[str, ...]:
    """
    Return the FFT backends installed, the default first.
    """
    return tuple(fft_libraries())


def one_line(machine: dict[str, Any]) -> str:
    """Return the machine in one line, for the foot of a plot."""
    libraries = ", ".join(machine["fft_libraries"].values())
    return (
        f"{machine['cpu']}, {machine['usable_cores']} cores; {machine['python']}, "
        f"NumPy {machine['packages']['numpy']}; {libraries}"
    )


def _count(ranges: str) -> int:
    """Return the number of entries of a list such as "0-3,8"."""
    total = 0
    for first, last in re.findall(r"(\d+)(?:-(\d+))?", ranges):
        total += int(last or first) - int(first) + 1
    return total
