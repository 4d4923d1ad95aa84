"""Atmospheres simple enough for closed forms."""

import numpy as np

from skybake.angles import cosine_between
from skybake.optics.medium import Medium, altitude_nodes
from skybake.optics.phase import SCATTERING_ANGLES

RADIUS, TOP = 6360.0, 6460.0


def plain_medium(
    density=None, extinction=0.0, *, albedo=1.0, ground=0.0, radius=RADIUS, thickness=100.0
):
    """One isotropically scattering constituent; `density` is a function of altitude, default 1.

    `extinction` [km^-1] and `ground` are scalars or one value per wavelength.
    """
    altitude = altitude_nodes(radius, radius + thickness)
    profile = np.ones_like(altitude) if density is None else density(altitude)
    extinction = np.atleast_1d(np.asarray(extinction, dtype=float))[None]
    return Medium(
        r_bottom=radius,
        r_top=radius + thickness,
        density=profile[:, None].copy(),
        scattering=albedo * extinction,
        extinction=extinction,
        phase=np.full((1, SCATTERING_ANGLES, extinction.shape[1]), 0.25 / np.pi),
        ground_albedo=np.full(extinction.shape[1], float(ground)),
    )


def cosine_to_sun(mu, mu_s, azimuth):
    """Cosine of the angle between a view and a sun that are `azimuth` apart. [rad]"""
    sine, sine_s = (np.sqrt(np.maximum(1.0 - x**2, 0.0)) for x in (mu, mu_s))
    return np.clip(cosine_between(mu, sine, mu_s, sine_s, azimuth), -1.0, 1.0)
