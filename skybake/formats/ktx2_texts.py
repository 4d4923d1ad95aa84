"""Key/value pairs back from KTX 2 files."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

from skybake.errors import InputError

_IDENTIFIER = bytes.fromhex("AB4B5458203230BB0D0A1A0A")
_PLACE_AT = 56
_MOST = 1 << 24


def read_texts(path: Path) -> dict[str, Any]:
    """Return the texts of a KTX 2 file by their keys.

    Raises
    ------
    InputError
        If it is missing, of another format, or damaged there.
    """
    try:
        with path.open("rb") as file:
            header = file.read(_PLACE_AT + 8)
            if not header.startswith(_IDENTIFIER):
                raise InputError(f"{path}: must be a KTX 2 file, got another format")
            begin, size = struct.unpack_from("<2I", header, _PLACE_AT)
            file.seek(begin)
            data = file.read(min(size, _MOST))
        found = {}
        while data:
            (length,) = struct.unpack_from("<I", data)
            key, _, value = data[4 : 4 + length].partition(b"\0")
            found[key.decode()] = value.rstrip(b"\0").decode()
            data = data[4 + length + -length % 4 :]
    except OSError as error:
        raise InputError(f"{path}: must be a KTX 2 file, got {error.strerror}") from error
    except (struct.error, UnicodeDecodeError) as error:
        raise InputError(f"{path}: key/value pairs must be whole, got damaged ones") from error
    return found
