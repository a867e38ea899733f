"""Opens point caches and chains of joints in Blender, and compares them with the simulated hair.

    game.py points FOLDER    the points of every frame of moving.usdc, as usd-core has them, into known.f32 and counts.txt
    game.py blender FOLDER   moving.pc2, moving.mdd and the .glb files, in Blender
    game.py three FOLDER     what three.mjs wrote of the .glb files, against the same

Distances are in centimetres. FOLDER/told.txt has a line for each .glb: its name, and the mean distance that Nabiki told.
"""

import sys
from pathlib import Path

import numpy as np

# Of scenes/head_turn.toml.
FRAMES = 61
RATE = 120


def known(folder):
    return np.fromfile(folder / "known.f32", "f4").reshape(FRAMES, -1, 3).astype("f8")


def told(folder):
    return {name: float(mean) for name, mean in (line.split() for line in (folder / "told.txt").read_text().splitlines())}


def compare(name, found, points, folder):
    """Points found in the frames: the mean distance is as told. Told of a quarter, half, three quarters and the tip of each strand."""
    counts = np.loadtxt(folder / "counts.txt", dtype=int)
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    places = np.concatenate([starts + -((1 - counts) * i // 4) for i in range(1, 5)])
    # Ribbons have two vertices at each point.
    found = 0.5 * (found[:, ::2] + found[:, 1::2]) if found.shape[1] == 2 * points.shape[1] else found
    apart = np.linalg.norm(found - points, axis=2)
    mean, wanted = apart[::4][:, places].mean(), told(folder)[name]
    print(f"measured: {name}: {mean:.3f} cm from the simulated hair on average, {apart.max():.2f} at most; told {wanted}")
    # Told to a hundredth, of every fourth frame; weights are whole parts of 255.
    assert abs(mean - wanted) < 0.02 + 0.02 * wanted, name


def new_scene():
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = RATE
    return bpy.context.scene


def evaluated(frame):
    """World positions of the vertices of the hair."""
    import bpy

    bpy.context.scene.frame_set(frame)
    graph = bpy.context.evaluated_depsgraph_get()
    found = next(o for o in bpy.data.objects if o.type == "MESH" and o.name.startswith(("hair", "cache")))
    hair = found.evaluated_get(graph)
    points = hair.data.attributes["position"].data
    numbers = np.empty(3 * len(points), "f4")
    points.foreach_get("vector", numbers)
    world = np.array(hair.matrix_world)
    return numbers.reshape(-1, 3).astype("f8") @ world[:3, :3].T + world[:3, 3]


def points(folder):
    """In the world of the file: centimetres, y up."""
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.Open(str(folder / "moving.usdc"))
    [hair] = [UsdGeom.BasisCurves(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.BasisCurves)]
    frames = []
    for frame in range(FRAMES):
        world = np.array(UsdGeom.Imageable(hair).ComputeLocalToWorldTransform(frame))
        local = np.array(hair.GetPointsAttr().Get(frame), "f8")
        frames.append(local @ world[:3, :3] + world[3, :3])
    np.array(frames, "f4").tofile(folder / "known.f32")
    (folder / "counts.txt").write_text("\n".join(map(str, hair.GetCurveVertexCountsAttr().Get())))


def blender(folder):
    import bpy

    wanted = known(folder)
    for name in ["moving.pc2", "moving.mdd"]:
        new_scene()
        mesh = bpy.data.meshes.new("cache")
        mesh.from_pydata(wanted[0].tolist(), [], [])
        thing = bpy.data.objects.new("cache", mesh)
        bpy.context.collection.objects.link(thing)
        modifier = thing.modifiers.new("cache", "MESH_CACHE")
        modifier.cache_format = name[-3:].upper()
        modifier.filepath = str(folder / name)
        modifier.frame_start = 0
        found = np.array([evaluated(frame) for frame in range(FRAMES)])
        apart = np.abs(found - wanted).max()
        print(f"measured: {name}: {apart:.1e} cm from the simulated hair at most")
        assert apart < 1e-3, name
    for name in told(folder):
        new_scene()
        bpy.ops.import_scene.gltf(filepath=str(folder / name))
        # Blender's z is up and its unit the metre; the file faces +z where hair of no file faces +x.
        found = np.array([100.0 * evaluated(frame) for frame in range(FRAMES)])
        x, y, z = found[..., 0], found[..., 1], found[..., 2]
        compare(name, np.stack([-y, z, -x], 2), wanted, folder)


def three(folder):
    wanted = known(folder)
    # three.js draws lines that no joint moves.
    for name in (name for name in told(folder) if not name.startswith("lines")):
        found = 100.0 * np.fromfile(folder / f"{name}.f32", "f4").reshape(FRAMES, -1, 3).astype("f8")
        x, y, z = found[..., 0], found[..., 1], found[..., 2]
        compare(name, np.stack([z, y, -x], 2), wanted, folder)


if __name__ == "__main__":
    {"points": points, "blender": blender, "three": three}[sys.argv[1]](Path(sys.argv[2]))
