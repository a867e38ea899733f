"""Lists that a scene gives and is given."""

from __future__ import annotations

from collections.abc import Callable, Iterable, MutableSequence
from typing import Generic, SupportsIndex, TypeVar, overload

V = TypeVar("V")
G = TypeVar("G")


class Written(MutableSequence[V], Generic[V, G]):
    """What a scene has of something, as a list of `V`; whoever changes it, giving a `V` or a `G`, changes the scene, which may refuse."""

    __slots__ = ("_read", "_write")

    def __init__(self, read: Callable[[], list[V]], write: Callable[[list[V | G]], None]) -> None:
        self._read, self._write = read, write

    def __len__(self) -> int:
        return len(self._read())

    @overload
    def __getitem__(self, index: SupportsIndex) -> V: ...
    @overload
    def __getitem__(self, index: slice) -> list[V]: ...
    def __getitem__(self, index: SupportsIndex | slice) -> V | list[V]:
        return self._read()[index]

    @overload
    def __setitem__(self, index: SupportsIndex, value: V | G) -> None: ...
    @overload
    def __setitem__(self, index: slice, value: Iterable[V | G]) -> None: ...
    def __setitem__(self, index: SupportsIndex | slice, value: V | G | Iterable[V | G]) -> None:
        values: list[V | G] = [*self._read()]
        values[index] = value  # type: ignore[index, assignment]
        self._write(values)

    def __delitem__(self, index: SupportsIndex | slice) -> None:
        values: list[V | G] = [*self._read()]
        del values[index]
        self._write(values)

    def insert(self, index: SupportsIndex, value: V | G) -> None:
        self[index:index] = [value]

    def append(self, value: V | G) -> None:
        self._write([*self._read(), value])

    def extend(self, values: Iterable[V | G]) -> None:
        self._write([*self._read(), *values])

    def __iadd__(self, values: Iterable[V | G]) -> Written[V, G]:
        self.extend(values)
        return self

    def clear(self) -> None:
        self._write([])

    def reverse(self) -> None:
        self._write([*self._read()[::-1]])

    def __add__(self, values: Iterable[V]) -> list[V]:
        return [*self._read(), *values]

    def __eq__(self, other: object) -> bool:
        return self._read() == (other._read() if isinstance(other, Written) else other)

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[object, ...]:
        # Elsewhere it is a list of what the scene has now.
        return list, (self._read(),)

    def __repr__(self) -> str:
        return repr(self._read())
