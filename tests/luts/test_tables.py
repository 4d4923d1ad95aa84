"""Tables against the path tracer, rays of their own, and each other, by their files alone."""

import math

import numpy as np
import pytest

from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.moon import Moon
from skybake.errors import InputError
from skybake.image.night import Night
from skybake.luts.aerial_perspective import air_segments, screen_directions
from skybake.luts.lookup import look_up
from skybake.luts.settings import TableSettings
from skybake.luts.transmittance import space_transmittance
from skybake.optics.phase import eval_phase
from skybake.reference.air import air_at
from skybake.reference.rays import transmittance_to_space
from skybake.scattering.segments import trace_segments
from tests.luts.sets import baked, places, read_texture, scene_of, tables_of, vector


@pytest.fixture(scope="module")
def scene():
    return scene_of()


@pytest.fixture(scope="module")
def files(tmp_path_factory, scene):
    """A folder with tables, and what its ``luts.json`` says."""
    folder = tmp_path_factory.mktemp("luts")
    return folder, baked(folder, scene, aerial_size=(6, 5, 12), azimuth=math.radians(200.0))


def test_transmittance_is_that_of_the_path_tracer(files, scene):
    folder, about = files
    altitude, mu = np.broadcast_arrays(*places(about, "transmittance"))
    table = read_texture(folder / "transmittance.ktx2")
    medium = scene.sky.medium
    picks = np.random.default_rng(0).integers(0, altitude.size, 300)
    for colour in range(3):
        air = air_at(medium, colour)
        h, m = altitude.ravel()[picks], mu.ravel()[picks]
        expected = [transmittance_to_space(air, *ray) for ray in zip(h, m, strict=True)]
        found = table[..., colour].ravel()[picks]
        np.testing.assert_allclose(found, expected, rtol=1e-3, atol=1e-9)


def test_transmittance_is_that_of_the_columns_toward_the_sun(files, scene):
    """Those that rays look up are interpolated, so that few of them are off by more."""
    mu = np.cos(np.radians(np.linspace(0.0, 89.5, 60)))
    height = np.full(mu.shape, scene.sky.skylight.radius - scene.sky.medium.r_bottom)
    table = space_transmittance(scene.sky.medium, height, mu)
    looked_up = scene.sun.transmittance(np.arccos(mu))
    np.testing.assert_allclose(table, looked_up, rtol=1e-3)


def test_multiple_scattering_is_the_mean_of_the_light_all_round(scene):
    """But for what aerosols hardly turn, which counts as sunlight."""
    made = tables_of(scene)
    x, weight = np.polynomial.legendre.leggauss(48)
    azimuth = math.pi * (np.arange(48) + 0.5) / 48
    mu, azimuth = np.meshgrid(x, azimuth, indexing="ij")
    sun = scene.sky.source
    nu = mu * sun.mu + np.sqrt(1.0 - mu**2) * math.cos(sun.elevation) * np.cos(azimuth)
    light = scene.sky.radiance_per_irradiance(mu, nu)
    mean = 0.5 * np.einsum("m,mac->c", weight, light) / azimuth.shape[1]
    found = look_up(
        made.tables["multiple_scattering"], made.constants, {"altitude": 2.0, "mu_s": sun.mu}
    )
    np.testing.assert_allclose(found, mean, rtol=0.15)
    clear = scene_of(sun=40.0, altitude=20.0)
    nu = mu * clear.sky.source.mu + np.sqrt(1.0 - mu**2) * math.cos(
        clear.sky.source.elevation
    ) * np.cos(azimuth)
    light = clear.sky.radiance_per_irradiance(mu, nu)
    mean = 0.5 * np.einsum("m,mac->c", weight, light) / azimuth.shape[1]
    inputs = {"altitude": 20.0, "mu_s": clear.sky.source.mu}
    found = look_up(made.tables["multiple_scattering"], made.constants, inputs)
    np.testing.assert_allclose(found, mean, rtol=0.01)


def test_the_closure_is_near_the_solution_by_day_but_not_the_same():
    inputs = {"altitude": [0.5, 5.0, 20.0], "mu_s": 0.7}
    full, closed = (
        look_up(made.tables["multiple_scattering"], made.constants, inputs)
        for made in (tables_of(scene_of(method=name)) for name in ("full", "hillaire"))
    )
    difference = np.abs(closed / full - 1.0)
    assert 0.01 < difference.max() < 0.2


def test_the_view_of_the_sky_holds_what_rays_of_their_own_bring(files, scene):
    folder, about = files
    zenith, cosine = np.broadcast_arrays(*places(about, "sky_view"))
    table = read_texture(folder / "sky_view.ktx2")[..., :3]
    picks = np.random.default_rng(0).integers(0, zenith.size, 400)
    theta, phi = zenith.ravel()[picks], np.arccos(cosine.ravel()[picks])
    sun = scene.sky.source
    nu = np.cos(theta) * sun.mu + np.sin(theta) * math.cos(sun.elevation) * np.cos(phi)
    light = scene.sky.radiance_per_irradiance(np.cos(theta), nu) @ scene.rgb_weights
    np.testing.assert_allclose(table.reshape(-1, 3)[picks], light, rtol=2e-3)


def test_slices_of_the_volume_hold_the_light_of_segments(files, scene):
    folder, about = files
    x, y, distance = places(about, "aerial_perspective")
    volume = read_texture(folder / "aerial_perspective.ktx2")
    passed = read_texture(folder / "aerial_transmittance.ktx2")[..., :3]
    forward, right, up = (vector(about, f"CAMERA_{one}") for one in ("FORWARD", "RIGHT", "UP"))
    half_width, half_height = (
        about["constants"][f"CAMERA_HALF_{one}"]["value"] for one in ("WIDTH", "HEIGHT")
    )
    atmosphere, medium = scene.sky.atmosphere, scene.sky.medium
    for row, column in ((0, 0), (2, 5), (1, 3)):
        across = half_width * (2.0 * x.ravel()[column] - 1.0)
        above = half_height * (1.0 - 2.0 * y.ravel()[row])
        view = forward + across * right + above * up
        view /= np.linalg.norm(view)
        sun = vector(about, "SUN_DIRECTION")
        ray = (np.array([one]) for one in (medium.r_bottom + 2.0, view[1], sun[1], view @ sun))
        light = trace_segments(atmosphere, *ray, distance.ravel())
        phase = eval_phase(atmosphere.scaled.phase, np.array([view @ sun]))[:, None]
        radiance = ((light.single * phase).sum(axis=2) + light.diffuse)[0, :, :3]
        found = volume[:, row, column, :3]
        np.testing.assert_allclose(found, radiance @ scene.rgb_weights, rtol=1e-5)
        transmittance = light.transmittance[0, :, :3]
        np.testing.assert_allclose(passed[:, row, column], transmittance, rtol=1e-5)


def test_behind_the_ground_stands_the_air_before_it(files):
    folder, about = files
    distance = places(about, "aerial_perspective")[2].ravel()
    volume = read_texture(folder / "aerial_perspective.ktx2")
    # The lowest row looks down by 14 degrees, and meets the ground after 8 km.
    lowest = volume[:, -1]
    behind = distance > 12.0
    np.testing.assert_array_equal(lowest[behind], lowest[behind][:1].repeat(behind.sum(), axis=0))
    assert (np.diff(volume[..., :3], axis=0) >= -1e-7).all()
    assert (np.diff(volume[..., 3], axis=0) <= 0.0).all()


def test_air_in_two_parts_is_the_air_as_a_whole():
    """A camera in the middle of a path sees the second part of it."""
    scene = scene_of(sun=20.0, altitude=3.0)
    settings = TableSettings()
    x, y = np.array([0.3, 0.8]), np.array([0.1, 0.4])
    directions = screen_directions(settings, x, y)
    whole = air_segments(scene, directions, np.array([15.0, 40.0]))
    bottom, height = scene.sky.medium.r_bottom, 3.0
    for ray, direction in enumerate(directions):
        middle = np.array([0.0, bottom + height, 0.0]) + 15.0 * direction
        radius = float(np.linalg.norm(middle))
        up = middle / radius
        sun = scene.sky.source.direction
        rays = (np.array([one]) for one in (radius, direction @ up, sun @ up, direction @ sun))
        atmosphere = scene.sky.atmosphere
        rest = trace_segments(atmosphere, *rays, [25.0])
        phase = eval_phase(atmosphere.scaled.phase, np.array([direction @ sun]))[:, None]
        added = ((rest.single * phase).sum(axis=2) + rest.diffuse)[0, 0, :3]
        first, both = whole.radiance[ray]
        passed, passed_both = whole.transmittance[ray]
        np.testing.assert_allclose(first + passed * added, both, rtol=2e-3)
        np.testing.assert_allclose(passed * rest.transmittance[0, 0, :3], passed_both, rtol=1e-4)


def test_table_times_colour_of_the_sun_is_the_colour_of_the_sun_behind_the_air():
    scene = scene_of("earth", sun=10.0, altitude=0.5)
    made = tables_of(scene, transmittance_size=(1024, 256))
    inputs = {"altitude": 0.5, "mu": scene.sky.source.mu}
    share = look_up(made.tables["transmittance"], made.constants, inputs)
    above = np.array(made.constants["SUN_ILLUMINANCE"][0])
    normal, _ = scene.sun.irradiance_per_irradiance()
    np.testing.assert_allclose(share * above, normal @ scene.rgb_weights, rtol=3e-3)


def test_the_disc_brings_the_light_of_the_sun(scene):
    known = {name: value for name, (value, _) in tables_of(scene).constants.items()}
    share = (np.arange(2000) + 0.5) / 2000
    profile = (
        np.array(known["SUN_RADIANCE"])
        - np.outer(1.0 - np.sqrt(1.0 - share**2), known["SUN_LIMB"])
        - np.outer(share**2, known["SUN_LIMB_OF_SQUARE"])
    )
    rings = 2.0 * math.pi * known["SUN_SINE"] ** 2 * share / 2000
    np.testing.assert_allclose(rings @ profile, known["SUN_ILLUMINANCE"], rtol=1e-4)


@pytest.mark.parametrize("sun", [60.0, 10.0])
def test_a_march_with_tables_and_constituents_of_the_files_gives_the_sky(tmp_path, sun):
    """As Hillaire's renderer does it, in the world and by the method of his paper."""
    scene = scene_of(sun=sun, altitude=0.5, method="hillaire")
    about = baked(tmp_path, scene, parametrisation="bruneton2017")
    made = tables_of(scene, parametrisation="bruneton2017")
    medium, sunward = about["medium"], vector(about, "SUN_DIRECTION")
    bottom = about["constants"]["BOTTOM_RADIUS"]["value"]
    for toward in ([0.0, 1.0, 0.0], [0.6, 0.8, 0.0], [-0.5, 0.3, 0.8], [0.1, 0.2, -0.9]):
        view = np.array(toward) / np.linalg.norm(toward)
        ends = 600.0 * np.linspace(0.0, 1.0, 400) ** 2
        middle, length = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends)
        places = np.array([0.0, bottom + 0.5, 0.0]) + middle[:, None] * view
        radius = np.linalg.norm(places, axis=1)
        altitude, mu_s = radius - bottom, places @ sunward / radius
        inside = altitude < medium["altitude_km"][-1]
        angle = math.acos(view @ sunward)
        scattering, extinction, phased = (np.zeros((middle.size, 3)) for _ in range(3))
        for one in medium["constituents"].values():
            density = np.interp(altitude, medium["altitude_km"], one["relative_density"]) * inside
            phase = np.array(one["phase_per_sr"])
            here = [np.interp(angle, medium["scattering_angle_rad"], each) for each in phase.T]
            scattering += np.outer(density, one["scattering_per_km"])
            extinction += np.outer(density, one["extinction_per_km"])
            phased += np.outer(density, one["scattering_per_km"]) * here
        inputs = {"altitude": np.minimum(altitude, 99.9)}
        lit = look_up(made.tables["transmittance"], made.constants, {**inputs, "mu": mu_s})
        mean = look_up(made.tables["multiple_scattering"], made.constants, {**inputs, "mu_s": mu_s})
        depth = np.cumsum(extinction * length[:, None], axis=0)
        passed = np.exp(-(depth - 0.5 * extinction * length[:, None]))
        light = (passed * (phased * lit + scattering * mean) * length[:, None]).sum(axis=0)
        found = light * vector(about, "SUN_ILLUMINANCE")
        expected = scene.sky.radiance(view) / scene.sky.irradiance @ scene.rgb_weights
        np.testing.assert_allclose(found, expected, rtol=0.01)


def test_what_is_not_symmetric_about_the_sun_is_refused():
    frame = CelestialFrame("earth", 0.7, 0.5, 2026.0)
    scene = scene_of("earth", night=Night(frame))
    with pytest.raises(InputError, match="night: must not be shown in tables"):
        tables_of(scene)
    moon = Moon(math.radians(215.0), math.radians(30.0))
    with pytest.raises(InputError, match="moon: must not eclipse the sun in tables"):
        tables_of(scene_of("earth", sun=30.0, moon=moon))
