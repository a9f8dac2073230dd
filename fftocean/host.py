"""The machine: its processor, cores and free memory."""

import contextlib
import os
import platform
import subprocess
import sys
from pathlib import Path

from fftocean.errors import ParameterError


def cores() -> int:
    """
    Return the number of cores that this process can use.

    The smaller of its processor affinity and the quota of its control group.
    """
    count = (
        len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    )
    quota, _, period = read_system_file("/sys/fs/cgroup/cpu.max").partition(" ")
    if not quota:  # control groups of version 1, whose quota is -1 where there is none
        quota = read_system_file("/sys/fs/cgroup/cpu/cpu.cfs_quota_us")
        period = read_system_file("/sys/fs/cgroup/cpu/cpu.cfs_period_us")
    if quota.strip().isdigit() and period.strip().isdigit() and int(period):
        count = min(count, max(1, int(quota) // int(period)))
    return count


def processor() -> str:
    """Return the name of the processor."""
    for line in read_system_file("/proc/cpuinfo").splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    if sys.platform == "darwin":
        with contextlib.suppress(OSError, subprocess.SubprocessError):
            asked = subprocess.run(
                ["/usr/sbin/sysctl", "-n", "machdep.cpu.brand_string"],
                capture_output=True,
                text=True,
                timeout=10,
            )
            if asked.stdout.strip():
                return asked.stdout.strip()
    return platform.processor() or platform.machine()


def available_memory() -> float:
    """
    Return the memory that this process can still get, of the machine or of its control group [B].

    The smaller of the two counts; inf if neither is known.
    """
    candidates = [float("inf")]
    try:
        for line in read_system_file("/proc/meminfo").splitlines():
            if line.startswith("MemAvailable:"):
                candidates.append(1024.0 * int(line.split()[1]))
    except (ValueError, IndexError):
        pass
    if len(candidates) == 1 and hasattr(os, "sysconf") and "SC_PHYS_PAGES" in os.sysconf_names:
        candidates.append(float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE"))
    for limit, used in _GROUP_MEMORY:
        # "max" of version 2 is no number; version 1 without a limit has one near 2^63.
        with contextlib.suppress(ValueError):
            candidates.append(float(int(read_system_file(limit))) - int(read_system_file(used)))
    return min(candidates)


_GROUP_MEMORY = (
    ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
    (
        "/sys/fs/cgroup/memory/memory.limit_in_bytes",
        "/sys/fs/cgroup/memory/memory.usage_in_bytes",
    ),
)
"""Limit and use [B] of the control group, as versions 2 and 1 tell them."""


def require_memory(what: str, needed: float) -> None:
    """
    Raise if there is too little memory, before anything is allocated.

    Args:
        what: the object to be made, for the message.
        needed: its memory [B].

    Raises:
        ParameterError: `needed` is more than `available_memory()`.
    """
    available = available_memory()
    if needed > available:
        free = max(available, 0.0) / 2**30
        raise ParameterError(
            f"{what} needs about {needed / 2**30:.1f} GiB of memory, "
            f"but only {free:.1f} GiB are free"
        )


def read_system_file(path: str | Path) -> str:
    """Return the text of a system file; "" if it cannot be read."""
    try:
        return Path(path).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
