"""Fixtures of the tests of the live page's server."""

import warnings

import pytest
from serving import Running, sea_viewer, write_page

from fftocean.errors import SeaWarning


@pytest.fixture(autouse=True)
def quiet_seas():
    """Leave warnings about short loops and the like to the tests of the sea."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SeaWarning)
        yield


@pytest.fixture(scope="session")
def page(tmp_path_factory):
    """Return the folder of the small page."""
    return write_page(tmp_path_factory.mktemp("page"))


@pytest.fixture
def running(page):
    """Run a server of the small sea."""
    with Running(sea_viewer(), page) as server:
        yield server


@pytest.fixture(scope="module")
def shared(page):
    """Run a server for all tests of a module that leave it as it is."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SeaWarning)
        with Running(sea_viewer(), page) as server:
            yield server
