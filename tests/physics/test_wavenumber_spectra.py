"""
Wavenumber spectra: the same energy seen as S(omega) and F(k) in any water, and the figures that
their papers promise.
"""

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from scipy import integrate

from fftocean.constants import GRAVITY, SURFACE_TENSION
from fftocean.errors import ParameterError, SeaWarning
from fftocean.physics.dispersion import angular_frequency, group_velocity, wavenumber
from fftocean.physics.moments import moment, peak_period, significant_wave_height
from fftocean.physics.sea import Sea, WaveSystem
from fftocean.physics.spectra import Elfouhaily, FrequencySpectrum, Phillips, PiersonMoskowitz
from fftocean.physics.spreading import ElfouhailySpreading, Spreading
from fftocean.physics.spreading.elfouhaily import SHORT_PEAK, SLOWEST

WATERS = [(math.inf, 0.0), (8.0, 0.0), (math.inf, SURFACE_TENSION), (8.0, SURFACE_TENSION)]
SEVERAL = [
    *(
        Phillips(speed=u, amplitude=1e-3, cutoff=c)
        for u, c in ((0.01, 0.0), (12.0, 0.0), (12.0, 0.5), (150.0, 0.0))
    ),
    *(
        Phillips(speed=12.0, amplitude=1e-3, depth=h, surface_tension=t)
        for h, t in ((1e-6, 0.0), (3.0, SURFACE_TENSION))
    ),
    *(Elfouhaily(speed=u) for u in (0.01, 2.0, 10.0, 150.0)),
    Elfouhaily(speed=10.0, fetch=6e3),
    Elfouhaily(speed=10.0, surface_tension=0.0),
    Elfouhaily(speed=10.0, depth=0.01),
]


def _over_wavenumber(density, power, k_low, k_high):
    """
    The integral of k^power F(k) dk by trapezoids in ln k: fine enough for 1e-9 on these smooth
    curves (halving the step says so).
    """
    u = np.linspace(math.log(k_low), math.log(k_high), 100_001)
    k = np.exp(u)
    return float(integrate.trapezoid(density(k) * k ** (power + 1.0), u))


@pytest.mark.parametrize("s", SEVERAL, ids=repr)
def test_every_spectrum_is_finite_and_serves_a_sea(s):
    """
    From a thousandth to a thousand times the peak, at 0, below it and at infinity; no warning is
    raised, or the suite would fail.
    """
    assert isinstance(s, FrequencySpectrum)
    omega = np.concatenate(
        [[-1.0, 0.0, 5e-324], s.peak * np.geomspace(1e-3, 1e3, 4001), [1e300, np.inf]]
    )
    values = s(omega)
    assert values.shape == omega.shape
    assert np.all(np.isfinite(values) & (values >= 0.0))
    assert np.array_equal(values[:3], np.zeros(3))
    assert np.max(values) > 0.0
    assert s(1.0).shape == ()
    assert pickle.loads(pickle.dumps(s)) == s
    assert (
        Sea(WaveSystem(spectrum=s), depth=s.depth, surface_tension=s.surface_tension).peak == s.peak
    )


@pytest.mark.parametrize("cutoff", [0.0, 1e-6, 0.02, 1.0, 10.0])
@pytest.mark.parametrize(("depth", "tension"), WATERS)
@pytest.mark.slow
def test_phillips_is_scaled_to_the_height_in_any_water(cutoff, depth, tension):
    """
    The Bessel integral against adaptive quadrature over omega, which knows nothing of it: 1e-9 of
    Hs, whatever the dispersion.
    """
    s = Phillips.from_height(
        hs=3.0, speed=12.0, cutoff=cutoff, depth=depth, surface_tension=tension
    )
    assert significant_wave_height(s) == pytest.approx(3.0, rel=1e-9)


@pytest.mark.parametrize("speed", [3.0, 12.0, 30.0])
def test_phillips_is_pierson_moskowitz_in_deep_water(speed):
    """In deep water, l = 0: alpha = 2 pi A and omega_p = 0.8^(1/4) g/V, point by point."""
    s = Phillips(speed=speed, amplitude=1.3e-3)
    pm = PiersonMoskowitz(peak=0.8**0.25 * GRAVITY / speed, alpha=2.0 * math.pi * 1.3e-3)
    assert s.peak == pytest.approx(pm.peak, rel=1e-14)
    omega = pm.peak * np.geomspace(0.25, 100.0, 301)
    assert s(omega) == pytest.approx(pm(omega), rel=1e-12)


def test_phillips_has_the_density_that_tessendorf_wrote():
    """
    P(k) = A exp(-1/(kL)^2) k^-4 cos^2 theta exp(-k^2 l^2); over all directions k P sums to F (2001,
    eq. 23 and 24).
    """
    s = Phillips(speed=10.0, amplitude=2e-3, cutoff=0.3)
    big_l = 100.0 / GRAVITY
    for k in (0.05, 0.3, 4.0):

        def p(theta, k=k):
            return (
                2e-3
                * math.exp(-1.0 / (k * big_l) ** 2)
                / k**4
                * math.cos(theta) ** 2
                * math.exp(-((k * 0.3) ** 2))
            )

        assert s.wavenumber_density(k) == pytest.approx(
            integrate.quad(p, -math.pi, math.pi)[0] * k, rel=1e-12
        )


@pytest.mark.parametrize("cutoff", [0.0, 0.1, 5.0])
def test_phillips_peaks_where_it_says(cutoff):
    s = Phillips(speed=12.0, amplitude=1e-3, cutoff=cutoff)
    assert 2.0 * math.pi / peak_period(s) == pytest.approx(
        s.peak, rel=1e-5
    )  # the search grid is 1e-6 of the peak


@pytest.mark.parametrize("s", SEVERAL[1:3] + SEVERAL[7:11], ids=repr)
@pytest.mark.parametrize(("depth", "tension"), WATERS)
@pytest.mark.slow
def test_the_same_energy_in_wavenumber_and_in_frequency(s, depth, tension):
    """S(omega) domega/dk = F(k) and the bands agree: F does not change with the water, S does."""
    s = replace(s, depth=depth, surface_tension=tension)
    k = wavenumber(s.peak, depth, tension) * np.geomspace(0.2, 1e4, 401)
    omega = angular_frequency(k, depth, tension)
    ahead = s.wavenumber_density(k)
    assert s(omega) * group_velocity(k, depth, tension) == pytest.approx(
        ahead, rel=1e-11, abs=1e-200
    )  # 4 eps of k on slopes to 3000
    low, high = k[40], k[200]
    band = moment(s, 0, *angular_frequency(np.array([low, high]), depth, tension))
    assert band == pytest.approx(
        _over_wavenumber(s.wavenumber_density, 0.0, low, high), rel=1e-7
    )  # trapezoids of 1e-4 in ln k


def test_a_developed_sea_is_as_high_as_others_find_it():
    """
    g Hs/U10^2 of the unified spectrum lies between Pierson & Moskowitz's 0.22 and Wilson's (1965)
    0.30, at every wind.
    """
    for speed in (5.0, 20.0):
        s = Elfouhaily(speed=speed)
        scaled = GRAVITY * significant_wave_height(s) / speed**2
        assert (
            GRAVITY * significant_wave_height(PiersonMoskowitz.from_wind(speed=speed)) / speed**2
            < scaled
            < 0.30
        )
        assert s.inverse_wave_age == 0.84
        assert s.peak == pytest.approx(
            0.84 * GRAVITY / speed, rel=1e-3
        )  # g/omega_p = c_p = U/0.84, but for the surface tension
        assert 2.0 * math.pi / peak_period(s) == pytest.approx(s.peak, rel=0.05)


def test_height_and_period_grow_with_fetch_up_to_the_developed_sea():
    fetches = [6e3, 2e4, 1e5, 1e6, 4e7, math.inf]
    seas = [Elfouhaily(speed=10.0, fetch=f) for f in fetches]
    heights = [
        4.0 * math.sqrt(_over_wavenumber(s.wavenumber_density, 0.0, 1e-3, 1e4)) for s in seas
    ]
    assert heights == sorted(heights)
    assert [s.peak for s in seas] == sorted((s.peak for s in seas), reverse=True)
    assert heights[-2] == pytest.approx(heights[-1], rel=1e-2)
    # the law of fetch in its young limit is omega_p U/g = 0.84 (2.2e4)^0.3 X^-0.3 = 16.9 X^-0.3,
    # JONSWAP's 22 X^-1/3 within 5 % at X = 1000
    x = GRAVITY * 1e4 / 100.0
    assert seas[0].inverse_wave_age > Elfouhaily(speed=10.0, fetch=1e4).inverse_wave_age
    assert Elfouhaily(speed=10.0, fetch=1e4).inverse_wave_age == pytest.approx(
        22.0 * x ** (-1.0 / 3.0), rel=0.06
    )


@pytest.mark.parametrize("speed", [5.0, 7.0, 10.0, 13.5])
def test_slopes_are_those_of_the_sun_glitter(speed):
    """
    Total, up-wind and cross-wind mean-square slope against Cox & Munk (1954), clean sea: 0.003 +
    0.00512 W, 0.00316 W, 0.003 + 0.00192 W.

    Their W is at 12.5 m, 2 % above U10; they quote +-0.004, a tenth or so at these winds; the model
    is fitted by eye: 20 %.
    """
    s = Elfouhaily(speed=speed)
    total = _over_wavenumber(s.wavenumber_density, 2.0, 1e-3, 1e5)

    def directed(k):
        omega = angular_frequency(k, math.inf, SURFACE_TENSION)
        return s.wavenumber_density(k) * s.spreading.delta(omega, s.peak)

    swing = _over_wavenumber(directed, 2.0, 1e-3, 1e5)
    up, cross = (
        0.5 * total + 0.25 * swing,
        0.5 * total - 0.25 * swing,
    )  # <cos^2 theta> = 1/2 + Delta/4
    w = 1.02 * speed
    assert total == pytest.approx(0.003 + 0.00512 * w, rel=0.2)
    assert up == pytest.approx(0.00316 * w, rel=0.2)
    assert cross == pytest.approx(0.003 + 0.00192 * w, rel=0.2)


def test_curvature_has_its_second_peak_at_the_slowest_wave():
    """
    B_h is highest at k_m = 370 rad/m, where it is alpha_m/2 (1997, eq. 40): c(k_m) = sqrt(2 g/k_m)
    against the paper's rounded 0.23.
    """
    s = Elfouhaily(speed=10.0)
    k = np.geomspace(60.0, 2000.0, 20001)
    b = s.curvature(k)
    assert k[np.argmax(b)] == pytest.approx(SHORT_PEAK, rel=1e-2)
    alpha_m = 0.01 * (1.0 + 3.0 * math.log(s.friction_velocity / SLOWEST))
    assert np.max(b) == pytest.approx(0.5 * alpha_m, rel=0.02)  # B_l still adds 1 %
    assert s.friction_velocity == pytest.approx(
        math.sqrt(1.44e-3) * 10.0, rel=0.01
    )  # the paper's figure 11 at 10 m/s


def test_ripples_begin_with_the_wind():
    """
    alpha_m is 0 up to u* = c_m/e, 0.01 at u* = c_m, and grows three times as fast from there (eq.
    44); never negative.
    """
    k = np.geomspace(100.0, 1500.0, 401)
    for speed in (1.0, 2.6):
        s = Elfouhaily(speed=speed)
        assert s.friction_velocity < SLOWEST / math.e
        assert np.all(np.diff(s.curvature(k)) < 0.0)  # B_l alone, which only falls
    s = Elfouhaily(speed=2.8)
    assert s.friction_velocity > SLOWEST / math.e
    assert s.curvature(SHORT_PEAK) > Elfouhaily(speed=2.6).curvature(SHORT_PEAK)
    s = Elfouhaily(speed=6.566)
    assert s.friction_velocity == pytest.approx(SLOWEST, rel=2e-3)
    assert s.curvature(SHORT_PEAK) == pytest.approx(0.005, rel=0.03)  # B_l still adds 1 %


def test_the_long_waves_are_the_paper_written_out():
    """
    B_l by hand at a few k (eq. 2, 3, 31-34), young and old, where B_h's Gaussian has died (k < 1
    rad/m: e^-1/4 of alpha_m c_m/c).
    """
    for fetch in (math.inf, 2e4):
        s = Elfouhaily(speed=10.0, fetch=fetch)
        omega_c = s.inverse_wave_age
        kp = omega_c**2 * GRAVITY / 100.0
        sigma = 0.08 * (1.0 + 4.0 / omega_c**3)
        gamma = 1.7 if omega_c <= 1.0 else 1.7 + 6.0 * math.log10(omega_c)
        for x in (0.5, 1.0, 1.3, 4.0):
            k = x * kp
            c, cp = math.sqrt(GRAVITY / k * (1 + (k / 370) ** 2)), math.sqrt(GRAVITY / kp)
            shape = math.exp(-1.25 / x**2) * gamma ** math.exp(
                -((math.sqrt(x) - 1.0) ** 2) / (2.0 * sigma**2)
            )
            long = (
                0.5
                * 0.006
                * omega_c**0.55
                * cp
                / c
                * shape
                * math.exp(-omega_c / math.sqrt(10.0) * (math.sqrt(x) - 1.0))
            )
            alpha_m = 0.01 * (1.0 + 3.0 * math.log(s.friction_velocity / 0.23))
            short = 0.5 * alpha_m * 0.23 / c * shape * math.exp(-0.25 * (k / 370.0 - 1.0) ** 2)
            assert s.curvature(k) == pytest.approx(long + short, rel=1e-12)


def test_short_waves_leave_the_long_alone():
    """
    The L J that eq. 41 forgets: without it B_h alone would tower over the spectrum at wavelengths
    far beyond the peak.
    """
    s = Elfouhaily(speed=10.0)
    k = s.peak**2 / GRAVITY * np.array([0.1, 0.2, 0.3])
    assert np.all(s.curvature(k) < 1e-6)


@pytest.mark.parametrize("both_ways", [False, True])
@pytest.mark.parametrize("friction", [0.0, 0.38, 20.0])
def test_its_spreading_integrates_to_one(both_ways, friction):
    """At 20 frequencies from 0.3 to 30 peaks; cut at +-pi/2, where the folded form ends."""
    d = ElfouhailySpreading(friction_velocity=friction, both_ways=both_ways)
    assert isinstance(d, Spreading)
    peak = 0.82
    for x in np.geomspace(0.3, 30.0, 20):
        cuts = 0.5 * math.pi * np.arange(-2, 3)
        whole = float(
            np.sum(
                integrate.tanhsinh(
                    lambda t, x=x: d(x * peak, t, peak), cuts[:-1], cuts[1:], atol=1e-13, rtol=1e-13
                ).integral
            )
        )
        assert whole == pytest.approx(1.0, abs=1e-10)
    omega = peak * np.array([0.0, 1e-3, 1.0, 1e3, np.inf])[:, None]
    values = d(omega, np.linspace(-math.pi, math.pi, 101), peak)
    assert np.all(np.isfinite(values) & (values >= 0.0))


def test_its_spreading_is_narrow_at_both_ends_and_folds_onto_itself():
    """
    Delta is 1 at the peak (tanh(0.173 + 4) = 0.9995), falls, and rises again to the ripples (1997,
    figure 10a).

    Folding keeps D(theta) + D(theta + pi).
    """
    s = Elfouhaily(speed=10.0)
    d = s.spreading
    k = np.geomspace(s.peak**2 / GRAVITY, SHORT_PEAK, 2001)
    delta = d.delta(angular_frequency(k, math.inf, SURFACE_TENSION), s.peak)
    assert delta[0] == pytest.approx(math.tanh(math.log(2.0) / 4.0 + 4.0), abs=1e-4)
    lowest = int(np.argmin(delta))
    assert 0 < lowest < 2000
    assert np.all(np.diff(delta[:lowest]) < 0.0)
    assert np.all(np.diff(delta[lowest + 1 :]) > 0.0)
    assert delta[-1] == pytest.approx(
        math.tanh(math.log(2.0) / 4.0 + 0.13 * s.friction_velocity / SLOWEST), rel=0.02
    )
    both = replace(d, both_ways=True)
    theta = np.linspace(-3.0, 3.0, 41)
    for omega in (1.0, 9.0, 80.0):
        folded = d(omega, theta, s.peak) + d(omega, theta + math.pi, s.peak)
        assert folded == pytest.approx(
            both(omega, theta, s.peak) + both(omega, theta + math.pi, s.peak), rel=1e-12
        )


def test_still_air_is_a_flat_sea_and_says_so():
    with pytest.warns(SeaWarning, match="exactly flat"):
        phillips = Phillips(speed=0.0, amplitude=1e-3)
    with pytest.warns(SeaWarning, match="exactly flat"):
        unified = Elfouhaily(speed=0.0)
    for s in (phillips, unified):
        assert np.array_equal(s(np.array([0.0, 0.1, 1.0, 100.0])), np.zeros(4))
        assert Sea(WaveSystem(spectrum=s)).hs == 0.0


@pytest.mark.filterwarnings("ignore:a fetch of:fftocean.errors.SeaWarning")
def test_a_fetch_too_short_for_the_paper_is_refused_with_the_shortest():
    """U10/c_p = 5 is where the paper ends; the message names a fetch that is accepted."""
    with pytest.raises(
        ParameterError, match=r"fetch must be at least (\d+\.\d) m for a wind of 10 m/s"
    ) as refusal:
        Elfouhaily(speed=10.0, fetch=100.0)
    shortest = float(str(refusal.value).split("at least ")[1].split(" m")[0])
    assert Elfouhaily(speed=10.0, fetch=1.001 * shortest).inverse_wave_age == pytest.approx(
        5.0, rel=1e-3
    )


BAD = [math.nan, -math.inf, -1.0, "5", True, None, [1.0]]


@pytest.mark.parametrize("bad", BAD)
@pytest.mark.parametrize(
    "build",
    [
        *(
            lambda v, name=name: Phillips(**{"speed": 9.0, "amplitude": 1e-3, name: v})
            for name in ("speed", "amplitude", "cutoff", "depth", "surface_tension")
        ),
        *(
            lambda v, name=name: Elfouhaily(**{"speed": 9.0, name: v})
            for name in ("speed", "fetch", "depth", "surface_tension")
        ),
        *(
            lambda v, name=name: ElfouhailySpreading(**{"friction_velocity": 0.4, name: v})
            for name in ("friction_velocity", "depth", "surface_tension")
        ),
        lambda v: Phillips.from_height(hs=v, speed=12.0),
        lambda v: Phillips.from_height(hs=2.0, speed=v),
        lambda v: ElfouhailySpreading(friction_velocity=0.4, both_ways=1 if v is True else v),
    ],
)
def test_impossible_values_are_refused(build, bad):
    with pytest.raises(ParameterError, match="must be"):
        build(bad)


@pytest.mark.parametrize("huge", [math.inf, 1e308])
def test_huge_values_are_refused_or_mean_what_they_say(huge):
    """inf is deep water and an endless fetch; nothing else may be huge."""
    assert Elfouhaily(speed=10.0, fetch=huge, depth=huge)(1.0) == Elfouhaily(speed=10.0)(1.0)
    assert Phillips(speed=10.0, amplitude=1e-3, depth=huge)(1.0) == Phillips(
        speed=10.0, amplitude=1e-3
    )(1.0)
    for build in (
        lambda v: Phillips(speed=v, amplitude=1e-3),
        lambda v: Phillips(speed=9.0, amplitude=v),
        lambda v: Phillips(speed=9.0, amplitude=1e-3, cutoff=v),
        lambda v: Phillips(speed=9.0, amplitude=1e-3, surface_tension=v),
        lambda v: Elfouhaily(speed=v),
        lambda v: Elfouhaily(speed=9.0, surface_tension=v),
        lambda v: ElfouhailySpreading(friction_velocity=v),
    ):
        with pytest.raises(ParameterError, match="must be"):
            build(huge)


def test_waves_too_steep_for_their_wind_are_refused():
    with pytest.raises(
        ParameterError, match=r"2 pi amplitude at most 1.*hs = 3 m with a wind of 3 m/s"
    ):
        Phillips.from_height(hs=3.0, speed=3.0)
    with pytest.warns(SeaWarning), pytest.raises(ParameterError, match="waves that are possible"):
        Phillips.from_height(hs=3.0, speed=0.0)
    with pytest.raises(ParameterError, match="cutoff must be at most"):
        Phillips(speed=10.0, amplitude=1e-3, cutoff=11.0)
