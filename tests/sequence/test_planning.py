"""Plans of sequences, from what changes over time to frames."""

import math
from datetime import date
from pathlib import Path

import pytest

from skybake.angles import direction_from_angles
from skybake.ephemeris.moment import TimeSpan, sun_at
from skybake.ephemeris.place import SITES
from skybake.errors import ArgumentError, InputError
from skybake.image.settings import map_settings
from skybake.optics.changes import PresetChanges
from skybake.sequence.exposure_curve import ExposureCurve
from skybake.sequence.moon_path import MoonPath
from skybake.sequence.planning import plan_sequence
from skybake.sequence.ramp import Ramp
from tests.ephemeris.places import PARIS

MORNING = TimeSpan("2026-06-21T04:00Z", "2026-06-21T06:00Z", PARIS)
HOURLY = TimeSpan("2026-06-21T04:00Z", "2026-06-21T06:00Z", PARIS, every=3600.0)


def suns(plan):
    return [frame.settings.lighting.sun_elevation for frame in plan.frames]


def test_ramps_go_evenly_over_the_frames_and_constants_stay():
    plan = plan_sequence(
        frames="1-5", sun_elevation=Ramp(0.0, 0.4), sun_azimuth=1.0, altitude=Ramp(0.0, 8.0)
    )
    assert suns(plan) == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4])
    assert {frame.settings.lighting.sun_azimuth for frame in plan.frames} == {1.0}
    assert [frame.settings.view.altitude for frame in plan.frames] == [0.0, 2.0, 4.0, 6.0, 8.0]
    assert [str(frame.output) for frame in plan.frames][::4] == ["earth.0001.exr", "earth.0005.exr"]


def test_what_is_not_given_is_that_of_the_settings():
    settings = map_settings(size=64, sun_elevation=0.3, altitude=1.0, ev=3.0, colorspace="acescg")
    plan = plan_sequence(frames=[3, 1, 3], settings=settings)
    assert [frame.number for frame in plan.frames] == [1, 3]
    assert {frame.settings for frame in plan.frames} == {settings}


def test_a_span_and_its_moments_make_the_same_frames():
    spread = plan_sequence(frames="1-3", times=MORNING)
    stepped = plan_sequence(times=HOURLY)
    listed = plan_sequence(times=[sun_at(f"2026-06-21T0{hour}:00Z", PARIS) for hour in (4, 5, 6)])
    assert spread.frames == stepped.frames == listed.frames
    assert plan_sequence(frames="1-3x2", times=MORNING).frames == spread.frames[::2]


def test_a_world_that_changes_is_one_for_each_frame():
    plan = plan_sequence("mars", frames="1-2", changes={"dust.optical_depth": Ramp(0.5, 2.0)})
    assert [world.recipe["set"] for world in plan.planets] == [
        {"constituents.dust.optical_depth": 0.5},
        {"constituents.dust.optical_depth": 2},
    ]
    assert plan.planet(plan.frames[1]) is plan.planets[1]
    still = plan_sequence(frames="1-2", changes=PresetChanges(ozone=250.0))
    assert len(still.planets) == 1


def test_pictures_lie_beside_the_maps_or_have_names_of_their_own():
    beside = plan_sequence(frames="7", output="a/sky.#.exr", preview=True)
    assert beside.frames[0].preview == Path("a/sky.0007.png")
    named = plan_sequence(frames="7", output="a/sky.#.exr", preview="b.%d.png")
    assert named.frames[0].preview == Path("b.7.png")
    assert plan_sequence(frames="7").frames[0].preview is None


def test_an_exposure_curve_is_straight_between_its_points_and_level_beyond():
    curve = ExposureCurve(((2, 10.0), (4, 14.0)))
    plan = plan_sequence(frames="1-5", exposure_curve=curve)
    evs = [frame.settings.encoding.ev for frame in plan.frames]
    assert evs == [10.0, 10.0, 12.0, 14.0, 14.0]


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ((), "exposure curve: must hold at least one frame and its ev"),
        (((1, 41.0),), "exposure curve: ev must be from -30 to 40, got 41"),
        (((math.nan, 4.0),), "exposure curve: frame must be finite, got nan"),
        (((1, 4.0), (1, 5.0)), "exposure curve: frames must ascend, got 1"),
    ],
)
def test_a_faulty_exposure_curve_is_refused(points, message):
    with pytest.raises(InputError) as caught:
        ExposureCurve(points)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, "frames: is required, such as 1-96"),
        ({"frames": []}, "frames: must hold at least one frame"),
        ({"times": MORNING}, "frames: is required, or every"),
        ({"times": []}, "times: must hold at least one moment"),
        ({"times": HOURLY, "frames": "1-4"}, "frames: must be as many as every makes, which is 3"),
        ({"times": [sun_at("2026-06-21T04:00Z", PARIS)], "frames": "1-2"}, "frames: must be as"),
        ({"times": HOURLY, "sun_elevation": 0.1}, "sun_elevation: cannot be combined with times"),
        ({"times": HOURLY, "sun_azimuth": 0.1}, "sun_azimuth: cannot be combined with times"),
        ({"times": HOURLY, "preset": "mars"}, "place: is on Earth"),
        ({"times": [sun_at("2026-06-21T04:00Z", SITES["gale"])]}, "place: is on Mars"),
        ({"frames": "1-2", "output": "sky.exr"}, "output: sky.exr: must have a place for the"),
        ({"frames": "1-2", "preview": "sky.png"}, "preview: sky.png: must have a place for the"),
    ],
)
def test_arguments_that_do_not_go_together_are_named(arguments, message):
    with pytest.raises(ArgumentError) as caught:
        plan_sequence(**arguments)
    assert str(caught.value).startswith(message)


def test_two_hazes_are_refused():
    with pytest.raises(ArgumentError, match="turbidity: cannot be combined with visibility"):
        PresetChanges(visibility=20.0, turbidity=2.0)


def test_a_plan_of_an_evening_knows_its_local_times():
    span = TimeSpan(
        "sunset", "civil-dusk", PARIS, every=900.0, day=date(2026, 6, 21), zone="Europe/Paris"
    )
    labels = [frame.label for frame in plan_sequence(times=span).frames]
    assert [label[11:16] for label in labels] == ["21:57", "22:12", "22:27"]


def test_a_moon_by_hand_moves_evenly_and_has_the_phase_that_each_sun_makes():
    path = MoonPath(elevation=Ramp(0.1, 0.5), azimuth=math.radians(90.0))
    plan = plan_sequence(frames="1-3", sun_elevation=Ramp(0.0, -1.0), moon_path=path)
    lights = [frame.settings.moonlight.moon for frame in plan.frames]
    assert [each.elevation for each in lights] == pytest.approx([0.1, 0.3, 0.5])
    assert [each.azimuth for each in lights] == pytest.approx([math.radians(90.0)] * 3)
    for frame, each in zip(plan.frames, lights, strict=True):
        sun = frame.settings.lighting
        assert each.sun == pytest.approx(
            direction_from_angles(sun.sun_azimuth, sun.sun_elevation), abs=1e-9
        )


def test_the_phase_of_a_moon_by_hand_may_change():
    path = MoonPath(elevation=0.5, phase=Ramp(0.0, 1.0))
    plan = plan_sequence(frames="1-2", sun_elevation=-0.5, moon_path=path)
    assert [frame.settings.moonlight.moon.phase_angle for frame in plan.frames] == pytest.approx(
        [0.0, 1.0], abs=1e-6
    )
