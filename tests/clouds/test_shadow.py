"""The sun through clouds, at places around them."""

import math

import numpy as np
import pytest

from skybake.clouds.solve import nearest_sun
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset

DECK = load_preset("earth-overcast")
UP = np.array([[0.0, 0.0, 1.0]])


def visible(sun, altitudes):
    """Share of a sun in the south, at altitudes above the observer."""
    settings = map_settings(
        sun_elevation=math.radians(sun), method="hillaire", clouds_quality="draft"
    )
    clouds = Scene(DECK, settings).cloudscape
    return clouds.visible(UP, np.array([altitudes]))[0]


@pytest.fixture(scope="module")
def places():
    """Ends of a stretch below the deck, and of one above it. [km]"""
    (layer,) = Scene(
        DECK, map_settings(method="hillaire", clouds_quality="draft")
    ).cloudscape.layers
    return [0.02, 0.5 * layer.grid.base, layer.grid.top + 0.5, layer.grid.top + 1.0]


def test_below_a_deck_the_sun_stays_hidden_as_it_passes_the_horizontal(places):
    # Its light comes by the planet's edge, and through the deck as it did before.
    before, after = (visible(each, places) for each in (0.02, -0.02))
    assert before[0] < 0.05
    assert after[0] == pytest.approx(before[0], abs=0.01)


def test_a_lower_layer_is_dark_when_the_sun_has_passed_the_horizontal():
    """The sun's light would have to come through the upper one, by the planet's edge."""
    high = {"kind": "stratus", "base_km": 2.0, "depth_km": 0.4, "optical_depth": 25.0}
    both = load_preset("earth-overcast", {"clouds.high": high | {"cover": 1.0}})
    settings = map_settings(
        sun_elevation=math.radians(-0.02), method="hillaire", clouds_quality="draft"
    )
    clouds = Scene(both, settings).cloudscape
    upper, lower = (
        each.light.irradiance[nearest_sun(each, clouds.sun)].max() for each in clouds.solved
    )
    assert lower < 1e-3 * upper


def test_above_a_deck_the_sun_is_whole(places):
    for sun in (20.0, 0.02):
        assert visible(sun, places)[2] == 1.0
