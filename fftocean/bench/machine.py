"""On what a time was measured: the processor, the memory, the versions, and how busy it all was."""

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

PACKAGES = ("numpy", "scipy", "numba", "llvmlite", "pyFFTW", "mkl", "matplotlib", "OpenEXR")


def describe() -> dict[str, Any]:
    """Say what machine this is, as plain data: strings, numbers, lists and dicts of them."""
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
    Say how busy the machine is now: the load is that of the last minute, this measurement included.
    """
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    return {
        "utc": time.strftime("%Y-%m-%d %H:%M", time.gmtime()),
        "load": None if load is None else round(load, 2),
    }


def instructions() -> list[str]:
    """The vector instructions that matter to an FFT."""
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
    """The data caches that core 0 sees, by level, with how many cores share each."""
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
    """Bytes of memory in the machine; 0 if unknown."""
    if hasattr(os, "sysconf") and {"SC_PHYS_PAGES", "SC_PAGE_SIZE"} <= os.sysconf_names.keys():
        return float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    return 0.0


def versions() -> dict[str, str]:
    """The versions of what does the work, of those that are installed."""
    found = {}
    for package in PACKAGES:
        with contextlib.suppress(metadata.PackageNotFoundError):
            found[package] = metadata.version(package)
    return found


def fft_libraries() -> dict[str, str]:
    """
    The FFT libraries that an ocean can use here, the default first, with what they call themselves.
    """
    return {
        backend: name
        for backend in transforms.BACKENDS
        if (name := transforms.library(backend)) is not None
    }


def backends() -> tuple[str, ...]:
    """
    The FFT libraries that an ocean can use here, the default first, by the names that it knows them
    by.
    """
    return tuple(fft_libraries())


def one_line(machine: dict[str, Any]) -> str:
    """The machine in one line, for the foot of a picture."""
    libraries = ", ".join(machine["fft_libraries"].values())
    return f"{machine['cpu']}, {machine['usable_cores']} cores; {machine['python']}, NumPy {machine['packages']['numpy']}; {libraries}"


def _count(ranges: str) -> int:
    """How many a list such as "0-3,8" names."""
    total = 0
    for first, last in re.findall(r"(\d+)(?:-(\d+))?", ranges):
        total += int(last or first) - int(first) + 1
    return total
