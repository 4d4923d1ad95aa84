"""Spherical harmonics of three bands, of the light and of the irradiance that it makes.

References
----------
R. Ramamoorthi and P. Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
SIGGRAPH 2001: basis functions in equation 3, the clamped cosine's factors in equation 8.
"""

from __future__ import annotations

import math

import numpy as np

from skybake.ibl.cube import Array, Cube, texel_directions, texel_sizes
from skybake.ibl.points import Points

NAMES = ("L00", "L1-1", "L10", "L11", "L2-2", "L2-1", "L20", "L21", "L22")
"""Band and order of each coefficient."""

BASIS = ("1", "y", "z", "x", "x y", "y z", "3 z^2 - 1", "x z", "x^2 - y^2")
"""What each coefficient's function is, but for its factor in `NORMALISATION`."""

_ROOT = math.sqrt(1.0 / math.pi)

NORMALISATION = np.array(
    [
        0.5 * _ROOT,
        *[math.sqrt(3.0) / 2.0 * _ROOT] * 3,
        *[math.sqrt(15.0) / 2.0 * _ROOT] * 2,
        math.sqrt(5.0) / 4.0 * _ROOT,
        math.sqrt(15.0) / 2.0 * _ROOT,
        math.sqrt(15.0) / 4.0 * _ROOT,
    ]
)
"""Factors by which the functions are orthonormal."""

COSINE = np.array([math.pi, *[2.0 * math.pi / 3.0] * 3, *[math.pi / 4.0] * 5])
"""Factors from the harmonics of light to those of irradiance."""


def harmonics_of(cube: Cube, points: Points) -> Array:
    """Return the coefficients of light from all around, by quadrature.

    Parameters
    ----------
    cube : ndarray of float32, shape (6, n, n, 3)
        The light but for the points.
    points : Points
        Light from points.

    Returns
    -------
    ndarray of float64, shape (9, 3)
        Integrals of light times each function, in the order of `NAMES`. The functions have no
        signs of their own: a light from +X, +Y or +Z has positive coefficients there.
    """
    edge = cube.shape[1]
    sizes, directions = texel_sizes(edge)[..., None], texel_directions(edge)
    total: Array = basis(points.directions).T @ points.flux
    for face, toward in zip(cube, directions, strict=True):
        light = (face * sizes).reshape(-1, 3)
        total += basis(toward.reshape(-1, 3).astype(np.float64)).T @ light
    return total


def basis(directions: Array) -> Array:
    """Return the orthonormal functions in directions, shape (n, 3), as shape (n, 9)."""
    x, y, z = directions.T
    functions = (
        *(np.ones_like(x), y, z, x),
        *(x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y),
    )
    values: Array = np.stack(functions, axis=-1) * NORMALISATION
    return values


def irradiance_harmonics(harmonics: Array) -> Array:
    """Return the coefficients of irradiance, shape (9, 3), from those of light."""
    irradiance: Array = COSINE[:, None] * harmonics
    return irradiance


def polynomial(harmonics: Array) -> Array:
    """Return the coefficients of `BASIS` whose sum is irradiance over pi, shape (9, 3).

    It is what a white diffuse surface shows, and what Filament's shaders evaluate.
    """
    coefficients: Array = irradiance_harmonics(harmonics) / math.pi * NORMALISATION[:, None]
    return coefficients


def filament_text(harmonics: Array) -> str:
    """Return the file `sh.txt` as Filament's cmgen writes it, without a window."""
    rows = zip(polynomial(harmonics), NAMES, strict=True)
    return "".join(
        f"({red:18.15f}, {green:18.15f}, {blue:18.15f}); // {name}, irradiance, pre-scaled base\n"
        for (red, green, blue), name in rows
    )


def harmonics_summary(harmonics: Array) -> dict[str, object]:
    """Return all three forms, fit for JSON."""
    forms = {
        "radiance": harmonics,
        "irradiance": irradiance_harmonics(harmonics),
        "irradiance_over_pi_polynomial": polynomial(harmonics),
    }
    return {
        "order": list(NAMES),
        "functions": list(BASIS),
        "normalisation": NORMALISATION.tolist(),
        **{name: values.tolist() for name, values in forms.items()},
    }
