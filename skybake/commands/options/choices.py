"""What options may be.

These repeat the choices of the engine, because help and completion must not wait for the engine's
imports; a test compares both.
"""

from __future__ import annotations

PROJECTIONS = ("equirect", "cubemap", "fisheye", "perspective", "angular", "octahedral")
PROJECTIONS_WITH = {
    "equirect_rows": ("equirect",),
    "cube_layout": ("cubemap",),
    "cube_space": ("cubemap",),
    "face_names": ("cubemap",),
    "fov": ("fisheye", "perspective"),
    "look": ("fisheye", "perspective"),
}
TARGETS = (
    *("blender", "usd", "mitsuba", "houdini", "openexr"),
    *("unreal", "unity", "godot", "bevy", "three", "filament"),
)
EQUIRECT_ROWS = ("centres", "poles")
CUBE_LAYOUTS = ("faces", "cross", "vertical-cross", "row", "column", "exr")
CUBE_SPACES = ("world", "flip-x", "flip-z")
COLOUR_SPACES = ("lin_rec709", "acescg", "lin_rec2020", "lin_p3d65", "aces2065-1", "xyz")
CAMERA_WHITES = ("d65", "none")
UNITS = ("ev15", "nits")
PIXELS = ("auto", "half", "float", "rgb9e5", "r11g11b10")
CUBE_SUFFIXES = (".ktx2", ".dds")
MAP_SUFFIXES = (".exr", ".hdr", *CUBE_SUFFIXES)
BELOW_HORIZON = ("ground", "extend", "black")
SUN_DISCS = ("include", "exclude", "only", "separate")
LIGHTING_PARTS = ("specular", "diffuse", "sh", "dfg")
LIGHTING_FORMATS = ("ktx2", "dds", "exr")
LIGHTING_TARGETS = ("bevy", "three", "filament")
LIGHTING_SUN_DISCS = ("include", "exclude")
MIP_ROUGHNESS = ("linear", "filament")
METHODS = ("full", "scalar", "hillaire", "march")
CLOUD_QUALITIES = ("draft", "normal", "high")
SHOWN = ("light", "dop", "aop")
VIEWS = ("aces1", "aces2")
VISIONS = ("camera", "eye")
AIMS = ("sun", "moon", "horizon", "limb", "planet")
CAMERA_UNITS = ("m", "cm", "mm", "km", "ft")
CAMERA_UPS = ("y", "z")
AERIAL_METHODS = ("march", "froxel")
DEPTH_KINDS = ("planar", "ray")
MOONS_IN_AIR = ("include", "exclude")
DEPTH_BACKGROUNDS = ("inf", "0")
SKIES_BEHIND = ("none", "fill")
PARAMETRISATIONS = ("hillaire2020", "bruneton2017", "linear")
TABLE_PIXELS = ("float", "half")
TABLE_METHODS = ("full", "scalar", "hillaire")
