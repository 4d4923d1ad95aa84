"""Clouds at many wavelengths, from their light at a few.

What clouds make of the light that falls on them is smooth in the wavelength; that light itself,
with ozone's bands, is not, but is known at all of them.
"""

from __future__ import annotations

import hashlib
import math
from functools import cached_property

import numpy as np
import numpy.typing as npt

from skybake.clouds.air import ClearAir
from skybake.clouds.cloudscape import Cloudscape
from skybake.clouds.layer import SolvedLayer
from skybake.clouds.quadrature import double_gauss
from skybake.jit.kept import Kept
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

WIDEST = 50.0
"""Distance of the wavelengths at which the light of clouds is solved for. [nm]"""

DIRECTIONS = 7
"""Order of the directions over which the light that falls on clouds is averaged."""

KEPT = 64
"""Calls whose rays are not followed again for other wavelengths."""


def nodes_among(wavelengths: Array) -> npt.NDArray[np.int64]:
    """Return which of ascending wavelengths [nm] clouds are solved for, ascending."""
    count = math.ceil((wavelengths[-1] - wavelengths[0]) / WIDEST) + 1
    if count >= wavelengths.size:
        return np.arange(wavelengths.size)
    even = np.linspace(wavelengths[0], wavelengths[-1], count)
    nearest = np.abs(wavelengths - even[:, None]).argmin(axis=1)
    return np.unique(nearest)


def cubic_shares(nodes: Array, wavelengths: Array) -> Array:
    """Return weights of nodes in the cubics through the four nearest ones, (node, wavelength)."""
    count = min(nodes.size, 4)
    first = np.searchsorted(nodes, wavelengths, side="right") - count // 2
    first = np.clip(first, 0, nodes.size - count)
    shares = np.zeros((nodes.size, wavelengths.size))
    columns = np.arange(wavelengths.size)
    for k in range(count):
        share = np.ones(wavelengths.size)
        for other in range(count):
            if other != k:
                step = nodes[first + k] - nodes[first + other]
                share *= (wavelengths - nodes[first + other]) / step
        shares[first + k, columns] = share
    return shares


def light_on_clouds(air: ClearAir, top: float, sun: Array) -> Array:
    """Light that falls on clouds from all around, per unit irradiance, shape (wavelength,).

    Parameters
    ----------
    air : ClearAir
        What surrounds them.
    top : float
        Altitude. [km]
    sun : ndarray of float64, shape (3,)
        Toward the sun.
    """
    quadrature = double_gauss(DIRECTIONS, 0.0)
    light = air.light_at(top, -quadrature.direction, sun)
    diffuse = quadrature.weight @ (light.single + light.diffuse)
    total: Array = air.sunlight(np.array([top]), float(sun[2]))[0] + diffuse
    return np.maximum(total, 1e-300)


class CloudsAtNodes:
    """Clouds whose channels are some of the wavelengths of a sky.

    Parameters
    ----------
    cloudscape : Cloudscape
        The clouds, whose channels are the radiance per unit irradiance at the nodes.
    wavelengths : ndarray of float64, shape (wavelength,)
        Of the sky. [nm]
    nodes : ndarray of int, shape (node,)
        Which of them the channels are.
    """

    def __init__(
        self, cloudscape: Cloudscape, wavelengths: Array, nodes: npt.NDArray[np.int64]
    ) -> None:
        self.cloudscape = cloudscape
        self._seen: Kept[bytes, tuple[Floats, Floats]] = Kept(KEPT)
        self.shares = cubic_shares(wavelengths[nodes], wavelengths)
        falls = light_on_clouds(cloudscape.air, cloudscape.top, cloudscape.sun)
        self.of_clouds = self.shares * falls / falls[nodes, None]

    def see(
        self, directions: Array, pixel: float, ends: Array | None = None
    ) -> tuple[Floats, Floats]:
        """As of the cloudscape; rays of the last calls are not followed again."""
        digest = hashlib.blake2b(np.ascontiguousarray(directions).data, digest_size=16)
        digest.update(repr(pixel).encode())
        if ends is not None:
            digest.update(np.ascontiguousarray(ends).data)
        return self._seen.get(digest.digest(), lambda: self.cloudscape.see(directions, pixel, ends))

    def with_channels(self, weights: Array) -> Cloudscape:
        """Return the clouds in channels that any wavelengths add up to.

        Parameters
        ----------
        weights : ndarray of float64, shape (wavelength, channel)
            As of `Cloudscape`.
        """
        return _Mixed(self, weights)


class _Mixed(Cloudscape):
    """Clouds in channels that are sums over those of others."""

    def __init__(self, nodes: CloudsAtNodes, weights: Array) -> None:
        own = nodes.cloudscape
        place = own.layers, own.air, own.altitude, own.sun
        # Which pixels are alike must not depend on the channels, whose rays are the same.
        super().__init__(*place, weights, own.depth, 0.0, own.workers)
        self._nodes = nodes
        self._of_clouds = (nodes.of_clouds @ weights).astype(np.float32)
        share = nodes.shares @ (weights / weights.sum(axis=0))
        self._of_air = share.astype(np.float32)

    @cached_property
    def solved(self) -> list[SolvedLayer]:
        """The light of each layer at the nodes."""
        return self._nodes.cloudscape.solved

    def see(
        self, directions: Array, pixel: float, ends: Array | None = None
    ) -> tuple[Floats, Floats]:
        """As of `Cloudscape`."""
        seen, passing = self._nodes.see(directions, pixel, ends)
        return np.maximum(seen @ self._of_clouds, np.float32(0.0)), passing

    @cached_property
    def nodes(self) -> tuple[Floats, Floats, Array]:
        """As of `Cloudscape`."""
        lit, through, distance = self._nodes.cloudscape.nodes
        return lit @ self._of_air, through @ self._of_air, distance

    @cached_property
    def sunlit_air(self) -> Floats:
        """As of `Cloudscape`."""
        lit: Floats = self._nodes.cloudscape.sunlit_air @ self._of_air
        return lit
