"""The mappings of all tables, each defined once, as the formula that everything else is made of.

References
----------
S. Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", Computer
Graphics Forum 39(4), 2020; E. Bruneton, "Precomputed Atmospheric Scattering: a New Implementation",
2017.
"""

from __future__ import annotations

from dataclasses import replace

from skybake.errors import InputError
from skybake.luts.mapping import Mapping

TABLES = ("transmittance", "multiple_scattering", "sky_view", "aerial_perspective")
PARAMETRISATIONS = ("hillaire2020", "bruneton2017", "linear")

LEAST_SUN_COSINE = -0.2079
"""Cosine of the sun's zenith angle, of 102 degrees, beyond which Bruneton's table is constant."""

CONSTANTS = {
    "PI": "half a turn",
    "BOTTOM_RADIUS": "radius of the ground [km]",
    "TOP_RADIUS": "radius of the top of the atmosphere [km]",
    "LEAST_SUN_COSINE": "cosine of the sun's zenith angle at which Bruneton's table ends",
    "OBSERVER_ALTITUDE": "altitude of the observer above the ground [km]",
    "HORIZON": "zenith angle of the horizon as the observer sees it [rad]",
    "FAR": "distance of the volume's far end from the camera [km]",
    "NEAREST": "distance of the volume's first texel from the camera [km]",
}
"""Names in formulas, and what they mean."""

INPUTS = {
    "altitude": "above the ground [km]",
    "mu": "cosine of the zenith angle of the direction looked in",
    "mu_s": "cosine of the sun's zenith angle there",
    "zenith": "zenith angle of the direction looked in [rad]",
    "cos_azimuth": "cosine of the angle between the azimuths of the direction and of the sun",
    "screen_x": "place on the screen, 0 at its left edge, 1 at its right one",
    "screen_y": "place on the screen, 0 at its top edge, 1 at its bottom one",
    "distance": "from the camera along the ray, not along the camera's axis [km]",
}
"""What tables are looked up by."""

# The roots are of differences that round below 0, and altitudes are not taken from radii, which in
# single precision are half a metre apart.
_TRANSMITTANCE = Mapping(
    table="transmittance",
    inputs=("altitude", "mu"),
    forward="""
h = sqrt(TOP_RADIUS * TOP_RADIUS - BOTTOM_RADIUS * BOTTOM_RADIUS)
r = BOTTOM_RADIUS + altitude
rho = sqrt(max(altitude * (altitude + 2 * BOTTOM_RADIUS), 0))
d = max(sqrt(max(r * r * (mu * mu - 1) + TOP_RADIUS * TOP_RADIUS, 0)) - r * mu, 0)
d_min = TOP_RADIUS - r
d_max = rho + h
x = (d - d_min) / (d_max - d_min)
y = rho / h
""",
    inverse="""
h = sqrt(TOP_RADIUS * TOP_RADIUS - BOTTOM_RADIUS * BOTTOM_RADIUS)
rho = h * y
r = sqrt(rho * rho + BOTTOM_RADIUS * BOTTOM_RADIUS)
altitude = rho * rho / (r + BOTTOM_RADIUS)
d_min = TOP_RADIUS - r
d_max = rho + h
d = d_min + x * (d_max - d_min)
mu = max(min((h * h - rho * rho - d * d) / (2 * r * d), 1), -1) if d > 0 else 1
""",
    placements=("centres", "centres"),
)

_TRANSMITTANCE_LINEAR = Mapping(
    table="transmittance",
    inputs=("altitude", "mu"),
    forward="""
rho = sqrt(max(altitude * (altitude + 2 * BOTTOM_RADIUS), 0))
mu_horizon = -rho / (BOTTOM_RADIUS + altitude)
x = (mu - mu_horizon) / (1 - mu_horizon)
y = altitude / (TOP_RADIUS - BOTTOM_RADIUS)
""",
    inverse="""
altitude = y * (TOP_RADIUS - BOTTOM_RADIUS)
rho = sqrt(altitude * (altitude + 2 * BOTTOM_RADIUS))
mu_horizon = -rho / (BOTTOM_RADIUS + altitude)
mu = mu_horizon + x * (1 - mu_horizon)
""",
    placements=("ends", "ends"),
)

_MULTIPLE = Mapping(
    table="multiple_scattering",
    inputs=("altitude", "mu_s"),
    forward="""
x = 0.5 + 0.5 * mu_s
y = altitude / (TOP_RADIUS - BOTTOM_RADIUS)
""",
    inverse="""
mu_s = 2 * x - 1
altitude = y * (TOP_RADIUS - BOTTOM_RADIUS)
""",
    placements=("ends", "ends"),
)

_MULTIPLE_BRUNETON = Mapping(
    table="multiple_scattering",
    inputs=("altitude", "mu_s"),
    forward="""
h = sqrt(TOP_RADIUS * TOP_RADIUS - BOTTOM_RADIUS * BOTTOM_RADIUS)
rho = sqrt(max(altitude * (altitude + 2 * BOTTOM_RADIUS), 0))
d_min = TOP_RADIUS - BOTTOM_RADIUS
reach = BOTTOM_RADIUS * mu_s
most = BOTTOM_RADIUS * LEAST_SUN_COSINE
a = (sqrt(reach * reach + h * h) - reach - d_min) / (h - d_min)
a_most = (sqrt(most * most + h * h) - most - d_min) / (h - d_min)
x = max(1 - a / a_most, 0) / (1 + a)
y = rho / h
""",
    inverse="""
h = sqrt(TOP_RADIUS * TOP_RADIUS - BOTTOM_RADIUS * BOTTOM_RADIUS)
rho = h * y
altitude = rho * rho / (sqrt(rho * rho + BOTTOM_RADIUS * BOTTOM_RADIUS) + BOTTOM_RADIUS)
d_min = TOP_RADIUS - BOTTOM_RADIUS
most = BOTTOM_RADIUS * LEAST_SUN_COSINE
a_most = (sqrt(most * most + h * h) - most - d_min) / (h - d_min)
d = d_min + (h - d_min) * (a_most - x * a_most) / (1 + x * a_most)
mu_s = max(min((h * h - d * d) / (2 * BOTTOM_RADIUS * d), 1), -1)
""",
    placements=("ends", "ends"),
)

_SKY = Mapping(
    table="sky_view",
    inputs=("zenith", "cos_azimuth"),
    forward="""
x = sqrt(max(0.5 - 0.5 * cos_azimuth, 0))
sky = 0.5 - 0.5 * sqrt(max(1 - zenith / HORIZON, 0))
ground = 0.5 + 0.5 * sqrt(max(zenith - HORIZON, 0) / (PI - HORIZON))
y = sky if zenith < HORIZON else ground
""",
    inverse="""
cos_azimuth = 1 - 2 * x * x
side = 1 - 2 * y
zenith = HORIZON * (1 - side * side) if y < 0.5 else HORIZON + (PI - HORIZON) * side * side
""",
    placements=("ends", "ends"),
)

_SKY_BRUNETON = Mapping(
    table="sky_view",
    inputs=("zenith", "cos_azimuth"),
    forward="""
h = sqrt(TOP_RADIUS * TOP_RADIUS - BOTTOM_RADIUS * BOTTOM_RADIUS)
r = BOTTOM_RADIUS + OBSERVER_ALTITUDE
rho = sqrt(OBSERVER_ALTITUDE * (OBSERVER_ALTITUDE + 2 * BOTTOM_RADIUS))
b = r * cos(zenith)
root = sqrt(max(b * b - rho * rho, 0))
d_top = sqrt(max(b * b - rho * rho + h * h, 0)) - b
d_ground = rho * rho / (root - b)
least = TOP_RADIUS - r
sky = 0.5 * (d_top - least) / (rho + h - least)
ground = 1 - 0.5 * (d_ground - OBSERVER_ALTITUDE) / (rho - OBSERVER_ALTITUDE)
x = acos(cos_azimuth) / PI
y = min(max(sky, 0), 0.499999) if zenith < HORIZON else min(max(ground, 0.5), 1)
""",
    inverse="""
h = sqrt(TOP_RADIUS * TOP_RADIUS - BOTTOM_RADIUS * BOTTOM_RADIUS)
r = BOTTOM_RADIUS + OBSERVER_ALTITUDE
rho = sqrt(OBSERVER_ALTITUDE * (OBSERVER_ALTITUDE + 2 * BOTTOM_RADIUS))
least = TOP_RADIUS - r
d_top = least + 2 * y * (rho + h - least)
d_ground = OBSERVER_ALTITUDE + (2 - 2 * y) * (rho - OBSERVER_ALTITUDE)
sky = (h * h - rho * rho - d_top * d_top) / (2 * r * d_top)
ground = -(rho * rho + d_ground * d_ground) / (2 * r * d_ground)
cos_azimuth = cos(PI * x)
zenith = acos(max(min(sky if y < 0.5 else ground, 1), -1))
""",
    placements=("ends", "halves"),
)

_SKY_LINEAR = Mapping(
    table="sky_view",
    inputs=("zenith", "cos_azimuth"),
    forward="""
x = acos(cos_azimuth) / PI
ground = 0.5 + 0.5 * (zenith - HORIZON) / (PI - HORIZON)
y = min(0.5 * zenith / HORIZON, 0.499999) if zenith < HORIZON else ground
""",
    inverse="""
cos_azimuth = cos(PI * x)
zenith = 2 * y * HORIZON if y < 0.5 else HORIZON + (2 * y - 1) * (PI - HORIZON)
""",
    placements=("ends", "halves"),
)

_AERIAL = Mapping(
    table="aerial_perspective",
    inputs=("screen_x", "screen_y", "distance"),
    forward="""
x = screen_x
y = screen_y
z = min(sqrt(distance / FAR), 1)
""",
    inverse="""
screen_x = x
screen_y = y
distance = FAR * z * z
""",
    placements=("centres", "centres", "centres"),
)

_AERIAL_LINEAR = replace(
    _AERIAL,
    forward=_AERIAL.forward.replace("sqrt(distance / FAR)", "distance / FAR"),
    inverse=_AERIAL.inverse.replace("FAR * z * z", "FAR * z"),
    placements=("ends", "ends", "ends"),
)

_MAPPINGS = {
    "hillaire2020": (_TRANSMITTANCE, _MULTIPLE, _SKY, _AERIAL),
    "bruneton2017": (
        replace(_TRANSMITTANCE, placements=("ends", "ends")),
        _MULTIPLE_BRUNETON,
        _SKY_BRUNETON,
        _AERIAL,
    ),
    "linear": (_TRANSMITTANCE_LINEAR, _MULTIPLE, _SKY_LINEAR, _AERIAL_LINEAR),
}


def find_mappings(name: str) -> dict[str, Mapping]:
    """Return the mappings of a parametrisation, by the names of `TABLES`.

    Raises
    ------
    InputError
        If there is none of that name; the message lists the known ones.
    """
    if name not in _MAPPINGS:
        known = ", ".join(PARAMETRISATIONS)
        raise InputError(f"parametrisation: must be one of {known}, got {name!r}")
    return {mapping.table: mapping for mapping in _MAPPINGS[name]}
