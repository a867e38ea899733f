"""How hair lies at rest: `scene.hair`. Written by generate.py from the schema of scenes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

from ._table import Arrays, File, Matrices, Numbers, Table, Tables

__all__ = [
    "Clumps",
    "Comb",
    "Curl",
    "Cut",
    "Fringe",
    "HairSettings",
    "Hairline",
    "Length",
    "Lift",
    "Parting",
    "Ponytail",
    "Stiffness",
    "Style",
    "Variation",
    "Volume",
]


class HairSettings(Table):
    """The hair at rest: grown from the scalp, or, where `file` is given, read from a file."""

    __slots__ = ()

    @property
    def segment_length(self) -> float:
        """Length of the segments that are grown (d), in which stiffness and the paper's k and i are counted. Number
        above 0 (cm); default: 1.
        """
        value: float = self._get('segment_length')
        return value

    @segment_length.setter
    def segment_length(self, value: float | None) -> None:
        self._set('segment_length', value)

    @property
    def strands(self) -> int:
        """Number of strands of the whole scene. 19,330 is the paper's Table 1. Whole number, 1 to 800000000; default:
        19330.
        """
        value: int = self._get('strands')
        return value

    @strands.setter
    def strands(self, value: int | None) -> None:
        self._set('strands', value)

    @property
    def segments(self) -> int:
        """Most segments of a strand. 18 is the paper's k. Whole number, 1 to 65535; default: 18."""
        value: int = self._get('segments')
        return value

    @segments.setter
    def segments(self, value: int | None) -> None:
        self._set('segments', value)

    @property
    def seed(self) -> int:
        """Seed of the roots and of the differences between strands: another number, others of both. Whole number;
        default: 1.
        """
        value: int = self._get('seed')
        return value

    @seed.setter
    def seed(self, value: int | None) -> None:
        self._set('seed', value)

    @property
    def hairline(self) -> Hairline:
        """Where hair grows."""
        return Hairline(self._scene, self._key_of('hairline'))

    @hairline.setter
    def hairline(self, value: Hairline | Mapping[str, Any] | None) -> None:
        self._set('hairline', value)

    @property
    def style(self) -> Style:
        """How it lies."""
        return Style(self._scene, self._key_of('style'))

    @style.setter
    def style(self, value: Style | Mapping[str, Any] | None) -> None:
        self._set('style', value)

    @property
    def file(self) -> str:
        """A .hair, .tfx, .obj (polylines), USD layer or Alembic archive. Path; must be given."""
        value: str = self._get('file')
        return value

    @file.setter
    def file(self, value: File | Arrays | None) -> None:
        self._set('file', value)

    @property
    def groups(self) -> tuple[str, ...]:
        """Curves of a USD layer or Alembic archive to keep, by the name or path of their prim or of what it stands
        below; all if empty. List of texts; default: none.
        """
        value: tuple[str, ...] = self._get('groups')
        return value

    @groups.setter
    def groups(self, value: Sequence[str] | None) -> None:
        self._set('groups', value)

    @property
    def unit(self) -> str | float | None:
        """Unit of the file. Left out, it is what the file says, or that of the head's file, or cm. "mm", "cm", "dm",
        "m", "in" or "ft", or number above 0; default: what files say.
        """
        value: str | float | None = self._get('unit')
        return value

    @unit.setter
    def unit(self, value: str | float | None) -> None:
        self._set('unit', value)

    @property
    def up(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file that points up. Left out, it is what the file says, or that of the head's file, or +y. "+x",
        "-x", "+y", "-y", "+z" or "-z"; default: what files say.
        """
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('up')
        return value

    @up.setter
    def up(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('up', value)

    @property
    def facing(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file along which the face looks. Left out, it is that of the head's file, or +x. "+x", "-x", "+y",
        "-y", "+z" or "-z"; default: the head's.
        """
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('facing')
        return value

    @facing.setter
    def facing(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('facing', value)

    @property
    def origin(self) -> tuple[float, float, float] | None:
        """Point of the file that becomes the origin of head space, in the file's unit. 3 numbers; default: the head's."""
        value: tuple[float, float, float] | None = self._get('origin')
        return value

    @origin.setter
    def origin(self, value: Numbers | None) -> None:
        self._set('origin', value)

    @property
    def root(self) -> Literal["skin", "first", "last"]:
        """Which end of a strand is its root. "skin", "first" or "last"; default: "skin"."""
        value: Literal["skin", "first", "last"] = self._get('root')
        return value

    @root.setter
    def root(self, value: Literal["skin", "first", "last"] | None) -> None:
        self._set('root', value)

    @property
    def join_within(self) -> float:
        """Neighbouring points of a strand this close are joined. 0 joins those alone that lie in one place, between
        which a strand has no direction to move in. Number of at least 0 (cm); default: 0.001.
        """
        value: float = self._get('join_within')
        return value

    @join_within.setter
    def join_within(self, value: float | None) -> None:
        self._set('join_within', value)

    @property
    def drop_shorter_than(self) -> float:
        """Strands shorter than this are dropped; 0: only those without any extent. Number of at least 0 (cm); default:
        0.
        """
        value: float = self._get('drop_shorter_than')
        return value

    @drop_shorter_than.setter
    def drop_shorter_than(self, value: float | None) -> None:
        self._set('drop_shorter_than', value)


class Hairline(Table):
    """Where hair grows: how far the hairline runs below the crown, all about the head.

    Depths are measured straight down from the highest point of the head ellipsoid E, in units of the mean of its two
    horizontal half axes (8.65 cm on the built-in bust), so that a hairline fits heads of any size.
    """

    __slots__ = ()

    @property
    def forehead(self) -> float:
        """Depth of the line over the middle of the forehead. 0.5 is 4.3 cm on the bust. Number, 0 to 2; default: 0.5."""
        value: float = self._get('forehead')
        return value

    @forehead.setter
    def forehead(self, value: float | None) -> None:
        self._set('forehead', value)

    @property
    def temple_recession(self) -> float:
        """How much higher than that the line stands over the temples. 0.05 is 0.4 cm on the bust. Number, -0.5 to 0.5;
        default: 0.05.
        """
        value: float = self._get('temple_recession')
        return value

    @temple_recession.setter
    def temple_recession(self, value: float | None) -> None:
        self._set('temple_recession', value)

    @property
    def sideburns(self) -> float:
        """Depth of the lower end of the sideburns, in front of the ears. 1.45 is 12.5 cm on the bust. Number, 0 to 2.5;
        default: 1.45.
        """
        value: float = self._get('sideburns')
        return value

    @sideburns.setter
    def sideburns(self, value: float | None) -> None:
        self._set('sideburns', value)

    @property
    def above_ears(self) -> float:
        """Depth of the line above the ears. 0.98 is 8.5 cm on the bust. Number, 0 to 2.5; default: 0.98."""
        value: float = self._get('above_ears')
        return value

    @above_ears.setter
    def above_ears(self, value: float | None) -> None:
        self._set('above_ears', value)

    @property
    def behind_ears(self) -> float:
        """How much farther forward the line comes down behind the ears: hair that is tied up shows where it runs. 0.25
        is 2.2 cm on the bust. Number, 0 to 0.25; default: 0.
        """
        value: float = self._get('behind_ears')
        return value

    @behind_ears.setter
    def behind_ears(self, value: float | None) -> None:
        self._set('behind_ears', value)

    @property
    def nape(self) -> float:
        """Depth of the line on the nape. 2.1 is 18 cm on the bust. Number, 0 to 2.8; default: 2.1."""
        value: float = self._get('nape')
        return value

    @nape.setter
    def nape(self, value: float | None) -> None:
        self._set('nape', value)

    @property
    def fade(self) -> float:
        """Height over which hair thins out at the line. 0.1 is 0.9 cm on the bust. Number, 0 to 1; default: 0.1."""
        value: float = self._get('fade')
        return value

    @fade.setter
    def fade(self, value: float | None) -> None:
        self._set('fade', value)

    @property
    def wander(self) -> float:
        """How far the line wanders up and down, in waves of one to three centimetres on the bust. Number, 0 to 0.3;
        default: 0.
        """
        value: float = self._get('wander')
        return value

    @wander.setter
    def wander(self, value: float | None) -> None:
        self._set('wander', value)


class Style(Table):
    """A hairstyle: how hair leaves the scalp, how stiff and how long it is, where it is combed and cut.

    Lengths are in cm, directions in head space (+x where the face looks, +y up, +z to the character's right), loads
    in units of the hair's own weight.
    """

    __slots__ = ()

    @property
    def stiffness(self) -> Stiffness:
        """(E I / w)^(1/3): over about this length hair bends under its own weight."""
        return Stiffness(self._scene, self._key_of('stiffness'))

    @stiffness.setter
    def stiffness(self, value: Stiffness | Mapping[str, Any] | None) -> None:
        self._set('stiffness', value)

    @property
    def length(self) -> Length:
        """Length before any cut, at most `hair.segments` x `hair.segment_length`."""
        return Length(self._scene, self._key_of('length'))

    @length.setter
    def length(self, value: Length | Mapping[str, Any] | None) -> None:
        self._set('length', value)

    @property
    def lift_degrees(self) -> Lift:
        """Angle between a root and the scalp: 90 is along the normal, as in the paper."""
        return Lift(self._scene, self._key_of('lift_degrees'))

    @lift_degrees.setter
    def lift_degrees(self, value: Lift | Mapping[str, Any] | None) -> None:
        self._set('lift_degrees', value)

    @property
    def parting(self) -> Parting:
        """The line that hair is combed away from."""
        return Parting(self._scene, self._key_of('parting'))

    @parting.setter
    def parting(self, value: Parting | Mapping[str, Any] | None) -> None:
        self._set('parting', value)

    @property
    def comb(self) -> Comb:
        """The styling force near the root."""
        return Comb(self._scene, self._key_of('comb'))

    @comb.setter
    def comb(self, value: Comb | Mapping[str, Any] | None) -> None:
        self._set('comb', value)

    @property
    def fringe(self) -> Fringe:
        """Hair combed over the forehead; none by default."""
        return Fringe(self._scene, self._key_of('fringe'))

    @fringe.setter
    def fringe(self, value: Fringe | Mapping[str, Any] | None) -> None:
        self._set('fringe', value)

    @property
    def volume(self) -> Volume:
        """How hair lies over hair."""
        return Volume(self._scene, self._key_of('volume'))

    @volume.setter
    def volume(self, value: Volume | Mapping[str, Any] | None) -> None:
        self._set('volume', value)

    @property
    def variation(self) -> Variation:
        """How much the strands differ."""
        return Variation(self._scene, self._key_of('variation'))

    @variation.setter
    def variation(self, value: Variation | Mapping[str, Any] | None) -> None:
        self._set('variation', value)

    @property
    def clumps(self) -> Clumps:
        """How strands keep together."""
        return Clumps(self._scene, self._key_of('clumps'))

    @clumps.setter
    def clumps(self, value: Clumps | Mapping[str, Any] | None) -> None:
        self._set('clumps', value)

    @property
    def curl(self) -> Curl:
        """Curls and waves; none by default."""
        return Curl(self._scene, self._key_of('curl'))

    @curl.setter
    def curl(self, value: Curl | Mapping[str, Any] | None) -> None:
        self._set('curl', value)

    @property
    def ponytail(self) -> Ponytail:
        """A tail that all hair but the fringe is tied to."""
        return Ponytail(self._scene, self._key_of('ponytail'))

    @ponytail.setter
    def ponytail(self, value: Ponytail | Mapping[str, Any] | None) -> None:
        self._set('ponytail', value)

    @property
    def cuts(self) -> Tables[Cut]:
        """Planes beyond which hair is cut off, in any number."""
        return Tables(self._scene, self._key_of('cuts'), Cut)

    @cuts.setter
    def cuts(self, value: Iterable[Cut | Mapping[str, Any]] | None) -> None:
        self._set('cuts', value)

    @property
    def lever_arms(self) -> Literal["straight", "deformed"]:
        """Which lever arms bend a strand that hangs free. "straight" or "deformed"; default: "deformed"."""
        value: Literal["straight", "deformed"] = self._get('lever_arms')
        return value

    @lever_arms.setter
    def lever_arms(self, value: Literal["straight", "deformed"] | None) -> None:
        self._set('lever_arms', value)


class Stiffness(Table):
    """(E I / w)^(1/3) by region. Real hair: about 4.5; combed and lying on other hair, less."""

    __slots__ = ()

    @property
    def top(self) -> float:
        """On the upper third of the head; passes smoothly into `sides` and `back`. Number, 0.1 to 100 (cm); default: 2."""
        value: float = self._get('top')
        return value

    @top.setter
    def top(self, value: float | None) -> None:
        self._set('top', value)

    @property
    def sides(self) -> float:
        """Below, in front of the middle of the ears; passes smoothly into `back`. Number, 0.1 to 100 (cm); default: 2."""
        value: float = self._get('sides')
        return value

    @sides.setter
    def sides(self, value: float | None) -> None:
        self._set('sides', value)

    @property
    def back(self) -> float:
        """Below, behind. Number, 0.1 to 100 (cm); default: 2."""
        value: float = self._get('back')
        return value

    @back.setter
    def back(self, value: float | None) -> None:
        self._set('back', value)

    @property
    def fringe(self) -> float:
        """Of the fringe, if the style has one. Number, 0.1 to 100 (cm); default: 2."""
        value: float = self._get('fringe')
        return value

    @fringe.setter
    def fringe(self, value: float | None) -> None:
        self._set('fringe', value)


class Length(Table):
    """Length by region before any cut."""

    __slots__ = ()

    @property
    def top(self) -> float:
        """On the upper third of the head; passes smoothly into `sides` and `back`. Number above 0 (cm); default: 18."""
        value: float = self._get('top')
        return value

    @top.setter
    def top(self, value: float | None) -> None:
        self._set('top', value)

    @property
    def sides(self) -> float:
        """Below, in front of the middle of the ears; passes smoothly into `back`. Number above 0 (cm); default: 18."""
        value: float = self._get('sides')
        return value

    @sides.setter
    def sides(self, value: float | None) -> None:
        self._set('sides', value)

    @property
    def back(self) -> float:
        """Below, behind. Number above 0 (cm); default: 18."""
        value: float = self._get('back')
        return value

    @back.setter
    def back(self, value: float | None) -> None:
        self._set('back', value)

    @property
    def fringe(self) -> float:
        """Of the fringe, if the style has one. Number above 0 (cm); default: 18."""
        value: float = self._get('fringe')
        return value

    @fringe.setter
    def fringe(self, value: float | None) -> None:
        self._set('fringe', value)


class Lift(Table):
    """Angle of the roots above the scalp by region."""

    __slots__ = ()

    @property
    def top(self) -> float:
        """On the upper third of the head; passes smoothly into `sides` and `back`. Number, 0 to 90 (degrees); default:
        20.
        """
        value: float = self._get('top')
        return value

    @top.setter
    def top(self, value: float | None) -> None:
        self._set('top', value)

    @property
    def sides(self) -> float:
        """Below, in front of the middle of the ears; passes smoothly into `back`. Number, 0 to 90 (degrees); default:
        20.
        """
        value: float = self._get('sides')
        return value

    @sides.setter
    def sides(self, value: float | None) -> None:
        self._set('sides', value)

    @property
    def back(self) -> float:
        """Below, behind. Number, 0 to 90 (degrees); default: 20."""
        value: float = self._get('back')
        return value

    @back.setter
    def back(self, value: float | None) -> None:
        self._set('back', value)

    @property
    def fringe(self) -> float:
        """Of the fringe, if the style has one. Number, 0 to 90 (degrees); default: 20."""
        value: float = self._get('fringe')
        return value

    @fringe.setter
    def fringe(self, value: float | None) -> None:
        self._set('fringe', value)


class Parting(Table):
    """The parting: a line over the top of the head, straight as seen from above, from the front to the crown.

    Hair is combed away from the nearest point of it: to the sides along the line, all around beyond its ends.
    Positive z is on the character's right.
    """

    __slots__ = ()

    @property
    def front(self) -> tuple[float, float]:
        """Its front end as seen from above, (x, z); it may stop short of the hairline. 2 numbers, each -100 to 100 (cm);
        default: [10, 0].
        """
        value: tuple[float, float] = self._get('front')
        return value

    @front.setter
    def front(self, value: Numbers | None) -> None:
        self._set('front', value)

    @property
    def crown(self) -> tuple[float, float]:
        """Its end at the crown, (x, z). 2 numbers, each -100 to 100 (cm); default: [-4, 0]."""
        value: tuple[float, float] = self._get('crown')
        return value

    @crown.setter
    def crown(self, value: Numbers | None) -> None:
        self._set('crown', value)

    @property
    def wobble(self) -> float:
        """How far it strays from the straight line, clumps and single strands alike: what grows nearer falls to either
        side, which keeps the line from being bare. Number, 0 to 5 (cm); default: 0.3.
        """
        value: float = self._get('wobble')
        return value

    @wobble.setter
    def wobble(self, value: float | None) -> None:
        self._set('wobble', value)


class Comb(Table):
    """The styling force: a load besides the weight that decays along the strand as exp(-s / decay)."""

    __slots__ = ()

    @property
    def away(self) -> float:
        """Away from the parting, level. Number, 0 to 1000 (weights); default: 1."""
        value: float = self._get('away')
        return value

    @away.setter
    def away(self, value: float | None) -> None:
        self._set('away', value)

    @property
    def sweep(self) -> tuple[float, float, float]:
        """In one direction for all hair but the fringe: (-1, 0, 0) is backward. 3 numbers, each -1000 to 1000 (weights);
        default: [0, 0, 0].
        """
        value: tuple[float, float, float] = self._get('sweep')
        return value

    @sweep.setter
    def sweep(self, value: Numbers | None) -> None:
        self._set('sweep', value)

    @property
    def off_face(self) -> float:
        """Backward for hair rooted in front, growing toward the forehead, which keeps the face free. Number, 0 to 1000
        (weights); default: 0.
        """
        value: float = self._get('off_face')
        return value

    @off_face.setter
    def off_face(self, value: float | None) -> None:
        self._set('off_face', value)

    @property
    def decay(self) -> float:
        """Length over which they fall to 1/e. Number above 0 (cm); default: 6."""
        value: float = self._get('decay')
        return value

    @decay.setter
    def decay(self, value: float | None) -> None:
        self._set('decay', value)


class Fringe(Table):
    """Hair over the forehead: the strands rooted in a strip at the front are combed forward, past the parting's rule."""

    __slots__ = ()

    @property
    def half_width(self) -> float:
        """Half the width of the strip, about the middle of the head; 0: no fringe. Number, 0 to 100 (cm); default: 0."""
        value: float = self._get('half_width')
        return value

    @half_width.setter
    def half_width(self, value: float | None) -> None:
        self._set('half_width', value)

    @property
    def from_(self) -> float:
        """Where it ends behind, along x. Number, -100 to 100 (cm); default: 5."""
        value: float = self._get('from')
        return value

    @from_.setter
    def from_(self, value: float | None) -> None:
        self._set('from', value)

    @property
    def forward(self) -> float:
        """Load forward near the root. Number, 0 to 1000 (weights); default: 1.5."""
        value: float = self._get('forward')
        return value

    @forward.setter
    def forward(self, value: float | None) -> None:
        self._set('forward', value)

    @property
    def aside(self) -> float:
        """Load along z, for a fringe swept to one side. Number, -1000 to 1000 (weights); default: 0."""
        value: float = self._get('aside')
        return value

    @aside.setter
    def aside(self, value: float | None) -> None:
        self._set('aside', value)


class Volume(Table):
    """Hair over hair: what comes from farther up lies farther out."""

    __slots__ = ()

    @property
    def thickness(self) -> float:
        """Distance to the skin that hair from far above keeps. Number, 0 to 20 (cm); default: 0.8."""
        value: float = self._get('thickness')
        return value

    @thickness.setter
    def thickness(self, value: float | None) -> None:
        self._set('thickness', value)

    @property
    def reach(self) -> float:
        """Length of hair on the head over which most of it is reached. Number above 0 (cm); default: 6."""
        value: float = self._get('reach')
        return value

    @reach.setter
    def reach(self, value: float | None) -> None:
        self._set('reach', value)

    @property
    def gap(self) -> float:
        """Distance that any hair keeps. Number, 0 to 5 (cm); default: 0.04."""
        value: float = self._get('gap')
        return value

    @gap.setter
    def gap(self, value: float | None) -> None:
        self._set('gap', value)

    @property
    def over_ears(self) -> bool:
        """Whether hair from above passes over the ears or parts about them. True or false; default: true."""
        value: bool = self._get('over_ears')
        return value

    @over_ears.setter
    def over_ears(self, value: bool | None) -> None:
        self._set('over_ears', value)


class Variation(Table):
    """Differences from strand to strand, drawn from the scene's seed and the root's place."""

    __slots__ = ()

    @property
    def length(self) -> float:
        """Largest share by which a strand falls short of its length. Number, 0 to 0.9; default: 0.06."""
        value: float = self._get('length')
        return value

    @length.setter
    def length(self, value: float | None) -> None:
        self._set('length', value)

    @property
    def stiffness(self) -> float:
        """Relative deviation of the stiffness. Number, 0 to 0.3; default: 0.15."""
        value: float = self._get('stiffness')
        return value

    @stiffness.setter
    def stiffness(self, value: float | None) -> None:
        self._set('stiffness', value)

    @property
    def direction_degrees(self) -> float:
        """Deviation of the direction, at the root and of the load. Number, 0 to 45 (degrees); default: 3."""
        value: float = self._get('direction_degrees')
        return value

    @direction_degrees.setter
    def direction_degrees(self, value: float | None) -> None:
        self._set('direction_degrees', value)

    @property
    def strays(self) -> float:
        """Share of stray hairs, whose direction deviates four times as much. Number, 0 to 1; default: 0.02."""
        value: float = self._get('strays')
        return value

    @strays.setter
    def strays(self, value: float | None) -> None:
        self._set('strays', value)

    @property
    def cut(self) -> float:
        """Deviation of the cut from its plane. Number, 0 to 10 (cm); default: 0.15."""
        value: float = self._get('cut')
        return value

    @cut.setter
    def cut(self, value: float | None) -> None:
        self._set('cut', value)

    @property
    def baby_hair(self) -> float:
        """Baby hair: the largest share by which a strand on the hairline falls short, and strays the more. It is as long
        as others from 0.2 of the hairline's unit on (1.7 cm on the bust). Number, 0 to 0.95; default: 0.
        """
        value: float = self._get('baby_hair')
        return value

    @baby_hair.setter
    def baby_hair(self, value: float | None) -> None:
        self._set('baby_hair', value)


class Clumps(Table):
    """Clumps: neighbours that fall together, and wave together."""

    __slots__ = ()

    @property
    def size(self) -> float:
        """Width of a clump at the scalp. Number above 0 (cm); default: 1.2."""
        value: float = self._get('size')
        return value

    @size.setter
    def size(self, value: float | None) -> None:
        self._set('size', value)

    @property
    def gather(self) -> float:
        """How far its tips draw together: 0 not at all, 1 to a point. Number, 0 to 1; default: 0.4."""
        value: float = self._get('gather')
        return value

    @gather.setter
    def gather(self, value: float | None) -> None:
        self._set('gather', value)

    @property
    def direction_degrees(self) -> float:
        """Deviation of a clump's direction as a whole. Number, 0 to 45 (degrees); default: 2."""
        value: float = self._get('direction_degrees')
        return value

    @direction_degrees.setter
    def direction_degrees(self, value: float | None) -> None:
        self._set('direction_degrees', value)

    @property
    def wave(self) -> float:
        """Height of its waves, at most 0.16 of their length. Number of at least 0 (cm); default: 0.1."""
        value: float = self._get('wave')
        return value

    @wave.setter
    def wave(self, value: float | None) -> None:
        self._set('wave', value)

    @property
    def wave_length(self) -> float:
        """Length of its waves. Number above 0 (cm); default: 8."""
        value: float = self._get('wave_length')
        return value

    @wave_length.setter
    def wave_length(self, value: float | None) -> None:
        self._set('wave_length', value)


class Curl(Table):
    """Curls: every strand winds about the line in which it would hang without them, alike within a clump.

    `hair.style.length` is the hair's own, so a strand reaches the less far the more it curls, and has the same
    segments. Stiffness and loads are those of the curled strand as a whole, and cuts are made where its line meets
    the plane: its end lies within the curl's radius of that.
    """

    __slots__ = ()

    @property
    def radius(self) -> float:
        """Distance between a strand and its line, at most `pitch`; 0: no curls. Number of at least 0 (cm); default: 0."""
        value: float = self._get('radius')
        return value

    @radius.setter
    def radius(self, value: float | None) -> None:
        self._set('radius', value)

    @property
    def pitch(self) -> float:
        """Length of the line in one turn. Number above 0 (cm); default: 2.5."""
        value: float = self._get('pitch')
        return value

    @pitch.setter
    def pitch(self, value: float | None) -> None:
        self._set('pitch', value)

    @property
    def from_(self) -> float:
        """Distance from the root at which curls are whole, as a share of the strand's length: from there on they have
        their radius, before they grow to it. Number, 0.01 to 1; default: 0.25.
        """
        value: float = self._get('from')
        return value

    @from_.setter
    def from_(self, value: float | None) -> None:
        self._set('from', value)

    @property
    def flatness(self) -> float:
        """0 winds to a helix, 1 waves in a plane; between them the helix is flat. Number, 0 to 1; default: 0."""
        value: float = self._get('flatness')
        return value

    @flatness.setter
    def flatness(self, value: float | None) -> None:
        self._set('flatness', value)

    @property
    def gather(self) -> float:
        """How far the hair of a clump closes to one lock by `from`: 0 not at all, 1 onto one line. Number, 0 to 1;
        default: 0.7.
        """
        value: float = self._get('gather')
        return value

    @gather.setter
    def gather(self, value: float | None) -> None:
        self._set('gather', value)

    @property
    def variation(self) -> float:
        """Largest share by which radius and pitch differ from clump to clump. Number, 0 to 0.6; default: 0.2."""
        value: float = self._get('variation')
        return value

    @variation.setter
    def variation(self, value: float | None) -> None:
        self._set('variation', value)

    @property
    def frizz(self) -> float:
        """The same for the radius of single strands within a clump, and for the half turn by which they may be ahead or
        behind. Number, 0 to 0.6; default: 0.15.
        """
        value: float = self._get('frizz')
        return value

    @frizz.setter
    def frizz(self, value: float | None) -> None:
        self._set('frizz', value)


class Ponytail(Table):
    """A ponytail: hair goes along the head to one place, through a band there, and falls from it.

    A strand too short to reach it ends on the way. `[free] tie` holds the hair there when it moves.
    """

    __slots__ = ()

    @property
    def at(self) -> tuple[float, float, float]:
        """The middle of the band, in head space, at least `radius` away from the skin. 3 numbers (cm); must be given."""
        value: tuple[float, float, float] = self._get('at')
        return value

    @at.setter
    def at(self, value: Numbers | None) -> None:
        self._set('at', value)

    @property
    def radius(self) -> float:
        """Radius of the hair within the band. Number, 0.01 to 5 (cm); default: 0.9."""
        value: float = self._get('radius')
        return value

    @radius.setter
    def radius(self, value: float | None) -> None:
        self._set('radius', value)

    @property
    def direction(self) -> tuple[float, float, float]:
        """The way that hair takes through the band, of any length but 0. 3 numbers; default: [-1, 0.2, 0]."""
        value: tuple[float, float, float] = self._get('direction')
        return value

    @direction.setter
    def direction(self, value: Numbers | None) -> None:
        self._set('direction', value)


class Cut(Table):
    """A cut: hair on the side of the plane that `normal` points to is taken off."""

    __slots__ = ()

    @property
    def point(self) -> tuple[float, float, float]:
        """A point of the plane, in head space. 3 numbers (cm); must be given."""
        value: tuple[float, float, float] = self._get('point')
        return value

    @point.setter
    def point(self, value: Numbers | None) -> None:
        self._set('point', value)

    @property
    def normal(self) -> tuple[float, float, float]:
        """Toward the hair taken off, of any length but 0: (0, -1, 0) cuts level. 3 numbers; must be given."""
        value: tuple[float, float, float] = self._get('normal')
        return value

    @normal.setter
    def normal(self, value: Numbers | None) -> None:
        self._set('normal', value)

    @property
    def region(self) -> Literal["top", "sides", "back", "fringe"] | None:
        """The region whose hair it cuts. "top", "sides", "back" or "fringe"; default: all."""
        value: Literal["top", "sides", "back", "fringe"] | None = self._get('region')
        return value

    @region.setter
    def region(self, value: Literal["top", "sides", "back", "fringe"] | None) -> None:
        self._set('region', value)

    @property
    def shortest(self) -> float:
        """No strand is made shorter than this: in the paper's equations (6) to (8) a strand of length L feels c_k |F| =
        (3 dt^2 / 2 lambda) |F| / (k L^2), and a stubble would be too quick for the time step. Number above 0 (cm);
        default: 2.5.
        """
        value: float = self._get('shortest')
        return value

    @shortest.setter
    def shortest(self, value: float | None) -> None:
        self._set('shortest', value)
