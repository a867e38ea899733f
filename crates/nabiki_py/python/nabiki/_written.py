"""Lists that a scene gives and is given."""

from __future__ import annotations

from collections.abc import Callable, Iterable, MutableSequence
from typing import Any, Generic, TypeVar

V = TypeVar("V")


class Written(MutableSequence[V], Generic[V]):
    """What a scene has of something, as a list; whoever changes it changes the scene, which may refuse."""

    __slots__ = ("_read", "_write")

    def __init__(self, read: Callable[[], list[V]], write: Callable[[list[V]], None]) -> None:
        self._read, self._write = read, write

    def __len__(self) -> int:
        return len(self._read())

    def __getitem__(self, index: Any) -> Any:
        return self._read()[index]

    def __setitem__(self, index: Any, value: Any) -> None:
        values = self._read()
        values[index] = value
        self._write(values)

    def __delitem__(self, index: int | slice) -> None:
        values = self._read()
        del values[index]
        self._write(values)

    def insert(self, index: int, value: V) -> None:
        self[index:index] = [value]

    def extend(self, values: Iterable[V]) -> None:
        self._write([*self._read(), *values])

    def clear(self) -> None:
        self._write([])

    def reverse(self) -> None:
        self._write(self._read()[::-1])

    def __add__(self, values: Iterable[V]) -> list[V]:
        return [*self._read(), *values]

    def __eq__(self, other: object) -> bool:
        return self._read() == (other._read() if isinstance(other, Written) else other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return repr(self._read())
