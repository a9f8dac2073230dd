"""Rules shared by the two models of the VRX wave generation note: PMS and CWR."""

import math

import numpy as np

from fftocean.arrays import Real
from fftocean.errors import ParameterError
from fftocean.gerstner.checks import ACCELERATION, FACTOR, NUMBER, RATIO, check_tau
from fftocean.limits import ANGLE, DIRECTION, PERIOD


def steps(number: int) -> Real:
    """Return n = i - (N-1)/2: whole or half numbers, centred on 0."""
    return np.arange(number) - 0.5 * (number - 1)


def shared_steepness(steepness: float, slope: Real) -> Real:
    """
    Return q_i = min(1, q / (A_i k_i N)).

    Each wave gets an equal share of the steepness that would make a cusp.
    """
    if steepness == 0.0:
        return np.zeros_like(slope)
    return steepness / np.maximum(slope * slope.size, steepness)


def check_family(
    number: int,
    period: float,
    scale: float,
    direction: float,
    angle: float,
    steepness: float,
    tau: float,
    gravity: float,
) -> None:
    """
    Check the parameters that both models share.

    Raises:
        ParameterError: a value out of range, or waves spread beyond a factor 1e6 from the middle.
    """
    NUMBER.check("number", number)
    PERIOD.check("period", period)
    RATIO.check("scale", scale)
    if 0.5 * (number - 1) * math.log(scale) > math.log(1e6):
        raise ParameterError(
            "number and scale must keep scale^((number-1)/2), the outermost wave to the middle, "
            f"below 1e6, got {number} and {scale:g}"
        )
    DIRECTION.check("direction", direction)
    ANGLE.check("angle", angle)
    FACTOR.check("steepness", steepness)
    check_tau(tau)
    ACCELERATION.check("gravity", gravity)
