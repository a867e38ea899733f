"""Every setting of a scene as an attribute. Written by generate.py from the doc comments of the Rust structs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, TypedDict

from .. import _nabiki
from ._table import Table, Tables
from .hair import Clumps, Comb, Curl, Cut, Fringe, HairSettings, Hairline, Length, Lift, Parting, Ponytail, Stiffness, Style, Variation, Volume
from .head import BodySettings, HeadSettings, MotionSource
from .motion import Contact, Disturbance, FreeSettings, Motion, NeighbourForces, PseudoForce, Tie
from .picture import Background, Camera, CameraKey, HairLook, HeadLook, Light, Output, Picture, Sky, Video
from .wind import BodyWind, EnvelopeKey, Falloff, Fan, Flow, Gust, Keyframe, Point, Turbulence, Vortex, Wind


class SceneTables(TypedDict, total=False):
    """What may be said of a scene that is put together, but for what the scene itself names."""

    picture: Picture | Mapping[str, Any] | None
    output: Output | Mapping[str, Any] | None
    force: Iterable[Keyframe | Mapping[str, Any]] | None
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
        """`[hair]`."""
        return HairSettings(self, 'hair')

    @hair.setter
    def hair(self, value: HairSettings | Mapping[str, Any] | None) -> None:
        self['hair'] = value

    @property
    def picture(self) -> Picture:
        """The scene's `[picture]` table."""
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
    def force(self) -> Tables[Keyframe]:
        """Vectors uniform in space, each over some frames: equation (5)."""
        return Tables(self, 'force', Keyframe)

    @force.setter
    def force(self, value: Iterable[Keyframe | Mapping[str, Any]] | None) -> None:
        self['force'] = value

    @property
    def wind(self) -> Wind:
        """How they follow one another."""
        return Wind(self, 'wind')

    @wind.setter
    def wind(self, value: Wind | Mapping[str, Any] | None) -> None:
        self['wind'] = value

    @property
    def gust(self) -> Gust:
        """A random factor on them. Not there unless it is given."""
        return Gust(self, 'gust')

    @gust.setter
    def gust(self, value: Gust | Mapping[str, Any] | None) -> None:
        self['gust'] = value

    @property
    def body_wind(self) -> BodyWind:
        """The wind that the head makes by moving. Not there unless it is given."""
        return BodyWind(self, 'body_wind')

    @body_wind.setter
    def body_wind(self, value: BodyWind | Mapping[str, Any] | None) -> None:
        self['body_wind'] = value

    @property
    def flow(self) -> Flow:
        """The way of the wind round the head. Not there unless it is given."""
        return Flow(self, 'flow')

    @flow.setter
    def flow(self, value: Flow | Mapping[str, Any] | None) -> None:
        self['flow'] = value

    @property
    def turbulence(self) -> Turbulence:
        """Random swirls. Not there unless it is given."""
        return Turbulence(self, 'turbulence')

    @turbulence.setter
    def turbulence(self, value: Turbulence | Mapping[str, Any] | None) -> None:
        self['turbulence'] = value

    @property
    def point(self) -> Tables[Point]:
        """Points that blow or draw."""
        return Tables(self, 'point', Point)

    @point.setter
    def point(self, value: Iterable[Point | Mapping[str, Any]] | None) -> None:
        self['point'] = value

    @property
    def vortex(self) -> Tables[Vortex]:
        """Whirls."""
        return Tables(self, 'vortex', Vortex)

    @vortex.setter
    def vortex(self, value: Iterable[Vortex | Mapping[str, Any]] | None) -> None:
        self['vortex'] = value

    @property
    def fan(self) -> Tables[Fan]:
        """Winds in a cone."""
        return Tables(self, 'fan', Fan)

    @fan.setter
    def fan(self, value: Iterable[Fan | Mapping[str, Any]] | None) -> None:
        self['fan'] = value

    @property
    def motion(self) -> Motion:
        """The settings of the motion; the default is Table 1 of the paper."""
        return Motion(self, 'motion')

    @motion.setter
    def motion(self, value: Motion | Mapping[str, Any] | None) -> None:
        self['motion'] = value

    @property
    def free(self) -> FreeSettings:
        """What holds hair in shape and calms it, in the free form."""
        return FreeSettings(self, 'free')

    @free.setter
    def free(self, value: FreeSettings | Mapping[str, Any] | None) -> None:
        self['free'] = value

    @property
    def contact(self) -> Contact:
        """How hair and head touch, in the free form."""
        return Contact(self, 'contact')

    @contact.setter
    def contact(self, value: Contact | Mapping[str, Any] | None) -> None:
        self['contact'] = value

    @property
    def neighbours(self) -> NeighbourForces:
        """Hair against hair, in the free form. Not there unless it is given."""
        return NeighbourForces(self, 'neighbours')

    @neighbours.setter
    def neighbours(self, value: NeighbourForces | Mapping[str, Any] | None) -> None:
        self['neighbours'] = value

    @property
    def pseudo_force(self) -> PseudoForce:
        """The settings of the pseudo-force; the default is Table 1 of the paper."""
        return PseudoForce(self, 'pseudo_force')

    @pseudo_force.setter
    def pseudo_force(self, value: PseudoForce | Mapping[str, Any] | None) -> None:
        self['pseudo_force'] = value

    @property
    def disturbance(self) -> Disturbance:
        """Turns every strand a little, at random, every so many frames.

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
        """`[head]`."""
        return HeadSettings(self, 'head')

    @head.setter
    def head(self, value: HeadSettings | Mapping[str, Any] | None) -> None:
        self['head'] = value

    @property
    def body(self) -> Tables[BodySettings]:
        """What else hair does not enter, in the free form."""
        return Tables(self, 'body', BodySettings)

    @body.setter
    def body(self, value: Iterable[BodySettings | Mapping[str, Any]] | None) -> None:
        self['body'] = value
