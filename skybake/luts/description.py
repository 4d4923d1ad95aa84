"""What a set of tables states of itself in ``luts.json``: all that is needed to sample it."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping as Values
from typing import Any

import numpy as np

from skybake.image.scene import Scene
from skybake.luts.constants import Constants
from skybake.luts.mapping import PLACEMENTS
from skybake.luts.parametrisations import INPUTS
from skybake.luts.settings import TableSettings
from skybake.luts.table import Table
from skybake.luts.transmittance import colour_shares
from skybake.optics.medium import Array
from skybake.optics.phase import eval_phase
from skybake.units import degrees, metres
from skybake.version import __version__

VERSION = 1
"""Of the layout of ``luts.json``."""

PROFILE_NODES = 65
PHASE_NODES = 91

_CONVENTIONS = {
    "axes": "right-handed, +X east, +Y up, +Z south (-Z north); azimuths are compass bearings, "
    "clockwise from north; angles in radians, lengths in km",
    "texture_coordinates": "u from left to right, v from the first row of the file, w from the "
    "first slice, each 0 to 1 over the whole texture",
    "sampling": "linear filter, clamp to edge, no mip levels",
    "exr_of_a_volume": "slices one above the other, the first on top",
    "values": "linear; radiance in units of white_luminance_cd_m2",
    "formulas": "lines of name = expression; a if condition else b chooses; names in capitals are "
    "constants",
    "shares": "x, y, z: 0 to 1 along an axis; lookup gives texture coordinates of the inputs, "
    "inverse gives the inputs of the shares that texels stand for",
}


def tables_recipe(scene: Scene, settings: TableSettings) -> dict[str, Any]:
    """All that decides the tables, in human-readable units, fit for JSON."""
    lighting, encoding = scene.settings.lighting, scene.settings.encoding
    distance = lighting.sun_distance
    return {
        "tables": {
            "sun_elevation_deg": degrees(lighting.sun_elevation),
            "sun_azimuth_deg": degrees(lighting.sun_azimuth),
            **({} if distance is None else {"sun_distance_au": distance}),
            "altitude_m": metres(scene.settings.view.altitude),
            "method": lighting.method,
            "colorspace": encoding.colorspace,
            "white_luminance_cd_m2": encoding.white_luminance,
            "parametrisation": settings.parametrisation,
            **{f"{name}_size": list(size) for name, size in settings.sizes.items()},
            "fov_deg": degrees(settings.fov),
            "aspect": settings.aspect,
            "look_azimuth_deg": degrees(settings.azimuth),
            "look_elevation_deg": degrees(settings.elevation),
            **({"roll_deg": degrees(settings.roll)} if settings.roll else {}),
            **({"lens_shift": list(settings.shift)} if any(settings.shift) else {}),
            "far_km": settings.far,
            "pixel": settings.pixel,
        },
        "preset": scene.planet.recipe,
    }


def recipe_hash(recipe: Values[str, Any]) -> str:
    """Digest of a recipe and of the version that makes the tables."""
    text = json.dumps([__version__, recipe], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def describe_tables(
    scene: Scene,
    settings: TableSettings,
    tables: Values[str, Table],
    files: Values[str, list[str]],
    constants: Constants,
) -> dict[str, Any]:
    """Return the content of ``luts.json``.

    Parameters
    ----------
    scene : Scene
        The observer, the sun and the scale.
    settings : TableSettings
        What the tables are like.
    tables : mapping of str to Table
        By name.
    files : mapping of str to list of str
        Names of each table's files, and of ``code`` in each language.
    constants : Constants
        Of formulas and code.
    """
    encoding, planet = scene.settings.encoding, scene.planet
    recipe = tables_recipe(scene, settings)
    return {
        "version": VERSION,
        "generator": f"skybake {__version__}",
        "preset": planet.name,
        "method": scene.settings.lighting.method,
        "parametrisation": settings.parametrisation,
        "colour": {
            "space": encoding.space.name,
            "interop_id": encoding.space.interop_id,
            "chromaticities": list(encoding.space.chromaticities),
            "white_luminance_cd_m2": encoding.white_luminance,
        },
        "conventions": _CONVENTIONS,
        "constants": {
            name: {"value": list(value) if isinstance(value, tuple) else value, "meaning": meaning}
            for name, (value, meaning) in constants.items()
        },
        "tables": {name: _describe(table, files[name]) for name, table in tables.items()},
        "sun": _sun(scene),
        "medium": _medium(scene),
        "code": files["code"],
        "recipe": recipe,
        "recipe_hash": recipe_hash(recipe),
    }


def _describe(table: Table, files: list[str]) -> dict[str, Any]:
    mapping = table.mapping
    shares = "xyz"
    return {
        "files": files,
        "size": list(table.size),
        "channels": list(table.channels),
        "quantity": table.quantity,
        "unit": table.unit,
        "is_radiance": table.is_radiance,
        "range": [float(table.values.min()), float(table.values.max())],
        "inputs": {name: INPUTS[name] for name in mapping.inputs},
        "axes": [
            {
                "coordinate": texture,
                "share": shares[axis],
                "texels": table.size[axis],
                "placement": mapping.placements[axis],
                "shares_of_texels": PLACEMENTS[mapping.placements[axis]],
            }
            for axis, texture in enumerate(mapping.textures)
        ],
        "lookup": mapping.lookup(table.size).splitlines(),
        "inverse": mapping.inverse.strip().splitlines(),
    }


def _sun(scene: Scene) -> dict[str, Any]:
    source = scene.sky.source
    xyz, _ = scene.sun_xyz()
    return {
        "elevation_deg": degrees(source.elevation),
        "azimuth_deg": degrees(source.azimuth),
        "angular_radius_rad": source.angular_radius,
        "solid_angle_sr": 2.0 * math.pi * (1.0 - math.cos(source.angular_radius)),
        "illuminance_above_atmosphere_lx": float(scene.xyz_weights[:, 1].sum()),
        "illuminance_lx": float(xyz[1]),
    }


def _medium(scene: Scene) -> dict[str, Any]:
    """Describe what the air consists of, for programs that march through it themselves."""
    medium, planet = scene.sky.medium, scene.planet
    shares = colour_shares(scene.rgb_weights)
    height = medium.r_top - medium.r_bottom
    nodes = np.linspace(0.0, 1.0, PROFILE_NODES) ** 2
    places = np.sqrt(nodes) * (len(medium.density) - 1)
    density = np.stack(
        [np.interp(places, np.arange(len(each)), each) for each in medium.density.T], axis=0
    )
    is_exact = planet.rendering != "spectral"
    angle = np.linspace(0.0, 1.0, PHASE_NODES) ** 2 * math.pi
    phase = eval_phase(medium.phase, np.cos(angle))
    scattered = medium.scattering[:, :, None] * shares
    return {
        "colours": "of the wavelengths that stand for red, green and blue"
        if is_exact
        else "means over sunlight, approximate where air is thick: transmittance is no exponential "
        "of them",
        "altitude_km": (nodes * height).tolist(),
        "scattering_angle_rad": angle.tolist(),
        "constituents": {
            constituent.name: {
                "scattering_per_km": (medium.scattering[i] @ shares).tolist(),
                "extinction_per_km": (medium.extinction[i] @ shares).tolist(),
                "relative_density": density[i].tolist(),
                "phase_per_sr": _weighted(phase[:, i], scattered[i]).tolist(),
            }
            for i, constituent in enumerate(planet.constituents)
        },
        "ground_albedo": (medium.ground_albedo @ shares).tolist(),
    }


def _weighted(values: Array, weights: Array) -> Array:
    """Means over wavelengths by the weights of each colour, 0 where there are none, (angle, 3)."""
    total = weights.sum(axis=0)
    return (values @ weights) / np.where(total == 0.0, 1.0, total)
