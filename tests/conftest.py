"""Settings that all tests share."""

import pytest

from fftocean.baking.previews import sheets as preview


@pytest.fixture(autouse=True)
def small_pictures(request, monkeypatch):
    """
    A bake's pictures have few pixels, as their cost is in them; not in tests marked
    `full_pictures`.
    """
    if request.node.get_closest_marker("full_pictures") is None:
        for name, value in {
            "WIDTH": 96,
            "VIEW_HEIGHT": 34,
            "THUMBNAIL": 12,
            "FILM": (24, 9),
            "FILM_FRAMES": 2,
        }.items():
            monkeypatch.setattr(preview, name, value)
