"""How much aerosol makes a given visibility or turbidity."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from skybake.errors import PresetError
from skybake.optics.medium import build_medium, vertical_optical_depth
from skybake.preset import Aerosol, Gas, Planet

CONTRAST = 3.912
"""Optical depth at which a black object fades into the horizon: -ln 0.02, Koschmieder (1924)."""

HAZE_WAVELENGTH = 550.0
"""Wavelength of visibility and turbidity. [nm]"""

_LEAST_SHARE = 0.01


class _Haze(NamedTuple):
    """Extinction of a planet's atmosphere, split into the haze and the rest.

    `weights` are optical depths by the names of the aerosols that make the haze; with
    these `ground` and `column` are their extinction at the ground [km⁻¹] and their
    vertical optical depth. `ground_rest` and `column_rest` are those of all other
    constituents and of the other aerosols; `molecular` is the gases' optical depth.
    """

    weights: dict[str, float]
    ground: float
    column: float
    ground_rest: float
    column_rest: float
    molecular: float


def visibility(planet: Planet) -> float:
    """Meteorological visibility at the ground by Koschmieder's law.

    Returns
    -------
    float
        3.912 / extinction, of all constituents, at the ground and 550 nm. [km]
    """
    extinction = sum(_at_ground(planet).values())
    return CONTRAST / extinction if extinction > 0.0 else float("inf")


def turbidity(planet: Planet) -> float | None:
    """Vertical optical depth of gases and aerosols relative to that of the gases, at 550 nm.

    Absorbing gases do not count. None without a gas.
    """
    gases = sum(_vertical(planet, Gas).values())
    aerosols = sum(_vertical(planet, Aerosol).values())
    return (gases + aerosols) / gases if gases > 0.0 else None


def haze_for_visibility(planet: Planet, kilometres: float) -> dict[str, float]:
    """Optical depths with which the aerosols near the ground leave a given visibility.

    Parameters
    ----------
    planet : Planet
        Its aerosols' profiles and colours stay; those that give less than 1 % of the
        aerosols' extinction at the ground, as a layer aloft does, stay altogether.
        The others are scaled alike.
    kilometres : float
        Visibility 3.912 / extinction at the ground and 550 nm.

    Returns
    -------
    dict of str to float
        ``optical_depth`` of each aerosol that changes, by its name.

    Raises
    ------
    PresetError
        If there is no such aerosol, or the atmosphere is too thick without it already.
    """
    haze = _haze(planet)
    needed = CONTRAST / kilometres - haze.ground_rest
    if needed < 0.0:
        raise PresetError(
            f"must be at most {CONTRAST / haze.ground_rest:.4g} km, the visibility of "
            f"{planet.name} without haze, got {kilometres:g} km"
        )
    return {name: one * needed / haze.ground for name, one in haze.weights.items()}


def haze_for_turbidity(planet: Planet, ratio: float) -> dict[str, float]:
    """Optical depths with which the aerosols near the ground make a given turbidity.

    Parameters
    ----------
    planet : Planet
        As of `haze_for_visibility`.
    ratio : float
        Vertical optical depth of gases and aerosols relative to that of the gases at
        550 nm, at least 1.

    Returns
    -------
    dict of str to float
        ``optical_depth`` of each aerosol that changes, by its name.

    Raises
    ------
    PresetError
        If there is no such aerosol or no gas, or the other aerosols alone exceed it.
    """
    haze = _haze(planet)
    if haze.molecular == 0.0:
        raise PresetError(f"needs a constituent of kind gas, {planet.name} has {_kinds(planet)}")
    aloft = haze.column_rest
    needed = (ratio - 1.0) * haze.molecular - aloft
    if needed < 0.0:
        raise PresetError(
            f"must be at least {1.0 + aloft / haze.molecular:.4g}, the turbidity of "
            f"{planet.name} without haze, got {ratio:g}"
        )
    return {name: one * needed / haze.column for name, one in haze.weights.items()}


def _haze(planet: Planet) -> _Haze:
    weights = {
        one.name: one.optical_depth for one in planet.constituents if isinstance(one, Aerosol)
    }
    if not any(weights.values()):
        weights = dict.fromkeys(weights, 1.0)
    weighted = replace(
        planet,
        constituents=tuple(
            replace(one, optical_depth=weights[one.name]) if isinstance(one, Aerosol) else one
            for one in planet.constituents
        ),
    )
    ground = _at_ground(weighted)
    least = _LEAST_SHARE * sum(ground[name] for name in weights)
    weights = {name: one for name, one in weights.items() if ground[name] >= least > 0.0}
    if not weights:
        raise PresetError(
            f"needs a constituent of kind aerosol that reaches the ground, "
            f"{planet.name} has {_kinds(planet)}"
        )
    vertical = _vertical(weighted, Aerosol)
    return _Haze(
        weights=weights,
        ground=sum(ground[name] for name in weights),
        column=sum(vertical[name] for name in weights),
        ground_rest=_sum_without(_at_ground(planet), weights),
        column_rest=_sum_without(_vertical(planet, Aerosol), weights),
        molecular=sum(_vertical(planet, Gas).values()),
    )


def _sum_without(values: dict[str, float], names: Iterable[str]) -> float:
    return sum(value for name, value in values.items() if name not in names)


def _at_ground(planet: Planet) -> dict[str, float]:
    """Extinction at the ground by each constituent. [km⁻¹]"""
    if not planet.constituents:
        return {}
    medium = build_medium(planet, np.array([HAZE_WAVELENGTH]))
    extinction = (medium.density[0] * medium.extinction[:, 0]).tolist()
    return {one.name: k for one, k in zip(planet.constituents, extinction, strict=True)}


def _vertical(planet: Planet, kind: type[Gas | Aerosol]) -> dict[str, float]:
    """Vertical optical depth of each constituent of a kind."""
    if not planet.constituents:
        return {}
    medium = build_medium(planet, np.array([HAZE_WAVELENGTH]))
    depths = vertical_optical_depth(medium)[:, 0].tolist()
    return {
        one.name: depth
        for one, depth in zip(planet.constituents, depths, strict=True)
        if isinstance(one, kind)
    }


def _kinds(planet: Planet) -> str:
    kinds = [f"{one.name} ({type(one).__name__.lower()})" for one in planet.constituents]
    return ", ".join(kinds) or "no constituents"
