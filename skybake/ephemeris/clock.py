"""How texts of times are interpreted: by place, clock, day or season."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import date, datetime, tzinfo

from skybake.ephemeris.horizon import Horizon
from skybake.ephemeris.local_clock import find_zone
from skybake.ephemeris.place import Place
from skybake.ephemeris.season import DAY, parse_solar_time
from skybake.ephemeris.times import kind_of, parse_end, parse_time
from skybake.errors import ArgumentError, InputError


@dataclass(frozen=True)
class Clock:
    """How texts of times are interpreted.

    Attributes
    ----------
    place : Place
        Where.
    zone : str or None
        Time zone of times without an offset.
    day : date or None
        Local date of events.
    solar_longitude : float or None
        Season of Mars; times are then of local true solar time. [rad]
    refraction : bool or None
        Whether the sun is raised by refraction in Earth's atmosphere; None raises it where
        a time is that of an event, which is defined by what is seen.
    altitudes : tuple of float
        Of the observer above the ground, at the first moment and at the last. [km]
    """

    place: Place
    zone: str | None
    day: date | None
    solar_longitude: float | None
    refraction: bool | None = None
    altitudes: tuple[float, float] = (0.0, 0.0)

    @property
    def is_on_mars(self) -> bool:
        """Whether the place is."""
        return self.place.planet == "mars"

    def horizons(self, texts: Iterable[str]) -> tuple[Horizon, Horizon]:
        """Return the horizon at the first moment and at the last, for times that are texts."""
        refraction = self.refraction
        if refraction is None:
            refraction = not self.is_on_mars and any(kind_of(text) == "event" for text in texts)
        with argument("altitude"):
            first, last = (
                Horizon(self.place.planet, altitude, refraction) for altitude in self.altitudes
            )
        return first, last

    def check(self, texts: Mapping[str, str]) -> None:
        """Refuse what has no effect with the rest, and require what is missing.

        Parameters
        ----------
        texts : mapping of str to str
            Times by the names of their arguments: one, or start and end.

        Raises
        ------
        ArgumentError
            That names the arguments.
        """
        if self.is_on_mars and self.refraction:
            raise ArgumentError(
                "{refraction}: is that of Earth's atmosphere (the place is on Mars)"
            )
        if self.solar_longitude is None:
            self._check_kinds(texts)
            return
        if not self.is_on_mars:
            raise ArgumentError("{solar_longitude}: is a season of Mars (the place is on Earth)")
        if not 0.0 <= self.solar_longitude <= 2.0 * math.pi + 1e-9:
            raise ArgumentError(
                "{solar_longitude}: must be from 0deg to 360deg, got {angle:g}deg",
                angle=math.degrees(self.solar_longitude),
            )
        for name, value in (("zone", self.zone), ("day", self.day)):
            if value is not None:
                raise ArgumentError(
                    f"{{{name}}}: cannot be combined with {{solar_longitude}}, "
                    "which needs times in solar time"
                )

    def _check_kinds(self, texts: Mapping[str, str]) -> None:
        kinds = {name: kind_of(text) for name, text in texts.items()}
        for name, text in texts.items():
            if self.is_on_mars and kinds[name] == "unknown":
                raise ArgumentError(
                    f"{{{name}}}: on Mars must be such as 2026-06-21T04:00Z, sunset with {{day}}, "
                    "or 16:30 with {solar_longitude}, got {text!r}",
                    text=text,
                )
            if kinds[name] == "event" and self.day is None:
                instead = " or {solar_longitude}" if self.is_on_mars else ""
                raise ArgumentError(f"{{{name}}} {{text}}: needs {{day}}{instead}", text=text)
            if kinds[name] == "local" and self.zone is None:
                raise ArgumentError(
                    f"{{{name}}}: needs an offset, as {{text}}Z or {{text}}+02:00, or {{zone}}, "
                    "since local times differ",
                    text=text,
                )
        if self.day is not None and set(kinds.values()) <= {"local", "absolute"}:
            raise ArgumentError(f"{{day}}: needs {{{next(iter(texts))}}} sunset or another event")

    def bounds(self, texts: Mapping[str, str]) -> tuple[tzinfo | None, datetime, datetime]:
        """Return the local clock, the first time and the last, of what `check` has accepted.

        Raises
        ------
        ArgumentError
            If there are no such times.
        """
        zone = None
        if self.zone is not None:
            with argument("zone"):
                zone = find_zone(self.zone)
        first_horizon, last_horizon = self.horizons(texts.values())
        (first, text), *others = texts.items()
        with argument(first):
            start = end = parse_time(
                text, place=self.place, zone=zone, day=self.day, horizon=first_horizon
            )
        for last, text in others:
            with argument(last):
                end = parse_end(
                    text, start, place=self.place, zone=zone, day=self.day, horizon=last_horizon
                )
        return zone, start, end

    def solar_bounds(self, season: float, texts: Mapping[str, str]) -> tuple[float, float]:
        """Return the first and the last local true solar time in a season of Mars. [s]

        Raises
        ------
        ArgumentError
            If there are no such times.
        """
        times = []
        for (name, text), horizon in zip(
            texts.items(), self.horizons(texts.values()), strict=False
        ):
            with argument(name):
                times.append(parse_solar_time(text, season, self.place, horizon))
        start, end = times[0], times[-1]
        return start, end + DAY if len(times) > 1 and end <= start else end


@contextmanager
def argument(name: str) -> Iterator[None]:
    """Put the name of an argument before the error in its value."""
    try:
        yield
    except ArgumentError:
        raise
    except InputError as error:
        raise ArgumentError(f"{{{name}}}: {{cause}}", cause=error) from error
