"""Header of a bake: everything that determines its bytes."""

import os
import platform
import zlib
from collections.abc import Mapping, Sequence
from importlib import metadata
from typing import Any

import fftocean
from fftocean.export.formats import FORMATS
from fftocean.gpu.device import adapter
from fftocean.job.job import Job
from fftocean.job.parameters import PARAMETERS
from fftocean.transforms import library

HEADER = ("tool", "version", "job", "units", "subset", "downsample", "inputs", "made_with")
"""Keys of the header: all of `job.json`, and the beginning of `manifest.json`."""


def header_of(job: Job, *, frames: Sequence[int], downsample: int, backend: str) -> dict[str, Any]:
    """
    Return the header of a bake: job, subset of the frames, measured files and libraries.

    Args:
        job: as the user gave it, before downsampling.
        frames: numbers of the frames in the loop.
        downsample: factor by which the samples a side are fewer than the job's.
        backend: the FFT library in use, or "gpu".

    Raises:
        ReaderError: a measured file that cannot be read.
    """
    units = {p.key: p.unit for p in PARAMETERS if p.unit}
    step = frames[1] - frames[0] if len(frames) > 1 else 1
    whole = len(frames) == job.frames
    return {
        "tool": "fftocean",
        "version": fftocean.__version__,
        "job": job.describe(),
        "units": units,
        "subset": "all" if whole else f"{frames[0]}:{frames[-1] + 1}:{step}",
        "downsample": downsample,
        "inputs": job.inputs(),
        "made_with": _libraries(job, backend),
    }


def _libraries(job: Job, backend: str) -> dict[str, str]:
    """Return the libraries whose next version may give other bits, by their purpose."""
    numba = "numba (off)" if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0") else "numba"
    encoder = (
        {"encoder": f"isal {_version('isal')}"} if FORMATS[job.format].suffix == ".exr" else {}
    )
    return {
        "fft": str(adapter()) if backend == "gpu" else library(backend) or backend,
        "arrays": f"numpy {_version('numpy')}",
        "functions": f"scipy {_version('scipy')}",
        "compiler": f"{numba} {_version('numba')}",
        **encoder,
        "deflate": f"zlib {zlib.ZLIB_RUNTIME_VERSION}",
        "pictures": f"pillow {_version('pillow')}",
        "machine": platform.machine(),
    }


def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "unknown"


def differences(old: Mapping[str, Any], new: Mapping[str, Any]) -> str:
    """Return the keys in which two headers differ, with both values; "" where none does."""
    there, here = _flat(old), _flat(new)
    differing = sorted(key for key in {*there, *here} if there.get(key) != here.get(key))
    return "; ".join(
        f"{key}: {there.get(key, 'not set')} there, {here.get(key, 'not set')} here"
        for key in differing[:6]
    )


def _flat(header: Mapping[str, Any]) -> dict[str, Any]:
    """Return a header's values by the names under which a user knows them."""
    flat = {key: header[key] for key in ("version", "subset", "downsample") if key in header}
    for group, prefix in (("job", ""), ("inputs", "inputs."), ("made_with", "made_with.")):
        values = header.get(group)
        flat |= (
            {f"{prefix}{key}": value for key, value in values.items()}
            if isinstance(values, dict)
            else {}
        )
    return flat
