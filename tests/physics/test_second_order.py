"""Second-order interaction of two waves, and the skewness of a sea."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from scipy import integrate

import fftocean as fo
from fftocean.constants import GRAVITY as g
from fftocean.gerstner import bound
from fftocean.physics.second_order import Components, interaction, skewness
from fftocean.statistics import sea_skewness

TABLE = Path(__file__).resolve().parents[1] / "data" / "skewness.csv"
ROWS = list(csv.DictReader(TABLE.read_text(encoding="utf-8").splitlines()))


def components(kx, ky, depth):
    kx, ky = np.asarray(kx, dtype=float), np.asarray(ky, dtype=float)
    k = np.hypot(kx, ky)
    bed = 1.0 if math.isinf(depth) else np.tanh(k * depth)
    return Components(kx, ky, np.sqrt(g * k * bed))


@pytest.mark.parametrize("kh", [0.3, 0.5, 1.0, 2.0, 5.0, math.inf])
def test_one_wave_is_that_of_stokes(kh):
    """C = k/2 (3 - t^2)/t^3, t = tanh kh: Stokes 1847. The tolerance is 4 roundings."""
    k, angle = 1.7, 0.6
    wave = components([k * math.cos(angle)], [k * math.sin(angle)], kh / k)
    t = math.tanh(kh)
    stokes = 0.5 * k * (3.0 - t * t) / t**3
    assert interaction(wave, wave, kh / k).elevation[0] == pytest.approx(stokes, rel=4e-15)
    with_itself = interaction(wave, wave.conjugate, kh / k)
    assert [float(part[0]) for part in with_itself] == [0.0, 0.0, 0.0]  # no mean


@pytest.mark.parametrize(("k1", "k2"), [(1.0, 1.3), (1.0, 4.0), (0.2, 7.0), (5.0, 0.3)])
def test_collinear_waves_in_deep_water(k1, k2):
    """
    C+ = (k1 + k2)/2 and C- = -|k1 - k2|/2: Longuet-Higgins 1963. A choppy surface has all of the
    sums; of the differences min(k1, k2) is left, the set-down of groups.
    """
    one, two = components([k1], [0.0], math.inf), components([k2], [0.0], math.inf)
    plus, minus = interaction(one, two, math.inf), interaction(one, two.conjugate, math.inf)
    rounding = 1e-14 * (k1 + k2)
    assert abs(plus.elevation[0] - 0.5 * (k1 + k2)) < rounding
    assert abs(minus.elevation[0] + 0.5 * abs(k1 - k2)) < rounding
    assert abs(plus.elevation[0] - plus.displaced[0]) < rounding
    assert abs(minus.elevation[0] - minus.displaced[0] - min(k1, k2)) < rounding


@pytest.mark.parametrize("depth", [math.inf, 4.0, 0.4])
def test_crossing_waves_are_those_of_dalzell(depth):
    """
    Dalzell's coefficients in cosines are another algebra. In shallow water they are 1e3 times as
    large as the wavenumbers, of terms that nearly cancel.
    """
    rng = np.random.default_rng(4)
    waves = components(*rng.normal(size=(2, 12)), depth)
    k = np.hypot(waves.kx, waves.ky)
    rows = waves.part((slice(None), None))
    cosine = (rows.kx * waves.kx + rows.ky * waves.ky) / (k[:, None] * k)
    plus, minus = bound.coefficients(k[:, None], k[None, :], cosine, depth)
    others = ~np.eye(k.size, dtype=bool)
    scale = k[:, None] + k + np.abs(plus)
    ours = interaction(rows, waves, depth).elevation
    assert np.max(np.abs(ours - plus) / scale) < 1e-12
    ours = interaction(rows, waves.conjugate, depth).elevation
    assert np.max((np.abs(ours - minus) / scale)[others]) < 1e-12


def test_opposite_components_are_conjugate():
    """A field is real: C does not change its sign with both components, b does."""
    rng = np.random.default_rng(5)
    one, two = (
        components(*rng.normal(size=(2, 20)), 3.0),
        components(*rng.normal(size=(2, 20)), 3.0),
    )
    pair, opposite = interaction(one, two, 3.0), interaction(one.conjugate, two.conjugate, 3.0)
    assert np.array_equal(pair.elevation, opposite.elevation)
    assert np.array_equal(pair.displaced, opposite.displaced)
    assert np.array_equal(pair.potential, -opposite.potential)


def rogue_sea(row):
    """The sea of one row as that package discretises it: 58 frequencies, 24 directions."""
    hs, tp, gamma = (float(row[name]) for name in ("Hs", "Tp", "gamma"))
    width, depth = float(row["cos2N_width_deg"]), float(row["depth_m"])
    f = np.linspace(0.03, 0.6, 58) * 8.0 / tp
    x = f * tp
    s = np.where(x <= 1.0, 0.07, 0.09)
    density = x**-5.0 * np.exp(-1.25 * x**-4.0) * gamma ** np.exp(-((x - 1.0) ** 2) / 2.0 / s**2)
    density *= (hs / 4.0) ** 2 / np.trapezoid(density, f)
    theta = np.radians(np.arange(-180.0, 180.0, 15.0))
    power = 2.0 / np.radians(width) ** 2 - 1.0
    spread = np.maximum(np.cos(theta / 2.0) ** 2, 1e-300) ** power
    variance = (density * np.gradient(f))[:, None] * (spread / spread.sum())
    k = fo.dispersion.wavenumber(2.0 * np.pi * f, depth)
    waves = components(k[:, None] * np.cos(theta), k[:, None] * np.sin(theta), depth)
    return waves.part(variance > 1e-5 * variance.max()), variance[variance > 1e-5 * variance.max()]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: "-".join(row.values()))
def test_skewness_is_that_of_roguewavespectrum(row):
    """
    Its values are of its own discretisation, and its directional spreading is cut: 2 %.
    """
    waves, variance = rogue_sea(row)
    found = skewness(waves, variance, float(row["depth_m"]))
    assert found == pytest.approx(float(row["skewness_2nd_order"]), rel=0.02)


def test_skewness_of_a_long_crested_sea():
    """
    In deep water C+ + C- = min(k, k'): the skewness is 6 int int_{k' > k} k S S' / m0^1.5, here by
    adaptive quadrature of frequency; classes of frequencies 1.1 wide are 0.4 % off.
    """
    spectrum = fo.JONSWAP.from_sea_state(hs=3.0, tp=8.0, gamma=3.3)
    sea = fo.Sea(fo.WaveSystem(spectrum=spectrum, spreading=fo.LongCrested()))
    above = np.linspace(0.3, 12.0, 40001)
    density = spectrum(above)
    rest = integrate.cumulative_simpson(density[::-1], dx=above[1] - above[0], initial=0.0)[::-1]
    m0 = rest[0]
    truth = 6.0 * integrate.simpson(above**2 / g * density * rest, x=above) / m0**1.5
    assert truth == pytest.approx(0.1476, abs=2e-4)
    assert sea_skewness(sea) == pytest.approx(truth, rel=5e-3)


@pytest.mark.filterwarnings("ignore::fftocean.SeaWarning")
def test_a_calm_sea_has_no_skewness():
    waves = components([1.0], [0.0], math.inf)
    assert skewness(waves, np.zeros(1), math.inf) == 0.0
    assert sea_skewness(fo.Sea.from_wind(speed=0.0, fetch=1e4)) == 0.0
