"""What surrounds the motion: the rest stays, Undo works, files come back, nothing old is shown, the wind is found."""

import importlib

import bpy
import numpy as np

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
    assert bpy.ops.nabiki.simulate() == {"FINISHED"}
    bpy.ops.ed.undo_push(message="Simulate")
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


def test_the_wind_that_moved_the_hair_is_found_again(command, shared):
    hair = scenes.groom(24, moving=False)
    scenes.interval(hair, 24, (10, 60, 20))
    blown_far = motions.simulated(hair, 30)
    bpy.context.scene.frame_set(14)
    wanted = scenes.positions(blown_far.data)
    hair.nabiki.intervals[0].vector = (0, 0, 0)
    preview = motions.simulated(hair, 30)
    bpy.context.scene.frame_set(14)
    # What a hand does in Edit Mode: the tips of some curves go where the wind would take them.
    points = scenes.positions(preview.data)
    for strand in range(0, 30, 3):
        rows = slice((strand + 1) * scenes.POINTS - 3, (strand + 1) * scenes.POINTS)
        points[rows] = wanted[rows]
    preview.data.attributes["position"].data.foreach_set("vector", points.ravel())
    scenes.active(preview)
    bpy.ops.ed.undo_push(message="moved")
    # Another step and back: what was moved stays.
    bpy.context.scene.render.resolution_x = 640
    bpy.ops.ed.undo_push(message="something else")
    bpy.ops.ed.undo()
    hair = bpy.data.objects["Hair"]
    preview = hair.nabiki.preview
    assert np.array_equal(scenes.positions(preview.data), points)
    assert bpy.ops.nabiki.solve() == {"FINISHED"}
    found = np.array(hair.nabiki.intervals[0].vector)
    # The law of docs/solve.md: no vector is off by more than 2.
    assert np.abs(found - [10, 60, 20]).max() <= 2, found
    bpy.context.scene.frame_set(14)
    left = np.abs(scenes.positions(hair.nabiki.preview.data) - wanted).max()
    assert left < 0.002, left
    bpy.ops.ed.undo_push(message="Find the Wind")
    bpy.ops.ed.undo()
    assert tuple(bpy.data.objects["Hair"].nabiki.intervals[0].vector) == (0, 0, 0)


def test_the_wind_is_found_beside_one_of_blenders(command, shared):
    hair = scenes.groom(20, moving=False)
    scenes.wind(40.0)
    scenes.interval(hair, 20, (0, 50, 0))
    bpy.context.scene.frame_set(1)
    far = motions.simulated(hair, 20)
    bpy.context.scene.frame_set(12)
    wanted = scenes.positions(far.data)
    hair.nabiki.intervals[0].vector = (0, 0, 0)
    preview = motions.simulated(hair, 20)
    bpy.context.scene.frame_set(12)
    preview.data.attributes["position"].data.foreach_set("vector", wanted.ravel())
    assert bpy.ops.nabiki.solve() == {"FINISHED"}
    found = np.array(hair.nabiki.intervals[0].vector)
    assert np.abs(found - [0, 50, 0]).max() <= 4, found


def test_a_head_on_a_bone_or_bent_by_one_moves_as_a_head_that_is_moved(command, shared):
    """The same turn, keyed on the head itself, on a bone it is parented to, and on a bone that bends its mesh."""
    found = []
    for how in ["object", "parent", "modifier", "named"]:
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
    for how, frames in zip(["parent", "modifier", "named"], found[1:], strict=True):
        # Poses of bones are products of a few matrices of 32 bits, and hair feels their second differences at 24 frames a second:
        # 0.1 mm is what that comes to with room.
        assert np.abs(frames - found[0]).max() < 1e-4, f"{how}: {np.abs(frames - found[0]).max()}"


def test_force_fields_are_carried_over_by_the_table(command, shared):
    hair = scenes.groom(10, moving=False)
    way = part("axes").to_nabiki("-y")
    where = scenes.PLACE + [0.3, 0.1, 0.05]
    made = {}
    for kind in ["FORCE", "VORTEX", "TURBULENCE", "DRAG", "CHARGE"]:
        bpy.ops.object.effector_add(type=kind, location=where)
        made[kind] = bpy.context.object
        made[kind].name = kind.title()
        made[kind].field.strength = 25
    made["FORCE"].field.falloff_power = 1
    made["VORTEX"].field.falloff_power = 2
    made["VORTEX"].rotation_euler = (0, np.pi / 2, 0)
    made["TURBULENCE"].field.size, made["TURBULENCE"].field.seed = 0.12, 7
    fan = scenes.wind(80.0, rotation=(0, -np.pi / 2, 0))
    fan.location = where
    fan.field.falloff_type = "CONE"
    fan.field.use_radial_max, fan.field.radial_max = True, 25
    fan.field.use_max_distance, fan.field.distance_max = True, 0.6
    for frame, strength in [(1, 0.0), (5, 80.0), (10, 80.0)]:
        fan.field.strength = strength
        fan.keyframe_insert("field.strength", frame=frame)
    for curve in curves_of(fan):
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    bpy.context.scene.frame_set(1)
    motions.simulated(hair, 20)
    known = part("playing").takes[hair.session_uid]
    tables, _, _ = part("fields").settings(known.sample.effectors, way, known.sample.origin, 100.0, 1.0)
    place = (way @ (where - known.sample.origin) * 100).tolist()
    [point], [vortex], [blower], swirls = (tables[name] for name in ["point", "vortex", "fan", "turbulence"])
    for table in [point, vortex, blower]:
        assert np.allclose(table["position"], place, atol=1e-4)
    assert point["strength"] == 25 and point["falloff"] == {"law": "inverse", "radius": 100.0}
    assert vortex["falloff"]["law"] == "inverse_square" and np.allclose(vortex["axis"], way @ [1, 0, 0], atol=1e-6)
    assert (swirls["strength"], swirls["seed"]) == (25, 7) and abs(swirls["swirl_size"] - 12) < 1e-5
    assert blower["spread"] == 25 and blower["falloff"]["law"] == "smooth" and abs(blower["falloff"]["radius"] - 60) < 1e-4
    assert np.allclose(blower["direction"], way @ [-1, 0, 0], atol=1e-6)
    keys = [(key["frame"], round(key["factor"], 5)) for key in blower["envelope"]]
    assert keys == [(0, 0.0), (4, 1.0), (9, 1.0)], keys
    notes = " ".join(next(reversed(known.films.values())).notes)
    assert '"Drag" is not carried over' in notes and '"Charge" is not carried over' in notes


def pushed(kind, place, at, rotation, **settings):
    """Where Blender's own force field pushes a ball that floats, in a few frames."""
    scene = scenes.empty(6)
    ball = scenes.ball("Floating", 0.02, at)
    scenes.active(ball)
    bpy.ops.rigidbody.world_add()
    bpy.ops.rigidbody.object_add()
    scene.use_gravity = False
    field_of(kind, place, rotation, **settings)
    for frame in range(1, 6):
        scene.frame_set(frame)
    return np.array(ball.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.translation) - at


def field_of(kind, place, rotation, **settings):
    bpy.ops.object.effector_add(type=kind, location=place, rotation=rotation)
    thing = bpy.context.object
    thing.field.strength = 20
    for name, value in settings.items():
        setattr(thing.field, name, value)


def test_force_fields_push_where_blenders_own_push(command, shared):
    import nabiki

    place, rotation = scenes.PLACE + [0.2, -0.1, 0.1], (0.5, -0.7, 0.3)
    # Within the head's reach nothing is led round it, since that is off.
    at = place + np.array([0.3, 0.2, -0.1])
    # A vortex of the shape Plane draws inward as well, which ours does not.
    kinds = [("WIND", {}), ("FORCE", {}), ("FORCE", {"falloff_power": 1}), ("VORTEX", {"shape": "POINT"})]
    for kind, settings in [*kinds, ("WIND", {"falloff_type": "CONE", "use_radial_max": True, "radial_max": 60.0})]:
        cone = "falloff_type" in settings
        # A cone is asked on its axis.
        where = place + 0.3 * np.array(scenes.turned(rotation)) if cone else at
        own = pushed(kind, place, where, rotation, **settings)
        hair = scenes.groom(6, moving=False)
        field_of(kind, place, rotation, **settings)
        motions.simulated(hair, 5)
        path = command.folder / "pushed.toml"
        assert bpy.ops.nabiki.write_scene(filepath=str(path), name="Hair") == {"FINISHED"}
        origin, way = np.array(hair.nabiki.preview.location), part("axes").to_nabiki("-y")
        force = nabiki.Scene.open(path).force_at([way @ (where - origin) * 100], 3)[0] @ way
        own, size = own / np.linalg.norm(own), np.linalg.norm(force)
        assert force @ own / size > 1 - 1e-4, f"{kind} {settings}: {force / size} and {own}"
        wanted = 20 / (1 + np.linalg.norm(at - place)) if settings.get("falloff_power") else 20
        assert abs(size - wanted) < 0.05 * wanted, f"{kind} {settings}: {size}"


def curves_of(thing):
    """The f-curves of an object, wherever this Blender keeps them."""
    action = thing.animation_data.action
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags for curve in bag.fcurves]


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
