"""The lobe of a rough mirror: the GGX distribution, seen along the normal.

Engines filter a map once for each roughness as if it were looked at along the normal, which is
the direction of the reflection too (the split sum's assumption N = V = R). With h half-way
between the normal n and a direction l, n.h = cos(t), the filtered radiance is

    integral of L(l) D(h) (n.l) dl  /  integral of D(h) (n.l) dl,   n.l = cos(2 t).

References
----------
B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007 (GGX).
B. Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course (the split sum).
J. Krivanek and M. Colbert, "Real-time Shading with Filtered Importance Sampling", EGSR 2008.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

WIDER = 0.5
"""Levels of the pyramid by which samples are read coarser than their own solid angle: the
patches of neighbours overlap by then, and their pattern does not show (Krivanek and Colbert)."""

_GOLDEN = math.pi * (3.0 - math.sqrt(5.0))


class Samples(NamedTuple):
    """Directions about the normal, (0, 0, 1), in which a lobe is sampled.

    Attributes
    ----------
    vectors : ndarray of float32, shape (sample, 3)
        Unit vectors.
    weights : ndarray of float32, shape (sample,)
        Whose sum is 1.
    levels : ndarray of int64, shape (sample,)
        Of the pyramid that is read.
    """

    vectors: npt.NDArray[np.float32]
    weights: npt.NDArray[np.float32]
    levels: npt.NDArray[np.int64]


def density(alpha: float, cosine: Array) -> Array:
    """GGX's D of the cosine of the half vector's angle from the normal. [sr⁻¹]"""
    squared = alpha * alpha
    return squared / (math.pi * (cosine * cosine * (squared - 1.0) + 1.0) ** 2)


def lobe_total(alpha: float) -> float:
    """Return the integral of D(h) (n.l) over the directions l of the hemisphere."""
    # dl = 4 cos(t) dh and dh = 2 pi sin(t) dt = pi dx / sqrt(x), so that the integrand is
    # 4 pi D(x) (2 x - 1) dx from 1/2 to 1, with D = a / (pi (1 - b x)²), b = 1 - a, a = alpha².
    a = alpha * alpha
    b = 1.0 - a
    if b < 1e-4:
        return 1.0 + 2.0 / 3.0 * b
    first = 1.0 / a - 1.0 / (1.0 - 0.5 * b)
    logarithm = math.log((1.0 - 0.5 * b) / a)
    return 4.0 * a * ((2.0 / b**2 - 1.0 / b) * first - 2.0 / b**2 * logarithm)


def lobe_samples(alpha: float, count: int, edge: int, levels: int) -> Samples:
    """Return samples of a lobe in proportion to D, on a spiral of the golden angle.

    Parameters
    ----------
    alpha : float
        GGX's width, greater than 0 and at most 1.
    count : int
        How many; those below the surface fall away.
    edge, levels : int
        Of the pyramid's first cube [pixel], and how many cubes it has.
    """
    index = np.arange(count)
    u = (index + 0.5) / count
    squared = (1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u)
    cosine, sine = np.sqrt(squared), np.sqrt(1.0 - squared)
    along, height = 2.0 * cosine * sine, 2.0 * squared - 1.0
    turn = _GOLDEN * index
    vectors = np.stack([along * np.cos(turn), along * np.sin(turn), height], axis=-1)
    # The half vector's density is D cos(t), and dl = 4 cos(t) dh.
    patch = 4.0 / (count * density(alpha, cosine))
    texel = 4.0 * math.pi / (6.0 * edge * edge)
    level = np.rint(0.5 * np.log2(patch / texel) + WIDER)
    above = height > 0.0
    weights = height[above] / height[above].sum()
    return Samples(
        vectors[above].astype(np.float32),
        weights.astype(np.float32),
        np.clip(level[above], 0, levels - 1).astype(np.int64),
    )
