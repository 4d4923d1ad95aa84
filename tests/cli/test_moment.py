"""Suns by place and time."""

import csv
import json
import math
import re
from datetime import UTC, datetime
from pathlib import Path
from zoneinfo import ZoneInfo

import numpy as np
import pytest

from skybake.commands.options.celestial import latitude, longitude
from skybake.ephemeris.earth import refraction, sun_position
from skybake.ephemeris.mars import mars_time, sun_in_season
from skybake.ephemeris.place import SITES, Place
from skybake.formats.reader import read_image
from tests.cli.runs import SMALL, invoke, listing
from tests.cli.test_faults import check_fault, table

PARIS = ("--lat", "48.8566", "--lon", "2.3522")
MARS = ("--preset", "mars")

pytestmark = pytest.mark.usefixtures("folder")


def render(*arguments):
    """Render quietly; returns the printed object and the file's attributes and pixels."""
    result = invoke("render", *SMALL, "--json", "--quiet", "-o", "a.exr", *arguments)
    assert result.exit_code == 0, result.output
    pixels, attributes = read_image(Path("a.exr"))
    return json.loads(result.stdout), attributes, pixels


def direction(elevation, azimuth):
    return [
        math.cos(elevation) * math.sin(azimuth),
        math.sin(elevation),
        -math.cos(elevation) * math.cos(azimuth),
    ]


def test_the_sun_stands_where_it_does_at_that_time_and_place():
    # What the night has decides pixels as well, and tells of the time.
    told, attributes, _ = render(*PARIS, "--time", "2026-06-21T10:00+02:00", "--night", "off")
    place = Place(math.radians(48.8566), math.radians(2.3522))
    sun = sun_position(datetime(2026, 6, 21, 8, tzinfo=UTC), place)
    assert told["sun_direction"] == pytest.approx(direction(*sun), abs=1e-12)
    assert told["time"] == attributes["skybake:time"] == "2026-06-21T08:00:00Z"
    assert attributes["skybake:latitude"] == pytest.approx(48.8566, rel=1e-6)
    assert attributes["skybake:longitude"] == pytest.approx(2.3522, rel=1e-6)
    assert "skybake:refraction" not in attributes
    recipe = json.loads(attributes["skybake:recipe"])["map"]
    assert recipe["sun_elevation_deg"] == pytest.approx(math.degrees(sun[0]), abs=1e-9)
    assert not [key for key in recipe if "time" in key or "latitude" in key]


def test_without_a_time_nothing_is_said_of_one():
    told, attributes, _ = render()
    assert told["time"] is None
    assert not {"skybake:time", "skybake:latitude", "skybake:longitude"} & set(attributes)


@pytest.mark.parametrize(
    ("place", "date", "column"),
    [(("--lat", "48N", "--lon", "0"), "2026-12-21", 32), (("--lat", "48S", "--lon", "0"), "", 0)],
)
def test_the_noon_sun_is_in_the_middle_of_the_north_and_on_the_seam_of_the_south(
    place, date, column
):
    *_, pixels = render(
        *place, "--date", date or "2026-06-21", "--time", "noon", "--sun-disc", "only"
    )
    lit = np.flatnonzero(pixels.sum(axis=(0, 2)))
    # The disc is thinner than a column; it stands on the border of two.
    assert set(lit) <= {(column - 1) % 64, column}
    assert lit.size


def test_a_polar_day_has_a_sun_at_midnight():
    told, *_ = render(
        *("--lat", "69.6492", "--lon", "18.9553", "--tz", "Europe/Oslo"),
        *("--date", "2026-06-21", "--time", "midnight", "--no-refraction"),
    )
    assert told["sun_direction"][1] == pytest.approx(math.sin(math.radians(3.09)), abs=1e-3)


def test_an_event_is_lifted_by_refraction_unless_told_otherwise():
    arguments = (*PARIS, "--date", "2026-03-20", "--tz", "Europe/Paris", "--time", "sunset")
    below, *_ = render(*arguments, "--no-refraction")
    lifted, attributes, _ = render(*arguments)
    geometric = math.asin(below["sun_direction"][1])
    assert math.degrees(geometric) == pytest.approx(-16 / 60, abs=0.003)
    lift = refraction(math.radians(-50 / 60))
    seen = math.asin(lifted["sun_direction"][1])
    assert seen == pytest.approx(math.radians(-50 / 60) + lift, abs=4e-5)
    assert attributes["skybake:refraction"] == pytest.approx(math.degrees(lift), rel=1e-3)


def test_the_advice_on_an_ambiguous_time_can_be_followed():
    arguments = (*PARIS, "--tz", "Europe/Paris", "--time")
    told = invoke("render", *SMALL, *arguments, "2026-10-25T02:30").stderr
    for advised in re.findall(r"2026-10-25T02:30:00\+0\d:00", told):
        followed, *_ = render(*arguments, advised)
        assert followed["time"].startswith("2026-10-25T0")
    assert followed["time"] == "2026-10-25T01:30:00Z"


@pytest.mark.parametrize("word", ["yesterday", "today", "Tomorrow"])
def test_a_date_may_be_a_word_by_the_local_clock(word):
    """At this longitude the date is another than in UTC for most of the day."""
    zone, place = "Pacific/Kiritimati", ("--lat", "1.87", "--lon", "-157.4")
    before = datetime.now(ZoneInfo(zone)).date()
    told, *_ = render(*place, "--tz", zone, "--date", word, "--time", "noon")
    noon = datetime.fromisoformat(told["time"]).astimezone(ZoneInfo(zone)).date()
    days = (noon - before).days - ("yesterday", "today", "tomorrow").index(word.lower()) + 1
    # Midnight may pass meanwhile.
    assert days in {0, 1}


LIGHT = ("--sun-disc", "only")


@pytest.mark.parametrize(
    ("arguments", "distance"),
    [
        ((*PARIS, "--time", "2026-01-03T12:00Z"), 0.98330),
        ((*PARIS, "--time", "2026-07-06T12:00Z"), 1.01664),
        ((*PARIS, "--time", "2026-07-06T12:00Z", "--sun-distance", "mean"), 1.0),
        ((*PARIS, "--time", "2026-07-06T12:00Z", "--sun-distance", "0.9au"), 0.9),
        ((*PARIS, "--time", "2026-07-06T12:00Z", "--set", "star.distance_au=1.2"), 1.2),
        (
            (
                *(*PARIS, "--time", "2026-07-06T12:00Z"),
                *("--set", "star.distance_au=2", "--sun-distance", "date"),
            ),
            2.03329,
        ),
        ((*MARS, "--site", "gale", "--ls", "71", "--time", "12:00"), 1.66599),
        ((*MARS, "--site", "gale", "--ls", "251", "--time", "12:00"), 1.38137),
        ((*MARS, "--sun", "90", "--sun-distance", "1.5"), 1.5),
        (("--sun", "30"), 1.0),
    ],
)
def test_light_and_disc_are_those_of_the_suns_distance(arguments, distance):
    """Without air, on a plane that faces the sun: 133.1 klx at 1 au."""
    airless = [f"--set={name}=none" for name in ("air", "ozone", "aerosol")]
    if "mars" in arguments:
        airless = ["--set=gas=none", "--set=dust=none"]
    told, attributes, _ = render(*arguments, *airless, *LIGHT)
    assert told["sun_distance_au"] == pytest.approx(distance, abs=1e-5)
    assert told["direct_normal_illuminance_lux"] == pytest.approx(133_140 / distance**2, rel=1e-3)
    diameter = math.degrees(2.0 * math.asin(695_700.0 / (distance * 149_597_870.7)))
    assert told["sun_angular_diameter_deg"] == pytest.approx(diameter, rel=1e-4)
    recipe = json.loads(attributes["skybake:recipe"])
    stated = recipe["map"].get("sun_distance_au", recipe["preset"]["star"]["distance_au"])
    assert stated == told["sun_distance_au"]


def test_a_probe_has_the_sun_of_its_date():
    figures = {}
    for arguments in (("--sun-distance", "mean"), ()):
        output = invoke(
            *("probe", *PARIS, "--time", "2026-01-03T12:00Z", "--illuminance", *arguments),
            *("--wavelengths", "550", "--method", "hillaire"),
        ).stdout
        row = next(csv.DictReader(output.splitlines()))
        for name in ("radiance_550nm", "luminance_cd_m2", "sky_illuminance_lux"):
            figures.setdefault(name, []).append(float(row[name]))
    for mean, near in figures.values():
        assert near / mean == pytest.approx(0.98330**-2, rel=1e-4)


def test_another_date_solves_no_new_atmosphere(monkeypatch):
    render(*PARIS, "--time", "2026-01-03T12:00Z", "--method", "hillaire")

    def never(*_):
        raise AssertionError

    monkeypatch.setattr("skybake.scattering.atmosphere.build_atmosphere", never)
    render(*PARIS, "--time", "2026-07-03T12:00Z", "--method", "hillaire")


def test_mars_has_the_sun_of_its_own_time():
    told, attributes, _ = render(*MARS, "--site", "gale", "--time", "2026-06-21T04:00Z")
    now, place = mars_time(datetime(2026, 6, 21, 4, tzinfo=UTC)), SITES["gale"]
    hour_angle = now.hour_angle(place.longitude)
    sun = sun_in_season(now.solar_longitude, hour_angle, place.latitude)
    assert told["sun_direction"] == pytest.approx(direction(*sun), abs=1e-12)
    assert told["time"] == attributes["skybake:time"] == "2026-06-21T04:00:00Z"
    season = math.degrees(now.solar_longitude)
    assert attributes["skybake:solarLongitude"] == pytest.approx(season, rel=1e-6)
    hours = 12 + 12 / math.pi * hour_angle
    clock = [int(part) for part in attributes["skybake:trueSolarTime"].split(":")]
    assert clock[0] + clock[1] / 60 + clock[2] / 3600 == pytest.approx(hours, abs=1.5e-4)


@pytest.mark.parametrize("place", [("--site", "gale"), ("--lat", "4.59S", "--lon", "137.44E")])
def test_a_season_of_mars_goes_by_true_solar_time(place):
    told, attributes, _ = render(*MARS, *place, "--ls", "0", "--time", "06:00")
    assert told["sun_direction"] == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)
    assert told["time"] is None
    assert attributes["skybake:solarLongitude"] == 0.0
    assert attributes["skybake:trueSolarTime"] == "06:00:00"
    assert attributes["skybake:latitude"] == pytest.approx(-4.59, rel=1e-6)


USAGE = """
--time 2026-06-21T04:00Z => --time: needs --lat and --lon, or on Mars --site
--lat 1 --time 2026-06-21T04:00Z => --lat: needs --lon as well
--lon 1 --time 2026-06-21T04:00Z => --lon: needs --lat as well
--lat 1 --lon 2 => --lat: needs --time
--site gale => --site: needs --time
--ls 180 => --ls: needs --time
--tz UTC => --tz: needs --time
--date 2026-06-21 => --date: needs --time
--refraction => --refraction: needs --time
P --time 2026-06-21T04:00Z --sun 30deg => --sun: cannot be combined with --time
P --time 2026-06-21T04:00Z --sun-azimuth 180deg => --sun-azimuth: cannot be combined with --time
P --time 2026-06-21T04:00 => --time: needs an offset, as 2026-06-21T04:00Z or
P --time 2026-03-29T02:30 --tz Europe/Paris => --time: does not exist in Europe/Paris, where
P --time 2026-10-25T02:30 --tz Europe/Paris => --time: is ambiguous in Europe/Paris, write
P --time 2026-06-21T04:00 --tz Europe/Pari => --tz: unknown time zone 'Europe/Pari'; nearest:
P --time 2026-06-21T04:00 --tz Springfield => --tz: unknown time zone 'Springfield'; must be such as
P --time sunset --date today --tz Springfield => --tz: unknown time zone 'Springfield'; must
P --time sunset --date 2011-12-30 --tz Pacific/Apia => --date: does not exist in Pacific/Apia, where
P --time sunset --date 2026-06-21 --sun-distance 0 => '--sun-distance': must be mean, date or a
--sun-distance date => --sun-distance: date needs --time
--sun-distance far => '--sun-distance': must be mean, date or a number of au from 0.001 to 1000
P --time 2026-06-21T04:00Z --date 2026-06-21 => --date: needs --time sunset or another event
P --time sunset => --time sunset: needs --date
P --time sunzet --date 2026-06-21 => --time: must be a time such as 2026-06-21T04:00Z or
P --time 04:00 => --time: must be a time such as 2026-06-21T04:00Z or
P --time sunset --date 21.6.2026 => '--date': must be a date such as 2026-06-21, or today, got
P --time sunset --date 2026-02-30 => '--date': must be a date such as 2026-06-21, or today, got
T --time sunset --date 2026-06-21 => --time: sunset: the sun does not set at 69.65N
T --time noon-1x --date 2026-06-21 => --time: must be a duration such as 10min
P --site gale --time 2026-06-21T04:00Z => --site: cannot be combined with --lat and --lon
P --time 2026-06-21T04:00Z --preset mars-storm => --lat: is on Earth, a place on Mars
P --time 2026-06-21T04:00Z --preset titan => --lat: the sun's path is known for Earth and Mars only
M --site gale --time 2026-06-21T04:00Z --preset earth-hazy => --site: is on Mars (the preset is o
M --site gale --time 16:30 => --time: on Mars must be such as 2026-06-21T04:00Z, sunset
M --site gale --time sunset => --time sunset: needs --date or --ls
M --site gale --time next-sunset --ls 180 => --time: next-sunset: needs a date, and a season has
M --site gale --time 1960-06-21T04:00Z => --time: on Mars must be in the years 1972 to 2127
M --site gale --time 16:30 --ls 180 --tz UTC => --tz: cannot be combined with --ls, which needs
M --site gale --time 16:30 --ls 180 --date 2026-06-21 => --date: cannot be combined with --ls, which
M --site gale --time 16:30 --ls 180 --refraction => --refraction: is that of Earth's atmos
M --site gale --time 25:00 --ls 180 => --time: must be a time of day such as 04:00 or
M --site gale --time 2026-06-21T04:00Z --ls 180 => --time: must be a time of day such as 04:00 or
M --site gale --time 16:30 --ls 361 => '--ls': must be from 0deg to 360deg, got 361
M --time 16:30 --ls 180 => --time: needs --lat and --lon, or on Mars --site
M --site venus --time 16:30 --ls 180 => '--site': 'venus' is not one of 'ares-vallis',
--lat 91 --lon 0 --time 2026-06-21T04:00Z => '--lat': must be from -90deg to 90deg, got 91
--lat -5S --lon 0 --time 2026-06-21T04:00Z => '--lat': must have a sign or S, not both, got -5S
--lat 5E --lon 0 --time 2026-06-21T04:00Z => '--lat': must be an angle such as 5deg
--lat 5 --lon 361 --time 2026-06-21T04:00Z => '--lon': must be from -180deg to 360deg, got 361
--lat 5 --lon 181W --time 2026-06-21T04:00Z => '--lon': must be from -180deg to 360deg, got 181W
"""
SHORT = {"P": PARIS, "T": ("--lat", "69.65", "--lon", "18.96"), "M": MARS}


@pytest.mark.parametrize(("arguments", "message"), table(USAGE))
def test_wrong_usage_is_one_line_exit_2_and_no_file(folder, arguments, message):
    first, *rest = arguments.split()
    result = invoke("render", *SHORT.get(first, (first,)), *rest)
    check_fault(result, 2, message)
    assert listing(folder) == []


def test_a_world_of_ones_own_may_be_anywhere(folder):
    Path("own.toml").write_text('extends = "mars"\n', encoding="utf-8")
    result = invoke("render", "--preset", "own.toml", *PARIS, "--time", "2026-06-21T04:00Z")
    check_fault(
        result,
        2,
        "--lat: is on Earth, a place on Mars needs --site or --ls (the preset is of mars)",
    )
    result = invoke("presets", "show", "--resolved", "titan")
    Path("alone.toml").write_text(result.stdout, encoding="utf-8")
    result = invoke("render", "--preset", "alone.toml", *PARIS, "--time", "x")
    check_fault(result, 2, "--time: must be a time such as 2026")


@pytest.mark.parametrize(
    ("text", "degrees"),
    [("48.8566", 48.8566), ("48.8566deg", 48.8566), ("5S", -5), ("5degN", 5), ("-5", -5)],
)
def test_a_latitude_is_read_with_a_sign_or_a_letter(text, degrees):
    assert math.degrees(latitude(text)) == pytest.approx(degrees, abs=1e-12)


@pytest.mark.parametrize(
    ("text", "degrees"), [("78.5W", -78.5), ("181.5", -178.5), ("360E", 0), ("-180", 180)]
)
def test_a_longitude_is_read_with_a_sign_or_a_letter(text, degrees):
    assert math.remainder(math.degrees(longitude(text)) - degrees, 360) == pytest.approx(
        0.0, abs=1e-12
    )
    assert abs(longitude(text)) <= math.pi
