"""The head and other bodies: `scene.head`, `scene.body`. Written by generate.py from the schema of scenes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

from ._table import Arrays, File, Matrices, Numbers, Table, Tables

__all__ = ["BodySettings", "CapsuleSettings", "HeadSettings", "MotionSource"]


class HeadSettings(Table):
    """The head that hair grows on: the built-in bust, or a mesh from a file."""

    __slots__ = ()

    @property
    def ellipsoid(self) -> str | dict[str, Any]:
        """The head ellipsoid E: fitted to the part of the head where hair grows, or given in head space. "fit" or a
        table of Ellipsoid (cm); default: "fit".
        """
        value: str | dict[str, Any] = self._get('ellipsoid')
        return value

    @ellipsoid.setter
    def ellipsoid(self, value: str | Mapping[str, Any] | None) -> None:
        self._set('ellipsoid', value)

    @property
    def shell(self) -> float:
        """Scale of the shell C around the ellipsoid E. The pseudo-force acts only within this shell; a larger value
        reaches farther from the head. Number above 1; default: 1.25.
        """
        value: float = self._get('shell')
        return value

    @shell.setter
    def shell(self, value: float | None) -> None:
        self._set('shell', value)

    @property
    def motion(self) -> MotionSource:
        """A file that moves the head."""
        return MotionSource(self._scene, self._key_of('motion'))

    @motion.setter
    def motion(self, value: MotionSource | Mapping[str, Any] | Matrices | None) -> None:
        self._set('motion', value)

    @property
    def mesh(self) -> str:
        """The mesh: a .obj, .glb, .gltf, .fbx, .ply, .tfxmesh, USD layer or Alembic archive. Path; must be given."""
        value: str = self._get('mesh')
        return value

    @mesh.setter
    def mesh(self, value: File | Arrays | None) -> None:
        self._set('mesh', value)

    @property
    def groups(self) -> tuple[str, ...]:
        """Groups, objects or nodes of the file to use. Uses all if empty. List of texts; default: none."""
        value: tuple[str, ...] = self._get('groups')
        return value

    @groups.setter
    def groups(self, value: Sequence[str] | None) -> None:
        self._set('groups', value)

    @property
    def unit(self) -> str | float | None:
        """Length unit of the file. "mm", "cm", "dm", "m", "in" or "ft", or number above 0; default: what the file says,
        or cm.
        """
        value: str | float | None = self._get('unit')
        return value

    @unit.setter
    def unit(self, value: str | float | None) -> None:
        self._set('unit', value)

    @property
    def up(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file that points up. "+x", "-x", "+y", "-y", "+z" or "-z"; default: what the file says, or +y."""
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('up')
        return value

    @up.setter
    def up(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('up', value)

    @property
    def facing(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file along which the face looks. "+x", "-x", "+y", "-y", "+z" or "-z"; default: +x."""
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('facing')
        return value

    @facing.setter
    def facing(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('facing', value)

    @property
    def origin(self) -> tuple[float, float, float] | None:
        """Point of the file that becomes the origin of head space, in the file's unit. By default the centre of the
        fitted ellipsoid, or the file's own origin if you give an ellipsoid. 3 numbers; default: the ellipsoid's
        centre.
        """
        value: tuple[float, float, float] | None = self._get('origin')
        return value

    @origin.setter
    def origin(self, value: Numbers | None) -> None:
        self._set('origin', value)


class MotionSource(Table):
    """The file that moves the head, and what the file does not contain."""

    __slots__ = ()

    @property
    def file(self) -> str:
        """The motion: a .bvh, .amc, .tof, .glb, .gltf, .fbx, .abc, .usd, .usda or .usdc file, a .csv, or a .pc2 or .mdd
        with the mesh's points. A .csv has the columns t_s, px_m, py_m, pz_m (or _cm, _mm), qx, qy, qz, qw. Path;
        default: none.
        """
        value: str = self._get('file')
        return value

    @file.setter
    def file(self, value: File | None) -> None:
        self._set('file', value)

    @property
    def skeleton(self) -> str | None:
        """Skeleton file of the motion: the .asf of an .amc, or the .tof with the skeleton of a .tof animation. Other
        formats have none. Path; default: none.
        """
        value: str | None = self._get('skeleton')
        return value

    @skeleton.setter
    def skeleton(self, value: File | None) -> None:
        self._set('skeleton', value)

    @property
    def node(self) -> str:
        """Joint, bone or node that carries the head. Case does not matter. Not used for .csv. Text; default: "Head"."""
        value: str = self._get('node')
        return value

    @node.setter
    def node(self, value: str | None) -> None:
        self._set('node', value)

    @property
    def clip(self) -> str:
        """Name of the animation in a .glb, .gltf or .fbx. Needed only if there are several. Text; default: none."""
        value: str = self._get('clip')
        return value

    @clip.setter
    def clip(self, value: str | None) -> None:
        self._set('clip', value)

    @property
    def unit_cm(self) -> float | None:
        """Length of the file's unit. Required for .bvh, .tof and .abc. A .glb or .gltf is in metres unless you set this,
        an .amc in inches times the `length` of its .asf. A .csv, USD or FBX file names its own unit. Number above 0
        (cm); default: what the file says.
        """
        value: float | None = self._get('unit_cm')
        return value

    @unit_cm.setter
    def unit_cm(self, value: float | None) -> None:
        self._set('unit_cm', value)

    @property
    def up(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Up axis of the file's world. Required for .bvh, .amc, .tof and .csv. It is +y in .glb, .gltf and .abc; USD and
        FBX files name their own. "+x", "-x", "+y", "-y", "+z" or "-z"; default: what the file says.
        """
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('up')
        return value

    @up.setter
    def up(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('up', value)

    @property
    def facing(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file's world along which the character looks while the joint is unturned. Not required for .glb
        and .gltf, where it is +z in the still pose, nor for a USD layer, Alembic archive or FBX that the mesh is from
        too. A bone of an .amc is unturned in the rest pose of the .asf, a joint of a .tof when its axes are those of
        the world. "+x", "-x", "+y", "-y", "+z" or "-z"; default: what the file says.
        """
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('facing')
        return value

    @facing.setter
    def facing(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('facing', value)

    @property
    def frames_per_second(self) -> float | None:
        """Sample rate of the file. Required for most .amc files; a .pc2 has that of the scene unless you set this. All
        other formats contain it. Number above 0 (per second); default: what the file says.
        """
        value: float | None = self._get('frames_per_second')
        return value

    @frames_per_second.setter
    def frames_per_second(self, value: float | None) -> None:
        self._set('frames_per_second', value)

    @property
    def skip(self) -> int:
        """Number of samples to drop at the start, for example a T-pose. Not for .glb, .gltf and .fbx. Whole number
        (samples); default: 0.
        """
        value: int = self._get('skip')
        return value

    @skip.setter
    def skip(self, value: int | None) -> None:
        self._set('skip', value)

    @property
    def positions(self) -> Literal["linear", "cubic"]:
        """How to interpolate positions between two samples. Rotations turn at a constant rate (slerp). Not for .glb,
        .gltf and .fbx, whose curves define it. "linear" or "cubic"; default: "cubic".
        """
        value: Literal["linear", "cubic"] = self._get('positions')
        return value

    @positions.setter
    def positions(self, value: Literal["linear", "cubic"] | None) -> None:
        self._set('positions', value)

    @property
    def speed(self) -> float:
        """Playback speed of the motion. 0.25 makes it four times as long. Number, 0.01 to 100; default: 1."""
        value: float = self._get('speed')
        return value

    @speed.setter
    def speed(self, value: float | None) -> None:
        self._set('speed', value)

    @property
    def smoothing(self) -> float:
        """Standard deviation of the bell that averages positions and rotations, in frames of the scene. Raise it if a
        recording trembles, since hair feels accelerations. 0 leaves the motion as it is. Number, 0 to 240 (frames);
        default: 0.
        """
        value: float = self._get('smoothing')
        return value

    @smoothing.setter
    def smoothing(self, value: float | None) -> None:
        self._set('smoothing', value)

    @property
    def start_at_origin(self) -> bool:
        """Whether to move the first frame to the world's origin and turn it about y to face +x. True or false; default:
        false.
        """
        value: bool = self._get('start_at_origin')
        return value

    @start_at_origin.setter
    def start_at_origin(self, value: bool | None) -> None:
        self._set('start_at_origin', value)

    @property
    def bind_at_start(self) -> bool:
        """Whether the mesh is already placed as the first frame has it, as in a file that contains both mesh and motion.
        The motion then carries the mesh on from there. With a joint of the same USD layer or FBX, the mesh is placed
        as the skeleton binds it. Hair that grows on the head goes along. If the mesh bends in that file, so does its
        skin here. True or false; default: false.
        """
        value: bool = self._get('bind_at_start')
        return value

    @bind_at_start.setter
    def bind_at_start(self, value: bool | None) -> None:
        self._set('bind_at_start', value)


class BodySettings(Table):
    """An object besides the head that hair keeps out of in the free form."""

    __slots__ = ()

    @property
    def mesh(self) -> str:
        """The mesh: a .obj, .glb, .gltf, .fbx, .ply, .tfxmesh, USD layer or Alembic archive. Required without `capsule`.
        Path; default: none.
        """
        value: str = self._get('mesh')
        return value

    @mesh.setter
    def mesh(self, value: File | Arrays | None) -> None:
        self._set('mesh', value)

    @property
    def capsule(self) -> CapsuleSettings:
        """A capsule or ball instead of a mesh: an arm, a shoulder, a finger. It needs no file."""
        return CapsuleSettings(self._scene, self._key_of('capsule'))

    @capsule.setter
    def capsule(self, value: CapsuleSettings | Mapping[str, Any] | None) -> None:
        self._set('capsule', value)

    @property
    def groups(self) -> tuple[str, ...]:
        """Groups, objects or nodes of the file to use. Uses all if empty. List of texts; default: none."""
        value: tuple[str, ...] = self._get('groups')
        return value

    @groups.setter
    def groups(self, value: Sequence[str] | None) -> None:
        self._set('groups', value)

    @property
    def unit(self) -> str | float | None:
        """Length unit of the file. "mm", "cm", "dm", "m", "in" or "ft", or number above 0; default: what the file says,
        or cm.
        """
        value: str | float | None = self._get('unit')
        return value

    @unit.setter
    def unit(self, value: str | float | None) -> None:
        self._set('unit', value)

    @property
    def up(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file that points up. "+x", "-x", "+y", "-y", "+z" or "-z"; default: what the file says, or +y."""
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('up')
        return value

    @up.setter
    def up(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('up', value)

    @property
    def facing(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file that lies along +x of the scene. "+x", "-x", "+y", "-y", "+z" or "-z"; default: +x."""
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('facing')
        return value

    @facing.setter
    def facing(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('facing', value)

    @property
    def origin(self) -> tuple[float, float, float] | None:
        """Point of the file that the body's motion carries, in the file's unit. 3 numbers; default: the file's."""
        value: tuple[float, float, float] | None = self._get('origin')
        return value

    @origin.setter
    def origin(self, value: Numbers | None) -> None:
        self._set('origin', value)

    @property
    def motion(self) -> MotionSource:
        """A file that moves the body through the world, as `head.motion` moves the head."""
        return MotionSource(self._scene, self._key_of('motion'))

    @motion.setter
    def motion(self, value: MotionSource | Mapping[str, Any] | Matrices | None) -> None:
        self._set('motion', value)

    @property
    def with_head(self) -> bool:
        """Whether the body is worn: it is placed in head space and moves with the head. True or false; default: false."""
        value: bool = self._get('with_head')
        return value

    @with_head.setter
    def with_head(self, value: bool | None) -> None:
        self._set('with_head', value)

    @property
    def solid(self) -> bool:
        """Whether hair keeps out of the body. If false, the body is only drawn, and its mesh may be open. True or false;
        default: true.
        """
        value: bool = self._get('solid')
        return value

    @solid.setter
    def solid(self, value: bool | None) -> None:
        self._set('solid', value)

    @property
    def margin(self) -> float:
        """Distance that nodes keep from its skin. Number, 0 to 5 (cm); default: 0.1."""
        value: float = self._get('margin')
        return value

    @margin.setter
    def margin(self, value: float | None) -> None:
        self._set('margin', value)

    @property
    def friction(self) -> float:
        """Friction of sliding hair: the share of the push that it loses as speed along the skin. Number, 0 to 10;
        default: 0.1.
        """
        value: float = self._get('friction')
        return value

    @friction.setter
    def friction(self, value: float | None) -> None:
        self._set('friction', value)

    @property
    def static_friction(self) -> float:
        """Friction of hair that does not slide, at least `friction`. Number, 0 to 10; default: 0.15."""
        value: float = self._get('static_friction')
        return value

    @static_friction.setter
    def static_friction(self, value: float | None) -> None:
        self._set('static_friction', value)

    @property
    def shown(self) -> bool:
        """Whether the body is drawn. A hidden body hides nothing and casts no shadow. True or false; default: true."""
        value: bool = self._get('shown')
        return value

    @shown.setter
    def shown(self, value: bool | None) -> None:
        self._set('shown', value)

    @property
    def colour(self) -> tuple[float, float, float]:
        """Colour in pictures. The default is a grey. 3 numbers, each 0 to 1 (sRGB); default: [0.42, 0.46, 0.5]."""
        value: tuple[float, float, float] = self._get('colour')
        return value

    @colour.setter
    def colour(self, value: Numbers | None) -> None:
        self._set('colour', value)


class CapsuleSettings(Table):
    """A capsule: all points within a radius of a line, or of a single point."""

    __slots__ = ()

    @property
    def from_(self) -> tuple[float, float, float]:
        """One end of the line, in the body's space. 3 numbers, each -1000 to 1000 (cm); must be given."""
        value: tuple[float, float, float] = self._get('from')
        return value

    @from_.setter
    def from_(self, value: Numbers | None) -> None:
        self._set('from', value)

    @property
    def to(self) -> tuple[float, float, float] | None:
        """The other end. Without it, the capsule is a ball. 3 numbers, each -1000 to 1000 (cm); default: a ball."""
        value: tuple[float, float, float] | None = self._get('to')
        return value

    @to.setter
    def to(self, value: Numbers | None) -> None:
        self._set('to', value)

    @property
    def radius(self) -> float:
        """The radius. Number above 0, at most 1000 (cm); must be given."""
        value: float = self._get('radius')
        return value

    @radius.setter
    def radius(self, value: float | None) -> None:
        self._set('radius', value)
