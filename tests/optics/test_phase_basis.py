import numpy as np
import pytest

from skybake.optics.medium import LANES, build_medium
from skybake.optics.phase import scattering_angles
from skybake.optics.phase_basis import TOLERANCE, build_phase_basis, pad_basis
from skybake.preset import load_preset
from skybake.sky.sky import WAVELENGTHS


def phase_of(preset):
    return build_medium(load_preset(preset), WAVELENGTHS).phase


@pytest.mark.parametrize("preset", ["earth", "mars"])
def test_a_basis_restores_each_phase_function(preset):
    phase = phase_of(preset)
    basis = build_phase_basis(phase, [[c] for c in range(len(phase))])
    restored = np.einsum("cwq,qa->caw", basis.weights, basis.curves)
    rms = np.sqrt(np.mean(phase**2, axis=2, keepdims=True))
    assert (np.abs(restored - phase) / rms).max() <= TOLERANCE * (1.0 + 1e-9)


def test_an_asymmetry_that_varies_with_wavelength_needs_few_curves():
    basis = build_phase_basis(phase_of("earth"), [[0], [1], [2]])
    assert basis.curves.shape[0] <= 8


def test_first_curve_is_one_for_light_without_a_phase_function():
    basis = build_phase_basis(phase_of("mars"), [[0], [1]])
    np.testing.assert_array_equal(basis.curves[0], 1.0)


def test_isotropic_scattering_needs_no_curve_of_its_own():
    isotropic = np.full((1, scattering_angles().size, 4), 0.25 / np.pi)
    basis = build_phase_basis(isotropic, [[0]])
    assert basis.curves.shape[0] <= 2
    restored = np.einsum("cwq,qa->caw", basis.weights, basis.curves)
    np.testing.assert_allclose(restored, isotropic, rtol=2e-3)


def test_curves_that_fill_up_a_vector_change_nothing():
    phase = phase_of("mars")
    basis = build_phase_basis(phase, [[0], [1]])
    padded = pad_basis(basis)
    assert len(padded.curves) % LANES == padded.weights.shape[2] % LANES == 0
    np.testing.assert_allclose(
        padded.weights @ padded.curves, basis.weights @ basis.curves, rtol=1e-13
    )
