"""
Directional moments in netCDF: NDBC's (alpha1, alpha2, r1, r2) and CDIP's (A1, B1, A2, B2).

NDBC: `mean_wave_dir`, `principal_wave_dir` [degrees] FROM, clockwise from north,
`wave_spectrum_r1`, `wave_spectrum_r2`. CDIP: `waveA1Value` and so on, r1 cos(a1) and r1 sin(a1) of
the same directions, with `waveMeanDirection`, against which they are checked.

Source: NDBC, Measurement Descriptions and Units; CDIP, "Wave data: netCDF variables".
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from fftocean.arrays import Complex, Real
from fftocean.errors import ReaderError
from fftocean.readers import units

if TYPE_CHECKING:
    from xarray import DataArray, Dataset

FAMILIES: Final = {"spectral_wave_density": "NDBC netCDF", "waveEnergyDensity": "CDIP netCDF"}
"""The formats, by the name of the variable of S(f) [m2/Hz] beside which the moments stand."""

DENSITIES: Final = tuple(FAMILIES)

_NDBC: Final = ("mean_wave_dir", "principal_wave_dir", "wave_spectrum_r1", "wave_spectrum_r2")
_CDIP: Final = ("waveA1Value", "waveB1Value", "waveA2Value", "waveB2Value")
_APART: Final = 2.0  # largest difference of `waveMeanDirection` from that of the moments [degrees]


def find(
    raw: "Dataset", name: object, source: str, values: Callable[["DataArray"], Real]
) -> tuple[Complex, Complex] | None:
    """
    Return both moments of the directions FROM, clockwise from north; None if the dataset has none.

    Args:
        raw: the dataset.
        name: of the variable of densities.
        source: what to call the dataset in errors.
        values: function that returns the values of such a variable at one place, (time, f).

    Raises:
        ReaderError: some of the variables without the others, of other dimensions or units, or out
            of range.
    """
    if name not in DENSITIES:
        return None
    for family in (_NDBC, _CDIP):
        absent = [word for word in family if word not in raw.variables]
        if len(absent) == len(family):
            continue
        if absent:
            raise ReaderError(
                f"{source} must hold all four moments or none; missing: {', '.join(absent)}"
            )
        for word in family:
            if raw[word].dims != raw[name].dims:
                raise ReaderError(f"{source}: variable {word} must have the dimensions of {name}")
        return _ndbc(raw, source, values) if family is _NDBC else _cdip(raw, source, values)
    return None


def _ndbc(
    raw: "Dataset", source: str, values: Callable[["DataArray"], Real]
) -> tuple[Complex, Complex]:
    angles = []
    for word in _NDBC[:2]:
        unit = units.parse(raw[word].attrs.get("units", "degree"))
        if unit is None or not unit.is_(rad=1):
            said = raw[word].attrs.get("units")
            raise ReaderError(f"{source}: variable {word} must be in degrees, got {said!r:.40}")
        angle = values(raw[word]) * unit.scale
        _require(f"{source}: variable {word}", angle, -2.0 * np.pi, 4.0 * np.pi, "radians")
        angles.append(angle)
    r = []
    for word in _NDBC[2:]:
        r.append(values(raw[word]))
        _require(f"{source}: variable {word}", r[-1], 0.0, 1.1, "")
    return _moment(r[0], angles[0], 1), _moment(r[1], angles[1], 2)


def _cdip(
    raw: "Dataset", source: str, values: Callable[["DataArray"], Real]
) -> tuple[Complex, Complex]:
    parts = []
    for word in _CDIP:
        parts.append(values(raw[word]))
        _require(f"{source}: variable {word}", parts[-1], -1.1, 1.1, "")
    c1 = np.asarray(parts[0] + 1j * parts[1], dtype=np.complex128)
    c2 = np.asarray(parts[2] + 1j * parts[3], dtype=np.complex128)
    if "waveMeanDirection" in raw.variables and raw["waveMeanDirection"].dims == raw[_CDIP[0]].dims:
        mean = values(raw["waveMeanDirection"])
        with np.errstate(invalid="ignore"):
            apart = np.abs(np.degrees(np.angle(c1 * np.exp(-1j * np.radians(mean)))))
            wrong = (apart > _APART) & (np.abs(c1) > 0.1)
        if np.any(wrong):
            place = tuple(int(i) for i in np.argwhere(wrong)[0])
            raise ReaderError(
                f"{source}: variable waveMeanDirection must be the direction of waveA1Value and "
                f"waveB1Value, "
                f"got {mean[place]:g} against {np.degrees(np.angle(c1[place])) % 360.0:.6g} "
                f"degrees at {place}"
            )
    return c1, c2


def _moment(r: Real, angle: Real, n: int) -> Complex:
    return np.asarray(r * np.exp(1j * n * angle), dtype=np.complex128)


def _require(where: str, values: Real, low: float, high: float, unit: str) -> None:
    with np.errstate(invalid="ignore"):
        wrong: Any = (values < low) | (values > high)
    if np.any(wrong):
        raise ReaderError(
            f"{where} must be between {low:g} and {high:g} {unit}".rstrip()
            + f", got {values[wrong][0]:g}"
        )
