"""TOML to `Planet`, with every check on what the user wrote."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, cast

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.preset.clouds_model import CloudLayer
from skybake.preset.constituents import Top, read_constituent
from skybake.preset.document import Document
from skybake.preset.extend import NAME, Overrides, load_document
from skybake.preset.find import find_preset
from skybake.preset.message import shown
from skybake.preset.model import Constituent, Ground, Planet, Star
from skybake.preset.recipe import recipe_of
from skybake.preset.section import Gather, Section

MAX_CONSTITUENTS = 16
"""More than any known sky needs, and few enough for registers and cache."""

MAX_WAVELENGTHS = 128
"""Memory and time of an atmosphere's tables grow with each of them."""

VISIBLE = (380.0, 720.0)
"""What spectra must cover, unless the preset chooses its wavelengths. [nm]"""

EYE = (360.0, 830.0)
"""What a star's spectrum must cover: the wavelengths of the CIE observer. [nm]"""


def load_preset(name_or_path: str | Path, overrides: Overrides = ()) -> Planet:
    """Load a planet.

    Parameters
    ----------
    name_or_path : str or Path
        Name of a preset that comes with skybake, or a TOML file of the user's (a
        Path, or a text that ends in ``.toml`` or has a path separator).
    overrides : mapping of str to Any, or iterable of Override, optional
        What to change: values as in TOML by dotted keys, in which the prefix
        ``constituents.`` may be left out: ``{"aerosol.optical_depth": 0.3,
        "ground.albedo": "grassland"}``. The value "none" removes a key.

    Returns
    -------
    Planet
        Checked throughout: what it describes can be rendered.

    Raises
    ------
    PresetError
        With the file, the key and the rule that it breaks; its `faults` are all errors.

    Warns
    -----
    PresetWarning
        If a table had to be normalised.
    """
    path = find_preset(name_or_path)
    document = load_document(path, overrides)
    planet = planet_from_document(document, name=path.stem)
    return replace(planet, recipe=recipe_of(document, path.parent))


def planet_from_document(document: Document, *, name: str) -> Planet:
    """Build a planet from a preset, without its recipe.

    Parameters
    ----------
    document : Document
        The merged preset.
    name : str
        The planet's name.

    Raises
    ------
    PresetError
        With all errors.
    """
    top = Section(document)
    read = Gather(top)
    title = read(top.text, "title")
    data_quality = read(_read_data_quality, top)
    rendering = read(top.choice, "rendering", ("spectral", "rgb"), default="spectral")
    wavelengths = read(_read_wavelengths, top, rendering)
    if wavelengths:
        top.cover = (min(wavelengths), max(wavelengths))
    elif rendering == "spectral" and not top.has("wavelengths_nm"):
        top.cover = VISIBLE
    radius, highest = read(_read_body, top) or (None, None)
    star = read(_read_star, top)
    ground = read(_read_ground, top)
    constituents = read(_read_constituents, top, highest)
    clouds = read(_read_clouds, top, highest)
    read.finish()
    return Planet(
        name=name,
        title=title,
        radius=radius,
        atmosphere_top=highest.altitude,
        rendering=cast(Any, rendering),
        wavelengths=wavelengths,
        star=star,
        ground=ground,
        constituents=constituents,
        recipe={},
        data_quality=data_quality,
        clouds=clouds,
    )


def _read_data_quality(top: Section) -> str | None:
    if not top.has("data_quality"):
        return None
    text = top.raw("data_quality")
    if not isinstance(text, str) or not text.strip():
        top.fail("data_quality", f"must be text, got {shown(text)}")
    return text.strip()


def _read_wavelengths(top: Section, rendering: str) -> tuple[float, ...] | None:
    wavelengths = top.numbers("wavelengths_nm", 100.0, 1e5) if top.has("wavelengths_nm") else None
    if rendering == "rgb" and (wavelengths is None or len(wavelengths) != 3):
        top.fail("wavelengths_nm", "rendering = 'rgb' needs three: for red, green and blue")
    if wavelengths and len(wavelengths) > MAX_WAVELENGTHS:
        top.fail("wavelengths_nm", f"must be at most {MAX_WAVELENGTHS}, got {len(wavelengths)}")
    if wavelengths and len(set(wavelengths)) < len(wavelengths):
        top.fail("wavelengths_nm", "must differ from each other")
    return wavelengths


def _read_body(top: Section) -> tuple[float, Top]:
    section = top.section("planet")
    read = Gather(section)
    radius = read(section.number, "radius_km", 1.0, 1e6)
    # A top beyond one radius would be an exosphere, which no plane layer of tables resolves.
    atmosphere_top = read(section.number, "atmosphere_top_km", 0.1, radius or 1e6)
    read.finish()
    return radius, Top(atmosphere_top, section.where("atmosphere_top_km"))


def _read_star(top: Section) -> Star:
    section = top.section("star")
    read = Gather(section)
    radius = read(section.number, "radius_km", 1.0, 1e10)
    distance = read(section.number, "distance_au", 1e-3, 1e5)
    u = read(section.spectrum, "limb_darkening_u", -2.0, 2.0, default=0.0)
    v = read(section.spectrum, "limb_darkening_v", -2.0, 2.0, default=0.0)
    section.cover = EYE
    irradiance = read(section.spectrum, "irradiance_w_m2_nm", 0.0, 1e9)
    read.finish()
    star = Star(radius, distance * ASTRONOMICAL_UNIT, irradiance, u, v)
    if star.radius >= star.distance:
        other = section.where("distance_au")
        section.fail(
            "radius_km", f"must be less than the distance, {star.distance:g} km (see {other})"
        )
    return star


def _read_ground(top: Section) -> Ground:
    section = top.section("ground")
    read = Gather(section)
    albedo = read(section.spectrum, "albedo", 0.0, 1.0)
    read.finish()
    return Ground(albedo)


def _read_constituents(top: Section, highest: Top | None) -> tuple[Constituent, ...]:
    section = top.section("constituents")
    names = section.keys()
    if len(names) > MAX_CONSTITUENTS:
        section.fail("", f"must be at most {MAX_CONSTITUENTS}, got {len(names)}")
    for name in names:
        if not NAME.fullmatch(name):
            section.fail("", f"names must consist of letters, digits, _ and -, got {shown(name)}")
    read = Gather()
    constituents = tuple(read(_read_one, section, name, highest) for name in names)
    read.finish()
    return constituents


def _read_clouds(top: Section, highest: Top | None) -> tuple[CloudLayer, ...]:
    if not top.has("clouds"):
        return ()
    from skybake.preset.clouds import read_clouds

    return read_clouds(top.section("clouds"), highest)


def _read_one(section: Section, name: str, highest: Top | None) -> Constituent:
    return read_constituent(name, section.section(name), highest)
