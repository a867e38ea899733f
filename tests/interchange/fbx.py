"""Hair on skin that bends, out of FBX files of Blender: roots are where Blender has the skin, in every frame.

    fbx.py write FOLDER      heads that bend, each with hair that stands still and a scene; in Blender
    fbx.py compare FOLDER    holds what `nabiki simulate` exported of each against Blender; in Blender's Python
"""

import math
import struct
import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

LAST = 36
ROWS, COLUMNS = 16, 24
HEIGHT = 1.6
# Single precision has 2e-5 cm at two metres, and Blender computes in it.
NEAR_CM = 2e-4

SCENE = """[head]
mesh = "{name}.fbx"
groups = ["skin"]
facing = "{facing}"
origin = [{of_head}]
ellipsoid = {{ center = [0, 0, 0], half_axes = [9.5, 11, 7.8] }}
motion = {{ file = "{name}.fbx", node = "{node}", bind_at_start = true }}
[hair]
file = "{name}.obj"
unit = "m"
up = "+z"
facing = "-y"
origin = [{of_hair}]
join_within = 0
segment_length = 1.0
[motion]
form = "free"
frames = {last}
frame_rate = 24
inertia_length_floor = 14.0
[free]
drag = 0
gravity = 0
[[force]]
through = {last}
vector = [0, 0, 0]
"""

# What Blender is told, how a place in metres with z up gets into the file, and where the face looks.
Y_UP = ({}, lambda x, y, z: (100 * x, 100 * z, -100 * y), "+z")
Z_UP = (
    {"axis_forward": "Y", "axis_up": "Z", "apply_scale_options": "FBX_SCALE_UNITS", "apply_unit_scale": True},
    lambda x, y, z: (x, y, z),
    "-y",
)
KINDS = {
    "fbx_joints": (True, False, Y_UP, "head"),
    "fbx_shapes": (False, True, Y_UP, "skin"),
    "fbx_both": (True, True, Y_UP, "head"),
    "fbx_metres": (True, True, Z_UP, "head"),
}


def ball():
    """Places of a head (m, z up, the face along -y), its triangles, and those that carry hair."""
    points, triangles = [], []
    for row in range(ROWS + 1):
        down = math.pi * (row + 0.5) / (ROWS + 1)
        for column in range(COLUMNS):
            around = 2 * math.pi * column / COLUMNS
            side = math.sin(down)
            points.append((0.078 * side * math.cos(around), 0.095 * side * math.sin(around), HEIGHT + 0.11 * math.cos(down)))
    for row in range(ROWS):
        for column in range(COLUMNS):
            a, b = row * COLUMNS + column, row * COLUMNS + (column + 1) % COLUMNS
            triangles += [(a, a + COLUMNS, b), (b, a + COLUMNS, b + COLUMNS)]
    points = np.array(points)
    middles = points[np.array(triangles)].mean(1)
    grown = [t for t in range(0, len(triangles), 5) if middles[t, 2] > HEIGHT - 0.02 and middles[t, 1] > -0.04]
    return points, triangles, grown


def rig(joints, shapes):
    """The head in a scene of its own, moved over all frames."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.render.fps = 0, LAST, 24
    points, triangles, _ = ball()
    mesh = bpy.data.meshes.new("skin")
    mesh.from_pydata(points.tolist(), [], triangles)
    skin = bpy.data.objects.new("skin", mesh)
    scene.collection.objects.link(skin)
    if joints:
        armature = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
        scene.collection.objects.link(armature)
        bpy.context.view_layer.objects.active = armature
        bpy.ops.object.mode_set(mode="EDIT")
        neck = armature.data.edit_bones.new("neck")
        neck.head, neck.tail = (0, 0.02, HEIGHT - 0.2), (0, 0, HEIGHT - 0.08)
        head = armature.data.edit_bones.new("head")
        head.head, head.tail, head.parent, head.roll = neck.tail, (0, 0, HEIGHT + 0.1), neck, 0.4
        bpy.ops.object.mode_set(mode="OBJECT")
        skin.parent = armature
        skin.modifiers.new("rig", "ARMATURE").object = armature
        share = np.clip((points[:, 2] - HEIGHT + 0.11) / 0.2, 0, 1)
        for name, weights in [("neck", 1 - share), ("head", share)]:
            group = skin.vertex_groups.new(name=name)
            for vertex, weight in enumerate(weights.tolist()):
                if weight > 0:
                    group.add([vertex], weight, "REPLACE")
    if shapes:
        skin.shape_key_add(name="Basis")
        brows = skin.shape_key_add(name="brows")
        for vertex, point in enumerate(points):
            if point[2] > HEIGHT:
                brows.data[vertex].co = Vector(point) + Vector((0, 0.01 * math.sin(60 * point[0]), 0.005))
    for n in range(LAST + 1):
        if joints:
            armature.location = (0.3, 0.02 * n, 0.1 * math.sin(0.2 * n))
            armature.keyframe_insert("location", frame=n)
            for bone, axis, angle in [("neck", "X", 8 * math.sin(0.3 * n + 1)), ("head", "Y", 30 * math.sin(0.2 * n + 0.5))]:
                pose = armature.pose.bones[bone]
                pose.rotation_mode = "QUATERNION"
                pose.rotation_quaternion = Matrix.Rotation(math.radians(angle), 4, axis).to_quaternion()
                pose.keyframe_insert("rotation_quaternion", frame=n)
        if shapes:
            brows.value = 0.5 + 0.5 * math.sin(0.5 * n)
            brows.keyframe_insert("value", frame=n)
    return skin


def places(skin):
    """Where the scene has the vertices now (m)."""
    evaluated = skin.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return np.array([evaluated.matrix_world @ vertex.co for vertex in evaluated.data.vertices])


def write(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.iterdir():
        old.unlink()
    _, triangles, grown = ball()
    carriers = np.array(triangles)[grown]
    for name, (joints, shapes, (options, place, facing), node) in KINDS.items():
        skin = rig(joints, shapes)
        scene = bpy.context.scene
        expected = []
        for n in range(LAST + 1):
            scene.frame_set(n)
            expected.append(places(skin)[carriers].mean(1))
        np.save(folder / f"{name}.npy", np.array(expected))
        # An FBX has its rig bound where it stands when it is written, unbent, though its joints are then in another pose.
        scene.frame_set(LAST // 2)
        for modifier in skin.modifiers:
            modifier.show_viewport = False
        middle = Vector(skin.matrix_world.translation) + Vector((0, 0, HEIGHT))
        rows = []
        for root in places(skin)[carriers].mean(1):
            out = root - np.array(middle)
            rows += [root + 0.01 * i * out / np.linalg.norm(out) for i in range(5)]
        for modifier in skin.modifiers:
            modifier.show_viewport = True
        lines = ["v %.9g %.9g %.9g" % tuple(row) for row in rows]
        lines += ["l " + " ".join(str(5 * s + i + 1) for i in range(5)) for s in range(len(grown))]
        (folder / f"{name}.obj").write_text("\n".join(lines) + "\n")
        bpy.ops.export_scene.fbx(
            filepath=str(folder / f"{name}.fbx"), add_leaf_bones=False, bake_anim_use_all_actions=False,
            bake_anim_use_nla_strips=False, bake_anim_simplify_factor=0, **options,
        )
        of_head, of_hair = (", ".join("%.9g" % x for x in at) for at in (place(*middle), middle))
        text = SCENE.format(name=name, node=node, facing=facing, of_head=of_head, of_hair=of_hair, last=LAST)
        (folder / f"{name}.toml").write_text(text)


def compare(folder):
    for name in KINDS:
        data = (folder / f"{name}.pc2").read_bytes()
        magic, _, points, _, _, samples = struct.unpack_from("<12siiffi", data)
        assert magic.startswith(b"POINTCACHE2") and samples == LAST + 1, name
        expected = np.load(folder / f"{name}.npy")
        found = np.frombuffer(data, "<f4", offset=32).reshape(samples, points, 3)[:, :: points // expected.shape[1]]
        off = 100 * np.linalg.norm(found - expected, axis=2)
        way = 100 * np.linalg.norm(expected - expected[0], axis=2).max()
        print(f"  {name}: {expected.shape[1]} roots go up to {way:.1f} cm, at most {off.max():.1e} cm from Blender's skin")
        assert way > 0.4 and off.max() < NEAR_CM, name


{"write": write, "compare": compare}[sys.argv[1]](Path(sys.argv[2]))
