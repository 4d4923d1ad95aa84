"""Physically based HDR sky maps for any sun, altitude and planet.

Names are imported when they are first used: the command line's help needs none
of numpy, numba and OpenImageIO.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from skybake.version import __version__

if TYPE_CHECKING:
    from skybake.baking import Baked, bake
    from skybake.baking.convert import Converted, convert
    from skybake.baking.orientation_chart import bake_orientation_chart
    from skybake.colour.camera import CameraResponse, load_camera
    from skybake.colour.space import ColourSpace
    from skybake.commands.in_notebook import StudioFrame, studio
    from skybake.environment.environment import Environment
    from skybake.environment.load import load_environment
    from skybake.environment.resample import resample
    from skybake.ephemeris.celestial import CelestialFrame
    from skybake.ephemeris.lit_moon import LitMoon, moon_by_hand
    from skybake.ephemeris.moment import Moment, TimeSpan, sun_at
    from skybake.ephemeris.moon import Moon
    from skybake.ephemeris.place import SITES, Place, find_place
    from skybake.errors import (
        ArgumentError,
        CancelledError,
        InputError,
        OutputError,
        PresetError,
        PresetWarning,
        SkybakeError,
    )
    from skybake.image.image import Image
    from skybake.image.light import Light
    from skybake.image.moon_figures import MoonFigures
    from skybake.image.moonlight import Moonlight
    from skybake.image.night import Night
    from skybake.image.picture_settings import PictureSettings
    from skybake.image.scene import Scene
    from skybake.image.sensor import Sensor
    from skybake.image.settings import Clouds, Encoding, Lighting, MapSettings, View, map_settings
    from skybake.image.target import TARGETS, Target, TargetAxes, TargetReason, find_target
    from skybake.jit.workers import Workers
    from skybake.luts.bake import BakedTables, bake_tables
    from skybake.luts.settings import TableSettings
    from skybake.optics.changes import PresetChanges
    from skybake.pipeline import Pipeline, Sky
    from skybake.preset import (
        Absorber,
        Aerosol,
        CloudLayer,
        Coefficients,
        Constituent,
        CornetteShanksPhase,
        DoubleHenyeyGreensteinPhase,
        ExponentialProfile,
        Gas,
        Ground,
        HenyeyGreensteinPhase,
        Override,
        Phase,
        Planet,
        PolarisationTable,
        Profile,
        RayleighPhase,
        Spectrum,
        Star,
        TabulatedPhase,
        TabulatedProfile,
        TentProfile,
        Tile,
        load_preset,
        preset_names,
    )
    from skybake.projection import (
        Angular,
        Cubemap,
        Equirect,
        Fisheye,
        Octahedral,
        Perspective,
        Projection,
    )
    from skybake.projection.camera import Camera
    from skybake.projection.frame import PictureAxes
    from skybake.sequence.bake import bake_sequence
    from skybake.sequence.exposure_curve import ExposureCurve
    from skybake.sequence.frame import FrameOutcome
    from skybake.sequence.moon_path import MoonPath
    from skybake.sequence.plan import Frame, Plan
    from skybake.sequence.planning import plan_sequence
    from skybake.sequence.products import Products, default_manifest
    from skybake.sequence.ramp import Ramp
    from skybake.sequence.run import FrameEvent, SequenceResult
    from skybake.sidecar.map_light import MapLight

__all__ = [
    "SITES",
    "TARGETS",
    "Absorber",
    "Aerosol",
    "Angular",
    "ArgumentError",
    "Baked",
    "BakedTables",
    "Camera",
    "CameraResponse",
    "CancelledError",
    "CelestialFrame",
    "CloudLayer",
    "Clouds",
    "Coefficients",
    "ColourSpace",
    "Constituent",
    "Converted",
    "CornetteShanksPhase",
    "Cubemap",
    "DoubleHenyeyGreensteinPhase",
    "Encoding",
    "Environment",
    "Equirect",
    "ExponentialProfile",
    "ExposureCurve",
    "Fisheye",
    "Frame",
    "FrameEvent",
    "FrameOutcome",
    "Gas",
    "Ground",
    "HenyeyGreensteinPhase",
    "Image",
    "InputError",
    "Light",
    "Lighting",
    "LitMoon",
    "MapLight",
    "MapSettings",
    "Moment",
    "Moon",
    "MoonFigures",
    "MoonPath",
    "Moonlight",
    "Night",
    "Octahedral",
    "OutputError",
    "Override",
    "Perspective",
    "Phase",
    "PictureAxes",
    "PictureSettings",
    "Pipeline",
    "Place",
    "Plan",
    "Planet",
    "PolarisationTable",
    "PresetChanges",
    "PresetError",
    "PresetWarning",
    "Products",
    "Profile",
    "Projection",
    "Ramp",
    "RayleighPhase",
    "Scene",
    "Sensor",
    "SequenceResult",
    "Sky",
    "SkybakeError",
    "Spectrum",
    "Star",
    "StudioFrame",
    "TableSettings",
    "TabulatedPhase",
    "TabulatedProfile",
    "Target",
    "TargetAxes",
    "TargetReason",
    "TentProfile",
    "Tile",
    "TimeSpan",
    "View",
    "Workers",
    "__version__",
    "bake",
    "bake_orientation_chart",
    "bake_sequence",
    "bake_tables",
    "convert",
    "default_manifest",
    "find_place",
    "find_target",
    "load_camera",
    "load_environment",
    "load_preset",
    "map_settings",
    "moon_by_hand",
    "plan_sequence",
    "preset_names",
    "resample",
    "studio",
    "sun_at",
]

_HOMES = {
    "Absorber": "skybake.preset",
    "Aerosol": "skybake.preset",
    "Angular": "skybake.projection",
    "ArgumentError": "skybake.errors",
    "Baked": "skybake.baking",
    "BakedTables": "skybake.luts.bake",
    "Camera": "skybake.projection.camera",
    "CameraResponse": "skybake.colour.camera",
    "CancelledError": "skybake.errors",
    "CelestialFrame": "skybake.ephemeris.celestial",
    "CloudLayer": "skybake.preset",
    "Clouds": "skybake.image.settings",
    "Coefficients": "skybake.preset",
    "ColourSpace": "skybake.colour.space",
    "Constituent": "skybake.preset",
    "Converted": "skybake.baking.convert",
    "CornetteShanksPhase": "skybake.preset",
    "Cubemap": "skybake.projection",
    "DoubleHenyeyGreensteinPhase": "skybake.preset",
    "Encoding": "skybake.image.settings",
    "Environment": "skybake.environment.environment",
    "Equirect": "skybake.projection",
    "ExponentialProfile": "skybake.preset",
    "ExposureCurve": "skybake.sequence.exposure_curve",
    "Fisheye": "skybake.projection",
    "Frame": "skybake.sequence.plan",
    "FrameEvent": "skybake.sequence.run",
    "FrameOutcome": "skybake.sequence.frame",
    "Gas": "skybake.preset",
    "Ground": "skybake.preset",
    "HenyeyGreensteinPhase": "skybake.preset",
    "Image": "skybake.image.image",
    "InputError": "skybake.errors",
    "Light": "skybake.image.light",
    "Lighting": "skybake.image.settings",
    "LitMoon": "skybake.ephemeris.lit_moon",
    "MapLight": "skybake.sidecar.map_light",
    "MapSettings": "skybake.image.settings",
    "Moment": "skybake.ephemeris.moment",
    "Moon": "skybake.ephemeris.moon",
    "MoonFigures": "skybake.image.moon_figures",
    "MoonPath": "skybake.sequence.moon_path",
    "Moonlight": "skybake.image.moonlight",
    "Night": "skybake.image.night",
    "Octahedral": "skybake.projection",
    "OutputError": "skybake.errors",
    "Override": "skybake.preset",
    "Perspective": "skybake.projection",
    "PictureAxes": "skybake.projection.frame",
    "Phase": "skybake.preset",
    "PictureSettings": "skybake.image.picture_settings",
    "Pipeline": "skybake.pipeline",
    "Place": "skybake.ephemeris.place",
    "Plan": "skybake.sequence.plan",
    "Planet": "skybake.preset",
    "PolarisationTable": "skybake.preset",
    "PresetChanges": "skybake.optics.changes",
    "PresetError": "skybake.errors",
    "PresetWarning": "skybake.errors",
    "Products": "skybake.sequence.products",
    "Profile": "skybake.preset",
    "Projection": "skybake.projection",
    "Ramp": "skybake.sequence.ramp",
    "RayleighPhase": "skybake.preset",
    "Scene": "skybake.image.scene",
    "Sensor": "skybake.image.sensor",
    "SequenceResult": "skybake.sequence.run",
    "SITES": "skybake.ephemeris.place",
    "Sky": "skybake.pipeline",
    "SkybakeError": "skybake.errors",
    "Spectrum": "skybake.preset",
    "Star": "skybake.preset",
    "StudioFrame": "skybake.commands.in_notebook",
    "TableSettings": "skybake.luts.settings",
    "TabulatedPhase": "skybake.preset",
    "TabulatedProfile": "skybake.preset",
    "Target": "skybake.image.target",
    "TargetAxes": "skybake.image.target",
    "TargetReason": "skybake.image.target",
    "TARGETS": "skybake.image.target",
    "TentProfile": "skybake.preset",
    "Tile": "skybake.preset",
    "TimeSpan": "skybake.ephemeris.moment",
    "View": "skybake.image.settings",
    "Workers": "skybake.jit.workers",
    "bake": "skybake.baking",
    "bake_orientation_chart": "skybake.baking.orientation_chart",
    "bake_sequence": "skybake.sequence.bake",
    "bake_tables": "skybake.luts.bake",
    "convert": "skybake.baking.convert",
    "default_manifest": "skybake.sequence.products",
    "find_place": "skybake.ephemeris.place",
    "find_target": "skybake.image.target",
    "load_camera": "skybake.colour.camera",
    "load_environment": "skybake.environment.load",
    "load_preset": "skybake.preset",
    "map_settings": "skybake.image.settings",
    "moon_by_hand": "skybake.ephemeris.lit_moon",
    "plan_sequence": "skybake.sequence.planning",
    "preset_names": "skybake.preset",
    "resample": "skybake.environment.resample",
    "studio": "skybake.studio",
    "sun_at": "skybake.ephemeris.moment",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
