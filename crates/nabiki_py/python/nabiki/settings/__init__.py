"""Every setting of a scene as an attribute. Written by generate.py from the schema of scenes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, TypedDict

from .. import _nabiki
from ._table import Table, Tables
from .hair import Clumps, Comb, Curl, Cut, Fringe, HairSettings, Hairline, Length, Lift, Parting, Ponytail, Stiffness, Style, Variation, Volume
from .head import BodySettings, HeadSettings, MotionSource
from .motion import Contact, Disturbance, FreeSettings, LockVariation, Motion, NeighbourForces, PseudoForce, Tie
from .picture import Background, Camera, CameraKey, HairLook, HeadLook, Light, Output, Picture, Sky, Video
from .wind import BodyWind, EnvelopeKey, Falloff, Fan, Flow, ForceSettings, Gust, Point, Turbulence, Vortex, Wind


class SceneTables(TypedDict, total=False):
    """What may be said of a scene that is put together, but for what the scene itself names."""

    picture: Picture | Mapping[str, Any] | None
    output: Output | Mapping[str, Any] | None
    force: Iterable[ForceSettings | Mapping[str, Any]] | None
    wind: Wind | Mapping[str, Any] | None
    gust: Gust | Mapping[str, Any] | None
    body_wind: BodyWind | Mapping[str, Any] | None
    flow: Flow | Mapping[str, Any] | None
    turbulence: Turbulence | Mapping[str, Any] | None
    point: Iterable[Point | Mapping[str, Any]] | None
    vortex: Iterable[Vortex | Mapping[str, Any]] | None
    fan: Iterable[Fan | Mapping[str, Any]] | None
    motion: Motion | Mapping[str, Any] | None
    free: FreeSettings | Mapping[str, Any] | None
    contact: Contact | Mapping[str, Any] | None
    neighbours: NeighbourForces | Mapping[str, Any] | None
    pseudo_force: PseudoForce | Mapping[str, Any] | None
    disturbance: Disturbance | Mapping[str, Any] | None
    body: Iterable[BodySettings | Mapping[str, Any]] | None


class SceneSettings(_nabiki.Scene):
    """The tables of a scene by the names that they have in a file."""

    __slots__ = ()

    @property
    def hair(self) -> HairSettings:
        """The hair at rest: grown from the scalp, or, where `file` is given, read from a file."""
        return HairSettings(self, 'hair')

    @hair.setter
    def hair(self, value: HairSettings | Mapping[str, Any] | None) -> None:
        self['hair'] = value

    @property
    def picture(self) -> Picture:
        """What is drawn, and how."""
        return Picture(self, 'picture')

    @picture.setter
    def picture(self, value: Picture | Mapping[str, Any] | None) -> None:
        self['picture'] = value

    @property
    def output(self) -> Output:
        """What a run writes. Where it goes is the command line's affair."""
        return Output(self, 'output')

    @output.setter
    def output(self, value: Output | Mapping[str, Any] | None) -> None:
        self['output'] = value

    @property
    def force(self) -> Tables[ForceSettings]:
        """One interval of the wind: `vector` drives every frame after the interval before it, up to `through`."""
        return Tables(self, 'force', ForceSettings)

    @force.setter
    def force(self, value: Iterable[ForceSettings | Mapping[str, Any]] | None) -> None:
        self['force'] = value

    @property
    def wind(self) -> Wind:
        """How the vectors of the intervals follow one another."""
        return Wind(self, 'wind')

    @wind.setter
    def wind(self, value: Wind | Mapping[str, Any] | None) -> None:
        self['wind'] = value

    @property
    def gust(self) -> Gust:
        """Gusts: a random factor about 1 on the wind of the intervals, which rises and falls as wind does.

        It has the spectrum of the wind's own direction after T. von Karman ("Progress in the statistical theory of
        turbulence", PNAS 34, 1948) as engineers write it, `S(f) = 4 T / (1 + 70.8 (f T)^2)^(5/6)`, up to a highest
        frequency: what is faster is not felt by the whole head of hair at once, and is turbulence. Not there unless
        it is given.
        """
        return Gust(self, 'gust')

    @gust.setter
    def gust(self, value: Gust | Mapping[str, Any] | None) -> None:
        self['gust'] = value

    @property
    def body_wind(self) -> BodyWind:
        """The wind from the head's own motion, uniform in space; it needs a motion of the head.

        With the head's velocity v (cm/s) and acceleration a (cm/s^2), from the poses and the frame rate: F = -drag v
        - footfall (0, a_y, 0). Not there unless it is given.
        """
        return BodyWind(self, 'body_wind')

    @body_wind.setter
    def body_wind(self, value: BodyWind | Mapping[str, Any] | None) -> None:
        self['body_wind'] = value

    @property
    def flow(self) -> Flow:
        """The way of the wind round the head, instead of through it. Not there unless it is given."""
        return Flow(self, 'flow')

    @flow.setter
    def flow(self, value: Flow | Mapping[str, Any] | None) -> None:
        self['flow'] = value

    @property
    def turbulence(self) -> Turbulence:
        """Turbulence: a random force without sources, which drifts with the wind and changes on its way.

        It is the curl of a random vector potential, a sum of octaves each half as large as the one before. Near the
        head the potential is let go to 0 by Bridson's ramp, so that the force runs along the head. Not there unless
        it is given.
        """
        return Turbulence(self, 'turbulence')

    @turbulence.setter
    def turbulence(self, value: Turbulence | Mapping[str, Any] | None) -> None:
        self['turbulence'] = value

    @property
    def point(self) -> Tables[Point]:
        """A point that blows or draws."""
        return Tables(self, 'point', Point)

    @point.setter
    def point(self, value: Iterable[Point | Mapping[str, Any]] | None) -> None:
        self['point'] = value

    @property
    def vortex(self) -> Tables[Vortex]:
        """A whirl: a force round an axis."""
        return Tables(self, 'vortex', Vortex)

    @vortex.setter
    def vortex(self, value: Iterable[Vortex | Mapping[str, Any]] | None) -> None:
        self['vortex'] = value

    @property
    def fan(self) -> Tables[Fan]:
        """A wind in a cone."""
        return Tables(self, 'fan', Fan)

    @fan.setter
    def fan(self, value: Iterable[Fan | Mapping[str, Any]] | None) -> None:
        self['fan'] = value

    @property
    def motion(self) -> Motion:
        """Length and pace of the motion, and the mass of hair. The defaults are Table 1 of the paper."""
        return Motion(self, 'motion')

    @motion.setter
    def motion(self, value: Motion | Mapping[str, Any] | None) -> None:
        self['motion'] = value

    @property
    def free(self) -> FreeSettings:
        """How hair keeps its shape and settles, in the free form. Strengths are in the unit of the force F, or in one of
        the world.
        """
        return FreeSettings(self, 'free')

    @free.setter
    def free(self, value: FreeSettings | Mapping[str, Any] | None) -> None:
        self['free'] = value

    @property
    def contact(self) -> Contact:
        """How hair and a body touch, in the free form."""
        return Contact(self, 'contact')

    @contact.setter
    def contact(self, value: Contact | Mapping[str, Any] | None) -> None:
        self['contact'] = value

    @property
    def neighbours(self) -> NeighbourForces:
        """Hair against hair, through a grid that a few strands, the carriers, fill as they move.

        Carriers write density and mean velocity; in the next frame every strand, carriers too, reads them. So a
        strand depends on itself and the carriers only, and any subset of the hair moves as within the whole. Not
        there unless it is given.
        """
        return NeighbourForces(self, 'neighbours')

    @neighbours.setter
    def neighbours(self, value: NeighbourForces | Mapping[str, Any] | None) -> None:
        self['neighbours'] = value

    @property
    def pseudo_force(self) -> PseudoForce:
        """The pseudo-force: it weakens the wind before the head, the paper's stand-in for collisions. The default is
        Table 1 of the paper.
        """
        return PseudoForce(self, 'pseudo_force')

    @pseudo_force.setter
    def pseudo_force(self, value: PseudoForce | Mapping[str, Any] | None) -> None:
        self['pseudo_force'] = value

    @property
    def disturbance(self) -> Disturbance:
        """Turns every strand a little, at random, every so many frames, in the paper's form.

        The paper names neither its size nor its law. Here a strand is given one random turn of theta and one of phi,
        uniform within `amplitude` at the tip and falling to nothing at the root, so that it stays a smooth curve; the
        segments' speeds are left alone. The numbers depend on seed, strand and frame only. Not there unless it is
        given.
        """
        return Disturbance(self, 'disturbance')

    @disturbance.setter
    def disturbance(self, value: Disturbance | Mapping[str, Any] | None) -> None:
        self['disturbance'] = value

    @property
    def head(self) -> HeadSettings:
        """The head that hair grows on: the built-in bust, or one out of a file."""
        return HeadSettings(self, 'head')

    @head.setter
    def head(self, value: HeadSettings | Mapping[str, Any] | None) -> None:
        self['head'] = value

    @property
    def body(self) -> Tables[BodySettings]:
        """Something besides the head that hair does not enter, in the free form."""
        return Tables(self, 'body', BodySettings)

    @body.setter
    def body(self, value: Iterable[BodySettings | Mapping[str, Any]] | None) -> None:
        self['body'] = value
