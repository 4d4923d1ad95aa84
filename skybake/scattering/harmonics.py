"""Real spherical harmonics that are even about the sun's azimuth.

Y_lm = Nlm * Plm(mu) * cos(m phi), orthonormal over the sphere. Coefficients of
a field are stored by l and then m: (0,0) (1,0) (1,1) (2,0) ... (L,L).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array


class Harmonics(NamedTuple):
    """Constants of the recurrence for one highest order.

    Attributes
    ----------
    order : int
        Highest l.
    degree, azimuthal : ndarray of int64, shape (harmonic,)
        l and m of each harmonic.
    up, back : ndarray of float64, shape (harmonic,)
        Factors of (l-1, m) times mu, and of (l-2, m).
    """

    order: int
    degree: npt.NDArray[np.int64]
    azimuthal: npt.NDArray[np.int64]
    up: Array
    back: Array


def build_harmonics(order: int) -> Harmonics:
    """Constants of the harmonics up to an order."""
    pairs = [(degree, m) for degree in range(order + 1) for m in range(degree + 1)]
    up, back = zip(*(_factors(degree, m) for degree, m in pairs), strict=True)
    degree, azimuthal = np.array(pairs).T.copy()
    return Harmonics(order, degree, azimuthal, np.array(up), np.array(back))


def _factors(degree: int, m: int) -> tuple[float, float]:
    if degree == m:
        return math.sqrt((2 * m + 1) / (2 * m) * (2.0 if m == 1 else 1.0)) if m else 0.0, 0.0
    scale = math.sqrt((4 * degree**2 - 1) / (degree**2 - m**2))
    below = degree - 1
    return scale, scale * math.sqrt((below**2 - m**2) / (4 * below**2 - 1))


def harmonics_at(harmonics: Harmonics, mu: Array) -> Array:
    """Nlm * Plm of several mu, shape (mu, harmonic)."""
    out = np.empty((mu.size, harmonics.degree.size))
    fill_each(harmonics, mu, out)
    return out


@kernel
def fill_each(harmonics, mu, out):
    """Call `fill_harmonics` for each mu, shape (mu,)."""
    for i in range(mu.size):
        fill_harmonics(harmonics, mu[i], out[i])


@kernel
def fill_harmonics(harmonics, mu, out):
    """Write Nlm * Plm(mu) to `out`, shape (harmonic,); times cos(m phi) they are Y_lm."""
    sine = math.sqrt(max(0.0, 1.0 - mu * mu))
    diagonal = math.sqrt(0.25 / math.pi)
    for m in range(harmonics.order + 1):
        i = m * (m + 3) // 2
        if m > 0:
            diagonal *= harmonics.up[i] * sine
        out[i] = diagonal
        before, last = 0.0, diagonal
        for degree in range(m + 1, harmonics.order + 1):
            i += degree
            value = harmonics.up[i] * mu * last - harmonics.back[i] * before
            out[i] = value
            before, last = last, value
