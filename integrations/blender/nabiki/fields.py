# SPDX-License-Identifier: GPL-3.0-or-later
"""Force fields of Blender as fields of nabiki, by the table of docs/fields.md."""

from dataclasses import dataclass

import numpy as np

# What pushes in Blender and has nothing here that does the same.
UNKNOWN = {
    "BOID": "Boid",
    "CHARGE": "Charge",
    "DRAG": "Drag (to calm the hair, use Settings > Settle)",
    "FLUID_FLOW": "Fluid Flow",
    "GUIDE": "Curve Guide",
    "HARMONIC": "Harmonic",
    "LENNARDJ": "Lennard-Jones",
    "MAGNET": "Magnetic",
    "TEXTURE": "Texture",
}

KNOWN = {"WIND", "FORCE", "VORTEX", "TURBULENCE"}


@dataclass(frozen=True)
class Now:
    """A force field in one frame."""

    strength: float
    matrix: tuple
    shape: tuple
    """What else decides the force."""

    @classmethod
    def of(cls, evaluated):
        field = evaluated.field
        names = ["flow", "noise", "seed", "size", "falloff_type", "falloff_power", "use_max_distance", "distance_max", "z_direction"]
        names += ["radial_max", "use_radial_max", "inflow"]
        matrix = tuple(tuple(row) for row in evaluated.matrix_world)
        return cls(field.strength, matrix, tuple(getattr(field, name, None) for name in names))

    @property
    def axis(self):
        """The object's z axis, along which it blows."""
        axis = np.array([row[2] for row in self.matrix[:3]], np.float64)
        return axis / max(np.linalg.norm(axis), 1e-12)

    @property
    def place(self):
        return np.array([row[3] for row in self.matrix[:3]], np.float64)


@dataclass
class Effector:
    """A force field through the frames."""

    name: str
    kind: str
    falloff: dict
    noise: float
    seed: int
    size: float
    cone: float | None
    """Degrees between the axis and the edge of a cone; None without one."""
    notes: list
    frames: list

    @classmethod
    def of(cls, thing, now):
        field = thing.field
        falloff, notes = _falloff(field)
        cone = None
        if field.type in {"WIND", "FORCE"} and field.falloff_type == "CONE":
            cone = min(max(field.radial_max, 1.0), 90.0) if field.use_radial_max else 90.0
        if field.type == "WIND" and cone is None and (field.falloff_power or field.use_max_distance):
            notes.append("blows equally everywhere: Nabiki uses its falloff only with a cone")
        if field.type == "VORTEX" and field.inflow:
            notes.append("its inflow is not used")
        if field.type == "TURBULENCE" and (field.falloff_power or field.use_max_distance):
            notes.append("swirls equally everywhere: its falloff is not used")
        if field.type in {"FORCE", "VORTEX"} and field.noise:
            notes.append("its noise is not used")
        return cls(thing.name, field.type, falloff, field.noise, field.seed, field.size, cone, notes, [now])

    def strengths(self):
        return np.array([now.strength for now in self.frames])

    def moves(self):
        return any(now.matrix != self.frames[0].matrix for now in self.frames)


def _falloff(field):
    """The falloff of a force field, radius in Blender's unit."""
    if field.use_max_distance:
        notes = ["it falls smoothly to 0 at Max Distance, instead of by its falloff power"] if field.falloff_power else []
        return {"law": "smooth", "radius": max(field.distance_max, 1e-3)}, notes
    if not field.falloff_power:
        return {"law": "none", "radius": 1.0}, []
    if field.falloff_power < 1.5:
        return {"law": "inverse", "radius": 1.0}, []
    return {"law": "inverse_square", "radius": 1.0}, []


def uniform(effector, way, scale):
    """The force of a wind in each frame after the first: (frames, 3), nabiki's axes."""
    return np.array([scale * now.strength * (way @ now.axis) for now in effector.frames[1:]]).reshape(-1, 3)


def eased(intervals, count, ease):
    """The force of intervals (last frame, vector) in frames 1 to `count`: (count, 3), as nabiki lets them follow one another."""
    forces = np.zeros((count, 3))
    if not intervals:
        return forces
    ends = [last for last, _ in intervals]
    vectors = np.array([vector for _, vector in intervals], np.float64)
    frames = np.arange(1, count + 1)
    if ease == "stepped":
        return vectors[np.minimum(np.searchsorted(ends, frames), len(ends) - 1)]
    middles = np.array([(before + 1 + last) / 2 for before, last in zip([0, *ends[:-1]], ends, strict=True)])
    after = np.clip(np.searchsorted(middles, frames, side="right"), 1, max(len(ends) - 1, 1))
    if len(ends) == 1:
        return np.repeat(vectors, count, 0)
    part = np.clip((frames - middles[after - 1]) / (middles[after] - middles[after - 1]), 0, 1)
    part = part * part * (3 - 2 * part) if ease == "smooth" else part
    return vectors[after - 1] + part[:, None] * (vectors[after] - vectors[after - 1])


def runs(forces):
    """Forces of each frame from 1 on as the fewest intervals: (last frame, vector) each."""
    if not len(forces):
        return []
    last = [*np.flatnonzero((np.diff(forces, axis=0) != 0).any(1)) + 1, len(forces)]
    return [(int(n), tuple(float(x) for x in forces[n - 1])) for n in last]


def envelope(strengths):
    """The largest strength, and the parts of it over the frames where they are not all 1."""
    most = strengths[int(np.abs(strengths).argmax())]
    if most == 0 or (strengths == most).all():
        return float(most), []
    parts = strengths / most
    # A key where the parts turn from one straight line to another.
    bend = np.ones(len(parts), bool)
    bend[1:-1] = np.abs(np.diff(parts, 2)) > 1e-9
    return float(most), [{"frame": int(n), "factor": float(parts[n])} for n in np.flatnonzero(bend)]


def settings(effectors, way, origin, unit_cm, scale):
    """Tables of nabiki for force fields, but for uniform winds, a line for each thing that is not carried over, and what the
    entries are called, by their keys.

    `way`: Blender's directions in nabiki's axes; `origin`: the point of Blender's world that is nabiki's 0.
    """
    tables, notes, names = {"point": [], "vortex": [], "fan": []}, [], {}
    swirls = []
    for effector in effectors:
        notes += [f'"{effector.name}": {note}' for note in effector.notes]
        first = effector.frames[0]
        most, keys = envelope(scale * effector.strengths())
        if most == 0:
            continue
        place = (way @ (first.place - origin) * unit_cm).tolist()
        axis = (way @ first.axis).tolist()
        falloff = {**effector.falloff, "radius": effector.falloff["radius"] * unit_cm}
        common = {"strength": most, "envelope": keys, "falloff": falloff}
        if effector.kind == "TURBULENCE":
            size = effector.size * unit_cm if effector.size > 0 else 10.0
            swirls.append((abs(most), effector, {"strength": abs(most), "swirl_size": size, "seed": abs(effector.seed), "envelope": keys}))
            continue
        if effector.kind == "WIND" and effector.cone is None:
            continue
        if effector.moves():
            notes.append(f'"{effector.name}": moves: Nabiki uses its place in the first frame (only a Wind may turn)')
        if effector.cone is not None:
            name, entry = "fan", {"position": place, "direction": axis, "spread": effector.cone, **common}
        elif effector.kind == "FORCE":
            name, entry = "point", {"position": place, **common}
        else:
            name, entry = "vortex", {"position": place, "axis": axis, **common}
        names[f"{name}[{len(tables[name])}]"] = f'the force field "{effector.name}"'
        tables[name].append(entry)
    if swirls:
        strongest = max(swirls, key=lambda swirl: swirl[0])
        tables["turbulence"] = strongest[2]
        names["turbulence"] = f'the force field "{strongest[1].name}"'
        notes += [f'"{s[1].name}": is not used: only the strongest Turbulence counts, "{strongest[1].name}"' for s in swirls if s is not strongest]
    return {name: table for name, table in tables.items() if table}, notes, names
