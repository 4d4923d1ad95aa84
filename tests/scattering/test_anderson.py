import numpy as np

from skybake.scattering.anderson import Anderson


def dark_error(passes, weight):
    """Error of a dark row beside a bright one that has settled up to noise, [1] at first."""
    draw = np.random.default_rng(0)
    kept = np.array([0.1, 0.5, 0.9, 0.98])
    fixed = np.array([np.ones(4), 1e-6 * np.ones(4)])
    state = fixed * np.array([[1.0], [0.0]])
    mixing = Anderson(1)
    for _ in range(passes):
        image = np.stack(
            [fixed[0] + 1e-6 * draw.standard_normal(4), fixed[1] + kept * (state[1] - fixed[1])]
        )
        state = mixing.step(state, image, weight)
    return np.abs(state[1] / fixed[1] - 1.0).max()


def test_a_dark_row_settles_by_weight_beside_the_noise_of_a_bright_one():
    assert dark_error(20, np.array([0.0, 1e12])) < 1e-3
    assert dark_error(20, None) > 0.1
