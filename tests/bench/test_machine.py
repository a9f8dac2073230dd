"""The description of the machine as plain data, against other sources."""

import json
import platform

import numpy as np
import pytest

import fftocean as fo
from fftocean import host
from fftocean.bench import machine
from fftocean.host import available_memory


def test_the_machine_is_described_in_plain_data():
    said = machine.describe()
    assert json.loads(json.dumps(said, allow_nan=False)) == said
    assert said["cpu"]
    assert said["packages"]["numpy"] == np.__version__
    assert said["packages"]["fftocean"] == fo.__version__
    assert platform.python_version() in said["python"]
    assert 1 <= said["usable_cores"] <= said["cores"]
    assert said["fft_default"] in said["fft_libraries"]
    assert "scipy" in said["fft_libraries"]


def test_the_default_backend_is_that_of_an_ocean():
    assert machine.describe()["fft_default"] == fo.Ocean.from_modes([], n=4, size=1.0).backend


def test_every_listed_backend_computes_a_frame():
    for name in machine.backends():
        assert fo.Ocean.from_modes([(1, 0, 1.0, 0.0)], n=8, size=10.0, backend=name).backend == name


def test_memory_is_more_than_what_is_free():
    assert 0.0 < available_memory() < machine.memory()


def test_a_moment_has_time_and_load():
    said = machine.moment()
    assert set(said) == {"utc", "load"}
    assert said["load"] is None or said["load"] >= 0.0
    assert len(said["utc"]) == len("2026-01-31 12:00")


@pytest.mark.parametrize(("ranges", "count"), [("0", 1), ("0-3", 4), ("0-3,8,10-11\n", 7), ("", 0)])
def test_lists_of_cores_are_counted(ranges, count):
    assert machine._count(ranges) == count


def test_a_system_without_such_files_is_described_too(monkeypatch):
    monkeypatch.setattr(host, "read_system_file", lambda path: "")  # noqa: ARG005
    assert host.processor()
    assert machine.instructions() == []
    assert host.cores() >= 1
