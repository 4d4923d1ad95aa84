"""The air between a camera and places before it: what it adds, and what it lets pass."""

from __future__ import annotations

from collections.abc import Mapping as Values
from dataclasses import replace

import numpy as np

from skybake.colour.space import luminance_weights
from skybake.image.scene import Scene
from skybake.luts.mapping import Mapping
from skybake.luts.settings import TableSettings
from skybake.luts.table import Table, texels
from skybake.luts.transmittance import colour_shares
from skybake.optics.medium import Array
from skybake.sky.skylight import Segments, Skylight

ABOVE_GROUND = 1e-6
"""How far before the ground rays end, so that its own light is not counted as that of the air.
[km]"""


TEXELS_AT_ONCE = 1 << 16


def screen_directions(settings: TableSettings, x: Array, y: Array) -> Array:
    """Return unit vectors through places of the camera's screen, shape (..., 3).

    Parameters
    ----------
    settings : TableSettings
        With the camera.
    x, y : ndarray of float64, broadcast to shape (...)
        From 0 at the left and the top to 1 at the right and the bottom.
    """
    frame, (across, above) = settings.frame, settings.shift
    right = across + settings.half_width * (2.0 * x[..., None] - 1.0)
    up = above + settings.half_height * (1.0 - 2.0 * y[..., None])
    # Not the length of the sum, whose rounding would differ between the left and the right.
    length = np.sqrt(1.0 + right**2 + up**2)
    unit: Array = (frame.forward + right * frame.right + up * frame.up) / length
    return unit


def ground_distances(r: float, r_bottom: float, mu: Array) -> Array:
    """Distances to the ground; infinite of rays that miss it. [km]"""
    rho_squared = (r - r_bottom) * (r + r_bottom)
    root_squared = (r * mu) ** 2 - rho_squared
    meets = (mu < 0.0) & (root_squared >= 0.0)
    down = -r * mu + np.sqrt(np.maximum(root_squared, 0.0))
    distance: Array = np.where(meets, rho_squared / np.where(meets, down, 1.0), np.inf)
    return distance


def air_segments(scene: Scene, directions: Array, distances: Array) -> Segments:
    """Light of the air alone up to distances, and what passes through it.

    Parameters
    ----------
    scene : Scene
        The observer and the sun.
    directions : ndarray of float64, shape (..., 3)
        Unit vectors.
    distances : ndarray of float64, shape (distance,)
        Ascending; those behind the ground count as just before it. [km]

    Returns
    -------
    Segments
        Radiance is per unit irradiance of the sun. [sr⁻¹]
    """
    sky = scene.sky
    source = replace(sky.source, irradiance=np.ones_like(sky.irradiance))
    skylight = Skylight(sky.atmosphere, sky.skylight.observer, (source,), workers=scene.workers)
    ground = ground_distances(skylight.radius, sky.medium.r_bottom, directions[..., 1])
    most = np.maximum(ground - ABOVE_GROUND, 0.0)
    return skylight.segments(directions, np.minimum(distances, most[..., None]))


def _colours(scene: Scene, directions: Array, distances: Array) -> tuple[Array, Array]:
    """Light and transmittance of each colour along rays, shape (ray, distance, 3)."""
    distances = distances.ravel()
    light, passed = (np.empty((len(directions), distances.size, 3)) for _ in range(2))
    shares = colour_shares(scene.rgb_weights)
    # Rays in all wavelengths take much more memory than colours do.
    step = max(2, TEXELS_AT_ONCE // distances.size)
    for first in range(0, len(directions), step):
        part = slice(first, first + step)
        found = air_segments(scene, directions[part], distances)
        light[part] = found.radiance @ scene.rgb_weights
        passed[part] = found.transmittance @ shares
    return light, passed


def aerial_tables(
    scene: Scene, settings: TableSettings, mapping: Mapping, constants: Values[str, float]
) -> tuple[Table, Table]:
    """Tabulate the light and the transmittance of the air before a camera.

    Parameters
    ----------
    scene : Scene
        The observer, who is the camera, the sun and the scale.
    settings : TableSettings
        With the camera.
    mapping, constants
        Where the texels are, see `Mapping.texels`.

    Returns
    -------
    light : Table
        Four channels, the last being the transmittance of white light.
    transmittance : Table
        That of each colour.
    """
    places = mapping.texels(settings.aerial_size, constants)
    across, down = places["screen_x"][0], places["screen_y"][0]
    directions = screen_directions(settings, *np.broadcast_arrays(across, down))
    # Columns on either side of the middle look equally high: side by side they share samples.
    columns = np.arange(settings.aerial_size[0])
    paired = np.argsort(np.minimum(columns, columns[::-1]), kind="stable")
    light, passed = (
        each.reshape(*directions.shape[:2], -1, 3)[:, np.argsort(paired)]
        for each in _colours(scene, directions[:, paired].reshape(-1, 3), places["distance"])
    )
    white = scene.rgb_weights.sum(axis=0) * luminance_weights(scene.settings.encoding.space)
    mean = passed @ (white / white.sum())
    # From (row, column, slice, ...) to slices of rows.
    light, passed = (np.moveaxis(each, 2, 0) for each in (light, passed))
    mean = np.moveaxis(mean, 2, 0)[..., None]
    first = Table(
        name=mapping.table,
        values=texels(np.concatenate([light, mean], axis=-1)),
        channels=("R", "G", "B", "A"),
        quantity="R, G, B: radiance that the air adds up to a distance, without the ground; A: "
        "share of sunlight's luminance that passes",
        unit="white luminance; A: 1",
        is_radiance=True,
        mapping=mapping,
    )
    second = replace(
        first,
        name="aerial_transmittance",
        values=texels(passed),
        channels=("R", "G", "B"),
        quantity="share of sunlight that passes up to a distance",
        unit="1",
        is_radiance=False,
    )
    return first, second
