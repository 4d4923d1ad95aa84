"""Code that looks tables up, in the languages of shaders, by the functions of their mappings."""

from __future__ import annotations

from collections.abc import Mapping as Values

from skybake.luts.mapping import Mapping
from skybake.luts.parametrisations import INPUTS
from skybake.luts.shading import Constant, declare_constants, write_functions

_LOOKUPS = '''
def luts_horizon(altitude: float) -> float:
    """Cosine of the zenith angle of the horizon, seen from an altitude [km]."""
    rho = sqrt(max(altitude * (altitude + 2 * BOTTOM_RADIUS), 0))
    return -rho / (BOTTOM_RADIUS + altitude)

def luts_transmittance(transmittance: plane, altitude: float, mu: float) -> vec3:
    """Share of light that comes through the air from outside it, 0 where the ground is in the way.
    altitude in km, at most that of the top; mu: cosine of the zenith angle."""
    place: vec2 = luts_transmittance_coordinates(altitude, mu)
    return sample(transmittance, place).rgb if mu > luts_horizon(altitude) else vec3(0, 0, 0)

def luts_multiple_scattering(multiple_scattering: plane, altitude: float, mu_s: float) -> vec3:
    """Light scattered once or more, the mean of all directions, per illuminance by the sun [1/sr].
    altitude in km; mu_s: cosine of the sun's zenith angle there."""
    return sample(multiple_scattering, luts_multiple_scattering_coordinates(altitude, mu_s)).rgb

def luts_sky(sky_view: plane, direction: vec3) -> vec3:
    """Radiance of sky and ground without the sun's disc, in a unit direction."""
    across = sqrt(direction.x * direction.x + direction.z * direction.z)
    zenith = atan2(across, direction.y)
    along = direction.x * SUN_BEARING.x + direction.z * SUN_BEARING.y
    cos_azimuth = max(min(along / max(across, 1e-9), 1), -1)
    return sample(sky_view, luts_sky_view_coordinates(zenith, cos_azimuth)).rgb

def luts_sun(transmittance: plane, direction: vec3) -> vec3:
    """Radiance of the sun's disc through the air, 0 beside it. Add it to the sky."""
    aside: vec3 = cross(direction, SUN_DIRECTION)
    ahead = dot(direction, SUN_DIRECTION)
    share = dot(aside, aside) / (SUN_SINE * SUN_SINE)
    limb = 1 - sqrt(max(1 - share, 0))
    limb_of_square = share
    disc: vec3 = SUN_RADIANCE - SUN_LIMB * limb - SUN_LIMB_OF_SQUARE * limb_of_square
    seen: vec3 = disc * luts_transmittance(transmittance, OBSERVER_ALTITUDE, direction.y)
    inside = (1 if share < 1 else 0) * (1 if ahead > 0 else 0)
    return seen * inside

def luts_screen(direction: vec3) -> vec2:
    """Place on the screen of the volume's camera, 0 to 1 from the left and from the top."""
    ahead = dot(direction, CAMERA_FORWARD)
    right = (dot(direction, CAMERA_RIGHT) / ahead - CAMERA_SHIFT.x) / CAMERA_HALF_WIDTH
    up = (dot(direction, CAMERA_UP) / ahead - CAMERA_SHIFT.y) / CAMERA_HALF_HEIGHT
    return vec2(0.5 + 0.5 * right, 0.5 - 0.5 * up)

def luts_aerial_weight(distance: float) -> float:
    """Share of the nearest texels that counts nearer than they are."""
    return min(distance / max(NEAREST, 1e-9), 1)

def luts_aerial_light(aerial_perspective: volume, screen: vec2, distance: float) -> vec4:
    """Light that the air up to a distance [km] adds (rgb), and the mean transmittance (a)."""
    place: vec3 = luts_aerial_perspective_coordinates(screen.x, screen.y, distance)
    weight = luts_aerial_weight(distance)
    found: vec4 = sample(aerial_perspective, place)
    return vec4(found.rgb * weight, 1 + (found.a - 1) * weight)

def luts_aerial_transmittance(aerial_transmittance: volume, screen: vec2, distance: float) -> vec3:
    """Transmittance of the air up to a distance [km], of each colour."""
    place: vec3 = luts_aerial_perspective_coordinates(screen.x, screen.y, distance)
    weight = luts_aerial_weight(distance)
    found: vec4 = sample(aerial_transmittance, place)
    return vec3(1, 1, 1) + (found.rgb - vec3(1, 1, 1)) * weight

def luts_through_air(aerial_perspective: volume, aerial_transmittance: volume, screen: vec2, distance: float, colour: vec3) -> vec3:
    """A surface's radiance as it looks through the air in front of it."""
    light: vec4 = luts_aerial_light(aerial_perspective, screen, distance)
    passed: vec3 = luts_aerial_transmittance(aerial_transmittance, screen, distance)
    return colour * passed + light.rgb
'''  # noqa: E501 - one line of a function's parameters


def lookup_code(
    language: str,
    mappings: Values[str, Mapping],
    sizes: Values[str, tuple[int, ...]],
    constants: Values[str, tuple[Constant, str]],
    heading: str,
) -> str:
    """Return the code that looks up a set of tables.

    Parameters
    ----------
    language : str
        One of `skybake.luts.shading.LANGUAGES`.
    mappings : mapping of str to Mapping
        Of each table.
    sizes : mapping of str to tuple of int
        Width, height and depth of each. [texel]
    constants : mapping of str to (float or tuple of float, str)
        Value and meaning of each.
    heading : str
        What the tables are of, lines of a comment.
    """
    parts = ["".join(f"// {line}\n" for line in heading.splitlines())]
    parts.append(declare_constants(language, constants))
    functions = [_coordinates(mapping, sizes[name]) for name, mapping in mappings.items()]
    parts.append(write_functions(language, "\n".join([*functions, _LOOKUPS])))
    return "\n".join(parts)


def _coordinates(mapping: Mapping, sizes: tuple[int, ...]) -> str:
    """Return the function of a mapping, as `write_functions` takes it."""
    names = mapping.textures
    parameters = ", ".join(f"{name}: float" for name in mapping.inputs)
    meaning = "; ".join(f"{name}: {INPUTS[name]}" for name in mapping.inputs)
    size = " x ".join(map(str, sizes))
    lines = [
        f"def luts_{mapping.table}_coordinates({parameters}) -> vec{len(names)}:",
        f'"""Texture coordinates in {mapping.table}, {size} texels.\n    {meaning}."""',
        *mapping.lookup(sizes).splitlines(),
        f"return vec{len(names)}({', '.join(names)})",
    ]
    return "\n    ".join(lines) + "\n"
