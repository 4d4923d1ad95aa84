"""What ``import skybake`` offers."""

import dataclasses
import inspect
import typing

import pytest

import skybake

PUBLIC = {name: getattr(skybake, name) for name in skybake.__all__}
HANDED_ON = (skybake.Projection, skybake.Scene)
"""What users pass on and the engine alone calls."""


def hints(thing):
    """Types of what a public thing takes, has and returns."""
    if not isinstance(thing, type):
        return typing.get_type_hints(thing) if callable(thing) else {}
    found = {}
    for name, member in inspect.getmembers(thing):
        if name == "__init__" and dataclasses.is_dataclass(thing):
            # Of the class, since fields of its bases are annotated in their modules.
            found[name] = typing.get_type_hints(thing)
        elif inspect.isroutine(member) and is_ours(member) and not name.startswith("_"):
            if not issubclass(thing, HANDED_ON):
                found[name] = typing.get_type_hints(member)
        elif name == "__init__" and is_ours(member) and not issubclass(thing, HANDED_ON):
            found[name] = typing.get_type_hints(member)
        elif isinstance(member, property) and not issubclass(thing, HANDED_ON):
            found[name] = typing.get_type_hints(member.fget)
    return found


def is_ours(thing):
    return (getattr(thing, "__module__", None) or "").startswith("skybake")


def classes(hint):
    """All classes of skybake in an annotation."""
    if isinstance(hint, type) and is_ours(hint):
        yield hint
    parts = hint.values() if isinstance(hint, dict) else typing.get_args(hint)
    for part in hint if isinstance(hint, list) else parts:
        yield from classes(part)


def test_public_names_are_there_and_others_are_not():
    assert all(value is not None for value in PUBLIC.values())
    assert set(skybake.__all__) <= set(dir(skybake))
    with pytest.raises(AttributeError, match="has no attribute 'bakery'"):
        _ = skybake.bakery


@pytest.mark.parametrize("name", PUBLIC)
def test_every_type_in_a_public_signature_is_public(name):
    """Aliases apart, which are made of such types."""
    missing = {one for one in classes(hints(PUBLIC[name])) if one not in PUBLIC.values()}
    assert not missing
