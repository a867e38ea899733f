"""How hair answers: `scene.motion`, `scene.free`, ... Written by generate.py from the schema of scenes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

from ._table import Arrays, File, Matrices, Numbers, Table, Tables

__all__ = [
    "Contact",
    "Disturbance",
    "FreeSettings",
    "LockVariation",
    "Motion",
    "NeighbourForces",
    "PseudoForce",
    "Tie",
]


class Motion(Table):
    """Length and pace of the motion, and the mass of hair. The defaults are Table 1 of the paper."""

    __slots__ = ()

    @property
    def form(self) -> Literal["paper", "free"]:
        """The equations that hair moves by. "paper" or "free"; default: "paper"."""
        value: Literal["paper", "free"] = self._get('form')
        return value

    @form.setter
    def form(self, value: Literal["paper", "free"] | None) -> None:
        self._set('form', value)

    @property
    def frames(self) -> int:
        """Frames after the rest frame 0 (N_f). Whole number, 1 to 10000000; default: 100."""
        value: int = self._get('frames')
        return value

    @frames.setter
    def frames(self, value: int | None) -> None:
        self._set('frames', value)

    @property
    def frame_rate(self) -> float:
        """Frames in a second: how fast they are shown, and where a recorded head is in each. Hair moves by frames: of
        its settings only those in units of the world depend on this. Number above 0 (a second); default: 24.
        """
        value: float = self._get('frame_rate')
        return value

    @frame_rate.setter
    def frame_rate(self, value: float | None) -> None:
        self._set('frame_rate', value)

    @property
    def time_step(self) -> float:
        """Delta t of equation (7), in a unit of the step's own: a frame is one step. Number above 0; default: 0.1."""
        value: float = self._get('time_step')
        return value

    @time_step.setter
    def time_step(self, value: float | None) -> None:
        self._set('time_step', value)

    @property
    def slow(self) -> float:
        """Slow motion of the hair: 4 is hair filmed at four times the frame rate. The head and the fields keep their
        pace. Number, 0.1 to 100 (times); default: 1.
        """
        value: float = self._get('slow')
        return value

    @slow.setter
    def slow(self, value: float | None) -> None:
        self._set('slow', value)

    @property
    def linear_density(self) -> float:
        """lambda of equation (6): the mass of a centimetre of hair, in the units of the force. Number above 0 (per cm);
        default: 0.05.
        """
        value: float = self._get('linear_density')
        return value

    @linear_density.setter
    def linear_density(self, value: float | None) -> None:
        self._set('linear_density', value)

    @property
    def inertia_length_floor(self) -> float:
        """Hair shorter than this has the inertia of hair this long: its longer neighbours hold it. 0, the paper's way,
        gives every strand the inertia of its own length, and short hair very fast swings. Number of at least 0 (cm);
        default: 0.
        """
        value: float = self._get('inertia_length_floor')
        return value

    @inertia_length_floor.setter
    def inertia_length_floor(self, value: float | None) -> None:
        self._set('inertia_length_floor', value)

    @property
    def straighten(self) -> float:
        """Segments that hang within this of the vertical at rest are made to hang exactly so, and are then free to swing
        in the plane of any force (section 4.2). A segment nearly vertical is not: it keeps the plane of its small
        lean, and hair that leans this way and that is blown apart. 0, the paper's way, leaves the hair as it is.
        Number, 0 to 45 (degrees); default: 0.
        """
        value: float = self._get('straighten')
        return value

    @straighten.setter
    def straighten(self, value: float | None) -> None:
        self._set('straighten', value)

    @property
    def force_space(self) -> Literal["world", "head"]:
        """Space of the forces; it matters where the head turns. "world" or "head"; default: "world"."""
        value: Literal["world", "head"] = self._get('force_space')
        return value

    @force_space.setter
    def force_space(self, value: Literal["world", "head"] | None) -> None:
        self._set('force_space', value)


class FreeSettings(Table):
    """How hair keeps its shape and settles, in the free form. Strengths are in the unit of the force F, or in one of the
    world.
    """

    __slots__ = ()

    @property
    def stiffness(self) -> float | str | tuple[float | str, ...]:
        """How firmly hair keeps its shape: at 36 times the wind, hair of 18 cm bends within about 6 cm. "4.5 cm" is hair
        that bends under its own `gravity` within that length, as real hair does. One, or a list from root to tip. K
        of docs/motion-forms.md: EI = 3/8 A L K d^2, with d `hair.segment_length`. Hair bends alike however finely it
        is cut. Number, 0 to 1000000000, or "... cm", or a list of them; default: [12000, 1000].
        """
        value: float | str | tuple[float | str, ...] = self._get('stiffness')
        return value

    @stiffness.setter
    def stiffness(self, value: float | str | Numbers | Sequence[float | str] | None) -> None:
        self._set('stiffness', value)

    @property
    def hold(self) -> float | str | tuple[float | str, ...]:
        """How firmly hair keeps its place on the head, as with hair spray. "0.3 g" pulls with so much of its weight on
        the earth. One number, or a list from root to tip. H: turns segments toward their rest direction on the head.
        Against a force F, limp hair settles along F + H r. Number, 0 to 1000000000, or "... g", or a list of them;
        default: 30.
        """
        value: float | str | tuple[float | str, ...] = self._get('hold')
        return value

    @hold.setter
    def hold(self, value: float | str | Numbers | Sequence[float | str] | None) -> None:
        self._set('hold', value)

    @property
    def settle(self) -> float | str | tuple[float | str, ...]:
        """Frames in which a swing falls to 1/e: 7 is wet hair, 20 swings over once, 60 goes on waving, 0 has no air.
        "0.8 s" are as many as pass in it. One number, or a list from root to tip, interpolated in frames: next to a 0
        hair hardly swings. Number of at least 0 or "... s" or a list of them (frames); default: 20.
        """
        value: float | str | tuple[float | str, ...] = self._get('settle')
        return value

    @settle.setter
    def settle(self, value: float | str | Numbers | Sequence[float | str] | None) -> None:
        self._set('settle', value)

    @property
    def gravity(self) -> float | str:
        """How fast moved hair falls. A strength, or "1 g" for that of the earth, 981 cm/s^2 at `motion.frame_rate`;
        "earth" is the same. Hair at rest does not sag. Number, 0 to 1000000000, or "... g" or "earth"; default: 100.
        """
        value: float | str = self._get('gravity')
        return value

    @gravity.setter
    def gravity(self, value: float | str | None) -> None:
        self._set('gravity', value)

    @property
    def drag(self) -> float | tuple[float, ...]:
        """How far a head that moves leaves hair behind: 0 rides along, 1 is as in life, more exaggerates. One number, or
        a list from root to tip. It weighs the head's turn, its acceleration and the pull of the still air. Number, 0
        to 10, or list of numbers, each 0 to 10; default: 1.
        """
        value: float | tuple[float, ...] = self._get('drag')
        return value

    @drag.setter
    def drag(self, value: float | Numbers | None) -> None:
        self._set('drag', value)

    @property
    def pseudo_force(self) -> bool:
        """Whether `[pseudo_force]` weakens the field before the head, as in the paper's form. True or false; default:
        false.
        """
        value: bool = self._get('pseudo_force')
        return value

    @pseudo_force.setter
    def pseudo_force(self, value: bool | None) -> None:
        self._set('pseudo_force', value)

    @property
    def variation(self) -> LockVariation:
        """How locks differ, so that they part in the wind."""
        return LockVariation(self._scene, self._key_of('variation'))

    @variation.setter
    def variation(self, value: LockVariation | Mapping[str, Any] | None) -> None:
        self._set('variation', value)

    @property
    def tie(self) -> Tie:
        """A band that ties hair: strands that pass it at rest are held from the root to the band."""
        return Tie(self._scene, self._key_of('tie'))

    @tie.setter
    def tie(self, value: Tie | Mapping[str, Any] | None) -> None:
        self._set('tie', value)

    @property
    def substeps(self) -> int | None:
        """Steps that a frame is divided into. Left open, a scene takes as many as weight and stiffness need, and at
        least 2. Whole number, 1 to 32; default: by weight and stiffness.
        """
        value: int | None = self._get('substeps')
        return value

    @substeps.setter
    def substeps(self, value: int | None) -> None:
        self._set('substeps', value)


class LockVariation(Table):
    """How locks differ, so that they part in the wind instead of moving as one.

    A lock is the hair of a clump, as the groom has them, and keeps its ways in every take: they are drawn from its
    place on the head and the seed. Hair that takes n times the air is pushed n times as hard by the wind, and settles
    n times as fast.
    """

    __slots__ = ()

    @property
    def air(self) -> float:
        """How much the air that a lock takes differs from lock to lock: the standard deviation of its logarithm. 0.35
        lets a sixth of the locks take 1.4 times the air, or more, and a sixth 0.7 times, or less. Number, 0 to 1;
        default: 0.35.
        """
        value: float = self._get('air')
        return value

    @air.setter
    def air(self, value: float | None) -> None:
        self._set('air', value)

    @property
    def flutter(self) -> float:
        """How much the wind on a lock swells and turns by itself, in strength and in radians (both root mean square), in
        a rhythm of the lock's own. This is what parts locks in an even wind. Number, 0 to 0.5; default: 0.3.
        """
        value: float = self._get('flutter')
        return value

    @flutter.setter
    def flutter(self, value: float | None) -> None:
        self._set('flutter', value)

    @property
    def flutter_frames(self) -> float:
        """Frames in which it does so once, about. Number, 2 to 10000 (frames); default: 24."""
        value: float = self._get('flutter_frames')
        return value

    @flutter_frames.setter
    def flutter_frames(self, value: float | None) -> None:
        self._set('flutter_frames', value)

    @property
    def stiffness(self) -> float:
        """How much stiffness differs from lock to lock: the standard deviation of its logarithm. Number, 0 to 1;
        default: 0.2.
        """
        value: float = self._get('stiffness')
        return value

    @stiffness.setter
    def stiffness(self, value: float | None) -> None:
        self._set('stiffness', value)

    @property
    def strands(self) -> float:
        """How much the strands of a lock differ among themselves, as a part of how locks differ. What is much frays
        locks to frizz. Number, 0 to 1; default: 0.2.
        """
        value: float = self._get('strands')
        return value

    @strands.setter
    def strands(self, value: float | None) -> None:
        self._set('strands', value)

    @property
    def flyaways(self) -> float:
        """Share of strands that take three times the air. Number, 0 to 1; default: 0.02."""
        value: float = self._get('flyaways')
        return value

    @flyaways.setter
    def flyaways(self, value: float | None) -> None:
        self._set('flyaways', value)

    @property
    def size(self) -> float | None:
        """Width of a lock at the scalp. Left open, that of the groom's clumps, so that clumps are locks; 1.2 cm for hair
        of a file. Number, 0.1 to 100 (cm); default: the groom's clumps.
        """
        value: float | None = self._get('size')
        return value

    @size.setter
    def size(self, value: float | None) -> None:
        self._set('size', value)

    @property
    def seed(self) -> int:
        """Another number, other locks that catch the wind. Whole number; default: 0."""
        value: int = self._get('seed')
        return value

    @seed.setter
    def seed(self, value: int | None) -> None:
        self._set('seed', value)


class Tie(Table):
    """A band that ties hair. A strand that passes it at rest goes with the head up to the band, and moves beyond it as
    if it were rooted there.

    Segments up to the node nearest to the band are held: their inverse mass is 0. Lengths and lists from root to tip
    count from there. A strand that passes between two nodes, neither near enough, is tied at the nearer one, but
    never at its root.
    """

    __slots__ = ()

    @property
    def at(self) -> tuple[float, float, float]:
        """Middle of the band, in head space. 3 numbers (cm); must be given."""
        value: tuple[float, float, float] = self._get('at')
        return value

    @at.setter
    def at(self, value: Numbers | None) -> None:
        self._set('at', value)

    @property
    def within(self) -> float:
        """Strands that pass this near are tied. Number above 0 (cm); must be given."""
        value: float = self._get('within')
        return value

    @within.setter
    def within(self, value: float | None) -> None:
        self._set('within', value)


class Contact(Table):
    """How hair and a body touch, in the free form."""

    __slots__ = ()

    @property
    def margin(self) -> float:
        """How far from the skin nodes are kept. A node that lies closer at rest is kept where it lies. Number, 0 to 5
        (cm); default: 0.1.
        """
        value: float = self._get('margin')
        return value

    @margin.setter
    def margin(self, value: float | None) -> None:
        self._set('margin', value)

    @property
    def friction(self) -> float:
        """The part of a push that sliding hair loses of its speed along the skin (Coulomb). Number, 0 to 10; default:
        0.1.
        """
        value: float = self._get('friction')
        return value

    @friction.setter
    def friction(self, value: float | None) -> None:
        self._set('friction', value)

    @property
    def static_friction(self) -> float:
        """The same for hair that does not slide, at least `friction`: it stays as long as what would move it is below
        this part of the push. Number, 0 to 10; default: 0.15.
        """
        value: float = self._get('static_friction')
        return value

    @static_friction.setter
    def static_friction(self, value: float | None) -> None:
        self._set('static_friction', value)


class NeighbourForces(Table):
    """Hair against hair, through a grid that a few strands, the carriers, fill as they move.

    Carriers write density and mean velocity; in the next frame every strand, carriers too, reads them. So a strand
    depends on itself and the carriers only, and any subset of the hair moves as within the whole.
    """

    __slots__ = ()

    @property
    def carriers(self) -> int:
        """Number of carriers: the first strands of the farthest-first order. Whole number, 1 to 4096 (strands); default:
        256.
        """
        value: int = self._get('carriers')
        return value

    @carriers.setter
    def carriers(self, value: int | None) -> None:
        self._set('carriers', value)

    @property
    def pressure(self) -> float:
        """How firmly hair keeps its volume: pushes it out of places fuller than at rest. In the unit of F where the
        density falls by that of the hair at rest over one cell. Number of at least 0; default: 40.
        """
        value: float = self._get('pressure')
        return value

    @pressure.setter
    def pressure(self, value: float | None) -> None:
        self._set('pressure', value)

    @property
    def cohesion(self) -> float:
        """How firmly strands drag their neighbours along: pulls a node toward the mean velocity about it, in the unit of
        F for each cm a frame. Number of at least 0; default: 40.
        """
        value: float = self._get('cohesion')
        return value

    @cohesion.setter
    def cohesion(self, value: float | None) -> None:
        self._set('cohesion', value)

    @property
    def cell(self) -> float:
        """Edge of a cell of the grid. Number, 0.5 to 20 (cm); default: 2."""
        value: float = self._get('cell')
        return value

    @cell.setter
    def cell(self, value: float | None) -> None:
        self._set('cell', value)


class PseudoForce(Table):
    """The pseudo-force: it weakens the wind before the head, the paper's stand-in for collisions. The default is Table 1
    of the paper.
    """

    __slots__ = ()

    @property
    def alpha(self) -> float:
        """alpha of equation (4), the cosine that bounds Gamma: at 1 all of the shell, at -1 only the line against the
        wind. Number, -1 to 1; default: -0.75.
        """
        value: float = self._get('alpha')
        return value

    @alpha.setter
    def alpha(self, value: float | None) -> None:
        self._set('alpha', value)

    @property
    def coefficients(self) -> tuple[float, ...]:
        """eps_i for the segments i = 1, 2, ... from the root on; the last one goes on to the tip. Where segments are not
        `hair.segment_length` long, i is the distance along the strand counted in it. List of numbers, each above 0,
        at most 1; default: [0.01, 0.01, 0.1, 0.1, 0.2, 0.2, 0.2, 0.2, 0.4, 0.4, 0.4, 0.4, 0.8, 0.8, 0.8, 1].
        """
        value: tuple[float, ...] = self._get('coefficients')
        return value

    @coefficients.setter
    def coefficients(self, value: Numbers | None) -> None:
        self._set('coefficients', value)


class Disturbance(Table):
    """Turns every strand a little, at random, every so many frames, in the paper's form.

    The paper names neither its size nor its law. Here a strand is given one random turn of theta and one of phi,
    uniform within `amplitude` at the tip and falling to nothing at the root, so that it stays a smooth curve; the
    segments' speeds are left alone. The numbers depend on seed, strand and frame only.
    """

    __slots__ = ()

    @property
    def every(self) -> int:
        """Frames from one disturbance to the next. The paper has 10; every frame would be too much. Whole number of at
        least 1 (frames); default: 10.
        """
        value: int = self._get('every')
        return value

    @every.setter
    def every(self, value: int | None) -> None:
        self._set('every', value)

    @property
    def from_(self) -> int:
        """First frame that may be disturbed. The paper disturbs the last 60 of 100. Whole number (frame); default: 1."""
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
        """Frames in which a disturbance sets in, at most `every`. At 1, the paper's way, it is there at once, and seen
        as a jump; over more frames it comes and stays smoothly, and is the same in the end. Whole number of at least
        1 (frames); default: 1.
        """
        value: int = self._get('over')
        return value

    @over.setter
    def over(self, value: int | None) -> None:
        self._set('over', value)

    @property
    def seed(self) -> int:
        """Seed of the random numbers: another number, other turns. Whole number; default: 1."""
        value: int = self._get('seed')
        return value

    @seed.setter
    def seed(self, value: int | None) -> None:
        self._set('seed', value)
