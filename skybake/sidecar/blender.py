"""A script by which Blender lights a scene as a map does: its world, a sun, and a Moon."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from skybake.colour.exposure import luminance_from_ev
from skybake.image.light import Triple
from skybake.sidecar.map_light import MapLight
from skybake.version import __version__

TURN = math.pi / 2.0
"""By which Blender has to turn a map about its Z for the map's -Z to look along its +Y. [rad]"""

WORLD, SUN, MOON = "Sky by skybake", "Sun by skybake", "Moon by skybake"
"""Names in Blender."""

_SPACES = {
    "lin_rec709": "Linear Rec.709",
    "lin_rec2020": "Linear Rec.2020",
    "lin_p3d65": "Linear DCI-P3 D65",
    "acescg": "ACEScg",
    "aces2065-1": "ACES2065-1",
    "xyz": "Linear CIE-XYZ D65",
}

_SCRIPT = '''\
"""Light of a sky, by skybake {version}: a map around the scene, and {discs}.

Run it in the text editor of Blender, or as: blender scene.blend --python THIS_FILE
It replaces the world, and {lamps}.
"""

from math import radians
from pathlib import Path

import bpy
from mathutils import Vector

# The sky of {preset}.
MAP = {file}
COLOUR_SPACE = {space}
TURN = {turn}  # of the map about Z [deg]

# A sun's strength is its irradiance, in the unit of the map.
SUN_DIRECTION = {direction}
SUN_STRENGTH = {strength}
SUN_COLOUR = {colour}
SUN_ANGLE = {angle}  # [deg]
SUN_IS_IN_MAP = {is_in_map}
{moon}
# That a camera would choose, for Exposure in the render properties. [stop]
SUGGESTED_EXPOSURE = {exposure}


def map_file():
    texts = [Path(bpy.path.abspath(text.filepath)) for text in bpy.data.texts if text.filepath]
    for script in (Path(__file__), *texts):
        if (script.parent / MAP).is_file():
            return script.parent / MAP
    raise FileNotFoundError(f"{{MAP}} must be beside this script")


def light_by_map(scene, file):
    world = bpy.data.worlds.get({world_name}) or bpy.data.worlds.new({world_name})
    if world.node_tree is None:
        world.use_nodes = True
    scene.world = world
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    coordinates = nodes.new("ShaderNodeTexCoord")
    mapping = nodes.new("ShaderNodeMapping")
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, radians(TURN))
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(str(file), check_existing=True)
    texture.image.colorspace_settings.name = COLOUR_SPACE
    background = nodes.new("ShaderNodeBackground")
    output = nodes.new("ShaderNodeOutputWorld")
    links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], background.inputs["Color"])
    links.new(background.outputs["Background"], output.inputs["Surface"])


def light_by_disc(scene, name, direction, strength, colour, angle, is_in_map):
    former = bpy.data.lights.get(name)
    if former is not None:
        bpy.data.lights.remove(former)
    if is_in_map:
        return
    light = bpy.data.lights.new(name, "SUN")
    light.energy = strength
    light.color = colour
    light.angle = radians(angle)
    lamp = bpy.data.objects.new(name, light)
    lamp.rotation_euler = Vector(direction).to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(lamp)


light_by_map(bpy.context.scene, map_file())
light_by_disc(
    bpy.context.scene,
    {sun_name},
    SUN_DIRECTION,
    SUN_STRENGTH,
    SUN_COLOUR,
    SUN_ANGLE,
    SUN_IS_IN_MAP,
)
{light_by_moon}'''

_MOON = """
MOON_DIRECTION = {direction}
MOON_STRENGTH = {strength}
MOON_COLOUR = {colour}
MOON_ANGLE = {angle}  # [deg]
MOON_IS_IN_MAP = {is_in_map}
"""

_LIGHT_BY_MOON = """\
light_by_disc(
    bpy.context.scene,
    {moon_name},
    MOON_DIRECTION,
    MOON_STRENGTH,
    MOON_COLOUR,
    MOON_ANGLE,
    MOON_IS_IN_MAP,
)
"""


def blender_script(light: MapLight, files: Sequence[str]) -> str:
    """Return a script of Python for Blender 4.0 and later.

    Blender's importer of USD takes a distant light four times too bright, which it does not
    if it is made by a script.

    Parameters
    ----------
    light : MapLight
        Of an equirect map.
    files : sequence of str
        The map, as seen from the script's folder.
    """
    # A map that is turned for a program keeps its north, one that a user has turned does not.
    turn = math.remainder(TURN + light.target_turn, 2.0 * math.pi)
    exposure = math.log2(light.white_luminance / luminance_from_ev(light.exposure_ev))
    sun = _lamp(
        light,
        turn,
        light.sun_direction,
        light.sun_colour,
        light.direct_normal_illuminance,
        light.sun_angular_diameter,
        light.sun_is_in_map,
    )
    moon = _moon(light, turn)
    return _SCRIPT.format(
        **sun,
        version=__version__,
        preset=ascii(light.preset)[1:-1],
        file=ascii(files[0]),
        space=ascii(_SPACES[light.colorspace]),
        turn=_number(math.degrees(turn)),
        exposure=f"{exposure:.2f}",
        world_name=ascii(WORLD),
        sun_name=ascii(SUN),
        discs="sun and Moon as lamps" if moon else "the sun as a lamp",
        lamps=f"the lights named {SUN!a} and {MOON!a}" if moon else f"the light named {SUN!a}",
        moon=moon,
        light_by_moon=_LIGHT_BY_MOON.format(moon_name=ascii(MOON)) if moon else "",
    )


def _moon(light: MapLight, turn: float) -> str:
    """Return the lines that describe the Moon, none without one."""
    moon = light.moon
    if moon is None:
        return ""
    lamp = _lamp(
        light,
        turn,
        moon.direction,
        moon.colour,
        moon.normal_illuminance,
        moon.angular_diameter,
        light.sun_is_in_map,
    )
    return _MOON.format(**lamp)


def _lamp(
    light: MapLight,
    turn: float,
    direction: Triple,
    colour: Triple,
    illuminance: float,
    angular_diameter: float,
    is_in_map: bool,
) -> dict[str, Any]:
    """Return what a lamp of Blender is made of, as text."""
    # A lamp's colour is at most 1 in Blender's interface.
    strongest = max(colour)
    return {
        "direction": _numbers(_in_blender(direction, turn)),
        "strength": _number(strongest * illuminance / light.white_luminance),
        "colour": _numbers([component / strongest for component in colour]),
        "angle": _number(math.degrees(angular_diameter)),
        "is_in_map": is_in_map,
    }


def _in_blender(direction: Triple, turn: float) -> Triple:
    """Direction toward a light: an unturned map has its middle, +Z, along Blender's +X."""
    x, up, z = direction
    cosine, sine = math.cos(turn), math.sin(turn)
    return cosine * z + sine * x, cosine * x - sine * z, up


def _numbers(values: Sequence[float]) -> str:
    return f"({', '.join(map(_number, values))})"


def _number(value: float) -> str:
    return repr(float(f"{value:.9g}"))
