"""Pictures of the degree and the angle of linear polarisation."""

from __future__ import annotations

import numpy as np

from skybake.image.picture import CodeValues
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.projection import Projection

# Colours are in Oklab (B. Ottosson, 2020), in which equal steps look equal.
_FROM_OKLAB = np.array(
    [
        [1.0, 0.3963377774, 0.2158037573],
        [1.0, -0.1055613458, -0.0638541728],
        [1.0, -0.0894841775, -1.2914855480],
    ]
)
_RGB_FROM_LMS = np.array(
    [
        [4.0767416621, -3.3077115913, 0.2309699292],
        [-1.2684380046, 2.6097574011, -0.3413193965],
        [-0.0041960863, -0.7034186147, 1.7076147010],
    ]
)

LIGHTNESS, CHROMA = 0.75, 0.12
"""Of all angles: what differs is the hue, which returns after half a turn."""

UPRIGHT_HUE = np.radians(25.0)
"""Of light whose E-vector is vertical, red; that of horizontal light is opposite. [rad]"""

LEAST_DEGREE = 0.04
"""Degree of polarisation below which colours of angles fade to grey, since none is defined at 0."""


def polarisation_picture(scene: Scene, projection: Projection, show: str) -> CodeValues:
    """Show the polarisation of a scene's luminance.

    Parameters
    ----------
    scene : Scene
        What is shown, with its sun and stars, which are unpolarised.
    projection : Projection
        Of one picture.
    show : {"dop", "aop"}
        The degree, from black over violet and orange to white at 1, or the angle from the
        vertical, as hues of one lightness, grey where there is hardly any polarisation.

    Returns
    -------
    ndarray of uint8, shape (row, column, 3)
        Code values of sRGB.
    """
    (canvas,) = projection.canvases()
    raster = Raster(scene, canvas)
    light = raster.rows(0, canvas.height) @ scene.luminance
    stokes = raster.band("stokes", 0, canvas.height)
    even, odd = stokes[..., :3] @ scene.luminance, stokes[..., 3:] @ scene.luminance
    is_lit = light > 0.0
    degree = np.where(is_lit, np.hypot(even, odd) / np.where(is_lit, light, 1.0), 0.0)
    if show == "dop":
        return degree_colours(np.minimum(degree, 1.0))
    return angle_colours(0.5 * np.arctan2(odd, even), degree)


def degree_colours(degree: np.ndarray) -> CodeValues:
    """Colours of degrees from 0 to 1, the lighter the higher."""
    # Hues from violet over red and orange to yellow.
    hue = np.radians(-70.0 + 170.0 * degree)
    chroma = 0.62 * degree * (1.0 - degree) + 0.02
    return _code_values(0.12 + 0.86 * degree, chroma, hue)


def angle_colours(angle: np.ndarray, degree: np.ndarray) -> CodeValues:
    """Colours of angles of E-vectors [rad], the same after half a turn."""
    chroma = CHROMA * np.minimum(degree / LEAST_DEGREE, 1.0)
    return _code_values(np.full(angle.shape, LIGHTNESS), chroma, UPRIGHT_HUE + 2.0 * angle)


def _code_values(lightness: np.ndarray, chroma: np.ndarray, hue: np.ndarray) -> CodeValues:
    lab = np.stack([lightness, chroma * np.cos(hue), chroma * np.sin(hue)], axis=-1)
    light = np.clip((lab @ _FROM_OKLAB.T) ** 3 @ _RGB_FROM_LMS.T, 0.0, 1.0)
    # IEC 61966-2-1.
    encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    codes: CodeValues = np.rint(255.0 * encoded).astype(np.uint8)
    return codes
