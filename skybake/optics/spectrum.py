"""Spectra of a preset at the wavelengths of a rendering, and the light of its star."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.errors import InputError, PresetError
from skybake.preset import Spectrum, Star

Array = npt.NDArray[np.float64]

BANDWIDTH = 10.0
"""Width of the band that stands for one wavelength of a finely structured spectrum. [nm]"""

WIDEST = 25.0
"""Distance beyond which a spectrum does not count for a wavelength. [nm]"""

_HAT_SAMPLES = 400


def eval_spectrum(spectrum: Spectrum, wavelengths: Array) -> Array:
    """Evaluate a spectrum, linear between its nodes and exact at them.

    Parameters
    ----------
    spectrum : Spectrum
        What the preset gives.
    wavelengths : ndarray, shape (wavelength,)
        In any order. [nm]

    Returns
    -------
    ndarray of float64, shape (wavelength,)

    Raises
    ------
    PresetError
        If a wavelength is outside the nodes.
    """
    if not spectrum.wavelength:
        return np.full(len(wavelengths), spectrum.values[0])
    check_range(spectrum.where, spectrum.wavelength, wavelengths)
    return np.interp(wavelengths, spectrum.wavelength, spectrum.values)


def eval_band_mean(spectrum: Spectrum, wavelengths: Array, bandwidth: float) -> Array:
    """Average a spectrum over bands, as suits one with lines finer than the sampling.

    Parameters
    ----------
    spectrum : Spectrum
        What the preset gives.
    wavelengths : ndarray, shape (wavelength,)
        Centres of the bands. [nm]
    bandwidth : float
        Full width of the bands, cut at the ends of the spectrum; 0 evaluates at
        the centres. [nm]

    Returns
    -------
    ndarray of float64, shape (wavelength,)

    Raises
    ------
    PresetError
        If a centre is outside the nodes.
    """
    if not spectrum.wavelength or bandwidth <= 0.0:
        return eval_spectrum(spectrum, wavelengths)
    check_range(spectrum.where, spectrum.wavelength, wavelengths)
    nodes = np.array(spectrum.wavelength)
    values = np.array(spectrum.values)
    below = np.concatenate([[0.0], np.cumsum(np.diff(nodes) * (values[1:] + values[:-1]) / 2.0)])
    half_width = np.array([[-0.5], [0.5]]) * bandwidth
    edges = np.clip(wavelengths + half_width, nodes[0], nodes[-1])
    left = np.clip(np.searchsorted(nodes, edges, side="right") - 1, 0, len(nodes) - 2)
    at_edges = np.interp(edges, nodes, values)
    integral = below[left] + (edges - nodes[left]) * (values[left] + at_edges) / 2.0
    mean: Array = (integral[1] - integral[0]) / (edges[1] - edges[0])
    return mean


def hat_means(spectrum: Spectrum, wavelengths: Array) -> Array:
    """Average a spectrum around wavelengths, weighted as linear interpolation weights them.

    Parameters
    ----------
    spectrum : Spectrum
        What the preset gives.
    wavelengths : ndarray, shape (wavelength,)
        Ascending. A weight falls from 1 to 0 at the neighbours, at most `WIDEST` away; the first
        and the last have the same distance on both sides, a single one `BANDWIDTH`. [nm]

    Returns
    -------
    ndarray of float64, shape (wavelength,)
        What is linear between these values has the spectrum's integral between the ends.

    Raises
    ------
    PresetError
        If a wavelength is outside the nodes.
    """
    if not spectrum.wavelength:
        return eval_spectrum(spectrum, wavelengths)
    check_range(spectrum.where, spectrum.wavelength, wavelengths)
    nodes, values = np.array(spectrum.wavelength), np.array(spectrum.values)
    return hat_means_of(nodes, values, wavelengths)


def hat_means_of(nodes: Array, values: Array, wavelengths: Array) -> Array:
    """Average what is linear between nodes around wavelengths, see `hat_means`."""
    below, above = _hat_sides(wavelengths)
    side = (np.arange(_HAT_SAMPLES) + 0.5) / _HAT_SAMPLES
    total = np.zeros(wavelengths.size)
    for sign, width in ((-1.0, below), (1.0, above)):
        around = wavelengths[:, None] + sign * width[:, None] * side
        total += width * (np.interp(around, nodes, values) @ (1.0 - side))
    means: Array = total / (0.5 * _HAT_SAMPLES * (below + above))
    return means


def hats_at(lines: Array, wavelengths: Array) -> Array:
    """Return the weights of `hat_means` for light of single wavelengths.

    Parameters
    ----------
    lines : ndarray of float64, shape (line,)
        Wavelengths of the light. [nm]
    wavelengths : ndarray of float64, shape (wavelength,)
        As of `hat_means`.

    Returns
    -------
    ndarray of float64, shape (line, wavelength)
        The mean is the light times these, whose integral over lines is 1. [nm⁻¹]
    """
    below, above = _hat_sides(wavelengths)
    away = lines[:, None] - wavelengths
    width = np.where(away < 0.0, below, above)
    hats: Array = np.maximum(1.0 - np.abs(away) / width, 0.0) / (0.5 * (below + above))
    return hats


def _hat_sides(wavelengths: Array) -> tuple[Array, Array]:
    """How far weights reach below wavelengths and above them. [nm]"""
    if wavelengths.size == 1:
        return np.array([BANDWIDTH]), np.array([BANDWIDTH])
    steps = np.minimum(np.diff(wavelengths), WIDEST)
    return np.append(steps[0], steps), np.append(steps, steps[-1])


def star_at(star: Star, distance: float | None) -> Star:
    """Return a star at another distance.

    Parameters
    ----------
    star : Star
        The preset's star.
    distance : float or None
        From the planet; None leaves it where it is. [au]

    Raises
    ------
    InputError
        If the distance is not finite, or within the star.
    """
    if distance is None:
        return star
    length = distance * ASTRONOMICAL_UNIT
    if not star.radius < length < math.inf:
        raise InputError(
            f"sun distance: must be finite and greater than the star's radius, "
            f"{star.radius / ASTRONOMICAL_UNIT:.4g} au, got {distance:g} au"
        )
    return replace(star, distance=length)


def star_irradiance(star: Star, wavelengths: Array, bandwidth: float = BANDWIDTH) -> Array:
    """Irradiance on a plane above the atmosphere that faces the star, averaged over bands.

    Parameters
    ----------
    star : Star
        The preset's star.
    wavelengths : ndarray, shape (wavelength,)
        Centres of the bands. [nm]
    bandwidth : float, optional
        Full width of the bands. [nm]

    Returns
    -------
    ndarray of float64, shape (wavelength,)
        [W m⁻² nm⁻¹]

    Raises
    ------
    PresetError
        If a wavelength is outside the star's spectrum.
    """
    return star.dilution * eval_band_mean(star.irradiance, wavelengths, bandwidth)


def star_spectrum(star: Star) -> tuple[Array, Array]:
    """Irradiance at the planet at its full resolution, for integrals over colour.

    Parameters
    ----------
    star : Star
        The preset's star.

    Returns
    -------
    wavelengths : ndarray of float64, shape (n,)
        Nodes, ascending from 360 to 830. [nm]
    irradiance : ndarray of float64, shape (n,)
        To be interpolated linearly. [W m⁻² nm⁻¹]

    Raises
    ------
    PresetError
        If the star's spectrum does not cover 360 to 830 nm.
    """
    nodes = np.array(star.irradiance.wavelength)
    inner = nodes[(nodes > 360.0) & (nodes < 830.0)]
    wavelengths = np.concatenate([[360.0], inner, [830.0]])
    return wavelengths, star.dilution * eval_spectrum(star.irradiance, wavelengths)


def limb_darkening(star: Star, wavelengths: Array) -> Array:
    """Coefficients u and v of I(mu)/I(1) = 1 - u (1 - mu) - v (1 - mu²).

    Parameters
    ----------
    star : Star
        The preset's star.
    wavelengths : ndarray, shape (wavelength,)
        [nm]

    Returns
    -------
    ndarray of float64, shape (2, wavelength)
        The disc's mean is 1 - u/3 - v/2 of its centre.

    Raises
    ------
    PresetError
        If a wavelength is outside the coefficients' nodes.
    """
    return np.stack(
        [
            eval_spectrum(star.limb_darkening_u, wavelengths),
            eval_spectrum(star.limb_darkening_v, wavelengths),
        ]
    )


def check_range(where: str, nodes: tuple[float, ...], wavelengths: Array) -> None:
    """Raise PresetError unless the wavelengths are within the nodes, both in nm."""
    outside = wavelengths[(wavelengths < nodes[0]) | ~(wavelengths <= nodes[-1])]
    if outside.size:
        raise PresetError(
            f"{where}: wavelength must be within {nodes[0]:g} to {nodes[-1]:g} nm, "
            f"got {outside[0]:g} nm"
        )
