# SPDX-License-Identifier: GPL-3.0-or-later
"""The steps from an object of curves to its motion."""

import shutil
import tempfile
from contextlib import contextmanager

import bpy
import numpy as np

from . import attributes, axes, jobs, playing, sampling, scene_files
from . import hair as hair_module
from .messages import Cancelled, Mistake

PREVIEW, BAKED = " Preview", " Baked"

# How what is no hair becomes hair.
WAYS_OUT = {
    "CURVE": ": use Object > Convert > Curves",
    "MESH": ": for particle hair, use Convert to Curves in the menu next to the list of Properties > Particles",
}


def chosen(context, name=""):
    """The object of curves that is meant: the one of that name, or the active one, or what its preview is of."""
    thing = context.scene.objects.get(name) if name else context.object
    if thing is None:
        raise Mistake("no object is active: select the hair, an object of curves")
    if thing.type == "CURVES" and thing.nabiki.of is not None:
        thing = thing.nabiki.of
    if thing.type != "CURVES":
        kind = thing.bl_rna.properties["type"].enum_items[thing.type].name.lower()
        raise Mistake(f'"{thing.name}" is a {kind}, but Nabiki needs hair curves (Add > Curve > Empty Hair){WAYS_OUT.get(thing.type, "")}')
    if thing.library is not None or thing.override_library is not None:
        raise Mistake(f'"{thing.name}" belongs to another .blend file: make it local (Object > Relations > Make Local)')
    if context.mode != "OBJECT":
        raise Mistake("an object is in Edit Mode or another mode: return to Object Mode first (Tab)")
    return thing


@contextmanager
def folder():
    """A folder of Blender's own for files that are gone afterwards."""
    made = tempfile.mkdtemp(prefix="nabiki_", dir=bpy.app.tempdir or None)
    try:
        yield made
    finally:
        shutil.rmtree(made, ignore_errors=True)


def sampled(context, thing):
    """The sample of an object, read anew: nobody tells of all that may have changed. Yields how far it is."""
    known = playing.take(thing)
    with playing.Quiet():
        reading = sampling.sample(context, thing)
        while True:
            try:
                done, total = next(reading)
            except StopIteration as ended:
                known.sample = ended.value
                known.films.clear()
                return known.sample
            yield done / total, f"reading frame {done} of {total}"


def film(sample, plain, made, strands, progress):
    """The motion of some strands; on a thread. `strands`: how many, or None for all."""
    scene_files.build(made)
    count = None if strands is None or strands >= len(sample.hair) else strands
    frames = made.scene.simulate(count)
    chosen_strands = np.asarray(frames.ids).astype(np.int64)
    points = np.empty((len(frames), int(frames.offsets[-1]), 3), np.float32)
    for number, frame in enumerate(frames):
        progress(number, len(frames))
        points[number] = axes.as_in_blender(frame.world_points(), plain["facing"], sample.unit_cm)
    return playing.Film(points, chosen_strands, sample.frames, sample.rate, made.notes)


def simulate(context, thing, operator, anew=True):
    """Moves the preview of an object; yields how far it is and returns the motion. `anew`: whether the frames are read again, which
    they need not be where settings alone are another."""
    known = playing.take(thing)
    sample = (yield from sampled(context, thing)) if anew or known.sample is None else known.sample
    plain = scene_files.values(thing.nabiki, sample.frames.start)
    key = playing.key(context.scene, thing)
    found = known.films.get(key)
    if found is None:
        strands, number = thing.nabiki.preview_strands, thing.session_uid
        with folder() as place:
            operator.made = made = scene_files.write(sample, plain, place)
            found = yield from jobs.on_thread(lambda progress: film(sample, plain, made, strands, progress), "moving hair")
        # Undo may have put another in its place.
        thing = next((other for other in context.scene.objects if other.session_uid == number), None)
        if thing is None:
            raise Mistake("the hair was deleted")
    known.keep(key, found)
    if operator.beside and playing.key(context.scene, thing) != key:
        raise Cancelled
    with playing.Quiet():
        preview = put_preview(context, thing, sample, found, operator.beside)
        playing.show(context.scene, thing, preview, found)
    return found


def put_preview(context, thing, sample, found, beside):
    """The object that shows a motion: a copy of its strands, in the place of the hair. The hair itself is never written.
    `beside`: whether no step of Undo follows. Then no data-block may be added or removed: what the steps before it keep would
    point to one that is gone, and Blender ends where they are undone."""
    settings, preview = thing.nabiki, playing.preview_of(context.scene, thing)
    if beside:
        refill(preview, sample, found)
        return preview
    if preview is None:
        preview = bpy.data.objects.new(thing.name + PREVIEW, bpy.data.hair_curves.new(thing.name + PREVIEW))
        for collection in collections_of(context, thing):
            collection.objects.link(preview)
        settings.preview, preview.nabiki.of = preview, thing
    data = hair_module.make(thing.name + PREVIEW, sample.hair, found.strands, sample.hair.smooth)
    put_rest(data, sample, found)
    old, preview.data = preview.data, data
    bpy.data.hair_curves.remove(old)
    preview.location = sample.origin
    baked = settings.baked if settings.baked is not None and settings.baked.nabiki.of == thing else None
    # Of a preview and a bake one is seen, and the other drawn.
    preview.hide_render = baked is not None
    if baked is not None:
        baked.hide_viewport = True
    hide(thing)
    return preview


def refill(preview, sample, found):
    """Other strands for a preview that is there, in its own data-block."""
    if preview is None:
        raise Mistake("the preview was deleted: press Simulate")
    data = preview.data
    if found.fits(data):
        return
    if not hasattr(data, "remove_curves"):  # Blender 4.2
        raise Mistake("the number of strands has changed: press Simulate")
    data.remove_curves()
    hair_module.fill(data, sample.hair, found.strands, sample.hair.smooth)
    put_rest(data, sample, found)


def put_rest(data, sample, found):
    rest = sample.hair.points[sample.hair.points_of(found.strands)]
    attributes.put(data, "nabiki_rest", "FLOAT_VECTOR", "POINT", rest)


def collections_of(context, thing):
    return [c for c in thing.users_collection] or [context.scene.collection]


def hide(thing):
    """Hides the hair, and remembers how it was shown."""
    if not thing.nabiki.shown_before:
        thing.nabiki.shown_before = f"{int(thing.hide_viewport)}{int(thing.hide_render)}"
    thing.hide_viewport = thing.hide_render = True


def clear(context, thing):
    """Takes everything away that was added, and shows the hair as it was. Motions are kept, for Undo."""
    settings = thing.nabiki
    with playing.Quiet(), still_active(context, thing):
        for added in [settings.preview, settings.baked]:
            remove(thing, added)
        settings.preview = settings.baked = None
        if settings.shown_before:
            thing.hide_viewport, thing.hide_render = (figure == "1" for figure in settings.shown_before)
            settings.shown_before = ""


@contextmanager
def still_active(context, thing):
    """Where what is removed meanwhile was active, the hair is active afterwards: panels are those of what is active."""
    objects, settings = context.view_layer.objects, thing.nabiki
    was = objects.active is not None and objects.active in (settings.preview, settings.baked)
    yield
    if was and objects.active is None:
        objects.active = thing
        if not thing.hide_viewport:
            thing.select_set(True)


def remove(thing, added):
    """Removes what was added for an object, with its data and the cache that it reads; not what was added for one that the
    object is a copy of."""
    if added is None or added.nabiki.of != thing:
        return
    data, caches = added.data, [m.cache_file for m in added.modifiers if m.type == "MESH_SEQUENCE_CACHE" and m.cache_file]
    action = added.animation_data.action if added.animation_data else None
    bpy.data.objects.remove(added)
    if data.users == 0:
        bpy.data.hair_curves.remove(data)
    if action is not None and action.users == 0:
        bpy.data.actions.remove(action)
    for cache in caches:
        if cache.users == 0:
            bpy.data.batch_remove([cache])
