"""Directional spectra from the directional moments that buoys report."""

from typing import Any, Final

import numpy as np

from fftocean.arrays import Complex, Real
from fftocean.readers.maximum_entropy import maximum_entropy

METHOD: Final = "maximum entropy (Kobune & Hashimoto 1986)"
_CHUNK: Final = 64  # records unfolded at a time, so that their arrays fit in the cache


def compass(bins: int) -> Real:
    """Return `bins` equally spaced directions round the compass, from north [degrees]."""
    return 360.0 / bins * np.arange(bins)


def unfold(s: Real, c1: Complex, c2: Complex, bins: int) -> tuple[Real, dict[str, Any]]:
    """
    Return densities spread over directions by maximum entropy, with two moments of each.

    Args:
        s: (time, f) density [m2/Hz]; NaN is missing.
        c1, c2: (time, f) r1 e^{i a1}, r2 e^{2 i a2}, of the directions FROM, clockwise from north;
            NaN is not measured.
        bins: directions round the compass.

    Returns:
        (time, f, bins) density [m2/Hz/degree] on `compass(bins)`, and notes on missing and
        limited moments.
    """
    density = np.empty((*s.shape, bins))
    limited = 0
    for i in range(0, len(s), _CHUNK):
        piece = slice(i, i + _CHUNK)
        unfolded = maximum_entropy(c1[piece], c2[piece], bins)
        density[piece] = s[piece, :, None] * unfolded.share * (bins / 360.0)
        limited += int(np.count_nonzero(unfolded.limited & (s[piece] > 0.0)))
    return density, {
        "undirected_densities": int(np.count_nonzero(np.isnan(c1) & (s > 0.0))),
        "limited_moments": limited,
        "directional_method": METHOD,
    }


def from_spread(mean: Real, spread: Real) -> Complex:
    """
    Return the first moment of a mean direction and a spread, sigma = sqrt(2 (1 - r1)).

    Args:
        mean: [degrees].
        spread: [degrees], at most 81.03 (r1 = 0); NaN is not measured.

    Source: Kuik, van Vledder & Holthuijsen, J. Phys. Oceanogr. 18 (1988) 1020, eq. 17.
    """
    r1 = np.maximum(1.0 - 0.5 * np.radians(spread) ** 2, 0.0)
    return np.asarray(r1 * np.exp(1j * np.radians(mean)), dtype=np.complex128)


def from_centred(
    mean: Real, spread: Real, skewness: Real, kurtosis: Real
) -> tuple[Complex, Complex]:
    """
    Return both moments of the four parameters of Kuik et al., which Datawell's buoys report.

    With the centred moments m1, m2 (cosine) and n2 (sine): sigma^2 = 2 (1 - m1), gamma = -n2 / ((1
    - m2)/2)^(3/2), delta = (6 - 8 m1 + 2 m2) / sigma^4; solved for the moments.

    Source: Kuik, van Vledder & Holthuijsen, J. Phys. Oceanogr. 18 (1988) 1020, eq. 17 to 19.
    """
    sigma2 = np.radians(spread) ** 2
    m1 = 1.0 - 0.5 * sigma2
    m2 = 0.5 * (kurtosis * sigma2**2 - 6.0 + 8.0 * m1)
    n2 = -skewness * np.maximum(0.5 * (1.0 - m2), 0.0) ** 1.5
    turn = np.exp(1j * np.radians(mean))
    return from_spread(mean, spread), np.asarray((m2 + 1j * n2) * turn**2, dtype=np.complex128)
