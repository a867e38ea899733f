"""Hair moves in Blender as the command moves it; it is baked, cleared, undone, and found again."""

import bpy
import numpy as np

import command as commands
import scenes

EPS = np.finfo(np.float32).eps


def all_frames(thing):
    """World points of every frame of the scene."""
    scene = bpy.context.scene
    return np.array([scenes.evaluated(thing, frame)[0] for frame in range(scene.frame_start, scene.frame_end + 1)])


def near(found, wanted, apart, what):
    """Points agree to `apart` (metres) and the roundings of their own size."""
    left = np.abs(found - wanted).max()
    allowed = apart + 8 * EPS * np.abs(wanted).max()
    assert left <= allowed, f"{what}: {left:.3g} m apart, and {allowed:.3g} are allowed"
    return left


def simulated(hair, strands):
    hair.nabiki.stiffness, hair.nabiki.preview_strands = (3000, 300), strands
    scenes.active(hair)
    assert bpy.ops.nabiki.simulate() == {"FINISHED"}
    return hair.nabiki.preview


def centre():
    """The origin that keeps most digits; any would do."""
    return np.round(scenes.PLACE, 3)


def test_a_groom_of_blender_moves_as_the_command_moves_it(command, shared):
    hair = scenes.groom(30)
    keys = [(1, 0.0), (8, 80.0), (20, 80.0), (24, 10.0)]
    wind = scenes.wind(keys=keys)
    forces, scene = [], bpy.context.scene
    for frame in range(2, scene.frame_end + 1):
        scene.frame_set(frame)
        axis = np.array(wind.matrix_world.to_3x3().col[2])
        forces.append((frame - 1, wind.field.strength * axis))
    toml = commands.made(command, hair, forces, centre())
    preview = simulated(hair, 10**6)
    found = all_frames(preview)
    known, apart = commands.rounding(command, toml, command.folder / "hair.hair")
    known = commands.in_blender(known, centre())
    way = np.abs(known[-1] - known[0]).max()
    assert way > 0.02, "hardly anything moves"
    # What the test rounds otherwise than the extension a strand hardly feels, but where it is pressed to the head.
    apart_most = np.quantile(np.abs(found - known), 0.99)
    assert apart_most < 1e-5, f"99 of 100 points: {apart_most:.2g} m apart"
    # With the very files that the extension makes the command's points are the same but for their own roundings.
    assert bpy.ops.nabiki.write_scene(filepath=str(command.folder / "written.toml"), name=hair.name) == {"FINISHED"}
    same = command.frames("written.toml")
    left = near(found, commands.in_blender(same, np.array(preview.location, np.float64)), 0, "a groom as it is written")
    print(f"measured: a groom of Blender: {left * 1000:.2g} mm apart over {way * 100:.0f} cm; a rounding of the hair: {apart * 10:.2g} mm")


def test_intervals_of_the_panel_are_eased_as_in_a_scene_file(command, shared):
    for ease in ["smooth", "linear", "stepped"]:
        hair = scenes.groom(20, moving=False)
        hair.nabiki.ease = ease
        for last, vector in [(8, (0, 60, 10)), (14, (-50, 20, 0)), (20, (0, 0, 0))]:
            scenes.interval(hair, last, vector)
        forces = [(7, (0, 60, 10)), (13, (-50, 20, 0)), (19, (0, 0, 0))]
        toml = commands.made(command, hair, forces, centre(), ease)
        found = all_frames(simulated(hair, 10**6))
        known, apart = commands.rounding(command, toml, command.folder / "hair.hair")
        near(found, commands.in_blender(known, centre()), 8 * apart / 100, ease)
        # Together with a Wind of no strength but in its last frame, the intervals are summed frame by frame.
        scenes.wind(keys=[(19, 0.0), (20, 1e-3)])
        summed = all_frames(simulated(hair, 10**6))
        near(summed[:-1], found[:-1], 8 * apart / 100, f"{ease}, summed")


def test_the_written_scene_is_the_one_that_was_simulated(command, shared):
    hair = scenes.groom(20)
    scenes.wind(70.0)
    found = all_frames(simulated(hair, 50))
    assert bpy.ops.nabiki.write_scene(filepath=str(command.folder / "written.toml"), name="Hair") == {"FINISHED"}
    known = command.frames("written.toml", "--strands", 50)
    # The same inputs to the bit, so only the points' own roundings differ: into the world, and into metres.
    near(found, commands.in_blender(known, np.array(hair.nabiki.preview.location)), 0, "the written scene")
    # It goes wherever its folder goes.
    (command.folder / "moved").mkdir()
    for name in ["written", "written.toml"]:
        (command.folder / name).rename(command.folder / "moved" / name)
    assert np.array_equal(command.frames("moved/written.toml", "--strands", 50), known)


def test_sintels_groom_moves_as_the_command_moves_it(command, shared):
    hair_file, head_file = shared / "hair" / "sintel_hair_16pts.tfx", shared / "heads" / "sintel_bust.obj"
    if not head_file.exists():
        return f"{head_file} is not there"
    scenes.empty(24)
    bpy.ops.wm.obj_import(filepath=str(head_file))
    head = bpy.context.object
    points, offsets = scenes.tfx(hair_file)
    turned = np.stack([points[:, 0], -points[:, 2], points[:, 1]], 1)
    hair = scenes.curves("Sintel", turned, offsets)
    hair.nabiki.head = head
    scenes.interval(hair, 16, (0, 60, 15))
    scenes.interval(hair, 24, (0, 0, 0))
    preview = simulated(hair, 300)
    found = all_frames(preview)
    origin = np.array(preview.location, np.float64)
    used = float(np.float32(origin[0])), float(np.float32(origin[2])), float(np.float32(-origin[1]))
    toml = command.folder / "scene.toml"
    text = f'[head]\nmesh = "{head_file}"\nunit = "m"\nfacing = "+z"\norigin = {list(used)}\n'
    text += f'\n[hair]\nfile = "{command.folder / "hair.hair"}"\njoin_within = 0\nunit = "m"\nfacing = "+z"\n'
    text += commands.SETTINGS.format(frames=23, rate=24, stiffness=list(hair.nabiki.stiffness), ease="smooth")
    # In the file y is up and she looks along z, in nabiki y is up and she looks along x.
    for last, (x, y, z) in [(15, (0, 60, 15)), (23, (0, 0, 0))]:
        text += f"\n[[force]]\nthrough = {last}\nvector = {[-y, z, -x]}\n"
    toml.write_text(text)
    commands.write_hair(command.folder / "hair.hair", points, offsets)
    known, apart = commands.rounding(command, toml, command.folder / "hair.hair", "--strands", 300)
    known = known @ commands.WAY / 100 + origin
    # A strand at a kink of the skin falls to either side of it by a rounding. Most of the hair is not, and hardly feels one.
    each = np.abs(found - known).reshape(len(found), -1, int(offsets[1] - offsets[0]), 3).max(axis=(0, 2, 3))
    parted = np.count_nonzero(each > 8 * apart / 100 + 8 * EPS * np.abs(known).max())
    assert 100 * parted <= len(each), f"Sintel: {parted} of {len(each)} strands part, the worst by {each.max():.3g} m"
    left = np.sort(each)[len(each) - 1 - parted]
    most = np.quantile(np.abs(found - known), 0.99)
    assert most < 1e-5, f"99 of 100 points: {most:.2g} m apart"
    # With the very files that the extension makes the command's points are the same but for their own roundings.
    assert bpy.ops.nabiki.write_scene(filepath=str(command.folder / "written.toml"), name="Sintel") == {"FINISHED"}
    same = command.frames("written.toml", "--strands", 300)
    near(found, commands.in_blender(same, origin), 0, "Sintel as it is written")
    way = np.abs(known[15] - known[0]).max()
    assert way > 0.01, "hardly anything moves"
    print(f"measured: Sintel: {left * 1000:.2g} mm apart, 99 of 100 points {most * 1000:.2g} mm, over {way * 100:.0f} cm")
    print(f"measured: Sintel with a rounding of the hair: {apart * 10:.2g} mm apart")
    baked_is(command, hair, "usdc")
    return None


def baked_is(command, hair, ending):
    """The bake reads back, every frame, as what the preview of all strands shows; velocities are those of motion blur."""
    scene = bpy.context.scene
    preview = simulated(hair, 10**6)
    wanted = all_frames(preview)
    hair.nabiki.cache_path = str(command.folder / f"cache.{ending}")
    scenes.active(hair)
    assert bpy.ops.nabiki.bake() == {"FINISHED"}
    baked = hair.nabiki.baked
    assert hair.nabiki.preview is None and hair.hide_render and not baked.hide_render
    found = all_frames(baked)
    near(found, wanted, 0, f"baked to .{ending}")
    # Between frames points go on straight lines in the head's space, and so does the head's place.
    own = [scenes.positions(scenes.evaluated(baked, frame)[1]) for frame in range(scene.frame_start, scene.frame_end + 1)]
    at = 10 - scene.frame_start
    near(scenes.positions(scenes.evaluated(baked, 10, 0.25)[1]), 0.75 * own[at] + 0.25 * own[at + 1], 0, "between frames")
    rate = scene.render.fps / scene.render.fps_base
    if bpy.app.version < (4, 5):
        # Its reader of curves leaves velocities where they are.
        return baked
    for frame in [scene.frame_start, 10, scene.frame_end - 1]:
        _, data = scenes.evaluated(baked, frame)
        speeds = scenes.vectors(data, "velocity")
        at = frame - scene.frame_start
        by_hand = (own[at + 1] - own[at]) * rate
        # A difference of two numbers of this size, each rounded, times the rate.
        near(speeds, by_hand, 8 * EPS * np.abs(own).max() * rate, f"velocities of frame {frame}")
        assert np.abs(speeds).max() > 0.01 or frame == scene.frame_start
    return baked


def test_a_bake_reads_back_with_its_velocities(command, shared):
    hair = scenes.groom(16)
    material = bpy.data.materials.new("Hair Material")
    hair.data.materials.append(material)
    mine = hair.data.attributes.new("mine", "FLOAT", "CURVE")
    mine.data.foreach_set("value", np.arange(scenes.STRANDS, dtype=np.float32))
    scenes.wind(70.0)
    for ending in ["usdc", "usda"]:
        baked_is(command, hair, ending)
    # Another wind into the same file: what was read of the old one is gone.
    hair.nabiki.strength_scale = 0.4
    again = baked_is(command, hair, ending)
    data = scenes.evaluated(again, 5)[1]
    assert [m.name for m in data.materials] == ["Hair Material"]
    assert [value.value for value in data.attributes["mine"].data] == list(range(scenes.STRANDS))
    radii = [value.value for value in data.attributes["radius"].data]
    wanted = [value.value for value in hair.data.attributes["radius"].data]
    assert np.abs(np.array(radii) - wanted).max() <= 4 * EPS * max(wanted)


def test_a_rendered_animation_shows_the_motion(command, shared):
    """Rendering evaluates the scene by itself, without what is hidden in pictures: the motion goes on all the same."""
    hair = scenes.groom(6)
    # Thick enough for a small picture.
    hair.data.attributes["radius"].data.foreach_set("value", np.full(len(hair.data.points), 4e-3, np.float32))
    # Black before white: only what the hair covers changes the picture.
    black = bpy.data.materials.new("Black")
    black.use_nodes = True
    black.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0, 0, 0, 1)
    hair.data.materials.append(black)
    scenes.wind(70.0)
    preview = simulated(hair, 20)
    wanted = all_frames(preview)
    scene = bpy.context.scene
    scene.camera = scenes.linked("Camera", bpy.data.cameras.new("Camera"), scenes.PLACE - [0, 1, 0])
    scene.camera.rotation_euler = (np.pi / 2, 0, 0)
    for name in ["Head", "Ball"]:
        bpy.data.objects[name].hide_render = True
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (1, 1, 1, 1)
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.resolution_x = scene.render.resolution_y = 48
    scene.render.filepath, scene.frame_end = str(command.folder / "frame"), 6
    found = {}

    def written(scene, *_):
        found[scene.frame_current] = scenes.positions(preview.data) + np.array(preview.location)

    bpy.app.handlers.render_write.append(written)
    try:
        bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.render_write.remove(written)
    near(np.array([found[frame] for frame in range(1, 7)]), wanted, 0, "while it is rendered")
    pictures = [bpy.data.images.load(str(path)) for path in sorted(command.folder.glob("frame*.png"))]
    pixels = [np.array(picture.pixels[:]) for picture in pictures]
    assert len(pixels) == 6 and all(np.abs(a - b).max() > 0.05 for a, b in zip(pixels, pixels[1:], strict=False))


def test_an_alembic_bake_reads_back(command, shared):
    hair = scenes.groom(16)
    scenes.wind(70.0)
    wanted = all_frames(simulated(hair, 10**6))
    hair.nabiki.cache_path = str(command.folder / "cache.abc")
    scenes.active(hair)
    assert bpy.ops.nabiki.bake() == {"FINISHED"}
    near(all_frames(hair.nabiki.baked), wanted, 0, "baked to .abc")


def test_blender_knows_where_a_frame_has_moved_the_preview(command, shared):
    """Its bounds, by which what is out of sight is left out, are those of the points it has in each frame."""
    if "resize_curves" not in bpy.types.Curves.bl_rna.functions:
        return "Blender 4.2 cannot be told"
    hair = scenes.groom(16, moving=False)
    scenes.interval(hair, 16, (0, 90, 20))
    preview = simulated(hair, 40)
    boxes = []
    for frame in [1, 9, 15, 4]:
        points, _ = scenes.evaluated(preview, frame)
        box = np.array(preview.evaluated_get(bpy.context.evaluated_depsgraph_get()).bound_box) + np.array(preview.location)
        low, high = points.min(0) - box.min(0), box.max(0) - points.max(0)
        # From 4.5 on bounds have the radius about the points; Catmull-Rom curves may go out of their points by little.
        assert (abs(low) < 2e-3).all() and (abs(high) < 2e-3).all(), (frame, low, high)
        boxes.append(box)
    assert abs(boxes[2] - boxes[0]).max() > 0.01, boxes
