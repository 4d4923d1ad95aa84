"""Suns at a time and a place, and over a span of time."""

import math
from datetime import UTC, date, datetime

import pytest

from skybake.ephemeris.earth import refraction, sun_distance, sun_position
from skybake.ephemeris.horizon import Horizon
from skybake.ephemeris.moment import TimeSpan, sun_at
from skybake.ephemeris.place import SITES, Place, check_planet, find_place
from skybake.errors import ArgumentError
from tests.ephemeris.places import PARIS, TROMSO

SUMMER = date(2026, 6, 21)
GALE = SITES["gale"]
APIA = Place(math.radians(-13.83), math.radians(-171.77))
HOUR = 3600.0


def test_a_text_and_a_datetime_of_the_same_time_are_one_moment():
    time = datetime(2026, 6, 21, 8, tzinfo=UTC)
    moment = sun_at(time, PARIS)
    assert moment == sun_at("2026-06-21T10:00+02:00", PARIS)
    assert (moment.sun_elevation, moment.sun_azimuth) == sun_position(time, PARIS)
    local = sun_at(datetime(2026, 6, 21, 10), PARIS, zone="Europe/Paris")
    assert local.time == time
    assert local.label == "2026-06-21T10:00:00+02:00"


def test_a_span_has_its_end_and_local_labels_across_a_change_of_clocks():
    found = TimeSpan(
        "2026-03-29T01:00", "2026-03-29T04:00", PARIS, every=HOUR, zone="Europe/Paris"
    ).moments()
    assert [one.label for one in found] == [
        "2026-03-29T01:00:00+01:00",
        "2026-03-29T03:00:00+02:00",
        "2026-03-29T04:00:00+02:00",
    ]
    assert [one.time.hour for one in found] == [0, 1, 2]
    for one in found:
        assert (one.sun_elevation, one.sun_azimuth) == sun_position(one.time, PARIS)
        assert one.attributes["skybake:time"] == f"{one.time:%Y-%m-%dT%H:%M:%SZ}"


def test_a_count_is_spread_evenly_with_start_and_end():
    span = TimeSpan("2026-06-21T04:00Z", "2026-06-21T05:00Z", PARIS)
    assert [one.label for one in span.moments(4)] == [
        f"2026-06-21T{clock}:00Z" for clock in ("04:00", "04:20", "04:40", "05:00")
    ]
    assert len(span.moments(1)) == 1


def test_a_night_goes_from_sunset_to_the_next_sunrise():
    found = TimeSpan("sunset", "sunrise", PARIS, day=SUMMER, zone="Europe/Paris").moments(3)
    assert found[0].label.startswith("2026-06-21T21:57")
    assert found[-1].label.startswith("2026-06-22T05:47")
    seen = math.radians(-50 / 60) + refraction(math.radians(-50 / 60))
    assert found[0].sun_elevation == pytest.approx(seen, abs=4e-5)
    assert found[-1].sun_elevation == pytest.approx(seen, abs=4e-5)
    assert found[1].sun_elevation < math.radians(-15.0)


def test_a_day_on_mars_goes_by_its_own_clock():
    found = TimeSpan("04:00", "20:00", GALE, every=HOUR, solar_longitude=math.pi).moments()
    assert len(found) == 17
    assert found[0].label == "Ls 180 04:00:00"
    assert all(one.time is None for one in found)
    assert found[8].sun_elevation == max(one.sun_elevation for one in found)
    night = TimeSpan("22:00", "02:00", GALE, solar_longitude=math.pi).moments(3)
    assert [one.label for one in night] == [f"Ls 180 {h}:00:00" for h in ("22", "00", "02")]
    dates = TimeSpan("2026-06-21T04:00Z", "2026-06-22T04:00Z", SITES["jezero"]).moments(2)
    assert [one.label for one in dates] == ["2026-06-21T04:00:00Z", "2026-06-22T04:00:00Z"]


@pytest.mark.parametrize(
    ("start", "end", "options", "message"),
    [
        ("2026-06-21T04:00Z", "2026-06-21T04:00Z", {}, "end: must be after the start"),
        ("2026-06-21T04:00", "2026-06-21T05:00Z", {}, "start: needs an offset"),
        ("2026-06-21T04:00Z", "x", {}, "end: must be a time such as"),
        ("2026-06-21T04:00Z", "sunset", {}, "end sunset: needs day"),
        ("2026-06-21T04:00Z", "2026-06-21T05:00Z", {"every": 0.0}, "every: must be longer than"),
        ("2026-06-21T04:00Z", "2026-06-22T05:00Z", {"every": 0.1}, "every: must give at most 10"),
        ("2026-06-21T04:00Z", "2026-06-21T05:00Z", {"count": 0}, "frames: must be from 1 to 10"),
        ("2026-06-21T04:00Z", "2026-06-21T05:00Z", {"count": None}, "frames: must be from 1 to"),
    ],
)
def test_a_faulty_span_names_the_argument(start, end, options, message):
    count = options.pop("count", 2)
    with pytest.raises(ArgumentError) as caught:
        TimeSpan(start, end, PARIS, **options).moments(count)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    ("time", "place", "options", "message"),
    [
        ("sunset", TROMSO, {"day": SUMMER}, "time: sunset: the sun does not set at 69.65N 18.96E"),
        ("sunset", PARIS, {}, "time sunset: needs day"),
        ("2026-06-21T04:00", PARIS, {}, "time: needs an offset, as 2026-06-21T04:00Z or"),
        (
            "2026-06-21T04:00Z",
            PARIS,
            {"day": SUMMER},
            "day: needs time sunset or another event",
        ),
        ("sunset", PARIS, {"day": SUMMER, "altitude": -1.0}, "altitude: must be at least 0 km, g"),
        (
            "sunset",
            APIA,
            {"day": date(2011, 12, 30), "zone": "Pacific/Apia"},
            "day: does not exist in Pacific/Apia, where clocks change from 2011-12-30 00:00 to "
            "2011-12-31 00:00, got",
        ),
        ("2011-12-30T09:00", APIA, {"zone": "Pacific/Apia"}, "time: does not exist in Pacific/"),
        ("2026-06-21T04:00", PARIS, {"zone": "Mars/Gale"}, "zone: unknown time zone 'Mars/Gale'"),
        ("12:00", PARIS, {"solar_longitude": 1.0}, "solar_longitude: is a season of Mars (the pl"),
        ("12:00", GALE, {"solar_longitude": 7.0}, "solar_longitude: must be from 0deg to 360deg"),
        ("25:00", GALE, {"solar_longitude": 1.0}, "time: must be a time of day such as 04:00"),
        ("12:00", GALE, {}, "time: on Mars must be such as 2026-06-21T04:00Z, sunset with day,"),
        ("sunset", GALE, {}, "time sunset: needs day or solar_longitude"),
        ("next-sunset", GALE, {"solar_longitude": 1.0}, "time: next-sunset: needs a date, and"),
        (
            "sunset",
            Place(math.radians(80.0), 0.0, "mars"),
            {"solar_longitude": math.pi / 2},
            "time: sunset: the sun does not set at 80.00N 0.00E at Ls 90, it stays above the hor",
        ),
        ("1960-06-21T04:00Z", GALE, {}, "time: on Mars must be in the years 1972 to 2127"),
        ("2026-06-21T04:00Z", GALE, {"refraction": True}, "refraction: is that of Earth's atmosp"),
    ],
)
def test_a_faulty_time_names_the_argument(time, place, options, message):
    with pytest.raises(ArgumentError) as caught:
        sun_at(time, place, **options)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize("altitude", [0.0, 0.1, 4.2, 12.0])
@pytest.mark.parametrize("event", ["sunrise", "sunset"])
def test_the_sun_is_seen_on_the_horizon_as_it_rises_and_sets(event, altitude):
    """Its upper edge is within 4' of the horizon of the altitude, with refraction or without."""
    for lifted in (None, False):
        sun = sun_at(event, PARIS, day=SUMMER, altitude=altitude, refraction=lifted)
        edge = math.degrees(sun.sun_elevation + Horizon("earth", altitude).dip) * 60 + 16
        expected = 3.1 * math.exp(-altitude / 8.1) if lifted is None else 0.0
        assert edge == pytest.approx(expected, abs=0.15)


def test_the_dip_of_the_horizon_delays_sunset():
    """At 4200 m by the sunrise equation's 2.08' times the root of metres, less a tenth."""
    low, high = (sun_at("sunset", PARIS, day=SUMMER, altitude=km) for km in (0.0, 4.2))
    lower = math.degrees(sun_position(low.time, PARIS)[0] - sun_position(high.time, PARIS)[0])
    assert lower * 60 == pytest.approx(math.sqrt(4200) * 2.076, rel=0.08)


def test_an_event_raises_the_sun_and_a_clock_does_not():
    event = sun_at("noon", PARIS, day=SUMMER)
    assert event.attributes["skybake:refraction"] > 0.0
    plain = sun_at(event.time, PARIS)
    assert "skybake:refraction" not in plain.attributes
    assert plain.sun_elevation < event.sun_elevation
    assert sun_at("noon", PARIS, day=SUMMER, refraction=False).sun_elevation == plain.sun_elevation
    span = TimeSpan("2026-06-21T18:00Z", "sunset", PARIS, day=SUMMER).moments(2)
    assert all("skybake:refraction" in one.attributes for one in span)


def test_a_climb_has_the_horizon_of_each_moments_altitude():
    first, middle, last = TimeSpan(
        "sunset-30min", "sunset", PARIS, day=SUMMER, altitude=(0.0, 4.0)
    ).moments(3)
    assert first.time == sun_at("sunset-30min", PARIS, day=SUMMER).time
    assert last == sun_at("sunset", PARIS, day=SUMMER, altitude=4.0)
    halfway = sun_at(middle.time, PARIS, refraction=True, altitude=2.0)
    assert halfway.sun_elevation == middle.sun_elevation


def test_a_moment_has_the_suns_distance_on_both_planets():
    time = datetime(2026, 1, 3, 17, tzinfo=UTC)
    assert (
        sun_at(time, PARIS).sun_distance == sun_distance(time) == pytest.approx(0.98330, abs=2e-5)
    )
    season = sun_at("12:00", GALE, solar_longitude=math.radians(251.0))
    assert season.sun_distance == pytest.approx(1.38137, abs=2e-5)
    day = sun_at(time, GALE)
    again = math.radians(day.attributes["skybake:solarLongitude"])
    assert day.sun_distance == pytest.approx(
        sun_at("12:00", GALE, solar_longitude=again).sun_distance, abs=3e-4
    )


@pytest.mark.parametrize("event", ["sunrise", "sunset"])
@pytest.mark.parametrize("altitude", [0.0, 5.0])
def test_on_mars_the_sun_rises_and_sets_by_date_and_by_season(event, altitude):
    """Its upper edge, 10.5' above its centre on average, is on the horizon."""
    day = sun_at(event, GALE, day=SUMMER, altitude=altitude)
    season = math.radians(day.attributes["skybake:solarLongitude"])
    edge = math.asin(695_700.0 / (day.sun_distance * 149_597_870.7))
    target = -edge - Horizon("mars", altitude).dip
    assert day.sun_elevation == pytest.approx(target, abs=4e-5)
    assert (math.sin(day.sun_azimuth) > 0.0) == (event == "sunrise")
    same = sun_at(event, GALE, solar_longitude=season, altitude=altitude)
    assert same.sun_elevation == pytest.approx(target, abs=1e-6)
    assert same.sun_azimuth == pytest.approx(day.sun_azimuth, abs=1e-4)
    clocks = [one.attributes["skybake:trueSolarTime"] for one in (day, same)]
    assert clocks[0][:5] == clocks[1][:5]


def test_a_sol_goes_from_an_hour_before_sunrise_to_an_hour_after_sunset():
    found = TimeSpan("sunrise-1h", "sunset+1h", GALE, every=HOUR, solar_longitude=0.0).moments()
    clocks = [one.attributes["skybake:trueSolarTime"] for one in found]
    assert clocks[0].startswith("04:5")
    assert clocks[-1].startswith("18:5")
    night = TimeSpan("sunset", "sunrise", GALE, solar_longitude=0.0).moments(3)
    assert [one.sun_elevation > -0.01 for one in night] == [True, False, True]


def test_a_place_is_given_by_coordinates_or_on_mars_by_its_name():
    assert find_place(latitude=0.5, longitude=1.0) == Place(0.5, 1.0, "earth")
    assert find_place(latitude=0.5, longitude=1.0, solar_longitude=0.0).planet == "mars"
    assert find_place(site="gale") == GALE


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (find_place, "place: needs latitude and longitude, or on Mars site"),
        (lambda: find_place(latitude=1.0), "latitude: needs longitude as well"),
        (lambda: find_place(longitude=1.0), "longitude: needs latitude as well"),
        (lambda: find_place(site="venus"), "site: must be one of ares-vallis, "),
        (lambda: find_place(site="gale", latitude=1.0, longitude=1.0), "site: cannot be combined"),
        (lambda: Place(1.6, 0.0), "latitude: must be from -90deg to 90deg, got 91.6"),
        (lambda: Place(math.nan, 0.0), "latitude: must be from -90deg to 90deg, got nan"),
        (lambda: Place(0.0, math.inf), "longitude: must be finite, got inf"),
        (lambda: Place(0.0, 0.0, "venus"), "planet: must be one of earth, mars, got 'venus'"),
        (lambda: check_planet(GALE, "earth"), "place: is on Mars (the preset is of earth)"),
        (lambda: check_planet(PARIS, "mars"), "place: is on Earth, a place on Mars needs site or"),
        (lambda: check_planet(PARIS, "titan"), "place: the sun's path is known for Earth and Mars"),
    ],
)
def test_a_faulty_place_names_the_argument(make, message):
    with pytest.raises(ArgumentError) as caught:
        make()
    assert str(caught.value).startswith(message)


def test_a_place_of_an_unknown_planet_is_let_pass():
    check_planet(PARIS, None)
    check_planet(PARIS, "earth")


def test_a_fault_tells_names_of_options_as_well_and_leaves_braces_of_values_alone():
    with pytest.raises(ArgumentError) as caught:
        sun_at("{zone}", PARIS, zone="UTC")
    assert caught.value.text({"time": "--time", "zone": "--tz"}).endswith("got '{zone}'")
    assert caught.value.text({"time": "--time"}).startswith("--time: must be a time such")
