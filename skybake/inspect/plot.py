"""Plots the optics of a planet's atmosphere. Needs matplotlib, the extra ``skybake[plot]``."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from skybake.errors import InputError
from skybake.formats.whole_files import replace_when_whole
from skybake.optics.medium import Medium, altitude_nodes, build_medium
from skybake.optics.phase import scattering_angles
from skybake.preset import CloudLayer, Planet
from skybake.sky.sky import WAVELENGTHS

SAMPLES = 171
"""Wavelengths of the curves, each 2 nm over the visible."""

LEAST_SHARE = 1e-4
"""Of a profile's maximum; the altitude axis ends where all fall below it."""


def plot_planet(planet: Planet, path: Path) -> None:
    """Draw coefficients, profiles and phase functions.

    Parameters
    ----------
    planet : Planet
        What to draw.
    path : Path
        ``.png`` or ``.svg``.

    Raises
    ------
    SkybakeError
        If the planet cannot be rendered or the file not be written.
    """
    if not planet.constituents:
        raise InputError(f"{planet.name}: must have a constituent to draw, got none")
    own = np.array(planet.wavelengths or WAVELENGTHS, dtype=float)
    wavelengths = np.linspace(own.min(), own.max(), SAMPLES)
    medium = build_medium(planet, wavelengths)
    figure = Figure(figsize=(13.0, 4.4), layout="constrained")
    coefficients, profiles, phases = figure.subplots(1, 3)
    figure.suptitle(f"{planet.name}: {planet.title}")
    colours = [f"C{i % 10}" for i in range(len(planet.constituents))]
    _plot_coefficients(coefficients, medium, wavelengths, colours)
    _plot_profiles(profiles, medium, colours)
    _plot_phases(phases, medium, wavelengths, colours)
    for colour, one in zip(colours, planet.constituents, strict=True):
        profiles.plot([], [], color=colour, label=one.name)
    _plot_clouds(profiles, planet.clouds)
    profiles.legend()
    with replace_when_whole(path) as temporary:
        figure.savefig(temporary, dpi=120)


def _plot_coefficients(
    axes: Axes, medium: Medium, wavelengths: np.ndarray, colours: list[str]
) -> None:
    densest = medium.density.max(axis=0)[:, None]
    absorption = medium.extinction - medium.scattering
    for i, colour in enumerate(colours):
        for values, style in ((medium.scattering, "-"), (absorption, "--")):
            curve = (values * densest)[i]
            if curve.max() > 0.0:
                axes.plot(wavelengths, np.where(curve > 0.0, curve, np.nan), style, color=colour)
    axes.plot([], [], "k-", label="scattering")
    axes.plot([], [], "k--", label="absorption")
    axes.set(yscale="log", xlabel="wavelength [nm]", ylabel="coefficient where densest [1/km]")
    axes.legend()


def _plot_profiles(axes: Axes, medium: Medium, colours: list[str]) -> None:
    altitude = altitude_nodes(medium.r_bottom, medium.r_top)
    share = medium.density / medium.density.max(axis=0)
    highest = altitude[(share > LEAST_SHARE).any(axis=1)].max()
    for values, colour in zip(share.T, colours, strict=True):
        axes.plot(np.where(values > LEAST_SHARE, values, np.nan), altitude, color=colour)
    axes.set(
        xscale="log",
        xlim=(LEAST_SHARE, 1.5),
        ylim=(0.0, highest),
        xlabel="density relative to the greatest",
        ylabel="altitude [km]",
    )


def _plot_clouds(axes: Axes, layers: tuple[CloudLayer, ...]) -> None:
    for i, layer in enumerate(layers):
        top = layer.base + layer.depth
        shade = 0.55 + 0.3 * (i % 2)
        axes.axhspan(layer.base, top, color=f"{shade:g}", alpha=0.5, label=f"clouds {layer.name}")
        axes.set_ylim(top=max(top, axes.get_ylim()[1]))


def _plot_phases(axes: Axes, medium: Medium, wavelengths: np.ndarray, colours: list[str]) -> None:
    angles = np.degrees(scattering_angles())
    blue, green, red = 0, len(wavelengths) // 2, len(wavelengths) - 1
    for i, colour in enumerate(colours):
        if medium.scattering[i].max() == 0.0:
            continue
        for k, style in ((blue, ":"), (green, "-"), (red, "--")):
            axes.plot(angles, medium.phase[i, :, k], style, color=colour, linewidth=1.0)
    for k, style in ((blue, ":"), (green, "-"), (red, "--")):
        axes.plot([], [], f"k{style}", label=f"{wavelengths[k]:.0f} nm")
    axes.axhline(0.25 / math.pi, color="0.8", zorder=0)
    axes.set(
        yscale="log",
        xlim=(0.0, 180.0),
        xticks=range(0, 181, 30),
        xlabel="scattering angle [deg]",
        ylabel="phase function [1/sr]",
    )
    axes.legend()
