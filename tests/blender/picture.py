"""Draws the picture of docs/blender.md with Cycles: the gust's hair, moved and baked by the extension, with motion blur.

Wants a Python that has bpy, BLENDER_USER_RESOURCES set to a new folder, and three arguments: the extension's .zip, a folder for
files, the picture's name.
"""

import math
import sys
from pathlib import Path

import bpy

import extension
import scenes

STRANDS, FRAME = 14000, 38


def main():
    archive, work, picture = (Path(word).resolve() for word in sys.argv[1:4])
    extension.install(archive)
    import nabiki

    root = Path(__file__).resolve().parents[2]
    groom = nabiki.Scene.open(root / "scenes" / "gust.toml", {"motion.frames": 1, "output.sheet": [0]})
    groom.export(work / "groom.usdc", strands=STRANDS)
    scene = scenes.empty(60)
    bpy.ops.wm.usd_import(filepath=str(work / "groom.usdc"))
    scene.frame_start, scene.frame_end = 1, 60
    (hair,) = [thing for thing in bpy.data.objects if thing.type == "CURVES"]
    (head,) = [thing for thing in bpy.data.objects if thing.type == "MESH"]
    hair.data.materials.append(hair_material())
    head.data.materials.append(skin_material())
    settings = hair.nabiki
    # It was written looking along x.
    settings.head, settings.facing = head, "+x"
    for last, vector in [(6, (0, 0, 0)), (44, (-170, 20, 90)), (60, (0, 0, 0))]:
        scenes.interval(hair, last, vector)
    settings.stiffness = (4000, 400)
    settings.use_flow = settings.use_gust = True
    settings.cache_path = str(work / "picture.usdc")
    scenes.active(hair)
    assert bpy.ops.nabiki.bake() == {"FINISHED"}
    drawn(scene, picture)


def hair_material():
    material = bpy.data.materials.new("Hair")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    fibre, output = tree.nodes.new("ShaderNodeBsdfHairPrincipled"), tree.nodes.new("ShaderNodeOutputMaterial")
    fibre.parametrization = "MELANIN"
    fibre.inputs["Melanin"].default_value, fibre.inputs["Melanin Redness"].default_value = 0.5, 0.9
    fibre.inputs["Roughness"].default_value = 0.25
    tree.links.new(fibre.outputs[0], output.inputs[0])
    return material


def skin_material():
    material = bpy.data.materials.new("Skin")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (0.45, 0.32, 0.27, 1)
    shader.inputs["Roughness"].default_value = 0.6
    return material


def drawn(scene, picture):
    camera = scenes.linked("Camera", bpy.data.cameras.new("Camera"), (0.62, -1.05, 0.05))
    camera.data.lens = 72
    aim(camera, (-0.07, 0, -0.02))
    scene.camera = camera
    for name, place, size, watts in [("Key", (1.0, -1.2, 0.9), 0.8, 34), ("Rim", (-1.0, 0.9, 1.1), 0.6, 70)]:
        lamp = bpy.data.lights.new(name, "AREA")
        lamp.size, lamp.energy = size, watts
        aim(scenes.linked(name, lamp, place), (0, 0, 0))
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.55, 0.58, 0.62, 1)
    scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0.7
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 128, False
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.35
    scene.render.resolution_x, scene.render.resolution_y = 960, 540
    scene.view_settings.view_transform = "AgX"
    scene.render.filepath = str(picture)
    scene.frame_set(FRAME)
    bpy.ops.render.render(write_still=True)


def aim(thing, at):
    way = scenes.vector(at) - thing.location
    thing.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    assert all(math.isfinite(angle) for angle in thing.rotation_euler)


if __name__ == "__main__":
    main()
