"""What a world's wavelengths stand for, and how spectra are held by them."""

from __future__ import annotations

import numpy as np

from skybake.colour.observer import load_observer, xyz_weights
from skybake.colour.response import EyeResponse, Response, weights_of_radiance
from skybake.colour.space import find_colour_space, rgb_from_xyz
from skybake.optics.medium import Array
from skybake.sky.sky import Sky

_EVERYWHERE = np.array([300.0, 900.0])


class Channels:
    """Wavelengths of a world, or R, G and B for which its three wavelengths stand.

    Parameters
    ----------
    sky : Sky
        Of the world.
    response : Response, optional
        What sees the light, in place of an eye.

    Attributes
    ----------
    wavelengths : ndarray of float64, shape (wavelength,)
        At which spectra of light are to be given, ascending. [nm]
    air : ndarray of float64, shape (channel,)
        Of the air's own properties. [nm]
    weights : ndarray of float64, shape (channel, 3)
        XYZ [cd m⁻²], or what the response is to it, is what `hold` returns times these.
    """

    def __init__(self, sky: Sky, response: Response | None = None) -> None:
        self.air = sky.wavelengths
        self._is_spectral = sky.planet.rendering == "spectral"
        self.wavelengths = sky.wavelengths if self._is_spectral else load_observer()[0]
        flat = np.ones_like(_EVERYWHERE)
        self._to_xyz = xyz_weights(self.wavelengths, _EVERYWHERE, flat)
        self._to_rgb = rgb_from_xyz(find_colour_space("lin_rec709"))
        from_rgb = np.asarray(np.linalg.inv(self._to_rgb).T, dtype=float)
        self.weights: Array = self._to_xyz if self._is_spectral else from_rgb
        self._response: Response = response or EyeResponse()
        if response is not None:
            self.weights = weights_of_radiance(response, self.wavelengths)

    def hold(self, spectra: Array) -> Array:
        """Return spectra, (..., wavelength), as they are dimmed by the air, (..., channel)."""
        if self._is_spectral:
            return spectra
        held: Array = spectra @ self._to_xyz @ self._to_rgb.T
        return held

    def of_lines(self, lines: Array) -> Array:
        """Return XYZ, or what the response is, of 1 W at wavelengths [nm], (line, 3)."""
        return self._response.of_lines(lines)

    def at(self, wavelengths: Array, values: Array) -> Array:
        """Interpolate what the air does, (..., channel), at wavelengths, (..., wavelength)."""
        order = np.argsort(self.air)
        nodes = self.air[order]
        return np.stack([np.interp(wavelengths, nodes, row[order]) for row in values])
