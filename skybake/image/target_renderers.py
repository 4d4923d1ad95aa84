"""What renderers, scenes and tools need of a map."""

from __future__ import annotations

from skybake.image.target_model import Target, TargetAxes, TargetReason
from skybake.image.target_reasons import (
    AUTO,
    BY_DOCUMENTATION,
    CENTRES,
    EITHER,
    GRAPHICS,
    NO_CUBE,
    OUR_AXES,
    PHOTOGRAPH,
    SUN_IN_MAP,
    WEST,
)

RENDERERS = (
    Target(
        name="blender",
        title="Blender: Environment Texture of a World",
        maps={"equirect": EITHER},
        axes=TargetAxes(east="+X", north="+Y", up="+Z"),
        verified="Blender 5.0.1: directions of a map, and level and shadow of a lit scene",
        rotation=WEST,
        reasons={
            "maps": TargetReason(
                "The Environment Texture takes equirect maps and mirror balls.",
                "https://docs.blender.org/manual/en/latest/render/shader_nodes/textures/environment.html",
            ),
            "turn": TargetReason(
                "u = 1/2 - atan2(y, x) / 2 pi: -X is at the left edge, which is west if +Y is "
                "north, as Blender's Sun Position has it.",
                "intern/cycles/kernel/camera/projection.h, direction_to_equirectangular_range",
            ),
            "cube": NO_CUBE,
            "rows": CENTRES,
            "scale": PHOTOGRAPH,
            "pixel": AUTO,
            "sun": SUN_IN_MAP,
        },
    ),
    Target(
        name="usd",
        title="USD: DomeLight",
        maps={"equirect": EITHER},
        axes=GRAPHICS,
        verified=BY_DOCUMENTATION,
        reasons={
            "maps": TargetReason(
                "A dome light takes the format latlong everywhere, cubes nearly nowhere.",
                "https://openusd.org/release/user_guides/schemas/usdLux/DomeLight.html",
            ),
            "turn": TargetReason(OUR_AXES, "the schema DomeLight: latlong as OpenEXR has it"),
            "cube": NO_CUBE,
            "rows": CENTRES,
            "scale": PHOTOGRAPH,
            "pixel": AUTO,
            "sun": SUN_IN_MAP,
        },
    ),
    Target(
        name="mitsuba",
        title="Mitsuba: emitter envmap",
        maps={"equirect": EITHER},
        axes=GRAPHICS,
        verified="Mitsuba 3.9.1: directions of a map, and level and shadow of a lit scene",
        equirect_rows="poles",
        reasons={
            "maps": TargetReason(
                "The emitter envmap takes equirect maps.",
                "https://mitsuba.readthedocs.io/en/stable/src/generated/plugins_emitters.html",
            ),
            "turn": TargetReason(OUR_AXES, "rays through a map of directions"),
            "cube": NO_CUBE,
            "rows": TargetReason(
                "It takes the first row for the zenith and the last for the nadir: without, a sun "
                "in the zenith loses half of its light.",
                "rays through a map with the sun in the zenith, docs/formats.md, OpenEXR",
            ),
            "scale": PHOTOGRAPH,
            "pixel": AUTO,
            "sun": SUN_IN_MAP,
        },
    ),
    Target(
        name="houdini",
        title="Houdini: Dome Light in Solaris, for Karma",
        maps={"equirect": EITHER},
        axes=GRAPHICS,
        verified=BY_DOCUMENTATION,
        reasons={
            "maps": TargetReason(
                "The Dome Light takes the format latlong.",
                "https://www.sidefx.com/docs/houdini/nodes/lop/domelight.html",
            ),
            "turn": TargetReason(OUR_AXES, "it is USD's DomeLight"),
            "cube": NO_CUBE,
            "rows": CENTRES,
            "scale": PHOTOGRAPH,
            "pixel": AUTO,
            "sun": SUN_IN_MAP,
        },
    ),
    Target(
        name="openexr",
        title="OpenEXR: programs that follow its envmap attribute, as exrenvmap",
        maps={"equirect": (".exr",), "cubemap": (".exr",)},
        axes=GRAPHICS,
        verified="exrenvmap 3.1.5: directions of maps",
        cube_layout="exr",
        equirect_rows="poles",
        reasons={
            "maps": TargetReason(
                "The attribute envmap belongs to .exr.",
                "https://openexr.com/en/latest/StandardAttributes.html",
            ),
            "turn": TargetReason(OUR_AXES, "src/lib/OpenEXR/ImfEnvmap.h"),
            "cube": TargetReason(
                "Six faces below each other, in the world's axes.", "src/lib/OpenEXR/ImfEnvmap.h"
            ),
            "rows": TargetReason(
                "The first row is the zenith and the last the nadir. Columns stay centred, half a "
                "texel beside the letter, as nearly all readers have them.",
                "src/lib/OpenEXR/ImfEnvmap.h",
            ),
            "scale": PHOTOGRAPH,
            "pixel": AUTO,
            "sun": SUN_IN_MAP,
        },
    ),
)
