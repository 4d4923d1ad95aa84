"""Times as people type them."""

from datetime import UTC, date, datetime, timedelta
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.ephemeris.events import EVENTS, event_time
from skybake.ephemeris.local_clock import find_zone, local_text, utc_text
from skybake.ephemeris.times import (
    MAX_STEPS,
    kind_of,
    parse_clock,
    parse_end,
    parse_time,
    steps,
)
from skybake.errors import InputError
from tests.ephemeris.places import PARIS, TROMSO

PARISIAN = ZoneInfo("Europe/Paris")
DAY = date(2026, 6, 21)


def message(function, *arguments, **keywords):
    with pytest.raises(InputError) as caught:
        function(*arguments, **keywords)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "utc"),
    [
        ("2026-06-21T04:00Z", "2026-06-21T04:00:00Z"),
        ("2026-06-21T04:00:30Z", "2026-06-21T04:00:30Z"),
        ("2026-06-21T04:00:30.25+00:00", "2026-06-21T04:00:30.250Z"),
        ("2026-06-21T04:00+02:00", "2026-06-21T02:00:00Z"),
        ("2026-01-01T00:00-09:30", "2026-01-01T09:30:00Z"),
        ("2026-06-21T04:00", "2026-06-21T02:00:00Z"),
        ("2026-12-21T04:00", "2026-12-21T03:00:00Z"),
    ],
)
def test_an_iso_time_is_read_by_its_offset_or_the_zone(text, utc):
    time = parse_time(text, zone=PARISIAN)
    assert utc_text(time) == utc
    assert time.tzinfo is UTC


def test_a_time_without_offset_and_zone_is_refused():
    text = message(parse_time, "2026-06-21T04:00")
    assert text.startswith("needs an offset, as 2026-06-21T04:00Z or 2026-06-21T04:00+02:00, or a")


@pytest.mark.parametrize(
    ("text", "start"),
    [
        ("2026-13-01T00:00Z", "must be a date and time that exists"),
        ("2026-02-30T00:00Z", "must be a date and time that exists"),
        ("2026-06-21T24:01Z", "must be a date and time that exists"),
        ("0999-06-21T04:00Z", "must be in the years 1000 to 2999"),
        ("3000-01-01T00:00Z", "must be in the years 1000 to 2999"),
        ("2026-06-21", "must be a time such as 2026-06-21T04:00Z or an event such as sunset+10min"),
        ("04:00", "must be a time such as 2026-06-21T04:00Z or an event"),
        ("sunset10min", "must be a time such as 2026-06-21T04:00Z or an event"),
        ("sunset+", "must be a time such as 2026-06-21T04:00Z or an event"),
        ("sunset+10", "must be a duration such as 10min"),
        ("2026-06-21T04:00+00:00:61", "must be a time such as 2026-06-21T04:00Z or an event"),
        ("2026-06-21T04:00+02:60", "must be a time such as 2026-06-21T04:00Z or an event"),
        ("sunset+25h", "sunset: offset must be at most 24h, got 25h"),
        ("", "must be a time such as 2026-06-21T04:00Z or an event"),
    ],
)
def test_what_is_no_time_is_refused_with_the_reason(text, start):
    assert message(parse_time, text, place=PARIS, zone=PARISIAN, day=DAY).startswith(start)


@given(
    st.text(max_size=30)
    | st.builds(
        "{}{}{}".format, st.sampled_from(EVENTS), st.sampled_from("+-"), st.text(max_size=6)
    )
    | st.from_regex(r"\A[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}[-+][0-9]{2}:[0-9]{2}\Z")
)
def test_any_text_is_a_time_or_one_line(text):
    try:
        lines = [utc_text(parse_time(text, place=PARIS, day=DAY))]
    except InputError as error:
        lines = str(error).splitlines()
    assert len(lines) == 1


def test_a_mistyped_event_tells_the_nearest():
    assert message(parse_time, "sunrize").endswith("got 'sunrize'; nearest: sunrise, sunset")


def test_a_time_in_the_gap_of_spring_is_refused():
    assert message(parse_time, "2026-03-29T02:30", zone=PARISIAN) == (
        "does not exist in Europe/Paris, where clocks change from 02:00 to 03:00, "
        "got '2026-03-29T02:30:00'"
    )
    assert utc_text(parse_time("2026-03-29T03:00", zone=PARISIAN)) == "2026-03-29T01:00:00Z"


def test_a_time_that_autumn_shows_twice_is_refused_with_both_offsets():
    assert message(parse_time, "2026-10-25T02:30", zone=PARISIAN) == (
        "is ambiguous in Europe/Paris, write 2026-10-25T02:30:00+02:00 or "
        "2026-10-25T02:30:00+01:00, got '2026-10-25T02:30:00'"
    )
    assert utc_text(parse_time("2026-10-25T02:30+02:00")) == "2026-10-25T00:30:00Z"
    assert utc_text(parse_time("2026-10-25T03:00", zone=PARISIAN)) == "2026-10-25T02:00:00Z"


def test_a_gap_of_half_an_hour_is_reported_as_it_is():
    text = message(parse_time, "2026-10-04T02:10", zone=ZoneInfo("Australia/Lord_Howe"))
    assert "clocks change from 02:00 to 02:30" in text


def test_an_event_is_that_of_the_local_date_with_its_offset():
    sunset = event_time("sunset", DAY, PARIS, PARISIAN)
    place = {"place": PARIS, "zone": PARISIAN, "day": DAY}
    assert parse_time("sunset", **place) == sunset
    assert parse_time("sunset+10min", **place) == sunset + timedelta(minutes=10)
    assert parse_time("sunset-1h30min", **place) == sunset - timedelta(minutes=90)
    dawn = event_time("civil-dawn", DAY, PARIS, PARISIAN)
    assert parse_time("civil-dawn-1h", **place) == dawn - timedelta(hours=1)


def test_an_event_needs_place_and_date():
    assert message(parse_time, "sunset", day=DAY) == "sunset needs a place and a date, got none"
    assert message(parse_time, "sunset", place=PARIS) == "sunset needs a place and a date, got none"


def test_an_event_that_ends_a_range_before_its_start_is_that_of_the_next_day():
    place = {"place": PARIS, "zone": PARISIAN, "day": DAY}
    start = parse_time("sunset", **place)
    tomorrow = DAY + timedelta(days=1)
    assert parse_end("sunrise", start, **place) == event_time("sunrise", tomorrow, PARIS, PARISIAN)
    assert parse_end("civil-dusk", start, **place) == event_time("civil-dusk", DAY, PARIS, PARISIAN)


def test_another_end_that_is_not_after_the_start_is_refused():
    start = datetime(2026, 6, 21, 4, tzinfo=UTC)
    for text in ("2026-06-21T04:00Z", "2026-06-21T05:00+02:00"):
        assert message(parse_end, text, start).startswith(
            "must be after the start, 2026-06-21T04:00:00Z, got 2026-06-21T0"
        )
    late = datetime(2026, 8, 1, tzinfo=UTC)
    assert "must be after the start" in message(parse_end, "noon", late, place=TROMSO, day=DAY)


@pytest.mark.parametrize(
    ("name", "nearest"),
    [
        ("Europe/Pari", "nearest: Europe/Paris"),
        ("europe/paris", "nearest: Europe/Paris"),
        ("New York", "nearest: America/New_York"),
        ("new_york", "nearest: America/New_York"),
        ("Los Angeles", "nearest: America/Los_Angeles"),
        ("Buenos Aires", "nearest: America/Buenos_Aires, America/Argentina/Buenos_Aires"),
        ("Tokio", "nearest: Asia/Tokyo"),
        ("utc ", "nearest: UTC, Etc/UTC"),
        *(
            (bad, "must be such as Europe/Paris or UTC")
            for bad in ("", "/etc/passwd", "a\0b", "é", "Springfield")
        ),
    ],
)
def test_an_unknown_zone_tells_the_nearest_or_an_example(name, nearest):
    assert message(find_zone, name).startswith(f"unknown time zone {name!r}; {nearest}")


@pytest.mark.parametrize("name", ["New York", "Europe/Pari", "kiritimatti", "EST5", "Sao Paulo"])
def test_every_zone_that_is_suggested_exists(name):
    for suggested in message(find_zone, name).partition("nearest: ")[2].split(", "):
        assert find_zone(suggested).key == suggested


def test_without_a_database_it_says_what_to_install(monkeypatch):
    monkeypatch.setattr("skybake.ephemeris.local_clock.available_timezones", set)
    assert message(find_zone, "Europe/Pari").endswith("is installed (pip install tzdata)")


@pytest.mark.parametrize(
    ("text", "seconds"), [("00:00", 0), ("04:00", 14400), ("16:30:15", 59415), ("24:00", 86400)]
)
def test_a_time_of_day_is_read(text, seconds):
    assert parse_clock(text) == seconds


@pytest.mark.parametrize("text", ["", "4:00", "24:01", "12:60", "12:00:60", "-1:00", "noon", "12"])
def test_what_is_no_time_of_day_is_refused(text):
    assert message(parse_clock, text).startswith("must be a time of day such as 04:00")


@pytest.mark.parametrize(
    ("span", "every", "count"),
    [(3600, 600, 7), (3599, 600, 6), (0.7, 0.1, 8), (1, 2, 1), (86400, 0.9, 96001)],
)
def test_steps_include_the_end_where_it_falls_on_one(span, every, count):
    found = steps(span, every)
    assert len(found) == count
    assert found[0] == 0.0
    assert found[-1] <= span + 1e-9
    assert found[-1] + every > span


@pytest.mark.parametrize(
    ("span", "every", "start"),
    [
        (60, 0, "must be longer than 0s, got 0s"),
        (60, float("nan"), "must be longer than 0s"),
        (86400 * 365, 1, f"must give at most {MAX_STEPS} frames, got 3.1536e+07"),
        (1, 5e-324, f"must give at most {MAX_STEPS} frames, got inf"),
    ],
)
def test_absurd_steps_are_refused(span, every, start):
    assert message(steps, span, every).startswith(start)


def test_texts_are_told_apart():
    texts = ("sunset+1h", "2026-06-21T04:00", "2026-06-21T04:00Z", "sunzet")
    assert [kind_of(text) for text in texts] == ["event", "local", "absolute", "unknown"]


def test_times_are_written_as_they_are_read():
    local = datetime(2026, 6, 21, 4, 0, 0, 250_000, tzinfo=PARISIAN)
    assert local_text(local) == "2026-06-21T04:00:00.250+02:00"
    assert utc_text(local) == "2026-06-21T02:00:00.250Z"
    assert parse_time(utc_text(local)) == local
