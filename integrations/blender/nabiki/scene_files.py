# SPDX-License-Identifier: GPL-3.0-or-later
"""A sample of Blender as a scene of nabiki: the files that it names, and its settings."""

import struct
from dataclasses import dataclass
from pathlib import Path

import nabiki
import numpy as np

from . import axes, fields, meshes
from .messages import Mistake, in_words


@dataclass
class Made:
    """A scene of nabiki."""

    scene: object
    names: dict
    """What its files hold, by their paths, and what its entries of lists are called, by their keys."""
    notes: list
    box: tuple = ()
    """The least and the largest corner of the head (head space, cm)."""


def values(settings, start):
    """The settings of a panel as plain values, since nothing of Blender may be asked from a thread. `start`: the first frame."""
    plain = {name: getattr(settings, name) for name in PLAIN}
    plain["stiffness"] = tuple(settings.stiffness)
    plain["intervals"] = [(interval.through - start, tuple(interval.vector), interval.solve) for interval in settings.intervals]
    plain["regions"] = [(region.name, {factor: getattr(region, factor) for factor in FACTORS}) for region in settings.regions]
    return plain


# What a region multiplies.
FACTORS = ["stiffness", "hold", "settle", "wind", "drag"]
PLAIN = ["facing", "strength_scale", "ease", "use_gust", "gust_intensity", "gust_time_scale", "gust_seed", "use_flow", "flow_thickness"]
PLAIN += ["use_body_wind", "body_wind_drag", "hold", "settle", "gravity", "drag", "speed", "slow", "substeps", "short_hair_length"]
PLAIN += ["margin", "friction", "static_friction", "use_neighbours", "pressure", "cohesion"]


def write(sample, plain, folder, apart=()):
    """Writes the files of a sample into `folder` and makes the scene about them.

    `apart`: winds that are not added to the intervals, since these are to be found.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    made = Made(None, {}, list(sample.notes))
    space = {"unit": sample.unit_cm, "up": "+z", "facing": plain["facing"], "origin": (0.0, 0.0, 0.0)}
    count = len(sample.frames) - 1

    def named(file, name):
        made.names[file.as_posix()] = name
        return file.as_posix()

    def track(body, file):
        if body.bends():
            file = file.with_suffix(".pc2")
            _write_points(file, body.bent)
            return {"file": file.as_posix()}
        _write_track(file, body.ways, sample.unit_cm, sample.rate)
        return {"file": file.as_posix(), "up": "+z", "facing": plain["facing"]}

    weights = {f"region_{number}": of for number, of in enumerate(sample.regions) if of is not None}
    head, hair = folder / "head.ply", folder / ("hair.usda" if weights else "hair.hair")
    _write_mesh(head, sample.head)
    if weights:
        _write_weighted_hair(hair, sample.hair, weights)
    else:
        _write_hair(hair, sample.hair)
    corners = sample.head.points @ axes.to_nabiki(plain["facing"]).T * sample.unit_cm
    made.box = corners.min(0), corners.max(0)
    settings = {"head": {"mesh": named(head, f'the head "{sample.head.name}"'), **space}}
    if sample.head.moves():
        settings["head"]["motion"] = track(sample.head, folder / "head.csv")
    # Frames come back in the order of Blender's points, whichever end lies on the skin.
    settings["hair"] = {"file": named(hair, "the hair"), "root": "first", "join_within": 0.0, **space}
    bodies = []
    for number, body in enumerate(sample.bodies):
        file = folder / f"body_{number}.ply"
        _write_mesh(file, body)
        made.names[f"body[{number}]"] = f'the body "{body.name}"'
        bodies.append({"mesh": named(file, f'the body "{body.name}"'), **space})
        bodies[-1] |= {name: plain[name] for name in ["margin", "friction", "static_friction"]}
        if body.moves():
            bodies[-1]["motion"] = track(body, folder / f"body_{number}.csv")
    if bodies:
        settings["body"] = bodies
    settings["motion"] = {"form": "free", "frames": count, "frame_rate": sample.rate, "time_step": 0.1 * plain["speed"]}
    settings["motion"] |= {"slow": plain["slow"], "inertia_length_floor": plain["short_hair_length"]}
    settings["free"] = {name: plain[name] for name in ["hold", "settle", "gravity", "drag"]}
    if plain["substeps"]:
        settings["free"]["substeps"] = plain["substeps"]
    settings["free"]["stiffness"] = plain["stiffness"]
    regions = []
    for number, (name, factors) in enumerate(plain["regions"]):
        if f"region_{number}" in weights:
            made.names[f"free.regions[{len(regions)}]"] = f'the region "{name}"'
            regions.append({"name": name, "attribute": f"region_{number}", **factors})
        else:
            made.notes.append(f'the region "{name}" is not used: it has neither an attribute nor a vertex group')
    if regions:
        settings["free"]["regions"] = regions
    settings["contact"] = {name: plain[name] for name in ["margin", "friction", "static_friction"]}
    if plain["use_neighbours"]:
        settings["neighbours"] = {"pressure": plain["pressure"], "cohesion": plain["cohesion"]}
    found, notes, names = _wind(sample, plain, count, apart)
    made.notes += notes
    made.names |= names
    made.scene = nabiki.Scene(**settings, **found)
    return made


def _wind(sample, plain, count, apart):
    """The tables of the wind, what is said of it, and what its entries are called."""
    way = axes.to_nabiki(plain["facing"])
    scale = plain["strength_scale"]
    found, notes, names = fields.settings(sample.effectors, way, sample.origin, sample.unit_cm, scale)
    intervals = in_order([(last, way @ np.array(vector)) for last, vector, _ in plain["intervals"]])
    winds = [e for e in sample.effectors if e.kind == "WIND" and e.cone is None and e not in apart and e.strengths().any()]
    if winds:
        forces = fields.eased(intervals, count, plain["ease"])
        forces = forces + sum(fields.uniform(wind, way, scale) for wind in winds)
        found["force"] = [{"through": last, "vector": vector} for last, vector in fields.runs(forces)]
        for number, force in enumerate(found["force"]):
            names[f"force[{number}]"] = f"the wind up to frame {sample.frames.start + force['through']}"
    elif intervals:
        found["force"] = [{"through": last, "vector": tuple(map(float, vector))} for last, vector in intervals]
        found["wind"] = {"ease": plain["ease"]}
        names |= {f"force[{number}]": f"Wind > Interval {number + 1}" for number in range(len(intervals))}
    noise = max((wind.noise for wind in winds), default=0.0)
    if plain["use_gust"]:
        found["gust"] = {"intensity": plain["gust_intensity"], "time_scale": plain["gust_time_scale"], "seed": plain["gust_seed"]}
    elif noise > 0:
        strongest = max(winds, key=lambda wind: wind.noise)
        found["gust"] = {"intensity": min(noise, 1.0), "seed": abs(strongest.seed)}
    if plain["use_flow"]:
        found["flow"] = {"thickness": plain["flow_thickness"]}
    if plain["use_body_wind"]:
        found["body_wind"] = {"drag": plain["body_wind_drag"]}
    return found, notes, names


def in_order(intervals):
    """The intervals as they are, unless one ends before it begins."""
    last = 0
    for number, (through, _) in enumerate(intervals, 1):
        if through <= last:
            before = "the first frame" if number == 1 else f"interval {number - 1} does"
            raise Mistake(f"Wind > Interval {number} ends before {before}: set its last frame later, or remove it")
        last = through
    return intervals


def build(made):
    """Reads and checks all that the scene names. A head without a skull gets an ellipsoid about it."""
    try:
        return made.scene.simulate()
    except nabiki.Error as refused:
        if "skull" not in str(refused) and "ellipsoid" not in str(refused):
            raise
    low, high = made.box
    half = 0.5 * (high - low)
    # As `nabiki new` draws it; what is flat is then refused for what it is.
    made.scene["head.ellipsoid"] = {"center": (0.5 * (low + high)).tolist(), "half_axes": np.maximum(half, half.max() / 3).tolist()}
    made.notes.append("no skull was found in the head: the wind flows around its bounding box")
    return made.scene.simulate()


def line(error, made):
    """What nabiki refuses, in the words of the panels."""
    return in_words(error, made.names if made else {})


def _write_mesh(file, body):
    """A binary .ply of triangles."""
    faces = np.empty(len(body.faces), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, body.faces
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(body.points)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    file.write_bytes(header.encode() + body.points.astype("<f4").tobytes() + faces.tobytes())


def _write_hair(file, hair):
    """A .hair file with segments and diameters."""
    segments = np.diff(hair.offsets) - 1
    if segments.max() > 65535:
        raise Mistake(f"a curve has {segments.max() + 1} points, but hair has at most 65536: use fewer points")
    header = struct.pack("<4sIIIIfffff88s", b"HAIR", len(segments), len(hair.points), 1 | 2 | 4, 0, 0, 0, 0, 0, 0, b"")
    thickness = (2 * hair.radii).astype("<f4")
    file.write_bytes(header + segments.astype("<u2").tobytes() + hair.points.astype("<f4").tobytes() + thickness.tobytes())


def _write_weighted_hair(file, hair, weights):
    """A .usda layer with curves, diameters and a number per strand for each region. `weights`: arrays by their names."""

    def row(values):
        return "[" + ", ".join(np.char.mod("%.9g", np.asarray(values, np.float32)).tolist()) + "]"

    counts = np.diff(hair.offsets)
    points = np.char.mod("%.9g", hair.points.astype(np.float32)).tolist()
    text = ["#usda 1.0", 'def BasisCurves "hair"', "{", '    uniform token type = "linear"']
    text += [f"    int[] curveVertexCounts = {counts.tolist()}"]
    text += ["    point3f[] points = [" + ", ".join(f"({x}, {y}, {z})" for x, y, z in points) + "]"]
    text += [f'    float[] widths = {row(2 * hair.radii)} ( interpolation = "vertex" )']
    text += [f'    float[] primvars:{name} = {row(of)} ( interpolation = "uniform" )' for name, of in weights.items()]
    file.write_text("\n".join([*text, "}", ""]), encoding="ascii")


def _write_points(file, frames):
    """A point cache, PC2: the points of a mesh in every frame."""
    header = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(frames[0]), 0.0, 1.0, len(frames))
    file.write_bytes(header + b"".join(points.astype("<f4").tobytes() for points in frames))


def _write_track(file, ways, unit_cm, rate):
    """The way of something rigid, a row a frame."""
    rows, before = ["t_s,px_m,py_m,pz_m,qx,qy,qz,qw"], None
    for frame, (turn, shift) in enumerate(ways):
        turned = meshes.quaternion(turn)
        if before is not None and turned @ before < 0:
            turned = -turned
        before = turned
        numbers = [frame / rate, *(shift * unit_cm / 100), *turned]
        rows.append(",".join(repr(float(number)) for number in numbers))
    file.write_text("\n".join(rows) + "\n")
