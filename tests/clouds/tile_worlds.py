"""Worlds with clouds from a file of voxels."""

from __future__ import annotations

import numpy as np

DROPLETS = '{ kind = "henyey-greenstein", asymmetry = 0.85 }'


def tile_world(
    folder,
    extinction,
    spacing,
    base=1.0,
    *,
    extends="earth-hillaire2020",
    settings="",
    interpolation="constant",
    origin=(0.0, 0.0),
):
    """Write voxels by z, y and x [km^-1] and a preset with them; return its path."""
    np.savez(folder / "cloud.npz", extinction_per_km=extinction, spacing_km=np.array(spacing))
    path = folder / "world.toml"
    path.write_text(
        f'extends = "{extends}"\n{settings}\n[clouds.own]\ntile = "cloud.npz"\n'
        f'base_km = {base}\ninterpolation = "{interpolation}"\n'
        f"origin_km = [{origin[0]}, {origin[1]}]\nphase = {DROPLETS}\n"
    )
    return path


def one_cloud(parts=4):
    """Voxels with a small cloud of two densities, and their spacing."""
    values = np.zeros((4, 8, 8), np.float32)
    values[:, 2:6, 2:5] = 2.0
    values[1:3, 3:5, 3] = 4.0
    for axis in range(3):
        values = np.repeat(values, parts, axis)
    return values, (0.25 / parts, 0.5 / parts, 0.5 / parts)
