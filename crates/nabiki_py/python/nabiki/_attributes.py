"""What is said of attributes that are not there."""

from __future__ import annotations

import difflib

from . import _nabiki
from ._error import Error, UnknownAttribute, unknown


def no_attribute(owner: object, scene: _nabiki.Scene, name: str, key: str) -> AttributeError:
    """The exception of an attribute of `owner` that is not there: as a setting it would have the key `key`."""
    kind = type(owner).__name__
    if name.startswith("_"):
        # Python asks for many of these, to learn what an object can do.
        return AttributeError(f"{kind!r} object has no attribute {name!r}")
    others = [other for other in dir(type(owner)) if other[0] != "_" and callable(getattr(type(owner), other))]
    if near := difflib.get_close_matches(name, others, 1, 0.75):
        way_out = f"did you mean {near[0]}?"
        return UnknownAttribute(f"{kind} has no attribute {name}; {way_out}", thing=key, way_out=way_out)
    try:
        scene[key]
    except Error as error:
        # The scene knows which setting was perhaps meant.
        return unknown(error)
    way_out = f'write scene["{key}"]'
    return UnknownAttribute(f"{kind} has no attribute {name}: {way_out}", thing=key, way_out=way_out)
