"""The scene, with its settings as attributes."""

from __future__ import annotations

import os
import reprlib
from collections.abc import Callable, Iterable, Mapping
from itertools import islice
from typing import TYPE_CHECKING, Any

from ._attributes import no_attribute
from ._error import Error
from ._nabiki import Field, Solution
from ._timeline import Timeline
from ._written import Written
from .settings import SceneSettings
from .settings._table import Arrays, File, Numbers

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .settings import SceneTables

Force = tuple[int, Numbers] | tuple[int, Numbers, str]
Interval = tuple[int, tuple[float, float, float]] | tuple[int, tuple[float, float, float], str]
Body = File | Arrays | Mapping[str, Any]


def _interval(place: int, force: Any) -> dict[str, Any]:
    """An interval of the wind as a scene has it."""
    try:
        # No more than it may have, of what may never end.
        through, vector, *more = islice(force, 4)
        (speed,) = more or [None]
    except (TypeError, ValueError):
        value = " ".join(reprlib.repr(force).split())
        if len(value) > 80:
            value = f"a {type(force).__name__}"
        thing, way_out = f"forces[{place}]", "must be (last frame, (x, y, z)), or (last frame, (x, y, z), speed)"
        raise Error(f"{thing} = {value}: {way_out}", thing=thing, value=value, way_out=way_out) from None
    return {"through": through, "vector": vector} | ({} if speed is None else {"speed": speed})


class Scene(SceneSettings):
    """Everything that decides a movie. Read a file with `Scene.open`, or make a scene here.

    `head`: a mesh file, (points, faces), or settings of the head. `hair`: a hair file, (points, offsets), or settings of the
    hair; without it, hair is grown. All other arguments are tables of settings by name: `motion={"frames": 50}`.

    Each table of a scene file is an attribute, and each setting is an attribute of its table: `scene.motion.frames = 50`.
    Setting a key adds its table to the scene. None removes a table: `scene.gust = None`.
    """

    __slots__ = ()

    def __init__(
        self,
        head: File | Arrays | Mapping[str, Any] | None = None,
        hair: File | Arrays | Mapping[str, Any] | None = None,
        *,
        forces: Iterable[Force] | None = None,
        bodies: Iterable[Body] | None = None,
        fields: Iterable[Field] | None = None,
        **settings: Unpack[SceneTables],
    ) -> None:
        # First, as matrices of a head or body go by the frame rate.
        for name, value in settings.items():
            self[name] = value
        if head is not None:
            self["head"] = head if isinstance(head, Mapping) else {"mesh": head}
        if hair is not None:
            self["hair"] = hair if isinstance(hair, Mapping) else {"file": hair}
        if forces is not None:
            self.forces = forces
        if bodies is not None:
            self.bodies = bodies
        if fields is not None:
            self.fields = fields

    @property
    def forces(self) -> Written[Interval, Force]:
        """The intervals of `[[force]]`: last frame and vector of each, and its speed if it has one."""

        def write(forces: Iterable[Force]) -> None:
            self.forces = forces

        def read() -> list[Interval]:
            read: list[Interval] = []
            for force in self.force:
                if force.speed is None:
                    read.append((force.through, force.vector))
                else:
                    read.append((force.through, force.vector, force.speed))
            return read

        return Written(read, write)

    @forces.setter
    def forces(self, forces: Iterable[Force]) -> None:
        self["force"] = [_interval(place, force) for place, force in enumerate(forces)]

    @property
    def bodies(self) -> Written[dict[str, Any], Body]:
        """Bodies that hair keeps out of in the free form: a list of settings of bodies, mesh files or (points, faces)."""

        def write(bodies: Iterable[Body]) -> None:
            self.bodies = bodies

        return Written(lambda: self.body.to_list(), write)

    @bodies.setter
    def bodies(self, bodies: Iterable[Body]) -> None:
        self["body"] = [body if isinstance(body, Mapping) else {"mesh": body} for body in bodies]

    @property
    def fields(self) -> Written[Field, Field]:
        """Fields of Python functions. They add to the fields of the settings."""

        def write(fields: Iterable[Field]) -> None:
            self.fields = fields

        return Written(lambda: list(self._fields), write)

    @fields.setter
    def fields(self, fields: Iterable[Field]) -> None:
        self._fields = list(fields)

    def timeline(self, strands: int | None = None) -> Timeline:
        """The motion with random access, a sequence of frames: any frame, some, or all at once."""
        return Timeline(self._timeline(strands))

    def solve(
        self,
        wishes: File | Iterable[Mapping[str, Any]],
        *,
        nails: Iterable[Mapping[str, Any]] = (),
        unknowns: Mapping[str, Any] | None = None,
        space: str = "world",
        prior: Mapping[str, Any] | None = None,
        search: Mapping[str, Any] | None = None,
        strands: int = 300,
        progress: Callable[[int, int], object] | None = None,
        report: Callable[[str], object] | None = None,
    ) -> Solution:
        """Finds the wind that makes the hair do what the wishes ask for. This scene does not change; the answer has its own.

        `wishes`: a wish file, or the contents of its `[[wish]]` tables; `nails`, `unknowns`, `space`, `prior` and `search` as
        in the file. Without `unknowns`, the vectors of all intervals that affect the wishes may change. `strands`: how many
        strands to search for locks near a point. `progress` receives the steps done and their maximum; it may raise to end
        the search.
        """
        if isinstance(wishes, (str, os.PathLike)):
            return self._solve_file(wishes, strands=strands, progress=progress, report=report)
        problem: dict[str, Any] = {"space": space, "wish": list(wishes), "nail": list(nails)}
        given = {"unknowns": unknowns, "prior": prior, "search": search}
        problem |= {name: value for name, value in given.items() if value is not None}
        return self._solve(problem, strands=strands, progress=progress, report=report)

    if not TYPE_CHECKING:
        # To a type checker these would be leave to ask for anything, and to set it.

        def __getattr__(self, name: str) -> Any:
            raise no_attribute(self, self, name, name)

        def __setattr__(self, name: str, value: Any) -> None:
            try:
                super().__setattr__(name, value)
            except AttributeError:
                if hasattr(type(self), name):
                    raise
                raise no_attribute(self, self, name, name) from None
