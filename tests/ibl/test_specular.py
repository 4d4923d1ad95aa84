"""Rough mirrors show what an integral over all light gives, without seams."""

import numpy as np
import pytest

from skybake.ibl.cube import SPACES, coarser, in_space, pyramid, with_borders
from skybake.ibl.points import no_points
from skybake.ibl.specular import SpecularFilter
from skybake.projection.cubemap import FACES, FaceChart
from tests.ibl.maps import directions, gradient, lobe_mean, sizes


@pytest.fixture(scope="module")
def source():
    return gradient(128)


@pytest.mark.parametrize("roughness", [1 / 6, 0.5, 1.0])
def test_a_filtered_texel_is_the_integral_over_its_lobe(source, roughness):
    edge = 16
    shown = SpecularFilter(source, no_points()).cube(edge, roughness, 1024).reshape(-1, 3)
    normals = directions(edge)
    chosen = np.arange(0, len(normals), 61)
    expected = np.array([lobe_mean(source, normals[i], roughness) for i in chosen])
    assert np.abs(shown[chosen] / expected - 1.0).max() < 0.015
    assert np.sqrt(np.mean((shown[chosen] / expected - 1.0) ** 2)) < 0.004


@pytest.mark.parametrize("roughness", [1 / 6, 1 / 3, 1.0])
def test_no_level_has_seams_at_the_edges_of_faces(roughness):
    noise = np.random.default_rng(1).random((6, 64, 64, 3)).astype(np.float32)
    edge = 32
    shown = SpecularFilter(noise, no_points()).cube(edge, roughness, 256)
    padded = with_borders(shown)
    within = np.abs(np.diff(shown, axis=1)).mean(), np.abs(np.diff(shown, axis=2)).mean()
    across = [
        np.abs(padded[:, 1, 1:-1] - padded[:, 0, 1:-1]),
        np.abs(padded[:, -1, 1:-1] - padded[:, -2, 1:-1]),
        np.abs(padded[:, 1:-1, 1] - padded[:, 1:-1, 0]),
        np.abs(padded[:, 1:-1, -1] - padded[:, 1:-1, -2]),
    ]
    assert np.mean(across) < 1.25 * np.mean(within)


def test_borders_are_the_texels_beyond_an_edge():
    edge = 8
    place = directions(edge).reshape(6, edge, edge, 3).astype(np.float32)
    padded = with_borders(place)
    texel = np.linalg.norm(place[0, 3, 4] - place[0, 3, 3])
    for line, beside in (
        (padded[:, 0, 1:-1], padded[:, 1, 1:-1]),
        (padded[:, -1, 1:-1], padded[:, -2, 1:-1]),
        (padded[:, 1:-1, 0], padded[:, 1:-1, 1]),
        (padded[:, 1:-1, -1], padded[:, 1:-1, -2]),
    ):
        assert np.linalg.norm(line - beside, axis=-1).max() < 1.2 * texel


def test_coarser_cubes_keep_all_light(source):
    weights = sizes(128)
    whole = weights @ source.reshape(-1, 3)
    for level in pyramid(source):
        total = sizes(level.shape[1]) @ level.reshape(-1, 3).astype(float)
        assert total == pytest.approx(whole, rel=1e-6)
    assert np.array_equal(coarser(source, 128), source)


@pytest.mark.parametrize("space", SPACES)
def test_cubes_in_other_spaces_hold_what_their_charts_show(space):
    edge = 4
    place = directions(edge).reshape(6, edge, edge, 3).astype(np.float32)
    turned = in_space(place, space)
    for face, shown in zip(FACES, turned, strict=True):
        assert shown == pytest.approx(FaceChart(face, edge, space).vectors(0, edge), abs=1e-6)
