# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole moving hair in a file, and the object that reads it."""

from pathlib import Path

import bpy
import numpy as np

from . import hair as hair_module
from . import jobs, meshes, motion, playing, scene_files
from .messages import Mistake

ENDINGS = (".usdc", ".usda", ".abc")

# Bytes of a file at either end.
LOOKED_AT = 1 << 20

# Where the hair is in the files that nabiki writes.
PRIM = {".usdc": "/head/hair", ".usda": "/head/hair", ".abc": "/head/hair"}


def place(thing):
    """Where the cache of an object goes."""
    given = thing.nabiki.cache_path.strip()
    if not any(readable(ending) for ending in ENDINGS):
        way_out = "use Blender from blender.org, or render the preview with all strands"
        raise Mistake(f"this Blender was built without USD and Alembic, so it cannot read baked hair: {way_out}")
    if not given:
        ending = next(ending for ending in ENDINGS if readable(ending))
        given = f"//{bpy.path.clean_name(thing.name)}_nabiki{ending}"
    if given.startswith("//") and not bpy.data.filepath:
        raise Mistake("the .blend file is not saved yet, and the cache goes next to it: save it, or set an absolute path in Nabiki > Cache")
    path = Path(bpy.path.abspath(given))
    if path.suffix.lower() not in ENDINGS:
        raise Mistake(f'"{path.name}" ends in none of {", ".join(ENDINGS)}: rename the cache in Nabiki > Cache')
    if not readable(path.suffix.lower()):
        others = " or ".join(ending for ending in ENDINGS if readable(ending))
        raise Mistake(f'this Blender was built without support for "{path.name}": name a file with {others} in Nabiki > Cache')
    if not path.parent.is_dir():
        raise Mistake(f'there is no folder "{path.parent}": create it, or set another one in Nabiki > Cache')
    if path.is_dir() or (path.exists() and not ours(path)):
        raise Mistake(f'"{path.name}" exists and is not a Nabiki cache: name another file in Nabiki > Cache')
    return given, path


def readable(ending):
    """Whether this Blender reads such files: those that systems package are often built without."""
    return bpy.app.build_options.alembic if ending == ".abc" else bpy.app.build_options.usd


def ours(path):
    """Whether nabiki has written a file: its formats say so near one of their ends."""
    with open(path, "rb") as file:
        found = file.read(LOOKED_AT)
        file.seek(max(0, path.stat().st_size - LOOKED_AT))
        return b"Nabiki" in found or b"Nabiki" in file.read()


def bake(context, thing, operator):
    """Writes all strands and frames, and adds the object that reads them; yields how far it is and returns what to report."""
    given, path = place(thing)
    sample = yield from motion.sampled(context, thing)
    plain = scene_files.values(thing.nabiki, sample.frames.start)
    # It has its name once it is whole and nobody has pressed Esc: until then a cache that is there already is read.
    part = path.with_name(f".{path.stem}_part{path.suffix}")
    try:
        with motion.folder() as folder:
            operator.made = made = scene_files.write(sample, plain, folder)
            made.names[str(part)] = f'"{path.name}"'

            def write(progress):
                scene_files.build(made)
                made.scene.export(part, progress=progress, report=lambda line: None)

            yield from jobs.on_thread(write, "writing hair")
        with playing.Quiet(), motion.still_active(context, thing):
            # A file that Blender reads cannot be replaced everywhere.
            motion.remove(thing, thing.nabiki.baked)
            context.view_layer.update()
            part.replace(path)
            put_baked(context, thing, sample, given, path)
    finally:
        part.unlink(missing_ok=True)
    size = path.stat().st_size / 1e6
    return f"{len(sample.hair)} strands, {len(sample.frames)} frames, {size:.0f} MB: {path}", made.notes


def put_baked(context, thing, sample, given, path):
    """The object that reads the cache."""
    settings = thing.nabiki
    motion.remove(thing, settings.preview)
    settings.baked = settings.preview = None
    name = thing.name + motion.BAKED
    data = hair_module.make(name, sample.hair, np.arange(len(sample.hair)), smooth=False)
    baked = bpy.data.objects.new(name, data)
    for collection in motion.collections_of(context, thing):
        collection.objects.link(baked)
    place_baked(baked, sample, path.suffix.lower())
    cache = open_cache(path)
    cache.filepath = given if given.startswith("//") else str(path)
    cache.frame_offset = sample.frames.start
    cache.velocity_unit = "SECOND"
    modifier = baked.modifiers.new("Nabiki", "MESH_SEQUENCE_CACHE")
    modifier.cache_file, modifier.object_path = cache, PRIM[path.suffix.lower()]
    settings.baked, baked.nabiki.of = baked, thing
    motion.hide(thing)


# Blender takes an Alembic file for one whose y is up, and turns its points about x: this turns them back.
TURNED = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def place_baked(baked, sample, ending):
    """Puts the object where the head is, with a key in each frame where that moves: the file's points are the head's."""
    own = TURNED if ending == ".abc" else np.eye(3)
    baked.rotation_mode = "QUATERNION"
    before = None
    ways = sample.head.ways if sample.head.moves() else sample.head.ways[:1]
    for frame, (turn, shift) in zip(sample.frames, ways, strict=False):
        x, y, z, w = meshes.quaternion(turn @ own)
        now = np.array([w, x, y, z])
        before = now = -now if before is not None and now @ before < 0 else now
        baked.location, baked.rotation_quaternion = sample.origin + shift, now
        if len(ways) > 1:
            baked.keyframe_insert("location", frame=frame, group="Nabiki")
            baked.keyframe_insert("rotation_quaternion", frame=frame, group="Nabiki")
    if len(ways) > 1:
        for curve in curves_of(baked.animation_data):
            for key in curve.keyframe_points:
                key.interpolation = "LINEAR"


def curves_of(animation):
    """The f-curves of an object, wherever this Blender keeps them."""
    if hasattr(animation.action, "fcurves"):
        return list(animation.action.fcurves)
    bags = [bag for layer in animation.action.layers for strip in layer.strips for bag in strip.channelbags]
    return [curve for bag in bags for curve in bag.fcurves]


def open_cache(path):
    before = set(bpy.data.cache_files)
    bpy.ops.cachefile.open(filepath=str(path))
    (cache,) = set(bpy.data.cache_files) - before
    # The operator counts a user of its own, where no menu asked for the file.
    cache.user_clear()
    return cache
