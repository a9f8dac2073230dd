"""Spreadings: integral 1 over the circle, and the shape of each."""

import math
import pickle
from dataclasses import replace
from functools import partial
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from scipy import integrate

from fftocean.errors import ParameterError
from fftocean.physics.spreading import (
    Blend,
    CosinePower,
    CosineSquared,
    DonelanBanner,
    Spreading,
    wrapped,
)
from fftocean.physics.spreading.cosine_power import cosine_2s
from fftocean.physics.spreading.donelan_banner import donelan_banner_beta

PEAK = 0.7
MODELS = [
    CosineSquared(),
    CosinePower(s=0.0),
    CosinePower(s=0.3),
    CosinePower(s=25.0),
    CosinePower(s=1e4),
    CosinePower(s=1e6),
    DonelanBanner(),
    Blend(),
    Blend(CosinePower(s=2.5), Blend(DonelanBanner(), CosineSquared(), weight=0.2), weight=0.7),
]


@pytest.mark.parametrize("model", MODELS, ids=repr)
@pytest.mark.slow
def test_every_model_integrates_to_one(model):
    """
    Adaptive quadrature, cut at the kinks (0, pi/2) and round the narrowest lobe, whose width is
    sqrt(2/s) = 1.4e-3.
    """
    cuts = [0.0, 0.002, 0.01, 0.1, 0.5 * math.pi, math.pi]
    for x in np.geomspace(0.3, 30.0, 20):
        total = 0.0
        for side in (1.0, -1.0):

            def d(theta, x=x, side=side):
                return float(model(x * PEAK, side * theta, PEAK))

            total += sum(
                integrate.quad(d, a, b, epsabs=1e-12, epsrel=1e-12)[0] for a, b in pairwise(cuts)
            )
        assert total == pytest.approx(1.0, abs=1e-10)


@pytest.mark.parametrize("model", MODELS, ids=repr)
def test_every_model_is_a_density_on_the_circle(model):
    """
    Never negative, the same to both sides, the same after a turn: to the rounding of the turn
    itself, times the slope, which is that of a lobe 1/sqrt(s) wide (save at the far side, where
    cos^0.6 is vertical).
    """
    omega = PEAK * np.array([[0.0], [1e-3], [0.5], [1.0], [5.0], [1e3]])
    theta = np.linspace(-math.pi, math.pi, 241)
    d = model(omega, theta, PEAK)
    assert d.shape == (6, 241)
    assert np.all((d >= 0.0) & np.isfinite(d))
    assert np.array_equal(d, model(omega, -theta, PEAK))
    slope = np.max(d) * max(1.0, math.sqrt(getattr(model, "s", 1.0)))
    for turns in (-3, 1, 1000):
        turned = model(omega, theta + 2.0 * math.pi * turns, PEAK)
        assert (
            np.max(np.abs(turned - d)[:, 1:-1])
            < np.spacing(2.0 * math.pi * (abs(turns) + 1)) * 4.0 * slope
        )
    assert np.all(np.argmax(d, axis=1) == 120) or model == CosinePower(s=0.0)  # toward theta = 0
    assert np.shape(model(1.0, 0.0, PEAK)) == ()
    assert model([], [], PEAK).shape == (0,)


def test_wrapped_angles_keep_their_direction():
    theta = np.linspace(-50.0, 50.0, 1001)
    w = wrapped(theta)
    assert np.all(np.abs(w) <= math.pi * (1.0 + 1e-15))
    assert np.exp(1j * w) == pytest.approx(np.exp(1j * theta), abs=2e-14)  # eps times 50


def test_cosine_squared_is_zero_behind():
    d = CosineSquared()
    assert d(1.0, 0.0, PEAK) == 2.0 / math.pi
    assert d(1.0, math.pi / 3.0, PEAK) == pytest.approx(0.5 / math.pi, rel=1e-15)
    assert np.array_equal(d(1.0, np.linspace(0.5 * math.pi, 1.5 * math.pi, 99), PEAK), np.zeros(99))


def test_cosine_power_with_whole_exponents():
    """s = 0 is all round; s = 1 is (1 + cos)/2pi; s = 2 is (1 + cos)^2/3pi."""
    theta = np.linspace(-3.0, 3.0, 61)
    assert CosinePower(s=0.0)(1.0, theta, PEAK) == pytest.approx(0.5 / math.pi, rel=1e-15)
    assert CosinePower(s=1.0)(1.0, theta, PEAK) == pytest.approx(
        (1.0 + np.cos(theta)) / (2.0 * math.pi), abs=1e-16 * 4
    )
    assert CosinePower(s=2.0)(1.0, theta, PEAK) == pytest.approx(
        (1.0 + np.cos(theta)) ** 2 / (3.0 * math.pi), abs=1e-16 * 4
    )


@pytest.mark.parametrize("s", [1e-308, 0.5, 7.0, 123.4, 1e4, 1e6])
def test_cosine_power_against_40_digits(s):
    """
    1e-11: below s = 1e4 the ratio of Gamma functions comes from their logarithms, 3e-12 off at
    worst; above, from its own series.
    """
    model = CosinePower(s=s)
    for theta in (0.0, 1e-6, 1e-3 / math.sqrt(1.0 + s), 1.0 / math.sqrt(1.0 + s), 1.0, 3.0):
        with mpmath.workdps(40):
            m = mpmath.mpf(s)
            norm = mpmath.exp(mpmath.loggamma(m + 1) - mpmath.loggamma(m + 0.5)) / (
                2 * mpmath.sqrt(mpmath.pi)
            )
            exact = float(norm * mpmath.cos(mpmath.mpf(theta) / 2) ** (2 * m))
        assert model(1.0, theta, PEAK) == pytest.approx(exact, rel=1e-11, abs=1e-300)


def test_cosine_power_at_the_far_side():
    """cos(pi/2) is 6e-17, its logarithm finite: nothing there, no warning, for any exponent."""
    for s in (1e-3, 1.0, 1e4, 1e6):
        assert 0.0 <= CosinePower(s=s)(1.0, math.pi, PEAK) <= (0.16 if s < 1.0 else 1e-30)
    several = cosine_2s(np.array([0.0, 1.0, 1e6]), 0.3)
    assert several == pytest.approx(
        [float(CosinePower(s=s)(1.0, 0.3, PEAK)) for s in (0.0, 1.0, 1e6)], rel=1e-15
    )


def test_donelan_banner_is_sech_squared():
    """At the peak beta = 2.28: D = beta/(2 tanh(pi beta)) sech^2(beta theta)."""
    theta = np.linspace(-math.pi, math.pi, 91)
    expected = 2.28 / (2.0 * math.tanh(2.28 * math.pi)) / np.cosh(2.28 * theta) ** 2
    assert DonelanBanner()(PEAK, theta, PEAK) == pytest.approx(expected, rel=1e-13)


def test_donelan_banner_coefficients():
    """The formulas as published, one point each; far above the peak beta falls to 10^-0.4."""
    x = np.array([0.56, 0.8, 0.949, 0.951, 1.2, 1.599, 1.601, 3.0, 1e3, 1e6])
    beta = donelan_banner_beta(x)
    low, middle, high = x[:3], x[3:6], x[6:]
    assert beta[:3] == pytest.approx(2.61 * low**1.3, rel=1e-14)
    assert beta[3:6] == pytest.approx(2.28 * middle**-1.3, rel=1e-14)
    assert beta[6:] == pytest.approx(
        10.0 ** (-0.4 + 0.8393 * np.exp(-0.567 * np.log(high**2))), rel=1e-14
    )
    assert beta[-1] == pytest.approx(10.0**-0.4, rel=1e-6)


@pytest.mark.parametrize(("x", "step"), [(0.95, 2e-3), (1.6, 1e-4)])
def test_donelan_banner_joins_up(x, step):
    """
    The published coefficients leave steps of 0.18 % at 0.95 and 0.008 % at 1.6; the formulas'
    slopes add 1e-9.
    """
    below, above = donelan_banner_beta(np.array([x * (1.0 - 1e-9), x * (1.0 + 1e-9)]))
    assert abs(above / below - 1.0) < step
    grid = donelan_banner_beta(np.geomspace(1e-3, 1e3, 100_001))
    assert (
        np.max(np.abs(np.diff(np.log(grid)))) < 2e-3
    )  # and nowhere else: a step of 1.4e-4 in ln x, a slope of 1.3


def test_donelan_banner_is_held_below():
    """The data end at 0.56: below it the formula would go on to beta = 0, waves all round."""
    x = np.array([-1.0, 0.0, 1e-3, 0.3, 0.55, 0.56])
    assert np.array_equal(donelan_banner_beta(x), np.full(6, 2.61 * 0.56**1.3))
    theta = np.linspace(-math.pi, math.pi, 25)
    assert np.array_equal(
        DonelanBanner()(0.1 * PEAK, theta, PEAK), DonelanBanner()(0.56 * PEAK, theta, PEAK)
    )


def test_donelan_banner_narrows_toward_the_peak():
    omega = PEAK * np.array([0.5, 0.7, 0.949])
    assert np.all(np.diff(DonelanBanner()(omega, 0.0, PEAK)) > 0.0)
    assert np.all(np.diff(DonelanBanner()(PEAK * np.array([1.0, 1.5, 2.0, 5.0]), 0.0, PEAK)) < 0.0)


def test_blend_ends_are_its_models():
    omega, theta = PEAK * np.array([[0.5], [1.0], [3.0]]), np.linspace(-4.0, 4.0, 33)
    first, second = DonelanBanner(), CosinePower(s=8.0)
    assert np.array_equal(
        Blend(first, second, weight=0.0)(omega, theta, PEAK), first(omega, theta, PEAK)
    )
    assert np.array_equal(
        Blend(first, second, weight=1.0)(omega, theta, PEAK), second(omega, theta, PEAK)
    )
    half = Blend(first, second)(omega, theta, PEAK)
    assert half == pytest.approx(
        0.5 * (first(omega, theta, PEAK) + second(omega, theta, PEAK)), rel=1e-15
    )
    quarter = Blend(first, second, weight=0.25)(omega, theta, PEAK)
    assert quarter == pytest.approx(
        0.75 * first(omega, theta, PEAK) + 0.25 * second(omega, theta, PEAK), rel=1e-15
    )


@pytest.mark.parametrize("bad", [5, None, "cos2", DonelanBanner])
def test_only_models_can_be_blended(bad):
    with pytest.raises(
        ParameterError, match=r"first must be callable as D\(omega, theta, peak\), got "
    ):
        Blend(bad)
    with pytest.raises(
        ParameterError, match=r"second must be callable as D\(omega, theta, peak\), got "
    ):
        Blend(DonelanBanner(), bad)


@pytest.mark.parametrize("model", MODELS, ids=repr)
def test_models_are_frozen_values(model):
    assert isinstance(model, Spreading)
    for twin in (replace(model), pickle.loads(pickle.dumps(model))):
        assert twin == model
        assert hash(twin) == hash(model)
    for name in ("s", "weight", "ss"):
        with pytest.raises((AttributeError, TypeError)):
            setattr(model, name, 1.0)


def test_a_plain_function_is_no_model():
    """
    Nobody has seen to its integral: 1 everywhere would deliver 2 pi times the energy.
    CustomSpreading does see to it.
    """

    def everywhere(omega, theta, _peak):
        return 1.0 + 0.0 * omega + 0.0 * theta

    for f in (everywhere, partial(everywhere), np.add.reduce):
        with pytest.raises(
            ParameterError, match=r"first must integrate to 1 .* CustomSpreading\(f\)"
        ):
            Blend(f, CosineSquared())
