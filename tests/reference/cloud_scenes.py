"""Clouds of the reference tables, and the air around them."""

from __future__ import annotations

import numpy as np

from skybake.cloud_fields.build import build_field, empty_field
from skybake.cloud_fields.field import CONSTANT, LINEAR, CloudField
from skybake.optics.medium import Medium
from skybake.optics.phase import scattering_angles
from skybake.preset import load_preset
from tests.media import plain_medium
from tests.truth import TRUTH_FOLDER, henyey_greenstein, truth_medium

DROPLETS = henyey_greenstein(scattering_angles(), 0.85)[:, None]
"""Phase function of all clouds in the tables, at one wavelength. [sr^-1]"""


def voxels(
    extinction: np.ndarray,
    spacing: tuple[float, float, float],
    base: float,
    *,
    kind: int = CONSTANT,
    origin: tuple[float, float] = (0.0, 0.0),
) -> CloudField:
    """A layer of voxels by z, y and x, in km^-1 and km."""
    beyond = 0.5 * spacing[0] if kind == LINEAR else 0.0
    return empty_field()._replace(
        kind=kind,
        values=np.ascontiguousarray(extinction, dtype=np.float32),
        spacing=np.array(spacing),
        period=np.array([spacing[2], spacing[1]]) * extinction.shape[:0:-1],
        origin=np.array(origin),
        base=base - beyond,
        top=base + len(extinction) * spacing[0] + beyond,
    )


def deck(optical_depth: float, base: float = 1.0, depth: float = 1.0) -> CloudField:
    """A homogeneous layer."""
    return voxels(np.full((1, 1, 1), optical_depth / depth), (depth, 1.0, 1.0), base)


def cumulus() -> CloudField:
    """CUMULUS of the tables, seen from below a cloud."""
    with np.load(TRUTH_FOLDER / "field_CUMULUS.npz") as arrays:
        values = arrays["extinction_per_km"].transpose(2, 1, 0)
    return voxels(values, (0.05, 0.1, 0.1), 0.9, origin=(4.0, 4.0))


def linear_cumulus() -> CloudField:
    """CUMULUS_LINEAR of the tables."""
    with np.load(TRUTH_FOLDER / "field_CUMULUS_LINEAR.npz") as arrays:
        values, base = arrays["sigma"], float(arrays["zb"])
        spacing = tuple(float(arrays[name]) for name in ("dz", "dx", "dx"))
    return voxels(values, spacing, base, kind=LINEAR)


def preset_cumulus() -> CloudField:
    """Cumuli with a surface that noise displaces."""
    return build_field(load_preset("earth-fair").clouds[0])


def cloud_table(name: str) -> np.ndarray:
    """Rows of a table of clouds, a structured array with fields as the file's columns."""
    return np.genfromtxt(
        TRUTH_FOLDER / f"{name}.csv",
        delimiter=",",
        names=True,
        dtype=None,
        encoding="utf-8",
        deletechars="",
    )


def vacuum(ground: float = 0.0) -> Medium:
    """No air above a planet so large that it is flat."""
    return plain_medium(radius=6.36e6, ground=ground)


def air_at_550nm(name: str, ground: float) -> Medium:
    """EARTH_A of the tables, or HILLAIRE: the same without ozone, whose aerosol is another."""
    medium = truth_medium("EARTH_A")
    kept = [0, 1, 2]
    phase = medium.phase[:, :, [1]]
    if name == "HILLAIRE":
        kept = [0, 1]
        phase[1] = henyey_greenstein(scattering_angles(), 0.8)[:, None]
    return Medium(
        r_bottom=medium.r_bottom,
        r_top=medium.r_top,
        density=np.ascontiguousarray(medium.density[:, kept]),
        scattering=medium.scattering[kept][:, [1]],
        extinction=medium.extinction[kept][:, [1]],
        phase=np.ascontiguousarray(phase[kept]),
        ground_albedo=np.array([ground]),
    )
