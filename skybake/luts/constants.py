"""The numbers in the formulas and in the code that look up one set of tables."""

from __future__ import annotations

import math
from collections.abc import Mapping as Values

import numpy as np

from skybake.image.scene import Scene
from skybake.luts.mapping import Mapping
from skybake.luts.parametrisations import CONSTANTS, LEAST_SUN_COSINE
from skybake.luts.settings import TableSettings
from skybake.luts.shading import Constant

Constants = dict[str, tuple[Constant, str]]
"""Value and meaning by name."""


def mapping_constants(
    scene: Scene, settings: TableSettings, mappings: Values[str, Mapping]
) -> dict[str, float]:
    """Return the constants of mappings, by the names of `CONSTANTS`."""
    medium, radius = scene.sky.medium, scene.sky.skylight.radius
    values = {
        "PI": math.pi,
        "BOTTOM_RADIUS": medium.r_bottom,
        "TOP_RADIUS": medium.r_top,
        "LEAST_SUN_COSINE": LEAST_SUN_COSINE,
        "OBSERVER_ALTITUDE": radius - medium.r_bottom,
        "HORIZON": math.pi - math.asin(medium.r_bottom / radius),
        "FAR": settings.far,
    }
    nodes = mappings["aerial_perspective"].texels(settings.aerial_size, values)["distance"]
    return {**values, "NEAREST": float(nodes.min())}


def known_constants(values: Values[str, float]) -> Constants:
    """Return the constants of mappings with their meanings."""
    return {name: (values[name], meaning) for name, meaning in CONSTANTS.items()}


def light_constants(scene: Scene) -> Constants:
    """Return where the sun is and what its disc is like, above the atmosphere.

    The disc's radiance at the share m of its edge, 0 in the middle and 1 at the limb, is
    radiance - limb * (1 - sqrt(1 - m²)) - limb of square * m².
    """
    source = scene.sky.source
    sine = math.sin(source.angular_radius)
    u, v = source.limb_darkening
    # What the disc brings, spread over it as the limb's profile has it in each wavelength.
    spread = scene.rgb_weights / ((1.0 - u / 3.0 - v / 2.0) * math.pi * sine**2)[:, None]
    radiance, limb, square = (
        _triple((spread * share[:, None]).sum(axis=0)) for share in (np.ones_like(u), u, v)
    )
    direction = source.direction
    azimuth = source.azimuth
    return {
        "SUN_DIRECTION": (
            _triple(direction),
            "unit vector toward the sun; +X east, +Y up, +Z south",
        ),
        "SUN_BEARING": (
            (math.sin(azimuth), -math.cos(azimuth)),
            "x and z of the unit vector of the sun's azimuth",
        ),
        "SUN_ILLUMINANCE": (
            _triple(scene.rgb_weights.sum(axis=0)),
            "irradiance by the sun above the atmosphere, radiance times solid angle",
        ),
        "SUN_SINE": (sine, "sine of the sun's angular radius"),
        "SUN_RADIANCE": (radiance, "radiance of the middle of the sun's disc above the atmosphere"),
        "SUN_LIMB": (limb, "how much darker its limb is: the factor of 1 - sqrt(1 - m m)"),
        "SUN_LIMB_OF_SQUARE": (square, "and that of m m; m is 0 in its middle, 1 at its edge"),
    }


def camera_constants(settings: TableSettings) -> Constants:
    """Return the camera of the volume."""
    frame = settings.frame
    return {
        "CAMERA_RIGHT": (
            _triple(frame.right),
            "unit vector along the volume's screen to its right",
        ),
        "CAMERA_UP": (_triple(frame.up), "unit vector along it to its top"),
        "CAMERA_FORWARD": (
            _triple(frame.forward),
            "unit vector at right angles to it; to its middle if the lens is not shifted",
        ),
        "CAMERA_HALF_WIDTH": (settings.half_width, "half its width, at distance 1"),
        "CAMERA_HALF_HEIGHT": (settings.half_height, "half its height, at distance 1"),
        "CAMERA_SHIFT": (
            settings.shift,
            "where its middle is, at distance 1: to the right of the axis, and above it",
        ),
    }


def _triple(values: np.ndarray) -> tuple[float, ...]:
    return tuple(float(value) for value in values)
