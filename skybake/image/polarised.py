"""Pixels of the sky's linear polarisation: Stokes components, and what a filter passes of them."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from skybake.errors import InputError
from skybake.image.scene import Scene
from skybake.image.settings import MapSettings
from skybake.optics.matrix import unpolarised_constituents
from skybake.optics.medium import Array
from skybake.preset import Planet

REFERENCE = "toward the zenith; S2 counter-clockwise, seen along the view"
"""What S1 and S2 are relative to, as files state it."""


def check_polarisation(settings: MapSettings, what: str) -> None:
    """Refuse maps whose polarisation is not known.

    Parameters
    ----------
    settings : MapSettings
        What is baked.
    what : str
        What asks for polarisation, for messages.

    Raises
    ------
    InputError
        In an eclipse, by another method than full, or with an extended horizon.
    """
    if settings.lighting.moon is not None:
        raise InputError(f"{what}: needs a sun without a moon in front, got one")
    if settings.lighting.method != "full":
        raise InputError(
            f"{what}: needs the method full, which alone knows polarisation, "
            f"got {settings.lighting.method}"
        )
    if settings.view.below_horizon == "extend":
        raise InputError(f"{what}: needs ground or black below the horizon, got extend")


def polarisation_warnings(planet: Planet) -> list[str]:
    """Return what is to know of a world's polarisation, a line each."""
    names, warnings = unpolarised_constituents(planet), []
    if names:
        warnings.append(
            f"what {', '.join(names)} scatter{'s' if len(names) == 1 else ''} counts as "
            "unpolarised, since no scattering matrix is known"
        )
    if not all(layer.is_empty for layer in planet.clouds):
        warnings.append("what clouds scatter counts as unpolarised")
    return warnings


def evaluate_stokes(
    scene: Scene, zenith: Array, azimuth: Array, footprint: Array | float
) -> np.ndarray:
    """S1 and S2 of the sky and the ground, which discs and stars add nothing to.

    Parameters
    ----------
    scene : Scene
        What is seen.
    zenith, azimuth, footprint
        As of `Scene.evaluate`.

    Returns
    -------
    ndarray of float32, shape (row, column, 6)
        S1 of three channels, and S2.
    """
    if scene.cloudscape is not None:
        # Clear skies do not wait for kernels of clouds.
        from skybake.image.polarised_clouds import stokes_behind_clouds

        clear = partial(_clear_stokes, scene)
        return stokes_behind_clouds(scene, clear, zenith, azimuth, footprint)
    return _clear_stokes(scene, zenith, azimuth, footprint)


def _clear_stokes(
    scene: Scene, zenith: Array, azimuth: Array, footprint: Array | float
) -> np.ndarray:
    """As `evaluate_stokes`, without clouds."""
    even, odd = (scene.evaluate_table(each, zenith, azimuth, footprint) for each in scene.stokes)
    odd *= np.sin(azimuth)[..., None].astype(np.float32)
    return np.concatenate([even, odd], axis=2)


def through_filter(light: np.ndarray, stokes: np.ndarray, angle: float) -> np.ndarray:
    """Return what an ideal linear polarising filter passes.

    Parameters
    ----------
    light : ndarray of float32, shape (row, column, 3)
        S0.
    stokes : ndarray of float32, shape (row, column, 6)
        S1 and S2.
    angle : float
        Of the filter's axis from the vertical, counter-clockwise as seen along the view. [rad]

    Returns
    -------
    ndarray of float32, shape (row, column, 3)
        Half of unpolarised light, and by Malus's law of light that is polarised.
    """
    even, odd = stokes[..., :3], stokes[..., 3:]
    cosine, sine = np.float32(math.cos(2.0 * angle)), np.float32(math.sin(2.0 * angle))
    passed: np.ndarray = np.float32(0.5) * (light + cosine * even + sine * odd)
    return passed
