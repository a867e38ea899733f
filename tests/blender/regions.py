"""Regions by vertex groups of the head and attributes of the curves: their hair answers otherwise, other hair as before."""

import bpy
import numpy as np

import mistakes
import motions
import scenes


def painted(hair):
    """A vertex group of the head that is 1 where z is above its middle, and a weight per curve that is 1, 0.5 or 0."""
    head = hair.nabiki.head
    group = head.vertex_groups.new(name="Upper")
    for vertex in head.data.vertices:
        if vertex.co.z > 0.5 * scenes.RADIUS:
            group.add([vertex.index], 1.0, "REPLACE")
    mask = hair.data.attributes.new("mask", "FLOAT", "CURVE")
    weights = np.arange(scenes.STRANDS) % 3 / 2
    mask.data.foreach_set("value", weights.astype(np.float32))
    # Far enough from the border, which is as wide as a triangle.
    height = strands_of(hair.data)[:, 0, 2] / scenes.RADIUS
    return height > 0.65, height < 0.35, weights


def strands_of(data):
    return scenes.positions(data).reshape(scenes.STRANDS, scenes.POINTS, 3)


def region(hair, **settings):
    scenes.active(hair)
    assert bpy.ops.nabiki.region_add() == {"FINISHED"}
    added = hair.nabiki.regions[hair.nabiki.active_region]
    for name, value in settings.items():
        setattr(added, name, value)
    return added


def moved(hair):
    """Every strand in every frame."""
    found = motions.all_frames(motions.simulated(hair, 10**6))
    return found.reshape(len(found), scenes.STRANDS, scenes.POINTS, 3)


def test_regions_hold_their_hair_and_leave_other_hair_alone(command, shared):
    hair = scenes.groom(16, moving=False)
    upper, lower, weights = painted(hair)
    assert upper.sum() > 10 and lower.sum() > 10
    scenes.wind(70.0)
    free = moved(hair)
    way = np.abs(free[-1] - free[0]).max((1, 2))
    assert way.min() > 0.005, "hardly anything moves"

    of_group = region(hair, name="Upper", vertex_group="Upper", wind=0.0)
    by_group = moved(hair)
    motions.near(by_group[:, lower], free[:, lower], 0, "hair outside the vertex group")
    motions.near(by_group[:, upper], np.broadcast_to(free[:1, upper], free[:, upper].shape), 0, "hair that no wind moves")

    of_group.vertex_group, of_group.attribute = "", "mask"
    by_mask = moved(hair)
    motions.near(by_mask[:, weights == 0], free[:, weights == 0], 0, "hair of weight 0")
    still, half = weights == 1, weights == 0.5
    motions.near(by_mask[:, still], np.broadcast_to(free[:1, still], free[:, still].shape), 0, "hair of weight 1")
    less = np.abs(by_mask[-1] - by_mask[0]).max((1, 2))[half] / way[half]
    assert 0.2 < less.min() and less.max() < 0.95, f"half of the wind moves hair {less.min():.2f} to {less.max():.2f} as far"

    # Both: hair that the group and the attribute hold.
    of_group.vertex_group = "Upper"
    by_both = moved(hair)
    motions.near(by_both[:, weights == 0], free[:, weights == 0], 0, "hair of weight 0 in the attribute")
    motions.near(by_both[:, upper & still], np.broadcast_to(free[:1, upper & still], free[:, upper & still].shape), 0, "hair of both")
    motions.near(by_both[:, lower], free[:, lower], 0, "hair outside the vertex group")

    # The command moves the written scene alike, and a bake reads back.
    assert bpy.ops.nabiki.write_scene(filepath=str(command.folder / "written.toml"), name=hair.name) == {"FINISHED"}
    place = np.array(hair.nabiki.preview.location, np.float64)
    known = motions.commands.in_blender(command.frames("written.toml"), place)
    motions.near(by_both.reshape(known.shape), known, 0, "the written scene")
    motions.baked_is(command, hair, "usdc")

    scenes.active(hair)
    assert bpy.ops.nabiki.region_remove() == {"FINISHED"} and not hair.nabiki.regions
    motions.near(moved(hair), free, 0, "without the region")


def test_mistakes_about_regions_are_said_in_one_line(command, shared):
    hair = scenes.groom(8, moving=False)
    painted(hair)
    scenes.wind(70.0)
    added = region(hair, name="Bangs", vertex_group="Nowhere")
    mistakes.refused(bpy.ops.nabiki.simulate, '"Nowhere"', "pick one that it has")
    added.vertex_group, added.attribute = "", "nothing"
    mistakes.refused(bpy.ops.nabiki.simulate, '"nothing"', "Nabiki > Regions > Bangs")
    large = hair.data.attributes.new("large", "FLOAT", "CURVE")
    large.data.foreach_set("value", np.full(scenes.STRANDS, 2.0, np.float32))
    added.attribute = "large"
    mistakes.refused(bpy.ops.nabiki.simulate, 'the region "Bangs"', "must be 0 to 1")
    added.attribute = ""
    assert bpy.ops.nabiki.simulate() == {"FINISHED"}
