"""Scenes that are made in Blender, as a user makes them."""

import struct

import bpy
import numpy as np

# Of the hair that is made: strands, points of each, length and radius of the head in metres.
STRANDS, POINTS, LENGTH, RADIUS = 160, 12, 0.16, 0.095
PLACE = np.array([0.3, -0.2, 1.6])


def empty(frames=30, rate=24):
    """A new file."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, frames
    scene.render.fps, scene.render.fps_base = rate, 1.0
    scene.frame_set(1)
    return scene


def linked(name, data, location=(0, 0, 0)):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    thing.location = location
    return thing


def ball(name, radius, location):
    """A closed mesh of triangles."""
    import bmesh

    mesh = bpy.data.meshes.new(name)
    form = bmesh.new()
    bmesh.ops.create_icosphere(form, subdivisions=4, radius=radius)
    form.to_mesh(mesh)
    form.free()
    return linked(name, mesh, location)


def curves(name, points, offsets, kind="POLY"):
    """An object of curves."""
    data = bpy.data.hair_curves.new(name)
    if len(offsets) == 1:  # Blender ends where no curves are added.
        return linked(name, data)
    data.add_curves(np.diff(offsets).tolist())
    data.attributes["position"].data.foreach_set("vector", np.float32(points).ravel())
    radii = np.linspace(4e-4, 1e-4, len(points), dtype=np.float32)
    (data.attributes.get("radius") or data.attributes.new("radius", "FLOAT", "POINT")).data.foreach_set("value", radii)
    thing = linked(name, data)
    if hasattr(data, "set_types"):
        data.set_types(type=kind)
    else:  # Blender 4.2, where a type that is only written as an attribute is the end of it
        active(thing)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.curves.select_all(action="SELECT")
        bpy.ops.curves.curve_type_set(type=kind)
        bpy.ops.object.mode_set(mode="OBJECT")
    return thing


def strands(seed=1):
    """Hair that stands on the upper half of a head about the origin and bends down: points and offsets."""
    random = np.random.default_rng(seed)
    height = random.uniform(0.15, 0.98, STRANDS)
    round_ = random.uniform(0, 2 * np.pi, STRANDS)
    flat = np.sqrt(1 - height**2)
    out = np.stack([flat * np.cos(round_), flat * np.sin(round_), height], 1)
    part = np.linspace(0, 1, POINTS)
    length = LENGTH * random.uniform(0.8, 1.0, STRANDS)
    way = out[:, None] * part[:, None] * length[:, None, None]
    fall = 0.35 * (length[:, None] * part**2)[..., None] * np.array([0, 0, -1])
    points = RADIUS * 1.001 * out[:, None] + way + fall
    return np.float32(points.reshape(-1, 3)), np.arange(STRANDS + 1) * POINTS


def groom(frames=30, kind="POLY", moving=True):
    """A head with hair, a head that turns, a keyframed wind and a ball that comes by."""
    scene = empty(frames)
    head = ball("Head", RADIUS, PLACE)
    points, offsets = strands()
    hair = curves("Hair", points, offsets, kind)
    hair.location = PLACE
    hair.nabiki.head = head
    if moving:
        for frame, angle, shift in [(1, 0.0, 0.0), (frames // 2, 0.5, 0.03), (frames, -0.3, -0.01)]:
            for thing in [head, hair]:
                thing.rotation_euler = (0.2 * angle, 0, angle)
                thing.location = PLACE + [0, shift, shift]
                thing.keyframe_insert("rotation_euler", frame=frame)
                thing.keyframe_insert("location", frame=frame)
        obstacle = ball("Ball", 0.05, (0, 0, 0))
        obstacle.modifiers.new("Collision", "COLLISION")
        for frame, x in [(1, 0.35), (frames, 0.12)]:
            obstacle.location = PLACE + [x, 0, 0.02]
            obstacle.keyframe_insert("location", frame=frame)
    active(hair)
    scene.frame_set(1)
    return hair


def wind(strength=60.0, keys=(), rotation=(1.2, 0, 0.4)):
    """A Wind, as Add > Force Field adds it, with keyframes (frame, strength)."""
    bpy.ops.object.effector_add(type="WIND")
    thing = bpy.context.object
    thing.name, thing.rotation_euler = "Wind", rotation
    thing.field.strength = strength
    for frame, value in keys:
        thing.field.strength = value
        thing.keyframe_insert("field.strength", frame=frame)
    return thing


def active(thing):
    for other in bpy.context.view_layer.objects:
        other.select_set(other == thing)
    bpy.context.view_layer.objects.active = thing


def interval(hair, through, vector):
    found = hair.nabiki.intervals.add()
    found.through, found.vector = through, vector
    return found


def evaluated(thing, frame, subframe=0.0):
    """World points of an object of curves in a frame, and its evaluated data."""
    bpy.context.scene.frame_set(frame, subframe=subframe)
    graph = bpy.context.evaluated_depsgraph_get()
    found = thing.evaluated_get(graph)
    world = np.array(found.matrix_world, np.float64)
    return positions(found.data) @ world[:3, :3].T + world[:3, 3], found.data


def positions(data):
    points = np.empty(3 * len(data.points), np.float32)
    data.attributes["position"].data.foreach_get("vector", points)
    return points.reshape(-1, 3)


def vectors(data, name):
    found = np.empty(3 * len(data.points), np.float32)
    data.attributes[name].data.foreach_get("vector", found)
    return found.reshape(-1, 3)


def tfx(path):
    """Points and offsets of a TressFX 4 file."""
    raw = path.read_bytes()
    _, count, each, at = struct.unpack_from("<fIII", raw)
    points = np.frombuffer(raw, "<f4", 4 * count * each, at).reshape(-1, 4)[:, :3]
    return points, np.arange(count + 1) * each


def vector(of):
    from mathutils import Vector

    return Vector(of)


def turned(rotation):
    """The z axis of an object with this rotation."""
    from mathutils import Euler

    return Euler(rotation).to_matrix().col[2]
