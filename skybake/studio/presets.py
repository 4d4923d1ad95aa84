"""The presets that come with skybake, as the page's gallery shows them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from skybake.preset import load_document, preset_names

PICTURES = Path(__file__).parent / "pictures"
"""Made by docs/make_gallery.py."""


def preset_list() -> list[dict[str, Any]]:
    """Return name, title, summary and address of the picture of each preset, fit for JSON."""
    listed = []
    for name in preset_names():
        title, _, summary = load_document(name).data["title"].partition(": ")
        picture = f"/api/preset-picture/{name}"
        listed.append({"name": name, "title": title, "summary": summary, "picture": picture})
    return listed


def preset_picture(name: str) -> bytes | None:
    """Return the JPEG of a preset, or None where there is none of that name."""
    pictures = {path.stem: path for path in PICTURES.glob("*.jpg")}
    return pictures[name].read_bytes() if name in pictures else None
