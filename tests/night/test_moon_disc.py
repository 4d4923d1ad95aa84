"""The Moon's disc: its flux, phase, maria, and Earth's shadow on it."""

import math
from datetime import UTC, datetime

import numpy as np
import pytest

from skybake.eclipse.share import powers_from_limb_darkening, uncovered_powers
from skybake.ephemeris.lit_moon import moon_by_hand
from skybake.ephemeris.moonlight import lit_moon_at
from skybake.ephemeris.place import Place
from skybake.night.earth_shadow import EarthShadow, is_reached
from skybake.night.moon_albedo import moon_albedo
from skybake.night.moon_disc import MoonDisc
from skybake.optics.spectrum import limb_darkening
from skybake.projection import Equirect
from skybake.sky.sky import Sky

PERTH = Place(math.radians(-32.0), math.radians(116.0))
SUN_RADIUS = math.radians(0.2666)


def by_hand(phase, elevation=40.0):
    return moon_by_hand(2.5, math.radians(elevation), math.radians(phase), 1.0, -0.7)


def cells_of(moon, width=1024):
    chart = Equirect(width).canvases()[0].parts[0].chart
    return chart.disc_cells(math.pi / 2 - moon.elevation, moon.azimuth, moon.angular_radius)


def light_of(moon, cells, disc=None):
    disc = disc or MoonDisc(moon)
    return disc.light(cells.zenith, cells.azimuth, cells.distance, np.sqrt(cells.solid_angle))


def eclipsed_at(time):
    return lit_moon_at(datetime.fromisoformat(time).replace(tzinfo=UTC), PERTH, 0.0)


@pytest.mark.parametrize(("phase", "within"), [(0, 5e-3), (60, 5e-3), (110, 5e-3), (150, 0.01)])
def test_all_cells_together_have_the_light_of_the_disc(phase, within):
    moon = by_hand(phase)
    cells = cells_of(moon)
    light = light_of(moon, cells)
    assert (light.sunlit[:, 0] * cells.solid_angle).sum() == pytest.approx(1.0, abs=within)
    mean = (light.albedo * cells.solid_angle).sum() / cells.solid_angle.sum()
    assert mean == pytest.approx(1.0, abs=0.01)


def test_a_full_moon_is_as_bright_at_its_edge_as_in_its_middle_but_for_its_seas():
    moon = by_hand(0.0)
    cells = cells_of(moon)
    light = light_of(moon, cells)
    even = light.sunlit[:, 0] / light.albedo
    assert even.max() / even.min() == pytest.approx(1.0, abs=0.01)


def test_a_quarter_is_dark_on_the_side_away_from_the_sun():
    moon = by_hand(90.0)
    cells = cells_of(moon)
    lit = light_of(moon, cells).sunlit[:, 0] > 0.0
    assert (cells.solid_angle[lit]).sum() / cells.solid_angle.sum() == pytest.approx(0.5, abs=0.02)
    flat = np.cos(np.pi / 2 - cells.zenith[lit])
    vectors = np.stack(
        [
            flat * np.sin(cells.azimuth[lit]),
            np.cos(cells.zenith[lit]),
            -flat * np.cos(cells.azimuth[lit]),
        ],
        axis=1,
    )
    toward = vectors.mean(axis=0) - np.array(moon.direction)
    assert toward @ np.array(moon.sun) > 0.4 * math.sin(moon.angular_radius)


def test_the_seas_are_where_a_map_of_the_moon_has_them():
    # Imbrium, Serenitatis, Crisium, Procellarum; Tycho and the southern highlands.
    places = np.radians([(-16, 33), (18, 28), (59, 17), (-57, 20), (-11, -43), (10, -60)])
    albedo = moon_albedo(*places.T)
    assert (albedo[:4] < 0.8).all()
    assert (albedo[4:] > 1.2).all()


def test_the_shadow_reaches_the_moon_when_almanacs_say_so():
    # Of 2025-09-07 (Espenak): P1 15:28, P4 20:55; greatest at 18:11:49.
    for time, reached in (
        ("2025-09-07T15:22", False),
        ("2025-09-07T15:35", True),
        ("2025-09-07T20:49", True),
        ("2025-09-07T21:02", False),
        ("2025-08-09T12:00", False),
    ):
        moon = eclipsed_at(time)
        assert is_reached(moon, SUN_RADIUS) == reached, time
    middle = eclipsed_at("2025-09-07T18:11:49")
    earth = np.array(middle.earth)
    axis = math.acos(np.dot(middle.sun, earth) / np.linalg.norm(earth))
    # Gamma, the least distance of the Moon from the axis, is 0.2752 radii of Earth.
    assert axis * np.linalg.norm(earth) / 6378.0 == pytest.approx(0.2752, abs=0.01)


@pytest.fixture(scope="module")
def sky():
    return Sky("earth", math.radians(-30.0), method="hillaire")


def test_a_total_eclipse_is_copper_and_as_bright_as_most_are(sky):
    moon = eclipsed_at("2025-09-07T18:11:49")
    left = MoonDisc(moon, EarthShadow(sky, moon)).eclipsed_share
    green = float(np.interp(550.0, sky.wavelengths, left))
    # Full it has V -12.9 at this distance; in totality most have -1 to 1 (Danjon 2 to 3).
    assert -1.0 < -12.9 - 2.5 * math.log10(green) < 1.0
    assert np.interp(650.0, sky.wavelengths, left) > 3.5 * green
    assert np.interp(450.0, sky.wavelengths, left) < 0.3 * green


def test_the_rim_of_the_umbra_is_blue_and_its_middle_red(sky):
    moon = eclipsed_at("2025-09-07T18:11:49")
    shadow = EarthShadow(sky, moon)
    reds, blues = (int(np.argmin(np.abs(sky.wavelengths - each))) for each in (600.0, 490.0))
    colour = shadow._share[:, blues] / shadow._share[:, reds]
    degrees = np.degrees(shadow._separation)
    assert colour[degrees < 0.4].max() < 0.3
    assert 1.1 < colour[(degrees > 0.6) & (degrees < 0.72)].max() < 3.0
    assert colour[-1] == pytest.approx(1.0, abs=0.01)


def test_the_half_shadow_is_the_share_of_the_sun_beside_earth(sky):
    moon = eclipsed_at("2025-09-07T15:45")
    shadow = EarthShadow(sky, moon)
    sun = shadow._sun_radius
    # The air makes Earth's shadow about 1 % larger.
    ratio = 1.01 * 6371.0 / np.linalg.norm(moon.earth) / sun
    seen = shadow._separation > sun * (ratio - 0.7)
    powers = powers_from_limb_darkening(limb_darkening(sky.star, sky.wavelengths))
    beside = uncovered_powers(shadow._separation[seen] / sun, ratio) @ powers
    assert shadow._share[seen] == pytest.approx(beside, abs=0.025)
