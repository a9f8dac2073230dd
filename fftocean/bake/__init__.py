"""
Bakes: a job, the folder it becomes, and the picture on top.

`fftocean.bake(job, folder)` is the public name of the function, and this room has the same name: so the room can be called.
"""

import sys
from types import ModuleType
from typing import Any


class _Room(ModuleType):
    """A module that bakes when it is called; see `fftocean.bake.baker.bake`."""

    def __call__(self, *args: Any, **kwargs: Any) -> dict[str, Any]:
        from fftocean.bake.baker import bake

        return bake(*args, **kwargs)


sys.modules[__name__].__class__ = _Room
