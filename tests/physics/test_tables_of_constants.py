"""
Tables of numbers, each transcribed here a second time from its source.

Every entry is compared by way of a public result to which it is proportional or a power, to a few
roundings: an error of 2 % in any of them is seen. Laws and tables are written out, not imported.
"""

import math

import numpy as np
import pytest

from fftocean import constants
from fftocean.foam_coverage import whitecap_coverage
from fftocean.physics import plausibility, units
from fftocean.physics.presets import beaufort_table, sea_state_table
from fftocean.physics.spectra import JONSWAP, TMA, Elfouhaily, OchiHubble, PiersonMoskowitz
from fftocean.physics.spectra import Torsethaugen as TorsethaugenSpectrum
from fftocean.physics.spectra.gamma import norm_by_regression
from fftocean.physics.spectra.growth import peak_enhancement
from fftocean.physics.spreading import (
    DonelanBanner,
    ElfouhailySpreading,
    GodaSuzuki,
    Hasselmann,
    Mitsuyasu,
)

pytestmark = pytest.mark.nojit
G = 9.80665  # CGPM 1901
ROUNDINGS = 1e-12  # a handful of operations, powers up to 5 among them


def test_water_and_gravity():
    """
    Surface tension by IAPWS R1-76 (2014) and the factor of salt of Nayar et al. 2014, density by
    EOS-80 (UNESCO 1981), at 15 degrees C and 35 g/kg. The constants are rounded, to 1 % and to
    1 kg/m^3.
    """
    tau = 1.0 - 288.15 / 647.096
    fresh = 235.8e-3 * tau**1.256 * (1.0 - 0.625 * tau)
    salty = fresh * (1.0 + 3.766e-4 * 35.0 + 2.347e-6 * 35.0 * 15.0)
    assert salty == pytest.approx(0.0745, abs=5e-5)
    assert pytest.approx(salty, rel=1e-2) == constants.SURFACE_TENSION
    t, s = 15.0, 35.0
    pure = 999.842594 + 6.793952e-2 * t - 9.095290e-3 * t**2 + 1.001685e-4 * t**3
    pure += -1.120083e-6 * t**4 + 6.536332e-9 * t**5
    a = 8.24493e-1 - 4.0899e-3 * t + 7.6438e-5 * t**2 - 8.2467e-7 * t**3 + 5.3875e-9 * t**4
    b = -5.72466e-3 + 1.0227e-4 * t - 1.6546e-6 * t**2
    density = pure + a * s + b * s**1.5 + 4.8314e-4 * s**2
    assert pytest.approx(density, abs=1.0) == constants.WATER_DENSITY
    assert constants.GRAVITY == G


def test_units():
    """A nautical mile is 1852 m, a foot 12 inches of 25.4 mm."""
    assert units.knots(3600.0) == pytest.approx(1852.0, rel=ROUNDINGS)
    assert pytest.approx(1852.0 / 3600.0, rel=ROUNDINGS) == units.KNOT
    assert pytest.approx(12 * 0.0254, rel=ROUNDINGS) == units.FOOT
    assert units.NAUTICAL_MILE == 1852.0


# Beaufort: limits of the wind in tenths of a metre a second and the probable height of waves in
# tenths of a metre (WMO-No. 306, code table 1100). Each range ends just below the next.
WINDS = (0, 3, 16, 34, 55, 80, 108, 139, 172, 208, 245, 285, 327)
PROBABLE = (0, 1, 2, 6, 10, 20, 30, 40, 55, 70, 90, 115, 140)
# Upper limits of height of sea states 0 to 8, in centimetres (WMO-No. 306, code table 3700).
STATES = (0, 10, 50, 125, 250, 400, 600, 900, 1400)


@pytest.mark.parametrize("number", range(13))
def test_beaufort(number):
    row = beaufort_table()[number]
    top = WINDS[number + 1] - 1 if number < 12 else 327
    middle = 0.05 * (WINDS[number] + top) if number else 0.0
    assert row.wind == pytest.approx(middle, rel=ROUNDINGS)
    assert row.hs == pytest.approx(PROBABLE[number] / 10.0, rel=ROUNDINGS)


@pytest.mark.parametrize("number", range(10))
def test_sea_states(number):
    low, high = STATES[max(number - 1, 0)], STATES[min(number, 8)]
    assert sea_state_table()[number].hs == pytest.approx(0.005 * (low + high), rel=ROUNDINGS)


# Ochi & Hubble 1976, table of the family, by column: the most probable sea, then the ten of 95 %
# confidence. Decays are in thousandths a metre.
OCHI_HUBBLE = {
    "share_low": (84, 95, 65, 84, 84, 90, 77, 73, 92, 84, 84),
    "share_high": (54, 31, 76, 54, 54, 44, 64, 68, 39, 54, 54),
    "omega_low": (70, 70, 61, 93, 41, 81, 54, 70, 70, 74, 62),
    "fall_low": (46, 46, 39, 56, 16, 52, 39, 46, 46, 52, 39),
    "omega_high": (115, 150, 94, 150, 88, 160, 61, 99, 137, 130, 103),
    "fall_high": (39, 46, 36, 46, 26, 33, 0, 39, 39, 39, 30),
    "lambda_low": (300, 135, 495, 300, 255, 180, 450, 640, 70, 265, 260),
    "lambda_high": (154, 248, 248, 277, 182, 295, 195, 178, 178, 390, 53),
    "fall_lambda": (62, 102, 102, 112, 89, 105, 82, 69, 69, 85, 69),
}


@pytest.mark.parametrize("member", range(11))
def test_ochi_hubble_family(member):
    """At 5 m, where a decay of 0.02 / m instead of none is 10 % of a frequency."""
    hs, row = 5.0, {name: column[member] for name, column in OCHI_HUBBLE.items()}
    sea = OchiHubble.family(hs=hs)[member]
    assert sea.hs_low / sea.hs_high == pytest.approx(
        row["share_low"] / row["share_high"], rel=ROUNDINGS
    )
    for side in ("low", "high"):
        omega = row[f"omega_{side}"] / 100.0 * math.exp(-row[f"fall_{side}"] / 1000.0 * hs)
        assert 2.0 * math.pi / getattr(sea, f"tp_{side}") == pytest.approx(omega, rel=ROUNDINGS)
    assert sea.lambda_low == row["lambda_low"] / 100.0
    assert sea.lambda_high == pytest.approx(
        row["lambda_high"] / 100.0 * math.exp(-row["fall_lambda"] / 1000.0 * hs), rel=ROUNDINGS
    )


# Torsethaugen 1996, table of parameters: names of the report, as the Marine Systems Simulator
# (NTNU) gives them in torsetSpectrum.m.
AF, AE, AU, A10, A1, A20, A2, A3 = 6.6, 2.0, 25.0, 0.7, 0.5, 0.6, 0.3, 6.0
KG, KG0, KG1, R, K0, K00, M0 = 35.0, 3.5, 1.0, 6.0 / 7.0, 0.5, 3.2, 4.0
B1, B2, B3, S0, S1 = 2.0, 0.7, 3.0, 0.08, 3.0


def torsethaugen(hs, tp, full):
    """Return (hs, tp, tail, front, gamma) of the wind sea and of the swell."""
    tf = AF * hs ** (1.0 / 3.0)
    n = K0 * math.sqrt(hs) + K00 if full else 4.0
    low = 1.0 + KG0 * math.exp(-hs / KG1) if full else 1.0
    if tp < tf:
        eps = (tf - tp) / (tf - AE * math.sqrt(hs))
        share = (1.0 - A10) * math.exp(-((eps / A1) ** 2)) + A10
        gamma = KG * low * (2.0 * math.pi / G * share * hs / tp**2) ** R
        rest = hs * math.sqrt(1.0 - share**2)
        return (share * hs, tp, n, M0, max(gamma, 1.0)), (rest, tf + B1, n, M0, 1.0)
    eps = (tp - tf) / (AU - tf)
    share = (1.0 - A20) * math.exp(-((eps / A2) ** 2)) + A20
    gamma = KG * low * (2.0 * math.pi / G * hs / tf**2) ** R * (1.0 + A3 * eps)
    rest = hs * math.sqrt(1.0 - share**2)
    m, period = M0, AF * rest ** (1.0 / 3.0)
    if full:
        m = M0 * (1.0 - B2 * math.exp(-hs / B3))
        g0 = m * (n / m) ** ((n - 1.0) / m) / math.gamma((n - 1.0) / m)
        s4 = max(0.01, S0 * (1.0 - math.exp(-hs / S1)))  # limits: DNV-RP-C205 (2010), appendix A
        period = max(2.5, (g0 * rest**2 / (16.0 * s4 * 0.4**n)) ** (1.0 / (n - 1.0)))
    return (rest, period, n, m, 1.0), (share * hs, tp, n, M0, max(gamma, 1.0))


@pytest.mark.parametrize("form", ["simplified", "full"])
@pytest.mark.parametrize(
    ("hs", "tp"),
    [(0.2, 14.0), (0.5, 5.2), (2.0, 6.0), (2.0, 8.6), (2.0, 15.0), (6.0, 9.0), (6.0, 17.0)],
)
def test_torsethaugen(form, hs, tp):
    """
    To a hundred roundings: a share near 1 leaves the root of a difference for the other system. Of
    0.2 m s4 has its least value; of 2 m and 8.6 s the period has, 2.5 s; of 0.5 m gamma is 1.
    """
    wind, swell = torsethaugen(hs, tp, form == "full")
    first, second = TorsethaugenSpectrum(hs=hs, tp=tp, form=form).systems
    expected = (swell, wind) if tp > AF * hs ** (1.0 / 3.0) else (wind, swell)
    for got, row in zip((first, second), expected, strict=True):
        assert (got.hs, got.tp, got.tail, got.front, got.gamma) == pytest.approx(row, rel=1e-11)


@pytest.mark.parametrize("hs", [0.03, 2.0])
def test_limits_of_torsethaugen(hs):
    """
    At Tf there is no second system, and its period is 0.1 s at least; beyond 25 s and in seas
    steeper than 2 sqrt(Hs) the distance from Tf is held at 1.
    """
    tf = AF * hs ** (1.0 / 3.0)
    for form in ("simplified", "full"):
        long = TorsethaugenSpectrum(hs=hs, tp=40.0, form=form).systems[0]
        assert long.hs / hs == pytest.approx(A20 + (1.0 - A20) * math.exp(-1.0 / A2**2), rel=1e-12)
    barely = TorsethaugenSpectrum(hs=hs, tp=tf * (1.0 + 1e-13), form="simplified").systems[1]
    assert barely.tp == 0.1
    steep = TorsethaugenSpectrum(hs=hs, tp=1.95 * math.sqrt(hs)).systems[0]
    assert steep.hs / hs == pytest.approx(A10 + (1.0 - A10) * math.exp(-1.0 / A1**2), rel=1e-12)


@pytest.mark.parametrize(("n", "m"), [(3.4, 4.0), (4.0, 2.5), (5.5, 4.0)])
@pytest.mark.parametrize("gamma", [1.7, 6.0])
def test_norm_of_torsethaugen(n, m, gamma):
    """The regression of DNV-RP-C205 (2010), A.1, for A_gamma."""
    f1 = 4.1 / (n - 2.0 * m**0.28 + 5.3) ** (1.45 * m**0.1 - 0.96)
    f2 = (2.2 / m**3.3 + 0.57) / n ** (0.58 * m**0.37 - 0.53) + 0.94 - 1.04 / m**1.9
    expected = (1.0 + f1 * math.log(gamma) ** f2) / gamma
    assert norm_by_regression(n, m, gamma) == pytest.approx(expected, rel=ROUNDINGS)


@pytest.mark.parametrize(
    ("speed", "fetch"), [(2.0, 1e5), (5.0, 1e6), (12.0, 3e4), (20.0, math.inf)]
)
def test_unified_spectrum(speed, fetch):
    """
    Elfouhaily et al. 1997: eq. 37 (inverse wave age), 3 (gamma), 34 (alpha_p), 44 (alpha_m), 31, 32
    and 40; L before the ripples too (Mobley, Ocean Optics Web Book); u* of Wu 1982.
    """
    k = np.geomspace(1e-3, 5e3, 200)
    km, cm = 370.0, 0.23
    x = G * fetch / speed**2
    age = 0.84 * math.tanh((x / 2.2e4) ** 0.4) ** -0.75 if math.isfinite(x) else 0.84
    kp = G * age**2 / speed**2
    c, cp = np.sqrt(G / k * (1.0 + k**2 / km**2)), speed / age
    gamma = 1.7 + (6.0 * math.log10(age) if age > 1.0 else 0.0)
    sigma = 0.08 * (1.0 + 4.0 / age**3)
    peak = gamma ** np.exp(-((np.sqrt(k / kp) - 1.0) ** 2) / (2.0 * sigma**2))
    moskowitz = np.exp(-1.25 * kp**2 / k**2)
    low = 0.003 * age**0.55 * cp / c * np.exp(-age / 10**0.5 * (np.sqrt(k / kp) - 1.0))
    friction = speed * math.sqrt(1e-3 * (0.8 + 0.065 * speed))
    log = math.log(friction / cm)
    alpha_m = 0.01 * max((1.0 + log) if log < 0.0 else (1.0 + 3.0 * log), 0.0)
    high = 0.5 * alpha_m * cm / c * np.exp(-0.25 * (k / km - 1.0) ** 2)
    expected = moskowitz * peak * (low + high)
    spectrum = Elfouhaily(speed=speed, fetch=fetch)
    assert spectrum.inverse_wave_age == pytest.approx(age, rel=ROUNDINGS)
    seen = k > 0.2 * kp
    assert spectrum.curvature(k)[seen] == pytest.approx(expected[seen], rel=1e-9)
    omega = np.sqrt(G * k * (1.0 + k**2 / km**2))
    peak_omega = math.sqrt(G * kp)
    # eq. 57 and 59: a0 = ln 2/4, ap = 4, am = 0.13 u*/cm
    delta = np.tanh(
        0.25 * math.log(2.0) + 4.0 * (c / cp) ** 2.5 + 0.13 * friction / cm * (cm / c) ** 2.5
    )
    # of this tension the waves of a frequency are those of the spectrum's own phase speed
    tension = constants.WATER_DENSITY * G / km**2
    spreading = ElfouhailySpreading(friction_velocity=friction, surface_tension=tension)
    there = float(spreading.delta(peak_omega * math.sqrt(1.0 + kp**2 / km**2), peak_omega))
    assert there == pytest.approx(math.tanh(0.25 * math.log(2.0) + 4.0), rel=1e-3)
    assert spreading.delta(omega, peak_omega) == pytest.approx(delta, rel=1e-3)


def test_slowest_ripples():
    """c is least at k_m, and c_m is c there, rounded to two digits (0.230 m/s)."""
    from fftocean.physics.spreading.elfouhaily import SHORT_PEAK, SLOWEST

    assert math.sqrt(2.0 * G / SHORT_PEAK) == pytest.approx(SLOWEST, abs=1e-3)
    assert pytest.approx(math.sqrt(G * 1000.0 / 0.0716), rel=2e-3) == SHORT_PEAK


@pytest.mark.parametrize(
    "x", [0.3, 0.5, 0.57, 0.9, 0.94, 0.96, 1.0, 1.04, 1.06, 1.5, 1.59, 1.61, 3.0]
)
def test_laws_of_spreading(x):
    """
    Donelan, Hamilton & Hui 1985 and Banner 1990; Mitsuyasu et al. 1975; Hasselmann, Dunckel & Ewing
    1980. Frequencies stand on both sides of every limit, 1 or 2 % away.
    """
    speed, peak = 12.0, 0.9
    age = speed * peak / G
    if x < 0.95:
        beta = 2.61 * max(x, 0.56) ** 1.3
    elif x < 1.6:
        beta = 2.28 * x**-1.3
    else:
        beta = 10.0 ** (-0.4 + 0.8393 * math.exp(-0.567 * math.log(x * x)))
    at_centre = beta / (2.0 * math.tanh(math.pi * beta))
    assert float(DonelanBanner()(x * peak, 0.0, peak)) == pytest.approx(at_centre, rel=ROUNDINGS)
    s = 11.5 * age**-2.5 * (x**5 if x <= 1.0 else x**-2.5)
    assert float(Mitsuyasu(speed=speed).exponent(x * peak, peak)) == pytest.approx(s, rel=1e-12)
    s = 6.97 * x**4.06 if x < 1.05 else 9.77 * x ** (-2.33 - 1.45 * (age - 1.17))
    assert float(Hasselmann(speed=speed).exponent(x * peak, peak)) == pytest.approx(s, rel=1e-12)
    s = 25.0 * (x**5 if x <= 1.0 else x**-2.5)
    assert float(GodaSuzuki(s_max=25.0).exponent(x * peak, peak)) == pytest.approx(s, rel=1e-12)


@pytest.mark.parametrize("x", [0.7, 0.93, 1.0, 1.06, 1.3, 4.0])
def test_jonswap_and_pierson_moskowitz(x):
    """Hasselmann et al. 1973: alpha = 0.076 (gF/U^2)^-0.22, 22 (g^2/UF)^(1/3); PM 1964: 0.877."""
    speed, fetch = 14.0, 1e5
    sea = JONSWAP.from_wind(speed=speed, fetch=fetch)
    alpha = 0.076 * (speed**2 / (fetch * G)) ** 0.22
    peak = 22.0 * (G**2 / (speed * fetch)) ** (1.0 / 3.0)
    sigma = 0.07 if x <= 1.0 else 0.09
    raised = 3.3 ** math.exp(-((x - 1.0) ** 2) / (2.0 * sigma**2))
    pm = G**2 * math.exp(-1.25 * x**-4) / (x * peak) ** 5
    assert float(sea(x * peak)) == pytest.approx(alpha * pm * raised, rel=1e-11)
    developed = PiersonMoskowitz.from_wind(speed=speed)
    assert developed.peak == pytest.approx(0.877 * G / (1.026 * speed), rel=ROUNDINGS)
    omega = x * developed.peak
    # 0.74 of the paper is 1.25 * 0.877^4 to its two digits; alpha = 8.1e-3
    assert float(developed(omega)) == pytest.approx(
        8.1e-3 * G**2 / omega**5 * math.exp(-1.25 * (developed.peak / omega) ** 4), rel=1e-11
    )
    deep = TMA(sea, depth=math.inf)
    assert float(deep(x * peak)) == pytest.approx(float(sea(x * peak)), rel=1e-12)


@pytest.mark.parametrize("ratio", [3.0, 3.55, 3.65, 4.2, 4.95, 5.05, 6.0])
def test_peak_enhancement(ratio):
    """DNV-RP-C205 (2010), 3.5.5.5, on both sides of its two limits."""
    expected = 5.0 if ratio <= 3.6 else 1.0 if ratio >= 5.0 else math.exp(5.75 - 1.15 * ratio)
    assert peak_enhancement(4.0, 2.0 * ratio) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("tp", [2.0, 7.9, 8.1, 11.5, 14.8, 15.2, 30.0])
def test_steepest_seas(tp):
    """DNV-RP-C205 (2010), 3.5.5.3: 1/15 up to 8 s, 1/25 from 15 s, linear between."""
    part = min(max((tp - 8.0) / 7.0, 0.0), 1.0)
    expected = (1.0 - part) / 15.0 + part / 25.0
    assert plausibility.steepest(tp) == pytest.approx(expected, rel=ROUNDINGS)


@pytest.mark.parametrize("speed", [5.0, 12.0, 25.0])
def test_whitecaps(speed):
    """Monahan & O'Muircheartaigh 1980: W = 3.84e-6 U^3.41."""
    assert whitecap_coverage(speed) == pytest.approx(3.84e-6 * speed**3.41, rel=ROUNDINGS)
