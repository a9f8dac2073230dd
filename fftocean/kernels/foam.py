"""One time step of foam: decay, and growth where water breaks."""

import numpy as np

from fftocean.arrays import Real
from fftocean.kernels.compiler import compiled


@compiled
def advance(
    before: Real,
    now: Real,
    then: Real,
    after: Real,
    cubic: Real,
    weights: Real,
    threshold: float,
    decay: float,
    state: Real,
) -> None:
    """
    Advance state to decay state + sum over i of weights[i] max(threshold - eigenvalue(u_i), 0).

    The smallest eigenvalue of the deformation gradient is a cubic through the four given times, and
    u_i are times from `now` to `then`: eigenvalue(u_i) is the sum of cubic[i] times the four. So a
    crest that breaks between two steps is not missed.
    """
    for j in range(state.shape[0]):
        a, b, c, d, f = before[j], now[j], then[j], after[j], state[j]
        for i in range(f.size):
            f[i] *= decay
        for u in range(weights.size):
            weight, first, second, third, fourth = (
                weights[u],
                cubic[u, 0],
                cubic[u, 1],
                cubic[u, 2],
                cubic[u, 3],
            )
            for i in range(f.size):
                below = threshold - (first * a[i] + second * b[i] + third * c[i] + fourth * d[i])
                f[i] += weight * (below if below > 0.0 else 0.0)


@compiled
def coverage(state: Real, out: Real) -> None:
    """Write out = 1 - e^{-state}, in 0..1."""
    for j in range(out.shape[0]):
        for i in range(out.shape[1]):
            out[j, i] = -np.expm1(-state[j, i])


@compiled
def means_on_loop(
    eigenvalue: Real, threshold: float, gain: float, decay: float, every: int
) -> tuple[float, float]:
    """
    Return the means of 1 - e^{-f} and of f over loops of the foam equation.

    f[i] = decay f[i - 1] + gain max(threshold - eigenvalue[i], 0) is the state that returns to
    itself; one loop a row. Coverage is taken at one sample in `every`.
    """
    covered, total, taken = 0.0, 0.0, 0
    count = eigenvalue.shape[1]
    for row in eigenvalue:
        f = 0.0
        for i in range(count):
            below = threshold - float(row[i])  # also where nothing is compiled
            f = decay * f + (gain * below if below > 0.0 else 0.0)
        f /= -np.expm1(count * np.log(decay))
        for i in range(count):
            below = threshold - float(row[i])  # also where nothing is compiled
            f = decay * f + (gain * below if below > 0.0 else 0.0)
            total += f
            if i % every == 0:
                covered -= np.expm1(-f)
                taken += 1
    return covered / taken, total / eigenvalue.size
