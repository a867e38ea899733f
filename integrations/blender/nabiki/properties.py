# SPDX-License-Identifier: GPL-3.0-or-later
"""What belongs to an object of curves: kept in the .blend file, undone with all else."""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from . import playing
from .declared import EASE, SETTINGS


def changed(self, context):
    """A setting is another: what was computed from the one before is not shown any more."""
    playing.settings_changed(self.id_data)


def declared(key, **ours):
    """What a property of a setting is made with: as the scene declares it, but for what is said here."""
    return {**SETTINGS[key], "update": changed, **ours}


def is_mesh(self, thing):
    return thing.type == "MESH"


class NabikiInterval(bpy.types.PropertyGroup):
    through: IntProperty(
        name="Last Frame", description="The last scene frame in which this wind blows", default=50, min=0, max=1048574, update=changed
    )
    vector: FloatVectorProperty(
        name="Wind",
        description="Direction and strength of the wind along the world axes. 30 is a breeze, 100 a strong wind",
        subtype="XYZ",
        size=3,
        default=(0.0, 0.0, 0.0),
        soft_min=-300.0,
        soft_max=300.0,
        step=100,
        precision=1,
        update=changed,
    )
    solve: BoolProperty(name="Find", description="Whether Find the Wind may change this wind", default=True)


class NabikiRegion(bpy.types.PropertyGroup):
    name: StringProperty(name="Name", description="Name of the region", default="Region", update=changed)
    attribute: StringProperty(
        name="Attribute",
        description="Attribute of the curves with a weight per curve or point: 0 leaves the hair as it is, 1 makes it belong to the region",
        update=changed,
    )
    vertex_group: StringProperty(
        name="Vertex Group",
        description="Vertex group of the head: its weight at the root makes hair belong to the region. With an attribute, the weights multiply",
        update=changed,
    )
    stiffness: FloatProperty(**declared("free.regions.stiffness", description="Factor on the stiffness of its hair"))
    hold: FloatProperty(**declared("free.regions.hold", description="Factor on how firmly its hair returns to its place"))
    settle: FloatProperty(**declared("free.regions.settle", description="Factor on the frames in which its hair settles. At 2, it swings twice as long"))
    wind: FloatProperty(**declared("free.regions.wind", description="Factor on the forces on its hair. At 0, no wind moves it"))
    drag: FloatProperty(**declared("free.regions.drag", description="Factor on how far a moving head leaves its hair behind"))


FACING = [
    ("-y", "-Y", "The face looks along -Y of the world in the first frame, as in Blender's front view"),
    ("+y", "Y", "The face looks along Y of the world in the first frame"),
    ("-x", "-X", "The face looks along -X of the world in the first frame"),
    ("+x", "X", "The face looks along X of the world in the first frame"),
]

SUBSTEPS = SETTINGS["free.substeps"]["description"] + ". 0 uses as many as weight and stiffness need"


class NabikiSettings(bpy.types.PropertyGroup):
    # What takes part.
    head: PointerProperty(
        name="Head",
        description="The mesh that the hair grows on and collides with. If empty, the surface that the curves are attached to",
        type=bpy.types.Object,
        poll=is_mesh,
        update=changed,
    )
    head_group: StringProperty(
        name="Vertex Group",
        description="The part of the mesh that is the head, if the mesh is more than a head. If empty, all of the mesh",
        update=changed,
    )
    head_bone: StringProperty(name="Head Bone", description="The bone that carries the head. If empty, the motion of the mesh counts", update=changed)
    facing: EnumProperty(
        name="Faces", description="The direction in which the face looks in the first frame", items=FACING, default="-y", update=changed
    )
    collision_collection: PointerProperty(
        name="Collision Collection",
        description="Meshes that the hair collides with, in addition to the head. If empty, all meshes with Collision in their Physics tab",
        type=bpy.types.Collection,
        update=changed,
    )
    effector_collection: PointerProperty(
        name="Effector Collection",
        description="The force fields that act on the hair. If empty, all of the scene",
        type=bpy.types.Collection,
        update=changed,
    )
    # Frames.
    use_frame_range: BoolProperty(name="Frame Range", description="Use another frame range than the scene's", default=False, update=changed)
    frame_start: IntProperty(name="Start", description="The frame in which the hair is at rest", default=1, min=0, max=1048574, update=changed)
    frame_end: IntProperty(name="End", description="The last frame of the motion", default=100, min=1, max=1048574, update=changed)
    # Wind.
    intervals: CollectionProperty(type=NabikiInterval)
    active_interval: IntProperty(name="Interval", description="The selected wind", default=0)
    ease: EnumProperty(name="Ease", description=SETTINGS["wind.ease"]["description"], items=EASE, default="smooth", update=changed)
    strength_scale: FloatProperty(
        name="Strength",
        description="Factor on the strengths of Blender's force fields. For hair, 30 is a breeze and 100 a strong wind",
        default=1.0,
        soft_min=0.0,
        soft_max=100.0,
        update=changed,
    )
    use_gust: BoolProperty(name="Gusts", description="Make the wind rise and fall at random", default=False, update=changed)
    gust_intensity: FloatProperty(**declared("gust.intensity", soft_max=0.6))
    gust_time_scale: FloatProperty(**declared("gust.time_scale", min=0.01, soft_max=20.0))
    gust_seed: IntProperty(**declared("gust.seed"))
    use_flow: BoolProperty(name="Flow Around the Head", description="Make the wind flow around the head", default=False, update=changed)
    flow_thickness: FloatProperty(**declared("flow.thickness", name="Hair Thickness (cm)", default=1.5, soft_max=10.0))
    use_body_wind: BoolProperty(name="Wind from Motion", description="Add the wind that a moving head makes", default=False, update=changed)
    body_wind_drag: FloatProperty(**declared("body_wind.drag", soft_max=2.0))
    # How hair answers.
    stiffness: FloatVectorProperty(**declared("free.stiffness", size=2, soft_max=40000.0, step=10000, precision=0))
    hold: FloatProperty(**declared("free.hold", soft_max=300.0))
    settle: FloatProperty(**declared("free.settle", soft_max=120.0))
    gravity: FloatProperty(**declared("free.gravity", soft_max=500.0))
    drag: FloatProperty(**declared("free.drag", soft_max=2.0))
    speed: FloatProperty(
        name="Speed", description="Speed of the hair's motion. 1 looks like slow motion", default=1.6, min=0.01, soft_max=4.0, update=changed
    )
    slow: FloatProperty(**declared("motion.slow", soft_max=10.0))
    # Of nabiki there are none below 1: 0 leaves the number open.
    substeps: IntProperty(**declared("free.substeps", description=SUBSTEPS, default=0, min=0))
    short_hair_length: FloatProperty(**declared("motion.inertia_length_floor", name="Short Hair (cm)", default=14.0, soft_max=60.0))
    # Hair that answers otherwise.
    regions: CollectionProperty(type=NabikiRegion)
    active_region: IntProperty(name="Region", description="The selected region", default=0)
    # Collisions.
    margin: FloatProperty(**declared("contact.margin"))
    friction: FloatProperty(**declared("contact.friction"))
    static_friction: FloatProperty(**declared("contact.static_friction"))
    use_neighbours: BoolProperty(
        name="Hair Against Hair", description="Make strands push their neighbours away and take them along", default=False, update=changed
    )
    pressure: FloatProperty(**declared("neighbours.pressure", soft_max=200.0))
    cohesion: FloatProperty(**declared("neighbours.cohesion", soft_max=200.0))
    # What is shown and written.
    preview_strands: IntProperty(
        name="Strands",
        description="How many strands the preview shows, spread evenly over the head. They move exactly as in the full hair",
        default=300,
        min=1,
        soft_max=20000,
        update=changed,
    )
    cache_path: StringProperty(
        name="File",
        description="The file for the baked hair: .usdc, .usda or .abc. If empty, next to the .blend file",
        subtype="FILE_PATH",
    )
    # What belongs to it in the scene.
    preview: PointerProperty(type=bpy.types.Object)
    baked: PointerProperty(type=bpy.types.Object)
    shown_before: StringProperty()
    of: PointerProperty(type=bpy.types.Object)


CLASSES = [NabikiInterval, NabikiRegion, NabikiSettings]


def register():
    for known in CLASSES:
        bpy.utils.register_class(known)
    bpy.types.Object.nabiki = PointerProperty(type=NabikiSettings)


def unregister():
    del bpy.types.Object.nabiki
    for known in reversed(CLASSES):
        bpy.utils.unregister_class(known)
