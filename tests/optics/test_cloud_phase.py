"""Phase functions of cloud particles."""

import numpy as np
import pytest

from skybake.optics.phase import build_phase, integrate_phase, scattering_angles
from skybake.preset.particles import EFFECTIVE_RADII, particle_phase

WAVELENGTHS = np.array([380.0, 440.0, 550.0, 680.0, 720.0])
ANGLES = np.degrees(scattering_angles())
NU = np.cos(scattering_angles())[:, None]


def droplets(radius, wavelengths=WAVELENGTHS):
    return build_phase(particle_phase("water", "here", radius), wavelengths)


def at(phase, degrees):
    return float(np.interp(degrees, ANGLES, phase))


@pytest.mark.parametrize("particles", ["water", "ice", "co2_ice"])
def test_phase_functions_are_normalised(particles):
    phase = particle_phase(particles, "here", 13.0)
    assert integrate_phase(build_phase(phase, WAVELENGTHS)) == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("name", ["5um", "10um", "20um"])
def test_tables_of_droplets_integrate_to_one_as_they_are(name):
    radius = float(name.removesuffix("um"))
    phase = particle_phase("water", "here", radius)
    table = np.array(phase.values).T
    assert np.degrees(phase.angle) == pytest.approx(ANGLES, abs=1e-4)
    assert integrate_phase(table) == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize(("radius", "asymmetry"), [(5, 0.849), (10, 0.864), (20, 0.873)])
def test_the_asymmetry_of_droplets_is_that_of_mie_theory(radius, asymmetry):
    """Hu & Stamnes (1993), J. Climate 6, 728: 0.85 to 0.88 in the visible."""
    phase = droplets(float(radius), np.array([550.0]))
    assert integrate_phase(phase * NU)[0] == pytest.approx(asymmetry, abs=0.003)


def test_droplets_have_a_cloudbow_and_a_glory():
    phase = droplets(10.0)[:, 2]
    bow = (ANGLES > 130) & (ANGLES < 155)
    assert 138 < ANGLES[bow][phase[bow].argmax()] < 146
    assert at(phase, 141.5) > 1.5 * at(phase, 125)
    back = phase[ANGLES > 175]
    assert back.max() > 2.0 * at(phase, 165)


def test_larger_droplets_have_a_narrower_corona():
    """Diffraction falls to half of its peak at x theta = 1.6, of mean sizes near r_eff."""
    half = []
    for radius in EFFECTIVE_RADII:
        phase = droplets(radius, np.array([550.0]))[:, 0]
        half.append(ANGLES[np.argmax(phase < 0.5 * phase[0])])
    for radius, angle in zip(EFFECTIVE_RADII, half, strict=True):
        size = 2 * np.pi * radius / 0.55
        assert np.radians(angle) * size == pytest.approx(1.5, abs=0.25)


def test_red_light_has_the_wider_corona():
    phase = droplets(10.0)
    assert at(phase[:, 1] / phase[0, 1], 1.0) < at(phase[:, 3] / phase[0, 3], 1.0)


def test_fringes_of_single_droplets_are_averaged_out():
    """Between corona and cloudbow neighbouring nodes differ by no more than a smooth curve does."""
    for radius in EFFECTIVE_RADII:
        phase = np.log(droplets(radius, np.array([550.0]))[:, 0])
        smooth = (ANGLES > 20) & (ANGLES < 118)
        bend = phase[2:] - 2.0 * phase[1:-1] + phase[:-2]
        assert np.abs(bend[smooth[1:-1]]).max() < 0.01


def test_between_tables_the_phase_function_is_between_theirs():
    few, many, between = (droplets(radius)[:, 2] for radius in (5.0, 10.0, 7.0))
    lower, upper = np.minimum(few, many), np.maximum(few, many)
    assert (between >= lower * (1 - 1e-3)).all()
    assert (between <= upper * (1 + 1e-3)).all()
    share = np.log(7.0 / 5.0) / np.log(2.0)
    np.testing.assert_allclose(between, (1 - share) * few + share * many, rtol=2e-3)


def test_ice_has_halos_where_prisms_deviate_light_least():
    phase = build_phase(particle_phase("ice", "here"), WAVELENGTHS)
    for prism, least in ((60.0, 1.3), (90.0, 1.1)):
        index = 1.311
        angle = 2 * np.degrees(np.arcsin(index * np.sin(np.radians(prism / 2)))) - prism
        near = np.abs(ANGLES - angle) < 3.0
        peak = phase[near, 2].argmax()
        assert ANGLES[near][peak] == pytest.approx(angle, abs=0.3)
        inside = np.abs(ANGLES - angle + 2.0) < 2.0
        assert phase[near, 2].max() > least * phase[inside, 2].min()
    assert integrate_phase(phase * NU)[2] == pytest.approx(0.76, abs=0.02)


def test_halos_are_red_inside():
    phase = build_phase(particle_phase("ice", "here"), WAVELENGTHS)
    assert at(phase[:, 3], 21.3) > 1.05 * at(phase[:, 1], 21.3)
