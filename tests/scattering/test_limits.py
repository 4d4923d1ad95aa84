"""Where the solver stops and says so."""

from __future__ import annotations

import pytest

from skybake.errors import TooThickError
from skybake.optics.delta_m import scale_medium
from skybake.scattering.limits import MAX_DEPTH, check_medium
from tests.truth import truth_medium


def test_a_medium_beyond_the_solvers_depth_is_refused():
    medium = truth_medium("EARTH_A")
    thick = medium._replace(
        scattering=medium.scattering * 200.0, extinction=medium.extinction * 200.0
    )

    with pytest.raises(TooThickError, match=rf"at most {MAX_DEPTH:g} .*got \d"):
        check_medium(scale_medium(thick, 10))
