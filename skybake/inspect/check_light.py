"""Whether a map holds the light that it states."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from skybake.colour.space import ColourSpace, luminance_weights
from skybake.inspect.check_tags import numbers
from skybake.inspect.finding import Finding
from skybake.inspect.seen import Seen
from skybake.projection.equirect import EquirectChart
from skybake.projection.of_file import file_recipe

TOLERANCE, CLOUDY_TOLERANCE = 0.02, 0.05
"""Of the illuminance by sky and sun, under a clear sky and under clouds, which a map's pixels and
the stated figures sample at different places."""

_ALL = 0.99
_NOTICEABLE = 0.05
_TEXELS = 2.0
_HEIGHT = 0.6


def light_findings(
    seen: Sequence[Seen], attributes: Mapping[str, Any], space: ColourSpace, part: str
) -> Iterator[Finding]:
    """Yield where the light of a map is not what its attributes state.

    Parameters
    ----------
    seen : sequence of Seen
        All of the map.
    attributes : mapping
        Of its file. One that states no illuminance is not checked.
    space : ColourSpace
        Of the pixels.
    part : str
        Name of the part of the file, empty if it has but one.
    """
    held = _held(attributes, part)
    white, stated = _figure(attributes, "whiteLuminance"), _stated(attributes, held)
    sizes = [one.sizes() for one in seen]
    if white is None or stated is None or not held or not seen:
        return
    vectors = [one.vectors() for one in seen]
    above = sum(float(size[v[..., 1] >= 0.0].sum()) for size, v in zip(sizes, vectors, strict=True))
    if above < _ALL * 2.0 * math.pi:
        return
    weights = (luminance_weights(space) * white).astype(np.float32)
    luminance = [one.rgb @ weights for one in seen]
    found = sum(
        float((each * np.maximum(v[..., 1], 0.0) * size).sum(dtype=np.float64))
        for each, v, size in zip(luminance, vectors, sizes, strict=True)
    )
    whole = _stated(attributes, ("sky", "sun")) or stated
    allowed = _tolerance(attributes) * whole
    if "sun" in held and not isinstance(seen[0].chart, EquirectChart):
        # Elsewhere the disc keeps its light, but not its height within a texel.
        normal = _figure(attributes, "skybake:directNormalIlluminance") or 0.0
        allowed += _HEIGHT * math.sqrt(max(float(size.max()) for size in sizes)) * normal
    if abs(found - stated) > allowed:
        yield Finding(
            "illuminance",
            True,
            f"{found:.5g} lx on the horizontal by {' and '.join(held)}, not the stated "
            f"{stated:.5g} lx",
        )
    if "sun" in held:
        yield from _sun_findings(luminance, vectors, sizes, attributes)


def _held(attributes: Mapping[str, Any], part: str) -> tuple[str, ...]:
    """Which light a part holds, of sky, sun, Moon and stars; none where that is not known."""
    shown = file_recipe(attributes).get("map")
    disc = shown.get("sun_disc", "include") if isinstance(shown, dict) else "include"
    stars = ("stars",) if "skybake:starIlluminance" in attributes else ()
    moon = ("moon",) if "skybake:moonIlluminance" in attributes else ()
    if isinstance(shown, dict) and shown.get("stars") == "only":
        return stars
    by_disc = {"include": ("sky", "sun", *moon), "exclude": ("sky",), "only": ("sun",)}
    if isinstance(shown, dict) and shown.get("moonlight") == "only":
        by_disc["include"] = ("sky", *moon)
    if part in {"", "beauty"}:
        return (*by_disc.get(disc, ("sky",)), *stars)
    return (part,) if part in {"sky", "sun", "moon", "stars"} else ()


def _tolerance(attributes: Mapping[str, Any]) -> float:
    preset = file_recipe(attributes).get("preset")
    return CLOUDY_TOLERANCE if isinstance(preset, dict) and preset.get("clouds") else TOLERANCE


def _stated(attributes: Mapping[str, Any], held: Sequence[str]) -> float | None:
    names = {
        "sky": "skybake:skyIlluminance",
        "sun": "skybake:directIlluminance",
        "moon": "skybake:moonIlluminance",
        "stars": "skybake:starIlluminance",
    }
    figures = [_figure(attributes, names[one]) for one in held]
    whole = [figure for figure in figures if figure is not None]
    return sum(whole) if len(whole) == len(figures) else None


def _figure(attributes: Mapping[str, Any], name: str) -> float | None:
    found = numbers(attributes.get(name))
    return float(found.ravel()[0]) if found is not None and found.size == 1 else None


def _sun_findings(
    luminance: Sequence[np.ndarray],
    vectors: Sequence[np.ndarray],
    sizes: Sequence[np.ndarray],
    attributes: Mapping[str, Any],
) -> Iterator[Finding]:
    """Yield a finding if the brightest pixel is not where the sun is stated to be."""
    sun = numbers(attributes.get("skybake:sunDirection"))
    direct = _figure(attributes, "skybake:directNormalIlluminance") or 0.0
    sky = _figure(attributes, "skybake:skyIlluminance") or 0.0
    if sun is None or sun.size != 3 or not direct > _NOTICEABLE * sky:
        return
    number = int(np.argmax([each.max() for each in luminance]))
    place = np.unravel_index(int(luminance[number].argmax()), luminance[number].shape)
    cosine = float(np.clip(vectors[number][place] @ (sun / np.linalg.norm(sun)), -1.0, 1.0))
    away = math.acos(cosine)
    shown = file_recipe(attributes).get("map")
    drawn = shown.get("sun_size_deg") if isinstance(shown, dict) else None
    # Beside a pole texels are narrow, and the disc spreads over many.
    texel = max(math.sqrt(float(size.max())) for size in sizes)
    if away > _TEXELS * texel + 0.5 * math.radians(drawn or 2.0):
        yield Finding(
            "sun",
            True,
            f"the brightest pixel is {math.degrees(away):.1f}deg from skybake:sunDirection",
        )
