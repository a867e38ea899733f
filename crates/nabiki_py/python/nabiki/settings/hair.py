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
    """The hair at rest. It grows from the scalp, or comes from a file if you give `file`."""

    __slots__ = ()

    @property
    def segment_length(self) -> float:
        """Length d of a grown segment. Stiffness and the paper's k and i are counted in this length. Number above 0
        (cm); default: 1.
        """
        value: float = self._get('segment_length')
        return value

    @segment_length.setter
    def segment_length(self, value: float | None) -> None:
        self._set('segment_length', value)

    @property
    def strands(self) -> int:
        """Number of strands. The paper's Table 1 has 19,330. Whole number, 1 to 800000000; default: 19330."""
        value: int = self._get('strands')
        return value

    @strands.setter
    def strands(self, value: int | None) -> None:
        self._set('strands', value)

    @property
    def segments(self) -> int:
        """Largest number of segments of a strand. The paper uses k = 18. Whole number, 1 to 65535; default: 18."""
        value: int = self._get('segments')
        return value

    @segments.setter
    def segments(self, value: int | None) -> None:
        self._set('segments', value)

    @property
    def seed(self) -> int:
        """Random seed of the roots and of the differences between strands. Whole number; default: 1."""
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
        """How the hair is styled."""
        return Style(self._scene, self._key_of('style'))

    @style.setter
    def style(self, value: Style | Mapping[str, Any] | None) -> None:
        self._set('style', value)

    @property
    def file(self) -> str:
        """The hair: a .hair, .tfx, .obj (polylines), USD layer or Alembic archive. Path; must be given."""
        value: str = self._get('file')
        return value

    @file.setter
    def file(self, value: File | Arrays | None) -> None:
        self._set('file', value)

    @property
    def groups(self) -> tuple[str, ...]:
        """Curves of a USD layer or Alembic archive to use, by the name or path of their prim or of one above it. Uses
        all if empty. List of texts; default: none.
        """
        value: tuple[str, ...] = self._get('groups')
        return value

    @groups.setter
    def groups(self, value: Sequence[str] | None) -> None:
        self._set('groups', value)

    @property
    def unit(self) -> str | float | None:
        """Length unit of the file. By default the unit in the file, or else that of the head's file, or else cm. "mm",
        "cm", "dm", "m", "in" or "ft", or number above 0; default: what the file says.
        """
        value: str | float | None = self._get('unit')
        return value

    @unit.setter
    def unit(self, value: str | float | None) -> None:
        self._set('unit', value)

    @property
    def up(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file that points up. By default the axis in the file, or else that of the head's file, or else +y.
        "+x", "-x", "+y", "-y", "+z" or "-z"; default: what the file says.
        """
        value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None = self._get('up')
        return value

    @up.setter
    def up(self, value: Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None) -> None:
        self._set('up', value)

    @property
    def facing(self) -> Literal["+x", "-x", "+y", "-y", "+z", "-z"] | None:
        """Axis of the file along which the face looks. By default that of the head's file, or else +x. "+x", "-x", "+y",
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
        """Joins neighbouring points of a strand that are at most this far apart. 0 joins only points in the same place,
        between which a strand has no direction. Number of at least 0 (cm); default: 0.001.
        """
        value: float = self._get('join_within')
        return value

    @join_within.setter
    def join_within(self, value: float | None) -> None:
        self._set('join_within', value)

    @property
    def drop_shorter_than(self) -> float:
        """Drops strands shorter than this. 0 drops only strands without any length. Number of at least 0 (cm); default:
        0.
        """
        value: float = self._get('drop_shorter_than')
        return value

    @drop_shorter_than.setter
    def drop_shorter_than(self, value: float | None) -> None:
        self._set('drop_shorter_than', value)


class Hairline(Table):
    """Where hair grows: how far the hairline runs below the crown, all around the head.

    Depths are measured straight down from the top of the head ellipsoid E. The unit is the mean of its two horizontal
    half axes, 8.65 cm on the built-in bust, so a hairline fits heads of any size.
    """

    __slots__ = ()

    @property
    def forehead(self) -> float:
        """Depth of the line above the middle of the forehead. 0.5 is 4.3 cm on the bust. Number, 0 to 2; default: 0.5."""
        value: float = self._get('forehead')
        return value

    @forehead.setter
    def forehead(self, value: float | None) -> None:
        self._set('forehead', value)

    @property
    def temple_recession(self) -> float:
        """How much higher the line is at the temples than at the forehead. 0.05 is 0.4 cm on the bust. Number, -0.5 to
        0.5; default: 0.05.
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
        """How much farther forward the line comes down behind the ears. It shows when hair is tied up. 0.25 is 2.2 cm on
        the bust. Number, 0 to 0.25; default: 0.
        """
        value: float = self._get('behind_ears')
        return value

    @behind_ears.setter
    def behind_ears(self, value: float | None) -> None:
        self._set('behind_ears', value)

    @property
    def nape(self) -> float:
        """Depth of the line at the nape. 2.1 is 18 cm on the bust. Number, 0 to 2.8; default: 2.1."""
        value: float = self._get('nape')
        return value

    @nape.setter
    def nape(self, value: float | None) -> None:
        self._set('nape', value)

    @property
    def fade(self) -> float:
        """Height of the band along the line in which hair thins out. 0.1 is 0.9 cm on the bust. Number, 0 to 1; default:
        0.1.
        """
        value: float = self._get('fade')
        return value

    @fade.setter
    def fade(self, value: float | None) -> None:
        self._set('fade', value)

    @property
    def wander(self) -> float:
        """How far the line wanders up and down, in waves of 1 to 3 cm on the bust. Raise it for a less regular hairline.
        Number, 0 to 0.3; default: 0.
        """
        value: float = self._get('wander')
        return value

    @wander.setter
    def wander(self, value: float | None) -> None:
        self._set('wander', value)


class Style(Table):
    """A hairstyle: how hair leaves the scalp, its stiffness and length, and where it is combed and cut.

    Lengths are in cm. Directions are in head space: +x where the face looks, +y up, +z to the character's right.
    Loads are in units of the hair's own weight.
    """

    __slots__ = ()

    @property
    def stiffness(self) -> Stiffness:
        """Length over which hair bends under its own weight: (E I / w)^(1/3)."""
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
        """Angle between root and scalp. 90 is along the normal, as in the paper."""
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
        """Hair combed over the forehead. Off by default."""
        return Fringe(self._scene, self._key_of('fringe'))

    @fringe.setter
    def fringe(self, value: Fringe | Mapping[str, Any] | None) -> None:
        self._set('fringe', value)

    @property
    def volume(self) -> Volume:
        """How hair lies over other hair."""
        return Volume(self._scene, self._key_of('volume'))

    @volume.setter
    def volume(self, value: Volume | Mapping[str, Any] | None) -> None:
        self._set('volume', value)

    @property
    def variation(self) -> Variation:
        """How much strands differ."""
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
        """Curls and waves. Off by default."""
        return Curl(self._scene, self._key_of('curl'))

    @curl.setter
    def curl(self, value: Curl | Mapping[str, Any] | None) -> None:
        self._set('curl', value)

    @property
    def ponytail(self) -> Ponytail:
        """A ponytail that ties all hair except the fringe."""
        return Ponytail(self._scene, self._key_of('ponytail'))

    @ponytail.setter
    def ponytail(self, value: Ponytail | Mapping[str, Any] | None) -> None:
        self._set('ponytail', value)

    @property
    def cuts(self) -> Tables[Cut]:
        """Any number of planes that cut off the hair beyond them."""
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
    """Bending length (E I / w)^(1/3) by region. Raise it for hair that stands off more. Real hair has about 4.5 cm;
    combed hair that lies on other hair has less.
    """

    __slots__ = ()

    @property
    def top(self) -> float:
        """Value on the upper third of the head. It blends smoothly into `sides` and `back`. Number, 0.1 to 100 (cm);
        default: 2.
        """
        value: float = self._get('top')
        return value

    @top.setter
    def top(self, value: float | None) -> None:
        self._set('top', value)

    @property
    def sides(self) -> float:
        """Value below the top, in front of the middle of the ears. It blends smoothly into `back`. Number, 0.1 to 100
        (cm); default: 2.
        """
        value: float = self._get('sides')
        return value

    @sides.setter
    def sides(self, value: float | None) -> None:
        self._set('sides', value)

    @property
    def back(self) -> float:
        """Value below the top, behind the ears. Number, 0.1 to 100 (cm); default: 2."""
        value: float = self._get('back')
        return value

    @back.setter
    def back(self, value: float | None) -> None:
        self._set('back', value)

    @property
    def fringe(self) -> float:
        """Value of the fringe, if the style has one. Number, 0.1 to 100 (cm); default: 2."""
        value: float = self._get('fringe')
        return value

    @fringe.setter
    def fringe(self, value: float | None) -> None:
        self._set('fringe', value)


class Length(Table):
    """Length by region, before any cut."""

    __slots__ = ()

    @property
    def top(self) -> float:
        """Value on the upper third of the head. It blends smoothly into `sides` and `back`. Number above 0 (cm);
        default: 18.
        """
        value: float = self._get('top')
        return value

    @top.setter
    def top(self, value: float | None) -> None:
        self._set('top', value)

    @property
    def sides(self) -> float:
        """Value below the top, in front of the middle of the ears. It blends smoothly into `back`. Number above 0 (cm);
        default: 18.
        """
        value: float = self._get('sides')
        return value

    @sides.setter
    def sides(self, value: float | None) -> None:
        self._set('sides', value)

    @property
    def back(self) -> float:
        """Value below the top, behind the ears. Number above 0 (cm); default: 18."""
        value: float = self._get('back')
        return value

    @back.setter
    def back(self, value: float | None) -> None:
        self._set('back', value)

    @property
    def fringe(self) -> float:
        """Value of the fringe, if the style has one. Number above 0 (cm); default: 18."""
        value: float = self._get('fringe')
        return value

    @fringe.setter
    def fringe(self, value: float | None) -> None:
        self._set('fringe', value)


class Lift(Table):
    """Angle of the roots above the scalp, by region."""

    __slots__ = ()

    @property
    def top(self) -> float:
        """Value on the upper third of the head. It blends smoothly into `sides` and `back`. Number, 0 to 90 (degrees);
        default: 20.
        """
        value: float = self._get('top')
        return value

    @top.setter
    def top(self, value: float | None) -> None:
        self._set('top', value)

    @property
    def sides(self) -> float:
        """Value below the top, in front of the middle of the ears. It blends smoothly into `back`. Number, 0 to 90
        (degrees); default: 20.
        """
        value: float = self._get('sides')
        return value

    @sides.setter
    def sides(self, value: float | None) -> None:
        self._set('sides', value)

    @property
    def back(self) -> float:
        """Value below the top, behind the ears. Number, 0 to 90 (degrees); default: 20."""
        value: float = self._get('back')
        return value

    @back.setter
    def back(self, value: float | None) -> None:
        self._set('back', value)

    @property
    def fringe(self) -> float:
        """Value of the fringe, if the style has one. Number, 0 to 90 (degrees); default: 20."""
        value: float = self._get('fringe')
        return value

    @fringe.setter
    def fringe(self, value: float | None) -> None:
        self._set('fringe', value)


class Parting(Table):
    """The parting: a line over the top of the head from the front to the crown, straight as seen from above.

    Hair is combed away from the nearest point of the line: to the sides along it, in all directions beyond its ends.
    Positive z is on the character's right.
    """

    __slots__ = ()

    @property
    def front(self) -> tuple[float, float]:
        """Front end of the line as seen from above, (x, z). It may lie behind the hairline. 2 numbers, each -100 to 100
        (cm); default: [10, 0].
        """
        value: tuple[float, float] = self._get('front')
        return value

    @front.setter
    def front(self, value: Numbers | None) -> None:
        self._set('front', value)

    @property
    def crown(self) -> tuple[float, float]:
        """End of the line at the crown, (x, z). 2 numbers, each -100 to 100 (cm); default: [-4, 0]."""
        value: tuple[float, float] = self._get('crown')
        return value

    @crown.setter
    def crown(self, value: Numbers | None) -> None:
        self._set('crown', value)

    @property
    def wobble(self) -> float:
        """How far the parting strays from the straight line, by clumps and single strands. Raise it to hide a bare line:
        hair that grows nearer falls to either side. Number, 0 to 5 (cm); default: 0.3.
        """
        value: float = self._get('wobble')
        return value

    @wobble.setter
    def wobble(self, value: float | None) -> None:
        self._set('wobble', value)


class Comb(Table):
    """The styling force. It acts in addition to weight and decays along the strand as exp(-s / decay)."""

    __slots__ = ()

    @property
    def away(self) -> float:
        """Load away from the parting, horizontally. Number, 0 to 1000 (weights); default: 1."""
        value: float = self._get('away')
        return value

    @away.setter
    def away(self, value: float | None) -> None:
        self._set('away', value)

    @property
    def sweep(self) -> tuple[float, float, float]:
        """Load in one direction for all hair except the fringe. (-1, 0, 0) is backward. 3 numbers, each -1000 to 1000
        (weights); default: [0, 0, 0].
        """
        value: tuple[float, float, float] = self._get('sweep')
        return value

    @sweep.setter
    def sweep(self, value: Numbers | None) -> None:
        self._set('sweep', value)

    @property
    def off_face(self) -> float:
        """Backward load on hair rooted in front, strongest at the forehead. Raise it to keep the face free. Number, 0 to
        1000 (weights); default: 0.
        """
        value: float = self._get('off_face')
        return value

    @off_face.setter
    def off_face(self, value: float | None) -> None:
        self._set('off_face', value)

    @property
    def decay(self) -> float:
        """Length over which these loads fall to 1/e. Number above 0 (cm); default: 6."""
        value: float = self._get('decay')
        return value

    @decay.setter
    def decay(self, value: float | None) -> None:
        self._set('decay', value)


class Fringe(Table):
    """Hair over the forehead. Strands rooted in a strip at the front are combed forward instead of away from the
    parting.
    """

    __slots__ = ()

    @property
    def half_width(self) -> float:
        """Half the width of the strip, centred on the head. 0 makes no fringe. Number, 0 to 100 (cm); default: 0."""
        value: float = self._get('half_width')
        return value

    @half_width.setter
    def half_width(self, value: float | None) -> None:
        self._set('half_width', value)

    @property
    def from_(self) -> float:
        """Rear edge of the strip along x. Number, -100 to 100 (cm); default: 5."""
        value: float = self._get('from')
        return value

    @from_.setter
    def from_(self, value: float | None) -> None:
        self._set('from', value)

    @property
    def forward(self) -> float:
        """Forward load near the root. Number, 0 to 1000 (weights); default: 1.5."""
        value: float = self._get('forward')
        return value

    @forward.setter
    def forward(self, value: float | None) -> None:
        self._set('forward', value)

    @property
    def aside(self) -> float:
        """Load along z near the root. Raise it to sweep the fringe to one side. Number, -1000 to 1000 (weights);
        default: 0.
        """
        value: float = self._get('aside')
        return value

    @aside.setter
    def aside(self, value: float | None) -> None:
        self._set('aside', value)


class Volume(Table):
    """Hair over hair: hair from farther up lies farther out."""

    __slots__ = ()

    @property
    def thickness(self) -> float:
        """Distance from the skin that hair from far above keeps. Number, 0 to 20 (cm); default: 0.8."""
        value: float = self._get('thickness')
        return value

    @thickness.setter
    def thickness(self, value: float | None) -> None:
        self._set('thickness', value)

    @property
    def reach(self) -> float:
        """Length of hair on the head over which most of `thickness` is reached. Number above 0 (cm); default: 6."""
        value: float = self._get('reach')
        return value

    @reach.setter
    def reach(self, value: float | None) -> None:
        self._set('reach', value)

    @property
    def gap(self) -> float:
        """Distance from the skin that all hair keeps. Number, 0 to 5 (cm); default: 0.04."""
        value: float = self._get('gap')
        return value

    @gap.setter
    def gap(self, value: float | None) -> None:
        self._set('gap', value)

    @property
    def over_ears(self) -> bool:
        """Whether hair from above passes over the ears instead of parting around them. True or false; default: true."""
        value: bool = self._get('over_ears')
        return value

    @over_ears.setter
    def over_ears(self, value: bool | None) -> None:
        self._set('over_ears', value)


class Variation(Table):
    """Random differences between strands. They depend on the scene's seed and the place of the root."""

    __slots__ = ()

    @property
    def length(self) -> float:
        """Largest share by which a strand is shorter than `length`. Number, 0 to 0.9; default: 0.06."""
        value: float = self._get('length')
        return value

    @length.setter
    def length(self, value: float | None) -> None:
        self._set('length', value)

    @property
    def stiffness(self) -> float:
        """Standard deviation of the stiffness, relative to its value. Number, 0 to 0.3; default: 0.15."""
        value: float = self._get('stiffness')
        return value

    @stiffness.setter
    def stiffness(self, value: float | None) -> None:
        self._set('stiffness', value)

    @property
    def direction_degrees(self) -> float:
        """Standard deviation of the direction, at the root and of the load. Number, 0 to 45 (degrees); default: 3."""
        value: float = self._get('direction_degrees')
        return value

    @direction_degrees.setter
    def direction_degrees(self, value: float | None) -> None:
        self._set('direction_degrees', value)

    @property
    def strays(self) -> float:
        """Share of stray hairs. Their direction varies four times as much. Number, 0 to 1; default: 0.02."""
        value: float = self._get('strays')
        return value

    @strays.setter
    def strays(self, value: float | None) -> None:
        self._set('strays', value)

    @property
    def cut(self) -> float:
        """Standard deviation of the cut from its plane. Number, 0 to 10 (cm); default: 0.15."""
        value: float = self._get('cut')
        return value

    @cut.setter
    def cut(self, value: float | None) -> None:
        self._set('cut', value)

    @property
    def baby_hair(self) -> float:
        """Largest share by which a strand at the hairline is shorter; it also strays more. Hair has its full length from
        0.2 of the unit of the hairline on (1.7 cm on the bust). Number, 0 to 0.95; default: 0.
        """
        value: float = self._get('baby_hair')
        return value

    @baby_hair.setter
    def baby_hair(self, value: float | None) -> None:
        self._set('baby_hair', value)


class Clumps(Table):
    """Clumps: neighbouring strands that fall and wave together."""

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
        """How far the tips of a clump draw together, from 0 (not at all) to 1 (to a point). Number, 0 to 1; default:
        0.4.
        """
        value: float = self._get('gather')
        return value

    @gather.setter
    def gather(self, value: float | None) -> None:
        self._set('gather', value)

    @property
    def direction_degrees(self) -> float:
        """Standard deviation of the direction of each clump. Number, 0 to 45 (degrees); default: 2."""
        value: float = self._get('direction_degrees')
        return value

    @direction_degrees.setter
    def direction_degrees(self, value: float | None) -> None:
        self._set('direction_degrees', value)

    @property
    def wave(self) -> float:
        """Height of the waves of a clump, at most 0.16 of their length. Number of at least 0 (cm); default: 0.1."""
        value: float = self._get('wave')
        return value

    @wave.setter
    def wave(self, value: float | None) -> None:
        self._set('wave', value)

    @property
    def wave_length(self) -> float:
        """Length of the waves of a clump. Number above 0 (cm); default: 8."""
        value: float = self._get('wave_length')
        return value

    @wave_length.setter
    def wave_length(self, value: float | None) -> None:
        self._set('wave_length', value)


class Curl(Table):
    """Curls: each strand winds around the line that it would follow without curls, alike within a clump.

    A strand keeps the length of `hair.style.length` and its segments, so it reaches less far the more it curls.
    Stiffness and loads act on the curled strand. A cut acts where the line meets the plane, so the end of the strand
    lies within the curl's radius of it.
    """

    __slots__ = ()

    @property
    def radius(self) -> float:
        """Distance between a strand and its line, at most `pitch`. 0 makes no curls. Number of at least 0 (cm); default:
        0.
        """
        value: float = self._get('radius')
        return value

    @radius.setter
    def radius(self, value: float | None) -> None:
        self._set('radius', value)

    @property
    def pitch(self) -> float:
        """Length of the line per turn. Number above 0 (cm); default: 2.5."""
        value: float = self._get('pitch')
        return value

    @pitch.setter
    def pitch(self, value: float | None) -> None:
        self._set('pitch', value)

    @property
    def from_(self) -> float:
        """Distance from the root at which curls reach their full radius, as a share of the strand's length. Number, 0.01
        to 1; default: 0.25.
        """
        value: float = self._get('from')
        return value

    @from_.setter
    def from_(self, value: float | None) -> None:
        self._set('from', value)

    @property
    def flatness(self) -> float:
        """0 winds a helix, 1 waves in a plane. Values in between flatten the helix. Number, 0 to 1; default: 0."""
        value: float = self._get('flatness')
        return value

    @flatness.setter
    def flatness(self, value: float | None) -> None:
        self._set('flatness', value)

    @property
    def gather(self) -> float:
        """How far the hair of a clump closes to one lock by `from`, from 0 (not at all) to 1 (onto one line). Number, 0
        to 1; default: 0.7.
        """
        value: float = self._get('gather')
        return value

    @gather.setter
    def gather(self, value: float | None) -> None:
        self._set('gather', value)

    @property
    def variation(self) -> float:
        """Largest share by which radius and pitch differ between clumps. Number, 0 to 0.6; default: 0.2."""
        value: float = self._get('variation')
        return value

    @variation.setter
    def variation(self, value: float | None) -> None:
        self._set('variation', value)

    @property
    def frizz(self) -> float:
        """Largest share by which the radius differs between strands of a clump. It also shifts strands along the curl,
        by up to half a turn at 1. Number, 0 to 0.6; default: 0.15.
        """
        value: float = self._get('frizz')
        return value

    @frizz.setter
    def frizz(self, value: float | None) -> None:
        self._set('frizz', value)


class Ponytail(Table):
    """A ponytail: hair runs along the head to a band, passes through it and falls from there.

    A strand too short to reach the band ends on the way. To hold the hair there when it moves, add `[free.tie]`.
    """

    __slots__ = ()

    @property
    def at(self) -> tuple[float, float, float]:
        """Middle of the band in head space, at least `radius` away from the skin. 3 numbers (cm); must be given."""
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
        """Direction of the hair through the band. Any length except 0. 3 numbers; default: [-1, 0.2, 0]."""
        value: tuple[float, float, float] = self._get('direction')
        return value

    @direction.setter
    def direction(self, value: Numbers | None) -> None:
        self._set('direction', value)


class Cut(Table):
    """A cut. It removes the hair on the side of the plane that `normal` points to."""

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
        """Direction toward the removed hair. Any length except 0; (0, -1, 0) cuts horizontally. 3 numbers; must be
        given.
        """
        value: tuple[float, float, float] = self._get('normal')
        return value

    @normal.setter
    def normal(self, value: Numbers | None) -> None:
        self._set('normal', value)

    @property
    def region(self) -> Literal["top", "sides", "back", "fringe"] | None:
        """The region whose hair is cut. "top", "sides", "back" or "fringe"; default: all."""
        value: Literal["top", "sides", "back", "fringe"] | None = self._get('region')
        return value

    @region.setter
    def region(self, value: Literal["top", "sides", "back", "fringe"] | None) -> None:
        self._set('region', value)

    @property
    def shortest(self) -> float:
        """Minimum length of a strand after the cut. Very short strands swing too fast for the time step: by the paper's
        equations (6) to (8), a strand of length L feels c_k |F| = (3 dt^2 / 2 lambda) |F| / (k L^2). Number above 0
        (cm); default: 2.5.
        """
        value: float = self._get('shortest')
        return value

    @shortest.setter
    def shortest(self, value: float | None) -> None:
        self._set('shortest', value)
