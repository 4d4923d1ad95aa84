"""Names that maps get by themselves."""

import itertools
import math
import re

import pytest

from skybake.baking import default_path
from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.moon import Moon
from skybake.image.night import Night
from skybake.image.settings import map_settings
from skybake.preset import load_preset

DEGREE = math.pi / 180.0
SETTINGS = {
    "sun_elevation": 5.0 * DEGREE,
    "sun_azimuth": 90.0 * DEGREE,
    "altitude": 2.0,
    "projection": "cubemap",
    "colorspace": "acescg",
    "units": "nits",
    "ev": 12.0,
    "rotation": 30.0 * DEGREE,
    "sun_disc": "exclude",
    "sun_size": 2.0 * DEGREE,
    "sun_soft": True,
    "sun_strength": 0.5,
    "clamp_negative": True,
    "method": "hillaire",
    "sun_distance": 0.98,
}
CHANGES = (
    {},
    {"dust.optical_depth": 2},
    {"dust.optical_depth": 2.5},
    {"ground.albedo": "snow"},
    {"ground.albedo": 0.5},
    {"dust.optical_depth": 0.30000000000000004},
    {"dust.optical_depth": 0.30000000000000010},
    {"dust.profile": {"kind": "exponential", "scale_height_km": 9}},
    {"title": "a/b"},
    {"title": "a b"},
    {"dust": "none"},
    {"wavelengths_nm": [500, 600]},
    {"title": "a+b"},
)


def name(changes=None, preset="mars", **settings):
    return str(default_path(load_preset(preset, changes or {}), map_settings(**settings)))


def test_a_plain_map_is_named_by_world_sun_and_projection():
    assert name() == "mars_sun30.00deg_equirect.exr"
    assert name(projection="cubemap") == "mars_sun30.00deg_cubemap.exr"


def test_what_changes_the_light_shows_in_the_name():
    assert name({"dust.optical_depth": 2}, sun_elevation=5.0 * DEGREE) == (
        "mars_dust.optical_depth=2_sun05.00deg_equirect.exr"
    )
    assert name(sun_azimuth=-DEGREE, altitude=0.5, sun_disc="only", ev=-2.5) == (
        "mars_sun30.00deg_az359.00deg_500m_disc_ev-2.5_equirect.exr"
    )
    assert name(method="march", colorspace="xyz", units="nits", clamp_negative=True) == (
        "mars_sun30.00deg_march_xyz_nits_clamped_equirect.exr"
    )
    assert name(rotation=-DEGREE, sun_size=2.0 * DEGREE, sun_soft=True, sun_strength=0.5) == (
        "mars_sun30.00deg_rot359deg_size2deg_soft_strength0.5_equirect.exr"
    )
    assert name(rows="poles") == "mars_sun30.00deg_equirect_poles.exr"
    assert name(projection="cubemap", layout="cross") == ("mars_sun30.00deg_cubemap_cross.exr")


def test_what_a_map_has_of_the_night_shows_in_the_name():
    by_hand, at_a_time = (
        CelestialFrame("mars", 75.0 * DEGREE, 0.5, year) for year in (2000.0, 2026.4)
    )
    assert name(night=Night(at_a_time)) == "mars_sun30.00deg_equirect.exr"
    assert name(night=Night(by_hand)) == "mars_sun30.00deg_lst75.00deg_equirect.exr"
    named = {
        "nonight": Night(at_a_time, is_shown=False),
        "nostars": Night(at_a_time, stars="exclude"),
        "stars": Night(at_a_time, stars="only"),
        "stars4_zodiacal0.5": Night(at_a_time, faintest_star=4.0, zodiacal=0.5),
    }
    for part, night in named.items():
        assert name(night=night) == f"mars_sun30.00deg_{part}_equirect.exr"
    moon = Moon(math.pi, 0.5)
    assert name(moon=moon) == "mars_sun30.00deg_moon_equirect.exr"


@pytest.mark.parametrize(
    "settings",
    [
        {"size": 64},
        {"pixel": "float"},
        {"compression": "dwaa:45"},
        {"sun_azimuth": -math.pi},
        {"ev": 15.0},
        {"omit_exposure": True},
        {"rotation": 2.0 * math.pi},
    ],
)
def test_what_does_not_change_the_light_does_not_show(settings):
    assert name(**settings) == name()


def test_no_two_variants_share_a_name():
    settings = [
        dict(pair) for n in (0, 1, 2) for pair in itertools.combinations(SETTINGS.items(), n)
    ]
    # An exposure value takes the place of units.
    settings = [one for one in settings if not {"units", "ev"} <= one.keys()]
    names = [name(**one) for one in settings] + [name(change) for change in CHANGES[1:]]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("changes", CHANGES)
def test_names_are_short_and_fit_for_any_file_system(changes):
    longest = name(changes, **SETTINGS)
    assert re.fullmatch(r"[A-Za-z0-9_.=-]+", longest)
    assert len(longest) < 200


def test_long_changes_are_six_digits_which_stay_the_same():
    several = {"dust.optical_depth": 2, "ground.albedo": 0.5, "planet.radius_km": 3000}
    assert re.fullmatch(r"mars_[0-9a-f]{6}_sun30\.00deg_equirect\.exr", name(several))
    assert name(several) == name(several)
