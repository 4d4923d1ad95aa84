import numpy as np
import pytest

from skybake.formats.half import half_rows


def test_halves_are_rounded_as_numpy_rounds_them():
    """All halves, the middles between them with their neighbours, and random bits."""
    halves = np.arange(0, 0x7C00, dtype=np.uint16).view(np.float16).astype(np.float32)
    middles = 0.5 * (halves[1:] + halves[:-1])
    largest = np.nextafter(np.float32(65520.0), np.float32(0.0))
    bits = np.random.default_rng(3).integers(0, 2**32, 1_000_000, dtype=np.uint64)
    noise = bits.astype(np.uint32).view(np.float32)
    noise = noise[np.abs(noise) <= largest]
    above, below = (np.nextafter(middles, np.float32(end)) for end in (np.inf, 0.0))
    values = np.concatenate([halves, middles, above, below, [1e-45, largest], noise])
    values = np.concatenate([values, -values]).astype(np.float32).reshape(1, -1, 1)
    expected = values.astype(np.float16)
    assert np.isfinite(expected).all()
    np.testing.assert_array_equal(
        half_rows(values)[0].view(np.uint16), expected.view(np.uint16), strict=True
    )


def test_rows_keep_their_places():
    values = np.arange(70 * 3 * 4, dtype=np.float32).reshape(70, 3, 4)
    halves, _ = half_rows(values[::2, ::-1])
    np.testing.assert_array_equal(halves, values[::2, ::-1])
    assert halves.dtype == np.float16
    assert half_rows(values[:0])[0].shape == (0, 3, 4)


@pytest.mark.parametrize("value", [70000.0, -70000.0, 3.5, -3.5, 0.0, np.inf, -np.inf, np.nan])
def test_the_largest_magnitude_is_told(value):
    values = np.zeros((70, 3, 4), np.float32)
    values[66, 1, 2] = value
    assert half_rows(values)[1] == pytest.approx(abs(value), nan_ok=True)
