"""Tables of settings that live in a scene: they hold no values, and ask the scene by key."""

from __future__ import annotations

import operator
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, MutableSequence, Sequence
from typing import TYPE_CHECKING, Any, Generic, SupportsIndex, TypeVar, overload

import numpy
import numpy.typing

from .. import _nabiki
from .._attributes import no_attribute
from .._error import Error

File = str | os.PathLike[str]
Numbers = Sequence[float] | numpy.typing.NDArray[Any]
Matrices = numpy.typing.ArrayLike
Arrays = tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike]


class Table:
    """A table of settings."""

    __slots__ = ("_scene", "_key")

    _scene: _nabiki.Scene
    _key: str

    def __init__(self, scene: _nabiki.Scene, key: str) -> None:
        object.__setattr__(self, "_scene", scene)
        object.__setattr__(self, "_key", key)

    def _key_of(self, name: str) -> str:
        return f"{self._key}.{name}"

    def _get(self, name: str) -> Any:
        value = self._scene[self._key_of(name)]
        if value is None and not self:
            way_out = f"is not in this scene; scene.{self._key} = {{}} adds it with its defaults"
            raise Error(f"{self._key}: {way_out}", thing=self._key, way_out=way_out)
        return value

    def _set(self, name: str, value: object) -> None:
        self._scene[self._key_of(name)] = value

    if not TYPE_CHECKING:
        # To a type checker these would be leave to ask for anything, and to set it.

        def __getattr__(self, name: str) -> Any:
            raise no_attribute(self, self._scene, name, self._key_of(name))

        def __setattr__(self, name: str, value: Any) -> None:
            if not isinstance(getattr(type(self), name, None), property):
                raise no_attribute(self, self._scene, name, self._key_of(name))
            object.__setattr__(self, name, value)

    def __bool__(self) -> bool:
        """Whether the scene has this table."""
        return self._scene[self._key] is not None

    def to_dict(self) -> dict[str, Any]:
        """All its settings, given or not."""
        values: dict[str, Any] | None = self._scene[self._key]
        return values or {}

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Table):
            return type(self) is type(other) and self.to_dict() == other.to_dict()
        return isinstance(other, Mapping) and self.to_dict() == dict(other)

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self._scene, self._key)

    def __repr__(self) -> str:
        return f"<{self._key}: {self.to_dict() if self else 'not in this scene'}>"


T = TypeVar("T", bound=Table)


class Tables(MutableSequence[T], Generic[T]):
    """A list of tables, such as the fans of a scene. Entries may be given as dictionaries."""

    __slots__ = ("_scene", "_key", "_entry")

    def __init__(self, scene: _nabiki.Scene, key: str, entry: Callable[[_nabiki.Scene, str], T]) -> None:
        self._scene, self._key, self._entry = scene, key, entry

    def _place(self, index: SupportsIndex) -> str:
        index, count = operator.index(index), len(self)
        if not -count <= index < count:
            raise IndexError(f"{self._key}[{index}]: there are {count}")
        return f"{self._key}[{index % count}]"

    def __len__(self) -> int:
        return len(self._scene[self._key] or ())

    @overload
    def __getitem__(self, index: SupportsIndex) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> list[T]: ...
    def __getitem__(self, index: SupportsIndex | slice) -> T | list[T]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        return self._entry(self._scene, self._place(index))

    @overload
    def __setitem__(self, index: SupportsIndex, value: T | Mapping[str, Any]) -> None: ...
    @overload
    def __setitem__(self, index: slice, value: Iterable[T | Mapping[str, Any]]) -> None: ...
    def __setitem__(self, index: SupportsIndex | slice, value: Any) -> None:
        if isinstance(index, slice):
            entries = self.to_list()
            entries[index] = value
            self._scene[self._key] = entries
        else:
            self._scene[self._place(index)] = value

    def __delitem__(self, index: SupportsIndex | slice) -> None:
        if isinstance(index, slice):
            entries = self.to_list()
            del entries[index]
            self._scene[self._key] = entries
        else:
            del self._scene[self._place(index)]

    def insert(self, index: SupportsIndex, value: T | Mapping[str, Any]) -> None:
        entries = self.to_list()
        entries.insert(index, value)
        self._scene[self._key] = entries

    def append(self, value: T | Mapping[str, Any]) -> None:
        self.insert(len(self), value)

    def extend(self, values: Iterable[T | Mapping[str, Any]]) -> None:
        self._scene[self._key] = [*self.to_list(), *values]

    def pop(self, index: SupportsIndex = -1) -> T:
        """Takes an entry out; it is then one of a copy of the scene, since entries have no values of their own."""
        entry = self._entry(self._scene.copy(), self._place(index))
        del self[index]
        return entry

    # One by one, an entry would be what its neighbour has become, and the last one may not be taken out.
    def reverse(self) -> None:
        self._scene[self._key] = self.to_list()[::-1]

    def clear(self) -> None:
        self._scene[self._key] = []

    def to_list(self) -> list[Any]:
        """All entries as dictionaries."""
        return list(self._scene[self._key] or ())

    def __iter__(self) -> Iterator[T]:
        return (self[i] for i in range(len(self)))

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Tables):
            return self._entry is other._entry and self.to_list() == other.to_list()
        return isinstance(other, list) and list(self) == other

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<{self._key}: {self.to_list()}>"
