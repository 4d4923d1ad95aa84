"""Text can be drawn wherever OpenImageIO's wheel is."""

import numpy as np
import pytest

from skybake.formats.lettering import draw_text, text_width


def _drawn(text, x=5, baseline=30, size=20, shape=(40, 300, 3)):
    pixels = np.zeros(shape, np.uint8)
    draw_text(pixels, text, x, baseline, size, (1.0, 0.5, 0.0))
    return pixels


def test_letters_stand_on_the_baseline_at_the_left_edge_in_their_width_and_colour():
    rows, columns = np.nonzero(_drawn("HEH")[..., 0] > 128)
    assert abs(columns.min() - 5) <= 3
    assert abs(columns.max() - (5 + text_width("HEH", 20))) <= 3
    assert abs(rows.max() - 30) <= 1
    assert _drawn("HEH").reshape(-1, 3).max(axis=0).tolist() == [255, 128, 0]


def test_width_goes_with_the_size():
    assert text_width("sun +12.3", 40) == pytest.approx(2 * text_width("sun +12.3", 20), rel=0.05)


@pytest.mark.parametrize("text", ["°", "é", "ü", "+", "·"])
def test_the_font_has_what_labels_need(text):
    assert _drawn(text).any()


def test_a_true_minus_is_drawn_as_a_hyphen():
    np.testing.assert_array_equal(_drawn("el \u22125°"), _drawn("el -5°"))


@pytest.mark.parametrize("text", ["", " ", "東京", "a\nb"])
def test_text_without_letters_does_no_harm(text):
    assert _drawn(text).shape == (40, 300, 3)
    assert text_width(text, 20) >= 0


def test_text_outside_is_left_out():
    assert not _drawn("sun", x=2000).any()
    assert not _drawn("sun", baseline=-100).any()


def test_a_part_of_a_picture_can_be_drawn_into():
    pixels = np.zeros((80, 100, 3), np.uint8)
    draw_text(pixels[40:, 20:60], "WWWWWWWW", 0, 30, 20, (1.0, 1.0, 1.0))
    assert pixels[40:, 20:60].any()
    pixels[40:, 20:60] = 0
    assert not pixels.any()
