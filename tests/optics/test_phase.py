import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.errors import PresetError
from skybake.optics.phase import (
    SCATTERING_ANGLES,
    build_phase,
    integrate_phase,
    phase_cornette_shanks,
    phase_henyey_greenstein,
    phase_rayleigh,
    scattering_angles,
)
from skybake.preset import (
    DoubleHenyeyGreensteinPhase,
    HenyeyGreensteinPhase,
    Spectrum,
    TabulatedPhase,
    load_preset,
)

ANGLES = scattering_angles()
NU = np.cos(ANGLES)


def constant(value: float) -> Spectrum:
    return Spectrum("here", (), (value,))


def mars_dust() -> TabulatedPhase:
    phase = load_preset("mars").constituents[1].phase
    assert isinstance(phase, TabulatedPhase)
    return phase


def at(table, degrees):
    return np.exp(np.interp(np.radians(degrees), ANGLES, np.log(table)))


@given(st.floats(-0.95, 0.95))
def test_henyey_greenstein_integrates_to_one_with_its_parameter_as_mean_cosine(g):
    phase = phase_henyey_greenstein(NU, np.float64(g))
    # The trapezoid between nodes is good to 1e-4 for a peak as sharp as g = 0.95.
    assert integrate_phase(phase) == pytest.approx(1.0, abs=2e-4)
    assert integrate_phase(phase * NU) == pytest.approx(g, abs=2e-4)


@given(st.floats(-0.95, 0.95))
def test_cornette_shanks_integrates_to_one_with_its_published_mean_cosine(g):
    phase = phase_cornette_shanks(NU, np.float64(g))
    mean = g * 3.0 * (4.0 + g**2) / (5.0 * (2.0 + g**2))  # Cornette & Shanks (1992), equation 9
    assert integrate_phase(phase) == pytest.approx(1.0, abs=2e-4)
    assert integrate_phase(phase * NU) == pytest.approx(mean, abs=2e-4)


@given(st.floats(0.0, 0.5))
def test_rayleigh_integrates_to_one_and_its_sides_show_the_depolarisation(rho):
    phase = phase_rayleigh(NU, np.float64(rho))
    assert integrate_phase(phase) == pytest.approx(1.0, abs=1e-5)
    assert integrate_phase(phase * NU) == pytest.approx(0.0, abs=1e-12)
    # By definition of rho, the intensity at 90 deg is (1 + rho) against 2 forward.
    assert phase[SCATTERING_ANGLES // 2] / phase[0] == pytest.approx((1.0 + rho) / 2.0)


def test_rayleigh_without_depolarisation_is_three_over_sixteen_pi_of_one_plus_cosine_squared():
    expected = 3.0 / (16.0 * np.pi) * (1.0 + NU**2)
    np.testing.assert_allclose(phase_rayleigh(NU, np.float64(0.0)), expected, rtol=1e-15)


def test_double_henyey_greenstein_of_curiosity_has_its_published_mean_cosine():
    # Chen-Chen et al. (2019): 0.743, 0.889, 0.094 at 650 nm have a mean cosine of 0.687 +- 0.1.
    phase = DoubleHenyeyGreensteinPhase(constant(0.889), constant(0.094), constant(0.743))
    table = build_phase(phase, np.array([650.0]))[:, 0]
    assert integrate_phase(table * NU) == pytest.approx(0.687, abs=0.003)


def test_a_phase_function_follows_its_asymmetry_over_wavelength():
    phase = HenyeyGreensteinPhase(Spectrum("here", (400.0, 600.0), (0.8, 0.6)))
    table = build_phase(phase, np.array([600.0, 500.0]))
    np.testing.assert_allclose(integrate_phase(table * NU[:, None]), [0.6, 0.7], atol=1e-4)


def test_a_table_is_normalised_to_one_on_the_nodes():
    table = build_phase(mars_dust(), np.array([360.0, 437.0, 550.0, 830.0]))
    np.testing.assert_allclose(integrate_phase(table), 1.0, rtol=1e-13)


def test_a_table_that_misses_one_by_more_than_a_percent_is_refused():
    dust = mars_dust()
    double = tuple(tuple(1.02 * value for value in values) for values in dust.values)
    with pytest.raises(PresetError) as caught:
        build_phase(
            TabulatedPhase("a.toml: x", dust.angle, dust.wavelength, double), np.array([550.0])
        )
    assert str(caught.value).startswith(
        "a.toml: x: must integrate to 1 over the sphere within 1 %, "
    )
    assert str(caught.value).endswith(" at 550 nm")


def test_a_table_of_one_column_holds_at_all_wavelengths():
    flat = TabulatedPhase("here", (0.0, np.pi), (), ((0.25 / np.pi, 0.25 / np.pi),))
    np.testing.assert_allclose(build_phase(flat, np.array([1.0, 9e4])), 0.25 / np.pi, rtol=1e-12)


def test_a_table_is_refused_beyond_its_wavelengths():
    with pytest.raises(PresetError, match=r"must be within 350 to 1000 nm, got 349.9 nm$"):
        build_phase(mars_dust(), np.array([550.0, 349.9]))


def test_martian_dust_is_bluer_than_the_sun_only_close_to_it():
    # Irregular grains or not, diffraction is narrower in the blue: the glow of Martian sunsets.
    table = build_phase(mars_dust(), np.array([440.0, 680.0]))
    ratio = [
        0.788 / 0.972 * np.divide(*at_both)
        for at_both in zip(
            at(table[:, 0], [0.0, 2.0, 10.0, 60.0]),
            at(table[:, 1], [0.0, 2.0, 10.0, 60.0]),
            strict=True,
        )
    ]
    assert ratio[0] > 2.0
    assert ratio[1] > 1.5
    assert max(ratio[2:]) < 0.75


def test_sides_of_martian_dust_are_those_that_curiosity_measured_and_have_no_glory():
    # Chen-Chen et al. (2019) at 650 nm: 0.0252 per sr at 90 deg, twice that of spheres.
    table = build_phase(mars_dust(), np.array([650.0]))[:, 0]
    assert at(table, 90.0) == pytest.approx(0.0252, rel=0.1)
    beyond = table[np.radians(90.0) < ANGLES]
    assert np.all(np.diff(beyond) <= 0.0)


def test_mean_cosine_of_martian_dust_is_that_of_irregular_grains():
    # T-matrix, 440/550/680 nm; within the 0.03 that the blend with spheres may move it.
    table = build_phase(mars_dust(), np.array([440.0, 550.0, 680.0]))
    mean = integrate_phase(table * NU[:, None])
    np.testing.assert_allclose(mean, [0.766, 0.693, 0.700], atol=0.03)
