"""What engines that draw in real time need of a map."""

from __future__ import annotations

from skybake.image.target_model import Target, TargetAxes, TargetReason
from skybake.image.target_reasons import (
    AUTO,
    BY_DOCUMENTATION,
    CENTRES,
    EITHER,
    GRAPHICS,
    NITS,
    NO_CUBE,
    OUR_AXES,
    PHOTOGRAPH,
    RGBE,
    SOUTH,
    SUN_AS_LIGHT,
    WEST,
)

ENGINES = (
    Target(
        name="unreal",
        title="Unreal Engine: TextureCube of a Sky Light or an HDRI Backdrop",
        maps={"equirect": (".hdr",)},
        axes=TargetAxes(east="+X", north="-Y", up="+Z"),
        verified=BY_DOCUMENTATION,
        rotation=SOUTH,
        units="nits",
        sun_disc="exclude",
        reasons={
            "maps": TargetReason(
                "Unreal imports a 2:1 .hdr as a TextureCube, and an .exr as a flat texture.",
                "https://dev.epicgames.com/documentation/en-us/unreal-engine/"
                "hdri-backdrop-visualization-tool-in-unreal-engine",
            ),
            "turn": TargetReason(
                "The importer finds +Y at the left edge and -Y in the middle; +X is east and +Y "
                "south there, as in Cesium for Unreal and the georeferencing plugin.",
                "TextureCompressorModule.cpp, LookupLongLat and TransformSideToWorldSpace",
            ),
            "cube": TargetReason("It makes the cube itself, from the 2:1 map.", "as of the maps"),
            "rows": CENTRES,
            "scale": NITS,
            "pixel": RGBE,
            "sun": SUN_AS_LIGHT,
        },
    ),
    Target(
        name="unity",
        title="Unity: material Skybox/Panoramic, or a texture of the shape Cube in a cross",
        maps={"equirect": EITHER, "cubemap": EITHER},
        axes=TargetAxes(east="+X", north="+Z", up="+Y"),
        verified=BY_DOCUMENTATION,
        rotation=WEST,
        cube_layout="cross",
        cube_space="flip-z",
        face_names="posx",
        sun_disc="exclude",
        reasons={
            "maps": TargetReason(
                "Skybox/Panoramic takes the flat texture; the importer takes crosses as cubes.",
                "https://docs.unity3d.com/Manual/class-Cubemap-create.html",
            ),
            "turn": TargetReason(
                "Skybox/Panoramic: u = 1/2 - atan2(z, x) / 2 pi, so -X, west, is at the left "
                "edge. How the importer turns a LatLong map into a cube is not published.",
                "Unity's built-in shaders, Skybox-Panoramic.shader, ToRadialCoords",
            ),
            "cube": TargetReason(
                "Its axes are left-handed with +Z in front: cubes hold the light with z negated.",
                "https://docs.unity3d.com/ScriptReference/CubemapFace.html",
            ),
            "rows": CENTRES,
            "scale": PHOTOGRAPH,
            "pixel": AUTO,
            "sun": SUN_AS_LIGHT,
        },
    ),
    Target(
        name="godot",
        title="Godot: PanoramaSkyMaterial",
        maps={"equirect": EITHER},
        axes=GRAPHICS,
        verified="Godot 3.2.3: directions of a map",
        sun_disc="exclude",
        reasons={
            "maps": TargetReason(
                "PanoramaSkyMaterial takes an equirect map, .exr or .hdr.",
                "https://docs.godotengine.org/en/stable/classes/class_panoramaskymaterial.html",
            ),
            "turn": TargetReason(OUR_AXES, "sky.glsl: u = atan(x, -z) / 2 pi"),
            "cube": NO_CUBE,
            "rows": CENTRES,
            "scale": PHOTOGRAPH,
            "pixel": AUTO,
            "sun": SUN_AS_LIGHT,
        },
    ),
    Target(
        name="bevy",
        title="Bevy: Skybox and EnvironmentMapLight",
        maps={"cubemap": (".ktx2",)},
        axes=GRAPHICS,
        verified=BY_DOCUMENTATION,
        cube_space="flip-z",
        pixel="half",
        sun_disc="exclude",
        reasons={
            "maps": TargetReason(
                "Bevy takes cubemaps only, which KTX2 holds in one file.",
                "https://docs.rs/bevy/latest/bevy/light/struct.EnvironmentMapLight.html",
            ),
            "turn": TargetReason("Cubes are not turned.", "as of the cube"),
            "cube": TargetReason(
                "It negates z before it samples a cube.",
                "crates/bevy_pbr/src/light_probe/environment_map.wgsl",
            ),
            "rows": CENTRES,
            "scale": TargetReason(
                "Texels are multiplied by brightness and intensity, in cd/m2: 39322. In cd/m2 "
                "themselves the light about the sun exceeds half floats.",
                "https://docs.rs/bevy/latest/bevy/light/struct.Skybox.html",
            ),
            "pixel": TargetReason(
                "Not all graphics hardware filters textures of floats.",
                "https://www.w3.org/TR/webgpu/#float32-filterable",
            ),
            "sun": SUN_AS_LIGHT,
        },
    ),
    Target(
        name="three",
        title="three.js: background and environment of a scene",
        maps={"equirect": EITHER, "cubemap": (".hdr", ".exr")},
        axes=GRAPHICS,
        verified="three.js r187: directions of maps, and level and shadow of a lit scene",
        rotation=WEST,
        cube_space="flip-x",
        sun_disc="exclude",
        reasons={
            "maps": TargetReason(
                "EXRLoader and HDRLoader with EquirectangularReflectionMapping, or six faces by "
                "HDRCubeTextureLoader; KTX2Loader reads no cubes that are not compressed.",
                "https://threejs.org/docs/#EXRLoader, https://threejs.org/docs/#HDRCubeTextureLoader",
            ),
            "turn": TargetReason(
                "u = atan(z, x) / 2 pi + 1/2: -X, west, is at the left edge. Cubes are not turned.",
                "src/renderers/shaders/ShaderChunk/common.glsl.js, equirectUv",
            ),
            "cube": TargetReason(
                "It negates x before it samples a cube that was loaded.",
                "src/renderers/shaders/ShaderChunk/envmap_fragment.glsl.js",
            ),
            "rows": CENTRES,
            "scale": PHOTOGRAPH,
            "pixel": AUTO,
            "sun": SUN_AS_LIGHT,
        },
    ),
    Target(
        name="filament",
        title="Filament: cmgen, for an IndirectLight and a Skybox",
        maps={"equirect": EITHER},
        axes=GRAPHICS,
        verified="cmgen 1.9.25: directions of a map",
        units="nits",
        sun_disc="exclude",
        reasons={
            "maps": TargetReason(
                "cmgen takes equirect maps, .exr or .hdr, and makes KTX of them.", "cmgen --help"
            ),
            "turn": TargetReason(OUR_AXES, "cmgen --extract of a map of directions"),
            "cube": TargetReason(
                "It samples cubes with directions of its world, as cmgen writes them.",
                "cmgen --extract of a map of directions",
            ),
            "rows": CENTRES,
            "scale": TargetReason(
                "It reckons light in cd/m2 with an intensity of 1, and exposes by a camera.",
                "https://google.github.io/filament/Filament.md.html#lighting/imagebasedlights",
            ),
            "pixel": AUTO,
            "sun": TargetReason(
                "cmgen filters the map at 1024 samples and loses a disc of a few texels.",
                "https://github.com/google/filament/issues/1387",
            ),
        },
    ),
)
