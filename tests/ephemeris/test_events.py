"""When the sun rises, sets and culminates."""

import math
from datetime import UTC, date, datetime, timedelta
from itertools import pairwise
from zoneinfo import ZoneInfo

import numpy as np
import pytest

from skybake.ephemeris import mars
from skybake.ephemeris.earth import hour_angle, sun_position
from skybake.ephemeris.events import EVENTS, event_time, mean_solar_zone
from skybake.ephemeris.place import SITES, Place
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


@pytest.mark.parametrize(
    ("event", "day", "previous", "following"),
    [
        ("sunset", SUMMER, date(2026, 5, 17), date(2026, 7, 27)),
        ("sunrise", WINTER, date(2026, 11, 27), date(2027, 1, 15)),
    ],
)
def test_the_events_around_polar_day_and_night_are_told_and_found(event, day, previous, following):
    """Tromso's midnight sun and polar night, within two days of what the almanacs have."""
    oslo = ZoneInfo("Europe/Oslo")
    before, after = (
        event_time(event, day, TROMSO, oslo, search=search) for search in ("previous", "next")
    )
    assert abs(before.astimezone(oslo).date() - previous) <= timedelta(days=2)
    assert abs(after.astimezone(oslo).date() - following) <= timedelta(days=2)
    with pytest.raises(InputError) as caught:
        event_time(event, day, TROMSO, oslo)
    assert str(caught.value).endswith(
        f"; previous-{event} is on {before.astimezone(oslo):%Y-%m-%d}"
        f"; next-{event} is on {after.astimezone(oslo):%Y-%m-%d}"
    )


def test_the_next_event_is_that_of_the_day_if_it_happens():
    day = date(2026, 3, 20)
    plain = event_time("sunset", day, TROMSO, UTC)
    for search in ("next", "previous"):
        assert event_time("sunset", day, TROMSO, UTC, search=search) == plain


def test_at_the_pole_the_sun_rises_once_a_year():
    pole = PLACES["north pole"]
    risen = event_time("sunrise", date(2026, 1, 1), pole, UTC, search="next")
    assert date(2026, 3, 17) <= risen.date() <= date(2026, 3, 20)


def test_on_mars_the_events_of_a_date_surround_its_first_noon():
    gale = SITES["gale"]
    for days in range(40):
        day = SUMMER + timedelta(days=days)
        begin = datetime(day.year, day.month, day.day, tzinfo=UTC)
        midnight, sunrise, noon, sunset = (
            event_time(event, day, gale, UTC) for event in ("midnight", "sunrise", "noon", "sunset")
        )
        assert midnight < sunrise < noon < sunset
        assert timedelta() <= noon - begin < timedelta(days=1.0275)
        assert mars.hour_angle(noon, gale) == pytest.approx(0.0, abs=4e-5)


def test_the_night_of_a_pole_of_mars_ends_with_a_next_sunrise():
    pole = Place(math.radians(85.0), 0.0, "mars")
    night = next(
        day
        for day in (date(2026, 1, 1) + timedelta(days=30 * n) for n in range(24))
        if math.sin(mars.mars_time(datetime(day.year, day.month, day.day, tzinfo=UTC))[0]) < -0.9
    )
    with pytest.raises(InputError, match=r"does not rise at .* it stays below the horizon; prev"):
        event_time("sunrise", night, pole, UTC)
    risen = event_time("sunrise", night, pole, UTC, search="next")
    assert mars.sun_position(risen, pole)[0] == pytest.approx(math.radians(-10 / 60), abs=4e-4)
