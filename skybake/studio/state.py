"""What the knobs of the studio are set to, as they would be typed on the command line."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from skybake.errors import InputError

Typed = str | bool | tuple[str, ...]

MOST_ENTRIES = 200
LONGEST_TEXT = 4096


@dataclass(frozen=True)
class State:
    """Options as they are typed; those that are not named keep their default.

    Attributes
    ----------
    options : mapping of str to str, bool or tuple of str
        By the long name of the option without dashes; a bool of a flag, a tuple of an option that
        may be repeated.
    changes : mapping of str to str
        Values of the preset by their keys, as of ``--set``.
    """

    options: Mapping[str, Typed] = field(default_factory=dict)
    changes: Mapping[str, str] = field(default_factory=dict)

    def link(self) -> str:
        """Return the state as a text that fits into a URL."""
        plain = json.dumps({"options": self.options, "set": self.changes}, separators=(",", ":"))
        return base64.urlsafe_b64encode(plain.encode()).decode().rstrip("=")


def state_from_json(value: Any) -> State:
    """Read a state that a page has sent.

    Raises
    ------
    InputError
        If it is no state.
    """
    table = _table(value, "state")
    unknown = sorted(table.keys() - {"options", "set"})
    if unknown:
        raise InputError(f"state: keys must be options and set, got {unknown[0]!r}")
    options = _table(table.get("options", {}), "options")
    changes = _table(table.get("set", {}), "set")
    if len(options) + len(changes) > MOST_ENTRIES:
        count = len(options) + len(changes)
        raise InputError(f"state: entries must be at most {MOST_ENTRIES}, got {count}")
    return State(
        {_text(name, "state"): _typed(text, name) for name, text in options.items()},
        {_text(key, "set"): _change(text, key) for key, text in changes.items()},
    )


def typed_texts(state: State) -> Iterator[tuple[str, str]]:
    """Yield the name and each text of all options that have texts."""
    for name, value in state.options.items():
        for text in value if isinstance(value, tuple) else (value,):
            if isinstance(text, str):
                yield name, text


def _table(value: Any, name: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise InputError(f"{name}: must be an object, got {_short(value)}")
    return value


def _typed(value: Any, name: str) -> Typed:
    if isinstance(value, bool):
        return value
    if isinstance(value, list):
        return tuple(_text(one, name) for one in value)
    return _text(value, name)


def _change(value: Any, key: str) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    return _text(value, key)


def _text(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise InputError(f"{name}: must be a text, got {_short(value)}")
    if len(value) > LONGEST_TEXT or "\0" in value:
        raise InputError(
            f"{name}: must be a text of at most {LONGEST_TEXT} characters, got {_short(value)}"
        )
    return value


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
