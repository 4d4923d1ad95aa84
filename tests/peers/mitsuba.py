"""Mitsuba, by the map and the JSON of its light."""

import importlib
import json

import numpy as np

from tests.peers import scenes
from tests.peers.peer import AbsentError, Rendered

_VARIANT = "scalar_rgb"


def render(baked, _):
    """Render all views; parameters and errors are those of `tests.peers.blender.render`."""
    try:
        mitsuba = importlib.import_module("mitsuba")
    except ImportError as error:
        raise AbsentError("no package mitsuba") from error
    mitsuba.set_variant(_VARIANT)
    lights = _lights(baked)

    def view(objects, camera, width, height, samples):
        # One light at a time: a path tracer that chooses between two makes more noise.
        return sum(
            one_light({name: emitter, **objects}, camera, width, height, samples)
            for name, emitter in lights.items()
        )

    def one_light(objects, camera, width, height, samples):
        film = {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
            "component_format": "float32",
        }
        sampler = {"type": "independent", "sample_count": samples}
        scene = {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 5},
            "sensor": {**camera, "film": film, "sampler": sampler},
            **objects,
        }
        return np.array(mitsuba.render(mitsuba.load_dict(scene)))[..., :3]

    (wide, edge), (ball, across), (field, fine) = scenes.PLANE, scenes.BALL, scenes.POLE
    plane, pole = _plane(mitsuba), _pole(0.0, 0.0, scenes.POLE_HEIGHT, scenes.POLE_RADIUS)
    together = {
        "plane": plane,
        "white": _ball([-1.1, 1.0, 0.0], _diffuse()),
        "mirror": _ball([1.1, 1.0, 0.0], _mirror()),
        "pole": _pole(0.0, 1.6, 1.2, 0.06),
    }
    center = [0.0, 0.0, 0.0]
    north, above = _camera(mitsuba, "z", ball), _camera(mitsuba, "y", wide)
    views = scenes.Views(
        plane=view({"plane": plane}, above, edge, edge, 128),
        sphere=view({"ball": _ball(center, _diffuse())}, north, across, across, 128),
        mirror=view({"ball": _ball(center, _mirror())}, north, across, across, 16),
        pole=view({"plane": plane, "pole": pole}, _camera(mitsuba, "y", field), fine, fine, 16),
        picture=view(together, _perspective(mitsuba), *scenes.PICTURE, 64),
    )
    return Rendered(mitsuba.__version__, views)


def _lights(baked):
    sun = json.loads(baked.json.read_text("utf-8"))["sun"]
    return {
        "sky": {"type": "envmap", "filename": str(baked.map)},
        "sun": {
            "type": "directional",
            "direction": [-component for component in sun["target_direction"]],
            "irradiance": {
                "type": "rgb",
                "value": sun["irradiance"],
            },
        },
    }


def _diffuse():
    value = [scenes.ALBEDO] * 3
    return {"type": "diffuse", "reflectance": {"type": "rgb", "value": value}}


def _mirror():
    return {"type": "conductor", "material": "none"}


def _ball(center, material):
    return {"type": "sphere", "center": center, "radius": 1.0, "bsdf": material}


def _plane(mitsuba):
    turn = mitsuba.ScalarTransform4f
    to_world = turn().rotate([1, 0, 0], -90) @ turn().scale(50.0)
    return {"type": "rectangle", "to_world": to_world, "bsdf": _diffuse()}


def _pole(x, z, height, radius):
    return {
        "type": "cylinder",
        "p0": [x, 0.0, z],
        "p1": [x, height, z],
        "radius": radius,
        "bsdf": {"type": "twosided", "bsdf": _diffuse()},
    }


def _camera(mitsuba, axis, half_width):
    """An orthographic camera, from above or from the south."""
    origin, up = ([0, 10, 0], [0, 0, -1]) if axis == "y" else ([0, 0, 10], [0, 1, 0])
    turn = mitsuba.ScalarTransform4f
    look = turn().look_at(origin=origin, target=[0, 0, 0], up=up)
    scale = turn().scale([half_width, half_width, 1.0])
    return {"type": "orthographic", "to_world": look @ scale}


def _perspective(mitsuba):
    look = mitsuba.ScalarTransform4f().look_at(origin=[0, 2.2, 8], target=[0, 0.8, 0], up=[0, 1, 0])
    return {"type": "perspective", "fov": 40.0, "fov_axis": "x", "to_world": look}
