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


def changed(self, context):
    """A setting is another: what was computed from the one before is not shown any more."""
    playing.settings_changed(self.id_data)


def is_mesh(self, thing):
    return thing.type == "MESH"


class NabikiInterval(bpy.types.PropertyGroup):
    through: IntProperty(
        name="Last Frame", description="The last frame of the scene in which this wind blows", default=50, min=0, max=1048574, update=changed
    )
    vector: FloatVectorProperty(
        name="Wind",
        description="Where the wind pushes, along the axes of the world. 30 is a breeze, 100 a strong wind",
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


FACING = [
    ("-y", "-Y", "The face looks along -Y of the world in the first frame, as in Blender's front view"),
    ("+y", "Y", "The face looks along Y of the world in the first frame"),
    ("-x", "-X", "The face looks along -X of the world in the first frame"),
    ("+x", "X", "The face looks along X of the world in the first frame"),
]

EASE = [
    ("smooth", "Smooth", "Each wind is reached in the middle of its interval, as with bezier keyframes"),
    ("linear", "Linear", "Each wind is reached in the middle of its interval, on straight lines"),
    ("stepped", "Constant", "Each wind blows unchanged up to its last frame"),
]


class NabikiSettings(bpy.types.PropertyGroup):
    # What takes part.
    head: PointerProperty(
        name="Head",
        description="The mesh that the hair grows on and keeps out of. Without one, the surface that the curves are attached to",
        type=bpy.types.Object,
        poll=is_mesh,
        update=changed,
    )
    head_group: StringProperty(
        name="Vertex Group", description="The part of the mesh that is the head, where it is more than a head. All of it if empty", update=changed
    )
    head_bone: StringProperty(name="Head Bone", description="The bone that carries the head. Without one, the mesh tells", update=changed)
    facing: EnumProperty(name="Faces", description="Where the face looks in the first frame", items=FACING, default="-y", update=changed)
    collision_collection: PointerProperty(
        name="Collision Collection",
        description="Meshes that hair keeps out of, besides the head. Without one, all that have Collision in their Physics tab",
        type=bpy.types.Collection,
        update=changed,
    )
    effector_collection: PointerProperty(
        name="Effector Collection",
        description="Force fields that are felt. Without one, all of the scene",
        type=bpy.types.Collection,
        update=changed,
    )
    # Frames.
    use_frame_range: BoolProperty(name="Frame Range", description="Use other frames than those of the scene", default=False, update=changed)
    frame_start: IntProperty(name="Start", description="The frame in which the hair is at rest", default=1, min=0, max=1048574, update=changed)
    frame_end: IntProperty(name="End", description="The last frame of the motion", default=100, min=1, max=1048574, update=changed)
    # Wind.
    intervals: CollectionProperty(type=NabikiInterval)
    active_interval: IntProperty(name="Interval", description="The interval that is shown", default=0)
    ease: EnumProperty(name="Ease", description="How one wind follows another", items=EASE, default="smooth", update=changed)
    strength_scale: FloatProperty(
        name="Strength",
        description="What the strengths of Blender's force fields are multiplied by. 30 is a breeze for hair, 100 a strong wind",
        default=1.0,
        soft_min=0.0,
        soft_max=100.0,
        update=changed,
    )
    use_gust: BoolProperty(name="Gusts", description="Let the wind rise and fall at random", default=False, update=changed)
    gust_intensity: FloatProperty(
        name="Intensity",
        description="How much the wind changes: 0.15 as in open country, 0.4 as in a town",
        default=0.3,
        min=0.0,
        soft_max=0.6,
        update=changed,
    )
    gust_time_scale: FloatProperty(
        name="Time Scale", description="How long a gust takes, in seconds", default=2.0, min=0.01, soft_max=20.0, update=changed
    )
    gust_seed: IntProperty(name="Seed", description="Another number for other gusts", default=1, min=0, update=changed)
    use_flow: BoolProperty(name="Flow Round the Head", description="Lead the wind round the head", default=False, update=changed)
    flow_thickness: FloatProperty(
        name="Hair Thickness (cm)",
        description="How far the hair on the head stands out, in centimetres: the wind goes round that, too",
        default=1.5,
        min=0.0,
        soft_max=10.0,
        update=changed,
    )
    use_body_wind: BoolProperty(name="Wind of the Motion", description="Let a head that moves make wind", default=False, update=changed)
    body_wind_drag: FloatProperty(
        name="Drag", description="The wind's strength for each centimetre a second", default=0.3, min=0.0, soft_max=2.0, update=changed
    )
    # How hair answers.
    stiffness: FloatVectorProperty(
        name="Stiffness",
        description="How firmly hair keeps its shape, at the root and at the tip. Where it is 36 times the wind, hair bends within 6 cm",
        size=2,
        default=(12000.0, 1000.0),
        min=0.0,
        soft_max=40000.0,
        step=10000,
        precision=0,
        update=changed,
    )
    adapt_stiffness: BoolProperty(
        name="Adapt to Hair",
        description="Lower the stiffness to what the shortest segments of this hair can be moved with",
        default=True,
        update=changed,
    )
    hold: FloatProperty(
        name="Hold",
        description="How firmly hair keeps its place on the head, as with hair spray",
        default=30.0,
        min=0.0,
        soft_max=300.0,
        update=changed,
    )
    settle: FloatProperty(
        name="Settle",
        description="Frames in which a swing dies down: 7 is wet hair, 20 swings over once, 60 goes on waving, 0 never ends",
        default=20.0,
        min=0.0,
        soft_max=120.0,
        update=changed,
    )
    gravity: FloatProperty(
        name="Weight",
        description="How heavy hair is that has been moved, and how much a jolt of the head is felt",
        default=100.0,
        min=0.0,
        soft_max=500.0,
        update=changed,
    )
    lag: FloatProperty(
        name="Lag", description="How far tips fall behind a head that turns: 0 not at all", default=1.0, min=0.0, soft_max=4.0, update=changed
    )
    speed: FloatProperty(
        name="Speed", description="How fast all of it goes: 1 is hair in slow motion", default=1.6, min=0.01, soft_max=4.0, update=changed
    )
    short_hair_length: FloatProperty(
        name="Short Hair (cm)",
        description="Hair shorter than this, in centimetres, moves as hair of this length: it is held by the longer hair beside it",
        default=14.0,
        min=0.0,
        soft_max=60.0,
        update=changed,
    )
    # Collisions.
    margin: FloatProperty(
        name="Margin (cm)", description="How far from skin and bodies hair is kept, in centimetres", default=0.1, min=0.0, max=5.0, update=changed
    )
    friction: FloatProperty(
        name="Friction", description="How much hair is slowed that slides over skin and bodies", default=0.1, min=0.0, max=10.0, update=changed
    )
    static_friction: FloatProperty(
        name="Static Friction", description="The same for hair that does not slide yet", default=0.15, min=0.0, max=10.0, update=changed
    )
    use_neighbours: BoolProperty(
        name="Hair Against Hair", description="Let strands push away and take along those beside them", default=False, update=changed
    )
    pressure: FloatProperty(
        name="Pressure", description="How firmly the hair keeps its volume", default=40.0, min=0.0, soft_max=200.0, update=changed
    )
    cohesion: FloatProperty(
        name="Cohesion", description="How firmly strands take along those beside them", default=40.0, min=0.0, soft_max=200.0, update=changed
    )
    # What is shown and written.
    preview_strands: IntProperty(
        name="Strands",
        description="How many strands the preview moves, spread evenly over the head. They move as they do among all",
        default=300,
        min=1,
        soft_max=20000,
        update=changed,
    )
    cache_path: StringProperty(
        name="File",
        description="Where the whole moving hair is written: .usdc, .usda or .abc. Empty: beside the .blend file",
        subtype="FILE_PATH",
    )
    # What belongs to it in the scene.
    preview: PointerProperty(type=bpy.types.Object)
    baked: PointerProperty(type=bpy.types.Object)
    shown_before: StringProperty()
    of: PointerProperty(type=bpy.types.Object)


CLASSES = [NabikiInterval, NabikiSettings]


def register():
    for known in CLASSES:
        bpy.utils.register_class(known)
    bpy.types.Object.nabiki = PointerProperty(type=NabikiSettings)


def unregister():
    del bpy.types.Object.nabiki
    for known in reversed(CLASSES):
        bpy.utils.unregister_class(known)
