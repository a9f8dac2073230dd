"""
Direct sum of second-order waves, in float64, pair by pair.

It is the reference for `Ocean(..., order=2)`, and shares neither formula nor code with it: here are
the interaction coefficients of two real waves in cosines, of Dalzell.
"""

import math
from typing import NamedTuple, Protocol

import numpy as np

from fftocean.arrays import Real
from fftocean.constants import GRAVITY


class ParentColumns(Protocol):
    """The waves that have bound waves, each array (m,); omega as the waves run."""

    @property
    def kx(self) -> Real: ...
    @property
    def ky(self) -> Real: ...
    @property
    def amplitude(self) -> Real: ...
    @property
    def phase(self) -> Real: ...
    @property
    def omega(self) -> Real: ...


class Pairs(NamedTuple):
    """Bound waves: eta2 = sum of amplitude cos(kx x + ky y - omega t - phase), each (pairs,)."""

    kx: Real
    ky: Real
    amplitude: Real
    phase: Real
    omega: Real


def coefficients(k1: Real, k2: Real, cosine: Real, depth: float) -> tuple[Real, Real]:
    """
    Return B+ and B- of two waves: eta2 = a1 a2 (B+ cos(f1 + f2) + B- cos(f1 - f2)).

    Args:
        k1, k2: wavenumbers [rad/m].
        cosine: of the angle between the waves.
        depth: still-water depth [m], inf is deep.

    Returns:
        Two arrays of the shape that the arguments broadcast to [1/m].

    Source: Dalzell 1999 (Applied Ocean Research 21), for arbitrary depth.
    """
    g = GRAVITY
    deep = math.isinf(depth)

    def bed(k: Real) -> Real:
        """Return tanh kh."""
        return np.ones_like(k) if deep else np.tanh(k * depth)

    t1, t2 = bed(k1), bed(k2)
    w1, w2 = np.sqrt(g * k1 * t1), np.sqrt(g * k2 * t2)
    # 1/sinh^2 = 1/tanh^2 - 1
    cube1, cube2 = w1**3 * (1.0 / t1**2 - 1.0), w2**3 * (1.0 / t2**2 - 1.0)
    found = []
    for sign in (1.0, -1.0):
        k = np.sqrt(np.maximum(k1 * k1 + k2 * k2 + 2.0 * sign * k1 * k2 * cosine, 0.0))
        w, gkt = w1 + sign * w2, g * k * bed(k)
        with np.errstate(divide="ignore", invalid="ignore"):
            b = (
                (w1 * w1 + w2 * w2) / (2.0 * g)
                - sign
                * (w1 * w2 / (2.0 * g))
                * (1.0 - sign * cosine / (t1 * t2))
                * ((w * w + gkt) / (w * w - gkt))
                + w / (2.0 * g * (w * w - gkt)) * (cube1 + sign * cube2)
            )
        found.append(b)
    return found[0], found[1]


def pairs(waves: ParentColumns, depth: float, choppiness: float) -> Pairs:
    """
    Return the bound waves of all pairs, without those of infinite length.

    A surface displaced by `choppiness` D has -choppiness D.grad eta1 of them already: that is, for
    two waves of displacement a coth(kh) k/|k|, choppiness a1 a2 (k1^.k2 coth k1h + k2^.k1 coth
    k2h)/2 (cos(f1 + f2) - cos(f1 - f2)).
    """
    one, two = np.triu_indices(waves.kx.size)
    k = np.sqrt(waves.kx**2 + waves.ky**2)
    k1, k2 = k[one], k[two]
    ux, uy = waves.kx / k, waves.ky / k
    cosine = ux[one] * ux[two] + uy[one] * uy[two]
    plus, minus = coefficients(k1, k2, cosine, depth)
    coth = 1.0 / (np.ones_like(k) if math.isinf(depth) else np.tanh(k * depth))
    moved = 0.5 * choppiness * cosine * (k2 * coth[one] + k1 * coth[two])
    # a wave with itself: half of what two equal waves have
    alone = np.where(one == two, 0.5, 1.0) * waves.amplitude[one] * waves.amplitude[two]
    parts = []
    for sign, coefficient in ((1.0, plus - moved), (-1.0, minus + moved)):
        kx = waves.kx[one] + sign * waves.kx[two]
        ky = waves.ky[one] + sign * waves.ky[two]
        some = np.hypot(kx, ky) > 1e-9 * k1
        parts.append(
            (
                kx[some],
                ky[some],
                (alone * coefficient)[some],
                (waves.phase[one] + sign * waves.phase[two])[some],
                (waves.omega[one] + sign * waves.omega[two])[some],
            )
        )
    return Pairs(*(np.concatenate(column) for column in zip(*parts, strict=True)))
