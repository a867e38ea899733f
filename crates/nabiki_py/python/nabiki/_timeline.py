"""A motion with random access to its frames."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from typing import SupportsIndex, overload

import numpy
import numpy.typing

from . import _nabiki
from ._nabiki import Frame


class Timeline(Sequence[Frame]):
    """A motion with random access, a sequence of frames: any frame, some, or all at once."""

    __slots__ = ("_motion",)

    def __init__(self, motion: _nabiki.Timeline) -> None:
        self._motion = motion

    def __len__(self) -> int:
        return len(self._motion)

    @overload
    def __getitem__(self, frame: SupportsIndex) -> Frame: ...
    @overload
    def __getitem__(self, frame: slice) -> list[Frame]: ...
    def __getitem__(self, frame: SupportsIndex | slice) -> Frame | list[Frame]:
        """Any frame, computed from the latest requested one before it. `timeline[-1]` is the last frame, `timeline[10:20]` a
        list of ten."""
        count = len(self)
        if isinstance(frame, slice):
            return [self._motion.frame(number) for number in range(*frame.indices(count))]
        number = operator.index(frame)
        if not -count <= number < count:
            raise IndexError(f"frame {number}: the frames are 0 to {count - 1}")
        return self._motion.frame(number % count)

    def play(self) -> numpy.typing.NDArray[numpy.float32]:
        """All frames: (frames, P, 3) float32, head space, cm; read-only. They take frames x P x 12 bytes."""
        return self._motion.play()

    @property
    def offsets(self) -> numpy.typing.NDArray[numpy.uint32]:
        """Where strands begin in the points of each frame, with the end as the last value: (S + 1,) uint32."""
        return self._motion.offsets

    @property
    def ids(self) -> numpy.typing.NDArray[numpy.uint32]:
        """The number of each strand among all strands of the scene: (S,) uint32."""
        return self._motion.ids

    def __repr__(self) -> str:
        return repr(self._motion)
