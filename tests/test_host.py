"""Cores, processor and memory of the machine, from trees of system files."""

import os

import pytest

from fftocean import host
from fftocean.errors import ParameterError


def test_a_control_group_limits_the_cores(monkeypatch):
    real = host.read_system_file
    monkeypatch.setattr(
        host,
        "read_system_file",
        lambda path: "150000 100000\n" if str(path).endswith("cpu.max") else real(path),
    )
    assert host.cores() == 1
    monkeypatch.setattr(
        host,
        "read_system_file",
        lambda path: "max 100000\n" if str(path).endswith("cpu.max") else real(path),
    )
    assert 1 <= host.cores() <= os.cpu_count()


def test_the_processor_has_a_name():
    assert host.processor()


@pytest.fixture
def system(monkeypatch, tmp_path):
    """Return a function that writes the only system files there are, under `tmp_path`."""
    monkeypatch.setattr(
        host, "read_system_file", lambda path, read=host.read_system_file: read(f"{tmp_path}{path}")
    )

    def write(files):
        for path, text in files.items():
            (tmp_path / path[1:]).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / path[1:]).write_text(text)

    return write


MEMINFO = "MemTotal:       16000000 kB\nMemFree:          200000 kB\nMemAvailable:    3000000 kB\n"
V2 = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current")
V1 = tuple(f"/sys/fs/cgroup/memory/memory.{name}_in_bytes" for name in ("limit", "usage"))


def test_proc_counts_in_kibibytes(system):
    system({"/proc/meminfo": MEMINFO})
    assert host.available_memory() == 3000000 * 1024


@pytest.mark.parametrize("group", [V2, V1])
def test_a_control_group_limits_the_memory(system, group):
    """Limit less use, in bytes; the smaller of it and what the machine has."""
    system({"/proc/meminfo": MEMINFO, group[0]: "2000000000\n", group[1]: "500000000\n"})
    assert host.available_memory() == 1500000000
    system({group[0]: "9000000000\n"})
    assert host.available_memory() == 3000000 * 1024


@pytest.mark.parametrize("limit", ["max\n", "9223372036854771712\n", "", "?\n"])
def test_no_limit_of_a_control_group(system, limit):
    for group in (V2, V1):
        system({"/proc/meminfo": MEMINFO, group[0]: limit, group[1]: "500000000\n"})
        assert host.available_memory() == 3000000 * 1024


@pytest.mark.parametrize("meminfo", [None, "", "MemAvailable:\n", "MemAvailable: many kB\n"])
def test_without_proc_the_whole_memory_counts(system, meminfo):
    if meminfo is not None:
        system({"/proc/meminfo": meminfo})
    pages = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    assert host.available_memory() == pages
    system({V2[0]: "4096\n"})  # a limit whose use is not told
    assert host.available_memory() == pages
    system({V2[1]: "1024\n"})
    assert host.available_memory() == 3072


def test_what_needs_more_memory_is_refused(system):
    system({"/proc/meminfo": MEMINFO})
    host.require_memory("a frame", 3000000 * 1024)
    with pytest.raises(ParameterError, match=r"a frame needs about 2\.9 GiB .* 2\.9 GiB are free"):
        host.require_memory("a frame", 3000000 * 1024 + 1)
    system({V2[0]: "1000\n", V2[1]: "2000\n"})  # a group over its limit
    with pytest.raises(ParameterError, match=r"only 0\.0 GiB"):
        host.require_memory("a frame", 1.0)


@pytest.mark.parametrize(
    ("quota", "period", "cores"),
    [("250000", "100000", 2), ("50000", "100000", 1), ("-1", "100000", 8), ("100000", "0", 8)],
)
def test_cores_of_control_groups(system, monkeypatch, quota, period, cores):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(8)), raising=False)
    assert host.cores() == 8
    folder = "/sys/fs/cgroup/cpu"
    system({f"{folder}/cpu.cfs_quota_us": quota, f"{folder}/cpu.cfs_period_us": period})
    assert host.cores() == cores
    system({"/sys/fs/cgroup/cpu.max": "300000 100000\n"})
    assert host.cores() == 3
