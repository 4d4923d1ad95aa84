import math
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.errors import InputError
from skybake.units import degrees, metres, parse_angle, parse_duration, parse_length


@pytest.mark.parametrize(
    ("text", "radians"),
    [
        ("5deg", math.radians(5.0)),
        ("5", math.radians(5.0)),
        ("-18 deg", math.radians(-18.0)),
        ("0.1rad", 0.1),
        ("30arcmin", math.radians(0.5)),
        ("960arcsec", math.radians(960.0 / 3600.0)),
        ("1e-3rad", 1e-3),
        (" .5deg ", math.radians(0.5)),
        ("5°", math.radians(5.0)),
        ("-5 °", math.radians(-5.0)),
        ("5DEG", math.radians(5.0)),
        ("0.1Rad", 0.1),
    ],
)
def test_an_angle_is_read_in_its_unit_and_in_degrees_without_one(text, radians):
    assert parse_angle(text) == pytest.approx(radians, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "kilometres"),
    [
        ("2km", 2.0),
        ("400km", 400.0),
        ("1500m", 1.5),
        ("400KM", 400.0),
        ("400Km", 400.0),
        ("30000FT", 9.144),
        ("0", 0.0),
        ("-0.0", 0.0),
        ("30000ft", 9.144),
        ("1mi", 1.609344),
        ("-5m", -0.005),
    ],
)
def test_a_length_is_read_in_its_unit_in_capitals_or_not(text, kilometres):
    assert parse_length(text) == pytest.approx(kilometres, rel=1e-15)


@pytest.mark.parametrize(
    "text",
    ["", " ", "deg", "5dgr", "5km", "nan", "inf", "-inf", "1e999deg", "5 5", "0x10", "5deg6", "٥"],  # noqa: RUF001
)
def test_what_is_no_finite_angle_is_refused_with_the_known_units(text):
    with pytest.raises(InputError) as caught:
        parse_angle(text)
    assert str(caught.value) == (
        "must be an angle such as 5deg (units: deg, rad, arcmin, arcsec; "
        f"a bare number is in deg), got {text!r}"
    )


@pytest.mark.parametrize(
    "text", ["2deg", "two km", "nan", "inf", "1e999km", "2,5km", "5 k m", "400M", "5mM", "5MM"]
)
def test_what_is_no_finite_length_is_refused_with_the_known_units(text):
    with pytest.raises(InputError) as caught:
        parse_length(text)
    assert str(caught.value) == (
        f"must be a length such as 2km (units: m, km, ft, mi), got {text!r}"
    )


@pytest.mark.parametrize("text", ["400", "-1", "2.5e3"])
def test_a_length_without_a_unit_is_refused_with_two_that_may_be_meant(text):
    with pytest.raises(InputError) as caught:
        parse_length(text)
    assert str(caught.value) == (
        f"needs a unit, such as {text}m or {text}km (units: m, km, ft, mi), got {text!r}"
    )


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("10min", 600.0),
        ("1h", 3600.0),
        ("30s", 30.0),
        ("1h30min", 5400.0),
        ("1d2h3min4.5s", 93784.5),
        (" .5h ", 1800.0),
        ("0s", 0.0),
        ("10MIN", 600.0),
        ("1H30Min", 5400.0),
    ],
)
def test_a_duration_is_the_sum_of_its_parts(text, seconds):
    assert parse_duration(text) == seconds


@pytest.mark.parametrize(
    "text", ["", "10", "min", "1h30", "-1h", "1 h", "1m", "1e3s", "nan", "infs", "1h+5s", "\u0665s"]
)
def test_what_is_no_duration_is_refused_with_the_known_units(text):
    with pytest.raises(InputError) as caught:
        parse_duration(text)
    assert str(caught.value) == (
        "must be a duration such as 10min or 1h30min (units: s, min, h, d), got " + repr(text)
    )


def test_a_duration_beyond_all_numbers_is_refused():
    with pytest.raises(InputError, match="must be a duration"):
        parse_duration("9" * 400 + "h")


@given(
    st.floats(-1e6, 1e6),
    st.sampled_from([("deg", math.pi / 180), ("rad", 1.0), ("arcmin", math.pi / 10800)]),
)
def test_an_angle_survives_being_written_and_read(value, unit):
    name, radians = unit
    assert parse_angle(f"{value!r}{name}") == pytest.approx(value * radians, rel=1e-15, abs=0.0)


@given(st.floats(-1e9, 1e9), st.sampled_from([("m", 1e-3), ("km", 1.0), ("ft", 0.3048e-3)]))
def test_a_length_survives_being_written_and_read(value, unit):
    name, kilometres = unit
    assert parse_length(f"{value!r} {name}") == pytest.approx(
        value * kilometres, rel=1e-15, abs=0.0
    )


@given(st.floats(-360.0, 360.0).map(lambda value: round(value, 6)))
def test_an_angle_is_stated_as_it_was_typed(value):
    assert degrees(parse_angle(f"{value}deg")) == value
    assert math.radians(degrees(value / 7)) == pytest.approx(value / 7, rel=1e-15)


@given(st.integers(0, 10**9), st.sampled_from(["m", "km"]))
def test_a_length_is_stated_as_it_was_typed(value, unit):
    assert metres(parse_length(f"{value / 10}{unit}")) == pytest.approx(
        value / 10 * (1000 if unit == "km" else 1), rel=1e-15
    )
    assert len(repr(metres(parse_length(f"{value / 10}m")))) <= len(repr(value / 10))


@given(st.text())
def test_any_text_gives_a_finite_number_or_one_line(text):
    try:
        value = parse_angle(text)
    except InputError as error:
        lines = str(error).splitlines()
    else:
        lines = [f"{value}"] if math.isfinite(value) else []
    assert len(lines) == 1


def test_units_are_read_without_numpy():
    code = "import sys, skybake.units; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
