"""Tables of settings that live in a scene: they hold no values, and ask the scene by key."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, MutableSequence, Sequence
from typing import Any, Generic, TypeVar, overload

import numpy
import numpy.typing

from .. import _nabiki
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

    def __setattr__(self, name: str, value: object) -> None:
        # The scene knows which key was perhaps meant.
        if isinstance(getattr(type(self), name, None), property):
            object.__setattr__(self, name, value)
        else:
            self._set(name, value)

    def __bool__(self) -> bool:
        """Whether the scene has this table."""
        return self._scene[self._key] is not None

    def to_dict(self) -> dict[str, Any]:
        """All its settings, given or not."""
        values: dict[str, Any] | None = self._scene[self._key]
        return values or {}

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Table):
            return self.to_dict() == other.to_dict()
        return isinstance(other, Mapping) and self.to_dict() == dict(other)

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self._scene, self._key)

    def __repr__(self) -> str:
        return f"<{self._key}: {self.to_dict()}>"


T = TypeVar("T", bound=Table)


class Tables(MutableSequence[T], Generic[T]):
    """A list of tables, such as the fans of a scene. Entries may be given as dictionaries."""

    __slots__ = ("_scene", "_key", "_entry")

    def __init__(self, scene: _nabiki.Scene, key: str, entry: Callable[[_nabiki.Scene, str], T]) -> None:
        self._scene, self._key, self._entry = scene, key, entry

    def _place(self, index: int) -> str:
        count = len(self)
        if not -count <= index < count:
            raise IndexError(f"{self._key}[{index}]: there are {count}")
        return f"{self._key}[{index % count}]"

    def __len__(self) -> int:
        return len(self._scene[self._key] or ())

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> MutableSequence[T]: ...
    def __getitem__(self, index: int | slice) -> T | MutableSequence[T]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        return self._entry(self._scene, self._place(index))

    def __setitem__(self, index: Any, value: Any) -> None:
        if isinstance(index, slice):
            entries = self.to_list()
            entries[index] = value
            self._scene[self._key] = entries
        else:
            self._scene[self._place(index)] = value

    def __delitem__(self, index: int | slice) -> None:
        if isinstance(index, slice):
            entries = self.to_list()
            del entries[index]
            self._scene[self._key] = entries
        else:
            del self._scene[self._place(index)]

    def insert(self, index: int, value: T | Mapping[str, Any]) -> None:
        entries = self.to_list()
        entries.insert(index, value)
        self._scene[self._key] = entries

    def append(self, value: T | Mapping[str, Any]) -> None:
        self.insert(len(self), value)

    def extend(self, values: Iterable[T | Mapping[str, Any]]) -> None:
        self._scene[self._key] = [*self.to_list(), *values]

    def pop(self, index: int = -1) -> T:
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

    def __repr__(self) -> str:
        return f"<{self._key}: {self.to_list()}>"
