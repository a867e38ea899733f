# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair out of Blender's curves, and curves of Blender out of hair."""

from dataclasses import dataclass, field

import bpy
import numpy as np

from . import attributes
from .messages import Mistake

# Points of a strand that are as near as this are one (cm): a segment needs a direction.
JOINED_CM = 1e-3

# The radius that Cycles draws hair with that has none (Blender's unit).
DRAWN = 0.005

CATMULL_ROM, POLY, BEZIER, NURBS = range(4)


@dataclass
class Hair:
    """Strands at rest, root first, in Blender's axes and unit about the origin of a sample."""

    points: np.ndarray
    offsets: np.ndarray
    radii: np.ndarray
    smooth: bool
    """Whether curves go smoothly through their points (Catmull-Rom), or straight (Poly)."""
    by_point: dict = field(default_factory=dict)
    by_strand: dict = field(default_factory=dict)
    materials: list = field(default_factory=list)
    left_out: int = 0
    """Curves that have no extent."""
    has_radii: bool = True
    """Whether the radii are its own, or what Blender draws hair without any with."""

    def __len__(self):
        return len(self.offsets) - 1

    def points_of(self, strands):
        """The numbers of the points of some strands."""
        counts = np.diff(self.offsets)[strands]
        starts = np.repeat(self.offsets[:-1][strands], counts)
        within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        return starts + within


def read(evaluated, to_world, origin, unit_cm):
    """The hair of an evaluated object of curves. `to_world`: (4, 4); `origin`: the point of the world that becomes 0."""
    name, data = evaluated.name, evaluated.data
    counts = np.empty(len(data.curves), np.int32)
    data.curves.foreach_get("points_length", counts)
    if not len(counts):
        raise Mistake(f'"{name}" has no curves: add hair to it, or pick another object')
    kinds = attributes.values(data.attributes["curve_type"])[:, 0] if "curve_type" in data.attributes else np.zeros(len(counts))
    for kind, called in [(BEZIER, "Bezier"), (NURBS, "NURBS")]:
        if (kinds == kind).any():
            raise Mistake(f'"{name}" has {called} curves: in Edit Mode choose Curves > Set Curve Type > Catmull Rom or Poly')
    cyclic = data.attributes.get("cyclic")
    if cyclic is not None and attributes.values(cyclic).any():
        raise Mistake(f'"{name}" has cyclic curves, but hair needs a root and a tip: in Edit Mode choose Curves > Toggle Cyclic')
    local = attributes.points_of(data).astype(np.float64)
    if not np.isfinite(local).all():
        raise Mistake(f'"{name}" has points with invalid positions (NaN or infinite): undo the change, or delete these curves')
    world = local @ to_world[:3, :3].T + to_world[:3, 3] - origin
    starts = np.cumsum(counts) - counts
    kept = _apart(world * unit_cm, starts)
    strand = np.repeat(np.arange(len(counts)), counts)
    left = np.bincount(strand[kept], minlength=len(counts))
    whole = left >= 2
    kept &= whole[strand]
    if not whole.any():
        raise Mistake(f'"{name}" has only curves of length 0: each needs at least two distinct points')
    offsets = np.concatenate([[0], np.cumsum(left[whole])])
    radii = attributes.values(data.attributes["radius"])[:, 0] if "radius" in data.attributes else np.full(len(world), DRAWN, np.float32)
    # A radius is not turned, so a scaled object scales it by the mean of its axes.
    radii = radii * np.float32(abs(np.linalg.det(to_world[:3, :3])) ** (1 / 3))
    hair = Hair(world[kept].astype(np.float32), offsets, radii[kept], bool((kinds == CATMULL_ROM).all()))
    hair.materials, hair.left_out = [slot.name if slot else None for slot in data.materials], int((~whole).sum())
    hair.has_radii = "radius" in data.attributes
    for attribute in data.attributes:
        if attribute.name in attributes.OWN or attribute.name == "radius" or attribute.name.startswith("."):
            continue
        rows = attributes.values(attribute)
        if rows is None:
            continue
        if attribute.domain == "POINT":
            hair.by_point[attribute.name] = (attribute.data_type, rows[kept])
        elif attribute.domain == "CURVE":
            hair.by_strand[attribute.name] = (attribute.data_type, rows[whole])
    return hair


def _apart(points_cm, starts):
    """Which points are apart from the one before them in their strand; roots always are."""
    apart = np.ones(len(points_cm), bool)
    apart[1:] = np.linalg.norm(np.diff(points_cm, axis=0), axis=1) > JOINED_CM
    apart[starts] = True
    return apart


def make(name, hair, strands, smooth):
    """A data-block of curves with some strands of the hair, with all that they carry."""
    data = bpy.data.hair_curves.new(name)
    fill(data, hair, strands, smooth)
    for material in hair.materials:
        data.materials.append(bpy.data.materials.get(material) if material else None)
    return data


def fill(data, hair, strands, smooth):
    """Puts some strands of the hair into a data-block without curves."""
    points = hair.points_of(strands)
    data.add_curves(np.diff(hair.offsets)[strands].tolist())
    # Blender before 4.5 knows no way for it, and its curves stay smooth.
    if not smooth and hasattr(data, "set_types"):
        data.set_types(type="POLY")
    attributes.put(data, "position", "FLOAT_VECTOR", "POINT", hair.points[points])
    if hair.has_radii:
        attributes.put(data, "radius", "FLOAT", "POINT", hair.radii[points])
    for attribute, (kind, rows) in hair.by_point.items():
        attributes.put(data, attribute, kind, "POINT", rows[points])
    for attribute, (kind, rows) in hair.by_strand.items():
        attributes.put(data, attribute, kind, "CURVE", rows[strands])
