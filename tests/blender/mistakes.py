"""What a user does wrong is one clear line, and nothing is left half done."""

import importlib

import bpy
import numpy as np

import scenes


def refused(press, *words):
    """Presses a button that refuses: its one line has all the words, and no object, data or file has come or gone."""
    before = snapshot()
    try:
        done = press()
    except RuntimeError as error:
        lines = [line for line in str(error).splitlines() if line.strip()]
        assert len(lines) == 1 and lines[0].startswith("Error: ") and not lines[0][7].islower(), str(error)
        assert "Traceback" not in lines[0] and "/nabiki_" not in lines[0], lines[0]
        for word in words:
            assert word.lower() in lines[0].lower(), f"{word!r} is not in: {lines[0]}"
        assert snapshot() == before
        return lines[0]
    raise AssertionError(f"was not refused, but {done}")


def snapshot():
    kinds = [bpy.data.objects, bpy.data.hair_curves, bpy.data.cache_files, bpy.data.actions, bpy.data.meshes]
    hidden = {thing.name: (thing.hide_viewport, thing.hide_render) for thing in bpy.data.objects}
    return [sorted(kind.keys()) for kind in kinds], hidden, bpy.context.scene.frame_current


def plain():
    hair = scenes.groom(8, moving=False)
    hair.nabiki.stiffness = (3000, 300)
    scenes.interval(hair, 8, (0, 60, 0))
    return hair


def simulate():
    return bpy.ops.nabiki.simulate()


def bake():
    return bpy.ops.nabiki.bake()


def test_wrong_objects_are_refused(command, shared):
    hair = plain()
    hair.nabiki.head = None
    refused(simulate, '"Hair" has no head', "pick the mesh")
    # The surface that curves are attached to is a head, too.
    hair.data.surface = bpy.data.objects["Head"]
    assert simulate() == {"FINISHED"}
    scenes.active(bpy.data.objects["Head"])
    refused(simulate, '"Head" is a mesh', "Convert to Curves")
    bpy.ops.curve.primitive_bezier_curve_add()
    refused(simulate, "is a curve", "Object > Convert > Curves")
    for other in bpy.context.view_layer.objects:
        other.select_set(False)
    bpy.context.view_layer.objects.active = None
    refused(simulate, "no object is active")
    empty = scenes.curves("Nothing", np.empty((0, 3)), [0])
    empty.nabiki.head = bpy.data.objects["Head"]
    scenes.active(empty)
    refused(simulate, '"Nothing" has no curves')
    flat = scenes.curves("Points", np.zeros((6, 3)), [0, 3, 6])
    flat.nabiki.head = bpy.data.objects["Head"]
    scenes.active(flat)
    refused(simulate, '"Points"', "length 0")


def test_other_kinds_of_curves_are_refused(command, shared):
    hair = plain()
    points, offsets = scenes.strands()
    bent = scenes.curves("Bent", points, offsets, "BEZIER")
    bent.nabiki.head = bpy.data.objects["Head"]
    scenes.active(bent)
    refused(simulate, "Bezier", "Set Curve Type")
    hair.data.attributes.new("cyclic", "BOOLEAN", "CURVE").data[3].value = True
    scenes.active(hair)
    refused(simulate, "cyclic", "Toggle Cyclic")


def test_heads_that_are_none_are_refused(command, shared):
    hair = plain()
    head = bpy.data.objects["Head"]
    whole = head.data.copy()
    head.data.clear_geometry()
    refused(simulate, '"Head" has no faces')
    head.data = whole
    import bmesh

    # A sheet encloses nothing.
    form = bmesh.new()
    bmesh.ops.create_grid(form, x_segments=4, y_segments=4, size=0.1)
    sheet = bpy.data.meshes.new("Sheet")
    form.to_mesh(sheet)
    form.free()
    head.data = sheet
    refused(simulate, 'the head "Head", a sheet', "encloses no space")
    head.data = whole
    hair.nabiki.head_group = "nowhere"
    refused(simulate, 'no vertex group "nowhere"')
    hair.nabiki.head_group, hair.nabiki.head_bone = "", "skull"
    refused(simulate, "no armature")
    hair.nabiki.head_bone = ""
    hair.location.x += 1
    refused(simulate, 'the roots of "Hair" are', "cm from the head", "pick the mesh")
    hair.location.x -= 1
    ball = scenes.ball("Open", 0.05, scenes.PLACE + [0.2, 0, 0])
    ball.modifiers.new("Collision", "COLLISION")
    ball.data = sheet
    refused(simulate, 'the body "Open":', "a sheet encloses no space")


def test_sizes_that_are_wrong_are_refused(command, shared):
    hair = plain()
    head = bpy.data.objects["Head"]
    for frame, size in [(1, 1.0), (8, 1.3)]:
        head.scale = (size, size, size)
        head.keyframe_insert("scale", frame=frame)
    refused(simulate, 'the head "Head"', "scale")
    head.animation_data_clear()
    head.scale = (0, 1, 1)
    refused(simulate, 'the head "Head", a sheet')
    head.scale = (1, 1, 1)
    # A head of ten metres in a scene of metres: what is said of it is nabiki's own line.
    for thing in [head, hair]:
        thing.scale = (1e5, 1e5, 1e5)
    refused(simulate, 'the head "Head", a head of', "Unit Scale")


def test_what_blender_does_not_evaluate_is_no_head_and_no_body(command, shared):
    """It would seem to stand still; what the eye alone hides takes part as ever."""
    seen = None
    for how in ["seen", "eye", "disabled", "collection"]:
        hair = scenes.groom(8)
        things = [bpy.data.objects["Head"], bpy.data.objects["Ball"]]
        if how == "collection":
            apart = bpy.data.collections.new("Apart")
            bpy.context.scene.collection.children.link(apart)
            for thing in things:
                apart.objects.link(thing)
                bpy.context.scene.collection.objects.unlink(thing)
            apart.hide_viewport = True
        for thing in things:
            thing.hide_viewport = how == "disabled"
            if how == "eye":
                thing.hide_set(True)
        bpy.context.view_layer.update()
        hair.nabiki.stiffness = (3000, 300)
        if how in {"disabled", "collection"}:
            refused(simulate, '"Head" is disabled')
            continue
        assert simulate() == {"FINISHED"}
        found = scenes.evaluated(hair.nabiki.preview, 8)[0]
        assert seen is None or np.array_equal(found, seen)
        seen = found


def test_frames_and_winds_that_cannot_be_are_refused(command, shared):
    hair = plain()
    scene = bpy.context.scene
    scene.frame_start = scene.frame_end = 5
    refused(simulate, "the frame range is 5 to 5")
    scene.frame_start, scene.frame_end = 1, 8
    scenes.interval(hair, 4, (0, 1, 0))
    refused(simulate, "Wind > Interval 2 ends before interval 1 does")
    hair.nabiki.intervals[1].through = 9
    hair.nabiki.intervals[0].through = 1
    refused(simulate, "Wind > Interval 1 ends before the first frame")
    hair.nabiki.intervals[0].through = 8
    hair.nabiki.intervals[0].vector = (0, 1e7, 0)
    refused(simulate, "Wind > Interval 1: is too strong for this hair: keep it below", "Settings > Speed")
    thing = scenes.wind(1e7)
    bpy.context.scene.frame_set(1)
    scenes.active(hair)
    refused(simulate, "the wind up to frame ", ": is too strong for this hair")
    thing.field.falloff_type = "CONE"
    hair.nabiki.intervals[0].vector = (0, 0, 0)
    refused(simulate, 'the force field "Wind": is too strong')
    bpy.data.objects.remove(thing)
    hair.nabiki.intervals[0].vector = (0, 60, 0)
    # Stiffness may be any, and weight may not.
    hair.nabiki.stiffness = (1e6, 1e6)
    assert simulate() == {"FINISHED"}
    hair.nabiki.gravity = 1e8
    refused(simulate, "Settings > Weight: is too strong for this hair: keep it below")


def test_caches_without_a_place_are_refused(command, shared):
    hair = plain()
    refused(bake, "save it", "Nabiki > Cache")
    folder = command.folder / "none"
    hair.nabiki.cache_path = str(folder / "a.usdc")
    refused(bake, "there is no folder", "create it, or set another")
    assert not folder.exists()
    hair.nabiki.cache_path = str(command.folder / "a.obj")
    refused(bake, ".usdc", "rename the cache")
    assert list(command.folder.iterdir()) == []
    # A file of somebody's own is not replaced, and neither is a folder.
    own, folder = command.folder / "groom.usdc", command.folder / "folder.usdc"
    own.write_bytes(b"somebody's groom")
    folder.mkdir()
    for path in [own, folder]:
        hair.nabiki.cache_path = str(path)
        refused(bake, "is not a Nabiki cache")
    assert own.read_bytes() == b"somebody's groom" and folder.is_dir()


def test_a_blender_without_usd_or_alembic_says_so(command, shared):
    """Systems package Blender without them: baked hair would not move there."""
    baking = importlib.import_module("bl_ext.user_default.nabiki.baking")
    hair, known = plain(), baking.readable
    try:
        baking.readable = lambda ending: False
        refused(bake, "without USD and Alembic", "blender.org")
        baking.readable = lambda ending: ending == ".abc"
        hair.nabiki.cache_path = str(command.folder / "a.usdc")
        refused(bake, '"a.usdc"', "name a file with .abc")
        hair.nabiki.cache_path = str(command.folder / "a.abc")
        assert bake() == {"FINISHED"} and [file.name for file in command.folder.iterdir()] == ["a.abc"]
    finally:
        baking.readable = known


def test_a_scene_that_is_refused_is_not_written(command, shared):
    hair = plain()
    hair.nabiki.intervals[0].vector = (0, 1e7, 0)
    write = bpy.ops.nabiki.write_scene
    refused(lambda: write(filepath=str(command.folder / "a.toml"), name="Hair"), "is too strong")
    refused(lambda: write(filepath=str(command.folder / "a.txt"), name="Hair"), "cannot hold a scene")
    assert list(command.folder.iterdir()) == []


def test_points_and_names_of_any_kind(command, shared):
    hair = plain()
    hair.data.attributes["position"].data[7].vector.x = float("nan")
    refused(simulate, "points with invalid positions")
    # What objects are called is theirs to say.
    hair = plain()
    for thing, name in [(hair, 'Här "0" \\1'), (bpy.data.objects["Head"], "head.mesh [body[0].mesh] \\g<1>")]:
        thing.name = name
    hair.nabiki.cache_path = str(command.folder / "käsh \u9761.usdc")
    assert bpy.ops.nabiki.bake() == {"FINISHED"}
    assert len(scenes.evaluated(hair.nabiki.baked, 5)[0]) == scenes.STRANDS * scenes.POINTS
    hair.nabiki.intervals[0].vector = (0, 1e7, 0)
    refused(simulate, "Wind > Interval 1: is too strong")
    sheet = bpy.data.meshes.new("Sheet")
    sheet.from_pydata([(0, 0, 0), (0.1, 0, 0), (0, 0, 0.1)], [], [(0, 1, 2)])
    body = scenes.linked("the head.mesh = \\1", sheet, scenes.PLACE + [0.2, 0, 0])
    body.modifiers.new("Collision", "COLLISION")
    refused(simulate, "encloses no space")


def test_wishes_that_are_none_are_refused(command, shared):
    hair = plain()
    solve = bpy.ops.nabiki.solve
    refused(solve, "press Simulate")
    assert simulate() == {"FINISHED"}
    bpy.context.scene.frame_set(5)
    refused(solve, "you moved no curve of the preview")
    preview = hair.nabiki.preview
    points = scenes.positions(preview.data)
    points[scenes.POINTS - 1] += 0.02
    preview.data.attributes["position"].data.foreach_set("vector", points.ravel())
    hair.nabiki.intervals[0].solve = False
    refused(solve, "tick Find")
    hair.nabiki.gravity = 120
    refused(solve, "settings have changed")
    hair.nabiki.gravity = 100
    bpy.context.scene.frame_set(1)
    refused(solve, "the hair does not move in frame 1")


def test_work_that_is_stopped_leaves_nothing(command, shared):
    """Esc, at any step of any button."""
    import importlib

    jobs = importlib.import_module("bl_ext.user_default.nabiki.jobs")
    messages = importlib.import_module("bl_ext.user_default.nabiki.messages")
    steps = {
        "motion": lambda part, hair: part.simulate(bpy.context, hair, Pressed()),
        "baking": lambda part, hair: part.bake(bpy.context, hair, Pressed()),
    }
    for name, work in steps.items():
        part = importlib.import_module(f"bl_ext.user_default.nabiki.{name}")
        hair = plain()
        hair.nabiki.cache_path = str(command.folder / "stopped.usdc")
        bpy.context.scene.frame_set(3)
        before = snapshot()
        for after in [1, 4, 9]:
            generator = work(part, hair)
            for _ in range(after):
                next(generator)
            try:
                generator.throw(messages.Cancelled())
                raise AssertionError("went on")
            except messages.Cancelled:
                pass
            assert snapshot() == before and list(command.folder.iterdir()) == [], name
    assert jobs.running is None


def test_a_search_that_is_stopped_leaves_the_winds_as_they_were(command, shared):
    """Also where the wind is found already, and the preview is being moved by it; and where there was none."""
    import importlib

    wishing = importlib.import_module("bl_ext.user_default.nabiki.wishing")
    messages = importlib.import_module("bl_ext.user_default.nabiki.messages")
    for winds in [1, 0]:
        hair = plain()
        if not winds:
            hair.nabiki.intervals.clear()
        assert simulate() == {"FINISHED"}
        preview = hair.nabiki.preview
        bpy.context.scene.frame_set(6)
        points = scenes.positions(preview.data)
        points.reshape(-1, scenes.POINTS, 3)[:, -2:] += np.float32([0.02, 0.01, 0.0])
        preview.data.attributes["position"].data.foreach_set("vector", points.ravel())
        before, stages = [tuple(i.vector) for i in hair.nabiki.intervals], set()
        for stage in ["finding the wind", "moving hair"]:
            generator = wishing.solve(bpy.context, hair, Pressed())
            for _, text, *_ in generator:
                stages.add(text)
                if text == stage:
                    break
            try:
                generator.throw(messages.Cancelled())
                raise AssertionError("went on")
            except messages.Cancelled:
                pass
            assert [tuple(i.vector) for i in hair.nabiki.intervals] == before, stage
            assert np.array_equal(scenes.positions(preview.data), points), "what a hand has moved stays"
        assert stages == {"finding the wind", "moving hair"}
        # And without Esc it is found.
        assert bpy.ops.nabiki.solve() == {"FINISHED"}
        assert len(hair.nabiki.intervals) == 1 and np.linalg.norm(hair.nabiki.intervals[0].vector) > 1


class Pressed:
    made = None
