"""The light of a sun in eclipse."""

import math

import numpy as np
import pytest

from skybake.eclipse.shadow import shares_at
from skybake.ephemeris.moon import Moon
from skybake.errors import InputError
from skybake.image.light import light_of_scene
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from skybake.reference.estimate import irradiance, radiance
from skybake.reference.occultation import Occultation, uncovered_share
from skybake.sky.sky import Sky

SUN = math.radians(40.0)
LARGE = math.radians(0.55)


def moon(above=0.0, **others):
    return Moon(math.pi, SUN + math.radians(above), LARGE, **others)


def sky(above=0.0, **others):
    return Sky("earth", SUN, moon=moon(above), **others)


def scene(lunar, **others):
    settings = map_settings("equirect", 64, sun_elevation=SUN, moon=lunar, **others)
    return Scene(load_preset("earth"), settings)


@pytest.fixture(scope="module")
def total():
    return scene(moon())


@pytest.fixture(scope="module")
def whole():
    return scene(None)


@pytest.mark.parametrize(
    ("above", "diameter", "name"),
    [(0.0, 0.55, "total"), (0.0, 0.5, "annular"), (0.2, 0.55, "partial"), (0.6, 0.55, "none")],
)
def test_the_phase_follows_from_the_discs(above, diameter, name):
    lunar = Moon(math.pi, SUN + math.radians(above), math.radians(diameter))
    phase = Sky("earth", SUN, moon=lunar).eclipse.phase
    assert phase.name == name
    assert (phase.obscuration == 0.0) == (name == "none")


def test_a_moon_whose_shadow_is_nowhere_in_sight_makes_no_eclipse():
    assert sky(1.5).eclipse is None
    assert sky(1.5).source.occluder is None


def test_the_shadow_moves_with_the_place_as_far_as_the_moon_is_near():
    eclipse = Sky("earth", math.radians(90.0), moon=Moon(0.0, math.radians(90.0), LARGE)).eclipse
    shadow = eclipse._shadow
    umbra = 0.5 * (LARGE - 2.0 * math.asin(shadow.sun_radius / shadow.sun[2])) * 384_400.0
    places = np.array([[0.97 * umbra, 0.0, 0.0], [1.1 * umbra, 0.0, 0.0], [3700.0, 0.0, 0.0]])
    shares = shares_at(shadow, places)
    assert (shares[0] == 0.0).all()
    assert (shares[1] > 0.0).all()
    assert (shares[1] < 0.02).all()
    assert (shares[2] == 1.0).all()


def test_light_in_totality_is_1e_4_of_that_of_the_day(total, whole):
    """So it was in the zenith in 1970 and 1973.

    Dandekar and Turtle (1971, Appl. Opt. 10, 1220): about four orders of magnitude; Shaw (1975,
    Appl. Opt. 14, 388): 10^4 times, and darkest in the zenith.
    """
    eclipsed = light_of_scene(total)
    assert eclipsed.direct_illuminance == 0.0
    zenith, azimuth = np.radians([[0.5], [45.0], [87.0]]), np.radians([[0.0, 90.0, 180.0, 270.0]])
    left, day = (one.evaluate(zenith, azimuth, 1e-9) @ one.luminance for one in (total, whole))
    assert 3e-5 < left[0].mean() / day[0].mean() < 3e-4
    assert (np.diff(left.mean(axis=1)) > 0.0).all()


def test_totality_glows_all_around_the_horizon(total, whole):
    zenith = np.radians([[20.0], [87.0]])
    azimuth = np.linspace(0.0, 2.0 * math.pi, 13)[None, :-1]
    left, day = (one.evaluate(zenith, azimuth, 1e-9) @ one.luminance for one in (total, whole))
    share = left / day
    assert (share[1] > 2.0 * share[0]).all()
    # Warmer than by day, since it comes through far more air.
    red, blue = (total.evaluate(zenith, azimuth, 1e-9)[..., channel] for channel in (0, 2))
    assert ((red / blue)[1] > 1.5 * (red / blue)[0]).all()


def test_sky_and_disc_are_as_bright_as_the_share_of_the_sun_that_is_left(whole):
    partial = scene(moon(0.2))
    share = partial.sky.eclipse.uncovered
    ours, day = light_of_scene(partial), light_of_scene(whole)
    left = ours.direct_illuminance / day.direct_illuminance
    assert share.min() < left < share.max()
    assert ours.sky_illuminance / day.sky_illuminance == pytest.approx(left, rel=0.02)


def test_the_disc_on_a_map_holds_the_light_that_the_moon_leaves():
    lunar = Moon(math.pi, SUN + math.radians(0.1), LARGE)
    sun = scene(lunar, sun_disc="only", sun_azimuth=math.pi)
    canvas = sun.settings.view.projection.canvases()[0]
    pixels = Raster(sun, canvas).rows(0, canvas.height).astype(float)
    zenith = (np.arange(32) + 0.5) / 32 * math.pi
    flux = (pixels @ sun.luminance) * (np.sin(zenith) * (math.pi / 32) ** 2)[:, None]
    assert flux.sum() == pytest.approx(sun.sun_illuminance()[0], rel=0.02)


def test_light_is_the_whole_suns_where_the_moon_only_darkens_distant_air(whole):
    distant = scene(moon(0.65))
    assert distant.sky.eclipse.phase.name == "none"
    ratio = light_of_scene(distant).sky_illuminance / light_of_scene(whole).sky_illuminance
    assert 0.999 < ratio <= 1.0


def test_the_umbra_is_a_spot_on_the_ground_seen_from_space():
    high = Sky("earth", math.radians(70.0), 2000.0, moon=Moon(math.pi, math.radians(70.0), LARGE))
    axis = high.eclipse.axis
    unit = axis / np.linalg.norm(axis)
    mu, azimuth = np.array([unit[2], unit[2]]), math.atan2(unit[1], unit[0]) + np.array([0.0, 1.5])
    eclipsed, day = high.eclipse.radiance_per_irradiance(mu, azimuth)
    assert (eclipsed[0] < 0.01 * day[0]).all()
    assert (eclipsed[1] > 0.1 * day[1]).all()


def test_single_scattering_alone_is_refused():
    with pytest.raises(InputError, match="eclipse: method must be full or hillaire, got march"):
        _ = sky(method="march").eclipse


def occultations(eclipse, limb_darkening):
    shadow = eclipse._shadow
    radii = float(shadow.sun_radius), float(shadow.moon_radius)
    return [
        Occultation(shadow.sun, shadow.moon, *radii, float(u), float(v))
        for u, v in limb_darkening.T
    ]


def test_the_path_tracer_sees_the_same_share_of_the_sun():
    one = sky(0.1)
    places = np.array([[0.0, 0.0, 0.0], [300.0, 100.0, 10.0], [-200.0, 400.0, 30.0]])
    own = shares_at(one.eclipse._shadow, places)
    for k, veil in enumerate(occultations(one.eclipse, one.source.limb_darkening)):
        traced = [uncovered_share(veil, *place) for place in places]
        np.testing.assert_allclose(own[:, k], traced, atol=5e-4)


def on_the_ground(eclipse):
    """Irradiance of the horizontal by the sky, per unit irradiance of the whole sun."""
    node, weight = np.polynomial.legendre.leggauss(48)
    zenith = math.pi / 4.0 * (node + 1.0)
    azimuth = 2.0 * math.pi * (np.arange(24) + 0.5) / 24
    mu = np.repeat(np.cos(zenith), 24)
    light, _ = eclipse.radiance_per_irradiance(mu, np.tile(azimuth, 48))
    ring = math.pi / 4.0 * weight * np.sin(zenith) * np.cos(zenith) * 2.0 * math.pi
    return ring @ light.reshape(48, 24, -1).mean(axis=1)


def test_a_crescent_lights_the_ground_as_the_path_tracer_says():
    """In green, at an obscuration of 89 %; thirty times less light is that of a deeper eclipse."""
    one = Sky("earth-clear", SUN, wavelengths=[550.0], moon=moon(0.06))
    veils = occultations(one.eclipse, one.source.limb_darkening)
    traced = irradiance(one.medium, 0.0, SUN, samples=8192, occultations=veils)
    assert traced.down_stderr[0] < 0.01 * traced.down[0]
    assert on_the_ground(one.eclipse)[0] == pytest.approx(traced.down[0], rel=0.03)


@pytest.mark.slow
@pytest.mark.parametrize(("above", "tolerance"), [(0.0, 0.08), (0.02, 0.02), (0.06, 0.02)])
def test_the_sky_lights_the_ground_as_the_path_tracer_says(above, tolerance):
    one = Sky("earth-clear", SUN, wavelengths=[450.0, 550.0, 650.0], moon=moon(above))
    veils = occultations(one.eclipse, one.source.limb_darkening)
    traced = irradiance(one.medium, 0.0, SUN, samples=100_000, occultations=veils).down
    np.testing.assert_allclose(on_the_ground(one.eclipse), traced, rtol=tolerance)


@pytest.mark.slow
def test_totality_is_as_bright_toward_the_horizon_and_overhead_as_the_path_tracer_says():
    """Light from the horizon that haze scatters on is brighter there and darker overhead."""
    one = Sky("earth-clear", SUN, wavelengths=[550.0], moon=moon())
    veils = occultations(one.eclipse, one.source.limb_darkening)
    zenith, azimuth = np.radians([5.0, 85.0, 85.0, 85.0]), np.radians([0.0, 0.0, 90.0, 180.0])
    order = {"orders": (1, math.inf), "samples": 20_000, "occultations": veils}
    traced, _ = radiance(one.medium, 0.0, SUN, zenith, azimuth, **order)
    own, _ = one.eclipse.radiance_per_irradiance(np.cos(zenith), azimuth)
    np.testing.assert_allclose(own, traced, rtol=0.12)


@pytest.mark.slow
def test_light_grows_smoothly_after_totality():
    """Frames 0.004 degrees of the moon's way apart: roots of radiances have no jumps."""
    zenith, azimuth = np.radians([10.0, 60.0, 85.0]), np.radians([0.0, 90.0, 180.0])
    mu, around = np.repeat(np.cos(zenith), 3), np.tile(azimuth, 3)
    frames = []
    for above in (0.0, 0.008, 0.016, 0.02, 0.024, 0.028, 0.032):
        one = Sky("earth-clear", SUN, wavelengths=[550.0], moon=moon(above))
        frames.append(one.eclipse.radiance_per_irradiance(mu, around)[0][:, 0])
    root = np.sqrt(frames)
    assert (np.diff(root.mean(axis=1)) > 0.0).all()
    # Of a path without jumps the third differences are small beside the first ones.
    bends = np.abs(np.diff(root[2:], 3, axis=0)) / np.diff(root[2:], axis=0).mean(axis=0)
    assert bends.max() < 0.06
