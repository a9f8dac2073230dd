"""
Dispersion relation of surface gravity-capillary waves: omega(k), d omega/dk, k(omega), and the
frequencies of a loop.
"""

import math

import numpy as np

from fftocean.arrays import Integer, Real, RealLike
from fftocean.constants import GRAVITY, WATER_DENSITY
from fftocean.errors import ParameterError
from fftocean.limits import DEPTH, LOOP, SURFACE_TENSION, Quantity

LARGEST = 1e48
"""
No wavenumber [rad/m] or frequency [rad/s] beyond this: the sixth power of a frequency must stay
within double precision.
"""


WAVENUMBER = Quantity("rad/m", 0.0, LARGEST)
FREQUENCY = Quantity("rad/s", 0.0, LARGEST)


def _water(depth: float, surface_tension: float) -> float:
    """Return the kinematic surface tension sigma/rho [m^3/s^2] of checked water."""
    DEPTH.check("depth", depth)
    return SURFACE_TENSION.check("surface_tension", surface_tension) / WATER_DENSITY


def _times_depth(k: Real, depth: float) -> Real:
    """Return k h, with 0 h = 0 also in infinitely deep water."""
    if math.isinf(depth):
        return np.where(k > 0.0, np.inf, 0.0)
    with np.errstate(over="ignore"):  # inf is as deep as it gets
        return k * depth


def _frequency(k: Real, depth: float, kinematic_tension: float) -> Real:
    """Return omega(k), unchecked."""
    omega: Real = np.sqrt(
        (GRAVITY * k + kinematic_tension * k**3) * np.tanh(_times_depth(k, depth))
    )
    return omega


def _speed_ratio(k: Real, depth: float, kinematic_tension: float) -> Real:
    """Return (d omega/dk) / (omega/k), unchecked."""
    s = kinematic_tension * k**2
    # sinh overflows past 710; x/sinh x is 0 long before
    x2 = 2.0 * np.minimum(_times_depth(k, depth), 350.0)
    ratio: Real = 0.5 * (
        (GRAVITY + 3.0 * s) / (GRAVITY + s)
        + np.divide(x2, np.sinh(x2), out=np.ones_like(x2), where=x2 > 0.0)
    )
    return ratio


def turns_per_second(omega: Real) -> Real:
    """
    Return omega / 2 pi [1/s], divided in extended precision where the machine has it: the nearest
    double. The shape is that of omega.
    """
    cycles: Real = (
        omega.astype(np.longdouble) / np.longdouble("6.283185307179586476925286766559")
    ).astype(np.float64)
    return cycles


def angular_frequency(k: RealLike, depth: float = math.inf, surface_tension: float = 0.0) -> Real:
    """
    Return omega(k):  omega^2 = (g k + (sigma/rho) k^3) tanh(k h).

    Args:
        k: wavenumber magnitude, any shape, [rad/m], >= 0.
        depth: still-water depth h [m]; `math.inf` is deep water.
        surface_tension: sigma [N/m]; 0 leaves capillary waves out, `constants.SURFACE_TENSION` is
            sea water.

    Returns:
        Same shape as `k`, [rad/s].

    Raises:
        ParameterError: a wavenumber, depth or tension out of its range (`LARGEST`, `limits.DEPTH`,
            `limits.SURFACE_TENSION`).

    Source: Lamb, Hydrodynamics (1932), art. 228 and 267.
    Pinned by tests/physics/test_dispersion.py: deep and shallow limits, and the round trip through
    `wavenumber`.
    """
    kinematic_tension = _water(depth, surface_tension)
    return _frequency(WAVENUMBER.check_array("k", k), depth, kinematic_tension)


def group_to_phase_speed(
    k: RealLike, depth: float = math.inf, surface_tension: float = 0.0
) -> Real:
    """
    Return (d omega/dk) / (omega/k) [-]: 1/2 for deep gravity waves, 1 for shallow ones, 3/2 for
    capillaries (2 in shallow water).

    With x = k h and s = (sigma/rho) k^2:  1/2 ((g + 3 s)/(g + s) + 2x / sinh 2x).

    The shape is that of k.
    """
    kinematic_tension = _water(depth, surface_tension)
    return _speed_ratio(WAVENUMBER.check_array("k", k), depth, kinematic_tension)


def group_velocity(k: RealLike, depth: float = math.inf, surface_tension: float = 0.0) -> Real:
    """
    Return d(omega)/dk, the speed at which wave energy travels.

    Args:
        k: wavenumber magnitude, any shape, [rad/m], > 0.
        depth: still-water depth [m]; `math.inf` is deep water.
        surface_tension: sigma [N/m].

    Returns:
        Same shape as `k`, [m/s].

    Raises:
        ParameterError: as `angular_frequency`, and for k = 0, where deep water has no finite
            answer.

    Source: Lamb, Hydrodynamics (1932), art. 236.
    Pinned by tests/physics/test_dispersion.py, against a central difference of `angular_frequency`.
    """
    k = WAVENUMBER.check_array("k", k)
    if np.any(k == 0.0):
        raise ParameterError("k must be more than 0 rad/m for a group velocity, got 0.0")
    return (
        angular_frequency(k, depth, surface_tension)
        / k
        * group_to_phase_speed(k, depth, surface_tension)
    )


def wavenumber(omega: RealLike, depth: float = math.inf, surface_tension: float = 0.0) -> Real:
    """
    Return k(omega), the inverse of `angular_frequency`, to a few units in the last place.

    Newton's method on ln omega(ln k): its slope is the ratio of group to phase speed, always
    between 1/2 (deep) and 2 (shallow capillaries), so the step never overshoots far, from the
    longest wave to the shortest.

    Args:
        omega: angular frequency, any shape, [rad/s], >= 0.
        depth: still-water depth [m]; `math.inf` is deep water.
        surface_tension: sigma [N/m].

    Returns:
        Same shape as `omega`, [rad/m].

    Raises:
        ParameterError: as `angular_frequency`.

    Source: the first guess is Eckart's (1952), k = (omega^2/g) / sqrt(tanh(omega^2 h/g)).
    Pinned by tests/physics/test_dispersion.py, against 40-digit arithmetic, to 4 eps.
    """
    kinematic_tension = _water(depth, surface_tension)
    omega = FREQUENCY.check_array("omega", omega)
    deep = omega**2 / GRAVITY
    if math.isinf(depth) and kinematic_tension == 0.0:
        return deep
    moving = deep > 0.0
    w, k = omega[moving], deep[moving]
    k = k / np.sqrt(np.tanh(_times_depth(k, depth)))
    if kinematic_tension > 0.0:
        # w^2 over the faintest of tensions would overflow
        k = np.minimum(k, np.cbrt(w) ** 2 / np.cbrt(kinematic_tension))
    for _ in range(_NEWTON_STEPS):
        misfit = _frequency(k, depth, kinematic_tension) / w - 1.0
        k = k * np.exp(-np.log1p(misfit) / _speed_ratio(k, depth, kinematic_tension))
    result = np.zeros_like(omega)
    result[moving] = k
    return result


# from a guess within 1/4 of the root in ln k, five steps reach the last digit; one is spare
_NEWTON_STEPS = 6


def loop_cycles(omega: RealLike, period: float) -> Integer:
    """
    Return the number of whole cycles of each wave in a loop of `period` [s]: max(1, round(omega T /
    2 pi)), in the shape of omega.

    A wave whose true frequency is omega then runs at 2 pi n / T, which is off by at most pi / T,
    except for the slowest waves, which are sped up to one cycle a loop rather than frozen.

    Raises:
        ParameterError: a frequency or period out of its range, or more cycles than a 64 bit
            integer counts.

    Source: Tessendorf 2001, section 4.4 (who truncates; rounding halves the error).
    """
    period = LOOP.check("period", period)
    cycles = np.rint(FREQUENCY.check_array("omega", omega) * (period / (2.0 * np.pi)))
    if np.any(cycles >= 2.0**63):
        raise ParameterError(
            f"omega must make fewer than 2^63 cycles in a loop, got {np.max(cycles):g} "
            f"in {period:g} s"
        )
    whole: Integer = np.maximum(cycles, 1.0).astype(np.int64)
    return whole
