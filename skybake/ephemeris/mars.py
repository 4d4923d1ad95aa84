"""The sun as seen from Mars.

After Allison and McEwen (2000, Planet. Space Sci. 48, 215), with the constants that
NASA GISS revised for Mars24 (Allison and Schmunk, "Algorithm and Worked Examples").
Good for 0.01 deg of solar longitude from 1874 to 2127.
"""

from __future__ import annotations

import math
from datetime import UTC, datetime, timedelta
from typing import NamedTuple

from skybake.ephemeris.place import Place
from skybake.errors import InputError

FIRST_YEAR, LAST_YEAR = 1972, 2127

SOL_DAYS = 1.0274912517
"""Length of a mean solar day. [d]"""

_J2000 = datetime(2000, 1, 1, 12, tzinfo=UTC)
_DAY = timedelta(days=1)
_TURN = 2.0 * math.pi

_SIN_OBLIQUITY = 0.42565
OBLIQUITY = math.asin(_SIN_OBLIQUITY)
"""Of the equator to the orbit. [rad]"""

EQUATORIAL_RADIUS, POLAR_RADIUS = 3396.19, 3376.20
"""Of the ellipsoid of IAU 2000 (Seidelmann et al. 2002). [km]"""

# Amplitude [deg], period [Julian years] and phase [deg] of perturbations by other planets.
_PERTURBATIONS = (
    (0.0071, 2.2353, 49.409),
    (0.0057, 2.7543, 168.173),
    (0.0039, 1.1177, 191.837),
    (0.0037, 15.7866, 21.736),
    (0.0021, 2.1354, 15.704),
    (0.0020, 2.4694, 95.528),
    (0.0018, 32.8493, 49.095),
)
# Amplitudes [deg] of the sines of the mean anomaly and its multiples; the first grows.
_CENTRE = (10.691, 0.623, 0.050, 0.005, 0.0005)

_SEMIMAJOR_AXIS = 1.52367934  # au
_ECCENTRICITY = 0.09340
_PERIHELION = 251.000  # Ls at perihelion in 2000, deg

# TT is 32.184 s ahead of atomic time, and that was 10 s ahead of UTC when it began to
# leap. Leap seconds since then, at the beginning of these (IERS Bulletin C).
_TT_LESS_UTC_IN_1972 = 42.184
_LEAPS = (
    *("1972-07", "1973-01", "1974-01", "1975-01", "1976-01", "1977-01", "1978-01"),
    *("1979-01", "1980-01", "1981-07", "1982-07", "1983-07", "1985-07", "1988-01"),
    *("1990-01", "1991-01", "1992-07", "1993-07", "1994-07", "1996-01", "1997-07"),
    *("1999-01", "2006-01", "2009-01", "2012-07", "2015-07", "2017-01"),
)


class MarsTime(NamedTuple):
    """Season and time of day on Mars.

    Attributes
    ----------
    solar_longitude : float
        Of the sun, Ls, from the northern spring equinox, 0 to 2 pi. [rad]
    equation_of_time : float
        True less mean solar time. [rad]
    sol_date : float
        Mars Sol Date; its fraction is the mean solar time at longitude 0. [sol]
    sun_distance : float
        As of `distance_in_season`. [au]
    """

    solar_longitude: float
    equation_of_time: float
    sol_date: float
    sun_distance: float

    def hour_angle(self, longitude: float) -> float:
        """Local true solar time as the angle since noon, at an east longitude. [rad]"""
        mean = _TURN * (self.sol_date % 1.0) + longitude
        return math.remainder(mean + self.equation_of_time - math.pi, _TURN)


def mars_time(time: datetime) -> MarsTime:
    """Return season and time of day on Mars.

    Parameters
    ----------
    time : datetime
        Aware.

    Raises
    ------
    InputError
        Before 1972, where UTC has no whole seconds, and after 2127.
    """
    time = time.astimezone(UTC)
    if not FIRST_YEAR <= time.year <= LAST_YEAR:
        raise InputError(
            f"on Mars must be in the years {FIRST_YEAR} to {LAST_YEAR}, got {time.year}"
        )
    days = (time - _J2000) / _DAY + tt_less_utc(time) / 86_400.0
    anomaly = math.radians(19.3871 + 0.52402073 * days)
    mean_sun = math.radians(270.3871 + 0.524038496 * days)
    centre = 3.0e-7 * days * math.sin(anomaly)
    centre += sum(size * math.sin(n * anomaly) for n, size in enumerate(_CENTRE, 1))
    centre += sum(
        size * math.cos(math.radians(360.0 / 365.25 * days / period + phase))
        for size, period, phase in _PERTURBATIONS
    )
    centre = math.radians(centre)
    season = (mean_sun + centre) % _TURN
    projection = 2.861 * math.sin(2 * season) - 0.071 * math.sin(4 * season)
    projection += 0.002 * math.sin(6 * season)
    sol_date = (days - 4.5) / SOL_DAYS + 44_796.0 - 0.0009626
    # At perihelion the anomaly is 0 and the equation of centre too.
    distance = distance_in_season(season, mean_sun - anomaly)
    return MarsTime(season, math.radians(projection) - centre, sol_date, distance)


def tt_less_utc(time: datetime) -> float:
    """Return how far terrestrial time is ahead of UTC, from 1972 on. [s]"""
    month = f"{time.astimezone(UTC):%Y-%m}"
    return _TT_LESS_UTC_IN_1972 + sum(leap <= month for leap in _LEAPS)


def distance_in_season(
    solar_longitude: float, perihelion: float = math.radians(_PERIHELION)
) -> float:
    """Return how far the sun is in a season, by the ellipse of Allison and McEwen (2000).

    Parameters
    ----------
    solar_longitude : float
        Ls. [rad]
    perihelion : float, optional
        Ls at perihelion, by default that of 2000. [rad]

    Returns
    -------
    float
        Within 0.0004, which is how far other planets move Mars from its ellipse. [au]
    """
    anomaly = solar_longitude - perihelion
    axis = _SEMIMAJOR_AXIS * (1.0 - _ECCENTRICITY**2)
    return axis / (1.0 + _ECCENTRICITY * math.cos(anomaly))


def declination(solar_longitude: float) -> float:
    """Angle of the direction to the sun from the plane of Mars's equator. [rad]"""
    return math.asin(_SIN_OBLIQUITY * math.sin(solar_longitude))


def planetographic_latitude(latitude: float) -> float:
    """Angle of the vertical from the plane of the equator, of a planetocentric latitude. [rad]"""
    squared = (POLAR_RADIUS / EQUATORIAL_RADIUS) ** 2
    return math.atan2(math.sin(latitude), squared * math.cos(latitude))


def horizontal(latitude: float, declination: float, hour_angle: float) -> tuple[float, float]:
    """Return elevation and azimuth of what has a declination and an hour angle.

    Parameters
    ----------
    latitude : float
        Of the vertical. [rad]
    declination, hour_angle : float
        Hour angles grow toward the west. [rad]

    Returns
    -------
    elevation, azimuth : float
        The azimuth is a compass bearing from 0 to 2 pi. [rad]
    """
    sine, cosine = math.sin(declination), math.cos(declination)
    up = math.sin(latitude) * sine + math.cos(latitude) * cosine * math.cos(hour_angle)
    north = math.cos(latitude) * sine - math.sin(latitude) * cosine * math.cos(hour_angle)
    east = -cosine * math.sin(hour_angle)
    return math.atan2(up, math.hypot(north, east)), math.atan2(east, north) % _TURN


def sun_in_season(
    solar_longitude: float, hour_angle: float, latitude: float
) -> tuple[float, float]:
    """Return the sun's position at a season and a local true solar time.

    Parameters
    ----------
    solar_longitude : float
        Ls. [rad]
    hour_angle : float
        Local true solar time as the angle since noon. [rad]
    latitude : float
        Planetocentric. [rad]

    Returns
    -------
    elevation, azimuth : float
        Geometric, of the sun's centre; a compass bearing, 0 to 2 pi. [rad]

    Notes
    -----
    The direction to the sun and the vertical are both measured from the equator's plane.
    Mars24 puts the planetographic latitude of the point below the sun in place of the
    former, and gives elevations that are up to 0.25 deg off.
    """
    vertical = planetographic_latitude(latitude)
    return horizontal(vertical, declination(solar_longitude), hour_angle)


def sun_position(time: datetime, place: Place) -> tuple[float, float]:
    """Return the position of the sun's centre at a time and a place.

    Returns
    -------
    elevation, azimuth : float
        As of `sun_in_season`. [rad]

    Raises
    ------
    InputError
        As `mars_time`.
    """
    now = mars_time(time)
    return sun_in_season(now.solar_longitude, now.hour_angle(place.longitude), place.latitude)


def hour_angle(time: datetime, place: Place) -> float:
    """Return how far the sun has moved past the upper meridian, -pi to pi. [rad]"""
    return mars_time(time).hour_angle(place.longitude)
