"""``--moon`` as a light, ``--moon-elevation``, ``--moon-azimuth`` and ``--moon-phase``."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from skybake.formats.reader import ImageFile, read_image
from tests.cli.runs import SMALL, invoke

PLACE = ("--lat", "48.8566", "--lon", "2.3522", "--method", "hillaire")
NIGHT = (*PLACE, "--time", "2026-04-25T22:00Z")
BY_HAND = ("--sun", "-40deg", "--method", "hillaire", "--moon-elevation", "30deg")


def render(*arguments):
    result = invoke("render", *SMALL, "--json", "-q", *arguments)
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def test_the_moon_is_there_at_a_time_and_tells_its_light(folder):
    told = render(*NIGHT, "-o", "a.exr")
    _, tags = read_image(Path("a.exr"))
    moon = told["moon"]
    assert moon["is_in_map"] is True
    assert (moon["azimuth_deg"], moon["elevation_deg"]) == pytest.approx((231.4, 42.9), abs=0.1)
    assert moon["phase_angle_deg"] == pytest.approx(67.4, abs=0.3)
    assert moon["illuminated_fraction"] == pytest.approx(0.69, abs=0.01)
    assert 0.03 < moon["illuminance_lux"] < 0.06
    assert tags["skybake:moonDirection"] == pytest.approx(moon["direction"])
    assert tags["skybake:moonPhaseAngle"] == pytest.approx(moon["phase_angle_deg"])
    assert tags["skybake:moonNormalIlluminance"] == pytest.approx(moon["illuminance_lux"])
    assert tags["skybake:moonIlluminance"] == pytest.approx(moon["horizontal_illuminance_lux"])
    assert len(tags["skybake:moonColour"]) == 3
    assert invoke("check", "a.exr").exit_code == 0


def test_a_map_without_the_moon_is_dark_and_tells_nothing_of_it(folder):
    lit, dark = (render(*NIGHT, "--moon", which) for which in ("include", "exclude"))
    assert dark["moon"] is None
    assert dark["sky_illuminance_lux"] < 0.4 * lit["sky_illuminance_lux"]
    assert render(*NIGHT, "--night", "off")["moon"] is None
    assert Path(dark["files"][0]).name.count("nomoon") == 1


def test_the_moon_alone_has_no_other_light(folder):
    render(
        *PLACE, "--time", "2026-04-25T16:00Z", "--moon", "only", "--units", "nits", "-o", "a.exr"
    )
    pixels, _ = read_image(Path("a.exr"))
    # Of a day, the sky of which has thousands.
    assert 0.0 < np.median(pixels[:30]) < 0.05
    assert invoke("check", "a.exr").exit_code == 0


def test_a_moon_by_hand_stands_where_it_is_put(folder):
    full = render(*BY_HAND, "--moon-azimuth", "90deg", "--moon-phase", "full", "-o", "a.exr")
    crescent = render(*BY_HAND, "--moon-azimuth", "90deg", "--moon-phase", "135deg")
    assert full["moon"]["direction"] == pytest.approx([0.866, 0.5, 0.0], abs=1e-3)
    assert (full["moon"]["phase_angle_deg"], crescent["moon"]["phase_angle_deg"]) == pytest.approx(
        (0.0, 135.0), abs=1e-4
    )
    assert crescent["moon"]["illuminance_lux"] < 0.03 * full["moon"]["illuminance_lux"]
    assert "moon30deg90deg135deg" in crescent["files"][0]


def test_the_disc_is_a_layer_that_adds_up_with_the_others(folder):
    render(*NIGHT, "--layers", "--pixel", "float", "-o", "a.exr")
    parts = {
        name: np.concatenate(list(ImageFile(Path("a.exr"), part=name).bands()))
        for name in ("beauty", "sky", "sun", "moon", "stars")
    }
    added = sum(parts[name] for name in ("sky", "sun", "moon", "stars"))
    np.testing.assert_allclose(added, parts["beauty"], rtol=1e-5, atol=1e-9)
    assert np.count_nonzero(parts["moon"].sum(axis=2)) < 20


def test_a_lunar_eclipse_is_told(folder):
    night = ("--lat", "-32", "--lon", "116", "--method", "hillaire")
    told = render(*night, "--time", "2025-09-07T18:11:49Z")
    assert 0.9999 < told["moon"]["eclipsed"] < 1.0
    assert told["moon"]["illuminance_lux"] < 2e-5
    red, green, blue = told["moon"]["colour"]
    assert red > 2.0 * green > 10.0 * blue
    result = invoke("render", *SMALL, *night, "--time", "2025-09-07T15:00Z", "-o", "b.exr")
    assert "in the shadow of Earth" not in result.stdout
    assert "100% lit" in result.stdout


def test_phase_and_distance_change_from_frame_to_frame(folder):
    span = ("--from", "2026-04-25T20:00Z", "--to", "2026-04-25T22:00Z", "--every", "1h")
    products = ("--manifest", "m.csv", "--manifest", "m.usda", "--manifest", "m.json", "-q")
    result = invoke("sequence", "--size", "32", *PLACE, *span, *products, "-o", "m.####.exr")
    assert result.exit_code == 0, result.output
    rows = list(csv.DictReader(Path("m.csv").read_text().splitlines()))
    column = {
        name: np.array([float(row[f"moon_{name}"]) for row in rows])
        for name in ("azimuth_deg", "elevation_deg", "angular_diameter_deg", "illuminance_lux")
    }
    assert (np.diff(column["azimuth_deg"]) > 10.0).all()
    assert (np.diff(column["angular_diameter_deg"]) < 0.0).all()
    assert len(set(column["illuminance_lux"])) == 3
    assert 'def DistantLight "Moon"' in Path("m.usda").read_text()
    (first, *_) = json.loads(Path("m.json").read_text())["records"]
    assert first["moon"]["illuminance_lux"] == pytest.approx(column["illuminance_lux"][0])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--moon", "maybe"), "must be include, exclude, only or AZIMUTH,ELEVATION"),
        (("--moon", "only"), "--moon: only needs --time or --moon-elevation"),
        (("--moon-phase", "full"), "--moon-phase: needs --moon-elevation"),
        (("--moon-azimuth", "10deg"), "--moon-azimuth: needs --moon-elevation"),
        (("--moon-elevation", "95deg"), "must be from -90deg to 90deg, got 95deg"),
        ((*BY_HAND, "--moon-phase", "blue"), "must be from 0deg to 180deg or one of full, gibbous"),
        ((*BY_HAND, "--moon-phase", "181deg"), "got '181deg'"),
        ((*BY_HAND, "--moon", "180,40"), "--moon-elevation: cannot be combined with --moon AZ"),
        ((*BY_HAND, "--moon", "exclude"), "--moon-elevation: cannot be combined with --moon excl"),
        ((*NIGHT, "--moon-elevation", "3deg"), "--moon-elevation: cannot be combined with --time"),
        (
            (*NIGHT, "--moon", "only", "--night", "off"),
            "--moon: only cannot be combined with --nig",
        ),
        (
            (*NIGHT, "--moon", "only", "--stars", "only"),
            "--moon: only cannot be combined with --st",
        ),
        ((*PLACE, "--time", "4000-01-01T00:00Z"), "--time: must be in the years 1000 to 2999"),
        (
            ("--preset", "mars", "--site", "gale", "--time", "2026-01-01T00:00Z", "--moon", "only"),
            "--moon: only needs a place on Earth",
        ),
    ],
)
def test_moons_that_contradict_each_other_are_one_line(folder, arguments, message):
    result = invoke("render", *SMALL, *arguments, "-q", "-o", "a.exr")
    told = result.output + (str(result.exception) if result.exception else "")
    assert result.exit_code in {1, 2}
    assert message in told
    assert not Path("a.exr").exists()


def test_a_camera_looks_at_the_moon(folder):
    here = ("--method", "hillaire", "--size", "40x40", "--no-preview", "-q", "-o", "a.exr")
    looks = ("--look", "moon", "--fov", "1deg", *here)
    result = invoke("shot", *PLACE[:4], "--time", "2026-04-25T22:00Z", *looks)
    assert result.exit_code == 0, result.output
    pixels, _ = read_image(Path("a.exr"))
    lit = pixels[..., 1] > 10.0 * np.median(pixels[..., 1])
    # Half a degree of one, of which two thirds are lit.
    assert 0.10 < lit.mean() < 0.2
    nowhere = invoke("shot", "--sun", "-30deg", *looks)
    assert nowhere.exit_code == 2
    assert "--look: moon must be in the sky, got none" in nowhere.output
