"""Refusal of eclipses, by what only knows a whole sun."""

from __future__ import annotations

from dataclasses import replace

from skybake.ephemeris.moment import Moment
from skybake.errors import InputError
from skybake.image.eclipsing_moon import eclipsing_moon
from skybake.image.scene import Scene
from skybake.image.settings import MapSettings
from skybake.preset import Planet


def check_uneclipsed(planet: Planet, settings: MapSettings, moment: Moment | None) -> None:
    """Refuse a time at which a moon is in front of the sun, or its shadow is in sight.

    Parameters
    ----------
    planet : Planet
        The world.
    settings : MapSettings
        The observer and the sun.
    moment : Moment or None
        When; None if the sun was placed by hand.

    Raises
    ------
    InputError
        That tells how much of the sun is covered.
    """
    lighting = settings.lighting
    moon = eclipsing_moon(planet, moment, lighting.sun_distance, settings.view.altitude)
    if moon is None:
        return
    eclipse = Scene(planet, replace(settings, lighting=replace(lighting, moon=moon))).sky.eclipse
    if eclipse is not None:
        covered = eclipse.phase.obscuration
        raise InputError(
            f"time: sun must not be in eclipse, in whose shadow air has another light, got "
            f"{covered:.1%} of it covered"
        )
