"""Which moon is in front of the sun at a moment, if its shadow is anywhere near."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from skybake.ephemeris.moon import Moon, reaches
from skybake.optics.spectrum import star_at
from skybake.preset import Planet

if TYPE_CHECKING:
    from skybake.ephemeris.moment import Moment


def eclipsing_moon(
    planet: Planet, moment: Moment | None, sun_distance: float | None, altitude: float
) -> Moon | None:
    """Return the moon of a moment, if it covers the sun for any air or ground that can be seen.

    Parameters
    ----------
    planet : Planet
        The world.
    moment : Moment or None
        When, and where the sun is.
    sun_distance : float or None
        As of `skybake.image.settings.Lighting`. [au]
    altitude : float
        Of the observer. [km]
    """
    if moment is None or moment.moon is None:
        return None
    star = star_at(planet.star, sun_distance)
    top = planet.radius + planet.atmosphere_top
    reach = math.sqrt(altitude * (altitude + 2.0 * planet.radius))
    reach += math.sqrt(top**2 - planet.radius**2)
    sun = moment.sun_azimuth, moment.sun_elevation, star.angular_radius, star.distance
    return moment.moon if reaches(moment.moon, *sun, reach) else None
