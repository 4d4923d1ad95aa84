"""Texts of attributes in pieces, for programs that read no more than 255 bytes of one.

FFmpeg 5.1 goes on reading the header in the middle of a longer text, and shows a black picture.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

LONGEST = 255
"""Of the text of an attribute of OpenEXR. [byte]"""

_LONGEST_LETTER = 4


def pieces(name: str, text: str) -> Iterator[tuple[str, str]]:
    """Yield names and texts of the attributes that hold a text: ``name``, ``name:2`` and so on."""
    left = text.encode("utf-8", "surrogatepass")
    count = 0
    while left or not count:
        end = min(LONGEST, len(left))
        while end < len(left) and left[end] & 0xC0 == 0x80:
            end -= 1
        count += 1
        piece = left[:end].decode("utf-8", "surrogatepass")
        yield (name if count == 1 else f"{name}:{count}"), piece
        left = left[end:]


def joined(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Return attributes with texts whole that `pieces` divided."""
    whole = dict(attributes)
    for name in attributes:
        count, last = 2, whole.get(name)
        while _is_full(last) and isinstance(whole.get(f"{name}:{count}"), str):
            last = whole.pop(f"{name}:{count}")
            whole[name] += last
            count += 1
    return whole


def _is_full(text: Any) -> bool:
    return (
        isinstance(text, str) and len(text.encode("utf-8", "replace")) > LONGEST - _LONGEST_LETTER
    )
