"""TOML to `Planet`, with every check on what the user wrote."""

from __future__ import annotations

import re
import tomllib
from hashlib import sha256
from pathlib import Path
from typing import Any, cast

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.errors import PresetError
from skybake.preset.constituents import read_constituent
from skybake.preset.find import display_name, find_preset, read_text
from skybake.preset.message import shown
from skybake.preset.model import Ground, Planet, Star
from skybake.preset.section import Section
from skybake.preset.tables import is_user_file

MAX_CONSTITUENTS = 16
"""More than any known sky needs, few enough for kernels to hold in registers and cache."""


_NAME = re.compile(r"[A-Za-z0-9_-]+")


def load_preset(name_or_path: str | Path) -> Planet:
    """Load a planet.

    Parameters
    ----------
    name_or_path : str or Path
        Name of a preset that comes with skybake, or a TOML file of the user's (a
        Path, or a text that ends in ``.toml`` or has a path separator).

    Returns
    -------
    Planet
        Checked throughout: what it describes can be rendered.

    Raises
    ------
    PresetError
        With the file, the key and the rule that it breaks.
    """
    path = find_preset(name_or_path)
    file = display_name(path)
    text = read_text(path, file)
    try:
        document = tomllib.loads(text)
    # A ValueError that is no TOMLDecodeError comes from an integer of thousands of digits.
    except (ValueError, RecursionError) as error:
        raise PresetError(f"{file}: not valid TOML: {error}") from error
    return planet_from_document(document, file=file, name=path.stem, folder=path.parent)


def planet_from_document(document: dict[str, Any], *, file: str, name: str, folder: Path) -> Planet:
    """Build a planet from a parsed preset.

    Parameters
    ----------
    document : dict
        The preset as parsed from TOML.
    file, name : str
        How messages call it; the planet's name.
    folder : Path
        What paths to the user's tables are relative to.

    Raises
    ------
    PresetError
        With the file, the key and the rule that it breaks.
    """
    top = Section(file, "", document, folder)
    title = top.text("title")
    rendering = top.choice("rendering", ("spectral", "rgb"), default="spectral")
    wavelengths = top.numbers("wavelengths_nm", 100.0, 1e5) if top.has("wavelengths_nm") else None
    if rendering == "rgb" and (wavelengths is None or len(wavelengths) != 3):
        top.fail("wavelengths_nm", "rendering = 'rgb' needs three: for red, green and blue")
    if wavelengths and len(set(wavelengths)) < len(wavelengths):
        top.fail("wavelengths_nm", "must differ from each other")
    body = top.section("planet")
    radius = body.number("radius_km", 1.0, 1e6)
    # A top beyond one radius would be an exosphere, which no plane layer of tables resolves.
    atmosphere_top = body.number("atmosphere_top_km", 0.1, radius)
    body.finish()
    star = _read_star(top.section("star"))
    ground = top.section("ground")
    albedo = ground.spectrum("albedo", 0.0, 1.0)
    ground.finish()
    constituents = top.section("constituents")
    names = constituents.keys()
    if not 1 <= len(names) <= MAX_CONSTITUENTS:
        constituents.fail("", f"must be 1 to {MAX_CONSTITUENTS}, got {len(names)}")
    for key in names:
        if not _NAME.fullmatch(key):
            constituents.fail("", f"names must be of letters, digits, _ and -, got {shown(key)}")
    top.finish()
    return Planet(
        name=name,
        title=title,
        radius=radius,
        atmosphere_top=atmosphere_top,
        rendering=cast(Any, rendering),
        wavelengths=wavelengths,
        star=star,
        ground=Ground(albedo),
        constituents=tuple(
            read_constituent(key, constituents.section(key), atmosphere_top) for key in names
        ),
        recipe=_recipe(document, folder),
    )


def _read_star(section: Section) -> Star:
    star = Star(
        radius=section.number("radius_km", 1.0, 1e10),
        distance=section.number("distance_au", 1e-3, 1e5) * ASTRONOMICAL_UNIT,
        irradiance=section.spectrum("irradiance_w_m2_nm", 0.0, 1e9),
        limb_darkening_u=section.spectrum("limb_darkening_u", -2.0, 2.0, default=0.0),
        limb_darkening_v=section.spectrum("limb_darkening_v", -2.0, 2.0, default=0.0),
    )
    if star.radius >= star.distance:
        section.fail("radius_km", f"must be less than the distance, {star.distance:g} km")
    section.finish()
    return star


def _recipe(document: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Copy of the document with the digests of the user's own tables under ``"files"``."""
    names = sorted(set(_user_files(document)))
    if not names:
        return dict(document)
    digests = {name: sha256((folder / name).read_bytes()).hexdigest() for name in names}
    return {**document, "files": digests}


def _user_files(value: Any, key: str = "") -> list[str]:
    if isinstance(value, dict):
        return [name for k, v in value.items() for name in _user_files(v, k)]
    return [value] if isinstance(value, str) and key != "title" and is_user_file(value) else []
