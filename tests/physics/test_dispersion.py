"""Dispersion relation: limits, 40-digit arithmetic, and the frequencies of a loop."""

import math

import mpmath
import numpy as np
import pytest

from fftocean.constants import GRAVITY, SURFACE_TENSION, WATER_DENSITY
from fftocean.errors import ParameterError
from fftocean.physics.dispersion import (
    LARGEST,
    angular_frequency,
    group_to_phase_speed,
    group_velocity,
    loop_cycles,
    wavenumber,
)

EPS = float(np.finfo(float).eps)
DEPTHS = [1e-6, 1e-3, 0.1, 1.0, 15.0, 4000.0, math.inf]
TENSIONS = [0.0, SURFACE_TENSION]


def test_deep_water_is_the_root_of_g_k():
    """tanh kh is 1 in double precision from kh = 19.1 on: the limit is reached, not approached."""
    k = np.geomspace(1e-6, 1e6, 97)
    assert np.array_equal(angular_frequency(k), np.sqrt(GRAVITY * k))
    assert np.array_equal(angular_frequency(k[k > 0.02], 1000.0), np.sqrt(GRAVITY * k[k > 0.02]))


def test_shallow_water_is_not_dispersive():
    """omega/k -> sqrt(g h) (1 - (kh)^2/6): the series of tanh, whose next term is 19/360 (kh)^4."""
    k = np.geomspace(1e-9, 1e-3, 31)
    kh = 10.0 * k
    # 4 eps: product, root and quotient each round once or twice.
    series = 1.0 - kh**2 / 6.0 + 19.0 * kh**4 / 360.0
    assert angular_frequency(k, 10.0) / k == pytest.approx(
        math.sqrt(GRAVITY * 10.0) * series, rel=4 * EPS
    )


def test_the_shortest_waves_are_capillaries():
    """omega^2 -> (sigma/rho) k^3; gravity is a part g rho / (sigma k^2) of it, 1e-9 at k = 1e7."""
    k = 1e7
    capillary = math.sqrt(SURFACE_TENSION / WATER_DENSITY * k**3)
    assert angular_frequency(k, surface_tension=SURFACE_TENSION) == pytest.approx(
        capillary, rel=1e-9
    )
    assert group_to_phase_speed(k, surface_tension=SURFACE_TENSION) == pytest.approx(1.5, abs=1e-8)


def test_slowest_wave_on_water():
    """
    Gravity and tension balance at k = sqrt(g rho/sigma): the phase speed is least, (4 g
    sigma/rho)^(1/4) = 23 cm/s  (Lamb, art. 267).
    """
    k = math.sqrt(GRAVITY * WATER_DENSITY / SURFACE_TENSION)
    speed = (4.0 * GRAVITY * SURFACE_TENSION / WATER_DENSITY) ** 0.25
    assert angular_frequency(k, surface_tension=SURFACE_TENSION) / k == pytest.approx(
        speed, rel=4 * EPS
    )
    assert group_velocity(k, surface_tension=SURFACE_TENSION) == pytest.approx(
        speed, rel=4 * EPS
    )  # least: the two speeds agree
    assert speed == pytest.approx(0.23, abs=0.005)


def oracle(omega: float, near: float, depth: float, tension: float) -> mpmath.mpf:
    """
    k(omega) to 40 digits: Newton on the relation itself, in logarithms as k spans thirty decades.
    """
    w, h, t = mpmath.mpf(omega), mpmath.mpf(depth), mpmath.mpf(tension) / mpmath.mpf(WATER_DENSITY)

    def misfit(log_k):
        k = mpmath.exp(log_k)
        return mpmath.log((GRAVITY * k + t * k**3) * mpmath.tanh(k * h)) - 2 * mpmath.log(w)

    # The misfit itself carries 41 digits of numbers as large as 100: 1e-37 is as far as the
    # residual can fall.
    return mpmath.exp(mpmath.findroot(misfit, mpmath.log(near), tol=1e-74))


@pytest.mark.parametrize("tension", TENSIONS)
@pytest.mark.parametrize("depth", DEPTHS)
def test_wavenumber_against_40_digits(depth, tension):
    omega = np.geomspace(1e-5, 1e5, 41)
    found = wavenumber(omega, depth, tension)
    with mpmath.workdps(40):
        error = [
            abs(mpmath.mpf(k) / oracle(w, k, depth, tension) - 1)
            for w, k in zip(omega.tolist(), found.tolist(), strict=True)
        ]
    assert max(error) <= 4 * EPS


@pytest.mark.parametrize("tension", TENSIONS)
@pytest.mark.parametrize("depth", DEPTHS)
def test_round_trip(depth, tension):
    k = np.geomspace(1e-12, 1e12, 193)
    assert wavenumber(angular_frequency(k, depth, tension), depth, tension) == pytest.approx(
        k, rel=1e-12
    )


@pytest.mark.parametrize("tension", TENSIONS)
@pytest.mark.parametrize("depth", DEPTHS)
def test_group_velocity_is_the_slope(depth, tension):
    """
    A central difference of omega, whose own error is (step^2/6) k^3 omega'''/(k omega'): measured,
    1.79 times step^2/6 where it is worst (and a quarter of that at half the step). The step of 2e-4
    makes it 1.2e-8, and its round-off is eps/2e-4 = 1e-12.
    """
    k = np.geomspace(1e-6, 1e6, 97)
    h = 2e-4 * k
    slope = (
        angular_frequency(k + h, depth, tension) - angular_frequency(k - h, depth, tension)
    ) / (2.0 * h)
    assert group_velocity(k, depth, tension) == pytest.approx(slope, rel=1.3e-8)


@pytest.mark.parametrize("depth", DEPTHS)
def test_group_speed_lies_between_half_and_three_halves_of_the_phase_speed(depth):
    k = np.geomspace(1e-20, 1e20, 401)
    assert np.all((group_to_phase_speed(k, depth) >= 0.5) & (group_to_phase_speed(k, depth) <= 1.0))
    with_tension = group_to_phase_speed(k, depth, SURFACE_TENSION)
    assert np.all(
        (with_tension >= 0.5) & (with_tension <= 2.0)
    )  # 3/2 is the deep capillary, 2 the shallow one (k^2 sqrt(h sigma/rho))
    assert (
        group_to_phase_speed(0.0, 10.0) == 1.0
    )  # the longest wave in any finite depth is a shallow one


def three_pieces(k: float, depth: float) -> float:
    """
    The erratum: shallow, transitional and deep formulas, switched at h = lambda/20 and lambda/2 as
    textbooks print them.
    """
    part = depth * k / (2.0 * math.pi)  # h / lambda
    return math.sqrt(
        GRAVITY * k * (k * depth if part < 0.05 else math.tanh(k * depth) if part < 0.5 else 1.0)
    )


@pytest.mark.parametrize(("part", "jump"), [(0.05, 0.0159), (0.5, 0.0018)])
def test_three_piece_dispersion_jumps_and_ours_does_not(part, jump):
    depth = 10.0
    k = 2.0 * math.pi * part / depth
    left, right = k * (1.0 - 1e-9), k * (1.0 + 1e-9)
    assert abs(three_pieces(right, depth) / three_pieces(left, depth) - 1.0) > jump
    ours = angular_frequency([left, right], depth)
    assert 0.0 < ours[1] / ours[0] - 1.0 < 2.1e-9  # the slope of ln omega (ln k) is at most 1


@pytest.mark.parametrize("tension", TENSIONS)
@pytest.mark.parametrize("depth", DEPTHS)
def test_omega_only_rises(depth, tension):
    """100 001 steps of 0.06 %: a switch of formula anywhere would show as a fall or a jump."""
    k = np.geomspace(1e-12, 1e14, 100_001)
    step = np.diff(np.log(angular_frequency(k, depth, tension))) / np.diff(np.log(k))
    assert np.all(
        (step > 0.5 - 1e-9) & (step < 2.0 + 1e-9)
    )  # 1e-9: round-off of 1e-13 in ln omega over a step of 6e-4


def test_zero_and_shapes():
    assert angular_frequency(0.0) == 0.0
    assert angular_frequency(0.0, 10.0) == 0.0
    assert np.array_equal(wavenumber([0.0, 0.0], 10.0), [0.0, 0.0])
    assert wavenumber(np.ones((2, 3)), 10.0).shape == (2, 3)
    assert np.shape(wavenumber(1.0, 10.0, 0.07)) == ()
    assert angular_frequency([], 10.0).shape == wavenumber([], 10.0).shape == (0,)
    assert angular_frequency(np.float32(2.0)) == angular_frequency(2) == angular_frequency(2.0)


@pytest.mark.parametrize(
    "function", [angular_frequency, group_velocity, group_to_phase_speed, wavenumber]
)
def test_no_input_in_range_overflows(function):
    """
    Warnings are errors here: neither the ends of the range nor the faintest tension may raise one,
    or give anything but a number.
    """
    ends = [1e-150, 1e-12, 1.0, 1e12, LARGEST]
    for depth in (1e-6, 1e308, math.inf):
        for tension in (0.0, 1e-308, 1.0):
            assert np.all(np.isfinite(function(ends, depth, tension)))


@pytest.mark.parametrize(
    "function", [angular_frequency, group_velocity, group_to_phase_speed, wavenumber]
)
@pytest.mark.parametrize(
    "bad", [-1.0, math.nan, math.inf, -math.inf, 1e308, "5", True, None, 1j, [1.0, -1e-3]]
)
def test_what_is_no_wavenumber_is_refused(function, bad):
    name = "omega" if function is wavenumber else "k"
    with pytest.raises(
        ParameterError, match=rf"{name}(\[1\])? must be .*between 0 and 1e\+48 rad/.*, got "
    ):
        function(bad, 10.0)


@pytest.mark.parametrize(
    "function", [angular_frequency, group_velocity, group_to_phase_speed, wavenumber]
)
@pytest.mark.parametrize("bad", [-1.0, 0.0, math.nan, -math.inf, 1e-308, "5", True, None])
def test_what_is_no_depth_is_refused(function, bad):
    with pytest.raises(
        ParameterError, match=r"depth must be .*at least 1e-06 m \(inf is allowed\), got "
    ):
        function(1.0, bad)
    if bad != 0.0 and bad != 1e-308:
        with pytest.raises(
            ParameterError, match=r"surface_tension must be .*between 0 and 1 N/m, got "
        ):
            function(1.0, 10.0, bad)


def test_no_group_velocity_at_rest():
    with pytest.raises(ParameterError, match="k must be more than 0 rad/m"):
        group_velocity([1.0, 0.0])


def test_loop_cycles_are_the_nearest_whole_turns():
    """
    |n 2 pi/T - omega| <= pi/T, save for waves slower than half a turn, which are given a whole one.
    """
    period = 16.0
    omega = np.concatenate([[0.0], np.geomspace(1e-6, 1e6, 2001)])
    n = loop_cycles(omega, period)
    assert n.dtype == np.int64
    assert np.all(n[omega * period < math.pi] == 1)
    resolved = omega * period >= math.pi
    assert (
        np.max(np.abs(n - omega * period / (2.0 * math.pi))[resolved]) <= 0.5 + 1e-9
    )  # 1e-9: eps times 2.5e6 turns
    assert np.array_equal(
        loop_cycles(2.0 * math.pi / period * np.arange(1, 9), period), np.arange(1, 9)
    )
    assert loop_cycles(1.9 * 2.0 * math.pi / period, period) == 2  # truncation would give 1


@pytest.mark.parametrize("bad", [0.0, -5.0, math.nan, math.inf, "5", True, None, 1e308, 1e-308])
def test_loop_cycles_refuses_what_is_no_period(bad):
    with pytest.raises(ParameterError, match=r"period must be .*between 0\.01 and 1e\+09 s, got "):
        loop_cycles([1.0], bad)


def test_loop_cycles_refuses_more_turns_than_it_can_count():
    assert loop_cycles(1e10, 1e9) == 1591549430918953472  # the double nearest to 1e19 / 2 pi
    with pytest.raises(
        ParameterError,
        match=r"omega must make fewer than 2\^63 cycles in a loop, got 1.59155e\+20 in 1e\+09 s",
    ):
        loop_cycles([1.0, 1e12], 1e9)
