"""
Writers of `spectrum_files.sea` in the formats of instruments and of models' text files.

Each follows the format's own documents and shares no code with the readers.
"""

from pathlib import Path

import numpy as np
from builders import lazy
from spectrum_files import FREQUENCY, TIMES, TO, SpecifiedSpectrum

xr = lazy("xarray")

FROM = (TO + 180.0) % 360.0
STEP = 15.0
EDGES = np.concatenate([FREQUENCY[:1], 0.5 * (FREQUENCY[1:] + FREQUENCY[:-1]), FREQUENCY[-1:]])


def undirected(specified: SpecifiedSpectrum) -> np.ndarray:
    """Return E(f) [m2/Hz], (time, f)."""
    return specified.density.sum(axis=2) * STEP


def fourier(specified: SpecifiedSpectrum, n: int) -> np.ndarray:
    """Return the n-th moment sum D e^{i n from}, (time, f), of directions FROM, clockwise."""
    wave = np.exp(1j * n * np.radians(FROM))
    total = specified.density.sum(axis=2)
    return (specified.density @ wave) / np.where(
        total > 0.0, total, 1.0
    )  # 0 where there is no energy


def stamps() -> list[str]:
    return [str(t)[:19] for t in TIMES.astype("datetime64[s]")]


def write_ww3_text(
    path: Path, specified: SpecifiedSpectrum, *, points: int = 1, figures: int = 9
) -> Path:
    """
    Write ww3_outp's transfer file: 8 frequencies and 7 other numbers a line, radians TO, per
    radian.
    """

    def rows(values, per, spec):
        text = [format(v, spec) for v in values]
        return [" " + " ".join(text[i : i + per]) for i in range(0, len(text), per)]

    out = [f"'WAVEWATCH III SPECTRA'  {FREQUENCY.size:4d}  {TO.size:4d} {points:5d} 'a sea'"]
    out += rows(FREQUENCY, 8, f".{figures}E") + rows(np.radians(TO), 7, f".{figures}E")
    for stamp, density in zip(stamps(), specified.density, strict=True):
        out.append(stamp.replace("-", "").replace(":", "").replace("T", " "))
        for point in range(points):
            out.append(f"'{f'P{point}':10s}'  45.00-130.00      30.0   5.00 270.0   0.10  90.0")
            flat = (density * (point + 1)).T.ravel() * 180.0 / np.pi  # the frequency fastest
            out += rows(flat, 7, f".{figures}E")
    path.write_text("\n".join(out) + "\n")
    return path


def write_swan_1d(
    path: Path, specified: SpecifiedSpectrum, *, cartesian: bool = False, energy: bool = False
) -> Path:
    """Write VaDens or EnDens, mean direction and spread of each frequency, at two places."""
    c1 = fourier(specified, 1)
    mean = np.degrees(np.angle(c1)) % 360.0
    spread = np.degrees(np.sqrt(2.0 * (1.0 - np.abs(c1))))
    mean = (270.0 - mean) % 360.0 if cartesian else mean
    scale = 1025.0 * 9.81 if energy else 1.0
    out = ["SWAN   1     Swan standard spectral file, version", "$ a comment", "TIME", " 1   code"]
    out += [
        "LONLAT",
        " 2  number",
        " -30.0 45.0",
        " -31.0 46.0",
        "AFREQ   absolute",
        f" {FREQUENCY.size}",
    ]
    out += [f" {f:.9f}" for f in FREQUENCY]
    out += ["QUANT", " 3  number"]
    out += ["EnDens", "J/m2/Hz"] if energy else ["VaDens  variance", "m2/Hz  unit"]
    out += [
        "  -0.9900E+02  exception value",
        "CDIR" if cartesian else "NDIR",
        "degr",
        " -0.9990E+03",
    ]
    out += ["DSPRDEGR  spreading", "degr", " -0.9000E+01"]
    for i, stamp in enumerate(stamps()):
        out.append(stamp.replace("-", "").replace(":", "").replace("T", ".") + "   date and time")
        out.append("LOCATION     1")
        for s, m, d in zip(undirected(specified)[i] * scale, mean[i], spread[i], strict=True):
            out.append(f"  {s:.9E}  {m:.6f}  {d:.6f}")
        out.append("NODATA")
    path.write_text("\n".join(out) + "\n")
    return path


def write_spotter(path: Path, specified: SpecifiedSpectrum) -> Path:
    """
    Write a1 .. b2 of directions TO, counter-clockwise from east; df reaches half way to neighbours.
    """
    count = FREQUENCY.size
    width = np.diff(EDGES)
    middle = 0.5 * (EDGES[1:] + EDGES[:-1])
    s = undirected(specified)
    once = ["Epoch Time ", "Significant Wave Height (m) ", "Latitude (deg) ", "Longitude (deg) "]
    words = ("f", "df", "a1", "b1", "a2", "b2", "varianceDensity", "direction", "directionalSpread")
    lines = [",".join(once + [f"{w}_{i} " for w in words for i in range(count)])]
    east = np.radians(90.0 - TO)  # TOWARD, counter-clockwise from east
    for i, time in enumerate(TIMES.astype("datetime64[s]").astype(np.int64)):
        total = specified.density[i].sum(axis=1, keepdims=True)
        share = specified.density[i] / np.where(total > 0.0, total, 1.0)
        a1, b1 = share @ np.cos(east), share @ np.sin(east)
        a2, b2 = share @ np.cos(2.0 * east), share @ np.sin(2.0 * east)
        mean = (270.0 - np.degrees(np.arctan2(b1, a1))) % 360.0
        spread = np.degrees(np.sqrt(2.0 - 2.0 * np.hypot(a1, b1)))
        hs = 4.0 * np.sqrt(np.sum(s[i] * width))
        row = [f"{time}", f"{hs:.3f}", "45.0", "-30.0"]
        for values in (middle, width, a1, b1, a2, b2, s[i], mean, spread):
            row += [f"{v:.9f}" for v in values]
        lines.append(",".join(row))
    path.write_text("\n".join(lines) + "\n")
    return path


def write_datawell(path: Path, specified: SpecifiedSpectrum) -> Path:
    """Write density / largest density, direction, spread, skewness, kurtosis (Kuik et al. 1988)."""
    c1, c2, s = fourier(specified, 1)[0], fourier(specified, 2)[0], undirected(specified)[0]
    mean = np.angle(c1)
    m1 = np.abs(c1)
    centred = c2 * np.exp(-2j * mean)
    sigma = np.sqrt(2.0 - 2.0 * m1)
    skewness = -centred.imag / ((1.0 - centred.real) / 2.0) ** 1.5
    kurtosis = (6.0 - 8.0 * m1 + 2.0 * centred.real) / (2.0 - 2.0 * m1) ** 2
    hs = 400.0 * np.sqrt(np.sum(s * np.gradient(FREQUENCY)))
    head = [10, f"{hs:.1f}", 4.5, f"{s.max():.9E}", 25.0, 19.6, 7, -0.17, 0.37, 0.26, 213.8, 68.2]
    lines = [str(v) for v in head]
    for f, e, m, d, g, k in zip(
        FREQUENCY,
        s / s.max(),
        np.degrees(mean) % 360.0,
        np.degrees(sigma),
        skewness,
        kurtosis,
        strict=True,
    ):
        lines.append(f"{f:.9f},{e:.9E},{m:.6f},{d:.6f},{g:.6f},{k:.6f}")
    path.write_text("\r\n".join(lines) + "\r\n")
    return path


def write_triaxys(path: Path, specified: SpecifiedSpectrum, *, directed: bool = True) -> Path:
    """
    Write a table on equal frequencies, from 0 Hz: `specified` at 0.01 Hz steps, interpolated
    linearly.
    """
    f = 0.01 * np.arange(40)
    table = np.stack(
        [np.interp(f, FREQUENCY, column, left=0.0, right=0.0) for column in specified.density[0].T],
        axis=1,
    )
    bearing = np.arange(FROM.size + 1) * STEP
    at = [int(np.argmin(np.abs((FROM - b - 7.5 + 180.0) % 360.0 - 180.0))) for b in bearing]
    table = table[:, at]  # turned by 7.5 degrees, so that it begins at north
    kind = "DIRECTIONAL SPECTRUM" if directed else "NON-DIRECTIONAL SPECTRUM"
    lines = [
        "TRIAXYS BUOY DATA REPORT - TAS01970 - TAB01401 - 4830.0000N13030.0000W",
        "VERSION = WV",
    ]
    lines += [
        f"TYPE\t= {kind}",
        "DATE    = 2020-01-01 00:00(UTC)",
        f"NUMBER OF FREQUENCIES = {f.size}",
    ]
    lines += ["INITIAL FREQUENCY (Hz) = 0.000", "FREQUENCY SPACING (Hz) = 0.010"]
    if directed:
        lines += [f"NUMBER OF DIRECTIONS = {bearing.size}", "DIRECTION SPACING (DEG) = 15"]
        lines += ["COLUMNS = 0.00 TO 360.00 DEG", "ROWS\t= 0.00 TO   0.39 Hz"]
        lines += [" ".join(f"{v:.8E}" for v in row) for row in table]
    else:
        lines += ["COLUMN 1 = FREQUENCY (Hz)", "COLUMN 2 = SPECTRAL DENSITY (M^2/Hz)"]
        lines += [
            f"{a:.3f}  {v:.8E}" for a, v in zip(f, table[:, :-1].sum(axis=1) * STEP, strict=True)
        ]
    path.write_text("\n".join(lines) + "\n")
    return path


def write_octopus(path: Path, specified: SpecifiedSpectrum) -> Path:
    """Write energies of bins of direction FROM and frequency, bands half way to the neighbours."""
    width = np.diff(EDGES)
    came = np.argsort(FROM)
    lines = [
        "Forecast",
        f"nfreqs,{FREQUENCY.size}",
        f"ndir,{FROM.size}",
        f"nrecs,{len(specified.density)}",
    ]
    lines += ["Latitude, 45.0", "Longitude, -30.0", "Depth,30.0"]
    for stamp, density in zip(stamps(), specified.density, strict=True):
        energy = density * width[:, None] * STEP
        date = stamp.replace("-", "").replace(":", "").replace("T", "")
        hs = 4.0 * np.sqrt(energy.sum())
        lines += ["", "CCYYMM,DDHHmm,LPoint,HSig", f"{date[:6]},'{date[6:12]},place,{hs:.4f}"]
        lines.append("freq," + ",".join(f"{f:.9f}" for f in FREQUENCY) + ",anspec")
        for j in came:
            row = ",".join(f"{e:.12f}" for e in energy[:, j])
            lines.append(f"{FROM[j]:g},{row},{energy[:, j].sum():.5f}")
        lines.append("fSpec," + ",".join(f"{e:.5f}" for e in energy.sum(axis=1)) + ",")
        lines.append("den," + ",".join(f"{e:.5f}" for e in energy.sum(axis=1) / width) + ",")
    path.write_text("\n".join(lines) + "\n")
    return path


def write_archive(folder: Path, specified: SpecifiedSpectrum) -> Path:
    """Write NDBC's five files of a year: alpha1, alpha2 in degrees, r1 and r2 in hundredths."""
    c1, c2 = fourier(specified, 1), fourier(specified, 2)
    columns = {
        "w": undirected(specified),
        "d": np.degrees(np.angle(c1)) % 360.0,
        "i": np.degrees(np.angle(c2)) / 2.0 % 360.0,
        "j": 100.0 * np.abs(c1),
        "k": 100.0 * np.abs(c2),
    }
    head = "#YY  MM DD hh mm " + " ".join(f"{f:.9f}" for f in FREQUENCY)
    for kind, values in columns.items():
        lines = [head]
        for stamp, row in zip(stamps(), values, strict=True):
            date = stamp[:16].replace("-", " ").replace("T", " ").replace(":", " ")
            lines.append(f"{date} " + " ".join(f"{v:.6f}" for v in row))
        (folder / f"12345{kind}2020.txt").write_text("\n".join(lines) + "\n")
    return folder / "12345w2020.txt"


def ndbc_netcdf(specified: SpecifiedSpectrum) -> "xr.Dataset":
    """Return a dataset like NDBC's THREDDS files, with one place of latitude and longitude."""
    c1, c2 = fourier(specified, 1), fourier(specified, 2)
    dims = ("time", "frequency", "latitude", "longitude")

    def variable(values, **attrs):
        return dims, values[:, :, None, None], attrs

    return xr.Dataset(
        {
            "spectral_wave_density": variable(undirected(specified), units="(meter * meter)/Hz"),
            "mean_wave_dir": variable(np.degrees(np.angle(c1)) % 360.0, units="degrees_true"),
            "principal_wave_dir": variable(
                np.degrees(np.angle(c2)) / 2.0 % 360.0, units="degrees_true"
            ),
            "wave_spectrum_r1": variable(np.abs(c1)),
            "wave_spectrum_r2": variable(np.abs(c2)),
        },
        {
            "time": TIMES,
            "frequency": ("frequency", FREQUENCY, {"units": "Hz", "standard_name": "frequency"}),
            "latitude": [45.0],
            "longitude": [-30.0],
        },
    )


def cdip(specified: SpecifiedSpectrum) -> "xr.Dataset":
    """
    Return a dataset like CDIP's: A1, B1, A2, B2 of directions FROM, clockwise from true north, and
    bandwidths.
    """
    c1, c2 = fourier(specified, 1), fourier(specified, 2)
    dims = ("waveTime", "waveFrequency")
    name = "sea_surface_wave_variance_spectral_density"
    return xr.Dataset(
        {
            "waveEnergyDensity": (
                dims,
                undirected(specified),
                {"units": "meter^2 second", "standard_name": name},
            ),
            "waveMeanDirection": (dims, np.degrees(np.angle(c1)) % 360.0, {"units": "degreeT"}),
            "waveA1Value": (dims, c1.real),
            "waveB1Value": (dims, c1.imag),
            "waveA2Value": (dims, c2.real),
            "waveB2Value": (dims, c2.imag),
        },
        {
            "waveTime": TIMES,
            "waveFrequency": ("waveFrequency", FREQUENCY, {"units": "hertz"}),
        },
    )
