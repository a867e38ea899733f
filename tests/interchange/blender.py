"""Opens the samples in Blender, and gives Nabiki hair that Blender wrote."""

import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np

from expected import FRAME_RATE, FRAMES, Expected


def new_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = round(FRAME_RATE)
    return bpy.context.scene


def evaluated(frame):
    """World points and radii of the one object of curves in a frame, and its data."""
    bpy.context.scene.frame_set(frame)
    graph = bpy.context.evaluated_depsgraph_get()
    [hair] = [o.evaluated_get(graph) for o in bpy.data.objects if o.type == "CURVES"]
    count = len(hair.data.points)
    points, radii = np.empty(3 * count, "f4"), np.empty(count, "f4")
    hair.data.attributes["position"].data.foreach_get("vector", points)
    hair.data.attributes["radius"].data.foreach_get("value", radii)
    world = np.array(hair.matrix_world)
    return points.reshape(-1, 3) @ world[:3, :3].T + world[:3, 3], radii, hair.data


def imported(expected):
    shot = expected.folder / "shot.usda"
    shot.write_text(
        "#usda 1.0\n(\n    defaultPrim = \"head\"\n    startTimeCode = 0\n    endTimeCode = 9\n    metersPerUnit = 0.01\n"
        "    upAxis = \"Y\"\n    subLayers = [@./layer.usdc@, @./rest.usda@]\n)\n"
    )
    names = ["still.usda", "still.usdc", "moving.usda", "moving.usdc", "still.abc", "moving.abc", "shot.usda"]
    for name in names:
        scene = new_scene()
        path = str(expected.folder / name)
        alembic = name.endswith("abc")
        if alembic:
            bpy.ops.wm.alembic_import(filepath=path, as_background_job=False)
        else:
            bpy.ops.wm.usd_import(filepath=path)
        assert (scene.frame_start, scene.frame_end) == (0, FRAMES - 1), f"{name}: {scene.frame_start}..{scene.frame_end}"
        # Blender's z is up and its unit the metre; Alembic says no unit, so its numbers stay.
        scale = 1.0 if alembic else 0.01
        for frame in range(FRAMES):
            found, radii, data = evaluated(frame)
            known = expected.in_world(frame) if name.startswith("moving") else expected.points[frame].astype("f8")
            known = np.stack([known[:, 0], -known[:, 2], known[:, 1]], 1)
            expected.near(found / scale, known, f"{name}: frame {frame}")
            expected.near(radii * 2, expected.widths, f"{name}: widths of frame {frame}")
        kinds = {value.value for value in data.attributes["curve_type"].data}
        assert kinds == {1}, f"{name}: not poly curves but {kinds}"
        assert [curve.points_length for curve in data.curves] == list(expected.counts), name
        if not alembic:
            ids = [value.value for value in data.attributes["groom_id"].data]
            assert ids == list(expected.ids), name
    return len(names)


def exported(expected, nabiki):
    """Hair made and written by Blender, read by Nabiki, and read back from what Nabiki made of it."""
    counts = [4, 6, 5]
    points = np.random.default_rng(1).normal(size=(sum(counts), 3)).astype("f4")
    radii = np.linspace(0.001, 0.002, len(points), dtype="f4")
    for kind, ending in [("POLY", "usdc"), ("POLY", "usda"), ("POLY", "abc"), ("CATMULL_ROM", "usdc")]:
        new_scene()
        data = bpy.data.hair_curves.new("groom")
        data.add_curves(counts)
        data.set_types(type=kind)
        data.attributes["position"].data.foreach_set("vector", points.ravel())
        data.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", radii)
        roots = np.array([[0.25, 0.5], [0.125, 0.75], [1, 0]], "f4")
        data.attributes.new("surface_uv_coordinate", "FLOAT2", "CURVE").data.foreach_set("vector", roots.ravel())
        bpy.context.scene.collection.objects.link(bpy.data.objects.new("groom", data))
        made = expected.folder / f"blender.{ending}"
        if ending == "abc":
            bpy.ops.wm.alembic_export(filepath=str(made), as_background_job=False, start=0, end=0)
        else:
            bpy.ops.wm.usd_export(filepath=str(made))
        back = expected.folder / f"back.{ending}"
        subprocess.run([nabiki, "convert", made, back, "--quiet"], check=True)
        new_scene()
        if ending == "abc":
            bpy.ops.wm.alembic_import(filepath=str(back), as_background_job=False)
        else:
            bpy.ops.wm.usd_import(filepath=str(back))
        found, widths, data = evaluated(0)
        assert [curve.points_length for curve in data.curves] == counts, f"{kind} {ending}"
        if ending != "abc":
            # Blender neither writes nor reads attributes of curves in Alembic.
            back_roots = np.empty(6, "f4")
            data.attributes["surface_uv_coordinate"].data.foreach_get("vector", back_roots)
            assert np.array_equal(back_roots.reshape(-1, 2), roots), f"{kind} {ending}: root UVs"
        if kind == "POLY":
            expected.near(found, points, f"{kind} in .{ending}: points")
            expected.near(widths, radii, f"{kind} in .{ending}: radii")
        else:
            # Walked by arc length: only the ends are where they were.
            ends = [0, 3, 4, 9, 10, 14]
            expected.near(found[ends], points[ends], f"{kind} in .{ending}: ends")


def main():
    expected, nabiki = Expected(sys.argv[1]), Path(sys.argv[2])
    count = imported(expected)
    exported(expected, nabiki)
    print(f"Blender {bpy.app.version_string}: {count} files in, {FRAMES} frames each, and 4 of its own grooms there and back")


if __name__ == "__main__":
    main()
