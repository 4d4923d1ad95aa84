import math

import numpy as np
import pytest

from skybake.errors import InputError
from skybake.jit import workers
from skybake.optics.medium import ALTITUDE_NODES, Medium, altitude_nodes
from skybake.optics.phase import scattering_angles
from skybake.reference.air import air_at
from skybake.reference.estimate import irradiance, radiance, single_scattering
from skybake.reference.guide import make_guide
from skybake.reference.paths import mean_irradiance
from skybake.reference.rays import transmittance_to_space
from tests.truth import (
    TRUTH_WAVELENGTHS,
    henyey_greenstein,
    load_irradiance_truth,
    load_truth,
    truth_medium,
)

SCENES = [
    ("EARTH_A", 0.001, 60.0),
    ("EARTH_A", 0.001, -4.0),
    ("EARTH_A", 10.0, 2.0),
    ("EARTH_A", 400.0, 10.0),
    ("EARTH_HAZE", 0.001, 35.0),
    ("MARS_A", 0.001, 60.0),
]
QUICK_SCENES = SCENES[:2] + SCENES[3:4] + SCENES[5:]
MORE_SCENES = [
    ("EARTH_A", 0.001, 5.0),
    ("EARTH_A", 0.001, 0.0),
    ("EARTH_A", 10.0, 30.0),
    ("EARTH_A", 10.0, -2.0),
    ("EARTH_A", 400.0, -6.0),
    ("EARTH_HAZE", 0.001, -3.0),
    ("MARS_A", 0.001, 2.0),
    ("EARTH_A", 0.001, -6.0),
    ("EARTH_A", 0.001, -9.0),
    ("EARTH_A", 10.0, -9.0),
    ("EARTH_A", 400.0, -12.0),
    ("MARS_A", 0.001, -4.0),
    ("MARS_A", 0.001, -9.0),
]


def truth_rows(name: str, altitude: float, sun: float, count: int) -> np.ndarray:
    """At least `count` views of one scene, spread over all of them; shape (view, wavelength)."""
    rows = load_truth(name)
    rows = rows[(rows["altitude_km"] == altitude) & (rows["sun_elevation_deg"] == sun)]
    rows = np.sort(rows, order=["view_zenith_deg", "relative_azimuth_deg", "wavelength_nm"])
    rows = rows.reshape(-1, len(TRUTH_WAVELENGTHS))[:, ::-1]
    rows = rows[:: len(rows) // count]
    assert len(rows) >= count
    assert np.all(rows["wavelength_nm"] == TRUTH_WAVELENGTHS)
    return rows


def at_one_wavelength(medium: Medium, i: int) -> Medium:
    return medium._replace(
        scattering=medium.scattering[:, [i]],
        extinction=medium.extinction[:, [i]],
        phase=medium.phase[:, :, [i]],
        ground_albedo=medium.ground_albedo[[i]],
    )


def views(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return (
        np.radians(rows["view_zenith_deg"][:, 0]),
        np.radians(rows["relative_azimuth_deg"][:, 0]),
    )


@pytest.mark.parametrize(("name", "altitude", "sun"), SCENES + MORE_SCENES)
def test_light_scattered_once_is_that_of_the_tables(name, altitude, sun):
    rows = truth_rows(name, altitude, sun, count=6)
    single = single_scattering(truth_medium(name), altitude, np.radians(sun), *views(rows))
    # The tables' quadrature is good to 1e-4 of what matters; the night side is 1e-5 of that.
    dark = 1e-5 * rows["radiance"].max()
    np.testing.assert_allclose(single, rows["order1"], rtol=5e-4, atol=2e-4 * dark)


def check_all_orders(name, altitude, sun, samples, count, worst_stderr):
    rows = truth_rows(name, altitude, sun, count)
    mean, stderr = radiance(
        truth_medium(name), altitude, np.radians(sun), *views(rows), samples=samples
    )
    judged = (rows["stderr"] < 0.05 * rows["radiance"]) & (
        rows["radiance"] > 1e-5 * rows["radiance"].max()
    )
    assert judged.sum() >= 8
    # The tables' own errors are about a quarter too small in twilight.
    noise = np.hypot(stderr, rows["stderr"] * (1.25 if sun <= 0.0 else 1.0))
    allowed = 3.0 * noise + 0.002 * rows["radiance"]
    assert np.median((stderr / rows["radiance"])[judged]) < worst_stderr
    error = np.abs(mean - rows["radiance"])
    assert np.all((error <= allowed)[judged]), (error / noise)[judged].max()


@pytest.mark.parametrize(
    ("name", "altitude", "sun"),
    [
        pytest.param(*scene, marks=() if scene in QUICK_SCENES else pytest.mark.slow)
        for scene in SCENES
    ],
)
def test_all_orders_agree_with_the_tables(name, altitude, sun):
    worst = 0.006 if name == "EARTH_A" and sun >= 0.0 else 0.02
    check_all_orders(name, altitude, sun, samples=4800, count=5, worst_stderr=worst)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "altitude", "sun"), SCENES + MORE_SCENES)
def test_all_orders_agree_with_the_tables_at_many_samples(name, altitude, sun):
    # As deep into the night as the tables are judged themselves.
    check_all_orders(name, altitude, sun, samples=32_000, count=5, worst_stderr=0.05)


def test_sampling_the_first_order_gives_its_quadrature():
    medium = truth_medium("MARS_A")
    zenith, azimuth = np.radians([30.0, 88.0, 100.0, 70.0]), np.radians([0.0, 20.0, 90.0, 3.0])
    mean, stderr = radiance(
        medium, 0.5, np.radians(20.0), zenith, azimuth, samples=16_000, orders=(1, 1)
    )
    exact = single_scattering(medium, 0.5, np.radians(20.0), zenith, azimuth)
    assert np.all(stderr < 0.01 * exact)
    assert np.all(np.abs(mean - exact) < 3.5 * stderr + 1e-5 * exact)


@pytest.mark.slow
def test_orders_add_up():
    medium = at_one_wavelength(truth_medium("EARTH_HAZE"), 2)
    view = (np.radians(10.0), np.radians([40.0, 80.0]), np.radians([30.0, 150.0]))
    parts = [
        radiance(medium, 0.1, *view, samples=16_000, orders=orders, seed=orders[0])
        for orders in ((1, 1), (2, 2), (3, math.inf))
    ]
    whole, whole_stderr = radiance(medium, 0.1, *view, samples=16_000)
    noise = np.sqrt(whole_stderr**2 + sum(stderr**2 for _, stderr in parts))
    assert np.all(noise < 0.02 * whole)
    assert np.all(np.abs(sum(mean for mean, _ in parts) - whole) < 3.5 * noise)


@pytest.mark.slow
def test_the_standard_error_is_the_scatter_between_seeds():
    medium = at_one_wavelength(truth_medium("EARTH_A"), 1)
    view = (np.radians(5.0), np.radians([5.0, 20.0, 60.0, 85.0, 88.0, 95.0]), np.radians(120.0))
    runs = [radiance(medium, 0.0, *view, samples=640, seed=seed) for seed in range(24)]
    scatter = np.std([mean for mean, _ in runs], axis=0, ddof=1)
    stated = np.mean([stderr for _, stderr in runs], axis=0)
    # Each ratio has a standard deviation of 1 / sqrt(2 x 23) = 15 %.
    assert np.all(np.abs(scatter / stated - 1.0) < 0.45)
    assert abs(np.mean(scatter / stated) - 1.0) < 0.18


def test_results_do_not_depend_on_the_number_of_threads(monkeypatch):
    medium = at_one_wavelength(truth_medium("EARTH_A"), 0)
    view = (np.radians(-3.0), np.radians([60.0, 95.0]), 0.0)

    def run(count):
        monkeypatch.setattr(workers, "cpu_count", lambda: count)
        return radiance(medium, 1.0, *view, samples=320, seed=5)

    np.testing.assert_array_equal(run(1), run(3))


@pytest.mark.parametrize(
    ("name", "sun", "samples"),
    [
        ("EARTH_A", 60.0, 6400),
        pytest.param("EARTH_A", 10.0, 6400, marks=pytest.mark.slow),
        ("EARTH_A", -4.0, 6400),
        pytest.param("MARS_A", 60.0, 6400, marks=pytest.mark.slow),
        ("MARS_A", 10.0, 6400),
        # Dusk in dust: most light has turned many times, and few paths find it.
        pytest.param("MARS_A", -4.0, 100_000, marks=pytest.mark.slow),
    ],
)
def test_irradiances_agree_with_the_tables(name, sun, samples):
    altitude = 0.001
    rows = load_irradiance_truth(name)
    rows = rows[(rows["altitude_km"] == altitude) & (rows["sun_elevation_deg"] == sun)]
    result = irradiance(truth_medium(name), altitude, np.radians(sun), samples=samples)
    np.testing.assert_allclose(result.transmittance, rows["sun_direct_transmittance"], rtol=5e-5)
    np.testing.assert_allclose(result.direct, rows["direct_horizontal_irradiance"], atol=2e-6)
    for side in ("down", "up"):
        truth, stderr = rows[f"diffuse_{side}_irradiance"], getattr(result, f"{side}_stderr")
        noise = np.hypot(stderr, 1.25 * rows[f"stderr_{side}"])
        assert np.all(stderr < 0.1 * truth)
        assert np.all(np.abs(getattr(result, side) - truth) < 3.0 * noise + 0.002 * truth)


def planet(extinction: float, ground_albedo: float, g: float = 0.75) -> Medium:
    """A small planet in conservative haze, where curvature matters."""
    return Medium(
        r_bottom=1000.0,
        r_top=1060.0,
        density=np.exp(-altitude_nodes(1000.0, 1060.0) / 8.0)[:, None],
        scattering=np.array([[extinction]]),
        extinction=np.array([[extinction]]),
        phase=henyey_greenstein(scattering_angles(), g)[None, :, None],
        ground_albedo=np.array([ground_albedo]),
    )


@pytest.mark.slow
@pytest.mark.parametrize("depth", [0.4, 5.0])
def test_a_planet_that_absorbs_nothing_returns_all_the_light(depth):
    air = air_at(planet(depth / 8.0, ground_albedo=1.0), 0)
    guide = make_guide(air)
    top, r_top = 60.0, 1060.0
    # Diffuse light out of the sphere, by Gauss-Legendre over the sun's zenith angle.
    x, w = np.polynomial.legendre.leggauss(6)
    seeds = np.random.SeedSequence(1).generate_state(4 * len(x) * 16, np.uint64)
    seeds = iter(seeds.reshape(-1, 16))
    diffuse, variance = 0.0, 0.0
    for low, high in ((-0.7, -0.3), (-0.3, 0.0), (0.0, 0.3), (0.3, 1.0)):
        for node, weight in zip(x, w, strict=True):
            mu_s = low + 0.5 * (high - low) * (node + 1.0)
            sun = (math.sqrt(1.0 - mu_s * mu_s), 0.0, mu_s)
            samples = 1500 if low > 0.0 else 300
            runs = [mean_irradiance(air, guide, sun, top, -1.0, samples, s) for s in next(seeds)]
            share = (high - low) * weight
            diffuse += share * np.mean(runs)
            variance += share**2 * np.var(runs, ddof=1) / len(runs)
    # And light that passed the limb unscattered.
    p = np.linspace(1000.0, r_top, 4001)[:-1] + 30.0 / 4000
    limb = [transmittance_to_space(air, top, -math.sqrt(1.0 - (q / r_top) ** 2)) for q in p]
    direct = np.sum(2.0 * p * np.array(limb)) * 60.0 / 4000 / r_top**2
    assert math.sqrt(variance) < 0.01
    assert abs(diffuse + direct - 1.0) < 3.0 * math.sqrt(variance) + 0.001


def test_without_air_only_the_ground_is_seen():
    medium = planet(0.0, ground_albedo=0.4)
    sun = np.radians(50.0)
    mean, stderr = radiance(medium, 100.0, sun, [np.pi, 0.0, np.pi / 2], 0.0, samples=32)
    np.testing.assert_allclose(mean[:, 0], [0.4 / np.pi * np.sin(sun), 0.0, 0.0], rtol=1e-12)
    np.testing.assert_array_equal(stderr, 0.0)


def test_black_ground_under_absorbing_air_is_black():
    medium = planet(0.1, ground_albedo=0.0)
    medium = medium._replace(scattering=np.zeros((1, 1)))
    mean, _ = radiance(medium, 0.0, 0.5, [0.0, 1.5, 3.0], 0.0, samples=64, orders=(1, math.inf))
    np.testing.assert_array_equal(mean, 0.0)


def test_directions_past_the_atmosphere_are_black():
    mean, stderr = radiance(truth_medium("MARS_A"), 400.0, 0.3, [0.0, 1.6], [0.0, 1.0], samples=32)
    np.testing.assert_array_equal(mean, 0.0)
    np.testing.assert_array_equal(stderr, 0.0)


def test_a_layer_of_cloud_thinner_than_a_kilometre_is_finite_and_dims_the_ground():
    medium = planet(2.0, ground_albedo=0.1)
    altitude = altitude_nodes(1000.0, 1060.0)
    layer = np.where(np.abs(altitude - 2.0) < 0.3, 1.0, 0.0)[:, None]
    assert layer.shape == (ALTITUDE_NODES, 1)
    cloudy = medium._replace(density=layer * 10.0)
    mean, stderr = radiance(cloudy, 5.0, 0.8, [np.pi, 0.9 * np.pi], 0.0, samples=640)
    assert np.all(np.isfinite(mean))
    assert np.all(mean > 0.1 / np.pi * np.sin(0.8) + 3.0 * stderr)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"altitude": -1.0}, "altitude: must be >= 0 km, got -1.0"),
        ({"sun_elevation": math.nan}, "sun_elevation: must be finite, got nan"),
        ({"samples": 0}, "samples: must be >= 1, got 0"),
        ({"orders": (3, 2)}, "orders: must be 1 <= first <= last, got (3, 2)"),
    ],
)
def test_arguments_out_of_range_are_named(change, message):
    arguments = {
        "altitude": 1.0,
        "sun_elevation": 0.5,
        "view_zenith": 0.1,
        "relative_azimuth": 0.0,
        "samples": 32,
    } | change
    with pytest.raises(InputError) as caught:
        radiance(truth_medium("EARTH_A"), **arguments)
    assert str(caught.value) == message
