"""Where the solver stops and says so."""

from __future__ import annotations

import numpy as np
import pytest

from skybake.errors import InputError
from skybake.optics.legendre import truncate_peaks
from skybake.scattering.solver import MAX_DEPTH, solve_field
from tests.truth import truth_medium


def test_air_beyond_the_solvers_depth_is_refused_with_the_way_out():
    medium = truth_medium("EARTH_A")
    thick = medium._replace(
        scattering=medium.scattering * 200.0, extinction=medium.extinction * 200.0
    )

    with pytest.raises(InputError, match=rf"at most {MAX_DEPTH:g} .*got \d.*--method reference"):
        solve_field(truncate_peaks(thick, 10), np.zeros((2, 2, 3)))
