"""The head and other bodies: `scene.head`, `scene.body`. Written by generate.py from the doc comments of the Rust structs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

from ._table import Arrays, File, Matrices, Numbers, Table, Tables

__all__ = ["BodySettings", "HeadSettings", "MotionSource"]


class HeadSettings(Table):
    """`[head]`."""

    __slots__ = ()

    @property
    def ellipsoid(self) -> str | dict[str, Any]:
        """E: fitted (default), or its centre and half axes (head space, cm)."""
        value: str | dict[str, Any] = self._get('ellipsoid')
        return value

    @ellipsoid.setter
    def ellipsoid(self, value: str | Mapping[str, Any] | None) -> None:
        self._set('ellipsoid', value)

    @property
    def shell(self) -> float:
        """C is E scaled by this, above 1 (default 1.25)."""
        value: float = self._get('shell')
        return value

    @shell.setter
    def shell(self, value: float | None) -> None:
        self._set('shell', value)

    @property
    def motion(self) -> MotionSource:
        """A file that moves the head (default: it stands still)."""
        return MotionSource(self._scene, self._key_of('motion'))

    @motion.setter
    def motion(self, value: MotionSource | Mapping[str, Any] | Matrices | None) -> None:
        self._set('motion', value)

    @property
    def mesh(self) -> str:
        """A .obj, .glb, .gltf, .ply, .tfxmesh, USD layer or Alembic archive. Key: `mesh`."""
        value: str = self._get('mesh')
        return value

    @mesh.setter
    def mesh(self, value: File | Arrays | None) -> None:
        self._set('mesh', value)

    @property
    def groups(self) -> tuple[str, ...]:
        """Groups, objects or nodes of the file to keep (default: all)."""
        value: tuple[str, ...] = self._get('groups')
        return value

    @groups.setter
    def groups(self, value: Sequence[str] | None) -> None:
        self._set('groups', value)

    @property
    def unit(self) -> str | float | None:
        """Unit of the file (default: what the file or its format says, or cm)."""
        value: str | float | None = self._get('unit')
        return value

    @unit.setter
    def unit(self, value: str | float | None) -> None:
        self._set('unit', value)

    @property
    def up(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file that points up (default: what the file or its format says, or +y)."""
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('up')
        return value

    @up.setter
    def up(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('up', value)

    @property
    def facing(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file along which the face looks (default +x)."""
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('facing')
        return value

    @facing.setter
    def facing(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('facing', value)

    @property
    def origin(self) -> tuple[float, float, float] | None:
        """Point of the file that becomes the origin of head space (file units). Default: the centre of the fitted
        ellipsoid; the file's own origin where the ellipsoid is given.
        """
        value: tuple[float, float, float] | None = self._get('origin')
        return value

    @origin.setter
    def origin(self, value: Numbers | None) -> None:
        self._set('origin', value)


class MotionSource(Table):
    """Which file moves the head, and what that file cannot say itself: `[head.motion]` of a scene."""

    __slots__ = ()

    @property
    def file(self) -> str:
        """A .bvh, .amc, .tof, .glb, .gltf, .abc, .usd, .usda or .usdc file, or a .csv with the columns t_s, px_m, py_m,
        pz_m (or _cm, _mm), qx, qy, qz, qw.
        """
        value: str = self._get('file')
        return value

    @file.setter
    def file(self, value: File | None) -> None:
        self._set('file', value)

    @property
    def skeleton(self) -> str | None:
        """File of the skeleton that the motion moves: the .asf of an .amc, the .tof with the skeleton of a .tof
        animation. Others have none.
        """
        value: str | None = self._get('skeleton')
        return value

    @skeleton.setter
    def skeleton(self, value: File | None) -> None:
        self._set('skeleton', value)

    @property
    def node(self) -> str:
        """Joint, bone or node that carries the head (default "Head"; capitals do not count). Not used for .csv."""
        value: str = self._get('node')
        return value

    @node.setter
    def node(self, value: str | None) -> None:
        self._set('node', value)

    @property
    def clip(self) -> str:
        """Animation of a .glb or .gltf by name; may stay empty where there is one only."""
        value: str = self._get('clip')
        return value

    @clip.setter
    def clip(self, value: str | None) -> None:
        self._set('clip', value)

    @property
    def unit_cm(self) -> float | None:
        """Length of the file's unit (cm). Needed for .bvh, .tof and .abc; .glb and .gltf are in metres unless said here,
        .amc in inches times the `length` of its .asf; .csv and USD name their own.
        """
        value: float | None = self._get('unit_cm')
        return value

    @unit_cm.setter
    def unit_cm(self, value: float | None) -> None:
        self._set('unit_cm', value)

    @property
    def up(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Up axis of the file's world. Needed for .bvh, .amc, .tof and .csv; +y in .glb, .gltf and .abc; USD names its
        own.
        """
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('up')
        return value

    @up.setter
    def up(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('up', value)

    @property
    def facing(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file's world that the character faces while the joint is unturned. Needed but for .glb and .gltf:
        +z in those, whose node is unturned as the file's still pose has it; and but for a USD layer or Alembic
        archive that the mesh is from, too, which face as the mesh does. A bone of an .amc is unturned as the .asf has
        it, a joint of a .tof where its axes are the world's.
        """
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('facing')
        return value

    @facing.setter
    def facing(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('facing', value)

    @property
    def frames_per_second(self) -> float | None:
        """Samples a second. Needed for an .amc, which seldom says; all others say it themselves."""
        value: float | None = self._get('frames_per_second')
        return value

    @frames_per_second.setter
    def frames_per_second(self, value: float | None) -> None:
        self._set('frames_per_second', value)

    @property
    def skip(self) -> int:
        """Samples dropped at the start (a T-pose, say; default 0). Not for .glb and .gltf."""
        value: int = self._get('skip')
        return value

    @skip.setter
    def skip(self, value: int | None) -> None:
        self._set('skip', value)

    @property
    def positions(self) -> Literal["linear", "cubic"]:
        """How positions between two samples are found (default cubic). Rotations turn at a constant rate (slerp). Not
        for .glb and .gltf, whose channels say it themselves.
        """
        value: Literal["linear", "cubic"] = self._get('positions')
        return value

    @positions.setter
    def positions(self, value: Literal["linear", "cubic"] | None) -> None:
        self._set('positions', value)

    @property
    def speed(self) -> float:
        """How fast the motion is played, 0.01..100: 0.25 takes four times as long (default 1)."""
        value: float = self._get('speed')
        return value

    @speed.setter
    def speed(self, value: float | None) -> None:
        self._set('speed', value)

    @property
    def smoothing(self) -> float:
        """Deviation of the bell that places and turns are averaged by (frames of the scene), 0..240 (default 0: as they
        are). Recordings tremble, and hair feels accelerations.
        """
        value: float = self._get('smoothing')
        return value

    @smoothing.setter
    def smoothing(self, value: float | None) -> None:
        self._set('smoothing', value)

    @property
    def start_at_origin(self) -> bool:
        """Whether the first frame is moved to the world's origin and turned about y to face +x (default false)."""
        value: bool = self._get('start_at_origin')
        return value

    @start_at_origin.setter
    def start_at_origin(self, value: bool | None) -> None:
        self._set('start_at_origin', value)

    @property
    def bind_at_start(self) -> bool:
        """Whether the mesh stands in its file as the first frame has it, wherever that is and however it is turned
        there, as one out of the same scene does: it is then carried on from there (default false). Beside a joint of
        the same USD layer it stands as the skeleton binds it. Hair that grows on a head stands there as well.
        """
        value: bool = self._get('bind_at_start')
        return value

    @bind_at_start.setter
    def bind_at_start(self, value: bool | None) -> None:
        self._set('bind_at_start', value)


class BodySettings(Table):
    """`[[body]]`: something besides the head that hair does not enter."""

    __slots__ = ()

    @property
    def mesh(self) -> str:
        """A .obj, .glb, .gltf, .ply, .tfxmesh, USD layer or Alembic archive."""
        value: str = self._get('mesh')
        return value

    @mesh.setter
    def mesh(self, value: File | Arrays | None) -> None:
        self._set('mesh', value)

    @property
    def groups(self) -> tuple[str, ...]:
        """Groups, objects or nodes of the file to keep (default: all)."""
        value: tuple[str, ...] = self._get('groups')
        return value

    @groups.setter
    def groups(self, value: Sequence[str] | None) -> None:
        self._set('groups', value)

    @property
    def unit(self) -> str | float | None:
        """Unit of the file (default: what the file says, or cm)."""
        value: str | float | None = self._get('unit')
        return value

    @unit.setter
    def unit(self, value: str | float | None) -> None:
        self._set('unit', value)

    @property
    def up(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file that points up (default: what the file says, or +y)."""
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('up')
        return value

    @up.setter
    def up(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('up', value)

    @property
    def facing(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file that lies along +x of the scene (default +x)."""
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('facing')
        return value

    @facing.setter
    def facing(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('facing', value)

    @property
    def origin(self) -> tuple[float, float, float] | None:
        """Point of the file that the body's motion carries (file units; default: the file's own origin)."""
        value: tuple[float, float, float] | None = self._get('origin')
        return value

    @origin.setter
    def origin(self, value: Numbers | None) -> None:
        self._set('origin', value)

    @property
    def motion(self) -> MotionSource:
        """A file that moves the body through the world, as `head.motion` moves the head (default: it stands still)."""
        return MotionSource(self._scene, self._key_of('motion'))

    @motion.setter
    def motion(self, value: MotionSource | Mapping[str, Any] | Matrices | None) -> None:
        self._set('motion', value)

    @property
    def with_head(self) -> bool:
        """Whether it is worn: it stands in head space and goes with the head (default false)."""
        value: bool = self._get('with_head')
        return value

    @with_head.setter
    def with_head(self, value: bool | None) -> None:
        self._set('with_head', value)

    @property
    def solid(self) -> bool:
        """Whether hair keeps out of it (default true); otherwise it is drawn and no more, and may be open."""
        value: bool = self._get('solid')
        return value

    @solid.setter
    def solid(self, value: bool | None) -> None:
        self._set('solid', value)

    @property
    def margin(self) -> float:
        """How far from its skin nodes are kept (cm; default 0.1)."""
        value: float = self._get('margin')
        return value

    @margin.setter
    def margin(self, value: float | None) -> None:
        self._set('margin', value)

    @property
    def friction(self) -> float:
        """The part of a push that sliding hair loses of its speed (default 0.1)."""
        value: float = self._get('friction')
        return value

    @friction.setter
    def friction(self, value: float | None) -> None:
        self._set('friction', value)

    @property
    def static_friction(self) -> float:
        """The same for hair that does not slide, at least `friction` (default 0.15)."""
        value: float = self._get('static_friction')
        return value

    @static_friction.setter
    def static_friction(self, value: float | None) -> None:
        self._set('static_friction', value)

    @property
    def shown(self) -> bool:
        """Whether it is drawn (default true)."""
        value: bool = self._get('shown')
        return value

    @shown.setter
    def shown(self, value: bool | None) -> None:
        self._set('shown', value)

    @property
    def colour(self) -> tuple[float, float, float]:
        """Its colour in pictures (sRGB, 0..1; default `[0.42, 0.46, 0.5]`, a grey)."""
        value: tuple[float, float, float] = self._get('colour')
        return value

    @colour.setter
    def colour(self, value: Numbers | None) -> None:
        self._set('colour', value)
