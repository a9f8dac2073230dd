"""Public names of `fftocean.export`: imported at their first use, and no others."""

import importlib

import pytest

from fftocean import export


def test_each_name_is_that_of_its_module():
    assert set(export.__all__) == {"SeaStateGrid", "components", "openfast", "swd"}
    for name in export.__all__:
        found = getattr(export, name)
        assert found.__name__ == name
        assert getattr(importlib.import_module(found.__module__), name) is found
    assert set(export.__all__) <= set(dir(export))


def test_another_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match=r"module 'fftocean\.export' has no attribute 'sdw'"):
        export.__getattr__("sdw")
    assert not hasattr(export, "write")
