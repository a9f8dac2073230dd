"""Contenders are compared before they are timed, in the time that was asked for."""

import numpy as np
import pytest

from fftocean import host
from fftocean.bench import charts, machine, quick
from fftocean.bench.fits import cost, n_log_n, power_law


@pytest.fixture
def races(monkeypatch):
    """Take the place of the timing; the list grows by what would have been timed."""
    made = []
    monkeypatch.setattr(quick, "race", lambda *what, **how: made.append((what, how)) or [])
    monkeypatch.setattr(host, "cores", lambda: 2)
    return made


@pytest.mark.parametrize("part", [(quick.frames, lambda: None), (quick.direct,)])
def test_other_water_is_not_timed(races, monkeypatch, part):
    def differs(*_, **__):
        raise AssertionError("other water")

    monkeypatch.setattr(quick, "require_same_water", differs)
    with pytest.raises(AssertionError, match="other water"):
        part[0](16, 0.0, *part[1:])
    assert not races


def test_shares_of_the_time_add_up(races):
    quick.frames(16, 10.0, lambda: None)
    assert len(races) == 2
    assert sum(how["seconds"] for _, how in races) == pytest.approx(10.0, rel=1e-12)


def test_columns_of_other_lengths_are_refused():
    x = np.arange(4.0, 9.0)
    with pytest.raises(ValueError, match="three points"):
        cost(x, x[:4], n_log_n)
    with pytest.raises(ValueError, match="three points"):
        power_law(x, x[:4])


def test_lists_of_cores_are_counted():
    """The list of Linux, as of cpuset(7)."""
    assert [machine._count(s) for s in ("0", "0-3", "0-3,8", "0-1,4-5\n", "")] == [1, 4, 5, 4, 0]


@pytest.mark.parametrize(
    ("value", "shown"),
    [(0.5, "0.5"), (1.0, "1"), (9.99, "9.99"), (9.996, "10.0"), (12.34, "12.3"), (99.4, "99.4")],
)
def test_ratios_have_two_digits_or_three(value, shown):
    assert charts._two(value).rstrip("0").rstrip(".") == shown.rstrip("0").rstrip(".")
    assert charts._two(99.6) == "100"
    assert charts._two(1234.5) in ("1,234", "1,235")
