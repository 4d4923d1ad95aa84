"""What several targets have in common."""

from __future__ import annotations

import math

from skybake.image.target_model import TargetAxes, TargetReason

WEST, SOUTH = math.radians(270.0), math.radians(180.0)
EITHER = (".exr", ".hdr")
GRAPHICS = TargetAxes(east="+X", north="-Z", up="+Y")

BY_DOCUMENTATION = "by documentation only"
OUR_AXES = "The program looks up directions as OpenEXR does, north at the left edge."
CENTRES = TargetReason(
    "Texel i of W is at (i + 1/2) / W, as graphics hardware samples a texture.",
    "https://registry.khronos.org/vulkan/specs/latest/html/vkspec.html#textures",
)
NO_CUBE = TargetReason("It takes no cubemap as a light.", "its documentation, as of the maps")
PHOTOGRAPH = TargetReason(
    "1.0 is what a camera at EV 15 shows as white, so that daylight needs no exposure.",
    "docs/formats.md, Pixels",
)
NITS = TargetReason(
    "It reckons light in cd/m2, and without the disc a day's sky fits half floats.",
    "docs/formats.md, Pixels",
)
AUTO = TargetReason(
    "It reads both types; half is taken where no value is lost.", "OpenEXR's own types"
)
RGBE = TargetReason("A .hdr has one type, which holds any value.", "docs/formats.md, Radiance")
SUN_IN_MAP = TargetReason(
    "A path tracer samples the disc by its brightness and finds all of its light.",
    "docs/formats.md, Pixels",
)
SUN_AS_LIGHT = TargetReason(
    "Filters of environment maps lose a disc of a few texels or make fireflies of it, and it casts "
    "no shadow: a directional light has to take its place.",
    "https://github.com/mrdoob/three.js/pull/28166, https://github.com/godotengine/godot/pull/58164",
)
