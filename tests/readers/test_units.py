"""Units of measurement in all the spellings that UDUNITS and wave files have."""

import math
import time

import numpy as np
import pytest
from builders import lazy
from hypothesis import given
from hypothesis import strategies as st

import fftocean as fo
from fftocean.readers import units

xr = lazy("xarray")

DENSITY = {"m": 2, "s": 1}
TURNED = {"m": 2, "s": 1, "rad": -1}
DEGREE = 180.0 / math.pi


@pytest.mark.parametrize(
    ("text", "scale", "powers"),
    [
        ("m2 s", 1.0, DENSITY),
        ("meter^2 second", 1.0, DENSITY),
        ("meter2/hertz", 1.0, DENSITY),
        ("metre2 second", 1.0, DENSITY),
        ("(meter * meter)/Hz", 1.0, DENSITY),
        ("m^2/Hz", 1.0, DENSITY),
        ("m**2 s", 1.0, DENSITY),
        ("m2.s", 1.0, DENSITY),
        ("m²·s", 1.0, DENSITY),
        ("M^2/HZ", 1.0, DENSITY),
        ("meters2 per hertz", 1.0, DENSITY),
        ("cm2 s", 1e-4, DENSITY),
        ("1e-4 m2 s", 1e-4, DENSITY),
        ("m2 Hz-1", 1.0, DENSITY),
        ("m2 s rad-1", 1.0, TURNED),
        ("m2 s degree-1", DEGREE, TURNED),
        ("m^{2}.s.degree^{-1}", DEGREE, TURNED),
        ("m**2 s radian**-1", 1.0, TURNED),
        ("m2/Hz/degr", DEGREE, TURNED),
        ("m^2/(Hz radian)", 1.0, TURNED),
        ("m² s rad⁻¹", 1.0, TURNED),
        ("m2 s per degree", DEGREE, TURNED),
        ("J/m2/Hz/degr", DEGREE, {"kg": 1, "s": -1, "rad": -1}),
        ("s-1", 1.0, {"s": -1}),
        ("1/s", 1.0, {"s": -1}),
        ("s^-1", 1.0, {"s": -1}),
        ("hertz", 1.0, {"s": -1}),
        ("mHz", 1e-3, {"s": -1}),
        ("rad/s", 1.0, {"rad": 1, "s": -1}),
        ("degrees_true", 1.0 / DEGREE, {"rad": 1}),
        ("degree_T", 1.0 / DEGREE, {"rad": 1}),
        ("1", 1.0, {}),
        ("ft", 0.3048, {"m": 1}),
        ("ft2 s", 0.3048**2, DENSITY),
        ("fathoms", 6 * 0.3048, {"m": 1}),
        ("km", 1e3, {"m": 1}),
        ("mm2/Hz", 1e-6, DENSITY),
        ("ms", 1e-3, {"s": 1}),
        ("minutes", 60.0, {"s": 1}),
        ("hr", 3600.0, {"s": 1}),
        ("m/s/s", 1.0, {"m": 1, "s": -2}),
    ],
)  # fmt: skip
def test_spellings(text, scale, powers):
    unit = units.parse(text)
    assert unit is not None
    assert unit.scale == pytest.approx(scale, rel=1e-15)
    assert dict(unit.powers) == powers
    assert unit.base is None


@pytest.mark.parametrize(
    "text",
    ["", " ", "banana", "m2 banana", "m2 s (", "m2)", "m-", "m //s", "m * * s", "m99",
     "10^400 m", "m^0.5", "m2.5", None, 3, "m" * 300, "(" * 190 + "m",
     "MM", "Ms", "MHz", "Km2", "FT2 KG-1 x", "m2 s # comment", "m2 s since 1990-01-01", "/s",
     "m^", "0 m"],
)  # fmt: skip
def test_what_is_no_unit(text):
    assert units.parse(text) is None


@pytest.mark.parametrize(
    ("text", "base", "offset"),
    [
        ("log10(m2 s rad-1 +1E-12)", 10.0, 1e-12),
        ("log10(m2 s rad-1)", 10.0, 0.0),
        ("lg(re 1 m2 s rad-1)", 10.0, 0.0),
        ("lg(re: 1 m2 s rad-1)", 10.0, 0.0),
        ("ln(re m2 s rad-1)", math.e, 0.0),
        ("lb(re m2 s rad-1)", 2.0, 0.0),
    ],
)
def test_logarithms(text, base, offset):
    unit = units.parse(text)
    assert (dict(unit.powers), unit.base, unit.offset) == (TURNED, base, offset)
    values = np.array([0.0, 1e-6, 2.5])
    stored = np.log(values + (offset or 1e-30)) / math.log(base)
    assert unit.linear(stored) == pytest.approx(values, rel=1e-9, abs=2e-16)


@given(st.text(alphabet="ms2^*/-.()+ {}1e raddegHzlog", max_size=200))
def test_no_text_takes_long_or_raises(text):
    start = time.process_time()
    unit = units.parse(text)
    assert time.process_time() - start < 1.0
    assert unit is None or (math.isfinite(unit.scale) and unit.scale > 0.0)


@pytest.mark.parametrize(
    "unit", ["m2 s", "meter^2 second", "meter2/hertz", "metre2 second", "(meter * meter)/Hz"]
)
def test_a_sea_of_any_spelling(unit):
    f = np.linspace(0.03, 0.5, 48)
    s = 0.3 * (f / 0.1) ** -5 * np.exp(-1.25 * (f / 0.1) ** -4)
    name = "sea_surface_wave_variance_spectral_density"
    data = xr.Dataset(
        {
            "waveEnergyDensity": (
                ("waveTime", "waveFrequency"),
                s[None],
                {"units": unit, "standard_name": name},
            )
        },
        {
            "waveFrequency": ("waveFrequency", f, {"units": "hertz"}),
            "waveTime": [np.datetime64("2020-01-01", "ns")],
        },
    )
    made = fo.Sea.from_spectrum(data, direction=0.0, spreading=fo.CosineSquared())
    assert made.hs == pytest.approx(4.0 * np.sqrt(s.sum() * 0.01), rel=1e-6)


def test_centimetres_and_millihertz_are_turned():
    f = np.linspace(30.0, 500.0, 48)
    s = 0.3 * (f / 100.0) ** -5 * np.exp(-1.25 * (f / 100.0) ** -4)
    name = "sea_surface_wave_variance_spectral_density"
    data = xr.Dataset(
        {"waves": (("time", "freq"), 1e4 * s[None], {"units": "cm2/Hz", "standard_name": name})},
        {"freq": ("freq", f, {"units": "mHz"}), "time": [np.datetime64("2020-01-01", "ns")]},
    )
    made = fo.Sea.from_spectrum(data, direction=0.0, spreading=fo.CosineSquared())
    assert made.hs == pytest.approx(4.0 * np.sqrt(s.sum() * 0.01), rel=1e-6)
