"""From h0 to h(t): how far each wave has turned, then the spectra of height, of its rate of change, and of their derivatives."""

import numpy as np

from fftocean.arrays import Complex, Integer, Real
from fftocean.kernels.compiler import compiled


@compiled
def turns_at(coarse: Real, fine: Real, t_coarse: float, t_fine: float, out: Real) -> None:
    """
    out = frac((coarse + fine) (t_coarse + t_fine)): turns made at time t, in [-1/2, 1/2], at any t as exact as the frequency.

    `coarse` and `t_coarse` hold the leading 26 bits of frequency and time, so the two large products are exact, and whole
    turns can be dropped from them without loss.
    """
    t = t_coarse + t_fine
    for j in range(out.shape[0]):
        for i in range(out.shape[1]):
            first = coarse[j, i] * t_coarse
            second = coarse[j, i] * t_fine
            whole = (first - np.rint(first)) + (second - np.rint(second)) + fine[j, i] * t
            out[j, i] = whole - np.rint(whole)


@compiled
def turns_in_loop(cycles: Integer, step: int, count: int, out: Real) -> None:
    """out = (cycles step mod count) / count: turns made at the step-th of `count` moments of a loop, in whole numbers."""
    for j in range(out.shape[0]):
        for i in range(out.shape[1]):
            out[j, i] = ((cycles[j, i] % count) * step % count) / count


@compiled
def evolve(forward: Complex, backward: Complex, turns: Real, out: Complex) -> None:
    """out = forward e^{-2 pi i turns} + backward e^{+2 pi i turns}, in double precision until it is stored."""
    for j in range(out.shape[0]):
        for i in range(out.shape[1]):
            angle = 2.0 * np.pi * turns[j, i]
            phasor = complex(np.cos(angle), -np.sin(angle))
            out[j, i] = forward[j, i] * phasor + backward[j, i] * phasor.conjugate()


@compiled
def evolve_rate(forward: Complex, backward: Complex, turns: Real, omega: Real, out: Complex) -> None:
    """out = -i omega (forward e^{-2 pi i turns} - backward e^{+2 pi i turns}): the time derivative of `evolve`."""
    for j in range(out.shape[0]):
        for i in range(out.shape[1]):
            angle = 2.0 * np.pi * turns[j, i]
            phasor = complex(np.cos(angle), -np.sin(angle))
            out[j, i] = -1j * omega[j, i] * (forward[j, i] * phasor - backward[j, i] * phasor.conjugate())


@compiled
def multiply(spectrum: Complex, factor: Real, out: Complex) -> None:
    """out = factor spectrum."""
    for j in range(out.shape[0]):
        for i in range(out.shape[1]):
            out[j, i] = spectrum[j, i] * factor[j, i]


@compiled
def differentiate(spectrum: Complex, along_x: Real, along_y: Real, unit: complex, out: Complex) -> None:
    """out[j, i] = unit along_y[j] along_x[i] spectrum[j, i]: with kx^a, ky^b and i^(a + b), the derivative d^a/dx^a d^b/dy^b."""
    for j in range(out.shape[0]):
        row = unit * along_y[j]
        for i in range(out.shape[1]):
            out[j, i] = row * along_x[i] * spectrum[j, i]
