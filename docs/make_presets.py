"""Writes the tables of presets.md, from the project's root: ``python -m docs.make_presets``."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from pathlib import Path

from skybake.inspect.summary import summarise
from skybake.preset import load_preset, preset_names
from skybake.preset.cloud_kinds import DEFAULTS
from skybake.preset.constituents import GASES
from skybake.preset.tables import table_columns

DOCUMENT = Path(__file__).parent / "presets.md"

_PART = r"(<!-- {name}: written by docs/make_presets\.py -->\n).*?(<!-- end -->)"


def presets_table() -> str:
    """Names, titles and summary of the presets."""
    return _table(
        ("preset", "what it is", "optical depth", "visibility [km]", "sun [klx]", "its disc [deg]"),
        (_preset_row(name) for name in preset_names()),
    )


def _preset_row(name: str) -> tuple[str, ...]:
    planet = load_preset(name)
    summary = summarise(planet)
    green = int(abs(summary.wavelengths - 550.0).argmin())
    return (
        f"`{name}`",
        planet.title,
        f"{summary.constituents[-1].optical_depth[green]:.3g}",
        "" if summary.visibility is None else f"{summary.visibility:.3g}",
        f"{summary.sun_illuminance / 1e3:.4g}",
        f"{math.degrees(summary.sun_angular_diameter):.3g}",
    )


def tables_table() -> str:
    """Tables that come with skybake, by the keys that they serve."""
    keys: dict[str, list[str]] = {}
    for name, columns in table_columns().items():
        served = columns[1:]
        if columns[0] == "angle_deg":
            is_matrix = columns[1].startswith("p12_")
            served = ["phase.polarisation" if is_matrix else "phase.table"]
        served = ["profile"] if columns[0] == "altitude_km" else served
        for key in (key for key in served if not key.endswith("_bar")):
            keys.setdefault(key, []).append(f"`{name}`")
    return _table(
        ("key", "tables that come with skybake"),
        ((f"`{key}`", ", ".join(names)) for key, names in sorted(keys.items())),
    )


def gases_line() -> str:
    """Gases of a composition."""
    return f"Gases of a composition: {', '.join(f'`{gas}`' for gas in GASES)}.\n"


def clouds_table() -> str:
    """Kinds of clouds, as they are unless a preset says otherwise."""
    head = ("kind", *(f"`{key}`" for key in _CLOUD_KEYS), "wind [m/s]")
    return _table(
        head,
        (
            (
                f"`{kind}`",
                *(f"{value:g}" for value in usual[:5]),
                f'`"{usual.phase}"`',
                f"{usual.wind:g}",
            )
            for kind, usual in DEFAULTS.items()
        ),
    )


_CLOUD_KEYS = ("base_km", "depth_km", "size_km", "cover", "optical_depth", "phase")

PARTS: dict[str, Callable[[], str]] = {
    "presets": presets_table,
    "tables": tables_table,
    "gases": gases_line,
    "clouds": clouds_table,
}


def filled(text: str) -> str:
    """Return the document with its tables as they are now."""
    for name, make in PARTS.items():
        pattern = re.compile(_PART.format(name=name), re.DOTALL)
        part = f"\n{make()}\n"
        text, found = pattern.subn(lambda match, part=part: match[1] + part + match[2], text)
        if found != 1:
            raise SystemExit(f"presets.md: must have one part {name}, got {found}")
    return text


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = [f"| {' | '.join(cells)} |" for cells in (head, *rows)]
    lines.insert(1, f"|{'---|' * len(head)}")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    DOCUMENT.write_text(filled(DOCUMENT.read_text("utf-8")), "utf-8")
