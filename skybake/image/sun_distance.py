"""How far the sun of a world is: as its preset says, as the user says, or as the date has it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.place import MEAN_DISTANCES
from skybake.preset import Planet

if TYPE_CHECKING:
    from skybake.ephemeris.moment import Moment

FROM_DATE, MEAN = "date", "mean"
"""Distances by a word: that of the moment, and that of the preset."""

_KEY = "star.distance_au"


def sun_distance(
    planet: Planet, moment: Moment | None = None, wanted: float | str | None = None
) -> float | None:
    """Return how far the sun is, as `skybake.image.settings.Lighting` takes it.

    Parameters
    ----------
    planet : Planet
        The world. That of a moment is taken as the mean of its orbit, which is as eccentric
        as the planet's of the moment's place.
    moment : Moment, optional
        When.
    wanted : float, "date", "mean" or None, optional
        A distance [au], or where it is from; None follows a moment, unless the distance
        was set in the preset.

    Returns
    -------
    float or None
        None leaves the sun where the preset has it. [au]
    """
    if wanted is None:
        wanted = MEAN if _KEY in planet.recipe.get("set", {}) else FROM_DATE
    if isinstance(wanted, float | int):
        return float(wanted)
    if wanted == MEAN or moment is None:
        return None
    mean = planet.star.distance / ASTRONOMICAL_UNIT
    return mean * moment.sun_distance / MEAN_DISTANCES[moment.place.planet]
