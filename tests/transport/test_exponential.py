import numba
import numpy as np

from tests.kernels import fast_exp


@numba.njit
def exponentials(x):
    out = np.empty_like(x)
    for i in range(x.size):
        out[i] = fast_exp(x[i])
    return out


def test_error_stays_below_8e_9():
    x = np.linspace(-300.0, 300.0, 2_000_001)
    assert np.abs(exponentials(x) / np.exp(x) - 1.0).max() < 8e-9


def test_zero_gives_exactly_one():
    assert exponentials(np.zeros(1))[0] == 1.0


def test_what_no_light_survives_stays_finite_and_positive():
    out = exponentials(np.array([-300.0, -301.0, -1e4, -1e300, -np.inf]))
    assert (out > 0.0).all()
    assert (out < 1e-130).all()
