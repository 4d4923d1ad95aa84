"""A script by which Blender lights a scene as a map does: its world, and a sun."""

from __future__ import annotations

import math
from collections.abc import Sequence

from skybake.colour.exposure import luminance_from_ev
from skybake.sidecar.map_light import MapLight
from skybake.version import __version__

TURN = math.pi / 2.0
"""By which Blender has to turn a map about its Z for the map's -Z to look along its +Y. [rad]"""

WORLD, SUN = "Sky by skybake", "Sun by skybake"
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
"""Light of a sky, by skybake {version}: a map around the scene, and the sun as a lamp.

Run it in the text editor of Blender, or as: blender scene.blend --python THIS_FILE
It replaces the world, and the light named {sun_name}.
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


def light_by_sun(scene):
    former = bpy.data.lights.get({sun_name})
    if former is not None:
        bpy.data.lights.remove(former)
    if SUN_IS_IN_MAP:
        return
    light = bpy.data.lights.new({sun_name}, "SUN")
    light.energy = SUN_STRENGTH
    light.color = SUN_COLOUR
    light.angle = radians(SUN_ANGLE)
    sun = bpy.data.objects.new({sun_name}, light)
    sun.rotation_euler = Vector(SUN_DIRECTION).to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(sun)


light_by_map(bpy.context.scene, map_file())
light_by_sun(bpy.context.scene)
'''


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
    # A lamp's colour is at most 1 in Blender's interface.
    strongest = max(light.sun_colour)
    strength = light.direct_normal_illuminance / light.white_luminance
    exposure = math.log2(light.white_luminance / luminance_from_ev(light.exposure_ev))
    return _SCRIPT.format(
        version=__version__,
        preset=ascii(light.preset)[1:-1],
        file=ascii(files[0]),
        space=ascii(_SPACES[light.colorspace]),
        turn=_number(math.degrees(turn)),
        direction=_numbers(_in_blender(light, turn)),
        strength=_number(strongest * strength),
        colour=_numbers([component / strongest for component in light.sun_colour]),
        angle=_number(math.degrees(light.sun_angular_diameter)),
        is_in_map=light.sun_is_in_map,
        exposure=f"{exposure:.2f}",
        world_name=ascii(WORLD),
        sun_name=ascii(SUN),
    )


def _in_blender(light: MapLight, turn: float) -> tuple[float, float, float]:
    """Direction toward the sun: an unturned map has its middle, +Z, along Blender's +X."""
    x, up, z = light.sun_direction
    cosine, sine = math.cos(turn), math.sin(turn)
    return cosine * z + sine * x, cosine * x - sine * z, up


def _numbers(values: Sequence[float]) -> str:
    return f"({', '.join(map(_number, values))})"


def _number(value: float) -> str:
    return repr(float(f"{value:.9g}"))
