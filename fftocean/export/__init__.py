"""
Encoding of arrays in files, the only place where they are scaled and converted.

Its public names write the waves of a sea for programs that compute loads on structures. They are
`fftocean.wave_files`, far above the modules of this package, and are imported at first use, as the
public names of fftocean itself are.
"""

import importlib
from typing import Any

_MODULE_OF = {
    "SeaStateGrid": "fftocean.wave_files.openfast",
    "components": "fftocean.wave_files.components",
    "openfast": "fftocean.wave_files.openfast",
    "swd": "fftocean.wave_files.swd",
}

__all__ = sorted(_MODULE_OF)


def __getattr__(name: str) -> Any:
    """Import a public name from its module."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'fftocean.export' has no attribute {name!r}")
    return getattr(importlib.import_module(_MODULE_OF[name]), name)


def __dir__() -> list[str]:
    """Return the public names and the module's own dunder names."""
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
