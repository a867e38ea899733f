# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels: settings in the Physics tab of the hair, buttons in the sidebar of the 3D Viewport as well."""

import textwrap

import bpy

from . import playing
from .messages import sentence
from .operators import hair_of


# Pixels of a letter on the average, and of what is beside a line of text, at a resolution scale of 1; letters of the shortest line.
LETTER, BORDERS, LEAST = 5.7, 64, 20


def of(context):
    """The object of curves that is active, or that the active preview is of."""
    thing = context.object
    return hair_of(thing) if thing is not None and thing.type == "CURVES" else None


def columns(layout):
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


def film_of(context, thing):
    """The motion that is shown of an object, or None."""
    preview = playing.preview_of(context.scene, thing)
    return playing.shown_film(context.scene, thing, preview) if preview is not None else None


def buttons(layout, context, thing):
    """What is pressed, and how far it is: as high at any time, so that nothing below moves away from under the mouse."""
    state, settings = context.window_manager.nabiki, thing.nabiki
    busy = bool(state.text)
    column = layout.column(align=True)
    if busy:
        column.progress(factor=state.part, text=state.text)
    else:
        column.operator("nabiki.simulate", icon="PLAY")
    column.prop(settings, "preview_strands")
    column = layout.column(align=True)
    column.enabled = not busy
    row = column.row()
    row.enabled = settings.preview is not None
    row.operator("nabiki.solve", icon="FORCE_WIND")
    column.operator("nabiki.bake", icon="FILE_CACHE")
    row = column.row()
    row.enabled = settings.preview is not None or settings.baked is not None
    row.operator("nabiki.clear", icon="TRASH")
    if busy:
        layout.label(text="Esc cancels", icon="INFO")
    else:
        said, icon = standing(context, thing)
        layout.label(text=said, icon=icon)


def standing(context, thing):
    """In a few words what is shown of an object, and an icon."""
    settings, film = thing.nabiki, film_of(context, thing)
    if film is not None:
        return f"{len(film.strands)} strands, {len(film.frames)} frames", "INFO" if film.notes else "CHECKMARK"
    if settings.preview is not None:
        return "At rest: press Simulate", "INFO"
    return ("Baked", "CHECKMARK") if settings.baked is not None else ("Not simulated yet", "INFO")


def notes(layout, context, thing):
    """What was not carried over, or done otherwise than it was set, in lines as wide as the panel."""
    film = film_of(context, thing)
    region = context.region
    across = region.width / context.preferences.system.ui_scale if region is not None else 0
    column = layout.column(align=True)
    for note in film.notes if film is not None else []:
        for number, line in enumerate(textwrap.wrap(note, max(LEAST, int((across - BORDERS) / LETTER)))):
            column.label(text=line if number else sentence(line), icon="BLANK1" if number else "DOT")


class Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "physics"

    @classmethod
    def poll(cls, context):
        return of(context) is not None


class NABIKI_PT_main(Panel, bpy.types.Panel):
    bl_label = "Nabiki"

    def draw(self, context):
        thing = of(context)
        settings, layout = thing.nabiki, columns(self.layout)
        buttons(layout, context, thing)
        column = layout.column()
        column.prop(settings, "head")
        head = settings.head or thing.data.surface
        if head is not None and settings.head is None:
            column.label(text=f"Surface: {head.name}")
        if head is not None and head.type == "MESH":
            column.prop_search(settings, "head_group", head, "vertex_groups")
            armature = head.find_armature()
            if armature is not None:
                column.prop_search(settings, "head_bone", armature.data, "bones")
        column.prop(settings, "facing")


class Part(Panel):
    bl_parent_id = "NABIKI_PT_main"
    bl_options = {"DEFAULT_CLOSED"}


class NABIKI_UL_intervals(bpy.types.UIList):
    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index=0, flt_flag=0):
        before = data.intervals[index - 1].through if index else context.scene.frame_start
        row = layout.split(factor=0.38)
        row.label(text=f"{before} to {item.through}")
        row.label(text=", ".join(str(round(part)) for part in item.vector))
        layout.prop(item, "solve", text="", icon="FORCE_WIND" if item.solve else "LOCKED", emboss=False)


class NABIKI_PT_wind(Panel, bpy.types.Panel):
    bl_label = "Wind"
    bl_parent_id = "NABIKI_PT_main"

    def draw(self, context):
        settings, layout = of(context).nabiki, columns(self.layout)
        row = layout.row()
        row.template_list("NABIKI_UL_intervals", "", settings, "intervals", settings, "active_interval", rows=3)
        column = row.column(align=True)
        column.operator("nabiki.interval_add", text="", icon="ADD")
        column.operator("nabiki.interval_remove", text="", icon="REMOVE")
        if 0 <= settings.active_interval < len(settings.intervals):
            interval = settings.intervals[settings.active_interval]
            column = layout.column()
            column.prop(interval, "through")
            column.prop(interval, "vector")
            column.prop(interval, "solve")
        layout.prop(settings, "ease")


class NABIKI_PT_fields(Part, bpy.types.Panel):
    bl_label = "Force Fields"
    bl_parent_id = "NABIKI_PT_wind"

    def draw(self, context):
        settings, layout = of(context).nabiki, columns(self.layout)
        layout.prop(settings, "effector_collection")
        layout.prop(settings, "strength_scale")


def switched(name, label, switch, *shown):
    """A panel with a switch in its header."""

    def draw_header(self, context):
        self.layout.prop(of(context).nabiki, switch, text="")

    def draw(self, context):
        settings, layout = of(context).nabiki, columns(self.layout)
        layout.active = getattr(settings, switch)
        for property_name in shown:
            layout.prop(settings, property_name)

    members = {"bl_label": label, "bl_parent_id": "NABIKI_PT_wind", "draw_header": draw_header, "draw": draw}
    return type(name, (Part, bpy.types.Panel), members)


NABIKI_PT_gusts = switched("NABIKI_PT_gusts", "Gusts", "use_gust", "gust_intensity", "gust_time_scale", "gust_seed")
NABIKI_PT_flow = switched("NABIKI_PT_flow", "Flow Around the Head", "use_flow", "flow_thickness")
NABIKI_PT_body_wind = switched("NABIKI_PT_body_wind", "Wind from Motion", "use_body_wind", "body_wind_drag")


class NABIKI_PT_settings(Part, bpy.types.Panel):
    bl_label = "Settings"

    def draw(self, context):
        settings, layout = of(context).nabiki, columns(self.layout)
        column = layout.column(align=True)
        column.prop(settings, "stiffness", index=0, text="Stiffness Root")
        column.prop(settings, "stiffness", index=1, text="Tip")
        column = layout.column()
        for name in ["hold", "settle", "gravity", "drag", "speed", "slow", "substeps", "short_hair_length"]:
            column.prop(settings, name)
        layout.prop(settings, "use_frame_range")
        column = layout.column(align=True)
        column.active = settings.use_frame_range
        column.prop(settings, "frame_start")
        column.prop(settings, "frame_end")


class NABIKI_UL_regions(bpy.types.UIList):
    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index=0, flt_flag=0):
        layout.prop(item, "name", text="", emboss=False, icon="CURVES")
        layout.label(text=", ".join(word for word in [item.attribute, item.vertex_group] if word))


class NABIKI_PT_regions(Part, bpy.types.Panel):
    bl_label = "Regions"

    def draw(self, context):
        thing = of(context)
        settings, layout = thing.nabiki, columns(self.layout)
        row = layout.row()
        row.template_list("NABIKI_UL_regions", "", settings, "regions", settings, "active_region", rows=3)
        column = row.column(align=True)
        column.operator("nabiki.region_add", text="", icon="ADD")
        column.operator("nabiki.region_remove", text="", icon="REMOVE")
        if not 0 <= settings.active_region < len(settings.regions):
            return
        region, head = settings.regions[settings.active_region], settings.head or thing.data.surface
        column = layout.column()
        # The attributes that modifiers add are not listed, so a name may be typed.
        column.prop(region, "attribute")
        if head is not None and head.type == "MESH":
            column.prop_search(region, "vertex_group", head, "vertex_groups")
        column = layout.column()
        for name in ["stiffness", "hold", "settle", "wind", "drag"]:
            column.prop(region, name)


class NABIKI_PT_collisions(Part, bpy.types.Panel):
    bl_label = "Collisions"

    def draw(self, context):
        settings, layout = of(context).nabiki, columns(self.layout)
        layout.prop(settings, "collision_collection")
        column = layout.column()
        for name in ["margin", "friction", "static_friction"]:
            column.prop(settings, name)
        layout.prop(settings, "use_neighbours")
        column = layout.column()
        column.active = settings.use_neighbours
        column.prop(settings, "pressure")
        column.prop(settings, "cohesion")


class NABIKI_PT_cache(Part, bpy.types.Panel):
    bl_label = "Cache"

    def draw(self, context):
        settings, layout = of(context).nabiki, columns(self.layout)
        layout.prop(settings, "cache_path")
        layout.operator("nabiki.bake", icon="FILE_CACHE")
        layout.operator("nabiki.write_scene", icon="EXPORT")


class NABIKI_PT_notes(Panel, bpy.types.Panel):
    bl_label = "Notes"
    bl_parent_id = "NABIKI_PT_main"

    @classmethod
    def poll(cls, context):
        film = film_of(context, of(context)) if of(context) is not None else None
        return film is not None and bool(film.notes)

    def draw(self, context):
        notes(self.layout, context, of(context))


class NABIKI_PT_sidebar(bpy.types.Panel):
    bl_label = "Nabiki"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Animation"

    @classmethod
    def poll(cls, context):
        return of(context) is not None

    def draw(self, context):
        buttons(columns(self.layout), context, of(context))
        notes(self.layout, context, of(context))


CLASSES = [NABIKI_UL_intervals, NABIKI_PT_main, NABIKI_PT_wind, NABIKI_PT_fields, NABIKI_PT_gusts, NABIKI_PT_flow, NABIKI_PT_body_wind]
CLASSES += [NABIKI_UL_regions, NABIKI_PT_settings, NABIKI_PT_regions, NABIKI_PT_collisions, NABIKI_PT_cache, NABIKI_PT_notes, NABIKI_PT_sidebar]

register, unregister = bpy.utils.register_classes_factory(CLASSES)
