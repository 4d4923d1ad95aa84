"""Where the solver stops and says so."""

from __future__ import annotations

import numpy as np
import pytest

from skybake.errors import TooThickError, UnsolvableError
from skybake.optics.delta_m import scale_medium
from skybake.optics.phase import scattering_angles
from skybake.preset.phases import ASYMMETRY
from skybake.scattering.grid import ORDER
from skybake.scattering.limits import MAX_DEPTH, check_medium
from tests.media import plain_medium
from tests.truth import henyey_greenstein, truth_medium


def test_a_medium_beyond_the_solvers_depth_is_refused():
    medium = truth_medium("EARTH_A")
    thick = medium._replace(
        scattering=medium.scattering * 200.0, extinction=medium.extinction * 200.0
    )

    with pytest.raises(TooThickError, match=rf"at most {MAX_DEPTH:g} .*got \d"):
        check_medium(scale_medium(thick, 10))


@pytest.mark.parametrize(
    ("asymmetry", "fault"),
    [(0.97, r"forward peak .*at most 0\.45, got 0\.63"), (-0.9, r"backward peak .*got 0\.22")],
)
def test_a_peak_that_truncation_cannot_hold_is_refused(asymmetry, fault):
    medium = plain_medium(lambda h: np.exp(-h / 8.0), 0.1)
    phase = henyey_greenstein(scattering_angles(), asymmetry)
    medium = medium._replace(phase=phase[None, :, None].copy())

    with pytest.raises(UnsolvableError, match=fault):
        check_medium(scale_medium(medium, ORDER))


@pytest.mark.parametrize("asymmetry", ASYMMETRY)
def test_every_asymmetry_that_presets_may_have_is_held(asymmetry):
    medium = plain_medium(lambda h: np.exp(-h / 8.0), 0.1)
    phase = henyey_greenstein(scattering_angles(), asymmetry)
    check_medium(scale_medium(medium._replace(phase=phase[None, :, None].copy()), ORDER))
