"""The share of a limb-darkened disc's light that passes a moon in front of it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel

Array = npt.NDArray[np.float64]

POWERS = 3
"""Powers of mu that a disc's radiance is a sum of, from 0 on."""

NODES = 128
"""Intervals of the separation at which a moon covers the sun's edge, and again inside it."""

RATIOS = 33
"""Ratios of the two radii."""

_GAUSS_NODES, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(96)


class ShareTable(NamedTuple):
    """Uncovered light of a disc over the separation and the ratio of the radii.

    Attributes
    ----------
    first_ratio, ratio_step : float
        Radius of the moon over that of the sun, at the first node and between nodes.
    uncovered : ndarray of float64, shape (RATIOS, 2 * NODES + 1, POWERS)
        Integrals of the powers of mu over what is uncovered, over pi sun radii squared. The first
        half is where the moon is within the sun's disc, or the sun behind the moon's, the
        second where their edges cross.
    """

    first_ratio: float
    ratio_step: float
    uncovered: Array


def powers_from_limb_darkening(limb_darkening: Array) -> Array:
    """Weights of the powers of mu in the light of a whole disc, which is 1.

    Parameters
    ----------
    limb_darkening : ndarray of float64, shape (2, wavelength)
        Coefficients u and v of I(mu)/I(1) = 1 - u (1 - mu) - v (1 - mu²).

    Returns
    -------
    ndarray of float64, shape (POWERS, wavelength)
        Of the integrals of `uncovered_powers`.
    """
    u, v = limb_darkening
    weights: Array = np.stack([1.0 - u - v, u, v]) / (1.0 - u / 3.0 - v / 2.0)
    return weights


def uncovered_powers(separation: npt.ArrayLike, ratio: npt.ArrayLike) -> Array:
    """Integrals of the powers of mu over what a moon leaves of the sun's disc.

    Parameters
    ----------
    separation, ratio : array_like, broadcast to shape (...)
        Of the two centres, and radius of the moon, both over the radius of the sun.

    Returns
    -------
    ndarray of float64, shape (..., POWERS)
        Over pi times the square of the sun's radius: 1, 2/3 and 1/2 for a whole disc.

    Notes
    -----
    By Gauss-Legendre quadrature over rings of the sun, of which the moon covers an arc. The
    variable is stretched at both ends, where the arc begins as a square root, so that 96
    nodes leave an error below 1e-8.
    """
    z, k = np.broadcast_arrays(
        np.asarray(separation, dtype=float)[..., None], np.asarray(ratio, dtype=float)[..., None]
    )
    low, high = np.minimum(np.abs(z - k), 1.0), np.minimum(z + k, 1.0)
    place = np.sin(0.25 * math.pi * (_GAUSS_NODES + 1.0)) ** 2
    slope = 0.25 * math.pi * np.sin(0.5 * math.pi * (_GAUSS_NODES + 1.0)) * _GAUSS_WEIGHTS
    radius = low + (high - low) * place
    cosine = (radius**2 + z**2 - k**2) / np.maximum(2.0 * radius * z, 1e-300)
    arc = np.arccos(np.clip(cosine, -1.0, 1.0))
    weight = 2.0 / math.pi * radius * arc * slope * (high - low)
    # Rings that the moon covers all around.
    whole = np.minimum(np.maximum(k - z, 0.0), 1.0)[..., 0] ** 2
    powers = []
    for n in range(POWERS):
        half = 0.5 * n
        covered = (weight * np.maximum(1.0 - radius**2, 0.0) ** half).sum(axis=-1)
        covered += (1.0 - (1.0 - whole) ** (half + 1.0)) / (half + 1.0)
        powers.append(1.0 / (half + 1.0) - covered)
    uncovered: Array = np.maximum(np.stack(powers, axis=-1), 0.0)
    return uncovered


def build_share_table(least_ratio: float, greatest_ratio: float) -> ShareTable:
    """Tabulate the uncovered light for ratios of the radii between two.

    Parameters
    ----------
    least_ratio, greatest_ratio : float
        Radius of the moon over that of the sun, greater than 0.
    """
    first = least_ratio
    step = max((greatest_ratio - least_ratio) / (RATIOS - 2), 1e-6)
    if least_ratio < 1.0 < greatest_ratio:
        # What a moon as large as the sun leaves has a kink, which shall be at a node.
        first = 1.0 - math.ceil((1.0 - least_ratio) / step) * step
    ratio = first + step * np.arange(RATIOS)[:, None]
    x = np.linspace(0.0, 1.0, NODES + 1)
    touching = np.abs(1.0 - ratio)
    inside = touching * np.sin(0.5 * math.pi * x[:-1])
    crossing = touching + (1.0 + ratio - touching) * np.sin(0.5 * math.pi * x) ** 2
    separation = np.concatenate([inside, crossing], axis=1)
    return ShareTable(first, step, uncovered_powers(separation, ratio))


@kernel
def fill_share(table, powers, separation, ratio, out):
    """Write the uncovered share of a disc's light, shape (wavelength,).

    Parameters
    ----------
    table : ShareTable
        The table.
    powers : ndarray of float64, shape (POWERS, wavelength)
        Result of `powers_from_limb_darkening`.
    separation, ratio : float
        As of `uncovered_powers`.
    out : ndarray of float64, shape (wavelength,)
        Receives the share, from 0 to 1.
    """
    if separation >= 1.0 + ratio:
        for w in range(out.size):
            out[w] = 1.0
        return
    last = table.uncovered.shape[1] - 1
    half = last // 2
    touching = abs(1.0 - ratio)
    if separation < touching:
        if ratio >= 1.0:
            for w in range(out.size):
                out[w] = 0.0
            return
        y = half * (2.0 / math.pi) * math.asin(separation / touching)
    else:
        across = (separation - touching) / (1.0 + ratio - touching)
        y = half * (1.0 + (2.0 / math.pi) * math.asin(math.sqrt(min(across, 1.0))))
    j = min(int(y), last - 1)
    v = y - j
    x = (ratio - table.first_ratio) / table.ratio_step
    i = min(max(int(x), 0), table.uncovered.shape[0] - 2)
    u = min(max(x - i, 0.0), 1.0)
    near, far = table.uncovered[i], table.uncovered[i + 1]
    for w in range(out.size):
        out[w] = 0.0
    for n in range(powers.shape[0]):
        low = near[j, n] + v * (near[j + 1, n] - near[j, n])
        high = far[j, n] + v * (far[j + 1, n] - far[j, n])
        value = low + u * (high - low)
        for w in range(out.size):
            out[w] += powers[n, w] * value
    for w in range(out.size):
        out[w] = min(max(out[w], 0.0), 1.0)
