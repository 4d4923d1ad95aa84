"""Real spherical harmonics that are even about the sun's azimuth.

Y_lm = Nlm * Plm(mu) * cos(m phi), orthonormal over the sphere. Coefficients of
a field are stored by m and then l: (0,0) (0,1) ... (0,L) (1,1) ... (L,L).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.optics.medium import Array
from skybake.transport.kernel import kernel


class Harmonics(NamedTuple):
    """Constants of the recurrence for one highest order.

    Attributes
    ----------
    order : int
        Highest l.
    degree : ndarray of int64, shape (harmonic,)
        l of each harmonic.
    up, back : ndarray of float64, shape (harmonic,)
        Factors of (l-1, m) times mu, and of (l-2, m).
    """

    order: int
    degree: npt.NDArray[np.int64]
    up: Array
    back: Array


def build_harmonics(order: int) -> Harmonics:
    """Constants of the harmonics up to an order."""
    degree, up, back = [], [], []
    for m in range(order + 1):
        for degree_ in range(m, order + 1):
            degree.append(degree_)
            if degree_ == m:
                up.append(math.sqrt((2 * m + 1) / (2 * m) * (2.0 if m == 1 else 1.0)) if m else 0.0)
                back.append(0.0)
                continue
            scale = math.sqrt((4 * degree_**2 - 1) / (degree_**2 - m**2))
            up.append(scale)
            below = degree_ - 1
            back.append(scale * math.sqrt((below**2 - m**2) / (4 * below**2 - 1)))
    return Harmonics(order, np.array(degree), np.array(up), np.array(back))


@kernel
def fill_harmonics(harmonics, mu, out):
    """Write Nlm * Plm(mu) to `out`, shape (harmonic,); times cos(m phi) they are Y_lm."""
    sine = math.sqrt(max(0.0, 1.0 - mu * mu))
    diagonal = math.sqrt(0.25 / math.pi)
    i = 0
    for m in range(harmonics.order + 1):
        if m > 0:
            diagonal *= harmonics.up[i] * sine
        out[i] = diagonal
        before, last = 0.0, diagonal
        for j in range(i + 1, i + harmonics.order + 1 - m):
            value = harmonics.up[j] * mu * last - harmonics.back[j] * before
            out[j] = value
            before, last = last, value
        i += harmonics.order + 1 - m
