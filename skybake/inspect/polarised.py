"""Polarisation of a planet's sky in given directions."""

from __future__ import annotations

import math

import numpy as np

from skybake.angles import cosine_between
from skybake.errors import InputError
from skybake.optics.matrix import unpolarised_constituents
from skybake.optics.medium import Array
from skybake.preset import Planet
from skybake.reference.stokes import stokes
from skybake.sky.sky import Sky
from skybake.sky.stokes import linear_polarisation, stokes_per_irradiance


def polarisation_warning(planet: Planet) -> str | None:
    """Say which constituents count as unpolarised, or return None if there is none."""
    names = unpolarised_constituents(planet)
    if not names:
        return None
    return f"no scattering matrix is known of {', '.join(names)}: taken to polarise no light"


def check_polarisation(planet: Planet, sky: Sky) -> None:
    """Refuse worlds and methods without polarisation.

    Raises
    ------
    InputError
        That says what stands in the way.
    """
    if not all(layer.is_empty for layer in planet.clouds):
        raise InputError("clouds: polarisation is known of clear skies only")
    if sky.eclipse is not None:
        raise InputError("eclipse: polarisation is known without a moon in front of the sun only")
    if sky.method != "full":
        raise InputError(f"polarisation: method must be full or reference, got {sky.method}")


def stokes_columns(
    sky: Sky, zenith: Array, azimuth: Array, scale: Array, samples: int | None
) -> dict[str, Array]:
    """Stokes parameters, degree and angle of polarisation, by the names of their columns.

    Parameters
    ----------
    sky : Sky
        The sky, checked by `check_polarisation`.
    zenith, azimuth : ndarray, shape (direction,)
        Zenith angle of the view, and its bearing less that of the sun. [rad]
    scale : ndarray, shape (wavelength,)
        What Stokes parameters per unit irradiance are multiplied by.
    samples : int or None
        Paths of the reference, which adds standard errors; None for the solver.

    Returns
    -------
    dict of str to ndarray of float64, shape (direction,)
    """
    if samples is None:
        mu, sine, sun = np.cos(zenith), np.sin(zenith), sky.source.zenith
        nu = cosine_between(mu, sine, math.cos(sun), math.sin(sun), azimuth)
        vectors = stokes_per_irradiance(sky.skylight, sky.source, mu, np.clip(nu, -1.0, 1.0))
        vectors[:, 2] *= np.where(np.sin(azimuth) < 0.0, -1.0, 1.0)[:, None]
        errors = None
    else:
        place = sky.medium, sky.altitude, sky.sun_elevation
        vectors, errors = stokes(*place, zenith, azimuth, samples=samples)
    degree, angle = linear_polarisation(vectors)
    columns: dict[str, Array] = {}
    for k, wavelength in enumerate(sky.wavelengths):
        for i, name in enumerate("iquv"):
            columns[f"{name}_{wavelength:g}nm"] = vectors[:, i, k] * scale[k]
            if errors is not None:
                columns[f"stderr_{name}_{wavelength:g}nm"] = errors[:, i, k] * scale[k]
        columns[f"polarisation_degree_{wavelength:g}nm"] = degree[:, k]
        columns[f"polarisation_angle_deg_{wavelength:g}nm"] = np.degrees(angle[:, k])
    return columns
