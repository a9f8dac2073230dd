"""
The fields of the sea, one line of signs each.

Every linear field is a derivative of one of two functions of (x, y, t): the height h, and the
displacement potential chi, whose gradient is the horizontal displacement D of the water at the
surface. In wavenumber space

    chi(k) = h(k) / (|k| tanh(|k| depth)),      d/dx = i kx,      d/dy = i ky,

so D = grad chi = sum (+i k/|k|) / tanh(|k| depth) h(k) e^{i k.x}: +i moves water toward the crests
and sharpens them. The time derivative multiplies the two terms of h(k) = forward e^{-i omega t} +
backward e^{+i omega t} by -i omega and +i omega.
"""

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from fftocean.arrays import Complex, Real


@dataclass(frozen=True, slots=True)
class Field:
    """A field as a derivative: its function, and the orders along x, y and t."""

    of: Literal["height", "potential"]
    dx: int
    dy: int
    dt: int
    unit: str
    caption: str


_H: Final = "height"
_P: Final = "potential"
_RAW = ", before choppiness"

FIELDS: dict[str, Field] = {
    #                     of  dx dy dt
    "height":      Field(_H, 0, 0, 0, "m",   "vertical displacement"),
    "displace_x":  Field(_P, 1, 0, 0, "m",   "horizontal displacement along x" + _RAW),
    "displace_y":  Field(_P, 0, 1, 0, "m",   "horizontal displacement along y" + _RAW),
    "slope_x":     Field(_H, 1, 0, 0, "1",   "d height / dx"),
    "slope_y":     Field(_H, 0, 1, 0, "1",   "d height / dy"),
    "stretch_xx":  Field(_P, 2, 0, 0, "1",   "d displace_x / dx"),
    "stretch_xy":  Field(_P, 1, 1, 0, "1",   "d displace_x / dy = d displace_y / dx"),
    "stretch_yy":  Field(_P, 0, 2, 0, "1",   "d displace_y / dy"),
    "velocity_x":  Field(_P, 1, 0, 1, "m/s", "d displace_x / dt of the surface particle" + _RAW),
    "velocity_y":  Field(_P, 0, 1, 1, "m/s", "d displace_y / dt of the surface particle" + _RAW),
    "velocity_z":  Field(_H, 0, 0, 1, "m/s", "d height / dt of the surface particle"),
}  # fmt: skip

DISPLACEMENT_GRADIENT = ("stretch_xx", "stretch_xy", "stretch_yy")
"""The gradient of the horizontal displacement, before choppiness [-]."""

EIGHT = tuple(name for name, field in FIELDS.items() if field.dt == 0)
"""The eight fields of one moment, which `Ocean.frame` returns by default."""

GEOMETRY = ("slope_x", "slope_y", "stretch_xx", "stretch_xy", "stretch_yy")
"""The gradients of height and displacement, in the order that the kernels of `surface` take."""

POINTWISE = {"normal": GEOMETRY, "jacobian": GEOMETRY[2:]}
"""The fields that are not linear, and the linear ones that they are computed from."""


def potential_factor(k: Real, depth: float) -> Real:
    """
    Return 1 / (k tanh(k h)) [m], the factor from height to displacement potential.

    It is 0 at k = 0, where there is no wave.

    Args:
        k: wavenumber [rad/m], any shape.
        depth: still-water depth h [m].
    """
    k = np.asarray(k, dtype=np.float64)
    with np.errstate(over="ignore"):
        steepening = k * (1.0 if np.isinf(depth) else np.tanh(k * depth))
    return np.divide(1.0, steepening, out=np.zeros_like(k), where=steepening > 0.0)


def multiplier(field: Field, kx: Real, ky: Real, depth: float) -> Complex:
    """
    Return the factor from h(k), or from dh/dt(k), to the spectrum of a field.

    Args:
        field: a row of `FIELDS`.
        kx, ky: wavenumbers, of one shape [rad/m].
        depth: still-water depth [m].
    """
    factor = potential_factor(np.hypot(kx, ky), depth) if field.of == "potential" else 1.0
    return np.asarray((1j * kx) ** field.dx * (1j * ky) ** field.dy * factor, dtype=np.complex128)
