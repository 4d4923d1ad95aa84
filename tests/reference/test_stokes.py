"""Stokes vectors by the path tracer."""

import math

import numpy as np
import pytest

from skybake.errors import InputError
from skybake.reference.estimate import radiance
from skybake.reference.stokes import stokes
from tests.media import plain_medium
from tests.truth import load_vector_truth, vector_medium

BLUE = 2


def one_wavelength(medium, k):
    return medium._replace(
        scattering=medium.scattering[:, k : k + 1],
        extinction=medium.extinction[:, k : k + 1],
        phase=medium.phase[..., k : k + 1],
        matrix=medium.matrix[..., k : k + 1],
        ground_albedo=medium.ground_albedo[k : k + 1],
    )


@pytest.mark.parametrize(
    ("name", "elevation", "samples"),
    [
        ("RAY", 60.0, 1000),
        pytest.param("RAYMIE", 10.0, 20_000, marks=pytest.mark.slow),
        pytest.param("RAY", 0.0, 20_000, marks=pytest.mark.slow),
    ],
)
def test_it_agrees_with_another_program_within_their_errors(name, elevation, samples):
    table = load_vector_truth(name)
    rows = table[
        (table["sun_elevation_deg"] == elevation)
        & (table["wavelength_nm"] == 440.0)
        & (table["view_zenith_deg"] > 0.0)
    ][::9]
    directions = np.radians(rows["view_zenith_deg"]), np.radians(rows["relative_azimuth_deg"])
    medium = one_wavelength(vector_medium(name), BLUE)
    sun = math.radians(elevation)
    mean, error = stokes(medium, 0.001, sun, *directions, samples=samples, seed=4)
    assert (mean[:, 3] == 0.0).all()
    for i, element in enumerate("IQU"):
        both = np.hypot(error[:, i, 0], rows[f"stderr_{element}"])
        score = (mean[:, i, 0] - rows[element]) / both
        assert np.abs(score).max() < 4.5
        assert np.mean(score**2) < 2.2
    assert np.abs(rows["U"]).max() > 20.0 * error[:, 2].max()


def test_a_world_without_matrices_has_no_polarisation():
    with pytest.raises(InputError, match="must have scattering matrices, got none"):
        stokes(plain_medium(extinction=0.01), 0.0, 0.5, 0.1, 0.0, samples=32)


def test_intensity_without_matrices_is_that_of_unpolarised_light():
    """An element of 0 everywhere but P11 leaves nothing of polarisation."""
    medium = one_wavelength(vector_medium("RAY"), BLUE)
    medium = medium._replace(matrix=0.0 * medium.matrix)
    view = 0.0, 0.4, np.radians([20.0, 70.0]), 0.0
    mean, _ = stokes(medium, *view, samples=64, seed=9)
    plain, _ = radiance(medium, *view, samples=64, seed=9)
    np.testing.assert_allclose(mean[:, 0], plain, rtol=1e-12)
    np.testing.assert_array_equal(mean[:, 1:], 0.0)
