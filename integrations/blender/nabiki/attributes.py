# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of curves as arrays, and back."""

import numpy as np

# What an attribute of a type is read by: the name of its values, how many there are, their type.
KINDS = {
    "FLOAT": ("value", 1, np.float32),
    "INT": ("value", 1, np.int32),
    "INT8": ("value", 1, np.int32),
    "BOOLEAN": ("value", 1, bool),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color", 4, np.float32),
    "QUATERNION": ("value", 4, np.float32),
}

# What curves have by themselves, or what only other types of curves need.
OWN = {"position", "curve_type", "velocity", "cyclic", "resolution", "handle_left", "handle_right", "handle_type_left", "handle_type_right"}
OWN |= {"nurbs_order", "nurbs_weight", "knots_mode", "normal_mode"}


def values(attribute):
    """The values of an attribute, one row an element; nothing for a type that cannot be read so."""
    kind = KINDS.get(attribute.data_type)
    if kind is None:
        return None
    name, width, number = kind
    found = np.empty(len(attribute.data) * width, number)
    attribute.data.foreach_get(name, found)
    return found.reshape(-1, width)


def points_of(data):
    """The positions of curves: (points, 3) float32."""
    attribute = data.attributes.get("position")
    return np.empty((0, 3), np.float32) if attribute is None else values(attribute)


def put(data, name, kind, domain, rows):
    """Gives curves an attribute, or new values to one that they have."""
    attribute = data.attributes.get(name) or data.attributes.new(name, kind, domain)
    value, _, number = KINDS[kind]
    attribute.data.foreach_set(value, np.ascontiguousarray(rows, number).ravel())


def moved(data):
    """Tells Blender that the points of curves are elsewhere. Bounds and evaluated lines, by which it culls, draws Edit Mode and feeds
    modifiers, are kept from before when positions alone are written; a curve that is given as many points as it has renews them."""
    if len(data.curves) and hasattr(data, "resize_curves"):  # Blender 4.2 has none
        data.resize_curves([data.curves[0].points_length], indices=[0])
    data.update_tag()
