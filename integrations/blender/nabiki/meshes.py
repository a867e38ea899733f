# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of Blender as arrays, and how rigid things go through the frames."""

import numpy as np
from mathutils.bvhtree import BVHTree

from .messages import Mistake

# Modifiers that bend a mesh from frame to frame.
BENDING = {"ARMATURE", "CAST", "CLOTH", "CURVE", "DISPLACE", "HOOK", "LAPLACIANDEFORM", "LATTICE", "MESH_CACHE", "MESH_DEFORM"}
BENDING |= {"MESH_SEQUENCE_CACHE", "NODES", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH", "SOFT_BODY", "SURFACE_DEFORM", "WARP", "WAVE"}

# How far columns may be from a turn, as a number of their own size: matrices of Blender have 32 bits.
RIGID = 1e-4


def matrix(of):
    return np.array(of, np.float64)


def bends(thing):
    """Whether the mesh of an object may bend from frame to frame."""
    keys = thing.data.shape_keys
    return any(m.type in BENDING and m.show_viewport for m in thing.modifiers) or (keys is not None and keys.animation_data is not None)


def vertices(evaluated):
    """The vertices of an evaluated mesh, in the object's own space."""
    mesh = evaluated.data
    found = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", found)
    return found.reshape(-1, 3).astype(np.float64)


def corners(evaluated):
    """The triangles of an evaluated mesh, by the numbers of its vertices."""
    mesh = evaluated.data
    mesh.calc_loop_triangles()
    found = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("vertices", found)
    return found.reshape(-1, 3)


def triangles(evaluated, what, group=""):
    """The vertices (in the object's space) and triangles of an evaluated mesh; of a vertex group alone, if one is named."""
    mesh = evaluated.data
    points, faces = vertices(evaluated), corners(evaluated)
    if group:
        number = group_number(evaluated, what, group)
        within = np.array([any(g.group == number and g.weight > 0.5 for g in v.groups) for v in mesh.vertices], bool)
        faces = faces[within[faces].all(1)]
    if not len(faces):
        raise Mistake(f'{what} "{evaluated.name}" has no faces: pick a mesh with a surface')
    used, faces = np.unique(faces, return_inverse=True)
    return points[used], faces.reshape(-1, 3)


def group_weights(evaluated, what, group):
    """The weight of each vertex of an evaluated mesh in a vertex group."""
    number = group_number(evaluated, what, group)
    return np.array([next((g.weight for g in v.groups if g.group == number), 0.0) for v in evaluated.data.vertices], np.float64)


def group_number(evaluated, what, group):
    if group not in evaluated.vertex_groups:
        raise Mistake(f'{what} "{evaluated.name}" has no vertex group "{group}": pick one that it has, or none')
    return evaluated.vertex_groups[group].index


def nearest(points, faces, places):
    """The points of triangles that are nearest to some places: the three corners of each, and their shares, which add up to 1."""
    skin = BVHTree.FromPolygons(points.tolist(), faces.tolist())
    hits = [skin.find_nearest(place) for place in places.tolist()]
    at, corners = np.array([hit[0] for hit in hits]), faces[[hit[2] for hit in hits]]
    a, b, c = (points[corners[:, i]] for i in range(3))
    # Each corner has the share of the area that is across from it.
    across = np.stack([np.cross(c - b, at - b), np.cross(a - c, at - c), np.cross(b - a, at - a)], 1)
    normal = np.cross(b - a, c - a)
    shares = np.einsum("nij,nj->ni", across, normal).clip(0)
    return corners, shares / shares.sum(1, keepdims=True).clip(np.finfo(np.float64).tiny)


def placed(points, faces, to_world, origin):
    """The same in the world about `origin`; a mirrored object keeps its outside outside."""
    world = points @ to_world[:3, :3].T + to_world[:3, 3] - origin
    return world, faces[:, ::-1] if np.linalg.det(to_world[:3, :3]) < 0 else faces


def rigid(first, now, origin, what):
    """The way from the place of frame one to that of another, about `origin`: (rotation, shift), or a mistake."""
    if (first == now).all():
        return np.eye(3), np.zeros(3)
    if abs(np.linalg.det(first[:3, :3])) < 1e-18:
        raise Mistake(f"{what} has a scale of 0: give it a size")
    way = now @ np.linalg.inv(first)
    turn = nearest_turn(way[:3, :3])
    if np.abs(turn - way[:3, :3]).max() > RIGID:
        raise Mistake(f"{what} changes its size or shape over time, but Nabiki needs rigid motion: remove the keyframes of its scale")
    return turn, way[:3, :3] @ origin + way[:3, 3] - origin


def nearest_turn(of):
    u, _, v = np.linalg.svd(of)
    return u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v


def fitted(first, now):
    """The rigid way that takes some points nearest to others (W. Kabsch, 1976), and how far they stay apart (root mean square)."""
    middle, there = first.mean(0), now.mean(0)
    turn = nearest_turn((now - there).T @ (first - middle))
    left = (first - middle) @ turn.T + there - now
    return turn, there - turn @ middle, float(np.sqrt((left**2).sum(1).mean()))


def quaternion(turn):
    """(x, y, z, w) of a rotation matrix."""
    m = turn
    way = np.array([1 + m[0, 0] - m[1, 1] - m[2, 2], 1 - m[0, 0] + m[1, 1] - m[2, 2], 1 - m[0, 0] - m[1, 1] + m[2, 2], 1 + np.trace(m)])
    most = int(way.argmax())
    rows = [
        [way[0], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
        [m[0, 1] + m[1, 0], way[1], m[1, 2] + m[2, 1], m[0, 2] - m[2, 0]],
        [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], way[2], m[1, 0] - m[0, 1]],
        [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], way[3]],
    ]
    found = np.array(rows[most])
    return found / np.linalg.norm(found)
