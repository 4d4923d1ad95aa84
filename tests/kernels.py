"""Kernels that only other kernels call, made callable from Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba

from skybake.scattering import field, transmittance
from skybake.transport import density, exponential, geometry, trace


def _from_python(kernel: Callable[..., Any]) -> Any:
    def call(*arguments: Any) -> Any:
        return kernel(*arguments)

    return numba.njit(call)


fast_acos = _from_python(field.fast_acos)
log_twilight = _from_python(field.log_twilight)
sun_weights = _from_python(field.sun_weights)
altitude_mu_from_unit = _from_python(transmittance.altitude_mu_from_unit)
fill_ground_irradiance = _from_python(field.fill_ground_irradiance)
fill_sun_column = _from_python(transmittance.fill_sun_column)
fill_transmittance = _from_python(transmittance.fill_transmittance)
unit_from_altitude_mu = _from_python(transmittance.unit_from_altitude_mu)
fill_column = _from_python(density.fill_column)
fill_density = _from_python(density.fill_density)
fast_exp = _from_python(exponential.fast_exp)
distance_to_entry = _from_python(geometry.distance_to_entry)
distance_to_exit = _from_python(geometry.distance_to_exit)
radius_at = _from_python(geometry.radius_at)
shadow_interval = _from_python(geometry.shadow_interval)
ray_limits = _from_python(trace.ray_limits)
