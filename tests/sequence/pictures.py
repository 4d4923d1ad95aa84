"""Small display-referred pictures that look like skies."""

import numpy as np


def dusk(share, height=48, width=96):
    """From dark orange dusk, share 0, to blue day, share 1."""
    down = np.linspace(0.0, 1.0, height)[:, None, None]
    along = 0.8 + 0.2 * np.sin(np.arange(width) / 15.0)[None, :, None]
    top = np.array([20.0, 60.0, 140.0]) * share + np.array([2.0, 3.0, 10.0]) * (1.0 - share)
    horizon = np.array([180.0, 210.0, 240.0]) * share + np.array([120.0, 60.0, 20.0]) * (
        1.0 - share
    )
    return ((top * np.sqrt(1.0 - down) + horizon * (1.0 - np.sqrt(1.0 - down))) * along).astype(
        np.uint8
    )
