"""Clouds of few voxels, whose light is solved for at once."""

import numpy as np

LAYER = "tile=cloud.npz,base=1km,wind=40m/s@270deg"


def few_voxels(folder, name="cloud.npz"):
    """Write a tile in a folder; `LAYER` makes it a layer."""
    extinction = np.zeros((2, 8, 8), np.float32)
    extinction[:, 2:5, 1:5] = 12.0
    np.savez(folder / name, extinction_per_km=extinction, spacing_km=np.array([0.2, 0.3, 0.3]))
    return folder / name
