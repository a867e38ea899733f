"""What is drawn: `scene.picture`, `scene.output`. Written by generate.py from the schema of scenes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

from ._table import Arrays, File, Matrices, Numbers, Table, Tables

__all__ = [
    "Background",
    "Camera",
    "CameraKey",
    "HairLook",
    "HeadLook",
    "Light",
    "Output",
    "Picture",
    "Sky",
    "Video",
]


class Picture(Table):
    """How pictures are drawn."""

    __slots__ = ()

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture. 2 whole numbers, each 1 to 16384 (pixels); default: [960, 540]."""
        value: tuple[int, int] = self._get('size')
        return value

    @size.setter
    def size(self, value: Numbers | None) -> None:
        self._set('size', value)

    @property
    def antialiasing(self) -> Literal["coverage", "oversample"]:
        """How a hair gets its share of a pixel: exact coverage, or points as in the paper. "coverage" or "oversample";
        default: "coverage".
        """
        value: Literal["coverage", "oversample"] = self._get('antialiasing')
        return value

    @antialiasing.setter
    def antialiasing(self, value: Literal["coverage", "oversample"] | None) -> None:
        self._set('antialiasing', value)

    @property
    def samples(self) -> int:
        """Points along each side of a pixel when oversampling. More give smoother edges and take longer. Whole number, 1
        to 32; default: 4.
        """
        value: int = self._get('samples')
        return value

    @samples.setter
    def samples(self, value: int | None) -> None:
        self._set('samples', value)

    @property
    def camera(self) -> Camera:
        """The camera."""
        return Camera(self._scene, self._key_of('camera'))

    @camera.setter
    def camera(self, value: Camera | Mapping[str, Any] | None) -> None:
        self._set('camera', value)

    @property
    def hair(self) -> HairLook:
        """Width, colour and shading of the hair."""
        return HairLook(self._scene, self._key_of('hair'))

    @hair.setter
    def hair(self, value: HairLook | Mapping[str, Any] | None) -> None:
        self._set('hair', value)

    @property
    def lights(self) -> Tables[Light]:
        """The lamps, at most 16. By default a warm key light, a weak fill light and two kickers."""
        return Tables(self._scene, self._key_of('lights'), Light)

    @lights.setter
    def lights(self, value: Iterable[Light | Mapping[str, Any]] | None) -> None:
        self._set('lights', value)

    @property
    def sky(self) -> Sky:
        """The light from all directions."""
        return Sky(self._scene, self._key_of('sky'))

    @sky.setter
    def sky(self, value: Sky | Mapping[str, Any] | None) -> None:
        self._set('sky', value)

    @property
    def shadows(self) -> bool:
        """Whether hair, head and bodies cast shadows. True or false; default: true."""
        value: bool = self._get('shadows')
        return value

    @shadows.setter
    def shadows(self, value: bool | None) -> None:
        self._set('shadows', value)

    @property
    def head(self) -> HeadLook:
        """How the head is drawn."""
        return HeadLook(self._scene, self._key_of('head'))

    @head.setter
    def head(self, value: HeadLook | Mapping[str, Any] | None) -> None:
        self._set('head', value)

    @property
    def background(self) -> Background:
        """What is behind hair and head."""
        return Background(self._scene, self._key_of('background'))

    @background.setter
    def background(self, value: Background | Mapping[str, Any] | None) -> None:
        self._set('background', value)

    @property
    def exposure(self) -> float:
        """Brightness in photographic stops. Each stop is a factor of 2. Number, -20 to 20 (stops); default: 0."""
        value: float = self._get('exposure')
        return value

    @exposure.setter
    def exposure(self, value: float | None) -> None:
        self._set('exposure', value)

    @property
    def tone_mapping(self) -> Literal["linear", "filmic"]:
        """How scene light becomes display light in 8 and 16 bit pictures and in movies. "linear" or "filmic"; default:
        "filmic".
        """
        value: Literal["linear", "filmic"] = self._get('tone_mapping')
        return value

    @tone_mapping.setter
    def tone_mapping(self, value: Literal["linear", "filmic"] | None) -> None:
        self._set('tone_mapping', value)

    @property
    def shutter(self) -> float:
        """Share of the frame interval during which the shutter is open. 0 gives a sharp picture, 0.5 the motion blur of
        a film camera with 180 degrees. Number, 0 to 1; default: 0.
        """
        value: float = self._get('shutter')
        return value

    @shutter.setter
    def shutter(self, value: float | None) -> None:
        self._set('shutter', value)

    @property
    def video(self) -> Video:
        """The movie."""
        return Video(self._scene, self._key_of('video'))

    @video.setter
    def video(self, value: Video | Mapping[str, Any] | None) -> None:
        self._set('video', value)


class Camera(Table):
    """A camera on an orbit around the hair, still or moving between two places."""

    __slots__ = ()

    @property
    def projection(self) -> Literal["perspective", "orthographic"]:
        """How space is projected onto the picture. "perspective" or "orthographic"; default: "perspective"."""
        value: Literal["perspective", "orthographic"] = self._get('projection')
        return value

    @projection.setter
    def projection(self, value: Literal["perspective", "orthographic"] | None) -> None:
        self._set('projection', value)

    @property
    def azimuth(self) -> float:
        """Direction of the camera around the world's vertical. For a head that has not turned, 0 is in front of the
        face, 90 at the character's right hand and 180 behind. Number, -3600 to 3600 (degrees); default: 40.
        """
        value: float = self._get('azimuth')
        return value

    @azimuth.setter
    def azimuth(self, value: float | None) -> None:
        self._set('azimuth', value)

    @property
    def elevation(self) -> float:
        """Direction of the camera above the horizon. Number, -89 to 89 (degrees); default: 5."""
        value: float = self._get('elevation')
        return value

    @elevation.setter
    def elevation(self, value: float | None) -> None:
        self._set('elevation', value)

    @property
    def fov(self) -> float:
        """Vertical field of view, for perspective. Number, 1 to 150 (degrees); default: 26."""
        value: float = self._get('fov')
        return value

    @fov.setter
    def fov(self, value: float | None) -> None:
        self._set('fov', value)

    @property
    def distance(self) -> float | None:
        """Distance from the target to the eye. Number, 1 to 1000000 (cm); default: fits everything."""
        value: float | None = self._get('distance')
        return value

    @distance.setter
    def distance(self, value: float | None) -> None:
        self._set('distance', value)

    @property
    def height(self) -> float | None:
        """Height of the picture in space, for orthographic views. Number, 0.001 to 1000000 (cm); default: fits
        everything.
        """
        value: float | None = self._get('height')
        return value

    @height.setter
    def height(self, value: float | None) -> None:
        self._set('height', value)

    @property
    def target(self) -> tuple[float, float, float] | None:
        """The point to look at, from the head's origin along the world's axes. The camera moves with the head but does
        not turn with it. 3 numbers, each -1000000 to 1000000 (cm); default: the middle.
        """
        value: tuple[float, float, float] | None = self._get('target')
        return value

    @target.setter
    def target(self, value: Numbers | None) -> None:
        self._set('target', value)

    @property
    def f_stop(self) -> float | None:
        """Aperture of the lens, for perspective: focal length over diameter. Small numbers blur more; nabiki refuses
        skin blurred by more than 3 picture heights. The focal length is that for a sensor 24 mm high with this `fov`:
        52 mm for 26 degrees. Number, 0.1 to 128; default: everything sharp.
        """
        value: float | None = self._get('f_stop')
        return value

    @f_stop.setter
    def f_stop(self, value: float | None) -> None:
        self._set('f_stop', value)

    @property
    def focus_distance(self) -> float | None:
        """Distance from the eye to the plane in focus, along the view axis. By default the side of the head that the
        camera sees. Number, 1 to 1000000 (cm); default: the head.
        """
        value: float | None = self._get('focus_distance')
        return value

    @focus_distance.setter
    def focus_distance(self, value: float | None) -> None:
        self._set('focus_distance', value)

    @property
    def margin(self) -> float:
        """Empty border around what is framed, as a share of the picture's shorter side. Number, 0 to 0.45; default:
        0.06.
        """
        value: float = self._get('margin')
        return value

    @margin.setter
    def margin(self, value: float | None) -> None:
        self._set('margin', value)

    @property
    def to(self) -> CameraKey:
        """Camera at the last frame. It moves there from the values above."""
        return CameraKey(self._scene, self._key_of('to'))

    @to.setter
    def to(self, value: CameraKey | Mapping[str, Any] | None) -> None:
        self._set('to', value)


class CameraKey(Table):
    """Where a moving camera ends. Values you leave out do not change."""

    __slots__ = ()

    @property
    def azimuth(self) -> float | None:
        """Azimuth at the end. Number, -3600 to 3600 (degrees); default: unchanged."""
        value: float | None = self._get('azimuth')
        return value

    @azimuth.setter
    def azimuth(self, value: float | None) -> None:
        self._set('azimuth', value)

    @property
    def elevation(self) -> float | None:
        """Elevation at the end. Number, -89 to 89 (degrees); default: unchanged."""
        value: float | None = self._get('elevation')
        return value

    @elevation.setter
    def elevation(self, value: float | None) -> None:
        self._set('elevation', value)

    @property
    def distance(self) -> float | None:
        """Distance at the end. It requires `distance` at the start. Number, 1 to 1000000 (cm); default: unchanged."""
        value: float | None = self._get('distance')
        return value

    @distance.setter
    def distance(self, value: float | None) -> None:
        self._set('distance', value)

    @property
    def fov(self) -> float | None:
        """Field of view at the end. Number, 1 to 150 (degrees); default: unchanged."""
        value: float | None = self._get('fov')
        return value

    @fov.setter
    def fov(self, value: float | None) -> None:
        self._set('fov', value)

    @property
    def target(self) -> tuple[float, float, float] | None:
        """Target at the end. It requires `target` at the start. 3 numbers, each -1000000 to 1000000 (cm); default:
        unchanged.
        """
        value: tuple[float, float, float] | None = self._get('target')
        return value

    @target.setter
    def target(self, value: Numbers | None) -> None:
        self._set('target', value)

    @property
    def focus_distance(self) -> float | None:
        """Focus distance at the end. It requires `focus_distance` at the start. Number, 1 to 1000000 (cm); default:
        unchanged.
        """
        value: float | None = self._get('focus_distance')
        return value

    @focus_distance.setter
    def focus_distance(self, value: float | None) -> None:
        self._set('focus_distance', value)


class HairLook(Table):
    """Width, colour and shading of the hair."""

    __slots__ = ()

    @property
    def width(self) -> float:
        """Diameter of a hair at its root. Real hair has about 0.007 cm; the default is larger because 20,000 strands
        represent 100,000. Lower it if you raise the number of strands. Number, 1e-05 to 5 (cm); default: 0.014.
        """
        value: float = self._get('width')
        return value

    @width.setter
    def width(self, value: float | None) -> None:
        self._set('width', value)

    @property
    def tip(self) -> float:
        """Thickness at the tip as a share of that at the root. Number, 0 to 1; default: 0.3."""
        value: float = self._get('tip')
        return value

    @tip.setter
    def tip(self, value: float | None) -> None:
        self._set('tip', value)

    @property
    def taper(self) -> float:
        """Share of the length over which the hair thins toward its tip. Number, 0 to 1; default: 0.4."""
        value: float = self._get('taper')
        return value

    @taper.setter
    def taper(self, value: float | None) -> None:
        self._set('taper', value)

    @property
    def colour(self) -> str | dict[str, Any]:
        """A name, amounts of pigment, or the colour of a thick mass of hair in even light. "black", "brown", "blond",
        "red" or "grey", a table of MelaninColour, or a table of RgbColour; default: "brown".
        """
        value: str | dict[str, Any] = self._get('colour')
        return value

    @colour.setter
    def colour(self, value: str | Mapping[str, Any] | None) -> None:
        self._set('colour', value)

    @property
    def variation(self) -> float:
        """How much hairs differ in pigment and in the tilt of their scales. Number, 0 to 1; default: 0.25."""
        value: float = self._get('variation')
        return value

    @variation.setter
    def variation(self, value: float | None) -> None:
        self._set('variation', value)

    @property
    def shading(self) -> Literal["fibre", "kajiya-kay"]:
        """How a hair reflects light: a fibre with pigment, or the paper's model of 1989. "fibre" or "kajiya-kay";
        default: "fibre".
        """
        value: Literal["fibre", "kajiya-kay"] = self._get('shading')
        return value

    @shading.setter
    def shading(self, value: Literal["fibre", "kajiya-kay"] | None) -> None:
        self._set('shading', value)

    @property
    def roughness(self) -> float:
        """Roughness along the hair. Raise it to widen the highlight. Number, 2 to 40 (degrees); default: 5."""
        value: float = self._get('roughness')
        return value

    @roughness.setter
    def roughness(self, value: float | None) -> None:
        self._set('roughness', value)

    @property
    def azimuthal_roughness(self) -> float:
        """Roughness around the hair. Lower it to sharpen the light through the fibre. Number, 0.05 to 1; default: 0.35."""
        value: float = self._get('azimuthal_roughness')
        return value

    @azimuthal_roughness.setter
    def azimuthal_roughness(self, value: float | None) -> None:
        self._set('azimuthal_roughness', value)

    @property
    def scale_tilt(self) -> float:
        """Tilt of the scales of the cuticle. Raise it to shift the white highlight toward the root and the coloured one
        toward the tip. Number, -10 to 10 (degrees); default: 2.5.
        """
        value: float = self._get('scale_tilt')
        return value

    @scale_tilt.setter
    def scale_tilt(self, value: float | None) -> None:
        self._set('scale_tilt', value)

    @property
    def refraction(self) -> float:
        """Refractive index of the fibre. Number, 1.1 to 2.5; default: 1.55."""
        value: float = self._get('refraction')
        return value

    @refraction.setter
    def refraction(self, value: float | None) -> None:
        self._set('refraction', value)

    @property
    def smooth(self) -> bool:
        """Whether to draw a curve through the nodes instead of straight segments. True or false; default: true."""
        value: bool = self._get('smooth')
        return value

    @smooth.setter
    def smooth(self, value: bool | None) -> None:
        self._set('smooth', value)


class Light(Table):
    """A lamp, far away."""

    __slots__ = ()

    @property
    def azimuth(self) -> float:
        """Direction around the vertical that the light comes from, counted like the camera's azimuth. Number, -3600 to
        3600 (degrees); default: 0.
        """
        value: float = self._get('azimuth')
        return value

    @azimuth.setter
    def azimuth(self, value: float | None) -> None:
        self._set('azimuth', value)

    @property
    def elevation(self) -> float:
        """Direction above the horizon that the light comes from. Number, -90 to 90 (degrees); default: 40."""
        value: float = self._get('elevation')
        return value

    @elevation.setter
    def elevation(self, value: float | None) -> None:
        self._set('elevation', value)

    @property
    def strength(self) -> float:
        """Strength: the brightness of a white surface that faces the lamp. Number, 0 to 1000; default: 1."""
        value: float = self._get('strength')
        return value

    @strength.setter
    def strength(self, value: float | None) -> None:
        self._set('strength', value)

    @property
    def colour(self) -> tuple[float, float, float]:
        """Colour of the light, as linear amounts. 3 numbers, each 0 to 1 (linear); default: [1, 1, 1]."""
        value: tuple[float, float, float] = self._get('colour')
        return value

    @colour.setter
    def colour(self, value: Numbers | None) -> None:
        self._set('colour', value)

    @property
    def spread(self) -> float:
        """Apparent size of the lamp as seen from the hair. Raise it for softer shadows. Number, 0 to 45 (degrees);
        default: 4.
        """
        value: float = self._get('spread')
        return value

    @spread.setter
    def spread(self, value: float | None) -> None:
        self._set('spread', value)

    @property
    def space(self) -> Literal["camera", "world", "head"]:
        """What the direction is relative to. "camera", "world" or "head"; default: "camera"."""
        value: Literal["camera", "world", "head"] = self._get('space')
        return value

    @space.setter
    def space(self, value: Literal["camera", "world", "head"] | None) -> None:
        self._set('space', value)


class Sky(Table):
    """Light from all directions, dimmed where hair or head block it."""

    __slots__ = ()

    @property
    def strength(self) -> float:
        """Strength: the brightness of a white surface that nothing blocks. Number, 0 to 1000; default: 0.24."""
        value: float = self._get('strength')
        return value

    @strength.setter
    def strength(self, value: float | None) -> None:
        self._set('strength', value)

    @property
    def above(self) -> tuple[float, float, float]:
        """Colour of the light from straight above. 3 numbers, each 0 to 1 (linear); default: [0.93, 0.97, 1]."""
        value: tuple[float, float, float] = self._get('above')
        return value

    @above.setter
    def above(self, value: Numbers | None) -> None:
        self._set('above', value)

    @property
    def below(self) -> tuple[float, float, float]:
        """Colour of the light from straight below. 3 numbers, each 0 to 1 (linear); default: [0.55, 0.5, 0.47]."""
        value: tuple[float, float, float] = self._get('below')
        return value

    @below.setter
    def below(self, value: Numbers | None) -> None:
        self._set('below', value)

    @property
    def occlusion(self) -> bool:
        """Whether hair and head block the light of the sky. True or false; default: true."""
        value: bool = self._get('occlusion')
        return value

    @occlusion.setter
    def occlusion(self, value: bool | None) -> None:
        self._set('occlusion', value)

    @property
    def space(self) -> Literal["world", "head"]:
        """Whether the sky stays fixed to the world or turns with the head. "world" or "head"; default: "world"."""
        value: Literal["world", "head"] = self._get('space')
        return value

    @space.setter
    def space(self, value: Literal["world", "head"] | None) -> None:
        self._set('space', value)


class HeadLook(Table):
    """How the head is drawn."""

    __slots__ = ()

    @property
    def visible(self) -> bool:
        """Whether to draw the head. A hidden head still hides the hair behind it and casts shadows. True or false;
        default: true.
        """
        value: bool = self._get('visible')
        return value

    @visible.setter
    def visible(self, value: bool | None) -> None:
        self._set('visible', value)

    @property
    def colour(self) -> tuple[float, float, float]:
        """Colour of the skin. The default is a muted skin tone that does not distract from the hair. 3 numbers, each 0
        to 1 (sRGB); default: [0.56, 0.44, 0.37].
        """
        value: tuple[float, float, float] = self._get('colour')
        return value

    @colour.setter
    def colour(self, value: Numbers | None) -> None:
        self._set('colour', value)

    @property
    def softness(self) -> float:
        """How far light spreads past the terminator, as in skin. Number, 0 to 1; default: 0.2."""
        value: float = self._get('softness')
        return value

    @softness.setter
    def softness(self, value: float | None) -> None:
        self._set('softness', value)

    @property
    def sheen(self) -> float:
        """Strength of the sheen. Number, 0 to 1; default: 0.25."""
        value: float = self._get('sheen')
        return value

    @sheen.setter
    def sheen(self, value: float | None) -> None:
        self._set('sheen', value)

    @property
    def stubble(self) -> float:
        """Length of undrawn short hair at each root, as thick as the hair. It tints the scalp where roots are dense, so
        that partings do not shine. 0 shows bare skin. Number, 0 to 100 (cm); default: 2.
        """
        value: float = self._get('stubble')
        return value

    @stubble.setter
    def stubble(self, value: float | None) -> None:
        self._set('stubble', value)

    @property
    def face(self) -> bool:
        """Whether the built-in head has coloured brows, eyes and lips. Other heads have one colour. True or false;
        default: true.
        """
        value: bool = self._get('face')
        return value

    @face.setter
    def face(self, value: bool | None) -> None:
        self._set('face', value)


class Background(Table):
    """The background: a vertical gradient, or none."""

    __slots__ = ()

    @property
    def top(self) -> tuple[float, float, float]:
        """Displayed colour at the top edge. 3 numbers, each 0 to 1 (sRGB); default: [0.36, 0.38, 0.41]."""
        value: tuple[float, float, float] = self._get('top')
        return value

    @top.setter
    def top(self, value: Numbers | None) -> None:
        self._set('top', value)

    @property
    def bottom(self) -> tuple[float, float, float]:
        """Displayed colour at the bottom edge. 3 numbers, each 0 to 1 (sRGB); default: [0.2, 0.21, 0.23]."""
        value: tuple[float, float, float] = self._get('bottom')
        return value

    @bottom.setter
    def bottom(self, value: Numbers | None) -> None:
        self._set('bottom', value)

    @property
    def transparent(self) -> bool:
        """Whether to leave out the background. Alpha is then 0 where there is neither hair nor head. True or false;
        default: false.
        """
        value: bool = self._get('transparent')
        return value

    @transparent.setter
    def transparent(self, value: bool | None) -> None:
        self._set('transparent', value)


class Video(Table):
    """The movie file."""

    __slots__ = ()

    @property
    def quality(self) -> float:
        """Quality of the movie. 0 gives a small file, 1 a large, nearly lossless one. Number, 0 to 1; default: 0.75."""
        value: float = self._get('quality')
        return value

    @quality.setter
    def quality(self, value: float | None) -> None:
        self._set('quality', value)

    @property
    def frame_rate(self) -> float | None:
        """Playback rate of the movie. A value below `motion.frame_rate` gives slow motion. Number, 1 to 240 (per
        second); default: the motion's.
        """
        value: float | None = self._get('frame_rate')
        return value

    @frame_rate.setter
    def frame_rate(self, value: float | None) -> None:
        self._set('frame_rate', value)


class Output(Table):
    """What a run writes. The command line sets the folder."""

    __slots__ = ()

    @property
    def movie(self) -> bool:
        """Whether to write a movie. True or false; default: true."""
        value: bool = self._get('movie')
        return value

    @movie.setter
    def movie(self, value: bool | None) -> None:
        self._set('movie', value)

    @property
    def png_frames(self) -> bool:
        """Whether to write each frame as a PNG. True or false; default: false."""
        value: bool = self._get('png_frames')
        return value

    @png_frames.setter
    def png_frames(self, value: bool | None) -> None:
        self._set('png_frames', value)

    @property
    def png_bits(self) -> int:
        """Bits per channel of the PNG frames: 8 or 16. Whole number, 8 to 16; default: 8."""
        value: int = self._get('png_bits')
        return value

    @png_bits.setter
    def png_bits(self, value: int | None) -> None:
        self._set('png_bits', value)

    @property
    def exr_frames(self) -> bool:
        """Whether to write each frame as an OpenEXR file with depth, hair direction and motion. True or false; default:
        false.
        """
        value: bool = self._get('exr_frames')
        return value

    @exr_frames.setter
    def exr_frames(self, value: bool | None) -> None:
        self._set('exr_frames', value)

    @property
    def field(self) -> bool:
        """Whether to plot the force, projected on the yz and zx planes, as SVG and PNG. This is the paper's Figure 10.
        True or false; default: false.
        """
        value: bool = self._get('field')
        return value

    @field.setter
    def field(self, value: bool | None) -> None:
        self._set('field', value)

    @property
    def sheet(self) -> tuple[int, ...] | None:
        """Frames of the contact sheet. By default four frames at equal distances from frame 0 on, as in the paper's
        Figure 6. List of whole numbers (frames); default: 4, evenly spaced.
        """
        value: tuple[int, ...] | None = self._get('sheet')
        return value

    @sheet.setter
    def sheet(self, value: Sequence[int] | None) -> None:
        self._set('sheet', value)

    @property
    def first_frame(self) -> int | None:
        """Frame number of the shot for frame 0. Exports of moving hair (USD, Alembic) count from it; pictures keep the
        scene's numbers. By default it comes from the head's motion, if that is from USD or Alembic and plays at its
        own speed. Otherwise it comes from the hair's USD layer (`startTimeCode`) or Alembic archive, or is 0. Whole
        number, -10000000 to 10000000; default: as in the files.
        """
        value: int | None = self._get('first_frame')
        return value

    @first_frame.setter
    def first_frame(self, value: int | None) -> None:
        self._set('first_frame', value)
