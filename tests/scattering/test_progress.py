"""How far a solution is."""

from threading import Event

import numpy as np

from skybake.jit.workers import ALL_CPUS
from skybake.scattering.atmosphere import build_atmosphere
from tests.media import plain_medium


def test_the_share_of_a_solution_that_is_done_grows():
    told = []
    workers = ALL_CPUS.with_cancel(Event(), told.append)
    build_atmosphere(plain_medium(lambda h: np.exp(-h / 8.0), 0.01), "full", workers)
    assert len(told) >= 4
    assert told == sorted(told)
    assert 0.0 < told[0] < told[-1] < 1.0
