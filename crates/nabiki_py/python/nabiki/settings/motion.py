"""How hair answers: `scene.motion`, `scene.free`, ... Written by generate.py from the schema of scenes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

from ._table import Arrays, File, Matrices, Numbers, Table, Tables

__all__ = [
    "AimSettings",
    "Contact",
    "Disturbance",
    "FieldShare",
    "FreeSettings",
    "LockVariation",
    "Motion",
    "NeighbourForces",
    "PseudoForce",
    "Region",
    "Tie",
]


class Motion(Table):
    """Length and pace of the motion, and the mass of hair. The defaults are Table 1 of the paper."""

    __slots__ = ()

    @property
    def form(self) -> Literal["paper", "free"]:
        """The equations of the motion. "paper" or "free"; default: "paper"."""
        value: Literal["paper", "free"] = self._get('form')
        return value

    @form.setter
    def form(self, value: Literal["paper", "free"] | None) -> None:
        self._set('form', value)

    @property
    def frames(self) -> int:
        """Number of frames after the rest frame 0 (N_f). Whole number, 1 to 10000000; default: 100."""
        value: int = self._get('frames')
        return value

    @frames.setter
    def frames(self, value: int | None) -> None:
        self._set('frames', value)

    @property
    def frame_rate(self) -> float:
        """Frames per second, for playback and for sampling a recorded head. Hair moves by frames, so only settings in
        world units such as "1 g" depend on this. Number above 0 (per second); default: 24.
        """
        value: float = self._get('frame_rate')
        return value

    @frame_rate.setter
    def frame_rate(self, value: float | None) -> None:
        self._set('frame_rate', value)

    @property
    def time_step(self) -> float:
        """Delta t of equation (7), in the method's own unit. A frame is one step; a larger value makes hair swing
        faster. Number above 0; default: 0.1.
        """
        value: float = self._get('time_step')
        return value

    @time_step.setter
    def time_step(self, value: float | None) -> None:
        self._set('time_step', value)

    @property
    def slow(self) -> float:
        """Slow motion of the hair: 4 shows hair as if filmed at four times the frame rate. The head and the fields keep
        their pace. Number, 0.1 to 100 (times); default: 1.
        """
        value: float = self._get('slow')
        return value

    @slow.setter
    def slow(self, value: float | None) -> None:
        self._set('slow', value)

    @property
    def linear_density(self) -> float:
        """Mass of 1 cm of hair, in the units of the force: lambda of equation (6). Number above 0 (per cm); default:
        0.05.
        """
        value: float = self._get('linear_density')
        return value

    @linear_density.setter
    def linear_density(self, value: float | None) -> None:
        self._set('linear_density', value)

    @property
    def inertia_length_floor(self) -> float:
        """Hair shorter than this gets the inertia of hair this long, as if longer neighbours held it. Raise it to calm
        short hair, which otherwise swings very fast. 0, as in the paper, gives each strand the inertia of its own
        length. Number of at least 0 (cm); default: 0.
        """
        value: float = self._get('inertia_length_floor')
        return value

    @inertia_length_floor.setter
    def inertia_length_floor(self, value: float | None) -> None:
        self._set('inertia_length_floor', value)

    @property
    def straighten(self) -> float:
        """Makes segments exactly vertical that are within this angle of the vertical at rest. They can then swing in the
        plane of any force (section 4.2). Raise it if straight hair is blown apart: a nearly vertical segment
        otherwise keeps the plane of its small lean. 0, as in the paper, leaves the hair as it is. Number, 0 to 45
        (degrees); default: 0.
        """
        value: float = self._get('straighten')
        return value

    @straighten.setter
    def straighten(self, value: float | None) -> None:
        self._set('straighten', value)

    @property
    def force_space(self) -> Literal["world", "head"]:
        """The space of the forces. It matters if the head turns. "world" or "head"; default: "world"."""
        value: Literal["world", "head"] = self._get('force_space')
        return value

    @force_space.setter
    def force_space(self, value: Literal["world", "head"] | None) -> None:
        self._set('force_space', value)


class FreeSettings(Table):
    """How hair keeps its shape and settles in the free form. Strengths are in F, the unit of the wind, or in world
    units.
    """

    __slots__ = ()

    @property
    def stiffness(self) -> float | str | tuple[float | str, ...]:
        """How firmly hair keeps its shape: at 36 times the strength of the wind, hair of 18 cm bends over about 6 cm.
        "4.5 cm" is hair that bends under its own `gravity` over that length, like real hair. One value, or a list
        from root to tip. In docs/motion-forms.md this is K, with EI = 3/8 A L K d^2 and d = `hair.segment_length`.
        The number of segments does not change how hair bends. Number, 0 to 1000000000, or "... cm", or a list of
        them; default: [12000, 1000].
        """
        value: float | str | tuple[float | str, ...] = self._get('stiffness')
        return value

    @stiffness.setter
    def stiffness(self, value: float | str | Numbers | Sequence[float | str] | None) -> None:
        self._set('stiffness', value)

    @property
    def hold(self) -> float | str | tuple[float | str, ...]:
        """How firmly hair returns to its groomed place on the head, like hair spray. "0.3 g" pulls with 0.3 times the
        weight of the hair on earth. One value, or a list from root to tip. In docs/motion-forms.md this is H: it
        turns segments toward their rest direction on the head. Against a force F, limp hair settles along F + H r.
        Number, 0 to 1000000000, or "... g", or a list of them; default: 30.
        """
        value: float | str | tuple[float | str, ...] = self._get('hold')
        return value

    @hold.setter
    def hold(self, value: float | str | Numbers | Sequence[float | str] | None) -> None:
        self._set('hold', value)

    @property
    def settle(self) -> float | str | tuple[float | str, ...]:
        """Number of frames in which a swing falls to 1/e: 7 looks like wet hair, 20 swings over once, 60 keeps waving, 0
        removes the air. "0.8 s" is a time instead of a number of frames. One value, or a list from root to tip,
        interpolated in frames: hair next to a 0 hardly swings. Number of at least 0 or "... s" or a list of them
        (frames); default: 20.
        """
        value: float | str | tuple[float | str, ...] = self._get('settle')
        return value

    @settle.setter
    def settle(self, value: float | str | Numbers | Sequence[float | str] | None) -> None:
        self._set('settle', value)

    @property
    def gravity(self) -> float | str:
        """How fast moved hair falls. Hair at rest does not sag. Give a strength in F, or "1 g" or "earth" for 981 cm/s^2
        at `motion.frame_rate`. Number, 0 to 1000000000, or "... g" or "earth"; default: 100.
        """
        value: float | str = self._get('gravity')
        return value

    @gravity.setter
    def gravity(self, value: float | str | None) -> None:
        self._set('gravity', value)

    @property
    def drag(self) -> float | tuple[float, ...]:
        """How far a moving head leaves the hair behind: 0 moves hair with the head, 1 is realistic, more exaggerates. It
        scales the effect of turns, accelerations and still air. One number, or a list from root to tip. Number, 0 to
        10, or list of numbers, each 0 to 10; default: 1.
        """
        value: float | tuple[float, ...] = self._get('drag')
        return value

    @drag.setter
    def drag(self, value: float | Numbers | None) -> None:
        self._set('drag', value)

    @property
    def pseudo_force(self) -> bool:
        """Whether `[pseudo_force]` weakens the wind in front of the head, as in the paper's form. True or false;
        default: false.
        """
        value: bool = self._get('pseudo_force')
        return value

    @pseudo_force.setter
    def pseudo_force(self, value: bool | None) -> None:
        self._set('pseudo_force', value)

    @property
    def variation(self) -> LockVariation:
        """Differences between locks, so that they part in the wind."""
        return LockVariation(self._scene, self._key_of('variation'))

    @variation.setter
    def variation(self, value: LockVariation | Mapping[str, Any] | None) -> None:
        self._set('variation', value)

    @property
    def regions(self) -> Tables[Region]:
        """Parts of the hair that move differently, such as a fringe that stays."""
        return Tables(self._scene, self._key_of('regions'), Region)

    @regions.setter
    def regions(self, value: Iterable[Region | Mapping[str, Any]] | None) -> None:
        self._set('regions', value)

    @property
    def tie(self) -> Tie:
        """A band that ties hair. Strands that pass it at rest are held from the root to the band."""
        return Tie(self._scene, self._key_of('tie'))

    @tie.setter
    def tie(self, value: Tie | Mapping[str, Any] | None) -> None:
        self._set('tie', value)

    @property
    def substeps(self) -> int | None:
        """Number of steps per frame. By default a scene takes as many as weight and stiffness need, at least 2. Raise it
        if fast contact is missed. Whole number, 1 to 32; default: as many as needed.
        """
        value: int | None = self._get('substeps')
        return value

    @substeps.setter
    def substeps(self, value: int | None) -> None:
        self._set('substeps', value)


class LockVariation(Table):
    """How locks differ, so that they part in the wind instead of moving as one.

    A lock is the hair of a clump of the groom. Its differences are drawn from its place on the head and the seed, so
    they are the same in each take. Hair that catches n times as much air is pushed n times as hard by the wind and
    settles n times as fast.
    """

    __slots__ = ()

    @property
    def air(self) -> float:
        """How much locks differ in the air they catch, so that they part in changing wind. It is the standard deviation
        of the logarithm: at 0.35, a sixth of the locks catches at least 1.4 times the air, and a sixth at most 0.7
        times. Number, 0 to 1; default: 0.35.
        """
        value: float = self._get('air')
        return value

    @air.setter
    def air(self, value: float | None) -> None:
        self._set('air', value)

    @property
    def flutter(self) -> float:
        """How much the wind on a lock varies by itself. It changes in strength and direction (root mean square, in
        radians), in the lock's own rhythm. This is what parts locks in a steady wind. Number, 0 to 0.5; default: 0.3.
        """
        value: float = self._get('flutter')
        return value

    @flutter.setter
    def flutter(self, value: float | None) -> None:
        self._set('flutter', value)

    @property
    def flutter_frames(self) -> float:
        """Approximate number of frames of one flutter. Number, 2 to 10000 (frames); default: 24."""
        value: float = self._get('flutter_frames')
        return value

    @flutter_frames.setter
    def flutter_frames(self, value: float | None) -> None:
        self._set('flutter_frames', value)

    @property
    def stiffness(self) -> float:
        """How much locks differ in stiffness: the standard deviation of its logarithm. Number, 0 to 1; default: 0.2."""
        value: float = self._get('stiffness')
        return value

    @stiffness.setter
    def stiffness(self, value: float | None) -> None:
        self._set('stiffness', value)

    @property
    def strands(self) -> float:
        """How much the strands within a lock differ, as a share of how locks differ. Large values fray locks to frizz.
        Number, 0 to 1; default: 0.2.
        """
        value: float = self._get('strands')
        return value

    @strands.setter
    def strands(self, value: float | None) -> None:
        self._set('strands', value)

    @property
    def flyaways(self) -> float:
        """Share of strands that catch three times as much air. Number, 0 to 1; default: 0.02."""
        value: float = self._get('flyaways')
        return value

    @flyaways.setter
    def flyaways(self, value: float | None) -> None:
        self._set('flyaways', value)

    @property
    def size(self) -> float | None:
        """Width of a lock at the scalp. By default that of the groom's clumps, so that clumps are locks, or 1.2 cm for
        hair from a file. Number, 0.1 to 100 (cm); default: the groom's clumps.
        """
        value: float | None = self._get('size')
        return value

    @size.setter
    def size(self, value: float | None) -> None:
        self._set('size', value)

    @property
    def seed(self) -> int:
        """Random seed. Change it to make other locks catch the wind. Whole number; default: 0."""
        value: int = self._get('seed')
        return value

    @seed.setter
    def seed(self, value: int | None) -> None:
        self._set('seed', value)


class Region(Table):
    """Hair that moves differently from the rest, such as a fringe that stays in the wind.

    A strand belongs to the region by its group, by an attribute of the hair or of the head's mesh, by a painted map,
    by painted points, or if its root is near a point or line; with several of these, by all of them. Factors multiply
    the settings of the scene. Where a factor may be a list, it runs from root to tip. Where regions overlap, their
    factors multiply.
    """

    __slots__ = ()

    @property
    def name(self) -> str:
        """Name of the region, for `info`. Text; default: none."""
        value: str = self._get('name')
        return value

    @name.setter
    def name(self, value: str | None) -> None:
        self._set('name', value)

    @property
    def groups(self) -> tuple[str, ...]:
        """Groups of hair: only strands of these groups belong to it. Grown hair has the groups "top", "sides", "back"
        and "fringe"; hair from a file has those of the file. List of texts; default: none.
        """
        value: tuple[str, ...] = self._get('groups')
        return value

    @groups.setter
    def groups(self, value: Sequence[str] | None) -> None:
        self._set('groups', value)

    @property
    def attribute(self) -> str | None:
        """Attribute of the hair in its file, such as a painted weight: one number per strand or point, of which that of
        the root counts. It is how much the strand belongs to the region: 0 not at all, 1 fully. If the hair has none
        of this name, it is a weight or colour that is painted on the vertices of the head's mesh, where the strand
        grows. Of a colour the luminance counts, or one channel: "COLOR_0.g". Text; default: none.
        """
        value: str | None = self._get('attribute')
        return value

    @attribute.setter
    def attribute(self, value: str | None) -> None:
        self._set('attribute', value)

    @property
    def values(self) -> tuple[int, ...]:
        """Values of the attribute that belong to the region, such as the numbers of clumps, or of parts of the head's
        mesh. Without them, the attribute is a weight. List of whole numbers; default: none.
        """
        value: tuple[int, ...] = self._get('values')
        return value

    @values.setter
    def values(self, value: Sequence[int] | None) -> None:
        self._set('values', value)

    @property
    def map(self) -> str | None:
        """A picture over the head, PNG: white where hair belongs to it fully, black where it does not. Hair finds its
        place by its own root UVs, or else by the UVs of the head's mesh where it grows. Path; default: none.
        """
        value: str | None = self._get('map')
        return value

    @map.setter
    def map(self, value: File | None) -> None:
        self._set('map', value)

    @property
    def painted(self) -> tuple[tuple[float, float, float, float], ...]:
        """Painted points of the skin, as the studio's brush leaves them: x, y, z in the space of the head at rest (cm),
        and how much hair there belongs to the region, 0 to 1. A root takes the weights of the three points nearest to
        it, and belongs to the region only up to `within` from the nearest one, fading over `soft`. List of groups of
        4 numbers, each -1000 to 1000; default: none.
        """
        value: tuple[tuple[float, float, float, float], ...] = self._get('painted')
        return value

    @painted.setter
    def painted(self, value: Sequence[Numbers] | None) -> None:
        self._set('painted', value)

    @property
    def near(self) -> tuple[float, float, float] | None:
        """Where the region is, in the space of the head at rest. 3 numbers, each -1000 to 1000 (cm); default:
        everywhere.
        """
        value: tuple[float, float, float] | None = self._get('near')
        return value

    @near.setter
    def near(self, value: Numbers | None) -> None:
        self._set('near', value)

    @property
    def to(self) -> tuple[float, float, float] | None:
        """End of the line that the region lies along, such as the other end of a parting. 3 numbers, each -1000 to 1000
        (cm); default: a point, not a line.
        """
        value: tuple[float, float, float] | None = self._get('to')
        return value

    @to.setter
    def to(self, value: Numbers | None) -> None:
        self._set('to', value)

    @property
    def within(self) -> float:
        """Distance up to which roots belong to it fully. Number, 0 to 1000 (cm); default: 4."""
        value: float = self._get('within')
        return value

    @within.setter
    def within(self, value: float | None) -> None:
        self._set('within', value)

    @property
    def soft(self) -> float:
        """Width of its border. Across it, the factors fade to 1. Number, 0 to 1000 (cm); default: 2."""
        value: float = self._get('soft')
        return value

    @soft.setter
    def soft(self, value: float | None) -> None:
        self._set('soft', value)

    @property
    def stiffness(self) -> float | tuple[float, ...]:
        """Factor on `free.stiffness`. Number, 0 to 10, or list of numbers, each 0 to 10; default: 1."""
        value: float | tuple[float, ...] = self._get('stiffness')
        return value

    @stiffness.setter
    def stiffness(self, value: float | Numbers | None) -> None:
        self._set('stiffness', value)

    @property
    def hold(self) -> float | tuple[float, ...]:
        """Factor on `free.hold`. Number, 0 to 10, or list of numbers, each 0 to 10; default: 1."""
        value: float | tuple[float, ...] = self._get('hold')
        return value

    @hold.setter
    def hold(self, value: float | Numbers | None) -> None:
        self._set('hold', value)

    @property
    def settle(self) -> float | tuple[float, ...]:
        """Factor on `free.settle`: at 2, hair swings twice as long. Number, 0.01 to 10, or list of numbers, each 0.01 to
        10; default: 1.
        """
        value: float | tuple[float, ...] = self._get('settle')
        return value

    @settle.setter
    def settle(self, value: float | Numbers | None) -> None:
        self._set('settle', value)

    @property
    def wind(self) -> float:
        """Factor on the forces of all fields. At 0, no wind moves the hair. Number, 0 to 10; default: 1."""
        value: float = self._get('wind')
        return value

    @wind.setter
    def wind(self, value: float | None) -> None:
        self._set('wind', value)

    @property
    def fields(self) -> Tables[FieldShare]:
        """Factors on single fields, such as a fan that the fringe does not feel."""
        return Tables(self._scene, self._key_of('fields'), FieldShare)

    @fields.setter
    def fields(self, value: Iterable[FieldShare | Mapping[str, Any]] | None) -> None:
        self._set('fields', value)

    @property
    def gravity(self) -> float:
        """Factor on `free.gravity`, for each strand as a whole. Hair at rest does not sag, whatever its weight. Factors
        above 1 of all regions together may raise the number of steps per frame. Number, 0 to 10; default: 1.
        """
        value: float = self._get('gravity')
        return value

    @gravity.setter
    def gravity(self, value: float | None) -> None:
        self._set('gravity', value)

    @property
    def margin(self) -> float:
        """Factor on the distance that hair keeps from the head and from bodies, `contact.margin`. That distance times
        the factors above 1 of all regions, whether they overlap or not, is at most 5 cm. Number, 0 to 10; default: 1.
        """
        value: float = self._get('margin')
        return value

    @margin.setter
    def margin(self, value: float | None) -> None:
        self._set('margin', value)

    @property
    def drag(self) -> float | tuple[float, ...]:
        """Factor on `free.drag`. Number, 0 to 10, or list of numbers, each 0 to 10; default: 1."""
        value: float | tuple[float, ...] = self._get('drag')
        return value

    @drag.setter
    def drag(self, value: float | Numbers | None) -> None:
        self._set('drag', value)


class FieldShare(Table):
    """How strongly the hair of a region feels one field."""

    __slots__ = ()

    @property
    def field(self) -> str:
        """The field: `wind` for `[[force]]`, `[gust]`, `[body_wind]` and `[flow]` together, `turbulence`, or a table of
        which there may be several with its number, from 0, such as `fan[0]`. Text; must be given.
        """
        value: str = self._get('field')
        return value

    @field.setter
    def field(self, value: str | None) -> None:
        self._set('field', value)

    @property
    def share(self) -> float:
        """Factor on its force. At 0, the hair does not feel it. Number, 0 to 10; must be given."""
        value: float = self._get('share')
        return value

    @share.setter
    def share(self, value: float | None) -> None:
        self._set('share', value)


class Tie(Table):
    """A band that ties hair. A strand that passes the band at rest moves with the head up to it. Beyond the band it
    moves as if rooted there.

    Segments up to the node nearest to the band are held: their inverse mass is 0. Lengths, and lists from root to
    tip, count from there. A strand that passes with no node close enough is tied at the nearer node of that segment,
    but never at its root.
    """

    __slots__ = ()

    @property
    def at(self) -> tuple[float, float, float]:
        """Middle of the band in head space. 3 numbers (cm); must be given."""
        value: tuple[float, float, float] = self._get('at')
        return value

    @at.setter
    def at(self, value: Numbers | None) -> None:
        self._set('at', value)

    @property
    def within(self) -> float:
        """Largest distance from the band of the strands to tie. Number above 0 (cm); must be given."""
        value: float = self._get('within')
        return value

    @within.setter
    def within(self, value: float | None) -> None:
        self._set('within', value)


class Contact(Table):
    """How hair and a body touch in the free form."""

    __slots__ = ()

    @property
    def margin(self) -> float:
        """Distance that nodes keep from the skin. A node that is closer at rest keeps its rest distance. Number, 0 to 5
        (cm); default: 0.1.
        """
        value: float = self._get('margin')
        return value

    @margin.setter
    def margin(self, value: float | None) -> None:
        self._set('margin', value)

    @property
    def friction(self) -> float:
        """Friction of sliding hair: the share of the push that it loses as speed along the skin (Coulomb). Number, 0 to
        10; default: 0.1.
        """
        value: float = self._get('friction')
        return value

    @friction.setter
    def friction(self, value: float | None) -> None:
        self._set('friction', value)

    @property
    def static_friction(self) -> float:
        """Friction of hair that does not slide, at least `friction`. Hair starts to slide when the force along the skin
        exceeds this share of the push. Number, 0 to 10; default: 0.15.
        """
        value: float = self._get('static_friction')
        return value

    @static_friction.setter
    def static_friction(self, value: float | None) -> None:
        self._set('static_friction', value)


class NeighbourForces(Table):
    """Hair against hair. A few strands, the carriers, fill a grid as they move.

    Carriers write density and mean velocity to the grid. In the next frame all strands read them. A strand therefore
    depends only on itself and the carriers, and any subset of the hair moves as it does among all.
    """

    __slots__ = ()

    @property
    def carriers(self) -> int:
        """Number of carriers: the first strands of an even selection. Whole number, 1 to 4096 (strands); default: 256."""
        value: int = self._get('carriers')
        return value

    @carriers.setter
    def carriers(self, value: int | None) -> None:
        self._set('carriers', value)

    @property
    def pressure(self) -> float:
        """How firmly hair keeps its volume: it pushes hair out of places that are fuller than at rest. In the unit F,
        where the density falls by that of hair at rest over one cell. Number of at least 0; default: 40.
        """
        value: float = self._get('pressure')
        return value

    @pressure.setter
    def pressure(self, value: float | None) -> None:
        self._set('pressure', value)

    @property
    def cohesion(self) -> float:
        """How firmly strands drag their neighbours along: raise it if neighbours drift apart. It pulls a node toward the
        mean velocity around it, in the unit F per cm per frame. Number of at least 0; default: 40.
        """
        value: float = self._get('cohesion')
        return value

    @cohesion.setter
    def cohesion(self, value: float | None) -> None:
        self._set('cohesion', value)

    @property
    def cell(self) -> float:
        """Edge length of a grid cell. Number, 0.5 to 20 (cm); default: 2."""
        value: float = self._get('cell')
        return value

    @cell.setter
    def cell(self, value: float | None) -> None:
        self._set('cell', value)


class AimSettings(Table):
    """A shape that hair is led to in some frames, whatever the wind does: a pose of curves, a point, or the groom. Free
    form only.
    """

    __slots__ = ()

    @property
    def name(self) -> str:
        """Name of the aim, for `info`. Text; default: none."""
        value: str = self._get('name')
        return value

    @name.setter
    def name(self, value: str | None) -> None:
        self._set('name', value)

    @property
    def region(self) -> str | None:
        """Name of the region of `[[free.regions]]` that it leads. Where the region fades, so does the strength. Text;
        default: all hair.
        """
        value: str | None = self._get('region')
        return value

    @region.setter
    def region(self, value: str | None) -> None:
        self._set('region', value)

    @property
    def file(self) -> str:
        """A file with curves of the shape: .usd, .usda, .usdc, .abc, .nabiki, .hair, .tfx or .obj. A strand follows the
        directions of the curves that begin nearest to its root. Path; default: none.
        """
        value: str = self._get('file')
        return value

    @file.setter
    def file(self, value: File | None) -> None:
        self._set('file', value)

    @property
    def curves(self) -> tuple[tuple[tuple[float, float, float], ...], ...]:
        """Curves of the shape instead of a file, as the studio's comb leaves them: lists of points from root to tip, in
        head space (cm). List of lists of groups of 3 numbers, each -100000 to 100000; default: none.
        """
        value: tuple[tuple[tuple[float, float, float], ...], ...] = self._get('curves')
        return value

    @curves.setter
    def curves(self, value: Sequence[Sequence[Numbers]] | None) -> None:
        self._set('curves', value)

    @property
    def frame(self) -> int | None:
        """The frame of the scene in which the curves are posed, on the head as it is there. From a file that moves, this
        frame is used, counted from the file's first. Without it, the curves are posed on the head at rest. Whole
        number; default: at rest.
        """
        value: int | None = self._get('frame')
        return value

    @frame.setter
    def frame(self, value: int | None) -> None:
        self._set('frame', value)

    @property
    def toward(self) -> tuple[float, float, float] | None:
        """A point to lead hair to instead of a shape, in the space of the head at rest. 3 numbers, each -100000 to
        100000 (cm); default: a shape.
        """
        value: tuple[float, float, float] | None = self._get('toward')
        return value

    @toward.setter
    def toward(self, value: Numbers | None) -> None:
        self._set('toward', value)

    @property
    def groom(self) -> bool:
        """Whether to lead hair to its groom, the shape at rest. True or false; default: false."""
        value: bool = self._get('groom')
        return value

    @groom.setter
    def groom(self, value: bool | None) -> None:
        self._set('groom', value)

    @property
    def strength(self) -> float | str:
        """Strength of the pull. "3 g" pulls with three times the weight of the hair on earth; a number is in F. Against
        a force F, limp hair settles along F + S t, where t is the direction of the aim. Number, 0 to 1000000000, or
        "... g"; default: "3 g".
        """
        value: float | str = self._get('strength')
        return value

    @strength.setter
    def strength(self, value: float | str | None) -> None:
        self._set('strength', value)

    @property
    def from_(self) -> int:
        """First frame of the full strength. Whole number (frame); default: 0."""
        value: int = self._get('from')
        return value

    @from_.setter
    def from_(self, value: int | None) -> None:
        self._set('from', value)

    @property
    def through(self) -> int | None:
        """Last frame of the full strength. Without it, the aim never ends. Whole number (frame); default: the end."""
        value: int | None = self._get('through')
        return value

    @through.setter
    def through(self, value: int | None) -> None:
        self._set('through', value)

    @property
    def ease_in(self) -> int:
        """Number of frames before `from` in which the strength rises from 0. Whole number, 0 to 1000000 (frames);
        default: 12.
        """
        value: int = self._get('ease_in')
        return value

    @ease_in.setter
    def ease_in(self, value: int | None) -> None:
        self._set('ease_in', value)

    @property
    def ease_out(self) -> int:
        """Number of frames after `through` in which the strength falls to 0. Whole number, 0 to 1000000 (frames);
        default: 12.
        """
        value: int = self._get('ease_out')
        return value

    @ease_out.setter
    def ease_out(self, value: int | None) -> None:
        self._set('ease_out', value)


class PseudoForce(Table):
    """The pseudo-force: it weakens the wind in front of the head, in place of collisions. The defaults are Table 1 of
    the paper.
    """

    __slots__ = ()

    @property
    def alpha(self) -> float:
        """Cosine that bounds the domain Gamma: alpha of equation (4). 1 covers the whole shell, -1 only the line against
        the wind. Number, -1 to 1; default: -0.75.
        """
        value: float = self._get('alpha')
        return value

    @alpha.setter
    def alpha(self, value: float | None) -> None:
        self._set('alpha', value)

    @property
    def coefficients(self) -> tuple[float, ...]:
        """Factor eps_i on the wind for each segment, from the root on. The last one continues to the tip. If segments
        are not `hair.segment_length` long, i counts the distance along the strand in that length. List of numbers,
        each above 0, at most 1; default: [0.01, 0.01, 0.1, 0.1, 0.2, 0.2, 0.2, 0.2, 0.4, 0.4, 0.4, 0.4, 0.8, 0.8,
        0.8, 1].
        """
        value: tuple[float, ...] = self._get('coefficients')
        return value

    @coefficients.setter
    def coefficients(self, value: Numbers | None) -> None:
        self._set('coefficients', value)


class Disturbance(Table):
    """Turns each strand a little, at random and at regular intervals, in the paper's form.

    The paper gives neither size nor law. Here a strand gets one random turn of theta and one of phi, uniform within
    `amplitude` at the tip and falling to 0 at the root. It therefore stays a smooth curve. The speeds of the segments
    do not change. The random numbers depend only on seed, strand and frame.
    """

    __slots__ = ()

    @property
    def every(self) -> int:
        """Frames between two disturbances. The paper uses 10; a disturbance in each frame is too much. Whole number of
        at least 1 (frames); default: 10.
        """
        value: int = self._get('every')
        return value

    @every.setter
    def every(self, value: int | None) -> None:
        self._set('every', value)

    @property
    def from_(self) -> int:
        """First frame that may be disturbed. The paper disturbs the last 60 of 100 frames. Whole number (frame);
        default: 1.
        """
        value: int = self._get('from')
        return value

    @from_.setter
    def from_(self, value: int | None) -> None:
        self._set('from', value)

    @property
    def amplitude(self) -> float:
        """Largest turn at the tip. Number above 0, at most 3.141592653589793 (rad); default: 0.03."""
        value: float = self._get('amplitude')
        return value

    @amplitude.setter
    def amplitude(self, value: float | None) -> None:
        self._set('amplitude', value)

    @property
    def over(self) -> int:
        """Number of frames over which a disturbance builds up, at most `every`. At 1, as in the paper, it is a visible
        jump. More frames make it smooth, with the same end result. Whole number of at least 1 (frames); default: 1.
        """
        value: int = self._get('over')
        return value

    @over.setter
    def over(self, value: int | None) -> None:
        self._set('over', value)

    @property
    def seed(self) -> int:
        """Random seed of the turns. Whole number; default: 1."""
        value: int = self._get('seed')
        return value

    @seed.setter
    def seed(self, value: int | None) -> None:
        self._set('seed', value)
