"""Real spherical harmonics in which directions are not symmetric about the sun.

They are scaled such that the sum over m of Y_lm(a) Y_lm(b) is P_l(a·b). The order is (0, 0),
(1, -1), (1, 0), (1, 1), (2, -2) ...; negative m go with sines of the azimuth.
"""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array


@kernel
def fill_harmonics(x, y, z, order, out):
    """Write all harmonics up to an order, of a unit vector, to `out`, shape ((order + 1)²,).

    Schmidt's recurrence in l for each m, started at l = m.
    """
    diagonal, cosine, sine = 1.0, 1.0, 0.0
    for m in range(order + 1):
        if m > 0:
            cosine, sine = cosine * x - sine * y, sine * x + cosine * y
            diagonal *= math.sqrt((2.0 * m - 1.0) / (2.0 * m)) if m > 1 else 1.0
        below, here = 0.0, diagonal
        for degree in range(m, order + 1):
            at = degree * degree + degree
            out[at + m] = here * cosine
            if m > 0:
                out[at - m] = here * sine
            up = degree + 1.0
            root = math.sqrt(up * up - m * m)
            back = math.sqrt(degree * degree - m * m)
            below, here = here, ((2.0 * degree + 1.0) * z * here - back * below) / root


def harmonics_of(directions: Array, order: int) -> Array:
    """Harmonics of unit vectors, shape (direction, (order + 1)²)."""
    out = np.empty((len(directions), (order + 1) ** 2))
    for row, (x, y, z) in zip(out, directions.tolist(), strict=True):
        fill_harmonics(x, y, z, order, row)
    return out


def degrees(order: int) -> np.ndarray:
    """Degree l of each harmonic up to an order."""
    return np.repeat(np.arange(order + 1), 2 * np.arange(order + 1) + 1)
