"""
fftocean: seamlessly tiling, looping ocean surfaces with the statistics of a specified sea state.

Public names are imported on first use, so that `import fftocean` loads no compiler and no FFT
library.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fftocean import export as export
    from fftocean import foam as foam
    from fftocean import gerstner as gerstner
    from fftocean import gpu as gpu
    from fftocean import kinematics as kinematics
    from fftocean import plots as plots
    from fftocean import readers as readers
    from fftocean import science as science
    from fftocean import view as view
    from fftocean.baking.bake import bake as bake
    from fftocean.baking.finished.check import Finding as Finding
    from fftocean.baking.finished.check import check as check
    from fftocean.baking.finished.load import Bake as Bake
    from fftocean.baking.finished.load import BakedCascade as BakedCascade
    from fftocean.baking.finished.load import load as load
    from fftocean.baking.repair import repair as repair
    from fftocean.cascade import Cascade as Cascade
    from fftocean.constraints import constrained as constrained
    from fftocean.constraints import crest_height as crest_height
    from fftocean.errors import CacheWarning as CacheWarning
    from fftocean.errors import DeviceError as DeviceError
    from fftocean.errors import FFTOceanError as FFTOceanError
    from fftocean.errors import FieldError as FieldError
    from fftocean.errors import FolderInUseError as FolderInUseError
    from fftocean.errors import IntegrityError as IntegrityError
    from fftocean.errors import JobError as JobError
    from fftocean.errors import OutputError as OutputError
    from fftocean.errors import ParameterError as ParameterError
    from fftocean.errors import ReaderError as ReaderError
    from fftocean.errors import SeaWarning as SeaWarning
    from fftocean.eulerian import Eulerian as Eulerian
    from fftocean.fixed_values import Crest as Crest
    from fftocean.fixed_values import Fix as Fix
    from fftocean.fixed_values import Rarity as Rarity
    from fftocean.foam import Foam as Foam
    from fftocean.frame import EulerianFrame as EulerianFrame
    from fftocean.frame import Frame as Frame
    from fftocean.job.job import Job as Job
    from fftocean.ocean import Ocean as Ocean
    from fftocean.physics import dispersion as dispersion
    from fftocean.physics import moments as moments
    from fftocean.physics import presets as presets
    from fftocean.physics import units as units
    from fftocean.physics.sea import Sea as Sea
    from fftocean.physics.sea import WaveSystem as WaveSystem
    from fftocean.physics.sea import from_compass as from_compass
    from fftocean.physics.spectra import JONSWAP as JONSWAP
    from fftocean.physics.spectra import TMA as TMA
    from fftocean.physics.spectra import Bretschneider as Bretschneider
    from fftocean.physics.spectra import CustomSpectrum as CustomSpectrum
    from fftocean.physics.spectra import Elfouhaily as Elfouhaily
    from fftocean.physics.spectra import OchiHubble as OchiHubble
    from fftocean.physics.spectra import Phillips as Phillips
    from fftocean.physics.spectra import PiersonMoskowitz as PiersonMoskowitz
    from fftocean.physics.spectra import TabulatedSpectrum as TabulatedSpectrum
    from fftocean.physics.spectra import Torsethaugen as Torsethaugen
    from fftocean.physics.spreading import Blend as Blend
    from fftocean.physics.spreading import CosineN as CosineN
    from fftocean.physics.spreading import CosinePower as CosinePower
    from fftocean.physics.spreading import CosineSquared as CosineSquared
    from fftocean.physics.spreading import CustomSpreading as CustomSpreading
    from fftocean.physics.spreading import DonelanBanner as DonelanBanner
    from fftocean.physics.spreading import GodaSuzuki as GodaSuzuki
    from fftocean.physics.spreading import Hasselmann as Hasselmann
    from fftocean.physics.spreading import LongCrested as LongCrested
    from fftocean.physics.spreading import Mitsuyasu as Mitsuyasu
    from fftocean.physics.spreading import SwellElongation as SwellElongation
    from fftocean.physics.spreading import WrappedNormal as WrappedNormal
    from fftocean.probe_series import Series as Series
    from fftocean.probe_series import series as series
    from fftocean.products import Folding as Folding
    from fftocean.products import folding as folding
    from fftocean.products import jacobian as jacobian
    from fftocean.products import minimum_eigenvalue as minimum_eigenvalue
    from fftocean.products import normals as normals
    from fftocean.proof import Check as Check
    from fftocean.proof import verify as verify
    from fftocean.query import Answer as Answer
    from fftocean.query import Query as Query
    from fftocean.runtime.folder import export_sea as export_sea
    from fftocean.runtime.folder import load_sea as load_sea
    from fftocean.science import to_xarray as to_xarray
    from fftocean.statistics import Statistics as Statistics
    from fftocean.statistics import measure as measure
    from fftocean.window import Window as Window

__version__ = "0.2.0"

_NAMES_BY_MODULE = {
    "fftocean.baking.bake": ("bake",),
    "fftocean.baking.finished.check": ("Finding", "check"),
    "fftocean.job.job": ("Job",),
    "fftocean.baking.finished.load": ("Bake", "BakedCascade", "load"),
    "fftocean.baking.repair": ("repair",),
    "fftocean.cascade": ("Cascade",),
    "fftocean.constraints": ("constrained", "crest_height"),
    "fftocean.errors": (
        "CacheWarning",
        "DeviceError",
        "FFTOceanError",
        "FieldError",
        "FolderInUseError",
        "IntegrityError",
        "JobError",
        "OutputError",
        "ParameterError",
        "ReaderError",
        "SeaWarning",
    ),
    "fftocean.eulerian": ("Eulerian",),
    "fftocean.fixed_values": ("Crest", "Fix", "Rarity"),
    "fftocean.foam": ("Foam",),
    "fftocean.frame": ("EulerianFrame", "Frame"),
    "fftocean.ocean": ("Ocean",),
    "fftocean.physics.sea": ("Sea", "WaveSystem", "from_compass"),
    "fftocean.physics.spectra": (
        "Bretschneider",
        "CustomSpectrum",
        "Elfouhaily",
        "JONSWAP",
        "OchiHubble",
        "Phillips",
        "PiersonMoskowitz",
        "TMA",
        "TabulatedSpectrum",
        "Torsethaugen",
    ),
    "fftocean.physics.spreading": (
        "Blend",
        "CosineN",
        "CosinePower",
        "CosineSquared",
        "CustomSpreading",
        "DonelanBanner",
        "GodaSuzuki",
        "Hasselmann",
        "LongCrested",
        "Mitsuyasu",
        "SwellElongation",
        "WrappedNormal",
    ),
    "fftocean.probe_series": ("Series", "series"),
    "fftocean.products": ("Folding", "folding", "jacobian", "minimum_eigenvalue", "normals"),
    "fftocean.proof": ("Check", "verify"),
    "fftocean.query": ("Answer", "Query"),
    "fftocean.runtime.folder": ("export_sea", "load_sea"),
    "fftocean.science": ("to_xarray",),
    "fftocean.statistics": ("Statistics", "measure"),
    "fftocean.window": ("Window",),
}
_PUBLIC_MODULES = {
    "dispersion": "fftocean.physics.dispersion",
    "export": "fftocean.export",
    "foam": "fftocean.foam",
    "gerstner": "fftocean.gerstner",
    "gpu": "fftocean.gpu",
    "kinematics": "fftocean.kinematics",
    "moments": "fftocean.physics.moments",
    "plots": "fftocean.plots",
    "presets": "fftocean.physics.presets",
    "readers": "fftocean.readers",
    "science": "fftocean.science",
    "units": "fftocean.physics.units",
    "view": "fftocean.view",
}
_MODULE_OF = {name: module for module, names in _NAMES_BY_MODULE.items() for name in names}

__all__ = sorted([*_MODULE_OF, *_PUBLIC_MODULES])


def __getattr__(name: str) -> Any:
    """Import a public name from its module."""
    if name in _PUBLIC_MODULES:
        value = importlib.import_module(_PUBLIC_MODULES[name])
    elif name in _MODULE_OF:
        value = getattr(importlib.import_module(_MODULE_OF[name]), name)
    else:
        raise AttributeError(f"module 'fftocean' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names and the module's own dunder names."""
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
