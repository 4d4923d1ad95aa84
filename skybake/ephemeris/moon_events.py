"""Moonrise and moonset: when the Moon's upper edge passes the horizon of a place on Earth."""

from __future__ import annotations

import math
from datetime import UTC, date, datetime, time, timedelta, tzinfo
from typing import NamedTuple

from skybake.ephemeris.earth_moon import sun_and_moon
from skybake.ephemeris.events import dates_around
from skybake.ephemeris.horizon import Horizon
from skybake.ephemeris.moon import MEAN_RADIUS
from skybake.ephemeris.place import Place
from skybake.errors import InputError

STEP = timedelta(minutes=20)
"""Between times that are tried; a Moon that is up for less may be missed beside a pole."""

LONGEST_ABSENCE = 30
"""Days after which the Moon has risen again everywhere."""

_SECOND = timedelta(seconds=1)


class MoonDay(NamedTuple):
    """A moonrise or moonset at a place, of any day.

    Attributes
    ----------
    event : {"moonrise", "moonset"}
        Which of them.
    place : Place
        On Earth.
    zone : tzinfo
        The local clock.
    horizon : Horizon
        On which the Moon is seen.
    """

    event: str
    place: Place
    zone: tzinfo
    horizon: Horizon

    def time(self, day: date) -> datetime | None:
        """Return when it happens first on a local date, in UTC, or None if it does not.

        Raises
        ------
        InputError
            If the place is not on Earth.
        """
        if self.place.planet != "earth":
            raise InputError(f"{self.event}: needs a place on Earth")
        start, end = (
            datetime.combine(each, time(), self.zone).astimezone(UTC)
            for each in (day, day + timedelta(days=1))
        )
        sign = 1.0 if self.event == "moonrise" else -1.0
        before, height = start, sign * self._height(start)
        while before < end:
            after = min(before + STEP, end)
            following = sign * self._height(after)
            if height < 0.0 <= following:
                return self._crossing(before, after, sign)
            before, height = after, following
        return None

    def nearest(self, day: date, step: int) -> datetime | None:
        """Return when it happens first after a day, or before it with a step of -1."""
        for days in range(1, LONGEST_ABSENCE + 1):
            try:
                found = self.time(day + step * timedelta(days=days))
            except OverflowError:
                return None
            if found is not None:
                return found
        return None

    def absence(self, day: date) -> str:
        """Say that it does not happen on a day, and when it does."""
        verb = "rise" if self.event == "moonrise" else "set"
        text = f"{self.event}: the moon does not {verb} at {self.place} on {day}"
        return "; ".join([text, *dates_around(self, self.event, day, self.zone)])

    def _height(self, moment: datetime) -> float:
        """Return how far the Moon's upper edge is above the horizon, without refraction. [rad]"""
        _, moon = sun_and_moon(moment, self.place, self.horizon.altitude)
        distance = math.hypot(*moon)
        elevation = math.asin(float(moon[2]) / distance)
        return elevation + math.asin(MEAN_RADIUS / distance) - self.horizon.edge

    def _crossing(self, low: datetime, high: datetime, sign: float) -> datetime:
        while high - low > _SECOND / 10:
            middle = low + (high - low) / 2
            if sign * self._height(middle) < 0.0:
                low = middle
            else:
                high = middle
        return (low + _SECOND / 2).replace(microsecond=0)
