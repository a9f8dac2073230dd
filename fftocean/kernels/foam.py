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
