"""
The classic few-wave models, corrected: PMS and CWR, steepness waves, the slides' waves, the trochoidal surface.

Each model keeps the parameter names of the document it comes from and does one thing: it makes a `Waves`, the list of its
waves, where the geometry is written once. What is wrong in the documents is listed in docs/errata.md; it is right here.

Shader documents have y up and z across. Ours is z up: their (x, y, z) is our (x, z, y), so that a direction from x toward z
is one from x toward y here. That is the same world as Unity's left-handed frame, and the mirror image of a right-handed one
(OpenGL). `WaveSurface.y_up` gives the surface back in their order.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fftocean.arrays import Real, RealLike, brief_repr, require_memory
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError
from fftocean.limits import ANGLE, DEPTH, DIRECTION, LENGTH, LOOP, PERIOD, SAMPLES, SIZE, TIME, Count, Quantity

ALPHA = 8.1e-3
"""The Phillips constant of Pierson & Moskowitz (1964), as the VRX wave generation note has it [-]."""

NUMBER = Count("", 1, 1000)
AMPLITUDE = Quantity("m", 0.0, 1e3)
WAVENUMBER = Quantity("rad/m", 1e-6, 1e6)
COMPONENT = Quantity("rad/m", -1e6, 1e6)  # of a wavevector
FREQUENCY = Quantity("rad/s", 0.0, 1e6)
WAVELENGTH = Quantity("m", 1e-5, 1e7)
RATIO = Quantity("", 1.0, 100.0)  # of one wave to the next
FREQUENCY_RATIO = Quantity("", 1.001, 100.0)  # at 1 no wave would have any share of the frequency axis
SHARPNESS = Quantity("", 0.0, 1e13)  # coth(kh) of the longest wave in the thinnest film is 1e12
FACTOR = Quantity("", 0.0, 1e3)  # gain, steepness
TAU = Quantity("s", 1e-3, 1e6)
ACCELERATION = Quantity("m/s^2", 1e-3, 1e3)
POSITION = Quantity("m", -1e12, 1e12)

Column = float | Sequence[float]
"""One number for every wave, or one for each."""


@dataclass(frozen=True, slots=True, eq=False)
class YUp:
    """The surface in the order of the shader documents: x, height, z, where z is our y. Each is (..., 3)."""

    position: Real  # [m]
    tangent: Real  # d position / dx, not normalised
    binormal: Real  # d position / dz, not normalised
    normal: Real  # unit; along binormal x tangent, which is up here: tangent x binormal points down

    __repr__ = brief_repr


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WaveSurface:
    """
    The surface at the parameters (x0, y0): the fields that a `Frame` has, by the same names, and what follows from them.

    Every field has the shape that x0, y0 and t broadcast to. The horizontal factors of the model are in `displace_*` and
    `stretch_*` already: an exporter must not apply a choppiness again.
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
        """Where the particle of (x0, y0) is, toward the east [m]."""
        return self.x0 + self.displace_x

    @property
    def y(self) -> Real:
        """Where it is, toward the north [m]."""
        return self.y0 + self.displace_y

    @property
    def z(self) -> Real:
        """Where it is, upward: the height [m]."""
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
        """1: the waves' own sharpness is in `displace_*` already; so the surface can go wherever a `Frame` can."""
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
        """Area of a patch seen from above to its area at rest: 1 on a flat sea, 0 where a crest is a cusp, negative where it is folded."""
        return (1.0 + self.stretch_xx) * (1.0 + self.stretch_yy) - self.stretch_xy**2

    @property
    def normal(self) -> Real:
        """Unit tangent_x x tangent_y, (..., 3): upward wherever the Jacobian is positive; straight up in a perfect cusp, which has none."""
        n = np.cross(self.tangent_x, self.tangent_y)
        length = np.linalg.norm(n, axis=-1, keepdims=True)
        unit: Real = np.broadcast_to([0.0, 0.0, 1.0], n.shape).copy()
        np.divide(n, length, out=unit, where=length > 0.0)
        return unit

    @property
    def y_up(self) -> YUp:
        """The same surface as the shader documents write it down."""
        swap = [0, 2, 1]
        return YUp(self.position[..., swap], self.tangent_x[..., swap], self.tangent_y[..., swap], self.normal[..., swap])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Waves:
    """
    A few waves, and the surface that they make: height = sum a cos(theta), displacement = -sum q a (k/|k|) sin(theta).

    theta = k.x0 - omega t - phase, so that every wave runs along its k. Columns of one length, float64, read-only; a single
    number stands for all waves. With q = 1 a particle goes round in a circle of radius a, with q = coth(kh) in the flat
    ellipse of depth h; q = 0 is a sum of sines.

    `tau` > 0 starts the sea from rest: height and horizontal motion alike grow as 1 - e^{-t/tau} from t = 0, and are 0
    before. Positions are continuous; velocities are not: at t = 0 they jump to (the full displacement)/tau.

    Raises:
        ParameterError: a column that is not numbers in range, columns of different lengths, or a wave without a wavenumber.
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
        columns = {"kx": (self.kx, COMPONENT), "ky": (self.ky, COMPONENT), "amplitude": (self.amplitude, LENGTH)}
        columns |= {"phase": (self.phase, ANGLE), "omega": (self.omega, FREQUENCY), "sharpness": (self.sharpness, SHARPNESS)}
        for name, column in _columns(**columns).items():
            array = np.array(column, dtype=np.float64)
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        k = self.wavenumber
        if not np.all(k > 0.0):
            raise ParameterError(f"kx and ky must not both be 0 in any wave, got wavenumber {k.min()} rad/m in wave {int(k.argmin())}")
        object.__setattr__(self, "tau", _tau(self.tau))

    def __len__(self) -> int:
        return int(self.kx.size)

    @property
    def wavenumber(self) -> Real:
        """|k| of each wave [rad/m]."""
        return np.hypot(self.kx, self.ky)

    @property
    def variance(self) -> float:
        """sum a^2/2 [m^2]: what the waves have of the spectrum's m0, once the start is over."""
        return float(0.5 * np.sum(self.amplitude**2))

    def ramp(self, t: RealLike) -> tuple[Real, Real]:
        """The factor 1 - e^{-t/tau} of the start, and its rate of change [1/s]: 0 before t = 0; 1 and 0 without a start."""
        t = _within("t", t, TIME)
        if self.tau == 0.0:
            return np.ones_like(t), np.zeros_like(t)
        age = np.maximum(t, 0.0) / self.tau
        return -np.expm1(-age), np.where(t >= 0.0, np.exp(-age) / self.tau, 0.0)

    def at(self, x0: RealLike, y0: RealLike, t: RealLike) -> WaveSurface:
        """
        The surface at the parameters (x0, y0) at time t.

        Args:
            x0, y0: where the particles rest [m]; any shapes that broadcast.
            t: time [s]; broadcasts with them.

        Raises:
            ParameterError: a position or time that is not a finite number within +-1e12.

        Pinned by tests/gerstner/test_wavefields.py, against complex-step derivatives of the formula above.
        """
        x0, y0, t = np.broadcast_arrays(_within("x0", x0, POSITION), _within("y0", y0, POSITION), _within("t", t, TIME))
        grow, grow_rate = self.ramp(t)
        height, dx, dy, sx, sy, xx, xy, yy, height_rate, dx_rate, dy_rate = np.zeros((11, *x0.shape))
        for kx, ky, k, a, phase, omega, q in zip(
            self.kx, self.ky, self.wavenumber, self.amplitude, self.phase, self.omega, self.sharpness, strict=True
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

    def grid(self, n: int | tuple[int, int], size: float | tuple[float, float], t: float = 0.0) -> WaveSurface:
        """
        The surface on a regular grid: fields (ny, nx), indexed [iy, ix], at x0 = ix Lx/nx and y0 = iy Ly/ny, as an `Ocean` has them.

        The grid tiles without a seam only if every wavevector is a whole multiple of 2 pi/L, which few of these models see to.

        Args:
            n: samples a side, or (nx, ny).
            size: the patch's width [m], or (Lx, Ly).
            t: time [s].

        Raises:
            ParameterError: a number of samples or a size out of range, or more memory than there is.
        """
        nx, ny = (SAMPLES.check_whole("n", value) for value in _pair("n", n))
        lx, ly = (SIZE.check("size", value) for value in _pair("size", size))
        require_memory(f"a surface of {nx} x {ny} samples", 8.0 * 30.0 * nx * ny)
        x0, y0 = np.meshgrid(np.arange(nx) * (lx / nx), np.arange(ny) * (ly / ny))
        return self.at(x0, y0, TIME.check("t", t))


@dataclass(frozen=True, slots=True, kw_only=True)
class PMS:
    """
    Pierson-Moskowitz sampling: a few frequencies of the fully developed sea, each with the energy of its share of the axis.

    omega_i = s^n omega_p with n = i - (N-1)/2, A_i = gain sqrt(2 S(omega_i) Delta_i), direction_i = direction + n angle.
    Delta_i is half the distance between the neighbours, omega_i (s - 1/s)/2; the first and the last reach, on both sides, half
    way to their one neighbour: Delta_0 = omega_0 (s - 1), Delta_{N-1} = omega_{N-1} (1 - 1/s). One wave alone has the middle rule.
    q_i is min(1, steepness / (A_i k_i N)): with steepness <= 1 no crest folds, wherever the waves meet. All phases are 0.

    `angle` is in radians, as in the note; `direction` in degrees, like every direction here (`direction_of` makes one of the
    note's vector).

    Source: VRX wave generation note, 2.2, for any N; its printed Delta_1 is wrong unless s = 2.
    Pinned by tests/gerstner/test_wavefields.py.

    Raises:
        ParameterError: a value out of its range, or frequencies spread beyond a factor 1e6 from the peak.
    """

    number: int = 3  # N
    period: float  # of the spectral peak [s]
    scale: float = 1.5  # s, of one frequency to the next [-]
    gain: float = 1.0  # on every amplitude; the energy goes with its square [-]
    direction: float = 0.0  # toward which the middle wave goes, counter-clockwise from +x [degrees]
    angle: float = 0.4  # from one wave's direction to the next [rad]
    steepness: float = 1.0  # q: 0 is sines, 1 is as sharp as can be without folding [-]
    tau: float = 0.0  # time constant of the start [s]; 0 is none
    gravity: float = GRAVITY  # [m/s^2]

    def __post_init__(self) -> None:
        _check_family(self.number, self.period, self.scale, self.direction, self.angle, self.steepness, self.tau, self.gravity)
        FREQUENCY_RATIO.check("scale", self.scale)
        FACTOR.check("gain", self.gain)
        _ = self.waves  # which refuses waves out of range

    @property
    def peak(self) -> float:
        """omega_p [rad/s]."""
        return 2.0 * math.pi / self.period

    @property
    def omega(self) -> Real:
        """omega_i, ascending [rad/s]."""
        return self.peak * self.scale ** _steps(self.number)

    @property
    def spacing(self) -> Real:
        """Delta_i, the stretch of the frequency axis that each wave stands for [rad/s]."""
        s, omega = self.scale, self.omega
        delta = omega * (0.5 * (s - 1.0 / s))
        if self.number > 1:
            delta[0], delta[-1] = omega[0] * (s - 1.0), omega[-1] * (1.0 - 1.0 / s)
        return delta

    @property
    def energy_kept(self) -> float:
        """
        sum A^2/2 over gain^2 m0, with m0 = alpha g^2 / (5 omega_p^4) [-].

        0.88 for three waves a factor 1.5 apart, 1.22 at 2, 0.39 at 1.1; toward 1 for many waves, close together, that reach far.
        """
        return float(np.sum(self._variances)) / (ALPHA * self.gravity**2 / (5.0 * self.peak**4))

    @property
    def _variances(self) -> Real:
        """S(omega_i) Delta_i [m^2]; S = alpha g^2 omega^-5 exp(-5/4 (omega_p/omega)^4)."""
        density: Real = ALPHA * self.gravity**2 * self.omega**-5 * np.exp(-1.25 * (self.peak / self.omega) ** 4)
        return density * self.spacing

    @property
    def waves(self) -> Waves:
        """The waves, the longest first."""
        amplitude = self.gain * np.sqrt(2.0 * self._variances)
        k = self.omega**2 / self.gravity
        heading = math.radians(self.direction) + _steps(self.number) * self.angle
        return _directed(k, heading, amplitude, self.omega, _shared_steepness(self.steepness, amplitude * k), self.tau)


@dataclass(frozen=True, slots=True, kw_only=True)
class CWR:
    """
    Constant wavelength-amplitude ratio: waves of one shape, each s times as long and as high as the one before.

    With n = i - (N-1)/2: A_i = amplitude s^n, k_i = k/s^n, omega_i = sqrt(g k_i), direction_i = direction + n angle, and
    q_i = min(1, steepness / (A_i k_i N)), the same for all since A_i k_i is. `period` and `amplitude` are those of the median
    wave, for an even number the geometric mean of the middle two. `angle` is in radians and `direction` in degrees, as in `PMS`.

    Source: VRX wave generation note, 2.3, after Finch, GPU Gems (2004), chapter 1. The note prints n = i - N/2, which is
    centred in neither case; its text says median.
    Pinned by tests/gerstner/test_wavefields.py.

    Raises:
        ParameterError: a value out of its range, or waves spread beyond a factor 1e6 from the median.
    """

    number: int = 3  # N
    period: float  # median [s]
    amplitude: float  # median [m]
    scale: float = 2.0  # s, of one wavelength to the next [-]
    direction: float = 0.0  # toward which the middle wave goes, counter-clockwise from +x [degrees]
    angle: float = 0.4  # from one wave's direction to the next [rad]
    steepness: float = 1.0  # q: 0 is sines, 1 is as sharp as can be without folding [-]
    tau: float = 0.0  # time constant of the start [s]; 0 is none
    gravity: float = GRAVITY  # [m/s^2]

    def __post_init__(self) -> None:
        _check_family(self.number, self.period, self.scale, self.direction, self.angle, self.steepness, self.tau, self.gravity)
        AMPLITUDE.check("amplitude", self.amplitude)
        _ = self.waves  # which refuses waves out of range

    @property
    def waves(self) -> Waves:
        """The waves, the shortest first."""
        n = _steps(self.number)
        amplitude = self.amplitude * self.scale**n
        k = (2.0 * math.pi / self.period) ** 2 / self.gravity / self.scale**n
        heading = math.radians(self.direction) + n * self.angle
        sharpness = _shared_steepness(self.steepness, amplitude * k)
        return _directed(k, heading, amplitude, np.sqrt(self.gravity * k), sharpness, self.tau)


@dataclass(frozen=True, slots=True, kw_only=True)
class SteepnessWaves:
    """
    Waves by wavelength, steepness and direction: A = steepness/k, P = [x + Dx A cos f, A sin f, z + Dz A cos f], y up.

    f = k (D.(x, z) - c t), c = sqrt(g/k): a Gerstner wave (q = 1) of phase pi/2. Crests become cusps at steepness 1 and fold
    beyond; where several waves meet it is the sum that counts.

    Each of the three is one number for all waves or a list of one for each.

    Source: CS175 final project (2023), section 2, after Catlike Coding, Waves (2018). Pinned by tests/gerstner/test_wavefields.py.

    Raises:
        ParameterError: a value out of its range, or lists of different lengths.
    """

    wavelength: Column  # [m]
    steepness: Column  # k A [-]
    direction: Column = 0.0  # of D, from x toward z (our y) [degrees]
    gravity: float = GRAVITY  # [m/s^2]; the document has 9.8

    def __post_init__(self) -> None:
        columns = {
            "wavelength": (self.wavelength, WAVELENGTH),
            "steepness": (self.steepness, FACTOR),
            "direction": (self.direction, DIRECTION),
        }
        _set_columns(self, columns)
        _gravity(self, self.gravity)
        _ = self.waves  # which refuses waves out of range

    @property
    def waves(self) -> Waves:
        """The waves, in the order given."""
        k = 2.0 * math.pi / np.asarray(self.wavelength)
        amplitude = np.asarray(self.steepness) / k
        return _directed(k, np.radians(self.direction), amplitude, np.sqrt(self.gravity * k), 1.0, 0.0, phase=0.5 * math.pi)


@dataclass(frozen=True, slots=True, kw_only=True)
class SlideWaves:
    """
    Deep-water waves by amplitude, wavenumber and angle.

    x' = x - sum A cos(gamma) sin(theta), y' = sum A cos(theta), z' = z - sum A sin(gamma) sin(theta), y up, with
    theta = k cos(gamma) x + k sin(gamma) z - omega t - phi and omega = sqrt(g k).

    Each of the four is one number for all waves or a list of one for each.

    Source: Mike Bailey's Gerstner wave slides (2021); the equations, with z for the second y in theta, not the shader.
    Pinned by tests/gerstner/test_wavefields.py.

    Raises:
        ParameterError: a value out of its range, or lists of different lengths.
    """

    A: Column  # amplitude [m]
    k: Column  # wavenumber, the slides' "wave density" [rad/m]
    gamma: Column = 0.0  # propagation angle, from x toward z (our y) [rad]
    phi: Column = 0.0  # phase [rad]
    gravity: float = GRAVITY  # [m/s^2]; the slides' shader has G = 1

    def __post_init__(self) -> None:
        _set_columns(self, {"A": (self.A, AMPLITUDE), "k": (self.k, WAVENUMBER), "gamma": (self.gamma, ANGLE), "phi": (self.phi, ANGLE)})
        _gravity(self, self.gravity)

    @property
    def waves(self) -> Waves:
        """The waves, in the order given."""
        k = np.asarray(self.k)
        return _directed(k, np.asarray(self.gamma), self.A, np.sqrt(self.gravity * k), 1.0, 0.0, phase=self.phi)


@dataclass(frozen=True, slots=True, kw_only=True)
class TrochoidalWaves:
    """
    Waves over water of any depth by amplitude and wavevector.

    xi = alpha - sum (kx/k) a/tanh(kh) sin(theta), eta = beta - sum (kz/k) a/tanh(kh) sin(theta), zeta = sum a cos(theta), the
    last of them up, with theta = kx alpha + kz beta - omega t - phi and omega^2 = g k tanh(kh). A particle goes round in an
    ellipse coth(kh) times as wide as it is high.

    A finite `loop` makes the surface repeat after that time: every omega becomes the nearest whole multiple of 2 pi/loop, which
    is off by at most pi/loop; waves that would stand still are sped up to one turn a loop.

    Each of kx, kz, a and phi is one number for all waves or a list of one for each.

    Source: Wikipedia, "Trochoidal wave", section "In computer graphics". Pinned by tests/gerstner/test_wavefields.py.

    Raises:
        ParameterError: a value out of its range, lists of different lengths, or a wave without a wavenumber.
    """

    a: Column  # amplitude [m]
    kx: Column  # [rad/m]
    kz: Column = 0.0  # our ky [rad/m]
    phi: Column = 0.0  # phase [rad]
    h: float = math.inf  # mean depth [m]; inf is deep water
    loop: float = math.inf  # the surface repeats after this time [s]; inf is never
    gravity: float = GRAVITY  # [m/s^2]

    def __post_init__(self) -> None:
        _set_columns(self, {"a": (self.a, AMPLITUDE), "kx": (self.kx, COMPONENT), "kz": (self.kz, COMPONENT), "phi": (self.phi, ANGLE)})
        DEPTH.check("h", self.h)
        if self.loop != math.inf:
            LOOP.check("loop", self.loop)
        _gravity(self, self.gravity)
        k = np.hypot(self.kx, self.kz)
        if not np.all(k >= WAVENUMBER.low):
            raise ParameterError(f"kx and kz must make wavenumbers of at least {WAVENUMBER.low:g} {WAVENUMBER.unit}, got {np.min(k)}")

    @property
    def waves(self) -> Waves:
        """The waves, in the order given."""
        k = np.hypot(self.kx, self.kz)
        tanh = np.tanh(k * self.h)
        omega = np.sqrt(self.gravity * k * tanh)
        if self.loop < math.inf:
            step = 2.0 * math.pi / self.loop
            omega = np.maximum(np.rint(omega / step), 1.0) * step
        return Waves(
            kx=_array(self.kx), ky=_array(self.kz), amplitude=_array(self.a), phase=_array(self.phi), omega=omega, sharpness=1.0 / tanh
        )


def direction_of(dx: float, dy: float) -> float:
    """
    The direction [degrees, counter-clockwise from +x] of a vector of any length, for documents that give one.

    Raises:
        ParameterError: a vector without a direction.
    """
    if not (math.isfinite(dx) and math.isfinite(dy) and (dx or dy)):
        raise ParameterError(f"a direction must be a finite vector that is not 0, got ({dx}, {dy})")
    return math.degrees(math.atan2(dy, dx))


def _steps(number: int) -> Real:
    """n = i - (N-1)/2: whole or half numbers, centred on 0."""
    return np.arange(number) - 0.5 * (number - 1)


def _shared_steepness(steepness: float, slope: Real) -> Real:
    """q_i = min(1, q / (A_i k_i N)): each wave gets an even share of the steepness that would make a cusp."""
    if steepness == 0.0:
        return np.zeros_like(slope)
    return steepness / np.maximum(slope * slope.size, steepness)


def _directed(
    k: Real, heading: RealLike, amplitude: RealLike, omega: Real, sharpness: RealLike, tau: float, phase: RealLike = 0.0
) -> Waves:
    """Waves of wavenumber k that go toward `heading` [rad]."""
    kx, ky = k * np.cos(heading), k * np.sin(heading)
    return Waves(kx=kx, ky=ky, amplitude=_array(amplitude), phase=_array(phase), omega=omega, sharpness=_array(sharpness), tau=tau)


def _check_family(
    number: int, period: float, scale: float, direction: float, angle: float, steepness: float, tau: float, gravity: float
) -> None:
    """Refuse what the VRX models, which share their parameters, cannot be made of."""
    NUMBER.check_whole("number", number)
    PERIOD.check("period", period)
    RATIO.check("scale", scale)
    if 0.5 * (number - 1) * math.log(scale) > math.log(1e6):
        raise ParameterError(
            f"number and scale must keep scale^((number-1)/2), the outermost wave to the middle one, below 1e6, got {number} and {scale:g}"
        )
    DIRECTION.check("direction", direction)
    ANGLE.check("angle", angle)
    FACTOR.check("steepness", steepness)
    _tau(tau)
    ACCELERATION.check("gravity", gravity)


def _tau(tau: Any) -> float:
    """A time constant, or 0 for none."""
    if isinstance(tau, (int, float)) and not isinstance(tau, bool) and tau == 0:
        return 0.0
    return TAU.check("tau, unless it is 0,", tau)


def _gravity(model: Any, gravity: float) -> None:
    object.__setattr__(model, "gravity", ACCELERATION.check("gravity", gravity))


def _array(values: Any) -> Real:
    return np.asarray(values, dtype=np.float64)


def _columns(**given: tuple[Any, Quantity]) -> dict[str, tuple[float, ...]]:
    """Check each value, and stretch single numbers to the common length."""
    columns = {}
    for name, (values, quantity) in given.items():
        if isinstance(values, np.ndarray):
            values = values.tolist()
        items = list(values) if isinstance(values, (list, tuple)) else [values]
        columns[name] = tuple(quantity.check(name, value) for value in items)
    length = max(len(column) for column in columns.values())
    for name, column in columns.items():
        if len(column) not in (1, length) or not column:
            raise ParameterError(f"{name} must be one number, or one for each wave ({max(length, 1)}), got {len(column)}")
    return {name: column * (length // len(column)) for name, column in columns.items()}


def _set_columns(model: Any, given: dict[str, tuple[Any, Quantity]]) -> None:
    for name, column in _columns(**given).items():
        object.__setattr__(model, name, column)


def _within(name: str, values: RealLike, quantity: Quantity) -> Real:
    """A float64 array, every entry in range."""
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ParameterError(f"{name} must be numbers {quantity.rule}, got {values!r:.60}") from error
    good = (array >= quantity.low) & (array <= quantity.high)
    if not np.all(good):
        raise ParameterError(f"{name} must be {quantity.rule}, got {array[~good].flat[0]}")
    return array


def _pair(name: str, value: Any) -> tuple[Any, Any]:
    """(x, y) of a value that may be one for both."""
    if isinstance(value, tuple):
        if len(value) != 2:
            raise ParameterError(f"{name} must be one number or a pair (x, y), got {value!r}")
        return value
    return value, value
