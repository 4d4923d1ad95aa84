"""Stokes parameters that `probe` prints."""

import csv
import io
import math

import numpy as np
import pytest

from skybake.errors import InputError
from skybake.inspect.polarised import polarisation_warning
from skybake.inspect.probe import probe, read_directions
from skybake.preset import load_preset
from tests.cli.runs import invoke

VIEWS = read_directions("x", ["view_zenith_deg,relative_azimuth_deg", "45,90", "45,-90", "45,180"])


def probed(preset="jupiter", method="full", **options):
    text = probe(
        load_preset(preset),
        VIEWS,
        sun_elevation=math.radians(10.0),
        wavelengths=np.array([550.0]),
        per_irradiance=True,
        with_stokes=True,
        method=method,
        **options,
    )
    return list(csv.DictReader(io.StringIO(text)))


def numbers(rows, name):
    return np.array([float(row[f"{name}_550nm"]) for row in rows])


def test_solver_and_path_tracer_print_the_same_light():
    solved, traced = probed(), probed(method="reference", samples=1000)
    np.testing.assert_allclose(numbers(solved, "i"), numbers(solved, "radiance"), rtol=1e-6)
    for name in "iqu":
        error = numbers(solved, name) - numbers(traced, name)
        assert (np.abs(error) < 5.0 * numbers(traced, f"stderr_{name}") + 1e-9).all()
    assert (numbers(solved, "v") == 0.0).all()
    q, u = numbers(solved, "q"), numbers(solved, "u")
    assert u[0] == pytest.approx(-u[1])
    # Clockwise of the sun it is to the left, and a little higher along the great circle.
    assert u[0] < -0.1 * numbers(solved, "i")[0]
    assert abs(u[2]) < 1e-6
    degree = numbers(solved, "polarisation_degree")
    np.testing.assert_allclose(degree, np.hypot(q, u) / numbers(solved, "i"), rtol=1e-5)
    angle = np.radians(numbers(solved, "polarisation_angle_deg"))
    np.testing.assert_allclose(np.tan(2.0 * angle[:2]), (u / q)[:2], rtol=1e-4)


@pytest.mark.parametrize(
    ("preset", "method", "fault"),
    [
        ("earth", "hillaire", "polarisation: method must be full or reference, got hillaire"),
        ("earth-overcast", "full", "clouds: polarisation is known of clear skies only"),
    ],
)
def test_what_has_no_polarisation_is_refused(preset, method, fault):
    with pytest.raises(InputError, match=fault):
        probed(preset, method)


def test_constituents_without_a_matrix_are_named_once():
    assert polarisation_warning(load_preset("earth")) is None
    warning = polarisation_warning(load_preset("mars"))
    assert warning == "no scattering matrix is known of dust: taken to polarise no light"
    result = invoke("probe", "--preset", "mars", "--stokes", "--method", "march")
    assert result.exit_code == 1
    assert result.output.count("no scattering matrix") == 1
    assert "polarisation: method must be full or reference, got march" in result.output
