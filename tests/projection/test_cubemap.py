import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.angles import zenith_azimuth
from skybake.projection import cubemap
from skybake.projection.cubemap import CROSS_ORIGINS, FACES

SUN_RADIUS = math.radians(0.2666)
AXES = {
    "px": (1, 0, 0),
    "nx": (-1, 0, 0),
    "py": (0, 1, 0),
    "ny": (0, -1, 0),
    "pz": (0, 0, 1),
    "nz": (0, 0, -1),
}
# OpenGL 4.6, table 8.19: which coordinates a face takes as sc and tc, over the major one.
OPENGL = {
    "px": lambda x, y, z: (-z / x, -y / x),
    "nx": lambda x, y, z: (z / -x, -y / -x),
    "py": lambda x, y, z: (x / y, z / y),
    "ny": lambda x, y, z: (x / -y, -z / -y),
    "pz": lambda x, y, z: (x / z, -y / z),
    "nz": lambda x, y, z: (-x / -z, -y / -z),
}


def disc(face, edge, elevation, bearing, radius=SUN_RADIUS):
    chart = cubemap.FaceChart(face, edge)
    return chart.disc_cells(math.radians(90.0 - elevation), bearing, radius)


def test_faces_come_in_the_order_of_opengl():
    assert FACES == ("px", "nx", "py", "ny", "pz", "nz")


@pytest.mark.parametrize("face", FACES)
def test_directions_of_a_face_are_opengls(face):
    edge = 16
    vectors = cubemap.face_directions(face, edge)
    np.testing.assert_allclose(np.linalg.norm(vectors, axis=-1), 1.0, rtol=1e-14)
    s, t = OPENGL[face](*np.moveaxis(vectors, -1, 0))
    centre = (2.0 * np.arange(edge) + 1.0) / edge - 1.0
    np.testing.assert_allclose(s, np.broadcast_to(centre, (edge, edge)), atol=1e-14)
    np.testing.assert_allclose(t, np.broadcast_to(centre[:, None], (edge, edge)), atol=1e-14)


@pytest.mark.parametrize("face", FACES)
def test_middle_of_a_face_looks_along_its_axis(face):
    assert cubemap.face_directions(face, 1)[0, 0] == pytest.approx(AXES[face])


@pytest.mark.parametrize("face", FACES)
def test_a_band_of_rows_is_that_band_of_the_face(face):
    whole = cubemap.face_directions(face, 12)
    np.testing.assert_array_equal(cubemap.FaceChart(face, 12).vectors(5, 9), whole[5:9])


@pytest.mark.parametrize("edge", [1, 2, 16, 333])
def test_solid_angles_of_six_faces_sum_to_4_pi(edge):
    assert 6.0 * cubemap.solid_angles(edge).sum() == pytest.approx(4.0 * math.pi, rel=1e-11)


def test_solid_angle_of_a_small_texel_is_its_area_seen_from_the_centre():
    edge = 512
    u = (2.0 * np.arange(edge) + 1.0) / edge - 1.0
    flat = (2.0 / edge) ** 2 / (1.0 + u**2 + u[:, None] ** 2) ** 1.5
    np.testing.assert_allclose(cubemap.solid_angles(edge), flat, rtol=1e-5)


@given(st.floats(0.0, math.pi), st.floats(-math.pi, math.pi))
def test_zenith_and_bearing_restore_the_direction(zenith, bearing):
    vector = np.array(
        [
            math.sin(zenith) * math.sin(bearing),
            math.cos(zenith),
            -math.sin(zenith) * math.cos(bearing),
        ]
    )
    theta, phi = zenith_azimuth(vector)
    assert theta == pytest.approx(zenith, abs=1e-12)
    back = [math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi)]
    assert back == pytest.approx(vector, abs=1e-12)


@pytest.mark.parametrize(
    ("elevation", "bearing"),
    [(90.0, 0.0), (0.0, math.pi), (30.0, 1.0), (45.0, math.pi / 2), (-35.26439, math.pi / 4)],
)
@pytest.mark.parametrize("edge", [4, 16, 256])
def test_disc_keeps_its_flux_over_all_faces(edge, elevation, bearing):
    """Across edges and on a corner of the cube too (45 deg east, 35.26 deg south-east)."""
    flux = np.zeros(3)
    cap = 0.0
    for face in FACES:
        cells = disc(face, edge, elevation, bearing)
        assert np.isfinite(cells.weight).all()
        texel = cells.texel[:, 0]
        size = cubemap.solid_angles(edge).ravel()[texel]
        vectors = cubemap.face_directions(face, edge).reshape(-1, 3)[texel]
        flux += (cells.weight[:, 0] * cells.solid_angle * size) @ vectors
        cap += cells.solid_angle.sum()
    sun = math.radians(90.0 - elevation)
    expected = cap * np.array(
        [
            math.sin(sun) * math.sin(bearing),
            math.cos(sun),
            -math.sin(sun) * math.cos(bearing),
        ]
    )
    assert cap == pytest.approx(4.0 * math.pi * math.sin(SUN_RADIUS / 2.0) ** 2, rel=5e-4)
    # A texel shines from its centre: off by no more than its own half diagonal.
    assert np.abs(flux - expected).max() < cap * min(1.0, 1.5 / edge)


@given(st.floats(-90.0, 90.0), st.floats(0.0, 2.0 * math.pi))
def test_disc_of_any_place_is_whole(elevation, bearing):
    cap = sum(disc(face, 64, elevation, bearing).solid_angle.sum() for face in FACES)
    assert cap == pytest.approx(4.0 * math.pi * math.sin(SUN_RADIUS / 2.0) ** 2, rel=5e-4)


def test_a_disc_behind_a_face_leaves_it_untouched():
    assert disc("nz", 64, 30.0, math.pi).distance.size == 0


def test_faces_meet_at_the_edges_of_the_cross():
    """Neighbours in the cross are neighbours in the sky: steps across folds are small."""
    edge = 64
    cross = np.full((3 * edge, 4 * edge, 3), np.nan)
    for face, (row, column) in CROSS_ORIGINS.items():
        block = np.s_[row * edge : (row + 1) * edge, column * edge : (column + 1) * edge]
        cross[block] = cubemap.face_directions(face, edge)
    for axis in (0, 1):
        step = np.linalg.norm(np.diff(cross, axis=axis), axis=-1)
        assert np.nanmax(step) < 2.0 / edge * 1.01


@pytest.mark.parametrize("face", cubemap.FACES)
def test_angles_of_a_face_are_those_of_its_directions(face):
    chart = cubemap.FaceChart(face, 12)
    zenith, bearing = chart.angles(2, 11)
    expected_zenith, expected_bearing = zenith_azimuth(chart.vectors(2, 11))
    np.testing.assert_allclose(zenith, expected_zenith, rtol=0.0, atol=1e-14)
    turn = np.exp(1j * (bearing - expected_bearing))
    np.testing.assert_allclose(turn, 1.0, rtol=0.0, atol=1e-14)
    assert bearing.shape == ((9, 12) if face in {"py", "ny"} else (1, 12))
