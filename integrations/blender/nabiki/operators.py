# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons."""

import shutil
from pathlib import Path

import bpy
from bpy_extras.io_utils import ExportHelper

from . import axes, baking, jobs, motion, playing, scene_files, wishing
from .messages import Mistake, sentence


# The wind that is added first, along the axes of nabiki, whose x is where the face looks: between a breeze and a strong wind.
FIRST_WIND = (-60.0, 0.0, 0.0)


class Named:
    """An operator about one object of curves: the active one, unless a name is given."""

    name: bpy.props.StringProperty(name="Hair", description="The curves object. If empty, the active one", options={"SKIP_SAVE", "HIDDEN"})


class NABIKI_OT_simulate(jobs.Working, Named, bpy.types.Operator):
    bl_idname = "nabiki.simulate"
    bl_label = "Simulate"
    bl_description = "Simulate a preview of the active hair in all frames. Scrub the timeline to see it"
    bl_options = {"REGISTER", "UNDO"}

    beside: bpy.props.BoolProperty(options={"SKIP_SAVE", "HIDDEN"})

    def steps(self, context):
        thing = motion.chosen(context, self.name)
        film = yield from motion.simulate(context, thing, self, anew=not self.beside)
        return f"{len(film.strands)} strands, {len(film.frames)} frames", film.notes


class NABIKI_OT_solve(jobs.Working, Named, bpy.types.Operator):
    bl_idname = "nabiki.solve"
    bl_label = "Find the Wind"
    bl_description = "Find the wind that brings the preview's curves to where you moved them in this frame"
    bl_options = {"REGISTER", "UNDO"}

    def steps(self, context):
        return (yield from wishing.solve(context, motion.chosen(context, self.name), self))


class NABIKI_OT_bake(jobs.Working, Named, bpy.types.Operator):
    bl_idname = "nabiki.bake"
    bl_label = "Bake"
    bl_description = "Write all strands and frames to a file, and add an object that reads it, with motion blur"
    bl_options = {"REGISTER", "UNDO"}

    def steps(self, context):
        return (yield from baking.bake(context, motion.chosen(context, self.name), self))


class NABIKI_OT_clear(Named, bpy.types.Operator):
    bl_idname = "nabiki.clear"
    bl_label = "Clear"
    bl_description = "Remove the preview and the baked object, and show the hair again. Files are kept"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        try:
            motion.clear(context, motion.chosen(context, self.name))
        except Mistake as mistake:
            self.report({"ERROR"}, sentence(mistake))
            return {"CANCELLED"}
        return {"FINISHED"}


class OfLists:
    """An operator about the winds or regions of the active hair."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "CURVES"

    def execute(self, context):
        thing = hair_of(context.object)
        with playing.Quiet():
            self.change(context.scene, thing.nabiki)
        playing.settings_changed(thing)
        return {"FINISHED"}


class Remove(OfLists):
    """Removes the selected entry of a list. `entries`, `active`: the settings with the list and with the selected number."""

    @classmethod
    def poll(cls, context):
        return super().poll(context) and len(getattr(hair_of(context.object).nabiki, cls.entries)) > 0

    def change(self, scene, settings):
        entries, active = getattr(settings, self.entries), getattr(settings, self.active)
        entries.remove(active)
        setattr(settings, self.active, max(0, min(active, len(entries) - 1)))


class NABIKI_OT_interval_add(OfLists, bpy.types.Operator):
    bl_idname = "nabiki.interval_add"
    bl_label = "Add Wind"
    bl_description = "Add a wind that starts where the last one ends. The first one blows against the face"

    def change(self, scene, settings):
        before = settings.intervals[-1].through if len(settings.intervals) else max(scene.frame_start, 0)
        interval = settings.intervals.add()
        interval.through = before + 24
        if len(settings.intervals) == 1:
            interval.vector = axes.to_nabiki(settings.facing).T @ FIRST_WIND
        settings.active_interval = len(settings.intervals) - 1


class NABIKI_OT_interval_remove(Remove, bpy.types.Operator):
    bl_idname = "nabiki.interval_remove"
    bl_label = "Remove Wind"
    bl_description = "Remove the selected wind"
    entries, active = "intervals", "active_interval"


class NABIKI_OT_region_add(OfLists, bpy.types.Operator):
    bl_idname = "nabiki.region_add"
    bl_label = "Add Region"
    bl_description = "Add hair that moves differently from the rest, such as a fringe that stays"

    def change(self, scene, settings):
        region = settings.regions.add()
        region.name = f"Region {len(settings.regions)}"
        settings.active_region = len(settings.regions) - 1


class NABIKI_OT_region_remove(Remove, bpy.types.Operator):
    bl_idname = "nabiki.region_remove"
    bl_label = "Remove Region"
    bl_description = "Remove the selected region"
    entries, active = "regions", "active_region"


class NABIKI_OT_write_scene(jobs.Working, Named, ExportHelper, bpy.types.Operator):
    bl_idname = "nabiki.write_scene"
    bl_label = "Write Scene"
    bl_description = "Write hair, head, bodies and wind as a Nabiki scene, for the command line, a render farm or the studio"
    bl_options = {"REGISTER"}

    filename_ext = ".toml"
    filter_glob: bpy.props.StringProperty(default="*.toml", options={"HIDDEN"})

    def invoke(self, context, event):
        return ExportHelper.invoke(self, context, event)

    def steps(self, context):
        thing = motion.chosen(context, self.name)
        path = Path(bpy.path.abspath(self.filepath))
        if path.suffix != ".toml" or not path.parent.is_dir():
            raise Mistake(f'"{path.name}" cannot hold a scene: name a .toml file in an existing folder')
        folder = path.with_suffix("")
        if folder.exists() and not folder.is_dir():
            raise Mistake(f'"{folder.name}" is a file, but the scene needs a folder of that name: choose another name for the scene')
        sample = yield from motion.sampled(context, thing)
        plain = scene_files.values(thing.nabiki, sample.frames.start)
        with motion.folder() as place:
            self.made = made = scene_files.write(sample, plain, place)
            yield from jobs.on_thread(lambda progress: scene_files.build(made), "checking the scene")
            # Only what is right gets its place, and is named from there.
            shutil.copytree(place, folder, dirs_exist_ok=True)
            text = made.scene.to_toml().replace(f"{Path(place).as_posix()}/", f"{folder.name}/")
            path.write_text(text, encoding="utf-8")
        return f"wrote {path}", made.notes


def hair_of(thing):
    return thing.nabiki.of or thing


CLASSES = [NABIKI_OT_simulate, NABIKI_OT_solve, NABIKI_OT_bake, NABIKI_OT_clear, NABIKI_OT_interval_add, NABIKI_OT_interval_remove]
CLASSES += [NABIKI_OT_region_add, NABIKI_OT_region_remove, NABIKI_OT_write_scene]

register, unregister = bpy.utils.register_classes_factory(CLASSES)
