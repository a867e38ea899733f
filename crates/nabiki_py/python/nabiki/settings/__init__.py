"""Every setting of a scene as an attribute. Written by generate.py from the schema of scenes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, TypedDict

from .. import _nabiki
from ._table import Table, Tables
from .hair import Clumps, Comb, Curl, Cut, Fringe, HairSettings, Hairline, Length, Lift, Parting, Ponytail, Stiffness, Style, Variation, Volume
from .head import BodySettings, CapsuleSettings, HeadSettings, MotionSource
from .motion import AimSettings, Contact, Disturbance, FieldShare, FreeSettings, LockVariation, Motion, NeighbourForces, PseudoForce, Region, Tie
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
    aim: Iterable[AimSettings | Mapping[str, Any]] | None
    pseudo_force: PseudoForce | Mapping[str, Any] | None
    disturbance: Disturbance | Mapping[str, Any] | None
    body: Iterable[BodySettings | Mapping[str, Any]] | None


class SceneSettings(_nabiki.Scene):
    """The tables of a scene by the names that they have in a file."""

    __slots__ = ()

    @property
    def hair(self) -> HairSettings:
        """The hair at rest. It grows from the scalp, or comes from a file if you give `file`."""
        return HairSettings(self, 'hair')

    @hair.setter
    def hair(self, value: HairSettings | Mapping[str, Any] | None) -> None:
        self['hair'] = value

    @property
    def picture(self) -> Picture:
        """How pictures are drawn."""
        return Picture(self, 'picture')

    @picture.setter
    def picture(self, value: Picture | Mapping[str, Any] | None) -> None:
        self['picture'] = value

    @property
    def output(self) -> Output:
        """What a run writes. The command line sets the folder."""
        return Output(self, 'output')

    @output.setter
    def output(self, value: Output | Mapping[str, Any] | None) -> None:
        self['output'] = value

    @property
    def force(self) -> Tables[ForceSettings]:
        """One interval of the wind. `vector` applies in each frame after the previous interval, up to and including
        `through`.
        """
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
        """Gusts: a random factor around 1 on the wind of the intervals, which rises and falls like natural wind.

        It has the spectrum of wind along its direction by T. von Karman ("Progress in the statistical theory of
        turbulence", PNAS 34, 1948) as engineers write it, `S(f) = 4 T / (1 + 70.8 (f T)^2)^(5/6)`, up to a highest
        frequency. Faster changes do not reach all the hair at once; use turbulence for them. Off unless the scene has
        this table.
        """
        return Gust(self, 'gust')

    @gust.setter
    def gust(self, value: Gust | Mapping[str, Any] | None) -> None:
        self['gust'] = value

    @property
    def body_wind(self) -> BodyWind:
        """The wind caused by the motion of the head, the same everywhere. It needs `[head.motion]`.

        With the head's velocity v (cm/s) and acceleration a (cm/s^2), from its poses and the frame rate: F = -drag v
        - footfall (0, a_y, 0). Off unless the scene has this table.
        """
        return BodyWind(self, 'body_wind')

    @body_wind.setter
    def body_wind(self, value: BodyWind | Mapping[str, Any] | None) -> None:
        self['body_wind'] = value

    @property
    def flow(self) -> Flow:
        """Leads the wind around the head instead of through it. Off unless the scene has this table."""
        return Flow(self, 'flow')

    @flow.setter
    def flow(self, value: Flow | Mapping[str, Any] | None) -> None:
        self['flow'] = value

    @property
    def turbulence(self) -> Turbulence:
        """Turbulence: a random force of swirls that drift with the wind and change on the way.

        It is the curl of a random vector potential, a sum of octaves that each have half the size of the one before.
        Near the head, Bridson's ramp reduces the potential to 0, so the force runs along the head. Off unless the
        scene has this table.
        """
        return Turbulence(self, 'turbulence')

    @turbulence.setter
    def turbulence(self, value: Turbulence | Mapping[str, Any] | None) -> None:
        self['turbulence'] = value

    @property
    def point(self) -> Tables[Point]:
        """A point that pushes or pulls."""
        return Tables(self, 'point', Point)

    @point.setter
    def point(self, value: Iterable[Point | Mapping[str, Any]] | None) -> None:
        self['point'] = value

    @property
    def vortex(self) -> Tables[Vortex]:
        """A vortex: a force around an axis."""
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
        """How hair keeps its shape and settles in the free form. Strengths are in F, the unit of the wind, or in world
        units.
        """
        return FreeSettings(self, 'free')

    @free.setter
    def free(self, value: FreeSettings | Mapping[str, Any] | None) -> None:
        self['free'] = value

    @property
    def contact(self) -> Contact:
        """How hair and a body touch in the free form."""
        return Contact(self, 'contact')

    @contact.setter
    def contact(self, value: Contact | Mapping[str, Any] | None) -> None:
        self['contact'] = value

    @property
    def neighbours(self) -> NeighbourForces:
        """Hair against hair. A few strands, the carriers, fill a grid as they move.

        Carriers write density and mean velocity to the grid. In the next frame all strands read them. A strand
        therefore depends only on itself and the carriers, and any subset of the hair moves as it does among all. Off
        unless the scene has this table.
        """
        return NeighbourForces(self, 'neighbours')

    @neighbours.setter
    def neighbours(self, value: NeighbourForces | Mapping[str, Any] | None) -> None:
        self['neighbours'] = value

    @property
    def aim(self) -> Tables[AimSettings]:
        """A shape that hair is led to in some frames, whatever the wind does: a pose of curves, a point, or the groom.
        Free form only.
        """
        return Tables(self, 'aim', AimSettings)

    @aim.setter
    def aim(self, value: Iterable[AimSettings | Mapping[str, Any]] | None) -> None:
        self['aim'] = value

    @property
    def pseudo_force(self) -> PseudoForce:
        """The pseudo-force: it weakens the wind in front of the head, in place of collisions. The defaults are Table 1
        of the paper.
        """
        return PseudoForce(self, 'pseudo_force')

    @pseudo_force.setter
    def pseudo_force(self, value: PseudoForce | Mapping[str, Any] | None) -> None:
        self['pseudo_force'] = value

    @property
    def disturbance(self) -> Disturbance:
        """Turns each strand a little, at random and at regular intervals, in the paper's form.

        The paper gives neither size nor law. Here a strand gets one random turn of theta and one of phi, uniform
        within `amplitude` at the tip and falling to 0 at the root. It therefore stays a smooth curve. The speeds of
        the segments do not change. The random numbers depend only on seed, strand and frame. Off unless the scene has
        this table.
        """
        return Disturbance(self, 'disturbance')

    @disturbance.setter
    def disturbance(self, value: Disturbance | Mapping[str, Any] | None) -> None:
        self['disturbance'] = value

    @property
    def head(self) -> HeadSettings:
        """The head that hair grows on: the built-in bust, or a mesh from a file."""
        return HeadSettings(self, 'head')

    @head.setter
    def head(self, value: HeadSettings | Mapping[str, Any] | None) -> None:
        self['head'] = value

    @property
    def body(self) -> Tables[BodySettings]:
        """An object besides the head that hair keeps out of in the free form."""
        return Tables(self, 'body', BodySettings)

    @body.setter
    def body(self, value: Iterable[BodySettings | Mapping[str, Any]] | None) -> None:
        self['body'] = value
