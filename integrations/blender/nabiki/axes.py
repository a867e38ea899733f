# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's axes and nabiki's: there x goes where the face looks, y up and z to the right of who looks."""

import numpy as np

FACING = {"+x": (1, 0, 0), "-x": (-1, 0, 0), "+y": (0, 1, 0), "-y": (0, -1, 0)}


def to_nabiki(facing):
    """The matrix (3, 3) that takes directions of Blender's world to nabiki's; it only swaps axes and signs."""
    front, up = np.array(FACING[facing], np.float64), np.array([0.0, 0.0, 1.0])
    return np.array([front, up, np.cross(front, up)])


def as_in_blender(points, facing, unit_cm):
    """Points of nabiki (cm, float32) in Blender's axes and unit, one rounding each."""
    way = to_nabiki(facing)
    found = np.empty(points.shape, np.float32)
    for axis in range(3):
        source = int(np.abs(way[:, axis]).argmax())
        np.multiply(points[..., source], np.float32(way[source, axis]), out=found[..., axis])
    return np.divide(found, np.float32(unit_cm), out=found)
