import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.angles import direction_from_angles, zenith_azimuth
from skybake.errors import InputError
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


@pytest.mark.parametrize(("space", "signs"), [("flip-x", (-1, 1, 1)), ("flip-z", (1, 1, -1))])
@pytest.mark.parametrize("face", FACES)
def test_a_mirrored_cube_shows_the_world_with_one_axis_negated(face, space, signs):
    flipped, direct = cubemap.FaceChart(face, 8, space), cubemap.FaceChart(face, 8)
    np.testing.assert_array_equal(flipped.vectors(0, 8), direct.vectors(0, 8) * signs)
    zenith, bearing = flipped.angles(0, 8)
    turned = direction_from_angles(bearing, math.pi / 2.0 - zenith)
    np.testing.assert_allclose(turned, flipped.vectors(0, 8), atol=1e-15)
    np.testing.assert_array_equal(flipped.solid_angles(0, 8), direct.solid_angles(0, 8))
    row, column = flipped.places(flipped.vectors(0, 8))
    np.testing.assert_allclose(row, np.broadcast_to(np.arange(8)[:, None] + 0.5, (8, 8)))
    np.testing.assert_allclose(column, np.broadcast_to(np.arange(8) + 0.5, (8, 8)))


@pytest.mark.parametrize("space", ["flip-x", "flip-z"])
def test_a_disc_is_whole_in_a_mirrored_cube(space):
    """Across an edge of the cube."""
    zenith, bearing = math.radians(60.0), math.radians(45.0)
    toward = direction_from_angles(bearing, math.pi / 2.0 - zenith)
    cap, flux = 0.0, np.zeros(3)
    for face in FACES:
        chart = cubemap.FaceChart(face, 64, space)
        cells = chart.disc_cells(zenith, bearing, SUN_RADIUS)
        cap += cells.solid_angle.sum()
        vectors = chart.vectors(0, 64).reshape(-1, 3)[cells.texel[:, 0]]
        flux += cells.solid_angle @ vectors
    assert cap == pytest.approx(4.0 * math.pi * math.sin(SUN_RADIUS / 2.0) ** 2, rel=5e-4)
    assert flux / cap == pytest.approx(toward, abs=0.02)


@pytest.mark.parametrize("style", cubemap.FACE_NAMES)
def test_a_style_of_names_is_that_of_its_first(style):
    names = cubemap.parse_face_names(style)
    assert names[0] == style
    assert len(set(names)) == 6
    assert cubemap.parse_face_names(",".join(names)) == names


@pytest.mark.parametrize(
    "text",
    [
        "",
        "py",
        "a,b,c,d,e",
        "a,b,c,d,e,f,g",
        "a,a,c,d,e,f",
        "a,A,c,d,e,f",
        "a,b,c,d,e,",
        "a/,b,c,d,e,f",
    ],
)
def test_other_names_are_refused(text):
    with pytest.raises(InputError, match="face-names: must be px, posx, "):
        cubemap.parse_face_names(text)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"space": "flip-y"}, "cube-space: must be one of world, flip-x, flip-z, got 'flip-y'"),
        ({"layout": "exr", "space": "flip-x"}, "cube-space: must be world for the cube layout exr"),
        ({"layout": "cross", "face_names": "posx"}, "face-names: must belong to the cube layout"),
    ],
)
def test_what_no_reader_expects_is_refused(options, message):
    with pytest.raises(InputError, match=message):
        cubemap.Cubemap(4, **options)
