"""
Writers of one specified sea in the formats of models and buoys.

Each follows the format's own documents and shares no code with the readers.
"""

import gzip
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from builders import lazy

xr = lazy("xarray")

DATA = Path(__file__).parent.parent / "data" / "spectra"

# ERA5's axes, which the other formats can hold too, so that one sea has the same numbers in all of
# them.
FREQUENCY = 0.03453 * 1.1 ** np.arange(30)  # [Hz]
TO = 7.5 + 15.0 * np.arange(24)  # [degrees] toward, clockwise from north
TIMES = np.array(["2020-01-01T00", "2020-01-01T06"], dtype="datetime64[ns]")


@dataclass(frozen=True)
class SpecifiedSpectrum:
    """
    A specified sea: E(f, toward) in m2/Hz/degree, on `FREQUENCY` and `TO`, at two `TIMES`
    (the second has twice as much).
    """

    density: np.ndarray  # (time, f, d)


def sea(toward: float = 90.0, width: float = 8.0) -> SpecifiedSpectrum:
    """
    Return a wind sea of 0.1 Hz, cos^2s about a compass direction TOWARD.

    It is narrower below the peak, so that f and theta do not separate.
    """
    s = 5.0 * (FREQUENCY / 0.1) ** -5 * np.exp(-1.25 * (FREQUENCY / 0.1) ** -4)
    exponent = width * np.where(FREQUENCY < 0.1, 2.0, 0.1 / FREQUENCY)[:, None]
    d = np.abs(np.cos(np.radians(TO - toward) / 2.0)) ** (2.0 * exponent)
    once = s[:, None] * d / (d.sum(axis=1, keepdims=True) * 15.0)
    once[once < 1e-9] = 0.0
    return SpecifiedSpectrum(np.stack([once, 2.0 * once]))


def write_wavespectra(path: Path, specified: SpecifiedSpectrum) -> Path:
    """
    Write efth(time, site, freq, dir) per degree, dir FROM without attributes, like the wavespectra
    package.
    """
    came = np.argsort((TO + 180.0) % 360.0)
    data = xr.Dataset(
        {
            "efth": (
                ("time", "site", "freq", "dir"),
                specified.density[:, None][..., came],
                {"units": "m^{2}.s.degree^{-1}"},
            )
        },
        {"time": TIMES, "site": [1], "freq": FREQUENCY, "dir": ((TO + 180.0) % 360.0)[came]},
    )
    data.to_netcdf(path, engine="h5netcdf")
    return path


def ww3(specified: SpecifiedSpectrum) -> "xr.Dataset":
    """
    Return efth(time, station, frequency, direction) per radian, direction TO and descending from
    north, depth 30 m.
    """
    back = np.argsort(-((TO - 90.0) % 360.0))
    density = specified.density[:, None][..., back] * 180.0 / np.pi
    name = "sea_surface_wave_directional_variance_spectral_density"
    to = {
        "standard_name": "sea_surface_wave_to_direction",
        "long_name": "sea surface wave to direction",
        "units": "degree",
    }
    return xr.Dataset(
        {
            "efth": (
                ("time", "station", "frequency", "direction"),
                density,
                {"standard_name": name, "units": "m2 s rad-1"},
            ),
            "dpt": (
                ("time", "station"),
                np.full((2, 1), 30.0),
                {"standard_name": "depth", "units": "m"},
            ),
            "longitude": (("time", "station"), np.full((2, 1), -30.0)),
            "latitude": (("time", "station"), np.full((2, 1), 45.0)),
        },
        {
            "time": TIMES,
            "station": np.array([1], dtype=np.int32),
            "frequency": (
                "frequency",
                FREQUENCY,
                {"standard_name": "sea_surface_wave_frequency", "units": "s-1"},
            ),
            "direction": ("direction", TO[back], to),
        },
    )


def write_ww3(path: Path, specified: SpecifiedSpectrum) -> Path:
    """Write netCDF 3, the default of WAVEWATCH III."""
    ww3(specified).to_netcdf(path, engine="scipy")
    return path


def era5(specified: SpecifiedSpectrum, *, numbers: bool = True) -> "xr.Dataset":
    """
    Return d2fd, log10 of m2/Hz/radian, NaN for no energy, direction before frequency, on a grid of
    2 by 1 (the sea is in the second).
    """
    with np.errstate(divide="ignore"):
        log10 = np.log10(specified.density * 180.0 / np.pi)
    log10[~np.isfinite(log10)] = np.nan
    here = np.stack([np.full_like(log10, np.nan), log10], axis=-1)[
        ..., None
    ]  # time, f, d, lat, lon
    coords = {"valid_time": TIMES, "latitude": [50.0, 45.0], "longitude": [-30.0]}
    coords |= {
        "frequencyNumber": np.arange(1, 31) if numbers else FREQUENCY,
        "directionNumber": np.arange(1, 25) if numbers else TO,
    }
    data = xr.Dataset(
        {
            "d2fd": (
                ("valid_time", "frequencyNumber", "directionNumber", "latitude", "longitude"),
                here,
                {"units": "m**2 s radian**-1"},
            )
        },
        coords,
    )
    return data.transpose(
        "valid_time", "directionNumber", "frequencyNumber", "latitude", "longitude"
    )


def write_era5(path: Path, specified: SpecifiedSpectrum, *, numbers: bool = True) -> Path:
    era5(specified, numbers=numbers).to_netcdf(path, engine="h5netcdf")
    return path


def write_swan(path: Path, specified: SpecifiedSpectrum, *, cartesian: bool = False) -> Path:
    """
    Write SWAN's ASCII with nine digits where SWAN has four, for comparison; nautical FROM or
    Cartesian TOWARD.
    """
    angles = (90.0 - TO) % 360.0 if cartesian else (TO + 180.0) % 360.0
    text = [
        "SWAN   1        Swan standard spectral file, version",
        "$ made for a test",
        "TIME",
        "     1",
        "LONLAT",
        "     1",
        "  -30.0  45.0",
    ]
    text += ["AFREQ", f"{FREQUENCY.size:6d}", *(f"{f:.12f}" for f in FREQUENCY)]
    text += ["CDIR" if cartesian else "NDIR", f"{angles.size:6d}", *(f"{a:.4f}" for a in angles)]
    text += ["QUANT", "     1", "VaDens", "m2/Hz/degr", "   -99"]
    for time, density in zip(TIMES, specified.density, strict=True):
        factor = density.max() / 999999999
        text += [
            time.astype("datetime64[s]").item().strftime("%Y%m%d.%H%M%S"),
            "FACTOR",
            f"{factor:.12E}",
        ]
        text += [" ".join(f"{v:.0f}" for v in row / factor) for row in density]
    path.write_text("\n".join(text) + "\n")
    return path


def write_ndbc(folder: Path, *, source: float = 270.0, r1: float = 0.9, r2: float = 0.65) -> Path:
    """Write a realtime set with one direction FROM for all frequencies."""
    s = 5.0 * (FREQUENCY / 0.1) ** -5 * np.exp(-1.25 * (FREQUENCY / 0.1) ** -4)
    columns = {
        "data_spec": ("Sep_Freq  < spec_1 (freq_1) ... >", [f"{v:.3f}" for v in s]),
        "swdir": ("alpha1_1 (freq_1) ... >", [f"{source:.1f}"] * s.size),
        "swdir2": ("alpha2_1 (freq_1) ... >", [f"{source:.1f}"] * s.size),
        "swr1": ("r1_1 (freq_1) ... >", [f"{r1:.2f}"] * s.size),
        "swr2": ("r2_1 (freq_1) ... >", [f"{r2:.2f}"] * s.size),
    }
    for suffix, (head, values) in columns.items():
        row = " ".join(f"{v} ({f:.3f})" for v, f in zip(values, FREQUENCY, strict=True))
        start = "2020 01 01 00 40 " + ("9.999 " if suffix == "data_spec" else "")
        (folder / f"12345.{suffix}").write_text(f"#YY  MM DD hh mm {head}\n{start}{row} \n")
    return folder / "12345.data_spec"


def packed(path: Path) -> Path:
    """Return the same file as .gz."""
    out = path.with_name(path.name + ".gz")
    out.write_bytes(gzip.compress(path.read_bytes(), 1))
    return out
