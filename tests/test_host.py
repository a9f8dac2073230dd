"""Cores and processor of the machine."""

import os

from fftocean import host


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
