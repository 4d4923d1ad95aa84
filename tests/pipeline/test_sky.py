"""Skies that show themselves."""

import io
import math

import numpy as np
import pytest
from PIL import Image as Picture

import skybake
from skybake.errors import InputError


@pytest.fixture(scope="module")
def sky():
    return skybake.Sky("earth", sun_elevation=math.radians(20.0))


@pytest.mark.parametrize(
    ("projection", "size", "values", "shape"),
    [
        ("equirect", 64, {}, (32, 64, 3)),
        ("cubemap", 16, {}, (6, 16, 16, 3)),
        ("cubemap", 16, {"layout": "cross"}, (48, 64, 3)),
        ("fisheye", 32, {"fov": math.pi}, (32, 32, 3)),
        ("perspective", (64, 36), {"fov": 1.0, "azimuth": 0.5, "elevation": 0.1}, (36, 64, 3)),
        (skybake.Equirect(32), None, {"units": "nits"}, (16, 32, 3)),
    ],
)
def test_an_image_has_the_shape_of_its_projection_and_shows_itself(
    sky, projection, size, values, shape
):
    image = sky.image(projection, size, **values)
    assert image.pixels.shape == shape
    assert image.pixels.dtype == np.float32
    assert np.isfinite(image.pixels).all()
    shown = np.asarray(Picture.open(io.BytesIO(image._repr_png_())))
    rows = shape[-3] if len(shape) == 3 else 3 * shape[1]
    assert shown.shape == (rows, shape[-2] if len(shape) == 3 else 4 * shape[2], 3)
    # Legible: neither black nor white.
    assert 10 < np.median(shown[shown.sum(axis=2) > 0]) < 220
    assert shown.max() > 150


def test_all_projections_show_the_same_sky(sky):
    """Illuminance of a horizontal plane by the texels above it, in lux."""
    for projection, size in (("equirect", 256), ("cubemap", 256), ("fisheye", 256)):
        image = sky.image(projection, size, units="nits", colorspace="xyz")
        pictures = image.pixels if image.pixels.ndim == 4 else image.pixels[None]
        total = 0.0
        for canvas, pixels in zip(image.projection.canvases(), pictures, strict=True):
            chart = canvas.parts[0].chart
            zenith, _ = chart.angles(0, canvas.height)
            size_of = chart.solid_angles(0, canvas.height) * np.maximum(np.cos(zenith), 0.0)
            total += float((pixels[..., 1] * size_of).sum())
        expected = image.light.sky_illuminance + image.light.direct_illuminance
        assert total == pytest.approx(expected, rel=5e-3), projection


def test_a_sky_shows_itself_in_a_notebook(sky):
    shown = Picture.open(io.BytesIO(sky._repr_png_()))
    assert shown.size == (512, 256)


def test_an_image_of_a_sky_is_that_of_the_command_with_the_same_options(sky, tmp_path):
    settings = skybake.map_settings(size=64, sun_elevation=math.radians(20.0), pixel="float")
    skybake.bake("earth", tmp_path / "a.exr", settings)
    from skybake.formats.reader import read_image

    np.testing.assert_array_equal(sky.image(width=64).pixels, read_image(tmp_path / "a.exr")[0])


def test_an_attribute_that_a_projection_has_not_is_refused(sky):
    with pytest.raises(InputError, match="fov"):
        sky.image("equirect", 64, fov=1.0)
