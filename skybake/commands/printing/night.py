"""What is printed of the lights of a map's night."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def night_lines(night: Mapping[str, Any]) -> list[str]:
    """Return lines on the attributes of a night, human-readable, none by day."""
    if not night:
        return []
    from skybake.image.night_figures import (
        NIGHT_ILLUMINANCE,
        STAR_ILLUMINANCE,
        ZENITH_LUMINANCE,
        surface_magnitude,
    )

    lines = []
    if NIGHT_ILLUMINANCE in night:
        zenith = night[ZENITH_LUMINANCE]
        lines.append(
            f"night sky {night[NIGHT_ILLUMINANCE]:.3g} lx on the horizontal, zenith {zenith:.3g} "
            f"cd/m2 ({surface_magnitude(zenith):.2f} mag/arcsec2)"
        )
    if STAR_ILLUMINANCE in night:
        lines.append(f"stars {night[STAR_ILLUMINANCE]:.3g} lx on the horizontal")
    return lines


def night_result(night: Mapping[str, Any]) -> dict[str, Any]:
    """Return what ``--json`` prints of the attributes of a night, see docs/cli.md."""
    if not night:
        return {"star_illuminance_lux": None, "night": None}
    from skybake.image.night_figures import (
        AIRGLOW_SCALE,
        NIGHT_ILLUMINANCE,
        ROTATION,
        STAR_ILLUMINANCE,
        ZENITH_LUMINANCE,
        surface_magnitude,
    )

    zenith = night.get(ZENITH_LUMINANCE)
    return {
        "star_illuminance_lux": night.get(STAR_ILLUMINANCE),
        "night": {
            "sky_illuminance_lux": night.get(NIGHT_ILLUMINANCE),
            "zenith_luminance_cd_m2": zenith,
            "zenith_mag_arcsec2": None if zenith is None else surface_magnitude(zenith),
            "airglow_scale": night.get(AIRGLOW_SCALE),
            "celestial_rotation": list(night[ROTATION]),
        },
    }
