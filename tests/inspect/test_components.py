"""Lights of the sky apart."""

import csv
import io
import math

import numpy as np
import pytest

from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.moment import sun_at
from skybake.ephemeris.place import Place
from skybake.errors import InputError
from skybake.image.moonlight import Moonlight
from skybake.image.night import Night
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.inspect.components import COMPONENTS, probe_components
from skybake.inspect.probe import probe, read_directions
from skybake.preset import load_preset

EARTH = load_preset("earth-clear")
LOOK = read_directions("-", ["view_zenith_deg,relative_azimuth_deg", "0,0", "70,40", "130,10"])
NIGHT = Night(CelestialFrame("earth", 2.0, -0.4))


def components(night=NIGHT, *, sun=-50.0, planet=EARTH):
    text = probe_components(planet, LOOK, night, sun_elevation=math.radians(sun), sun_azimuth=1.0)
    found = {}
    for row in csv.DictReader(io.StringIO(text)):
        found.setdefault(row["component"], []).append(row)
    return found


def column(rows, name="luminance_cd_m2"):
    return np.array([float(row[name]) for row in rows])


@pytest.fixture(scope="module")
def apart():
    return components()


def test_the_lights_of_a_night_add_up_to_what_a_map_shows(apart):
    assert set(apart) == {"sun", "airglow", "zodiacal", "stars", "all"}
    parts = sum(column(apart[name]) for name in apart if name != "all")
    np.testing.assert_allclose(parts, column(apart["all"]), rtol=1e-5)
    settings = map_settings(
        size=(64, 32), sun_elevation=math.radians(-50.0), sun_azimuth=1.0, night=NIGHT, units="nits"
    )
    scene = Scene(EARTH, settings)
    zenith, azimuth = LOOK.zenith[:, None], LOOK.azimuth[:, None]
    shown = (scene.evaluate(zenith, azimuth, 1e-6) @ scene.luminance)[:, 0]
    np.testing.assert_allclose(shown, column(apart["all"]), rtol=0.015)


def test_moonlight_is_what_a_map_shows_of_it():
    # Two days before the full moon of 2026-06-29, which is high over the Atacama.
    moment = sun_at("2026-06-28T04:00Z", Place(math.radians(-24.6), math.radians(-70.4)))
    moonlight = Moonlight(moment.lit_moon)
    where = {"sun_elevation": moment.sun_elevation, "sun_azimuth": moment.sun_azimuth}
    text = probe_components(EARTH, LOOK, Night(), **where, moonlight=moonlight)
    rows = [row for row in csv.DictReader(io.StringIO(text)) if row["component"] == "moon"]
    settings = map_settings(size=(64, 32), **where, moonlight=moonlight, units="nits")
    scene = Scene(EARTH, settings)
    zenith, azimuth = LOOK.zenith[:, None], LOOK.azimuth[:, None]
    shown = (scene.evaluate(zenith, azimuth, 1e-6) @ scene.luminance)[:, 0]
    np.testing.assert_allclose(column(rows), shown, rtol=0.01)
    assert 1e-3 < column(rows)[0] < 1e-2


def test_magnitudes_are_those_of_the_luminances(apart):
    expected = 12.58 - 2.5 * np.log10(column(apart["airglow"]))
    np.testing.assert_allclose(column(apart["airglow"], "mag_arcsec2"), expected, rtol=1e-5)


def test_radiances_of_airglow_hold_its_lines(apart):
    # 557.7 nm between 561 and 539 nm.
    row = {key: float(value) for key, value in apart["airglow"][0].items() if "radiance" in key}
    values = list(row.values())
    assert values[8] > 1.5 * values[6]


def test_by_day_there_is_the_sun_alone_and_it_is_that_of_the_probe():
    found = components(Night(), sun=20.0)
    assert set(found) == {"sun", "all"}
    plain = probe(EARTH, LOOK, sun_elevation=math.radians(20.0), sun_azimuth=1.0)
    rows = list(csv.DictReader(io.StringIO(plain)))
    np.testing.assert_allclose(column(found["sun"]), column(rows), rtol=1e-6)
    name = next(key for key in rows[0] if key.startswith("radiance"))
    np.testing.assert_allclose(column(found["sun"], name), column(rows, name), rtol=1e-6)


def test_every_light_has_a_name_in_the_order_of_the_help():
    assert tuple(COMPONENTS) == ("sun", "moon", "airglow", "zodiacal", "stars", "city")


def test_clouds_are_refused():
    with pytest.raises(InputError, match="components: must be of a world without clouds"):
        components(planet=load_preset("earth-fair"))


# Passbands of Bessell (1990), from 360 nm on by 10 nm.
B_BAND = np.array(
    [0, 30, 134, 567, 920, 978, 1000, 978, 935, 853, 740, 640, 536, 424, 325, 235, 150, 95, 43, 9]
)
V_BAND = np.array(
    [0] * 12
    + [30, 163, 458, 780, 967, 1000, 973, 898, 792, 684, 574, 461, 359, 270, 197, 135, 81, 45, 25]
)


SQUARE_ARCSECOND = math.radians(1.0 / 3600.0) ** 2


def magnitudes(wavelengths, radiance):
    """V of a square arcsecond and B-V of a spectrum, by those of the sun, -26.76 and 0.654."""

    def photons(spectrum, band):
        nodes = 360.0 + 10.0 * np.arange(len(band))
        return (np.interp(nodes, wavelengths, spectrum) * nodes * band).sum()

    sun = Scene(EARTH, map_settings(size=(64, 32))).sky.irradiance
    b, v = (photons(radiance, band) / photons(sun, band) for band in (B_BAND, V_BAND))
    return -26.76 - 2.5 * math.log10(v * SQUARE_ARCSECOND), 0.654 - 2.5 * math.log10(b / v)


def test_the_dark_zenith_is_as_bright_and_has_the_colour_that_is_measured():
    # Toward the pole of the galaxy. Patat (2003) has V 21.6 and B-V 1.0 at a solar maximum, Falchi
    # et al. (2016) take 22.0 for a natural sky.
    pole = Night(CelestialFrame("earth", math.radians(192.9), math.radians(27.1)))
    row = components(pole)["all"][0]
    radiance = {float(k[9:-2]): float(v) for k, v in row.items() if k.startswith("radiance")}
    v, b_v = magnitudes(list(radiance), list(radiance.values()))
    assert 21.6 < v < 22.0
    assert 0.9 < b_v < 1.05
    # By luminance, as an eye has it, lines count somewhat more than by the band V.
    assert float(row["mag_arcsec2"]) == pytest.approx(v, abs=0.07)
