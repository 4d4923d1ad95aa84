"""Surroundings from a map in a file, and the sun that a map of ours states."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from skybake.angles import direction_from_angles, zenith_azimuth
from skybake.constants import ASTRONOMICAL_UNIT
from skybake.environment.environment import Environment
from skybake.environment.resample import resample
from skybake.errors import InputError
from skybake.ibl.cube import Cube
from skybake.ibl.highlights import split_highlights
from skybake.ibl.settings import LightingMaps
from skybake.ibl.surroundings import Surroundings, without_disc
from skybake.image.light import light_from_attributes
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.projection.cubemap import Cubemap
from skybake.projection.of_file import file_recipe

SMALLEST = 16
"""Edge of the coarsest cube that a map is filtered from. [pixel]"""


class StatedDisc(NamedTuple):
    """The disc of a sun, as a file states it.

    Attributes
    ----------
    zenith, bearing : float
        Of its centre, the bearing by the compass. [rad]
    radius : float
        Its angular radius. [rad]
    """

    zenith: float
    bearing: float
    radius: float


def surroundings_of_environment(
    environment: Environment,
    maps: LightingMaps,
    rotation: float = 0.0,
    disc: StatedDisc | None = None,
    workers: Workers = ALL_CPUS,
) -> Surroundings:
    """Lay a map out as a cube, and take its small bright spots for points.

    Parameters
    ----------
    environment : Environment
        The map.
    maps : LightingMaps
        What is to be made of it.
    rotation : float, optional
        Compass bearing that the -Z of the cube looks to. [rad]
    disc : StatedDisc, optional
        What is to be taken away, and replaced by what is around it.
    workers : Workers, optional
        Threads that do the work.

    Notes
    -----
    The cube that is filtered has no more texels than the map has pixels: a sun of one pixel is to
    stay one texel, which can be told from a lamp.
    """
    count = sum(pixels.shape[0] * pixels.shape[1] for pixels in environment.pixels)
    edge = maps.source_edge
    while edge > SMALLEST and 6 * edge * edge > count:
        edge //= 2
    pixel = math.sqrt(4.0 * math.pi / count)

    def laid_out(size: int) -> Cube:
        cube = np.stack(resample(environment, Cubemap(size), rotation, workers).pixels)
        if disc is None:
            return cube
        elevation = 0.5 * math.pi - disc.zenith
        centre = direction_from_angles(disc.bearing - rotation, elevation)
        return without_disc(cube, centre, disc.radius, pixel)

    cube = laid_out(edge)
    smooth, points = split_highlights(cube)
    if "specular" in maps.parts and edge < maps.specular_size:
        cube = laid_out(maps.specular_size)
    return Surroundings(cube, smooth, points)


def stated_disc(path: Path, environment: Environment) -> StatedDisc | None:
    """Return the sun that is in a map of ours; None where its sun was left out.

    Raises
    ------
    InputError
        If the map does not state where its sun is, and how large.
    """
    recipe = file_recipe(environment.attributes)
    shown, preset = recipe.get("map"), recipe.get("preset")
    try:
        direction = light_from_attributes(environment.attributes).sun_direction
        if not isinstance(shown, dict) or not isinstance(preset, dict):
            raise KeyError("recipe")
        if shown["sun_disc"] == "exclude":
            return None
        radius = _radius(shown, preset)
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(
            f"{path}: a sun that is to be taken away must be stated, as maps of skybake do with "
            f"discs that are not soft, got no {error.args[0]}"
        ) from error
    zenith, bearing = zenith_azimuth(np.array(direction))
    return StatedDisc(float(zenith), float(bearing) + environment.rotation, radius)


def _radius(shown: Mapping[str, Any], preset: Mapping[str, Any]) -> float:
    if shown["sun_size_deg"] is not None:
        return 0.5 * math.radians(shown["sun_size_deg"])
    if shown["sun_soft"]:
        raise KeyError("size of a soft disc")
    star = preset["star"]
    distance = shown.get("sun_distance_au", star["distance_au"]) * ASTRONOMICAL_UNIT
    return math.asin(star["radius_km"] / distance)
