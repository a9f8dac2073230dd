"""
Verification of a tile against its specified sea.

Each check compares with a computation that shares no code with what it checks. `fftocean verify`
and the test suite run the same checks.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fftocean import gerstner
from fftocean.arrays import Integer, Real
from fftocean.bound_waves import POTENTIAL
from fftocean.constants import GRAVITY
from fftocean.errors import ParameterError, described
from fftocean.fields import EIGHT, FIELDS, multiplier
from fftocean.gerstner import Surface
from fftocean.ocean import Frame, Ocean
from fftocean.statistics import Statistics, measure

_POINTS = 256
"""Points of the direct sum: a grid of them on a larger tile."""
_FRAMES = 48
"""Frames of the loop that is verified."""


@dataclass(frozen=True, slots=True)
class Check:
    """
    One comparison: an error, its tolerance, and the reason for that tolerance.

    Args:
        name: the quantity.
        against: its independent value.
        error: relative to the scale that `verify` documents [-], or a count.
        tolerance: the largest error that passes, in the unit of `error`.
        reason: where the tolerance comes from.
    """

    name: str
    against: str
    error: float
    tolerance: float
    reason: str

    @property
    def figure(self) -> float:
        """The error, in the unit of `error` [-]: its earlier name."""
        return self.error

    @property
    def bound(self) -> float:
        """The tolerance, in the unit of `error` [-]: the earlier name of `tolerance`."""
        return self.tolerance

    @property
    def passed(self) -> bool:
        """True if the error is within the tolerance; NaN is not."""
        return self.error <= self.tolerance


def verify(ocean: Ocean, t: float = 3.7) -> list[Check]:
    """
    Verify an ocean: all fields against the direct sum, seam, loop, Parseval, and energy; the fixed
    values of a constrained one, whose energy is compared with that of seas that have them.

    Errors of fields are relative to the largest value of their kind in the frame (all
    displacements are one kind, all slopes another); errors of energies are relative to the
    expected energy; bits are counted.

    Args:
        ocean: an ocean of either precision.
        t: time of the frame that is verified [s].

    Returns:
        The checks; the ocean is right if all `.passed`.

    Raises:
        ParameterError: not an ocean.
    """
    if not isinstance(ocean, Ocean):
        raise ParameterError(
            f"ocean must be an Ocean, such as each of cascade.oceans, got {described(ocean)}"
        )
    return [
        *_fields(ocean, t),
        *_seam(ocean, t),
        *_loop(ocean),
        *_parseval(ocean, t),
        *_fixed_values(ocean),
        *_energy(ocean, measure(ocean)),
        *_free_surface(ocean),
    ]


def _tolerance(ocean: Ocean, t: float) -> float:
    """
    Return the tolerance of a field, relative to the largest value of its kind.

    It allows for some roundings, and for that of omega t in the direct sum.
    """
    omega = float(np.max(ocean.modes().omega, initial=0.0))
    roundings = 1e-6 if ocean.dtype == "float32" else 1e-12
    return roundings + 2.0 * np.finfo(np.float64).eps * omega * abs(t)


def _least(ocean: Ocean) -> float:
    """Return the least value that the ocean's type holds with all digits: less counts as 0."""
    kind = np.finfo(ocean.dtype)
    return float(kind.tiny) / float(kind.eps)


def _fields(ocean: Ocean, t: float) -> Iterator[Check]:
    """Compare the FFT with the sum of waves, at points spread over the tile."""
    frame = ocean.frame(t, fields=(*FIELDS, "normal", "jacobian"))
    ix, iy = _points(ocean)
    truth = gerstner.surface(ocean, ocean.grid.x[ix], ocean.grid.y[iy], t)
    roundings = "8 eps of float32" if ocean.dtype == "float32" else "4500 eps"
    reason = f"{roundings}, and the rounding of omega t"
    for name in (*FIELDS, "jacobian"):
        error = _error(ocean, frame, truth, name)
        yield Check(name, "direct sum", error, _tolerance(ocean, t), reason)
    area = _area(truth, ocean.choppiness)
    difference = np.linalg.norm(frame.normal[iy, ix] - truth.normal, axis=-1)
    yield Check(
        "normal",
        "direct sum, times area",
        float(np.max(difference * area)) / float(np.max(area)),
        _tolerance(ocean, t),
        "as above; at the edge of a fold the area is 0, and a rounding turns the normal",
    )


def _error(ocean: Ocean, frame: Frame, truth: Surface, name: str) -> float:
    """
    Return the largest difference of a field from the direct sum at `_points`, relative to the
    largest value of its kind.

    A kind is all displacements, all slopes, ...: the slopes along x of waves that run along y are
    roundings alone.
    """
    ix, iy = _points(ocean)
    kind = [f for f in frame.fields if f.partition("_")[0] == name.partition("_")[0]]
    largest = float(
        np.max([[np.max(np.abs(frame[f])), np.max(np.abs(getattr(truth, f)))] for f in kind])
    )
    return float(np.max(np.abs(frame[name][iy, ix] - getattr(truth, name)))) / max(
        largest, _least(ocean)
    )


def _area(truth: Surface, choppiness: float) -> Real:
    """Return the area of the displaced over the still surface: the tangents' cross product."""
    c, s = choppiness, truth
    along_x = np.stack([1.0 + c * s.stretch_xx, c * s.stretch_xy, s.slope_x], axis=-1)
    along_y = np.stack([c * s.stretch_xy, 1.0 + c * s.stretch_yy, s.slope_y], axis=-1)
    return np.asarray(np.linalg.norm(np.cross(along_x, along_y), axis=-1))


def _points(ocean: Ocean) -> tuple[Integer, Integer]:
    """Return sample indices (ix, iy) spread over the tile, corners included; one axis each."""
    grid = ocean.grid
    side = math.isqrt(_POINTS)
    ix = np.unique(np.linspace(0, grid.nx - 1, min(side, grid.nx)).astype(int))
    iy = np.unique(np.linspace(0, grid.ny - 1, min(side, grid.ny)).astype(int))
    columns, rows = np.meshgrid(ix, iy)
    return columns.ravel(), rows.ravel()


def _seam(ocean: Ocean, t: float) -> Iterator[Check]:
    """Compare the direct sum one tile further east and north with the edges of the frame."""
    grid = ocean.grid
    frame = ocean.frame(t, fields=("height",))
    rows = np.unique(np.linspace(0, grid.ny - 1, min(64, grid.ny)).astype(int))
    columns = np.unique(np.linspace(0, grid.nx - 1, min(64, grid.nx)).astype(int))
    east = gerstner.surface(ocean, grid.lx, grid.y[rows], t).height - frame.height[rows, 0]
    north = gerstner.surface(ocean, grid.x[columns], grid.ly, t).height - frame.height[0, columns]
    worst = float(np.max(np.abs(np.concatenate([east, north])))) / max(
        float(np.max(np.abs(frame.height))), _least(ocean)
    )
    rounding = 1e-11 + 4.0 * np.finfo(np.float64).eps * max(grid.nx, grid.ny)
    yield Check(
        "seam",
        "direct sum at x + L, y + L",
        worst,
        _tolerance(ocean, t) + rounding,
        "as the fields, and the rounding of k L",
    )


def _loop(ocean: Ocean) -> Iterator[Check]:
    """
    Verify that the loop's last frame leads to its first.

    Frames repeat to the bit, since phases are whole numbers of cycles in the loop; the sum of waves
    repeats to rounding.
    """
    if ocean.loop is None:
        return
    first, again = ocean.loop_frame(5, _FRAMES), ocean.loop_frame(5 + _FRAMES * 10**9, _FRAMES)
    differing = sum(int(np.count_nonzero(first[name] != again[name])) for name in first.fields)
    yield Check("loop, frame j + F", "frame j", float(differing), 0.0, "equal bits")
    t = ocean.loop * 5 / _FRAMES
    ix, iy = _points(ocean)
    truth = gerstner.surface(ocean, ocean.grid.x[ix], ocean.grid.y[iy], t)
    error = float(np.max([_error(ocean, first, truth, name) for name in EIGHT]))
    yield Check(
        "loop, frame j",
        "direct sum at t = j T/F",
        error,
        _tolerance(ocean, t),
        "the worst of the eight fields, as above",
    )
    start, end = ocean.frame(0.0), ocean.frame(ocean.loop)
    differing = sum(int(np.count_nonzero(start[name] != end[name])) for name in start.fields)
    yield Check("loop, t = T", "t = 0", float(differing), 0.0, "equal bits")
    x, y = ocean.grid.x[ix[:32]], ocean.grid.y[iy[:32]]
    change = (
        gerstner.surface(ocean, x, y, 0.0).height - gerstner.surface(ocean, x, y, ocean.loop).height
    )
    scale = max(float(np.max(np.abs(start.height))), _least(ocean))
    omega = float(np.max(ocean.modes().omega, initial=0.0))
    tolerance = 1e-12 + 4.0 * np.finfo(np.float64).eps * omega * ocean.loop
    yield Check(
        "loop of the waves",
        "direct sum at t = 0 and T",
        float(np.max(np.abs(change))) / scale,
        tolerance,
        "the rounding of omega T",
    )


def _parseval(ocean: Ocean, t: float) -> Iterator[Check]:
    """Compare the variance of the height in space with the energies of its waves, with beats."""
    ocean = ocean.linear()  # whose waves are independent of each other
    height = ocean.frame(t, fields=("height",)).height.astype(np.float64)
    waves = ocean.modes()
    mx = np.rint(waves.kx / ocean.grid.dkx).astype(int)
    my = np.rint(waves.ky / ocean.grid.dky).astype(int)
    half = 0.5 * waves.amplitude * np.exp(-1j * (waves.omega * t + waves.phase))
    flip = (mx < 0) | ((mx == 0) & (my < 0))
    key = np.where(flip, -mx, mx) * (2 * ocean.grid.ny + 1) + np.where(flip, -my, my)
    wavenumbers, which = np.unique(key, return_inverse=True)
    summed = np.zeros(wavenumbers.size, dtype=np.complex128)
    np.add.at(summed, which, np.where(flip, np.conj(half), half))
    expected = 2.0 * float(np.sum(np.abs(summed) ** 2))
    yield Check(
        "Parseval",
        "energies of the waves",
        _relative(float(np.mean(height**2)), expected, _least(ocean) ** 2),
        2.0 * _tolerance(ocean, t),  # a square doubles a relative error
        "a mean of squares, at the fields' precision",
    )
    level = abs(float(np.mean(height))) / max(float(np.max(np.abs(height))), _least(ocean))
    yield Check("mean level", "0", level, _tolerance(ocean, t), "k = 0 carries nothing")


def _fixed_values(ocean: Ocean) -> Iterator[Check]:
    """Compare the values that the waves were made to have with the direct sum at their places."""
    fixes = ocean.amplitudes.fixed
    if not fixes:
        return
    ocean = ocean.linear()  # the values are those of these waves
    worst, omega = 0.0, float(np.max(ocean.modes().omega, initial=0.0))
    for fix in fixes:
        kind = [name for name in FIELDS if name.partition("_")[0] == fix.field.partition("_")[0]]
        frame = ocean.frame(fix.t, kind)
        largest = max(float(np.max(np.abs(frame[name]))) for name in kind)
        found = getattr(gerstner.surface(ocean, fix.x, fix.y, fix.t), fix.field)
        scale = max(largest, abs(fix.value), _least(ocean))
        worst = max(worst, abs(float(found) - fix.value) / scale)
    grid = ocean.grid
    far = max(max(abs(f.x) / grid.lx * grid.nx, abs(f.y) / grid.ly * grid.ny) for f in fixes)
    late = omega * max(abs(fix.t) for fix in fixes)
    yield Check(
        "fixed values",
        "direct sum at their places",
        worst,
        1e-12 + 4.0 * np.finfo(np.float64).eps * (far + late),
        "the rounding of k.x and omega t",
    )


def _conditional_energy(ocean: Ocean) -> tuple[float, float]:
    """
    Return the expected m0 of waves that have fixed values, and the tolerance of one realisation,
    relative to it.

    Conditioned on the values b, the amplitudes z of the waves have the mean E c* Lambda^-1 b and
    the covariance that remains; half of the squares of both is the energy. To the tolerance of
    `_likely` comes that of the products of the mean with the rest, Gaussian with the variance sum
    of E |mean|^2.
    """
    a = ocean.amplitudes
    kx, ky = np.broadcast_arrays(ocean.grid.kx[None, :], ocean.grid.ky[:, None])
    ahead, against = a.variance_forward > 0.0, a.variance_backward > 0.0
    against[:, 0] = False
    energy = np.concatenate([a.variance_forward[ahead], a.variance_backward[against]])
    kx, ky = (np.concatenate([k[ahead], -k[against]]) for k in (kx, ky))
    omega = np.concatenate([a.running_omega[ahead], a.running_omega[against]])
    rows = []
    for fix in a.fixed:
        field = FIELDS[fix.field]
        phase = np.exp(1j * (kx * fix.x + ky * fix.y - omega * fix.t))
        rows.append(multiplier(field, kx, ky, a.depth) * (-1j * omega) ** field.dt * phase)
    c, b = np.array(rows), np.array([fix.value for fix in a.fixed])
    covariance = np.real((c * energy) @ np.conj(c.T))
    scale = np.sqrt(np.maximum(np.diagonal(covariance), np.finfo(np.float64).tiny))
    inverse = np.linalg.pinv(covariance / np.outer(scale, scale), 1e-12, hermitian=True)
    inverse /= np.outer(scale, scale)
    mean = energy * (np.conj(c.T) @ (inverse @ b))
    lost = np.real(np.sum((inverse @ c) * np.conj(c), axis=0)) * energy**2
    expected = float(np.sum(energy) + 0.5 * np.sum(np.abs(mean) ** 2 - lost))
    spread = math.sqrt(float(np.sum(energy**2))) + math.sqrt(
        float(np.sum(energy * np.abs(mean) ** 2))
    )
    return expected, (4.0 * spread + 8.0 * float(np.max(energy))) / expected


def _energy(ocean: Ocean, statistics: Statistics) -> Iterator[Check]:
    """
    Compare energies: of the frame, of the sea's resolved and unresolved parts, of the realisation.
    """
    realised = 0.5 * float(np.sum(ocean.modes().amplitude ** 2))
    yield Check(
        "m0 of the frame",
        "sum of a^2/2",
        _relative(statistics.m0, realised, _least(ocean) ** 2),
        2e-6 if ocean.dtype == "float32" else 1e-11,
        "a forward FFT of the frame",
    )
    specified = statistics.specified
    if ocean.sea is None or specified is None or specified.m0 == 0.0:
        return
    yield Check(
        "energy resolved + lost",
        "specified m0, by quadrature",
        _relative(
            statistics.resolved + statistics.energy_below + statistics.energy_above, specified.m0
        ),
        1e-3,
        "the sum over cells against integrals along rays",
    )
    if statistics.resolved > 0.0 and ocean.amplitudes.fixed:
        expected, tolerance = _conditional_energy(ocean)
        yield Check(
            "m0 of this realisation",
            "m0 given the fixed values, averaged over seeds",
            _relative(realised, expected),
            tolerance,
            "at most 1 seed in 1500 is further off",
        )
    elif statistics.resolved > 0.0:
        tolerance, reason = _likely(ocean)
        yield Check(
            "m0 of this realisation",
            "resolved m0, averaged over seeds",
            _relative(realised, statistics.resolved),
            tolerance,
            reason,
        )


_STEEPNESS = (0.02, 0.01)
"""Sums of a k of the waves for which the conditions at the free surface are verified."""


def _free_surface(ocean: Ocean) -> Iterator[Check]:
    """
    Verify that an ocean of order 2 obeys the exact conditions at the free surface to second order.

    The strongest six of its waves, at the same choppiness and depth, are made ever less steep:
    what the two conditions leave over falls as the third power of steepness: over the square of
    steepness it halves where the steepness does. Linear waves alone would leave the second.
    """
    if ocean.bound_waves is None or len(ocean.bound_waves) == 0:
        return
    # Stokes' expansion is one in steepness over (kh)^3, too.
    waves = ocean.parents()
    k = np.hypot(waves.kx, waves.ky)
    chosen = np.argsort(-(waves.amplitude**2) * k, kind="stable")[:6]
    small = min(1.0, float(np.min(k[chosen])) * ocean.depth) ** 3
    left = [_residuals(ocean, chosen, small * steepness) for steepness in _STEEPNESS]
    for name, large, less in zip(("kinematic", "dynamic"), *left, strict=True):
        ratio = _STEEPNESS[0] / _STEEPNESS[1]
        yield Check(
            f"{name} condition",
            "residual/steepness^2, which falls with steepness",
            less * ratio**2 / large if large > 0.0 else 0.0,
            ratio**-0.98,  # an exponent of 2.98 or more: waves of some symmetries have 4
            "at steepness 0.01 over that at 0.02: 0.5; without pairs 1",
        )


def _residuals(ocean: Ocean, chosen: Integer, steepness: float) -> tuple[float, float]:
    """
    Return what the kinematic [m/s] and the dynamic condition [m^2/s^2] leave over: the standard
    deviation over the surface.

    Args:
        ocean: an ocean of order 2.
        chosen: numbers of some of its `parents`.
        steepness: sum of a k to which their amplitudes are scaled.
    """
    kx, ky, amplitude, phase, _ = (column[chosen] for column in ocean.parents())
    k, h, grid, t = np.hypot(kx, ky), ocean.depth, ocean.grid, 0.37
    amplitude = amplitude * (steepness / float(np.sum(amplitude * k)))
    mx, my = np.rint(kx / grid.dkx).astype(int), np.rint(ky / grid.dky).astype(int)
    water = Ocean.from_modes(
        zip(mx.tolist(), my.tolist(), amplitude.tolist(), phase.tolist(), strict=True),
        n=(4 * int(np.max(np.abs(mx))) + 16, 4 * int(np.max(np.abs(my))) + 16),
        size=(grid.lx, grid.ly),
        depth=h,
        choppiness=ocean.choppiness,
        dtype="float64",
        order=2,
    )
    frame, c = water.frame(t, tuple(FIELDS)), water.choppiness
    here = _points(water)[::-1]
    value = {name: frame[name][here] for name in FIELDS}
    x0, y0 = water.grid.x[here[1]], water.grid.y[here[0]]
    x, y, z = x0 + c * value["displace_x"], y0 + c * value["displace_y"], value["height"]

    # the potential: of the waves, phi = a g/omega sin(k.x - omega t - phase), and of the pairs
    omega = np.sqrt(GRAVITY * k * (1.0 if math.isinf(h) else np.tanh(k * h)))
    free = -1j * amplitude * GRAVITY / omega * np.exp(-1j * (omega * t + phase))
    assert water.bound_waves is not None  # it is of order 2
    pairs = water.bound_waves.cells(POTENTIAL, t, (0, 1))
    kx, ky = np.append(kx, pairs.kx), np.append(ky, pairs.ky)
    potential = np.append(free, pairs.values[0])
    rate = np.append(-1j * omega * free, pairs.values[1])
    k = np.hypot(kx, ky)
    wave = np.exp(1j * (np.outer(x, kx) + np.outer(y, ky)))
    if math.isinf(h):
        level = slope = np.exp(np.outer(z, k))
    else:
        # cosh k(z + h)/cosh kh and sinh k(z + h)/cosh kh, without large numbers
        rise, fall = np.exp(np.outer(z, k)), np.exp(-np.outer(z + 2.0 * h, k))
        level, slope = ((rise + s * fall) / (1.0 + np.exp(-2.0 * k * h)) for s in (1.0, -1.0))
    u, v = ((1j * m * potential * wave * level).sum(axis=1).real for m in (kx, ky))
    w = (k * potential * wave * slope).sum(axis=1).real
    phi_t = (rate * wave * level).sum(axis=1).real

    # the surface moves along its normal as the water does
    xx, xy, yy = (c * value[name] for name in ("stretch_xx", "stretch_xy", "stretch_yy"))
    sx, sy = value["slope_x"], value["slope_y"]
    normal = (xy * sy - (1.0 + yy) * sx, xy * sx - (1.0 + xx) * sy, (1.0 + xx) * (1.0 + yy) - xy**2)
    moving = (c * value["velocity_x"] - u, c * value["velocity_y"] - v, value["velocity_z"] - w)
    kinematic = sum(a * b for a, b in zip(normal, moving, strict=True))
    dynamic = phi_t + 0.5 * (u * u + v * v + w * w) + GRAVITY * z
    # less their means: k = 0 carries nothing, neither the level of a choppy surface (which opposite
    # waves raise and lower) nor a pressure that is the same everywhere
    return float(np.std(kinematic)), float(np.std(dynamic))


def _likely(ocean: Ocean) -> tuple[float, str]:
    """
    Return the tolerance of one realisation's m0, relative to the mean, and its reason.

    Gaussian waves have exponential energies, of mean E each. Their sum passes its mean by sqrt(2 u
    sum E^2) + u max(E) with a probability of at most e^-u (Laurent & Massart 2000, lemma 1); u = 8.
    """
    a = ocean.amplitudes
    if a.draw != "gaussian":
        return 1e-9, "fixed amplitudes"
    energy = np.concatenate([a.variance_forward.ravel(), a.variance_backward[:, 1:].ravel()])
    energy /= a.variance
    tolerance = 4.0 * math.sqrt(float(np.sum(energy**2))) + 8.0 * float(np.max(energy))
    return tolerance, "at most 1 seed in 3000 is further off"


def _relative(value: float, truth: float, least: float = 0.0) -> float:
    """
    Return the difference relative to the truth, or to the least value that counts.

    If both are 0, return the difference itself.
    """
    return abs(value - truth) / (max(truth, least) or 1.0)
