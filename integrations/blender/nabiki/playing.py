# SPDX-License-Identifier: GPL-3.0-or-later
"""Motions in memory, and the preview that shows them as the time line is scrubbed.

A motion is kept under a number for all that it was computed from. What is shown is looked up by that number, so that a motion
of other settings is never shown: where there is none, the preview is at rest.
"""

import zlib
from collections import OrderedDict
from dataclasses import dataclass, field

import bpy
import numpy as np
from bpy.app.handlers import persistent

from . import attributes, jobs, sampling, scene_files
from .messages import Mistake

# Motions that are kept of an object, so that Undo and Redo find them.
KEPT = 4


@dataclass
class Film:
    """The motion of a preview."""

    points: np.ndarray
    """(frames, points, 3), float32, about the place of the preview."""
    strands: np.ndarray
    """The numbers of its strands in the sampled hair."""
    frames: range
    rate: float
    notes: list = field(default_factory=list)

    def at(self, frame):
        """The points of a frame; between frames on straight lines, before and after them as at the ends."""
        place = min(max(frame - self.frames.start, 0.0), len(self.points) - 1.0)
        before = int(place)
        part = np.float32(place - before)
        if not part:
            return self.points[before]
        return self.points[before] + part * (self.points[before + 1] - self.points[before])

    def fits(self, data):
        """Whether curves are as many as its strands, with as many points."""
        return len(data.curves) == len(self.strands) and len(data.points) == self.points.shape[1]

    def velocities(self, frame):
        """Units a second, toward the frame after, as motion blur wants them; those of the last frame are of the one before it."""
        before = min(max(int(frame) - self.frames.start, 0), len(self.points) - 2)
        return (self.points[before + 1] - self.points[before]) * np.float32(self.rate)


class Take:
    """What is known of an object of curves: what it was sampled as, and its motions."""

    def __init__(self):
        self.sample = None
        self.films = OrderedDict()

    def keep(self, key, film):
        self.films[key] = film
        self.films.move_to_end(key)
        while len(self.films) > KEPT:
            self.films.popitem(last=False)


takes = {}
"""By the number that an object has in a session of Blender, which Undo leaves alone."""

quiet = 0
"""Above 0 while what changes is changed by us."""


class Quiet:
    """While it lasts, changes are our own."""

    def __enter__(self):
        global quiet
        quiet += 1

    def __exit__(self, *_):
        global quiet
        quiet -= 1


def take(thing):
    return takes.setdefault(thing.session_uid, Take())


def key(scene, thing):
    """A number for all that a motion is computed from, but what moves by itself; None where a mistake is in the way."""
    try:
        plain = scene_files.values(thing.nabiki, sampling.frame_range(scene, thing.nabiki)[0])
        # Which winds may be changed decides no motion.
        plain["intervals"] = [interval[:2] for interval in plain["intervals"]]
        words = repr((sorted(plain.items()), thing.nabiki.preview_strands))
        return zlib.crc32(words.encode()), sampling.digest(scene, thing)
    except Mistake:
        return None


def film_of(scene, thing):
    """The motion of an object as it is now, or None."""
    known = takes.get(thing.session_uid)
    return known.films.get(key(scene, thing)) if known and known.films else None


def shown_film(scene, thing, preview):
    """The motion that a preview shows, or None: after Undo it may have the strands of another."""
    film = film_of(scene, thing)
    return film if film is not None and film.fits(preview.data) else None


def previews(scene):
    """The objects of curves that have a preview in a scene, and their previews."""
    for thing in scene.objects:
        preview = preview_of(scene, thing) if thing.type == "CURVES" else None
        if preview is not None:
            yield thing, preview


def preview_of(scene, thing):
    """The preview of an object, if it is still there, and its own: a copy of the object has that of the first."""
    preview = thing.nabiki.preview
    return preview if preview is not None and preview.name in scene.objects and preview.nabiki.of == thing else None


def show(scene, thing, preview, film):
    """Writes a frame of a motion into a preview; its rest where there is no motion."""
    if preview.mode != "OBJECT":
        return
    data = preview.data
    data["nabiki_shown"] = shown_now(scene, thing, film)
    if film is not None:
        frame = scene.frame_current_final
        points, velocities = film.at(frame), film.velocities(frame)
    else:
        rest = data.attributes.get("nabiki_rest")
        if rest is None:
            return
        points = attributes.values(rest)
        velocities = np.zeros_like(points)
    attributes.put(data, "position", "FLOAT_VECTOR", "POINT", points)
    attributes.put(data, "velocity", "FLOAT_VECTOR", "POINT", velocities)
    attributes.moved(data)


def shown_now(scene, thing, film):
    """What a preview shows, in a word that is kept with its points."""
    return f"{key(scene, thing)} {scene.frame_current_final}" if film is not None else "rest"


def show_all(scene):
    for thing, preview in previews(scene):
        show(scene, thing, preview, shown_film(scene, thing, preview))


def settings_changed(thing):
    """A setting of an object is another."""
    if quiet:
        return
    for scene in bpy.data.scenes:
        for own, preview in previews(scene):
            if own == thing:
                film = shown_film(scene, thing, preview)
                show(scene, thing, preview, film)
                if film is None:
                    ask_again(thing)


# Objects whose motion is computed again as soon as nobody changes anything any more, and how long that is waited for (seconds).
asked, CALM = set(), 0.3


def ask_again(thing):
    """Asks for the motion of other settings. What else has changed is read when the button is pressed: going through the frames
    would take things out of the hands of who moves them."""
    known = takes.get(thing.session_uid)
    if bpy.app.background or known is None or known.sample is None:
        return
    asked.add(thing.session_uid)
    if bpy.app.timers.is_registered(again):
        bpy.app.timers.unregister(again)
    bpy.app.timers.register(again, first_interval=CALM)


def again():
    """Computes what was asked for, beside whatever the user does, once nothing else is at work."""
    windows = bpy.context.window_manager.windows
    things = [o for o in windows[0].scene.objects if o.session_uid in asked] if windows else []
    working = jobs.running
    if working is not None:
        # Nobody waits for the motion of settings that are others by now.
        if working.beside and any(working.name == thing.name for thing in things):
            working.unwanted = True
        return CALM
    if not things:
        asked.clear()
        return None
    # One after another.
    thing = things[0]
    asked.remove(thing.session_uid)
    known, now = takes.get(thing.session_uid), key(windows[0].scene, thing)
    if known is not None and known.sample is not None and now is not None and known.sample.digest == now[1]:
        with bpy.context.temp_override(window=windows[0], scene=windows[0].scene):
            bpy.ops.nabiki.simulate("INVOKE_DEFAULT", name=thing.name, beside=True)
    return CALM if asked else None


@persistent
def before_frame(scene, _=None):
    """The preview is written before the frame is evaluated, so that all that depends on it is of the same frame."""
    if quiet:
        return
    with Quiet():
        show_all(scene)


@persistent
def after_frame(scene, graph=None):
    """What moves by itself may move otherwise than when it was sampled: then its motion is none any more."""
    # A picture is evaluated without what is hidden in it.
    if not quiet and (graph is None or graph.mode == "VIEWPORT"):
        check(scene, graph)


@persistent
def after_update(scene, graph):
    """Whatever was changed: motions of before are not shown any more."""
    if quiet:
        return
    shown = list(previews(scene))
    if not shown:
        return
    added = {block.session_uid for thing, preview in shown for block in ours(thing, preview)}
    updates = [u for u in graph.updates if u.id.original.session_uid not in added]
    touched = {u.id.original.session_uid for u in updates if u.is_updated_geometry}
    keyed = any(isinstance(u.id.original, bpy.types.Action) for u in updates)
    for thing, _ in shown:
        known = takes.get(thing.session_uid)
        if known is not None and known.sample is not None and (keyed or not sampling.still_shaped(known.sample, thing, graph, touched)):
            forget(thing)
    if not any(u.is_updated_geometry or u.is_updated_transform or isinstance(u.id.original, bpy.types.Object) for u in updates):
        return
    check(scene, graph)


def ours(thing, preview):
    """What was added to the scene, and decides no motion."""
    for own in [preview, thing.nabiki.baked]:
        if own is not None:
            yield from (own, own.data)
            if own.animation_data is not None and own.animation_data.action is not None:
                yield own.animation_data.action


def check(scene, graph=None):
    """Motions that are none any more are not shown."""
    for thing, preview in previews(scene):
        film = shown_film(scene, thing, preview)
        known = takes.get(thing.session_uid)
        # Samples are of whole frames.
        if film is not None and known.sample is not None and not scene.frame_subframe:
            graph_now = graph or bpy.context.evaluated_depsgraph_get()
            if not sampling.still_as_sampled(known.sample, thing, graph_now, scene.frame_current):
                forget(thing)
                film = None
        if film is None:
            with Quiet():
                show(scene, thing, preview, None)


def forget(thing):
    """What moves by itself was changed: neither sample nor motions hold."""
    known = takes.get(thing.session_uid)
    if known is not None:
        known.sample = None
        known.films.clear()


@persistent
def after_undo(scene, _=None):
    scene = bpy.context.scene
    for thing, preview in previews(scene):
        film = shown_film(scene, thing, preview)
        # What a hand has moved in this very frame stays.
        if preview.data.get("nabiki_shown") != shown_now(scene, thing, film):
            with Quiet():
                show(scene, thing, preview, film)
        if film is None:
            ask_again(thing)


@persistent
def after_load(*_):
    """Motions are of the file that was open before."""
    takes.clear()
    with Quiet():
        for scene in bpy.data.scenes:
            show_all(scene)


HANDLERS = [
    ("frame_change_pre", before_frame),
    ("frame_change_post", after_frame),
    ("depsgraph_update_post", after_update),
    ("undo_post", after_undo),
    ("redo_post", after_undo),
    ("load_post", after_load),
]


def register():
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister():
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    if bpy.app.timers.is_registered(again):
        bpy.app.timers.unregister(again)
    takes.clear()
