"""What surrounds the motion: the rest stays, Undo works, files come back, nothing old is shown."""

import importlib

import bpy
import mathutils
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

import motions
import scenes


def part(name):
    """A module of the installed extension."""
    return importlib.import_module(f"bl_ext.user_default.nabiki.{name}")


def rest_of(preview):
    return scenes.vectors(preview.data, "nabiki_rest")


def at_rest(preview):
    return np.array_equal(scenes.positions(preview.data), rest_of(preview))


def blown(frames=16, moving=False):
    """A groom in a wind, simulated."""
    hair = scenes.groom(frames, moving=moving)
    scenes.interval(hair, frames, (0, 70, 20))
    return hair, motions.simulated(hair, 40)


def state(hair):
    """All that the hair is, as bytes."""
    parts = [scenes.positions(hair.data).tobytes()]
    parts += [(a.name, a.data_type, a.domain) for a in sorted(hair.data.attributes, key=lambda a: a.name)]
    return parts + [hair.hide_viewport, hair.hide_render, hair.data.name, tuple(map(tuple, hair.matrix_world))]


def test_clear_puts_everything_back_to_the_bit(command, shared):
    hair = scenes.groom(12, kind="CATMULL_ROM")
    hair.hide_render = True
    scenes.interval(hair, 12, (0, 70, 0))
    was, objects, datas = state(hair), set(bpy.data.objects.keys()), set(bpy.data.hair_curves.keys())
    preview = motions.simulated(hair, 40)
    assert hair.hide_viewport and not at_rest_after(preview, 10)
    hair.nabiki.cache_path = str(command.folder / "cache.usdc")
    assert bpy.ops.nabiki.bake() == {"FINISHED"}
    motions.simulated(hair, 40)
    assert bpy.ops.nabiki.clear() == {"FINISHED"}
    bpy.context.scene.frame_set(1)
    assert state(hair) == was
    left = set(bpy.data.objects.keys()) ^ objects, set(bpy.data.hair_curves.keys()) ^ datas, bpy.data.cache_files.keys()
    assert not any(left), left


def at_rest_after(preview, frame):
    bpy.context.scene.frame_set(frame)
    return at_rest(preview)


def test_no_motion_of_other_settings_is_shown(command, shared):
    hair, preview = blown()
    scene = bpy.context.scene
    assert not at_rest_after(preview, 10)
    moved = scenes.positions(preview.data)
    changes = [("gravity", 300.0), ("hold", 10.0), ("facing", "+x"), ("preview_strands", 20), ("margin", 0.5)]
    for name, value in changes:
        before = getattr(hair.nabiki, name)
        setattr(hair.nabiki, name, value)
        assert at_rest(preview), name
        setattr(hair.nabiki, name, before)
        # The motion of these settings is still known.
        assert np.array_equal(scenes.positions(preview.data), moved), name
    hair.nabiki.intervals[0].vector = (10, 0, 0)
    assert at_rest(preview)
    hair.nabiki.intervals[0].vector = (0, 70, 20)
    assert not at_rest(preview)
    scene.frame_end += 1
    assert at_rest_after(preview, 9)
    scene.frame_end -= 1
    assert not at_rest_after(preview, 10)
    # The rest groom, the head, a new body, a head that is moved by hand.
    hair.data.attributes["position"].data[5].vector.z += 0.001
    assert at_rest_after(preview, 9)
    motions.simulated(hair, 40)
    head = bpy.data.objects["Head"]
    head.data.vertices[3].co.z += 1e-4
    head.data.update()
    assert at_rest_after(preview, 10)
    motions.simulated(hair, 40)
    assert not at_rest_after(preview, 9)
    head.location.x += 0.001
    bpy.context.view_layer.update()
    assert at_rest(preview)
    motions.simulated(hair, 40)
    scenes.ball("Other", 0.05, scenes.PLACE + [0.15, 0, 0]).modifiers.new("Collision", "COLLISION")
    assert at_rest_after(preview, 11)
    # A key of the wind in a frame that is not on screen.
    wind = scenes.wind(20.0, keys=[(5, 20.0), (12, 50.0)])
    motions.simulated(hair, 40)
    assert not at_rest_after(preview, 5)
    scene.frame_set(12)
    wind.field.strength = 90
    wind.keyframe_insert("field.strength", frame=12)
    assert at_rest_after(preview, 12)


def test_undo_and_redo_are_one_step_each(command, shared):
    hair = scenes.groom(12, moving=False)
    scenes.interval(hair, 12, (0, 70, 0))
    hair.nabiki.stiffness = (3000, 300)
    scenes.active(hair)
    bpy.ops.ed.undo_push(message="before")
    # As a press does it: the operator makes its own step of undo.
    assert bpy.ops.nabiki.simulate("EXEC_DEFAULT", True) == {"FINISHED"}
    bpy.ops.ed.undo()
    hair = bpy.data.objects["Hair"]
    assert hair.nabiki.preview is None and not hair.hide_viewport and "Hair Preview" not in bpy.data.objects
    bpy.ops.ed.redo()
    hair = bpy.data.objects["Hair"]
    preview = hair.nabiki.preview
    # What was computed is found again, and shown.
    assert not at_rest_after(preview, 8)
    hair.nabiki.gravity = 250
    bpy.ops.ed.undo_push(message="Weight")
    assert at_rest(preview)
    bpy.ops.ed.undo()
    hair = bpy.data.objects["Hair"]
    assert hair.nabiki.gravity == 100 and not at_rest_after(hair.nabiki.preview, 7)


def test_clear_leaves_the_hair_active_and_is_undone_with_its_motion(command, shared):
    hair, preview = blown()
    scenes.active(preview)
    bpy.context.scene.frame_set(9)
    bpy.ops.ed.undo_push(message="before")
    assert bpy.ops.nabiki.clear("EXEC_DEFAULT", True) == {"FINISHED"}
    assert bpy.context.object == hair and hair.select_get()
    bpy.ops.ed.undo()
    hair = bpy.data.objects["Hair"]
    assert not at_rest(hair.nabiki.preview)
    # A bake removes the preview, too.
    scenes.active(hair.nabiki.preview)
    hair.nabiki.cache_path = str(command.folder / "cache.usdc")
    assert bpy.ops.nabiki.bake() == {"FINISHED"}
    assert bpy.context.object in (hair, hair.nabiki.baked)


def test_a_file_comes_back_with_its_settings_and_at_rest(command, shared):
    hair, preview = blown()
    assert not at_rest_after(preview, 10)
    moved = scenes.positions(preview.data)
    path = str(command.folder / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    scenes.empty()
    bpy.ops.wm.open_mainfile(filepath=path)
    hair = bpy.data.objects["Hair"]
    preview = hair.nabiki.preview
    assert hair.nabiki.head.name == "Head" and tuple(hair.nabiki.intervals[0].vector) == (0, 70, 20)
    assert at_rest(preview)
    scenes.active(hair)
    assert bpy.ops.nabiki.simulate() == {"FINISHED"}
    bpy.context.scene.frame_set(10)
    assert np.array_equal(scenes.positions(hair.nabiki.preview.data), moved)
    # A cache beside the file is found from there.
    assert bpy.ops.nabiki.bake() == {"FINISHED"}
    assert bpy.data.cache_files[0].filepath == "//Hair_nabiki.usdc"
    known = motions.all_frames(hair.nabiki.baked)
    bpy.ops.wm.save_mainfile()
    scenes.empty()
    bpy.ops.wm.open_mainfile(filepath=path)
    assert np.array_equal(motions.all_frames(bpy.data.objects["Hair Baked"]), known)


def test_previews_move_as_all_do_and_follow_subframes(command, shared):
    hair, preview = blown()
    few = motions.all_frames(preview)
    assert few.shape[1] == 40 * scenes.POINTS
    film = next(reversed(part("playing").takes[hair.session_uid].films.values()))
    preview = motions.simulated(hair, 10**6)
    every = motions.all_frames(preview)
    rows = (film.strands[:, None] * scenes.POINTS + np.arange(scenes.POINTS)).ravel()
    assert np.array_equal(few, every[:, rows])
    half = scenes.evaluated(preview, 9, 0.5)[0]
    motions.near(half, 0.5 * (every[8] + every[9]), 0, "half a frame")
    # Whatever is looked at between frames, the motion is still there.
    hair.data.update_tag()
    bpy.context.view_layer.update()
    assert not at_rest(preview)


def test_a_head_on_a_bone_moves_as_a_head_that_is_moved(command, shared):
    """The same turn, keyed on the head itself, on a bone it is parented to, and on the bone that is named of those that bend its mesh."""
    found = []
    for how in ["object", "parent", "named"]:
        hair = scenes.groom(12, moving=False)
        head = bpy.data.objects["Head"]
        if how == "object":
            mover = head
        else:
            armature = scenes.linked("Rig", bpy.data.armatures.new("Rig"), scenes.PLACE)
            scenes.active(armature)
            bpy.ops.object.mode_set(mode="EDIT")
            bone = armature.data.edit_bones.new("skull")
            bone.head, bone.tail = (0, 0, 0), (0, 0, 0.1)
            bpy.ops.object.mode_set(mode="OBJECT")
            mover = armature.pose.bones["skull"]
            if how == "parent":
                world = head.matrix_world.copy()
                head.parent, head.parent_type, head.parent_bone = armature, "BONE", "skull"
                bpy.context.view_layer.update()
                head.matrix_world = world
            else:
                group = head.vertex_groups.new(name="skull")
                group.add(range(len(head.data.vertices)), 1.0, "REPLACE")
                head.modifiers.new("Armature", "ARMATURE").object = armature
            if how == "named":
                hair.nabiki.head_bone = "skull"
        mover.rotation_mode = "XYZ"
        # The bone's y is the world's z.
        axis = 2 if how == "object" else 1
        for frame, angle in [(1, 0.0), (12, 0.8)]:
            mover.rotation_euler[axis] = angle
            mover.keyframe_insert("rotation_euler", frame=frame)
        bpy.context.scene.frame_set(1)
        found.append(motions.all_frames(motions.simulated(hair, 30)))
        assert np.abs(found[-1][-1] - found[-1][0]).max() > 0.01
    for how, frames in zip(["parent", "named"], found[1:], strict=True):
        # Poses of bones are products of a few matrices of 32 bits, and hair feels their second differences at 24 frames a second:
        # 0.1 mm is what that comes to with room.
        assert np.abs(frames - found[0]).max() < 1e-4, f"{how}: {np.abs(frames - found[0]).max()}"


def bent_head(keys):
    """Hair on a head whose shape key slides and swells its right half by up to 2 cm; `keys`: (frame, value)."""
    hair = scenes.groom(12, moving=False)
    head = bpy.data.objects["Head"]
    head.shape_key_add(name="Basis")
    key = head.shape_key_add(name="Slide")
    for vertex, point in zip(head.data.vertices, key.data, strict=True):
        side = max(vertex.co.x, 0.0) / scenes.RADIUS
        point.co = vertex.co * (1 + 0.1 * side) + side * Vector((0.0, 0.0, 0.01))
    for frame, value in keys:
        key.value = value
        key.keyframe_insert("value", frame=frame)
    bpy.context.scene.frame_set(1)
    return hair, head


def test_roots_ride_on_a_head_that_a_shape_key_bends(command, shared):
    """Roots are where Blender's own evaluated mesh has the place of the skin that they grow on, in every frame."""
    hair, head = bent_head([(1, 0.0), (6, 1.0), (12, 0.3)])
    rest = [vertex.co.copy() for vertex in head.data.vertices]
    head.data.calc_loop_triangles()
    faces = [tuple(triangle.vertices) for triangle in head.data.loop_triangles]
    tree = BVHTree.FromPolygons(rest, faces)
    # Roots of the groom lie on a ball, and faces are flat: put them on the faces.
    points = scenes.positions(hair.data).copy()
    to_head = head.matrix_world.inverted() @ hair.matrix_world
    for number in range(0, len(points), scenes.POINTS):
        points[number] = to_head.inverted() @ tree.find_nearest(to_head @ Vector(points[number]))[0]
    hair.data.attributes["position"].data.foreach_set("vector", points.ravel())
    preview = motions.simulated(hair, 30)
    frames = motions.all_frames(preview)
    starts = np.arange(0, len(frames[0]), scenes.POINTS)
    world = head.matrix_world.copy()
    places = []
    for root in frames[0][starts]:
        at, _, face, _ = tree.find_nearest(world.inverted() @ Vector(root))
        places.append((face, mathutils.geometry.barycentric_transform, at))
    most = moved = 0.0
    for number, points in enumerate(frames):
        bpy.context.scene.frame_set(1 + number)
        graph = bpy.context.evaluated_depsgraph_get()
        mesh = head.evaluated_get(graph).data
        for root, (face, transform, at) in zip(points[starts], places, strict=True):
            corners = [rest[v] for v in faces[face]], [mesh.vertices[v].co for v in faces[face]]
            there = world @ transform(at, *corners[0], *corners[1])
            most = max(most, (Vector(root) - there).length)
            moved = max(moved, (world @ at - there).length)
    print(f"measured: roots on a shape key: {100 * most:.1e} cm from Blender's own skin, which moves by {100 * moved:.2f} cm")
    # Blender's numbers have 32 bits, at 1.6 m: 1e-7 m each.
    assert moved > 0.01 and most < 1e-6, (moved, most)


def test_hair_stays_out_of_a_head_that_swells(command, shared):
    hair, head = bent_head([(1, 0.0), (12, 1.0)])
    scenes.interval(hair, 12, (-60, 0, 0))
    frames = motions.all_frames(motions.simulated(hair, 60))
    bpy.context.scene.frame_set(12)
    mesh = head.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    tree = BVHTree.FromPolygons([v.co for v in mesh.vertices], [tuple(t.vertices) for t in mesh.loop_triangles])
    inverse = head.matrix_world.inverted()
    deepest = 0.0
    for point in frames[-1]:
        at, normal, _, _ = tree.find_nearest(inverse @ Vector(point))
        deepest = min(deepest, (inverse @ Vector(point) - at).dot(normal))
    print(f"measured: hair on a head that swells: at most {-100 * deepest:.3f} cm inside")
    # Roots lie on flat triangles, and samples of the distance are a third of a centimetre apart.
    assert deepest > -5e-4, deepest


def test_curves_without_extent_and_doubled_points_do_no_harm(command, shared):
    hair = scenes.groom(10, moving=False)
    points, offsets = scenes.strands()
    points[5 * scenes.POINTS + 4] = points[5 * scenes.POINTS + 3]
    points[9 * scenes.POINTS : 10 * scenes.POINTS] = points[9 * scenes.POINTS]
    hair.data.attributes["position"].data.foreach_set("vector", points.ravel())
    scenes.interval(hair, 10, (0, 60, 0))
    preview = motions.simulated(hair, 10**6)
    counts = [curve.points_length for curve in preview.data.curves]
    assert len(counts) == scenes.STRANDS - 1 and counts.count(scenes.POINTS - 1) == 1
    moved = motions.all_frames(preview)
    assert np.isfinite(moved).all() and np.abs(moved[-1] - moved[0]).max() > 0.01


def test_any_frame_rate_and_first_frame_will_do(command, shared):
    for rate, base, first, last in [(24, 1.001, 1, 98), (30, 1.001, 0, 30), (12, 0.96, 7, 36)]:
        hair = scenes.groom(last)
        scene = bpy.context.scene
        scene.frame_start, scene.render.fps, scene.render.fps_base = first, rate, base
        scenes.wind(50.0)
        moved = motions.all_frames(motions.simulated(hair, 10))
        assert len(moved) == last - first + 1 and np.abs(moved[-1] - moved[0]).max() > 0.01
        assert np.array_equal(moved[0], scenes.evaluated(hair.nabiki.preview, first - 1)[0]), "before the first frame it is at rest"


def test_a_scaled_scene_moves_alike(command, shared):
    """Centimetres for Blender's unit, and the same thing comes out a hundred times as large."""
    metres = motions.all_frames(blown()[1])
    hair = scenes.groom(16, moving=False)
    bpy.context.scene.unit_settings.scale_length = 0.01
    for thing in [hair, bpy.data.objects["Head"]]:
        thing.scale, thing.location = (100, 100, 100), 100 * scenes.PLACE
    scenes.interval(hair, 16, (0, 70, 20))
    centimetres = motions.all_frames(motions.simulated(hair, 40))
    # The same numbers but for where they are rounded.
    assert np.abs(centimetres / 100 - metres).max() < 1e-5


def test_what_modifiers_make_of_the_hair_is_moved(command, shared):
    """A geometry node that scales the hair by two: the preview begins with what was to be seen."""
    hair = scenes.groom(8, moving=False)
    group = bpy.data.node_groups.new("Longer", "GeometryNodeTree")
    for way in ["INPUT", "OUTPUT"]:
        group.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    nodes = [group.nodes.new(kind) for kind in ["NodeGroupInput", "GeometryNodeTransform", "NodeGroupOutput"]]
    nodes[1].inputs["Scale"].default_value = (1.05, 1.05, 1.05)
    socket = group.interface.new_socket("Unused", in_out="INPUT", socket_type="NodeSocketFloat").identifier
    group.links.new(nodes[0].outputs[0], nodes[1].inputs[0])
    group.links.new(nodes[1].outputs[0], nodes[2].inputs[0])
    modifier = hair.modifiers.new("Longer", "NODES")
    modifier.node_group = group
    scenes.interval(hair, 8, (0, 60, 0))
    seen = scenes.evaluated(hair, 1)[0]
    preview = motions.simulated(hair, 10**6)
    motions.near(scenes.evaluated(preview, 1)[0], seen, 0, "at rest")
    assert np.abs(scenes.evaluated(preview, 8)[0] - seen).max() > 0.01
    assert not at_rest_after(preview, 7)
    if bpy.app.version < (5, 2):
        modifier[socket] = 0.25
    else:
        getattr(modifier.properties.inputs, socket).value = 0.25
    assert at_rest_after(preview, 6)
    modifier.show_viewport = False
    without = motions.all_frames(motions.simulated(hair, 10**6))
    assert np.abs(without[0] - seen).max() > 0.001
    # One of the head, and weights of its group.
    head = bpy.data.objects["Head"]
    preview = hair.nabiki.preview
    assert not at_rest_after(preview, 7)
    head.modifiers.new("Bevel", "SMOOTH").factor = 0.4
    bpy.context.view_layer.update()
    assert at_rest(preview)


def test_of_a_body_the_vertex_group_is_the_head(command, shared):
    """A trunk in the same mesh changes nothing, as far as the group leaves it out: the hair may hang where it is."""
    found = []
    for whole in [False, True]:
        hair = scenes.groom(12, moving=False)
        head = bpy.data.objects["Head"]
        if whole:
            head.vertex_groups.new(name="skull").add(range(len(head.data.vertices)), 1.0, "REPLACE")
            trunk = scenes.ball("Trunk", 0.3, scenes.PLACE - [0, 0, 0.4])
            with bpy.context.temp_override(active_object=head, object=head, selected_editable_objects=[head, trunk], selected_objects=[head, trunk]):
                assert bpy.ops.object.join() == {"FINISHED"}
            hair.nabiki.head_group = "skull"
        scenes.interval(hair, 12, (0, 60, 0))
        found.append(motions.all_frames(motions.simulated(hair, 10**6)))
    # The same numbers but for where they are rounded: the origin is the middle of the group's box.
    assert np.abs(found[1] - found[0]).max() < 1e-6
    # Weights decide, too: without the group's crown the motion is another, and is computed again.
    preview, head = hair.nabiki.preview, bpy.data.objects["Head"]
    assert not at_rest_after(preview, 8)
    head.vertex_groups["skull"].remove([0, 1, 2])
    head.data.update_tag()
    bpy.context.view_layer.update()
    assert at_rest(preview)


def test_hair_that_blenders_own_menus_make_is_moved(command, shared):
    """Add > Curve > Empty Hair on a mesh, with the modifier that comes with it; particle hair, converted."""
    for how in ["empty hair", "particles"]:
        scenes.empty(10)
        bpy.ops.mesh.primitive_uv_sphere_add(radius=scenes.RADIUS, location=scenes.PLACE.tolist())
        head = bpy.context.object
        if how == "empty hair":
            assert bpy.ops.object.curves_empty_hair_add() == {"FINISHED"}
            hair = bpy.context.object
            points, offsets = scenes.strands()
            hair.data.add_curves(np.diff(offsets).tolist())
            hair.data.attributes["position"].data.foreach_set("vector", points.ravel())
            assert hair.data.surface == head and hair.modifiers
        else:
            head.modifiers.new("Hair", "PARTICLE_SYSTEM")
            settings = head.particle_systems[0].settings
            settings.type, settings.count, settings.hair_length = "HAIR", 100, 0.15
            bpy.context.view_layer.update()
            assert bpy.ops.curves.convert_from_particle_system() == {"FINISHED"}
            hair = bpy.context.object
            hair.nabiki.head = head
        scenes.interval(hair, 10, (0, 60, 0))
        moved = motions.all_frames(motions.simulated(hair, 50))
        assert np.abs(moved[-1] - moved[0]).max() > 0.01, how


def test_a_copy_of_the_hair_has_a_motion_of_its_own(command, shared):
    hair, preview = blown()
    bpy.context.scene.frame_set(9)
    moved = scenes.positions(preview.data)
    other = hair.copy()
    bpy.context.scene.collection.objects.link(other)
    other.nabiki.intervals[0].vector = (0, -50, 0)
    own = motions.simulated(other, 40)
    assert own != preview
    bpy.context.scene.frame_set(9)
    assert np.array_equal(scenes.positions(preview.data), moved)
    assert not np.array_equal(scenes.positions(own.data), moved)
    scenes.active(other)
    assert bpy.ops.nabiki.clear() == {"FINISHED"}
    assert hair.nabiki.preview == preview and preview.name in bpy.data.objects


def test_a_setting_that_changes_is_computed_again_beside_the_user(command, shared):
    """What the timer does once the settings are calm."""
    windows, jobs = importlib.import_module("windows"), part("jobs")
    hair, preview = blown()
    hair.nabiki.gravity = 160
    assert at_rest_after(preview, 9)
    scenes.active(bpy.data.objects["Head"])
    window, operator = windows.Window(), windows.pressed("NABIKI_OT_simulate", hair)
    operator.beside = True
    assert windows.in_window(jobs, operator, window, [windows.OTHER]) == {"CANCELLED"}
    assert operator.reports == [] and not at_rest(preview)
    # And by the operator itself, as the timer calls it.
    hair.nabiki.gravity = 170
    assert at_rest(hair.nabiki.preview)
    assert bpy.ops.nabiki.simulate(name=hair.name, beside=True) == {"CANCELLED"}
    assert not at_rest(hair.nabiki.preview)
