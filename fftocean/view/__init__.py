"""
Live page: parameters, state, seas, server and static page.

The module can be called: `fo.view(ocean)` shows a sea in a notebook; see `widget.view`.
"""

import sys
from types import ModuleType
from typing import Any


class _View(ModuleType):
    """This module, which is also the function that its name promises."""

    def __call__(self, source: Any, **options: Any) -> Any:
        """Show a sea live in a notebook; see `fftocean.view.widget.view`."""
        from fftocean.view.widget import view

        return view(source, **options)


sys.modules[__name__].__class__ = _View
