"""Settings that all tests share: which of them are quick, which start processes, small previews."""

from pathlib import Path

import pytest

TESTS = Path(__file__).parent

QUICK = (
    "physics/",
    "export/",
    "test_amplitudes.py",
    "test_fields.py",
    "test_grid.py",
    "test_noise.py",
    "test_ocean.py",
    "test_products.py",
)
"""Places of tests that are done in half a minute, but for `SLOW` and marks `process` and `slow`."""

SLOW = ("export/test_bakes.py", "export/test_displace.py", "export/test_matrix.py")
"""Places among these whose tests bake, or try every format in every engine."""

PROCESS = (
    "baking/test_executors.py",
    "baking/test_faults.py",
    "baking/test_lock.py",
    "bench/test_benchmarks.py",
    "clients/",
    "kernels/test_compiler.py",
    "test_forks.py",
    "test_packaging.py",
)
"""Places of tests that start processes; single tests elsewhere are marked where they stand."""


def pytest_collection_modifyitems(items):
    """Mark tests as `process` and `quick` by the place of their file."""
    for item in items:
        try:
            place = item.path.relative_to(TESTS).as_posix()
        except ValueError:  # a test from elsewhere
            continue
        if place.startswith(PROCESS):
            item.add_marker(pytest.mark.process)
        marked = any(item.get_closest_marker(name) for name in ("process", "slow"))
        if place.startswith(QUICK) and not place.startswith(SLOW) and not marked:
            item.add_marker(pytest.mark.quick)


@pytest.fixture(autouse=True)
def small_pictures(request, monkeypatch):
    """
    Give the previews of a bake few pixels, as their cost is in them.

    Tests marked `full_pictures` have them at full size.
    """
    if request.node.get_closest_marker("full_pictures") is None:
        from fftocean.baking.previews import sheets  # slow to import: not while collecting

        for name, value in {
            "WIDTH": 96,
            "VIEW_HEIGHT": 34,
            "THUMBNAIL": 12,
            "FILM": (24, 9),
            "FILM_FRAMES": 2,
        }.items():
            monkeypatch.setattr(sheets, name, value)
