"""Laws fitted to costs that were made by them."""

import numpy as np
import pytest

from fftocean.bench.fits import cost, crossover, n_log_n, power_law, square

SIZES = np.array([4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128], dtype=float)


def noisy(values, spread, seed):
    return values * np.exp(spread * np.random.default_rng(seed).standard_normal(values.size))


@pytest.mark.parametrize("exponent", [0.5, 1.0, 2.0, -1.5])
def test_an_exact_power_is_found_exactly(exponent):
    law = power_law(SIZES, 3.0 * SIZES**exponent)
    assert (law.exponent, law.factor) == pytest.approx((exponent, 3.0), rel=1e-12)
    assert law.error < 1e-14
    assert law(10.0) == pytest.approx(3.0 * 10.0**exponent, rel=1e-12)


def test_the_standard_error_is_that_of_linear_regression():
    """scipy.stats.linregress of the logarithms: another author's least squares."""
    from scipy import stats  # which is slow to import

    y = noisy(5e-9 * SIZES**4, 0.2, 3)
    law, other = power_law(SIZES, y), stats.linregress(np.log(SIZES), np.log(y))
    assert law.exponent == pytest.approx(other.slope, rel=1e-12)
    assert law.error == pytest.approx(other.stderr, rel=1e-12)
    assert law.factor == pytest.approx(np.exp(other.intercept), rel=1e-12)
    assert law.points == SIZES.size


def test_the_standard_error_covers_the_truth_as_often_as_it_should():
    """
    Of 400 fits to noise of 10 %, two standard errors hold the true exponent in 93 % (Student's t
    with 9 degrees: 0.9234).
    """
    hits = 0
    for seed in range(400):
        law = power_law(SIZES, noisy(SIZES**2, 0.1, seed))
        hits += abs(law.exponent - 2.0) < 2.0 * law.error
    assert hits / 400 == pytest.approx(
        0.9234, abs=3.0 * np.sqrt(0.9234 * 0.0766 / 400)
    )  # three standard deviations of a binomial


def test_laws_have_their_closed_form():
    assert n_log_n(np.array([2.0, 8.0, 1024.0])).tolist() == [2.0, 24.0, 10240.0]
    assert square(np.array([3.0, 16.0])).tolist() == [9.0, 256.0]


@pytest.mark.parametrize("law", [n_log_n, square])
def test_overhead_and_factor_are_separated(law):
    work = SIZES**2
    fit = cost(work, 1e-4 + 3e-8 * law(work), law)
    assert (fit.overhead, fit.factor) == pytest.approx((1e-4, 3e-8), rel=1e-9)
    assert fit.residual < 1e-12
    assert fit(100.0) == pytest.approx(1e-4 + 3e-8 * float(law(np.array(100.0))), rel=1e-9)


def test_the_wrong_law_misfits():
    """
    A sum that grows as N^2 is no N log N, nor the other way round; noise of 5 % does not hide it.
    """
    work = SIZES**2
    for right, wrong in ((n_log_n, square), (square, n_log_n)):
        times = noisy(1e-4 + 1e-7 * right(work), 0.05, 1)
        assert cost(work, times, right).residual < 0.08
        assert cost(work, times, wrong).residual > 0.2


def test_neither_overhead_nor_factor_is_ever_negative():
    work = SIZES**2
    falling = cost(work, 1.0 / work, n_log_n)
    assert falling.factor == 0.0
    assert falling.overhead > 0.0
    steep = cost(work, work**3, n_log_n)  # a straight line through it would start below 0
    assert steep.overhead == 0.0
    assert steep.factor > 0.0


@pytest.mark.parametrize("bad", [[1.0, 2.0, 0.0], [1.0, 2.0, -1.0], [1.0, np.nan, 2.0]])
def test_values_that_are_not_positive_are_refused(bad):
    with pytest.raises(ValueError, match="positive and finite"):
        power_law([1.0, 2.0, 3.0], bad)
    with pytest.raises(ValueError, match="positive and finite"):
        crossover([1.0, 2.0, 3.0], [1.0, 1.0, 1.0], bad)


def test_two_points_are_refused():
    with pytest.raises(ValueError, match="at least three points"):
        power_law([1.0, 2.0], [1.0, 2.0])
    with pytest.raises(ValueError, match="at least three points"):
        cost([1.0, 2.0], [1.0, 2.0], square)
    with pytest.raises(ValueError, match="at least three points"):
        power_law([2.0, 2.0, 2.0], [1.0, 2.0, 3.0])


def test_the_crossing_of_two_powers_is_where_they_meet():
    """
    2 n^4 = 50 n^2 at n = 5: both are straight lines between the logarithms, so that the point
    between two sizes is exact.
    """
    cross = crossover(SIZES, 50.0 * SIZES**2, 2.0 * SIZES**4)
    assert (cross.below, cross.above) == (4.0, 6.0)
    assert cross.at == pytest.approx(5.0, rel=1e-12)


def test_a_lead_counts_only_if_it_is_kept():
    """Faster at 6 by chance, slower again at 8: the crossing is after 8."""
    champion = np.array([1.0, 3.0, 1.0, 3.0, 9.0])
    cross = crossover([4, 6, 8, 12, 16], np.full(5, 2.0), champion)
    assert (cross.below, cross.above) == (8.0, 12.0)
    assert 8.0 < cross.at < 12.0


def test_no_crossing_is_none_and_an_early_one_the_first_size():
    assert crossover([4, 8, 16], [2.0, 2.0, 2.0], [1.0, 3.0, 1.0]) is None
    assert crossover([4, 8], [1.0, 1.0], [1.0, 1.0]) is None  # as dear is not cheaper
    cross = crossover([4, 8, 16], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0])
    assert (cross.below, cross.above, cross.at) == (4.0, 4.0, 4.0)


def test_sizes_must_ascend():
    with pytest.raises(ValueError, match="sizes must be ascending"):
        crossover([4, 4, 8], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0])
