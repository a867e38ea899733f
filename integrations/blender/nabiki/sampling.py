# SPDX-License-Identifier: GPL-3.0-or-later
"""What decides a motion, read from Blender frame by frame."""

import zlib
from dataclasses import dataclass, field

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from . import attributes, fields, meshes
from . import hair as hair_module
from .messages import Mistake

# Roots by which it is judged whether hair grows on a head, and the part of the head's size from which on they float.
JUDGED, AFLOAT = 600, 0.15


@dataclass
class Body:
    """Something that hair keeps out of."""

    name: str
    points: np.ndarray
    faces: np.ndarray
    matrices: list
    ways: list
    """(rotation, shift) in each frame, about the origin of the sample, from where it is in the first."""
    shape: int
    """A number for its mesh, as it is in its own space."""
    bent: list = None
    """Its points in each frame, about the origin of the sample; None for what keeps its shape."""

    def moves(self):
        return self.bends() or any((turn != np.eye(3)).any() or shift.any() for turn, shift in self.ways)

    def bends(self):
        return self.bent is not None and any((points != self.bent[0]).any() for points in self.bent)


@dataclass
class Sample:
    """A scene of Blender over some frames, in its own axes and unit about `origin`."""

    frames: range
    rate: float
    unit_cm: float
    origin: np.ndarray
    hair: hair_module.Hair
    head: Body
    bodies: list
    effectors: list
    digest: int
    notes: list = field(default_factory=list)
    regions: list = field(default_factory=list)
    """How much each strand belongs to each region, or None for a region without weights."""


def check_enabled(layer, thing):
    """Refuses what Blender does not evaluate, and what would therefore seem to stand still. The eye alone leaves it evaluated."""
    if thing.hide_viewport or not within(layer.layer_collection, thing):
        raise Mistake(f'"{thing.name}" is disabled in the viewport, directly or by its collection: enable it (the eye icon may stay off)')


def within(collection, thing):
    """Whether an object lies in a collection of a view layer, or in one below it, that is enabled."""
    if collection.exclude or collection.collection.hide_viewport:
        return False
    return thing.name in collection.collection.objects or any(within(child, thing) for child in collection.children)


def head_of(thing):
    """The head mesh of an object of curves: the one that is picked, or the surface that it is attached to."""
    head = thing.nabiki.head or thing.data.surface
    if head is None:
        raise Mistake(f'"{thing.name}" has no head: pick the mesh that it grows on in Nabiki > Head')
    if head.type != "MESH":
        raise Mistake(f'the head "{head.name}" is not a mesh: pick the mesh that the hair grows on')
    return head


def colliders(scene, thing):
    """The objects that hair keeps out of: those of the collection, or else all with Collision."""
    settings, head = thing.nabiki, head_of(thing)
    group = settings.collision_collection
    found = []
    for other in group.all_objects if group else scene.objects:
        if other == head or other.type != "MESH" or other.hide_viewport:
            continue
        if group or any(m.type == "COLLISION" for m in other.modifiers):
            found.append(other)
    return sorted(found, key=lambda other: other.name)


def effectors(scene, thing):
    """The objects with a force field: those of the collection, or else all."""
    group = thing.nabiki.effector_collection
    found = [other for other in (group.all_objects if group else scene.objects) if not other.hide_viewport]
    found = [other for other in found if other.field is not None and other.field.type != "NONE"]
    return sorted(found, key=lambda other: other.name)


def digest(scene, thing):
    """A number for all that decides a sample and does not change from frame to frame by itself: rest, meshes, who takes part."""
    settings = thing.nabiki
    head = head_of(thing)
    parts = [settings.head_group, settings.head_bone, str(frame_range(scene, settings)), str(rate(scene)), str(unit(scene))]
    for other in [head, *colliders(scene, thing)]:
        raw = np.empty(3 * len(other.data.vertices), np.float32)
        other.data.vertices.foreach_get("co", raw)
        parts += [other.name, raw]
    for other in effectors(scene, thing):
        parts += [other.name, other.field.type]
    # Hidden hair is not evaluated, so that nothing tells of its modifiers; what is within a node group is read at the next press.
    for modifier in thing.modifiers:
        parts += [repr(plain(modifier)), repr(inputs(modifier))]
    curves = np.empty(len(thing.data.curves), np.int32)
    thing.data.curves.foreach_get("points_length", curves)
    parts += [thing.name, curves, attributes.points_of(thing.data)]
    # Weights of vertices are read at the next press: one by one, they would be too slow for each frame that is shown.
    for region in settings.regions:
        parts += [region.attribute, region.vertex_group]
        painted = thing.data.attributes.get(region.attribute) if region.attribute else None
        rows = attributes.values(painted) if painted is not None else None
        if rows is not None:
            parts.append(rows)
    found = 0
    for part in parts:
        found = zlib.crc32(part.encode() if isinstance(part, str) else np.ascontiguousarray(part), found)
    return found


def inputs(modifier):
    """What a node group of a modifier is given."""
    try:
        return sorted((name, str(value)) for name, value in modifier.items())
    except TypeError:  # From Blender 5.2 on they have types of their own.
        given = getattr(getattr(modifier, "properties", None), "inputs", None)
        names = [p.identifier for p in given.bl_rna.properties if p.identifier != "rna_type"] if given else []
        found = [(name, getattr(given, name, None)) for name in names]
        return [(name, plain(value) if hasattr(value, "bl_rna") else str(value)) for name, value in found]


def plain(block):
    """The plain values of something of Blender's."""
    kinds = {"BOOLEAN", "INT", "FLOAT", "STRING", "ENUM"}
    known = [
        p.identifier for p in block.bl_rna.properties if p.type in kinds and p.identifier not in {"is_active", "execution_time", "show_expanded"}
    ]
    return [(name, str(getattr(block, name))) for name in known]


def frame_range(scene, settings):
    """First and last frame."""
    if settings.use_frame_range:
        return settings.frame_start, settings.frame_end
    return scene.frame_start, scene.frame_end


def rate(scene):
    return scene.render.fps / scene.render.fps_base


def unit(scene):
    """Centimetres of Blender's unit."""
    return 100.0 * scene.unit_settings.scale_length


def carrier(thing, head):
    """What carries the head: (object, name of a bone or nothing)."""
    bone = thing.nabiki.head_bone
    if not bone:
        return head, ""
    armature = head.find_armature() or (head.parent if head.parent and head.parent.type == "ARMATURE" else None)
    if armature is None:
        raise Mistake(f'the head "{head.name}" has no armature, but Nabiki > Head Bone is "{bone}": clear it')
    if bone not in armature.pose.bones:
        raise Mistake(f'the armature "{armature.name}" has no bone "{bone}": pick one that it has in Nabiki > Head Bone')
    return armature, bone


def carried(evaluated, bone):
    world = meshes.matrix(evaluated.matrix_world)
    return world @ meshes.matrix(evaluated.pose.bones[bone].matrix) if bone else world


def sample(context, thing):
    """Goes through the frames, yields (done, all) for each, and returns a Sample. The frame is where it was afterwards."""
    scene, settings = context.scene, thing.nabiki
    first, last = frame_range(scene, settings)
    if last <= first:
        raise Mistake(f"the frame range is {first} to {last}, but motion needs at least two frames: set a later end")
    head = head_of(thing)
    frames, was = range(first, last + 1), (scene.frame_current, scene.frame_subframe)
    hidden = thing.hide_viewport
    thing.hide_viewport = False
    try:
        graph = context.evaluated_depsgraph_get()
        for frame in frames:
            scene.frame_set(frame)
            graph.update()
            if frame == first:
                reader = Reader(scene, context.view_layer, thing, head, graph)
            else:
                reader.go_on(graph)
            yield frame - first + 1, len(frames)
    finally:
        thing.hide_viewport = hidden
        scene.frame_set(was[0], subframe=was[1])
    return reader.sample(frames)


class Reader:
    """A scene of Blender that is being read."""

    def __init__(self, scene, layer, thing, head, graph):
        self.scene, self.layer, self.thing, self.head = scene, layer, thing, head
        self.digest = digest(scene, thing)
        self.notes = []
        group = thing.nabiki.head_group
        self.carrier, self.bone = carrier(thing, head)
        for needed in [thing, head, self.carrier]:
            check_enabled(layer, needed)
        evaluated = head.evaluated_get(graph)
        to_world = meshes.matrix(evaluated.matrix_world)
        points, faces = meshes.triangles(evaluated, "the head", group)
        corners = points @ to_world[:3, :3].T + to_world[:3, 3]
        # Numbers near 0 keep the most digits, wherever in the world the head is.
        self.origin = np.round(0.5 * (corners.min(0) + corners.max(0)), 3)
        self.bent = not self.bone and meshes.bends(head)
        start = carried(self.carrier.evaluated_get(graph), self.bone)
        placed = meshes.placed(points, faces, to_world, self.origin)
        self.head_body = Body(head.name, *placed, [start], [(np.eye(3), np.zeros(3))], shape_of(points, faces))
        if self.bent:
            self.head_body.bent = [self.head_body.points.astype(np.float32)]
        own = thing.evaluated_get(graph)
        self.hair = hair_module.read(own, meshes.matrix(own.matrix_world), self.origin, unit(scene))
        if self.hair.left_out:
            self.notes.append(f"{self.hair.left_out} curves of length 0 are left out")
        self._check_roots()
        self.regions = self._weights(thing.nabiki.regions, evaluated, to_world)
        self.colliders = colliders(scene, thing)
        self.bodies = [self._body(other, graph) for other in self.colliders]
        self.fields, self.effectors = [], []
        for other in effectors(scene, thing):
            kind = other.field.type
            check_enabled(layer, other)
            if kind in fields.KNOWN:
                self.fields.append(other)
                evaluated = other.evaluated_get(graph)
                self.effectors.append(fields.Effector.of(evaluated, fields.Now.of(evaluated)))
            else:
                self.notes.append(f'"{other.name}" is not used: Nabiki has no {fields.UNKNOWN.get(kind, kind)}')

    def _check_roots(self):
        """Hair that does not grow on its head is another's, or somewhere else by mistake."""
        points, faces = self.head_body.points, self.head_body.faces
        skin = BVHTree.FromPolygons(points.tolist(), faces.tolist())
        roots = self.hair.points[self.hair.offsets[:-1]]
        off = float(np.median([skin.find_nearest(root)[3] for root in roots[:: max(1, len(roots) // JUDGED)].tolist()]))
        size = 0.5 * np.median(np.ptp(points, axis=0))
        cm = off * unit(self.scene)
        if off > size:
            way_out = "pick the mesh that it grows on in Nabiki > Head, or move the hair to it"
            raise Mistake(f'the roots of "{self.thing.name}" are {cm:.3g} cm from the head "{self.head.name}": {way_out}')
        if off > AFLOAT * size:
            self.notes.append(f'the roots are {cm:.2g} cm from the skin of "{self.head.name}"')

    def _weights(self, regions, evaluated, to_world):
        """How much each strand belongs to each region, or None for a region without weights."""
        roots, corners = self.hair.offsets[:-1], None
        if any(region.vertex_group for region in regions):
            skin = meshes.placed(meshes.vertices(evaluated), meshes.corners(evaluated), to_world, self.origin)
            corners, shares = meshes.nearest(*skin, self.hair.points[roots].astype(np.float64))
        found = []
        for region in regions:
            weights = self._painted(region, roots) if region.attribute else None
            if region.vertex_group:
                of_vertices = meshes.group_weights(evaluated, "the head", region.vertex_group)
                of_group = (of_vertices[corners] * shares).sum(1)
                weights = of_group if weights is None else weights * of_group
            found.append(weights)
        return found

    def _painted(self, region, roots):
        """The number at each root of a region's attribute."""
        name = region.attribute
        by_strand = name in self.hair.by_strand
        _, rows = (self.hair.by_strand if by_strand else self.hair.by_point).get(name, (None, None))
        if rows is None or rows.shape[1] != 1:
            of = "attribute with one number per curve or point"
            raise Mistake(f'"{self.thing.name}" has no {of} "{name}": correct it in Nabiki > Regions > {region.name}')
        return rows[:, 0] if by_strand else rows[roots, 0]

    def _body(self, other, graph):
        check_enabled(self.layer, other)
        evaluated = other.evaluated_get(graph)
        to_world = meshes.matrix(evaluated.matrix_world)
        points, faces = meshes.triangles(evaluated, "the body")
        placed = meshes.placed(points, faces, to_world, self.origin)
        body = Body(other.name, *placed, [to_world], [(np.eye(3), np.zeros(3))], shape_of(points, faces))
        if meshes.bends(other):
            body.bent = [body.points.astype(np.float32)]
        return body

    def _bend(self, body, other, graph, what, group=""):
        """Adds the shape of a mesh that bends, and the rigid way that fits it best."""
        evaluated = other.evaluated_get(graph)
        points, faces = meshes.triangles(evaluated, what, group)
        placed, faces = meshes.placed(points, faces, meshes.matrix(evaluated.matrix_world), self.origin)
        if len(placed) != len(body.points) or (faces != body.faces).any():
            frame = self.scene.frame_current
            way_out = "remove the modifier that changes them" + (", or set a bone in Nabiki > Head Bone" if body is self.head_body else "")
            raise Mistake(f'{what} "{other.name}" has other faces in frame {frame} than in the first: {way_out}')
        body.bent.append(placed.astype(np.float32))
        same = (body.bent[-1] == body.bent[0]).all()
        body.ways.append((np.eye(3), np.zeros(3)) if same else meshes.fitted(body.points, placed)[:2])

    def go_on(self, graph):
        """Reads one more frame."""
        body = self.head_body
        now = carried(self.carrier.evaluated_get(graph), self.bone)
        body.matrices.append(now)
        if self.bent:
            self._bend(body, self.head, graph, "the head", self.thing.nabiki.head_group)
        else:
            body.ways.append(meshes.rigid(body.matrices[0], now, self.origin, f'the head "{self.head.name}"'))
        for other, body in zip(self.colliders, self.bodies, strict=True):
            now = meshes.matrix(other.evaluated_get(graph).matrix_world)
            body.matrices.append(now)
            if body.bent is not None:
                self._bend(body, other, graph, "the body")
            else:
                body.ways.append(meshes.rigid(body.matrices[0], now, self.origin, f'the body "{other.name}"'))
        for other, effector in zip(self.fields, self.effectors, strict=True):
            effector.frames.append(fields.Now.of(other.evaluated_get(graph)))

    def sample(self, frames):
        return Sample(
            frames,
            rate(self.scene),
            unit(self.scene),
            self.origin,
            self.hair,
            self.head_body,
            self.bodies,
            self.effectors,
            self.digest,
            self.notes,
            self.regions,
        )


def shape_of(points, faces):
    return zlib.crc32(faces.astype(np.int32).tobytes(), zlib.crc32(points.tobytes()))


def still_shaped(sample, thing, graph, touched):
    """Whether meshes that may have changed, by their numbers, are what they were. What bends is taken for changed."""
    try:
        things = [head_of(thing), *(bpy.data.objects[body.name] for body in sample.bodies)]
        for other, body in zip(things, [sample.head, *sample.bodies], strict=True):
            if not {other.session_uid, other.data.session_uid} & touched:
                continue
            group = thing.nabiki.head_group if body is sample.head else ""
            if meshes.bends(other) or shape_of(*meshes.triangles(other.evaluated_get(graph), "the mesh", group)) != body.shape:
                return False
    except (Mistake, KeyError):
        return False
    return True


def still_as_sampled(sample, thing, graph, frame):
    """Whether what moves by itself is, in one frame, where it was when it was sampled."""
    if frame not in sample.frames:
        return True
    at = frame - sample.frames.start
    try:
        carried_by, bone = carrier(thing, head_of(thing))
        if (carried(carried_by.evaluated_get(graph), bone) != sample.head.matrices[at]).any():
            return False
        for body in sample.bodies:
            if (meshes.matrix(bpy.data.objects[body.name].evaluated_get(graph).matrix_world) != body.matrices[at]).any():
                return False
        return all(fields.Now.of(bpy.data.objects[e.name].evaluated_get(graph)) == e.frames[at] for e in sample.effectors)
    except (Mistake, KeyError):
        return False
