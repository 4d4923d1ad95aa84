"""Free flights through clouds and air by null collisions, and transmittances of clouds.

A place is a triple in kilometres whose origin is on the ground under the observer: x runs east,
y north, z up.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from skybake.cloud_fields.chart import cloud_place
from skybake.cloud_fields.field import CloudField, extinction_at
from skybake.jit.kernel import kernel
from skybake.reference.directions import uniform
from skybake.reference.majorants import CloudBounds, air_bound, cloud_bound
from skybake.reference.rays import node_value, shell_of

ESCAPES, MEETS_GROUND, COLLIDES, LEAVES_CLOUDS = 0, 1, 2, 3
"""How a flight ends."""

FAINT = 0.1
"""A transmittance below this goes on as often as it is large, or ends."""

_LONGEST_STEP = 10.0


class Clouds(NamedTuple):
    """Layers of clouds.

    Attributes
    ----------
    fields : tuple of CloudField
        Their extinction.
    bounds : tuple of CloudBounds
        Its upper bounds.
    top : float
        Altitude above which there is none of them. [km]
    """

    fields: tuple[CloudField, ...]
    bounds: tuple[CloudBounds, ...]
    top: float


@kernel
def altitude_of(radius, place):
    """Altitude of a place, to full precision. [km]"""
    x, y, z = place
    flat = x * x + y * y + z * z + 2.0 * radius * z
    return flat / (math.sqrt(x * x + y * y + (z + radius) ** 2) + radius)


@kernel
def vertical_at(radius, place):
    """Direction from the planet's centre to a place."""
    x, y, z = place[0], place[1], place[2] + radius
    norm = 1.0 / math.sqrt(x * x + y * y + z * z)
    return x * norm, y * norm, z * norm


@kernel
def moved(place, direction, distance):
    """Place at a distance along a direction."""
    return (
        place[0] + distance * direction[0],
        place[1] + distance * direction[1],
        place[2] + distance * direction[2],
    )


@kernel
def climb(radius, place, direction):
    """Distance from the centre times the cosine of the direction's zenith angle. [km]"""
    x, y, z = place
    return x * direction[0] + y * direction[1] + (z + radius) * direction[2]


@kernel
def distance_to_ground(radius, h, rising):
    """Distance to the ground from altitude `h` along a ray whose `climb` is `rising`, or inf."""
    if rising >= 0.0:
        return math.inf
    flat = max(h, 0.0) * (2.0 * radius + max(h, 0.0))
    inside = rising * rising - flat
    return flat / (math.sqrt(inside) - rising) if inside > 0.0 else math.inf


@kernel
def layer_extinction(clouds, i, radius, place, h):
    """Extinction of one layer at a place of altitude `h`. [km⁻¹]"""
    field = clouds.fields[i]
    x, y, erosion, _ = cloud_place(field, radius, place[0], place[1], place[2], h, 0.0)
    return extinction_at(field, x, y, h, 0.0, erosion)


@kernel
def clouds_extinction(clouds, radius, place, h):
    """Extinction of all layers at a place of altitude `h`. [km⁻¹]"""
    total = 0.0
    for i in range(len(clouds.fields)):
        total += layer_extinction(clouds, i, radius, place, h)
    return total


@kernel
def clouds_bound(clouds, radius, place, h):
    """Bound of all layers' extinction around a place, and the distance it holds for."""
    most = 0.0
    reach = max(_LONGEST_STEP, h - clouds.top)
    for i in range(len(clouds.fields)):
        layer, distance = cloud_bound(
            clouds.fields[i], clouds.bounds[i], radius, place[0], place[1], place[2], h
        )
        most += layer
        reach = min(reach, distance)
    return most, reach


@kernel
def distance_to_cloud(clouds, radius, start, direction, state):
    """Distance after which light from behind is scattered by clouds first, or inf."""
    distance = 0.0
    place = start
    while True:
        h = altitude_of(radius, place)
        rising = climb(radius, place, direction)
        if rising >= 0.0 and h >= clouds.top:
            return math.inf
        ground = distance_to_ground(radius, h, rising)
        most, reach = clouds_bound(clouds, radius, place, h)
        step = -math.log1p(-uniform(state)) / most if most > 0.0 else reach
        if min(step, reach) >= ground:
            return math.inf
        distance += min(step, reach)
        place = moved(start, direction, distance)
        if step < reach:
            extinction = clouds_extinction(clouds, radius, place, altitude_of(radius, place))
            if uniform(state) * most < extinction:
                return distance


@kernel
def clouds_transmittance(clouds, radius, start, direction, state):
    """Estimate of the transmittance of clouds to space, along a ray that misses the ground."""
    transmittance = 1.0
    place = start
    while True:
        h = altitude_of(radius, place)
        if h >= clouds.top and climb(radius, place, direction) >= 0.0:
            return transmittance
        most, reach = clouds_bound(clouds, radius, place, h)
        step = -math.log1p(-uniform(state)) / most if most > 0.0 else reach
        place = moved(place, direction, min(step, reach))
        if step < reach:
            extinction = clouds_extinction(clouds, radius, place, altitude_of(radius, place))
            transmittance *= 1.0 - extinction / most
            if transmittance < FAINT:
                if uniform(state) * FAINT >= transmittance:
                    return 0.0
                transmittance = FAINT


@kernel
def fly(air, peaks, clouds, place, direction, ends_above, state):
    """Follow a ray to its next collision with clouds or air, or with the ground.

    Parameters
    ----------
    ends_above : bool
        Whether the flight ends where no cloud is ahead any more.

    Returns
    -------
    end : int
        `ESCAPES`, `MEETS_GROUND`, `COLLIDES` or `LEAVES_CLOUDS`.
    place : tuple
        Where.
    h, extinction : float
        Altitude there, and the extinction of all that is there.
    """
    radius = air.r_bottom
    space = air.altitude[-1]
    while True:
        h = max(0.0, altitude_of(radius, place))
        rising = climb(radius, place, direction)
        if rising >= 0.0:
            if h >= space:
                return ESCAPES, place, h, 0.0
            if ends_above and h >= clouds.top:
                return LEAVES_CLOUDS, place, h, 0.0
        ground = distance_to_ground(radius, h, rising)
        most, reach = clouds_bound(clouds, radius, place, h)
        if h > space:
            step = reach = max(h - space, 0.01)
        else:
            most += air_bound(air, peaks, h if rising >= 0.0 else h - reach, h + reach)
            step = -math.log1p(-uniform(state)) / most if most > 0.0 else reach
        if min(step, reach) >= ground:
            return MEETS_GROUND, moved(place, direction, ground), 0.0, 0.0
        place = moved(place, direction, min(step, reach))
        if step < reach:
            h = max(0.0, altitude_of(radius, place))
            if h >= space:
                continue
            shell = shell_of(air.altitude, h)
            extinction = node_value(air.altitude, air.extinction, shell, h)
            extinction += clouds_extinction(clouds, radius, place, h)
            if uniform(state) * most < extinction:
                return COLLIDES, place, h, extinction
