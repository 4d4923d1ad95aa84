import numpy as np
import pytest

from skybake.transport.shells import SHELL_COUNT, altitude_shells
from tests.media import plain_medium
from tests.truth import truth_medium

CLOUD_DECK = plain_medium(lambda h: np.where(np.abs(h - 60.0) < 1.0, 1.0, 0.0), 1.0)


@pytest.mark.parametrize("count", [2, 13, SHELL_COUNT])
@pytest.mark.parametrize("name", ["EARTH_A", "EARTH_HAZE", "MARS_A"])
def test_shells_rise_from_the_ground_to_the_top(name, count):
    medium = truth_medium(name)
    shells = altitude_shells(medium, count)
    assert shells.shape == (count,)
    assert shells[0] == 0.0
    assert shells[-1] == pytest.approx(medium.r_top - medium.r_bottom, rel=1e-12)
    assert (np.diff(shells) > 0.0).all()


def test_layers_of_haze_are_thinner_than_a_third_of_its_scale_height():
    shells = altitude_shells(truth_medium("EARTH_A"))
    assert np.diff(shells[shells < 2.4]).max() < 0.4


def test_a_cloud_deck_aloft_gets_shells_at_its_edges():
    shells = altitude_shells(CLOUD_DECK)
    for edge in (59.0, 61.0):
        assert np.abs(shells - edge).min() < 0.2


@pytest.mark.parametrize("profile", [np.ones_like, np.zeros_like])
def test_air_without_structure_still_has_shells(profile):
    shells = altitude_shells(plain_medium(profile, 1.0))
    assert np.isfinite(shells).all()
    assert (np.diff(shells) > 0.0).all()
