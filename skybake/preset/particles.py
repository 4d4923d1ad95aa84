"""Phase functions of the particles of clouds that come with skybake."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

from skybake.preset.document import Source
from skybake.preset.optics_model import HenyeyGreensteinPhase, Phase, Spectrum, TabulatedPhase
from skybake.preset.tables import load_table

PARTICLES = ("water", "ice", "co2_ice")

EFFECTIVE_RADII = (5.0, 10.0, 20.0)
"""Of droplets whose phase functions are tabulated; between them these are interpolated. [um]"""

DEFAULT_EFFECTIVE_RADIUS = 10.0

CO2_ICE_ASYMMETRY = 0.77
"""Mean cosine of spheres of carbon dioxide ice with an effective radius of 1.5 um, as those of
clouds high above Mars (Montmessin et al. 2007, J. Geophys. Res. 112, E11S90), and a refractive
index of 1.41 (Warren 1986, Appl. Opt. 25, 2650), see docs/derivations/cloud_ice.py. Real grains
are crystals whose phase function nobody has measured: a declared simplification."""

_ANGLE = "angle_deg"
_SHIPPED = Source("", Path())


def particle_phase(particles: str, where: str, effective_radius: float | None = None) -> Phase:
    """Return the phase function of particles.

    Parameters
    ----------
    particles : str
        One of `PARTICLES`.
    where : str
        Where the preset names them, for messages.
    effective_radius : float, optional
        Of droplets, within `EFFECTIVE_RADII`. [um]
    """
    if particles == "co2_ice":
        return HenyeyGreensteinPhase(Spectrum(where, (), (CO2_ICE_ASYMMETRY,)))
    if particles == "ice":
        return TabulatedPhase(where, *_table("cloud_ice_phase"))
    return _droplets(where, effective_radius or DEFAULT_EFFECTIVE_RADIUS)


def _droplets(where: str, radius: float) -> TabulatedPhase:
    """Interpolate between the tables, linearly in the logarithm of the radius."""
    left = max(i for i, node in enumerate(EFFECTIVE_RADII[:-1]) if node <= radius or i == 0)
    small, large = EFFECTIVE_RADII[left : left + 2]
    share = math.log(radius / small) / math.log(large / small)
    angle, wavelength, few = _table(f"cloud_droplets_{small:g}um_phase")
    _, _, many = _table(f"cloud_droplets_{large:g}um_phase")
    values = tuple(
        tuple((1.0 - share) * a + share * b for a, b in zip(first, second, strict=True))
        for first, second in zip(few, many, strict=True)
    )
    return TabulatedPhase(where, angle, wavelength, values)


@cache
def _table(
    name: str,
) -> tuple[tuple[float, ...], tuple[float, ...], tuple[tuple[float, ...], ...]]:
    """Angles [rad], wavelengths [nm] and values of a table of skybake."""
    columns = dict(load_table(name, name, _SHIPPED, _ANGLE))
    angle = tuple(math.radians(degrees) for degrees in columns.pop(_ANGLE))
    return angle, tuple(map(float, columns)), tuple(columns.values())
