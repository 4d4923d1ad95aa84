"""How three channels respond to light: an eye's, a camera's, or single wavelengths."""

from __future__ import annotations

from typing import Protocol

import numpy as np
import numpy.typing as npt

from skybake.colour.camera import CameraResponse
from skybake.colour.observer import LUMINOUS_EFFICACY, load_observer, xyz_weights
from skybake.optics.spectrum import hat_means_of, hats_at

Array = npt.NDArray[np.float64]

_EVERYWHERE = np.array([300.0, 900.0])


class Response(Protocol):
    """How three channels respond to light."""

    def weights(self, wavelengths: Array, nodes: Array, light: Array) -> Array:
        """Return weights that fold light whose spectrum is known and is dimmed by the air.

        Parameters
        ----------
        wavelengths : ndarray of float64, shape (wavelength,)
            Ascending, at which it is known what the air does. [nm]
        nodes, light : ndarray of float64, shape (n,)
            Its spectrum above the air, linear between nodes that cover 360 to 830 nm.

        Returns
        -------
        ndarray of float64, shape (wavelength, 3)
            Values are what the air leaves, times these.
        """

    def of_lines(self, lines: Array) -> Array:
        """Return the values of light of 1 W at single wavelengths [nm], shape (line, 3)."""


def weights_of_radiance(response: Response, wavelengths: Array) -> Array:
    """Return weights that fold spectral radiance at wavelengths [nm], shape (wavelength, 3)."""
    return response.weights(wavelengths, _EVERYWHERE, np.ones_like(_EVERYWHERE))


class EyeResponse:
    """An eye: values are XYZ. [cd m⁻²]"""

    def weights(self, wavelengths: Array, nodes: Array, light: Array) -> Array:
        """As of `Response`."""
        return xyz_weights(wavelengths, nodes, light)

    def of_lines(self, lines: Array) -> Array:
        """As of `Response`."""
        nodes, bars = load_observer()
        return LUMINOUS_EFFICACY * _at(lines, nodes, bars)


class CameraChannels:
    """A camera.

    Parameters
    ----------
    camera : CameraResponse
        The camera.
    white_luminance : float
        Of light of D65 whose green is 1. [cd m⁻²]
    """

    def __init__(self, camera: CameraResponse, white_luminance: float) -> None:
        self._camera, self._white = camera, white_luminance

    def weights(self, wavelengths: Array, nodes: Array, light: Array) -> Array:
        """As of `Response`."""
        return self._camera.weights(wavelengths, nodes, light) / self._white

    def of_lines(self, lines: Array) -> Array:
        """As of `Response`."""
        nodes, _ = load_observer()
        return _at(lines, nodes, self._camera.scaled_curves) / self._white


class Wavelengths:
    """Spectral radiance at three of several wavelengths, as means around them.

    Parameters
    ----------
    every : ndarray of float64, shape (wavelength,)
        Ascending; they decide over how much of its neighbourhood each is a mean. [nm]
    shown : ndarray of float64, shape (3,)
        Which of them the channels are. [nm]
    """

    def __init__(self, every: Array, shown: Array) -> None:
        self._every = every
        self._at = np.searchsorted(every, shown)
        self._shown = shown

    def weights(self, wavelengths: Array, nodes: Array, light: Array) -> Array:
        """As of `Response`; the wavelengths of the channels are among those of the air."""
        means = hat_means_of(nodes, light, self._every)[self._at]
        weights: Array = (wavelengths[:, None] == self._shown) * means
        return weights

    def of_lines(self, lines: Array) -> Array:
        """As of `Response`. [nm⁻¹]"""
        return hats_at(lines, self._every)[:, self._at]


def _at(lines: Array, nodes: Array, curves: Array) -> Array:
    return np.stack(
        [np.interp(lines, nodes, curve, left=0.0, right=0.0) for curve in curves.T], axis=1
    )
