"""Harmonics of linear polarisation, which is even (Q) or odd (U) about the sun's azimuth.

With psi the sun's azimuth to the left of the view's,
Q = sum cos(m psi) (E_lm W_lm + B_lm X_lm) and U = sum sin(m psi) (E_lm X_lm + B_lm W_lm);
W and X are even and odd sums of the generalised spherical functions of spin 2 and -2, orthonormal
over the sphere. Moments are stored by l and m as those of `skybake.scattering.harmonics`, 0 for
l below 2.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array


class SpinHarmonics(NamedTuple):
    """Constants of the recurrence for one highest order, those of (l, m) at `place`.

    Attributes
    ----------
    order : int
        Highest l, at least 2.
    scale : ndarray of float64, shape (harmonic,)
        Norm of the functions.
    up, turn, back : ndarray of float64, shape (harmonic,)
        Factors of (l - 1, m) times mu, of (l - 1, m) times half the spin, and of (l - 2, m).
    first : ndarray of float64, shape (order + 1,)
        Factor of the least l of each m.
    """

    order: int
    scale: Array
    up: Array
    turn: Array
    back: Array
    first: Array


def build_spin_harmonics(order: int) -> SpinHarmonics:
    """Constants of the harmonics up to an order."""
    size = harmonic_count(order)
    scale, up, turn, back = (np.zeros(size) for _ in range(4))
    for m in range(order + 1):
        for degree in range(max(m, 2), order + 1):
            place = degree * (degree + 1) // 2 + m
            scale[place] = math.sqrt((2 * degree + 1) / (8.0 * math.pi)) * (1.0 if m else 0.5**0.5)
            below = degree - 1
            if below < max(m, 2):
                continue
            ahead = below * math.sqrt((degree**2 - m**2) * (degree**2 - 4))
            up[place] = (2 * below + 1) * below * degree / ahead
            turn[place] = (2 * below + 1) * 2 * m / ahead
            back[place] = degree * math.sqrt((below**2 - m**2) * (below**2 - 4)) / ahead
    pairs = [math.sqrt(math.comb(2 * m, m - 2)) for m in range(2, order + 1)]
    return SpinHarmonics(order, scale, up, turn, back, np.array([math.sqrt(6.0), 2.0, *pairs]))


def harmonic_count(order: int) -> int:
    """Moments up to an order."""
    return (order + 1) * (order + 2) // 2


@kernel
def fill_spin_harmonics(harmonics, mu, out):
    """Write W_lm and X_lm to `out`, shape (2, harmonic)."""
    cosine, sine = math.sqrt(max(0.5 * (1.0 + mu), 0.0)), math.sqrt(max(0.5 * (1.0 - mu), 0.0))
    both = cosine * sine
    out[...] = 0.0
    product = 1.0
    for m in range(harmonics.order + 1):
        # The functions of spin 2 and -2; as of m = 3 with one more factor each.
        if m == 0:
            plus = minus = harmonics.first[0] * both * both
        elif m == 1:
            plus = -harmonics.first[1] * both * cosine * cosine
            minus = harmonics.first[1] * both * sine * sine
        else:
            plus = harmonics.first[m] * product * cosine**4
            minus = harmonics.first[m] * product * sine**4
            product *= both
        before_plus = before_minus = 0.0
        least = max(m, 2)
        for degree in range(least, harmonics.order + 1):
            place = degree * (degree + 1) // 2 + m
            if degree > least:
                up, turn, back = harmonics.up[place], harmonics.turn[place], harmonics.back[place]
                next_plus = (up * mu - turn) * plus - back * before_plus
                next_minus = (up * mu + turn) * minus - back * before_minus
                before_plus, before_minus = plus, minus
                plus, minus = next_plus, next_minus
            out[0, place] = harmonics.scale[place] * (minus + plus)
            out[1, place] = harmonics.scale[place] * (minus - plus)


@kernel
def fill_each_spin(harmonics, mu, out):
    """Call `fill_spin_harmonics` for each mu."""
    for i in range(mu.size):
        fill_spin_harmonics(harmonics, mu[i], out[i])
