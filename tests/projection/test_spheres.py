"""Angular and octahedral maps, and crosses: where pixels look, and discs that keep their flux."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skybake.angles import direction_from_angles
from skybake.errors import InputError
from skybake.projection import Angular, Cubemap, Octahedral, find_projection
from skybake.projection.angular import AngularChart
from skybake.projection.octahedral import OctahedralChart

SUN_RADIUS = math.radians(0.2666)
NORTH, EAST, SOUTH, WEST = (0, 0, -1), (1, 0, 0), (0, 0, 1), (-1, 0, 0)
UP, DOWN = (0, 1, 0), (0, -1, 0)
CHARTS = [AngularChart, OctahedralChart]


def vectors(chart):
    zenith, bearing = np.broadcast_arrays(*chart.angles(0, chart.height))
    return direction_from_angles(bearing, math.pi / 2.0 - zenith)


def degrees_between(a, b):
    a, b = (np.asarray(each, float) / np.linalg.norm(each) for each in (a, b))
    return math.degrees(2.0 * math.asin(min(0.5 * float(np.linalg.norm(a - b)), 1.0)))


def test_an_angular_map_looks_where_debevec_has_it():
    """(0, 0, -1) turned by pi times the radius about +Y, then by the polar angle about -Z."""
    edge = 64
    seen = vectors(AngularChart(edge))
    place = (2.0 * np.arange(edge) + 1.0) / edge - 1.0
    u, v = place[None], -place[:, None]
    a, t = math.pi * np.hypot(u, v), np.arctan2(v, u)
    expected = np.stack([np.sin(a) * np.cos(t), np.sin(a) * np.sin(t), -np.cos(a)], axis=-1)
    within = np.hypot(u, v) < 1.0
    np.testing.assert_allclose(seen[within], expected[within], atol=1e-12)


@pytest.mark.parametrize(
    ("chart", "row", "column", "axis"),
    [
        (AngularChart, 0.5, 0.5, NORTH),
        (AngularChart, 0.5, 0.75, EAST),
        (AngularChart, 0.5, 0.25, WEST),
        (AngularChart, 0.25, 0.5, UP),
        (AngularChart, 0.75, 0.5, DOWN),
        (AngularChart, 0.5, 0.999, SOUTH),
        (AngularChart, 0.5, 0.001, SOUTH),
        (OctahedralChart, 0.5, 0.5, UP),
        (OctahedralChart, 0.5, 0.999, EAST),
        (OctahedralChart, 0.5, 0.001, WEST),
        (OctahedralChart, 0.001, 0.5, NORTH),
        (OctahedralChart, 0.999, 0.5, SOUTH),
        (OctahedralChart, 0.001, 0.001, DOWN),
        (OctahedralChart, 0.999, 0.999, DOWN),
        (OctahedralChart, 0.25, 0.75, (1, 0, -1)),
    ],
)
def test_places_of_the_axes(chart, row, column, axis):
    edge = 256
    seen = vectors(chart(edge))[int(row * edge), int(column * edge)]
    assert degrees_between(seen, axis) < 3.0 * 2.0 / edge * math.degrees(1.0)


def test_an_octahedral_map_unfolds_the_sides_of_an_octahedron():
    """Cigolle et al. (2014), listing 2, with our +Y for their +Z."""
    edge = 32
    for direction, row, column in zip(
        vectors(OctahedralChart(edge)).reshape(-1, 3),
        np.repeat(np.arange(edge), edge),
        np.tile(np.arange(edge), edge),
        strict=True,
    ):
        x, up, y = direction / np.abs(direction).sum()
        if up <= 0.0:
            x, y = (1.0 - abs(y)) * math.copysign(1.0, x), (1.0 - abs(x)) * math.copysign(1.0, y)
        expected = (2 * column + 1) / edge - 1.0, (2 * row + 1) / edge - 1.0
        assert (x, y) == pytest.approx(expected, abs=1e-12)


def test_places_of_an_octahedral_map_are_those_of_its_pixels():
    chart = OctahedralChart(50)
    row, column = chart.places(vectors(chart))
    np.testing.assert_allclose(column, np.tile(np.arange(50) + 0.5, (50, 1)), atol=1e-9)
    np.testing.assert_allclose(row, column.T, atol=1e-9)


@pytest.mark.parametrize("chart", CHARTS)
def test_solid_angles_make_the_sphere(chart):
    assert chart(128).solid_angles(0, 128).sum() == pytest.approx(4.0 * math.pi, rel=5e-5)


@pytest.mark.parametrize("chart", CHARTS)
def test_solid_angles_are_those_between_neighbours(chart):
    """Away from folds and the rim, of the parallelogram that the steps to the neighbours span."""
    made = chart(200)
    seen = vectors(made)
    down, right = np.gradient(seen, axis=(0, 1))
    area = np.linalg.norm(np.cross(right, down), axis=-1)
    u, v = (np.abs(2.0 * each / 200 - 1.0) for each in np.mgrid[0.5:200, 0.5:200])
    smooth = np.minimum(np.minimum(u, v), 0.99 - np.maximum(u, v)) > 0.02
    smooth &= np.hypot(u, v) < 0.97 if chart is AngularChart else np.abs(1.0 - u - v) > 0.03
    assert smooth.mean() > 0.5
    size = made.solid_angles(0, 200)
    np.testing.assert_allclose(area[smooth], size[smooth], rtol=0.01)


@pytest.mark.parametrize("chart", CHARTS)
def test_footprints_are_the_steps_of_the_zenith_angle_between_pixels(chart):
    made = chart(256)
    zenith, _ = made.angles(0, 256)
    u, v = (np.abs(2.0 * each / 256 - 1.0) for each in np.mgrid[0.5:256, 0.5:256])
    smooth = (zenith > 0.3) & (zenith < math.pi - 0.3)
    smooth &= np.minimum(np.minimum(u, v), 1.0 - np.maximum(u, v)) > 0.03
    smooth &= np.hypot(u, v) < 0.95 if chart is AngularChart else np.abs(1.0 - u - v) > 0.03
    assert smooth.mean() > 0.5
    across, along = np.gradient(zenith)
    expected = np.hypot(across, along)[smooth]
    np.testing.assert_allclose(made.footprints(0, 256)[smooth], expected, rtol=0.05)


@pytest.mark.parametrize("chart", CHARTS)
def test_a_band_of_rows_is_that_band_of_the_map(chart):
    made = chart(24)
    for whole, band in zip(made.angles(0, 24), made.angles(5, 9), strict=True):
        np.testing.assert_array_equal(whole[5:9], band)
    for part in (made.footprints, made.solid_angles):
        np.testing.assert_array_equal(part(0, 24)[5:9], part(5, 9))


# On folds, on the rim, at corners and elsewhere; in an angular map south is all of the rim.
PLACES = [
    (90.0, 0.0),
    (30.0, 180.0),
    (0.0, 180.0),
    (0.1, 179.9),
    (-10.0, 180.0),
    (-10.0, 90.0),
    (-90.0, 50.0),
    (-89.9, 120.0),
    (10.0, 57.0),
    (0.0, 0.0),
    (35.26, 45.0),
]


def check_disc(made, elevation, bearing, radius):
    edge = made.width
    cells = made.disc_cells(math.radians(90.0 - elevation), math.radians(bearing), radius)
    cap = 4.0 * math.pi * math.sin(0.5 * radius) ** 2
    assert cells.solid_angle.sum() == pytest.approx(cap, rel=1.5e-3)
    texel, size = cells.texel[:, 0], made.solid_angles(0, edge).ravel()
    flux = cells.weight[:, 0] * cells.solid_angle * size[texel]
    assert flux.sum() == pytest.approx(cells.solid_angle.sum(), rel=1e-6)
    centre = flux @ vectors(made).reshape(-1, 3)[texel] / flux.sum()
    place = direction_from_angles(math.radians(bearing), math.radians(elevation))
    assert degrees_between(centre, place) < 1.5 * 360.0 / edge
    return np.bincount(texel, cells.weight[:, 0] * cells.solid_angle, edge * edge)


@pytest.mark.parametrize(("elevation", "bearing"), PLACES)
@pytest.mark.parametrize("radius", [SUN_RADIUS, math.radians(5.0)])
@pytest.mark.parametrize("chart", CHARTS)
def test_a_disc_keeps_its_flux_and_its_place(chart, radius, elevation, bearing):
    check_disc(chart(256), elevation, bearing, radius)


@settings(max_examples=30)
@given(st.floats(-90.0, 90.0), st.floats(0.0, 360.0))
@pytest.mark.parametrize("chart", CHARTS)
def test_a_disc_of_any_place_is_whole(chart, elevation, bearing):
    check_disc(chart(64), elevation, bearing, math.radians(1.0))


@pytest.mark.parametrize(("elevation", "bearing"), [each for each in PLACES if each[1] < 150.0])
@pytest.mark.parametrize("chart", CHARTS)
def test_an_even_disc_is_even(chart, elevation, bearing):
    """Of radiance 1 in every pixel that it covers."""
    values = check_disc(chart(512), elevation, bearing, math.radians(5.0))
    assert values.max() == pytest.approx(1.0, abs=2e-3)
    assert (values > 0.99).sum() > 0.6 * (values > 0.0).sum()


def test_neighbours_in_a_vertical_cross_are_neighbours_in_the_sky():
    edge = 32
    (canvas,) = Cubemap(edge, "vertical-cross").canvases()
    assert (canvas.width, canvas.height) == (3 * edge, 4 * edge)
    cross = np.full((4 * edge, 3 * edge, 3), np.nan)
    for part in canvas.parts:
        face = part.chart.vectors(0, edge)
        if part.flip is not None:
            assert part.flip == "both"
            face = face[::-1, ::-1]
        cross[part.row : part.row + edge, part.column : part.column + edge] = face
    for axis in (0, 1):
        step = np.linalg.norm(np.diff(cross, axis=axis), axis=-1)
        assert np.nanmax(step) < 2.0 / edge * 1.01
    middle = edge + edge // 2
    assert degrees_between(cross[middle, middle], SOUTH) < 3.0
    assert degrees_between(cross[edge // 2, middle], UP) < 3.0
    assert degrees_between(cross[-edge // 2, middle], NORTH) < 3.0


@pytest.mark.parametrize(
    ("name", "size", "options", "fault"),
    [
        ("angular", (64, 32), {}, "square"),
        ("angular", (2,), {}, "size"),
        ("octahedral", (64, 32), {}, "square"),
        ("octahedral", (64,), {"layout": "cross"}, "layout"),
        ("equirect", (64,), {"rows": "edges"}, "edges"),
    ],
)
def test_a_shape_that_a_projection_has_not_is_refused(name, size, options, fault):
    with pytest.raises(InputError, match=fault):
        find_projection(name, size, options)


@pytest.mark.parametrize("kind", [Angular, Octahedral])
def test_a_square_map_is_reduced_and_glanced_at(kind):
    assert kind(2048).smaller(512) == kind(512)
    assert kind(256).smaller(512) == kind(256)
    assert kind(256).glance(64).name == "equirect"
