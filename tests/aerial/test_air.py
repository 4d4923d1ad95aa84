"""Light that the air adds, and what it lets pass, against rays that are traced one by one."""

import math

import numpy as np
import pytest

from skybake.aerial.air import Air, air_before
from skybake.aerial.compose import Behind, through_air
from skybake.aerial.depth import Depths
from skybake.aerial.froxels import air_by_froxels
from skybake.aerial.sight import lens_of
from skybake.aerial.to_space import dim_beyond
from skybake.ephemeris.lit_moon import moon_by_hand
from skybake.image.apart import evaluate_transmittance
from skybake.image.moonlight import Moonlight
from skybake.optics.changes import PresetChanges
from skybake.preset import load_preset
from skybake.projection.camera import camera_from_angles
from skybake.projection.gnomonic import GnomonicChart
from tests.aerial.pictures import scene

SIZE = 96, 54


def camera_to(azimuth, elevation, fov=50.0, roll=0.0):
    angles = (math.radians(each) for each in (azimuth, elevation, roll, fov))
    return camera_from_angles(*angles, SIZE[0] / SIZE[1])


def rays(camera, size=SIZE):
    """Unit vectors of all pixels, shape (row, column, 3)."""
    lens = lens_of(camera, size)
    column, row = np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5)
    right, up, forward = camera.frame
    u, v = lens.left + column * lens.width, lens.top - row * lens.height
    seen = forward + u[..., None] * right + v[..., None] * up
    return seen / np.linalg.norm(seen, axis=-1, keepdims=True)


def to_ground(directions, made):
    """Distance of the ground along rays, infinite above the horizon. [km]"""
    medium, r = made.sky.medium, made.sky.skylight.radius
    along = -r * directions[..., 1]
    height = (r - medium.r_bottom) * (r + medium.r_bottom)
    squared = along * along - height
    hits = (along > 0.0) & (squared > 0.0)
    return np.where(hits, height / (along + np.sqrt(np.maximum(squared, 0.0))), np.inf)


def traced(made, directions, distances):
    """Light and passing share of single rays, RGB."""
    found = made.sky.skylight.segments(directions, distances[..., None])
    weights = made.rgb_weights
    light = found.radiance[..., 0, :] / made.sky.irradiance @ weights
    return light, found.transmittance[..., 0, :] @ weights / weights.sum(axis=0)


def differences(made, camera, *, nearest=0.005, farthest=200.0, by=air_before):
    """Of light, over the brightest channel, and of passing shares, in pixels above the ground."""
    generator = np.random.default_rng(3)
    shape = SIZE[::-1]
    distance = np.exp(generator.uniform(np.log(nearest), np.log(farthest), shape))
    distance = distance.astype(np.float32)
    air = by(made, lens_of(camera, SIZE), Depths(distance, 1.0, False))
    directions = rays(camera)
    over = distance < 0.999 * to_ground(directions, made)
    chosen = np.zeros(shape, bool)
    chosen.flat[generator.choice(distance.size, 300, replace=False)] = True
    chosen &= over
    assert chosen.sum() > 100
    light, passing = traced(made, directions[chosen], distance[chosen].astype(float))
    scale = light.max(axis=-1, keepdims=True)
    return np.abs(air.light[chosen] - light) / scale, np.abs(air.passing[chosen] - passing)


@pytest.mark.parametrize(
    ("world", "elevation", "altitude", "look"),
    [
        ("earth", 20.0, 0.1, -3.0),
        ("earth", 1.0, 0.002, 2.0),
        ("earth", 40.0, 10.0, -20.0),
        ("mars", 3.0, 0.5, 0.0),
    ],
)
def test_pixels_are_those_of_rays_within_three_thousandths(world, elevation, altitude, look):
    """All passing shares, and the light of 99 in 100 pixels."""
    made = scene(elevation, altitude, load_preset(world))
    light, passing = differences(made, camera_to(190.0, look, roll=6.0))
    assert np.percentile(light, 99.0) < 3e-3
    assert light.max() < 0.01
    assert passing.max() < 3e-3


def test_the_shadow_of_the_planet_is_in_the_air():
    """In twilight half of the air is dark; the root mean square is a thousandth."""
    made = scene(-4.0, 0.1)
    light, _ = differences(made, camera_to(0.0, 3.0))
    assert math.sqrt((light**2).mean()) < 1e-3
    toward, _ = differences(made, camera_to(180.0, 3.0))
    assert math.sqrt((toward**2).mean()) < 1e-3


def test_froxels_differ_by_less_than_a_percent():
    made = scene(20.0, 0.1)
    light, passing = differences(made, camera_to(150.0, 5.0), nearest=0.5, by=air_by_froxels)
    assert math.sqrt((light**2).mean()) < 3e-3
    assert passing.max() < 3e-3


def moonlit():
    """A night with a half moon in the west."""
    moon = moon_by_hand(
        math.radians(270.0), math.radians(35.0), math.radians(90.0), math.pi, math.radians(-25.0)
    )
    return scene(-25.0, 0.1, moonlight=Moonlight(moon))


@pytest.mark.parametrize("light", [lambda: scene(20.0, 0.1), moonlit], ids=["sun", "moon"])
def test_far_away_the_air_is_the_sky(light):
    made, camera = light(), camera_to(120.0, 25.0)
    far = Depths(np.full(SIZE[::-1], 5000.0, np.float32), 1.0, False)
    air = air_before(made, lens_of(camera, SIZE), far)
    window = (0, 0, *SIZE)
    sky = Behind(made, camera, SIZE, window).sky
    above = rays(camera)[..., 1] > 0.02
    assert sky[above].min() > 0.0
    np.testing.assert_allclose(air.light[above], sky[above], rtol=3e-3)


def test_planar_depths_are_shorter_than_rays():
    made, camera = scene(20.0, 0.1), camera_to(120.0, 10.0, fov=80.0)
    lens = lens_of(camera, SIZE)
    cosine = rays(camera) @ camera.frame[2]
    planar = Depths((30e3 * cosine).astype(np.float32), 1e-3, True)
    ray = Depths(np.full(SIZE[::-1], 30.0, np.float32), 1.0, False)
    one, other = air_before(made, lens, planar), air_before(made, lens, ray)
    np.testing.assert_allclose(one.light, other.light, rtol=1e-5)
    np.testing.assert_allclose(one.passing, other.passing, rtol=1e-5)


def test_a_valley_below_the_ground_has_the_air_of_its_distance():
    """Light and dimming go on where the ground of the round planet would end them."""
    made, camera = scene(20.0, 0.002), camera_to(120.0, 0.0, fov=1.0)
    distance = np.full(SIZE[::-1], 4.0, np.float32)
    air = air_before(made, lens_of(camera, SIZE), Depths(distance, 1.0, False))
    ends = to_ground(rays(camera), made) < 4.0
    assert 0.2 < ends.mean() < 0.9
    assert np.abs(np.diff(air.light, axis=0)).max() < 0.01 * air.light.max()
    assert np.ptp(air.passing[..., 1]) < 1e-3


def hazy():
    """Earth with a visibility of 25 km, 3.912 / extinction."""
    return PresetChanges(visibility=25.0, sources={"visibility": "--visibility"}).load("earth")


@pytest.mark.parametrize("distance", [1.0, 10.0, 50.0])
def test_targets_in_haze_are_as_koschmieder_has_them(distance):
    """Black and white ones before the horizon, level, within 5 % of the horizon's light."""
    made = scene(50.0, 0.002, hazy(), method="hillaire")
    direction = np.array([[math.sin(2.0), 0.0, -math.cos(2.0)]])
    light, passing = traced(made, direction, np.array([distance]))
    horizon, _ = traced(made, direction, np.array([1e5]))
    medium = made.sky.medium
    extinction = medium.density[0] @ medium.extinction
    weights = made.rgb_weights[:, 1]
    beam = float(np.exp(-extinction * distance) @ weights / weights.sum())
    camera = camera_to(math.degrees(2.0), 0.0, fov=0.01)
    pixel = Depths(np.full(SIZE[::-1], distance, np.float32), 1.0, False)
    air = air_before(made, lens_of(camera, SIZE), pixel)
    white = float(horizon[0, 1])
    middle = SIZE[1] // 2, SIZE[0] // 2
    for target in (0.0, white):
        seen = float(target * air.passing[middle][1] + air.light[middle][1])
        expected = target * beam + white * (1.0 - beam)
        assert abs(seen - expected) < 0.05 * white
    assert air.passing[middle][1] == pytest.approx(float(passing[0, 1]), abs=3e-3)
    assert air.light[middle][1] == pytest.approx(float(light[0, 1]), rel=5e-3)


def test_a_way_in_two_parts_is_the_whole_way():
    """White light at 12 km: the air of 5 km, and of 7 km from there, within 0.2 %."""
    whole, camera = scene(30.0, 1.0), camera_to(150.0, 0.0, fov=0.01)
    lens = lens_of(camera, SIZE)
    middle = SIZE[1] // 2, SIZE[0] // 2

    def seen(made, distance, behind):
        even = Depths(np.full(SIZE[::-1], distance, np.float32), 1.0, False)
        air = air_before(made, lens, even)
        return behind * air.passing[middle] + air.light[middle]

    first, rest = 5.0, 7.0
    r = whole.sky.skylight.radius
    there = math.hypot(r, first)
    # Five kilometres on, the level ray rises and the sun stands elsewhere by the same angle.
    turn = math.atan2(first, r)
    sun = np.array([0.0, math.sin(math.radians(30.0)), math.cos(math.radians(30.0))])
    forward = np.array([math.sin(math.radians(150.0)), 0.0, -math.cos(math.radians(150.0))])
    up = np.array([0.0, math.cos(turn), 0.0]) + math.sin(turn) * forward
    moved = scene(math.degrees(math.asin(sun @ up)), 1.0 + there - r)
    level = forward * math.cos(turn) - np.array([0.0, math.sin(turn), 0.0])
    side = np.cross(level, up)
    azimuth = math.degrees(math.atan2(sun @ side, sun @ level))
    beyond = camera_to(180.0 - azimuth, math.degrees(turn), fov=0.01)
    lens_there = lens_of(beyond, SIZE)
    even = Depths(np.full(SIZE[::-1], rest, np.float32), 1.0, False)
    air = air_before(moved, lens_there, even)
    behind = 0.5 * air.passing[middle] + air.light[middle]
    np.testing.assert_allclose(
        seen(whole, first, behind), seen(whole, first + rest, 0.5), rtol=2e-3
    )


def test_at_distance_0_light_is_what_it_was():
    generator = np.random.default_rng(1)
    light = generator.uniform(-1.0, 1e4, (*SIZE[::-1], 3)).astype(np.float32)
    depths = Depths(np.zeros(SIZE[::-1], np.float32), 1.0, True)
    air = air_before(scene(), lens_of(camera_to(0.0, 0.0), SIZE), depths)
    out = through_air(light, None, air, depths, None, None)
    assert (out.view(np.uint32) == light.view(np.uint32)).all()


def test_from_space_there_is_no_air_before_it_begins():
    made, camera = scene(30.0, 400.0), camera_to(150.0, -50.0)
    lens = lens_of(camera, SIZE)
    near = air_before(made, lens, Depths(np.full(SIZE[::-1], 200.0, np.float32), 1.0, False))
    assert (near.light == 0.0).all()
    assert (near.passing == 1.0).all()
    distance = to_ground(rays(camera), made)
    ground = Depths(np.where(np.isfinite(distance), distance, 0.0).astype(np.float32), 1.0, False)
    air = air_before(made, lens, ground)
    chosen = np.isfinite(distance) & (distance < 800.0)
    light, passing = traced(made, rays(camera)[chosen], distance[chosen] * (1.0 - 1e-6))
    assert np.abs(air.light[chosen] / light - 1.0).max() < 0.01
    assert np.abs(air.passing[chosen] - passing).max() < 0.01


@pytest.mark.parametrize(
    ("altitude", "look", "fov"), [(0.002, 5.0, 50.0), (10.0, -2.0, 9.0), (400.0, -17.0, 20.0)]
)
def test_light_from_space_is_dimmed_as_the_transmittance_of_a_map_says(altitude, look, fov):
    """Within 0.002, also in pixels that the horizon divides."""
    made, camera = scene(20.0, altitude), camera_to(120.0, look, fov, roll=20.0)
    shape = SIZE[::-1]
    air = Air(np.zeros((*shape, 3), np.float32), np.full((*shape, 3), 9.0, np.float32))
    depth = np.full(shape, np.inf, np.float32)
    depth[:, ::5] = 3.0
    dim_beyond(made, lens_of(camera, SIZE), Depths(depth, 1.0, False), air)
    assert (air.passing[:, ::5] == 9.0).all()
    chart = GnomonicChart(camera.axes, camera.half_width, camera.half_height, *SIZE)
    expected = evaluate_transmittance(made, *chart.looks(0, SIZE[1]))
    is_far = np.isinf(depth)
    assert np.ptp(expected) > 0.4
    np.testing.assert_allclose(air.passing[is_far], expected[is_far], atol=2e-3)
