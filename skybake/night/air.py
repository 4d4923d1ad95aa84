"""The air of the night over an observer: what of it no hour changes."""

from __future__ import annotations

import math
from copy import copy

import numpy as np

from skybake.angles import direction_from_angles
from skybake.colour.response import Response
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.night.airglow import Layer, airglow_layers, path_through
from skybake.night.channels import Channels
from skybake.night.city import ground_response, lamp_channels
from skybake.optics.medium import Array
from skybake.sky.extended import STEPS, ExtendedSky
from skybake.sky.sky import Sky

ABOVE, BELOW = 256, 32
"""Rows of a table of the sky above the true horizon and below it, crowded toward it."""

BEARINGS = 720
"""Columns of the table."""

NODES_ABOVE, NODES_BELOW = 48, 16
"""Zenith angles at which scattered light is found, which is smooth between."""


class NightAir:
    """How the air passes and scatters lights from all around, for the rows of a table.

    Parameters
    ----------
    sky : Sky
        The observer and the air; its sun counts for nothing.
    has_airglow : bool
        Whether the air glows by itself, as that of Earth.
    has_city : bool
        Whether the ground does, by lamps.

    Attributes
    ----------
    zenith_horizon : float
        Zenith angle of the true horizon. [rad]
    zenith : ndarray of float64, shape (row,)
        Of the rows: those above the horizon, then those below it. [rad]
    vectors : ndarray of float64, shape (row, BEARINGS, 3)
        Where the table looks, from north clockwise: +Y up, -Z north, +X east.
    passing : ndarray of float64, shape (row, wavelength)
        As of `ExtendedSky`.
    channels : Channels
        How spectra are held.
    weights : ndarray of float64, shape (channel, 3)
        XYZ [cd m⁻²] is the spectral radiance, as channels hold it, times these.
    airglow : ndarray of float64, shape (row, 3)
        XYZ of airglow at the level of its table. [cd m⁻²]
    city : ndarray of float64, shape (row, 3)
        XYZ of the glow of a city all around, whose luminance in the zenith is 1.
    city_spectra : ndarray of float64, shape (row, channel)
        Of the same glow.
    lamps : ndarray of float64, shape (channel,)
        Radiance of the ground of that city.
    """

    def __init__(self, sky: Sky, *, has_airglow: bool, has_city: bool = False) -> None:
        skylight, medium = sky.skylight, sky.skylight.atmosphere.medium
        self._radius, self._bottom = skylight.radius, medium.r_bottom
        self._sky = sky
        self.sources = ExtendedSky(skylight.atmosphere, self._radius)
        self.channels = Channels(sky)
        self.zenith_horizon = math.pi - math.asin(min(self._bottom / self._radius, 1.0))
        self.zenith = row_zeniths(self.zenith_horizon)
        self._nodes, self._between = self._node_rows(is_smooth=self._radius < medium.r_top)
        bearing = 2.0 * math.pi * np.arange(BEARINGS) / BEARINGS
        self.vectors = direction_from_angles(bearing, 0.5 * math.pi - self.zenith[:, None])
        self.passing = self.sources.passing(np.cos(self.zenith))
        self.weights = self.channels.weights
        self._layers: list[tuple[Layer, Array]] = []
        if has_airglow:
            theta = np.linspace(0.0, 0.5 * math.pi, STEPS)
            for layer in airglow_layers():
                seen = self.scattered(self.layer_from_ground(layer, theta), sky.workers)
                seen += self.layer_directly(layer, self.zenith, self.passing)
                self._layers.append((layer, seen))
        self.airglow = self._airglow()
        self.city_spectra = np.zeros((ABOVE + BELOW, self.weights.shape[0]))
        self.lamps = np.zeros(self.weights.shape[0])
        self.city = np.zeros((ABOVE + BELOW, 3))
        if has_city:
            self._add_city(sky)

    def scattered(self, rings: Array, workers: Workers = ALL_CPUS) -> Array:
        """Radiance that is scattered toward the observer, shape (row, wavelength).

        Parameters
        ----------
        rings : ndarray of float64, shape (STEPS,) or (STEPS, wavelength)
            As of `ExtendedSky.scattered`.
        workers : Workers, optional
            Threads that do the work.
        """
        at_nodes = self.sources.scattered(np.cos(self._nodes), rings, workers)
        light: Array = self._between @ at_nodes
        return light

    def _node_rows(self, *, is_smooth: bool) -> tuple[Array, Array]:
        """Zenith angles at which light is scattered, and the weights of these in each row."""
        if not is_smooth:
            # From space the air is a thin line, within which nothing is.
            return self.zenith, np.eye(ABOVE + BELOW)
        nodes = row_zeniths(self.zenith_horizon, NODES_ABOVE, NODES_BELOW)
        weights = np.zeros((ABOVE + BELOW, NODES_ABOVE + NODES_BELOW))
        weights[:ABOVE, :NODES_ABOVE] = _cubic_weights(ABOVE, NODES_ABOVE)
        weights[ABOVE:, NODES_ABOVE:] = _cubic_weights(BELOW, NODES_BELOW)
        return nodes, weights

    def _add_city(self, sky: Sky) -> None:
        """Find the glow of a city, and that of the ground that it lights."""
        zenith = self.zenith[:ABOVE]
        lamps = lamp_channels(self.channels)
        above = self._nodes[self._nodes < self.zenith_horizon]
        response = ground_response(sky, above, sky.workers)
        glow = self._between[:ABOVE, : above.size] @ response * lamps
        on_plane = np.sin(zenith) * np.maximum(np.cos(zenith), 0.0)
        irradiance = 2.0 * math.pi * np.trapezoid(glow * on_plane[:, None], zenith, axis=0)
        albedo = sky.skylight.atmosphere.medium.ground_albedo
        ground = np.broadcast_to(albedo * irradiance / math.pi, (BELOW, albedo.size))
        spectra = np.concatenate([glow, ground])
        xyz = spectra @ self.weights
        self.city_spectra, self.lamps = spectra / xyz[0, 1], lamps / xyz[0, 1]
        self.city = xyz / xyz[0, 1]

    def _airglow(self) -> Array:
        xyz = np.zeros((ABOVE + BELOW, 3))
        for layer, seen in self._layers:
            xyz += lines_xyz(layer, self.channels, seen)
        return xyz

    def seen_by(self, response: Response, city: NightAir | None = None) -> NightAir:
        """Return the same air, whose XYZ are what a response makes of spectra.

        Parameters
        ----------
        response : Response
            Of three channels.
        city : NightAir, optional
            The air at other wavelengths, between which the glow of a city is interpolated.
        """
        other = copy(self)
        other.channels = Channels(self._sky, response)
        other.weights = other.channels.weights
        other.airglow = other._airglow()
        if city is not None:
            own, known = other.channels.wavelengths, city.channels.wavelengths
            other.city_spectra = np.stack([np.interp(own, known, row) for row in city.city_spectra])
            other.lamps = np.interp(own, known, city.lamps)
        other.city = other.city_spectra @ other.weights
        return other

    def rings(self, parts: Array, spectra: Array) -> Array:
        """Means around the vertical of a light, as `scattered` takes them.

        Parameters
        ----------
        parts : ndarray of float64, shape (part, row, bearing)
            Brightness of its parts at `vectors`.
        spectra : ndarray of float64, shape (part, wavelength)
            Of these.
        """
        theta = np.linspace(0.0, 0.5 * math.pi, STEPS)
        zenith = self.zenith[:ABOVE]
        means = [np.interp(theta, zenith, part[:ABOVE].mean(axis=1)) for part in parts]
        rings: Array = np.stack(means, axis=1) @ spectra
        return rings

    def layer_from_ground(self, layer: Layer, zenith: Array) -> Array:
        """Length of rays from the ground in a layer over its thickness, shape (ray,)."""
        return path_through(layer, self._bottom, self._bottom, np.cos(zenith))[1]

    def layer_directly(self, layer: Layer, zenith: Array, passing: Array) -> Array:
        """Return what is seen of a layer without scattering, (ray, wavelength).

        Over what is seen in the zenith from below, at zenith angles [rad] in which the share
        `passing` passes the air, as of `ExtendedSky`.
        """
        near, far = path_through(layer, self._bottom, self._radius, np.cos(zenith))
        seen: Array = near[:, None] + far[:, None] * passing
        return seen


def lines_xyz(layer: Layer, channels: Channels, seen: Array) -> Array:
    """XYZ of the lines of a layer, shape (ray, 3).

    Parameters
    ----------
    layer : Layer
        Whose lines.
    channels : Channels
        Of the air.
    seen : ndarray of float64, shape (ray, channel)
        What is seen over the layer's radiance in the zenith from below.
    """
    # Each line has its own colour, and of the air only what it does at its wavelength.
    at_lines = channels.at(layer.wavelengths, seen)
    xyz: Array = (at_lines * layer.radiance) @ channels.of_lines(layer.wavelengths)
    return xyz


def row_zeniths(zenith_horizon: float, above: int = ABOVE, below: int = BELOW) -> Array:
    """Zenith angles of rows: those above the horizon, then those below it. [rad]"""
    # On either side of the horizon itself, where a ray would graze the ground.
    gap = 1e-7
    high, low = 1.0 - np.arange(above) / (above - 1.0), np.arange(below) / (below - 1.0)
    first = zenith_horizon * (1.0 - high**2) - gap * (high == 0.0)
    second = zenith_horizon + (math.pi - zenith_horizon) * low**2 + gap * (low == 0.0)
    return np.concatenate([np.maximum(first, 0.0), np.minimum(second, math.pi)])


def _cubic_weights(rows: int, nodes: int) -> Array:
    """Weights of even nodes at even rows between the same ends, shape (rows, nodes).

    By the cubic through the four nearest ones.
    """
    x = np.arange(rows) * (nodes - 1.0) / (rows - 1.0)
    first = np.clip(x.astype(np.int64) - 1, 0, nodes - 4)
    weights = np.zeros((rows, nodes))
    for k in range(4):
        others = [j for j in range(4) if j != k]
        share = np.prod([(x - first - j) / (k - j) for j in others], axis=0)
        weights[np.arange(rows), first + k] = share
    return weights
