"""Values in a table of clouds, and the rules that they keep."""

from __future__ import annotations

import math
import re

from skybake.preset.cloud_kinds import DEFAULT_SEED, DEFAULT_WIND_FROM
from skybake.preset.message import shown
from skybake.preset.optics_model import Phase
from skybake.preset.particles import (
    DEFAULT_EFFECTIVE_RADIUS,
    EFFECTIVE_RADII,
    PARTICLES,
    particle_phase,
)
from skybake.preset.phases import read_phase
from skybake.preset.section import Section

MAX_OPTICAL_DEPTH = 300.0
"""A bound against mistaken units: thunderstorms have less. Transport was measured up to 64."""

ASYMMETRY = (-0.75, 0.95)
"""Bounds of mean cosines. The transport through clouds truncates peaks at a lower order than that
through air; it was measured at 0.85."""

WATER_DENSITY = 1000.0
"""Of liquid water. [kg m⁻³]"""

_OKTAS = re.compile(r"([0-8](?:\.\d+)?) ?oktas?|([0-8](?:\.\d+)?)/8", re.ASCII)


def parse_cover(text: str) -> float | None:
    """Read a share of the sky such as ``0.4``, ``3okta``, ``3/8`` or ``40%``.

    Returns
    -------
    float or None
        A number that may be out of range, or None if the text is no share.
    """
    oktas = _OKTAS.fullmatch(text.strip())
    if oktas is not None:
        return float(oktas[1] or oktas[2]) / 8.0
    try:
        number = float(text.strip().removesuffix("%"))
    except ValueError:
        return None
    return number / 100.0 if text.strip().endswith("%") else number


def read_cover(section: Section, usual: float) -> float:
    """Read the share of the sky that is covered; `usual` if it is not given."""
    value = section.raw("cover", usual)
    if isinstance(value, str):
        share = parse_cover(value)
        if share is None:
            section.fail(
                "cover", f"must be a share such as 0.4, '3okta' or '3/8', got {shown(value)}"
            )
        if not 0.0 <= share <= 1.0:
            section.fail("cover", f"must be from 0 to 1, or 8okta, got {shown(value)}")
        return share
    return section.number("cover", 0.0, 1.0, default=usual)


def read_particles(section: Section, usual: str) -> tuple[Phase, float | None]:
    """Read the particles' phase function and, of droplets, their effective radius [um]."""
    if isinstance(section.raw("phase", usual), dict):
        radius = _read_radius(section) if section.has("effective_radius_um") else None
        return read_phase(section.section("phase"), ASYMMETRY), radius
    particles = section.raw("phase", usual)
    if particles not in PARTICLES:
        section.has("effective_radius_um")
        section.fail(
            "phase",
            f"must be one of {', '.join(PARTICLES)}, or a table, got {shown(particles)}",
        )
    radius = _read_radius(section) if particles == "water" else None
    phase = particle_phase(particles, section.where("phase"), radius)
    nodes = getattr(phase, "wavelength", ())
    if nodes:
        section.check_cover("phase", nodes)
    return phase, radius


def _read_radius(section: Section) -> float:
    return section.number(
        "effective_radius_um",
        *(EFFECTIVE_RADII[0], EFFECTIVE_RADII[-1]),
        default=DEFAULT_EFFECTIVE_RADIUS,
    )


def read_optical_depth(section: Section, usual: float, radius: float | None) -> float:
    """Read the optical depth, or the water from which it follows with droplets of a radius [um]."""
    key = "liquid_water_path_g_m2"
    if not section.has(key):
        depth = section.number("optical_depth", 1e-3, 1e9, default=usual)
        _check_transport(section, "optical_depth", depth)
        return depth
    if section.has("optical_depth"):
        section.fail("", f"must give either optical_depth or {key}")
    if radius is None:
        section.fail(key, "needs droplets: phase = 'water', or effective_radius_um beside a table")
    path = section.number(key, 1e-3, 1e9)
    depth = depth_of_water(path, radius)
    _check_transport(section, key, depth)
    return depth


def depth_of_water(path: float, effective_radius: float) -> float:
    """Optical depth of droplets that are large compared with the wavelength.

    Stephens (1978), J. Atmos. Sci. 35, 2123, equation 7.

    Parameters
    ----------
    path : float
        Liquid water over an area. [g m⁻²]
    effective_radius : float
        [um]
    """
    return 3.0 * (path * 1e-3) / (2.0 * WATER_DENSITY * effective_radius * 1e-6)


def _check_transport(section: Section, key: str, depth: float) -> None:
    if depth > MAX_OPTICAL_DEPTH:
        section.fail(
            key,
            f"must give an optical depth of at most {MAX_OPTICAL_DEPTH:g}, the limit of the "
            f"transport through clouds, got {depth:g}",
        )


def read_seed(section: Section) -> int:
    """Read what makes a sky another one."""
    value = section.raw("seed", DEFAULT_SEED)
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 1 << 32:
        section.fail("seed", f"must be a whole number from 0 to 4294967295, got {shown(value)}")
    return value


def read_wind(section: Section, usual: float) -> tuple[float, float]:
    """Read speed [km s⁻¹] and bearing [rad]."""
    speed, bearing = read_pair(
        section, "wind_m_s", [usual, DEFAULT_WIND_FROM], (0.0, 1e3), (-360.0, 360.0)
    )
    return speed * 1e-3, math.radians(bearing % 360.0)


def read_pair(
    section: Section,
    key: str,
    usual: list[float],
    first: tuple[float, float],
    second: tuple[float, float],
) -> tuple[float, float]:
    """Read two numbers, each within its own bounds."""
    bounds = min(first[0], second[0]), max(first[1], second[1])
    values = section.numbers(key, *bounds, default=usual)
    if len(values) != 2:
        section.fail(key, f"must be two numbers, got {len(values)}")
    for value, (least, most) in zip(values, (first, second), strict=True):
        if not least <= value <= most:
            section.fail(key, f"must be from {least:g} to {most:g}, got {value:g}")
    return values[0], values[1]
