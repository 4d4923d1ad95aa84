"""Derived figures of a planet, by which one can judge whether it is as intended."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from skybake.colour.observer import xyz_weights
from skybake.constants import BOLTZMANN, DOBSON_UNIT
from skybake.errors import InputError, PresetError
from skybake.optics.delta_m import scale_medium
from skybake.optics.haze import HAZE_WAVELENGTH, turbidity, visibility
from skybake.optics.medium import (
    Array,
    Medium,
    build_medium,
    vertical_columns,
    vertical_optical_depth,
)
from skybake.optics.phase import build_phase
from skybake.optics.spectrum import limb_darkening, star_irradiance, star_spectrum
from skybake.preset import Absorber, CloudLayer, Gas, Planet
from skybake.scattering.grid import ORDER
from skybake.scattering.limits import check_medium
from skybake.sky.sky import WAVELENGTHS

SUMMARY_WAVELENGTHS = (450.0, 550.0, 650.0)
"""Where optical depths are reported. [nm]"""


@dataclass(frozen=True)
class ConstituentSummary:
    """What one constituent, or all together, does to light on the vertical.

    Attributes
    ----------
    name : str
        Of the constituent, or "total".
    optical_depth, single_scattering_albedo : ndarray of float64, shape (wavelength,)
        From the ground to the top; the mean weighted by extinction, NaN where there is none.
    column : float or None
        Molecules over the ground of a gas or an absorber. [m⁻²]
    """

    name: str
    optical_depth: Array
    single_scattering_albedo: Array
    column: float | None = None


@dataclass(frozen=True)
class Summary:
    """Derived figures of a planet.

    Attributes
    ----------
    wavelengths : ndarray of float64, shape (wavelength,)
        `SUMMARY_WAVELENGTHS`, as far as the preset reaches. [nm]
    constituents : tuple of ConstituentSummary
        In the preset's order, the total last.
    ground_albedo : ndarray of float64, shape (wavelength,)
        In [0, 1].
    visibility, turbidity : float or None
        As of `skybake.optics.haze`; None if there is none. [km], 1
    sun_illuminance : float
        Above the atmosphere, facing the star. [lx]
    sun_angular_diameter : float
        Of its disc. [rad]
    refusal : str or None
        Why the method `full` does not render it, if so.
    """

    wavelengths: Array
    constituents: tuple[ConstituentSummary, ...]
    ground_albedo: Array
    visibility: float | None
    turbidity: float | None
    sun_illuminance: float
    sun_angular_diameter: float
    refusal: str | None


def summarise(planet: Planet) -> Summary:
    """Derive figures of a planet, whose optics are thereby checked as for a rendering.

    Raises
    ------
    PresetError
        If it cannot be rendered.
    """
    whole = _try_all(planet)
    own = planet.wavelengths or tuple(WAVELENGTHS)
    wavelengths = np.unique(np.clip(SUMMARY_WAVELENGTHS, min(own), max(own)))
    medium = build_medium(planet, wavelengths)
    depth = vertical_optical_depth(medium)
    with np.errstate(invalid="ignore", divide="ignore"):
        albedo = medium.scattering / medium.extinction
        total_albedo = (np.nan_to_num(albedo) * depth).sum(axis=0) / depth.sum(axis=0)
    columns = vertical_columns(medium)
    rows = [
        ConstituentSummary(one.name, depth[i], albedo[i], _column(one, float(columns[i])))
        for i, one in enumerate(planet.constituents)
    ]
    rows.append(ConstituentSummary("total", depth.sum(axis=0), total_albedo))
    sees_haze = min(own) <= HAZE_WAVELENGTH <= max(own)
    return Summary(
        wavelengths=wavelengths,
        constituents=tuple(rows),
        ground_albedo=medium.ground_albedo,
        visibility=visibility(planet) if sees_haze else None,
        turbidity=turbidity(planet) if sees_haze else None,
        sun_illuminance=float(xyz_weights(WAVELENGTHS, *star_spectrum(planet.star))[:, 1].sum()),
        sun_angular_diameter=2.0 * planet.star.angular_radius,
        refusal=_refusal(whole),
    )


def _try_all(planet: Planet) -> Medium:
    """Sample everything as a render does, and return its medium."""
    wavelengths = np.array(planet.wavelengths or WAVELENGTHS, dtype=float)
    medium = build_medium(planet, wavelengths)
    arrays = [
        medium.density,
        medium.scattering,
        medium.extinction,
        medium.phase,
        medium.ground_albedo,
        star_irradiance(planet.star, wavelengths),
        limb_darkening(planet.star, wavelengths),
    ]
    arrays += [build_phase(layer.phase, wavelengths) for layer in planet.clouds]
    if not all(np.isfinite(array).all() for array in arrays):
        raise PresetError(f"{planet.name}: optics must be finite numbers")
    return medium


def _refusal(medium: Medium) -> str | None:
    try:
        check_medium(scale_medium(medium, ORDER))
    except InputError as error:
        return str(error)
    return None


def _column(constituent: object, length: float) -> float | None:
    """Molecules over the ground [m⁻²]; `length` is the column of relative density [km]."""
    if isinstance(constituent, Gas):
        return constituent.pressure / (BOLTZMANN * constituent.temperature) * length * 1e3
    return constituent.column if isinstance(constituent, Absorber) else None


def _cloud_line(layer: CloudLayer) -> str:
    reach = f"clouds {layer.name}: {layer.base:g} to {layer.base + layer.depth:g} km"
    if layer.tile is not None:
        return f"{reach}, voxels of {Path(layer.tile.path).name}, {layer.tile.interpolation}"
    return (
        f"{reach}, {layer.kind}, cover {layer.cover:.4g}, "
        f"optical depth {layer.optical_depth:.4g} at 550 nm"
    )


def summary_text(planet: Planet, summary: Summary) -> str:
    """Human-readable summary, in lines."""
    width = max(len(one.name) for one in summary.constituents)
    band = "".join(f"{wavelength:>9g}" for wavelength in summary.wavelengths)
    gap = " " * max(0, len(band) - len("optical depth") - 2)
    lines = [
        f"{planet.name}: {planet.title}",
        "",
        f"{'':{width}}  optical depth{gap}   single scattering albedo",
        f"{'nm':{width}}{band}  {band}",
    ]
    for one in summary.constituents:
        depth = "".join(f"{value:>9.4g}" for value in one.optical_depth)
        albedo = "".join(
            f"{'-' if math.isnan(value) else f'{value:.4f}':>9}"
            for value in one.single_scattering_albedo
        )
        lines.append(f"{one.name:{width}}{depth}  {albedo}")
    lines.append("")
    lines += [
        f"column of {one.name}: {one.column:.4g} molecules/m2, {one.column / DOBSON_UNIT:.4g} DU"
        for one in summary.constituents
        if one.column is not None
    ]
    lines += [_cloud_line(layer) for layer in planet.clouds]
    if summary.visibility is not None:
        is_clear = math.isinf(summary.visibility)
        length = "without limit" if is_clear else f"{summary.visibility:.4g} km"
        lines.append(f"visibility: {length} at the ground, 550 nm")
    if summary.turbidity is not None:
        lines.append(f"turbidity: {summary.turbidity:.4g} at 550 nm")
    albedo = ", ".join(
        f"{value:.4g} at {wavelength:g} nm"
        for value, wavelength in zip(summary.ground_albedo, summary.wavelengths, strict=True)
    )
    lines += [
        f"ground albedo: {albedo}",
        f"sun above the atmosphere: {summary.sun_illuminance:.4g} lx",
        f"sun's disc: {math.degrees(summary.sun_angular_diameter):.4g}deg across",
    ]
    if summary.refusal is not None:
        lines.append(f"will not render: {summary.refusal}")
    if planet.data_quality:
        lines.append(f"data quality: {' '.join(planet.data_quality.split())}")
    return "\n".join(lines)
