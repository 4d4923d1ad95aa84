"""The light that scatters again at any place in the air, as the mean of all directions."""

from __future__ import annotations

import math
from collections.abc import Mapping as Values

import numpy as np

from skybake.jit.arguments import flatten
from skybake.jit.kernel import kernel
from skybake.luts.mapping import Mapping
from skybake.luts.table import Table, texels
from skybake.luts.transmittance import colour_shares
from skybake.optics.medium import Array
from skybake.scattering.field import DiffuseField, altitude_weight, sun_weights
from skybake.scattering.tables import Atmosphere

MEAN = 1.0 / math.sqrt(4.0 * math.pi)
"""The mean of all directions is this times the moment of degree 0."""


@kernel
def _fill_means(field, altitude, mu_s, weights, out):
    for i in range(altitude.size):
        low, share = altitude_weight(field, altitude[i])
        first = sun_weights(field, mu_s[i], weights)
        for k in range(out.shape[1]):
            value = 0.0
            for q in range(4):
                below = field.radiance[low, first + q, 0, k]
                above = field.radiance[low + 1, first + q, 0, k]
                value += weights[q] * (below + share * (above - below))
            out[i, k] = MEAN * max(value, 0.0)


def mean_radiance(field: DiffuseField, altitude: Array, mu_s: Array) -> Array:
    """Mean over all directions of the radiance scattered or reflected at least once.

    Parameters
    ----------
    field : DiffuseField
        The light.
    altitude, mu_s : ndarray of float64, shape (place,)
        Places [km], and cosines of the sun's zenith angle there.

    Returns
    -------
    ndarray of float64, shape (place, wavelength)
        Per unit irradiance. [sr⁻¹]
    """
    out = np.empty((altitude.size, field.radiance.shape[3]))
    if field.altitude.size < 2:
        # Without air there is no light in it.
        out[:] = 0.0
        return out
    _fill_means(flatten(field), altitude, mu_s, np.empty(4), out)
    return out


def multiple_scattering_table(
    atmosphere: Atmosphere,
    weights: Array,
    mapping: Mapping,
    size: tuple[int, ...],
    constants: Values[str, float],
) -> Table:
    """Tabulate the light that scatters again.

    Parameters
    ----------
    atmosphere : Atmosphere
        Solved by either method.
    weights, mapping, size, constants
        As of `transmittance_table`.
    """
    places = mapping.texels(size, constants)
    altitude, mu_s = (
        np.ascontiguousarray(np.broadcast_to(places[name], size[::-1]).ravel())
        for name in mapping.inputs
    )
    count = atmosphere.medium.ground_albedo.size
    light = mean_radiance(atmosphere.field, altitude, mu_s)[:, :count] @ colour_shares(weights)
    return Table(
        name=mapping.table,
        values=texels(light.reshape(*size[::-1], 3)),
        quantity="radiance scattered or reflected at least once, the mean of all directions, per "
        "irradiance by the sun above the atmosphere",
        unit="sr-1",
        mapping=mapping,
    )
