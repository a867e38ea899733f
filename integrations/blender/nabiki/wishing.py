# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves that were moved by hand as wishes, and the wind that meets them."""

import nabiki
import numpy as np

from . import attributes, axes, fields, jobs, motion, playing, scene_files
from .messages import Mistake

# What is moved by less than this is not meant (cm): rounding of positions in Blender's unit.
MEANT_CM = 0.01

# How far hair may stay away (cm, root mean square) to be called there.
THERE_CM = 0.5


def moved(scene, thing, sample, found):
    """What was moved of the preview in the frame at hand: for each strand its number, part and mean way (cm, nabiki's axes)."""
    preview = thing.nabiki.preview
    now = attributes.points_of(preview.data).astype(np.float64)
    was = found.at(scene.frame_current_final).astype(np.float64)
    ways = (now - was) @ axes.to_nabiki(thing.nabiki.facing).T * sample.unit_cm
    far = np.linalg.norm(ways, axis=1) > MEANT_CM
    counts = np.diff(sample.hair.offsets)[found.strands]
    start = 0
    wishes = []
    for strand, count in zip(found.strands, counts, strict=True):
        rows = np.flatnonzero(far[start : start + count])
        rows = rows[rows > 0]
        if len(rows):
            # Nodes that were moved lie at these parts of the strand; a little more on both sides takes them in.
            along = [(rows[0] - 0.25) / (count - 1), min((rows[-1] + 0.25) / (count - 1), 1.0)]
            way = ways[start + rows[0] : start + rows[-1] + 1].mean(0)
            wishes.append((int(strand), along, way.tolist()))
        start += count
    return wishes


def solve(context, thing, operator):
    """Finds the wind under which hair goes where it was moved; yields how far it is and returns what to report."""
    scene, settings = context.scene, thing.nabiki
    if playing.preview_of(scene, thing) is None:
        raise Mistake("there is no preview yet: press Simulate, go to a frame, and move curves of the preview there")
    found = playing.film_of(scene, thing)
    sample = playing.take(thing).sample
    if found is None or sample is None:
        raise Mistake("settings have changed since the preview was simulated: press Simulate, and move its curves again")
    frame = scene.frame_current - sample.frames.start
    if not 0 < frame < len(sample.frames):
        raise Mistake(f"the hair does not move in frame {scene.frame_current}: go to a frame from {sample.frames.start + 1} to {sample.frames[-1]}")
    wishes = moved(scene, thing, sample, found)
    if not wishes:
        raise Mistake("you moved no curve of the preview in this frame: move tips in Edit Mode, leave it, and press Find the Wind")
    plain = scene_files.values(settings, sample.frames.start)
    if not plain["intervals"]:
        plain["intervals"] = [(len(sample.frames) - 1, (0.0, 0.0, 0.0), True)]
    # A wind that begins after the frame changes nothing in it.
    begins = [0, *(interval[0] for interval in plain["intervals"])]
    free = [n for n, interval in enumerate(plain["intervals"]) if interval[2] and begins[n] < frame]
    if not free:
        raise Mistake("no wind before this frame may change: tick Find next to an interval in Nabiki > Wind")
    winds = [e for e in sample.effectors if e.kind == "WIND" and e.cone is None and e.strengths().any()]
    problem = [{"frame": frame, "strands": [s], "along": along, "mean_moved": way} for s, along, way in wishes]
    with motion.folder() as folder:
        operator.made = made = scene_files.write(sample, plain, folder, apart=winds)

        def find(progress):
            scene_files.build(made)
            if winds:
                made.scene.fields = [_apart(winds, plain)]
            return made.scene.solve(problem, unknowns={"vectors": free}, progress=progress, report=lambda line: None)

        solution = yield from jobs.on_thread(find, "finding the wind")
    back = axes.to_nabiki(settings.facing).T
    before = [tuple(interval.vector) for interval in settings.intervals]
    with playing.Quiet():
        if not before:
            settings.intervals.add().through = sample.frames[-1]
        for interval, (_, vector) in zip(settings.intervals, solution.forces, strict=True):
            interval.vector = back @ np.array(vector)
    try:
        yield from motion.simulate(context, thing, operator, anew=False)
    except BaseException:
        with playing.Quiet():
            for interval, vector in zip(settings.intervals, before, strict=False):
                interval.vector = vector
            if not before:
                settings.intervals.clear()
        raise
    there = "which is close enough" if solution.after_cm < THERE_CM else "the nearest that was found: tick Find for more winds, or move it less"
    return f"the hair is {solution.after_cm:.2f} cm from where you moved it, {there} (before: {solution.before_cm:.2f} cm)", []


def _apart(winds, plain):
    """Blender's winds as a field of their own, while the intervals are looked for."""
    way, scale = axes.to_nabiki(plain["facing"]), plain["strength_scale"]
    forces = sum(fields.uniform(wind, way, scale) for wind in winds)

    def force(points, frame):
        return np.tile(forces[max(frame, 1) - 1], (len(points), 1))

    return nabiki.Field(force, strongest=float(np.linalg.norm(forces, axis=1).max()) + 1e-3)
