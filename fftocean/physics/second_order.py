"""Second-order interaction of two waves in water of any depth, and the skewness that follows."""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from fftocean.arrays import Real, brief_repr
from fftocean.constants import GRAVITY


@dataclass(frozen=True, slots=True, eq=False)
class Components:
    """
    Signed components a e^{i(k.x - omega t)} of waves without surface tension, arrays of one shape.

    Each real wave has two: this one, and its `conjugate` with the conjugate amplitude.
    """

    kx: Real  # [rad/m]
    ky: Real  # [rad/m]
    omega: Real  # of the dispersion relation [rad/s]; negative in a conjugate

    __repr__ = brief_repr

    @property
    def conjugate(self) -> "Components":
        """The components of the opposite wavenumber and frequency."""
        return Components(-self.kx, -self.ky, -self.omega)

    def part(self, index: Any) -> "Components":
        """Return the components at an index, as of an array."""
        return Components(self.kx[index], self.ky[index], self.omega[index])


class Interaction(NamedTuple):
    """
    Coefficients of the product a_i a_j e^{i(K.x - W t)} of two components, K = k_i + k_j and
    W = omega_i + omega_j. All three are 0 where K = 0.
    """

    elevation: Real  # C [1/m]: in eta2
    potential: Real  # b [1/s]: in phi2 at the mean level, as i b
    displaced: Real  # Cc [1/m]: what linear waves have of C after a displacement of choppiness 1


def interaction(first: Components, second: Components, depth: float) -> Interaction:
    """
    Return the second-order coefficients of pairs of components.

    The two conditions at the free surface, expanded about z = 0, are at second order

        phi2_t + g eta2 = -R,      R = eta1 phi1_zt + |grad phi1|^2/2
        eta2_t - phi2_z =  Q,      Q = -grad phi1.grad eta1 + eta1 phi1_zz

    and for a pair of components, with T = |K| tanh |K|h,

        R = (g^2 k_i.k_j/(w_i w_j) - w_i w_j - w_i^2 - w_j^2)/2
        Q = i q,     q = -g/2 (k_i.k_j (1/w_i + 1/w_j) + k_i^2/w_i + k_j^2/w_j)
        phi2 = i b,  b = (g q - W R)/(W^2 - g T)
        eta2 = C,    C = -(W b + R)/g

    A sum over all ordered pairs of signed components gives eta2 and phi2; phi2 falls off below the
    surface as cosh |K|(z + h)/cosh |K|h. Linear waves whose water is displaced horizontally by D
    have -D.grad eta1 of eta2 already:

        Cc = k_i.k_j/2 (1/(|k_i| tanh |k_i|h) + 1/(|k_j| tanh |k_j|h)).

    Args:
        first, second: components whose arrays broadcast.
        depth: still-water depth h [m]; `math.inf` is deep water.

    Source: Longuet-Higgins 1963 (J. Fluid Mech. 17), in the form of Sharma & Dean 1981 (SPE J. 21);
    Dalzell 1999 (Appl. Ocean Res. 21) has the same in cosines.
    Pinned by tests/physics/test_second_order.py: Stokes' wave in any depth, two collinear waves in
    deep water, skewness of the package roguewavespectrum; and by tests/test_second_order_ocean.py:
    the exact conditions at the free surface.
    """
    x1, y1, w1 = first.kx, first.ky, first.omega
    x2, y2, w2 = second.kx, second.ky, second.omega
    dot = x1 * x2 + y1 * y2
    square1, square2 = x1 * x1 + y1 * y1, x2 * x2 + y2 * y2
    kx, ky, w = x1 + x2, y1 + y2, w1 + w2
    k = np.hypot(kx, ky)
    steepness = k if math.isinf(depth) else k * np.tanh(np.minimum(k * depth, 350.0))
    product = w1 * w2
    r = 0.5 * (GRAVITY**2 * dot / product - product - w1 * w1 - w2 * w2)
    q = -0.5 * GRAVITY * (dot * (1.0 / w1 + 1.0 / w2) + square1 / w1 + square2 / w2)
    resonance = w * w - GRAVITY * steepness
    some = (k > 0.0) & (resonance != 0.0)
    b = np.divide(GRAVITY * q - w * r, resonance, out=np.zeros_like(resonance), where=some)
    # omega^2 = g k tanh kh
    shift = 0.5 * GRAVITY * dot * (1.0 / (w1 * w1) + 1.0 / (w2 * w2))
    return Interaction(
        elevation=np.where(some, -(w * b + r) / GRAVITY, 0.0),
        potential=b,
        displaced=np.where(some, shift, 0.0),
    )


def skewness(waves: Components, variance: Real, depth: float) -> float:
    """
    Return the skewness of the surface elevation of many Gaussian waves, <eta^3>/m0^1.5 [-].

    It is 3 sum over all ordered pairs of (C(k_i, k_j) + C(k_i, -k_j)) E_i E_j / m0^1.5.

    Args:
        waves: (m,).
        variance: E_i of each wave [m^2], (m,).
        depth: still-water depth [m].

    Source: Longuet-Higgins 1963, eq. 3.10 to 3.13.
    """
    m0 = float(np.sum(variance))
    if not m0 > 0.0:
        return 0.0
    some = variance > 0.0
    waves, variance = waves.part(some), variance[some]
    total = 0.0
    rows = max(1, _PAIRS // variance.size)
    for start in range(0, variance.size, rows):
        part = slice(start, start + rows)
        ours = waves.part(part).part((slice(None), None))
        both = (
            interaction(ours, waves, depth).elevation
            + interaction(ours, waves.conjugate, depth).elevation
        )
        total += float(np.einsum("i,ij,j->", variance[part], both, variance))
    return 3.0 * total / float(m0**1.5)


_PAIRS = 2**16
"""Pairs of waves at a time: what is made on the way stays in cache."""
