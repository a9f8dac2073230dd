"""The machine that this runs on: what processor it has, and how much of it is ours."""

import contextlib
import os
import platform
import subprocess
import sys
from pathlib import Path


def cores() -> int:
    """
    On how many cores this process may run: those it is bound to, and no more than its control group
    pays for.
    """
    count = (
        len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    )
    quota, _, period = read("/sys/fs/cgroup/cpu.max").partition(" ")
    if quota.strip().isdigit() and period.strip().isdigit():
        count = min(count, max(1, int(quota) // int(period)))
    return count


def processor() -> str:
    """The processor by name."""
    for line in read("/proc/cpuinfo").splitlines():
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


def read(path: str | Path) -> str:
    """What a system's file says; nothing where there is none."""
    try:
        return Path(path).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
