"""The discs of sun and Moon in maps, and the light of their parts."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from skybake.image.sun_size import drawn_radius
from skybake.optics.medium import Array
from skybake.projection.cells import Cells
from skybake.sky.disc import Disc
from skybake.sky.drawn_disc import DrawnDisc

if TYPE_CHECKING:
    from skybake.image.scene import Scene

CELLS_AT_ONCE = 32768
"""A disc in the zenith touches every column, and the spectra of all cells would fill the memory."""


class ShownDisc(NamedTuple):
    """A disc in a map.

    Attributes
    ----------
    zenith, bearing, angular_radius : float
        Of its centre on the map, and its own. [rad]
    flux : callable
        Returns the pixel value times solid angle that each cell adds, shape (cell, 3). [sr]
    """

    zenith: float
    bearing: float
    angular_radius: float
    flux: Callable[[Cells], Array]


def drawn_sun(scene: Scene) -> Disc:
    """Return the sun's disc in the size and softness that a scene's settings ask for.

    Raises
    ------
    InputError
        If it is to be soft and no such disc fits half floats.
    """
    lighting, source = scene.settings.lighting, scene.sky.source
    if lighting.sun_size is None and not lighting.sun_soft:
        return Disc(scene.sky.skylight, source)
    flux = lighting.sun_strength * float(scene.rgb_weights.sum(axis=0).max())
    # Before the atmosphere is solved for, which takes long.
    radius = drawn_radius(lighting, source.angular_radius, flux)
    return DrawnDisc(scene.sky.skylight, source, angular_radius=radius, is_soft=lighting.sun_soft)


def shown_sun(scene: Scene) -> ShownDisc | None:
    """Return the sun's disc, or None where a map leaves it out."""
    if "sun" not in scene.layer_names:
        return None
    radius = scene.sun.angular_radius
    return ShownDisc(
        scene.sun_zenith, scene.sun_bearing, radius, lambda cells: sun_flux(scene, cells)
    )


def shown_moon(scene: Scene) -> ShownDisc | None:
    """Return the Moon's disc, or None where a map has none."""
    if "moon" not in scene.layer_names or scene.moonlit is None:
        return None
    moon = scene.moonlit
    return ShownDisc(moon.zenith, moon.bearing, moon.angular_radius, moon.disc_flux)


def sun_flux(scene: Scene, cells: Cells) -> Array:
    """Pixel value times solid angle that each cell of the sun's disc adds, (cell, 3). [sr]"""
    flux = np.empty((cells.distance.size, 3))
    for first in range(0, len(flux), CELLS_AT_ONCE):
        part = slice(first, first + CELLS_AT_ONCE)
        bearing = cells.azimuth[part] + scene.settings.view.rotation
        where = cells.zenith[part], cells.distance[part], bearing
        light = scene.sun.radiance_per_irradiance(*where)
        flux[part] = (light @ scene.rgb_weights) * cells.solid_angle[part, None]
        if scene.cloudscape is not None:
            flux[part] *= scene.cloudscape.transmittance(cells.zenith[part], bearing)[:, None]
    return scene.settings.lighting.sun_strength * flux
