"""
Spreading laws: each shares out exactly what there is, however narrow, and each is the curve of its
paper.
"""

import math
import pickle

import numpy as np
import pytest
from scipy import integrate

from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.physics.moments import mean_direction_and_spread
from fftocean.physics.sea import WaveSystem
from fftocean.physics.spectra import PiersonMoskowitz
from fftocean.physics.spreading import (
    Blend,
    CosineN,
    CosinePower,
    CosineSquared,
    CustomSpreading,
    DonelanBanner,
    GodaSuzuki,
    Hasselmann,
    LongCrested,
    Mitsuyasu,
    Spreading,
    SwellElongation,
    TabulatedSpreading,
    WrappedNormal,
)
from fftocean.physics.spreading.mitsuyasu import SHARPEST
from fftocean.physics.spreading.normalisation import integrals, interpolated_integrals

PEAK = 0.7
AGED = [0.84, 1.17, 3.0, 5.0]  # U/c_p, from fully developed to young


def _ripple(omega, theta, peak):
    """A function that nobody has normalised."""
    return 7.0 * np.exp(np.cos(theta - 0.4) * np.minimum(peak / omega, 9.0))


def _hat(omega, theta, _peak):
    """A top hat: two jumps."""
    return np.where(np.abs(theta) < 0.3, 1.0 + 0.0 * omega, 0.0)


LAWS = [
    *(Mitsuyasu(u * GRAVITY / PEAK) for u in AGED),
    *(Hasselmann(u * GRAVITY / PEAK) for u in AGED),
    Mitsuyasu(speed=0.0),
    Hasselmann(speed=150.0),
    GodaSuzuki(s_max=75.0),
    GodaSuzuki(s_max=1e4),
    *(CosineN(n=n) for n in (0.0, 0.5, 2.0, 7.0, 1e4)),
    *(WrappedNormal(s) for s in (0.1, 5.0, 30.0, 100.0, 180.0)),
    CustomSpreading(_ripple),
    CustomSpreading(_hat, breaks=(-0.3, 0.3)),
    *(SwellElongation(xi=xi) for xi in (0.0, 0.01, 0.1, 0.5, 1.0)),
    *(
        SwellElongation(base, xi=0.7)
        for base in (
            CosineSquared(),
            CosineN(n=0.0),
            Blend(),
            WrappedNormal(30.0),
            CosinePower(s=0.0),
        )
    ),
    SwellElongation(CustomSpreading(_hat, breaks=(-0.3, 0.3)), xi=1.0),
    SwellElongation(Mitsuyasu(speed=10.0), xi=1.0),
    SwellElongation(SwellElongation(xi=0.3), xi=0.3),
]


def _whole(law, x):
    """
    The integral over the circle by adaptive quadrature (tanh-sinh), cut at the kinks and round the
    narrowest lobe (0.002).
    """
    cuts = np.array([0.0, 0.002, 0.01, 0.1, 0.3, 0.5 * math.pi, math.pi])
    cuts = np.unique(np.concatenate([-cuts, cuts]))
    result = integrate.tanhsinh(
        lambda t: law(x * PEAK, t, PEAK), cuts[:-1], cuts[1:], atol=1e-13, rtol=1e-13
    )
    assert np.all(result.error < 1e-11)
    return float(np.sum(result.integral))


@pytest.mark.parametrize("law", LAWS, ids=repr)
@pytest.mark.slow
def test_every_law_integrates_to_one(law):
    for x in np.geomspace(0.3, 30.0, 20):
        assert _whole(law, x) == pytest.approx(1.0, abs=1e-10)


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_every_law_is_a_density_on_the_circle(law):
    """
    Finite from a thousandth to a thousand times the peak, at 0 and at infinity; not negative;
    broadcast; the same after a turn.
    """
    assert isinstance(law, Spreading)
    omega = PEAK * np.array([0.0, 1e-3, 0.3, 0.95, 1.0, 1.05, 1.6, 30.0, 1e3, np.inf])[:, None]
    theta = np.linspace(-math.pi, math.pi, 97)
    d = law(omega, theta, PEAK)
    assert d.shape == (10, 97)
    assert np.all(np.isfinite(d) & (d >= 0.0))
    assert law(PEAK, 0.3, PEAK).shape == ()
    slope = 1.0 + np.max(np.abs(np.diff(d, axis=1))) / (theta[1] - theta[0])
    inner = slice(1, -1)  # at +-pi itself a turn may land on either side
    away = np.abs(np.abs(theta) - 0.5 * math.pi) > 1e-9  # as at a jump
    assert (
        np.max(np.abs(law(omega, theta + 2.0 * math.pi, PEAK) - d)[:, inner][:, away[inner]])
        < 1e-14 * slope * 10.0
    )  # eps of 2 pi


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_every_law_survives_a_pickle_and_serves_a_system(law):
    assert pickle.loads(pickle.dumps(law)) == law
    system = WaveSystem(spectrum=PiersonMoskowitz(peak=PEAK), spreading=law, direction=30.0)
    assert system.density(PEAK, math.radians(30.0)) == pytest.approx(
        float(system.spectrum(PEAK)) * float(law(PEAK, 0.0, PEAK)), rel=1e-12
    )


@pytest.mark.parametrize("inverse_age", AGED)
def test_mitsuyasu_peaks_at_the_spectral_peak(inverse_age):
    """
    s_p = 11.5 (U/c_p)^-2.5 there; x^5 below, x^-2.5 above, as Horvath 2015 gives the law of 1975.
    """
    law = Mitsuyasu(inverse_age * GRAVITY / PEAK)
    s_p = 11.5 * inverse_age**-2.5
    x = np.array([0.5, 1.0, 2.0, 4.0])
    assert law.exponent(x * PEAK, PEAK) == pytest.approx(
        s_p * np.array([1 / 32, 1.0, 2.0**-2.5, 1 / 32]), rel=1e-13
    )
    assert law(2.0 * PEAK, 0.7, PEAK) == pytest.approx(
        float(CosinePower(s_p * 2.0**-2.5)(1.0, 0.7, PEAK)), rel=1e-13
    )


def test_goda_names_the_peak_of_mitsuyasu():
    inverse_age = 1.3
    theta = np.linspace(-3.0, 3.0, 31)
    same = GodaSuzuki(s_max=11.5 * inverse_age**-2.5)
    omega = PEAK * np.array([[0.4], [1.0], [3.0]])
    assert same(omega, theta, PEAK) == pytest.approx(
        Mitsuyasu(inverse_age * GRAVITY / PEAK)(omega, theta, PEAK), rel=1e-12
    )


def test_the_laws_of_the_wind_are_held_at_the_sharpest():
    assert np.max(Mitsuyasu(speed=0.0).exponent(np.geomspace(0.01, 100.0, 999), PEAK)) == SHARPEST
    assert GodaSuzuki(s_max=1e6).exponent(PEAK, PEAK) == SHARPEST


@pytest.mark.parametrize("inverse_age", AGED)
def test_hasselmann_splits_at_1_05(inverse_age):
    """
    6.97 x^4.06 and 9.77 x^mu of Hasselmann, Dunckel & Ewing 1980; the step between the branches is
    the paper's own, 3 %.
    """
    law = Hasselmann(inverse_age * GRAVITY / PEAK)
    mu = -2.33 - 1.45 * (inverse_age - 1.17)
    x = np.array([0.5, 1.0, 1.05 * (1 - 1e-12), 1.05 * (1 + 1e-12), 2.0])
    expected = [6.97 * 0.5**4.06, 6.97, 6.97 * 1.05**4.06, 9.77 * 1.05**mu, 9.77 * 2.0**mu]
    assert law.exponent(x * PEAK, PEAK) == pytest.approx(expected, rel=1e-10)
    if inverse_age == 1.17:
        assert 9.77 * 1.05**mu / (6.97 * 1.05**4.06) == pytest.approx(1.026, abs=1e-3)


def test_an_older_sea_is_narrower():
    """
    At twice the peak, Mitsuyasu's and Hasselmann's s both grow as the wind falls behind its waves.
    """
    for law in (Mitsuyasu, Hasselmann):
        s = [float(law(u * GRAVITY / PEAK).exponent(2.0 * PEAK, PEAK)) for u in AGED]
        assert s == sorted(s, reverse=True)


def test_cosine_n_is_not_cosine_2s():
    theta = np.linspace(-math.pi, math.pi, 101)
    n2 = CosineN(n=2.0)(1.0, theta, PEAK)
    assert n2 == pytest.approx(CosineSquared()(1.0, theta, PEAK), abs=1e-15)  # rounding of cos
    assert (
        np.max(np.abs(n2 - CosinePower(s=1.0)(1.0, theta, PEAK))) > 0.3
    )  # the mix-up that the name is there to prevent
    front = np.abs(theta) < 0.5 * math.pi
    for n in (0.0, 1.0, 4.5):
        beta = math.exp(math.lgamma(0.5 * n + 1.0) - math.lgamma(0.5 * n + 0.5)) / math.sqrt(
            math.pi
        )
        expected = np.where(front, beta * np.maximum(np.cos(theta), 0.0) ** n, 0.0)
        assert CosineN(n=n)(1.0, theta, PEAK) == pytest.approx(expected, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("spread", [0.1, 5.0, 30.0, 100.0, 180.0])
def test_wrapped_normal_equals_its_fourier_series(spread):
    """
    (1 + 2 sum e^{-n^2 sigma^2/2} cos n theta) / 2 pi, an independent sum (Mardia 1972), and from it
    the circular spread.
    """
    sigma = math.radians(spread)
    n = np.arange(1, math.ceil(9.0 / sigma) + 1)
    theta = np.linspace(-math.pi, math.pi, 8001)[:-1]
    series = (1.0 + 2.0 * np.cos(theta[::250, None] * n) @ np.exp(-0.5 * (n * sigma) ** 2)) / (
        2.0 * math.pi
    )
    d = WrappedNormal(spread)(1.0, theta, PEAK)
    assert d[::250] == pytest.approx(
        series, abs=1e-13 * float(d.max()) * 10.0
    )  # the series cancels to within its largest value
    mean, measured = mean_direction_and_spread(d, theta)
    assert mean == pytest.approx(0.0, abs=1e-9)
    assert measured == pytest.approx(
        math.degrees(math.sqrt(2.0 * (1.0 - math.exp(-0.5 * sigma**2)))), rel=1e-9, abs=1e-6
    )


class _Disguised:
    """A model of which nothing is known but its values."""

    def __init__(self, model):
        self._model = model

    def __call__(self, omega, theta, peak, /):
        return self._model(omega, theta, peak)


def test_swell_elongation_adds_its_exponent_in_closed_form():
    """
    For a power of cos(theta/2) the exponents add; the numerical norm, reached through a disguise,
    agrees.
    """
    theta = np.linspace(-3.1, 3.1, 41)
    omega = PEAK * np.array([[0.4], [0.99], [1.3], [6.0]])
    for base in (
        CosinePower(s=3.0),
        CosinePower(s=0.0),
        Mitsuyasu(speed=12.0),
        Hasselmann(speed=12.0),
    ):
        closed = SwellElongation(base, xi=0.6)(omega, theta, PEAK)
        numerical = SwellElongation(_Disguised(base), xi=0.6)(omega, theta, PEAK)
        assert numerical == pytest.approx(closed, rel=1e-12)
    s = 3.0 + 16.0 * math.tanh(1.0 / 1.3) * 0.36
    assert SwellElongation(CosinePower(s=3.0), xi=0.6)(1.3 * PEAK, 0.8, PEAK) == pytest.approx(
        float(CosinePower(s)(1.0, 0.8, 1.0)), rel=1e-13
    )


def test_swell_elongation_narrows_the_long_waves():
    """
    Circular spread falls with xi, most below the peak; xi = 0 is the base, to the bit.

    On an all-round sea xi = 1 leaves cos^32(theta/2) at the lowest frequencies, whose spread is
    sqrt(2/(s + 1)), s = 16.
    """
    theta = np.linspace(-math.pi, math.pi, 2001)[:-1]

    def spread(xi, x):
        return mean_direction_and_spread(SwellElongation(xi=xi)(x * PEAK, theta, PEAK), theta)[1]

    for x in (0.5, 1.0, 4.0):
        widths = [spread(xi, x) for xi in (0.0, 0.25, 0.5, 0.75, 1.0)]
        assert widths == sorted(widths, reverse=True)
    left = [spread(1.0, x) / spread(0.0, x) for x in (0.5, 2.0, 8.0, 30.0)]
    assert left == sorted(left)
    everywhere = SwellElongation(_Disguised(CosinePower(s=0.0)), xi=1.0)
    assert mean_direction_and_spread(everywhere(0.01 * PEAK, theta, PEAK), theta)[
        1
    ] == pytest.approx(math.degrees(math.sqrt(2.0 / 17.0)), rel=1e-9)
    assert np.array_equal(
        SwellElongation(xi=0.0)(PEAK, theta, PEAK), DonelanBanner()(PEAK, theta, PEAK)
    )


@pytest.mark.parametrize(
    "base",
    [DonelanBanner(), Blend(), CosineSquared(), WrappedNormal(0.1), Hasselmann(speed=12.0)],
    ids=repr,
)
@pytest.mark.parametrize("xi", [0.05, 1.0])
def test_the_table_of_norms_is_the_norm(base, xi):
    """
    Among 20 000 frequencies, also within 1e-9 of every step of the base, interpolation and
    quadrature differ by less than 1e-12.
    """
    law = SwellElongation(base, xi=xi)
    steps = np.array([0.56, 0.95, 1.05, 1.6])
    omega = np.unique(
        PEAK
        * np.concatenate(
            [
                np.random.default_rng(1).uniform(0.01, 60.0, 20000),
                np.geomspace(1e-3, 1e3, 999),
                *(steps * (1 + e) for e in (-1e-9, 0.0, 1e-9)),
            ]
        )
    )
    check = np.union1d(
        np.arange(0, omega.size, 301),
        np.searchsorted(
            omega, PEAK * np.concatenate([steps * (1 - 1e-9), steps, steps * (1 + 1e-9)])
        ),
    )
    assert interpolated_integrals(law._product, omega, PEAK, ())[check] == pytest.approx(
        integrals(law._product, omega[check], PEAK, ()), rel=1e-12
    )


EVERY = [
    *LAWS,
    CosineSquared(),
    CosinePower(s=3.3),
    CosinePower(s=1e6),
    DonelanBanner(),
    Blend(CosinePower(s=2.5), SwellElongation(xi=0.3), weight=0.3),
    LongCrested(),
    TabulatedSpreading(
        frequency=[0.05, 0.1, 0.3],
        direction=np.arange(0.0, 360.0, 30.0).tolist(),
        density=np.random.default_rng(3).uniform(0.1, 1.0, (3, 12)).tolist(),
    ),
]


@pytest.mark.parametrize("law", EVERY, ids=repr)
def test_a_density_depends_on_no_other_frequency_of_its_batch(law):
    """To the bit: alone, among 7 and among 3000, in any order and shape."""
    rng = np.random.default_rng(2)
    omega = PEAK * np.concatenate(
        [rng.uniform(0.02, 20.0, 2950), np.geomspace(1e-4, 1e3, 45), [0.56, 0.95, 1.05, 1.6, 1.0]]
    )
    theta = np.concatenate(
        [rng.uniform(-math.pi, math.pi, 2900), rng.uniform(-2e-3, 2e-3, 99), [0.0]]
    )
    rng.shuffle(omega)
    many = law(omega, theta, PEAK)
    assert np.array_equal(law(omega.reshape(100, 30), theta.reshape(100, 30), PEAK).ravel(), many)
    some = np.arange(11, 3000, 427)
    assert np.array_equal(law(omega[some], theta[some], PEAK), many[some])
    assert np.array_equal(
        law(omega[some][::-1, None], theta[None, some], PEAK).diagonal(offset=0),
        law(omega[some][::-1], theta[some], PEAK),
    )
    for i in (*some, 0, 2999):
        assert float(law(omega[i], theta[i], PEAK)) == many[i]


def test_a_function_that_fades_to_nothing_is_refused():
    """
    At the frequencies where it is 0 all round there is nothing to spread, wherever they stand in a
    batch.
    """
    law = CustomSpreading(lambda omega, theta, _peak: np.where(omega < 2.0, 1.0 + 0.0 * theta, 0.0))
    assert law(1.9, 0.3, PEAK) == pytest.approx(0.5 / math.pi, rel=1e-12)
    omega = np.full(999, 1.0)
    omega[700] = 2.1
    with pytest.raises(ParameterError, match="more than 0"):
        law(omega, 0.3, PEAK)


def test_custom_spreading_is_any_function_divided_by_its_integral():
    theta = np.linspace(-math.pi, math.pi, 61)
    d = CustomSpreading(lambda _o, t, _p: 3.0 * np.maximum(np.cos(t), 0.0) ** 2)(1.0, theta, PEAK)
    assert d == pytest.approx(CosineSquared()(1.0, theta, PEAK), abs=1e-14)
    assert CustomSpreading(lambda _o, _t, _p: 5.0)(1.0, theta, PEAK) == pytest.approx(
        np.full(61, 0.5 / math.pi), rel=1e-13
    )  # a scalar will do
    bessel = np.i0(PEAK / 2.0)  # von Mises: the integral of e^{kappa cos} is 2 pi I0(kappa)
    assert CustomSpreading(_ripple)(2.0, 0.4, PEAK) == pytest.approx(
        math.exp(PEAK / 2.0) / (2.0 * math.pi * bessel), rel=1e-12
    )
    assert CustomSpreading(_hat, breaks=(0.3, -0.3))(1.0, 0.1, PEAK) == pytest.approx(
        1.0 / 0.6, rel=1e-13
    )


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (_hat, "every kink named in breaks"),
        (lambda _o, t, _p: 0.0 * t, "more than 0"),
        (lambda _o, t, _p: np.cos(t), "at least 0"),
        (lambda _o, t, _p: t * np.nan, "finite"),
        (lambda _o, t, _p: np.full(np.shape(t), "x"), "real numbers"),
        (lambda _o, _t, _p: np.zeros(3), "shape"),
    ],
)
def test_a_custom_function_that_will_not_do_is_refused_in_words(function, message):
    with pytest.raises(ParameterError, match=message):
        CustomSpreading(function)(PEAK, np.linspace(-1.0, 1.0, 5), PEAK)


@pytest.mark.parametrize(
    "bad", [math.nan, math.inf, -math.inf, -1.0, "5", True, None, 1e308, [1.0]]
)
@pytest.mark.parametrize(
    "build",
    [
        lambda v: Mitsuyasu(speed=v),
        lambda v: Hasselmann(speed=v),
        lambda v: GodaSuzuki(s_max=v),
        lambda v: CosineN(n=v),
        lambda v: WrappedNormal(spread=v),
        lambda v: SwellElongation(xi=v),
        lambda v: SwellElongation(v),
        lambda v: CustomSpreading(v),
        lambda v: CustomSpreading(_hat, breaks=(0.1, "5") if v == -1.0 else (v,)),
    ],
)
def test_impossible_values_are_refused(build, bad):
    with pytest.raises(ParameterError, match="must be"):
        build(bad)


@pytest.mark.parametrize(
    "build",
    [
        lambda: CustomSpreading(float),
        lambda: SwellElongation(DonelanBanner),
        lambda: CustomSpreading(_hat, breaks="ab"),
    ],
)
def test_classes_and_strings_are_not_functions(build):
    with pytest.raises(ParameterError):
        build()


@pytest.mark.parametrize("width", [2e-3, 1e-2, 0.3])
@pytest.mark.parametrize("centre", [-2.5, 0.0, 1.1, math.pi])
def test_a_custom_bell_anywhere_has_its_norm(centre, width):
    """
    A wound normal bell round a named direction, of any width down to 0.1 degrees: its closed top,
    to the 1e-10 of the quadrature.
    """

    def bell(_omega, theta, _peak):
        return sum(
            np.exp(-0.5 * ((theta - centre + turn) / width) ** 2)
            for turn in (-2.0 * np.pi, 0.0, 2.0 * np.pi)
        )

    model = CustomSpreading(bell, breaks=[centre])
    assert float(model(1.0, centre, 1.0)) == pytest.approx(
        1.0 / (width * math.sqrt(2.0 * math.pi)), rel=1e-10
    )
