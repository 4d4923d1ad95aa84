"""What every KTX 2 file begins with, and how its texts and levels are packed.

References
----------
KTX File Format Specification 2.0, registry.khronos.org/KTX/specs/2.0/ktxspec.v2.html.
"""

from __future__ import annotations

import struct
import sys
from collections.abc import Mapping

from skybake.formats.ktx2_descriptor import data_format_descriptor
from skybake.formats.spec import Attribute, attribute_text
from skybake.formats.texels import TexelFormat
from skybake.version import __version__

_IDENTIFIER = bytes.fromhex("AB4B5458203230BB0D0A1A0A")
_NO_COMPRESSION, _ZSTD = 0, 2
_HEADER = struct.Struct("<12s9I4I2Q")
_LEVEL = struct.Struct("<3Q")

INDEX_AT = _HEADER.size
"""Where the index of levels stands in a file. [byte]"""

ZSTD_LEVEL = 3
"""Level of the compression: of a sky higher ones save some percent in several times the time."""


def beginning(
    form: TexelFormat,
    size: tuple[int, int, int],
    *,
    faces: int,
    levels: int,
    zstd: bool,
    attributes: Mapping[str, Attribute],
) -> bytes:
    """Return all that stands before the texels, with zeros in the place of the index.

    Parameters
    ----------
    form : TexelFormat
        How texels are stored.
    size : (int, int, int)
        Width, height and depth, which is 0 of what is no volume. [pixel]
    faces, levels : int
        How many there are.
    zstd : bool
        Whether levels are compressed.
    attributes : mapping of str to Attribute
        Key/value pairs, as text; `colorInteropID` decides the primaries too.

    Raises
    ------
    ValueError
        If an attribute has a name that KTX reserves.
    """
    descriptor = data_format_descriptor(form, str(attributes.get("colorInteropID", "")))
    values = _key_values(attributes, "rd" if size[2] == 0 else "rdi")
    descriptor_at = _HEADER.size + _LEVEL.size * levels
    values_at = descriptor_at + len(descriptor)
    header = _HEADER.pack(
        _IDENTIFIER,
        *(form.vulkan, form.unit, *size, 0, faces, levels),
        _ZSTD if zstd else _NO_COMPRESSION,
        *(descriptor_at, len(descriptor), values_at, len(values)),
        *(0, 0),
    )
    return header + bytes(descriptor_at - len(header)) + descriptor + values


def index_entry(begin: int, stored: int, plain: int) -> bytes:
    """Return the entry of a level: where it begins, its bytes in the file and uncompressed."""
    return _LEVEL.pack(begin, stored, plain)


def compress(plain: bytes) -> bytes:
    """Compress a level."""
    if sys.version_info >= (3, 14):
        from compression import zstd
    else:
        import zstandard as zstd
    return zstd.compress(plain, level=ZSTD_LEVEL)


def _key_values(attributes: Mapping[str, Attribute], orientation: str) -> bytes:
    """Return the key/value pairs, in the order of their keys and each padded to 4 bytes."""
    for key in attributes:
        if key.lower().startswith("ktx") or "\0" in key or not key:
            raise ValueError(f"key must not be one that KTX reserves, got {key!r}")
    texts = {key: attribute_text(value) for key, value in attributes.items()}
    texts |= {"KTXorientation": orientation, "KTXwriter": f"skybake {__version__}"}
    pairs = b""
    for key in sorted(texts):
        pair = f"{key}\0{texts[key]}\0".encode()
        pairs += struct.pack("<I", len(pair)) + pair + bytes(-len(pair) % 4)
    return pairs
