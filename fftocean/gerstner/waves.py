"""
Surface of a list of waves, evaluated at particle positions.

Every few-wave model makes a `Waves`, where the geometry is written once. `WaveSurface.y_up` gives
the surface in the axis order of the shader documents.
"""

from dataclasses import dataclass

import numpy as np

from fftocean.arrays import Real, RealLike, brief_repr
from fftocean.errors import ParameterError
from fftocean.gerstner.checks import (
    COMPONENT,
    FREQUENCY,
    POSITION,
    SHARPNESS,
    check_columns,
    check_tau,
    pair,
)
from fftocean.host import require_memory
from fftocean.limits import ANGLE, LENGTH, SAMPLES, SIZE, TIME


@dataclass(frozen=True, slots=True, eq=False)
class YUp:
    """The surface in the axis order of shader documents: x, height, z (our y). Each is (..., 3)."""

    position: Real  # [m]
    tangent: Real  # d position / dx, not normalised
    binormal: Real  # d position / dz, not normalised
    normal: Real  # unit; along binormal x tangent, which is up here: tangent x binormal points down

    __repr__ = brief_repr


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WaveSurface:
    """
    Surface at the parameters (x0, y0): the fields of a `Frame`, and quantities derived from them.

    Every field has the shape that x0, y0 and t broadcast to. The horizontal factors of the model
    are in `displace_*` and `stretch_*` already: an exporter must not apply a choppiness again.
    """

    x0: Real  # [m]
    y0: Real
    height: Real  # [m]
    displace_x: Real  # [m]
    displace_y: Real
    slope_x: Real  # d height / dx0 [-]
    slope_y: Real
    stretch_xx: Real  # d displace_x / dx0 [-]
    stretch_xy: Real  # d displace_x / dy0 = d displace_y / dx0
    stretch_yy: Real
    velocity_x: Real  # of the particle, d position / dt [m/s]
    velocity_y: Real
    velocity_z: Real

    __repr__ = brief_repr

    @property
    def x(self) -> Real:
        """Position of the particle of (x0, y0), toward the east [m]."""
        return self.x0 + self.displace_x

    @property
    def y(self) -> Real:
        """Position of the particle, toward the north [m]."""
        return self.y0 + self.displace_y

    @property
    def z(self) -> Real:
        """Position of the particle, upward: the height [m]."""
        return self.height

    @property
    def position(self) -> Real:
        """x, y and z, (..., 3) [m]."""
        return np.stack([self.x, self.y, self.z], axis=-1)

    @property
    def velocity(self) -> Real:
        """The particle's velocity, (..., 3) [m/s]."""
        return np.stack([self.velocity_x, self.velocity_y, self.velocity_z], axis=-1)

    @property
    def choppiness(self) -> float:
        """
        1: `displace_*` has the sharpness of the waves already, so exporters take it as a `Frame`.
        """
        return 1.0

    @property
    def tangent_x(self) -> Real:
        """d position / dx0, (..., 3), not normalised."""
        return np.stack([1.0 + self.stretch_xx, self.stretch_xy, self.slope_x], axis=-1)

    @property
    def tangent_y(self) -> Real:
        """d position / dy0, (..., 3), not normalised."""
        return np.stack([self.stretch_xy, 1.0 + self.stretch_yy, self.slope_y], axis=-1)

    @property
    def jacobian(self) -> Real:
        """
        Ratio of a patch's area seen from above to its area at rest.

        1 on a flat sea, 0 where a crest is a cusp, negative where the surface is folded.
        """
        return (1.0 + self.stretch_xx) * (1.0 + self.stretch_yy) - self.stretch_xy**2

    @property
    def normal(self) -> Real:
        """
        Unit tangent_x x tangent_y, (..., 3).

        Upward wherever the Jacobian is positive. A perfect cusp has no normal: straight up there.
        """
        n = np.cross(self.tangent_x, self.tangent_y)
        length = np.linalg.norm(n, axis=-1, keepdims=True)
        unit: Real = np.broadcast_to([0.0, 0.0, 1.0], n.shape).copy()
        np.divide(n, length, out=unit, where=length > 0.0)
        return unit

    @property
    def y_up(self) -> YUp:
        """The same surface in the axis order of shader documents."""
        swap = [0, 2, 1]
        return YUp(
            self.position[..., swap],
            self.tangent_x[..., swap],
            self.tangent_y[..., swap],
            self.normal[..., swap],
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Waves:
    """
    A list of waves and the surface that they make.

    height = sum a cos(theta), displacement = -sum q a (k/|k|) sin(theta), with

    theta = k.x0 - omega t - phase, so every wave runs along its k. Columns of one length, float64,
    read-only; a single number stands for all waves. With q = 1 a particle goes round in a circle of
    radius a, with q = coth(kh) in the flat ellipse of depth h; q = 0 is a sum of sines.

    `tau` > 0 starts the sea from rest: height and horizontal motion alike grow as 1 - e^{-t/tau}
    from t = 0, and are 0 before. Positions are continuous; velocities are not: at t = 0 they jump
    to (the full displacement)/tau.

    Raises:
        ParameterError: a column that is not numbers in range, columns of different lengths, or a
            wave without a wavenumber.
    """

    kx: Real  # wavevector, toward which the wave runs [rad/m]
    ky: Real
    amplitude: Real  # a [m]
    phase: Real  # [rad]
    omega: Real  # [rad/s]
    sharpness: Real  # q [-]
    tau: float = 0.0  # time constant of the start [s]; 0 is no start: the sea has always been there

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        columns = {
            "kx": (self.kx, COMPONENT),
            "ky": (self.ky, COMPONENT),
            "amplitude": (self.amplitude, LENGTH),
        }
        columns |= {
            "phase": (self.phase, ANGLE),
            "omega": (self.omega, FREQUENCY),
            "sharpness": (self.sharpness, SHARPNESS),
        }
        for name, column in check_columns(**columns).items():
            array = np.array(column, dtype=np.float64)
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        k = self.wavenumber
        if not np.all(k > 0.0):
            raise ParameterError(
                "kx and ky must not both be 0 in any wave, "
                f"got wavenumber {k.min()} rad/m in wave {int(k.argmin())}"
            )
        object.__setattr__(self, "tau", check_tau(self.tau))

    def __len__(self) -> int:
        return int(self.kx.size)

    @property
    def wavenumber(self) -> Real:
        """|k| of each wave [rad/m]."""
        return np.hypot(self.kx, self.ky)

    @property
    def variance(self) -> float:
        """sum a^2/2 [m^2]: the variance of the waves once the start-up ramp is over."""
        return float(0.5 * np.sum(self.amplitude**2))

    def ramp(self, t: RealLike) -> tuple[Real, Real]:
        """
        Return the factor 1 - e^{-t/tau} of the start-up ramp, and its rate of change [1/s].

        Both are 0 before t = 0. Without a ramp they are 1 and 0.
        """
        t = TIME.check_array("t", t)
        if self.tau == 0.0:
            return np.ones_like(t), np.zeros_like(t)
        age = np.maximum(t, 0.0) / self.tau
        return -np.expm1(-age), np.where(t >= 0.0, np.exp(-age) / self.tau, 0.0)

    def at(self, x0: RealLike, y0: RealLike, t: RealLike) -> WaveSurface:
        """
        Return the surface at the parameters (x0, y0) at time t.

        Args:
            x0, y0: rest positions of the particles [m]; any shapes that broadcast.
            t: time [s]; broadcasts with them.

        Raises:
            ParameterError: a position or time that is not a finite number within +-1e12.

        Pinned by tests/gerstner/test_few_waves.py, against complex-step derivatives of the formula
        above.
        """
        x0, y0, t = np.broadcast_arrays(
            POSITION.check_array("x0", x0),
            POSITION.check_array("y0", y0),
            TIME.check_array("t", t),
        )
        grow, grow_rate = self.ramp(t)
        height, dx, dy, sx, sy, xx, xy, yy, height_rate, dx_rate, dy_rate = np.zeros(
            (11, *x0.shape)
        )
        for kx, ky, k, a, phase, omega, q in zip(
            self.kx,
            self.ky,
            self.wavenumber,
            self.amplitude,
            self.phase,
            self.omega,
            self.sharpness,
            strict=True,
        ):
            theta = kx * x0 + ky * y0 - omega * t - phase
            cosine, sine = a * np.cos(theta), a * np.sin(theta)
            ex, ey = q * kx / k, q * ky / k
            height += cosine
            dx -= ex * sine
            dy -= ey * sine
            sx -= kx * sine
            sy -= ky * sine
            xx -= ex * kx * cosine
            xy -= ex * ky * cosine
            yy -= ey * ky * cosine
            height_rate += omega * sine
            dx_rate += omega * ex * cosine
            dy_rate += omega * ey * cosine
        return WaveSurface(
            x0=x0,
            y0=y0,
            height=grow * height,
            displace_x=grow * dx,
            displace_y=grow * dy,
            slope_x=grow * sx,
            slope_y=grow * sy,
            stretch_xx=grow * xx,
            stretch_xy=grow * xy,
            stretch_yy=grow * yy,
            velocity_x=grow * dx_rate + grow_rate * dx,
            velocity_y=grow * dy_rate + grow_rate * dy,
            velocity_z=grow * height_rate + grow_rate * height,
        )

    def grid(
        self, n: int | tuple[int, int], size: float | tuple[float, float], t: float = 0.0
    ) -> WaveSurface:
        """
        Return the surface on a regular grid.

        Fields are (ny, nx), indexed [iy, ix], at x0 = ix Lx/nx and y0 = iy Ly/ny, as an `Ocean` has
        them.

        The grid tiles without a seam only if every wavevector is a whole multiple of 2 pi/L, which
        few of these models see to.

        Args:
            n: samples a side, or (nx, ny).
            size: the patch's width [m], or (Lx, Ly).
            t: time [s].

        Raises:
            ParameterError: a number of samples or a size out of range, or more memory than there
                is.
        """
        nx, ny = (SAMPLES.check("n", value) for value in pair("n", n))
        lx, ly = (SIZE.check("size", value) for value in pair("size", size))
        require_memory(f"a surface of {nx} x {ny} samples", 8.0 * 30.0 * nx * ny)
        x0, y0 = np.meshgrid(np.arange(nx) * (lx / nx), np.arange(ny) * (ly / ny))
        return self.at(x0, y0, TIME.check("t", t))
