"""Sets of tables to test, and a reader of their files that is independent of the writer."""

import json
import math
import struct

import numpy as np

import skybake
from skybake.image.scene import Scene
from skybake.luts.bake import bake_tables, make_tables
from skybake.luts.formula import evaluate
from skybake.luts.settings import TableSettings

TABLES = ("transmittance", "multiple_scattering", "sky_view", "aerial_perspective")


def scene_of(preset="earth-hillaire2020", sun=5.0, altitude=2.0, **values):
    """A sky whose sun is in the south-west; degrees and km."""
    view = skybake.map_settings(
        sun_elevation=math.radians(sun),
        sun_azimuth=math.radians(215.0),
        altitude=altitude,
        **values,
    )
    return Scene(skybake.load_preset(preset), view)


def tables_of(scene, **values):
    return make_tables(scene, TableSettings(**values))


def baked(folder, scene, **values):
    """Bake into a folder; returns what ``luts.json`` says."""
    bake_tables(scene, folder, TableSettings(**values))
    return json.loads((folder / "luts.json").read_text())


def read_texture(path):
    """Texels of a KTX 2 file, by the places that docs/tables.md gives, (..., width, 4)."""
    data = path.read_bytes()
    form, _, width, height, depth = struct.unpack_from("<5I", data, 12)
    begin, size = struct.unpack_from("<2Q", data, 80)
    kind = {109: "<f4", 97: "<f2"}[form]
    texels = np.frombuffer(data[begin : begin + size], kind)
    return texels.reshape(*([depth] if depth else []), height, width, 4).astype(float)


def places(about, name):
    """What the texels of a table stand for, by the formulas of ``luts.json`` alone."""
    table = about["tables"][name]
    shares = {}
    for axis, one in enumerate(table["axes"]):
        number = one["texels"]
        index = np.arange(number)
        held = (index + 0.5) / number if one["placement"] == "centres" else index / (number - 1)
        shape = [1] * len(table["axes"])
        shape[-1 - axis] = number
        shares[one["share"]] = held.reshape(shape)
    known = evaluate("\n".join(table["inverse"]), {**constants(about), **shares})
    return tuple(known[one] for one in table["inputs"])


def constants(about):
    """Numbers of ``luts.json``."""
    values = {name: one["value"] for name, one in about["constants"].items()}
    return {name: value for name, value in values.items() if not isinstance(value, list)}


def vector(about, name):
    return np.array(about["constants"][name]["value"])
