"""How the kernels are compiled: once, cached on disk where that can be, and never failing for the sake of a cache."""

from collections.abc import Callable
from typing import Any, TypeVar

import numba as nb

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """
    Compile a kernel at its first call, without the GIL. Of fast-math it may only fuse multiply-adds, where the processor has them.

    numba keeps its cache beside the source or, where that is read-only, in the user's own; where there is neither, the kernel
    is compiled anew in each process.
    """
    options: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}
    try:
        return nb.njit(cache=True, **options)(function)  # type: ignore[no-any-return]
    except RuntimeError:  # numba: "cannot cache function: no locator available"
        return nb.njit(**options)(function)  # type: ignore[no-any-return]
