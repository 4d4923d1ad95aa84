"""When the sun rises, sets and culminates."""

import math
from datetime import UTC, date, datetime, timedelta
from itertools import pairwise
from zoneinfo import ZoneInfo

import numpy as np
import pytest

from skybake.ephemeris.earth import hour_angle, sun_position
from skybake.ephemeris.events import EVENTS, event_time, mean_solar_zone
from skybake.errors import InputError
from tests.ephemeris.places import PARIS, PLACES, QUITO, TROMSO, USHUAIA, at

SUMMER, WINTER = date(2026, 6, 21), date(2026, 12, 21)


@pytest.mark.parametrize("place", [PARIS, at(-0.2, 0.0), at(-54.8, 10.0)])
def test_sunrise_noon_and_sunset_are_those_of_spa(place):
    """Near Greenwich, because its events are those of a date in UTC."""
    from pvlib import spa

    for month in range(1, 13):
        day = date(2026, month, 20)
        reference = spa.transit_sunrise_sunset(
            np.array([datetime(2026, month, 20, tzinfo=UTC).timestamp()]),
            *map(math.degrees, (place.latitude, place.longitude)),
            delta_t=spa.calculate_deltat(2026, month),
            numthreads=1,
        )
        for event, (seconds,) in zip(("noon", "sunrise", "sunset"), reference, strict=True):
            found = event_time(event, day, place, UTC).timestamp()
            assert found == pytest.approx(seconds, abs=3.0, rel=0.0)


@pytest.mark.parametrize(
    ("event", "degrees"),
    [
        *(("sunrise", -50 / 60), ("sunset", -50 / 60), ("civil-dawn", -6), ("civil-dusk", -6)),
        *(("nautical-dawn", -12), ("nautical-dusk", -12)),
        *(("astronomical-dawn", -18), ("astronomical-dusk", -18)),
    ],
)
@pytest.mark.parametrize("place", [PARIS, QUITO, USHUAIA])
def test_at_an_event_the_sun_has_its_elevation(event, degrees, place):
    time = event_time(event, date(2026, 3, 20), place, UTC)
    assert time.microsecond == 0
    # In half a second the sun moves by 0.002 deg at most.
    assert math.degrees(sun_position(time, place)[0]) == pytest.approx(degrees, abs=0.0022)
    is_rising = event == "sunrise" or event.endswith("dawn")
    assert (hour_angle(time, place) < 0.0) == is_rising


@pytest.mark.parametrize("name", PLACES)
@pytest.mark.parametrize(("event", "angle"), [("noon", 0.0), ("midnight", math.pi)])
def test_noon_and_midnight_are_on_the_meridian(name, event, angle):
    found = hour_angle(event_time(event, SUMMER, PLACES[name], UTC), PLACES[name])
    assert math.remainder(found - angle, 2 * math.pi) == pytest.approx(0.0, abs=4e-5)


@pytest.mark.parametrize("zone", ["Europe/Paris", "Asia/Tokyo", "Pacific/Kiritimati", "Etc/GMT+12"])
@pytest.mark.parametrize("place", [PARIS, at(0.0, 180.0), at(0.0, -179.9)])
def test_every_local_date_has_one_noon(zone, place):
    zone = ZoneInfo(zone)
    noons = [
        event_time("noon", SUMMER + timedelta(days=days), place, zone).astimezone(zone)
        for days in range(30)
    ]
    for noon, following in pairwise(noons):
        assert following - noon == pytest.approx(timedelta(days=1), abs=timedelta(minutes=1))
    for days, noon in enumerate(noons):
        middle = datetime(2026, 6, 21, 12, tzinfo=zone) + timedelta(days=days)
        assert abs(noon - middle) <= timedelta(hours=12, minutes=17)


def test_the_events_of_a_day_come_in_their_order():
    order = [
        *("midnight", "astronomical-dawn", "nautical-dawn", "civil-dawn", "sunrise", "noon"),
        *("sunset", "civil-dusk", "nautical-dusk", "astronomical-dusk"),
    ]
    assert set(order) == set(EVENTS)
    for place in (PARIS, QUITO, USHUAIA):
        zone = mean_solar_zone(place)
        times = [event_time(event, date(2026, 3, 20), place, zone) for event in order]
        assert times == sorted(times)
        # Local midnight may fall some minutes before the date begins.
        assert {time.astimezone(zone).date() for time in times[1:]} == {date(2026, 3, 20)}


@pytest.mark.parametrize(
    ("event", "day", "message"),
    [
        ("sunrise", SUMMER, "does not rise at 69.65N 18.96E on 2026-06-21, it stays above the"),
        ("sunset", SUMMER, "does not set at 69.65N 18.96E on 2026-06-21, it stays above the"),
        ("sunrise", WINTER, "does not rise at 69.65N 18.96E on 2026-12-21, it stays below the"),
        ("sunset", WINTER, "does not set at 69.65N 18.96E on 2026-12-21, it stays below the"),
        ("civil-dusk", SUMMER, "does not pass -6deg at 69.65N 18.96E on 2026-06-21, it stays abo"),
    ],
)
def test_midnight_sun_and_polar_night_are_told(event, day, message):
    with pytest.raises(InputError) as caught:
        event_time(event, day, TROMSO, ZoneInfo("Europe/Oslo"))
    assert str(caught.value).startswith(f"{event}: the sun {message}")


def test_in_polar_night_there_are_noon_and_civil_twilight():
    dawn, noon, dusk = (
        event_time(event, WINTER, TROMSO, UTC) for event in ("civil-dawn", "noon", "civil-dusk")
    )
    assert dawn < noon < dusk
    assert -6.0 < math.degrees(sun_position(noon, TROMSO)[0]) < -50 / 60


def test_a_place_without_a_zone_goes_by_its_own_sun():
    noon = event_time("noon", SUMMER, USHUAIA, mean_solar_zone(USHUAIA))
    local = noon.astimezone(mean_solar_zone(USHUAIA))
    assert local.date() == SUMMER
    assert abs(local - local.replace(hour=12, minute=0, second=0)) < timedelta(minutes=17)
