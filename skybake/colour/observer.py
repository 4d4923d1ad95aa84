"""The CIE 1931 observer: how a spectrum of radiance becomes XYZ."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

LUMINOUS_EFFICACY = 683.002
"""Luminous efficacy at the peak of y_bar, just beside the 540 THz of the definition. [lm W⁻¹]"""

_TABLE = Path(__file__).parents[1] / "data" / "cie_1931_2deg.csv"


@cache
def load_observer() -> tuple[Array, Array]:
    """Colour-matching functions of the CIE 1931 2 degree standard observer.

    Returns
    -------
    wavelengths : ndarray of float64, shape (471,)
        360 to 830, each 1. [nm]
    xyz_bar : ndarray of float64, shape (471, 3)
        Dimensionless; read-only, as the table is read once.

    References
    ----------
    CIE 018:2019, *The Basis of Physical Photometry*; table as in CIE 015.
    """
    lines = _TABLE.read_text(encoding="utf-8").splitlines()
    # Not by np.loadtxt: its first call costs 5 ms.
    table = np.array([line.split(",") for line in lines[3:]], dtype=np.float64)
    table.flags.writeable = False
    return table[:, 0], table[:, 1:]


def xyz_weights(wavelengths: Array, star_wavelengths: Array, star_irradiance: Array) -> Array:
    """Weights that fold a spectrum of radiance per unit of the star's light into XYZ.

    With `t` the radiances at `wavelengths` per unit of the star's spectral
    irradiance on top of the atmosphere [sr⁻¹], ``t @ weights`` is XYZ in
    cd m⁻², so that Y is the luminance.

    Parameters
    ----------
    wavelengths : ndarray, shape (wavelength,)
        Ascending. Between them `t` is taken as linear, beyond the ends as constant. [nm]
    star_wavelengths : ndarray, shape (n,)
        Ascending, covering 360 to 830. [nm]
    star_irradiance : ndarray, shape (n,)
        Linear between its nodes. [W m⁻² nm⁻¹]

    Returns
    -------
    ndarray of float64, shape (wavelength, 3)
        The sum of column 1 is the star's illuminance. [lm m⁻²]

    Raises
    ------
    ValueError
        If wavelengths do not ascend or the star's do not cover the observer's.

    Notes
    -----
    ``weights[k] = 683.002 * sum hat_k(l) E(l) xyz_bar(l) * 1 nm``, hat_k being the
    function that is 1 at node k and falls linearly to 0 at its neighbours. The
    fine structure of the star's light is thus kept, however few the nodes are.
    """
    return folding_weights(
        wavelengths, star_wavelengths, star_irradiance, load_observer()[1], LUMINOUS_EFFICACY
    )


def folding_weights(
    wavelengths: Array,
    star_wavelengths: Array,
    star_irradiance: Array,
    curves: Array,
    scale: float,
) -> Array:
    """Weights that fold a spectrum into what any responses make of it, see `xyz_weights`.

    Parameters
    ----------
    wavelengths, star_wavelengths, star_irradiance
        As of `xyz_weights`.
    curves : ndarray, shape (471, channel)
        Responses at 360 to 830, each 1. [nm]
    scale : float
        Factor of all weights.

    Returns
    -------
    ndarray of float64, shape (wavelength, channel)

    Raises
    ------
    ValueError
        As of `xyz_weights`.
    """
    nodes, _ = load_observer()
    for name, given in (("wavelengths", wavelengths), ("star_wavelengths", star_wavelengths)):
        if len(given) == 0 or not np.all(np.diff(given) > 0.0):
            raise ValueError(f"{name} must ascend, got {given}")
    if star_wavelengths[0] > nodes[0] or star_wavelengths[-1] < nodes[-1]:
        raise ValueError(
            f"star_wavelengths must cover {nodes[0]:g} to {nodes[-1]:g} nm, "
            f"got {star_wavelengths[0]:g} to {star_wavelengths[-1]:g} nm"
        )
    power = scale * np.interp(nodes, star_wavelengths, star_irradiance)
    # Each column is one hat: interpolation of a unit vector, which is constant beyond the ends.
    hats = np.stack([np.interp(nodes, wavelengths, unit) for unit in np.eye(len(wavelengths))])
    weights: Array = hats @ (power[:, None] * curves)
    return weights
