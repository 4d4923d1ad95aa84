import numpy as np
import OpenImageIO
import pytest

from skybake.formats.shrink import Shrinking, shrunk
from tests.formats.maps import sky


@pytest.mark.parametrize("band", [1, 7, 256, 10_000])
@pytest.mark.parametrize("size", [(300, 150), (257, 129), (100, 700), (1025, 3)])
def test_bands_make_the_same_picture_as_the_whole(size, band):
    pixels = sky(*size)
    whole = OpenImageIO.ImageBuf(pixels)
    width, height = 100, max(1, round(size[1] * 100 / size[0]))
    roi = OpenImageIO.ROI(0, width, 0, height, 0, 1, 0, 3)
    expected = OpenImageIO.ImageBufAlgo.resize(whole, filtername="triangle", roi=roi)
    shrinking = Shrinking(*size, 100)
    for first in range(0, size[1], band):
        shrinking.add(pixels[first : first + band])
    if size[0] == 100:
        np.testing.assert_array_equal(shrinking.result(), pixels)
    else:
        np.testing.assert_array_equal(shrinking.result(), expected.get_pixels(OpenImageIO.FLOAT))
    np.testing.assert_array_equal(shrunk(pixels, 100), shrinking.result())
