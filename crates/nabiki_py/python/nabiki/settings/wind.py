"""What pushes the hair: `scene.wind`, `scene.gust`, `scene.fan`, ... Written by generate.py from the schema of scenes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

from ._table import Arrays, File, Matrices, Numbers, Table, Tables

__all__ = [
    "BodyWind",
    "EnvelopeKey",
    "Falloff",
    "Fan",
    "Flow",
    "ForceSettings",
    "Gust",
    "Point",
    "Turbulence",
    "Vortex",
    "Wind",
]


class ForceSettings(Table):
    """One interval of the wind. `vector` applies in each frame after the previous interval, up to and including
    `through`.
    """

    __slots__ = ()

    @property
    def through(self) -> int:
        """Last frame of the interval (k_j of equation (5)). Whole number (frame); must be given."""
        value: int = self._get('through')
        return value

    @through.setter
    def through(self, value: int | None) -> None:
        self._set('through', value)

    @property
    def vector(self) -> tuple[float, float, float]:
        """Force F_j: direction and strength, without a unit. Only c_i |F| moves hair (section 4.3). With a `speed`, only
        the direction counts. 3 numbers; must be given.
        """
        value: tuple[float, float, float] = self._get('vector')
        return value

    @vector.setter
    def vector(self, value: Numbers | None) -> None:
        self._set('vector', value)

    @property
    def speed(self) -> str | None:
        """Air speed of the wind, in the free form: "20 km/h", "5 m/s" or "300 cm/s". The strength is then the one that
        carries free hair at this speed. "... cm/s", "... m/s" or "... km/h"; default: strength from vector.
        """
        value: str | None = self._get('speed')
        return value

    @speed.setter
    def speed(self, value: str | None) -> None:
        self._set('speed', value)


class Wind(Table):
    """How the vectors of the intervals follow one another."""

    __slots__ = ()

    @property
    def ease(self) -> Literal["stepped", "linear", "smooth"]:
        """How the wind changes from one vector to the next. "stepped", "linear" or "smooth"; default: "stepped"."""
        value: Literal["stepped", "linear", "smooth"] = self._get('ease')
        return value

    @ease.setter
    def ease(self, value: Literal["stepped", "linear", "smooth"] | None) -> None:
        self._set('ease', value)


class Gust(Table):
    """Gusts: a random factor around 1 on the wind of the intervals, which rises and falls like natural wind.

    It has the spectrum of wind along its direction by T. von Karman ("Progress in the statistical theory of
    turbulence", PNAS 34, 1948) as engineers write it, `S(f) = 4 T / (1 + 70.8 (f T)^2)^(5/6)`, up to a highest
    frequency. Faster changes do not reach all the hair at once; use turbulence for them.
    """

    __slots__ = ()

    @property
    def intensity(self) -> float:
        """How much the wind changes: 0.15 for open country, 0.4 for a town. It is the root mean square of the change of
        the factor; above 0.4 the wind sometimes reverses. Number of at least 0; default: 0.3.
        """
        value: float = self._get('intensity')
        return value

    @intensity.setter
    def intensity(self, value: float | None) -> None:
        self._set('intensity', value)

    @property
    def time_scale(self) -> float:
        """How long a gust takes. T is the length scale of the turbulence over the mean wind speed. Number above 0 (s);
        default: 2.
        """
        value: float = self._get('time_scale')
        return value

    @time_scale.setter
    def time_scale(self, value: float | None) -> None:
        self._set('time_scale', value)

    @property
    def highest(self) -> float:
        """Highest frequency of the changes. Faster ones do not reach all the hair at once. Number above 0 (Hz); default:
        1.
        """
        value: float = self._get('highest')
        return value

    @highest.setter
    def highest(self, value: float | None) -> None:
        self._set('highest', value)

    @property
    def seed(self) -> int:
        """Random seed of the gusts. Whole number; default: 1."""
        value: int = self._get('seed')
        return value

    @seed.setter
    def seed(self, value: int | None) -> None:
        self._set('seed', value)


class BodyWind(Table):
    """The wind caused by the motion of the head, the same everywhere. It needs `[head.motion]`.

    With the head's velocity v (cm/s) and acceleration a (cm/s^2), from its poses and the frame rate: F = -drag v -
    footfall (0, a_y, 0).
    """

    __slots__ = ()

    @property
    def drag(self) -> float:
        """Force per cm/s of the head's speed, opposite to its direction. Number of at least 0 (per cm/s); default: 0.3."""
        value: float = self._get('drag')
        return value

    @drag.setter
    def drag(self, value: float | None) -> None:
        self._set('drag', value)

    @property
    def footfall(self) -> float:
        """Downward force per cm/s^2 of upward acceleration of the head. With gravity G, hair that is lifted with the
        head feels G / 981. Number of at least 0 (per cm/s2); default: 0.
        """
        value: float = self._get('footfall')
        return value

    @footfall.setter
    def footfall(self, value: float | None) -> None:
        self._set('footfall', value)

    @property
    def smoothing(self) -> float:
        """Standard deviation of the bell that averages the head's positions for this wind. Raise it for recorded motion,
        whose accelerations tremble. 0 leaves the motion as it is. Number, 0 to 240 (frames); default: 0.
        """
        value: float = self._get('smoothing')
        return value

    @smoothing.setter
    def smoothing(self, value: float | None) -> None:
        self._set('smoothing', value)


class Flow(Table):
    """Leads the wind around the head instead of through it."""

    __slots__ = ()

    @property
    def thickness(self) -> float:
        """Thickness of the hair on the head ellipsoid: the wind flows around this layer too. Raise it for voluminous
        hair. Number, 0 to 100 (cm); default: 0.
        """
        value: float = self._get('thickness')
        return value

    @thickness.setter
    def thickness(self, value: float | None) -> None:
        self._set('thickness', value)


class Turbulence(Table):
    """Turbulence: a random force of swirls that drift with the wind and change on the way.

    It is the curl of a random vector potential, a sum of octaves that each have half the size of the one before. Near
    the head, Bridson's ramp reduces the potential to 0, so the force runs along the head.
    """

    __slots__ = ()

    @property
    def strength(self) -> float:
        """Strength far from the head: the root mean square of |F| over space. Number of at least 0; default: 30."""
        value: float = self._get('strength')
        return value

    @strength.setter
    def strength(self, value: float | None) -> None:
        self._set('strength', value)

    @property
    def swirl_size(self) -> float:
        """Size of the largest swirls, half of their wavelengths. The swirls of the last octave must be at least 0.01 cm
        as well. Number, 0.01 to 1000000 (cm); default: 10.
        """
        value: float = self._get('swirl_size')
        return value

    @swirl_size.setter
    def swirl_size(self, value: float | None) -> None:
        self._set('swirl_size', value)

    @property
    def pulse_length(self) -> float:
        """Approximate number of frames in which a swirl reverses and returns. 0 makes swirls drift without changing.
        Without drift, the pattern repeats after 16 times this number. Number of at least 0 (frames); default: 48.
        """
        value: float = self._get('pulse_length')
        return value

    @pulse_length.setter
    def pulse_length(self, value: float | None) -> None:
        self._set('pulse_length', value)

    @property
    def roughness(self) -> float:
        """Strength of each octave relative to the one before. 0.79 is that of Kolmogorov. Number, 0 to 1; default: 0.5."""
        value: float = self._get('roughness')
        return value

    @roughness.setter
    def roughness(self, value: float | None) -> None:
        self._set('roughness', value)

    @property
    def octaves(self) -> int:
        """Number of octaves, each half the size of the one before. More give finer swirls and take longer. Whole number,
        1 to 8; default: 2.
        """
        value: int = self._get('octaves')
        return value

    @octaves.setter
    def octaves(self, value: int | None) -> None:
        self._set('octaves', value)

    @property
    def drift(self) -> float:
        """Distance that the swirls drift per frame and unit of wind. Number of at least 0 (cm); default: 0.02."""
        value: float = self._get('drift')
        return value

    @drift.setter
    def drift(self, value: float | None) -> None:
        self._set('drift', value)

    @property
    def near_head(self) -> float:
        """Distance from the head ellipsoid within which the force turns along the head. 0 ignores the head. The distance
        is measured as (|q| - 1) times the mean half axis, with q the point in half axes from the centre, and is at
        most the mean half axis. Number of at least 0 (cm); default: 4.
        """
        value: float = self._get('near_head')
        return value

    @near_head.setter
    def near_head(self, value: float | None) -> None:
        self._set('near_head', value)

    @property
    def seed(self) -> int:
        """Random seed of the swirls. Whole number; default: 1."""
        value: int = self._get('seed')
        return value

    @seed.setter
    def seed(self, value: int | None) -> None:
        self._set('seed', value)

    @property
    def envelope(self) -> Tables[EnvelopeKey]:
        """Keyframes of the strength: the factor follows straight lines between them. Without keyframes, the strength is
        constant.
        """
        return Tables(self._scene, self._key_of('envelope'), EnvelopeKey)

    @envelope.setter
    def envelope(self, value: Iterable[EnvelopeKey | Mapping[str, Any]] | None) -> None:
        self._set('envelope', value)


class EnvelopeKey(Table):
    """A keyframe of the strength."""

    __slots__ = ()

    @property
    def frame(self) -> int:
        """The frame. Whole number; must be given."""
        value: int = self._get('frame')
        return value

    @frame.setter
    def frame(self, value: int | None) -> None:
        self._set('frame', value)

    @property
    def factor(self) -> float:
        """Factor on the strength, any finite number. Number; must be given."""
        value: float = self._get('factor')
        return value

    @factor.setter
    def factor(self, value: float | None) -> None:
        self._set('factor', value)


class Point(Table):
    """A point that pushes or pulls."""

    __slots__ = ()

    @property
    def position(self) -> tuple[float, float, float]:
        """Position, in the space of the forces. 3 numbers, each -1000000 to 1000000 (cm); must be given."""
        value: tuple[float, float, float] = self._get('position')
        return value

    @position.setter
    def position(self, value: Numbers | None) -> None:
        self._set('position', value)

    @property
    def strength(self) -> float:
        """Strength |F| close to the point. Negative values pull. Number; default: 50."""
        value: float = self._get('strength')
        return value

    @strength.setter
    def strength(self, value: float | None) -> None:
        self._set('strength', value)

    @property
    def falloff(self) -> Falloff:
        """How the force weakens with the distance. Within a twentieth of the radius it fades to 0, since it has no
        direction at the centre.
        """
        return Falloff(self._scene, self._key_of('falloff'))

    @falloff.setter
    def falloff(self, value: Falloff | Mapping[str, Any] | None) -> None:
        self._set('falloff', value)

    @property
    def envelope(self) -> Tables[EnvelopeKey]:
        """Keyframes of the strength: the factor follows straight lines between them. Without keyframes, the strength is
        constant.
        """
        return Tables(self._scene, self._key_of('envelope'), EnvelopeKey)

    @envelope.setter
    def envelope(self, value: Iterable[EnvelopeKey | Mapping[str, Any]] | None) -> None:
        self._set('envelope', value)


class Falloff(Table):
    """How a local force weakens with the distance r."""

    __slots__ = ()

    @property
    def law(self) -> Literal["none", "linear", "smooth", "inverse", "inverse_square"]:
        """The law by which the force weakens with distance. "none", "linear", "smooth", "inverse" or "inverse_square";
        default: "smooth".
        """
        value: Literal["none", "linear", "smooth", "inverse", "inverse_square"] = self._get('law')
        return value

    @law.setter
    def law(self, value: Literal["none", "linear", "smooth", "inverse", "inverse_square"] | None) -> None:
        self._set('law', value)

    @property
    def radius(self) -> float:
        """Radius R of the law. Within a twentieth of it the force fades to 0. Number above 0 (cm); default: 30."""
        value: float = self._get('radius')
        return value

    @radius.setter
    def radius(self, value: float | None) -> None:
        self._set('radius', value)


class Vortex(Table):
    """A vortex: a force around an axis."""

    __slots__ = ()

    @property
    def position(self) -> tuple[float, float, float]:
        """A point of the axis, in the space of the forces. 3 numbers, each -1000000 to 1000000 (cm); must be given."""
        value: tuple[float, float, float] = self._get('position')
        return value

    @position.setter
    def position(self, value: Numbers | None) -> None:
        self._set('position', value)

    @property
    def axis(self) -> tuple[float, float, float]:
        """Direction of the axis, of any length except 0. Hair goes around it counter-clockwise as seen from its tip. 3
        numbers; default: [0, 1, 0].
        """
        value: tuple[float, float, float] = self._get('axis')
        return value

    @axis.setter
    def axis(self, value: Numbers | None) -> None:
        self._set('axis', value)

    @property
    def strength(self) -> float:
        """Strength |F| close to the axis. Negative values turn the other way. Number; default: 50."""
        value: float = self._get('strength')
        return value

    @strength.setter
    def strength(self, value: float | None) -> None:
        self._set('strength', value)

    @property
    def falloff(self) -> Falloff:
        """How the force weakens with the distance from the axis. Within a twentieth of the radius it fades to 0."""
        return Falloff(self._scene, self._key_of('falloff'))

    @falloff.setter
    def falloff(self, value: Falloff | Mapping[str, Any] | None) -> None:
        self._set('falloff', value)

    @property
    def envelope(self) -> Tables[EnvelopeKey]:
        """Keyframes of the strength: the factor follows straight lines between them. Without keyframes, the strength is
        constant.
        """
        return Tables(self._scene, self._key_of('envelope'), EnvelopeKey)

    @envelope.setter
    def envelope(self, value: Iterable[EnvelopeKey | Mapping[str, Any]] | None) -> None:
        self._set('envelope', value)


class Fan(Table):
    """A wind in a cone."""

    __slots__ = ()

    @property
    def position(self) -> tuple[float, float, float]:
        """Tip of the cone, in the space of the forces. 3 numbers, each -1000000 to 1000000 (cm); must be given."""
        value: tuple[float, float, float] = self._get('position')
        return value

    @position.setter
    def position(self, value: Numbers | None) -> None:
        self._set('position', value)

    @property
    def direction(self) -> tuple[float, float, float]:
        """Direction of the wind. Any length except 0. 3 numbers; must be given."""
        value: tuple[float, float, float] = self._get('direction')
        return value

    @direction.setter
    def direction(self, value: Numbers | None) -> None:
        self._set('direction', value)

    @property
    def strength(self) -> float:
        """Strength |F| on the axis, close to the fan. Negative values draw air in. Number; default: 50."""
        value: float = self._get('strength')
        return value

    @strength.setter
    def strength(self, value: float | None) -> None:
        self._set('strength', value)

    @property
    def spread(self) -> float:
        """Angle between the axis and the edge of the cone. Number, 1 to 90 (degrees); default: 30."""
        value: float = self._get('spread')
        return value

    @spread.setter
    def spread(self, value: float | None) -> None:
        self._set('spread', value)

    @property
    def falloff(self) -> Falloff:
        """How the force weakens with the distance. Within a twentieth of the radius it fades to 0."""
        return Falloff(self._scene, self._key_of('falloff'))

    @falloff.setter
    def falloff(self, value: Falloff | Mapping[str, Any] | None) -> None:
        self._set('falloff', value)

    @property
    def envelope(self) -> Tables[EnvelopeKey]:
        """Keyframes of the strength: the factor follows straight lines between them. Without keyframes, the strength is
        constant.
        """
        return Tables(self._scene, self._key_of('envelope'), EnvelopeKey)

    @envelope.setter
    def envelope(self, value: Iterable[EnvelopeKey | Mapping[str, Any]] | None) -> None:
        self._set('envelope', value)
